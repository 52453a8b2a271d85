//! Probability that a pixel's digital number exceeds a floor, and draws of the number above the floor.
//!
//! Poisson(λ) is Poisson(λₖ) plus an independent Poisson(λ − λₖ), where λₖ is the next lower mean of a grid
//! of quarters of an electron. The probability of exceeding the floor is therefore a sum over n: the Poisson
//! probability of n extra electrons, times the probability of exceeding from λₖ plus n fixed electrons, which
//! a table holds. A number above the floor is drawn in two steps: first n, then the number by inversion in
//! the tail of that table.

use std::collections::BTreeMap;

use super::distribution::PixelDistribution;

/// Distribution of the digital numbers above a floor. Tables are made on first use; their content does not
/// depend on earlier use.
#[derive(Debug, Clone)]
pub(crate) struct Exceedance {
    distribution: PixelDistribution,
    floor_dn: u16,
    /// Lower and upper mean, in quarters of an electron, between which the limit of dark pixels follows the
    /// background; `None` if the darkest pixel exceeds the floor too often.
    limits: Option<(u32, u32)>,
    /// Most recent limit, and its mean in quarters of an electron: adjacent rows mostly have equal limits.
    last_limit: Option<(u32, DarkLimit)>,
    /// Tails by mean in quarters of an electron, then by extra electrons.
    tails: BTreeMap<(u32, u32), Tail>,
}

/// Probabilities of the digital numbers above the floor.
#[derive(Debug, Clone, PartialEq)]
struct Tail {
    first_dn: u16,
    /// Cumulative probability of the numbers above the floor, up to `first_dn` + i.
    cumulative: Vec<f64>,
}

/// Largest mean of a dark pixel, and the probability from which its exceedances are thinned.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct DarkLimit {
    /// Largest mean of a dark pixel, electrons; a pixel with a larger mean is drawn directly. Negative if
    /// every pixel is drawn directly.
    pub(crate) mean_e: f64,
    /// Probability that a pixel of this mean exceeds the floor: the maximum over all dark pixels.
    pub(crate) probability: f64,
}

impl DarkLimit {
    /// Limit without any dark pixels.
    const NOWHERE: Self = Self { mean_e: -1.0, probability: 0.0 };
}

/// Minimum exceedance probability of the limit, for any background: at this value there is one candidate in
/// two frames of half a million pixels.
const MIN_EXCEEDANCE: f64 = 1.0 / 1_048_576.0;
/// Maximum exceedance probability of the limit, for any background: above this value the draw of a pixel
/// costs less than its candidates.
const MAX_EXCEEDANCE: f64 = 1.0 / 64.0;
/// Upper end of the means of the limit, in quarters of an electron.
const MEANS_END: u32 = 4 * 1024;
/// Number of extra electrons from which on they are neglected: a remainder of less than a quarter of an
/// electron gives eight or more with a probability below 3.1e-10.
const NEGLECTED_EXTRA_E: u32 = 8;

impl Exceedance {
    /// Creates the distribution from a pixel's distribution with shot noise.
    pub(crate) fn new(distribution: &PixelDistribution, floor_dn: u16) -> Self {
        let mut new = Self {
            distribution: *distribution,
            floor_dn,
            limits: None,
            last_limit: None,
            tails: BTreeMap::new(),
        };
        new.limits =
            new.last_below(MAX_EXCEEDANCE).map(|high| (new.last_below(MIN_EXCEEDANCE).unwrap_or(0), high));
        new
    }

    /// Returns the highest mean of the grid whose probability of exceeding the floor is at most `limit`, in
    /// quarters of an electron. The probability grows with the mean.
    fn last_below(&mut self, limit: f64) -> Option<u32> {
        let (mut from, mut to) = (0, MEANS_END);
        while from < to {
            let middle = u32::midpoint(from, to);
            if self.tail(middle, 0).probability() <= limit { from = middle + 1 } else { to = middle }
        }
        from.checked_sub(1)
    }

    /// Returns true if the distribution belongs to this pixel distribution and floor.
    pub(crate) fn is_valid_for(&self, distribution: &PixelDistribution, floor_dn: u16) -> bool {
        self.distribution == *distribution && self.floor_dn == floor_dn
    }

