//! Angles with explicit units.

use std::ops::{Add, Mul, Neg, Sub};

/// An angle, stored in radians; constructors and accessors name the unit.
///
/// ```
/// use boresight_contract::Angle;
/// assert!((Angle::from_degrees(180.0).radians() - std::f64::consts::PI).abs() < 1e-15);
/// ```
#[derive(Debug, Clone, Copy, PartialEq, PartialOrd, Default)]
pub struct Angle {
    radians: f64,
}

const RADIANS_PER_DEGREE: f64 = std::f64::consts::PI / 180.0;
const RADIANS_PER_ARCSEC: f64 = RADIANS_PER_DEGREE / 3600.0;

impl Angle {
    /// The zero angle.
    pub const ZERO: Self = Self { radians: 0.0 };

    /// Creates an angle from radians.
    pub const fn from_radians(radians: f64) -> Self {
        Self { radians }
    }

    /// Creates an angle from degrees.
    pub const fn from_degrees(degrees: f64) -> Self {
        Self { radians: degrees * RADIANS_PER_DEGREE }
    }

    /// Creates an angle from arcseconds.
    pub const fn from_arcsec(arcsec: f64) -> Self {
        Self { radians: arcsec * RADIANS_PER_ARCSEC }
    }

    /// Returns the angle in radians.
    pub const fn radians(self) -> f64 {
        self.radians
    }

    /// Returns the angle in degrees.
    pub const fn degrees(self) -> f64 {
        self.radians / RADIANS_PER_DEGREE
    }

    /// Returns the angle in arcseconds.
    pub const fn arcsec(self) -> f64 {
        self.radians / RADIANS_PER_ARCSEC
    }

    /// Returns the absolute value of the angle.
    pub fn abs(self) -> Self {
        Self { radians: self.radians.abs() }
    }
}

impl Add for Angle {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        Self { radians: self.radians + other.radians }
    }
}

impl Sub for Angle {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        Self { radians: self.radians - other.radians }
    }
}

impl Neg for Angle {
    type Output = Self;
    fn neg(self) -> Self {
        Self { radians: -self.radians }
    }
}

impl Mul<f64> for Angle {
    type Output = Self;
    fn mul(self, factor: f64) -> Self {
        Self { radians: self.radians * factor }
    }
}
