//! Exact geometry of the pipeline: poses, projection, and their derivatives (docking paper, 3.1, without its
//! small-angle approximation).

use contract::PixelPoint;
use contract::docking::Pose;
use nalgebra::{Matrix3, SMatrix, SVector, Vector3, Vector6};

use crate::CameraModel;

/// Derivatives of an image point with respect to (d1, d2, d3, φ1, φ2, φ3).
pub(crate) type ByPose = SMatrix<f64, 2, 6>;

/// Angle below which the series of exp replaces sin and cos, rad: the neglected terms are under 1e-16.
const SMALL_RAD: f64 = 1e-4;

/// Returns \[v\]×, the matrix of the cross product: \[v\]× w = v × w.
pub fn cross_matrix(v: &Vector3<f64>) -> Matrix3<f64> {
    Matrix3::new(0.0, -v.z, v.y, v.z, 0.0, -v.x, -v.y, v.x, 0.0)
}

/// Returns exp(\[φ\]×), the rotation about φ by its length (Rodrigues).
pub fn exponential(phi_rad: &Vector3<f64>) -> Matrix3<f64> {
    let angle = phi_rad.norm();
    let k = cross_matrix(phi_rad);
    let (sine, cosine) = if angle < SMALL_RAD {
        let a2 = angle * angle;
        (1.0 - a2 / 6.0, 0.5 - a2 / 24.0)
    } else {
        let half = libm::sin(0.5 * angle) / angle;
        (libm::sin(angle) / angle, 2.0 * half * half)
    };
    Matrix3::identity() + k * sine + k * k * cosine
}

/// Returns the right Jacobian of exp: exp([φ + δ]×) = exp(\[φ\]×) exp([J δ]×) to first order in δ.
fn right_jacobian(phi_rad: &Vector3<f64>) -> Matrix3<f64> {
    let angle = phi_rad.norm();
    let k = cross_matrix(phi_rad);
    let (first, second) = if angle < SMALL_RAD {
        (0.5, 1.0 / 6.0)
    } else {
        let half = libm::sin(0.5 * angle) / angle;
        (2.0 * half * half, (angle - libm::sin(angle)) / (angle * angle * angle))
    };
    Matrix3::identity() - k * first + k * k * second
}

/// Returns A = diag(1, −1, −1) exp(\[φ\]×), the camera axes in the target frame: y = d + A x. Equal to the
/// paper's matrix to first order.
pub fn target_from_camera(phi_rad: &Vector3<f64>) -> Matrix3<f64> {
    Matrix3::from_diagonal(&Vector3::new(1.0, -1.0, -1.0)) * exponential(phi_rad)
}

/// Returns the rotation vector φ of a matrix A: the inverse of [`target_from_camera`], for angles under 180°.
pub fn phi_from_rotation(target_from_camera: &Matrix3<f64>) -> Vector3<f64> {
    let r = Matrix3::from_diagonal(&Vector3::new(1.0, -1.0, -1.0)) * target_from_camera;
    let twice_sine = Vector3::new(r[(2, 1)] - r[(1, 2)], r[(0, 2)] - r[(2, 0)], r[(1, 0)] - r[(0, 1)]);
    let sine = 0.5 * twice_sine.norm();
    let angle = libm::atan2(sine, 0.5 * (r.trace() - 1.0));
    if angle < SMALL_RAD { twice_sine * 0.5 } else { twice_sine * (0.5 * angle / sine) }
}

/// Returns the pixel position of a point of the target, on the detector or beside it, for a camera at a pose.
/// `point_m` is in the target frame. Returns `None` behind the camera or beyond the fold of the distortion.
pub fn project(camera: &CameraModel, pose: &Pose, point_m: &Vector3<f64>) -> Option<PixelPoint> {
    camera.project_vector(&PoseProjection::new(camera, pose).to_camera(point_m))
}

