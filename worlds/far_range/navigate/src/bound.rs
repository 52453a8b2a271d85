//! Bound of a campaign: what its measurements, manoeuvres and prior can determine.

use contract::navigation::Event;
use files::{Failure, format_utc};
use hifitime::Epoch;
use navigation::{BatchConfig, Bound};
use serde::{Deserialize, Serialize};

use crate::campaign::Campaign;
use crate::estimator::times;

/// Smallest standard deviations of position at an epoch.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct BoundAt {
    /// Time, UTC.
    pub time_utc: String,
    /// True distance between chaser and target, m.
    pub range_m: f64,
    /// Bound along R, T, N from the measurements until then, m; absent if they do not determine an orbit.
    pub filter_m: Option<[f64; 3]>,
    /// Bound along R, T, N from all measurements, m; absent if they do not determine an orbit.
    pub batch_m: Option<[f64; 3]>,
}

/// Posterior Cramér–Rao bound and observability of a campaign.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct BoundReport {
    /// Name of the scenario.
    pub scenario: String,
    /// Number of lines of sight.
    pub lines_of_sight: u64,
    /// Number of manoeuvres.
    pub manoeuvres: u64,
    /// Condition number of the information on the six elements without a prior, each scaled to unit
    /// information; above 1e8, a combination of elements is practically unknown. Absent if infinite.
    pub condition: Option<f64>,
    /// Standard deviation of aδλ from the measurements alone, percent of aδλ; absent if infinite.
    pub range_sigma_percent: Option<f64>,
    /// Bounds over time.
    pub bounds: Vec<BoundAt>,
}

/// Computes the bound of a campaign, linearised about its true elements, at `count` regular times.
///
/// # Errors
/// [`Failure::Contract`] for a setup outside its ranges, or without a usable measurement.
pub fn bound_of(campaign: &Campaign, count: u32) -> Result<BoundReport, Failure> {
    let config = BatchConfig { osculation: campaign.truth.osculation(), ..BatchConfig::default() };
    let events: Vec<Event> = campaign.arrivals.iter().map(|arrival| arrival.event).collect();
    let elements = campaign.truth.elements(campaign.epoch())?;
    let bound = Bound::new(&campaign.setup, &config, &events, &elements)?;
    let span_s = (campaign.last - campaign.epoch()).to_seconds();
    let epochs: Vec<Epoch> = if span_s > 0.0 {
        times(campaign, span_s / f64::from(count.max(1)))?
    } else {
        vec![campaign.epoch()]
    };
    let observability = bound.observability();
    let bounds = epochs.iter().zip(bound.of_filter(&epochs)).zip(bound.of_batch(&epochs));
    let bounds = bounds.map(|((epoch, filter), batch)| {
        let sigmas = |answer: contract::navigation::Answer| -> Option<[f64; 3]> {
            Some(answer.ok()?.covariance.sigmas().fixed_rows::<3>(0).into_owned().into())
        };
        let state = campaign.truth.state(*epoch);
        BoundAt {
            time_utc: format_utc(*epoch),
            range_m: state.fixed_rows::<3>(0).norm(),
            filter_m: sigmas(filter),
            batch_m: sigmas(batch),
        }
    });
    let finite = |value: f64| value.is_finite().then_some(value);
    Ok(BoundReport {
        scenario: campaign.name.clone(),
        lines_of_sight: campaign.lines_of_sight,
        manoeuvres: campaign.manoeuvres,
        condition: finite(observability.condition),
        range_sigma_percent: finite(100.0 * observability.range_sigma),
        bounds: bounds.collect(),
    })
}
