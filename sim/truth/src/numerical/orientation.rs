//! Orientation of the Earth: from celestial to terrestrial axes.
//!
//! The chain of the IERS Conventions (2010), Ch. 5, based on the celestial intermediate origin: IAU 2006
//! precession and IAU 2000A nutation from a table, the Earth rotation angle of UT1, and polar motion. UT1 −
//! UTC and the pole's position are constants of the configuration.

use contract::OutOfRange;
use hifitime::Epoch;
use nalgebra::{Matrix3, Vector3};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::clock;

/// Rate of the Earth rotation angle, rad/s (IERS Conventions 2010, Eq. 5.15).
pub(super) const EARTH_RATE_RAD_S: f64 = 2.0 * std::f64::consts::PI * TURNS_PER_DAY / 86_400.0;
const TURNS_PER_DAY: f64 = 1.002_737_811_911_354_6;

// Constants of make_cip.py.
const START_S: f64 = -3_652.5 * 86_400.0;
const PIECE_S: f64 = 32.0 * 86_400.0;
const PIECES: usize = 685;
const TERMS: usize = 26;
const LOCATOR_TERMS: usize = 6;
const RECORD: usize = 2 * TERMS + LOCATOR_TERMS;
const BYTES: usize = size_of::<f64>();

/// Table of coefficients. A table of another size does not compile.
static TABLE: &[u8; PIECES * RECORD * BYTES] = include_bytes!("../../../data/cip.bin");

/// Earth orientation that no theory predicts.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct EarthOrientationConfig {
    /// UT1 − UTC at the orbit's epoch, s, −0.9 to 0.9; constant in the run.
    #[serde(default)]
    #[schemars(range(min = -0.9, max = 0.9))]
    pub ut1_minus_utc_s: f64,
    /// Coordinates x, y of the pole, arcsec, each −1 to 1; constant in the run.
    #[serde(default)]
    #[schemars(inner(range(min = -1, max = 1)))]
    pub pole_arcsec: [f64; 2],
}

/// Orientation of the Earth over time.
#[derive(Debug, Clone)]
pub(super) struct EarthOrientation {
    /// TT at the epoch, seconds since J2000.0.
    tt_s: f64,
    /// Earth rotation angle at the epoch, rad.
    angle_rad: f64,
    itrs_from_tirs: Matrix3<f64>,
}

/// Orientation of the Earth at an instant.
#[derive(Debug, Clone, Copy)]
pub(super) struct Orientation {
    /// Rotation from GCRS (here ICRS) axes to Earth-fixed axes.
    pub(super) itrs_from_icrs: Matrix3<f64>,
    /// Unit vector along the axis of rotation, ICRS axes.
    pub(super) pole: Vector3<f64>,
}

impl EarthOrientation {
    /// Prepares the orientation for times that count from `epoch`.
    pub(super) fn new(config: &EarthOrientationConfig, epoch: Epoch) -> Self {
        // J2000.0 in nanoseconds of POSIX time; the difference is exact.
        let since_j2000_ns = i128::from(clock::unix_ns(epoch)) - 946_728_000_000_000_000;
        let (days, rest_ns) =
            (since_j2000_ns.div_euclid(86_400_000_000_000), since_j2000_ns.rem_euclid(86_400_000_000_000));
        let fraction = (rest_ns as f64 * 1e-9 + config.ut1_minus_utc_s) / 86_400.0;
        // IERS Conventions 2010, Eq. 5.15; whole days contribute no whole turns.
        let turns = 0.779_057_273_264_0 + (TURNS_PER_DAY - 1.0) * days as f64 + TURNS_PER_DAY * fraction;
        let [x, y] = config.pole_arcsec.map(|arcsec| (arcsec / 3_600.0).to_radians());
        let ((sin_x, cos_x), (sin_y, cos_y)) = (libm::sincos(x), libm::sincos(y));
        // R1(−y) R2(−x), the inverse of R2(x) R1(y) (Eq. 5.3); the terrestrial origin's s', 50 µas per
        // century, is neglected.
        let about_y = Matrix3::new(cos_x, 0.0, sin_x, 0.0, 1.0, 0.0, -sin_x, 0.0, cos_x);
        let about_x = Matrix3::new(1.0, 0.0, 0.0, 0.0, cos_y, -sin_y, 0.0, sin_y, cos_y);
        Self {
            tt_s: clock::tt_j2000_s(epoch),
            angle_rad: 2.0 * std::f64::consts::PI * (turns - turns.floor()),
            itrs_from_tirs: about_x * about_y,
        }
    }

