//! Random poses and suns, and their frames.

use std::error::Error;
use std::fmt::Write as _;
use std::fs;
use std::path::Path;

use contract::Camera;
use contract::docking::{Digitiser, DockingSetup, Field, Pose};
use nalgebra::Vector3;
use sim::SimError;
use sim::docking::{
    CameraConfig, DockingSimulation, DockingSimulator, LensConfig, LightingConfig, SunConfig,
};
use sim::randomness::{Effect, Seed, Stream, normal, uniform};
use sim::scene::docking::TargetFile;
use sim::television::{Interlace, TelevisionConfig, VideoNoiseConfig};
use sim::truth::approach::{ApproachConfig, ConstantVelocityConfig};

use crate::bound::{self, Bound};
use crate::docking_random::{camera, random_sun};
use crate::in_field::{are_inside, corners};

/// The target.
const TARGET: &str = "progress";
/// Standard deviation of the video noise, DN.
pub(crate) const NOISE_DN: f64 = 2.0;
/// Standard deviation of the lens's point spread, px.
pub(crate) const BLUR_PX: f64 = 0.7;
/// Lateral offset at most, as a part of d3, and angles at most, degrees.
const OFFSET: f64 = 0.03;
const ANGLE_DEG: f64 = 3.0;
/// How far the outermost corners of marks and cross stay from the border, px.
const MARGIN_PX: f64 = 1.0;
/// Error of the prior that OpenCV is given, as a part of the range, a direction at random.
const PRIOR: f64 = 0.01;

/// A row of the table.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Row {
    pub(crate) name: &'static str,
    focal_px: f64,
    range_m: f64,
}

impl Row {
    pub(crate) const ALL: [Self; 5] = [
        Self { name: "wide-20m", focal_px: 1055.0, range_m: 20.0 },
        Self { name: "wide-5m", focal_px: 1055.0, range_m: 5.0 },
        Self { name: "wide-1m", focal_px: 1055.0, range_m: 1.0 },
        Self { name: "narrow-20m", focal_px: 2917.0, range_m: 20.0 },
        Self { name: "narrow-5m", focal_px: 2917.0, range_m: 5.0 },
    ];
}

/// One frame: a pose, a Sun, noise of its own.
#[derive(Debug, Clone)]
pub(crate) struct Case {
    number: u64,
    camera: Camera,
    pose: Pose,
    prior: Pose,
    simulator: DockingSimulator,
}

impl Case {
    /// The pose of this number: d3 is the row's, lateral offsets and angles uniform within their limits, drawn again until
    /// every mark and the cross are in the field; the Sun uniform over the cap about the face's normal.
    pub(crate) fn random(row: &Row, seed: u64, number: u64, noise_dn: f64) -> Result<Self, SimError> {
        let case = Seed { seed, case: row.focal_px as u64 * 1000 + row.range_m as u64 };
        let mut stream = case.stream(number, Effect::AttitudeControl, 0);
        let camera = camera(row.focal_px);
        let target = TargetFile::built_in(TARGET).ok_or(SimError::Parameter {
            field: "target",
            value: TARGET.to_owned(),
            expected: "a built-in one",
        })?;
        let corners = corners(&target.model());
        let pose = loop {
            let symmetric = |stream: &mut Stream| 2.0 * uniform(stream) - 1.0;
            let d = row.range_m;
            let position_m =
                Vector3::new(OFFSET * d * symmetric(&mut stream), OFFSET * d * symmetric(&mut stream), d);
            let phi_rad = Vector3::from_fn(|_, _| ANGLE_DEG.to_radians() * symmetric(&mut stream));
            let pose = Pose { position_m, phi_rad };
            if are_inside(&camera, &pose, &corners, MARGIN_PX) {
                break pose;
            }
        };
        let sun = random_sun(&mut stream);
        let direction = Vector3::from_fn(|_, _| normal(&mut stream)).normalize();
        let prior = Pose { position_m: pose.position_m + PRIOR * row.range_m * direction, ..pose };
        // The noise of a field is addressed by seed and number of the field, which is 0 in every case: so seeds differ.
        let noise_seed = (seed << 32) ^ (case.case << 16) ^ number;
        let simulator = simulator(row, &camera, &pose, sun, noise_dn, noise_seed)?;
        Ok(Self { number, camera, pose, prior, simulator })
    }

