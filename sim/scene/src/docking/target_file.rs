//! Docking target as data: the tables of a target file, and their conversion to a scene and to a pipeline's
//! model.

#![cfg_attr(
    not(test),
    deny(
        clippy::indexing_slicing,
        clippy::string_slice,
        clippy::expect_used,
        clippy::panic,
        clippy::unreachable
    )
)]

use contract::OutOfRange;
use contract::bounds::{self, require};
use contract::docking::TargetModel;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::DockingScene;
use super::body::Bodies;
use super::checks::check_source;
use super::cross::CrossTable;
use super::docking_unit::DockingUnitTable;
use super::plate::{MarksTable, PlateTable};
use super::station::StationTable;

/// Target file: dimensions in metres in the target frame (origin at the disk's centre, y3 along its normal
/// away from the station, y2 up). Every table states the source of its values.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct TargetFile {
    /// Name of the target, not empty.
    pub name: String,
    /// Geometry at contact.
    pub contact: ContactTable,
    /// The dark disk.
    pub plate: PlateTable,
    /// Bright marks on the disk; none if absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub marks: Option<MarksTable>,
    /// The stand-off cross.
    pub cross: CrossTable,
    /// The docking unit.
    pub docking_unit: DockingUnitTable,
    /// The station's end.
    pub station: StationTable,
    /// Rails, antennas and boxes on the station's end, between its face and the disk's plane.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub fittings: Option<Bodies>,
    /// Modules, trusses and panels behind the wall of the station's end; they cast no shadows.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub structure: Option<Bodies>,
}

/// `[contact]`: position of the camera when the docking units touch.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ContactTable {
    /// Source of the value, or `assumed: why`.
    pub source: String,
    /// Distance of the camera from the disk's plane at contact, m, more than the height of the cross, at most
    /// 100.
    #[schemars(extend("exclusiveMinimum" = 0, "maximum" = 100))]
    pub camera_to_disk_m: f64,
}

impl TargetFile {
    /// Checks every number.
    ///
    /// # Errors
    /// [`OutOfRange`] for the first number outside its range, with its path.
    pub fn check(&self) -> Result<(), OutOfRange> {
        if self.name.trim().is_empty() {
            return Err(OutOfRange::new("name", "empty", "a name"));
        }
        bounds::check(self, "")?;
        self.plate.check()?;
        if let Some(marks) = &self.marks {
            marks.check(&self.plate)?;
        }
        self.cross.check()?;
        check_source("contact.source", &self.contact.source)?;
        require(
            "contact.camera_to_disk_m",
            self.contact.camera_to_disk_m,
            "more than cross.height_m, at most 100",
            |d| d > self.cross.height_m,
        )?;
        self.docking_unit.check()?;
        self.station.check(&self.docking_unit)?;
        if let Some(fittings) = &self.fittings {
            let between = [-self.station.depth_m, 0.0];
            fittings.check("fittings", between, "between the station's face and the disk's plane")?;
        }
        if let Some(structure) = &self.structure {
            let behind = [f64::NEG_INFINITY, -self.station.back_m()];
            structure.check("structure", behind, "behind the station's wall (station.depth_m + length_m)")?;
        }
        Ok(())
    }

    /// Returns the scene of a checked file. The back-to-front order of the parts holds for cameras in front
    /// of the target and up to 17° off its axis, provided that bodies whose extents along y3 overlap are
    /// separated (see [`Bodies`]).
    pub fn scene(&self) -> DockingScene {
        let mut parts = Vec::new();
        if let Some(structure) = &self.structure {
            parts.extend(structure.parts("structure", false));
        }
        parts.extend(self.station.parts(&self.docking_unit));
        if let Some(fittings) = &self.fittings {
            parts.extend(fittings.parts("fitting", true));
        }
        parts.extend(self.docking_unit.parts(self.station.depth_m));
        parts.push(self.plate.part(self.marks.as_ref()));
        parts.extend(self.cross.parts());
        DockingScene { parts }
    }

    /// Returns the model of the target that a pipeline receives.
    pub fn model(&self) -> TargetModel {
        TargetModel {
            name: self.name.clone(),
            plate_radius_m: self.plate.radius_m,
            // Without marks, the only circle on the disk is its edge.
            mark_circle_radius_m: self
                .marks
                .as_ref()
                .map_or(self.plate.radius_m, MarksTable::circle_radius_m),
            marks: self.marks.as_ref().map(MarksTable::quads).unwrap_or_default(),
            cross: self.cross.model(),
            docking_unit: self.docking_unit.model(),
            station: self.station.model(),
        }
    }
}
