//! Stars that both sets of frames show: brightness, colour, width, scatter of the positions.
//!
//! The two sets are compared star by star, so that errors of the catalogue and the different brightness of
//! the stars cancel. A star of several frames counts once.

use std::collections::BTreeMap;

use camera_fit::{CameraFit, MatchedStar};

use super::difference::{Likeness, NotCompared, Unit};
use super::estimate::Estimate;

/// Smallest significance of a star in both sets: the fluxes of fainter ones are those of the lucky ones.
const MIN_SIGNIFICANCE: f64 = 10.0;

/// Smallest number of stars of a figure.
const MIN_STARS: usize = 8;

/// Smallest standard deviation of B−V over which a colour term can be compared, mag.
const MIN_COLOUR_SPREAD: f64 = 0.1;

/// A star of both sets, with means over its frames.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SharedStar {
    /// Number in the Hipparcos catalogue.
    pub id: u32,
    /// Visual magnitude.
    pub magnitude: f64,
    /// Colour index B−V, if known.
    pub b_v: Option<f64>,
    /// Means of the camera and of the twin.
    pub sets: [StarMeans; 2],
}

/// Means over the frames of a star.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StarMeans {
    /// Natural logarithm of the flux in DN.
    pub ln_flux: f64,
    /// Natural logarithm of the width in px; NaN where no frame gives one.
    pub ln_width: f64,
    /// Natural logarithm of the squared residual of its position in px².
    pub ln_residual2: f64,
    /// Smallest significance.
    pub significance: f64,
}

/// Returns the stars of both sets, in order of their number.
pub fn shared_stars(camera: &CameraFit, twin: &CameraFit) -> Vec<SharedStar> {
    let (of_camera, of_twin) = (by_star(&camera.matched), by_star(&twin.matched));
    let mut shared = Vec::new();
    for (id, first) in &of_camera {
        let Some(second) = of_twin.get(id) else { continue };
        let Some(star) = first.first() else { continue };
        let sets = [means(first), means(second)];
        if sets.iter().all(|means| means.significance >= MIN_SIGNIFICANCE) {
            shared.push(SharedStar { id: *id, magnitude: star.magnitude, b_v: star.b_v, sets });
        }
    }
    shared
}

fn by_star(matched: &[MatchedStar]) -> BTreeMap<u32, Vec<&MatchedStar>> {
    let mut stars: BTreeMap<u32, Vec<&MatchedStar>> = BTreeMap::new();
    for star in matched {
        stars.entry(star.id).or_default().push(star);
    }
    stars
}

fn means(frames: &[&MatchedStar]) -> StarMeans {
    let mean = |value: &dyn Fn(&MatchedStar) -> f64| {
        let values: Vec<f64> =
            frames.iter().map(|star| value(star)).filter(|value| value.is_finite()).collect();
        if values.is_empty() { f64::NAN } else { values.iter().sum::<f64>() / values.len() as f64 }
    };
    StarMeans {
        ln_flux: mean(&|star| libm::log(star.flux_dn)),
        ln_width: mean(&|star| libm::log(star.width_px)),
        ln_residual2: mean(&|star| {
            let [x, y] = star.residual_px;
            libm::log(x * x + y * y)
        }),
        significance: frames.iter().map(|star| star.significance).fold(f64::INFINITY, f64::min),
    }
}

/// Returns the figures of the stars of both sets.
///
/// # Errors
/// In the second list: the figures that the stars do not give.
pub(crate) fn likenesses(stars: &[SharedStar]) -> (Vec<Likeness>, Vec<NotCompared>) {
    let (mut figures, mut missing) = (Vec::new(), Vec::new());
    let flux = ratio(stars, |means| means.ln_flux);
    let width = ratio(stars, |means| means.ln_width);
    // Half of the logarithm of the square is that of the scatter.
    let scatter = ratio(stars, |means| 0.5 * means.ln_residual2);
    for (code, name, estimate) in [
        ("star_flux", "star brightness", flux),
        ("star_width", "star width", width),
        ("position_scatter", "scatter of positions", scatter),
    ] {
        match estimate {
            Some(estimate) => figures.push(Likeness::of_ratio(code, name, estimate)),
            None => missing.push(too_few(name, stars.len())),
        }
    }
    let name = "colour term";
    match colour_term(stars) {
        Some(estimate) => {
            figures.push(Likeness::of_difference("colour_term", name, Unit::MagnitudePerColour, estimate));
        }
        None => missing.push(too_few(name, stars.len())),
    }
    (figures, missing)
}

