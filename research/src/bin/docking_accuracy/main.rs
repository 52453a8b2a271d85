//! Measures the accuracy of the pose: the built-in pipeline's best estimator and the paper's formulas,
//! OpenCV's `solvePnP` on identical frames, and the Cramér–Rao bound of these frames, over random poses and
//! Sun directions.
//!
//!     cargo run --release -p boresight-research --bin docking_accuracy -- OUT [--poses 200] [--seed 1]
//!     [--python PYTHON] [--rows wide-5m,narrow-5m] [--noise 2]
//!
//! Frames and truth are written below OUT, one directory per row of the table. With `--python` (an
//! interpreter with the packages of tests/python/docking_requirements.txt) `tests/python/docking_pnp.py`
//! measures these frames with OpenCV.

mod bound;
mod frames;
mod table;

use std::error::Error;
use std::path::{Path, PathBuf};
use std::process::Command;

use boresight_research::docking_random::still::{NOISE_DN, Row};
use bound::Bound;
use contract::PipelineFactory;
use contract::docking::{DockingSolution, FieldTelemetry, Pose, PoseEstimate};
use frames::{Case, ROWS};
use pipeline::CameraModel;
use pipeline::docking::model_fit::ModelFit;
use pipeline::docking::{DockingConfig, DockingFactory};
use rayon::prelude::*;
use table::{Answer, Line};

struct Arguments {
    out: PathBuf,
    poses: u64,
    seed: u64,
    python: Option<String>,
    rows: Option<Vec<String>>,
    noise_dn: f64,
}

fn arguments() -> Result<Arguments, Box<dyn Error>> {
    let mut words = std::env::args().skip(1);
    let out = words.next().ok_or(
        "usage: docking_accuracy OUT [--poses N] [--seed N] [--python PYTHON] [--rows A,B] [--noise DN]",
    )?;
    let mut arguments =
        Arguments { out: out.into(), poses: 200, seed: 1, python: None, rows: None, noise_dn: NOISE_DN };
    while let Some(option) = words.next() {
        let value = words.next().ok_or_else(|| format!("{option} has no value"))?;
        match option.as_str() {
            "--poses" => arguments.poses = value.parse()?,
            "--seed" => arguments.seed = value.parse()?,
            "--python" => arguments.python = Some(value),
            "--noise" => arguments.noise_dn = value.parse()?,
            "--rows" => arguments.rows = Some(value.split(',').map(str::to_owned).collect()),
            _ => return Err(format!("{option} is not an option").into()),
        }
    }
    Ok(arguments)
}

/// Estimates and bounds of one frame.
struct FrameResult {
    truth: Pose,
    /// Pipeline on the frame without a prior: its best estimator, and the paper's formulas.
    best: Option<PoseEstimate>,
    paper: Option<Pose>,
    /// Best estimator, started from the initial pose of OpenCV.
    near: Option<PoseEstimate>,
    bounds: [Bound; 3],
}

fn measure(
    row: &Row,
    arguments: &Arguments,
    number: u64,
    folder: &Path,
) -> Result<(Case, FrameResult), String> {
    let text = |error: &dyn std::fmt::Display| format!("{}, pose {number}: {error}", row.name);
    let case = Case::random(row, arguments.seed, number, arguments.noise_dn).map_err(|e| text(&e))?;
    let field = case.field().map_err(|e| text(&e))?;
    boresight::docking::video::write_field(&folder.join(Case::file(number)), &field).map_err(|e| text(&e))?;
    let setup = case.setup();
    // A new pipeline: every frame is its first one.
    let factory = DockingFactory::new(DockingConfig::default()).map_err(|e| text(&e))?;
    let mut pipeline = factory.build(&setup).map_err(|e| text(&e))?;
    let telemetry = FieldTelemetry { time_s: 0.0, camera: 0, digitiser: Default::default() };
    let outcome = pipeline.process(&field, &telemetry);
    let (best, paper) = match outcome.solution {
        DockingSolution::Measured(measurement) => (Some(measurement.best), measurement.paper),
        _ => (None, None),
    };
    let camera = CameraModel::new(&setup.cameras[0]).map_err(|e| text(&e))?;
    let near = ModelFit::new().fit_near(&field, &camera, &setup.target, case.prior());
    let near = near.ok().map(|fitted| fitted.estimate);
    let bounds = case.bounds().map_err(|e| text(&e))?;
    Ok((case.clone(), FrameResult { truth: *case.pose(), best, paper, near, bounds }))
}

fn run_row(row: &Row, arguments: &Arguments) -> Result<Vec<Line>, Box<dyn Error>> {
    let folder = arguments.out.join(row.name);
    std::fs::create_dir_all(&folder)?;
    let results: Vec<(Case, FrameResult)> = (0..arguments.poses)
        .into_par_iter()
        .map(|number| measure(row, arguments, number, &folder))
        .collect::<Result<_, _>>()?;
    let (cases, measured): (Vec<Case>, Vec<FrameResult>) = results.into_iter().unzip();
    frames::write_tables(&folder, &cases)?;
    let estimates = |of: &dyn Fn(&FrameResult) -> Option<PoseEstimate>| -> Vec<Answer> {
        let answer = |m| {
            let estimate = of(m);
            Answer {
                truth: m.truth,
                pose: estimate.map(|e| e.pose),
                covariance: estimate.map(|e| e.covariance),
            }
        };
        measured.iter().map(answer).collect()
    };
    let poses = |poses: Vec<Option<Pose>>| -> Vec<Answer> {
        measured
            .iter()
            .zip(poses)
            .map(|(m, pose)| Answer { truth: m.truth, pose, covariance: None })
            .collect()
    };
    let (best, near) = (estimates(&|m| m.best), estimates(&|m| m.near));
    table::write_errors(
        &folder.join("errors.csv"),
        &[("best", &best), ("near", &near)],
        &measured_bounds(&measured),
    )?;
    let mut lines = vec![
        Line::from_answers(row.name, "best", &best),
        Line::from_answers(row.name, "near", &near),
        Line::from_answers(row.name, "paper", &poses(measured.iter().map(|m| m.paper).collect())),
    ];
    if let Some(python) = &arguments.python {
        let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("../tests/python/docking_pnp.py");
        let status = Command::new(python).arg(script).arg(&folder).arg("--quiet").status()?;
        if !status.success() {
            return Err(format!("{python}: docking_pnp.py failed: {status}").into());
        }
        let opencv = table::read_poses(&folder.join("opencv.csv"), measured.len())?;
        lines.push(Line::from_answers(row.name, "OpenCV", &poses(opencv)));
    }
    for (i, name) in ["bound 1", "bound 2", "bound 3"].into_iter().enumerate() {
        let bounds: Vec<Bound> = measured.iter().map(|m| m.bounds[i]).collect();
        lines.push(Line::from_bounds(row.name, name, &bounds));
    }
    lines.extend(lines.last().map(|bound| lines[0].over(bound)));
    Ok(lines)
}

/// Reference bound of every frame.
fn measured_bounds(measured: &[FrameResult]) -> Vec<Bound> {
    measured.iter().map(|m| m.bounds[2]).collect()
}

fn main() -> Result<(), Box<dyn Error>> {
    let arguments = arguments()?;
    println!("{}", table::HEADING);
    for row in ROWS {
        if arguments.rows.as_ref().is_some_and(|names| !names.iter().any(|name| name == row.name)) {
            continue;
        }
        for line in run_row(&row, &arguments)? {
            println!("{line}");
        }
    }
    Ok(())
}
