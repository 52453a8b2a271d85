//! What a pipeline knows of the target: dimensions, in the target frame.

use serde::{Deserialize, Serialize};

/// The stand-off cross: two perpendicular bars along y1 and y2, their front face at y3 = height.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct StandOffCross {
    /// b: height of the front face over the disk's plane, m.
    pub height_m: f64,
    /// From the centre to the end of a bar, m.
    pub half_length_m: f64,
    /// Width of a bar, m.
    pub width_m: f64,
    /// Thickness of a bar, along y3, m.
    pub thickness_m: f64,
}

/// A circular outline parallel to the disk.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Outline {
    /// Centre (y1, y2), m.
    pub centre_m: [f64; 2],
    /// Radius, m.
    pub radius_m: f64,
    /// h: how far it lies behind the disk's plane, m.
    pub depth_m: f64,
}

/// The target's dimensions as a pipeline is told them.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct TargetModel {
    /// Name of the target.
    pub name: String,
    /// Radius of the dark plate behind the marks, m.
    pub plate_radius_m: f64,
    /// r: radius of the circle through the centres of the marks, m.
    pub mark_circle_radius_m: f64,
    /// Bright marks in the disk's plane (y3 = 0): corners (y1, y2) in m, counter-clockwise seen from the front.
    pub marks: Vec<[[f64; 2]; 4]>,
    /// The cross that stands off.
    pub cross: StandOffCross,
    /// The docking unit's disk.
    pub docking_unit: Outline,
    /// The outline of the station's end, what is seen before the target is resolved.
    pub station: Outline,
}
