//! Cast shadows: the outlines of what casts, projected along the light onto the planes that it falls on.
//!
//! Only what falls into the window of the image in which the plane is seen is cast ([`Beam`]): the outlines of what casts have
//! thousands of corners, and most planes are small. The outlines know no camera and stay while the light stays. A body's shadow is that of its lit side, or of its dark side where that is much the larger
//! (a sheet seen by the light from behind): of a closed body both are the same, and both together would count its outline twice.
//! Where all of it stands over the plane its [`silhouette`](super::silhouette) casts it, else each facet, cut at the plane.

use nalgebra::Vector3;

use super::beam::Beam;
use super::bounds::{Extent, Sphere};
use super::clip::keep_above;
use super::coverage::Window;
use super::planes::{Plane, PreparedScene};
use super::silhouette::Silhouette;
use super::source::Source;
use super::view::View;

impl Source {
    /// Where the outline of what casts is, seen from a plane; `sphere` is about all of it.
    fn classify(&self, outline: &Silhouette, sphere: &Sphere, plane: &Plane) -> RelativePosition {
        let highest = match self {
            Self::Parallel(_) => f64::INFINITY,
            Self::Point(position) => Shadows::BELOW_LIGHT * plane.height(position),
        };
        // The corners need not be looked at where all of a sphere is on one side.
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
            RelativePosition::Behind
        } else if lowest >= -Shadows::TOUCHING_M && greatest <= highest {
            RelativePosition::Between
        } else {
            RelativePosition::Across
        }
    }
}

/// Where something is, seen from a plane.
enum RelativePosition {
    /// Nothing of it is over the plane.
    Behind,
    /// All of it is between plane and light; it may stand on the plane.
    Between,
    /// Some of it is.
    Across,
}

/// What a part casts in one light.
#[derive(Debug, Clone, Default)]
struct PartShadow {
    /// Whether its dark side does.
    dark_side: bool,
    silhouette: Silhouette,
}

/// The shadows in a scene from one light.
#[derive(Debug, Clone, Default)]
pub(super) struct Shadows {
    source: Option<Source>,
    /// Of each part.
    part_shadow: Vec<PartShadow>,
    trimmed: Vec<Vector3<f64>>,
    cut: Vec<Vector3<f64>>,
    shadow: Vec<Vector3<f64>>,
}

impl Shadows {
    /// What lies less than this above a plane casts no shadow on it, m: it touches it.
    const TOUCHING_M: f64 = 1e-6;
    /// What lies higher than this share of a near light's height above a plane casts none: its shadow would have no end.
    const BELOW_LIGHT: f64 = 0.999;
    /// How many times the lit side the dark side must be to cast: a sheet seen from behind has next to no lit side. A tube, such
    /// as the rim of a plate whose faces are parts of their own, has both, of which a near light sees the dark one a little the
    /// larger; but that one's shadow lies within that of the face towards the light, and the lit one's beside it.
    const LARGER: f64 = 2.0;

    /// Forgets all.
    pub(super) fn forget(&mut self) {
        self.source = None;
    }

    /// Turns to a light, unless it is the last one: then the outlines of what casts stay.
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
            part_shadow.dark_side = dark > lit * Self::LARGER;
            let casts = |index: usize| source.casts_shadow(&part.facets[index], part_shadow.dark_side);
            part_shadow.silhouette.find(&ready.outlines, casts);
        }
    }

    /// Hands the polygons of the shadows on a plane to `take`, anticlockwise as seen from its front: right inside a window of
    /// the image, and outside of it as it happens.
    pub(super) fn find(
        &mut self,
        plane: &Plane,
        prepared: &PreparedScene,
        view: &View<'_>,
        window: Window,
        mut take: impl FnMut(&[Vector3<f64>]),
    ) {
        let Some(source) = self.source.filter(|source| source.illuminates(plane)) else { return };
        let beam = Beam::new(source, plane, view, window);
        let parts = prepared.scene.parts.iter().zip(&prepared.parts).zip(&self.part_shadow);
        for (index, ((part, ready), part_shadow)) in parts.enumerate() {
            if index == plane.part || ready.casters.is_empty() || beam.misses(&ready.sphere) {
                continue;
            }
            match source.classify(&part_shadow.silhouette, &ready.sphere, plane) {
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
                        let is_behind = plane.height(&caster.sphere.centre) < -caster.sphere.radius;
                        if is_behind
                            || !source.casts_shadow(facet, part_shadow.dark_side)
                            || beam.misses(&caster.sphere)
                        {
                            continue;
                        }
                        for polygon in 0..caster.loops.len() {
                            beam.trim(&caster.loops, polygon, &mut self.trimmed);
                            cut_between(&mut self.trimmed, plane, source, &mut self.cut);
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

/// Puts what of a polygon lies between plane and light into `cut`, and leaves anything in the polygon.
fn cut_between(polygon: &mut Vec<Vector3<f64>>, plane: &Plane, source: Source, cut: &mut Vec<Vector3<f64>>) {
    keep_above(polygon, cut, |point| plane.height(point) - Shadows::TOUCHING_M);
    if let Source::Point(position) = source {
        let highest = Shadows::BELOW_LIGHT * plane.height(&position);
        std::mem::swap(polygon, cut);
        keep_above(polygon, cut, |point| highest - plane.height(point));
    }
}

/// Puts the shadow of a polygon between plane and light into `shadow`; whether it may fall on the plane's facets. Where it
/// passes by these it must not shade the pixels that they have on their border.
fn cast(
    polygon: &[Vector3<f64>],
    plane: &Plane,
    source: Source,
    dark_side: bool,
    shadow: &mut Vec<Vector3<f64>>,
) -> bool {
    shadow.clear();
    if polygon.len() < 3 {
        return false;
    }
    match source {
        Source::Parallel(towards) => {
            let climb = plane.normal.dot(&towards);
            let along = |point: &Vector3<f64>| point - towards * (plane.height(point) / climb);
            shadow.extend(polygon.iter().map(along));
        }
        Source::Point(position) => {
            let height = plane.height(&position);
            let along = |point: &Vector3<f64>| {
                position + (point - position) * (height / (height - plane.height(point)))
            };
            shadow.extend(polygon.iter().map(along));
        }
    }
    if dark_side {
        shadow.reverse();
    }
    plane.extent.overlaps(&Extent::from_points(shadow.iter()))
}
