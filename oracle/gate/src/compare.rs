//! A result against a baseline.
use files::Failure;
use indexmap::IndexMap;
use run::figure_called;
use score::attitude_note;
use statistics::{BlockEffects, Exchanges, joint_test, normal_quantile};

use super::baseline::Baseline;
use super::comparable::{check_reported, check_units, pairs};
use super::effects::{FigureEffect, interval, neighbour_correlation};
use super::flips::Flips;
use super::identity::Pairing;
use super::judge::Judge;
use super::options::CompareOptions;
use super::report::{FigureVerdict, GateReport};
use super::sample::Sample;

/// Compares a result with a baseline.
///
/// # Errors
/// [`Failure::Usage`] for options that are not allowed, for two samples that cannot be compared (with what differs), and when no figure
/// has enough data to be found worse whatever happens: a gate that cannot shut must not pass for one.
pub fn compare(
    baseline: &Baseline,
    result: &Sample,
    options: &CompareOptions,
) -> Result<GateReport, Failure> {
    let alpha = options.alpha;
    if !(alpha > 0.0 && alpha < 0.5) {
        return Err(Failure::Usage(format!("--alpha is {alpha}, expected a number above 0 and below 0.5")));
    }
    let identity = &baseline.sample.identity;
    let pairing = identity.pairing(&result.identity)?;
    let units = identity.kind.units(&identity.world);
    check_units(baseline, result, &units)?;
    check_reported(baseline, result, &units)?;
    let pairs = pairs(baseline, result, options)?;

    let blocks = &baseline.blocks;
    let exchanges = Exchanges::new(blocks.count());
    let effects: Vec<FigureEffect> = pairs
        .iter()
        .map(|(before, after)| {
            let tolerance = options.tolerances.get(&before.name).copied();
            FigureEffect::of_runs(figure_called(&before.name).sense, before, after, blocks, tolerance)
        })
        .collect();
    // What shuts the gate is tested together: every worsening, and of figures with a best value the change to the other side too.
    let with_best_value: Vec<usize> = (0..effects.len()).filter(|i| effects[*i].has_best_value()).collect();
    let other_side = with_best_value.iter().map(|i| effects[*i].better());
    let worse: Vec<BlockEffects> =
        effects.iter().map(|effect| effect.worse.clone()).chain(other_side).collect();
    let for_the_better = |effect: &FigureEffect| {
        let mut better = effect.better();
        if effect.has_best_value() {
            better.effects.fill(0.0);
        }
        better
    };
    let better: Vec<BlockEffects> = effects.iter().map(for_the_better).collect();
    let (worse, better) = (joint_test(&worse, &exchanges, alpha), joint_test(&better, &exchanges, alpha));

    let mut figures = IndexMap::new();
    let mut correlation: f64 = 0.0;
    for (index, ((before, after), effect)) in pairs.iter().zip(&effects).enumerate() {
        let other_side = with_best_value.iter().position(|i| *i == index).map(|place| effects.len() + place);
        let judge = Judge { effect, worse: &worse, better: &better, index, other_side, alpha };
        let interval = interval(before, after, blocks, &exchanges);
        correlation = correlation.max(neighbour_correlation(&effect.worse.effects));
        figures.insert(before.name.clone(), judge.report(interval.map(|i| (i.low, i.high))));
    }
    if figures.values().all(|figure| figure.verdict == FigureVerdict::TooLittleData) {
        return Err(Failure::Usage(format!(
            "cannot compare: {} {units} in {} blocks leave no figure that could be found worse at alpha = {alpha}, expected more of them",
            baseline.header.units,
            blocks.count()
        )));
    }
    let any = |is: fn(FigureVerdict) -> bool| figures.values().any(|figure| is(figure.verdict));
    Ok(GateReport {
        verdict: if any(FigureVerdict::is_worse) {
            FigureVerdict::Worse
        } else if any(|verdict| verdict == FigureVerdict::Changed) {
            FigureVerdict::Changed
        } else {
            FigureVerdict::NoWorse
        },
        accepted: options.accept_changed.clone(),
        name: identity.name.clone(),
        world: identity.world.clone(),
        reason: baseline.header.reason.clone(),
        units,
        count: baseline.header.units,
        pairing,
        baseline_seed: identity.seed,
        result_seed: result.identity.seed,
        baseline_version: identity.version.clone(),
        result_version: result.identity.version.clone(),
        alpha,
        blocks: blocks.count() as u64,
        block_length: blocks.mean_length(),
        neighbour_correlation: correlation,
        notes: notes(baseline, result, pairing, (correlation, pairs.len())),
        figures,
        flips: (pairing == Pairing::Frames)
            .then(|| Flips::of(&baseline.sample.table.units, &result.table.units)),
    })
}

