//! Random approaches measured by the built-in pipeline.

use draws::{Effect, Seed, Stream, uniform};
use std::error::Error;
use std::path::Path;

use contract::PipelineFactory;
use contract::docking::{Digitiser, DockingSolution, Motion, MotionReport, PoseEstimate};
use pipeline::docking::{DockingConfig, DockingFactory};
use sim::SimError;
use sim::docking::{
    CameraConfig, DockingSimulation, DockingSimulator, LensConfig, LightingConfig, SunConfig,
};
use sim::television::{TelevisionConfig, VideoNoiseConfig};
use sim::truth::approach::{
    Approach, ApproachConfig, ApproachState, ConstantVelocityConfig, OscillationConfig, SegmentConfig,
    SegmentedConfig,
};

use crate::docking_random::in_field::{are_inside, corners};
use crate::docking_random::{camera, random_sun};

/// Name of the target.
const TARGET: &str = "progress";
/// Standard deviation of the lens's point-spread function, px.
const BLUR_PX: f64 = 0.7;
/// Number of fields in a portion, and fields per second.
pub const PORTION_FIELDS: u64 = 10;
const FIELD_RATE_HZ: f64 = 50.0;
/// Maximum lateral offset, as a fraction of d3; maximum angles, degrees.
const OFFSET: f64 = 0.03;
const ANGLE_DEG: f64 = 3.0;
/// Maximum lateral velocity, m/s; maximum angular rates, degrees per second.
const LATERAL_M_S: f64 = 0.03;
const RATE_DEG_S: f64 = 0.2;
/// Distance of the corners of marks and cross from the image border, at least, px.
const MARGIN_PX: f64 = 4.0;

/// Lens, and the range of d3 in which its approaches start, m.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Lens {
    /// Name in the tables.
    pub name: &'static str,
    focal_px: f64,
    start_m: (f64, f64),
}

impl Lens {
    /// The two lenses of the docking camera.
    pub const ALL: [Self; 2] = [
        Self { name: "narrow", focal_px: 2917.0, start_m: (4.0, 30.0) },
        Self { name: "wide", focal_px: 1055.0, start_m: (2.0, 10.0) },
    ];
}

/// Motion of the camera.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Course {
    /// d and φ linear in time.
    Steady,
    /// Glide with swings of up to 0.5 % of d3 and 0.3°, with periods of 5 to 20 s.
    Swinging,
}

/// Settings that all approaches share.
#[derive(Debug, Clone)]
pub struct Plan {
    /// Seed of all draws.
    pub seed: u64,
    /// Motion of the camera.
    pub course: Course,
    /// Portions per approach.
    pub portions: u64,
    /// Television chain.
    pub television: TelevisionConfig,
}

impl Plan {
    /// Plan with interlaced television whose only artefact is noise of a standard deviation in DN.
    pub fn noise_only(seed: u64, portions: u64, noise_dn: f64) -> Self {
        let noise = VideoNoiseConfig { sigma_dn8: noise_dn };
        let television = TelevisionConfig { noise, ..TelevisionConfig::default() };
        Self { seed, course: Course::Steady, portions, television }
    }

    fn fields(&self) -> u64 {
        self.portions * PORTION_FIELDS
    }

    fn duration_s(&self) -> f64 {
        (self.fields() - 1) as f64 / FIELD_RATE_HZ
    }
}

/// Report at the end of a portion, with the truth.
#[derive(Debug, Clone)]
pub struct Portion {
    /// Number of the portion in the approach, from 0.
    pub number: u64,
    /// Time since the previous report or the start, s.
    pub interval_s: f64,
    /// Ground truth at the time of the report.
    pub truth: ApproachState,
    /// Motion report of the pipeline.
    pub report: MotionReport,
}

impl Portion {
    /// Returns the motion by one of the estimators, if it has one.
    pub fn motion(&self, estimator: Estimator) -> Option<&Motion> {
        match estimator {
            Estimator::Exact => self.report.best.as_ref(),
            Estimator::Paper => self.report.paper.as_ref(),
        }
    }
}

/// Estimator of a motion.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Estimator {
    /// The least squares of the built-in pipeline.
    Exact,
    /// The formulas of the paper.
    Paper,
}

/// Measured approach.
#[derive(Debug, Clone)]
pub struct MeasuredApproach {
    /// Lens of the camera.
    pub lens: Lens,
    /// Measured portions in order.
    pub portions: Vec<Portion>,
    /// Fields that were measured, with their truth.
    pub fields: Vec<(ApproachState, PoseEstimate)>,
}

