//! Region of interest: given by the user, or predicted from previous fields.

use contract::bounds::require;
use contract::{OutOfRange, PixelPoint};
use nalgebra::{Vector2, Vector3};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use contract::docking::{Pose, TargetModel};

use super::view::Lens;
use crate::docking::cross_and_circle::cross::CrossSeed;
use crate::docking::cross_and_circle::marks::Plane;
use crate::docking::pose::geometry::project;

/// Rectangle of the camera's pixels, borders included.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Rectangle {
    /// First column, px.
    #[schemars(range(min = -1e5, max = 1e5))]
    pub first_column: f64,
    /// First row, px.
    #[schemars(range(min = -1e5, max = 1e5))]
    pub first_row: f64,
    /// Last column, px, not before the first.
    #[schemars(range(min = -1e5, max = 1e5))]
    pub last_column: f64,
    /// Last row, px, not before the first.
    #[schemars(range(min = -1e5, max = 1e5))]
    pub last_row: f64,
}

impl Rectangle {
    /// Rectangle that contains every pixel.
    pub(crate) const ALL: Self = Self {
        first_column: f64::NEG_INFINITY,
        first_row: f64::NEG_INFINITY,
        last_column: f64::INFINITY,
        last_row: f64::INFINITY,
    };

    /// Returns the square around a point.
    pub(crate) fn square(centre: PixelPoint, half_side: f64) -> Self {
        Self {
            first_column: centre.x - half_side,
            first_row: centre.y - half_side,
            last_column: centre.x + half_side,
            last_row: centre.y + half_side,
        }
    }

    pub(crate) fn contains(&self, point: PixelPoint) -> bool {
        (self.first_column..=self.last_column).contains(&point.x)
            && (self.first_row..=self.last_row).contains(&point.y)
    }
}

/// Region in which the target is searched for.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct RegionConfig {
    /// Window that must contain the centre of the cross, camera pixels; without one, the whole field.
    pub window: Option<Rectangle>,
    /// Longest time between two fields over which the target's position is predicted, s, above 0 to 60.
    #[schemars(extend("exclusiveMinimum" = 0, "maximum" = 60))]
    pub max_gap_s: f64,
}

impl Default for RegionConfig {
    fn default() -> Self {
        Self { window: None, max_gap_s: 0.5 }
    }
}

impl RegionConfig {
    pub(crate) fn check(&self) -> Result<(), OutOfRange> {
        let Some(Rectangle { first_column, first_row, last_column, last_row }) = self.window else {
            return Ok(());
        };
        let (column, row) = ("not before the first column", "not before the first row");
        require("region.window.last_column", last_column, column, |v| v >= first_column)?;
        require("region.window.last_row", last_row, row, |v| v >= first_row)
    }
}

/// Cross and marks in a field, ideal image.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct FeaturePositions {
    pub(crate) time_s: f64,
    pub(crate) camera: usize,
    pub(crate) focal_px: f64,
    pub(crate) cross: CrossSeed,
    pub(crate) plane: Plane,
    pub(crate) pose: Pose,
}

impl FeaturePositions {
    /// Returns the cross and marks predicted from a pose, or `None` if the pose does not project them into
    /// the image.
    pub(crate) fn from_pose(
        time_s: f64,
        camera: usize,
        lens: &Lens,
        target: &TargetModel,
        pose: Pose,
    ) -> Option<Self> {
        let (height, half, r) =
            (target.cross.height_m, target.cross.half_length_m, target.mark_circle_radius_m);
        let see =
            |x: f64, y: f64, z: f64| lens.to_ideal(project(lens.model(), &pose, &Vector3::new(x, y, z))?);
        // Symmetric differences, in which perspective along the bar cancels.
        let bar = see(0.3 * half, 0.0, height)? - see(-0.3 * half, 0.0, height)?;
        let disk = see(0.3 * r, 0.0, 0.0)? - see(-0.3 * r, 0.0, 0.0)?;
        let upwards = see(0.0, 0.3 * r, 0.0)? - see(0.0, -0.3 * r, 0.0)?;
        Some(Self {
            time_s,
            camera,
            focal_px: lens.focal_px(),
            cross: CrossSeed {
                centre: see(0.0, 0.0, height)?,
                half_length_px: bar.norm() / 0.6,
                slope: bar.y / bar.x,
            },
            plane: Plane {
                centre: see(0.0, 0.0, 0.0)?,
                scale_px_m: (disk.norm() + upwards.norm()) / (1.2 * r),
                roll_rad: libm::atan2(disk.y, disk.x),
            },
            pose,
        })
    }
}

/// Prediction of the next field from previous fields.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Prediction {
    pub(crate) cross: CrossSeed,
    pub(crate) plane: Plane,
    pub(crate) pose: Pose,
}

/// Recent sightings of the target.
#[derive(Debug, Clone, Default)]
pub(crate) struct Track {
    last: Option<FeaturePositions>,
    before: Option<FeaturePositions>,
}

