//! Inverse problem: the threshold value of a parameter at which a requirement is met.
//!
//! The probability is not always monotone in a parameter (a longer exposure smears). It is therefore first
//! evaluated on a grid over the bracket; the crossing nearest to the requested end is then refined by
//! bisection in the parameter's logarithm.
use files::Failure;
use statistics::{binomial_at_least, clopper_pearson};

use super::binding::binding;
use crate::design::{Design, between, design_with};
use crate::requirement::definition::Requirements;
use crate::requirement::{Demand, Extreme, FindTable, Parameter};

/// Number of values in the grid.
const GRID: usize = 13;
/// Number of bisection steps, which shrink the bracket of a grid step below a thousandth of the step.
const STEPS: usize = 10;
/// Number of boresights used by the search; the result is then evaluated at all boresights.
const SEARCH_POINTINGS: usize = 2000;
/// Power with which the simulation shows an existing difference.
const POWER: f64 = 0.95;

/// Result of a search.
#[derive(Debug, Clone, PartialEq)]
pub enum Search {
    /// A value that meets the requirement.
    Found(FoundValue),
    /// No value of the bracket meets the requirement.
    Impossible {
        /// Value of the grid with the highest probability.
        best_value: f64,
        /// Probability at this value.
        best_probability: f64,
        /// Binding constraint at this value.
        binds: String,
    },
}

/// A value that meets a requirement, and one that fails it.
#[derive(Debug, Clone, PartialEq)]
pub struct FoundValue {
    /// Value that meets the requirement with enough margin for the simulated frames to show it.
    pub value: f64,
    /// Target probability of the search: the required probability, or the higher one that the simulated
    /// frames need to show it.
    pub goal: f64,
    /// Value at which the analytic probability equals the required one.
    pub threshold_value: f64,
    /// Value far enough beyond the threshold for the simulated frames to show the failure; `None` when the
    /// whole bracket meets the requirement, or the frames cannot show a failure.
    pub failing_value: Option<f64>,
    /// True if all values of the grid beyond the found one, to the other end of the bracket, meet the
    /// requirement.
    pub is_monotone: bool,
}

/// Returns the two probabilities that a number of frames can distinguish from the required one, with power
/// 0.95 each: at the greater one, the lower bound of the frames' rate reaches the required probability; at
/// the smaller one, the upper bound is below it. `None` where no rate of so few frames shows the difference.
pub fn resolvable(required: f64, frames: u32, confidence: f64) -> (Option<f64>, Option<f64>) {
    let n = u64::from(frames);
    if n == 0 {
        return (None, None);
    }
    let enough = (0..=n).find(|k| clopper_pearson(*k, n, confidence).0 >= required);
    let few = (0..=n).rev().find(|k| clopper_pearson(*k, n, confidence).1 < required);
    let root = |holds: &dyn Fn(f64) -> bool| {
        let (mut low, mut high) = (0.0, 1.0);
        for _ in 0..50 {
            let middle = 0.5 * (low + high);
            if holds(middle) { high = middle } else { low = middle }
        }
        0.5 * (low + high)
    };
    (
        enough.map(|k| root(&|p| binomial_at_least(k, n, p) >= POWER)),
        few.map(|k| root(&|p| binomial_at_least(k + 1, n, p) >= 1.0 - POWER)),
    )
}

