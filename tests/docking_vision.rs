//! The docking pipeline on the simulator's fields: every artefact of the docking scenario on, from acquisition on.

use std::path::Path;

use contract::docking::{Digitiser, DockingPipelineFactory, DockingSolution, NoPose};
use pipeline::docking::{DockingConfig, DockingFactory};
use sim::docking::{DockingSimulation, DockingSimulator};

/// The simulation of the built-in scenario.
fn simulation() -> DockingSimulation {
    let text = std::fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join("scenarios/docking.toml"));
    let mut table: toml::Table = text.unwrap().parse().unwrap();
    for key in ["world", "title"] {
        table.remove(key);
    }
    table.try_into().unwrap()
}

/// One field of the check.
struct Answer {
    range_m: f64,
    camera: usize,
    target_in_field: bool,
    /// Distance of the cross from truth, px; `None` where it was not measured.
    cross_error_px: Option<f64>,
    range_error: Option<f64>,
    reason: String,
}

/// Starts a fresh pipeline at many places of the approach and gives it a few fields each.
fn answers(block_step: u64, block: u64) -> Vec<Answer> {
    let simulator = DockingSimulator::new(&simulation(), Path::new(env!("CARGO_MANIFEST_DIR"))).unwrap();
    let factory = DockingFactory::new(DockingConfig::default()).unwrap();
    let mut workspace = simulator.workspace().unwrap();
    let mut answers = Vec::new();
    for first in (0..simulator.field_count()).step_by(block_step as usize) {
        let mut pipeline = factory.build(&simulator.setup()).unwrap();
        let mut digitiser = Digitiser::default();
        for field in first..(first + block).min(simulator.field_count()) {
            let exposure = simulator.expose(&mut workspace, field).unwrap();
            let digitised = exposure.video.digitise(&digitiser);
            let outcome = pipeline.process(&digitised, &exposure.telemetry(digitiser));
            digitiser = outcome.digitiser.unwrap_or(digitiser);
            let truth = &exposure.truth;
            let measured = outcome.measurement().is_some();
            answers.push(Answer {
                range_m: truth.range_m,
                camera: truth.camera,
                target_in_field: truth.target_in_field,
                cross_error_px: outcome
                    .features
                    .cross
                    .filter(|_| measured)
                    .zip(truth.cross_centre)
                    .map(|(cross, centre)| cross.centre.distance(centre)),
                range_error: outcome
                    .measurement()
                    .map(|m| (m.best.pose.position_m.z - truth.pose.position_m.z) / truth.range_m),
                reason: match outcome.solution {
                    DockingSolution::NoSolution(NoPose::Failed(text)) => panic!("{text}"),
                    DockingSolution::NoSolution(reason) => reason.to_string(),
                    DockingSolution::RangeOnly { range_m, sigma_m } => {
                        format!("range_only {range_m:.1}+-{sigma_m:.1}")
                    }
                    DockingSolution::Measured(_) => String::new(),
                },
            });
        }
    }
    answers
}

#[test]
fn the_target_is_measured_where_it_is_resolved_and_in_the_field() {
    let answers = answers(400, 4);
    let (mut count, mut measured, mut wrong) = (0u32, 0u32, 0u32);
    for answer in &answers {
        let covered = match answer.camera {
            0 => (3.0..=30.0).contains(&answer.range_m),
            _ => (1.1..=10.0).contains(&answer.range_m),
        };
        if !(covered && answer.target_in_field) {
            println!("     {:7.2} m {} {}", answer.range_m, answer.camera, answer.reason);
            continue;
        }
        count += 1;
        measured += u32::from(answer.cross_error_px.is_some());
        wrong += u32::from(answer.cross_error_px.is_some_and(|error| error > 1.5));
        println!(
            "{:7.2} m {} cross {:?} range {:?} {}",
            answer.range_m, answer.camera, answer.cross_error_px, answer.range_error, answer.reason
        );
    }
    println!("{measured} of {count} measured, {wrong} wrong");
    assert!(f64::from(measured) >= 0.98 * f64::from(count), "{measured} of {count}");
    assert!(f64::from(wrong) <= 0.01 * f64::from(count), "{wrong} of {count} wrong");
}
