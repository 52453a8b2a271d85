//! Origin of the motion of chaser and target: the table `[trajectory]` of a far-range scenario.

use std::path::Path;
use std::sync::Arc;

use contract::OutOfRange;
use files::{Failure, FileError, FileLocation};
use flight_dynamics::{Coverage, Oem, OrbitEphemeris, Spk, Tle};
use hifitime::{Duration, Epoch};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use sim::truth::{
    Interpolation, NumericalConfig, SampledOrbit, SampledSegment, SampledStates, Schedule, StateSample,
    TrajectorySource, clock,
};

use crate::coverage::check_coverage;

/// Origin of the motion of chaser and target.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "kind", rename_all = "snake_case", deny_unknown_fields)]
pub enum TrajectoryConfig {
    /// Mean elements of `[orbit]`, which drift at secular rates due to the Earth's oblateness.
    MeanElements {},
    /// Orbits of `[orbit]`, whose elements are osculating at the epoch, integrated numerically.
    Numerical(NumericalConfig),
    /// Orbit ephemeris messages (CCSDS 502.0-B, KVN or XML), interpolated as they state. `[orbit]` has no
    /// effect.
    Oem {
        /// File of the chaser, relative to the scenario.
        chaser: String,
        /// File of the target, relative to the scenario.
        target: String,
    },
    /// Two-line elements, propagated by SGP4. `[orbit]` has no effect.
    Tle {
        /// File of the chaser, relative to the scenario.
        chaser: String,
        /// File of the target, relative to the scenario.
        target: String,
    },
    /// SPICE kernels of positions relative to the Earth. `[orbit]` has no effect.
    Spk {
        /// Kernel of the chaser, relative to the scenario.
        chaser: String,
        /// Kernel of the target, relative to the scenario; may be that of the chaser.
        target: String,
        /// NAIF's number of the chaser, −2147483648 to 2147483647; absent: that of the only body in its
        /// kernel.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        #[schemars(range(min = i32::MIN, max = i32::MAX))]
        chaser_id: Option<i32>,
        /// NAIF's number of the target, −2147483648 to 2147483647; absent: that of the only body in its
        /// kernel.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        #[schemars(range(min = i32::MIN, max = i32::MAX))]
        target_id: Option<i32>,
    },
}

/// Step of the samples of two-line elements and kernels, s. The remainder of a Lagrange polynomial of degree
/// 7 with such nodes is below 1e-9 km on a low orbit.
const STEP_S: f64 = 10.0;

/// Samples before the first and after the last frame, for the polynomials and for exposures at the ends.
const MARGIN: i64 = 12;

/// Largest number of samples of a spacecraft: four months.
const MAX_SAMPLES: i64 = 1 << 20;

impl Default for TrajectoryConfig {
    fn default() -> Self {
        Self::MeanElements {}
    }
}

impl TrajectoryConfig {
    /// Returns true for the default, which resolved scenarios omit.
    pub(crate) fn is_default(&self) -> bool {
        *self == Self::default()
    }

    /// Returns the paths of the files that the table names, with their roles.
    pub(crate) fn paths(&mut self) -> Vec<(&'static str, &mut String)> {
        match self {
            Self::MeanElements {} | Self::Numerical(_) => Vec::new(),
            Self::Oem { chaser, target }
            | Self::Tle { chaser, target }
            | Self::Spk { chaser, target, .. } => {
                vec![("trajectory.chaser", chaser), ("trajectory.target", target)]
            }
        }
    }

    /// Returns the origin of the motion for the simulator; reads the files that it names. Frames of
    /// `schedule` must lie within the time that the files cover.
    ///
    /// # Errors
    /// A [`Failure`] for a file that cannot be read, has a gap, or does not cover all frames.
    pub(crate) fn source(&self, schedule: Option<&Schedule>) -> Result<TrajectorySource, Failure> {
        let ends = schedule.and_then(Schedule::ends);
        let [chaser, target] = match self {
            Self::MeanElements {} => return Ok(TrajectorySource::MeanElements),
            Self::Numerical(config) => return Ok(TrajectorySource::Numerical(config.clone())),
            Self::Oem { chaser, target } => [chaser, target].map(|path| oem(Path::new(path), ends)),
            Self::Tle { chaser, target } => [chaser, target].map(|path| {
                let path = Path::new(path);
                sampled(path, &Tle::read(path)?.into(), ends)
            }),
            Self::Spk { chaser, target, chaser_id, target_id } => [(chaser, chaser_id), (target, target_id)]
                .map(|(path, id)| {
                    let path = Path::new(path);
                    sampled(path, &Spk::read(path, *id)?.into(), ends)
                }),
        };
        let (epoch, chaser) = chaser?;
        let (_, target) = target?;
        Ok(TrajectorySource::Sampled(Arc::new(SampledStates::new(epoch, chaser, target)?)))
    }
}

