//! Edges in a profile of grey values across a bright bar.

/// Grey levels of the plate and of its bright features.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Levels {
    pub(crate) dark: f64,
    pub(crate) bright: f64,
}

impl Levels {
    pub(crate) fn contrast(&self) -> f64 {
        self.bright - self.dark
    }
}

/// Smallest height of a bar over its surroundings in a profile, as a share of the full contrast. A lower bar
/// is in shadow or covered.
const MIN_HEIGHT: f64 = 0.4;

/// Smallest width of a bar, in samples, that has a plateau to take a level from.
const MIN_PLATEAU_SAMPLES: f64 = 4.0;

/// Finds the two edges of a bright bar of about the given width. `values` are grey values at `first`,
/// `first + step`, …, and extend a little beyond the bar on both sides. Returns `None` where there is no such
/// bar.
///
/// An edge is defined as the position of a step with the same sum of grey values. This position is accurate
/// to a few hundredths of a pixel although the rows of a field are undersampled; a crossing of the half level
/// between two samples is not.
pub(crate) fn bar_edges(
    values: &[f64],
    first: f64,
    step: f64,
    width: f64,
    levels: &Levels,
) -> Option<(f64, f64)> {
    let n = values.len();
    if n < 4 {
        return None;
    }
    let ends = if n >= 8 { 2 } else { 1 };
    let mean = |part: &[f64]| part.iter().sum::<f64>() / part.len() as f64;
    let (before, after) = (mean(&values[..ends]), mean(&values[n - ends..]));
    let peak = values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let surround = before.max(after);
    if !(peak - surround >= MIN_HEIGHT * levels.contrast() && surround < (levels.dark + levels.bright) / 2.0)
    {
        return None;
    }
    let sample_position = |i: f64| first + step * i;
    let background = |i: usize| before + (after - before) * i as f64 / (n - 1) as f64;
    let excess: Vec<f64> = values.iter().enumerate().map(|(i, v)| (v - background(i)).max(0.0)).collect();
    let sum: f64 = excess.iter().sum();
    let centroid = excess.iter().enumerate().map(|(i, e)| i as f64 * e).sum::<f64>() / sum;
    if width < MIN_PLATEAU_SAMPLES * step {
        let seen = (sum * step / levels.contrast()).clamp(0.3 * width, 1.7 * width);
        let middle = sample_position(centroid);
        return Some((middle - seen / 2.0, middle + seen / 2.0));
    }
    let half_core = 0.3 * width / step;
    let mut core: Vec<f64> = values
        .iter()
        .enumerate()
        .filter(|(i, _)| (*i as f64 - centroid).abs() <= half_core)
        .map(|(_, v)| *v)
        .collect();
    core.sort_by(f64::total_cmp);
    let plateau = *core.get(core.len() / 2)?;
    if plateau - surround < MIN_HEIGHT * levels.contrast() {
        return None;
    }
    let middle = centroid.round() as usize;
    let covered = |part: &[f64], level: f64| -> f64 {
        part.iter().map(|v| ((v - level) / (plateau - level)).clamp(-0.3, 1.3)).sum()
    };
    let low = sample_position(middle as f64 - 0.5 - covered(&values[..middle], before));
    let high = sample_position(middle as f64 + 0.5 + covered(values.get(middle + 1..)?, after));
    let seen = high - low;
    (seen > 0.5 * width && seen < 1.6 * width).then_some((low, high))
}

/// Returns the distance at which a profile that begins bright first falls below the mean of the two levels.
/// Samples are at `first`, `first + step`, …, with linear interpolation between two samples. Returns `None`
/// when the profile does not begin bright or does not fall.
pub(crate) fn falling_edge(values: &[f64], first: f64, step: f64, levels: &Levels) -> Option<f64> {
    let half = (levels.dark + levels.bright) / 2.0;
    if *values.first()? < half {
        return None;
    }
    let i = values.windows(2).position(|pair| pair[0] >= half && pair[1] < half)?;
    let share = (values[i] - half) / (values[i] - values[i + 1]);
    Some(first + step * (i as f64 + share))
}

#[cfg(test)]
mod tests {
    use super::*;

    const LEVELS: Levels = Levels { dark: 20.0, bright: 180.0 };

    /// Returns the profile of a bar from `low` to `high`, blurred by a Gaussian of 0.85 px, at positions
    /// `first`, `first + step`, ….
    fn bar(low: f64, high: f64, first: f64, step: f64, n: usize) -> Vec<f64> {
        let erf = |x: f64| libm::erf(x / (0.85 * std::f64::consts::SQRT_2));
        (0..n)
            .map(|i| {
                let x = first + step * i as f64;
                LEVELS.dark + LEVELS.contrast() * (erf(x - low) - erf(x - high)) / 2.0
            })
            .collect()
    }

    fn check(low: f64, high: f64, first: f64, step: f64, n: usize, tolerance: f64) {
        let (a, b) = bar_edges(&bar(low, high, first, step, n), first, step, high - low, &LEVELS).unwrap();
        assert!(((a + b) - (low + high)).abs() / 2.0 < tolerance, "middle of {a} {b}, bar {low} {high}");
        assert!((b - a - (high - low)).abs() < 4.0 * tolerance, "width of {a} {b}, bar {low} {high}");
    }

    #[test]
    fn edges_of_a_bar_are_found_at_any_phase_of_the_samples() {
        for i in 0..20 {
            let shift = 0.1 * f64::from(i);
            // Columns are well sampled. The clipped tails of the blur cost a hundredth.
            check(20.0 + shift, 32.0 + shift, 10.0, 1.0, 34, 0.01);
            // Rows of a field: the first alias of the blur, exp(−2 (π 0.85/2)²)/π rows of 2 px.
            check(20.0 + shift, 32.0 + shift, 10.0, 2.0, 17, 0.04);
            // A thin bar of a distant target.
            check(20.0 + shift, 23.0 + shift, 14.0, 1.0, 16, 0.01);
            check(20.0 + shift, 23.0 + shift, 10.0, 2.0, 13, 0.06);
        }
    }

    #[test]
    fn a_shadowed_a_bounded_and_a_missing_bar_are_refused() {
        let shadow: Vec<f64> =
            bar(20.0, 32.0, 10.0, 1.0, 34).iter().map(|v| 20.0 + 0.3 * (v - 20.0)).collect();
        assert_eq!(bar_edges(&shadow, 10.0, 1.0, 12.0, &LEVELS), None);
        assert_eq!(bar_edges(&[20.0; 30], 10.0, 1.0, 12.0, &LEVELS), None);
        assert_eq!(bar_edges(&[180.0; 30], 10.0, 1.0, 12.0, &LEVELS), None);
        assert_eq!(bar_edges(&bar(20.0, 60.0, 10.0, 1.0, 34), 10.0, 1.0, 12.0, &LEVELS), None);
        assert_eq!(bar_edges(&[20.0, 180.0], 10.0, 1.0, 1.0, &LEVELS), None);
    }

    #[test]
    fn the_end_of_an_arm_is_where_it_falls_to_the_middle() {
        let values = bar(-50.0, 12.3, 0.0, 1.0, 30);
        // Linear interpolation of an error function: a fiftieth of a pixel.
        assert!((falling_edge(&values, 0.0, 1.0, &LEVELS).unwrap() - 12.3).abs() < 0.02);
        assert_eq!(falling_edge(&[20.0; 9], 0.0, 1.0, &LEVELS), None);
        assert_eq!(falling_edge(&[180.0; 9], 0.0, 1.0, &LEVELS), None);
        assert_eq!(falling_edge(&[], 0.0, 1.0, &LEVELS), None);
    }
}
