//! Origin of the motion of chaser and target: the table `[trajectory]` of a far-range scenario.

use std::path::Path;
use std::sync::Arc;

use contract::OutOfRange;
use files::{Failure, FileError, FileLocation};
use flight_dynamics::{Coverage, InitialState, Oem, OrbitEphemeris, Spk, Tle, check_samples};
use hifitime::{Duration, Epoch};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use sim::truth::{
    DragConfig, Interpolation, ManoeuvreErrorsConfig, ManoeuvreReportsConfig, NumericalConfig, OrbitConfig,
    PropagatedStates, RadiationConfig, SampledOrbit, SampledSegment, SampledStates, StateSample,
    TrajectorySource, clock,
};

use crate::scenario::coverage::{NeededTimes, check_coverage};

/// Origin of the motion of chaser and target.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "kind", rename_all = "snake_case", deny_unknown_fields)]
pub enum TrajectoryConfig {
    /// Mean elements of `[orbit]`, which drift at secular rates due to the Earth's oblateness.
    MeanElements {},
    /// Orbits of `[orbit]`, whose elements are osculating at the epoch, integrated numerically.
    Numerical(NumericalConfig),
    /// States of orbit parameter messages (CCSDS 502.0-B, KVN or XML), integrated numerically. The manoeuvres
    /// are those of the chaser's message; coefficients of drag and radiation pressure, areas and masses are
    /// those of both messages. There is no `[orbit]`.
    Opm {
        /// File of the chaser, relative to the scenario.
        chaser: String,
        /// File of the target, relative to the scenario; it has no manoeuvres.
        target: String,
        /// Forces. Its tables `drag` and `radiation`, if present, replace the values of the messages.
        #[serde(default)]
        forces: NumericalConfig,
        /// Errors of the executed manoeuvres; absent: they are executed as planned.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        execution: Option<ManoeuvreErrorsConfig>,
        /// Reports of the manoeuvres in the telemetry; absent: immediate and exact.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        reports: Option<ManoeuvreReportsConfig>,
    },
    /// Orbit ephemeris messages (CCSDS 502.0-B, KVN or XML), interpolated as they state. There is no
    /// `[orbit]`.
    Oem {
        /// File of the chaser, relative to the scenario.
        chaser: String,
        /// File of the target, relative to the scenario.
        target: String,
    },
    /// Two-line elements, propagated by SGP4. There is no `[orbit]`.
    Tle {
        /// File of the chaser, relative to the scenario.
        chaser: String,
        /// File of the target, relative to the scenario.
        target: String,
    },
    /// SPICE kernels of positions relative to the Earth. There is no `[orbit]`.
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

/// Samples before the first and after the last instant that is needed, for the polynomials.
const MARGIN: i64 = 12;

/// Largest number of samples of a spacecraft: four months.
const MAX_SAMPLES: i64 = 1 << 20;

impl Default for TrajectoryConfig {
    fn default() -> Self {
        Self::MeanElements {}
    }
}

impl TrajectoryConfig {
    /// Returns the paths of the files that the table names, with their roles.
    pub(crate) fn paths(&mut self) -> Vec<(&'static str, &mut String)> {
        match self {
            Self::MeanElements {} | Self::Numerical(_) => Vec::new(),
            Self::Opm { chaser, target, .. }
            | Self::Oem { chaser, target }
            | Self::Tle { chaser, target }
            | Self::Spk { chaser, target, .. } => {
                vec![("trajectory.chaser", chaser), ("trajectory.target", target)]
            }
        }
    }

    /// Word of the kind in a scenario.
    fn kind(&self) -> &'static str {
        match self {
            Self::MeanElements {} => "mean_elements",
            Self::Numerical(_) => "numerical",
            Self::Opm { .. } => "opm",
            Self::Oem { .. } => "oem",
            Self::Tle { .. } => "tle",
            Self::Spk { .. } => "spk",
        }
    }