impl Track {
    /// Removes all sightings.
    pub(crate) fn reset(&mut self) {
        *self = Self::default();
    }

    /// Returns the last sighting.
    pub(crate) fn last(&self) -> Option<&FeaturePositions> {
        self.last.as_ref()
    }

    /// Adds a new sighting.
    pub(crate) fn push(&mut self, sighting: FeaturePositions) {
        let same_lens = self.last.is_some_and(|last| last.camera == sighting.camera);
        self.before = self.last.filter(|last| same_lens && last.time_s < sighting.time_s);
        self.last = Some(sighting);
    }

    /// Predicts cross, plane and pose at a given time, by constant velocity from the last two sightings, or
    /// constant from the last one. Another lens on the same axis has the same ideal image at another scale.
    pub(crate) fn predict(
        &self,
        time_s: f64,
        camera: usize,
        focal_px: f64,
        max_gap_s: f64,
    ) -> Option<Prediction> {
        let last = self.last.as_ref()?;
        let ahead = time_s - last.time_s;
        if !(ahead > 0.0 && ahead <= max_gap_s) {
            return None;
        }
        let zoom = if last.camera == camera { 1.0 } else { focal_px / last.focal_px };
        let share = match &self.before {
            Some(before) if last.time_s - before.time_s <= max_gap_s => ahead / (last.time_s - before.time_s),
            _ => 0.0,
        };
        // Extrapolation over a hundred fields would not be a prediction.
        let share = if share <= 8.0 { share } else { 0.0 };
        let before = self.before.as_ref().unwrap_or(last);
        let number = |a: f64, b: f64| a + share * (a - b);
        let extrapolate = |a: Vector2<f64>, b: Vector2<f64>| (a + share * (a - b)) * zoom;
        let half_length_px = zoom * number(last.cross.half_length_px, before.cross.half_length_px);
        let scale = zoom * number(last.plane.scale_px_m, before.plane.scale_px_m);
        if !(half_length_px > 0.0 && scale > 0.0) {
            return None;
        }
        let pose = Pose {
            position_m: last.pose.position_m + share * (last.pose.position_m - before.pose.position_m),
            phi_rad: last.pose.phi_rad + share * (last.pose.phi_rad - before.pose.phi_rad),
        };
        Some(Prediction {
            cross: CrossSeed {
                centre: extrapolate(last.cross.centre, before.cross.centre),
                half_length_px,
                slope: last.cross.slope,
            },
            plane: Plane {
                centre: extrapolate(last.plane.centre, before.plane.centre),
                scale_px_m: scale,
                roll_rad: last.plane.roll_rad,
            },
            pose,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sighting(time_s: f64, camera: usize, focal_px: f64, x: f64, half_length_px: f64) -> FeaturePositions {
        FeaturePositions {
            time_s,
            camera,
            focal_px,
            cross: CrossSeed { centre: Vector2::new(x, 5.0), half_length_px, slope: 0.1 },
            plane: Plane { centre: Vector2::new(x, 6.0), scale_px_m: 4.0 * half_length_px, roll_rad: 0.1 },
            pose: Pose { position_m: Vector3::new(0.01 * x, 0.0, 5.0), phi_rad: Vector3::zeros() },
        }
    }

    #[test]
    fn a_constant_velocity_is_predicted() {
        let mut track = Track::default();
        track.push(sighting(1.00, 0, 1000.0, 10.0, 20.0));
        track.push(sighting(1.02, 0, 1000.0, 11.0, 20.5));
        let Prediction { cross, plane, pose } = track.predict(1.04, 0, 1000.0, 0.5).unwrap();
        assert!((pose.position_m.x - 0.12).abs() < 1e-12);
        assert!((cross.centre.x - 12.0).abs() < 1e-9 && (cross.half_length_px - 21.0).abs() < 1e-9);
        assert!((plane.scale_px_m - 84.0).abs() < 1e-9);
    }

    #[test]
    fn a_change_of_lens_scales_the_image() {
        let mut track = Track::default();
        track.push(sighting(1.0, 1, 3000.0, 30.0, 60.0));
        let Prediction { cross, .. } = track.predict(1.02, 0, 1000.0, 0.5).unwrap();
        assert!((cross.centre.x - 10.0).abs() < 1e-9 && (cross.half_length_px - 20.0).abs() < 1e-9);
    }

    #[test]
    fn nothing_is_predicted_after_a_gap_or_backwards() {
        let mut track = Track::default();
        track.push(sighting(1.0, 0, 1000.0, 10.0, 20.0));
        assert!(track.predict(1.0, 0, 1000.0, 0.5).is_none());
        assert!(track.predict(1.6, 0, 1000.0, 0.5).is_none());
        assert!(track.predict(f64::NAN, 0, 1000.0, 0.5).is_none());
    }
}
