//! Layout of panels, text and legend on one sheet.

pub(crate) mod legend;
pub(crate) mod scale_bar;
pub(crate) mod view;

use contract::Window;
use serde::Serialize;

use crate::canvas::colour::{BACKGROUND, GREEN, GREY, ORANGE, RED, Rgb, SLATE, WHITE, YELLOW};
use crate::canvas::text::Font;
use crate::canvas::{Area, CLOSE, Canvas, label};
use crate::layout::scale_bar::ScaleBar;
use crate::layout::view::Placement;
use crate::panel::class::Class;
use crate::panel::raster::raster;
use crate::panel::stretch::White;
use crate::panel::{Mark, Panel, Table, Tone, Verdict};
use crate::{MAX_PANELS, ShowError};

/// Border of the sheet and gap between two panels, px.
const MARGIN: usize = 16;
/// Largest frame that is drawn without reduction, px; larger frames are reduced to this size.
const MAX_FRAME_PX: (usize, usize) = (1280, 1024);
/// Number of columns towards which a narrower frame is enlarged.
const WANTED_COLUMNS: usize = 768;
/// Width of the column beside a single frame, px.
const COLUMN: usize = 400;
/// Largest close-up beside a frame, px.
const CLOSE_UP: (usize, usize) = (COLUMN, 300);
/// Width of a contact sheet without its border, px.
const SHEET: usize = 1000;
/// Largest enlargement of a close-up.
const MAX_ZOOM: usize = 24;

/// A picture, and the positions of its panels.
#[derive(Debug, Clone)]
pub struct Picture {
    /// Width, px.
    pub width: usize,
    /// Height, px.
    pub height: usize,
    /// Red, green and blue of each pixel, row by row.
    pub rgb: Vec<[u8; 3]>,
    /// Positions of the panels, in the order in which they were given.
    pub panels: Vec<PanelLayout>,
}

/// Positions of the parts of a panel.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct PanelLayout {
    /// Position of the frame.
    pub frame: Placement,
    /// Position of the close-up, if there is one.
    pub close_up: Option<Placement>,
}

/// Part of a panel.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Part {
    /// The view, whose marks have labels.
    Frame,
    /// The close-up, whose marks have no labels.
    CloseUp,
}

/// Draws a single panel with a table beside it, or several panels as a contact sheet.
///
/// # Errors
/// [`ShowError::PanelCount`] for no panel or more than [`MAX_PANELS`]; [`ShowError::Size`] for a view without
/// pixels.
pub fn picture(panels: &[Panel]) -> Result<Picture, ShowError> {
    match panels {
        [only] => single(only),
        several if (2..=MAX_PANELS).contains(&several.len()) => contact_sheet(several),
        _ => Err(ShowError::PanelCount(panels.len())),
    }
}

/// Draws the view of a panel at its own size, pixel by pixel, with its marks and nothing beside it.
///
/// # Errors
/// [`ShowError::Size`] for a view without pixels.
pub fn image(panel: &Panel) -> Result<Picture, ShowError> {
    let Window { x, y, columns, rows } = panel.view;
    let place =
        Placement { left: 0, top: 0, width: columns, height: rows, first_column: x, first_row: y, zoom: 1.0 };
    let mut canvas = Canvas::new(columns, rows, BACKGROUND)?;
    canvas.copy(0, 0, columns, &raster(panel, panel.view, &place, White::Sky));
    for mark in &panel.marks {
        canvas.mark(mark, &place);
    }
    label::write(&mut canvas, &place, &panel.marks, &[], &[]);
    Ok(finished(&canvas, vec![PanelLayout { frame: place, close_up: None }]))
}

