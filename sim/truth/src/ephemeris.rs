//! Positions of the Earth and the Sun, and velocity of the Earth.
//!
//! Chebyshev polynomials made from ERFA's `epv00` by `sim/data/make_earth.py`: the same bits on every
//! machine, no transcendental function, no file to download. They agree with `epv00` to 0.3 km and 3 mm/s
//! (the Sun to 0.1 km); `epv00` itself agrees with a JPL ephemeris to about 10 km and 5 mm/s. 5 mm/s is 3 µas
//! of aberration.

use std::ops::RangeInclusive;

use contract::OutOfRange;
use hifitime::Epoch;
use nalgebra::Vector3;

use super::clock;

/// Interval covered by the table, in s of TDB since J2000.0: 1990-01-01 00:00 to 2050-01-06 00:00 TDB.
pub const COVERAGE: RangeInclusive<f64> = START_S..=END_S;

/// Text of [`COVERAGE`] for messages.
pub const COVERAGE_TEXT: &str = "from 1990-01-01 to 2050-01-05";

// Constants of make_earth.py.
const START_S: f64 = -3_652.5 * 86_400.0;
const PIECE_S: f64 = 32.0 * 86_400.0;
const PIECES: usize = 685;
const END_S: f64 = START_S + PIECES as f64 * PIECE_S;
const EARTH_TERMS: usize = 18;
const SUN_TERMS: usize = 5;
const RECORD: usize = 3 * (EARTH_TERMS + SUN_TERMS);
const SUN_OFFSET: usize = 3 * EARTH_TERMS;

const BYTES: usize = size_of::<f64>();

/// Table of coefficients. A table of another size does not compile.
static TABLE: &[u8; PIECES * RECORD * BYTES] = include_bytes!("../../data/earth.bin");

/// The Earth and the Sun at one instant; origin at the barycentre of the Solar System, ICRS axes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct EarthState {
    /// Position of the centre of the Earth, km.
    pub position_km: Vector3<f64>,
    /// Velocity of the centre of the Earth, km/s.
    pub velocity_km_s: Vector3<f64>,
    /// Position of the centre of the Sun, km.
    pub sun_position_km: Vector3<f64>,
}

impl EarthState {
    /// Position of the Sun relative to the Earth's centre, km: geometric, at the same instant (no light time,
    /// no aberration).
    pub fn sun_geocentric_km(&self) -> Vector3<f64> {
        self.sun_position_km - self.position_km
    }
}

/// Rejects an instant outside [`COVERAGE`]; `path` and `value` are those of the time in the scenario.
///
/// # Errors
/// [`OutOfRange`] with the path.
pub fn check_covered(path: impl Into<String>, value: &str, time: Epoch) -> Result<(), OutOfRange> {
    if COVERAGE.contains(&clock::tdb_j2000_s(time)) {
        Ok(())
    } else {
        Err(OutOfRange::new(path, value, format!("a time covered by the ephemerides, {COVERAGE_TEXT}")))
    }
}

/// State at an instant, in s of TDB since J2000.0 (see [`super::clock::tdb_j2000_s`]); `None` outside
/// [`COVERAGE`] and for NaN.
pub fn earth(tdb_j2000_s: f64) -> Option<EarthState> {
    if !COVERAGE.contains(&tdb_j2000_s) {
        return None;
    }
    let pieces = (tdb_j2000_s - START_S) / PIECE_S;
    // The end of the coverage belongs to the last piece.
    let piece = (pieces as usize).min(PIECES - 1);
    let x = 2.0 * (pieces - piece as f64) - 1.0;
    let record = TABLE.get(piece * RECORD * BYTES..(piece + 1) * RECORD * BYTES)?;

    let mut state = EarthState {
        position_km: Vector3::zeros(),
        velocity_km_s: Vector3::zeros(),
        sun_position_km: Vector3::zeros(),
    };
    for axis in 0..3 {
        let (position, slope) = clenshaw(coefficients(record, axis * EARTH_TERMS, EARTH_TERMS), x);
        state.position_km[axis] = position;
        state.velocity_km_s[axis] = slope * (2.0 / PIECE_S);
        let (sun, _) = clenshaw(coefficients(record, SUN_OFFSET + axis * SUN_TERMS, SUN_TERMS), x);
        state.sun_position_km[axis] = sun;
    }
    Some(state)
}

