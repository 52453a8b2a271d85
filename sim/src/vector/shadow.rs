//! Cast shadows: the outlines of what casts, projected along the light onto the planes that it falls on.
//!
//! They lie in the target's frame and know no camera, so that they stay while the light stays. A body's shadow is that of
//! its lit side, or of its dark side where that is the larger (a sheet seen by the light from behind): of a closed body
//! both are the same, and both together would count its outline twice.

use std::ops::Range;

use nalgebra::Vector3;

use super::clip::keep_above;
use super::planes::{Extent, Plane, Prepared, Sphere};
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

/// The shadows on every plane of a scene from one light.
#[derive(Debug, Clone, Default)]
pub(super) struct Shadows {
    source: Option<Source>,
    points: Vec<Vector3<f64>>,
    /// Where each polygon ends among the points.
    ends: Vec<usize>,
    /// Of each plane, its polygons.
    of_plane: Vec<Range<usize>>,
    /// Of each part, whether its dark side casts.
    dark_side: Vec<bool>,
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

    /// The polygons of the shadows on a plane, anticlockwise as seen from its front.
    pub(super) fn on(&self, plane: usize) -> impl Iterator<Item = &[Vector3<f64>]> {
        let range = self.of_plane.get(plane).cloned().unwrap_or(0..0);
        range.map(|index| {
            let start = if index == 0 { 0 } else { self.ends[index - 1] };
            &self.points[start..self.ends[index]]
        })
    }

    /// Finds the shadows from a light, unless they are those of the last one.
    pub(super) fn update(&mut self, prepared: &Prepared, source: Source) {
        if self.source == Some(source) {
            return;
        }
        self.source = Some(source);
        self.points.clear();
        self.ends.clear();
        self.of_plane.clear();
        self.dark_side.clear();
        for (part, ready) in prepared.scene.parts.iter().zip(&prepared.parts) {
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
            self.dark_side.push(dark > lit * Self::LARGER);
        }
        for (receiver, ready) in prepared.parts.iter().enumerate() {
            for plane in &prepared.planes[ready.planes.clone()] {
                let start = self.ends.len();
                if source.lights(plane) {
                    self.cast_on(plane, receiver, prepared, source);
                }
                self.of_plane.push(start..self.ends.len());
            }
        }
    }

    fn cast_on(&mut self, plane: &Plane, receiver: usize, prepared: &Prepared, source: Source) {
        for (index, ready) in prepared.parts.iter().enumerate() {
            if index == receiver
                || ready.casters.is_empty()
                || !source.may_shade(&ready.sphere, &plane.sphere)
            {
                continue;
            }
            let dark_side = self.dark_side[index];
            for (facet, caster) in prepared.scene.parts[index].facets.iter().zip(&ready.casters) {
                let Some(corner) = facet.outer.first() else { continue };
                let is_dark = facet.normal.dot(&source.from(corner)) <= 0.0;
                if is_dark == dark_side && source.may_shade(&caster.sphere, &plane.sphere) {
                    self.cast(facet, plane, source, dark_side);
                }
            }
        }
    }

    fn cast(&mut self, facet: &Facet, plane: &Plane, source: Source, dark_side: bool) {
        for polygon in std::iter::once(&facet.outer).chain(&facet.holes) {
            let start = self.points.len();
            keep_above(polygon, &mut self.cut, |point| plane.height(point) - Self::TOUCHING_M);
            match source {
                Source::Parallel(towards) => {
                    let climb = plane.normal.dot(&towards);
                    let shadow = |point: &Vector3<f64>| point - towards * (plane.height(point) / climb);
                    self.points.extend(self.cut.iter().map(shadow));
                }
                Source::Point(position) => {
                    let height = plane.height(&position);
                    let highest = Self::BELOW_LIGHT * height;
                    let upper = std::mem::take(&mut self.cut);
                    keep_above(&upper, &mut self.cut, |point| highest - plane.height(point));
                    let shadow = |point: &Vector3<f64>| {
                        position + (point - position) * (height / (height - plane.height(point)))
                    };
                    self.points.extend(self.cut.iter().map(shadow));
                }
            }
            if !plane.extent.meets(&Extent::of(&self.points[start..])) {
                self.points.truncate(start);
                continue;
            }
            if dark_side {
                self.points[start..].reverse();
            }
            self.ends.push(self.points.len());
        }
    }
}