/// Draws a frame with its close-up, table and legend.
fn single(panel: &Panel) -> Result<Picture, ShowError> {
    let most = (WANTED_COLUMNS / panel.view.columns.max(1)).max(1);
    let frame = Placement::fit(panel.view, MAX_FRAME_PX, most).moved_to(MARGIN, MARGIN);
    let left = frame.left + frame.width + MARGIN;
    let verdict = panel
        .verdict
        .as_ref()
        .map(|verdict| (wrapped(&verdict.words, COLUMN, Font::Heading), colour_of(verdict)));
    // The legend stands below the frame, and where the frame is narrow, below everything.
    let room = if frame.width >= COLUMN { frame.width } else { left + COLUMN - MARGIN };
    let entries = legend::rows(&legend::classes(std::slice::from_ref(panel)), room);

    let mut top = MARGIN + Font::Heading.height();
    let verdict_top = top;
    top += verdict.as_ref().map_or(0, |(lines, _)| lines.len() * Font::Heading.height()) + MARGIN / 2;
    let close_up =
        panel.close_up.map(|window| Placement::fit(window, CLOSE_UP, MAX_ZOOM).moved_to(left, top));
    top += close_up.map_or(0, |close_up| close_up.height + MARGIN / 2);
    let mut table_top = top;
    top += panel.tables.iter().map(Table::height).sum::<usize>();
    let legend_height = entries.len() * legend::line_height();
    let below = frame.top + frame.height + MARGIN;
    let legend_top = if frame.width >= COLUMN { below } else { below.max(top) };
    let height = top.max(legend_top + legend_height) + MARGIN;

    let mut canvas = Canvas::new(left + COLUMN + MARGIN, height, BACKGROUND)?;
    draw_view(&mut canvas, panel, panel.view, &frame, Part::Frame, &[])?;
    canvas.text(left, MARGIN, &Font::Heading.cut(&panel.title, COLUMN), Font::Heading, WHITE);
    for (line, words) in verdict.iter().flat_map(|(lines, _)| lines).enumerate() {
        let colour = verdict.as_ref().map_or(WHITE, |(_, colour)| *colour);
        canvas.text(left, verdict_top + line * Font::Heading.height(), words, Font::Heading, colour);
    }
    if let (Some(window), Some(place)) = (panel.close_up, &close_up) {
        draw_view(&mut canvas, panel, window, place, Part::CloseUp, &[])?;
    }
    for table in &panel.tables {
        table.draw(&mut canvas, left, table_top);
        table_top += table.height();
    }
    legend::draw(&mut canvas, MARGIN, legend_top, &entries);
    Ok(finished(&canvas, vec![PanelLayout { frame, close_up }]))
}

/// Draws frames side by side, each with its close-up in a corner and a caption below.
fn contact_sheet(panels: &[Panel]) -> Result<Picture, ShowError> {
    let across = match panels.len() {
        0..=4 => 2,
        5..=9 => 3,
        _ => 4,
    };
    let width = (SHEET - (across - 1) * MARGIN) / across;
    let fitted = |panel: &Panel| {
        let most = (width / panel.view.columns.max(1)).max(1);
        Placement::fit(panel.view, (width, width), most)
    };
    let entries = legend::rows(&legend::classes(panels), SHEET);
    let captions: Vec<Vec<Line>> = panels.iter().map(|panel| caption(panel, width)).collect();
    let caption_lines = captions.iter().map(Vec::len).max().unwrap_or(0);
    let caption_height = caption_lines * line_height() + MARGIN / 2;
    let row_heights: Vec<usize> = panels
        .chunks(across)
        .map(|row| row.iter().map(|panel| fitted(panel).height).max().unwrap_or(0))
        .collect();
    let rows_height: usize = row_heights.iter().map(|height| height + caption_height + MARGIN / 2).sum();
    let height = MARGIN + rows_height + MARGIN / 2 + entries.len() * legend::line_height() + MARGIN;
    let mut canvas = Canvas::new(SHEET + 2 * MARGIN, height, BACKGROUND)?;
    let mut places = Vec::with_capacity(panels.len());
    let mut top = MARGIN;
    for ((row, captions), row_height) in panels.chunks(across).zip(captions.chunks(across)).zip(&row_heights)
    {
        for (column, (panel, caption)) in row.iter().zip(captions).enumerate() {
            let left = MARGIN + column * (width + MARGIN);
            let frame = fitted(panel);
            // Narrow frames are centred in their cell.
            let frame = frame
                .moved_to(left + (width - frame.width.min(width)) / 2, top + (row_height - frame.height) / 2);
            let close_up = panel.close_up.map(|window| in_corner(window, &frame, &panel.marks));
            let taken: Vec<Area> = close_up
                .iter()
                .map(|place| Area {
                    left: place.left.saturating_sub(frame.left) as f64,
                    top: place.top.saturating_sub(frame.top) as f64,
                    width: place.width as f64,
                    height: place.height as f64,
                })
                .collect();
            draw_view(&mut canvas, panel, panel.view, &frame, Part::Frame, &taken)?;
            if let (Some(window), Some(place)) = (panel.close_up, &close_up) {
                draw_view(&mut canvas, panel, window, place, Part::CloseUp, &[])?;
                let edge = Area {
                    left: place.left as f64 - 0.5,
                    top: place.top as f64 - 0.5,
                    width: place.width as f64 + 1.0,
                    height: place.height as f64 + 1.0,
                };
                canvas.frame(&edge, WHITE, 1.0);
            }
            for (line, Line { indent, words, font, colour }) in caption.iter().enumerate() {
                let top = top + row_height + MARGIN / 4 + line * line_height();
                canvas.text(left + indent, top, words, *font, *colour);
            }
            if let Some(verdict) = panel.verdict.as_ref().filter(|verdict| is_beside(panel, verdict, width)) {
                let from = left + width - Font::Heading.width(&verdict.words);
                let top = top + row_height + MARGIN / 4;
                canvas.text(from, top, &verdict.words, Font::Heading, colour_of(verdict));
            }
            places.push(PanelLayout { frame, close_up });
        }
        top += row_height + caption_height + MARGIN / 2;
    }
    legend::draw(&mut canvas, MARGIN, top + MARGIN / 2, &entries);
    Ok(finished(&canvas, places))
}

