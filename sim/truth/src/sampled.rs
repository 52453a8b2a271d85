//! States of chaser and target sampled over time, and their interpolation.
//!
//! A reader of files converts frames, units and time systems beforehand: samples are geocentric, along ICRS
//! axes, in seconds since a common epoch. Interpolation is that of CCSDS 502.0-B-3 (Orbit Data Messages,
//! 2023, Sec. 5.2.4): a polynomial of a given degree through the nearest samples.

use std::ops::RangeInclusive;

use contract::OutOfRange;
use hifitime::Epoch;
use nalgebra::Vector3;

use super::orbit::{EARTH_GM_KM3_S2, Elements, State};
use super::states::States;

/// Largest supported degree of an interpolation; polynomials of a higher degree amplify the rounding of the
/// samples.
pub const MAX_DEGREE: usize = 19;

/// Distances from the Earth's centre that are accepted, km: from 100 km above the equator.
const DISTANCE_KM: RangeInclusive<f64> = 6_478.0..=1e6;

/// State at an instant.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StateSample {
    /// Seconds since the epoch of the [`SampledStates`].
    pub time_s: f64,
    /// Position and velocity, geocentric, ICRS axes.
    pub state: State,
}

/// Interpolating polynomial.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Interpolation {
    /// Lagrange's: positions and velocities are interpolated independently, degree + 1 samples.
    Lagrange,
    /// Hermite's: positions through positions and velocities, velocities as its derivative, (degree + 1)/2
    /// samples (rounded up).
    Hermite,
}

/// Samples that one sequence of polynomials interpolates, for example a segment of an Orbit Ephemeris
/// Message.
#[derive(Debug, Clone, PartialEq)]
pub struct SampledSegment {
    /// Kind of the polynomial.
    pub interpolation: Interpolation,
    /// Degree of the polynomial, 1 to [`MAX_DEGREE`].
    pub degree: usize,
    /// First and last instant at which the segment applies, seconds since the epoch.
    pub usable_s: [f64; 2],
    /// Samples in order of time.
    pub samples: Vec<StateSample>,
}

impl SampledSegment {
    /// Number of samples of a polynomial, which is the smallest of a segment. A Hermite polynomial of even
    /// degree gets the next odd degree.
    fn window(&self) -> usize {
        match self.interpolation {
            Interpolation::Lagrange => self.degree + 1,
            Interpolation::Hermite => (self.degree + 1).div_ceil(2),
        }
    }

    fn check(&self, path: &str) -> Result<(), OutOfRange> {
        if !(1..=MAX_DEGREE).contains(&self.degree) {
            return Err(OutOfRange::new(
                format!("{path}.degree"),
                self.degree,
                format!("a degree of interpolation from 1 to {MAX_DEGREE}"),
            ));
        }
        if self.samples.len() < self.window() {
            return Err(OutOfRange::new(
                format!("{path}.samples"),
                self.samples.len(),
                format!("at least {} samples for an interpolation of degree {}", self.window(), self.degree),
            ));
        }
        for (index, sample) in self.samples.iter().enumerate() {
            let numbers = sample.state.position_km.iter().chain(sample.state.velocity_km_s.iter());
            if !numbers.chain([&sample.time_s]).all(|number| number.is_finite()) {
                let expected = "finite numbers";
                return Err(OutOfRange::new(format!("{path}.samples[{index}]"), "not finite", expected));
            }
            check_orbit(&format!("{path}.samples[{index}]"), &sample.state)?;
        }
        for (index, pair) in self.samples.windows(2).enumerate() {
            if let [before, after] = pair
                && after.time_s <= before.time_s
            {
                return Err(OutOfRange::new(
                    format!("{path}.samples[{}]", index + 1),
                    format!("{} s", after.time_s),
                    format!("a time after that of the preceding sample, {} s", before.time_s),
                ));
            }
        }
        let [start, end] = self.usable_s;
        let inside = |time_s: f64| {
            self.samples.first().is_some_and(|first| first.time_s <= time_s)
                && self.samples.last().is_some_and(|last| time_s <= last.time_s)
        };
        if start < end && inside(start) && inside(end) {
            return Ok(());
        }
        Err(OutOfRange::new(
            format!("{path}.usable_s"),
            format!("{start} to {end}"),
            "an interval between the first and the last sample",
        ))
    }