    /// Checks that `[orbit]` is present where it gives the motion, and absent where files give it.
    ///
    /// # Errors
    /// [`OutOfRange`] for the table `orbit`.
    pub(crate) fn check_orbit(&self, orbit: Option<&OrbitConfig>) -> Result<(), OutOfRange> {
        let kind = self.kind();
        match (self, orbit) {
            (Self::MeanElements {} | Self::Numerical(_), None) => {
                let expected = format!("a table [orbit], the motion of trajectory.kind \"{kind}\"");
                Err(OutOfRange::new("orbit", "missing", expected))
            }
            (Self::Opm { .. } | Self::Oem { .. } | Self::Tle { .. } | Self::Spk { .. }, Some(_)) => {
                let mut expected =
                    format!("no table [orbit]: with trajectory.kind \"{kind}\" files give the motion");
                if matches!(self, Self::Opm { .. }) {
                    expected.push_str(
                        "; errors of manoeuvres are in [trajectory.execution] and [trajectory.reports]",
                    );
                }
                Err(OutOfRange::new("orbit", "present", expected))
            }
            _ => Ok(()),
        }
    }

    /// Returns the origin of the motion for the simulator; reads the files that it names, which must cover
    /// `needed`.
    ///
    /// # Errors
    /// A [`Failure`] for a missing or superfluous orbit, and for a file that cannot be read, has a gap, or
    /// does not cover the times.
    pub(crate) fn source(
        &self,
        orbit: Option<&OrbitConfig>,
        needed: Option<NeededTimes>,
    ) -> Result<TrajectorySource, Failure> {
        self.check_orbit(orbit)?;
        let with_orbit = |source: &dyn Fn(OrbitConfig) -> TrajectorySource| {
            let missing = || OutOfRange::new("orbit", "missing", "a table");
            Ok(source(orbit.cloned().ok_or_else(missing)?))
        };
        match self {
            Self::MeanElements {} => return with_orbit(&TrajectorySource::MeanElements),
            Self::Numerical(config) => {
                return with_orbit(&|orbit| TrajectorySource::Numerical(orbit, config.clone()));
            }
            Self::Opm { chaser, target, forces, execution, reports } => {
                let (execution, reports) = (execution.unwrap_or_default(), reports.unwrap_or_default());
                return propagated([chaser, target].map(Path::new), forces, execution, reports);
            }
            Self::Oem { .. } | Self::Tle { .. } | Self::Spk { .. } => {}
        }
        let mut orbits = self.sampled_orbits(needed)?.into_iter();
        let (Some(chaser), Some(target)) = (orbits.next(), orbits.next()) else {
            return Err(OutOfRange::new("trajectory", self.kind(), "a chaser and a target").into());
        };
        let states = SampledStates::new(chaser.epoch, chaser.orbit, target.orbit)
            .map_err(|error| error.under("trajectory"))?;
        Ok(TrajectorySource::Sampled(Arc::new(states)))
    }

    /// Returns remarks on unusual motion in the files, each with file and line; none for files with errors.
    pub(crate) fn remarks(&self, needed: Option<NeededTimes>) -> Vec<String> {
        let orbits = self.sampled_orbits(needed).unwrap_or_default();
        orbits.into_iter().flat_map(|orbit| orbit.remarks).collect()
    }

    /// Reads the orbits of chaser and target from the files that contain states; none for other kinds.
    fn sampled_orbits(&self, needed: Option<NeededTimes>) -> Result<Vec<OrbitFile>, Failure> {
        let orbits: Vec<Result<OrbitFile, Failure>> = match self {
            Self::MeanElements {} | Self::Numerical(_) | Self::Opm { .. } => Vec::new(),
            Self::Oem { chaser, target } => [chaser, target].map(|path| oem(Path::new(path), needed)).into(),
            Self::Tle { chaser, target } => [chaser, target]
                .map(|path| {
                    let path = Path::new(path);
                    sampled(path, &Tle::read(path)?.into(), needed)
                })
                .into(),
            Self::Spk { chaser, target, chaser_id, target_id } => [(chaser, chaser_id), (target, target_id)]
                .map(|(path, id)| {
                    let path = Path::new(path);
                    let spk = Spk::read(path, *id)?;
                    spk.check_no_gaps(path)?;
                    sampled(path, &spk.into(), needed)
                })
                .into(),
        };
        orbits.into_iter().collect()
    }
}

