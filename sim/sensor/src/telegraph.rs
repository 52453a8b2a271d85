//! Random telegraph noise: hot pixels that switch between two dark currents.

use draws::{Effect, Seed, Stream, uniform};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::pixel::poisson::poisson;

/// Random telegraph switching of a share of the hot pixels, as caused by proton damage in silicon (Hopkins &
/// Hopkinson, "Random telegraph signals from proton-irradiated CCDs", IEEE Trans. Nucl. Sci. 40, 1993): two
/// levels, exponential dwell times.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct TelegraphConfig {
    /// Share of the hot pixels that switch, 0 to 1.
    #[schemars(range(min = 0, max = 1))]
    pub fraction: f64,
    /// Dark current in the low state relative to that in the high state, 0 to 1.
    #[schemars(range(min = 0, max = 1))]
    pub low_level: f64,
    /// Mean time in the high state, s, 0.1 to 1e7.
    #[schemars(range(min = 0.1, max = 1e7))]
    pub high_s: f64,
    /// Mean time in the low state, s, 0.1 to 1e7.
    #[schemars(range(min = 0.1, max = 1e7))]
    pub low_s: f64,
}

impl TelegraphConfig {
    /// Mean dark current of a switching pixel from `from_s` to `to_s`, relative to that in the high state.
    ///
    /// The process has a memory, yet its state can be computed at any time directly. At the events of a
    /// Poisson process with the rate 1/`high_s` + 1/`low_s` the state is drawn anew, high with the
    /// probability `high_s`/(`high_s` + `low_s`), independently of the previous state: this is exactly the
    /// telegraph process, with exponential dwell times. Time is divided into cells; the events of a cell are
    /// drawn at the address of the cell, and the state at any time is that of the last event before it.
    pub(super) fn mean_level(&self, seed: &Seed, pixel: u64, from_s: f64, to_s: f64) -> f64 {
        let cell_s = EVENTS_PER_CELL * self.high_s * self.low_s / (self.high_s + self.low_s);
        let first = (from_s / cell_s).floor();
        let events = |cell: f64| {
            // Cells before the epoch have negative numbers; their bit patterns are valid addresses.
            let mut stream = seed.stream(cell as i64 as u64, Effect::Telegraph, pixel);
            self.events(cell * cell_s, cell_s, &mut stream)
        };
        let before = |cell: f64| events(cell).into_iter().rev().find(|event| event.time_s <= from_s);
        let mut high =
            (0..MAX_CELLS_BACK).find_map(|back| before(first - f64::from(back))).is_some_and(|e| e.high);
        let level = |high: bool| if high { 1.0 } else { self.low_level };
        if to_s <= from_s {
            return level(high);
        }
        let (mut time_s, mut sum, mut cell) = (from_s, 0.0, first);
        while cell * cell_s < to_s {
            for event in events(cell).into_iter().filter(|event| event.time_s > from_s && event.time_s < to_s)
            {
                sum += level(high) * (event.time_s - time_s);
                (time_s, high) = (event.time_s, event.high);
            }
            cell += 1.0;
        }
        sum += level(high) * (to_s - time_s);
        sum / (to_s - from_s)
    }

    /// Events of a cell, in order of time.
    fn events(&self, start_s: f64, cell_s: f64, stream: &mut Stream) -> Vec<Event> {
        let count = poisson(EVENTS_PER_CELL, stream) as usize;
        let high_share = self.high_s / (self.high_s + self.low_s);
        let mut events: Vec<Event> = (0..count)
            .map(|_| Event { time_s: start_s + cell_s * uniform(stream), high: uniform(stream) < high_share })
            .collect();
        events.sort_by(|a, b| a.time_s.total_cmp(&b.time_s));
        events
    }
}

/// Mean number of events in a cell of time. A larger value makes cells fewer and slower to draw.
const EVENTS_PER_CELL: f64 = 4.0;

/// Maximum number of cells searched backwards for an event: the probability of no event in sixteen cells is
/// exp(−64).
const MAX_CELLS_BACK: u32 = 16;

/// Time at which the state is drawn anew.
#[derive(Debug, Clone, Copy)]
struct Event {
    time_s: f64,
    high: bool,
}

/// Returns true if a hot pixel switches, decided by the last number of the pixel's stream.
pub(super) fn switches(telegraph: Option<&TelegraphConfig>, stream: &mut Stream) -> bool {
    telegraph.is_some_and(|telegraph| uniform(stream) < telegraph.fraction)
}

#[cfg(test)]
mod tests {
    use super::*;

    const SEED: Seed = Seed { seed: 5, case: 0 };
    const SLOW: TelegraphConfig =
        TelegraphConfig { fraction: 1.0, low_level: 0.0, high_s: 30.0, low_s: 90.0 };

    fn high(pixel: u64, time_s: f64) -> bool {
        SLOW.mean_level(&SEED, pixel, time_s, time_s) > 0.5
    }

    #[test]
    fn occupancy_is_the_share_of_the_dwell_times() {
        let n = 20_000;
        let share = (0..n).filter(|&pixel| high(pixel, 1234.5)).count() as f64 / n as f64;
        // One quarter; the standard error of independent pixels is sqrt(0.25 · 0.75/n) = 0.0031, and the
        // tolerance is four of them.
        assert!((share - 0.25).abs() < 0.0125, "{share}");
    }

    #[test]
    fn states_a_time_apart_are_correlated_as_an_exponential_telegraph_is() {
        let n = 20_000;
        // 1/(1/30 + 1/90) = 22.5 s.
        for lag_s in [5.0, 22.5, 60.0_f64] {
            let both = (0..n).filter(|&pixel| high(pixel, -40.0) && high(pixel, lag_s - 40.0)).count() as f64;
            let expected = 0.25 * (0.25 + 0.75 * libm::exp(-lag_s / 22.5));
            let error = (expected * (1.0 - expected) / n as f64).sqrt();
            assert!((both / n as f64 - expected).abs() < 4.0 * error, "lag {lag_s}");
        }
    }

    #[test]
    fn dwell_times_are_exponential() {
        // Sampled every 0.25 s; dwell times cut by either end of the series are dropped.
        let (step_s, mut long, mut dwells) = (0.25, 0, 0);
        for pixel in 0..60 {
            let states: Vec<bool> = (0..20_000).map(|i| high(pixel, f64::from(i) * step_s)).collect();
            let runs: Vec<&[bool]> = states.chunk_by(|a, b| a == b).collect();
            for run in runs[1..runs.len() - 1].iter().filter(|run| run[0]) {
                dwells += 1;
                long += usize::from(run.len() as f64 * step_s > 30.0);
            }
        }
        // A share of exp(−1) is longer than the mean; about 2,500 dwell times determine it to 0.0096. The
        // steps hide dwell times below 0.25 s, 0.8 % of them.
        let share = long as f64 / dwells as f64;
        assert!(dwells > 2000 && (share - 0.3679).abs() < 0.04, "{share} of {dwells}");
    }

    #[test]
    fn the_mean_over_an_exposure_is_the_mean_of_the_moments() {
        for pixel in 0..20 {
            let moments =
                (0..20_000).map(|i| SLOW.mean_level(&SEED, pixel, 0.01 * f64::from(i), 0.0)).sum::<f64>();
            let whole = SLOW.mean_level(&SEED, pixel, 0.0, 200.0);
            // Each of about ten switches is resolved to half a step of 20,000.
            assert!((moments / 20_000.0 - whole).abs() < 1e-3, "{whole}");
        }
    }
}
