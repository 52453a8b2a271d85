//! The normal distribution from a table: the profile of a blurred edge.

/// Beyond this the integral is 0 or 1 to 4e-8.
pub(super) const LIMIT: f64 = 5.4;

/// Nodes a unit. The series about the nearest node is then good to 2e-9.
const NODES: f64 = 32.0;

/// Φ and φ, tabulated.
#[derive(Debug, Clone)]
pub(super) struct Gaussian {
    nodes: Vec<(f64, f64)>,
}

impl Gaussian {
    pub(super) fn new() -> Self {
        let last = (2.0 * LIMIT * NODES).ceil() as usize + 1;
        let nodes = (0..=last)
            .map(|k| {
                let z = k as f64 / NODES - LIMIT;
                let density = libm::exp(-0.5 * z * z) / std::f64::consts::TAU.sqrt();
                (0.5 * libm::erfc(-z * std::f64::consts::FRAC_1_SQRT_2), density)
            })
            .collect();
        Self { nodes }
    }

    /// (Φ(z), φ(z)).
    pub(super) fn at(&self, z: f64) -> (f64, f64) {
        if z >= LIMIT {
            return (1.0, 0.0);
        }
        // Also what is not a number.
        if z.is_nan() || z <= -LIMIT {
            return (0.0, 0.0);
        }
        let k = ((z + LIMIT) * NODES + 0.5) as u32;
        let at = f64::from(k) / NODES - LIMIT;
        let (below, density) = self.nodes[k as usize];
        let d = z - at;
        let second = at * at - 1.0;
        (
            below + density * d * (1.0 + d * (-0.5 * at + d * second / 6.0)),
            density * (1.0 + d * (-at + d * (0.5 * second - d * at * (at * at - 3.0) / 6.0))),
        )
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
            let (below, density) = table.at(z);
            assert!((below - 0.5 * libm::erfc(-z / 2f64.sqrt())).abs() < 5e-8, "{z}");
            let exact = libm::exp(-0.5 * z * z) / std::f64::consts::TAU.sqrt();
            assert!((density - exact).abs() < 2e-7, "{z}");
        }
        assert_eq!(table.at(f64::NAN), (0.0, 0.0));
    }
}
