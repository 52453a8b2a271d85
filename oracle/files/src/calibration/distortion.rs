//! Brown–Conrady distortion in the units of a calibration and of the contract, and the change between them.

use nalgebra::{DMatrix, DVector};

/// Number of azimuths at which an image is sampled.
const AZIMUTHS: u32 = 96;
/// Samples on the longest radius of an image.
const RADII: u32 = 64;
/// Largest undistorted radius of a sample, in the distance of the farthest corner: as in the camera models of
/// the pipelines, a point beyond it is not imaged.
const MAX_RADIUS: u32 = 4;

/// Powers of the unit in each term, k1, k2, k3, p1, p2: a term's displacement grows with r to this power
/// plus 1.
const POWERS: [u32; 5] = [2, 4, 6, 1, 1];

/// Detector on which two models are compared.
#[derive(Debug, Clone, Copy)]
pub(super) struct Detector {
    /// Number of columns and rows.
    pub(super) size_px: [usize; 2],
    /// Principal point, px; the centre of the first pixel is 0.
    pub(super) principal_px: [f64; 2],
}

/// Distortion of offsets from the principal point.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Distortion {
    /// Units of an offset along columns and rows, px: the focal lengths for tangents, 1 for pixels.
    pub(super) unit_px: [f64; 2],
    /// Coefficients k1, k2, k3, p1, p2, for offsets in these units.
    pub(super) terms: [f64; 5],
}

/// Distortion in other units.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Refit {
    /// The distortion in the other units.
    pub(super) distortion: Distortion,
    /// Largest distance between the images of a point by the two models, over the detector, px.
    pub(super) displacement_px: f64,
}

impl Distortion {
    /// Returns the displacements by each term with a coefficient of 1, px, at the undistorted offset (u, v),
    /// px.
    fn unit_displacements(&self, u: f64, v: f64) -> [[f64; 2]; 5] {
        let [unit_x, unit_y] = self.unit_px;
        let (x, y) = (u / unit_x, v / unit_y);
        let r2 = x * x + y * y;
        let terms = [
            [x * r2, y * r2],
            [x * r2 * r2, y * r2 * r2],
            [x * r2 * r2 * r2, y * r2 * r2 * r2],
            [2.0 * x * y, r2 + 2.0 * y * y],
            [r2 + 2.0 * x * x, 2.0 * x * y],
        ];
        terms.map(|[along_x, along_y]| [along_x * unit_x, along_y * unit_y])
    }

    /// Returns the displacement of the undistorted offset (u, v), px.
    fn displacement(&self, u: f64, v: f64) -> [f64; 2] {
        let units = self.unit_displacements(u, v);
        let sum = |axis: fn(&[f64; 2]) -> f64| {
            units.iter().zip(self.terms).map(|(unit, term)| axis(unit) * term).sum()
        };
        [sum(|[x, _]| *x), sum(|[_, y]| *y)]
    }

    /// Returns true if the distortion has a displacement.
    fn is_distorting(&self) -> bool {
        self.terms.iter().any(|term| *term != 0.0)
    }

    /// Changes the units of the offsets: exactly where the units along columns and rows have the same ratio,
    /// by least squares over the detector elsewhere. A term of 0 stays 0. `None` if no point of the detector
    /// has an undistorted offset, or if a number is not finite.
    pub(super) fn with_units(&self, unit_px: [f64; 2], detector: &Detector) -> Option<Refit> {
        // Coefficients for the mean ratio of the units: c' = c (new unit / old unit)^power.
        let ratios = [unit_px[0] / self.unit_px[0], unit_px[1] / self.unit_px[1]];
        let ratio = if ratios[0] == ratios[1] { ratios[0] } else { (ratios[0] * ratios[1]).sqrt() };
        let mut terms = [0.0; 5];
        for ((term, old), power) in terms.iter_mut().zip(self.terms).zip(POWERS) {
            *term = if old == 0.0 { 0.0 } else { old * (0..power).fold(1.0, |product, _| product * ratio) };
        }
        let first = Self { unit_px, terms };
        if ratios[0] == ratios[1] || !self.is_distorting() {
            let is_finite = terms.iter().all(|term| term.is_finite());
            return is_finite.then_some(Refit { distortion: first, displacement_px: 0.0 });
        }
        let samples = self.samples(detector);
        let distortion = first.nearest_to(self, &samples)?;
        let displacement_px = distortion.largest_difference(self, &samples);
        (!samples.is_empty() && displacement_px.is_finite()).then_some(Refit { distortion, displacement_px })
    }

