//! Thinning of long series. The omitted points of a line are invisible at screen resolution. For a point
//! cloud a random sample is drawn, which has the distribution of all points; drawing the extremes of each
//! stretch would misrepresent that distribution.

/// Maximum number of drawn points of a cloud: each is an element of the page, and more would slow a browser
/// down.
const MAX_CLOUD_POINTS: usize = 2500;
/// Parts of a long cloud whose extremes are drawn beside the sample.
const PARTS: usize = 50;
/// Maximum number of points of a curve in a plane.
const MAX_CURVE_POINTS: usize = 5000;
/// Number of stretches that a series is cut into. Two points per pixel column of a chart look the same as all
/// points.
const STRETCHES: usize = 700;

/// Returns the indices of the points of a cloud of `count` rows that are drawn: all, or a random one of each
/// stretch of consecutive rows, so that any part of the rows keeps its distribution. The indices ascend, and
/// depend only on `count`.
pub fn sampled(count: usize) -> Vec<usize> {
    if count <= MAX_CLOUD_POINTS {
        return (0..count).collect();
    }
    let one_of = |stretch: usize| {
        let (from, to) = (stretch * count / MAX_CLOUD_POINTS, (stretch + 1) * count / MAX_CLOUD_POINTS);
        from + (scrambled(stretch as u64) % (to - from) as u64) as usize
    };
    (0..MAX_CLOUD_POINTS).map(one_of).collect()
}

/// Returns a pseudo-random number (SplitMix64: Steele, Lea & Flood 2014). Regularly spaced indices would
/// reveal a period of the rows.
fn scrambled(number: u64) -> u64 {
    let mut z = number.wrapping_add(1).wrapping_mul(0x9e37_79b9_7f4a_7c15);
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^ (z >> 31)
}

/// Returns the indices of the smallest and the largest value in each fiftieth of the rows of a sampled cloud;
/// none for a cloud that is drawn completely.
pub fn extremes(count: usize, value: &dyn Fn(usize) -> f64) -> Vec<usize> {
    let mut kept = Vec::new();
    if count > MAX_CLOUD_POINTS {
        for part in bins(count, PARTS) {
            let numbers = || part.clone().filter(|&i| value(i).is_finite());
            kept.extend(numbers().min_by(|&a, &b| value(a).total_cmp(&value(b))));
            kept.extend(numbers().max_by(|&a, &b| value(a).total_cmp(&value(b))));
        }
        kept.sort_unstable();
        kept.dedup();
    }
    kept
}

/// Describes how many points of each cloud are drawn; each cloud has a count and a name of its points.
/// `rings` is true if the extremes are drawn as rings.
pub fn thinning_caption(clouds: &[(usize, &str)], rings: bool) -> String {
    let of = |&(count, what): &(usize, &str)| format!("{} of {count} {what}", sampled(count).len());
    let parts: Vec<String> = clouds.iter().filter(|(count, _)| *count > 0).map(of).collect();
    let mut text = match parts.as_slice() {
        [] => "No measurement.".to_owned(),
        parts => format!("Drawn: {}.", parts.join(" and ")),
    };
    if clouds.iter().any(|(count, _)| *count > MAX_CLOUD_POINTS) {
        text.push_str(" The sample has one random point per interval and so the distribution of all points.");
        if rings {
            text.push_str(" Rings mark the smallest and the largest point of each fiftieth part.");
        }
    }
    text
}

/// Returns the indices of the rows that are drawn for a curve in a plane, at even steps from 0 to `count`.
/// The extremes of both coordinates, which are drawn for a line over time, would turn a loop into a polygon.
pub fn evenly(count: usize) -> Vec<usize> {
    let step = count.div_ceil(MAX_CURVE_POINTS).max(1);
    let mut kept: Vec<usize> = (0..count).step_by(step).collect();
    if kept.last().is_some_and(|&last| last + 1 < count) {
        kept.push(count - 1);
    }
    kept
}

/// Returns the indices of the rows, of `count`, that a line needs: of each stretch of consecutive rows the
/// first, and those with the smallest and the largest value of each of the `series`. All indices are returned
/// if they are few. The indices ascend. Values that are not finite are ignored.
pub fn thinned(count: usize, series: &[&dyn Fn(usize) -> f64]) -> Vec<usize> {
    let most = STRETCHES * (1 + 2 * series.len());
    if count <= most {
        return (0..count).collect();
    }
    let mut kept = Vec::with_capacity(most);
    for stretch in 0..STRETCHES {
        let (from, to) = (stretch * count / STRETCHES, (stretch + 1) * count / STRETCHES);
        kept.push(from);
        for value in series {
            let numbers = || (from..to).filter(|&i| value(i).is_finite());
            kept.extend(numbers().min_by(|&a, &b| value(a).total_cmp(&value(b))));
            kept.extend(numbers().max_by(|&a, &b| value(a).total_cmp(&value(b))));
        }
    }
    kept.sort_unstable();
    kept.dedup();
    kept
}

/// Returns the index range of each of at most `most` bins, which together contain all `count` indices in
/// order.
pub fn bins(count: usize, most: usize) -> impl Iterator<Item = std::ops::Range<usize>> {
    let bins = count.min(most);
    (0..bins).map(move |bin| bin * count / bins..(bin + 1) * count / bins)
}