/// Origin of the samples' times: the first frame, or the start of the coverage without frames.
fn origin(ends: Option<[Epoch; 2]>, coverage: &[Coverage]) -> Epoch {
    match (ends, coverage.first()) {
        (Some([first, _]), _) => first,
        (None, Some(span)) => span.start,
        (None, None) => clock::from_tt_j2000_s(0.0),
    }
}

fn seconds(from: Epoch, to: Epoch) -> f64 {
    let nanoseconds = to.to_tai_duration().total_nanoseconds() - from.to_tai_duration().total_nanoseconds();
    nanoseconds as f64 / 1e9
}

/// Reads an orbit ephemeris message.
fn oem(path: &Path, ends: Option<[Epoch; 2]>) -> Result<(Epoch, SampledOrbit), Failure> {
    let oem = Oem::read(path)?;
    let coverage = oem.ephemeris().coverage();
    check_coverage(path, ends, &coverage)?;
    let epoch = origin(ends, &coverage);
    let segments = oem.segments.iter().map(|segment| {
        let stated = segment.interpolation.unwrap_or(flight_dynamics::Interpolation::ORBIT_DEFAULT);
        let samples: Vec<StateSample> = segment
            .icrs_states()
            .map(|(time, state)| StateSample { time_s: seconds(epoch, time), state })
            .collect();
        // The file's first and last state may lie within the span by the rounding of its times.
        let within = |time_s: f64| {
            let (first, last) = (samples.first(), samples.last());
            time_s.clamp(first.map_or(time_s, |s| s.time_s), last.map_or(time_s, |s| s.time_s))
        };
        SampledSegment {
            interpolation: match stated.method {
                flight_dynamics::Method::Hermite => Interpolation::Hermite,
                flight_dynamics::Method::Lagrange | flight_dynamics::Method::Linear => {
                    Interpolation::Lagrange
                }
            },
            degree: stated.degree,
            usable_s: [segment.coverage.start, segment.coverage.stop]
                .map(|time| within(seconds(epoch, time))),
            samples,
        }
    });
    let orbit = SampledOrbit::new(segments.collect()).map_err(|error| in_file(path, &error))?;
    Ok((epoch, orbit))
}

/// Samples an ephemeris from before the first to after the last frame, as far as it covers that.
fn sampled(
    path: &Path,
    ephemeris: &OrbitEphemeris,
    ends: Option<[Epoch; 2]>,
) -> Result<(Epoch, SampledOrbit), Failure> {
    let coverage = ephemeris.coverage();
    check_coverage(path, ends, &coverage)?;
    let epoch = origin(ends, &coverage);
    let refused = |field: &str, value: String, expected: String| {
        FileError::value(path, FileLocation::Whole, field, value, expected)
    };
    let (Some(start), Some(stop)) = (coverage.first(), coverage.last()) else {
        return Err(refused("covered time", "nothing".to_owned(), "a span of time".to_owned()).into());
    };
    let last_s = ends.map_or(0.0, |[first, last]| seconds(first, last));
    let steps = libm::ceil(last_s / STEP_S) as i64 + MARGIN;
    if steps > MAX_SAMPLES {
        let expected = format!("frames within {} s", MAX_SAMPLES as f64 * STEP_S);
        return Err(refused("length of the schedule", format!("{last_s} s"), expected).into());
    }
    let mut samples = Vec::new();
    let mut sample = |time: Epoch| -> Result<(), Failure> {
        let state = ephemeris.state_at(time).map_err(|error| {
            refused(
                "covered time",
                error.spans.clone(),
                format!("a state at {}", clock::format_utc(error.time)),
            )
        })?;
        samples.push(StateSample { time_s: seconds(epoch, time), state });
        Ok(())
    };
    let times = (-MARGIN..=steps)
        .map(|step| epoch + Duration::from_total_nanoseconds(i128::from(step) * 10_000_000_000));
    let inside: Vec<Epoch> = times.filter(|time| start.start < *time && *time < stop.stop).collect();
    // The ends of the coverage, where they are near.
    let near = Duration::from_seconds(STEP_S);
    if inside.first().is_none_or(|first| *first - start.start <= near) {
        sample(start.start)?;
    }
    for time in &inside {
        sample(*time)?;
    }
    if inside.last().is_none_or(|last| stop.stop - *last <= near) {
        sample(stop.stop)?;
    }
    let ends_s = [samples.first(), samples.last()].map(|sample| sample.map_or(0.0, |sample| sample.time_s));
    let segment =
        SampledSegment { interpolation: Interpolation::Lagrange, degree: 7, usable_s: ends_s, samples };
    let orbit = SampledOrbit::new(vec![segment]).map_err(|error| in_file(path, &error))?;
    Ok((epoch, orbit))
}

