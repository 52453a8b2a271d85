//! Gravity field of the Earth: EGM96 to degree and order 36.

use nalgebra::Vector3;

use crate::orbit::{EARTH_GM_KM3_S2, EGM96_RADIUS_KM};

/// Highest degree and order of the coefficients in the tree.
pub(super) const MAX_DEGREE: usize = 36;

const BYTES: usize = size_of::<f64>();
const PAIRS: usize = (MAX_DEGREE + 1) * (MAX_DEGREE + 2) / 2;

/// Normalised coefficients C, S by degree, then order, made by `sim/data/make_gravity.py`. A table of another
/// size does not compile.
static TABLE: &[u8; 2 * PAIRS * BYTES] = include_bytes!("../../../data/egm96.bin");

/// Position of (n, m) in a triangle.
fn at(n: usize, m: usize) -> usize {
    n * (n + 1) / 2 + m
}

/// Coefficients and scratch memory of an expansion.
#[derive(Debug, Clone)]
pub(super) struct GravityField {
    degree: usize,
    /// Coefficients (C, S), not normalised, in the triangle of degree and order; 0 above the order.
    coefficients: Vec<[f64; 2]>,
    order: usize,
    /// Factors of the recursion, (2n − 1)/(n − m) and (n + m − 1)/(n − m).
    factors: Vec<[f64; 2]>,
    /// V and W of Cunningham's recursion, to one degree more.
    solids: Vec<[f64; 2]>,
}

impl GravityField {
    /// Prepares the expansion to `degree` and `order`, both at most [`MAX_DEGREE`] (larger values are
    /// reduced). Degree 0 or 1 is a point mass.
    pub(super) fn new(degree: usize, order: usize) -> Self {
        let degree = degree.min(MAX_DEGREE);
        let order = order.min(degree);
        let (words, _) = TABLE.as_chunks::<BYTES>();
        let number = |index: usize| words.get(index).map_or(0.0, |word| f64::from_le_bytes(*word));
        let mut coefficients = Vec::with_capacity(at(degree + 1, 0));
        for n in 0..=degree {
            for m in 0..=n {
                let pair = match (n, m) {
                    (0, 0) => [1.0, 0.0],
                    _ if m > order || n == 1 => [0.0, 0.0],
                    _ => [0, 1].map(|k| number(2 * at(n, m) + k) * normalisation(n, m)),
                };
                coefficients.push(pair);
            }
        }
        let mut factors = Vec::with_capacity(at(degree + 2, 0));
        for n in 0..=degree + 1 {
            for m in 0..=n {
                let below = if m < n { 1.0 / (n - m) as f64 } else { 0.0 };
                factors.push([(2 * n) as f64 - 1.0, (n + m) as f64 - 1.0].map(|factor| factor * below));
            }
        }
        let solids = vec![[0.0; 2]; at(degree + 2, 0)];
        Self { degree, coefficients, order, factors, solids }
    }

    /// Acceleration, km/s², at a position in the Earth-fixed frame, km (Montenbruck & Gill, *Satellite
    /// Orbits*, 2000, Eq. 3.29–3.33, after Cunningham 1970).
    pub(super) fn acceleration(&mut self, position_km: &Vector3<f64>) -> Vector3<f64> {
        let square = position_km.norm_squared();
        let scaled = position_km * (EGM96_RADIUS_KM / square);
        let (x, y, z) = (scaled.x, scaled.y, scaled.z);
        let rho = EGM96_RADIUS_KM * EGM96_RADIUS_KM / square;
        let top = self.degree + 1;
        let orders = (self.order + 1).min(top);
        let (solids, factors) = (&mut self.solids, &self.factors);

        solids[0] = [EGM96_RADIUS_KM / square.sqrt(), 0.0];
        for m in 0..=orders {
            if m > 0 {
                let [v, w] = solids[at(m - 1, m - 1)];
                let odd = (2 * m - 1) as f64;
                solids[at(m, m)] = [odd * (x * v - y * w), odd * (x * w + y * v)];
            }
            let (mut before, mut last) = ([0.0; 2], solids[at(m, m)]);
            for n in m + 1..=top {
                let [a, b] = factors[at(n, m)];
                let (up, down) = (a * z, b * rho);
                let next = [up * last[0] - down * before[0], up * last[1] - down * before[1]];
                (before, last) = (last, next);
                solids[at(n, m)] = next;
            }
        }

        let mut sum = Vector3::zeros();
        // From the smallest terms to the largest.
        for n in (0..=self.degree).rev() {
            for m in (0..=self.order.min(n)).rev() {
                let [c, s] = self.coefficients[at(n, m)];
                let [v_up, w_up] = solids[at(n + 1, m + 1)];
                let [v, w] = solids[at(n + 1, m)];
                let below = (n - m + 1) as f64;
                if m == 0 {
                    sum += Vector3::new(-c * v_up, -c * w_up, -c * v * below);
                } else {
                    let [v_down, w_down] = solids[at(n + 1, m - 1)];
                    let product = below * (below + 1.0);
                    sum += Vector3::new(
                        0.5 * (product * (c * v_down + s * w_down) - c * v_up - s * w_up),
                        0.5 * (product * (s * v_down - c * w_down) - c * w_up + s * v_up),
                        below * (-c * v - s * w),
                    );
                }
            }
        }
        sum * (EARTH_GM_KM3_S2 / (EGM96_RADIUS_KM * EGM96_RADIUS_KM))
    }
}