/// Places a close-up in the corner of a frame where it covers the fewest marks. The lower right corner is
/// reserved for the scale bar.
fn in_corner(window: Window, frame: &Placement, marks: &[Mark]) -> Placement {
    let room = (frame.width * 9 / 20, frame.height * 9 / 20);
    let fitted = Placement::fit(window, room, MAX_ZOOM);
    let inset = MARGIN / 2;
    let (near_x, near_y) = (frame.left + inset, frame.top + inset);
    let far_x = (frame.left + frame.width).saturating_sub(fitted.width + inset);
    let far_y = (frame.top + frame.height).saturating_sub(fitted.height + inset);
    let covered = |(left, top): (usize, usize)| -> usize {
        let shown = marks.iter().filter(|mark| {
            let (x, y) = frame.inner(mark.at);
            let (x, y) = (x + frame.left as f64 - left as f64, y + frame.top as f64 - top as f64);
            let reach = mark.shape.reach(frame.zoom);
            (-reach..fitted.width as f64 + reach).contains(&x)
                && (-reach..fitted.height as f64 + reach).contains(&y)
        });
        shown.map(|mark| if [Class::TARGET, Class::ANSWER].contains(&mark.class) { 1000 } else { 1 }).sum()
    };
    let corners = [(near_x, near_y), (far_x, near_y), (near_x, far_y)];
    let (left, top) = corners.into_iter().min_by_key(|corner| covered(*corner)).unwrap_or((near_x, near_y));
    fitted.moved_to(left, top)
}

/// Draws a window of a frame and the marks over it into a canvas. Labels keep clear of `taken`.
fn draw_view(
    canvas: &mut Canvas,
    panel: &Panel,
    window: Window,
    place: &Placement,
    part: Part,
    taken: &[Area],
) -> Result<(), ShowError> {
    // A close-up is stretched for its bright pixels, not for the sky.
    let white = if part == Part::CloseUp || place.zoom >= CLOSE { White::Brightest } else { White::Sky };
    // Drawn on a separate canvas, which clips marks at its edge.
    let mut inner = Canvas::new(place.width, place.height, BACKGROUND)?;
    inner.copy(0, 0, place.width, &raster(panel, window, place, white));
    let line = if place.zoom >= CLOSE { 2.0 } else { 1.0 };
    let edge = |region: &Window| {
        let corner = contract::PixelPoint::new(region.x as f64 - 0.5, region.y as f64 - 0.5);
        let (left, top) = place.inner(corner);
        let side = |length: usize| length as f64 * place.zoom + line;
        Area {
            left: left - 0.5 * line,
            top: top - 0.5 * line,
            width: side(region.columns),
            height: side(region.rows),
        }
    };
    let regions: Vec<Area> = panel.regions.iter().flatten().map(edge).collect();
    for region in &regions {
        inner.frame(region, SLATE, line);
    }
    for mark in &panel.marks {
        inner.mark(mark, place);
    }
    let mut taken = taken.to_vec();
    let marked: Vec<Area> =
        panel.marks.iter().map(|mark| label::bounds(mark, place)).chain(taken.iter().copied()).collect();
    if let Some(bar) = ScaleBar::new(place, &panel.scale, &marked) {
        bar.draw(&mut inner);
        taken.push(bar.area);
    }
    if part == Part::Frame {
        label::write(&mut inner, place, &panel.marks, &regions, &taken);
    }
    canvas.copy(place.left, place.top, place.width, &inner.rgb());
    Ok(())
}

