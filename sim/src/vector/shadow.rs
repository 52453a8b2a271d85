//! Cast shadows: the outlines of what casts, projected along the light onto the planes that it falls on.
//!
//! They lie in the target's frame and know no camera, so that they stay while the light stays; they are found for a plane
//! when it is first seen. A body's shadow is that of its lit side, or of its dark side where that is the larger (a sheet
//! seen by the light from behind): of a closed body both are the same, and both together would count its outline twice.
//! Where all of it stands over the plane its [`silhouette`](super::silhouette) casts it, else each facet, cut at the plane.

use std::ops::Range;

use nalgebra::Vector3;

use super::clip::keep_above;
use super::planes::{Extent, Plane, Prepared, Sphere};
use super::silhouette::Silhouette;
use crate::scene::docking::Facet;

/// Where light comes from.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Source {
    /// From very far: the unit vector towards it.
    Parallel(Vector3<f64>),
    /// From a point, m.
    Point(Vector3<f64>),
}

impl Source {
    /// The vector towards the light from a point: a unit vector from very far.
    fn from(&self, point: &Vector3<f64>) -> Vector3<f64> {
        match self {
            Self::Parallel(towards) => *towards,
            Self::Point(position) => position - point,
        }
    }

    /// Whether a plane has its front to the light.
    pub(super) fn lights(&self, plane: &Plane) -> bool {
        match self {
            Self::Parallel(towards) => plane.normal.dot(towards) > 0.0,
            Self::Point(position) => plane.height(position) > 0.0,
        }
    }

    /// Whether a facet is on the side of its part that casts.
    fn casts(&self, facet: &Facet, dark_side: bool) -> bool {
        let Some(corner) = facet.outer.first() else { return false };
        (facet.normal.dot(&self.from(corner)) <= 0.0) == dark_side
    }

    /// Where the outline of what casts is, seen from a plane.
    fn place(&self, outline: &Silhouette, plane: &Plane) -> Place {
        let heights = outline.polygons().flatten().map(|point| plane.height(point));
        let nothing = (f64::INFINITY, f64::NEG_INFINITY);
        let (lowest, greatest) =
            heights.fold(nothing, |(low, high), height| (height.min(low), height.max(high)));
        let highest = match self {
            Self::Parallel(_) => f64::INFINITY,
            Self::Point(position) => Shadows::BELOW_LIGHT * plane.height(position),
        };
        if greatest <= Shadows::TOUCHING_M {
            Place::Behind
        } else if lowest >= -Shadows::TOUCHING_M && greatest <= highest {
            Place::Between
        } else {
            Place::Across
        }
    }

    /// Whether one sphere may stand between another and the light.
    fn may_shade(&self, caster: &Sphere, receiver: &Sphere) -> bool {
        let reach = caster.radius + receiver.radius;
        let from_receiver = caster.centre - receiver.centre;
        let way = self.from(&receiver.centre);
        let (length, longest) = match self {
            Self::Parallel(_) => (1.0, f64::INFINITY),
            Self::Point(_) => (way.norm(), way.norm()),
        };
        if length == 0.0 {
            return true;
        }
        let along = (from_receiver.dot(&way) / length).clamp(0.0, longest);
        (from_receiver - way * (along / length)).norm_squared() <= reach * reach
    }
}

/// Where something is, seen from a plane.
enum Place {
    /// Nothing of it is over the plane.
    Behind,
    /// All of it is between plane and light; it may stand on the plane.
    Between,
    /// Some of it is.
    Across,
}

/// What a part casts in one light.
#[derive(Debug, Clone, Default)]
struct Casting {
    /// Whether its dark side does.
    dark_side: bool,
    silhouette: Silhouette,
}

/// The shadows on the planes of a scene from one light.
#[derive(Debug, Clone, Default)]
pub(super) struct Shadows {
    source: Option<Source>,
    points: Vec<Vector3<f64>>,
    /// Where each polygon ends among the points.
    ends: Vec<usize>,
    /// Of each plane, its polygons; `None` where they have not been asked for.
    of_plane: Vec<Option<Range<usize>>>,
    /// Of each part.
    casting: Vec<Casting>,
    cut: Vec<Vector3<f64>>,
}

impl Shadows {
    /// What lies less than this above a plane casts no shadow on it, m: it touches it.
    const TOUCHING_M: f64 = 1e-6;
    /// What lies higher than this share of a near light's height above a plane casts none: its shadow would have no end.
    const BELOW_LIGHT: f64 = 0.999;
    /// By how much the dark side must be the larger to cast, against rounding.
    const LARGER: f64 = 1.0 + 1e-6;