/// Orbit of one spacecraft from a file.
struct OrbitFile {
    /// Origin of the samples' times.
    epoch: Epoch,
    orbit: SampledOrbit,
    /// Remarks on unusual motion, each with file and line.
    remarks: Vec<String>,
}

/// Reads the orbit parameter messages of chaser and target.
fn propagated(
    paths: [&Path; 2],
    forces: &NumericalConfig,
    execution: ManoeuvreErrorsConfig,
    reports: ManoeuvreReportsConfig,
) -> Result<TrajectorySource, Failure> {
    let [chaser_path, target_path] = paths;
    let (chaser, target) = (InitialState::read(chaser_path)?, InitialState::read(target_path)?);
    target.check_no_manoeuvres(target_path)?;
    let both = |field: &str, table: &str, chaser: Option<f64>, target: Option<f64>| {
        let (path, other) = match (chaser, target) {
            (None, None) => return Ok(None),
            (Some(chaser), Some(target)) => return Ok(Some((chaser, target))),
            (None, Some(_)) => (chaser_path, target_path),
            (Some(_), None) => (target_path, chaser_path),
        };
        let expected = format!(
            "a value, as in {}; or [trajectory.forces.{table}] in the scenario, for both spacecraft",
            other.display()
        );
        Err(Failure::from(FileError::value(path, FileLocation::Whole, field, "missing", expected)))
    };
    let mut forces = forces.clone();
    if forces.drag.is_none()
        && let Some((chaser_m2_kg, target_m2_kg)) =
            both("DRAG_COEFF", "drag", chaser.drag_m2_kg, target.drag_m2_kg)?
    {
        forces.drag = Some(DragConfig { chaser_m2_kg, target_m2_kg, ..DragConfig::default() });
    }
    if forces.radiation.is_none()
        && let Some((chaser_m2_kg, target_m2_kg)) =
            both("SOLAR_RAD_COEFF", "radiation", chaser.radiation_m2_kg, target.radiation_m2_kg)?
    {
        forces.radiation = Some(RadiationConfig { chaser_m2_kg, target_m2_kg });
    }
    let states = PropagatedStates {
        chaser: (chaser.time, chaser.state),
        target: (target.time, target.state),
        manoeuvres: chaser.manoeuvres,
        execution,
        reports,
    };
    Ok(TrajectorySource::Propagated(Arc::new(states), forces))
}

/// Origin of the samples' times: the first frame, or the start of the coverage without frames.
fn origin(needed: Option<NeededTimes>, coverage: &[Coverage]) -> Epoch {
    match (needed, coverage.first()) {
        (Some(needed), _) => needed.frames[0],
        (None, Some(span)) => span.start,
        (None, None) => clock::from_tt_j2000_s(0.0),
    }
}

fn seconds(from: Epoch, to: Epoch) -> f64 {
    let nanoseconds = to.to_tai_duration().total_nanoseconds() - from.to_tai_duration().total_nanoseconds();
    nanoseconds as f64 / 1e9
}

/// Reads an orbit ephemeris message.
fn oem(path: &Path, needed: Option<NeededTimes>) -> Result<OrbitFile, Failure> {
    let (oem, remarks) = Oem::read_motion(path)?;
    let coverage = oem.ephemeris().coverage();
    check_coverage(path, needed, &coverage)?;
    let epoch = origin(needed, &coverage);
    let segments = oem.segments.iter().map(|segment| segment.sampled_since(epoch));
    let orbit = SampledOrbit::new(segments.collect()).map_err(|error| in_file(path, &error))?;
    Ok(OrbitFile { epoch, orbit, remarks })
}

