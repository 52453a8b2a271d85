//! Positions of the draws of a case in the unit cube.

use draws::{Effect, Seed, uniform};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::sobol::direction_numbers;

/// Method of spreading the dispersed parameters over their distributions.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum DesignKind {
    /// Every case is an independent draw: the plain Monte Carlo method, whose intervals are those of
    /// independent draws.
    #[default]
    Random,
    /// Latin hypercube (McKay, Beckman & Conover 1979): each parameter's distribution is cut into as many
    /// equally likely parts as there are cases, and each part has one case.
    LatinHypercube,
    /// Sobol's sequence with the direction numbers of Joe & Kuo (2008), with a digital shift derived from the
    /// seed; works best when the number of cases is a power of two.
    Sobol,
    /// Design of Saltelli et al. (2010) for Sobol indices: N points A, N points B, and, for each of d
    /// parameters, N points A with this parameter taken from B; N (d + 2) cases.
    Saltelli,
}

/// Largest number of dimensions of a low-discrepancy design.
const MAX_DIMENSIONS: usize = 100;

/// Factor that maps a number of 53 bits to the unit interval.
const UNIT: f64 = 1.0 / 9_007_199_254_740_992.0;

/// Points of a study's cases in the unit cube.
pub(crate) struct Design {
    kind: DesignKind,
    dimensions: usize,
    /// Number of points per replication.
    points: u64,
    /// Seed of the first replication; each further replication has a different one.
    seed: u64,
    /// Direction numbers of 64 bits, by dimension, then by bit.
    directions: Vec<[u64; 64]>,
}

impl Design {
    /// Creates a design with a given number of points per replication; the random design has no limit on the
    /// number of points.
    ///
    /// # Errors
    /// The expected value, for a number of points or dimensions that the design cannot have.
    pub(crate) fn new(kind: DesignKind, dimensions: usize, points: u64, seed: u64) -> Result<Self, String> {
        let of_sequence = match kind {
            DesignKind::Random | DesignKind::LatinHypercube => 0,
            DesignKind::Sobol => dimensions,
            DesignKind::Saltelli => 2 * dimensions,
        };
        if of_sequence > MAX_DIMENSIONS {
            return Err(format!(
                "a design of at most {MAX_DIMENSIONS} dimensions; this design has {of_sequence}"
            ));
        }
        if kind == DesignKind::Saltelli && (dimensions == 0 || !points.is_multiple_of(dimensions as u64 + 2))
        {
            return Err(format!("a multiple of {}, the number of parameters plus two", dimensions + 2));
        }
        Ok(Self { kind, dimensions, points, seed, directions: direction_numbers(of_sequence) })
    }

    /// Returns the point with a given number, from 0: one number of the open unit interval per dimension.
    ///
    /// Replications follow one another: each is a design of the same kind with a different seed.
    pub(crate) fn point(&self, number: u64) -> Vec<f64> {
        let all = 0..self.dimensions;
        let (replication, number) = (number / self.points, number % self.points);
        let seed = match replication {
            0 => self.seed,
            _ => Seed { seed: self.seed, case: replication }.streams(2, Effect::StudyDesign).word(0),
        };
        match self.kind {
            DesignKind::Random => all.map(|dimension| draw(seed, number, dimension)).collect(),
            DesignKind::LatinHypercube => all
                .map(|dimension| {
                    let stratum = self.shuffled(seed, number, dimension);
                    // Keeps the smallest distance from the ends that a number of 53 bits can have.
                    ((stratum as f64 + draw(seed, number, dimension)) / self.points as f64)
                        .clamp(0.5 * UNIT, 1.0 - 0.5 * UNIT)
                })
                .collect(),
            DesignKind::Sobol => all.map(|dimension| self.sobol(seed, number, dimension)).collect(),
            DesignKind::Saltelli => {
                let block = self.dimensions as u64 + 2;
                let (base, member) = (number / block, (number % block) as usize);
                all.map(|dimension| {
                    let is_of_b = member == 1 || member == dimension + 2;
                    self.sobol(seed, base, if is_of_b { self.dimensions + dimension } else { dimension })
                })
                .collect()
            }
        }
    }

    /// Returns a coordinate of a shifted Sobol point. Points are in the order of the sequence's Gray code,
    /// the XOR of one direction number per set bit; the XOR with a random word preserves the uniformity of
    /// the sequence.
    #[allow(clippy::indexing_slicing, reason = "there are directions for every dimension of the study")]
    fn sobol(&self, seed: u64, number: u64, dimension: usize) -> f64 {
        let gray = number ^ (number >> 1);
        let directions = &self.directions[dimension];
        let point = directions
            .iter()
            .enumerate()
            .filter(|(bit, _)| gray >> bit & 1 == 1)
            .fold(0, |point, (_, direction)| point ^ direction);
        let shift = shift(seed, dimension);
        (((point ^ shift) >> 11) as f64 + 0.5) * UNIT
    }