    /// Checks that the table covers an interval, seconds since the epoch.
    pub(super) fn check_covers(&self, [start_s, end_s]: [f64; 2]) -> Result<(), OutOfRange> {
        let covered = START_S..=START_S + PIECES as f64 * PIECE_S;
        if covered.contains(&(self.tt_s + start_s)) && covered.contains(&(self.tt_s + end_s)) {
            return Ok(());
        }
        Err(OutOfRange::new(
            "epoch",
            format!("{} s of TT since J2000.0", self.tt_s),
            "an epoch with a schedule from 1990 to 2049",
        ))
    }

    /// Orientation `time_s` seconds after the epoch.
    pub(super) fn at(&self, time_s: f64) -> Orientation {
        let [x, y, z] = pole(self.tt_s + time_s);
        let locator = z - 0.5 * x * y;
        let square = x * x + y * y;
        // IERS Conventions 2010, Eq. 5.10 with a = 1/(1 + cos d).
        let cosine = (1.0 - square).sqrt();
        let a = 1.0 / (1.0 + cosine);
        let cirs_from_icrs =
            Matrix3::new(1.0 - a * x * x, -a * x * y, -x, -a * x * y, 1.0 - a * y * y, -y, x, y, cosine);
        let (sin, cos) = libm::sincos(self.angle_rad + EARTH_RATE_RAD_S * time_s - locator);
        let turn = Matrix3::new(cos, sin, 0.0, -sin, cos, 0.0, 0.0, 0.0, 1.0);
        Orientation {
            itrs_from_icrs: self.itrs_from_tirs * turn * cirs_from_icrs,
            pole: Vector3::new(x, y, cosine),
        }
    }
}

/// X, Y and s + XY/2 of the celestial intermediate pole, rad, at a TT since J2000.0, s.
fn pole(tt_j2000_s: f64) -> [f64; 3] {
    let pieces = (tt_j2000_s - START_S) / PIECE_S;
    let piece = (pieces.max(0.0) as usize).min(PIECES - 1);
    let x = 2.0 * (pieces - piece as f64) - 1.0;
    let record = TABLE.get(piece * RECORD * BYTES..(piece + 1) * RECORD * BYTES).unwrap_or_default();
    let (words, _) = record.as_chunks::<BYTES>();
    [(0, TERMS), (TERMS, TERMS), (2 * TERMS, LOCATOR_TERMS)].map(|(first, terms)| {
        // Clenshaw's recurrence.
        let (mut b1, mut b2) = (0.0, 0.0);
        for word in words.iter().skip(first).take(terms).rev() {
            (b1, b2) = (f64::from_le_bytes(*word) + 2.0 * x * b1 - b2, b1);
        }
        b1 - x * b2
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::clock::parse_utc;

    /// SOFA's example of the IAU 2006/2000A chain (*SOFA Tools for Earth Attitude*, 2021, Sec. 5.5): 2007
    /// April 5, 12h UTC, with UT1 − UTC = −0.072 073 685 s and the pole at 0.034 928 2″, 0.483 316 3″; the
    /// corrections dX = 0.1750 mas, dY = −0.2259 mas are left out here.
    #[test]
    fn the_matrix_is_that_of_sofas_example() {
        let epoch = parse_utc("2007-04-05T12:00:00Z").unwrap();
        let config = EarthOrientationConfig {
            ut1_minus_utc_s: -0.072_073_685,
            pole_arcsec: [0.034_928_2, 0.483_316_3],
        };
        let got = EarthOrientation::new(&config, epoch).at(0.0).itrs_from_icrs;
        let expected = Matrix3::new(
            0.973_104_317_697_536,
            0.230_363_826_239_128,
            -0.000_703_163_481_769,
            -0.230_363_800_456_036,
            0.973_104_570_632_801,
            0.000_118_545_368_117,
            0.000_711_560_162_594,
            0.000_046_626_402_444,
            0.999_999_745_754_024,
        );
        // The corrections are 1.1e-9 rad.
        assert!((got - expected).amax() < 2e-9, "{got}");
    }

    #[test]
    fn a_later_time_equals_a_later_epoch() {
        let config = EarthOrientationConfig::default();
        let at = |text: &str, time_s| {
            EarthOrientation::new(&config, parse_utc(text).unwrap()).at(time_s).itrs_from_icrs
        };
        let (late, early) = (at("2012-04-27T12:00:00Z", 0.0), at("2012-04-23T00:00:00Z", 388_800.0));
        // Rounding of an angle of 28 rad.
        assert!((late - early).amax() < 1e-13, "{}", late - early);
    }
}
