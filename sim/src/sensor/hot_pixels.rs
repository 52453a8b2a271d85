//! Hot pixels: a fixed pattern of high dark currents.

use rand::Rng;

use super::config::HotPixelConfig;
use crate::SimError;
use crate::randomness::{Effect, Seed, normal};

/// A pixel with a high dark current.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HotPixel {
    /// Column.
    pub x: usize,
    /// Row.
    pub y: usize,
    /// Its dark current above that of an ordinary pixel, electrons a second.
    pub rate_e_per_s: f64,
}

/// The hot pixels of a detector, in the order of the image. They depend on the sensor's seed alone; a higher count
/// adds pixels and keeps the ones there were.
///
/// # Errors
/// [`SimError::Parameter`] when more than a tenth of all pixels would be hot.
pub(super) fn hot_pixels(
    config: &HotPixelConfig,
    columns: usize,
    rows: usize,
) -> Result<Vec<HotPixel>, SimError> {
    let pixels = columns * rows;
    // So few that a place drawn at random is free nine times in ten.
    if config.count > pixels / 10 {
        return Err(SimError::Parameter {
            field: "sensor.hot_pixels.count",
            value: config.count.to_string(),
            expected: "at most a tenth of all pixels",
        });
    }
    let streams = Seed { seed: config.seed, case: 0 }.streams(0, Effect::HotPixels);
    let mut taken = vec![false; if config.count > 0 { pixels } else { 0 }];
    let mut hot: Vec<HotPixel> = (0..config.count)
        .map(|number| {
            let mut stream = streams.at(number as u64);
            let rate_e_per_s = config.median_e_per_s * libm::exp(config.spread * normal(&mut stream));
            let index = loop {
                // The highest bits of a product: uniform but for pixels/2^64.
                let index = ((u128::from(stream.next_u64()) * pixels as u128) >> 64) as usize;
                if !std::mem::replace(&mut taken[index], true) {
                    break index;
                }
            };
            HotPixel { x: index % columns, y: index / columns, rate_e_per_s }
        })
        .collect();
    hot.sort_by_key(|pixel| (pixel.y, pixel.x));
    Ok(hot)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn config(count: usize) -> HotPixelConfig {
        HotPixelConfig { count, seed: 8, median_e_per_s: 100.0, spread: 1.5 }
    }

    #[test]
    fn no_pixel_is_hot_twice_and_a_higher_count_keeps_the_others() {
        let few = hot_pixels(&config(50), 40, 30).unwrap();
        let many = hot_pixels(&config(120), 40, 30).unwrap();
        assert_eq!((few.len(), many.len()), (50, 120));
        assert!(many.windows(2).all(|pair| (pair[0].y, pair[0].x) < (pair[1].y, pair[1].x)));
        assert!(few.iter().all(|pixel| many.contains(pixel)));
    }

    #[test]
    fn their_currents_are_log_normal() {
        use statrs::distribution::{ContinuousCDF, LogNormal};
        let law = LogNormal::new(libm::log(100.0), 1.5).unwrap();
        let mut rates: Vec<f64> =
            hot_pixels(&config(10_000), 400, 400).unwrap().iter().map(|pixel| pixel.rate_e_per_s).collect();
        rates.sort_by(f64::total_cmp);
        let n = rates.len() as f64;
        let distance = rates
            .iter()
            .enumerate()
            .map(|(i, rate)| (law.cdf(*rate) - (i as f64 + 0.5) / n).abs())
            .fold(0.0, f64::max);
        // Kolmogorov-Smirnov at the 1e-4 level.
        assert!(distance < 2.23 / n.sqrt(), "{distance}");
    }

    #[test]
    fn too_many_are_refused() {
        assert!(hot_pixels(&config(121), 40, 30).is_err());
        assert!(hot_pixels(&config(0), 0, 0).unwrap().is_empty());
    }
}