    /// Adjusts the terms that are not 0 to another distortion by linear least squares over the samples.
    fn nearest_to(&self, other: &Self, samples: &[[f64; 2]]) -> Option<Self> {
        let free: Vec<usize> = (0..5).filter(|index| self.terms.get(*index) != Some(&0.0)).collect();
        // Unknowns: relative corrections δ of the terms, whose displacements A δ are the missing ones, b.
        let mut design = DMatrix::zeros(2 * samples.len(), free.len());
        let mut missing = DVector::zeros(2 * samples.len());
        for (sample, [u, v]) in samples.iter().enumerate() {
            let (ours, theirs) = (self.displacement(*u, *v), other.displacement(*u, *v));
            let units = self.unit_displacements(*u, *v);
            for axis in 0..2 {
                let row = 2 * sample + axis;
                missing[row] = theirs[axis] - ours[axis];
                for (column, term) in free.iter().enumerate() {
                    design[(row, column)] = units[*term][axis] * self.terms[*term];
                }
            }
        }
        if samples.len() < free.len() || design.iter().chain(&missing).any(|number| !number.is_finite()) {
            return None;
        }
        // A = Q R, R δ = Qᵀ b.
        let factors = design.qr();
        factors.q_tr_mul(&mut missing);
        let corrections = factors.r().solve_upper_triangular(&missing.rows(0, free.len()).into_owned())?;
        let mut fitted = *self;
        for (correction, term) in corrections.iter().zip(free) {
            fitted.terms[term] *= 1.0 + correction;
        }
        fitted.terms.iter().all(|term| term.is_finite()).then_some(fitted)
    }

    /// Returns the largest distance between the images of a sample by two distortions, px.
    fn largest_difference(&self, other: &Self, samples: &[[f64; 2]]) -> f64 {
        let distance = |[u, v]: &[f64; 2]| {
            let (ours, theirs) = (self.displacement(*u, *v), other.displacement(*u, *v));
            libm::hypot(ours[0] - theirs[0], ours[1] - theirs[1])
        };
        samples.iter().map(distance).fold(0.0, f64::max)
    }

