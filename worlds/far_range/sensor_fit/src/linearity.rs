//! Linearity error of EMVA 1288.

use libm::sqrt;

use crate::figures::Finding;

/// Range of the levels, as shares of the saturation (EMVA 1288).
const RANGE: [f64; 2] = [0.05, 0.95];

/// Smallest number of levels: a line has two parameters.
const MIN_LEVELS: usize = 3;

/// A level of light without its dark signal.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct LinearityLevel {
    /// Light times seconds.
    pub(crate) exposure: f64,
    /// Mean above the dark signal, DN, and its relative standard deviation, with the light's.
    pub(crate) signal: f64,
    pub(crate) relative_sigma: f64,
}

/// Returns LE: the mean absolute deviation from the line that has the least relative deviations, percent.
pub(crate) fn linearity_error(levels: &[LinearityLevel], saturation_dn: f64) -> Finding {
    let inside: Vec<LinearityLevel> = levels
        .iter()
        .filter(|level| (RANGE[0]..=RANGE[1]).contains(&(level.signal / saturation_dn)))
        .copied()
        .collect();
    if inside.len() < MIN_LEVELS {
        return Finding::missing(format!(
            "{} levels of light within 5 to 95 % of the saturation: {MIN_LEVELS} or more determine the \
             linearity (EMVA 1288: 9)",
            inside.len()
        ));
    }
    // Line a0 + a1 H with weights 1/y²: the relative deviations have least squares.
    let mut sums = [0.0; 5];
    for level in &inside {
        let (weight, x, y) = (1.0 / (level.signal * level.signal), level.exposure, level.signal);
        let terms = [weight, weight * x, weight * x * x, weight * y, weight * x * y];
        sums.iter_mut().zip(terms).for_each(|(sum, term)| *sum += term);
    }
    let [s, sx, sxx, sy, sxy] = sums;
    let determinant = s * sxx - sx * sx;
    if determinant <= 1e-12 * s * sxx {
        return Finding::missing("the levels have one exposure: levels of different light determine it");
    }
    let (slope, offset) = ((s * sxy - sx * sy) / determinant, (sxx * sy - sx * sxy) / determinant);
    let count = inside.len() as f64;
    let deviation = |level: &LinearityLevel| {
        let line = offset + slope * level.exposure;
        (level.signal - line) / line
    };
    let error = inside.iter().map(|level| deviation(level).abs()).sum::<f64>() / count;
    let noise =
        sqrt(inside.iter().map(|level| level.relative_sigma * level.relative_sigma).sum::<f64>() / count);
    let sigma = noise / sqrt(count);
    if error < 2.0 * noise {
        return Finding::Below(100.0 * (error + 2.0 * sigma));
    }
    Finding::Value { value: 100.0 * error, sigma: 100.0 * sigma }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn levels(response: impl Fn(f64) -> f64) -> Vec<LinearityLevel> {
        (1..=9)
            .map(|i| {
                let exposure = 0.1 * f64::from(i);
                LinearityLevel { exposure, signal: response(exposure), relative_sigma: 1e-5 }
            })
            .collect()
    }

    #[test]
    fn a_line_has_no_error_and_a_parabola_that_of_its_residuals() {
        assert!(
            matches!(linearity_error(&levels(|x| 5.0 + 1000.0 * x), 1000.0), Finding::Below(limit) if limit < 0.01)
        );
        // numpy.polyfit(x, y, 1, w=1/y) of y = 1000 (x − 0.05 x²), x = 0.1 … 0.9, and the mean of
        // |y − line|/line: 0.68164 %.
        let Finding::Value { value, .. } = linearity_error(&levels(|x| 1000.0 * (x - 0.05 * x * x)), 1000.0)
        else {
            panic!("not determined");
        };
        assert!((value - 0.68164).abs() < 1e-4, "{value}");
    }

    #[test]
    fn two_levels_and_one_exposure_determine_nothing() {
        let few = levels(|x| 1000.0 * x);
        assert!(
            matches!(linearity_error(&few[..2], 1000.0), Finding::Missing(reason) if reason.contains("2 levels"))
        );
        let same: Vec<LinearityLevel> =
            few.iter().map(|level| LinearityLevel { exposure: 1.0, ..*level }).collect();
        assert!(matches!(linearity_error(&same, 1000.0), Finding::Missing(_)));
    }
}
