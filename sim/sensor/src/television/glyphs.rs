//! Stroke font of the overlay: capitals, figures and the characters of a clock and of a number.

use contract::docking::Lines;

/// Grid of a character: x from 0 to 4, y from 0 (top) to 6.
const GRID: (f64, f64) = (4.0, 6.0);

/// Strokes of the characters: points as pairs of digits x y on the grid; spaces separate strokes. A stroke
/// that repeats a single point is a dot.
const STROKES: [(char, &str); 42] = [
    ('0', "103041453616050110"),
    ('1', "112026 1636"),
    ('2', "01103041420646"),
    ('3', "0110304142334445361605 1333"),
    ('4', "36300444"),
    ('5', "400003334445361605"),
    ('6', "4130100105163645443303"),
    ('7', "004016"),
    ('8', "13020110304142331304051636454433"),
    ('9', "0516364541301001021343"),
    ('A', "062046 1434"),
    ('B', "00063645443342413000 0333"),
    ('C', "4130100105163645"),
    ('D', "00062644422000"),
    ('E', "40000646 0333"),
    ('F', "400006 0333"),
    ('G', "41301001051636454323"),
    ('H', "0006 4046 0343"),
    ('I', "1030 2026 1636"),
    ('J', "4045361605"),
    ('K', "0006 400346"),
    ('L', "000646"),
    ('M', "0600234046"),
    ('N', "06004640"),
    ('O', "103041453616050110"),
    ('P', "06003041423303"),
    ('Q', "103041453616050110 3446"),
    ('R', "06003041423303 2346"),
    ('S', "413010010213334445361605"),
    ('T', "0040 2026"),
    ('U', "000516364540"),
    ('V', "002640"),
    ('W', "0016223640"),
    ('X', "0046 4006"),
    ('Y', "002340 2326"),
    ('Z', "00400646"),
    (':', "2222 2525"),
    ('.', "2626"),
    ('-', "0343"),
    ('+', "0343 2125"),
    ('/', "4006"),
    (' ', ""),
];

/// Returns true if the font has a character.
pub(super) fn supports(character: char) -> bool {
    STROKES.iter().any(|(known, _)| *known == character)
}

/// Coverage of camera pixels by a shape, relative to its position.
#[derive(Debug, Clone, PartialEq)]
struct Sprite {
    columns: usize,
    rows: usize,
    coverage: Vec<f32>,
}

/// The font at one size, rasterised once.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Glyphs {
    sprites: Vec<(char, Sprite)>,
    /// Margin around a character's grid, px.
    margin: usize,
    /// Distance from one character to the next, px.
    advance: usize,
}

impl Glyphs {
    /// Creates a font with capitals of height `height_px` and strokes of width `stroke_px`.
    pub(super) fn new(height_px: f64, stroke_px: f64) -> Self {
        let scale = height_px / GRID.1;
        // Characters are slightly narrower than the grid's squares, as in television captions.
        let (x_px, y_px) = (0.85 * scale, scale);
        let margin = (stroke_px.ceil() as usize).max(1);
        let columns = (GRID.0 * x_px).ceil() as usize + 2 * margin + 1;
        let rows = height_px.ceil() as usize + 2 * margin + 1;
        let sprites = STROKES
            .iter()
            .map(|(character, strokes)| {
                let mut sprite = Sprite { columns, rows, coverage: vec![0.0; columns * rows] };
                for segment in segments(strokes) {
                    let end = |(x, y): (f64, f64)| (x * x_px + margin as f64, y * y_px + margin as f64);
                    sprite.draw(end(segment.0), end(segment.1), 0.5 * stroke_px);
                }
                (*character, sprite)
            })
            .collect();
        Self { sprites, margin, advance: ((GRID.0 + 1.4) * x_px).round() as usize }
    }

    /// Width of a text, px.
    pub(super) fn width(&self, text: &str) -> usize {
        self.advance * text.chars().count()
    }

