//! Power spectra of the noise along rows and columns.

use super::background::Plane;

/// Length of a piece of a row or column, px.
pub const LENGTH_PX: usize = 64;

/// Every so many rows or columns are used.
const STEP: usize = 4;

/// Mean power of pieces of 64 px at the frequencies 1/64 to 32/64 per pixel, DN²; white noise of σ has σ² at
/// each.
#[derive(Debug, Clone, PartialEq)]
pub struct Spectrum {
    /// Power by frequency.
    pub power: Vec<f64>,
}

impl Spectrum {
    /// Returns the spectrum along the rows of a plane. Pixels left out count as 0, and the power is that of
    /// the kept ones; pieces of which less than half is kept are left out.
    pub(crate) fn along_rows(plane: &Plane) -> Self {
        Self::of(plane.rows, plane.columns, |line, place| plane.at(place, line))
    }

    /// Returns the spectrum along the columns of a plane.
    pub(crate) fn along_columns(plane: &Plane) -> Self {
        Self::of(plane.columns, plane.rows, |line, place| plane.at(line, place))
    }

    /// Returns the mean of the periodograms |Σ x e^(−2πi k n/64)|²/64 of all pieces.
    fn of(lines: usize, length: usize, value: impl Fn(usize, usize) -> f64) -> Self {
        let turns: Vec<[f64; 2]> = (0..LENGTH_PX)
            .map(|n| {
                let angle = std::f64::consts::TAU * n as f64 / LENGTH_PX as f64;
                [libm::cos(angle), libm::sin(angle)]
            })
            .collect();
        let mut power = vec![0.0; LENGTH_PX / 2];
        let mut pieces = 0.0;
        for line in (0..lines).step_by(STEP) {
            for first in (0..(length + 1).saturating_sub(LENGTH_PX)).step_by(LENGTH_PX) {
                let mut piece = [0.0; LENGTH_PX];
                let mut count = 0;
                for (offset, kept) in piece.iter_mut().enumerate() {
                    let read = value(line, first + offset);
                    if !read.is_nan() {
                        *kept = read;
                        count += 1;
                    }
                }
                if 2 * count >= LENGTH_PX {
                    add_periodogram(&piece, &turns, LENGTH_PX as f64 / count as f64, &mut power);
                    pieces += 1.0;
                }
            }
        }
        for value in &mut power {
            *value /= f64::max(pieces, 1.0);
        }
        Self { power }
    }

    /// Returns the mean of several spectra.
    pub(crate) fn mean<'a>(spectra: impl Iterator<Item = &'a Self>) -> Self {
        let mut power = vec![0.0; LENGTH_PX / 2];
        let mut count = 0.0;
        for spectrum in spectra {
            for (sum, value) in power.iter_mut().zip(&spectrum.power) {
                *sum += value;
            }
            count += 1.0;
        }
        for value in &mut power {
            *value /= f64::max(count, 1.0);
        }
        Self { power }
    }
}

/// Adds the power of a piece at each frequency, times `factor`.
fn add_periodogram(piece: &[f64; LENGTH_PX], turns: &[[f64; 2]], factor: f64, power: &mut [f64]) {
    for (index, sum) in power.iter_mut().enumerate() {
        let (mut real, mut imaginary) = (0.0, 0.0);
        for (place, value) in piece.iter().enumerate() {
            let [cosine, sine] = turns[(index + 1) * place % LENGTH_PX];
            real += value * cosine;
            imaginary += value * sine;
        }
        *sum += factor * (real * real + imaginary * imaginary) / LENGTH_PX as f64;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_wave_has_its_power_at_its_frequency() {
        // cos(2π 8 n/64) of amplitude 2 has |Σ|²/64 = (2 · 64/2)²/64 = 64 at 8/64 per pixel.
        let mut values = Vec::new();
        for _ in 0..128 {
            for column in 0..128 {
                values.push(2.0 * libm::cos(std::f64::consts::TAU * f64::from(column) / 8.0));
            }
        }
        let plane = Plane { columns: 128, rows: 128, values };
        let along = Spectrum::along_rows(&plane).power;
        assert!((along[7] - 64.0).abs() < 1e-9, "{along:?}");
        assert!(along.iter().enumerate().all(|(index, power)| index == 7 || *power < 1e-9));
        // Along the columns it is constant: no power but at frequency 0.
        assert!(Spectrum::along_columns(&plane).power.iter().all(|power| *power < 1e-9));
    }
}