fn too_few(name: &'static str, stars: usize) -> NotCompared {
    let reason = format!("{stars} stars in both sets, {MIN_STARS} of different colours are needed");
    NotCompared { name, reason }
}

/// Returns the mean of the logarithm of the ratio of a value, twin over camera.
fn ratio(stars: &[SharedStar], value: fn(&StarMeans) -> f64) -> Option<Estimate> {
    let mut differences = Vec::with_capacity(stars.len());
    for SharedStar { sets: [camera, twin], .. } in stars {
        let difference = value(twin) - value(camera);
        if difference.is_finite() {
            differences.push(difference);
        }
    }
    if differences.len() < MIN_STARS { None } else { Estimate::of_values(&differences) }
}

/// Returns the change with B−V of the magnitude difference, twin minus camera, by least squares without the
/// stars beyond three standard deviations.
fn colour_term(stars: &[SharedStar]) -> Option<Estimate> {
    let mut points: Vec<[f64; 2]> = Vec::new();
    for star in stars {
        let [camera, twin] = star.sets;
        // 2.5 lg e.
        let magnitude = -1.085_736_204_758_129_6 * (twin.ln_flux - camera.ln_flux);
        if let (Some(b_v), true) = (star.b_v, magnitude.is_finite()) {
            points.push([b_v, magnitude]);
        }
    }
    let first = slope(&points)?;
    points.retain(|point| first.residual(point).abs() <= 3.0 * first.scatter);
    let line = slope(&points)?;
    // A star brightens with B−V where the term of V = zero point − 2.5 lg flux + term (B−V) is positive: the
    // term has the sign of the magnitude difference reversed.
    Some(Estimate { value: line.slope, sigma: line.sigma, freedom: line.count - 2.0 })
}

/// A straight line.
struct Slope {
    mean: [f64; 2],
    slope: f64,
    sigma: f64,
    scatter: f64,
    count: f64,
}

impl Slope {
    fn residual(&self, [x, y]: &[f64; 2]) -> f64 {
        y - self.mean[1] - self.slope * (x - self.mean[0])
    }
}

fn slope(points: &[[f64; 2]]) -> Option<Slope> {
    let count = points.len() as f64;
    if points.len() < MIN_STARS {
        return None;
    }
    let mean = [0, 1].map(|axis| points.iter().map(|point| point[axis]).sum::<f64>() / count);
    let (mut squares, mut products) = (0.0, 0.0);
    for [x, y] in points {
        squares += (x - mean[0]) * (x - mean[0]);
        products += (x - mean[0]) * (y - mean[1]);
    }
    if (squares / count).sqrt() < MIN_COLOUR_SPREAD {
        return None;
    }
    let mut line = Slope { mean, slope: products / squares, sigma: 0.0, scatter: 0.0, count };
    let sum: f64 = points.iter().map(|point| line.residual(point) * line.residual(point)).sum();
    line.scatter = (sum / (count - 2.0)).sqrt();
    line.sigma = line.scatter / squares.sqrt();
    Some(line)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn star(id: u32, scatter: f64) -> SharedStar {
        let b_v = f64::from(id % 10) / 10.0;
        let camera = StarMeans { ln_flux: 8.0, ln_width: 0.0, ln_residual2: -4.0, significance: 50.0 };
        // The twin is 3 % fainter at B−V = 0, loses 0.1 mag per mag of B−V, and is 2 % wider.
        let ln_flux = 8.0 - 0.03 - 0.1 * b_v / 1.085_736_204_758_129_6 + scatter;
        let twin = StarMeans { ln_flux, ln_width: 0.02 + scatter, ..camera };
        SharedStar { id, magnitude: 5.0, b_v: Some(b_v), sets: [camera, twin] }
    }

    #[test]
    fn differences_of_stars_are_found() {
        let stars: Vec<SharedStar> =
            (0..200).map(|id| star(id, 0.01 * (f64::from(id * 7 % 13) / 6.0 - 1.0))).collect();
        let (figures, missing) = likenesses(&stars);
        assert_eq!(missing, []);
        let of = |code: &str| figures.iter().find(|figure| figure.code == code).unwrap();
        let width = of("star_width");
        assert!((width.difference - 2.0).abs() < width.limit && width.limit < 0.2, "{width:?}");
        assert!(!width.is_indistinguishable());
        let colour = of("colour_term");
        assert!((colour.difference - 0.1).abs() < 2.0 * colour.limit && colour.limit < 0.02, "{colour:?}");
        assert!(of("position_scatter").is_indistinguishable());
        assert_eq!(likenesses(&stars[..7]).0, []);
    }
}
