//! Cast shadows: the outlines of shadow casters, projected along the light onto the planes that the shadows
//! fall on.
//!
//! Only shadows that fall into the window of the image in which the plane is visible are cast ([`Beam`]): the
//! outlines of shadow casters have thousands of corners, and most planes are small. The outlines are
//! independent of the camera and are kept while the light stays unchanged. A body's shadow is cast by its lit
//! side, or by its dark side where that is much larger (a sheet lit from behind): for a closed body both
//! sides cast the same shadow, and together they would count its outline twice. A body that stands completely
//! over the plane is cast by its [`silhouette`](super::silhouette); otherwise each facet is cut at the plane
//! and cast separately.

use nalgebra::Vector3;

use super::beam::Beam;
use super::bounds::{Extent, Sphere};
use super::coverage::Window;
use super::planes::{PartPlane, PreparedScene};
use super::silhouette::Silhouette;
use super::view::View;
use scene::docking::Facet;
use scene::shadow::{Plane, Source};

/// Position of an object relative to a plane.
enum RelativePosition {
    /// No part of the object is over the plane.
    Behind,
    /// The whole object is between plane and light; it may stand on the plane.
    Between,
    /// Part of the object is between plane and light.
    Across,
}

impl RelativePosition {
    /// Returns the position of a caster's outline relative to a plane; `sphere` encloses the caster.
    fn new(outline: &Silhouette, sphere: &Sphere, plane: &Plane, source: &Source) -> Self {
        let highest = source.highest(plane);
        // The corners need no test if their sphere lies completely on one side.
        let sure = |sphere: &Sphere| {
            let height = plane.height(&sphere.centre);
            let (low, high) = (height - sphere.radius, height + sphere.radius);
            let is_sure = high < -Shadows::TOUCHING_M || (low > Shadows::TOUCHING_M && high < highest);
            is_sure.then_some((low, high))
        };
        let (mut lowest, mut greatest) = (f64::INFINITY, f64::NEG_INFINITY);
        if let Some(heights) = sure(sphere) {
            (lowest, greatest) = heights;
        } else {
            for (sphere, points) in outline.loops.all_stretches() {
                if let Some((low, high)) = sure(sphere) {
                    (lowest, greatest) = (low.min(lowest), high.max(greatest));
                } else {
                    for height in points.iter().map(|point| plane.height(point)) {
                        (lowest, greatest) = (height.min(lowest), height.max(greatest));
                    }
                }
                let is_across = lowest < -Shadows::TOUCHING_M && greatest > Shadows::TOUCHING_M;
                if is_across {
                    break;
                }
            }
        }
        if greatest <= Shadows::TOUCHING_M {
            Self::Behind
        } else if lowest >= -Shadows::TOUCHING_M && greatest <= highest {
            Self::Between
        } else {
            Self::Across
        }
    }
}

/// Shadow-casting outline of a part in one light.
#[derive(Debug, Clone, Default)]
struct PartShadow {
    /// True if the dark side of the part casts the shadow.
    dark_side: bool,
    silhouette: Silhouette,
}

/// Shadows in a scene from one light.
#[derive(Debug, Clone, Default)]
pub(super) struct Shadows {
    source: Option<Source>,
    /// Shadow-casting outline of each part.
    part_shadow: Vec<PartShadow>,
    trimmed: Vec<Vector3<f64>>,
    cut: Vec<Vector3<f64>>,
    shadow: Vec<Vector3<f64>>,
}

impl Shadows {
    /// Height above a plane below which a point touches the plane and casts no shadow on it, m.
    const TOUCHING_M: f64 = 1e-6;
    /// Ratio of dark side to lit side above which the dark side casts the shadow. A sheet lit from behind has
    /// almost no lit side. A tube, such as the rim of a plate whose faces are separate parts, has both sides,
    /// and a near light sees the dark side slightly larger; but the shadow of that dark side lies within that
    /// of the face towards the light, and the shadow of the lit side lies beside it.
    const DARK_OVER_LIT: f64 = 2.0;

    /// Discards the light and its outlines.
    pub(super) fn forget(&mut self) {
        self.source = None;
    }