    /// Returns the position of `number` in a pseudorandom permutation of 0 to `points`, one permutation per
    /// dimension: a Feistel network over the next even number of bits, repeated while its result is not below
    /// `points` (Black & Rogaway 2002, cycle walking). Each case is therefore computed without the other
    /// cases.
    fn shuffled(&self, seed: u64, number: u64, dimension: usize) -> u64 {
        let bits = u64::BITS - (self.points.max(2) - 1).leading_zeros();
        let half = bits.div_ceil(2);
        let mask = (1u64 << half) - 1;
        let streams = Seed { seed, case: dimension as u64 }.streams(1, Effect::StudyDesign);
        let mut at = number;
        loop {
            let (mut left, mut right) = (at >> half, at & mask);
            for round in 0..4 {
                let mixed = streams.word((round << 32) | right) & mask;
                (left, right) = (right, left ^ mixed);
            }
            at = (left << half) | right;
            if at < self.points {
                return at;
            }
        }
    }
}

fn draw(seed: u64, number: u64, dimension: usize) -> f64 {
    uniform(&mut Seed { seed, case: number }.stream(0, Effect::StudyParameter, dimension as u64))
}

/// Returns the random word that shifts a dimension of Sobol's sequence.
fn shift(seed: u64, dimension: usize) -> u64 {
    Seed { seed, case: 0 }.streams(0, Effect::StudyDesign).word(dimension as u64)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn design(kind: DesignKind, dimensions: usize, points: u64) -> Design {
        Design::new(kind, dimensions, points, 7).unwrap()
    }

    #[test]
    fn a_latin_hypercube_has_one_case_in_every_part() {
        for points in [1, 2, 7, 100, 1000] {
            let design = design(DesignKind::LatinHypercube, 3, points);
            for dimension in 0..3 {
                let mut parts: Vec<u64> =
                    (0..points).map(|k| (design.point(k)[dimension] * points as f64) as u64).collect();
                parts.sort_unstable();
                assert!(parts.into_iter().eq(0..points), "{points} points, dimension {dimension}");
            }
        }
    }

    /// Two dimensions of a Latin hypercube have independent permutations: their ranks are uncorrelated.
    #[test]
    fn dimensions_of_a_latin_hypercube_are_uncorrelated() {
        let n = 4000;
        let design = design(DesignKind::LatinHypercube, 2, n);
        let sum: f64 = (0..n).map(|k| design.point(k)).map(|p| (p[0] - 0.5) * (p[1] - 0.5)).sum();
        // The standard error of a correlation is 1/√n = 0.016; the tolerance is four of these.
        assert!((12.0 * sum / n as f64).abs() < 0.064, "{}", 12.0 * sum / n as f64);
    }

    /// scipy 1.17.1, `qmc.Sobol(d=3, scramble=False).random(8)`: the expected points before the shift.
    #[test]
    fn points_of_the_sequence_are_those_of_scipy() {
        let published = [
            [0.0, 0.0, 0.0],
            [0.5, 0.5, 0.5],
            [0.75, 0.25, 0.25],
            [0.25, 0.75, 0.75],
            [0.375, 0.375, 0.625],
            [0.875, 0.875, 0.125],
            [0.625, 0.125, 0.875],
            [0.125, 0.625, 0.375],
        ];
        let design = design(DesignKind::Sobol, 3, 8);
        for (k, expected) in published.iter().enumerate() {
            for (dimension, expected) in expected.iter().enumerate() {
                let bits = (expected / UNIT) as u64;
                let shifted = ((bits ^ (shift(7, dimension) >> 11)) as f64 + 0.5) * UNIT;
                assert_eq!(design.point(k as u64)[dimension], shifted, "point {k}, dimension {dimension}");
            }
        }
    }

    #[test]
    fn every_design_lies_in_the_open_unit_cube() {
        for kind in [DesignKind::Random, DesignKind::LatinHypercube, DesignKind::Sobol, DesignKind::Saltelli]
        {
            let design = design(kind, 2, 400);
            assert!((0..400).all(|k| design.point(k).iter().all(|u| *u > 0.0 && *u < 1.0)), "{kind:?}");
        }
    }

    #[test]
    fn a_case_of_saltelli_differs_from_a_in_one_parameter_which_is_that_of_b() {
        let design = design(DesignKind::Saltelli, 2, 40);
        for base in 0..10 {
            let [a, b, ab0, ab1] = [0, 1, 2, 3].map(|member| design.point(4 * base + member));
            assert_eq!(ab0, [b[0], a[1]]);
            assert_eq!(ab1, [a[0], b[1]]);
        }
    }

    #[test]
    fn a_replication_is_a_design_of_its_own() {
        for kind in [DesignKind::LatinHypercube, DesignKind::Sobol] {
            let design = design(kind, 2, 16);
            let of = |replication: u64| -> Vec<Vec<f64>> {
                (0..16).map(|k| design.point(16 * replication + k)).collect()
            };
            for replication in [0, 1, 5] {
                for dimension in 0..2 {
                    let part = |point: &Vec<f64>| (point[dimension] * 16.0) as u64;
                    let mut parts: Vec<u64> = of(replication).iter().map(part).collect();
                    parts.sort_unstable();
                    assert!(parts.into_iter().eq(0..16), "{kind:?}, replication {replication}");
                }
            }
            assert!(of(0) != of(1) && of(1) != of(2), "{kind:?}");
        }
    }

    #[test]
    fn an_impossible_design_is_reported_with_the_possible_ones() {
        assert!(Design::new(DesignKind::Saltelli, 3, 12, 0).is_err());
        assert!(Design::new(DesignKind::Sobol, 101, 12, 0).is_err());
    }
}