/// Returns count, minimum, mean and maximum of some values, as cells; values that are not finite are ignored.
pub fn summary(values: impl Iterator<Item = f64>, decimals: usize) -> [String; 4] {
    let (mut count, mut sum, mut low, mut high) = (0_u64, 0.0, f64::INFINITY, f64::NEG_INFINITY);
    for value in values.filter(|value| value.is_finite()) {
        count += 1;
        sum += value;
        low = low.min(value);
        high = high.max(value);
    }
    if count == 0 {
        return ["0".to_owned(), String::new(), String::new(), String::new()];
    }
    let cell = |value: f64| format!("{value:.decimals$}");
    [count.to_string(), cell(low), cell(sum / count as f64), cell(high)]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn few_rows_are_all_kept() {
        assert_eq!(thinned(5, &[&|i| i as f64]), [0, 1, 2, 3, 4]);
        assert!(thinned(0, &[]).is_empty());
    }

    #[test]
    fn of_many_rows_every_extreme_is_kept_and_order_too() {
        // One row in 997 is an outlier, alternately up and down; other rows are NaN.
        let value = |i: usize| match i % 1994 {
            11 => 5.0 + i as f64,
            1008 => -5.0 - i as f64,
            i if i % 7 == 0 => f64::NAN,
            _ => 0.0,
        };
        let kept = thinned(100_000, &[&value]);
        assert!(kept.len() <= 3 * STRETCHES && kept.is_sorted());
        let extremes: Vec<usize> = (0..100_000).filter(|&i| value(i).abs() >= 5.0).collect();
        assert_eq!(extremes.len(), 101);
        assert!(extremes.iter().all(|extreme| kept.contains(extreme)));
    }

    #[test]
    fn a_sample_has_the_quantiles_of_all_and_of_any_part_of_them() {
        // A sharply peaked distribution that widens towards the end, with a periodic component.
        let value = |i: usize| {
            let uniform = (scrambled(77 + i as u64) >> 11) as f64 / (1_u64 << 53) as f64 - 0.5;
            (1.0 + i as f64 / 30_000.0) * 8.0 * uniform * uniform * uniform + 0.1 * libm::sin(i as f64 / 3.0)
        };
        let kept = sampled(30_000);
        assert_eq!(kept.len(), MAX_CLOUD_POINTS);
        assert!(kept.is_sorted_by(|a, b| a < b) && kept.iter().all(|&i| i < 30_000));
        for part in [0..30_000, 0..10_000, 20_000..30_000] {
            let all: Vec<f64> = part.clone().map(value).collect();
            let drawn: Vec<f64> = kept.iter().copied().filter(|i| part.contains(i)).map(value).collect();
            for level in [-0.5, -0.1, -0.02, 0.0, 0.05, 0.3] {
                let below = |of: &[f64]| of.iter().filter(|&&v| v < level).count() as f64 / of.len() as f64;
                // Three standard deviations of a fraction in a sample of this size.
                let limit = 1.5 / (drawn.len() as f64).sqrt();
                assert!((below(&all) - below(&drawn)).abs() < limit, "{level} in {part:?}");
            }
        }
    }

    #[test]
    fn extremes_include_the_points_that_are_not_drawn() {
        let value = |i: usize| if i == 7_321 { 99.0 } else { (i % 13) as f64 };
        assert!(extremes(MAX_CLOUD_POINTS, &value).is_empty());
        let kept = extremes(20_000, &value);
        assert!(kept.contains(&7_321) && kept.is_sorted() && kept.len() <= 2 * PARTS);
        assert!(extremes(20_000, &|_| f64::NAN).is_empty());
    }

    #[test]
    fn a_caption_states_the_drawn_and_the_total_number() {
        assert_eq!(thinning_caption(&[(12, "right"), (0, "wrong")], true), "Drawn: 12 of 12 right.");
        assert_eq!(thinning_caption(&[(0, "right"), (0, "wrong")], true), "No measurement.");
        let text = thinning_caption(&[(MAX_CLOUD_POINTS + 1, "right"), (3, "wrong")], true);
        assert!(
            text.starts_with("Drawn: 2500 of 2501 right and 3 of 3 wrong. ") && text.contains("Rings"),
            "{text}"
        );
    }

    #[test]
    fn a_curve_is_drawn_at_even_steps_to_its_end() {
        assert_eq!(evenly(4), [0, 1, 2, 3]);
        assert!(evenly(0).is_empty());
        let kept = evenly(16_077);
        assert!(kept.len() <= MAX_CURVE_POINTS + 1 && kept.last() == Some(&16_076));
        assert!(kept.windows(2).all(|pair| pair[1] - pair[0] <= 4));
    }

    #[test]
    fn bins_hold_every_row_once() {
        assert_eq!(bins(10, 3).flatten().collect::<Vec<_>>(), (0..10).collect::<Vec<_>>());
        assert_eq!(bins(2, 60).count(), 2);
        assert_eq!(bins(0, 60).count(), 0);
    }

    #[test]
    fn a_summary_of_nothing_has_no_numbers() {
        assert_eq!(summary([f64::NAN].into_iter(), 2), ["0", "", "", ""]);
        assert_eq!(summary([1.0, 3.0].into_iter(), 1), ["2", "1.0", "2.0", "3.0"]);
    }
}
