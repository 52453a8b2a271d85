//! Tasks that can be timed.

use std::error::Error;
use std::hint::black_box;

use boresight::far_range::{FarRangeMission, FarRangeScenario};
use boresight::run::{ScenarioSource, WorldFrames as _};
use contract::{Frame, Outcome, Pipeline, Rotation, Setup, Telemetry};
use hifitime::{Epoch, Unit};
use pipeline::far_range::{FarRangeConfig, FarRangePipeline, Mode};
use sim::Simulator;
use sim::onboard::ShutterConfig;
use sim::scene::BackgroundConfig;
use sim::sensor::{SensorConfig, Switch};

use crate::plain::{COLUMNS, PlainScene, ROWS};

/// First timed frame of each day of ARGON, and the name of the day.
const DAYS: [(u64, &str); 5] =
    [(300, "day 1"), (1800, "day 2"), (5000, "day 3"), (9000, "day 4"), (14_000, "day 5")];
/// Number of frames of a day that are made in turn, and their spacing in frames. Frames differ in cost by a
/// factor of two and more, so every turn of a comparison must make the same frames.
const FRAMES_OF_A_DAY: u64 = 10;
const STEP: u64 = 20;
/// Number of frames kept for detection.
const KEPT: u64 = 8;

/// Number of ARGON frames kept for detection: after the last frame the pipeline starts anew.
const KEPT_OF_ARGON: u64 = 64;

type Step = Box<dyn FnMut() -> Result<Option<Outcome>, Box<dyn Error>>>;

/// Task that can be repeated.
pub(crate) struct Work {
    name: String,
    step: Step,
}

impl Work {
    /// Name of the task, one word.
    pub(crate) fn name(&self) -> &str {
        &self.name
    }

    /// Runs the task once, on the next frame.
    pub(crate) fn next(&mut self) -> Result<(), Box<dyn Error>> {
        black_box((self.step)()?);
        Ok(())
    }

    /// Runs the task once and returns the positions of the clusters that the pipeline found, px.
    pub(crate) fn clusters(&mut self) -> Result<Vec<[f64; 2]>, Box<dyn Error>> {
        let outcome = (self.step)()?.ok_or_else(|| format!("{} detects nothing", self.name))?;
        Ok(outcome.clusters.iter().map(|cluster| [cluster.position.x, cluster.position.y]).collect())
    }
}

/// Returns all tasks that can be timed.
pub(crate) fn works(scene: &PlainScene) -> Result<Vec<Work>, Box<dyn Error>> {
    let mut works = vec![plain("plain", scene)?, plain("plain-uneven", &scene.uneven())?];
    boresight::register_worlds();
    let source = ScenarioSource::read("argon")?;
    let scenario = source.typed::<FarRangeScenario>("frame_speed")?;
    let whole = FarRangeScenario { roi: None, ..scenario.clone() };
    let field = star_field(scenario);
    for (name, scenario) in
        [("field", &FarRangeScenario { roi: None, ..field.clone() }), ("field-regions", &field)]
    {
        works.push(frames(name.to_owned(), simulator(&source, scenario)?, 300)?);
    }
    let (regions, whole) = (simulator(&source, scenario)?, simulator(&source, &whole)?);
    for (first, day) in DAYS {
        let day = day.replace(' ', "-");
        works.push(frames(format!("argon-{day}"), regions, first)?);
        works.push(frames(format!("argon-{day}-whole"), whole, first)?);
    }
    let setup = FarRangeMission::new(&source)?.setup().clone();
    works.push(detection_plain(scene, &setup)?);
    let best = FarRangeConfig { mode: Mode::Best, ..scenario.far_range.clone() };
    for (images, simulator) in [("regions", regions), ("whole", whole)] {
        for (mode, config) in [("", &scenario.far_range), ("-best", &best)] {
            works.push(detection(&format!("process-argon{mode}-{images}"), simulator, config, &setup)?);
        }
    }
    Ok(works)
}

