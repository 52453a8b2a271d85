//! The target as the camera sees it at the middle of a frame: the source of labels.

use contract::docking::Lines;
use contract::{CameraFrame, OutOfRange, PixelPoint, Rotation, Target};
use nalgebra::Vector3;
use render::vector::{MaskPainter, RowSpans};
use truth::SimError;

use crate::Simulator;
use crate::scene_state::SceneState;

/// The target at the middle of a frame's exposure, without motion during it.
#[derive(Debug, Clone, PartialEq)]
pub struct TargetView {
    /// Origin of the target's body frame in the camera frame, m.
    pub position_m: Vector3<f64>,
    /// Attitude; `None` for a target without orientation.
    pub camera_from_target: Option<Rotation<CameraFrame, Target>>,
    /// Image of the origin of the body frame; `None` behind the camera or far outside the picture.
    pub origin: Option<PixelPoint>,
    /// Pixels whose centres the target covers, lit or not, also beyond the picture.
    pub silhouette: RowSpans,
    /// Images of the target's named points, in their order.
    pub points: Vec<PointImage>,
}

/// Image of a point of the target; px of the camera, also for a field of interlaced television.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PointImage {
    /// Position, px; `None` behind the camera or far outside the picture.
    pub position: Option<PixelPoint>,
    /// True if an object lies between the camera and the point.
    pub is_hidden: bool,
}

impl Simulator {
    /// Returns the target as it appears in a frame.
    ///
    /// # Errors
    /// [`SimError::OutOfRange`] if the schedule has no such frame.
    pub fn target_view(&self, number: u64, painter: &mut MaskPainter) -> Result<TargetView, SimError> {
        let frame = self.schedule.frame(number);
        let (_, time) = frame.ok_or_else(|| OutOfRange::new("frame", number, "a frame of the schedule"))?;
        let state = SceneState::compute_at(self, time, number)?;
        let line_of_sight_m = state.states.line_of_sight_km() * 1000.0;
        let turn = state.target_from_icrs.unwrap_or_else(Rotation::identity);
        let camera_from_target = state.camera_from_icrs * turn.inverse();
        let position_m = state.camera_from_icrs.rotate(&line_of_sight_m);
        let eye_m = turn.rotate(&-line_of_sight_m);
        for polygon in self.target.silhouette_polygons(&eye_m) {
            let in_camera = |corner: &Vector3<f64>| camera_from_target.rotate(corner) + position_m;
            painter.add(&polygon.iter().map(in_camera).collect::<Vec<_>>(), &[]);
        }
        let image = |point_m: &Vector3<f64>| PointImage {
            position: state.project(point_m, &self.projection),
            is_hidden: self.target.hides_point(point_m, &eye_m),
        };
        Ok(TargetView {
            position_m,
            camera_from_target: state.target_from_icrs.map(|_| camera_from_target),
            origin: state.target_position,
            silhouette: painter.finish(),
            points: self.target.named_points().iter().map(|point| image(&point.position_m)).collect(),
        })
    }

    /// Returns a painter of masks in the images of a camera.
    ///
    /// # Errors
    /// [`SimError`] if the camera's data are invalid.
    pub fn mask_painter(camera: &contract::Camera) -> Result<MaskPainter, SimError> {
        MaskPainter::new(camera, Lines::All)
    }
}
