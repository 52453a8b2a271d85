//! Tests of the sequential navigator.

use boresight_navigation::{Batch, BatchConfig, Sequential, SequentialConfig};
use contract::navigation::{Event, NavigationSetup, Navigator, NoEstimate, RelativeEstimate, SlowError, Use};

use hifitime::Unit;

use crate::simulator::{Campaign, Flight, at};

fn fed(setup: &NavigationSetup, events: &[Event]) -> Sequential {
    let mut filter = Sequential::new(setup, &SequentialConfig::default()).expect("a sound setup");
    events.iter().for_each(|event| filter.receive(event));
    filter
}

fn fed_batch(setup: &NavigationSetup, events: &[Event]) -> Batch {
    let mut batch = Batch::new(setup, &BatchConfig::default()).expect("a sound setup");
    events.iter().for_each(|event| batch.receive(event));
    batch
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

/// The slopes of angles of 1″ differ between the ranges of successive estimates. A filter that linearises
/// each measurement about its latest estimate takes these differences for information about the range.
#[test]
fn precise_measurements_are_filtered_as_the_batch_fits_them() {
    for seed in [1, 2, 3] {
        let flight = Campaign::precise(16).fly(seed);
        let (mut batch, mut filter) = (fed_batch(&flight.setup, &[]), fed(&flight.setup, &[]));
        let mut events = flight.events.iter().peekable();
        for seconds in [36_000.0, 60_000.0, 140_000.0, 400_000.0] {
            while let Some(event) = events.next_if(|event| event.time() <= at(seconds)) {
                batch.receive(event);
                filter.receive(event);
            }
            let [fitted, filtered]: [RelativeEstimate; 2] =
                [batch.estimates(&[at(seconds)]), filter.estimates(&[at(seconds)])]
                    .map(|mut answers| answers.remove(0).unwrap());
            let (a, b) = (fitted.covariance.sigmas(), filtered.covariance.sigmas());
            let difference = (fitted.position_m - filtered.position_m)[1].abs() / a[1];
            assert!(difference < 0.2, "{seed}, {seconds} s: {difference} sigma");
            assert!((b[1] / a[1] - 1.0).abs() < 0.03, "{seed}, {seconds} s: {} {}", a[1], b[1]);
        }
    }
}

/// The angle of a displacement grows tenfold as the chaser approaches.
#[test]
fn displacements_are_filtered_as_the_batch_fits_them() {
    for seed in [1, 2] {
        let flight = Campaign::displaced(16).fly(seed);
        let (mut batch, mut filter) =
            (fed_batch(&flight.setup, &flight.events), fed(&flight.setup, &flight.events));
        let end = [at(430_000.0)];
        let [fitted, filtered]: [RelativeEstimate; 2] =
            [batch.estimates(&end), filter.estimates(&end)].map(|mut answers| answers.remove(0).unwrap());
        for estimate in [&fitted, &filtered] {
            // χ² with six degrees of freedom exceeds 27.9 once in 10,000.
            let squared = squared(&flight, estimate);
            assert!(squared < 27.9, "{seed}: {squared}");
        }
        let (a, b) = (fitted.covariance.sigmas(), filtered.covariance.sigmas());
        for k in 0..3 {
            let difference = (fitted.position_m[k] - filtered.position_m[k]).abs() / a[k];
            // Both fit the chaser's orbit to different states: 1″ at this accuracy, without displacements
            // too.
            assert!(difference < 1.0, "{seed}, {k}: {difference} sigma");
            // The filter has the error of the chaser's orbit, too.
            assert!((b[k] / a[k] - 1.0).abs() < 0.06, "{seed}, {k}: {} {}", a[k], b[k]);
        }
        // Displacements stated as angles at the smallest distance are too large at the others.
        let mut setup = flight.setup.clone();
        let displacements = std::mem::take(&mut setup.errors.displacements);
        let angles = displacements.iter().map(|displacement| SlowError {
            sigma_arcsec: displacement.sigma_m.map(|sigma| (sigma / 2_500.0).to_degrees() * 3600.0),
            memory_s: displacement.memory_s,
            period_s: displacement.period_s,
        });
        setup.errors.without_stars.slow.extend(angles);
        let angular = fed_batch(&setup, &flight.events).estimates(&end).remove(0).unwrap();
        assert!(angular.covariance.sigmas()[1] > 1.3 * a[1], "{seed}: {}", angular.covariance.sigmas());
    }
}

/// A manoeuvre reported hours after it, without a buffer for late measurements, is inserted in the history.
#[test]
fn a_late_report_of_a_manoeuvre_changes_nothing_in_the_end() {
    let flight = Campaign::argon(64).fly(13);
    let mut late = flight.events.clone();
    let first = late.iter().position(|event| matches!(event, Event::Manoeuvre(_))).unwrap();
    let report = late.remove(first);
    let arrival = late.iter().position(|event| event.time() > report.time() + Unit::Hour * 3).unwrap();
    late.insert(arrival, report);
    let config = SequentialConfig { buffer_s: 0.0, ..SequentialConfig::default() };
    let last = |events: &[Event]| {
        let mut filter = Sequential::new(&flight.setup, &config).unwrap();
        events.iter().for_each(|event| filter.receive(event));
        filter.estimates(&[at(430_000.0)]).remove(0).unwrap()
    };
    let (prompt, late) = (last(&flight.events), last(&late));
    let difference = (prompt.position_m - late.position_m).component_div(&prompt.covariance.sigmas().xyz());
    assert!(difference.abs().max() < 0.02, "{difference}");
}

/// Events beyond the history keep their linearisation and their states.
#[test]
fn a_short_history_answers_old_epochs() {
    let flight = Campaign::argon(64).fly(14);
    let config = SequentialConfig { history: 40, ..SequentialConfig::default() };
    let mut short = Sequential::new(&flight.setup, &config).unwrap();
    flight.events.iter().for_each(|event| short.receive(event));
    let epochs = [at(30_000.0), at(140_000.0), at(430_000.0)];
    let whole = fed(&flight.setup, &flight.events).estimates(&epochs);
    for (a, b) in short.estimates(&epochs).into_iter().zip(whole) {
        let (a, b) = (a.unwrap(), b.unwrap());
        let difference = (a.position_m - b.position_m).component_div(&b.covariance.sigmas().xyz());
        assert!(difference.abs().max() < 0.5, "{difference}");
    }
    assert!(short.dispositions().iter().all(|disposition| disposition.used == Use::Used));
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
