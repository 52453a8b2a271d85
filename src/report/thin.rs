//! Long series made short: what is left out is not seen at the size of a screen, and extremes stay.

/// Stretches that a series is cut into. Twice as many points as a chart has pixels across are no different from all.
const STRETCHES: usize = 700;

/// The places of `count` rows that a chart needs: of every stretch of rows that follow each other, the first, and those with the
/// smallest and the largest of each of the `series`. All of them where they are few. Ascending. Values that are no number are
/// passed over.
pub(super) fn thinned(count: usize, series: &[&dyn Fn(usize) -> f64]) -> Vec<usize> {
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

/// A range of places for each of at most so many bins, all places of `count` in them, in order.
pub(super) fn bins(count: usize, most: usize) -> impl Iterator<Item = std::ops::Range<usize>> {
    let bins = count.min(most);
    (0..bins).map(move |bin| bin * count / bins..(bin + 1) * count / bins)
}

/// Number, smallest, mean and largest of some values, as cells; values that are no number are passed over.
pub(super) fn summary(values: impl Iterator<Item = f64>, decimals: usize) -> [String; 4] {
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
        // One row in 997 stands out, up or down by turns, and others are no number at all.
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
