//! Bodies of simple shape: rails and antennas on the station's end, modules, trusses and solar panels behind
//! it.

use contract::OutOfRange;
use contract::bounds::require;
use nalgebra::Vector3;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::checks::{check_source, vector};
use super::shapes::{block, cylinder, facet};
use super::{Assembly, Facet, Part};

/// Maximum number of cells of a panel.
const MAX_CELLS: usize = 64;

/// Group of bodies with a common source: `[fittings]` on the station's end, or `[structure]` behind it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Bodies {
    /// Source of the values, or `assumed: why`.
    pub source: String,
    /// Bodies, in any order, 100 at most. Bodies whose extents along y3 overlap are separated across y3, so
    /// that none hides another from any possible camera position.
    #[schemars(length(max = 100))]
    pub body: Vec<Body>,
}

/// Opaque body; coordinates in the target frame.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "kind", rename_all = "snake_case", deny_unknown_fields)]
pub enum Body {
    /// Cylinder of any orientation: a rail, a mast, a dish, a module.
    Cylinder {
        /// Centre of one end, m.
        #[schemars(inner(range(min = -1000, max = 1000)))]
        from_m: [f64; 3],
        /// Centre of the other end, m, different from `from_m`.
        #[schemars(inner(range(min = -1000, max = 1000)))]
        to_m: [f64; 3],
        /// Radius, m, positive.
        #[schemars(extend("exclusiveMinimum" = 0, "maximum" = 1000))]
        radius_m: f64,
        /// Number of sides of the prism that approximates the cylinder, 3 to 128.
        #[schemars(range(min = 3, max = 128))]
        sides: usize,
        /// Lambertian reflectance, 0 to 1.
        #[schemars(range(min = 0, max = 1))]
        reflectance: f64,
    },
    /// Box with its third side along y3.
    Box {
        /// Centre, m.
        #[schemars(inner(range(min = -1000, max = 1000)))]
        centre_m: [f64; 3],
        /// Sides, m, positive.
        #[schemars(extend("items" = { "type": "number", "exclusiveMinimum": 0, "maximum": 1000 }))]
        size_m: [f64; 3],
        /// Rotation about y3, degrees from +y1 towards +y2, −180 to 180.
        #[serde(default)]
        #[schemars(range(min = -180, max = 180))]
        turn_deg: f64,
        /// Lambertian reflectance, 0 to 1.
        #[schemars(range(min = 0, max = 1))]
        reflectance: f64,
    },
    /// Thin panel of cells with transparent gaps between them.
    Panel {
        /// Centre, m.
        #[schemars(inner(range(min = -1000, max = 1000)))]
        centre_m: [f64; 3],
        /// Width and height, m, positive.
        #[schemars(extend("items" = { "type": "number", "exclusiveMinimum": 0, "maximum": 1000 }))]
        size_m: [f64; 2],
        /// Rotation of the width axis about y3, degrees from +y1 towards +y2, −180 to 180.
        #[serde(default)]
        #[schemars(range(min = -180, max = 180))]
        turn_deg: f64,
        /// Tilt about the width axis, degrees, −80 to 80; a positive tilt brings the upper edge forwards.
        #[serde(default)]
        #[schemars(range(min = -80, max = 80))]
        tilt_deg: f64,
        /// Number of cells along width and height, 64 in total at most.
        #[schemars(inner(range(min = 1, max = 64)))]
        cells: [usize; 2],
        /// Gap between cells, m, 0 or more, less than a cell.
        #[schemars(range(min = 0, max = 100))]
        gap_m: f64,
        /// Lambertian reflectance, 0 to 1.
        #[schemars(range(min = 0, max = 1))]
        reflectance: f64,
    },
}

impl Bodies {
    /// Checks every body. Each body must lie entirely between the heights `back_m` and `front_m` above the
    /// disk's plane; `expected` describes this range in the error.
    pub(super) fn check(
        &self,
        table: &str,
        [back_m, front_m]: [f64; 2],
        expected: &'static str,
    ) -> Result<(), OutOfRange> {
        check_source(&format!("{table}.source"), &self.source)?;
        for (i, body) in self.body.iter().enumerate() {
            let path = format!("{table}.body[{i}]");
            body.check(&path)?;
            let [low_m, high_m] = extent(&body.facets());
            if low_m < back_m || high_m > front_m {
                return Err(OutOfRange::new(path, format!("at y3 of {low_m} to {high_m} m"), expected));
            }
        }
        Ok(())
    }

