//! How large the target is in the image, by geometry alone.

use contract::docking::{DockingSetup, Pose, TargetModel};

/// The cameras and the target, as far as they decide what an image can show.
#[derive(Debug, Clone)]
pub(super) struct ImagingGeometry {
    /// Focal length of each camera, px, the shorter of both.
    focal_px: Vec<f64>,
    target: TargetModel,
}

impl ImagingGeometry {
    /// Narrowest bar of the cross that is resolved, px: one line of a field is two rows of the camera.
    pub(super) const RESOLVED_BAR_PX: f64 = 2.0;

    pub(super) fn new(setup: &DockingSetup) -> Self {
        let shorter = |(x, y): (f64, f64)| x.min(y);
        let focal_px = setup.cameras.iter().map(|camera| shorter(camera.focal_length_px())).collect();
        Self { focal_px, target: setup.target.clone() }
    }

    /// The target's dimensions.
    pub(super) fn target(&self) -> &TargetModel {
        &self.target
    }

    /// Focal length of a camera, px; `None` for a camera that the setup does not have.
    pub(super) fn focal_px(&self, camera: usize) -> Option<f64> {
        self.focal_px.get(camera).copied()
    }

    /// Whether the cross's bars are wide enough in the image to have two edges.
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
    use crate::docking::hand_made::{ahead, setup};

    /// f w/(d3 − b) = 2917 × 0.03/43.755 = 2 px with the narrow lens, 1055 × 0.03/15.825 with the wide one.
    #[test]
    fn the_target_is_resolved_from_two_pixels_a_bar_on() {
        let geometry = ImagingGeometry::new(&setup());
        assert!(!geometry.resolves(0, &ahead(44.1)) && geometry.resolves(0, &ahead(44.0)));
        assert!(!geometry.resolves(1, &ahead(16.2)) && geometry.resolves(1, &ahead(16.1)));
        assert!(!geometry.resolves(2, &ahead(5.0)), "a camera that is not there");
        // The cross stands out 0.3 m: who is at it or behind it sees no bar.
        assert!(geometry.resolves(0, &ahead(0.31)) && !geometry.resolves(0, &ahead(0.3)));
    }
}