    /// Returns undistorted offsets whose images are on the detector, or beside it by at most a step: rays
    /// from the principal point, each up to the fold where the distorted radius stops to grow.
    fn samples(&self, detector: &Detector) -> Vec<[f64; 2]> {
        let [left, top] = detector.principal_px.map(|c| -0.5 - c);
        let [right, bottom] =
            [0, 1].map(|axis| detector.size_px[axis] as f64 - 0.5 - detector.principal_px[axis]);
        let corner_px = libm::hypot(left.abs().max(right.abs()), top.abs().max(bottom.abs()));
        let step_px = corner_px / f64::from(RADII);
        let mut samples = Vec::new();
        for azimuth in 0..AZIMUTHS {
            let (sin, cos) = libm::sincos(std::f64::consts::TAU * f64::from(azimuth) / f64::from(AZIMUTHS));
            let mut last_radius_px = 0.0;
            for step in 1..=MAX_RADIUS * RADII {
                let (u, v) = (cos * step_px * f64::from(step), sin * step_px * f64::from(step));
                let [du, dv] = self.displacement(u, v);
                let (x, y) = (u + du, v + dv);
                let radius_px = libm::hypot(x, y);
                if !(radius_px > last_radius_px && radius_px <= corner_px + step_px) {
                    break;
                }
                last_radius_px = radius_px;
                let is_on_columns = (left - step_px..=right + step_px).contains(&x);
                if is_on_columns && (top - step_px..=bottom + step_px).contains(&y) {
                    samples.push([u, v]);
                }
            }
        }
        samples
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const DETECTOR: Detector = Detector { size_px: [1280, 960], principal_px: [651.0, 470.0] };
    const TERMS: [f64; 5] = [-0.28, 0.09, -0.01, 1.2e-3, -7e-4];

    #[test]
    fn equal_focal_lengths_convert_exactly() {
        let tangents = Distortion { unit_px: [900.0; 2], terms: TERMS };
        let pixels = tangents.with_units([1.0; 2], &DETECTOR).unwrap();
        assert_eq!(pixels.displacement_px, 0.0);
        // Displacements of 100 px are the same to the last digits.
        for [u, v] in [[600.0, 400.0], [-620.0, 100.0], [3.0, -450.0]] {
            let [a, b] = [tangents.displacement(u, v), pixels.distortion.displacement(u, v)];
            assert!((a[0] - b[0]).abs() < 1e-11 && (a[1] - b[1]).abs() < 1e-11, "{a:?} {b:?}");
        }
        let again = pixels.distortion.with_units([900.0; 2], &DETECTOR).unwrap().distortion;
        for (one, other) in TERMS.iter().zip(again.terms) {
            assert!((one - other).abs() < 1e-15);
        }
    }

    #[test]
    fn other_pixels_convert_within_the_stated_displacement() {
        for (ratio, limit_px) in [(1.0005, 0.2), (0.999, 0.2), (8.6 / 8.3, 5.0)] {
            let tangents = Distortion { unit_px: [900.0, 900.0 * ratio], terms: TERMS };
            let refit = tangents.with_units([1.0; 2], &DETECTOR).unwrap();
            assert!(refit.displacement_px > 1e-4 && refit.displacement_px < limit_px, "{refit:?}");
            // Pixels of the detector beside the samples; a fit is better than the mean of the focal lengths.
            let plain = tangents
                .terms
                .iter()
                .zip(POWERS)
                .map(|(term, power)| term / libm::pow(900.0 * ratio.sqrt(), f64::from(power)));
            let plain =
                Distortion { unit_px: [1.0; 2], terms: plain.collect::<Vec<_>>().try_into().unwrap() };
            let (mut worst, mut square, mut plain_square) = (0.0_f64, 0.0, 0.0);
            for (column, row) in (0..110).flat_map(|column| (0..80).map(move |row| (column, row))) {
                let (u, v) = (f64::from(column) * 13.0 - 760.0, f64::from(row) * 14.0 - 560.0);
                let [du, dv] = tangents.displacement(u, v);
                let is_on = (-651.5..=628.5).contains(&(u + du)) && (-470.5..=489.5).contains(&(v + dv));
                if is_on {
                    let difference = |other: &Distortion| {
                        let [a, b] = other.displacement(u, v);
                        libm::hypot(a - du, b - dv)
                    };
                    worst = worst.max(difference(&refit.distortion));
                    square += difference(&refit.distortion) * difference(&refit.distortion);
                    plain_square += difference(&plain) * difference(&plain);
                }
            }
            assert!(
                worst <= refit.displacement_px && worst > 0.7 * refit.displacement_px,
                "{worst} {refit:?}"
            );
            assert!(square <= 1.02 * plain_square, "{square} {plain_square}");
        }
    }

    #[test]
    fn terms_of_zero_stay_zero() {
        let one = Distortion { unit_px: [900.0, 910.0], terms: [-0.2, 0.0, 0.0, 0.0, 0.0] };
        let refit = one.with_units([1.0; 2], &DETECTOR).unwrap();
        assert!(refit.distortion.terms[0] < 0.0 && refit.distortion.terms[1..] == [0.0; 4]);
        let none = Distortion { terms: [0.0; 5], ..one }.with_units([1.0; 2], &DETECTOR).unwrap();
        assert_eq!((none.distortion.terms, none.displacement_px), ([0.0; 5], 0.0));
    }

    #[test]
    fn numbers_that_overflow_have_no_conversion() {
        let huge = Distortion { unit_px: [1e-3, 2e-3], terms: [1e308, 0.0, 0.0, 0.0, 0.0] };
        assert_eq!(huge.with_units([1.0; 2], &DETECTOR), None);
        let square = Distortion { unit_px: [1e-3; 2], terms: [0.0, 0.0, 1e300, 0.0, 0.0] };
        assert_eq!(square.with_units([1.0; 2], &DETECTOR), None);
        // The principal point is so far beside the detector that the distortion folds before it.
        let far = Detector { principal_px: [5000.0, 470.0], ..DETECTOR };
        let barrel = Distortion { unit_px: [900.0, 901.0], terms: [-0.3, 0.0, 0.0, 0.0, 0.0] };
        assert_eq!(barrel.with_units([1.0; 2], &far), None);
    }
}