/// Camera at a pose: the quantities shared by the projections of many points.
#[derive(Debug, Clone)]
pub(crate) struct PoseProjection {
    position_m: Vector3<f64>,
    camera_from_target: Matrix3<f64>,
    jacobian: Matrix3<f64>,
    focal_px: (f64, f64),
}

/// Point of the target in the image without distortion, relative to the principal point.
#[derive(Debug, Clone, Copy)]
pub(crate) struct ProjectedPoint {
    pub(crate) u: f64,
    pub(crate) v: f64,
    pub(crate) by_pose: ByPose,
}

impl PoseProjection {
    pub(crate) fn new(camera: &CameraModel, pose: &Pose) -> Self {
        Self {
            position_m: pose.position_m,
            camera_from_target: target_from_camera(&pose.phi_rad).transpose(),
            jacobian: right_jacobian(&pose.phi_rad),
            focal_px: camera.focal_px(),
        }
    }

    /// Returns x = Aᵀ (y − d), the point in the camera frame.
    pub(crate) fn to_camera(&self, point_m: &Vector3<f64>) -> Vector3<f64> {
        self.camera_from_target * (point_m - self.position_m)
    }

    /// Returns the image of a point of the target, with derivatives; `None` behind the camera.
    ///
    /// ∂x/∂d = −Aᵀ; with φ + δ, A becomes A exp([J δ]×), so ∂x/∂φ = [x]× J.
    pub(crate) fn project_with_derivatives(&self, point_m: &Vector3<f64>) -> Option<ProjectedPoint> {
        let x = self.to_camera(point_m);
        if x.z.is_nan() || x.z <= 1e-6 * x.norm() {
            return None;
        }
        let by_phi = cross_matrix(&x) * self.jacobian;
        let (fx, fy) = self.focal_px;
        let depth = 1.0 / x.z;
        let (u, v) = (fx * x.x * depth, fy * x.y * depth);
        let mut by_pose = ByPose::zeros();
        for i in 0..3 {
            let by_d = self.camera_from_target.column(i);
            by_pose[(0, i)] = -(fx * by_d[0] - u * by_d[2]) * depth;
            by_pose[(1, i)] = -(fy * by_d[1] - v * by_d[2]) * depth;
            let turned = by_phi.column(i);
            by_pose[(0, i + 3)] = (fx * turned[0] - u * turned[2]) * depth;
            by_pose[(1, i + 3)] = (fy * turned[1] - v * turned[2]) * depth;
        }
        Some(ProjectedPoint { u, v, by_pose })
    }

    /// Returns the intersection (y1, y2), m, of the ray of an ideal image point with the plane y3 =
    /// `height_m`; `None` when they do not meet.
    pub(crate) fn on_plane(&self, u: f64, v: f64, height_m: f64) -> Option<(f64, f64)> {
        let (fx, fy) = self.focal_px;
        let ray = self.camera_from_target.transpose() * Vector3::new(u / fx, v / fy, 1.0);
        let along = (height_m - self.position_m.z) / ray.z;
        let point = self.position_m + ray * along;
        (along > 0.0 && along.is_finite()).then_some((point.x, point.y))
    }
}

/// Returns (d1, d2, d3, φ1, φ2, φ3).
pub(crate) fn to_vector(pose: &Pose) -> Vector6<f64> {
    let (d, phi) = (&pose.position_m, &pose.phi_rad);
    Vector6::new(d.x, d.y, d.z, phi.x, phi.y, phi.z)
}

