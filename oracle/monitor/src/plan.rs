//! Planned approach in the phase chart: range against range rate, with a corridor around it.

use serde::Serialize;

/// Approximate number of points of a drawn plan.
const POINTS: u64 = 1200;
/// Number of segments of the corridor along the range.
const PIECES: usize = 80;
/// Fraction of the range, before and behind a point, over which the corridor takes the planned rates; holds
/// are not flown to the centimetre.
const NEAR_RANGE_FRACTION: f64 = 0.06;
/// Margin of the corridor on each side, as a fraction of the planned rate.
const MARGIN: f64 = 0.2;

/// Planned range and range rate, and the permitted range rates.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Plan {
    range_unit: &'static str,
    /// Points in order of time: frame, range (m or km, see `range_unit`) and range rate, m/s.
    points: Vec<(u64, f64, f64)>,
    /// Corridor in order of range: range, smallest and largest permitted rate.
    corridor: Vec<[f64; 3]>,
}

impl Plan {
    /// Creates the plan of `frames`; `at` returns range and range rate of a frame. The corridor extends from
    /// the smallest to the largest rate that the plan has within 6 % of a range, widened by a fifth and by
    /// `least_margin_m_s`.
    pub fn new(
        range_unit: &'static str,
        frames: &std::ops::Range<u64>,
        least_margin_m_s: f64,
        at: impl Fn(u64) -> Option<[f64; 2]>,
    ) -> Self {
        let step = ((frames.end - frames.start) / POINTS).max(1);
        let last = frames.end.saturating_sub(1);
        let points: Vec<(u64, f64, f64)> = frames
            .clone()
            .step_by(usize::try_from(step).unwrap_or(usize::MAX))
            .chain([last])
            .filter_map(|frame| at(frame).map(|[range, rate]| (frame, range, rate)))
            .filter(|(_, range, _)| *range > 0.0)
            .collect();
        Self { range_unit, corridor: corridor(&points, least_margin_m_s), points }
    }
}

fn corridor(points: &[(u64, f64, f64)], least_margin_m_s: f64) -> Vec<[f64; 3]> {
    let ranges = points.iter().map(|(_, range, _)| *range);
    let (least, greatest) =
        ranges.fold((f64::INFINITY, 0.0_f64), |(low, high), range| (low.min(range), high.max(range)));
    if points.is_empty() {
        return Vec::new();
    }
    // Equal steps in the logarithm of the range, because short ranges matter most.
    let ratio = libm::log(greatest / least);
    let piece = |i: usize| least * libm::exp(ratio * i as f64 / PIECES as f64);
    (0..=PIECES)
        .filter_map(|i| {
            let range = piece(i);
            let near = points.iter().filter(|(_, r, _)| (r - range).abs() <= NEAR_RANGE_FRACTION * range);
            let (low, high) = near.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), (_, _, rate)| {
                (low.min(*rate), high.max(*rate))
            });
            let margin = |rate: f64| MARGIN * rate.abs() + least_margin_m_s;
            (low <= high).then(|| [range, low - margin(low), high + margin(high)])
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// From 100 m to 1 m at 1 m/s, one frame per metre.
    #[test]
    fn the_corridor_has_its_stated_width_about_a_steady_approach() {
        let plan = Plan::new("m", &(0..100), 0.05, |frame| Some([100.0 - frame as f64, -1.0]));
        assert_eq!(plan.points.len(), 101);
        assert!(plan.corridor.windows(2).all(|pair| pair[0][0] < pair[1][0]));
        for [range, low, high] in &plan.corridor {
            assert!((low + 1.25).abs() < 1e-12 && (high + 0.75).abs() < 1e-12, "{range}: {low} {high}");
        }
    }

    #[test]
    fn a_retreat_is_inside_the_corridor() {
        let rate = |frame: u64| if frame < 50 { -1.0 } else { 0.5 };
        let plan = Plan::new("m", &(0..100), 0.05, |frame| Some([10.0, rate(frame)]));
        let [_, low, high] = plan.corridor[0];
        assert!(low < -1.0 && high > 0.5);
    }

    #[test]
    fn an_approach_without_a_point_has_no_corridor() {
        assert_eq!(Plan::new("m", &(0..3), 0.05, |_| None).corridor, Vec::<[f64; 3]>::new());
    }
}
