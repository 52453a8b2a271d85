//! Overlay of the camera's caption generator: a reticle, the clock, the camera's name, range and range rate.

use contract::docking::Lines;
use draws::{Effect, Seed, normal};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::glyphs::{Glyphs, field_row};

/// Number of camera rows to which the sizes below refer; they scale with the number of rows.
const REFERENCE_ROWS: f64 = 576.0;
/// Height of capitals and width of strokes, px.
const CAPITAL_PX: f64 = 15.0;
const STROKE_PX: f64 = 1.7;
/// Distance from the picture's border to the text, px.
const TEXT_MARGIN_PX: (f64, f64) = (20.0, 16.0);
/// Column of the range rate, px.
const RATE_AT_PX: f64 = 150.0;
/// Distance from the picture's lower border to the bottom of the lower text, px.
const BOTTOM_PX: f64 = 27.0;
/// The reticle's four lines: distance from the picture's border, length and width, px.
const RETICLE_PX: (f64, f64, f64) = (40.0, 30.0, 1.4);

/// Reticle and text, with their level.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct OverlayConfig {
    /// Level of lines and text, in units of the white level, 0 to 2.
    #[schemars(range(min = 0, max = 2))]
    pub level: f64,
    /// Standard deviation of the displayed range, relative to the range, 0 to 0.5; drawn anew each second.
    #[schemars(range(min = 0, max = 0.5))]
    pub range_error: f64,
    /// Standard deviation of the displayed range rate, m/s, 0 to 10; drawn anew each second.
    #[schemars(range(min = 0, max = 10))]
    pub range_rate_error_m_s: f64,
}

impl Default for OverlayConfig {
    fn default() -> Self {
        Self { level: 0.95, range_error: 0.01, range_rate_error_m_s: 0.02 }
    }
}

/// Content of the text; initially the true values.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Caption<'a> {
    /// UTC, for example 14:07:32.
    pub clock: &'a str,
    /// Name of the camera.
    pub camera: &'a str,
    /// Shown range, m.
    pub range_m: f64,
    /// Shown range rate, m/s.
    pub range_rate_m_s: f64,
}

impl OverlayConfig {
    /// Returns the caption with range and range rate as measured by the radar of the approach. The picture
    /// shows these readings; no picture contains the true values.
    pub fn measured<'a>(&self, seed: &Seed, time_s: f64, caption: &Caption<'a>) -> Caption<'a> {
        let second = time_s.max(0.0).floor();
        let mut stream = seed.stream(second as u64, Effect::OverlayReading, 0);
        // Range at the start of the second: the digits do not change between the fields of a frame.
        let range_m = caption.range_m - caption.range_rate_m_s * (time_s - second);
        Caption {
            range_m: range_m * (1.0 + self.range_error * normal(&mut stream)),
            range_rate_m_s: caption.range_rate_m_s + self.range_rate_error_m_s * normal(&mut stream),
            ..*caption
        }
    }
}

/// Overlay for one camera, its characters rasterised once.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Overlay {
    glyphs: Glyphs,
    level: f32,
    scale: f64,
    columns: usize,
    rows: usize,
}

impl Overlay {
    pub(super) fn new(config: &OverlayConfig, columns: usize, rows: usize) -> Self {
        let scale = rows as f64 / REFERENCE_ROWS;
        let glyphs = Glyphs::new(CAPITAL_PX * scale, (STROKE_PX * scale).max(1.0));
        Self { glyphs, level: config.level as f32, scale, columns, rows }
    }

    /// Draws the overlay over the rows of a field.
    pub(super) fn draw(&self, caption: &Caption<'_>, lines: Lines, signal: &mut [f32]) {
        self.reticle(lines, signal);
        let px = |length: f64| (length * self.scale).round() as usize;
        let (left, top) = (px(TEXT_MARGIN_PX.0), px(TEXT_MARGIN_PX.1));
        let bottom = self.rows.saturating_sub(px(BOTTOM_PX + CAPITAL_PX));
        let mut write = |text: &str, x, y| {
            self.glyphs.write(text, (x, y), self.level, lines, signal, self.columns);
        };
        write(caption.clock, left, top);
        let name_at = self.columns.saturating_sub(left + self.glyphs.width(caption.camera));
        write(caption.camera, name_at, top);
        write(&format!("R {:5.1}", caption.range_m), left, bottom);
        write(&format!("V {:+.2}", caption.range_rate_m_s), px(RATE_AT_PX), bottom);
    }

    /// Draws four lines that point at the picture's centre.
    fn reticle(&self, lines: Lines, signal: &mut [f32]) {
        let (inset, length) = (RETICLE_PX.0 * self.scale, RETICLE_PX.1 * self.scale);
        let half_width = 0.5 * (RETICLE_PX.2 * self.scale).max(1.0);
        let (right, bottom) = ((self.columns - 1) as f64, (self.rows - 1) as f64);
        let (middle_x, middle_y) = (0.5 * right, 0.5 * bottom);
        let across = |x: f64| (x - half_width, x + half_width);
        let near = (inset, inset + length);
        let far = |end: f64| (end - inset - length, end - inset);
        for (x, y) in [
            (across(middle_x), near),
            (across(middle_x), far(bottom)),
            (near, across(middle_y)),
            (far(right), across(middle_y)),
        ] {
            self.rectangle(x, y, lines, signal);
        }
    }

