//! Consistency of the stated covariances, by group, state of the image and source of the attitude.

use ::report::figures::words::display_name;
use ::report::figures::{cell, percent_cell};
use ::report::page::Section;
use ::report::page::data_table::DataTable;
use ::report::verdict::rules::{Measured, nees};
use far_range::scoring::{Score, names};
use indexmap::IndexMap;
use run::figure_by_name;
use score::Figure;

/// Figures of consistency, in the order of the columns.
const FIGURES: [&str; 6] = [
    names::CENTROID_NEES_MEAN,
    names::CENTROID_WITHIN_1SIGMA_RATE,
    names::CENTROID_WITHIN_3SIGMA_RATE,
    names::LINE_OF_SIGHT_NEES_MEAN,
    names::LINE_OF_SIGHT_WITHIN_1SIGMA_RATE,
    names::LINE_OF_SIGHT_WITHIN_3SIGMA_RATE,
];

/// Returns the table of consistency; empty if no correct measurement states a covariance.
pub(super) fn covariances(score: &Score) -> Section {
    let section = Section::new("covariances", "Covariances of the measurements");
    if score.consistency.is_empty() {
        return section.absent("No correct measurement states a covariance.");
    }
    let labels = FIGURES.map(|name| figure_by_name(name).words);
    let mut table = DataTable::new([String::new(), "frames".to_owned()].into_iter().chain(labels)).caption(
        "Correct measurements with a covariance. The mean NEES per dimension is 1 if the covariances are \
         correct and above 1 if they are too small; 68.27 and 99.73 % of the components are within 1 and 3 σ \
         for normal errors. With 95 % intervals.",
    );
    let mut push = |label: String, frames: u64, figures: &IndexMap<String, Figure>| {
        let cells = FIGURES.map(|name| figure_text(name, figures.get(name)));
        table.push([label, frames.to_string()].into_iter().chain(cells));
    };
    let counted = |figures: &IndexMap<String, Figure>| {
        let of = |name: &str| figures.get(name).map_or(0, |figure| figure.of);
        of(names::CENTROID_NEES_MEAN).max(of(names::LINE_OF_SIGHT_NEES_MEAN))
    };
    push("all".to_owned(), counted(&score.figures), &score.figures);
    for (group, of_group) in &score.groups {
        push(group.clone(), counted(&of_group.figures), &of_group.figures);
    }
    for row in &score.consistency {
        push(format!("{}: {}", row.by, display_name(&row.value)), row.frames, &row.figures);
    }
    section.table(table.narrow()).text(in_words(score))
}

/// States in words whether σ is honest.
fn in_words(score: &Score) -> String {
    let kinds =
        [("position in the image", names::CENTROID_NEES_MEAN), ("direction", names::LINE_OF_SIGHT_NEES_MEAN)];
    let mut sentences = Vec::new();
    for (what, name) in kinds {
        if let Some(measured) = Measured::from_figure(score.figures.get(name)) {
            sentences.push(format!("All frames, {what}: {}", nees(what, Some(measured)).text));
        }
    }
    sentences.join(" ")
}

/// Formats a figure with its interval; a dash if its denominator is 0.
fn figure_text(name: &str, figure: Option<&Figure>) -> String {
    let Some(figure) = figure.filter(|figure| figure.value.is_some()) else { return cell(None) };
    if figure_by_name(name).is_rate() {
        return percent_cell(Some(figure));
    }
    let interval = figure.low.zip(figure.high);
    let interval = interval.map(|(low, high)| format!(" ({}–{})", cell(Some(low)), cell(Some(high))));
    format!("{}{}", cell(figure.value), interval.unwrap_or_default())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_figure_has_its_interval_and_none_without_a_value() {
        crate::register();
        let nees = Figure::mean(&[vec![0.5, 1.5, 1.0, 2.0]]);
        let text = figure_text(names::CENTROID_NEES_MEAN, Some(&nees));
        assert!(text.starts_with("1.250 (") && text.ends_with(')'), "{text}");
        let within = Figure::rate(&[vec![true, true, false, true]]);
        assert!(figure_text(names::CENTROID_WITHIN_1SIGMA_RATE, Some(&within)).starts_with("75.00 ("));
        assert_eq!(figure_text(names::CENTROID_NEES_MEAN, Some(&Figure::mean(&[]))), "–");
        assert_eq!(figure_text(names::CENTROID_NEES_MEAN, None), "–");
    }
}