/// Factor from a normalised coefficient to the coefficient, √((2 − δ₀ₘ)(2n + 1)(n − m)!/(n + m)!).
fn normalisation(n: usize, m: usize) -> f64 {
    let ratio: f64 = (n - m + 1..=n + m).map(|k| 1.0 / k as f64).product();
    let double = if m == 0 { 1.0 } else { 2.0 };
    (double * (2 * n + 1) as f64 * ratio).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::orbit::EARTH_J2;

    /// Potential without its recursion: Legendre functions by their definition for the low degrees.
    fn zonal_potential(position_km: &Vector3<f64>) -> f64 {
        let r = position_km.norm();
        let s = position_km.z / r;
        let ratio = EGM96_RADIUS_KM / r;
        let p2 = 1.5 * s * s - 0.5;
        EARTH_GM_KM3_S2 / r * (1.0 - EARTH_J2 * ratio * ratio * p2)
    }

    fn gradient(potential: impl Fn(&Vector3<f64>) -> f64, position_km: &Vector3<f64>) -> Vector3<f64> {
        let step_km = 1.0;
        Vector3::from_fn(|axis, _| {
            let mut offset = Vector3::zeros();
            offset[axis] = step_km;
            (potential(&(position_km + offset)) - potential(&(position_km - offset))) / (2.0 * step_km)
        })
    }

    const POSITION_KM: [f64; 3] = [4100.0, -2800.0, 5100.0];

    #[test]
    fn degree_zero_is_the_point_mass() {
        let position = Vector3::from(POSITION_KM);
        let r = position.norm();
        let expected = position * (-EARTH_GM_KM3_S2 / (r * r * r));
        let got = GravityField::new(0, 0).acceleration(&position);
        assert!((got - expected).norm() < 1e-17, "{got}");
    }

    #[test]
    fn degree_two_is_the_gradient_of_the_oblate_earth() {
        let position = Vector3::from(POSITION_KM);
        let expected = gradient(zonal_potential, &position);
        let got = GravityField::new(2, 0).acceleration(&position);
        // The difference quotient has an error of h²/6 r⁻³ GM/r: 2e-8 of 8e-3 km/s², and 1e-12 by rounding.
        assert!((got - expected).norm() < 5e-10, "{got} {expected}");
    }

    /// Without sources outside the Earth the field has no divergence and no curl.
    #[test]
    fn the_field_has_no_divergence_and_no_curl() {
        let mut field = GravityField::new(MAX_DEGREE, MAX_DEGREE);
        let mut point = GravityField::new(0, 0);
        let position = Vector3::from(POSITION_KM);
        let mut rows = [Vector3::zeros(); 3];
        for (axis, row) in rows.iter_mut().enumerate() {
            let mut offset = Vector3::zeros();
            offset[axis] = 0.5;
            let mut anomaly =
                |position: Vector3<f64>| field.acceleration(&position) - point.acceleration(&position);
            *row = anomaly(position + offset) - anomaly(position - offset);
        }
        // Second derivatives of the anomaly are near 1e-8 s⁻²; the difference quotient is accurate to 1e-6 of
        // them, and to 1e-15 by rounding.
        let [x, y, z] = rows;
        let largest = x.norm().max(y.norm()).max(z.norm());
        assert!(largest > 1e-9, "{largest}");
        assert!((x.x + y.y + z.z).abs() < 2e-6 * largest);
        for twist in [x.y - y.x, y.z - z.y, z.x - x.z] {
            assert!(twist.abs() < 2e-6 * largest, "{twist} {largest}");
        }
    }

    #[test]
    fn the_table_is_egm96() {
        let field = GravityField::new(MAX_DEGREE, MAX_DEGREE);
        // J2, J3, J4 (Vallado, 4th edition, Table D-1); C22 of JGM-3 (Montenbruck & Gill, Table 3.2), which
        // differs by 5e-5.
        let j = |n: usize| -field.coefficients[at(n, 0)][0];
        assert!((j(2) / EARTH_J2 - 1.0).abs() < 1e-9);
        assert!((j(3) / -2.532_656_485_3e-6 - 1.0).abs() < 1e-9);
        assert!((j(4) / -1.619_621_591_4e-6 - 1.0).abs() < 1e-9);
        assert!((field.coefficients[at(2, 2)][0] / 1.574_536_03e-6 - 1.0).abs() < 1e-4);
    }
}