/// Line of a caption.
struct Line {
    indent: usize,
    words: String,
    font: Font,
    colour: Rgb,
}

/// Returns true if a verdict fits to the right of the title.
fn is_beside(panel: &Panel, verdict: &Verdict, width: usize) -> bool {
    let gap = 2 * Font::Heading.advance();
    Font::Heading.width(&panel.short_title) + gap + Font::Heading.width(&verdict.words) <= width
}

/// Returns title, verdict and lines below a panel of a contact sheet; long texts are continued in the next
/// line.
fn caption(panel: &Panel, width: usize) -> Vec<Line> {
    let title = Font::Heading.cut(&panel.short_title, width);
    let mut lines = vec![Line { indent: 0, words: title, font: Font::Heading, colour: WHITE }];
    if let Some(verdict) = panel.verdict.as_ref().filter(|verdict| !is_beside(panel, verdict, width)) {
        let colour = colour_of(verdict);
        let words = wrapped(&verdict.words, width, Font::Heading);
        lines.extend(words.into_iter().map(|words| Line { indent: 0, words, font: Font::Heading, colour }));
    }
    for text in panel.caption.iter().filter(|text| !text.is_empty()) {
        let blanks = text.chars().take_while(|c| *c == ' ').count();
        let indent = if Font::Body.width(text) <= width { blanks * Font::Body.advance() } else { 0 };
        let words = wrapped(text, width, Font::Body);
        lines.extend(words.into_iter().map(|words| Line { indent, words, font: Font::Body, colour: GREY }));
    }
    lines
}

fn finished(canvas: &Canvas, panels: Vec<PanelLayout>) -> Picture {
    Picture { width: canvas.width(), height: canvas.height(), rgb: canvas.rgb(), panels }
}

fn colour_of(verdict: &Verdict) -> Rgb {
    match verdict.tone {
        Tone::Good => GREEN,
        Tone::Partial => YELLOW,
        Tone::Bad => RED,
    }
}

/// Returns the distance from one line of text to the next, px.
fn line_height() -> usize {
    Font::Body.height() + 1
}

/// Breaks a text into lines of at most `width`, px.
fn wrapped(text: &str, width: usize, font: Font) -> Vec<String> {
    let mut lines: Vec<String> = Vec::new();
    for word in text.split_whitespace() {
        let fits = |line: &&mut String| font.width(line) + font.advance() + font.width(word) <= width;
        match lines.last_mut().filter(fits) {
            Some(line) => {
                line.push(' ');
                line.push_str(word);
            }
            None => lines.push(font.cut(word, width)),
        }
    }
    lines
}

impl Table {
    /// Returns the height of the table's lines and the gap after them, px.
    fn height(&self) -> usize {
        (self.rows.len() + usize::from(self.head.is_some())) * line_height() + MARGIN / 2
    }