    /// Returns the state at an instant between the first and the last sample, in seconds since the epoch. The
    /// samples are as many as the polynomial needs, and ascend.
    pub fn state_at(&self, time_s: f64) -> State {
        let window = self.window();
        let first = first_node(&self.samples, window, time_s, |sample| sample.time_s);
        let samples = self.samples.get(first..first + window).unwrap_or_default();
        match self.interpolation {
            Interpolation::Lagrange => lagrange(samples, time_s),
            Interpolation::Hermite => hermite(samples, time_s),
        }
    }
}

/// Returns the index of the first of `count` nodes around `time_s`: half of them on either side, or for an
/// odd number the nearest node in the middle; at an end, the nodes of the end. The times of the nodes ascend.
pub fn first_node<T>(nodes: &[T], count: usize, time_s: f64, time_of: impl Fn(&T) -> f64) -> usize {
    let after = nodes.partition_point(|node| time_of(node) <= time_s);
    let neighbours = after.checked_sub(1).and_then(|before| Some((nodes.get(before)?, nodes.get(after)?)));
    let middle = match neighbours {
        // The nearer of the two neighbours, made the last node of the lower half.
        Some((before, next)) if count % 2 == 1 => {
            after + usize::from(time_of(next) - time_s < time_s - time_of(before))
        }
        _ => after,
    };
    middle.saturating_sub(count.div_ceil(2)).min(nodes.len().saturating_sub(count))
}

/// Largest speed at infinity of a hyperbola about the Earth, km/s.
const MAX_EXCESS_KM_S: f64 = 20.0;

/// Smallest semi-latus rectum of an orbit, km: below it the velocity is zero or along the position, and the
/// orbit has no plane.
const MIN_PARAMETER_KM: f64 = 10.0;

/// Checks that a state is that of an orbit about the Earth: a file in metres has other numbers, and a state
/// without velocity has no orbital plane.
fn check_orbit(path: &str, state: &State) -> Result<(), OutOfRange> {
    let distance_km = state.position_km.norm();
    if !DISTANCE_KM.contains(&distance_km) {
        let value = format!("{distance_km:.3} km from the Earth's centre");
        return Err(OutOfRange::new(path, value, "a distance of 6478 to 1e6 km"));
    }
    let value = format!("{:.6} km/s", state.velocity_km_s.norm());
    let energy = 0.5 * state.velocity_km_s.norm_squared() - EARTH_GM_KM3_S2 / distance_km;
    if energy > 0.5 * MAX_EXCESS_KM_S * MAX_EXCESS_KM_S {
        let expected = "a velocity of an orbit about the Earth, at most 20 km/s at infinity";
        return Err(OutOfRange::new(path, value, expected));
    }
    let momentum = state.position_km.cross(&state.velocity_km_s).norm_squared();
    if momentum < MIN_PARAMETER_KM * EARTH_GM_KM3_S2 {
        let expected = "a velocity of an orbit about the Earth, neither zero nor along the position";
        return Err(OutOfRange::new(path, value, expected));
    }
    Ok(())
}

/// Lagrange's polynomials of position and velocity.
fn lagrange(samples: &[StateSample], time_s: f64) -> State {
    let mut state = State { position_km: Vector3::zeros(), velocity_km_s: Vector3::zeros() };
    for (i, sample) in samples.iter().enumerate() {
        let mut weight = 1.0;
        for (j, other) in samples.iter().enumerate() {
            if i != j {
                weight *= (time_s - other.time_s) / (sample.time_s - other.time_s);
            }
        }
        state.position_km += sample.state.position_km * weight;
        state.velocity_km_s += sample.state.velocity_km_s * weight;
    }
    state
}

