//! Tests of the batch navigator.

use boresight_navigation::{Batch, BatchConfig};
use contract::navigation::{Navigator, Use};

use crate::simulator::{Campaign, at};

#[test]
fn argon_is_estimated_within_its_covariance() {
    let flight = Campaign::argon(8).fly(1);
    let mut batch = Batch::new(&flight.setup, &BatchConfig::default()).unwrap();
    flight.events.iter().for_each(|event| batch.receive(event));
    for half_day in 0..10 {
        let estimate = batch.estimates(&[at(43_200.0 * f64::from(half_day))]).remove(0).unwrap();
        let error = flight.error(&estimate);
        let inverse = estimate.covariance.matrix().try_inverse().unwrap();
        // χ² with six degrees of freedom exceeds 27.9 once in 10,000.
        let squared = (error.transpose() * inverse * error)[0];
        assert!(squared < 27.9, "{half_day}: {squared}");
        // The prior has 1000 m along the track.
        assert!(estimate.covariance.sigmas()[1] < 250.0);
    }
    assert!(batch.dispositions().iter().all(|disposition| disposition.used == Use::Used));
}