    /// Draws the table: names at the left; a single value follows its name, two values are each aligned at
    /// the right of their column.
    fn draw(&self, canvas: &mut Canvas, left: usize, top: usize) {
        let names = self.rows.iter().map(|[name, ..]| Font::Body.width(name)).max().unwrap_or(0);
        let values = left + names + 2 * Font::Body.advance();
        let second = self.rows.iter().map(|[_, _, second]| Font::Body.width(second));
        let heads = self.head.iter().map(|[_, second]| Font::Body.width(second));
        let second_width = second.chain(heads).max().unwrap_or(0);
        let right = left + COLUMN;
        let first_right = right.saturating_sub(second_width + 2 * Font::Body.advance());
        let at_right = |canvas: &mut Canvas, right: usize, top: usize, text: &str, colour: Rgb| {
            canvas.text(right.saturating_sub(Font::Body.width(text)), top, text, Font::Body, colour);
        };
        let mut top = top;
        if let Some([first, second]) = &self.head {
            at_right(canvas, first_right, top, first, GREY);
            at_right(canvas, right, top, second, GREY);
            top += line_height();
        }
        for [name, value, second] in &self.rows {
            canvas.text(left, top, name, Font::Body, GREY);
            if second_width > 0 {
                at_right(canvas, first_right, top, value, WHITE);
                at_right(canvas, right, top, second, ORANGE);
            } else {
                let value = Font::Body.cut(value, right.saturating_sub(values));
                canvas.text(values, top, &value, Font::Body, WHITE);
            }
            top += line_height();
        }
    }
}

#[cfg(test)]
mod tests {
    use contract::PixelPoint;

    use super::*;
    use crate::panel::stretch::Stretch;
    use crate::panel::{Pixels, PlateScale, Reduction, Shape};

    /// Returns a dark frame that contains a target.
    fn panel(columns: usize, rows: usize) -> Panel {
        let dn = (0..columns * rows).map(|i| 100 + (i * 7 % 11) as u16).collect();
        let pixels = Pixels { columns, rows, dn, full_scale_dn: 4095 };
        let mark =
            |class, x: f64, y: f64, shape| Mark { at: PixelPoint::new(x, y), shape, class, label: None };
        Panel {
            view: pixels.full_window(),
            regions: None,
            close_up: None,
            stretch: Stretch::Asinh,
            reduction: Reduction::Brightest,
            scale: PlateScale { focal_length_px: 2347.0, range_m: None },
            marks: vec![
                mark(
                    Class::TARGET,
                    0.3 * columns as f64,
                    0.4 * rows as f64,
                    Shape::Around { radius_px: 2.0, least: 12.0 },
                ),
                mark(Class::ANSWER, 0.7 * columns as f64, 0.4 * rows as f64, Shape::Cross { arm: 9.0 }),
            ],
            title: "hand-made, frame 12".to_owned(),
            short_title: "frame 12".to_owned(),
            verdict: Some(Verdict { words: "wrong: lost motion test".to_owned(), tone: Tone::Bad }),
            tables: vec![Table {
                head: None,
                rows: vec![["range".to_owned(), "8 km".to_owned(), String::new()]],
            }],
            caption: vec!["range 8 km".to_owned()],
            pixels,
        }
    }

    /// Returns the mean position of all pixels of a colour inside a placement, in pixels of the frame.
    fn centre(picture: &Picture, place: &Placement, colour: Rgb) -> Option<(f64, f64)> {
        let (mut count, mut x_sum, mut y_sum) = (0.0, 0.0, 0.0);
        for y in place.top..place.top + place.height {
            for x in place.left..place.left + place.width {
                if picture.rgb[y * picture.width + x] == colour {
                    count += 1.0;
                    x_sum += x as f64 + 0.5 - place.left as f64;
                    y_sum += y as f64 + 0.5 - place.top as f64;
                }
            }
        }
        let frame = |sum: f64, first: usize| sum / count / place.zoom + first as f64 - 0.5;
        (count > 0.0).then(|| (frame(x_sum, place.first_column), frame(y_sum, place.first_row)))
    }

    #[test]
    fn marks_are_centred_on_their_positions_at_every_scale() {
        for (columns, rows) in [(90, 60), (752, 580), (2048, 1500)] {
            for count in [1, 2, 5] {
                let picture = picture(&vec![panel(columns, rows); count]).unwrap();
                assert_eq!(picture.panels.len(), count);
                for place in picture.panels.iter().map(|place| &place.frame) {
                    for (colour, part) in [(GREEN, 0.3), (ORANGE, 0.7)] {
                        let (x, y) = centre(&picture, place, colour).unwrap();
                        let error = (x - part * columns as f64).abs().max((y - 0.4 * rows as f64).abs());
                        // Tolerance: one pixel of the picture.
                        assert!(error * place.zoom < 1.0, "{columns} × {rows}, {count}: ({x}, {y})");
                    }
                }
            }
        }
    }

