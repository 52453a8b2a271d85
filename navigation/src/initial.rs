//! Initial relative orbit determination from lines of sight alone.
//!
//! Directions leave the scale of a relative orbit free, except through manoeuvres, which add a known
//! displacement, and weakly through the curvature of the orbit (Woffinden and Geller 2009, IEEE Trans. AES
//! 45, 1195; Gaias, D'Amico, Ardaens 2014, JGCD 37, 440). So a grid of along-track distances is tried: for
//! each, the other parameters follow from least squares with the distance held; the minima over the grid are
//! then released. Every distinct minimum is a hypothesis with its sum of squares and its covariance; without
//! manoeuvres the σ of aδλ is of the size of aδλ itself.

use contract::navigation::{Covariance6, NoEstimate, PriorOrbit, RelativeElements};
use nalgebra::Matrix6;

use crate::problem::Problem;
use crate::sight::Sight;

/// Largest number of measurements used.
const MEASUREMENTS: usize = 120;

/// Smallest number of measurements: two angles each for six elements.
const MIN_MEASUREMENTS: usize = 3;

/// Shortest and longest distance of the grid, m.
const DISTANCES_M: (f64, f64) = (100.0, 300_000.0);

/// Number of distances, in equal ratios.
const GRID: usize = 36;

/// σ of the held distance relative to itself.
const HELD: f64 = 0.02;

/// σ of the other elements relative to the distance while it is held.
const SHAPE: f64 = 0.5;

/// Distance between hypotheses, in σ of aδλ, below which they are one.
const DISTINCT_SIGMA: f64 = 1.0;

/// Candidate for the relative orbit at the epoch.
#[derive(Debug, Clone, PartialEq)]
pub struct Hypothesis {
    /// Mean relative elements at the epoch.
    pub elements: RelativeElements,
    /// Their covariance, m², by linearisation.
    pub covariance: Covariance6,
    /// Weighted sum of squared residuals of the measurements used, and the logarithm of the determinant of
    /// their covariance relative to that of white errors, which depends on the distance if there are
    /// displacements.
    pub cost: f64,
    /// Number of measurements used, two angles each.
    pub measurements: usize,
}

/// Finds the relative orbits that agree with the measurements, the best first.
///
/// # Errors
/// [`NoEstimate::NoMeasurements`] for fewer than three measurements, [`NoEstimate::NoInitialOrbit`] if no
/// orbit agrees.
pub(crate) fn hypotheses(problem: &Problem<'_>) -> Result<Vec<Hypothesis>, NoEstimate> {
    let stride = problem.sights.len().div_ceil(MEASUREMENTS).max(1);
    let few: Vec<Sight> = problem.sights.iter().step_by(stride).cloned().collect();
    if few.len() < MIN_MEASUREMENTS {
        return Err(NoEstimate::NoMeasurements);
    }
    // A target ahead means a chaser behind: a negative aδλ.
    let osculation = problem.reference.osculation();
    let ahead: f64 = few.iter().map(|sight| sight.ahead(osculation)).sum();
    let sign = if ahead > 0.0 { -1.0 } else { 1.0 };
    let ratio = libm::log(DISTANCES_M.1 / DISTANCES_M.0) / (GRID - 1) as f64;
    let held: Vec<Option<(f64, RelativeElements)>> =
        (0..GRID).map(|k| held(problem, &few, sign * DISTANCES_M.0 * libm::exp(ratio * k as f64))).collect();
    let cost = |k: usize| held.get(k).and_then(Option::as_ref).map_or(f64::INFINITY, |(cost, _)| *cost);
    let is_minimum = |k: usize| {
        let before = k.checked_sub(1).map_or(f64::INFINITY, cost);
        cost(k).is_finite() && cost(k) <= before && cost(k) <= cost(k + 1)
    };
    let minima = (0..GRID).filter(|k| is_minimum(*k)).filter_map(|k| held[k]);
    let mut found: Vec<Hypothesis> =
        minima.filter_map(|(_, start)| released(problem, &few, &start)).collect();
    found.sort_by(|a, b| a.cost.total_cmp(&b.cost));
    let mut distinct: Vec<Hypothesis> = Vec::new();
    for hypothesis in found {
        let is_known = distinct.iter().any(|known| {
            let distance = known.elements.a_dlambda_m - hypothesis.elements.a_dlambda_m;
            distance.abs() < DISTINCT_SIGMA * known.covariance.sigmas()[1]
        });
        if !is_known {
            distinct.push(hypothesis);
        }
    }
    if distinct.is_empty() { Err(NoEstimate::NoInitialOrbit) } else { Ok(distinct) }
}

/// Returns cost ([`Hypothesis::cost`]) and elements of the least squares with aδλ held near `distance_m`.
fn held(problem: &Problem<'_>, few: &[Sight], distance_m: f64) -> Option<(f64, RelativeElements)> {
    let elements = RelativeElements { a_dlambda_m: distance_m, ..RelativeElements::default() };
    let shape = SHAPE * distance_m.abs();
    let sigmas = [0.1 * shape, HELD * distance_m.abs(), shape, shape, shape, shape];
    let prior = PriorOrbit { elements, covariance: Covariance6::from_sigmas(sigmas).ok()? };
    let parameters = problem.parameters.with_orbit(Some(prior));
    let problem = Problem { sights: few, parameters: &parameters, ..*problem };
    let mut values = vec![0.0; parameters.count()];
    values.iter_mut().zip(elements.vector().iter()).for_each(|(value, x)| *value = *x);
    let cost = problem.robust(&mut values).ok()?.cost;
    Some((cost, parameters.elements(&values)))
}

/// Solves from `start` without holding the distance.
fn released(problem: &Problem<'_>, few: &[Sight], start: &RelativeElements) -> Option<Hypothesis> {
    let parameters = problem.parameters.with_orbit(None);
    let solution = Problem { sights: few, parameters: &parameters, ..*problem }.solve(start).ok()?;
    let covariance = Matrix6::from_iterator(solution.covariance.view((0, 0), (6, 6)).iter().copied());
    Some(Hypothesis {
        elements: parameters.elements(&solution.values),
        covariance: Covariance6::from_matrix(covariance).ok()?,
        cost: solution.cost,
        measurements: few.len(),
    })
}
