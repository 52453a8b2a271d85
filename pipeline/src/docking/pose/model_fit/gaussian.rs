//! CumulativeFlux normal distribution: the profile of a blurred edge.

/// Limit of |z| beyond which the integral is 0 or 1 to 4e-8.
pub(super) const LIMIT: f64 = 5.4;

/// Number of nodes per unit. The series about the nearest node is then accurate to 2e-9.
const NODES: f64 = 32.0;

/// Size of the table: a power of two, so an index needs no bounds check. 347 entries are used.
const TABLE: usize = 512;

/// Number whose addition to a number below 2^51 leaves the nearest integer in the last bits.
pub(super) const WHOLE: f64 = 6_755_399_441_055_744.0;

/// CumulativeFlux Φ and φ.
#[derive(Debug, Clone)]
pub(super) struct Gaussian {
    nodes: Box<[(f64, f64); TABLE]>,
}

impl Gaussian {
    pub(super) fn new() -> Self {
        let mut nodes = Box::new([(0.0, 0.0); TABLE]);
        for (k, node) in nodes.iter_mut().enumerate() {
            let z = k as f64 / NODES - LIMIT;
            let density = libm::exp(-0.5 * z * z) / std::f64::consts::TAU.sqrt();
            *node = (0.5 * libm::erfc(-z * std::f64::consts::FRAC_1_SQRT_2), density);
        }
        Self { nodes }
    }

    /// Returns (Φ(z), φ(z)).
    pub(super) fn cdf_and_pdf(&self, z: f64) -> (f64, f64) {
        if z >= LIMIT {
            return (1.0, 0.0);
        }
        // NaN also gives zero.
        if z.is_nan() || z <= -LIMIT {
            return (0.0, 0.0);
        }
        let ([below], [density]) = self.cdfs_and_pdfs([z]);
        (below, density)
    }

    /// Returns (Φ, φ) of numbers within the limits. Numbers outside are clamped to the nearest limit, NaN to
    /// the lower one.
    #[inline(always)]
    pub(super) fn cdfs_and_pdfs<const N: usize>(&self, z: [f64; N]) -> ([f64; N], [f64; N]) {
        let (mut from_node, mut at, mut node_index) = ([0.0; N], [0.0; N], [0; N]);
        for l in 0..N {
            let low = if z[l] > -LIMIT { z[l] } else { -LIMIT };
            let z = if low < LIMIT { low } else { LIMIT };
            let whole = (z + LIMIT) * NODES + WHOLE;
            node_index[l] = whole.to_bits();
            at[l] = (whole - WHOLE) / NODES - LIMIT;
            from_node[l] = z - at[l];
        }
        let (mut below, mut density) = ([0.0; N], [0.0; N]);
        for l in 0..N {
            (below[l], density[l]) = self.nodes[node_index[l] as usize % TABLE];
        }
        for l in 0..N {
            let (at, d) = (at[l], from_node[l]);
            let second = at * at - 1.0;
            below[l] += density[l] * d * (1.0 + d * (-0.5 * at + d * second / 6.0));
            density[l] *= 1.0 + d * (-at + d * (0.5 * second - d * at * (at * at - 3.0) / 6.0));
        }
        (below, density)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_table_is_the_function() {
        let table = Gaussian::new();
        for k in -6000..6000 {
            let z = f64::from(k) * 1.003e-3;
            let (below, density) = table.cdf_and_pdf(z);
            assert!((below - 0.5 * libm::erfc(-z / 2f64.sqrt())).abs() < 5e-8, "{z}");
            let exact = libm::exp(-0.5 * z * z) / std::f64::consts::TAU.sqrt();
            assert!((density - exact).abs() < 2e-7, "{z}");
        }
        assert_eq!(table.cdf_and_pdf(f64::NAN), (0.0, 0.0));
    }
}