/// Coefficients of one polynomial, highest term first.
fn coefficients(record: &[u8], first: usize, terms: usize) -> impl Iterator<Item = f64> {
    let (words, _) = record.as_chunks::<BYTES>();
    words.iter().skip(first).take(terms).rev().map(|word| f64::from_le_bytes(*word))
}

/// Returns value and derivative in x of a Chebyshev series, given with the highest term first, by Clenshaw's
/// recurrence (Clenshaw 1955) and its derivative.
fn clenshaw(highest_first: impl Iterator<Item = f64>, x: f64) -> (f64, f64) {
    let (mut b1, mut b2, mut d1, mut d2) = (0.0, 0.0, 0.0, 0.0);
    for c in highest_first {
        (d1, d2) = (2.0 * b1 + 2.0 * x * d1 - d2, d1);
        (b1, b2) = (c + 2.0 * x * b1 - b2, b1);
    }
    // The loop also applied the factor 2x to the last step; the constant term needs the factor x.
    (b1 - x * b2, d1 - b2 - x * d2)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn clenshaw_sums_the_polynomials_and_their_slopes() {
        // 1 + 2 T1 + 3 T2 + 4 T3 with T2 = 2x² − 1, T3 = 4x³ − 3x.
        for x in [-1.0, -0.3, 0.0, 0.7, 1.0] {
            let value = 1.0 + 2.0 * x + 3.0 * (2.0 * x * x - 1.0) + 4.0 * (4.0 * x * x * x - 3.0 * x);
            let slope = 2.0 + 12.0 * x + 4.0 * (12.0 * x * x - 3.0);
            let (v, s) = clenshaw([4.0, 3.0, 2.0, 1.0].into_iter(), x);
            assert!((v - value).abs() < 1e-13 && (s - slope).abs() < 1e-13, "{x}: {v} {s}");
        }
    }

    #[test]
    fn the_earth_keeps_the_speed_and_the_distance_of_its_orbit() {
        let mut day = START_S;
        while day < END_S {
            let state = earth(day).unwrap();
            // 29.29 to 30.29 km/s around the Sun (vis viva, e = 0.0167), and 13 m/s each for the Sun and the
            // Moon.
            let speed = state.velocity_km_s.norm();
            assert!((29.25..30.33).contains(&speed), "{speed} km/s at {day}");
            // Perihelion 147.10, aphelion 152.10 million km, with small deviations due to the Moon and the
            // planets.
            let distance = state.sun_geocentric_km().norm();
            assert!((147.05e6..152.15e6).contains(&distance), "{distance} km at {day}");
            day += 5.0 * 86_400.0;
        }
    }

    #[test]
    fn nothing_jumps_where_two_pieces_meet() {
        for piece in 1..PIECES {
            let seam = START_S + piece as f64 * PIECE_S;
            let (before, after) = (earth(seam - 1e-3).unwrap(), earth(seam + 1e-3).unwrap());
            // Twice the deviation of the polynomials from epv00; the motion in the 2 ms between is 0.06 km.
            assert!((after.position_km - before.position_km).norm() < 0.6, "position at piece {piece}");
            assert!((after.velocity_km_s - before.velocity_km_s).norm() < 6e-6, "velocity at piece {piece}");
            assert!((after.sun_position_km - before.sun_position_km).norm() < 0.2, "Sun at piece {piece}");
        }
    }

    #[test]
    fn outside_the_coverage_there_is_nothing() {
        assert!(earth(START_S).is_some() && earth(END_S).is_some());
        for t in [START_S - 1e-3, END_S + 1e-3, f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
            assert_eq!(earth(t), None);
        }
    }

    #[test]
    fn the_sun_is_at_the_equinox_at_the_almanacs_time() {
        // March equinox 2012: 2012-03-20 05:14 UTC (to the minute), apparent longitude of date 0. ICRS axes
        // differ by precession of 12.2 years × 50.3″ = 614″ and by 20.5″ of aberration.
        let time = clock::parse_utc("2012-03-20T05:14:00Z").unwrap();
        let sun = earth(clock::tdb_j2000_s(time)).unwrap().sun_geocentric_km();
        let ra_arcsec = libm::atan2(sun.y, sun.x).to_degrees() * 3_600.0;
        // There the right ascension is longitude × cos ε: (−614 + 20.5) × 0.9175 = −545. One minute is 2.5″,
        // nutation 16″.
        assert!((ra_arcsec + 545.0).abs() < 20.0, "{ra_arcsec}");
    }
}
