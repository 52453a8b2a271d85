//! A scene prepared for rendering: its facets grouped by plane, with bounds of all elements.

use std::ops::Range;

use nalgebra::Vector3;
use scene::docking::{DockingScene, Facet, Part};
use scene::shadow::Plane;

use super::bounds::{Extent, Sphere};
use super::loops::Loops;
use super::silhouette::FacetEdges;

/// Facets of one part that lie in one plane.
#[derive(Debug, Clone)]
pub(super) struct PartPlane {
    /// Index of the part in the scene.
    pub(super) part: usize,
    pub(super) surface: Plane,
    /// Indices of its facets in the part.
    pub(super) facets: Vec<usize>,
    pub(super) extent: Extent,
}

/// Data of a facet that casts a shadow.
#[derive(Debug, Clone)]
pub(super) struct Caster {
    pub(super) sphere: Sphere,
    /// Area, m².
    pub(super) area: f64,
    /// Outer boundary and holes.
    pub(super) loops: Loops,
}

/// A part prepared for rendering.
#[derive(Debug, Clone)]
pub(super) struct PreparedPart {
    /// Range of its planes in the scene.
    pub(super) planes: Range<usize>,
    pub(super) sphere: Sphere,
    /// One caster per facet; empty if the part casts no shadow.
    pub(super) casters: Vec<Caster>,
    /// Edges of its facets; empty if the part casts no shadow.
    pub(super) outlines: FacetEdges,
    /// True if corners of the part touch the previous part: both are surfaces of one body.
    pub(super) joins_previous: bool,
}

/// A scene with its prepared parts and planes.
#[derive(Debug, Clone, Default)]
pub(super) struct PreparedScene {
    pub(super) scene: DockingScene,
    pub(super) parts: Vec<PreparedPart>,
    pub(super) planes: Vec<PartPlane>,
}

impl PreparedScene {
    pub(super) fn new(scene: &DockingScene) -> Self {
        let mut planes = Vec::new();
        let before = std::iter::once(None).chain(scene.parts.iter().map(Some));
        let parts = before
            .zip(&scene.parts)
            .enumerate()
            .map(|(index, (before, part))| {
                let start = planes.len();
                if part.visible {
                    planes.extend(planes_of(part, index));
                }
                PreparedPart {
                    planes: start..planes.len(),
                    sphere: Sphere::enclosing(part.facets.iter().flat_map(|facet| &facet.outer)),
                    casters: if part.casts_shadow {
                        part.facets.iter().map(caster).collect()
                    } else {
                        Vec::new()
                    },
                    outlines: if part.casts_shadow {
                        FacetEdges::from_part(part)
                    } else {
                        FacetEdges::default()
                    },
                    joins_previous: before.is_some_and(|before| touch(before, part)),
                }
            })
            .collect();
        Self { scene: scene.clone(), parts, planes }
    }
}

/// Largest difference between the normals, and in metres between the offsets, of facets in one plane.
const SAME_PLANE: f64 = 1e-9;

/// Largest distance between the corners of parts that touch, m: circles with few and with many sides differ
/// by some millimetres.
const TOUCHING_M: f64 = 5e-3;

/// Returns true if both parts are visible and have corners that touch.
fn touch(one: &Part, other: &Part) -> bool {
    fn corners(part: &Part) -> impl Iterator<Item = &Vector3<f64>> {
        part.facets.iter().flat_map(|facet| std::iter::once(&facet.outer).chain(&facet.holes)).flatten()
    }
    let near = |corner: &Vector3<f64>| {
        corners(other).any(|point| (corner - point).norm_squared() <= TOUCHING_M * TOUCHING_M)
    };
    one.visible && other.visible && corners(one).any(near)
}

fn planes_of(part: &Part, index_of_part: usize) -> Vec<PartPlane> {
    let mut planes: Vec<PartPlane> = Vec::new();
    for (index, facet) in part.facets.iter().enumerate() {
        let Some(point) = facet.outer.first() else { continue };
        let offset = facet.normal.dot(point);
        let same = |plane: &&mut PartPlane| {
            (plane.surface.normal - facet.normal).norm() < SAME_PLANE
                && (plane.surface.offset - offset).abs() < SAME_PLANE
        };
        match planes.iter_mut().find(same) {
            Some(plane) => plane.facets.push(index),
            None => planes.push(PartPlane {
                part: index_of_part,
                surface: Plane { normal: facet.normal, offset },
                facets: vec![index],
                extent: Extent { low: *point, high: *point },
            }),
        }
    }
    for plane in &mut planes {
        let facets = plane.facets.iter().map(|index| &part.facets[*index]);
        plane.extent = Extent::from_points(facets.flat_map(|facet| &facet.outer));
    }
    planes
}

fn caster(facet: &Facet) -> Caster {
    let signed: f64 = std::iter::once(&facet.outer)
        .chain(&facet.holes)
        .map(|polygon| {
            let Some(last) = polygon.last() else { return 0.0 };
            let mut previous = last;
            let mut sum = Vector3::zeros();
            for point in polygon {
                sum += (previous - last).cross(&(point - last));
                previous = point;
            }
            0.5 * sum.dot(&facet.normal)
        })
        .sum();
    let mut loops = Loops::default();
    for polygon in std::iter::once(&facet.outer).chain(&facet.holes) {
        loops.push(polygon.iter().copied());
    }
    Caster { sphere: Sphere::enclosing(facet.outer.iter()), area: signed.abs(), loops }
}
