//! Notes that a reader of a gate's report needs in addition to its figures.
use indexmap::IndexMap;
use run::figure_by_name;
use score::attitude_note;
use statistics::normal_quantile;

use super::judge::ALPHA_OF_RUNS;
use crate::baseline::Baseline;
use crate::identity::Pairing;
use crate::report::FigureReport;
use crate::sample::Sample;

/// Largest number of figures that a note names; for further figures it states only their number.
const MAX_NAMED_FIGURES: usize = 3;

/// Data from which the notes are derived.
pub(crate) struct NoteInputs<'a> {
    pub(crate) baseline: &'a Baseline,
    pub(crate) result: &'a Sample,
    pub(crate) pairing: Pairing,
    pub(crate) alpha: f64,
    pub(crate) figures: &'a IndexMap<String, FigureReport>,
    /// Figures whose difference is correlated from block to block.
    pub(crate) beyond_blocks: &'a [&'a str],
    /// Figures with values in so few blocks that no data would be found worse.
    pub(crate) out_of_reach: &'a [&'a str],
    /// Largest correlation of neighbouring blocks among all figures.
    pub(crate) correlation: f64,
    pub(crate) blocks: usize,
}

/// Returns the notes for a reader of the report.
pub(crate) fn notes(noted: &NoteInputs<'_>) -> Vec<String> {
    let NoteInputs { baseline, result, pairing, .. } = *noted;
    let mut notes = Vec::new();
    let attitude = result.table.figures.iter().find_map(|figure| figure.attitude.as_deref());
    notes.extend(attitude_note(attitude));
    let (before, after) = (&baseline.sample.identity, &result.identity);
    if pairing == Pairing::Blocks && before.seed == after.seed {
        notes.push(format!(
            "The seed is the same, but the frames differ: the simulator has changed (version {} then, {} \
             now). Compared block by block, as for another seed.",
            before.version, after.version
        ));
    }
    notes.extend(loss_note(noted));
    if !noted.beyond_blocks.is_empty() {
        notes.push(format!(
            "Too little data for {} with different frames: the difference is correlated from block to block. \
             Compare the same frames, or make a longer run.",
            labels(noted.beyond_blocks)
        ));
    }
    if !noted.out_of_reach.is_empty() {
        notes.push(format!(
            "Too little data for {}: in so few blocks, no values would be found worse at alpha = {}. Compare a \
             longer result, or leave out --figures that have fewer values.",
            labels(noted.out_of_reach),
            noted.alpha
        ));
    }
    // Value that the largest of independent correlations, one per figure, exceeds in one of twenty
    // comparisons.
    let by_chance = normal_quantile(1.0 - 0.05 / noted.figures.len() as f64) / (noted.blocks as f64).sqrt();
    if noted.correlation > by_chance {
        notes.push(format!(
            "Neighbouring blocks are correlated (correlation {:.2}, by chance at most {by_chance:.2}): they \
             are too short, and the probabilities too small. Make a baseline with a longer --block-length \
             that still leaves many blocks.",
            noted.correlation
        ));
    }
    notes
}

/// Returns a note that names the lost units if their run of losses is the only reason to shut the gate.
fn loss_note(noted: &NoteInputs<'_>) -> Option<String> {
    let found_by_run = |figure: &&FigureReport| {
        let run = figure.loss_run.as_ref();
        figure.verdict.is_worse()
            && figure.adjusted_p > noted.alpha
            && run.is_some_and(|run| run.adjusted_p <= ALPHA_OF_RUNS * noted.alpha)
    };
    let (name, figure) = noted.figures.iter().find(|(_, figure)| found_by_run(figure))?;
    let run = figure.loss_run.as_ref()?;
    let identity = &noted.baseline.sample.identity;
    let units = identity.kind.units(&identity.world);
    let place = run.first.zip(run.last).map_or_else(String::new, |(first, last)| {
        format!(", {} of them in a row (numbers {first} to {last})", run.longest)
    });
    Some(format!(
        "{}: {} {units} were lost and {} won{place}. Chance does not explain this (p {:.1e}), although it \
         affects too few blocks for the block test.",
        figure_by_name(name).words,
        run.lost,
        run.won,
        run.adjusted_p
    ))
}

/// Returns the labels of some figures, and the number of further ones.
fn labels(names: &[&str]) -> String {
    let named: Vec<String> =
        names.iter().take(MAX_NAMED_FIGURES).map(|name| figure_by_name(name).words).collect();
    match names.len().saturating_sub(MAX_NAMED_FIGURES) {
        0 => named.join(", "),
        others => format!("{} and {others} other figures", named.join(", ")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::hand_made::{BEFORE, baseline, compared, hits, rate, sample};

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

    /// For two figures in 25 blocks the limit is the 97.5 % quantile divided by 5, 0.392.
    #[test]
    fn blocks_that_go_together_more_than_by_chance_are_noted() {
        let baseline = baseline(sample(vec![rate("hit_rate", &[1; 25]), rate("correct_rate", &[1; 25])]));
        let report = compared(baseline.sample.clone(), &baseline.sample);
        let notes = |correlation: f64| {
            notes(&NoteInputs {
                baseline: &baseline,
                result: &baseline.sample,
                pairing: Pairing::Frames,
                alpha: 0.05,
                figures: &report.figures,
                beyond_blocks: &[],
                out_of_reach: &[],
                correlation,
                blocks: 25,
            })
        };
        let [short] = &notes(0.3921)[..] else { panic!("one note") };
        assert!(short.contains("(correlation 0.39, by chance at most 0.39): they are too short"), "{short}");
        for correlation in [0.3919, 0.0, -0.5, normal_quantile(0.975) / 5.0] {
            assert!(notes(correlation).is_empty(), "{correlation}");
        }
    }
}
