//! Directions, typed by their frame.

use std::fmt;
use std::marker::PhantomData;

use nalgebra::Vector3;

use crate::{Angle, ContractError, OutOfRange};

/// Celestial frame: ICRS axes, treated as J2000 (the frame bias of about 20 mas is below every error budget).
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Icrs {}

/// Body frame of the chaser spacecraft (`SC` in the papers).
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Body {}

/// Body frame of the target spacecraft.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Target {}

/// Camera frame: z along the boresight, x along increasing column, y along increasing row.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum CameraFrame {}

/// A unit vector with components in the frame `F`.
///
/// Directions of different frames are different types:
/// ```compile_fail
/// use boresight_contract::{Direction, Icrs, Body};
/// let star: Direction<Icrs> = Direction::from_ra_dec(Default::default(), Default::default());
/// let wrong: Direction<Body> = star;
/// ```
pub struct Direction<F> {
    unit: Vector3<f64>,
    frame: PhantomData<fn() -> F>,
}

impl<F> Direction<F> {
    /// Returns the direction of a vector of any length.
    ///
    /// # Errors
    /// [`ContractError::OutOfRange`] if the length is zero or not finite.
    pub fn from_vector(vector: Vector3<f64>) -> Result<Self, ContractError> {
        let norm = vector.norm();
        if norm.is_finite() && norm > f64::MIN_POSITIVE {
            Ok(Self::from_unit(vector / norm))
        } else {
            Err(OutOfRange::new("length of a direction vector", norm, "finite and greater than 0").into())
        }
    }

    /// Creates a direction from a vector of unit length; the caller guarantees the length.
    pub fn from_unit(unit: Vector3<f64>) -> Self {
        debug_assert!((unit.norm_squared() - 1.0).abs() < 1e-9, "not a unit vector: {unit:?}");
        Self { unit, frame: PhantomData }
    }

    /// Returns the boresight: (0, 0, 1).
    pub fn z() -> Self {
        Self::from_unit(Vector3::z())
    }

    /// Returns the components as a unit vector.
    pub fn vector(&self) -> &Vector3<f64> {
        &self.unit
    }

    /// Returns the angle to another direction, accurate at every separation (atan2 of cross and dot product).
    pub fn separation(&self, other: &Self) -> Angle {
        Angle::from_radians(libm::atan2(self.unit.cross(&other.unit).norm(), self.unit.dot(&other.unit)))
    }
}

impl Direction<Icrs> {
    /// Creates a direction from right ascension and declination: r = (cos α cos δ, sin α cos δ, sin δ)
    /// (far-range paper, Eq. 3, with its interchanged sin α and cos α corrected).
    pub fn from_ra_dec(ra: Angle, dec: Angle) -> Self {
        let (sin_ra, cos_ra) = libm::sincos(ra.radians());
        let (sin_dec, cos_dec) = libm::sincos(dec.radians());
        Self::from_unit(Vector3::new(cos_ra * cos_dec, sin_ra * cos_dec, sin_dec))
    }

    /// Returns the right ascension in [0, 2π).
    pub fn ra(&self) -> Angle {
        let ra = libm::atan2(self.unit.y, self.unit.x);
        Angle::from_radians(if ra < 0.0 { ra + 2.0 * std::f64::consts::PI } else { ra })
    }

    /// Returns the declination in [−π/2, π/2].
    pub fn dec(&self) -> Angle {
        Angle::from_radians(libm::atan2(self.unit.z, libm::hypot(self.unit.x, self.unit.y)))
    }
}

// Implemented by hand: a derive would require the same traits of the marker type F.
impl<F> Clone for Direction<F> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<F> Copy for Direction<F> {}

impl<F> PartialEq for Direction<F> {
    fn eq(&self, other: &Self) -> bool {
        self.unit == other.unit
    }
}

impl<F> fmt::Debug for Direction<F> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "Direction({}, {}, {})", self.unit.x, self.unit.y, self.unit.z)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn right_ascension_and_declination_round_trip() {
        for (ra, dec) in [(0.0, 0.0), (10.0, -80.0), (359.5, 45.0), (180.0, 89.9999)] {
            let direction = Direction::from_ra_dec(Angle::from_degrees(ra), Angle::from_degrees(dec));
            assert!((direction.ra().degrees() - ra).abs() < 1e-9);
            assert!((direction.dec().degrees() - dec).abs() < 1e-9);
        }
    }

    #[test]
    fn the_vernal_equinox_is_x_and_six_hours_is_y() {
        let equinox = Direction::from_ra_dec(Angle::ZERO, Angle::ZERO);
        let six_hours = Direction::from_ra_dec(Angle::from_degrees(90.0), Angle::ZERO);
        assert!((equinox.vector() - Vector3::x()).norm() < 1e-15);
        assert!((six_hours.vector() - Vector3::y()).norm() < 1e-15);
    }

    #[test]
    fn a_zero_vector_has_no_direction() {
        assert!(Direction::<Icrs>::from_vector(Vector3::zeros()).is_err());
        assert!(Direction::<Icrs>::from_vector(Vector3::new(f64::NAN, 0.0, 1.0)).is_err());
    }
}
