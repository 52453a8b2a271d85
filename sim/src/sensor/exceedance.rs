//! How probable it is that a pixel's digital number is above a floor, and which number it then is.
//!
//! Poisson(λ) is Poisson(λₖ) plus an independent Poisson(λ − λₖ), where λₖ is the next lower mean of a grid of quarters of an
//! electron. So the probability of exceeding is the sum over n of the probability of n electrons more, which is Poisson's, times
//! that of exceeding from λₖ with n electrons more for certain, which a table holds; and a number above the floor is drawn by
//! its n, then by inversion in the tail of that table.

use std::collections::BTreeMap;

use super::pixel_distribution::PixelDistribution;

/// The law of the digital numbers above a floor. Tables are made when first met, and are the same whatever was met before.
#[derive(Debug, Clone)]
pub(super) struct Exceedance {
    distribution: PixelDistribution,
    floor_dn: u16,
    /// The means, in quarters of an electron, from and up to which the limit of dark pixels follows the background; `None` where
    /// the darkest pixel exceeds the floor too often.
    limits: Option<(u32, u32)>,
    /// The limit told last, and its mean in quarters of an electron: rows side by side mostly have the same.
    last_limit: Option<(u32, DarkLimit)>,
    /// By the mean in quarters of an electron, then by the electrons more.
    tails: BTreeMap<(u32, u32), Tail>,
}

/// The probabilities of the numbers above the floor.
#[derive(Debug, Clone, PartialEq)]
struct Tail {
    first_dn: u16,
    /// Of exceeding the floor by a number up to `first_dn` + i.
    cumulative: Vec<f64>,
}

/// The mean up to which a pixel is dark, and what its exceedances are thinned from.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct DarkLimit {
    /// A pixel with more expected electrons is drawn outright; negative where every pixel is.
    pub(super) mean_e: f64,
    /// The probability that a pixel of that mean exceeds the floor: no dark pixel's is higher.
    pub(super) probability: f64,
}

impl DarkLimit {
    /// Where no pixel is dark.
    const NOWHERE: Self = Self { mean_e: -1.0, probability: 0.0 };
}

/// However dark the background: below this a candidate comes once in two frames of half a million pixels.
const RAREST: f64 = 1.0 / 1_048_576.0;
/// However bright the background: above this it costs less to draw a pixel than its candidates.
const MOST_FREQUENT: f64 = 1.0 / 64.0;
/// The means of the limit end here, in quarters of an electron.
const END: u32 = 4 * 1024;
/// Of a mean's rest of less than a quarter of an electron eight electrons or more come once in 10^10.
const MOST_MORE: u32 = 8;

impl Exceedance {
    /// Of a law with shot noise.
    pub(super) fn new(distribution: &PixelDistribution, floor_dn: u16) -> Self {
        let mut new = Self {
            distribution: *distribution,
            floor_dn,
            limits: None,
            last_limit: None,
            tails: BTreeMap::new(),
        };
        new.limits = new.last_below(MOST_FREQUENT).map(|high| (new.last_below(RAREST).unwrap_or(0), high));
        new
    }

    /// The highest mean of the grid that exceeds the floor no more often than `limit`, in quarters of an electron. The
    /// probability grows with the mean.
    fn last_below(&mut self, limit: f64) -> Option<u32> {
        let (mut from, mut to) = (0, END);
        while from < to {
            let middle = u32::midpoint(from, to);
            if self.tail(middle, 0).probability() <= limit { from = middle + 1 } else { to = middle }
        }
        from.checked_sub(1)
    }

    /// Whether it is the law of these.
    pub(super) fn is_valid_for(&self, distribution: &PixelDistribution, floor_dn: u16) -> bool {
        self.distribution == *distribution && self.floor_dn == floor_dn
    }

    /// The limit of dark pixels over a background of at most `bound_e` electrons a pixel.
    #[inline(always)]
    pub(super) fn dark_limit(&mut self, bound_e: f64) -> DarkLimit {
        let Some((low, high)) = self.limits else { return DarkLimit::NOWHERE };
        // A cast saturates.
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

    /// A number above the floor of a dark pixel with a mean of `mean_e` electrons, or none: with the probability that it
    /// exceeds the floor, divided by `limit`'s. From three uniform numbers.
    pub(super) fn thin(
        &mut self,
        mean_e: f64,
        limit: DarkLimit,
        [keep, more, number]: [f64; 3],
    ) -> Option<u16> {
        let mean_e = mean_e.max(0.0);
        let level = keep * limit.probability;
        let quarters = (4.0 * mean_e) as u32;
        // Most are refused by the probability of the next mean of the grid, without those of more electrons.
        if level >= self.tail(quarters + 1, 0).probability() {
            return None;
        }
        let rest_e = mean_e - 0.25 * f64::from(quarters);
        let mut weights = [0.0; MOST_MORE as usize];
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

    /// The tail of the mean of so many quarters of an electron, with `more` electrons for certain.
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

    /// The number at a quantile, 0 to below 1.
    fn number(&self, quantile: f64) -> u16 {
        let level = quantile * self.probability();
        let i = self.cumulative.partition_point(|&up_to| up_to <= level);
        self.first_dn + i.min(self.cumulative.len().saturating_sub(1)) as u16
    }
}

#[cfg(test)]
mod tests {
    use super::super::SensorConfig;
    use super::super::config::tests::twelve_bit;
    use super::super::pixel_distribution::tests::{chi_square_p, from_zero, histogram};
    use super::*;
    use crate::randomness::{Effect, Seed, uniform};

    /// A gain of 1 e⁻/DN and a low read noise, so that single electrons are seen.
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
            assert!(limit.probability <= MOST_FREQUENT);
            let follows = limit.mean_e >= bound_e && limit.mean_e < bound_e + 0.25;
            let rarest =
                limit.mean_e > bound_e && above(&distribution, limit.mean_e + 0.25, floor_dn) > RAREST;
            let most =
                limit.mean_e < bound_e && above(&distribution, limit.mean_e + 0.25, floor_dn) > MOST_FREQUENT;
            assert!(follows || (rarest && limit.probability <= RAREST) || most, "{bound_e}: {limit:?}");
        }
        // The bias alone is above this floor: nothing is dark.
        assert_eq!(Exceedance::new(&distribution, 40).dark_limit(0.0), DarkLimit::NOWHERE);
        // Nothing is above full scale.
        assert_eq!(Exceedance::new(&distribution, 4095).dark_limit(3.0).probability, 0.0);
    }

    #[test]
    fn what_is_kept_of_the_candidates_follows_the_law_above_the_floor() {
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
    fn what_is_kept_changes_nothing() {
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