    /// Returns one part per body, sorted back to front by the middle of the body's extent along y3. Bodies
    /// with equal middles keep their order in the file.
    pub(super) fn parts(&self, name: &str, casts_shadow: bool) -> Vec<Part> {
        let mut parts: Vec<(f64, Part)> = self
            .body
            .iter()
            .enumerate()
            .map(|(i, body)| {
                let facets = body.facets();
                let [low_m, high_m] = extent(&facets);
                let name = format!("{name} {i}");
                (
                    low_m + high_m,
                    Part { name, assembly: Assembly::Station, facets, casts_shadow, visible: true },
                )
            })
            .collect();
        parts.sort_by(|(a, _), (b, _)| a.total_cmp(b));
        parts.into_iter().map(|(_, part)| part).collect()
    }
}

impl Body {
    fn check(&self, path: &str) -> Result<(), OutOfRange> {
        match *self {
            Self::Cylinder { from_m, to_m, .. } => {
                let length_m = (vector(to_m) - vector(from_m)).norm();
                require(format!("{path}.to_m"), length_m, "at least 1 mm from from_m", |l| l >= 1e-3)
            }
            Self::Box { .. } => Ok(()),
            Self::Panel { size_m, cells: [across, along], gap_m, .. } => {
                let count = across * along;
                require(format!("{path}.cells"), count as f64, "1 to 64 in total", |_| count <= MAX_CELLS)?;
                let cell_m = (size_m[0] / across as f64).min(size_m[1] / along as f64);
                require(format!("{path}.gap_m"), gap_m, "0 or more, less than a cell", |gap| gap < cell_m)
            }
        }
    }

    fn facets(&self) -> Vec<Facet> {
        match *self {
            Self::Cylinder { from_m, to_m, radius_m, sides, reflectance } => {
                let mut facets = cylinder(vector(from_m), vector(to_m), radius_m, sides, reflectance);
                // A facet that faces the station is never visible, and its shadow equals that of the
                // remaining facets.
                facets.retain(|facet| facet.normal.z > -1.0);
                facets
            }
            Self::Box { centre_m, size_m, turn_deg, reflectance } => {
                block(centre_m, size_m, turn_deg.to_radians(), reflectance)
            }
            Self::Panel { centre_m, size_m, turn_deg, tilt_deg, cells, gap_m, reflectance } => {
                let (sin_turn, cos_turn) = libm::sincos(turn_deg.to_radians());
                let (sin_tilt, cos_tilt) = libm::sincos(tilt_deg.to_radians());
                let width = Vector3::new(cos_turn, sin_turn, 0.0);
                let height = Vector3::new(-sin_turn * cos_tilt, cos_turn * cos_tilt, sin_tilt);
                let at = |x: f64, y: f64| vector(centre_m) + width * x + height * y;
                let spans = |size_m: f64, count: usize| {
                    (0..count).map(move |i| {
                        let cell_m = size_m / count as f64;
                        let low_m = -size_m / 2.0 + cell_m * i as f64;
                        [low_m + gap_m / 2.0, low_m + cell_m - gap_m / 2.0]
                    })
                };
                spans(size_m[1], cells[1])
                    .flat_map(|[bottom, top]| {
                        spans(size_m[0], cells[0]).map(move |[left, right]| [left, right, bottom, top])
                    })
                    .map(|[left, right, bottom, top]| {
                        let corners =
                            vec![at(left, bottom), at(right, bottom), at(right, top), at(left, top)];
                        facet(corners, reflectance)
                    })
                    .collect()
            }
        }
    }
}

/// Smallest and largest y3 of facets, m.
fn extent(facets: &[Facet]) -> [f64; 2] {
    let heights = facets.iter().flat_map(|facet| facet.outer.iter().map(|corner| corner.z));
    heights.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], y3| [low.min(y3), high.max(y3)])
}
