//! Text output of a comparison of a camera with its twin.

use comfy_table::Cell;
use twin::FrameSet;
use twin::likeness::{Comparison, Likeness};
use view::terminal::{finish, plain_table, wrapped};

/// Returns the likeness of the frames of a camera and of its twin as text.
pub fn likeness_table(camera: &FrameSet, twin: &FrameSet, found: &Comparison, styled: bool) -> String {
    let different = found.figures.iter().filter(|figure| !figure.is_indistinguishable()).count();
    let mut text = wrapped(&format!(
        "{} of {} figures are indistinguishable, {different} differ: {} frames of the camera, {} of the twin, {} \
         stars in both\n",
        found.figures.len() - different,
        found.figures.len(),
        camera.fit.frames.len(),
        twin.fit.frames.len(),
        found.stars.len()
    ));
    text.push_str(&wrapped(&format!("{}\n", whole_words(found))));
    let mut table = plain_table(styled);
    table.set_header(["figure", "camera", "twin", "difference", "± 95 %", ""]);
    for figure in &found.figures {
        let [name, unit, camera, twin, difference, limit, _, _] = likeness_cells(figure);
        let name = if unit.is_empty() { name } else { format!("{name}, {unit}") };
        let statement = if figure.is_indistinguishable() { "" } else { "differs" };
        let cells = [name, camera, twin, difference, limit, statement.to_owned()];
        table.add_row(cells.into_iter().map(Cell::new));
    }
    text.push_str(&finish(table));
    for lack in &found.missing {
        text.push_str(&wrapped(&format!("not compared: {}: {}\n", lack.name, lack.reason)));
    }
    text.trim_end().to_owned()
}

/// Returns the statement on all figures together.
pub(crate) fn whole_words(found: &Comparison) -> &'static str {
    if found.is_alike() {
        "As a whole they are alike: one figure in twenty differs by chance, and none by more."
    } else {
        "As a whole they differ, by more than chance gives in one of so many figures."
    }
}

/// Returns the row of a figure: name, unit, both values, difference, interval, statement, smallest visible
/// difference.
pub(crate) fn likeness_cells(figure: &Likeness) -> [String; 8] {
    let digits = digits(figure.limit);
    let number = |value: f64| format!("{value:.digits$}");
    let value = |value: Option<f64>| value.map_or_else(|| "–".to_owned(), number);
    let statement = if figure.is_indistinguishable() { "indistinguishable" } else { "differs" };
    [
        figure.name.to_owned(),
        figure.unit.words().to_owned(),
        value(figure.camera),
        value(figure.twin),
        signed(figure.difference, digits),
        number(figure.limit),
        statement.to_owned(),
        number(figure.visible),
    ]
}

/// Returns a number with its sign; none for one that rounds to 0.
fn signed(value: f64, digits: usize) -> String {
    let text = format!("{value:+.digits$}");
    if text.contains(|digit: char| ('1'..='9').contains(&digit)) { text } else { format!("{:.digits$}", 0.0) }
}

/// Returns the number of decimals with which an error has two digits.
fn digits(error: f64) -> usize {
    if error > 0.0 && error.is_finite() {
        (1.0 - libm::log10(error).floor()).clamp(0.0, 9.0) as usize
    } else {
        3
    }
}