/// Returns the error of samples with the file that they are from.
fn in_file(path: &Path, error: &OutOfRange) -> Failure {
    FileError::value(path, FileLocation::Whole, error.path.clone(), &error.value, error.expected.clone())
        .into()
}

#[cfg(test)]
mod tests {
    use super::*;
    use sim::truth::{GroupConfig, Trajectory};

    fn golden(name: &str) -> String {
        format!("{}/../../golden/flight_dynamics/{name}", env!("CARGO_MANIFEST_DIR"))
    }

    fn schedule(start_utc: &str, count: u64) -> Schedule {
        let text = format!("name = \"a\"\nstart_utc = \"{start_utc}\"\ncadence_s = 7.0\ncount = {count}\n");
        Schedule::new(&[toml::from_str::<GroupConfig>(&text).unwrap()]).unwrap()
    }

    fn orbit() -> sim::truth::OrbitConfig {
        crate::run_file::parse::<crate::FarRangeScenario>(Path::new("argon.toml"), crate::BUILT_IN[0].text)
            .unwrap()
            .orbit
    }

    fn spk(name: &str) -> TrajectoryConfig {
        TrajectoryConfig::Spk {
            chaser: golden(name),
            target: golden(name),
            chaser_id: None,
            target_id: Some(-200),
        }
    }

    #[test]
    fn the_simulator_moves_as_the_file_states() {
        let (hermite, lagrange) = (golden("orekit-hermite.oem"), golden("orekit-lagrange.oem"));
        let [chaser, target] =
            [&hermite, &lagrange].map(|path| Oem::read(Path::new(path)).unwrap().ephemeris());
        let schedule = schedule("2012-04-23T01:02:29Z", 200);
        let config = TrajectoryConfig::Oem { chaser: hermite, target: lagrange };
        let source = config.source(Some(&schedule)).unwrap();
        let trajectory = Trajectory::from_source(&orbit(), &source, 1, &schedule).unwrap();
        for frame in 0..200 {
            let (_, time) = schedule.frame(frame).unwrap();
            let states = trajectory.states_at(time);
            for (state, ephemeris) in [(states.chaser, &chaser), (states.target, &target)] {
                let expected = ephemeris.state_at(time).unwrap();
                assert!((state.position_km - expected.position_km).norm() < 1e-10, "{frame}");
                assert!((state.velocity_km_s - expected.velocity_km_s).norm() < 1e-12, "{frame}");
            }
        }
    }

    #[test]
    fn samples_of_elements_and_kernels_are_dense_enough() {
        let tle = |name: &str| TrajectoryConfig::Tle { chaser: golden(name), target: golden(name) };
        for (config, ephemeris, start, count, position_km) in [
            // SGP4 is rounded to 0.1 mm, 1.7e-7 km in three axes.
            (
                tle("test.tle"),
                Tle::read(Path::new(&golden("test.tle"))).unwrap().into(),
                "2008-09-21T00:00:03Z",
                900,
                3e-7,
            ),
            (
                spk("spice-type13.bsp"),
                Spk::read(Path::new(&golden("spice-type13.bsp")), None).unwrap().into(),
                "2012-04-22T23:59:00Z",
                500,
                2e-6,
            ),
        ] {
            let ephemeris: OrbitEphemeris = ephemeris;
            let schedule = schedule(start, count);
            let source = config.source(Some(&schedule)).unwrap();
            let trajectory = Trajectory::from_source(&orbit(), &source, 1, &schedule).unwrap();
            let mut worst = 0.0_f64;
            for frame in 0..count {
                let (_, time) = schedule.frame(frame).unwrap();
                let expected = ephemeris.state_at(time).unwrap();
                worst =
                    worst.max((trajectory.states_at(time).chaser.position_km - expected.position_km).norm());
            }
            assert!(worst < position_km, "{start}: {worst:e}");
        }
    }

    #[test]
    fn frames_outside_the_covered_time_are_refused_with_file_and_span() {
        let file = golden("spice-type2.bsp");
        for (config, start, span) in [
            (spk("spice-type2.bsp"), "2012-04-23T05:00:00Z", "2012-04-22T23:58:53"),
            (spk("spice-type2.bsp"), "2012-04-22T20:00:00Z", "2012-04-22T23:58:53"),
        ] {
            let error = config.source(Some(&schedule(start, 10))).unwrap_err().to_string();
            assert!(error.starts_with(&format!("{file}: `covered time` is `{span}")), "{error}");
            assert!(error.contains(&format!("a span that contains all frames, {}", &start[..16])), "{error}");
        }
    }
}
