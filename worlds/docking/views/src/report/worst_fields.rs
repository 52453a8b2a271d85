//! The worst fields of a run as pictures: of every kind of wrong, missed and doubtful fields one, then the
//! measured fields with the largest errors.

use ::report::page::Section;
use contract::docking::DockingOutcome;
use files::Failure;
use indexmap::IndexMap;

use super::{DockingRun, FieldDetail, renderer_note};

/// Legend of the marks in a picture.
pub(super) const KEY: &str = "Orange: recognised features (cross, circle of the marks, used marks); yellow: \
    outlines of station and docking unit; violet: rejected or missing marks; green: true centres of cross and \
    disk.";
/// Number of measured fields with the largest errors.
const SHOWN_ERRORS: usize = 3;

/// A field to show, with the number of fields of its kind.
struct Shown {
    row: usize,
    alike: usize,
}

/// Returns the section: one field of every kind of gross error, of every cause of misses and of every failed
/// test, the most frequent first, then the measured fields with the largest errors for their range.
pub(super) fn fields(run: &DockingRun, sheet: &FieldDetail) -> Result<Section, Failure> {
    let section = Section::new("worst-fields", "Worst fields");
    if let Some(reason) = sheet.reason() {
        return Ok(section.absent(format!("The fields cannot be rendered again: {reason}")));
    }
    let mut shown = Vec::new();
    for (verdict, causes) in
        [("wrong", &run.score.wrong), ("missed", &run.score.misses), ("doubtful", &run.score.doubtful)]
    {
        shown.extend(one_of_each(run, verdict, causes));
    }
    shown.extend(largest_errors(run));
    if shown.is_empty() {
        return Ok(section.absent("No field is wrong, missed, doubtful or measured."));
    }
    let mut pictures = sheet.pictures(run, &shown.iter().map(|shown| shown.row).collect::<Vec<_>>())?;
    for (picture, shown) in pictures.iter_mut().zip(&shown) {
        if shown.alike > 1 {
            picture.caption.push_str(&format!(" One of {} fields of this kind.", shown.alike));
        }
    }
    let text = format!(
        "The middle field of every kind of gross error, of every cause of misses and of every failed test of the \
         pipeline, the most frequent first; then the measured fields with the largest errors of the position for \
         their range. Rendered again from `run.toml`. {KEY}{}",
        renderer_note(run)
    );
    Ok(section.text(text).pictures(pictures))
}

/// Returns the middle field of every cause of a verdict, the most frequent cause first.
fn one_of_each(run: &DockingRun, verdict: &str, causes: &IndexMap<String, u64>) -> Vec<Shown> {
    let mut kinds: Vec<Vec<usize>> = Vec::new();
    for cause in causes.keys() {
        let is_of = |row: &usize| {
            let unit = &run.verdicts[*row];
            unit.verdict == verdict && unit.cause.as_deref() == Some(cause)
        };
        kinds.push((0..run.verdicts.len()).filter(is_of).collect());
    }
    kinds.sort_by_key(|rows| std::cmp::Reverse(rows.len()));
    kinds
        .iter()
        .filter_map(|rows| Some(Shown { row: *rows.get(rows.len() / 2)?, alike: rows.len() }))
        .collect()
}

/// Returns the measured fields whose position has the largest error, as a part of the range.
fn largest_errors(run: &DockingRun) -> Vec<Shown> {
    let error = |row: usize| {
        let measured = run.outcomes[row].as_ref().and_then(DockingOutcome::measurement)?;
        let truth = &run.truths[row];
        Some(
            (measured.best.pose.position_m - truth.pose.position_m).norm()
                / truth.range_m.max(f64::MIN_POSITIVE),
        )
    };
    let mut rows: Vec<(usize, f64)> = (0..run.verdicts.len())
        .filter(|&row| run.verdicts[row].verdict == "success")
        .filter_map(|row| Some((row, error(row)?)))
        .collect();
    rows.sort_by(|a, b| b.1.total_cmp(&a.1).then(a.0.cmp(&b.0)));
    rows.truncate(SHOWN_ERRORS);
    rows.into_iter().map(|(row, _)| Shown { row, alike: 1 }).collect()
}
