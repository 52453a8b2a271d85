//! Pixels that take no part in the figures.

use libm::{exp, log, sqrt};

/// Distance from the median at which a pixel is a defect, in standard deviations of the distribution's own
/// side: a good pixel of a million is beyond it.
const DEFECT_SIGMAS: f64 = 5.0;

/// Distance from the median up to which values show the deviation of the ordinary ones.
const NEAR_SIGMAS: f64 = 8.0;

/// Response below which a pixel is dead, as a share of the mean.
pub(crate) const DEAD_RESPONSE: f64 = 0.5;

/// Share of dead pixels above which a column is dead.
const DEAD_COLUMN_SHARE: f64 = 0.9;

/// Largest number of values of which the quantiles are taken.
const MAX_SAMPLES: usize = 200_000;

/// Kinds of defects of each pixel.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(crate) struct Defect {
    /// High dark current, or a high level without exposure.
    pub(crate) hot: bool,
    /// Response below half of the mean.
    pub(crate) dead: bool,
    /// Response outside of the distribution of the others.
    pub(crate) odd_response: bool,
    /// Temporal noise, or offset, outside of the distribution of the others.
    pub(crate) noisy: bool,
}

impl Defect {
    pub(crate) fn is_any(self) -> bool {
        self.hot || self.dead || self.odd_response || self.noisy
    }
}

/// Limits between which the values of ordinary pixels lie.
///
/// The distribution is taken as a log-normal one with a shift, whose quantiles at −1, 0 and 1 standard
/// deviations are those of the values: it covers the normal distribution and the tail of dark currents.
/// `floor` is the smallest standard deviation, for values that are mostly equal.
pub(crate) fn ordinary_limits(values: impl Iterator<Item = f32>, count: usize, floor: f64) -> [f64; 2] {
    let step = (count / MAX_SAMPLES).max(1);
    let mut sample: Vec<f32> = values.step_by(step).filter(|value| value.is_finite()).collect();
    sample.sort_by(f32::total_cmp);
    if sample.is_empty() {
        return [f64::NEG_INFINITY, f64::INFINITY];
    }
    let quantile = |share: f64| f64::from(sample[(share * (sample.len() - 1) as f64) as usize]);
    let median = quantile(0.5);
    let low = (median - quantile(0.158_655)).max(floor);
    let high = (quantile(0.841_345) - median).max(floor);
    // The quotient of the sides is exp(shape); the shape of a normal distribution is 0.
    let shape = log(high / low).clamp(-1.5, 1.5);
    let reach = |z: f64| {
        if shape.abs() < 0.02 {
            0.5 * (low + high) * z
        } else {
            low * (exp(shape * z) - 1.0) / (1.0 - exp(-shape))
        }
    };
    // The limits are not below those of a normal distribution with the deviation of the values near the
    // median: coarse numbers have quantiles that only seem narrow or skewed.
    let near = |value: &&f32| (f64::from(**value) - median).abs() < NEAR_SIGMAS * low.max(high);
    let (mut squares, mut count) = (0.0, 0.0);
    for value in sample.iter().filter(near) {
        squares += (f64::from(*value) - median) * (f64::from(*value) - median);
        count += 1.0;
    }
    let normal = DEFECT_SIGMAS * sqrt(squares / f64::max(count, 1.0));
    [median + reach(-DEFECT_SIGMAS).min(-normal), median + reach(DEFECT_SIGMAS).max(normal)]
}

/// Temporal variance of a pixel beyond which it is noisy, in units of the mean: the quantile of χ² of the
/// degrees of freedom at [`NOISY_SIGMAS`] (Wilson & Hilferty 1931).
pub(crate) fn noisy_limit(degrees: f64) -> f64 {
    const NOISY_SIGMAS: f64 = 6.0;
    let part = 2.0 / (9.0 * degrees);
    let root = 1.0 - part + NOISY_SIGMAS * sqrt(part);
    root * root * root
}

/// Returns the columns of which nine tenths are dead.
pub(crate) fn dead_columns(defects: &[Defect], columns: usize) -> Vec<usize> {
    let rows = defects.len() / columns.max(1);
    let mut dead = vec![0_usize; columns];
    for (index, _) in defects.iter().enumerate().filter(|(_, defect)| defect.dead) {
        dead[index % columns] += 1;
    }
    let is_dead = |column: &usize| dead[*column] as f64 > DEAD_COLUMN_SHARE * rows as f64;
    (0..columns).filter(is_dead).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Quantiles of a normal distribution, evenly spaced in probability.
    fn normal_values(count: usize) -> Vec<f64> {
        let below = |z: f64| 0.5 * libm::erfc(-z / std::f64::consts::SQRT_2);
        let quantile = |share: f64| {
            let (mut low, mut high) = (-8.0, 8.0);
            for _ in 0..50 {
                let middle = 0.5 * (low + high);
                if below(middle) > share { high = middle } else { low = middle }
            }
            0.5 * (low + high)
        };
        (0..count).map(|index| quantile((index as f64 + 0.5) / count as f64)).collect()
    }

    #[test]
    fn limits_of_normal_and_log_normal_values_leave_all_but_a_millionth() {
        let values = normal_values(20_001);
        let limits =
            |map: fn(f64) -> f64| ordinary_limits(values.iter().map(|z| map(*z) as f32), values.len(), 0.0);
        let [low, high] = limits(|z| 10.0 + 2.0 * z);
        assert!((low - 0.0).abs() < 0.1 && (high - 20.0).abs() < 0.1, "{low} {high}");
        let [low, high] = limits(|z| exp(0.5 * z));
        assert!(low < exp(-2.5) && (high / exp(2.5) - 1.0).abs() < 0.05, "{low} {high}");
    }

    #[test]
    fn hot_pixels_do_not_move_the_limits() {
        let values = normal_values(20_001);
        let with_hot = values.iter().enumerate().map(|(i, z)| if i % 100 == 0 { 1e4 } else { *z as f32 });
        let [low, high] = ordinary_limits(with_hot, values.len(), 0.0);
        assert!(low < -4.5 && low > -6.0 && high > 4.5 && high < 6.0, "{low} {high}");
    }

    #[test]
    fn the_limit_of_noise_falls_with_the_frames() {
        // χ² of one degree of freedom exceeds 33 as often as a normal number exceeds 5.7.
        assert!((20.0..60.0).contains(&noisy_limit(1.0)) && noisy_limit(20.0) < 5.0);
    }

    #[test]
    fn a_column_is_dead_with_nine_tenths_of_its_pixels() {
        let mut defects = vec![Defect::default(); 40 * 30];
        for row in 0..28 {
            defects[row * 40 + 7].dead = true;
        }
        defects[3].dead = true;
        assert_eq!(dead_columns(&defects, 40), [7]);
    }
}
