//! Random poses and Sun directions, and their frames.

use draws::{Effect, normal};
use std::error::Error;
use std::fmt::Write as _;
use std::fs;
use std::path::Path;

use contract::Camera;
use contract::docking::{Digitiser, DockingSetup, Field, Pose};
use nalgebra::Vector3;
use sim::SimError;
use sim::docking::DockingSimulator;
use sim::scene::docking::TargetFile;

use crate::bound::{self, Bound};
use boresight_research::docking_random::in_field::{are_inside, corners};
use boresight_research::docking_random::still::{Row, TARGET};
use boresight_research::docking_random::{camera, random_sun};

/// Maximum lateral offset, as a fraction of d3, and maximum angles, degrees.
const OFFSET: f64 = 0.03;
const ANGLE_DEG: f64 = 3.0;
/// Distance of the outermost corners of marks and cross from the image border, at least, px.
const MARGIN_PX: f64 = 1.0;
/// Error of the prior that OpenCV receives, as a fraction of the range, in a random direction.
const PRIOR: f64 = 0.01;

/// Rows of the table.
pub(crate) const ROWS: [Row; 5] = [
    Row::wide("wide-20m", 20.0),
    Row::wide("wide-5m", 5.0),
    Row::wide("wide-1m", 1.0),
    Row::narrow("narrow-20m", 20.0),
    Row::narrow("narrow-5m", 5.0),
];

/// One frame: a pose, a Sun direction, and independent noise.
#[derive(Debug, Clone)]
pub(crate) struct Case {
    number: u64,
    camera: Camera,
    pose: Pose,
    prior: Pose,
    simulator: DockingSimulator,
}

impl Case {
    /// Draws the pose with this number: d3 is the row's; lateral offsets and angles are uniform within their
    /// limits, drawn again until every mark and the cross are in the field; the Sun is uniform over the cap
    /// about the face's normal.
    pub(crate) fn random(row: &Row, seed: u64, number: u64, noise_dn: f64) -> Result<Self, SimError> {
        let mut stream = row.seed(seed).stream(number, Effect::AttitudeControl, 0);
        let camera = camera(row.focal_px);
        let target = TargetFile::built_in(TARGET).ok_or(contract::OutOfRange::new(
            "target",
            TARGET,
            "a built-in one",
        ))?;
        let corners = corners(&target.model());
        let pose = loop {
            let pose = row.random_pose(OFFSET, ANGLE_DEG, &mut stream);
            if are_inside(&camera, &pose, &corners, MARGIN_PX) {
                break pose;
            }
        };
        let sun = random_sun(&mut stream);
        let direction = Vector3::from_fn(|_, _| normal(&mut stream)).normalize();
        let prior = Pose { position_m: pose.position_m + PRIOR * row.range_m * direction, ..pose };
        let simulator = row.simulator(&camera, &pose, sun, noise_dn, (seed, number))?;
        Ok(Self { number, camera, pose, prior, simulator })
    }

    pub(crate) fn pose(&self) -> &Pose {
        &self.pose
    }

    /// Initial pose that OpenCV receives.
    pub(crate) fn prior(&self) -> &Pose {
        &self.prior
    }

    pub(crate) fn setup(&self) -> DockingSetup {
        self.simulator.setup()
    }

    /// Frame, progressive, as output by the frame grabber.
    pub(crate) fn field(&self) -> Result<Field, SimError> {
        let mut workspace = self.simulator.workspace()?;
        Ok(self.simulator.expose(&mut workspace, 0)?.video.digitise(&Digitiser::default()))
    }

    /// Cramér–Rao bounds of the pose.
    pub(crate) fn bounds(&self) -> Result<[Bound; 3], SimError> {
        let lighting = self.simulator.field_state(0)?.lighting;
        bound::bounds_of_pose(&self.camera, self.simulator.scene(), &lighting, &self.pose)
    }

    /// File name of the image in its directory.
    pub(crate) fn file(number: u64) -> String {
        format!("{number:04}.png")
    }
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
