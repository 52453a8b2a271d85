//! Consistency of the navigators: dispersed campaigns of an independent simulator.
//!
//! `cargo run --release -p boresight-navigation --example consistency -- CAMPAIGNS STRIDE [FIRST]`: every
//! STRIDE-th measurement of ARGON's schedule, seeds from FIRST. The variable VARIANT contains `sequential`
//! for the filter instead of the batch, `precise` for the errors of best mode, `displaced` for those with a
//! centre of brightness displaced by centimetres instead of arcseconds, `exact` for exact manoeuvres, `white`
//! without slow errors, `unbiased` without constant errors, `halved` with all drawn errors halved, `mirrored`
//! with all of the opposite sign, `noiseless` without any.

#[path = "../tests/it/simulator.rs"]
mod simulator;

use boresight_navigation::{Batch, BatchConfig, Bound, Sequential, SequentialConfig};
use contract::navigation::{Answer, Event, Navigator, RelativeEstimate};
use hifitime::Epoch;
use nalgebra::Vector6;
use simulator::{Campaign, Flight, at};

#[allow(clippy::unwrap_used, reason = "a program of ours")]
fn main() {
    let arguments: Vec<usize> = std::env::args().skip(1).map(|text| text.parse().unwrap()).collect();
    let (campaigns, stride) = (arguments[0], arguments[1]);
    let first = arguments.get(2).copied().unwrap_or(0);
    let epochs: Vec<f64> = vec![0.0, 60_000.0, 140_000.0, 230_000.0, 300_000.0, 400_000.0];
    let mut sums = vec![Sums::default(); epochs.len()];
    let mut failed = 0;
    let (mut slowest, mut total) = (0.0_f64, 0.0);
    for seed in first..first + campaigns {
        let variant = std::env::var("VARIANT").unwrap_or_default();
        let mut campaign = if variant.contains("displaced") {
            Campaign::displaced(stride)
        } else if variant.contains("precise") {
            Campaign::precise(stride)
        } else {
            Campaign::argon(stride)
        };
        if variant.contains("exact") {
            campaign.manoeuvre_sigma = (0.0, 1e-7);
        }
        if variant.contains("white") {
            campaign.slow.clear();
            campaign.displacements.clear();
        }
        if variant.contains("unbiased") {
            campaign.constant_arcsec = 0.0;
        }
        if variant.contains("halved") {
            campaign.drawn = 0.5;
        }
        if variant.contains("mirrored") {
            campaign.drawn *= -1.0;
        }
        if variant.contains("noiseless") {
            campaign.drawn = 0.0;
        }
        let flight = campaign.fly(1000 + seed as u64);
        let times: Vec<_> = epochs.iter().map(|s| at(*s)).collect();
        let start = std::time::Instant::now();
        let answers =
            if variant.contains("sequential") { filtered(&flight, &times) } else { fitted(&flight, &times) };
        let took = start.elapsed().as_secs_f64();
        slowest = slowest.max(took);
        total += took;
        let mut true_events: Vec<Event> =
            flight.true_manoeuvres.iter().map(|manoeuvre| Event::Manoeuvre(*manoeuvre)).collect();
        let sights = flight.events.iter().filter(|event| matches!(event, Event::LineOfSight(_)));
        true_events.extend(sights.copied());
        let bound =
            Bound::new(&flight.setup, &BatchConfig::default(), &true_events, &flight.true_relative).unwrap();
        let bounds =
            if variant.contains("sequential") { bound.of_filter(&times) } else { bound.of_batch(&times) };
        for ((answer, bound), sum) in answers.iter().zip(&bounds).zip(&mut sums) {
            match (answer, bound) {
                (Ok(estimate), Ok(bound)) => sum.add(&flight.error(estimate), estimate, bound),
                (Err(reason), _) | (_, Err(reason)) => {
                    println!("campaign {seed}: {reason}");
                    failed += 1;
                }
            }
        }
    }
    for (seconds, sum) in epochs.iter().zip(&sums) {
        println!("{seconds:>8} s: {}", sum.line());
    }
    println!("failed {failed}, mean {:.3} s, slowest {slowest:.3} s", total / campaigns as f64);
}

#[allow(clippy::unwrap_used, reason = "a program of ours")]
fn fitted(flight: &Flight, epochs: &[Epoch]) -> Vec<Answer> {
    let mut batch = Batch::new(&flight.setup, &BatchConfig::default()).unwrap();
    flight.events.iter().for_each(|event| batch.receive(event));
    batch.estimates(epochs)
}

/// Answers each epoch once the events until then are received.
#[allow(clippy::unwrap_used, reason = "a program of ours")]
fn filtered(flight: &Flight, epochs: &[Epoch]) -> Vec<Answer> {
    let mut filter = Sequential::new(&flight.setup, &SequentialConfig::default()).unwrap();
    let mut events = flight.events.iter().peekable();
    let mut answers = Vec::new();
    for epoch in epochs {
        while let Some(event) = events.next_if(|event| event.time() <= *epoch) {
            filter.receive(event);
        }
        answers.extend(filter.estimates(&[*epoch]));
    }
    answers
}

/// Sums over campaigns at one epoch.
#[derive(Clone, Default)]
struct Sums {
    count: f64,
    nees: f64,
    nees_position: f64,
    inside: f64,
    squares: Vector6<f64>,
    scaled_squares: Vector6<f64>,
    scaled: Vector6<f64>,
    bound: Vector6<f64>,
}

impl Sums {
    fn add(&mut self, error: &Vector6<f64>, estimate: &RelativeEstimate, bound: &RelativeEstimate) {
        let sigma = estimate.covariance.sigmas();
        let scaled = error.component_div(&sigma);
        let correlation = estimate.covariance.matrix().component_div(&(sigma * sigma.transpose()));
        self.nees +=
            correlation.try_inverse().map_or(f64::NAN, |inverse| (scaled.transpose() * inverse * scaled)[0])
                / 6.0;
        let position = correlation.fixed_view::<3, 3>(0, 0).try_inverse();
        let p = scaled.fixed_rows::<3>(0);
        self.nees_position += position.map_or(f64::NAN, |inverse| (p.transpose() * inverse * p)[0]) / 3.0;
        self.inside += scaled.iter().filter(|x| x.abs() < 3.0).count() as f64 / 6.0;
        self.squares += error.component_mul(error);
        self.scaled_squares += scaled.component_mul(&scaled);
        self.scaled += scaled;
        let of_bound = bound.covariance.sigmas();
        self.bound += of_bound.component_mul(&of_bound);
        self.count += 1.0;
    }

    fn line(&self) -> String {
        let n = self.count;
        let rounded =
            |values: Vector6<f64>| values.iter().map(|x| format!("{x:.3}")).collect::<Vec<_>>().join(" ");
        format!(
            "NEES/6 {:.3}, of position NEES/3 {:.3}, inside 3 sigma {:.4}, RMS/sigma {}, RMS/bound {}, mean/sigma {}, RMS {}",
            self.nees / n,
            self.nees_position / n,
            self.inside / n,
            rounded((self.scaled_squares / n).map(f64::sqrt)),
            rounded(self.squares.component_div(&self.bound).map(f64::sqrt)),
            rounded(self.scaled / n),
            rounded((self.squares / n).map(f64::sqrt)),
        )
    }
}