    /// Limit of dark pixels over a background of at most `bound_e` electrons per pixel.
    #[inline(always)]
    pub(crate) fn dark_limit(&mut self, bound_e: f64) -> DarkLimit {
        let Some((low, high)) = self.limits else { return DarkLimit::NOWHERE };
        // The cast to an integer saturates.
        let quarters = ((4.0 * bound_e).ceil() as u32).clamp(low, high);
        if let Some((of, limit)) = self.last_limit
            && of == quarters
        {
            return limit;
        }
        let probability = self.tail(quarters, 0).probability();
        let limit = DarkLimit { mean_e: 0.25 * f64::from(quarters), probability };
        self.last_limit = Some((quarters, limit));
        limit
    }

    /// Draws a number above the floor for a dark pixel with a mean of `mean_e` electrons, or none. A number
    /// is drawn with the probability that the pixel exceeds the floor, divided by the probability of `limit`.
    /// Uses three uniform random numbers.
    pub(crate) fn thin(
        &mut self,
        mean_e: f64,
        limit: DarkLimit,
        [keep, more, number]: [f64; 3],
    ) -> Option<u16> {
        let mean_e = mean_e.max(0.0);
        let level = keep * limit.probability;
        let quarters = (4.0 * mean_e) as u32;
        // Most candidates are rejected by the probability of the next higher mean of the grid, which needs no
        // sum over extra electrons.
        if level >= self.tail(quarters + 1, 0).probability() {
            return None;
        }
        let rest_e = mean_e - 0.25 * f64::from(quarters);
        let mut weights = [0.0; NEGLECTED_EXTRA_E as usize];
        let (mut poisson, mut probability) = (libm::exp(-rest_e), 0.0);
        for (n, weight) in (0..).zip(&mut weights) {
            *weight = poisson * self.tail(quarters, n).probability();
            probability += *weight;
            poisson *= rest_e / f64::from(n + 1);
        }
        if level >= probability {
            return None;
        }
        let mut left = more * probability;
        let passed = |weight: &&f64| {
            left -= **weight;
            left >= 0.0
        };
        let n = weights[..weights.len() - 1].iter().take_while(passed).count();
        Some(self.tail(quarters, n as u32).number(number))
    }

    /// Returns the tail for a mean of `quarters` quarters of an electron plus `more` fixed electrons.
    fn tail(&mut self, quarters: u32, more: u32) -> &Tail {
        let (distribution, floor_dn) = (&self.distribution, self.floor_dn);
        self.tails
            .entry((quarters, more))
            .or_insert_with(|| Tail::new(distribution, floor_dn, quarters, more))
    }
}

impl Tail {
    fn new(distribution: &PixelDistribution, floor_dn: u16, quarters: u32, more: u32) -> Self {
        let whole = distribution.probabilities(0.25 * f64::from(quarters), more);
        let below = (usize::from(floor_dn) + 1).saturating_sub(usize::from(whole.first_dn));
        let below = below.min(whole.probabilities.len());
        let mut sum = 0.0;
        let cumulative = whole.probabilities[below..]
            .iter()
            .map(|probability| {
                sum += probability;
                sum
            })
            .collect();
        Self { first_dn: whole.first_dn.saturating_add(below as u16), cumulative }
    }

    fn probability(&self) -> f64 {
        self.cumulative.last().copied().unwrap_or(0.0)
    }

    /// Number at a quantile from 0 to below 1.
    fn number(&self, quantile: f64) -> u16 {
        let level = quantile * self.probability();
        let i = self.cumulative.partition_point(|&up_to| up_to <= level);
        self.first_dn + i.min(self.cumulative.len().saturating_sub(1)) as u16
    }
}

#[cfg(test)]
mod tests {
    use super::super::distribution::tests::{chi_square_p, from_zero, histogram};
    use super::*;
    use crate::SensorConfig;
    use crate::config::tests::twelve_bit;
    use draws::{Effect, Seed, uniform};

