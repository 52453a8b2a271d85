//! The target's disk: a dark plate with bright marks in its plane.

use std::f64::consts::PI;

use contract::OutOfRange;
use contract::bounds::require;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::checks::check_source;
use super::shapes::{COARSE_SAGITTA_M, Circle, FINE_SAGITTA_M, flat};
use super::{Assembly, Part};

/// Maximum number of marks on a plate: each mark is a hole in the plate, is compared with every other mark,
/// and has a bit in the truth of a field.
const MAX_MARKS: usize = 64;

/// `[plate]`: dark disk in the plane y3 = 0, centred on the origin of the target frame.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct PlateTable {
    /// Source of the values, or `assumed: why`.
    pub source: String,
    /// Radius, m, 0.01 to 10.
    #[schemars(range(min = 0.01, max = 10))]
    pub radius_m: f64,
    /// Lambertian reflectance, 0 to 1.
    #[schemars(range(min = 0, max = 1))]
    pub reflectance: f64,
}

/// `[marks]`: bright marks in the plane of the plate: a ring of equal marks, single marks, or both. They are
/// numbered from 0, those of the ring first, then the single marks.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct MarksTable {
    /// Source of the values, or `assumed: why`.
    pub source: String,
    /// Lambertian reflectance, 0 to 1.
    #[schemars(range(min = 0, max = 1))]
    pub reflectance: f64,
    /// Equal marks along a circle about the plate's centre.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub ring: Option<MarkRing>,
    /// Single marks.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub quad: Vec<MarkQuad>,
}

/// `[marks.ring]`: equal rectangles along a circle, each with its length along the radius.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct MarkRing {
    /// Radius of the circle through the marks' centres, m, positive.
    #[schemars(extend("exclusiveMinimum" = 0, "maximum" = 100))]
    pub circle_radius_m: f64,
    /// Number of marks, 1 to 64.
    #[schemars(range(min = 1, max = 64))]
    pub count: usize,
    /// Length of a mark along the radius, m, positive.
    #[schemars(extend("exclusiveMinimum" = 0, "maximum" = 100))]
    pub length_m: f64,
    /// Width of a mark across the radius, m, positive.
    #[schemars(extend("exclusiveMinimum" = 0, "maximum" = 100))]
    pub width_m: f64,
    /// Angle of the first mark, degrees from +y1 towards +y2, −360 to 360; the other marks follow in that
    /// direction.
    #[schemars(range(min = -360, max = 360))]
    pub first_angle_deg: f64,
}

/// `[[marks.quad]]`: one mark, any convex quadrangle.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct MarkQuad {
    /// Corners (y1, y2), m, counter-clockwise seen from the front.
    #[schemars(inner(inner(range(min = -100, max = 100))))]
    pub corners_m: [[f64; 2]; 4],
}

impl PlateTable {
    pub(super) fn check(&self) -> Result<(), OutOfRange> {
        check_source("plate.source", &self.source)
    }

    /// Returns the plate, with each mark as a hole and as a separate facet.
    pub(super) fn part(&self, marks: Option<&MarksTable>) -> Part {
        let outline = Circle { centre_m: [0.0, 0.0], radius_m: self.radius_m }.polygon_within(FINE_SAGITTA_M);
        let quads = marks.map(MarksTable::quads).unwrap_or_default();
        let holes: Vec<&[[f64; 2]]> = quads.iter().map(|quad| quad.as_slice()).collect();
        let mut facets = vec![flat(&outline, &holes, 0.0, self.reflectance)];
        let bright = marks.map_or(0.0, |marks| marks.reflectance);
        facets.extend(quads.iter().map(|quad| flat(quad, &[], 0.0, bright)));
        Part {
            name: "plate".to_owned(),
            assembly: Assembly::Target,
            facets,
            casts_shadow: true,
            visible: true,
        }
    }
}

