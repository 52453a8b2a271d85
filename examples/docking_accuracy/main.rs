//! How exactly is the pose measured? The built-in pipeline's best estimator and the paper's formulas, OpenCV's `solvePnP` on
//! the same frames, and the Cramér–Rao bound of these frames, over random poses and suns.
//!
//!     cargo run --release --example docking_accuracy -- OUT [--poses 200] [--seed 1] [--python PYTHON] [--rows wide-5m,narrow-5m]
//!
//! Frames and truth are written below OUT, one folder a row of the table. With `--python` (an interpreter with the packages
//! of tests/python/docking_requirements.txt) `tests/python/docking_pnp.py` measures the same frames with OpenCV.

mod bound;
mod frames;
mod table;

use std::error::Error;
use std::path::{Path, PathBuf};
use std::process::Command;

use contract::docking::{DockingPipelineFactory, DockingSolution, FieldTelemetry, Pose};
use pipeline::docking::{DockingConfig, DockingFactory};
use rayon::prelude::*;

use bound::{Bound, Features};
use frames::{Case, Row};
use table::{Answer, Line};

struct Arguments {
    out: PathBuf,
    poses: u64,
    seed: u64,
    python: Option<String>,
    rows: Option<Vec<String>>,
}

fn arguments() -> Result<Arguments, Box<dyn Error>> {
    let mut words = std::env::args().skip(1);
    let out = words
        .next()
        .ok_or("usage: docking_accuracy OUT [--poses N] [--seed N] [--python PYTHON] [--rows A,B]")?;
    let mut arguments = Arguments { out: out.into(), poses: 200, seed: 1, python: None, rows: None };
    while let Some(option) = words.next() {
        let value = words.next().ok_or_else(|| format!("{option} has no value"))?;
        match option.as_str() {
            "--poses" => arguments.poses = value.parse()?,
            "--seed" => arguments.seed = value.parse()?,
            "--python" => arguments.python = Some(value),
            "--rows" => arguments.rows = Some(value.split(',').map(str::to_owned).collect()),
            _ => return Err(format!("{option} is not an option").into()),
        }
    }
    Ok(arguments)
}

/// What the pipeline and the bound say of one frame.
struct Measured {
    truth: Pose,
    best: Option<Pose>,
    paper: Option<Pose>,
    bounds: [Bound; 2],
}

fn measure(row: &Row, seed: u64, number: u64, folder: &Path) -> Result<(Case, Measured), String> {
    let text = |error: &dyn std::fmt::Display| format!("{}, pose {number}: {error}", row.name);
    let case = Case::random(row, seed, number).map_err(|e| text(&e))?;
    let field = case.field().map_err(|e| text(&e))?;
    boresight::files::write_field(&folder.join(Case::file(number)), &field).map_err(|e| text(&e))?;
    // A pipeline that has seen nothing: every frame is the first one.
    let factory = DockingFactory::new(DockingConfig::default()).map_err(|e| text(&e))?;
    let mut pipeline = factory.build(&case.setup()).map_err(|e| text(&e))?;
    let telemetry = FieldTelemetry { time_s: 0.0, camera: 0, digitiser: Default::default() };
    let outcome = pipeline.process(&field, &telemetry);
    let (best, paper) = match outcome.solution {
        DockingSolution::Measured(measurement) => (Some(measurement.best.pose), measurement.paper),
        _ => (None, None),
    };
    let bound = |features| case.bound(features).map_err(|e| text(&e));
    let bounds = [bound(Features::All)?, bound(Features::WithoutRim)?];
    Ok((case.clone(), Measured { truth: *case.pose(), best, paper, bounds }))
}

fn run_row(row: &Row, arguments: &Arguments) -> Result<Vec<Line>, Box<dyn Error>> {
    let folder = arguments.out.join(row.name);
    std::fs::create_dir_all(&folder)?;
    let results: Vec<(Case, Measured)> = (0..arguments.poses)
        .into_par_iter()
        .map(|number| measure(row, arguments.seed, number, &folder))
        .collect::<Result<_, _>>()?;
    let (cases, measured): (Vec<Case>, Vec<Measured>) = results.into_iter().unzip();
    frames::write_tables(&folder, &cases)?;
    let answers = |of: &dyn Fn(&Measured) -> Option<Pose>| -> Vec<Answer> {
        measured.iter().map(|m| Answer { truth: m.truth, estimate: of(m) }).collect()
    };
    let mut lines = vec![
        Line::of_answers(row.name, "best", &answers(&|m| m.best)),
        Line::of_answers(row.name, "paper", &answers(&|m| m.paper)),
    ];
    if let Some(python) = &arguments.python {
        let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/python/docking_pnp.py");
        let status = Command::new(python).arg(script).arg(&folder).arg("--quiet").status()?;
        if !status.success() {
            return Err(format!("{python}: docking_pnp.py failed: {status}").into());
        }
        let poses = table::read_poses(&folder.join("opencv.csv"), measured.len())?;
        let answers: Vec<Answer> =
            measured.iter().zip(poses).map(|(m, estimate)| Answer { truth: m.truth, estimate }).collect();
        lines.push(Line::of_answers(row.name, "OpenCV", &answers));
    }
    for (i, name) in [(0, "bound"), (1, "no rim")] {
        lines.push(Line::of_bounds(
            row.name,
            name,
            &measured.iter().map(|m| m.bounds[i]).collect::<Vec<_>>(),
        ));
    }
    Ok(lines)
}

fn main() -> Result<(), Box<dyn Error>> {
    let arguments = arguments()?;
    println!("{}", table::HEADING);
    for row in Row::ALL {
        if arguments.rows.as_ref().is_some_and(|names| !names.iter().any(|name| name == row.name)) {
            continue;
        }
        for line in run_row(&row, &arguments)? {
            println!("{line}");
        }
    }
    Ok(())
}
