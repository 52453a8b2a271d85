//! Direction numbers of Sobol's sequence.

/// Polynomials and initial numbers of the dimensions from the second on (Joe & Kuo 2008), a line each: number
/// of the dimension, degree s, coefficients a, initial numbers m1 … ms.
const TABLE: &str = include_str!("../../data/new-joe-kuo-6.100.txt");

/// Number of bits of a coordinate, and of direction numbers per dimension.
const BITS: usize = 64;

/// Returns the direction numbers of the first `dimensions` dimensions, at most 100: one per bit, the binary
/// point before the highest bit.
pub(super) fn direction_numbers(dimensions: usize) -> Vec<[u64; BITS]> {
    // The first dimension is van der Corput's sequence: v_k = 2⁻ᵏ.
    let mut first = [0; BITS];
    for (k, number) in first.iter_mut().enumerate() {
        *number = 1 << (BITS - 1 - k);
    }
    let mut all = vec![first];
    all.extend(TABLE.lines().filter(|line| !line.starts_with('#')).map(of_dimension));
    all.truncate(dimensions);
    all
}

/// Returns the direction numbers of the dimension that a line of the table describes.
fn of_dimension(line: &str) -> [u64; BITS] {
    let numbers: Vec<u64> = line.split_whitespace().skip(1).filter_map(|word| word.parse().ok()).collect();
    let [degree, coefficients, initial @ ..] = numbers.as_slice() else { return [0; BITS] };
    let degree = *degree as usize;
    let mut directions = [0; BITS];
    // v_k = m_k 2⁻ᵏ for k ≤ s.
    for (k, (number, m)) in directions.iter_mut().zip(initial).enumerate() {
        *number = m << (BITS - 1 - k);
    }
    // v_k = a_1 v_{k−1} ⊕ … ⊕ a_{s−1} v_{k−s+1} ⊕ v_{k−s} ⊕ (v_{k−s} / 2ˢ) for k > s.
    for k in degree..BITS {
        let oldest = directions.get(k - degree).copied().unwrap_or_default();
        let mut number = oldest ^ (oldest >> degree);
        for i in 1..degree {
            if coefficients >> (degree - 1 - i) & 1 == 1 {
                number ^= directions.get(k - i).copied().unwrap_or_default();
            }
        }
        if let Some(place) = directions.get_mut(k) {
            *place = number;
        }
    }
    directions
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Point 2²⁰ − 1 of scipy 1.17.1, `qmc.Sobol(d=100, scramble=False, bits=30)`, in some dimensions,
    /// times 2³⁰.
    const OF_SCIPY: [(usize, u64); 6] = [
        (1, 1_024),
        (2, 1_006_648_320),
        (3, 828_646_400),
        (11, 813_575_168),
        (51, 84_618_240),
        (100, 38_138_880),
    ];

    #[test]
    fn direction_numbers_of_all_dimensions_are_those_of_scipy() {
        let directions = direction_numbers(100);
        assert_eq!(directions.len(), 100);
        let number: u64 = (1 << 20) - 1;
        let gray = number ^ (number >> 1);
        for (dimension, expected) in OF_SCIPY {
            let point = (0..BITS)
                .filter(|bit| gray >> bit & 1 == 1)
                .fold(0, |point, bit| point ^ directions[dimension - 1][bit]);
            assert_eq!(point >> 34, expected, "dimension {dimension}");
        }
    }

    /// Every block of 2ᵏ points has one in each of the 2ᵏ equal parts, in each dimension.
    #[test]
    fn the_numbers_of_a_dimension_are_independent() {
        for (dimension, directions) in direction_numbers(100).iter().enumerate() {
            for (k, direction) in directions.iter().enumerate() {
                assert_eq!(direction.trailing_zeros() as usize, BITS - 1 - k, "dimension {dimension}");
            }
        }
    }
}