    /// Writes a text with its upper left corner at the camera's pixel (x, y) into the rows of a field.
    pub(super) fn write(
        &self,
        text: &str,
        (x, y): (usize, usize),
        level: f32,
        lines: Lines,
        signal: &mut [f32],
        columns: usize,
    ) {
        for (i, character) in text.chars().enumerate() {
            let Some((_, sprite)) = self.sprites.iter().find(|(known, _)| *known == character) else {
                continue;
            };
            let (left, top) = (x + i * self.advance, y);
            for row in 0..sprite.rows {
                let Some(camera_row) = (top + row).checked_sub(self.margin) else { continue };
                let Some(k) = field_row(camera_row, lines) else { continue };
                for column in 0..sprite.columns {
                    let Some(at) = (left + column).checked_sub(self.margin).filter(|at| *at < columns) else {
                        continue;
                    };
                    if let Some(value) = signal.get_mut(k * columns + at) {
                        *value += sprite.coverage[row * sprite.columns + column] * (level - *value);
                    }
                }
            }
        }
    }
}

/// Returns the row of a field that corresponds to a row of the camera; `None` if the field does not contain
/// it.
pub(super) fn field_row(camera_row: usize, lines: Lines) -> Option<usize> {
    let k = camera_row / lines.step();
    (lines.camera_row(k) == camera_row).then_some(k)
}

impl Sprite {
    /// Draws a segment with round ends: coverage falls from 1 to 0 over one pixel at its border.
    fn draw(&mut self, from: (f64, f64), to: (f64, f64), half_width: f64) {
        let (dx, dy) = (to.0 - from.0, to.1 - from.1);
        let length2 = dx * dx + dy * dy;
        for (i, value) in self.coverage.iter_mut().enumerate() {
            let (px, py) = ((i % self.columns) as f64 - from.0, (i / self.columns) as f64 - from.1);
            let along = if length2 > 0.0 { ((px * dx + py * dy) / length2).clamp(0.0, 1.0) } else { 0.0 };
            let (ex, ey) = (px - along * dx, py - along * dy);
            let distance = (ex * ex + ey * ey).sqrt();
            *value = value.max((half_width + 0.5 - distance).clamp(0.0, 1.0) as f32);
        }
    }
}

/// Straight segments of a character.
fn segments(strokes: &str) -> Vec<((f64, f64), (f64, f64))> {
    let mut segments = Vec::new();
    for stroke in strokes.split_whitespace() {
        let digit = |c: u8| f64::from(c - b'0');
        let points: Vec<(f64, f64)> =
            stroke.as_bytes().chunks_exact(2).map(|pair| (digit(pair[0]), digit(pair[1]))).collect();
        segments.extend(points.windows(2).map(|w| (w[0], w[1])));
    }
    segments
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_stroke_lies_on_the_grid() {
        for (character, strokes) in STROKES {
            for stroke in strokes.split_whitespace() {
                assert!(stroke.len() % 2 == 0 && stroke.len() >= 4, "{character}");
                for pair in stroke.as_bytes().chunks(2) {
                    assert!(
                        (b'0'..=b'4').contains(&pair[0]) && (b'0'..=b'6').contains(&pair[1]),
                        "{character}"
                    );
                }
            }
        }
    }

    #[test]
    fn no_two_characters_look_alike_but_o_and_zero() {
        let glyphs = Glyphs::new(15.0, 1.6);
        for (i, (a, first)) in glyphs.sprites.iter().enumerate() {
            for (b, second) in &glyphs.sprites[i + 1..] {
                let differs: f32 =
                    first.coverage.iter().zip(&second.coverage).map(|(p, q)| (p - q).abs()).sum();
                // In pixels of full coverage; a dot covers 2 or 3 pixels.
                assert!(differs > 1.5 || (*a, *b) == ('0', 'O'), "{a} {b}: {differs}");
            }
        }
    }

    #[test]
    fn two_fields_hold_the_rows_of_the_frame() {
        let glyphs = Glyphs::new(15.0, 1.6);
        let (columns, rows) = (80, 40);
        let written = |lines: Lines| {
            let mut signal = vec![0.0_f32; columns * lines.rows(rows)];
            glyphs.write("R 5.0", (5, 9), 1.0, lines, &mut signal, columns);
            signal
        };
        let frame = written(Lines::All);
        assert!(frame.iter().sum::<f32>() > 50.0);
        for lines in [Lines::Even, Lines::Odd] {
            for (k, row) in written(lines).chunks_exact(columns).enumerate() {
                let y = lines.camera_row(k);
                assert_eq!(row, &frame[y * columns..(y + 1) * columns]);
            }
        }
    }
}
