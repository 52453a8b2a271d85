//! The station's end: a disk with a rim, covered with blankets, and the wall of the module behind the disk.

use contract::OutOfRange;
use contract::bounds::require;
use contract::docking::Outline;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::blankets::BlanketsTable;
use super::checks::check_source;
use super::docking_unit::DockingUnitTable;
use super::shapes::{COARSE_SAGITTA_M, Circle, flat, wall};
use super::{Assembly, Part};

/// Number of sides of the wall.
const WALL_SIDES: usize = 48;

/// `[station]`: end face on which docking unit and target stand, a disk parallel to the target's disk.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct StationTable {
    /// Source of the values, or `assumed: why`.
    pub source: String,
    /// Centre (y1, y2), m.
    #[schemars(inner(range(min = -1000, max = 1000)))]
    pub centre_m: [f64; 2],
    /// Radius of the outline, m, at most 100; the docking unit lies inside it.
    #[schemars(extend("exclusiveMinimum" = 0, "maximum" = 100))]
    pub radius_m: f64,
    /// Distance of the face behind the disk's plane, m, more than that of the docking unit's front.
    #[schemars(range(min = -100, max = 100))]
    pub depth_m: f64,
    /// Length of the module's wall behind the face, m, positive.
    #[schemars(extend("exclusiveMinimum" = 0, "maximum" = 1000))]
    pub length_m: f64,
    /// Width of the bare rim of the face, m, positive.
    #[schemars(extend("exclusiveMinimum" = 0, "maximum" = 100))]
    pub rim_m: f64,
    /// Lambertian reflectance of rim and wall, 0 to 1.
    #[schemars(range(min = 0, max = 1))]
    pub rim_reflectance: f64,
    /// Lambertian reflectance of the face inside the rim, visible between the blankets, 0 to 1.
    #[schemars(range(min = 0, max = 1))]
    pub face_reflectance: f64,
    /// Blankets on the face; bare face if absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub blankets: Option<BlanketsTable>,
}

impl StationTable {
    pub(super) fn check(&self, unit: &DockingUnitTable) -> Result<(), OutOfRange> {
        check_source("station.source", &self.source)?;
        let [dy1_m, dy2_m] = [0, 1].map(|axis| unit.axis_m[axis] - self.centre_m[axis]);
        let reach_m = libm::hypot(dy1_m, dy2_m) + unit.outer_radius_m;
        require(
            "station.radius_m",
            self.radius_m,
            "large enough for rim and docking unit, at most 100",
            |r| r - self.rim_m > reach_m,
        )?;
        require("station.depth_m", self.depth_m, "more than docking_unit.depth_m, at most 100", |h| {
            h > unit.depth_m
        })?;
        let face = self.face();
        self.blankets.as_ref().map_or(Ok(()), |blankets| blankets.check(&face, self.depth_m, unit))
    }

    /// Returns wall, face and blankets, back to front. The face has an opening under the docking unit.
    pub(super) fn parts(&self, unit: &DockingUnitTable) -> Vec<Part> {
        let outline = Circle { centre_m: self.centre_m, radius_m: self.radius_m };
        // The opening is smaller than the docking unit's wall, which covers its edge.
        let opening = Circle { centre_m: unit.axis_m, radius_m: unit.inner_radius_m };
        let inside = self.face().polygon_within(COARSE_SAGITTA_M);
        let face = vec![
            flat(&inside, &[&opening.polygon_within(COARSE_SAGITTA_M)], -self.depth_m, self.face_reflectance),
            flat(&outline.polygon_within(COARSE_SAGITTA_M), &[&inside], -self.depth_m, self.rim_reflectance),
        ];
        let wall = wall(&outline.polygon(WALL_SIDES), -self.back_m(), -self.depth_m, self.rim_reflectance);
        let part = |name: &str, facets, casts_shadow| Part {
            name: name.to_owned(),
            assembly: Assembly::Station,
            facets,
            casts_shadow,
            visible: true,
        };
        // For sunlight, wall and face are one closed body and cast its shadow together; the blankets lie on
        // the face.
        let mut parts = vec![part("station wall", wall, true), part("station face", face, true)];
        if let Some(blankets) = &self.blankets {
            parts.push(part("blankets", blankets.facets(&self.face(), self.depth_m, unit), false));
        }
        parts
    }

    /// The part of the face inside the rim.
    fn face(&self) -> Circle {
        Circle { centre_m: self.centre_m, radius_m: self.radius_m - self.rim_m }
    }

    /// Distance of the rear end of the module's wall behind the disk's plane, m.
    pub(super) fn back_m(&self) -> f64 {
        self.depth_m + self.length_m
    }

    pub(super) fn model(&self) -> Outline {
        Outline { centre_m: self.centre_m, radius_m: self.radius_m, depth_m: self.depth_m }
    }
}
