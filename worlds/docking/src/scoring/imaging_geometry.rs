//! Size of the target in the image, from geometry only.

use contract::docking::{DockingSetup, Pose, TargetModel};

/// Dimensions of the target and focal lengths of the cameras, which determine the details that an image
/// resolves.
#[derive(Debug, Clone)]
pub(super) struct ImagingGeometry {
    /// Focal length of each camera, px: the shorter of the two axes.
    focal_px: Vec<f64>,
    target: TargetModel,
}

impl ImagingGeometry {
    /// Narrowest resolved bar of the cross, px: one line of a field spans two rows of the camera.
    pub(super) const RESOLVED_BAR_PX: f64 = 2.0;

    pub(super) fn new(setup: &DockingSetup) -> Self {
        let shorter = |(x, y): (f64, f64)| x.min(y);
        let focal_px = setup.cameras.iter().map(|camera| shorter(camera.focal_length_px())).collect();
        Self { focal_px, target: setup.target.clone() }
    }

    /// Returns the dimensions of the target.
    pub(super) fn target(&self) -> &TargetModel {
        &self.target
    }

    /// Returns the focal length of a camera, px; `None` for a camera that the setup does not have.
    pub(super) fn focal_px(&self, camera: usize) -> Option<f64> {
        self.focal_px.get(camera).copied()
    }

    /// Returns true if the bars of the cross are wide enough in the image to have two edges.
    pub(super) fn resolves(&self, camera: usize, pose: &Pose) -> bool {
        let cross = &self.target.cross;
        let distance_m = pose.position_m.z - cross.height_m;
        distance_m > 0.0
            && self
                .focal_px(camera)
                .is_some_and(|focal_px| focal_px * cross.width_m >= Self::RESOLVED_BAR_PX * distance_m)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scoring::hand_made::{ahead, setup};

    /// f w/(d3 − b) = 2917 × 0.03/43.755 = 2 px with the narrow lens, 1055 × 0.03/15.825 with the wide one.
    #[test]
    fn the_target_is_resolved_from_two_pixels_a_bar_on() {
        let geometry = ImagingGeometry::new(&setup());
        assert!(!geometry.resolves(0, &ahead(44.1)) && geometry.resolves(0, &ahead(44.0)));
        assert!(!geometry.resolves(1, &ahead(16.2)) && geometry.resolves(1, &ahead(16.1)));
        assert!(!geometry.resolves(2, &ahead(5.0)), "a camera that is not there");
        // The cross is 0.3 m in front of the disk: from this distance or nearer, no bar is visible.
        assert!(geometry.resolves(0, &ahead(0.31)) && !geometry.resolves(0, &ahead(0.3)));
    }
}
