//! Rotations, typed by the frames they connect.

use std::fmt;
use std::marker::PhantomData;
use std::ops::Mul;

use nalgebra::{Matrix3, Quaternion, UnitQuaternion, Vector3};

use crate::{Angle, ContractError, Direction};

/// Rotation that transforms components in frame `From` into components in frame `To`: v_to = R · v_from.
///
/// A variable of this type is named `to_from_from`, for example `camera_from_icrs`: adjacent frame names
/// match like the sizes of matrices. Its quaternion is Hamilton's, scalar first, and is called `q_to_from` in
/// files: v_to = q v_from q*.
///
/// ```
/// use boresight_contract::{Body, CameraFrame, Icrs, Rotation};
/// let camera_from_body: Rotation<CameraFrame, Body> = Rotation::identity();
/// let body_from_icrs: Rotation<Body, Icrs> = Rotation::identity();
/// let camera_from_icrs: Rotation<CameraFrame, Icrs> = camera_from_body * body_from_icrs;
/// ```
/// The wrong order does not compile:
/// ```compile_fail
/// use boresight_contract::{Body, CameraFrame, Icrs, Rotation};
/// let camera_from_body: Rotation<CameraFrame, Body> = Rotation::identity();
/// let body_from_icrs: Rotation<Body, Icrs> = Rotation::identity();
/// let wrong = body_from_icrs * camera_from_body;
/// ```
/// A direction in the wrong frame does not compile either:
/// ```compile_fail
/// use boresight_contract::{Body, CameraFrame, Direction, Icrs, Rotation};
/// let camera_from_body: Rotation<CameraFrame, Body> = Rotation::identity();
/// let star: Direction<Icrs> = Direction::from_ra_dec(Default::default(), Default::default());
/// let wrong = camera_from_body * star;
/// ```
pub struct Rotation<To, From> {
    quaternion: UnitQuaternion<f64>,
    frames: PhantomData<fn() -> (To, From)>,
}

impl<To, From> Rotation<To, From> {
    /// Returns the rotation between two coincident frames.
    pub fn identity() -> Self {
        Self::from_unit_quaternion(UnitQuaternion::identity())
    }

    /// Creates a rotation from a unit quaternion q with v_to = q v_from q*.
    pub fn from_unit_quaternion(quaternion: UnitQuaternion<f64>) -> Self {
        Self { quaternion, frames: PhantomData }
    }

    /// Creates a rotation from four quaternion components, scalar first.
    ///
    /// Components with a norm within 1e-12 of 1 are kept bit for bit, which makes reading a file back exact;
    /// those with a norm within 1e-5 are normalised.
    ///
    /// # Errors
    /// [`ContractError::NotUnit`] if the norm differs from 1 by more than 1e-5 or is not finite.
    pub fn from_wxyz(wxyz: [f64; 4]) -> Result<Self, ContractError> {
        let [w, x, y, z] = wxyz;
        let quaternion = Quaternion::new(w, x, y, z);
        let norm = quaternion.norm();
        if norm.is_nan() || (norm - 1.0).abs() > 1e-5 {
            return Err(ContractError::NotUnit { wxyz, norm });
        }
        Ok(Self::from_unit_quaternion(if (norm - 1.0).abs() < 1e-12 {
            UnitQuaternion::new_unchecked(quaternion)
        } else {
            UnitQuaternion::new_normalize(quaternion)
        }))
    }

    /// Creates a rotation from the rows of its matrix: the axes of `To`, expressed in `From`. They must be
    /// orthonormal and right-handed.
    pub fn from_axes(x: &Vector3<f64>, y: &Vector3<f64>, z: &Vector3<f64>) -> Self {
        let matrix = Matrix3::from_rows(&[x.transpose(), y.transpose(), z.transpose()]);
        let rotation = nalgebra::Rotation3::from_matrix_unchecked(matrix);
        Self::from_unit_quaternion(UnitQuaternion::from_rotation_matrix(&rotation))
    }

    /// Creates a small rotation from a rotation vector: its direction is the axis, its length the angle in
    /// radians. The rotation turns vectors (not axes) by the right-hand rule.
    pub fn from_rotation_vector(vector: Vector3<f64>) -> Self {
        Self::from_unit_quaternion(UnitQuaternion::from_scaled_axis(vector))
    }

    /// Creates a rotation from Euler angles in the convention 123: the frame `From` is turned by `phi` about
    /// its x axis, then by `theta` about the resulting y axis, then by `psi` about the resulting z axis, and
    /// then coincides with `To` (far-range paper, Fig. 8).
    pub fn from_euler_123(phi: Angle, theta: Angle, psi: Angle) -> Self {
        let turn = |axis, angle: Angle| UnitQuaternion::from_axis_angle(axis, -angle.radians());
        Self::from_unit_quaternion(
            turn(&Vector3::z_axis(), psi) * turn(&Vector3::y_axis(), theta) * turn(&Vector3::x_axis(), phi),
        )
    }

