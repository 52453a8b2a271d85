//! Verdict on one figure.
use score::{Better, Kind, Sense};
use statistics::{FigureTest, JointTest, normal_quantile};

use crate::dependence::effects::FigureEffect;
use crate::dependence::runs::LossRun;
use crate::report::{FigureReport, FigureVerdict};

/// The 95 % quantile of the standard normal distribution: the power for which the smallest visible change is
/// reported.
const Z_POWER: f64 = 1.644_853_626_951_472_2;
/// Share of alpha that runs of losses may add to alpha.
pub(crate) const ALPHA_OF_RUNS: f64 = 0.05;
/// Largest probability of chance at which a figure that the result lacks counts as gone.
const GONE_BY_CHANCE: f64 = 1e-3;

/// Data needed to judge one figure.
pub(crate) struct Judge<'a> {
    pub(crate) effect: &'a FigureEffect,
    pub(crate) worse: &'a JointTest,
    pub(crate) better: &'a JointTest,
    pub(crate) index: usize,
    /// Index of the test for a decrease, for a figure with a best value.
    pub(crate) other_side: Option<usize>,
    pub(crate) alpha: f64,
    /// Run of losses, for a rate on the same frames.
    pub(crate) loss_run: Option<&'a LossRun>,
}

impl Judge<'_> {
    pub(crate) fn report(&self, interval: Option<(f64, f64)>) -> FigureReport {
        let effect = self.effect;
        let difference = effect.result.zip(effect.baseline).map(|(result, baseline)| result - baseline);
        let figure_test = self.figure_test();
        FigureReport {
            verdict: self.verdict(),
            better: match effect.sense.better {
                Better::More => "more".to_owned(),
                Better::Less => "less".to_owned(),
                Better::Near(best) => format!("near {best}"),
            },
            baseline: effect.baseline,
            baseline_of: effect.baseline_of,
            result: effect.result,
            result_of: effect.result_of,
            difference,
            // For skewed values, the difference may lie outside the quantiles of its own sets.
            low: interval.zip(difference).map(|((low, _), difference)| low.min(difference)),
            high: interval.zip(difference).map(|((_, high), difference)| high.max(difference)),
            worse_by: effect.worsening(),
            tolerance: effect.tolerance,
            p: figure_test.p,
            adjusted_p: figure_test.adjusted_p,
            attainable_p: figure_test.attainable_p,
            better_adjusted_p: self.better.figures[self.index].adjusted_p,
            smallest_visible: self.smallest_visible(),
            blocks: effect.blocks as u64,
            loss_run: self.loss_run.cloned(),
        }
    }

    /// Returns the test for a worsening. For a figure with a best value, returns the test for the side of the
    /// change, with its own p for both sides.
    fn figure_test(&self) -> FigureTest {
        let up = self.worse.figures[self.index];
        let Some(down) = self.other_side.map(|place| self.worse.figures[place]) else { return up };
        let nearer = if up.p <= down.p { up } else { down };
        FigureTest { p: (2.0 * nearer.p).min(1.0), ..nearer }
    }

    fn verdict(&self) -> FigureVerdict {
        let effect = self.effect;
        if effect.baseline.is_some() && effect.result.is_none() {
            let by_chance = self.better.figures.len() as f64 * libm::exp2(-(effect.blocks as f64));
            return if by_chance <= GONE_BY_CHANCE.min(self.alpha) {
                FigureVerdict::Gone
            } else {
                FigureVerdict::TooLittleData
            };
        }
        let (Some(worsening), Some(change)) = (effect.worsening(), effect.change()) else {
            return FigureVerdict::TooLittleData;
        };
        if self.is_lost_in_runs() && worsening > effect.tolerance {
            FigureVerdict::Worse
        } else if !self.can_be_seen() {
            FigureVerdict::TooLittleData
        } else if self.figure_test().adjusted_p <= self.alpha && change > effect.tolerance {
            // A result farther from the best value by more than the tolerance is worse; a result closer to
            // it, or across it, has changed.
            if worsening > effect.tolerance { FigureVerdict::Worse } else { FigureVerdict::Changed }
        } else if self.better.figures[self.index].adjusted_p <= self.alpha && -worsening > effect.tolerance {
            FigureVerdict::Better
        } else {
            FigureVerdict::NoWorse
        }
    }

    /// Returns true if the number of losses, or the length of a run of them, is not due to chance.
    fn is_lost_in_runs(&self) -> bool {
        self.loss_run.is_some_and(|run| run.adjusted_p <= ALPHA_OF_RUNS * self.alpha)
    }

    /// Returns true if a figure with equal differences in all of its blocks would be found: its p, adjusted
    /// for all figures, is at most alpha, and its statistic exceeds the critical value.
    fn can_be_seen(&self) -> bool {
        !self.effect.is_beyond_blocks
            && self.worse.figures[self.index].attainable_p <= self.alpha
            && (self.effect.blocks as f64).sqrt() > self.worse.critical + 1e-9
    }

    /// Returns the number of standard errors of a change that is found with a probability of 95 %. The
    /// statistic T of n blocks is bounded by √n, and grows with Student's t as T² = n t²/(n − 1 + t²). The
    /// change, k standard errors as estimated here, must exceed the t of the critical value by the margin
    /// that one result in twenty falls short of. In units of the true standard error the variance is that of
    /// the change, 1, and of both estimates of the standard error, t²/2(n − 1) for the result to come and
    /// k²/2(n − 1) for this one. The critical value is that of this comparison, or that of Bonferroni if the
    /// former is smaller because few figures differ at all: a real change brings differences. Above √(n − 1),
    /// only equal signs in all blocks are found, which no statistic of another sign pattern exceeds. `None`
    /// for two blocks: their standard error is too uncertain for any multiple.
    fn visible_standard_errors(&self) -> Option<f64> {
        let n = self.effect.blocks as f64;
        let bonferroni = normal_quantile(1.0 - self.alpha / self.worse.figures.len() as f64);
        let critical = self.worse.critical.max(bonferroni.min((n - 1.0).sqrt()));
        let t = critical * ((n - 1.0) / (n - critical * critical)).sqrt();
        // (k − t)² = z² (1 + (t² + k²)/2(n − 1)), the larger root.
        let z2 = Z_POWER * Z_POWER;
        let of_estimate = 0.5 * z2 / (n - 1.0);
        let (square, rest) = (1.0 - of_estimate, t * t * (1.0 - of_estimate) - z2);
        (square > 0.0).then(|| (t + (t * t - square * rest).max(0.0).sqrt()) / square)
    }

    /// Returns the worsening that is found with a probability of 95 %; `None` if no worsening is. A worsening
    /// of a rate adds scatter: a loss of the fraction δ of n units has a variance of at least δ/n.
    fn smallest_visible(&self) -> Option<f64> {
        let effect = self.effect;
        effect.worsening()?;
        if !self.can_be_seen() {
            return None;
        }
        let Sense { kind, .. } = effect.sense;
        let z = self.visible_standard_errors()?;
        let by_noise = match kind {
            Kind::Amount => z * effect.standard_error,
            Kind::Rate => {
                let own = z * z / effect.result_of.max(1) as f64;
                0.5 * (own + (own * own + 4.0 * z * z * effect.standard_error * effect.standard_error).sqrt())
            }
        };
        Some(by_noise.max(effect.tolerance + Z_POWER * effect.standard_error))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use run::figure_by_name;
    use statistics::{BlockEffects, FigureTest};

    /// Returns a figure that is best when small, with ten blocks, which changes from 2 in the baseline to
    /// `result`.
    fn effect(result: f64) -> FigureEffect {
        crate::hand_made::register_worlds();
        FigureEffect {
            sense: figure_by_name("ra_rms_deg").sense,
            baseline: Some(2.0),
            result: Some(result),
            baseline_of: 100,
            result_of: 50,
            blocks: 10,
            worse: BlockEffects::one_sided(Vec::new()),
            standard_error: 0.25,
            tolerance: 0.5,
            is_beyond_blocks: false,
        }
    }

    /// Returns the report on an effect that is the first of `figures` figures, at 5 %, with the given
    /// adjusted probabilities of a worsening and of an improvement.
    fn judged(
        effect: &FigureEffect,
        [worse, better]: [f64; 2],
        critical: f64,
        figures: usize,
    ) -> FigureReport {
        let test = |adjusted_p| {
            let figure_test =
                FigureTest { statistic: 1.0, p: 0.5 * adjusted_p, adjusted_p, attainable_p: 0.001 };
            JointTest { figures: vec![figure_test; figures], critical }
        };
        let (worse, better) = (&test(worse), &test(better));
        Judge { effect, worse, better, index: 0, other_side: None, alpha: 0.05, loss_run: None }
            .report(Some((0.25, 0.75)))
    }

    #[test]
    fn worse_means_improbable_and_beyond_the_tolerance() {
        use FigureVerdict::{Better, NoWorse, Worse};
        let verdict = |result: f64, probabilities| judged(&effect(result), probabilities, 2.0, 1).verdict;
        // A probability of at most alpha, and a worsening of more than 0.5.
        assert_eq!(verdict(2.75, [0.05, 1.0]), Worse);
        assert_eq!(verdict(2.75, [0.01, 1.0]), Worse);
        assert_eq!(verdict(2.75, [0.051, 1.0]), NoWorse);
        assert_eq!(verdict(2.5, [0.01, 1.0]), NoWorse);
        assert_eq!(verdict(2.25, [0.01, 1.0]), NoWorse);
        // Equivalent conditions for an improvement.
        assert_eq!(verdict(1.25, [1.0, 0.05]), Better);
        assert_eq!(verdict(1.25, [1.0, 0.01]), Better);
        assert_eq!(verdict(1.25, [1.0, 0.051]), NoWorse);
        assert_eq!(verdict(1.5, [1.0, 0.01]), NoWorse);
        assert_eq!(verdict(1.75, [1.0, 0.01]), NoWorse);
        // Neither verdict follows from the probability of the other.
        assert_eq!(verdict(2.75, [1.0, 0.01]), NoWorse);
        assert_eq!(verdict(1.25, [0.01, 1.0]), NoWorse);
    }

    /// Ten blocks with equal differences have a statistic of √10.
    #[test]
    fn a_figure_that_cannot_exceed_the_critical_value_has_too_little_data() {
        let report = |critical: f64| judged(&effect(2.75), [0.01, 1.0], critical, 1);
        for critical in [10f64.sqrt(), 10f64.sqrt() - 1e-10, 4.0] {
            let found = report(critical);
            assert_eq!((found.verdict, found.smallest_visible), (FigureVerdict::TooLittleData, None));
        }
        for critical in [10f64.sqrt() - 1e-8, 0.0] {
            let found = report(critical);
            assert_eq!(found.verdict, FigureVerdict::Worse);
            assert!(found.smallest_visible.is_some());
        }
    }

    /// The probability that all of ten blocks lose a figure by chance is 2⁻¹⁰, less than a thousandth; for
    /// nine blocks, or for two figures, it is larger.
    #[test]
    fn a_figure_missing_from_the_result_is_gone_if_that_is_significant() {
        let verdict = |baseline, result, blocks, figures| {
            let effect = FigureEffect { baseline, result, blocks, ..effect(0.0) };
            let found = judged(&effect, [1.0, 1.0], 2.0, figures);
            assert_eq!((found.difference, found.low, found.high), (None, None, None));
            assert_eq!((found.worse_by, found.smallest_visible), (None, None));
            found.verdict
        };
        let too_little = FigureVerdict::TooLittleData;
        assert_eq!(verdict(Some(2.0), None, 10, 1), FigureVerdict::Gone);
        assert_eq!(verdict(Some(2.0), None, 9, 1), too_little);
        assert_eq!(verdict(Some(2.0), None, 10, 2), too_little);
        assert_eq!(verdict(Some(2.0), None, 11, 2), FigureVerdict::Gone);
        // A figure that the baseline lacks cannot become worse.
        assert_eq!(verdict(None, Some(2.0), 100, 1), too_little);
        assert_eq!(verdict(None, None, 100, 1), too_little);
    }

    #[test]
    fn a_report_of_a_figure_has_its_difference_within_its_interval() {
        let report = |result| judged(&effect(result), [0.5, 0.75], 2.0, 1);
        for (result, low, high) in [(2.5, 0.25, 0.75), (3.0, 0.25, 1.0), (1.5, -0.5, 0.75)] {
            let found = report(result);
            assert_eq!(found.difference, Some(result - 2.0));
            assert_eq!((found.low, found.high), (Some(low), Some(high)));
        }
        let found = report(2.5);
        assert_eq!((found.p, found.adjusted_p, found.better_adjusted_p), (0.25, 0.5, 0.75));
        assert_eq!((found.baseline_of, found.result_of, found.blocks), (100, 50, 10));
        assert_eq!(found.better, "less");
        let near = FigureEffect { sense: figure_by_name("nees_mean").sense, ..effect(2.5) };
        assert_eq!(judged(&near, [1.0, 1.0], 2.0, 1).better, "near 1");
    }

    /// Student's t must exceed that of the critical value, of the comparison or of Bonferroni (0.05/2:
    /// 1.960), by 1.645 of its standard deviations.
    #[test]
    fn the_smallest_visible_amount_is_a_multiple_of_its_standard_error() {
        let seen = |critical, figures, tolerance| {
            let effect = FigureEffect { tolerance, ..effect(2.0) };
            judged(&effect, [1.0, 1.0], critical, figures).smallest_visible.unwrap()
        };
        let is = |got: f64, expected: f64| assert!((got - expected).abs() < 1e-6, "{got}, not {expected}");
        // For ten blocks, a critical value of 3 is a t of 9; 1.96 is one of 2.369 632, 1.645 of 1.827 146.
        let with_scatter = |t: f64| {
            let of_estimate = 1.644_854 * 1.644_854 / 18.0;
            let square = 1.0 - of_estimate;
            let k = (t + (t * t - square * (t * t * square - 18.0 * of_estimate)).sqrt()) / square;
            // The margin is 1.645 of its standard deviation.
            let margin = 1.644_854 * (1.0 + (t * t + k * k) / 18.0).sqrt();
            assert!((k - t - margin).abs() < 1e-6, "{k} for {t}");
            0.25 * k
        };
        is(seen(3.0, 2, 0.0), with_scatter(9.0));
        is(seen(1.0, 2, 0.0), with_scatter(2.369_357));
        is(seen(1.0, 1, 0.0), with_scatter(1.827_057));
        // A hundred figures would need more than √9: equal signs in all blocks are enough.
        is(seen(1.0, 100_000, 0.0), with_scatter(9.0));
        // A tolerance above the change that the test finds: the smallest visible change exceeds it with a
        // probability of 95 %.
        is(seen(1.0, 2, 5.0), 5.0 + 0.25 * 1.644_854);
    }

    /// A loss of δ of n has a scatter of √(δ/n) in addition to the standard error e: δ = z √(e² + δ/n).
    #[test]
    fn the_smallest_visible_loss_of_a_rate_includes_its_scatter() {
        crate::hand_made::register_worlds();
        for (standard_error, result_of) in [(0.25, 50), (0.01, 7), (0.0, 400)] {
            let effect = FigureEffect {
                sense: figure_by_name("hit_rate").sense,
                tolerance: 0.0,
                standard_error,
                result_of,
                ..effect(2.0)
            };
            let seen = judged(&effect, [1.0, 1.0], 3.0, 2).smallest_visible.unwrap();
            // As for the amount, with a t of 9.
            let z = 16.455_191;
            let expected = z * (standard_error * standard_error + seen / result_of as f64).sqrt();
            assert!(seen > 0.0 && (seen / expected - 1.0).abs() < 1e-6, "{seen}, not {expected}");
        }
        // The value for zero units is that for one unit.
        let none = FigureEffect {
            sense: figure_by_name("hit_rate").sense,
            tolerance: 0.0,
            result_of: 0,
            ..effect(2.0)
        };
        let one = FigureEffect { result_of: 1, ..none.clone() };
        let [none, one] = [none, one].map(|effect| judged(&effect, [1.0, 1.0], 3.0, 2).smallest_visible);
        assert_eq!(none, one);
    }
}