    pub(crate) fn pose(&self) -> &Pose {
        &self.pose
    }

    /// The pose that OpenCV is given to begin with.
    pub(crate) fn prior(&self) -> &Pose {
        &self.prior
    }

    pub(crate) fn setup(&self) -> DockingSetup {
        self.simulator.setup()
    }

    /// The frame, progressive, as the frame grabber gives it.
    pub(crate) fn field(&self) -> Result<Field, SimError> {
        let mut workspace = self.simulator.workspace()?;
        Ok(self.simulator.expose(&mut workspace, 0)?.video.digitise(&Digitiser::default()))
    }

    /// The Cramér–Rao bounds of its pose.
    pub(crate) fn bounds(&self) -> Result<[Bound; 3], SimError> {
        let lighting = self.simulator.moment(0)?.lighting;
        bound::of(&self.camera, self.simulator.scene(), &lighting, &self.pose)
    }

    /// The image's file in its folder.
    pub(crate) fn file(number: u64) -> String {
        format!("{number:04}.png")
    }
}

/// A single progressive field of a pose: blur and noise, and nothing else.
fn simulator(
    row: &Row,
    camera: &Camera,
    pose: &Pose,
    sun: SunConfig,
    noise_dn: f64,
    seed: u64,
) -> Result<DockingSimulator, SimError> {
    let simulation = DockingSimulation {
        seed,
        start_utc: "2004-01-31T13:04:00Z".to_owned(),
        target: TARGET.to_owned(),
        approach: ApproachConfig::ConstantVelocity(ConstantVelocityConfig {
            position_m: pose.position_m.into(),
            velocity_m_s: [0.0; 3],
            phi_deg: pose.phi_rad.map(f64::to_degrees).into(),
            phi_rate_deg_s: [0.0; 3],
            duration_s: 0.0,
        }),
        cameras: vec![CameraConfig {
            name: if row.focal_px > 2000.0 { "TV-1" } else { "TV-2" }.to_owned(),
            until_range_m: 0.0,
            camera: camera.clone(),
        }],
        lens: LensConfig { blur_sigma_px: BLUR_PX },
        lighting: LightingConfig { sun: Some(sun), fill_radiance: 0.12, ..LightingConfig::default() },
        television: TelevisionConfig {
            interlace: Interlace::Off,
            noise: VideoNoiseConfig { sigma_dn8: noise_dn },
            ..TelevisionConfig::default()
        },
    };
    DockingSimulator::new(&simulation, Path::new("."))
}

/// Writes `poses.csv` (truth and prior) and `setup.json` (camera and target) for the script.
pub(crate) fn write_tables(folder: &Path, cases: &[Case]) -> Result<(), Box<dyn Error>> {
    let mut poses = String::from("frame,file");
    for of in ["", "prior_"] {
        for name in ["d1_m", "d2_m", "d3_m", "phi1_rad", "phi2_rad", "phi3_rad"] {
            write!(poses, ",{of}{name}")?;
        }
    }
    for case in cases {
        write!(poses, "\n{},{}", case.number, Case::file(case.number))?;
        for pose in [&case.pose, &case.prior] {
            for value in pose.position_m.iter().chain(&pose.phi_rad) {
                write!(poses, ",{value:?}")?;
            }
        }
    }
    poses.push('\n');
    fs::write(folder.join("poses.csv"), poses)?;
    if let Some(case) = cases.first() {
        let setup = case.setup();
        let (fx, fy) = case.camera.focal_length_px();
        let text = serde_json::json!({
            "focal_px": [fx, fy],
            "principal_px": [case.camera.principal_x_px, case.camera.principal_y_px],
            "target": setup.target,
        });
        fs::write(folder.join("setup.json"), format!("{text:#}\n"))?;
    }
    Ok(())
}
