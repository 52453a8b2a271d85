//! Intersection of straight lines with the scene: determines the shadowed marks and the hidden part of the
//! Sun.

use nalgebra::Vector3;
use scene::docking::{Facet, Part};

/// Minimum distance at which a facet can hide a point, m: a point on a surface is not hidden by that surface.
const CLEARANCE_M: f64 = 1e-6;

/// Facets that hide objects behind them, from either side.
#[derive(Debug, Clone, PartialEq, Default)]
pub(super) struct Occluders {
    plates: Vec<Plate>,
}

/// Sphere that contains points which are tested together.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Region {
    pub(super) centre: Vector3<f64>,
    pub(super) radius_m: f64,
}

/// Occluders that can meet a ray from a region.
#[derive(Debug, Clone)]
pub(super) struct NearbyOccluders<'a> {
    plates: Vec<&'a Plate>,
}

/// Facet, with its boundary projected along the axis of the normal's largest component.
#[derive(Debug, Clone, PartialEq)]
struct Plate {
    normal: Vector3<f64>,
    distance_m: f64,
    axes: (usize, usize),
    low: [f64; 2],
    high: [f64; 2],
    rings: Vec<Vec<[f64; 2]>>,
    /// Centre and radius of a bounding sphere.
    centre: Vector3<f64>,
    radius_m: f64,
}

impl Occluders {
    /// Collects the facets of `parts` for which `keep` returns true.
    pub(super) fn new<'a>(parts: impl IntoIterator<Item = &'a Part>, keep: impl Fn(&Facet) -> bool) -> Self {
        let facets = parts.into_iter().flat_map(|part| &part.facets).filter(|facet| keep(facet));
        Self { plates: facets.filter_map(Plate::new).collect() }
    }

    /// Selects the occluders that can meet a ray from a region along the unit vector `towards`.
    pub(super) fn along_direction(&self, region: &Region, towards: &Vector3<f64>) -> NearbyOccluders<'_> {
        self.in_capsule(region, towards, f64::INFINITY)
    }

    /// Selects the occluders that can lie between a region and a point.
    pub(super) fn between_region_and_point(
        &self,
        region: &Region,
        point: &Vector3<f64>,
    ) -> NearbyOccluders<'_> {
        let way = point - region.centre;
        let length = way.norm();
        self.in_capsule(region, &(way / length.max(f64::MIN_POSITIVE)), length)
    }

    /// Selects the occluders that meet the capsule swept by the region along `towards`.
    fn in_capsule(&self, region: &Region, towards: &Vector3<f64>, length: f64) -> NearbyOccluders<'_> {
        let meets = |plate: &&Plate| {
            let from_region = plate.centre - region.centre;
            let along = from_region.dot(towards).clamp(0.0, length);
            let reach = region.radius_m + plate.radius_m + CLEARANCE_M;
            (from_region - towards * along).norm_squared() <= reach * reach
        };
        NearbyOccluders { plates: self.plates.iter().filter(meets).collect() }
    }
}

impl NearbyOccluders<'_> {
    /// Returns true if the ray from `from` along the unit vector `towards` meets an occluder.
    pub(super) fn hide(&self, from: &Vector3<f64>, towards: &Vector3<f64>) -> bool {
        self.plates.iter().any(|plate| plate.is_hit_by(from, towards, f64::INFINITY))
    }

    /// Returns true if an occluder lies between two points.
    pub(super) fn separate(&self, from: &Vector3<f64>, to: &Vector3<f64>) -> bool {
        let way = to - from;
        let length = way.norm();
        length > 0.0 && self.plates.iter().any(|plate| plate.is_hit_by(from, &(way / length), length))
    }
}

impl Plate {
    /// Creates a plate from a facet; `None` for a facet without corners.
    fn new(facet: &Facet) -> Option<Self> {
        let normal = facet.normal;
        let axes = match normal.iamax() {
            0 => (1, 2),
            1 => (2, 0),
            _ => (0, 1),
        };
        let flat = |ring: &Vec<Vector3<f64>>| ring.iter().map(|p| [p[axes.0], p[axes.1]]).collect::<Vec<_>>();
        let outer = flat(&facet.outer);
        let bound = |pick: fn(f64, f64) -> f64, start: f64| {
            [0, 1].map(|i| outer.iter().fold(start, |bound, corner| pick(bound, corner[i])))
        };
        let first = facet.outer.first()?;
        let (least, greatest) = facet
            .outer
            .iter()
            .fold((*first, *first), |(least, greatest), corner| (least.inf(corner), greatest.sup(corner)));
        let centre = 0.5 * (least + greatest);
        Some(Self {
            normal,
            distance_m: normal.dot(first),
            axes,
            low: bound(f64::min, f64::INFINITY),
            high: bound(f64::max, f64::NEG_INFINITY),
            centre,
            radius_m: facet.outer.iter().map(|corner| (corner - centre).norm()).fold(0.0, f64::max),
            rings: std::iter::once(outer).chain(facet.holes.iter().map(flat)).collect(),
        })
    }

