//! Hot pixels: a fixed pattern of high dark currents.

use contract::OutOfRange;
use draws::{Effect, Seed, Stream, normal, uniform};
use rand::Rng;

use super::config::{HotPixelConfig, HotPixelDistribution};
use super::telegraph::switches;

/// A pixel with a high dark current.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HotPixel {
    /// Column.
    pub x: usize,
    /// Row.
    pub y: usize,
    /// Dark current above that of an ordinary pixel, electrons per second; for a switching pixel, in its high
    /// state.
    pub rate_e_per_s: f64,
    /// True if the dark current switches as random telegraph noise.
    pub switches: bool,
}

/// Returns the hot pixels of a detector, in image order. They depend only on the sensor's seed; a higher
/// count adds pixels and keeps the existing ones. `warmth` multiplies the currents.
///
/// # Errors
/// [`OutOfRange`] if more than a tenth of all pixels would be hot.
pub(super) fn hot_pixels(
    config: &HotPixelConfig,
    columns: usize,
    rows: usize,
    warmth: f64,
) -> Result<Vec<HotPixel>, OutOfRange> {
    let pixels = columns * rows;
    // With this limit a randomly drawn position is free in at least nine of ten draws.
    if config.count > pixels / 10 {
        return Err(OutOfRange::new(
            "sensor.hot_pixels.count",
            config.count,
            "at most a tenth of all pixels",
        ));
    }
    let streams = Seed { seed: config.seed, case: 0 }.streams(0, Effect::HotPixels);
    let mut taken = vec![false; if config.count > 0 { pixels } else { 0 }];
    let mut hot: Vec<HotPixel> = (0..config.count)
        .map(|number| {
            let mut stream = streams.stream_at(number as u64);
            let rate_e_per_s = warmth * current(config, &mut stream);
            let index = loop {
                // Highest bits of a product: uniform to within pixels/2^64.
                let index = ((u128::from(stream.next_u64()) * pixels as u128) >> 64) as usize;
                if !std::mem::replace(&mut taken[index], true) {
                    break index;
                }
            };
            let switches = switches(config.telegraph.as_ref(), &mut stream);
            HotPixel { x: index % columns, y: index / columns, rate_e_per_s, switches }
        })
        .collect();
    hot.sort_by_key(|pixel| (pixel.y, pixel.x));
    Ok(hot)
}

/// Draws a dark current at the reference temperature, electrons per second.
fn current(config: &HotPixelConfig, stream: &mut Stream) -> f64 {
    // A tail without a mean needs an upper limit.
    const MAX_E_PER_S: f64 = 1e9;
    let factor = match config.law {
        HotPixelDistribution::LogNormal => libm::exp(config.spread * normal(stream)),
        HotPixelDistribution::Pareto { index } => libm::pow(2.0 * uniform(stream), -1.0 / index),
    };
    (config.median_e_per_s * factor).min(MAX_E_PER_S)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::TelegraphConfig;

    fn config(count: usize) -> HotPixelConfig {
        HotPixelConfig { count, seed: 8, median_e_per_s: 100.0, spread: 1.5, ..HotPixelConfig::default() }
    }

    #[test]
    fn no_pixel_is_hot_twice_and_a_higher_count_keeps_the_others() {
        let few = hot_pixels(&config(50), 40, 30, 1.0).unwrap();
        let many = hot_pixels(&config(120), 40, 30, 1.0).unwrap();
        assert_eq!((few.len(), many.len()), (50, 120));
        assert!(many.windows(2).all(|pair| (pair[0].y, pair[0].x) < (pair[1].y, pair[1].x)));
        assert!(few.iter().all(|pixel| many.contains(pixel)));
    }

    #[test]
    fn their_currents_follow_their_distribution() {
        use statrs::distribution::{LogNormal, Pareto};
        follow(&config(10_000), &LogNormal::new(libm::log(100.0), 1.5).unwrap());
        let pareto = HotPixelConfig { law: HotPixelDistribution::Pareto { index: 1.2 }, ..config(10_000) };
        follow(&pareto, &Pareto::new(100.0 / libm::pow(2.0, 1.0 / 1.2), 1.2).unwrap());
    }

    fn follow(config: &HotPixelConfig, law: &impl statrs::distribution::ContinuousCDF<f64, f64>) {
        let mut rates: Vec<f64> =
            hot_pixels(config, 400, 400, 1.0).unwrap().iter().map(|pixel| pixel.rate_e_per_s).collect();
        rates.sort_by(f64::total_cmp);
        let n = rates.len() as f64;
        let distance = rates
            .iter()
            .enumerate()
            .map(|(i, rate)| (law.cdf(*rate) - (i as f64 + 0.5) / n).abs())
            .fold(0.0, f64::max);
        // Kolmogorov–Smirnov test at the 1e-4 level.
        assert!(distance < 2.23 / n.sqrt(), "{distance}");
    }

    #[test]
    fn the_requested_number_switches_and_nothing_else_changes() {
        let telegraph = TelegraphConfig { fraction: 0.3, low_level: 0.1, high_s: 10.0, low_s: 10.0 };
        let with = HotPixelConfig { telegraph: Some(telegraph), ..config(10_000) };
        let (with, without) =
            (hot_pixels(&with, 400, 400, 1.0).unwrap(), hot_pixels(&config(10_000), 400, 400, 1.0).unwrap());
        let switching = with.iter().filter(|pixel| pixel.switches).count();
        // Binomial distribution: 3000 ± 46; four standard deviations.
        assert!(switching.abs_diff(3000) < 184, "{switching}");
        assert_eq!((with.len(), without.len()), (10_000, 10_000));
        assert!(with.iter().zip(&without).all(|(a, b)| HotPixel { switches: false, ..*a } == *b));
    }

    #[test]
    fn too_many_are_refused() {
        assert!(hot_pixels(&config(121), 40, 30, 1.0).is_err());
        assert!(hot_pixels(&config(0), 0, 0, 1.0).unwrap().is_empty());
    }
}
