//! Brightness of the stars: zero point with a term for their colour, and limiting magnitude.

/// A star that a frame shows, or might.
#[derive(Debug, Clone, Copy)]
pub(crate) struct StarLight {
    /// Visual magnitude.
    pub(crate) magnitude: f64,
    /// Colour index B−V, if known.
    pub(crate) b_v: Option<f64>,
    /// Flux of its source above the background, DN; `None` if it has none.
    pub(crate) flux_dn: Option<f64>,
    /// Height of the source above the noise, standard deviations; 0 if it has none.
    pub(crate) significance: f64,
}

/// Brightness scale of the frames: V = zero point − 2.5 lg(flux in DN) + colour term · (B − V).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Photometry {
    /// V of a star with a flux of 1 DN per exposure and B−V = 0, and its standard deviation.
    pub zero_point: [f64; 2],
    /// Colour term, and its standard deviation.
    pub colour_term: [f64; 2],
    /// Scatter of a star about the relation, mag.
    pub scatter_mag: f64,
    /// Number of stars.
    pub stars: usize,
    /// V at which half of the listed stars in the frames have a source; `None` if the list ends before.
    pub limiting_v: Option<f64>,
}

/// Residual, in units of the scatter, beyond which a star is left out, and number of rounds.
const CLIP_SIGMAS: f64 = 3.0;
const ROUNDS: usize = 6;

/// Smallest number of stars of a brightness scale.
const MIN_STARS: usize = 8;

/// Significance from which a star takes part, if enough have it: of fainter ones, those are found that noise
/// or a neighbour makes brighter.
const MIN_SIGNIFICANCE: f64 = 25.0;
const MIN_SIGNIFICANT: usize = 20;

/// Width of a bin of magnitudes, and smallest number of stars in it.
const BIN_MAG: f64 = 0.5;
const MIN_IN_BIN: usize = 5;

/// Fits the brightness scale; `None` with too few stars.
pub(crate) fn photometry(stars: &[StarLight]) -> Option<Photometry> {
    let significant = stars.iter().filter(|star| star.significance >= MIN_SIGNIFICANCE).count();
    let limit = if significant >= MIN_SIGNIFICANT { MIN_SIGNIFICANCE } else { 0.0 };
    // Rows (B−V, V + 2.5 lg flux).
    let mut rows: Vec<[f64; 2]> = Vec::new();
    for star in stars.iter().filter(|star| star.significance >= limit) {
        if let (Some(b_v), Some(flux_dn)) = (star.b_v, star.flux_dn.filter(|flux| *flux > 0.0)) {
            rows.push([b_v, star.magnitude + 2.5 * libm::log10(flux_dn)]);
        }
    }
    // The first relation has no colour term: the median.
    let mut sorted: Vec<f64> = rows.iter().map(|row| row[1]).collect();
    sorted.sort_by(f64::total_cmp);
    let mut line = Line { offset: *sorted.get(sorted.len() / 2)?, ..Line::default() };
    line.scatter = 1.0;
    for _ in 0..ROUNDS {
        let kept: Vec<[f64; 2]> = rows
            .iter()
            .filter(|row| line.residual(row).abs() <= CLIP_SIGMAS * line.scatter)
            .copied()
            .collect();
        if kept.len() < MIN_STARS {
            return None;
        }
        line = Line::fit(&kept)?;
    }
    Some(Photometry {
        zero_point: [line.offset, line.offset_sigma],
        // V = offset + slope (B−V) − 2.5 lg flux.
        colour_term: [line.slope, line.slope_sigma],
        scatter_mag: line.scatter,
        stars: line.count,
        limiting_v: limiting_magnitude(stars),
    })
}

/// A straight line with errors.
#[derive(Debug, Clone, Copy, Default)]
struct Line {
    offset: f64,
    offset_sigma: f64,
    slope: f64,
    slope_sigma: f64,
    scatter: f64,
    count: usize,
}

