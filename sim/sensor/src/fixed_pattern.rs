//! Differences between pixels that are constant in time: response, dark current, defects.

use std::sync::{Mutex, PoisonError};

use contract::OutOfRange;
use draws::{Effect, Seed, Streams, normal};
use optics::pixel_factors::PixelFactors;
use rand::Rng;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Distribution of the dark currents of ordinary pixels.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum DarkCurrentDistribution {
    /// Log-normal distribution with the same mean: never negative, with a tail of high currents.
    #[default]
    LogNormal,
    /// Normal distribution, clipped at 0.
    Normal,
}

/// Differences between pixels, fixed for the life of a detector. They depend only on `seed`. All are off by
/// default.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct FixedPatternConfig {
    /// Seed of this detector; not the seed of the scenario.
    #[schemars(range(max = u64::MAX))]
    pub seed: u64,
    /// Photo-response non-uniformity (PRNU): standard deviation of the pixels' sensitivity to light as a
    /// fraction of its mean, 0 to 0.3. Normal distribution, clipped at 0.
    #[schemars(range(min = 0, max = 0.3))]
    pub prnu_fraction: f64,
    /// Dark-signal non-uniformity (DSNU): standard deviation of the pixels' dark current as a fraction of its
    /// mean, 0 to 5.
    #[schemars(range(min = 0, max = 5))]
    pub dsnu_fraction: f64,
    /// Distribution of the dark currents.
    pub dsnu_law: DarkCurrentDistribution,
    /// Standard deviation of the column offsets, which are added to every frame, electrons, 0 to 500. Normal
    /// distribution.
    #[schemars(range(min = 0, max = 500))]
    pub column_offset_e: f64,
    /// Number of dead pixels, at most a tenth of all pixels (26843545 for the largest detector); dead pixels
    /// collect neither photoelectrons nor dark current.
    #[schemars(range(max = 26_843_545))]
    pub dead_pixels: usize,
    /// Number of dead columns, at most a tenth of all columns.
    #[schemars(range(max = 1638))]
    pub dead_columns: usize,
}

/// Fixed pattern of a detector, computed once; empty for effects that are off.
#[derive(Debug, Clone, PartialEq, Default)]
pub(super) struct FixedPattern {
    /// Sensitivity of each pixel, with mean 1.
    pub(super) response: PixelFactors,
    /// Dark current of each pixel as a multiple of the mean.
    pub(super) dark: PixelFactors,
    /// Offset of each column, electrons.
    pub(super) column_offsets_e: Vec<f64>,
    /// Column and row of each dead pixel, dead columns included, in image order.
    pub(super) dead: Vec<(usize, usize)>,
}

/// Most recent pattern, with its configuration and size. A detector is the same in all cases of a study, and
/// its pattern takes longer to compute than many frames.
static LAST: Mutex<Option<(FixedPatternConfig, [usize; 2], FixedPattern)>> = Mutex::new(None);
/// Maximum number of pixels of a cached pattern.
const MAX_CACHED_PIXELS: usize = 1 << 22;

impl FixedPattern {
    /// Returns the pattern of a detector; reuses the most recent pattern if it matches.
    ///
    /// # Errors
    /// See [`FixedPattern::new`].
    pub(super) fn from_config(
        config: &FixedPatternConfig,
        columns: usize,
        rows: usize,
    ) -> Result<Self, OutOfRange> {
        // The pattern is stored in one assignment, so a thread that panicked with the lock held cannot have
        // left a partial pattern.
        let last = || LAST.lock().unwrap_or_else(PoisonError::into_inner);
        let size = [columns, rows];
        if let Some((_, _, pattern)) = last().as_ref().filter(|(of, at, _)| (of, *at) == (config, size)) {
            return Ok(pattern.clone());
        }
        let pattern = Self::new(config, columns, rows)?;
        if columns * rows <= MAX_CACHED_PIXELS {
            *last() = Some((config.clone(), size, pattern.clone()));
        }
        Ok(pattern)
    }