    #[test]
    fn every_part_lies_inside_of_the_picture_and_covers_no_other_panel() {
        for count in 1..=MAX_PANELS {
            let mut panels = vec![panel(300, 200); count];
            panels.iter_mut().for_each(|panel| {
                panel.close_up = Some(Window { x: 80, y: 70, columns: 32, rows: 24 });
            });
            let picture = picture(&panels).unwrap();
            assert_eq!(picture.rgb.len(), picture.width * picture.height);
            let areas: Vec<Area> = picture
                .panels
                .iter()
                .map(|place| Area {
                    left: place.frame.left as f64,
                    top: place.frame.top as f64,
                    width: place.frame.width as f64,
                    height: place.frame.height as f64,
                })
                .collect();
            for (i, area) in areas.iter().enumerate() {
                assert!(area.is_inside(picture.width, picture.height));
                assert!(areas[..i].iter().all(|other| !other.meets(area)));
            }
        }
    }

    /// The close-up covers neither the target nor the measurement if a corner without them exists.
    #[test]
    fn a_close_up_is_placed_where_it_hides_least() {
        let mut panel = panel(752, 580);
        panel.close_up = Some(Window { x: 200, y: 200, columns: 32, rows: 24 });
        for (x, y) in [(60.0, 60.0), (700.0, 60.0), (60.0, 500.0)] {
            panel.marks[0].at = PixelPoint::new(x, y);
            let picture = picture(&[panel.clone(), panel.clone()]).unwrap();
            let PanelLayout { frame, close_up: Some(close_up) } = picture.panels[0] else { panic!() };
            let (x, y) = frame.inner(PixelPoint::new(x, y));
            let (x, y) = (x + frame.left as f64, y + frame.top as f64);
            let inside =
                |at: f64, from: usize, length: usize| (from as f64..(from + length) as f64).contains(&at);
            assert!(!(inside(x, close_up.left, close_up.width) && inside(y, close_up.top, close_up.height)));
        }
    }

    #[test]
    fn no_panel_and_too_many_are_refused() {
        assert!(matches!(picture(&[]), Err(ShowError::PanelCount(0))));
        assert!(matches!(picture(&vec![panel(8, 8); MAX_PANELS + 1]), Err(ShowError::PanelCount(_))));
        let mut empty = panel(8, 8);
        empty.view.columns = 0;
        assert!(picture(&[empty]).is_ok_and(|picture| picture.width > 0));
    }

    /// Each pixel of the image is one of the frame; a label is text beside its mark.
    #[test]
    fn an_image_has_the_size_of_its_view_and_its_marks_only() {
        let mut panel = panel(90, 60);
        let plain = Panel { marks: Vec::new(), ..panel.clone() };
        let drawn = image(&plain).unwrap();
        assert_eq!((drawn.width, drawn.height, drawn.rgb.len()), (90, 60, 90 * 60));
        assert!(drawn.rgb.iter().all(|[red, green, blue]| red == green && green == blue));
        panel.marks[0].label = Some("Rigel".to_owned());
        let marked = image(&panel).unwrap();
        let (x, y) = centre(&marked, &marked.panels[0].frame, ORANGE).unwrap();
        assert!((x - 63.0).abs() < 1.0 && (y - 24.0).abs() < 1.0, "({x}, {y})");
        let changed = |range: std::ops::Range<usize>| {
            let pairs = marked.rgb.iter().zip(&drawn.rgb).enumerate();
            pairs.filter(|(i, (a, b))| range.contains(&(i % 90)) && a != b).count()
        };
        // The label is right of the mark at x = 27, whose circle ends at 39.
        assert!(changed(41..54) > 20, "{}", changed(41..54));
    }

    #[test]
    fn a_verdict_is_wrapped_between_words() {
        let lines = wrapped(
            "wrong: lost motion test, hot pixel 123456 was taken for the target",
            COLUMN,
            Font::Heading,
        );
        assert!(
            lines.len() == 2 && lines.iter().all(|line| Font::Heading.width(line) <= COLUMN),
            "{lines:?}"
        );
        assert_eq!(wrapped("success", COLUMN, Font::Heading), ["success"]);
        assert!(wrapped("", COLUMN, Font::Heading).is_empty());
    }
}