/// Searches for the value. `own` is the design of the given camera, which is reused for exposures that its
/// sky covers.
///
/// # Errors
/// A [`Failure`] when a camera of the bracket cannot be created.
pub fn search(
    requirements: &Requirements,
    own: &Design<'_>,
    demand: &Demand,
    find: &FindTable,
) -> Result<Search, Failure> {
    let file = &requirements.file;
    let required = demand.probability(file.probability);
    let (above, below) = resolvable(required, file.confirm.frames, file.confirm.confidence);
    let mut goal = above.unwrap_or(required);
    let pointings = SEARCH_POINTINGS.min(file.sky.pointings as usize);
    let fixed = match find.parameter {
        Parameter::ExposureS if own.covers(find.to) => Some(own.thinned(pointings)?),
        Parameter::ExposureS => Some(design_with(requirements, find.parameter, find.to, pointings)?.0),
        Parameter::ApertureDiameterMm | Parameter::FocalLengthMm => None,
    };
    let curve = Curve { requirements, demand, parameter: find.parameter, pointings, fixed };
    let mut grid: Vec<(f64, f64)> = Vec::new();
    for value in between(find.from, find.to, GRID) {
        grid.push((value, curve.probability(value)?));
    }
    // From here on, the requested end of the bracket is the first.
    if find.want == Extreme::Largest {
        grid.reverse();
    }
    if grid.iter().all(|(_, probability)| *probability < goal) {
        // No value reaches the probability that the frames could show: the search uses the required
        // probability, by the detection model only.
        goal = required;
    }
    let Some(met) = grid.iter().position(|(_, probability)| *probability >= goal) else {
        let best = grid.iter().copied().max_by(|a, b| a.1.total_cmp(&b.1));
        let (best_value, best_probability) = best.unwrap_or((find.from, 0.0));
        let binds = binding(requirements, demand, find.parameter, best_value, required)?;
        return Ok(Search::Impossible { best_value, best_probability, binds });
    };
    let crossing = |level: f64, side: usize| -> Result<f64, Failure> {
        let (inner, outer) = (&grid[side], &grid[side - 1]);
        let (mut meets, mut fails) = (libm::log(inner.0), libm::log(outer.0));
        for _ in 0..STEPS {
            let middle = 0.5 * (meets + fails);
            if curve.probability(libm::exp(middle))? >= level { meets = middle } else { fails = middle }
        }
        Ok(libm::exp(meets))
    };
    let value = if met == 0 { grid[0].0 } else { crossing(goal, met)? };
    // The threshold may lie one grid step farther out, and the failing value farther still.
    let outward = |level: f64| grid[..=met].iter().rposition(|(_, probability)| *probability < level);
    let at_level = |level: f64| outward(level).map(|outer| crossing(level, outer + 1)).transpose();
    let threshold_value = at_level(required)?.unwrap_or(value);
    let failing_value = match below {
        // The first value that is certainly below the level: the crossing is on the side that still reaches
        // it.
        Some(level) => outward(level)
            .map(|outer| Ok::<f64, Failure>(step_out(&grid, outer, crossing(level, outer + 1)?)))
            .transpose()?,
        None => None,
    };
    let is_monotone = grid[met..].iter().all(|(_, probability)| *probability >= required);
    Ok(Search::Found(FoundValue { value, goal, threshold_value, failing_value, is_monotone }))
}

/// Returns a value a thousandth beyond a crossing, towards the grid value that fails.
fn step_out(grid: &[(f64, f64)], outer: usize, crossing: f64) -> f64 {
    let fails = grid[outer].0;
    if fails < crossing { (crossing * 0.999).max(fails) } else { (crossing * 1.001).min(fails) }
}

/// Probability as a function of the parameter.
struct Curve<'a> {
    requirements: &'a Requirements,
    demand: &'a Demand,
    parameter: Parameter,
    pointings: usize,
    /// Common design of all exposures; `None` if the parameter is not the exposure.
    fixed: Option<Design<'a>>,
}

impl Curve<'_> {
    fn probability(&self, value: f64) -> Result<f64, Failure> {
        if let Some(design) = &self.fixed {
            return Ok(design.reached(self.demand, Some(value))?.probability);
        }
        let (design, exposure_s) = design_with(self.requirements, self.parameter, value, self.pointings)?;
        Ok(design.reached(self.demand, exposure_s)?.probability)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// 300 frames, 0.9, 95 %: 279 or more have a lower bound above 0.9, 260 or fewer an upper bound below it;
    /// these counts have a probability of 95 % in binomial distributions of 0.9507 and 0.8371
    /// (scipy.stats.binom, brentq).
    #[test]
    fn the_resolution_of_frames_follows_the_binomial_distribution() {
        let (above, below) = resolvable(0.9, 300, 0.95);
        let (above, below) = (above.unwrap(), below.unwrap());
        assert!((binomial_at_least(279, 300, above) - 0.95).abs() < 1e-6, "{above}");
        assert!(clopper_pearson(279, 300, 0.95).0 >= 0.9 && clopper_pearson(278, 300, 0.95).0 < 0.9);
        assert!(above > 0.93 && above < 0.97 && below > 0.80 && below < 0.88, "{above} {below}");
    }

    #[test]
    fn few_frames_cannot_show_a_high_probability() {
        let (above, below) = resolvable(0.99, 200, 0.95);
        assert!(above.is_none() && below.is_some());
        assert_eq!(resolvable(0.9, 0, 0.95), (None, None));
    }
}