/// Hermite's polynomial of the position and its derivative. With the Lagrange weights lᵢ(t) of the samples
/// and their derivatives: Σ [1 − 2 (t − tᵢ) lᵢ'(tᵢ)] lᵢ² rᵢ + (t − tᵢ) lᵢ² vᵢ (Davis, *Interpolation and
/// Approximation*, 1963, Sec. 2.5).
fn hermite(samples: &[StateSample], time_s: f64) -> State {
    let mut state = State { position_km: Vector3::zeros(), velocity_km_s: Vector3::zeros() };
    for (i, sample) in samples.iter().enumerate() {
        let (mut weight, mut slope, mut slope_at_node) = (1.0, 0.0, 0.0);
        for (j, other) in samples.iter().enumerate() {
            if i != j {
                let width = sample.time_s - other.time_s;
                let factor = (time_s - other.time_s) / width;
                slope = slope * factor + weight / width;
                weight *= factor;
                slope_at_node += 1.0 / width;
            }
        }
        let offset_s = time_s - sample.time_s;
        let (square, square_slope) = (weight * weight, 2.0 * weight * slope);
        let (position, velocity) = (&sample.state.position_km, &sample.state.velocity_km_s);
        let value = 1.0 - 2.0 * offset_s * slope_at_node;
        state.position_km += position * (value * square) + velocity * (offset_s * square);
        state.velocity_km_s += position * (value * square_slope - 2.0 * slope_at_node * square)
            + velocity * (square + offset_s * square_slope);
    }
    state
}

/// Orbit of one spacecraft.
#[derive(Debug, Clone, PartialEq)]
pub struct SampledOrbit {
    segments: Vec<SampledSegment>,
}

impl SampledOrbit {
    /// Creates the orbit from segments in order of time. Where segments overlap, the later one applies.
    ///
    /// # Errors
    /// [`OutOfRange`] for a segment with too few samples, samples out of order, numbers that are not finite,
    /// a sample that is not of an orbit above 100 km, or a usable interval outside its samples; for
    /// segments out of order or with a gap between them. Paths begin with `segments[index]`.
    pub fn new(segments: Vec<SampledSegment>) -> Result<Self, OutOfRange> {
        if segments.is_empty() {
            return Err(OutOfRange::new("segments", "empty", "at least one segment"));
        }
        for (index, segment) in segments.iter().enumerate() {
            segment.check(&format!("segments[{index}]"))?;
        }
        for (index, pair) in segments.windows(2).enumerate() {
            let [before, after] = pair else { continue };
            let ([first, end], [start, last]) = (before.usable_s, after.usable_s);
            if start > end || start < first || last < end {
                return Err(OutOfRange::new(
                    format!("segments[{}].usable_s", index + 1),
                    format!("{start} to {last}"),
                    format!("an interval that continues the preceding one, {first} to {end}, without a gap"),
                ));
            }
        }
        Ok(Self { segments })
    }

    /// First and last instant, seconds since the epoch.
    fn coverage_s(&self) -> [f64; 2] {
        let (first, last) = (self.segments.first(), self.segments.last());
        [first.map_or(0.0, |segment| segment.usable_s[0]), last.map_or(0.0, |segment| segment.usable_s[1])]
    }

    /// Times at which a segment follows another, seconds since the epoch.
    fn borders_s(&self) -> Vec<f64> {
        self.segments.iter().skip(1).map(|segment| segment.usable_s[0]).collect()
    }

    /// State at any instant; outside the coverage the nearest state continues as a Keplerian orbit.
    fn state_at(&self, time_s: f64) -> State {
        let [start, end] = self.coverage_s();
        let inside = time_s.clamp(start, end);
        let begun = self.segments.partition_point(|segment| segment.usable_s[0] <= inside);
        let state = self.segments[begun.saturating_sub(1)].state_at(inside);
        if inside == time_s { state } else { with_secular_drift(state, time_s - inside) }
    }
}

/// Returns a state `seconds` later (earlier if negative) on its Keplerian orbit with secular drift; a state
/// without supported elements moves along a line.
pub(super) fn with_secular_drift(state: State, seconds: f64) -> State {
    match Elements::from_state(&state) {
        Some(elements) => elements.propagate(seconds).state(),
        None => State { position_km: state.position_km + state.velocity_km_s * seconds, ..state },
    }
}

/// Sampled orbits of chaser and target.
#[derive(Debug, Clone, PartialEq)]
pub struct SampledStates {
    epoch: Epoch,
    chaser: SampledOrbit,
    target: SampledOrbit,
}

impl SampledStates {
    /// Combines two orbits whose times count from `epoch`.
    ///
    /// # Errors
    /// [`OutOfRange`] if the two orbits have no time in common.
    pub fn new(epoch: Epoch, chaser: SampledOrbit, target: SampledOrbit) -> Result<Self, OutOfRange> {
        let ([chaser_start, chaser_end], [start, end]) = (chaser.coverage_s(), target.coverage_s());
        if chaser_start.max(start) >= chaser_end.min(end) {
            return Err(OutOfRange::new(
                "chaser",
                format!("{chaser_start} to {chaser_end} s"),
                format!("times in common with the target's, {start} to {end} s"),
            ));
        }
        Ok(Self { epoch, chaser, target })
    }

