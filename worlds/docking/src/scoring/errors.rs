//! Errors of a measured pose against the true one.

use contract::docking::Pose;
use nalgebra::{UnitQuaternion, Vector3};

use super::approach_parameters::ApproachParameters;

/// Differences of a measured pose from the true one, measured minus true.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PoseErrors {
    /// Error of d, m, target frame.
    pub position_m: Vector3<f64>,
    /// Error of φ by component, rad; a φ longer than π is replaced by the shorter vector of the same
    /// rotation.
    pub phi_rad: Vector3<f64>,
    /// Error of ρ = |d|, m.
    pub range_m: f64,
    /// Error of α, rad.
    pub alpha_rad: f64,
    /// Error of β, rad.
    pub beta_rad: f64,
    /// Length of the error of (d1, d2), m, 0 or more.
    pub lateral_m: f64,
    /// Angle of the rotation from the true to the measured attitude, rad, 0 to π.
    pub attitude_rad: f64,
    /// Angle between the measured and true directions of the target's origin, rad, 0 to π.
    pub direction_rad: f64,
    /// Angle between the measured and true normals of the target's disk in the camera frame, rad, 0 to π.
    pub tilt_rad: f64,
    /// Pose score of SPEED (Kisantal et al. 2020, Eqs. 1 to 4): the sum of ‖Δr‖/‖r‖ of the target's position
    /// in the camera frame and the angle of the rotation, rad.
    pub speed_score: f64,
}

impl PoseErrors {
    /// Computes the errors of a pose; the true pose must not be at the target's origin.
    pub fn new(measured: &Pose, truth: &Pose) -> Self {
        let zero = Vector3::zeros();
        let shown = ApproachParameters::from_motion(measured, &zero)
            .difference(&ApproachParameters::from_motion(truth, &zero));
        let position_m = measured.position_m - truth.position_m;
        let (is, was) = (TargetInCamera::from_pose(measured), TargetInCamera::from_pose(truth));
        let attitude_rad = is.ideal_from_camera.angle_to(&was.ideal_from_camera);
        let r = was.from_origin_m.norm();
        Self {
            position_m,
            phi_rad: phi_error(measured, truth),
            range_m: shown[0],
            alpha_rad: shown[2],
            beta_rad: shown[3],
            lateral_m: position_m.xy().norm(),
            attitude_rad,
            direction_rad: angle(&is.from_origin_m, &was.from_origin_m),
            tilt_rad: angle(&is.normal, &was.normal),
            speed_score: if r > 0.0 { (is.from_origin_m - was.from_origin_m).norm() / r } else { 0.0 }
                + attitude_rad,
        }
    }
}

/// Returns measured minus true φ, rad, with the shortest rotation vector of each.
pub(super) fn phi_error(measured: &Pose, truth: &Pose) -> Vector3<f64> {
    let shortest = |phi: Vector3<f64>| {
        if phi.norm() <= std::f64::consts::PI {
            phi
        } else {
            UnitQuaternion::from_scaled_axis(phi).scaled_axis()
        }
    };
    shortest(measured.phi_rad) - shortest(truth.phi_rad)
}

/// Target relative to the camera at a pose, in the camera frame.
struct TargetInCamera {
    /// Rotation exp(\[φ\]×).
    ideal_from_camera: UnitQuaternion<f64>,
    /// Vector from the target's origin to the camera, m.
    from_origin_m: Vector3<f64>,
    /// Normal of the target's disk.
    normal: Vector3<f64>,
}

impl TargetInCamera {
    fn from_pose(pose: &Pose) -> Self {
        let ideal_from_camera = UnitQuaternion::from_scaled_axis(pose.phi_rad);
        // x = Aᵀ (y − d), A = diag(1, −1, −1) exp([φ]×): Aᵀ d is the vector from y = 0 to the camera, and Aᵀ
        // rotates the direction y3.
        let flip = |v: Vector3<f64>| Vector3::new(v.x, -v.y, -v.z);
        let to_camera = |v: Vector3<f64>| ideal_from_camera.inverse() * flip(v);
        Self { ideal_from_camera, from_origin_m: to_camera(pose.position_m), normal: to_camera(Vector3::z()) }
    }
}