impl MarksTable {
    pub(super) fn check(&self, plate: &PlateTable) -> Result<(), OutOfRange> {
        check_source("marks.source", &self.source)?;
        if let Some(ring) = &self.ring {
            ring.check(plate)?;
        }
        let count = self.ring.map_or(0, |ring| ring.count) + self.quad.len();
        require("number of marks", count as f64, "1 to 64 in marks.ring and marks.quad together", |n| {
            (1.0..=MAX_MARKS as f64).contains(&n)
        })?;
        let quads = self.quads();
        let first = quads.len() - self.quad.len();
        for (i, quad) in quads.iter().enumerate().skip(first) {
            let refuse = |expected| {
                Err(OutOfRange::new(
                    format!("marks.quad[{}].corners_m", i - first),
                    format!("{quad:?}"),
                    expected,
                ))
            };
            if !quad.iter().all(|corner| inside_plate(*corner, plate)) {
                return refuse("four corners at least 0.1 mm inside the plate's edge");
            }
            if !is_convex_counter_clockwise(quad) {
                return refuse(
                    "a convex quadrilateral with corners counter-clockwise as seen from the front",
                );
            }
            if quads[..i].iter().any(|other| overlap(other, quad)) {
                return refuse("a mark that overlaps no earlier mark");
            }
        }
        Ok(())
    }

    /// Returns the corners of all marks, counter-clockwise.
    pub(super) fn quads(&self) -> Vec<[[f64; 2]; 4]> {
        let ring = self.ring.iter().flat_map(MarkRing::quads);
        ring.chain(self.quad.iter().map(|quad| quad.corners_m)).collect()
    }

    /// Radius of the circle through the centres of the marks, m: that of the ring, or the mean over the
    /// single marks without a ring.
    pub(super) fn circle_radius_m(&self) -> f64 {
        if let Some(ring) = &self.ring {
            return ring.circle_radius_m;
        }
        let radii = self.quad.iter().map(|quad| {
            let sum = |axis: usize| quad.corners_m.iter().map(|corner| corner[axis]).sum::<f64>();
            libm::hypot(sum(0), sum(1)) / 4.0
        });
        radii.sum::<f64>() / self.quad.len() as f64
    }
}

impl MarkRing {
    fn check(&self, plate: &PlateTable) -> Result<(), OutOfRange> {
        let inner_m = self.circle_radius_m - self.length_m / 2.0;
        let outer_m = self.circle_radius_m + self.length_m / 2.0;
        require("marks.ring.length_m", self.length_m, "less than twice circle_radius_m", |_| inner_m > 0.0)?;
        require(
            "marks.ring.circle_radius_m",
            self.circle_radius_m,
            "a radius that leaves the marks at least 0.1 mm inside the plate's edge",
            |_| inside_plate([outer_m, self.width_m / 2.0], plate),
        )?;
        // Neighbouring marks are closest at their inner corners.
        let angle = 2.0 * libm::atan2(self.width_m / 2.0, inner_m);
        require(
            "marks.ring.count",
            self.count as f64,
            "1 to 64, and at most as many as fit side by side on the circle",
            |n| n * angle < 2.0 * PI,
        )
    }

    fn quads(&self) -> impl Iterator<Item = [[f64; 2]; 4]> + '_ {
        let (inner_m, outer_m) =
            (self.circle_radius_m - self.length_m / 2.0, self.circle_radius_m + self.length_m / 2.0);
        let half_m = self.width_m / 2.0;
        (0..self.count).map(move |i| {
            let turn = 2.0 * PI * i as f64 / self.count as f64;
            let (sin, cos) = libm::sincos(self.first_angle_deg.to_radians() + turn);
            [[inner_m, -half_m], [outer_m, -half_m], [outer_m, half_m], [inner_m, half_m]]
                .map(|[along, across]| [cos * along - sin * across, sin * along + cos * across])
        })
    }
}

/// Returns true if a point of a mark lies inside the polygon that approximates the plate's edge.
fn inside_plate(point: [f64; 2], plate: &PlateTable) -> bool {
    libm::hypot(point[0], point[1]) <= plate.radius_m - COARSE_SAGITTA_M
}

/// Twice the signed area of the triangle a, b, c: positive if the corners are counter-clockwise.
fn turn(a: [f64; 2], b: [f64; 2], c: [f64; 2]) -> f64 {
    (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
}

fn is_convex_counter_clockwise(quad: &[[f64; 2]; 4]) -> bool {
    (0..4).all(|i| turn(quad[i], quad[(i + 1) % 4], quad[(i + 2) % 4]) > 0.0)
}

/// Returns true if two convex quadrangles touch or overlap: no side of either separates them.
fn overlap(a: &[[f64; 2]; 4], b: &[[f64; 2]; 4]) -> bool {
    let separates = |quad: &[[f64; 2]; 4], other: &[[f64; 2]; 4]| {
        (0..4).any(|i| other.iter().all(|p| turn(quad[i], quad[(i + 1) % 4], *p) < 0.0))
    };
    !separates(a, b) && !separates(b, a)
}
