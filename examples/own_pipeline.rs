//! Runs and scores a minimal pipeline that reports the brightest pixel as the target.

use boresight::far_range::FarRangeMission;
use boresight::far_range_views::{TableStyle, far_range_table};
use boresight::run::{ScenarioSource, sequence};
use contract::{
    ContractError, FarRange, Frame, Measurement, NoSolution, Outcome, Pipeline, PipelineFactory, PixelPoint,
    Setup, Solution, Telemetry,
};

struct Brightest;

impl Pipeline<FarRange> for Brightest {
    fn process(&mut self, frame: &Frame, _: &Telemetry) -> Outcome {
        let brightest = frame.dn().iter().enumerate().max_by_key(|(_, dn)| **dn);
        match brightest.filter(|(_, dn)| **dn > 0) {
            None => Outcome::without_solution(NoSolution::EmptyFrame),
            Some((index, _)) => {
                let (x, y) = (index % frame.columns(), index / frame.columns());
                let position = PixelPoint::new(x as f64, y as f64);
                let measurement = Measurement::new(position, None);
                Outcome {
                    solution: Solution::Detected(measurement),
                    ..Outcome::without_solution(NoSolution::NoTarget)
                }
            }
        }
    }
}

struct BrightestFactory;

impl PipelineFactory<FarRange> for BrightestFactory {
    fn name(&self) -> String {
        "brightest".to_owned()
    }

    fn build(&self, _: &Setup) -> Result<Box<dyn Pipeline<FarRange>>, ContractError> {
        Ok(Box::new(Brightest))
    }
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    boresight::register_worlds();
    let prepared = FarRangeMission::new(&ScenarioSource::read("argon")?)?;
    let ran = sequence::score(&prepared, 8000..8200, &BrightestFactory)?;
    println!("{}", far_range_table(&ran.scored.score, TableStyle::default()));
    Ok(())
}