    /// Draws a rectangle between two columns and two rows, with exact coverage of pixels.
    fn rectangle(&self, x: (f64, f64), y: (f64, f64), lines: Lines, signal: &mut [f32]) {
        for camera_row in y.0.max(0.0).round() as usize..=y.1.max(0.0).round() as usize {
            let Some(row) = field_row(camera_row, lines)
                .and_then(|k| signal.get_mut(k * self.columns..(k + 1) * self.columns))
            else {
                continue;
            };
            let high = covered(y, camera_row);
            let columns = x.0.max(0.0).round() as usize..=x.1.max(0.0).round() as usize;
            for (column, value) in row.iter_mut().enumerate().filter(|(column, _)| columns.contains(column)) {
                *value += (high * covered(x, column)) as f32 * (self.level - *value);
            }
        }
    }
}

/// Share of the pixel at `index` that lies between two coordinates.
fn covered((from, to): (f64, f64), index: usize) -> f64 {
    let centre = index as f64;
    (to.min(centre + 0.5) - from.max(centre - 0.5)).clamp(0.0, 1.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn drawn(lines: Lines, caption: &Caption<'_>) -> Vec<f32> {
        let overlay = Overlay::new(&OverlayConfig { level: 1.0, ..OverlayConfig::default() }, 768, 576);
        let mut signal = vec![0.0; 768 * lines.rows(576)];
        overlay.draw(caption, lines, &mut signal);
        signal
    }

    const CAPTION: Caption<'static> =
        Caption { clock: "14:07:32", camera: "TV-1", range_m: 20.0, range_rate_m_s: -0.11 };

    /// All readings within a second equal the one at its start. Readings of many seconds have the requested
    /// errors.
    #[test]
    fn readings_are_the_radars_and_hold_for_a_second() {
        let config =
            OverlayConfig { range_error: 0.02, range_rate_error_m_s: 0.05, ..OverlayConfig::default() };
        let seed = Seed { seed: 3, case: 0 };
        let reading = |config: &OverlayConfig, time_s: f64| {
            let moved = CAPTION.range_m + CAPTION.range_rate_m_s * (time_s - time_s.floor());
            config.measured(&seed, time_s, &Caption { range_m: moved, ..CAPTION })
        };
        let at = |time_s: f64| reading(&config, time_s);
        // Rounding error of the extrapolation back to the start of the second.
        assert!((at(7.0).range_m - at(7.98).range_m).abs() < 1e-9);
        assert_eq!(at(7.0).range_rate_m_s, at(7.98).range_rate_m_s);
        assert!((at(7.0).range_m - at(8.0).range_m).abs() > 1e-3);
        let n = 4000;
        let (mut range, mut rate) = (0.0, 0.0);
        for second in 0..n {
            let reading = at(f64::from(second));
            range += libm::pow((reading.range_m / CAPTION.range_m - 1.0) / 0.02, 2.0);
            rate += libm::pow((reading.range_rate_m_s - CAPTION.range_rate_m_s) / 0.05, 2.0);
        }
        // Mean squares of normal random numbers: standard error √(2/n) = 0.022; the tolerance is four of
        // them.
        for mean in [range, rate].map(|sum| sum / f64::from(n)) {
            assert!((mean - 1.0).abs() < 0.09, "{mean}");
        }
        let exact = OverlayConfig { range_error: 0.0, range_rate_error_m_s: 0.0, ..config };
        assert_eq!(reading(&exact, 7.0), CAPTION);
    }

    #[test]
    fn the_reticle_points_at_the_centre_from_four_sides() {
        let frame = drawn(Lines::All, &CAPTION);
        let sum = |columns: std::ops::Range<usize>, rows: std::ops::Range<usize>| {
            rows.map(|y| frame[y * 768..][columns.clone()].iter().sum::<f32>()).sum::<f32>()
        };
        // Each line: length times width.
        for (columns, rows) in
            [(370..400, 30..80), (370..400, 500..545), (30..80, 270..300), (690..740, 270..300)]
        {
            assert!((sum(columns, rows) - 30.0 * 1.4).abs() < 1e-3);
        }
    }

    #[test]
    fn only_the_pixels_of_the_text_change() {
        let (a, b) =
            (drawn(Lines::Even, &CAPTION), drawn(Lines::Even, &Caption { range_m: 19.9, ..CAPTION }));
        let changed: Vec<usize> = (0..a.len()).filter(|i| a[*i] != b[*i]).collect();
        assert!(!changed.is_empty());
        for i in changed {
            let (x, y) = (i % 768, 2 * (i / 768));
            assert!((20..150).contains(&x) && (530..555).contains(&y), "{x} {y}");
        }
    }

    #[test]
    fn a_tiny_picture_is_no_harm() {
        let overlay = Overlay::new(&OverlayConfig::default(), 3, 2);
        let mut signal = vec![0.0; 6];
        overlay.draw(&CAPTION, Lines::All, &mut signal);
        assert!(signal.iter().all(|s| (0.0..=1.0).contains(s)));
    }
}
