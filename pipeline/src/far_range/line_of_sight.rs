//! Line of sight to the target (section 2.4, Eq. 17).

use contract::{CameraFrame, Direction, Icrs, PixelPoint, Rotation};

use crate::CameraModel;

/// Returns r_J2000 = R_j2000_cam · h⁻¹(c) (Eq. 17, with the product of its two rotations passed as one);
/// `None` where the camera model has no inverse.
///
/// Aberration is not corrected here: the target moves along with the camera, so light time cancels it.
pub(super) fn line_of_sight(
    centre: PixelPoint,
    camera_from_icrs: &Rotation<CameraFrame, Icrs>,
    model: &CameraModel,
) -> Option<Direction<Icrs>> {
    Some(camera_from_icrs.inverse() * model.back_project(centre)?)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::camera_model::tests::argon;
    use nalgebra::Vector3;

    #[test]
    fn the_principal_point_looks_along_the_boresight() {
        // Boresight along the y axis of ICRS, columns along z.
        let camera_from_icrs = Rotation::from_axes(&Vector3::z(), &Vector3::x(), &Vector3::y());
        let los = line_of_sight(PixelPoint::new(395.0, 288.0), &camera_from_icrs, &argon()).unwrap();
        assert!((los.vector() - Vector3::y()).norm() < 1e-15);
        // To the right of the principal point, the line of sight turns towards z.
        let right = line_of_sight(PixelPoint::new(495.0, 288.0), &camera_from_icrs, &argon()).unwrap();
        assert!(right.vector().z > 0.04 && right.vector().x.abs() < 1e-15);
    }
}