/// What a reader must know. `correlation` is the largest of neighbouring blocks, and of how many figures it is that.
fn notes(
    baseline: &Baseline,
    result: &Sample,
    pairing: Pairing,
    (correlation, figures): (f64, usize),
) -> Vec<String> {
    let mut notes = Vec::new();
    let attitude = result.table.figures.iter().find_map(|figure| figure.attitude.as_deref());
    notes.extend(attitude_note(attitude));
    let (before, after) = (&baseline.sample.identity, &result.identity);
    if pairing == Pairing::Blocks && before.seed == after.seed {
        notes.push(format!(
            "The seed is the same and the frames are not: the simulator has changed (version {} then, {} now). Compared as with another seed.",
            before.version, after.version
        ));
    }
    // What the largest of so many independent correlations exceeds in one comparison of twenty.
    let by_chance = normal_quantile(1.0 - 0.05 / figures as f64) / (baseline.blocks.count() as f64).sqrt();
    if correlation > by_chance {
        notes.push(format!(
            "Neighbouring blocks go together (correlation {correlation:.2}, by chance at most {by_chance:.2}): they are too short, and \
             probabilities too small. A baseline with a longer --block-length cures it, as long as blocks are many."
        ));
    }
    notes
}

#[cfg(test)]
mod tests {
    use super::super::hand_made::{
        AFTER, BEFORE, baseline, compared, figure, hits, rate, refusal, sample, unit,
    };
    use super::*;
    use score::Reduction;

    /// Of nine frames that changed eight were lost: that of a fair coin, (9 + 1)/2⁹, and of one that were won, (2⁹ − 1)/2⁹.
    #[test]
    fn of_hits_and_misses_the_probability_is_that_of_mcnemars_exact_test() {
        let report = compared(hits(&BEFORE), &hits(&AFTER));
        let found = &report.figures["hit_rate"];
        assert_eq!((report.verdict, found.verdict), (FigureVerdict::Worse, FigureVerdict::Worse));
        assert_eq!(
            (found.p, found.adjusted_p, found.better_adjusted_p),
            (10.0 / 512.0, 10.0 / 512.0, 511.0 / 512.0)
        );
        assert_eq!((found.baseline, found.result), (Some(10.0 / 12.0), Some(3.0 / 12.0)));
        assert_eq!((found.baseline_of, found.result_of, found.blocks), (12, 12, 12));
        assert!((found.worse_by.unwrap() - 7.0 / 12.0).abs() < 1e-12, "{found:?}");
        assert!((found.difference.unwrap() + 7.0 / 12.0).abs() < 1e-12, "{found:?}");
        assert_eq!((found.better.as_str(), found.tolerance), ("more", 0.0));
        assert_eq!(report.worse().collect::<Vec<_>>(), ["hit_rate"]);

        let report = compared(hits(&AFTER), &hits(&BEFORE));
        assert_eq!(report.verdict, FigureVerdict::NoWorse);
        assert_eq!(report.figures["hit_rate"].verdict, FigureVerdict::Better);
    }

