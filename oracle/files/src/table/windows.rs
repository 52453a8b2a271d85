//! Transmitted regions as text: `x y columns rows`, separated by `;`.

use contract::{Camera, Window};

/// Returns the regions as text; empty if the whole image was transmitted, `none` if nothing was.
pub fn format(windows: Option<&[Window]>) -> String {
    match windows {
        None => String::new(),
        Some([]) => "none".to_owned(),
        Some(windows) => windows.iter().map(format_one).collect::<Vec<_>>().join(";"),
    }
}

/// Returns one region as `x y columns rows`.
pub fn format_one(window: &Window) -> String {
    format!("{} {} {} {}", window.x, window.y, window.columns, window.rows)
}

/// Description of the input of [`parse`], for messages.
pub const EXPECTED: &str =
    "regions `x y columns rows` separated by `;`, `none`, or an empty cell for the whole image";

/// Parses the output of `format`; the inner `Option` is `None` if the whole image was transmitted.
pub fn parse(text: &str) -> Result<Option<Vec<Window>>, &'static str> {
    match text.trim() {
        "" => Ok(None),
        "none" => Ok(Some(Vec::new())),
        list => list.split(';').map(parse_one).collect::<Option<_>>().map(Some).ok_or(EXPECTED),
    }
}

/// Parses one region. No number may exceed the size of the largest detector, which excludes overflow of their
/// sums.
pub fn parse_one(text: &str) -> Option<Window> {
    let mut numbers = text
        .split_ascii_whitespace()
        .map(|word| word.parse::<usize>().ok().filter(|&n| n <= Camera::MAX_SIDE_PX));
    let mut next = || numbers.next().flatten();
    let window = Window { x: next()?, y: next()?, columns: next()?, rows: next()? };
    numbers.next().is_none().then_some(window)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn regions_round_trip() {
        let window = |x| Window { x, y: 2, columns: 64, rows: 32 };
        for windows in [None, Some(vec![]), Some(vec![window(0)]), Some(vec![window(7), window(100)])] {
            assert_eq!(parse(&format(windows.as_deref())), Ok(windows));
        }
    }

    #[test]
    fn an_invalid_region_is_refused() {
        for text in ["1 2 3", "1 2 3 4 5", "1 2 3 -4", "a b c d", "1 2 3 4;", ";", "0 99999999999999999 1 1"]
        {
            assert_eq!(parse(text), Err(EXPECTED), "{text}");
        }
    }
}
