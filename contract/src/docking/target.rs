//! Dimensions of the target, in the target frame, as known to a pipeline.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::OutOfRange;
use crate::bounds::{self, require};

/// Stand-off cross: two perpendicular bars along y1 and y2, with the front face at y3 = height.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct StandOffCross {
    /// Height b of the front face above the disk's plane, m.
    #[schemars(extend("exclusiveMinimum" = 0, "maximum" = 1000))]
    pub height_m: f64,
    /// Distance from the centre to the end of a bar, m.
    #[schemars(extend("exclusiveMinimum" = 0, "maximum" = 1000))]
    pub half_length_m: f64,
    /// Width of a bar, m.
    #[schemars(extend("exclusiveMinimum" = 0, "maximum" = 100))]
    pub width_m: f64,
    /// Thickness of a bar, along y3, m.
    #[schemars(extend("exclusiveMinimum" = 0, "maximum" = 100))]
    pub thickness_m: f64,
    /// Width of the post that carries the bars, seen from any side, m.
    #[schemars(extend("exclusiveMinimum" = 0, "maximum" = 100))]
    pub post_width_m: f64,
}

/// A circular outline parallel to the disk.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Outline {
    /// Centre (y1, y2), m.
    #[schemars(inner(range(min = -1000, max = 1000)))]
    pub centre_m: [f64; 2],
    /// Radius, m.
    #[schemars(extend("exclusiveMinimum" = 0, "maximum" = 1000))]
    pub radius_m: f64,
    /// Distance h of the outline behind the disk's plane, m.
    #[schemars(range(min = -1000, max = 1000))]
    pub depth_m: f64,
}

/// Dimensions of the target, as a pipeline receives them.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct TargetModel {
    /// Name of the target.
    pub name: String,
    /// Radius of the dark plate behind the marks, m.
    #[schemars(extend("exclusiveMinimum" = 0, "maximum" = 1000))]
    pub plate_radius_m: f64,
    /// Radius r of the circle through the centres of the marks, m.
    #[schemars(extend("exclusiveMinimum" = 0, "maximum" = 1000))]
    pub mark_circle_radius_m: f64,
    /// Bright marks in the disk's plane (y3 = 0): corners (y1, y2), m, counter-clockwise as seen from the
    /// front.
    #[schemars(inner(inner(inner(range(min = -1000, max = 1000)))))]
    pub marks: Vec<[[f64; 2]; 4]>,
    /// Stand-off cross.
    pub cross: StandOffCross,
    /// Disk of the docking unit.
    pub docking_unit: Outline,
    /// Outline of the station's end, visible before the target is resolved.
    pub station: Outline,
}

impl TargetModel {
    /// Checks the range of every number. No dimension or distance of a target exceeds 1000 m; a larger value
    /// indicates a wrong unit.
    ///
    /// # Errors
    /// [`OutOfRange`] for the first field outside its range.
    pub fn check(&self) -> Result<(), OutOfRange> {
        bounds::check(self, "target")?;
        let StandOffCross { height_m, half_length_m, width_m, thickness_m, post_width_m } = self.cross;
        require("target.cross.width_m", width_m, "greater than 0, less than half_length_m", |v| {
            v < half_length_m
        })?;
        require("target.cross.thickness_m", thickness_m, "greater than 0, less than height_m", |v| {
            v < height_m
        })?;
        require("target.cross.post_width_m", post_width_m, "greater than 0, at most width_m", |v| {
            v <= width_m
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn target() -> TargetModel {
        TargetModel {
            name: "progress".to_owned(),
            plate_radius_m: 0.3,
            mark_circle_radius_m: 0.25,
            marks: vec![[[0.24, -0.01], [0.26, -0.01], [0.26, 0.01], [0.24, 0.01]]],
            cross: StandOffCross {
                height_m: 0.3,
                half_length_m: 0.15,
                width_m: 0.03,
                thickness_m: 0.01,
                post_width_m: 0.02,
            },
            docking_unit: Outline { centre_m: [0.0, 0.9], radius_m: 0.6, depth_m: -0.1 },
            station: Outline { centre_m: [0.0, 0.9], radius_m: 2.0, depth_m: 0.5 },
        }
    }

    #[test]
    fn each_number_outside_its_range_is_named() {
        target().check().unwrap();
        let refused = |field: &str, change: fn(&mut TargetModel)| {
            let mut wrong = target();
            change(&mut wrong);
            assert_eq!(wrong.check().unwrap_err().path, field);
        };
        refused("target.plate_radius_m", |t| t.plate_radius_m = 0.0);
        refused("target.mark_circle_radius_m", |t| t.mark_circle_radius_m = 1e300);
        refused("target.marks[0][2][1]", |t| t.marks[0][2][1] = f64::NAN);
        refused("target.cross.height_m", |t| t.cross.height_m = -0.3);
        refused("target.cross.half_length_m", |t| t.cross.half_length_m = f64::INFINITY);
        refused("target.cross.width_m", |t| t.cross.width_m = 0.15);
        refused("target.cross.thickness_m", |t| t.cross.thickness_m = 0.0);
        refused("target.cross.thickness_m", |t| t.cross.thickness_m = 0.3);
        refused("target.cross.post_width_m", |t| t.cross.post_width_m = 0.031);
        refused("target.docking_unit.radius_m", |t| t.docking_unit.radius_m = 0.0);
        refused("target.docking_unit.centre_m[1]", |t| t.docking_unit.centre_m[1] = 1001.0);
        refused("target.docking_unit.depth_m", |t| t.docking_unit.depth_m = f64::NAN);
        refused("target.station.radius_m", |t| t.station.radius_m = -2.0);
        refused("target.station.centre_m[0]", |t| t.station.centre_m[0] = f64::NEG_INFINITY);
        refused("target.station.depth_m", |t| t.station.depth_m = 1e9);
    }

    /// A target may have no marks; each pipeline decides whether it works without them.
    #[test]
    fn a_target_without_marks_is_valid() {
        TargetModel { marks: Vec::new(), ..target() }.check().unwrap();
    }
}