impl Line {
    fn residual(&self, row: &[f64; 2]) -> f64 {
        row[1] - self.offset - self.slope * row[0]
    }

    /// Fits a line by least squares; `None` if all abscissae are equal.
    fn fit(rows: &[[f64; 2]]) -> Option<Self> {
        let n = rows.len() as f64;
        let mean_x = rows.iter().map(|row| row[0]).sum::<f64>() / n;
        let mean_y = rows.iter().map(|row| row[1]).sum::<f64>() / n;
        let (mut squares, mut products) = (0.0, 0.0);
        for [x, y] in rows {
            squares += (x - mean_x) * (x - mean_x);
            products += (x - mean_x) * (y - mean_y);
        }
        if squares <= 0.0 {
            return None;
        }
        let slope = products / squares;
        let offset = mean_y - slope * mean_x;
        let mut line = Self { offset, slope, count: rows.len(), ..Self::default() };
        let sum: f64 = rows.iter().map(|row| line.residual(row) * line.residual(row)).sum();
        line.scatter = (sum / (n - 2.0)).sqrt();
        line.slope_sigma = line.scatter / squares.sqrt();
        line.offset_sigma = line.scatter * (1.0 / n + mean_x * mean_x / squares).sqrt();
        Some(line)
    }
}

/// Returns the magnitude at which the share of listed stars with a source falls below a half, between the
/// centres of two bins.
fn limiting_magnitude(stars: &[StarLight]) -> Option<f64> {
    let mut before: Option<(f64, f64)> = None;
    let brightest = stars.iter().map(|star| star.magnitude).fold(f64::INFINITY, f64::min);
    let faintest = stars.iter().map(|star| star.magnitude).fold(f64::NEG_INFINITY, f64::max);
    let mut bin = (brightest / BIN_MAG).floor() * BIN_MAG;
    while bin < faintest {
        let of_bin = || stars.iter().filter(|star| (bin..bin + BIN_MAG).contains(&star.magnitude));
        let count = of_bin().count();
        if count >= MIN_IN_BIN {
            let share = of_bin().filter(|star| star.flux_dn.is_some()).count() as f64 / count as f64;
            let centre = bin + 0.5 * BIN_MAG;
            if let Some((last, last_share)) = before
                && share < 0.5
                && last_share >= 0.5
            {
                return Some(last + (centre - last) * (last_share - 0.5) / (last_share - share));
            }
            before = Some((centre, share));
        }
        bin += BIN_MAG;
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn zero_point_colour_and_limit_are_those_of_the_stars() {
        let mut stars = Vec::new();
        for i in 0..200 {
            let (magnitude, b_v) = (4.0 + 0.025 * f64::from(i), f64::from(i % 17) / 10.0 - 0.2);
            let scatter = 0.05 * (f64::from(i * 7 % 11) / 5.0 - 1.0);
            let lg_flux = (12.0 + 0.3 * b_v - magnitude + scatter) / 2.5;
            // Two of three stars have a source below V = 7, none beyond.
            let is_seen = magnitude < 7.0 && i % 3 != 0;
            let flux_dn = is_seen.then(|| libm::pow(10.0, lg_flux));
            let significance = flux_dn.map_or(0.0, |flux| flux / 100.0);
            stars.push(StarLight { magnitude, b_v: Some(b_v), flux_dn, significance });
        }
        // A wrong star.
        stars[1].flux_dn = Some(1.0);
        let found = photometry(&stars).unwrap();
        assert!((found.zero_point[0] - 12.0).abs() < 4.0 * found.zero_point[1], "{found:?}");
        assert!((found.colour_term[0] - 0.3).abs() < 4.0 * found.colour_term[1], "{found:?}");
        assert!((0.02..0.05).contains(&found.scatter_mag) && found.zero_point[1] < 0.01, "{found:?}");
        assert!((6.7..7.2).contains(&found.limiting_v.unwrap()), "{found:?}");
        assert_eq!(photometry(&stars[..8]), None);
    }
}
