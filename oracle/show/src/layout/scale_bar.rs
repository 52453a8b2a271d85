//! Scale bar: a number of pixels, as an angle and, if the range is known, as a length.

use super::view::Placement;
use crate::canvas::colour::{BLACK, WHITE};
use crate::canvas::text::Font;
use crate::canvas::{Area, Canvas};
use crate::panel::PlateScale;

/// Gap between text, bar and the edges of the box, px.
const ROOM: usize = 6;
/// Distance from the box to the edge of the picture, px.
const INSET: usize = 8;
/// Height of the ticks at the ends of the bar, px.
const TICK: f64 = 8.0;

/// Scale bar of a placement.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct ScaleBar {
    words: String,
    length: f64,
    /// Box around text and bar, in a lower corner of the placement.
    pub(crate) area: Area,
}

impl ScaleBar {
    /// Creates the bar of a placement, in the lower right corner, or in the left one if the box overlaps
    /// fewer of `areas` there; `None` if there is no room for a bar.
    pub(crate) fn new(placement: &Placement, scale: &PlateScale, areas: &[Area]) -> Option<Self> {
        let pixels = round_number(0.2 * placement.width as f64 / placement.zoom)?;
        let words = words(pixels, scale);
        let length = pixels * placement.zoom;
        let width = Font::Label.width(&words).max(length.ceil() as usize) + 2 * ROOM;
        let height = Font::Label.height() + TICK as usize + 2 * ROOM;
        let right = placement.width.checked_sub(width + INSET)?;
        let top = placement.height.checked_sub(height + INSET)?;
        let at = |left: usize| Area {
            left: left as f64,
            top: top as f64,
            width: width as f64,
            height: height as f64,
        };
        let hidden = |area: &Area| areas.iter().filter(|other| other.meets(area)).count();
        let area = [at(right), at(INSET)].into_iter().min_by_key(hidden)?;
        // The box may cover at most an eighth of the picture.
        (8 * width * height <= placement.width * placement.height).then_some(Self { words, length, area })
    }

    /// Draws the scale bar.
    pub(crate) fn draw(&self, canvas: &mut Canvas) {
        canvas.shade(&self.area);
        let room = ROOM as f64;
        let text_left = self.area.left + 0.5 * (self.area.width - Font::Label.width(&self.words) as f64);
        let text_top = self.area.top + 0.5 * room;
        canvas.text(text_left as usize, text_top as usize, &self.words, Font::Label, WHITE);
        let left = self.area.left + 0.5 * (self.area.width - self.length);
        let y = self.area.top + self.area.height - room - 0.5 * TICK;
        let right = left + self.length;
        let ticks = [left, right].map(|x| [(x, y - 0.5 * TICK), (x, y + 0.5 * TICK)]);
        let [first, last] = ticks;
        for (colour, width) in [(BLACK, 4.0), (WHITE, 2.0)] {
            canvas.lines(&[[(left, y), (right, y)], first, last], colour, width);
        }
    }
}

/// Returns the largest of 1, 2, 5, 10, 20 … that is at most `most`; `None` below 1.
fn round_number(most: f64) -> Option<f64> {
    let mut found = None;
    let mut decade = 1.0;
    while decade <= most && decade < 1e6 {
        found = [1.0, 2.0, 5.0].map(|digit| digit * decade).into_iter().rfind(|number| *number <= most);
        decade *= 10.0;
    }
    found
}

/// Returns the label of a bar that is `pixels` long.
fn words(pixels: f64, scale: &PlateScale) -> String {
    let radians = libm::atan(pixels / scale.focal_length_px);
    let degrees = radians.to_degrees();
    let angle = if degrees >= 0.1 {
        format!("{}°", two_digits(degrees))
    } else if degrees >= 0.1 / 60.0 {
        format!("{} arcmin", two_digits(60.0 * degrees))
    } else {
        format!("{} arcsec", two_digits(3600.0 * degrees))
    };
    let length = scale.range_m.map(|range_m| {
        let metres = range_m * pixels / scale.focal_length_px;
        let length = if metres >= 1.0 {
            format!("{} m", two_digits(metres))
        } else if metres >= 0.01 {
            format!("{} cm", two_digits(100.0 * metres))
        } else {
            format!("{} mm", two_digits(1000.0 * metres))
        };
        format!(" = {length}")
    });
    format!("{pixels} px = {angle}{}", length.unwrap_or_default())
}

/// Formats a positive number to two significant digits, without an exponent.
fn two_digits(value: f64) -> String {
    let decimals = if value >= 9.95 {
        0
    } else if value >= 0.995 {
        1
    } else {
        2
    };
    format!("{value:.decimals$}")
}

#[cfg(test)]
mod tests {
    use contract::Window;

    use super::*;

    #[test]
    fn the_bar_is_a_round_number_of_pixels() {
        let bars = [0.5, 1.0, 3.9, 7.0, 10.0, 49.9, 150.4, 1e9].map(round_number);
        let expected =
            [None, Some(1.0), Some(2.0), Some(5.0), Some(10.0), Some(20.0), Some(100.0), Some(500_000.0)];
        assert_eq!(bars, expected);
    }

    #[test]
    fn words_state_the_angle_in_its_unit_and_the_length_at_the_range() {
        let words =
            |pixels, focal_length_px, range_m| words(pixels, &PlateScale { focal_length_px, range_m });
        // ARGON: 20.187 mm focal length, 8.6 µm pixels; atan(100/2347.3) is 2.4394°.
        assert_eq!(words(100.0, 2347.3, None), "100 px = 2.4°");
        assert_eq!(words(2.0, 2347.3, None), "2 px = 2.9 arcmin");
        assert_eq!(words(1.0, 1e6, None), "1 px = 0.21 arcsec");
        // 20 m × 100/2917 is 0.686 m.
        assert_eq!(words(100.0, 2917.0, Some(20.0)), "100 px = 2.0° = 69 cm");
        assert_eq!(words(100.0, 2917.0, Some(400.0)), "100 px = 2.0° = 14 m");
    }

    #[test]
    fn it_gives_way_to_marks() {
        let scale = PlateScale { focal_length_px: 2917.0, range_m: None };
        let placement = Placement::fit(Window { x: 0, y: 0, columns: 752, rows: 580 }, (752, 580), 1);
        let left = |areas: &[Area]| ScaleBar::new(&placement, &scale, areas).unwrap().area.left;
        let mark = |left: f64| Area { left, top: 560.0, width: 14.0, height: 14.0 };
        assert!(left(&[]) > 500.0 && left(&[mark(20.0)]) > 500.0);
        assert!(left(&[mark(700.0)]) < 20.0 && left(&[mark(700.0), mark(20.0)]) > 500.0);
    }

    #[test]
    fn it_lies_inside_its_picture_or_is_left_out() {
        let scale = PlateScale { focal_length_px: 2917.0, range_m: Some(20.0) };
        let mut drawn = 0;
        for (columns, rows) in [(768, 576), (300, 200), (40, 30), (1, 1), (3000, 8)] {
            let window = Window { x: 0, y: 0, columns, rows };
            let placement = Placement::fit(window, (1280, 960), 9);
            if let Some(bar) = ScaleBar::new(&placement, &scale, &[]) {
                assert!(bar.area.is_inside(placement.width, placement.height), "{columns} × {rows}");
                assert!(bar.length < 0.21 * placement.width as f64);
                drawn += 1;
            }
        }
        assert!(drawn >= 2, "{drawn} bars");
    }
}