/// Simulates and measures the approach of a number: even numbers with the narrow lens, odd ones with the wide
/// lens.
pub fn simulate(plan: &Plan, number: u64) -> Result<MeasuredApproach, Box<dyn Error + Send + Sync>> {
    let lens = Lens::ALL[(number % 2) as usize];
    let (approach, sun) = draw(plan, &lens, number)?;
    let simulation = DockingSimulation {
        // The noise of a field is addressed by seed and field, so each approach has another seed.
        seed: (plan.seed << 32) ^ number,
        start_utc: "2004-01-31T13:04:00Z".to_owned(),
        target: TARGET.to_owned(),
        approach,
        cameras: vec![CameraConfig {
            name: "TV-1".to_owned(),
            until_range_m: 0.0,
            camera: camera(lens.focal_px),
        }],
        lens: LensConfig { blur_sigma_px: BLUR_PX },
        lighting: LightingConfig { sun: Some(sun), fill_radiance: 0.12, ..LightingConfig::default() },
        television: plan.television.clone(),
    };
    let simulator = DockingSimulator::new(&simulation, Path::new("."))?;
    let mut workspace = simulator.workspace()?;
    let mut pipeline = DockingFactory::new(DockingConfig::default())?.build(&simulator.setup())?;
    let mut digitiser = Digitiser::default();
    let mut approaches = MeasuredApproach { lens, portions: Vec::new(), fields: Vec::new() };
    let mut last_s = 0.0;
    for field in 0..plan.fields() {
        let exposure = simulator.expose(&mut workspace, field)?;
        let telemetry = exposure.telemetry(digitiser);
        let outcome = pipeline.process(&exposure.video.digitise(&digitiser), &telemetry);
        let truth = simulator.field_state(field)?.state;
        digitiser = outcome.digitiser.unwrap_or(digitiser);
        if let DockingSolution::Measured(measurement) = outcome.solution {
            approaches.fields.push((truth, measurement.best));
        }
        if let Some(report) = outcome.motion {
            let interval_s = telemetry.time_s - last_s;
            last_s = telemetry.time_s;
            approaches.portions.push(Portion { number: field / PORTION_FIELDS, interval_s, truth, report });
        }
    }
    Ok(approaches)
}

/// Draws course and Sun of an approach, again until marks and cross are in the field at the start, the middle
/// and the end.
fn draw(plan: &Plan, lens: &Lens, number: u64) -> Result<(ApproachConfig, SunConfig), SimError> {
    let mut stream = Seed { seed: plan.seed, case: 0 }.stream(number, Effect::AttitudeControl, 0);
    let target = sim::scene::docking::TargetFile::built_in(TARGET).ok_or(contract::OutOfRange::new(
        "target",
        TARGET,
        "a built-in one",
    ))?;
    let corners = corners(&target.model());
    let camera = camera(lens.focal_px);
    let approach = loop {
        let config = match plan.course {
            Course::Steady => steady(plan, lens, &mut stream),
            Course::Swinging => swinging(lens, &mut stream),
        };
        let Ok(approach) = Approach::new(&config, target.contact.camera_to_disk_m) else { continue };
        let is_in_field = |at_s: f64| are_inside(&camera, &approach.state_at(at_s).pose, &corners, MARGIN_PX);
        if [0.0, 0.5, 1.0].iter().all(|part| is_in_field(part * plan.duration_s())) {
            break config;
        }
    };
    Ok((approach, random_sun(&mut stream)))
}

fn within((low, high): (f64, f64), stream: &mut Stream) -> f64 {
    low + (high - low) * uniform(stream)
}

/// Draws d3 uniformly in its logarithm, to represent both near and far ranges.
fn start_m(lens: &Lens, stream: &mut Stream) -> f64 {
    let (near, far) = lens.start_m;
    near * libm::exp(libm::log(far / near) * uniform(stream))
}

const CLOSING_M_S: (f64, f64) = (0.05, 0.8);

fn steady(plan: &Plan, lens: &Lens, stream: &mut Stream) -> ApproachConfig {
    let d3 = start_m(lens, stream);
    let closing = within(CLOSING_M_S, stream);
    let mut symmetric = |size: f64| within((-size, size), stream);
    ApproachConfig::ConstantVelocity(ConstantVelocityConfig {
        position_m: [symmetric(OFFSET * d3), symmetric(OFFSET * d3), d3],
        velocity_m_s: [symmetric(LATERAL_M_S), symmetric(LATERAL_M_S), -closing],
        phi_deg: [0; 3].map(|_| symmetric(ANGLE_DEG)),
        phi_rate_deg_s: [0; 3].map(|_| symmetric(RATE_DEG_S)),
        duration_s: plan.duration_s(),
    })
}

fn swinging(lens: &Lens, stream: &mut Stream) -> ApproachConfig {
    let start_d3_m = start_m(lens, stream);
    let speed_m_s = within(CLOSING_M_S, stream);
    let offset = OFFSET * start_d3_m;
    let lateral_at_start_m = [0; 2].map(|_| within((-offset, offset), stream));
    let phi_deg = [0; 3].map(|_| within((-ANGLE_DEG, ANGLE_DEG), stream));
    let limit_cycle = OscillationConfig {
        lateral_amplitude_m: [0; 2].map(|_| within((0.0, 0.005 * start_d3_m), stream)),
        lateral_period_s: [0; 2].map(|_| within((5.0, 20.0), stream)),
        lateral_phase_deg: [0; 2].map(|_| within((0.0, 360.0), stream)),
        angular_amplitude_deg: [0; 3].map(|_| within((0.0, 0.3), stream)),
        angular_period_s: [0; 3].map(|_| within((5.0, 20.0), stream)),
        angular_phase_deg: [0; 3].map(|_| within((0.0, 360.0), stream)),
    };
    ApproachConfig::Segments(SegmentedConfig {
        start_d3_m,
        lateral_at_start_m,
        lateral_at_contact_m: [0.0; 2],
        phi_deg,
        ramp_s: 1.0,
        limit_cycle,
        segments: vec![SegmentConfig::Glide { to_d3_m: None, speed_m_s, end_speed_m_s: None }],
    })
}