/// Creates a simulator that lives as long as the program, because its cameras borrow it.
fn simulator(
    source: &ScenarioSource,
    scenario: &FarRangeScenario,
) -> Result<&'static Simulator, Box<dyn Error>> {
    Ok(Box::leak(Box::new(boresight::far_range::simulator(source, scenario)?)))
}

/// Scenario with stars to V = 7 and the target with the camera of `argon`, on an uneven detector without
/// other defects.
fn star_field(argon: &FarRangeScenario) -> FarRangeScenario {
    let mut field = argon.clone();
    field.catalog.magnitude_limit = Some(7.0);
    field.solar_system = Switch::Off;
    field.shutter = ShutterConfig::Fixed { exposure_s: 0.25 };
    field.background = BackgroundConfig::default();
    field.sensor = SensorConfig {
        background_e_per_s: 40.0,
        hot_pixels: Default::default(),
        blooming: None,
        cosmic_rays: None,
        ..argon.sensor.clone()
    };
    field
}

/// Task: plain frames from a list of stars.
fn plain(name: &str, scene: &PlainScene) -> Result<Work, Box<dyn Error>> {
    let mut painter = scene.painter()?;
    let mut number = 0;
    let step = move || {
        number += 1;
        black_box(painter.frame(number)?);
        Ok(None)
    };
    Ok(Work { name: name.to_owned(), step: Box::new(step) })
}

/// Task: frames of a scenario with their truth and telemetry.
fn frames(name: String, simulator: &'static Simulator, first: u64) -> Result<Work, Box<dyn Error>> {
    let mut camera = simulator.camera()?;
    let mut number = 0;
    let step = move || {
        number += 1;
        black_box(camera.expose(first + STEP * (number % FRAMES_OF_A_DAY))?);
        Ok(None)
    };
    Ok(Work { name, step: Box::new(step) })
}

/// Task: the pipeline on kept frames, one after the other.
fn detecting(name: &str, mut pipeline: FarRangePipeline, kept: Vec<(Frame, Telemetry)>) -> Work {
    let mut next = 0;
    let step = move || {
        let (frame, telemetry) = &kept[next % kept.len()];
        next += 1;
        Ok(Some(pipeline.process(frame, telemetry)))
    };
    Work { name: name.to_owned(), step: Box::new(step) }
}

/// Task: the pipeline on whole plain frames. Without a star list it finds clusters and their centres, and
/// links them to those of the previous frame.
fn detection_plain(scene: &PlainScene, setup: &Setup) -> Result<Work, Box<dyn Error>> {
    let mut painter = scene.painter()?;
    let start = Epoch::from_gregorian_utc_at_midnight(2012, 4, 23);
    let kept = (0..KEPT)
        .map(|number| {
            let dn = painter.frame(number)?.to_vec();
            let telemetry = Telemetry {
                time: start + 15.0 * number as f64 * Unit::Second,
                exposure_s: 0.25,
                body_from_icrs: Rotation::identity(),
                velocity_km_s: None,
            };
            Ok((Frame::new(number, COLUMNS, ROWS, 12, dn, None)?, telemetry))
        })
        .collect::<Result<_, Box<dyn Error>>>()?;
    let setup = Setup { stars: Vec::new(), ..setup.clone() };
    Ok(detecting("process-plain", FarRangePipeline::new(FarRangeConfig::default(), &setup)?, kept))
}

/// Task: the pipeline on frames of ARGON, with its star list.
fn detection(
    name: &str,
    simulator: &'static Simulator,
    config: &FarRangeConfig,
    setup: &Setup,
) -> Result<Work, Box<dyn Error>> {
    let mut camera = simulator.camera()?;
    let kept = (0..KEPT_OF_ARGON)
        .map(|number| {
            let exposure = camera.expose(5000 + number)?;
            Ok((exposure.frame, exposure.telemetry))
        })
        .collect::<Result<_, Box<dyn Error>>>()?;
    Ok(detecting(name, FarRangePipeline::new(config.clone(), setup)?, kept))
}