/// Samples an ephemeris from before the first to after the last frame, as far as it covers that.
fn sampled(
    path: &Path,
    ephemeris: &OrbitEphemeris,
    needed: Option<NeededTimes>,
) -> Result<OrbitFile, Failure> {
    let coverage = ephemeris.coverage();
    check_coverage(path, needed, &coverage)?;
    let epoch = origin(needed, &coverage);
    let refused = |field: &str, value: String, expected: String| {
        FileError::value(path, FileLocation::Whole, field, value, expected)
    };
    let (Some(start), Some(stop)) = (coverage.first(), coverage.last()) else {
        return Err(refused("covered time", "nothing".to_owned(), "a span of time".to_owned()).into());
    };
    let last_s = needed.map_or(0.0, |NeededTimes { frames: [first, last], .. }| seconds(first, last));
    let [before_s, after_s] = needed.map_or([0.0; 2], |needed| needed.reach.seconds());
    let steps_before = libm::ceil(before_s / STEP_S) as i64 + MARGIN;
    let steps = libm::ceil((last_s + after_s) / STEP_S) as i64 + MARGIN;
    if steps.saturating_add(steps_before) > MAX_SAMPLES {
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
    let times = (-steps_before..=steps)
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
    let remarks = check_samples(path, epoch, segment.clone())?;
    let orbit = SampledOrbit::new(vec![segment]).map_err(|error| in_file(path, &error))?;
    Ok(OrbitFile { epoch, orbit, remarks })
}

/// Returns the error of samples with the file that they are from.
fn in_file(path: &Path, error: &OutOfRange) -> Failure {
    FileError::value(path, FileLocation::Whole, error.path.clone(), &error.value, error.expected.clone())
        .into()
}

#[cfg(test)]
mod tests {
    use super::*;
    use sim::onboard::ShutterConfig;
    use sim::truth::{GroupConfig, Schedule, Trajectory};

    use crate::scenario::coverage::Reach;

    fn golden(name: &str) -> String {
        format!("{}/../../golden/flight_dynamics/{name}", env!("CARGO_MANIFEST_DIR"))
    }

    fn schedule(start_utc: &str, count: u64) -> Schedule {
        let text = format!("name = \"a\"\nstart_utc = \"{start_utc}\"\ncadence_s = 7.0\ncount = {count}\n");
        Schedule::new(&[toml::from_str::<GroupConfig>(&text).unwrap()]).unwrap()
    }

    fn needed(schedule: &Schedule) -> Option<NeededTimes> {
        let scenario = scenario::run_file::parse::<crate::FarRangeScenario>(
            Path::new("argon.toml"),
            scenario::built_in("argon").unwrap().text,
        )
        .unwrap();
        let shutter = ShutterConfig::Fixed { exposure_s: 0.5 };
        NeededTimes::of_schedule(schedule, Reach::new(&shutter, &scenario.sensor, &scenario.knowledge))
    }

    fn source(config: &TrajectoryConfig, schedule: &Schedule) -> Result<TrajectorySource, Failure> {
        config.source(None, needed(schedule))
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
        let schedule = schedule("2012-04-23T01:02:30Z", 200);
        let config = TrajectoryConfig::Oem { chaser: hermite, target: lagrange };
        let source = source(&config, &schedule).unwrap();
        let trajectory = Trajectory::from_source(&source, 1, &schedule).unwrap();
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
            let source = source(&config, &schedule).unwrap();
            let trajectory = Trajectory::from_source(&source, 1, &schedule).unwrap();
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
            let error = source(&config, &schedule(start, 10)).unwrap_err().to_string();
            assert!(error.starts_with(&format!("{file}: `covered time` is `{span}")), "{error}");
            // A quarter of a second before the frame.
            let begin = start.replace(":00:00Z", ":59:59.75");
            let begin = begin.replace("T05:", "T04:").replace("T20:", "T19:");
            assert!(error.contains(&format!("a span that contains {begin}")), "{error}");
        }
    }

    const EPOCH_UTC: &str = "2012-04-23T00:00:00Z";

    /// Forces of `argon-numerical`, and its orbit with one burn.
    fn numerical() -> (OrbitConfig, NumericalConfig) {
        let text = scenario::built_in("argon-numerical").unwrap().text;
        let scenario =
            scenario::run_file::parse::<crate::FarRangeScenario>(Path::new("argon-numerical.toml"), text)
                .unwrap();
        let TrajectoryConfig::Numerical(forces) = scenario.trajectory else { panic!("not numerical") };
        let mut orbit = scenario.orbit.unwrap();
        orbit.manoeuvres.truncate(1);
        (OrbitConfig { execution: None, reports: None, ..orbit }, forces)
    }

    /// Orbit parameter message of a state at [`EPOCH_UTC`].
    fn opm(state: &sim::truth::State, ballistic: &str, manoeuvre: &str) -> String {
        let [x, y, z]: [f64; 3] = state.position_km.into();
        let [vx, vy, vz]: [f64; 3] = state.velocity_km_s.into();
        format!(
            "CCSDS_OPM_VERS = 2.0\nCREATION_DATE = 2012-04-22T00:00:00\nORIGINATOR = TEST\nOBJECT_NAME = A\n\
             OBJECT_ID = 2010-028B\nCENTER_NAME = EARTH\nREF_FRAME = ICRF\nTIME_SYSTEM = UTC\n\
             EPOCH = 2012-04-23T00:00:00\nX = {x}\nY = {y}\nZ = {z}\nX_DOT = {vx}\nY_DOT = {vy}\n\
             Z_DOT = {vz}\n{ballistic}{manoeuvre}"
        )
    }

    /// Coefficients of mass 100 kg: Cd A/m and Cr A/m in m²/kg.
    fn ballistic(drag_m2_kg: f64, radiation_m2_kg: f64) -> String {
        format!(
            "MASS = 100.0\nSOLAR_RAD_AREA = {}\nSOLAR_RAD_COEFF = 1.25\nDRAG_AREA = {}\nDRAG_COEFF = 2.5\n",
            radiation_m2_kg * 80.0,
            drag_m2_kg * 40.0
        )
    }

    const BURN: &str = "MAN_EPOCH_IGNITION = 2012-04-23T08:44:50\nMAN_DURATION = 10.0\nMAN_DELTA_MASS = -0.1\n\
                        MAN_REF_FRAME = RTN\nMAN_DV_1 = 0.0\nMAN_DV_2 = -0.00001352\nMAN_DV_3 = 0.0\n";

    fn messages(
        folder: &tempfile::TempDir,
        forces: NumericalConfig,
        chaser: &str,
        target: &str,
    ) -> TrajectoryConfig {
        let write = |name: &str, text: &str| {
            let path = folder.path().join(name);
            std::fs::write(&path, text).unwrap();
            path.display().to_string()
        };
        TrajectoryConfig::Opm {
            chaser: write("chaser.opm", chaser),
            target: write("target.opm", target),
            forces,
            execution: None,
            reports: None,
        }
    }

    #[test]
    fn a_message_leads_to_the_orbit_of_the_elements_whose_state_it_has() {
        let (orbit, forces) = numerical();
        let schedule = schedule("2012-04-23T07:00:00Z", 1200);
        let by_elements = TrajectorySource::Numerical(orbit, forces.clone());
        let expected = Trajectory::from_source(&by_elements, 1, &schedule).unwrap();
        let start = expected.states_at(clock::parse_utc(EPOCH_UTC).unwrap());
        let (drag, radiation) = (forces.drag.unwrap(), forces.radiation.unwrap());
        let of_messages = NumericalConfig { drag: None, radiation: None, ..forces.clone() };
        let folder = tempfile::tempdir().unwrap();
        let config = messages(
            &folder,
            of_messages,
            &opm(&start.chaser, &ballistic(drag.chaser_m2_kg, radiation.chaser_m2_kg), BURN),
            &opm(&start.target, &ballistic(drag.target_m2_kg, radiation.target_m2_kg), ""),
        );
        let got = Trajectory::from_source(&source(&config, &schedule).unwrap(), 1, &schedule).unwrap();
        let last = schedule.frame(1199).unwrap().1;
        let (a, b) = (got.states_at(last), expected.states_at(last));
        // Coefficients differ by their rounding only.
        for (a, b) in [(a.chaser, b.chaser), (a.target, b.target)] {
            assert!(
                (a.position_km - b.position_km).norm() < 1e-9,
                "{}",
                (a.position_km - b.position_km).norm()
            );
        }
        let [of_message, of_elements] = [&got, &expected].map(|trajectory| trajectory.manoeuvres()[0]);
        assert_eq!(of_message.ends(), of_elements.ends());
        let difference = of_message.planned_dv_rtn_m_s[1] - of_elements.planned_dv_rtn_m_s[1];
        assert!(difference.abs() < 1e-15, "{difference:e}");
        // Without drag and radiation the orbits differ by metres.
        let bare = messages(
            &folder,
            NumericalConfig::default(),
            &opm(&start.chaser, "", BURN),
            &opm(&start.target, "", ""),
        );
        let bare = Trajectory::from_source(&source(&bare, &schedule).unwrap(), 1, &schedule).unwrap();
        assert!((bare.states_at(last).chaser.position_km - b.chaser.position_km).norm() > 1e-3);
    }

    #[test]
    fn a_message_that_cannot_be_integrated_is_refused_with_file_and_field() {
        let (orbit, forces) = numerical();
        let schedule = schedule("2012-04-23T00:10:00Z", 10);
        let start = Trajectory::new(&OrbitConfig { manoeuvres: Vec::new(), ..orbit }).unwrap();
        let state = start.states_at(clock::parse_utc(EPOCH_UTC).unwrap()).chaser;
        let folder = tempfile::tempdir().unwrap();
        let forces = NumericalConfig { drag: None, radiation: None, ..forces };
        let good = opm(&state, "", "");
        let whole = ballistic(0.01, 0.01);
        let early = BURN.replace("2012-04-23T08:44:50", "2012-04-22T08:44:50");
        let fast = sim::truth::State { velocity_km_s: state.velocity_km_s * 2.0, ..state };
        let low = sim::truth::State { position_km: state.position_km * 0.5, ..state };
        for (chaser, target, parts) in [
            (opm(&state, "", &early), good.clone(), ["chaser.opm", "line 16", "MAN_EPOCH_IGNITION"]),
            (
                opm(&state, "", &format!("{BURN}{BURN}")),
                good.clone(),
                ["chaser.opm", "line 23", "the end of the manoeuvre"],
            ),
            (
                opm(&state, "", &BURN.replace("10.0", "-1.0")),
                good.clone(),
                ["chaser.opm", "line 17", "MAN_DURATION"],
            ),
            (
                opm(&state, "", &BURN.replace("-0.00001352", "0.2")),
                good.clone(),
                ["chaser.opm", "line 21", "MAN_DV_2"],
            ),
            (good.clone(), opm(&state, "", BURN), ["target.opm", "number of manoeuvres", "only the chaser"]),
            (
                opm(&state, &whole.replace("MASS = 100.0\n", ""), ""),
                good.clone(),
                ["chaser.opm", "line 16", "MASS"],
            ),
            (
                opm(&state, &whole.replace("MASS = 100.0", "MASS = 0"), ""),
                good.clone(),
                ["chaser.opm", "line 16", "MASS"],
            ),
            (
                opm(&state, &whole.replace("DRAG_COEFF = 2.5\n", ""), ""),
                good.clone(),
                ["chaser.opm", "DRAG_COEFF", "DRAG_AREA"],
            ),
            (opm(&state, &whole, ""), good.clone(), ["target.opm", "DRAG_COEFF", "[trajectory.forces.drag]"]),
            (opm(&fast, "", ""), good.clone(), ["chaser.opm", "line 9", "bound orbit"]),
            (good.clone(), opm(&low, "", ""), ["target.opm", "line 9", "distance"]),
        ] {
            let config = messages(&folder, forces.clone(), &chaser, &target);
            let message = source(&config, &schedule).unwrap_err().to_string();
            assert!(parts.iter().all(|part| message.contains(part)), "{parts:?}: {message}");
        }
        // The scenario may state values that the messages lack.
        let (_, complete) = numerical();
        assert!(source(&messages(&folder, complete, &opm(&state, &whole, ""), &good), &schedule).is_ok());
    }

    #[test]
    fn an_orbit_is_needed_or_superfluous() {
        let (orbit, forces) = numerical();
        for config in [TrajectoryConfig::MeanElements {}, TrajectoryConfig::Numerical(forces)] {
            let message = config.check_orbit(None).unwrap_err().to_string();
            assert!(message.contains("orbit is missing") && message.contains(config.kind()), "{message}");
            config.check_orbit(Some(&orbit)).unwrap();
        }
        let message = spk("spice-type2.bsp").check_orbit(Some(&orbit)).unwrap_err().to_string();
        assert!(message.contains("no table [orbit]") && message.contains("\"spk\""), "{message}");
        spk("spice-type2.bsp").check_orbit(None).unwrap();
    }
}