    /// Computes the pattern of a detector.
    ///
    /// # Errors
    /// [`OutOfRange`] if more than a tenth of all pixels or columns would be dead.
    pub(super) fn new(config: &FixedPatternConfig, columns: usize, rows: usize) -> Result<Self, OutOfRange> {
        let seed = Seed { seed: config.seed, case: 0 };
        let standard = |effect: Effect, number: usize| normal(&mut seed.stream(0, effect, number as u64));
        let pixels = |on: bool| 0..if on { columns * rows } else { 0 };
        let response = |index| (1.0 + config.prnu_fraction * standard(Effect::PixelResponse, index)).max(0.0);
        // A log-normal distribution of mean 1 and standard deviation s has σ² = ln(1 + s²) and μ = −σ²/2.
        let variance = libm::log1p(config.dsnu_fraction * config.dsnu_fraction);
        let dark = |index| {
            let z = standard(Effect::DarkPattern, index);
            match config.dsnu_law {
                DarkCurrentDistribution::LogNormal => libm::exp(variance.sqrt() * z - 0.5 * variance),
                DarkCurrentDistribution::Normal => (1.0 + config.dsnu_fraction * z).max(0.0),
            }
        };
        let offset = |x| config.column_offset_e * standard(Effect::ColumnOffset, x);
        let offsets = 0..if config.column_offset_e > 0.0 { columns } else { 0 };
        let response = pixels(config.prnu_fraction > 0.0).map(|index| response(index) as f32);
        let dark = pixels(config.dsnu_fraction > 0.0).map(|index| dark(index) as f32);
        Ok(Self {
            response: PixelFactors::new(columns, response),
            dark: PixelFactors::new(columns, dark),
            column_offsets_e: offsets.map(offset).collect(),
            dead: dead(config, seed, columns, rows)?,
        })
    }

    /// Returns true if a pixel is dead.
    pub(super) fn is_dead(&self, x: usize, y: usize) -> bool {
        self.dead.binary_search_by_key(&(y, x), |&(x, y)| (y, x)).is_ok()
    }
}

/// Returns dead pixels and the pixels of dead columns, in image order.
fn dead(
    config: &FixedPatternConfig,
    seed: Seed,
    columns: usize,
    rows: usize,
) -> Result<Vec<(usize, usize)>, OutOfRange> {
    for (field, count, of, expected) in [
        (
            "sensor.fixed_pattern.dead_pixels",
            config.dead_pixels,
            columns * rows,
            "at most a tenth of all pixels",
        ),
        ("sensor.fixed_pattern.dead_columns", config.dead_columns, columns, "at most a tenth of all columns"),
    ] {
        if count > of / 10 {
            return Err(OutOfRange::new(field, count, expected));
        }
    }
    let pixels = distinct(config.dead_pixels, columns * rows, seed.streams(0, Effect::DeadPixels));
    let mut dead: Vec<(usize, usize)> =
        pixels.into_iter().map(|index| (index % columns, index / columns)).collect();
    for x in distinct(config.dead_columns, columns, seed.streams(0, Effect::DeadColumns)) {
        dead.extend((0..rows).map(|y| (x, y)));
    }
    dead.sort_by_key(|&(x, y)| (y, x));
    dead.dedup();
    Ok(dead)
}

