//! Map of star counts over the complete sky, in the Mollweide projection, as cells. Dots, one per pointing,
//! would overlap and leave holes at excluded pointings.

use std::f64::consts::{PI, SQRT_2};

use ::report::charts::chart::{REFERENCE, rounded};
use ::report::charts::plotly::{Axis, ColourScale, Layout, Line, Mode, TextPosition, Trace};
use ::visibility::PointingStars;
use contract::{Direction, Icrs};

/// Rows of cells of the map; it has twice as many columns.
const CELLS_UP: usize = 90;
/// Largest distance from a map cell to the nearest pointing that it shows, in units of the mean distance
/// between pointings.
const REACH: f64 = 1.5;
/// Number of segments of each grid line.
const OF_A_LINE: usize = 60;

/// Returns the map of the counted pointings; `of` is the number of all pointings.
pub(super) fn sky_map(counted: &[&PointingStars], of: usize) -> (Vec<Trace>, Layout) {
    let reach = REACH * (4.0 * PI / of.max(1) as f64).sqrt();
    let pointings = Pointings::new(counted);
    let centre = |cell: usize, cells: usize| (2 * cell + 1) as f64 / cells as f64 - 1.0;
    let x: Vec<f64> =
        (0..2 * CELLS_UP).map(|cell| rounded(2.0 * SQRT_2 * centre(cell, 2 * CELLS_UP), 4)).collect();
    let y: Vec<f64> = (0..CELLS_UP).map(|cell| rounded(SQRT_2 * centre(cell, CELLS_UP), 4)).collect();
    let (mut stars, mut words) = (Vec::new(), Vec::new());
    for &up in &y {
        let row = x.iter().map(|&across| {
            let (ra_deg, dec_deg) = sky_of(across, up)?;
            let stars = pointings.nearest(ra_deg, dec_deg, reach)?.stars;
            Some((rounded(stars, 2), format!("RA {:.0}°, Dec {dec_deg:.0}°", ra_deg.rem_euclid(360.0))))
        });
        let (numbers, texts): (Vec<f64>, Vec<String>) =
            row.map(|cell| cell.unwrap_or((f64::NAN, String::new()))).unzip();
        stars.push(numbers);
        words.push(texts);
    }
    let map = Trace::heat_map(x, y, &stars)
        .name("stars".to_owned())
        .cell_texts(words)
        .hover_template("%{text}<br>%{z} stars<extra></extra>")
        .no_hover_on_gaps()
        .colour_bar_title("stars")
        .colour_scale(ColourScale::Viridis);
    let x_axis = Axis::new().hidden().range([-2.0 * SQRT_2 - 0.25, 2.0 * SQRT_2 + 0.05]);
    let y_axis = Axis::new().hidden().range([-SQRT_2 - 0.05, SQRT_2 + 0.05]).same_scale_as("x");
    let layout = Layout::new(x_axis, y_axis).legend(false);
    (vec![map, net(), right_ascensions(), declinations()], layout)
}

/// Returns the grid: meridians and parallels every 30°, and the edge.
fn net() -> Trace {
    let (mut x, mut y) = (Vec::new(), Vec::new());
    let mut add = |place: &dyn Fn(f64) -> (f64, f64)| {
        for step in 0..=OF_A_LINE {
            let (across, up) = place(2.0 * step as f64 / OF_A_LINE as f64 - 1.0);
            x.push(rounded(across, 3));
            y.push(rounded(up, 3));
        }
        x.push(f64::NAN);
        y.push(f64::NAN);
    };
    for meridian in -6..=6 {
        add(&|part| map_of(30.0 * f64::from(meridian), 90.0 * part));
    }
    for parallel in -2..=2 {
        add(&|part| map_of(180.0 * part, 30.0 * f64::from(parallel)));
    }
    Trace::scatter(Mode::Lines, x, y).line(Line::new(0.7).colour(REFERENCE)).no_hover()
}

/// Returns the right ascension labels along the equator, white on the colours of the map.
fn right_ascensions() -> Trace {
    let ra_deg = [240, 300, 0, 60, 120];
    let places: Vec<(f64, f64)> =
        ra_deg.iter().map(|&ra| map_of(f64::from(if ra > 180 { ra - 360 } else { ra }), 0.0)).collect();
    let (x, y): (Vec<f64>, Vec<f64>) = places.into_iter().unzip();
    Trace::scatter(Mode::Text, x, y)
        .texts(ra_deg.iter().map(|ra| format!("{ra}°")).collect())
        .text_position(TextPosition::TopRight)
        .text_font("#ffffff", 11)
        .no_hover()
}