/// Returns the angle between two vectors, rad; accurate also for small angles.
fn angle(a: &Vector3<f64>, b: &Vector3<f64>) -> f64 {
    libm::atan2(a.cross(b).norm(), a.dot(b))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn pose(d: [f64; 3], phi: [f64; 3]) -> Pose {
        Pose { position_m: d.into(), phi_rad: phi.into() }
    }

    #[test]
    fn no_difference_is_no_error() {
        let pose = pose([0.3, -0.2, 7.0], [0.02, 0.03, -0.1]);
        let errors = PoseErrors::new(&pose, &pose);
        assert_eq!((errors.range_m, errors.lateral_m, errors.direction_rad), (0.0, 0.0, 0.0));
        assert!(errors.attitude_rad < 1e-15 && errors.speed_score < 1e-15, "{errors:?}");
    }

    #[test]
    fn a_whole_turn_more_is_the_same_attitude() {
        let truth = pose([0.0, 0.0, 5.0], [0.0, 0.0, 0.2]);
        let errors = PoseErrors::new(&pose([0.0, 0.0, 5.0], [0.0, 0.0, 0.2 + std::f64::consts::TAU]), &truth);
        assert!(errors.phi_rad.norm() < 1e-14 && errors.attitude_rad < 1e-14, "{errors:?}");
    }

    #[test]
    fn a_roll_turns_the_attitude_and_moves_nothing() {
        let errors =
            PoseErrors::new(&pose([0.0, 0.0, 5.0], [0.0, 0.0, 0.2]), &pose([0.0, 0.0, 5.0], [0.0; 3]));
        assert!((errors.attitude_rad - 0.2).abs() < 1e-15, "{errors:?}");
        assert!(errors.direction_rad.abs() < 1e-15 && errors.tilt_rad.abs() < 1e-15, "{errors:?}");
        assert!((errors.speed_score - 0.2).abs() < 1e-15, "{errors:?}");
    }

    /// A pitch φ1 turns the camera about its x axis: the whole image moves by φ1.
    #[test]
    fn a_pitch_moves_the_target_and_tilts_its_disk_by_its_angle() {
        let errors =
            PoseErrors::new(&pose([0.0, 0.0, 5.0], [0.1, 0.0, 0.0]), &pose([0.0, 0.0, 5.0], [0.0; 3]));
        for angle in [errors.attitude_rad, errors.direction_rad, errors.tilt_rad] {
            assert!((angle - 0.1).abs() < 1e-15, "{errors:?}");
        }
        // ‖Δr‖/‖r‖ is the chord of the angle.
        assert!((errors.speed_score - (2.0 * libm::sin(0.05) + 0.1)).abs() < 1e-14, "{errors:?}");
    }

    /// The two poses that an image distinguishes worst: a sideways displacement with a rotation that keeps
    /// the target at the same position in the image.
    #[test]
    fn a_step_aside_with_the_turn_that_hides_it_is_a_tilt_and_no_displacement() {
        let turn = libm::atan2(0.5, 10.0);
        // For a camera at d1 the origin is at x1/x3 = −d1/d3 − φ2: φ2 = −turn moves it back to the centre.
        let errors =
            PoseErrors::new(&pose([0.5, 0.0, 10.0], [0.0, -turn, 0.0]), &pose([0.0, 0.0, 10.0], [0.0; 3]));
        assert!(errors.direction_rad < 1e-15 && (errors.tilt_rad - turn).abs() < 1e-15, "{errors:?}");
        assert_eq!(errors.lateral_m, 0.5);
        assert!((errors.beta_rad - turn).abs() < 1e-15);
    }

    /// Displacement and rotation across rows: for a camera at d2 the origin is at x2/x3 = d2/d3 + φ1.
    #[test]
    fn a_step_up_with_the_turn_that_hides_it_is_a_tilt_and_no_displacement() {
        let turn = libm::atan2(0.5, 10.0);
        let errors =
            PoseErrors::new(&pose([0.0, 0.5, 10.0], [-turn, 0.0, 0.0]), &pose([0.0, 0.0, 10.0], [0.0; 3]));
        assert!(errors.direction_rad < 1e-15 && (errors.tilt_rad - turn).abs() < 1e-15, "{errors:?}");
        assert_eq!(errors.lateral_m, 0.5);
    }
}
