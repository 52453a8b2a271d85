//! Legend of the kinds of marks.

use crate::canvas::colour::GREY;
use crate::canvas::text::Font;
use crate::canvas::{Area, Canvas, LINE};
use crate::panel::Panel;
use crate::panel::class::{Class, Symbol};

/// Width of a symbol and the gap after it, px.
const SYMBOL: usize = 26;
/// Gap between two entries of a row, px.
const GAP: usize = 26;

/// Returns the classes that are visible in at least one of the panels, in the order of the legend.
pub(crate) fn classes(panels: &[Panel]) -> Vec<Class> {
    let mut drawn: Vec<Class> = Vec::new();
    for panel in panels {
        let shown = panel.marks.iter().filter(|mark| panel.shows(mark.at)).map(|mark| mark.class);
        let has_regions = panel.regions.as_ref().is_some_and(|regions| !regions.is_empty());
        for class in shown.chain(has_regions.then_some(Class::REGION)) {
            if !drawn.contains(&class) {
                drawn.push(class);
            }
        }
    }
    drawn.sort_by_key(|class| class.rank);
    drawn
}

/// Returns the width of an entry, px.
pub(crate) fn width(class: Class) -> usize {
    SYMBOL + Font::Body.width(class.words)
}

/// Arranges entries in rows of at most the width `room`, px.
pub(crate) fn rows(classes: &[Class], room: usize) -> Vec<Vec<Class>> {
    let mut rows: Vec<Vec<Class>> = Vec::new();
    let mut left = 0;
    for &class in classes {
        let needed = width(class) + GAP;
        match rows.last_mut().filter(|_| needed <= left + GAP) {
            Some(row) => row.push(class),
            None => {
                rows.push(vec![class]);
                left = room;
            }
        }
        left = left.saturating_sub(needed);
    }
    rows
}

/// Draws rows of entries, one below another.
pub(crate) fn draw(canvas: &mut Canvas, left: usize, top: usize, rows: &[Vec<Class>]) {
    for (line, row) in rows.iter().enumerate() {
        let top = top + line * line_height();
        let mut left = left;
        for &class in row {
            symbol(canvas, class, (left as f64 + 9.0, top as f64 + 0.5 * Font::Body.height() as f64));
            canvas.text(left + SYMBOL, top, class.words, Font::Body, GREY);
            left += width(class) + GAP;
        }
    }
}

/// Returns the distance from one row to the next, px.
pub(crate) fn line_height() -> usize {
    Font::Body.height() + 2
}

fn symbol(canvas: &mut Canvas, class: Class, (x, y): (f64, f64)) {
    let colour = class.rgb();
    let arms =
        |dx: f64, dy: f64| [[(x - dx, y - dy), (x + dx, y + dy)], [(x - dy, y + dx), (x + dy, y - dx)]];
    match class.symbol {
        Symbol::Circle => canvas.circle((x, y), 6.5, colour, LINE),
        Symbol::Cross => canvas.lines(&arms(7.0, 0.0), colour, LINE),
        Symbol::Saltire => canvas.lines(&arms(5.0, 5.0), colour, LINE),
        Symbol::Square => canvas.frame(&square((x, y)), colour, LINE),
        Symbol::ThinSquare => canvas.frame(&square((x, y)), colour, 1.0),
    }
}

fn square((x, y): (f64, f64)) -> Area {
    Area { left: x - 6.0, top: y - 6.0, width: 12.0, height: 12.0 }
}

#[cfg(test)]
mod tests {
    use super::*;

    const CLASSES: [Class; 6] = [
        Class::TARGET,
        Class { code: "star", words: "star, truth", ..Class::TARGET },
        Class { code: "hit", words: "cosmic-ray hit, truth", ..Class::TARGET },
        Class { code: "hot", words: "hot pixel, truth", ..Class::TARGET },
        Class::ANSWER,
        Class::REGION,
    ];

    #[test]
    fn rows_hold_every_entry_once_and_are_no_wider_than_their_room() {
        for room in [1, 300, 700, 5000] {
            let rows = rows(&CLASSES, room);
            assert_eq!(rows.concat(), CLASSES);
            for row in rows.iter().filter(|row| row.len() > 1) {
                let taken: usize = row.iter().map(|class| width(*class)).sum();
                assert!(taken + GAP * (row.len() - 1) <= room, "{room}: {row:?}");
            }
        }
        assert_eq!(rows(&CLASSES, 1).len(), CLASSES.len());
    }
}
