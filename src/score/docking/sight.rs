//! How well the target can be seen from a pose, by geometry alone.

use contract::docking::{DockingSetup, Pose, TargetModel};
use contract::{Camera, Direction};
use nalgebra::{UnitQuaternion, Vector3};
use sim::SimError;
use sim::optics::Projection;

/// How much of the target lies inside the image.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum View {
    /// All of the marks, and all of the cross.
    Whole,
    /// The cross's centre and at least half of the marks.
    Part,
    /// Less than that.
    Outside,
}

/// How the target shows in a field.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sight {
    /// Width of a bar of the cross, px.
    pub bar_width_px: f64,
    /// How much of it lies inside the image.
    pub view: View,
}

impl Sight {
    /// Narrowest bar that is resolved, px: one line of a field is two rows of the camera.
    pub const RESOLVED_BAR_PX: f64 = 2.0;

    /// Whether the cross's bars are wide enough to have two edges.
    pub fn is_resolved(&self) -> bool {
        self.bar_width_px >= Self::RESOLVED_BAR_PX
    }

    /// Resolved and wholly inside the image: what a pipeline should be able to measure.
    pub fn is_clear(&self) -> bool {
        self.is_resolved() && self.view == View::Whole
    }
}

/// The cameras and the target, ready to be seen.
#[derive(Debug, Clone)]
pub struct SightLines {
    lenses: Vec<Lens>,
    target: TargetModel,
}

#[derive(Debug, Clone)]
struct Lens {
    projection: Projection,
    /// Focal length, px, the shorter of both.
    focal_px: f64,
    columns: usize,
    rows: usize,
}

impl Lens {
    fn new(camera: &Camera) -> Result<Self, SimError> {
        let (x, y) = camera.focal_length_px();
        let projection = Projection::new(camera)?;
        Ok(Self { projection, focal_px: x.min(y), columns: camera.columns, rows: camera.rows })
    }
}

impl SightLines {
    /// Of a setup's cameras and target.
    ///
    /// # Errors
    /// [`SimError`] for a camera that is none.
    pub fn new(setup: &DockingSetup) -> Result<Self, SimError> {
        let lenses = setup.cameras.iter().map(Lens::new).collect::<Result<_, _>>()?;
        Ok(Self { lenses, target: setup.target.clone() })
    }

    /// Number of cameras.
    pub fn cameras(&self) -> usize {
        self.lenses.len()
    }

    /// The target's dimensions.
    pub fn target(&self) -> &TargetModel {
        &self.target
    }

    /// Focal length of a camera, px; `None` for a camera that the setup does not have.
    pub fn focal_px(&self, camera: usize) -> Option<f64> {
        self.lenses.get(camera).map(|lens| lens.focal_px)
    }

    /// How the target shows from a pose; `None` for a camera that the setup does not have.
    pub fn sight(&self, camera: usize, pose: &Pose) -> Option<Sight> {
        let lens = self.lenses.get(camera)?;
        let cross = &self.target.cross;
        let sees = |y: Vector3<f64>| lens.sees(pose, y);
        let centre = sees(Vector3::new(0.0, 0.0, cross.height_m));
        let ends = [(1.0, 0.0), (-1.0, 0.0), (0.0, 1.0), (0.0, -1.0)].map(|(x, y)| {
            sees(Vector3::new(x * cross.half_length_m, y * cross.half_length_m, cross.height_m))
        });
        let mark_is_seen = |mark: &[[f64; 2]; 4]| mark.iter().all(|[x, y]| sees(Vector3::new(*x, *y, 0.0)));
        let marks = self.target.marks.iter().filter(|mark| mark_is_seen(mark)).count();
        let view = if marks == self.target.marks.len() && centre && ends.iter().all(|seen| *seen) {
            View::Whole
        } else if centre && 2 * marks >= self.target.marks.len() {
            View::Part
        } else {
            View::Outside
        };
        let distance_m = pose.position_m.z - cross.height_m;
        let bar_width_px = if distance_m > 0.0 { lens.focal_px * cross.width_m / distance_m } else { 0.0 };
        Some(Sight { bar_width_px, view })
    }
}

impl Lens {
    /// Whether a point of the target frame has its image on the detector.
    fn sees(&self, pose: &Pose, y: Vector3<f64>) -> bool {
        let from_camera = y - pose.position_m;
        let ideal = Vector3::new(from_camera.x, -from_camera.y, -from_camera.z);
        let x = UnitQuaternion::from_scaled_axis(pose.phi_rad).inverse() * ideal;
        Direction::from_vector(x)
            .ok()
            .and_then(|direction| self.projection.project(&direction))
            .is_some_and(|point| point.is_on_detector(self.columns, self.rows))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::score::docking::hand_made::{ahead, setup};

    fn sight(camera: usize, pose: &Pose) -> Sight {
        SightLines::new(&setup()).unwrap().sight(camera, pose).unwrap()
    }

    /// The hand-made lenses are 2917 px and 1055 px, 768 × 576: marks reach out to 0.27 m, so that all of them fit
    /// into the half height of 288 px down to 0.27 × 2917/288 = 2.73 m with the narrow lens.
    #[test]
    fn the_marks_leave_the_field_where_the_closed_form_says() {
        assert_eq!(sight(0, &ahead(2.80)).view, View::Whole);
        assert_ne!(sight(0, &ahead(2.70)).view, View::Whole);
        assert_eq!(sight(1, &ahead(1.05)).view, View::Whole);
        assert_ne!(sight(1, &ahead(0.95)).view, View::Whole);
    }

    #[test]
    fn a_target_beside_the_field_or_behind_the_camera_is_outside() {
        let mut aside = ahead(5.0);
        aside.phi_rad.y = 0.5;
        assert_eq!(sight(0, &aside).view, View::Outside);
        let mut away = ahead(5.0);
        away.phi_rad.y = 3.0;
        assert_eq!(sight(0, &away).view, View::Outside);
    }

    /// f w/(d3 − b) = 2917 × 0.03/43.755 = 2 px.
    #[test]
    fn the_target_is_resolved_from_two_pixels_a_bar_on() {
        assert!(!sight(0, &ahead(44.1)).is_resolved());
        assert!(sight(0, &ahead(44.0)).is_resolved());
    }

    #[test]
    fn a_camera_that_is_not_there_sees_nothing() {
        assert_eq!(SightLines::new(&setup()).unwrap().sight(2, &ahead(5.0)), None);
    }
}