    /// Prepares the outlines of the casters for a light; keeps them if the light is unchanged.
    pub(super) fn update(&mut self, prepared: &PreparedScene, source: Source) {
        if self.source == Some(source) {
            return;
        }
        self.source = Some(source);
        self.part_shadow.resize_with(prepared.parts.len(), PartShadow::default);
        let parts = prepared.scene.parts.iter().zip(&prepared.parts);
        for ((part, ready), part_shadow) in parts.zip(&mut self.part_shadow) {
            let (mut lit, mut dark) = (0.0, 0.0);
            for (facet, caster) in part.facets.iter().zip(&ready.casters) {
                let towards = source.from(&caster.sphere.centre);
                let seen = match source {
                    Source::Parallel(_) => caster.area * facet.normal.dot(&towards),
                    Source::Point(_) => {
                        let distance = towards.norm();
                        caster.area * facet.normal.dot(&towards) / (distance * distance * distance)
                    }
                };
                if seen > 0.0 { lit += seen } else { dark -= seen }
            }
            part_shadow.dark_side = dark > lit * Self::DARK_OVER_LIT;
            let casts = |index: usize| casts_shadow(&source, &part.facets[index], part_shadow.dark_side);
            part_shadow.silhouette.find(&ready.outlines, casts);
        }
    }

    /// Passes the polygons of the shadows on a plane to `take`, anticlockwise as seen from the plane's front.
    /// The shadows are correct inside a window of the image, and arbitrary outside it.
    pub(super) fn find(
        &mut self,
        plane: &PartPlane,
        prepared: &PreparedScene,
        view: &View<'_>,
        window: Window,
        mut take: impl FnMut(&[Vector3<f64>]),
    ) {
        let surface = &plane.surface;
        let Some(source) = self.source.filter(|source| source.illuminates(surface)) else { return };
        let beam = Beam::new(source, surface, view, window);
        let parts = prepared.scene.parts.iter().zip(&prepared.parts).zip(&self.part_shadow);
        for (index, ((part, ready), part_shadow)) in parts.enumerate() {
            if index == plane.part || ready.casters.is_empty() || beam.misses(&ready.sphere) {
                continue;
            }
            match RelativePosition::new(&part_shadow.silhouette, &ready.sphere, surface, &source) {
                RelativePosition::Behind => {}
                RelativePosition::Between => {
                    let outlines = &part_shadow.silhouette.loops;
                    for outline in 0..outlines.len() {
                        beam.trim(outlines, outline, &mut self.cut);
                        if cast(&self.cut, plane, source, part_shadow.dark_side, &mut self.shadow) {
                            take(&self.shadow);
                        }
                    }
                }
                RelativePosition::Across => {
                    for (facet, caster) in part.facets.iter().zip(&ready.casters) {
                        let is_behind = surface.height(&caster.sphere.centre) < -caster.sphere.radius;
                        if is_behind
                            || !casts_shadow(&source, facet, part_shadow.dark_side)
                            || beam.misses(&caster.sphere)
                        {
                            continue;
                        }
                        for polygon in 0..caster.loops.len() {
                            beam.trim(&caster.loops, polygon, &mut self.trimmed);
                            source.cut_between(&mut self.trimmed, surface, Self::TOUCHING_M, &mut self.cut);
                            if cast(&self.cut, plane, source, part_shadow.dark_side, &mut self.shadow) {
                                take(&self.shadow);
                            }
                        }
                    }
                }
            }
        }
    }
}

/// Returns true if a facet belongs to the side of its part that casts the shadow.
fn casts_shadow(source: &Source, facet: &Facet, dark_side: bool) -> bool {
    let Some(corner) = facet.outer.first() else { return false };
    (facet.normal.dot(&source.from(corner)) <= 0.0) == dark_side
}

/// Writes the shadow of a polygon between plane and light to `shadow`; returns true if it may fall on the
/// plane's facets. A shadow that misses the facets must not darken the pixels on their border.
fn cast(
    polygon: &[Vector3<f64>],
    plane: &PartPlane,
    source: Source,
    dark_side: bool,
    shadow: &mut Vec<Vector3<f64>>,
) -> bool {
    if polygon.len() < 3 {
        return false;
    }
    source.cast(polygon, &plane.surface, shadow);
    if dark_side {
        shadow.reverse();
    }
    plane.extent.overlaps(&Extent::from_points(shadow.iter()))
}
