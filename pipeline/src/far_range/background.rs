//! Brightness of the background and its noise, from a histogram.

use contract::{Frame, Window};

/// Level and noise of the background, DN.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Background {
    /// Median, interpolated within its bin, DN.
    pub(super) median_dn: f64,
    /// Standard deviation, from the difference between the median and the 16th percentile, DN. Stars only
    /// brighten pixels, so the lower side is pure noise.
    pub(super) sigma_dn: f64,
}

/// Estimator of [`Background`] with a reusable histogram, so a frame needs no allocation.
#[derive(Debug, Default)]
pub(super) struct BackgroundEstimator {
    counts: Vec<[u32; TABLES]>,
}

/// Number of tables. Adjacent pixels are counted in different tables; otherwise each increment of a bin would
/// have to wait for the previous one.
const TABLES: usize = 4;

/// Approximate number of pixels sampled; excess rows are skipped. The median of 32768 pixels is accurate to
/// 0.7 % of the noise, and a histogram of the whole frame would cost more than its detection.
const SAMPLE_PIXELS: usize = 32_768;

/// Fraction of a normal distribution below its mean minus one standard deviation.
const BELOW_ONE_SIGMA: f64 = 0.158_655_253_931_457;

/// Noise of rounding to integer DN, 1/√12: the lower limit of the noise.
const QUANTISATION_DN: f64 = 0.288_675_134_594_812_9;

impl BackgroundEstimator {
    /// Estimates the background of the transmitted pixels (pixels outside the windows have no meaning).
    /// Returns `None` when none was transmitted. Pixels common to several windows are counted more than once.
    pub(super) fn estimate(&mut self, frame: &Frame) -> Option<Background> {
        let full_scale = frame.full_scale_dn();
        self.counts.clear();
        self.counts.resize(usize::from(full_scale) + 1, [0; TABLES]);
        let whole = [Window { x: 0, y: 0, columns: frame.columns(), rows: frame.rows() }];
        let windows = frame.windows().unwrap_or(&whole);
        let transmitted: usize = windows.iter().map(|window| window.columns * window.rows).sum();
        let step = (transmitted / SAMPLE_PIXELS).max(1);
        let rows = windows.iter().flat_map(|window| {
            (window.y..window.y + window.rows).map(|y| &frame.row(y)[window.x..window.x + window.columns])
        });
        let mut sampled = 0;
        for row in rows.step_by(step) {
            sampled += row.len();
            let (fours, rest) = row.as_chunks::<TABLES>();
            for pixels in fours.iter().map(<[u16; TABLES]>::as_slice).chain([rest]) {
                for (table, &dn) in pixels.iter().enumerate() {
                    self.counts[usize::from(dn.min(full_scale))][table] += 1;
                }
            }
        }
        let rank = |fraction: f64| fraction * sampled as f64;
        let [(lower_bin, lower), (_, median_dn)] = self.at_ranks([BELOW_ONE_SIGMA, 0.5].map(rank))?;
        // A lower percentile in the first bin is clipped by the converter and does not represent the noise.
        let sigma_dn = if lower_bin > 0 {
            median_dn - lower
        } else {
            let [(_, upper)] = self.at_ranks([1.0 - BELOW_ONE_SIGMA].map(rank))?;
            upper - median_dn
        };
        Some(Background { median_dn, sigma_dn: sigma_dn.max(QUANTISATION_DN) })
    }

    /// Returns the bins that contain the pixels of given ranks, in ascending order, and the values there,
    /// interpolated within each bin (bin n covers n ± 0.5). Returns `None` without any pixels.
    fn at_ranks<const N: usize>(&self, ranks: [f64; N]) -> Option<[(usize, f64); N]> {
        let (mut found, mut next) = ([(0, 0.0); N], 0);
        let mut below = 0.0;
        for (bin, tables) in self.counts.iter().enumerate() {
            let count = tables.iter().sum::<u32>();
            if count == 0 {
                continue;
            }
            let count = f64::from(count);
            while let Some(&rank) = ranks.get(next) {
                if below + count < rank {
                    break;
                }
                found[next] = (bin, bin as f64 - 0.5 + (rank - below) / count);
                next += 1;
            }
            if next == N {
                return Some(found);
            }
            below += count;
        }
        None
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns rounded normal deviates by the inverse of the normal distribution on an even grid, without a
    /// random generator.
    fn normal_dn(n: usize, mean: f64, sigma: f64) -> Vec<u16> {
        let mut values: Vec<u16> = (0..n)
            .map(|i| {
                let p = (i as f64 + 0.5) / n as f64;
                // Bisection on the error function of libm.
                let (mut low, mut high) = (-8.0, 8.0);
                for _ in 0..60 {
                    let middle = 0.5 * (low + high);
                    let below = 0.5 * libm::erfc(-middle / std::f64::consts::SQRT_2);
                    if below < p { low = middle } else { high = middle }
                }
                (mean + sigma * low).round().max(0.0) as u16
            })
            .collect();
        // Spread over the frame, because rows are sampled.
        let len = values.len();
        for i in 0..len {
            values.swap(i, (i * 7919) % len);
        }
        values
    }

    fn estimate(dn: Vec<u16>, windows: Option<Vec<Window>>) -> Option<Background> {
        let frame = Frame::new(0, 100, dn.len() / 100, 12, dn, windows).unwrap();
        BackgroundEstimator::default().estimate(&frame)
    }

    #[test]
    fn level_and_noise_of_a_normal_background_are_recovered() {
        for sigma in [0.8, 1.5, 10.0] {
            let got = estimate(normal_dn(10_000, 100.3, sigma), None).unwrap();
            // Linear interpolation within bins of 1 DN, which is coarse when the noise is less than a bin.
            let with_rounding = (sigma * sigma + 1.0 / 12.0).sqrt();
            assert!((got.median_dn - 100.3).abs() < 0.06, "{got:?}");
            assert!((got.sigma_dn / with_rounding - 1.0).abs() < 0.1, "{got:?}");
        }
    }

    #[test]
    fn stars_do_not_raise_it() {
        let mut dn = normal_dn(10_000, 100.0, 3.0);
        dn.iter_mut().step_by(50).for_each(|v| *v = 3000);
        let got = estimate(dn, None).unwrap();
        // 2 % of stars shift the median and the 16th percentile by about 0.03 σ each.
        assert!((got.median_dn - 100.0).abs() < 0.2 && (got.sigma_dn - 3.0).abs() < 0.2, "{got:?}");
    }

    #[test]
    fn a_background_cut_at_zero_is_measured_above() {
        let got = estimate(normal_dn(10_000, 1.0, 3.0), None).unwrap();
        assert!((got.sigma_dn - 3.0).abs() < 0.3, "{got:?}");
    }

    #[test]
    fn pixels_outside_the_windows_are_ignored() {
        let mut dn = vec![0; 10_000];
        for y in 20..40 {
            dn[y * 100 + 10..y * 100 + 30].fill(200);
        }
        let window = Window { x: 10, y: 20, columns: 20, rows: 20 };
        assert!((estimate(dn.clone(), Some(vec![window])).unwrap().median_dn - 200.0).abs() < 0.5);
        assert_eq!(estimate(dn, Some(Vec::new())), None);
    }
}