    /// A bias of −1 that becomes one of −0.5, of +0.9 or of −1.5: the first two are nearer to nought and no improvement.
    #[test]
    fn a_bias_that_points_to_nought_has_changed_and_shuts_the_gate() {
        let bias = |bias: f64| {
            let values: Vec<_> = (0..12).map(|i| Some(bias + 0.01 * f64::from(i % 3))).collect();
            sample(vec![figure("ra_mean_deg", Reduction::Mean, &values), rate("hit_rate", &BEFORE)])
        };
        for (after, verdict) in [
            (-0.5, FigureVerdict::Changed),
            (0.9, FigureVerdict::Changed),
            (-1.5, FigureVerdict::Worse),
            (-1.001, FigureVerdict::NoWorse),
        ] {
            let report = compared(bias(-1.0), &bias(after));
            assert_eq!(
                (report.verdict, report.figures["ra_mean_deg"].verdict),
                (verdict, verdict),
                "{after}"
            );
            assert_eq!(report.is_shut(), verdict != FigureVerdict::NoWorse);
            let accepting = CompareOptions {
                accept_changed: Some("a new centroider".to_owned()),
                ..CompareOptions::default()
            };
            let report = compare(&baseline(bias(-1.0)), &bias(after), &accepting).unwrap();
            assert_eq!(report.verdict, verdict);
            assert_eq!(report.is_shut(), verdict == FigureVerdict::Worse);
        }
    }

    #[test]
    fn a_report_tells_what_was_compared_and_the_frames_that_changed() {
        let mut after = hits(&AFTER);
        after.identity.version = "0.2.0".to_owned();
        after.table.units[3] = unit(3, "missed", Some("not_linked"));
        let report = compared(hits(&BEFORE), &after);
        assert_eq!((report.name.as_str(), report.world.as_str()), ("made by hand", "far_range"));
        assert_eq!((report.reason.as_str(), report.units.as_str(), report.count), ("a test", "frames", 12));
        assert_eq!((report.baseline_seed, report.result_seed), (1, 1));
        assert_eq!((report.baseline_version.as_str(), report.result_version.as_str()), ("0.1.0", "0.2.0"));
        assert_eq!((report.alpha, report.blocks, report.block_length), (0.05, 12, 1.0));
        let flips = report.flips.unwrap();
        assert_eq!((report.pairing, flips.lost, flips.units[0].number), (Pairing::Frames, 1, 3));
        // Of other frames nobody can say which changed.
        after.identity.seed = 2;
        let report = compared(hits(&BEFORE), &after);
        assert_eq!((report.pairing, report.result_seed, report.flips), (Pairing::Blocks, 2, None));
    }

    #[test]
    fn the_same_result_is_no_worse() {
        let report = compared(hits(&BEFORE), &hits(&BEFORE));
        let found = &report.figures["hit_rate"];
        assert_eq!((report.verdict, found.verdict), (FigureVerdict::NoWorse, FigureVerdict::NoWorse));
        assert_eq!((found.p, found.better_adjusted_p), (1.0, 1.0));
        assert_eq!((found.difference, found.low, found.high), (Some(0.0), Some(0.0), Some(0.0)));
        assert_eq!(report.neighbour_correlation, 0.0);
        assert!(report.flips.unwrap().units.is_empty() && report.notes.is_empty());
    }

    /// Of two figures one rises from block to block, and one alternates.
    #[test]
    fn the_correlation_of_neighbours_is_the_largest_of_any_figure() {
        let errors = |name: &str, values: [f64; 8]| figure(name, Reduction::Mean, &values.map(Some));
        let nought = |name: &str| errors(name, [10.0; 8]);
        let before = sample(vec![nought("a_mean"), nought("b_mean")]);
        let after = sample(vec![
            errors("a_mean", [11.0, 11.0, 12.0, 12.0, 14.0, 14.0, 15.0, 15.0]),
            errors("b_mean", [11.0, 15.0, 11.0, 15.0, 11.0, 15.0, 11.0, 15.0]),
        ]);
        // About their mean the differences of the first are −2 −2 −1 −1 1 1 2 2: products 4 + 2 + 1 − 1 + 1 + 2 + 4 over squares of 20.
        assert!((compared(before, &after).neighbour_correlation - 0.65).abs() < 1e-12);
    }