/// Returns the pose of the first six components: the inverse of [`to_vector`].
pub(crate) fn to_pose<const N: usize>(v: &SVector<f64, N>) -> Pose {
    Pose { position_m: Vector3::new(v[0], v[1], v[2]), phi_rad: Vector3::new(v[3], v[4], v[5]) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::camera_model::tests::argon;

    fn pose() -> Pose {
        Pose { position_m: Vector3::new(0.3, -0.2, 5.0), phi_rad: Vector3::new(0.05, -0.03, 0.2) }
    }

    #[test]
    fn to_first_order_a_is_the_papers_matrix() {
        let phi = Vector3::new(1e-3, -2e-3, 3e-3);
        let papers = Matrix3::new(1.0, -phi.z, phi.y, -phi.z, -1.0, phi.x, phi.y, -phi.x, -1.0);
        // The difference is of second order: |φ|²/2 = 7e-6.
        assert!((target_from_camera(&phi) - papers).abs().max() < 1e-5);
    }

    #[test]
    fn a_is_orthogonal_and_its_rotation_vector_is_phi() {
        for phi in [Vector3::zeros(), Vector3::new(1e-5, 2e-5, -1e-5), Vector3::new(0.4, -1.1, 2.0)] {
            let a = target_from_camera(&phi);
            assert!((a * a.transpose() - Matrix3::identity()).abs().max() < 1e-14);
            assert!((a.determinant() - 1.0).abs() < 1e-14);
            assert!((phi_from_rotation(&a) - phi).norm() < 1e-12);
        }
    }

    #[test]
    fn a_quarter_turn_of_roll_moves_up_to_the_left() {
        // With φ3 = +90° the camera is turned clockwise seen from behind: the former up direction is now at
        // its left.
        let pose = Pose {
            position_m: Vector3::new(0.0, 0.0, 5.0),
            phi_rad: Vector3::new(0.0, 0.0, std::f64::consts::FRAC_PI_2),
        };
        let model = argon();
        let centre = project(&model, &pose, &Vector3::zeros()).unwrap();
        let up = project(&model, &pose, &Vector3::new(0.0, 0.2, 0.0)).unwrap();
        assert!(up.x < centre.x - 50.0 && (up.y - centre.y).abs() < 1e-9, "{up:?}");
    }

    #[test]
    fn derivatives_are_those_of_finite_differences() {
        let model = argon();
        let point = Vector3::new(0.15, 0.1, 0.3);
        for phi in [Vector3::new(0.05, -0.03, 0.2), Vector3::new(1e-6, 0.0, 0.0)] {
            let at = to_vector(&Pose { phi_rad: phi, ..pose() });
            let seen = |v: &Vector6<f64>| {
                PoseProjection::new(&model, &to_pose(v)).project_with_derivatives(&point).unwrap()
            };
            for i in 0..6 {
                let step = Vector6::ith(i, 1e-6);
                let (plus, minus) = (seen(&(at + step)), seen(&(at - step)));
                let numeric = [(plus.u - minus.u) / 2e-6, (plus.v - minus.v) / 2e-6];
                for (row, n) in numeric.into_iter().enumerate() {
                    let analytic = seen(&at).by_pose[(row, i)];
                    // Central differences: rounding of 1e-16 · 500 px/1e-6, against slopes of 500 to 2500 px.
                    assert!((analytic - n).abs() < 1e-5 * (1.0 + n.abs()), "{i} {row}: {analytic} and {n}");
                }
            }
        }
    }

    #[test]
    fn the_plane_is_where_the_ray_came_from() {
        let view = PoseProjection::new(&argon(), &pose());
        let point = Vector3::new(0.12, -0.21, 0.3);
        let seen = view.project_with_derivatives(&point).unwrap();
        let (y1, y2) = view.on_plane(seen.u, seen.v, 0.3).unwrap();
        assert!((y1 - point.x).abs() < 1e-12 && (y2 - point.y).abs() < 1e-12);
        assert!(view.on_plane(seen.u, seen.v, 6.0).is_none());
    }

    #[test]
    fn nothing_behind_the_camera_is_seen() {
        assert!(project(&argon(), &pose(), &Vector3::new(0.0, 0.0, 5.5)).is_none());
        assert!(
            PoseProjection::new(&argon(), &pose())
                .project_with_derivatives(&Vector3::new(0.0, 0.0, 5.5))
                .is_none()
        );
    }
}
