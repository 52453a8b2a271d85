//! Positions of the Sun and the Moon for the forces: a table of the simulator's ephemerides, interpolated.

use contract::OutOfRange;
use hifitime::Epoch;
use nalgebra::Vector3;

use crate::clock;
use crate::ephemeris::{COVERAGE_TEXT, earth};
use crate::moon::moon_position_km;

/// Interval of the table, s. The Moon moves 1.5° in it; eight points then interpolate its position to a
/// metre.
const KNOT_S: f64 = 10_800.0;
/// Number of points of an interpolation.
const POINTS: i64 = 8;

/// 1/Π(i − j) over j ≠ i, for i from 0 to 7.
const INVERSE_DENOMINATORS: [f64; POINTS as usize] = [
    -1.0 / 5_040.0,
    1.0 / 720.0,
    -1.0 / 240.0,
    1.0 / 144.0,
    -1.0 / 144.0,
    1.0 / 240.0,
    -1.0 / 720.0,
    1.0 / 5_040.0,
];

/// Geocentric positions, km, ICRS axes.
#[derive(Debug, Clone, Copy)]
pub(super) struct Bodies {
    pub(super) sun_km: Vector3<f64>,
    pub(super) moon_km: Vector3<f64>,
}

/// Table of positions. Its points are multiples of [`KNOT_S`] from the epoch, so a position does not depend
/// on the interval that the table covers.
#[derive(Debug, Clone)]
pub(super) struct Sky {
    first: i64,
    bodies: Vec<Bodies>,
}

impl Sky {
    /// Computes the table for the interval from `start_s` to `end_s`, seconds since `epoch`.
    ///
    /// # Errors
    /// [`OutOfRange`] outside the ephemerides.
    pub(super) fn new(epoch: Epoch, [start_s, end_s]: [f64; 2]) -> Result<Self, OutOfRange> {
        let tdb_s = clock::tdb_j2000_s(epoch);
        let first = (start_s / KNOT_S).floor() as i64 - POINTS / 2;
        let last = (end_s / KNOT_S).floor() as i64 + POINTS / 2 + 1;
        let bodies = (first..=last).map(|knot| {
            // TDB and TT differ by 1.7 ms at most; the change of the difference is neglected.
            let time_s = tdb_s + knot as f64 * KNOT_S;
            let sun_km = earth(time_s)?.sun_geocentric_km();
            Some(Bodies { sun_km, moon_km: moon_position_km(time_s) })
        });
        let uncovered = || {
            let expected = format!("an epoch with a schedule {COVERAGE_TEXT}");
            OutOfRange::new("epoch", clock::format_utc(epoch), expected)
        };
        Ok(Self { first, bodies: bodies.collect::<Option<_>>().ok_or_else(uncovered)? })
    }

    /// Positions `time_s` seconds after the epoch: Lagrange's polynomial through the eight nearest points.
    pub(super) fn at(&self, time_s: f64) -> Bodies {
        let knots = time_s / KNOT_S;
        let begin = knots.floor() as i64 - POINTS / 2 + 1;
        let offset = (begin - self.first).clamp(0, self.bodies.len() as i64 - POINTS) as usize;
        let x = knots - (self.first + offset as i64) as f64;
        let mut sum = Bodies { sun_km: Vector3::zeros(), moon_km: Vector3::zeros() };
        let points = self.bodies.iter().skip(offset).take(POINTS as usize);
        for (i, bodies) in points.enumerate() {
            let mut weight = INVERSE_DENOMINATORS[i];
            for j in (0..POINTS as usize).filter(|j| *j != i) {
                weight *= x - j as f64;
            }
            sum.sun_km += bodies.sun_km * weight;
            sum.moon_km += bodies.moon_km * weight;
        }
        sum
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::clock::parse_utc;

    #[test]
    fn the_table_follows_the_ephemerides_and_does_not_depend_on_its_interval() {
        let epoch = parse_utc("2012-04-23T00:00:00Z").unwrap();
        let tdb_s = clock::tdb_j2000_s(epoch);
        let (short, long) =
            (Sky::new(epoch, [0.0, 86_400.0]).unwrap(), Sky::new(epoch, [-9e4, 5e5]).unwrap());
        for k in 0..200 {
            let time_s = f64::from(k) * 432.0;
            let (a, b) = (short.at(time_s), long.at(time_s));
            assert_eq!((a.sun_km, a.moon_km), (b.sun_km, b.moon_km));
            let moon_error_km = (a.moon_km - moon_position_km(tdb_s + time_s)).norm();
            let sun_error_km = (a.sun_km - earth(tdb_s + time_s).unwrap().sun_geocentric_km()).norm();
            // A change of position by 1 km is 3e-9 of the Moon's force, and less of the Sun's.
            assert!(moon_error_km < 1e-3 && sun_error_km < 1e-2, "{moon_error_km} {sun_error_km}");
        }
    }

    #[test]
    fn outside_the_ephemerides_there_is_no_table() {
        assert!(Sky::new(parse_utc("2049-12-30T00:00:00Z").unwrap(), [0.0, 1e7]).is_err());
    }
}