    #[test]
    fn alpha_is_above_nought_and_below_a_half() {
        let with = |alpha| CompareOptions { alpha, ..CompareOptions::default() };
        for alpha in [0.0, 0.5, -0.05, 1.0, f64::NAN] {
            let message = refusal(hits(&BEFORE), &hits(&AFTER), &with(alpha));
            let expected = format!("--alpha is {alpha}, expected a number above 0 and below 0.5");
            assert!(message.contains(&expected), "{message}");
        }
        // 10/512 is what the test finds.
        for (alpha, verdict) in [(0.49, FigureVerdict::Worse), (0.015, FigureVerdict::NoWorse)] {
            let report = compare(&baseline(hits(&BEFORE)), &hits(&AFTER), &with(alpha)).unwrap();
            assert_eq!((report.verdict, report.alpha), (verdict, alpha));
        }
    }

    /// Of five blocks no exchange has a probability below 1/32: at 5 % they can be found different, at 3 % not.
    #[test]
    fn a_gate_that_cannot_shut_is_an_error() {
        let with = |alpha| CompareOptions { alpha, ..CompareOptions::default() };
        let (before, after) = (hits(&[1; 5]), hits(&[0; 5]));
        let report = compare(&baseline(before.clone()), &after, &with(0.05)).unwrap();
        assert_eq!(report.verdict, FigureVerdict::Worse);
        let message = refusal(before, &after, &with(0.03));
        let expected = "5 frames in 5 blocks leave no figure that could be found worse at alpha = 0.03";
        assert!(message.contains(expected), "{message}");
    }

    /// Seven of twelve are lost: no worse where as many may be, and worse where one less may.
    #[test]
    fn a_figure_may_be_worse_by_its_tolerance() {
        let with = |tolerance: f64| {
            let tolerances = IndexMap::from([("hit_rate".to_owned(), tolerance)]);
            let options = CompareOptions { tolerances, ..CompareOptions::default() };
            compare(&baseline(hits(&BEFORE)), &hits(&AFTER), &options).unwrap().verdict
        };
        assert_eq!(with(7.01 / 12.0), FigureVerdict::NoWorse);
        assert_eq!(with(6.99 / 12.0), FigureVerdict::Worse);
    }

    #[test]
    fn another_simulator_is_noted_where_the_seed_is_the_same() {
        let note = |seed: u64, frames: &str| {
            let mut after = hits(&BEFORE);
            after.identity.seed = seed;
            after.identity.frames_sha256 = frames.to_owned();
            compared(hits(&BEFORE), &after).notes
        };
        let [changed] = &note(1, "g")[..] else { panic!("one note") };
        assert!(changed.contains("the simulator has changed (version 0.1.0 then, 0.1.0 now)"), "{changed}");
        assert_eq!(note(1, "f"), Vec::<String>::new());
        assert_eq!(note(2, "g"), Vec::<String>::new());
    }

    /// Of two figures in 25 blocks the 97.5 % quantile over 5, 0.392.
    #[test]
    fn blocks_that_go_together_more_than_by_chance_are_noted() {
        let baseline = baseline(hits(&[1; 25]));
        let notes = |correlation: f64| notes(&baseline, &baseline.sample, Pairing::Frames, (correlation, 2));
        let [short] = &notes(0.3921)[..] else { panic!("one note") };
        assert!(short.contains("(correlation 0.39, by chance at most 0.39): they are too short"), "{short}");
        for correlation in [0.3919, 0.0, -0.5, normal_quantile(0.975) / 5.0] {
            assert!(notes(correlation).is_empty(), "{correlation}");
        }
    }
}
