//! Scores the measurements of any pipeline against the ground truth of a run or a rendered dataset:
//! `cargo run --release -p boresight-examples --example score -- DIRECTORY MEASUREMENTS.csv`.

use std::path::Path;

use boresight::far_range::FarRangeMission;
use boresight::far_range_views::{TableStyle, far_range_table};
use boresight::run::WorldScore as _;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [directory, measurements] = arguments.as_slice() else {
        return Err("expected two arguments: DIRECTORY MEASUREMENTS.csv".into());
    };
    let scored = FarRangeMission::score_files(Path::new(directory), Path::new(measurements), None, None)?;
    println!("{}", far_range_table(&scored.score, TableStyle::default()));
    let correct = &scored.score.figures["correct_rate"];
    println!("correct: {} of {} frames", correct.count, correct.of);
    Ok(())
}