    /// Origin of the samples' times.
    pub fn epoch(&self) -> Epoch {
        self.epoch
    }

    /// Interval that both orbits cover, seconds since the epoch.
    pub fn coverage_s(&self) -> RangeInclusive<f64> {
        let ([chaser_start, chaser_end], [start, end]) = (self.chaser.coverage_s(), self.target.coverage_s());
        chaser_start.max(start)..=chaser_end.min(end)
    }

    /// Times at which segments of the chaser follow each other, seconds since the epoch.
    pub(super) fn chaser_borders_s(&self) -> Vec<f64> {
        self.chaser.borders_s()
    }

    /// Times at which segments of the target follow each other, seconds since the epoch.
    pub(super) fn target_borders_s(&self) -> Vec<f64> {
        self.target.borders_s()
    }

    /// States `time_s` seconds after the epoch; outside the coverage the nearest state continues as a
    /// Keplerian orbit.
    pub(super) fn states_at(&self, time_s: f64) -> States {
        States { time_s, chaser: self.chaser.state_at(time_s), target: self.target.state_at(time_s) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::clock::parse_utc;

    const ELEMENTS: Elements = Elements {
        semi_major_axis_km: 7130.0,
        eccentricity: 0.01,
        inclination_rad: 1.7,
        raan_rad: 2.0,
        argument_of_perigee_rad: 0.4,
        mean_anomaly_rad: 0.7,
    };

    /// Keplerian motion without drift, so that the velocity is the derivative of the position.
    fn kepler(time_s: f64) -> State {
        let mean_anomaly_rad = ELEMENTS.mean_anomaly_rad + ELEMENTS.mean_motion_rad_s() * time_s;
        Elements { mean_anomaly_rad, ..ELEMENTS }.state()
    }

    fn segment(interpolation: Interpolation, degree: usize, first: u32, last: u32) -> SampledSegment {
        let samples: Vec<StateSample> = (first..=last)
            .map(|k| f64::from(k) * 60.0)
            .map(|time_s| StateSample { time_s, state: kepler(time_s) })
            .collect();
        let usable_s = [samples[0].time_s, samples[samples.len() - 1].time_s];
        SampledSegment { interpolation, degree, usable_s, samples }
    }

    #[test]
    fn the_nodes_lie_around_the_time() {
        let times: Vec<f64> = (0..10).map(f64::from).collect();
        for (count, time, first) in [
            (4, 4.2, 3),
            (4, 4.0, 3),
            (4, 0.5, 0),
            (4, 9.0, 6),
            (4, 8.5, 6),
            (2, 4.2, 4),
            (2, 9.0, 8),
            (2, 0.0, 0),
            (3, 4.2, 3),
            (3, 4.7, 4),
            (10, 5.0, 0),
        ] {
            assert_eq!(first_node(&times, count, time, |time| *time), first, "{count} nodes at {time}");
        }
    }

    #[test]
    fn samples_are_met_and_the_motion_between_them_follows() {
        for (interpolation, degree, position_km, velocity_km_s) in [
            // Lagrange's error is |r⁽ⁿ⁺¹⁾| Π|t − tᵢ|/(n + 1)!: n = 7 inside, 60 s: 7130 (0.063)⁸ 6.5/40320 =
            // 3e-7 km, at the ends of a segment 50 times that. Hermite's of degree 7 has four nodes, squared.
            (Interpolation::Lagrange, 7, 2e-5, 2e-8),
            (Interpolation::Hermite, 7, 1e-6, 2e-7),
            (Interpolation::Hermite, 3, 1e-3, 1e-4),
        ] {
            let orbit = SampledOrbit::new(vec![segment(interpolation, degree, 0, 100)]).unwrap();
            for k in 0..600 {
                let time_s = f64::from(k) * 10.0;
                let (got, expected) = (orbit.state_at(time_s), kepler(time_s));
                let position = (got.position_km - expected.position_km).norm();
                let velocity = (got.velocity_km_s - expected.velocity_km_s).norm();
                assert!(
                    position < position_km && velocity < velocity_km_s,
                    "{time_s}: {position} {velocity}"
                );
                if k % 6 == 0 {
                    assert!(position < 1e-11 && velocity < 1e-14, "{time_s}: {position} {velocity}");
                }
            }
        }
    }

    #[test]
    fn hermite_of_degree_seven_takes_four_samples_and_lagrange_eight() {
        for (interpolation, degree, samples) in [
            (Interpolation::Hermite, 1, 1),
            (Interpolation::Hermite, 3, 2),
            (Interpolation::Hermite, 6, 4),
            (Interpolation::Hermite, 7, 4),
            (Interpolation::Lagrange, 7, 8),
        ] {
            assert_eq!(segment(interpolation, degree, 0, 40).window(), samples);
        }
    }

    #[test]
    fn the_later_of_two_segments_applies() {
        let mut later = segment(Interpolation::Lagrange, 5, 40, 80);
        for sample in &mut later.samples {
            sample.state.velocity_km_s.x += 1.0;
        }
        let orbit = SampledOrbit::new(vec![segment(Interpolation::Lagrange, 5, 0, 50), later]).unwrap();
        assert!((orbit.state_at(2399.0).velocity_km_s - kepler(2399.0).velocity_km_s).norm() < 1e-6);
        assert!((orbit.state_at(2400.0).velocity_km_s.x - kepler(2400.0).velocity_km_s.x - 1.0).abs() < 1e-6);
    }

    #[test]
    fn outside_the_coverage_the_orbit_continues() {
        let orbit = SampledOrbit::new(vec![segment(Interpolation::Hermite, 7, 0, 20)]).unwrap();
        for time_s in [-30.0, 1230.0] {
            // The secular drift is at most 1e-3 of the motion.
            let motion_km = 30.0 * 7.5;
            let error_km = (orbit.state_at(time_s).position_km - kepler(time_s).position_km).norm();
            assert!(error_km < 2e-3 * motion_km, "{error_km}");
        }
    }

    #[test]
    fn bad_samples_are_refused_by_their_index() {
        let refusal = |change: &dyn Fn(&mut SampledSegment)| {
            let mut segment = segment(Interpolation::Lagrange, 5, 0, 20);
            change(&mut segment);
            SampledOrbit::new(vec![segment]).unwrap_err().to_string()
        };
        assert!(refusal(&|s| s.samples[3].state.position_km.x = f64::NAN).contains("segments[0].samples[3]"));
        let refused = refusal(&|s| s.samples[2].state.position_km *= 1e3);
        assert!(
            refused.contains("segments[0].samples[2]") && refused.contains("6478 to 1e6 km"),
            "{refused}"
        );
        let refused = refusal(&|s| s.samples[2].state.velocity_km_s *= 1e3);
        assert!(
            refused.contains("segments[0].samples[2]") && refused.contains("an orbit about the Earth"),
            "{refused}"
        );
        let refused = refusal(&|s| s.samples[2].state.velocity_km_s *= 0.0);
        assert!(refused.contains("segments[0].samples[2]") && refused.contains("neither zero"), "{refused}");
        assert!(refusal(&|s| s.samples.swap(4, 5)).contains("segments[0].samples[5]"));
        assert!(refusal(&|s| s.samples.truncate(5)).contains("at least 6 samples"));
        assert!(refusal(&|s| s.degree = 0).contains("segments[0].degree"));
        assert!(refusal(&|s| s.usable_s[1] += 1.0).contains("segments[0].usable_s"));
        assert!(SampledOrbit::new(vec![]).is_err());
    }

    #[test]
    fn gaps_and_disorder_are_refused() {
        let make = |first, last| segment(Interpolation::Lagrange, 5, first, last);
        assert!(SampledOrbit::new(vec![make(0, 20), make(20, 40)]).is_ok());
        let gap = SampledOrbit::new(vec![make(0, 20), make(21, 40)]).unwrap_err().to_string();
        assert!(gap.contains("segments[1].usable_s") && gap.contains("gap"), "{gap}");
        assert!(SampledOrbit::new(vec![make(20, 40), make(0, 20)]).is_err());
        let (early, late) = (make(0, 20), make(30, 50));
        let orbit = |segment: SampledSegment| SampledOrbit::new(vec![segment]).unwrap();
        let epoch = parse_utc("2012-04-23T00:00:00Z").unwrap();
        assert!(SampledStates::new(epoch, orbit(early), orbit(late)).is_err());
    }
}