    /// Returns true if the ray from `from` along the unit vector `towards` meets the facet at a distance
    /// below `reach_m`.
    fn is_hit_by(&self, from: &Vector3<f64>, towards: &Vector3<f64>, reach_m: f64) -> bool {
        let along = self.normal.dot(towards);
        let distance = (self.distance_m - self.normal.dot(from)) / along;
        // An infinite or undefined distance means a ray parallel to the plane, which meets nothing.
        if !(distance.is_finite() && distance > CLEARANCE_M && distance < reach_m - CLEARANCE_M) {
            return false;
        }
        let (a, b) = self.axes;
        let point = [from[a] + distance * towards[a], from[b] + distance * towards[b]];
        let inside = |i: usize| (self.low[i]..=self.high[i]).contains(&point[i]);
        // A point in a hole is inside two rings.
        inside(0) && inside(1) && self.rings.iter().fold(false, |odd, ring| odd ^ encloses(ring, point))
    }
}

/// Returns true if a polygon encloses a point, from the parity of the edges that a half-line crosses.
fn encloses(ring: &[[f64; 2]], [x, y]: [f64; 2]) -> bool {
    let next = ring.iter().cycle().skip(1);
    ring.iter().zip(next).fold(false, |inside, (p, q)| {
        let crosses = (p[1] > y) != (q[1] > y) && x < p[0] + (y - p[1]) / (q[1] - p[1]) * (q[0] - p[0]);
        inside ^ crosses
    })
}

#[cfg(test)]
mod tests {
    use scene::docking::Assembly;

    use super::*;

    /// Square of side 2 at y3 = 1 with a square hole of side 1.
    fn framed() -> Occluders {
        let square = |half: f64, sign: f64| {
            [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]]
                .map(|[x, y]: [f64; 2]| Vector3::new(sign * half * x, half * y, 1.0))
                .to_vec()
        };
        let facet = Facet {
            outer: square(1.0, 1.0),
            holes: vec![square(0.5, -1.0)],
            normal: Vector3::z(),
            reflectance: 0.5,
        };
        let part = Part {
            name: "frame".into(),
            assembly: Assembly::Station,
            facets: vec![facet],
            casts_shadow: true,
            visible: true,
        };
        Occluders::new([&part], |_| true)
    }

    #[test]
    fn a_frame_hides_but_not_through_its_hole_nor_behind() {
        let occluders = framed();
        let region = Region { centre: Vector3::zeros(), radius_m: 3.0 };
        // The region contains the whole frame, so no facet is left out.
        let frame = occluders.along_direction(&region, &Vector3::z());
        let up = Vector3::z();
        for (x, y, hidden) in [(0.75, 0.0, true), (0.0, -0.9, true), (0.2, 0.3, false), (1.1, 0.0, false)] {
            assert_eq!(frame.hide(&Vector3::new(x, y, 0.0), &up), hidden, "{x} {y}");
            assert!(!frame.hide(&Vector3::new(x, y, 2.0), &up), "from beyond");
            assert!(!frame.hide(&Vector3::new(x, y, 1.0), &up), "from itself");
        }
        let slanting = Vector3::new(0.6, 0.0, 0.8);
        assert!(frame.separate(&Vector3::new(0.75, 0.0, 0.0), &Vector3::new(0.75, 0.0, 1.5)));
        assert!(
            !frame.separate(&Vector3::new(0.75, 0.0, 0.0), &Vector3::new(0.75, 0.0, 0.9)),
            "it lies beyond"
        );
        assert!(!frame.separate(&Vector3::zeros(), &Vector3::zeros()), "no way at all");
        // The ray moves by 0.75 along y1 until y3 = 1.
        assert!(frame.hide(&Vector3::zeros(), &slanting));
        assert!(!frame.hide(&Vector3::new(-0.5, 0.0, 0.0), &slanting));
        assert!(!frame.hide(&Vector3::zeros(), &Vector3::x()), "a ray along the plane");
    }

    #[test]
    fn omitted_facets_meet_no_ray_of_the_region() {
        let frame = framed();
        let region = Region { centre: Vector3::new(4.0, 0.0, 0.0), radius_m: 0.5 };
        let mut met = 0;
        for i in 0..40 {
            let (sin, cos) = libm::sincos(f64::from(i) * std::f64::consts::PI / 20.0);
            let towards = Vector3::new(cos, 0.1, sin).normalize();
            let point = region.centre + towards * 6.0;
            for (dx, dy) in [(0.0, 0.0), (0.5, 0.0), (-0.35, 0.35), (0.0, -0.5)] {
                let plate_point = region.centre + Vector3::new(dx, dy, 0.0);
                let all = frame.plates[0].is_hit_by(&plate_point, &towards, f64::INFINITY);
                assert_eq!(
                    frame.along_direction(&region, &towards).hide(&plate_point, &towards),
                    all,
                    "{towards}"
                );
                let way = point - plate_point;
                let between = frame.plates[0].is_hit_by(&plate_point, &way.normalize(), way.norm());
                assert_eq!(
                    frame.between_region_and_point(&region, &point).separate(&plate_point, &point),
                    between,
                    "{towards}"
                );
                met += usize::from(all);
            }
        }
        assert!(met > 0, "no ray meets the frame");
    }
}
