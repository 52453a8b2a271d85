//! The docking pipeline on simulated fields: with every artefact of the docking scenario on, from acquisition
//! on.

use std::path::Path;

use boresight::docking::STARTING_POINT as DOCKING;
use contract::PipelineFactory;
use contract::docking::{Digitiser, DockingSolution, NoPose};
use pipeline::docking::{DockingConfig, DockingFactory};
use sim::docking::{DockingSimulation, DockingSimulator};

/// Simulation of the built-in scenario; with `wide`, only through its wide lens.
fn simulation(wide: bool) -> DockingSimulation {
    let mut table: toml::Table = DOCKING.parse().unwrap();
    for key in ["world", "title", "docking"] {
        table.remove(key);
    }
    let mut simulation: DockingSimulation = table.try_into().unwrap();
    if wide {
        simulation.cameras.remove(0);
    }
    simulation
}

/// Result of one field.
#[derive(Debug)]
struct Answer {
    range_m: f64,
    camera: usize,
    is_whole: bool,
    answer: Kind,
}

#[derive(Debug)]
enum Kind {
    Measured,
    /// Only the range, and its error divided by its standard deviation.
    Range {
        sigmas: f64,
    },
    Wrong,
    Missed(NoPose),
}

/// Starts a new pipeline at many positions of the approach, from `first` on, and processes a few fields with
/// each.
fn answers(wide: bool, first: u64, block_step: usize, block: u64) -> Vec<Answer> {
    let simulator = DockingSimulator::new(&simulation(wide), Path::new(".")).unwrap();
    let factory = DockingFactory::new(DockingConfig::default()).unwrap();
    let mut workspace = simulator.workspace().unwrap();
    let mut answers = Vec::new();
    for first in (first..simulator.field_count()).step_by(block_step) {
        let mut pipeline = factory.build(&simulator.setup()).unwrap();
        let mut digitiser = Digitiser::default();
        for field in first..(first + block).min(simulator.field_count()) {
            let exposure = simulator.expose(&mut workspace, field).unwrap();
            let digitised = exposure.video.digitise(&digitiser);
            let outcome = pipeline.process(&digitised, &exposure.telemetry(digitiser));
            digitiser = outcome.digitiser.unwrap_or(digitiser);
            let truth = &exposure.truth;
            let answer = match &outcome.solution {
                DockingSolution::Measured(measurement) => {
                    let best = &measurement.best.pose;
                    // Gross errors as defined by the score: 5 % of the range, 5° of roll.
                    let is_wrong = (best.position_m.norm() / truth.range_m - 1.0).abs() > 0.05
                        || (best.phi_rad.z - truth.pose.phi_rad.z).abs() > 0.087;
                    if is_wrong { Kind::Wrong } else { Kind::Measured }
                }
                DockingSolution::RangeOnly { range_m, sigma_m } => {
                    let error_m = range_m - truth.pose.position_m.z;
                    if error_m.abs() > 0.2 * truth.range_m {
                        Kind::Wrong
                    } else {
                        Kind::Range { sigmas: error_m / sigma_m }
                    }
                }
                // A doubtful pose is not a reliable result.
                DockingSolution::Doubtful { .. } => Kind::Missed(NoPose::Inconsistent),
                DockingSolution::NoSolution(NoPose::Failed(text)) => panic!("{text}"),
                DockingSolution::NoSolution(reason) => Kind::Missed(reason.clone()),
            };
            answers.push(Answer {
                range_m: truth.range_m,
                camera: truth.camera,
                is_whole: truth.target_in_field,
                answer,
            });
        }
    }
    answers
}

/// Checks that at least 98 % are measured and at most 1 % are wrong, over the fields for which `counts`
/// holds.
fn check(answers: &[Answer], counts: impl Fn(&Answer) -> bool) {
    let counted: Vec<&Answer> = answers.iter().filter(|answer| counts(answer)).collect();
    let count = |kind: fn(&Kind) -> bool| counted.iter().filter(|a| kind(&a.answer)).count() as f64;
    let (measured, wrong) = (count(|k| matches!(k, Kind::Measured)), count(|k| matches!(k, Kind::Wrong)));
    let n = counted.len() as f64;
    let missed: Vec<&&Answer> = counted.iter().filter(|a| !matches!(a.answer, Kind::Measured)).collect();
    assert!(n >= 50.0, "{n} fields say little");
    assert!(measured >= 0.98 * n && wrong <= 0.01 * n, "{measured} of {n}, {wrong} wrong: {missed:#?}");
}

#[test]
fn from_30_m_to_3_m_the_narrow_lens_measures_the_target() {
    // From the hold at 50 m on.
    let answers = answers(false, 13_000, 397, 4);
    check(&answers, |a| a.camera == 0 && a.is_whole && (3.0..=30.0).contains(&a.range_m));
}

#[test]
fn from_10_m_to_1_m_the_wide_lens_measures_the_target() {
    let answers = answers(true, 17_000, 301, 4);
    check(&answers, |a| a.is_whole && (1.1..=10.0).contains(&a.range_m));
    // At closer range, the target is measured by its visible part, or its absence is reported.
    let close: Vec<&Answer> = answers.iter().filter(|a| a.range_m < 1.1 || !a.is_whole).collect();
    assert!(close.len() >= 4, "{} fields say little", close.len());
    for answer in close {
        let is_told = matches!(
            answer.answer,
            Kind::Measured
                | Kind::Missed(
                    NoPose::OutOfField | NoPose::NoTarget | NoPose::TooFewFeatures | NoPose::Inconsistent
                )
        );
        assert!(is_told, "{answer:?}");
    }
}

#[test]
fn from_500_m_on_the_stations_outline_gives_the_range() {
    let answers = answers(false, 0, 1_500, 4);
    let far: Vec<&Answer> = answers.iter().filter(|a| a.range_m > 75.0).collect();
    let sigmas: Vec<f64> = far
        .iter()
        .filter_map(|a| if let Kind::Range { sigmas } = a.answer { Some(sigmas) } else { None })
        .collect();
    let wrong = far.iter().filter(|a| matches!(a.answer, Kind::Wrong)).count();
    assert!(far.len() >= 20, "{} fields say little", far.len());
    assert!(10 * sigmas.len() >= 9 * far.len() && wrong == 0, "{} of {}: {far:#?}", sigmas.len(), far.len());
    assert!(sigmas.iter().all(|s| s.abs() < 3.5), "{sigmas:?}");
}