/// Draws `count` distinct integers below `of`; `count` is at most a tenth of `of`. A higher count keeps the
/// integers of a lower count.
fn distinct(count: usize, of: usize, streams: Streams) -> Vec<usize> {
    let mut taken = vec![false; if count > 0 { of } else { 0 }];
    (0..count)
        .map(|number| {
            let mut stream = streams.stream_at(number as u64);
            loop {
                // Highest bits of a product: uniform to within of/2^64.
                let index = ((u128::from(stream.next_u64()) * of as u128) >> 64) as usize;
                if !std::mem::replace(&mut taken[index], true) {
                    break index;
                }
            }
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_pattern_that_is_kept_is_the_pattern() {
        let config =
            |seed| FixedPatternConfig { seed, prnu_fraction: 0.1, dead_pixels: 3, ..Default::default() };
        for (seed, columns) in [(1, 40), (1, 40), (2, 40), (1, 41), (1, 40)] {
            let made = FixedPattern::new(&config(seed), columns, 30).unwrap();
            assert_eq!(FixedPattern::from_config(&config(seed), columns, 30).unwrap(), made);
        }
    }
    use statrs::distribution::{ContinuousCDF, LogNormal, Normal};

    /// Kolmogorov–Smirnov distance times √n: above 2.23 with a probability of 1 in 10,000.
    fn distance(mut values: Vec<f64>, law: &impl ContinuousCDF<f64, f64>) -> f64 {
        values.sort_by(f64::total_cmp);
        let n = values.len() as f64;
        let gaps = values.iter().enumerate().map(|(i, v)| (law.cdf(*v) - (i as f64 + 0.5) / n).abs());
        gaps.fold(0.0, f64::max) * n.sqrt()
    }

    fn widened(factors: &PixelFactors) -> Vec<f64> {
        factors.iter().map(f64::from).collect()
    }

    #[test]
    fn each_pattern_follows_its_distribution() {
        let config = FixedPatternConfig {
            seed: 4,
            prnu_fraction: 0.02,
            dsnu_fraction: 0.5,
            column_offset_e: 3.0,
            ..FixedPatternConfig::default()
        };
        let pattern = FixedPattern::new(&config, 300, 100).unwrap();
        assert!(distance(widened(&pattern.response), &Normal::new(1.0, 0.02).unwrap()) < 2.23);
        let sigma = libm::log(1.25_f64).sqrt();
        let log_normal = LogNormal::new(-0.5 * sigma * sigma, sigma).unwrap();
        assert!(distance(widened(&pattern.dark), &log_normal) < 2.23);
        assert!(distance(pattern.column_offsets_e, &Normal::new(0.0, 3.0).unwrap()) < 2.23);
        let config =
            FixedPatternConfig { dsnu_law: DarkCurrentDistribution::Normal, dsnu_fraction: 0.1, ..config };
        let pattern = FixedPattern::new(&config, 300, 100).unwrap();
        assert!(distance(widened(&pattern.dark), &Normal::new(1.0, 0.1).unwrap()) < 2.23);
    }

    #[test]
    fn nothing_is_negative() {
        for dsnu_law in [DarkCurrentDistribution::LogNormal, DarkCurrentDistribution::Normal] {
            let config =
                FixedPatternConfig { prnu_fraction: 0.3, dsnu_fraction: 2.0, dsnu_law, ..Default::default() };
            let pattern = FixedPattern::new(&config, 100, 100).unwrap();
            let factors: Vec<_> = pattern.response.iter().chain(pattern.dark.iter()).collect();
            assert!(factors.len() == 20_000 && factors.iter().all(|factor| *factor >= 0.0));
        }
    }

    #[test]
    fn the_requested_number_is_dead_and_a_higher_count_keeps_the_others() {
        let pattern = |dead_pixels, dead_columns| {
            let config = FixedPatternConfig { seed: 1, dead_pixels, dead_columns, ..Default::default() };
            FixedPattern::new(&config, 40, 30)
        };
        let (few, many) = (pattern(20, 0).unwrap(), pattern(100, 0).unwrap());
        assert_eq!((few.dead.len(), many.dead.len()), (20, 100));
        assert!(few.dead.iter().all(|&(x, y)| many.is_dead(x, y)));
        assert_eq!((0..1200).filter(|i| few.is_dead(i % 40, i / 40)).count(), 20);
        assert_eq!(pattern(0, 2).unwrap().dead.len(), 60);
        assert!(pattern(121, 0).is_err() && pattern(0, 5).is_err());
    }

    #[test]
    fn an_effect_switched_off_leaves_the_others_as_they_were() {
        let all = FixedPatternConfig {
            seed: 4,
            prnu_fraction: 0.02,
            dsnu_fraction: 0.5,
            column_offset_e: 3.0,
            dead_pixels: 7,
            dead_columns: 1,
            ..FixedPatternConfig::default()
        };
        let pattern = |config: &FixedPatternConfig| FixedPattern::new(config, 30, 20).unwrap();
        let (with, without) =
            (pattern(&all), pattern(&FixedPatternConfig { prnu_fraction: 0.0, ..all.clone() }));
        assert_eq!(without, FixedPattern { response: PixelFactors::default(), ..with.clone() });
        let without =
            pattern(&FixedPatternConfig { dsnu_fraction: 0.0, column_offset_e: 0.0, ..all.clone() });
        assert_eq!(without, FixedPattern { dark: PixelFactors::default(), column_offsets_e: vec![], ..with });
    }
}
