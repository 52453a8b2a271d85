//! Tests of the sequential navigator.

use boresight_navigation::{Batch, BatchConfig, Sequential, SequentialConfig};
use contract::navigation::{Event, NavigationSetup, Navigator, NoEstimate, RelativeEstimate, Use};

use crate::simulator::{Campaign, Flight, at};

fn fed(setup: &NavigationSetup, events: &[Event]) -> Sequential {
    let mut filter = Sequential::new(setup, &SequentialConfig::default()).expect("a sound setup");
    events.iter().for_each(|event| filter.receive(event));
    filter
}

fn squared(flight: &Flight, estimate: &RelativeEstimate) -> f64 {
    let error = flight.error(estimate);
    let inverse = estimate.covariance.matrix().try_inverse().expect("positive definite");
    (error.transpose() * inverse * error)[0]
}

#[test]
fn argon_is_filtered_within_its_covariance() {
    let flight = Campaign::argon(8).fly(1);
    let mut filter = Sequential::new(&flight.setup, &SequentialConfig::default()).unwrap();
    let mut events = flight.events.iter().peekable();
    for half_day in 1..10 {
        let seconds = 43_200.0 * f64::from(half_day);
        while let Some(event) = events.next_if(|event| event.time() <= at(seconds)) {
            filter.receive(event);
        }
        let estimate = filter.estimates(&[at(seconds)]).remove(0).unwrap();
        // χ² with six degrees of freedom exceeds 27.9 once in 10,000.
        let squared = squared(&flight, &estimate);
        assert!(squared < 27.9, "{half_day}: {squared}");
    }
    let dispositions = filter.dispositions();
    let outliers = dispositions.iter().filter(|disposition| disposition.used == Use::Outlier).count();
    // χ² with two degrees of freedom exceeds 25 once in 270,000.
    assert_eq!(outliers, 0);
}

/// At the end of a campaign the filter has used the same data as the batch. Its manoeuvre errors are process
/// noise and the batch's are parameters, which is the same for Gaussian errors; its linearisation
/// about early, less accurate elements is not.
#[test]
fn the_last_estimate_is_that_of_the_batch() {
    let flight = Campaign::argon(16).fly(3);
    let mut batch = Batch::new(&flight.setup, &BatchConfig::default()).unwrap();
    flight.events.iter().for_each(|event| batch.receive(event));
    let end = [at(430_000.0)];
    let filtered = fed(&flight.setup, &flight.events).estimates(&end).remove(0).unwrap();
    let fitted = batch.estimates(&end).remove(0).unwrap();
    let (a, b) = (fitted.covariance.sigmas(), filtered.covariance.sigmas());
    for k in 0..3 {
        let difference = (fitted.position_m[k] - filtered.position_m[k]).abs() / a[k];
        assert!(difference < 0.5, "{k}: {difference} sigma");
        assert!((b[k] / a[k] - 1.0).abs() < 0.15, "{k}: {} {}", a[k], b[k]);
    }
}

#[test]
fn late_events_within_the_buffer_change_nothing() {
    let flight = Campaign::argon(64).fly(2);
    let mut shuffled = flight.events.clone();
    // A minute is four frames; pairs arrive in the wrong order, manoeuvres too.
    shuffled.chunks_mut(2).for_each(<[Event]>::reverse);
    let config = SequentialConfig { buffer_s: 50_000.0, ..SequentialConfig::default() };
    let last = |events: &[Event]| {
        let mut filter = Sequential::new(&flight.setup, &config).unwrap();
        events.iter().for_each(|event| filter.receive(event));
        filter.estimates(&[at(430_000.0)]).remove(0).unwrap()
    };
    let (ordered, late) = (last(&flight.events), last(&shuffled));
    // The pieces of the chaser's orbit depend on the manoeuvres known when a measurement arrives.
    let difference = (ordered.position_m - late.position_m).component_div(&ordered.covariance.sigmas().xyz());
    assert!(difference.abs().max() < 0.02, "{difference}");
}

#[test]
fn measurements_before_the_buffer_are_not_used_and_duplicates_count_once() {
    let flight = Campaign::argon(64).fly(2);
    let mut filter = fed(&flight.setup, &flight.events);
    let before = filter.estimates(&[at(430_000.0)]);
    let Some(Event::LineOfSight(first)) =
        flight.events.iter().find(|event| matches!(event, Event::LineOfSight(_)))
    else {
        panic!("a measurement")
    };
    filter.receive(&Event::LineOfSight(*first));
    filter.receive(&Event::LineOfSight(contract::navigation::LineOfSightMeasurement {
        frame: 1_000_000,
        ..*first
    }));
    assert_eq!(filter.estimates(&[at(430_000.0)]), before);
    let uses: Vec<Use> = filter.dispositions().iter().rev().take(2).map(|d| d.used).collect();
    assert_eq!(uses, [Use::TooLate, Use::Duplicate]);
}

#[test]
fn without_a_prior_the_filter_waits_until_the_range_is_known() {
    let flight = Campaign { prior_sigma_m: None, ..Campaign::argon(8) }.fly(4);
    let mut filter = Sequential::new(&flight.setup, &SequentialConfig::default()).unwrap();
    assert_eq!(filter.estimates(&[at(0.0)]), [Err(NoEstimate::NoMeasurements)]);
    flight.events.iter().for_each(|event| filter.receive(event));
    let estimate = filter.estimates(&[at(425_000.0)]).remove(0).unwrap();
    let squared = squared(&flight, &estimate);
    assert!(squared < 27.9, "{squared}");
}
