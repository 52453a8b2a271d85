//! The worst frames of a run as pictures: of every cause of wrong and of missing measurements one, then the
//! correct measurements with the largest errors.

use std::cmp::Reverse;

use ::report::page::Section;
use far_range::scoring::{Cause, Verdict};
use files::Failure;

use super::FrameDetail;
use super::image::KEY;
use super::run::FarRangeRun;

/// Number of correct measurements with the largest errors.
const SHOWN_ERRORS: usize = 2;

/// A frame to show, with the number of frames of its kind.
struct Shown {
    row: usize,
    alike: usize,
}

/// Returns the section: for every cause of wrong measurements the farthest one, for every cause of misses the
/// middle one, most frequent causes first; then the largest errors of correct measurements and a typical one.
pub(super) fn frames(run: &FarRangeRun, sheet: &FrameDetail) -> Result<Section, Failure> {
    let section = Section::new("frames", "Worst frames");
    if let Some(reason) = sheet.reason() {
        return Ok(section.absent(format!("The frames cannot be rendered again: {reason}")));
    }
    let shown: Vec<Shown> = wrong(run).into_iter().chain(missed(run)).chain(correct(run)).collect();
    let mut pictures = sheet.pictures(run, &shown.iter().map(|shown| shown.row).collect::<Vec<_>>())?;
    for (picture, shown) in pictures.iter_mut().zip(&shown) {
        if shown.alike > 1 {
            picture.caption.push_str(&format!(" One of {} frames of this kind.", shown.alike));
        }
    }
    let text = format!(
        "For every cause of wrong measurements the farthest one, for every cause of misses the middle one, the \
         most frequent causes first; then the correct measurements with the largest errors, and a typical one. \
         Rendered again from `run.toml`, each with its own brightness scale. {KEY}"
    );
    Ok(section.text(text).pictures(pictures))
}

/// Returns the farthest wrong measurement of every cause.
fn wrong(run: &FarRangeRun) -> Vec<Shown> {
    by_cause(run, |verdict| match verdict {
        Verdict::Wrong { cause, .. } => Some(*cause),
        _ => None,
    })
    .into_iter()
    .filter_map(|rows| {
        let row = rows.iter().copied().max_by(|&a, &b| error_px(run, a).total_cmp(&error_px(run, b)))?;
        Some(Shown { row, alike: rows.len() })
    })
    .collect()
}

/// Returns the middle miss of every cause.
fn missed(run: &FarRangeRun) -> Vec<Shown> {
    by_cause(run, |verdict| match verdict {
        Verdict::Missed { cause } => Some(*cause),
        _ => None,
    })
    .into_iter()
    .filter_map(|rows| Some(Shown { row: *rows.get(rows.len() / 2)?, alike: rows.len() }))
    .collect()
}

/// Returns the correct measurements with the largest errors, and the one in the middle of the run.
fn correct(run: &FarRangeRun) -> Vec<Shown> {
    let mut rows: Vec<usize> = (0..run.verdicts.len())
        .filter(|&row| matches!(run.verdicts[row].verdict, Verdict::Correct { .. }))
        .collect();
    let typical = rows.get(rows.len() / 2).copied();
    rows.sort_by(|&a, &b| error_px(run, b).total_cmp(&error_px(run, a)).then(a.cmp(&b)));
    rows.truncate(SHOWN_ERRORS);
    rows.extend(typical.filter(|typical| !rows.contains(typical)));
    rows.into_iter().map(|row| Shown { row, alike: 1 }).collect()
}

/// Returns the rows of every cause that `cause_of` finds, the most frequent cause first.
fn by_cause(run: &FarRangeRun, cause_of: fn(&Verdict) -> Option<Cause>) -> Vec<Vec<usize>> {
    let mut kinds: Vec<Vec<usize>> = Vec::new();
    for cause in Cause::ALL {
        let is_of = |row: &usize| cause_of(&run.verdicts[*row].verdict) == Some(cause);
        kinds.push((0..run.verdicts.len()).filter(is_of).collect());
    }
    kinds.retain(|rows| !rows.is_empty());
    kinds.sort_by_key(|rows| Reverse(rows.len()));
    kinds
}

/// Returns the distance of the measured position from the target in a row, px; 0 without one.
fn error_px(run: &FarRangeRun, row: usize) -> f64 {
    let error = run.verdicts[row].verdict.error().and_then(|error| error.centroid_px);
    error.map_or(0.0, |[x, y]| libm::hypot(x, y))
}