    /// A gain of 1 e⁻/DN and a low read noise, so single electrons are distinguishable.
    fn distribution() -> PixelDistribution {
        PixelDistribution::new(&SensorConfig { gain_e_per_dn: 1.0, read_noise_e: 1.2, ..twelve_bit() })
    }

    fn above(distribution: &PixelDistribution, mean_e: f64, floor_dn: u16) -> f64 {
        from_zero(&distribution.probabilities(mean_e, 0))[usize::from(floor_dn) + 1..].iter().sum()
    }

    #[test]
    fn the_limit_follows_the_background_between_the_rarest_and_the_most_frequent() {
        let (distribution, floor_dn) = (distribution(), 70);
        let mut exceedance = Exceedance::new(&distribution, floor_dn);
        for bound_e in [0.0, 3.1, 8.2, 9.0, 12.0, 14.1, 40.0, 1e9] {
            let limit = exceedance.dark_limit(bound_e);
            assert!((limit.probability - above(&distribution, limit.mean_e, floor_dn)).abs() < 1e-12);
            assert!(limit.probability <= MAX_EXCEEDANCE);
            let follows = limit.mean_e >= bound_e && limit.mean_e < bound_e + 0.25;
            let rarest = limit.mean_e > bound_e
                && above(&distribution, limit.mean_e + 0.25, floor_dn) > MIN_EXCEEDANCE;
            let most = limit.mean_e < bound_e
                && above(&distribution, limit.mean_e + 0.25, floor_dn) > MAX_EXCEEDANCE;
            assert!(
                follows || (rarest && limit.probability <= MIN_EXCEEDANCE) || most,
                "{bound_e}: {limit:?}"
            );
        }
        // The bias exceeds this floor, so no pixel is dark.
        assert_eq!(Exceedance::new(&distribution, 40).dark_limit(0.0), DarkLimit::NOWHERE);
        // No number exceeds full scale.
        assert_eq!(Exceedance::new(&distribution, 4095).dark_limit(3.0).probability, 0.0);
    }

    #[test]
    fn accepted_candidates_follow_the_distribution_above_the_floor() {
        let distribution = distribution();
        for (frame, (mean_e, floor_dn)) in
            [(0.0, 53), (0.13, 54), (7.37, 65), (7.49, 67), (30.01, 95)].into_iter().enumerate()
        {
            let mut exceedance = Exceedance::new(&distribution, floor_dn);
            let limit = exceedance.dark_limit(mean_e + 1.0);
            let mut stream = Seed { seed: 51, case: 0 }.stream(frame as u64, Effect::Exceedance, 0);
            let n = 200_000;
            let kept = histogram((0..n).map(|_| {
                let levels = std::array::from_fn(|_| uniform(&mut stream));
                usize::from(exceedance.thin(mean_e, limit, levels).unwrap_or(0))
            }));
            let mut expected = from_zero(&distribution.probabilities(mean_e, 0));
            expected[..=usize::from(floor_dn)].fill(0.0);
            expected.iter_mut().for_each(|probability| *probability /= limit.probability);
            expected[0] = 1.0 - expected.iter().sum::<f64>();
            assert!(expected[0] < 0.99, "{mean_e} e⁻: too few to tell");
            let p = chi_square_p(&kept, &expected);
            assert!(p > 1e-4, "{mean_e} e⁻ over {floor_dn}: p = {p}");
        }
    }

    #[test]
    fn caching_changes_nothing() {
        let mut kept = Exceedance::new(&distribution(), 65);
        let limit = kept.dark_limit(9.0);
        let levels = |i: u32| [0.03 * f64::from(i % 31), 0.07 * f64::from(i % 13), 0.2 * f64::from(i % 5)];
        let mean_e = |i: u32| 0.029 * f64::from(i);
        let all: Vec<_> = (0..300).map(|i| kept.thin(mean_e(i), limit, levels(i))).collect();
        assert!(all.iter().flatten().count() > 20);
        for i in (0..300).step_by(17) {
            assert_eq!(
                Exceedance::new(&distribution(), 65).thin(mean_e(i), limit, levels(i)),
                all[i as usize]
            );
        }
    }
}