    /// Forgets all.
    pub(super) fn forget(&mut self) {
        self.source = None;
    }

    /// The polygons of the shadows on a plane that were found, anticlockwise as seen from its front.
    pub(super) fn on(&self, plane: usize) -> impl Iterator<Item = &[Vector3<f64>]> {
        let range = self.of_plane.get(plane).cloned().flatten().unwrap_or(0..0);
        range.map(|index| {
            let start = if index == 0 { 0 } else { self.ends[index - 1] };
            &self.points[start..self.ends[index]]
        })
    }

    /// Turns to a light, unless it is the last one: then what was found stays.
    pub(super) fn update(&mut self, prepared: &Prepared, source: Source) {
        if self.source == Some(source) {
            return;
        }
        self.source = Some(source);
        self.points.clear();
        self.ends.clear();
        self.of_plane.clear();
        self.of_plane.resize(prepared.planes.len(), None);
        self.casting.resize_with(prepared.parts.len(), Casting::default);
        let parts = prepared.scene.parts.iter().zip(&prepared.parts);
        for ((part, ready), casting) in parts.zip(&mut self.casting) {
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
            casting.dark_side = dark > lit * Self::LARGER;
            let casts = |index: usize| source.casts(&part.facets[index], casting.dark_side);
            casting.silhouette.find(&ready.outlines, casts);
        }
    }

    /// Finds the shadows on a plane, unless that is done.
    pub(super) fn find(&mut self, index: usize, prepared: &Prepared) {
        let Some(source) = self.source else { return };
        if self.of_plane.get(index).is_none_or(Option::is_some) {
            return;
        }
        let (plane, start) = (&prepared.planes[index], self.ends.len());
        if source.lights(plane) {
            // Taken out, so that the rest can be written to meanwhile.
            let casting = std::mem::take(&mut self.casting);
            self.cast_on(plane, &casting, prepared, source);
            self.casting = casting;
        }
        self.of_plane[index] = Some(start..self.ends.len());
    }

    fn cast_on(&mut self, plane: &Plane, casting: &[Casting], prepared: &Prepared, source: Source) {
        let parts = prepared.scene.parts.iter().zip(&prepared.parts).zip(casting);
        for (index, ((part, ready), casting)) in parts.enumerate() {
            if index == plane.part
                || ready.casters.is_empty()
                || !source.may_shade(&ready.sphere, &plane.sphere)
            {
                continue;
            }
            match source.place(&casting.silhouette, plane) {
                Place::Behind => continue,
                Place::Between => {
                    for outline in casting.silhouette.polygons() {
                        self.cut.clear();
                        self.cut.extend_from_slice(outline);
                        self.cast(plane, source, casting.dark_side);
                    }
                    continue;
                }
                Place::Across => {}
            }
            for (facet, caster) in part.facets.iter().zip(&ready.casters) {
                if !source.casts(facet, casting.dark_side) || !source.may_shade(&caster.sphere, &plane.sphere)
                {
                    continue;
                }
                for polygon in std::iter::once(&facet.outer).chain(&facet.holes) {
                    keep_above(polygon, &mut self.cut, |point| plane.height(point) - Self::TOUCHING_M);
                    if let Source::Point(position) = source {
                        let highest = Self::BELOW_LIGHT * plane.height(&position);
                        let upper = std::mem::take(&mut self.cut);
                        keep_above(&upper, &mut self.cut, |point| highest - plane.height(point));
                    }
                    self.cast(plane, source, casting.dark_side);
                }
            }
        }
    }

    /// Adds the shadow of the polygon in `cut`, which lies between plane and light.
    fn cast(&mut self, plane: &Plane, source: Source, dark_side: bool) {
        let start = self.points.len();
        match source {
            Source::Parallel(towards) => {
                let climb = plane.normal.dot(&towards);
                let shadow = |point: &Vector3<f64>| point - towards * (plane.height(point) / climb);
                self.points.extend(self.cut.iter().map(shadow));
            }
            Source::Point(position) => {
                let height = plane.height(&position);
                let shadow = |point: &Vector3<f64>| {
                    position + (point - position) * (height / (height - plane.height(point)))
                };
                self.points.extend(self.cut.iter().map(shadow));
            }
        }
        if !plane.extent.meets(&Extent::of(&self.points[start..])) {
            self.points.truncate(start);
            return;
        }
        if dark_side {
            self.points[start..].reverse();
        }
        self.ends.push(self.points.len());
    }
}