/// Returns the declination labels beside the left edge.
fn declinations() -> Trace {
    let dec_deg = [-60, -30, 0, 30, 60];
    let (x, y): (Vec<f64>, Vec<f64>) = dec_deg.iter().map(|&dec| map_of(180.0, f64::from(dec))).unzip();
    Trace::scatter(Mode::Text, x, y)
        .texts(dec_deg.iter().map(|dec| format!("{dec}° ")).collect())
        .text_position(TextPosition::MiddleLeft)
        .no_hover()
}

/// Converts sky coordinates to map coordinates. The right ascension, from −180 to 180°, increases to the
/// left, as in the sky seen from within.
fn map_of(ra_deg: f64, dec_deg: f64) -> (f64, f64) {
    let dec = dec_deg.to_radians();
    let wanted = PI * libm::sin(dec);
    // 2 θ + sin 2θ = π sin δ is monotonic in θ. Bisection solves it at the poles too, where Newton's method
    // fails.
    let (mut low, mut high) = (-PI / 2.0, PI / 2.0);
    for _ in 0..50 {
        let middle = 0.5 * (low + high);
        if 2.0 * middle + libm::sin(2.0 * middle) < wanted { low = middle } else { high = middle }
    }
    (-2.0 * SQRT_2 / PI * ra_deg.to_radians() * libm::cos(low), SQRT_2 * libm::sin(low))
}

/// Converts map coordinates to right ascension and declination, degrees; `None` outside the edge.
fn sky_of(across: f64, up: f64) -> Option<(f64, f64)> {
    let theta = libm::asin(up / SQRT_2);
    let ra = -PI * across / (2.0 * SQRT_2 * libm::cos(theta));
    let dec = libm::asin((2.0 * theta + libm::sin(2.0 * theta)) / PI);
    (ra.abs() <= PI).then(|| (ra.to_degrees(), dec.to_degrees()))
}

/// Pointings sorted by declination.
struct Pointings<'a> {
    by_declination: Vec<(f64, Direction<Icrs>, &'a PointingStars)>,
}

impl<'a> Pointings<'a> {
    fn new(counted: &[&'a PointingStars]) -> Self {
        let mut by_declination: Vec<_> =
            counted.iter().map(|&p| (p.dec_deg.to_radians(), direction(p.ra_deg, p.dec_deg), p)).collect();
        by_declination.sort_by(|a, b| a.0.total_cmp(&b.0));
        Self { by_declination }
    }

    /// Returns the nearest pointing within `reach`, rad.
    fn nearest(&self, ra_deg: f64, dec_deg: f64, reach: f64) -> Option<&'a PointingStars> {
        let (place, dec) = (direction(ra_deg, dec_deg), dec_deg.to_radians());
        let from = self.by_declination.partition_point(|p| p.0 < dec - reach);
        let near = self.by_declination[from..].iter().take_while(|p| p.0 <= dec + reach);
        let cosine = |p: &&(f64, Direction<Icrs>, &PointingStars)| place.vector().dot(p.1.vector());
        let nearest = near.max_by(|a, b| cosine(a).total_cmp(&cosine(b)))?;
        (cosine(&nearest) >= libm::cos(reach)).then_some(nearest.2)
    }
}

fn direction(ra_deg: f64, dec_deg: f64) -> Direction<Icrs> {
    Direction::from_ra_dec(contract::Angle::from_degrees(ra_deg), contract::Angle::from_degrees(dec_deg))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_map_and_its_inverse_agree_and_areas_are_equal() {
        for (ra, dec) in [(0.0, 0.0), (-120.0, 40.0), (179.0, -75.0), (30.0, 89.0)] {
            let (across, up) = map_of(ra, dec);
            let (ra_again, dec_again) = sky_of(across, up).unwrap();
            assert!((ra - ra_again).abs() < 1e-6 && (dec - dec_again).abs() < 1e-6, "{ra} {dec}");
        }
        // The band within 30° of the equator is half of the sky, and half of the ellipse.
        let theta = libm::asin(map_of(0.0, 30.0).1 / SQRT_2);
        assert!(((2.0 * theta + libm::sin(2.0 * theta)) / PI - 0.5).abs() < 1e-9);
        assert_eq!(sky_of(2.8, 1.0), None);
    }
}
