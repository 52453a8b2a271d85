//! Compares the pipeline's measurements of Mitsuba's images and of ours. Random poses and Sun directions are
//! each drawn by the fast renderer and rendered by Mitsuba, then passed through identical television chains
//! with identical random draws to the pipeline. The program prints both scores side by side, and the
//! difference of the two answers field by field.
//!
//!     cargo run --release -p boresight-research --bin docking_judge -- [--poses 4] [--samples 64] [--seed 1]
//!     [--rows wide-5m,narrow-5m]
//!
//! Mitsuba renders the square about the target's disk; outside it both images come from the fast renderer.
//! Rendered images are kept in Mitsuba's cache (docs/evidence/mitsuba.md) and are not rendered again.

mod cases;

use std::error::Error;

use boresight::mitsuba::{MitsubaOptions, MitsubaRenderer};
use cases::{Case, ROWS};
use contract::PipelineFactory;
use contract::docking::{Digitiser, DockingSolution, FieldTelemetry, Pose};
use pipeline::docking::{DockingConfig, DockingFactory};
use sim::mitsuba::Settings;
use sim::vector::{Drawer, RadianceImage};

struct Arguments {
    poses: u64,
    samples: u32,
    seed: u64,
    rows: Option<Vec<String>>,
}

fn arguments() -> Result<Arguments, Box<dyn Error>> {
    let mut arguments = Arguments { poses: 4, samples: 64, seed: 1, rows: None };
    let mut words = std::env::args().skip(1);
    while let Some(option) = words.next() {
        let value = words.next().ok_or_else(|| format!("{option} has no value"))?;
        match option.as_str() {
            "--poses" => arguments.poses = value.parse()?,
            "--samples" => arguments.samples = value.parse()?,
            "--seed" => arguments.seed = value.parse()?,
            "--rows" => arguments.rows = Some(value.split(',').map(str::to_owned).collect()),
            _ => return Err(format!("{option} is not an option").into()),
        }
    }
    Ok(arguments)
}

/// Errors of an answer, or differences of two answers: range, % of the range; d1 and d2, mm; φ1 and φ2,
/// degrees.
fn errors(answer: &Pose, truth: &Pose) -> [Vec<f64>; 3] {
    let (d, phi) = (answer.position_m - truth.position_m, answer.phi_rad - truth.phi_rad);
    let range_m = truth.position_m.norm();
    [
        vec![100.0 * (answer.position_m.norm() - range_m) / range_m],
        vec![1e3 * d.x, 1e3 * d.y],
        vec![phi.x.to_degrees(), phi.y.to_degrees()],
    ]
}

fn rms(errors: &[f64]) -> f64 {
    (errors.iter().map(|e| e * e).sum::<f64>() / errors.len() as f64).sqrt()
}

/// Prints a line of the table from pairs of an answer and its reference.
fn print_line(row: &str, name: &str, of: usize, pairs: &[(Pose, Pose)]) {
    let mut all: [Vec<f64>; 3] = Default::default();
    for (answer, truth) in pairs {
        for (all, own) in all.iter_mut().zip(errors(answer, truth)) {
            all.extend(own);
        }
    }
    let answered = format!("{}/{of}", pairs.len());
    let figures = if pairs.is_empty() {
        format!("{:>8} {:>11} {:>8}", "-", "-", "-")
    } else {
        let [range, lateral, angle] = all.map(|errors| rms(&errors));
        format!("{range:8.4} {lateral:11.3} {angle:8.4}")
    };
    println!("{row:<11} {name:<10} {answered:>8} {figures}");
}

/// Best estimate of a new pipeline.
fn measure(case: &Case, image: &RadianceImage) -> Result<Option<Pose>, Box<dyn Error>> {
    let mut workspace = case.simulator.workspace()?;
    let video = case.simulator.expose_image(&mut workspace, 0, image)?.video;
    let mut pipeline = DockingFactory::new(DockingConfig::default())?.build(&case.simulator.setup())?;
    let telemetry = FieldTelemetry { time_s: 0.0, camera: 0, digitiser: Digitiser::default() };
    Ok(match pipeline.process(&video.digitise(&Digitiser::default()), &telemetry).solution {
        DockingSolution::Measured(measurement) => Some(measurement.best.pose),
        _ => None,
    })
}

/// Returns the image of the fast renderer, and this image with Mitsuba's in the square about the target.
fn images(case: &Case, samples: u32) -> Result<[RadianceImage; 2], Box<dyn Error>> {
    let (scene, moment) = (case.simulator.scene(), case.simulator.field_state(0)?);
    let mut fast = RadianceImage::default();
    Drawer::new(&case.camera)?.draw(scene, &moment.lighting, &case.pose, &mut fast);
    let crop = case.target_window();
    let settings = Settings { samples, crop: Some(crop) };
    let renderer = MitsubaRenderer::new(MitsubaOptions { settings, ..MitsubaOptions::default() })?;
    let window = renderer.radiance(scene, &moment.lighting, &case.pose, &case.camera)?;
    let mut judged = fast.clone();
    for (row, pixels) in window.radiance.chunks_exact(crop.columns).enumerate() {
        let start = (crop.y + row) * judged.columns + crop.x;
        judged.radiance[start..start + crop.columns].copy_from_slice(pixels);
    }
    Ok([fast, judged])
}

fn main() -> Result<(), Box<dyn Error>> {
    let arguments = arguments()?;
    println!("Root mean squares: range, % of it; lateral, mm (per axis); φ1, φ2, degrees (per axis).");
    println!("difference: Mitsuba's answer less ours, where both are answered.");
    println!(
        "{:<11} {:<10} {:>8} {:>8} {:>11} {:>8}",
        "row", "images", "answered", "range %", "lateral mm", "φ1,2 °"
    );
    for row in ROWS {
        if arguments.rows.as_ref().is_some_and(|names| !names.iter().any(|name| name == row.name)) {
            continue;
        }
        let (mut ours, mut theirs, mut both) = (Vec::new(), Vec::new(), Vec::new());
        for number in 0..arguments.poses {
            let case = Case::random(&row, arguments.seed, number)?;
            let [fast, judged] = images(&case, arguments.samples)?;
            let answers = [measure(&case, &fast)?, measure(&case, &judged)?];
            ours.extend(answers[0].map(|answer| (answer, case.pose)));
            theirs.extend(answers[1].map(|answer| (answer, case.pose)));
            if let [Some(ours), Some(theirs)] = answers {
                both.push((theirs, ours));
            }
        }
        let of = arguments.poses as usize;
        print_line(row.name, "ours", of, &ours);
        print_line(row.name, "Mitsuba's", of, &theirs);
        print_line(row.name, "difference", of, &both);
    }
    Ok(())
}
