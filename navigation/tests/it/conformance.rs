//! Both navigators fulfil the contract.

use boresight_navigation::{BatchConfig, BatchFactory, Osculation, SequentialConfig, SequentialFactory};
use contract::ContractError;
use contract::conformance::navigation::check;
use contract::navigation::{
    Answer, Covariance6, Event, Mode, NavigationSetup, Navigator, NavigatorFactory, NoEstimate,
    RelativeElements, RelativeEstimate,
};
use hifitime::Epoch;
use nalgebra::Vector3;

#[test]
fn the_batch_conforms() {
    for osculation in [Osculation::None, Osculation::FirstOrder] {
        check(&BatchFactory { config: BatchConfig { osculation, ..BatchConfig::default() } }).unwrap();
    }
}

#[test]
fn the_filter_conforms() {
    for osculation in [Osculation::None, Osculation::FirstOrder] {
        let config = SequentialConfig { osculation, ..SequentialConfig::default() };
        check(&SequentialFactory { config }).unwrap();
    }
}

/// Answers every epoch from the first measurement alone.
struct Hasty(Option<RelativeEstimate>);

impl Navigator for Hasty {
    fn receive(&mut self, event: &Event) {
        self.0.get_or_insert_with(|| RelativeEstimate {
            time: event.time(),
            position_m: Vector3::new(0.0, -10_000.0, 0.0),
            velocity_m_s: Vector3::zeros(),
            covariance: Covariance6::from_sigmas([1.0; 6]).expect("positive"),
            elements: RelativeElements::default(),
            elements_covariance: Covariance6::from_sigmas([1.0; 6]).expect("positive"),
        });
    }

    fn estimates(&mut self, epochs: &[Epoch]) -> Vec<Answer> {
        let answer = self.0.ok_or(NoEstimate::NoMeasurements);
        epochs.iter().map(|epoch| answer.clone().map(|a| RelativeEstimate { time: *epoch, ..a })).collect()
    }
}

impl NavigatorFactory for Hasty {
    fn name(&self) -> String {
        "hasty".to_owned()
    }

    fn mode(&self) -> Mode {
        Mode::Batch
    }

    fn build(&self, _: &NavigationSetup) -> Result<Box<dyn Navigator>, ContractError> {
        Ok(Box::new(Self(None)))
    }
}

#[test]
fn an_estimate_from_nothing_is_a_violation() {
    let violations = check(&Hasty(None)).unwrap_err();
    let broken = violations.iter().find(|v| v.input == "one measurement without a prior").unwrap();
    assert!(broken.broken.contains("an estimate from nothing"), "{broken:?}");
}
