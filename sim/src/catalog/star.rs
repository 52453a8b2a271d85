//! Star of a catalogue.

use contract::{Angle, Direction, Icrs};

use super::photometry;

/// Star as catalogued: ICRS, epoch J1991.25 (TT).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CatalogStar {
    /// Hipparcos number, or the number in the user's catalogue.
    pub id: u32,
    /// Right ascension at J1991.25, rad.
    pub ra_rad: f64,
    /// Declination at J1991.25, rad.
    pub dec_rad: f64,
    /// Parallax, mas; may be negative as published.
    pub parallax_mas: f64,
    /// Proper motion in right ascension times cos δ, mas per Julian year.
    pub pm_ra_mas_per_yr: f64,
    /// Proper motion in declination, mas per Julian year.
    pub pm_dec_mas_per_yr: f64,
    /// Radial velocity, km/s, positive for recession; 0 if unknown.
    pub radial_velocity_km_s: f64,
    /// Magnitude in the Hipparcos band.
    pub hp_mag: f64,
    /// Colour index B−V, mag, never NaN; `None` if unknown.
    pub b_v: Option<f64>,
    /// Colour index V−I, mag; `None` if unknown.
    pub v_i: Option<f64>,
}

impl CatalogStar {
    /// Direction at the catalogue's epoch.
    pub fn direction(&self) -> Direction<Icrs> {
        Direction::from_ra_dec(Angle::from_radians(self.ra_rad), Angle::from_radians(self.dec_rad))
    }

    /// Johnson V, mag, computed by [`photometry::v_mag`], whose limits apply.
    pub fn v_mag(&self) -> f64 {
        photometry::v_mag(self.hp_mag, self.b_v)
    }
}