    /// Returns the Euler angles (φ, θ, ψ) of [`Rotation::from_euler_123`]; θ is in [−90°, 90°].
    #[allow(clippy::indexing_slicing, reason = "constant indices of a 3 × 3 matrix")]
    pub fn euler_123(&self) -> (Angle, Angle, Angle) {
        let m = self.matrix();
        let phi = libm::atan2(-m[(2, 1)], m[(2, 2)]);
        let theta = libm::asin(m[(2, 0)].clamp(-1.0, 1.0));
        let psi = libm::atan2(-m[(1, 0)], m[(0, 0)]);
        (Angle::from_radians(phi), Angle::from_radians(theta), Angle::from_radians(psi))
    }

    /// Returns the inverse rotation.
    pub fn inverse(&self) -> Rotation<From, To> {
        Rotation::from_unit_quaternion(self.quaternion.inverse())
    }

    /// Returns the 3 × 3 matrix R of v_to = R · v_from.
    pub fn matrix(&self) -> Matrix3<f64> {
        *self.quaternion.to_rotation_matrix().matrix()
    }

    /// Returns the unit quaternion.
    pub fn quaternion(&self) -> &UnitQuaternion<f64> {
        &self.quaternion
    }

    /// Returns the components of the quaternion, scalar first.
    pub fn wxyz(&self) -> [f64; 4] {
        let q = self.quaternion.quaternion();
        [q.w, q.i, q.j, q.k]
    }

    /// Returns the angle between this rotation and another one, in [0, π].
    pub fn angle_to(&self, other: &Self) -> Angle {
        let q = self.quaternion.inverse() * other.quaternion;
        Angle::from_radians(2.0 * libm::atan2(q.imag().norm(), q.w.abs()))
    }

    /// Transforms the components of any vector, for example of a velocity.
    pub fn rotate(&self, vector: &Vector3<f64>) -> Vector3<f64> {
        self.quaternion * vector
    }
}

impl<To, Mid, From> Mul<Rotation<Mid, From>> for Rotation<To, Mid> {
    type Output = Rotation<To, From>;
    fn mul(self, first: Rotation<Mid, From>) -> Rotation<To, From> {
        Rotation::from_unit_quaternion(self.quaternion * first.quaternion)
    }
}

impl<To, From> Mul<Direction<From>> for Rotation<To, From> {
    type Output = Direction<To>;
    fn mul(self, direction: Direction<From>) -> Direction<To> {
        Direction::from_unit(self.quaternion * direction.vector())
    }
}

// Implemented by hand: a derive would require the same traits of the marker types.
impl<To, From> Clone for Rotation<To, From> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<To, From> Copy for Rotation<To, From> {}

impl<To, From> PartialEq for Rotation<To, From> {
    fn eq(&self, other: &Self) -> bool {
        self.quaternion.as_vector() == other.quaternion.as_vector()
    }
}

impl<To, From> fmt::Debug for Rotation<To, From> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "Rotation{:?}", self.wxyz())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Body, CameraFrame, Icrs};

    #[test]
    fn euler_123_turns_the_axes_one_after_the_other() {
        // After a rotation of the frame by +90° about x, its y axis has the direction of the old z axis: a
        // vector along the old z has y = 1.
        let about_x: Rotation<CameraFrame, Body> =
            Rotation::from_euler_123(Angle::from_degrees(90.0), Angle::ZERO, Angle::ZERO);
        assert!((about_x.rotate(&Vector3::z()) - Vector3::y()).norm() < 1e-15);
        // A further rotation by +90° about the resulting y leaves the old z, now along y, unchanged.
        let both: Rotation<CameraFrame, Body> =
            Rotation::from_euler_123(Angle::from_degrees(90.0), Angle::from_degrees(90.0), Angle::ZERO);
        assert!((both.rotate(&Vector3::z()) - Vector3::y()).norm() < 1e-15);
        assert!((both.rotate(&Vector3::x()) - Vector3::z()).norm() < 1e-15);
    }

    #[test]
    fn euler_123_round_trips() {
        let angles = [10.0, -35.0, 170.0].map(Angle::from_degrees);
        let (phi, theta, psi) =
            Rotation::<CameraFrame, Body>::from_euler_123(angles[0], angles[1], angles[2]).euler_123();
        for (got, expected) in [phi, theta, psi].into_iter().zip(angles) {
            assert!((got.degrees() - expected.degrees()).abs() < 1e-12);
        }
    }

    #[test]
    fn rows_of_the_matrix_are_the_axes_of_the_frame_turned_to() {
        let rotation: Rotation<Body, Icrs> = Rotation::from_axes(&Vector3::y(), &Vector3::z(), &Vector3::x());
        assert!((rotation.rotate(&Vector3::y()) - Vector3::x()).norm() < 1e-15);
    }

    /// Test vector published in CONVENTIONS.md.
    #[test]
    fn the_published_quaternion_turns_the_published_vector() {
        let half = std::f64::consts::FRAC_1_SQRT_2;
        let body_from_icrs = Rotation::<Body, Icrs>::from_wxyz([half, 0.0, 0.0, -half]).unwrap();
        assert!((body_from_icrs.rotate(&Vector3::x()) + Vector3::y()).norm() < 1e-15);
    }

    #[test]
    fn a_quaternion_that_is_not_a_unit_is_refused() {
        for wxyz in [[0.9, 0.0, 0.0, 0.0], [f64::NAN, 0.0, 0.0, 1.0], [0.0; 4]] {
            assert!(matches!(Rotation::<Body, Icrs>::from_wxyz(wxyz), Err(ContractError::NotUnit { .. })));
        }
    }
}
