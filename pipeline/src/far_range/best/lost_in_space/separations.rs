//! Star pairs in order of their separation.

use contract::ListedStar;

use super::selection::Grid;

/// Indices of two stars, and their separation.
#[derive(Debug, Clone, Copy)]
pub(super) struct StarPair {
    /// Chord between the directions, 2 sin(θ/2).
    chord: f32,
    pub(super) stars: [u32; 2],
}

/// All pairs of stars up to a separation, in order of separation.
#[derive(Debug)]
pub(super) struct StarPairs(Vec<StarPair>);

/// Number of pairs of the list for a uniformly filled sky, 12 bytes each. With many stars, wide pairs are
/// omitted.
const MAX_PAIRS: f64 = 1_000_000.0;

impl StarPairs {
    /// Creates the list of pairs of stars whose chord is at most `largest_chord`, 0 to 2, or smaller if
    /// limited by memory.
    pub(super) fn new(stars: &[ListedStar], largest_chord: f64) -> Self {
        // A cap of chord c covers the share c²/4 of the sphere, so N stars have N² c²/8 pairs.
        let affordable = (8.0 * MAX_PAIRS).sqrt() / stars.len().max(1) as f64;
        let largest = largest_chord.min(affordable);
        let mut grid = Grid::new(largest);
        let mut pairs = Vec::new();
        for (star, number) in stars.iter().zip(0..) {
            let direction = star.direction.vector();
            grid.near(direction, largest, |other, chord| {
                pairs.push(StarPair { chord: chord as f32, stars: [other, number] });
                true
            });
            grid.push(*direction);
        }
        pairs.sort_unstable_by(|a: &StarPair, b| a.chord.total_cmp(&b.chord).then(a.stars.cmp(&b.stars)));
        Self(pairs)
    }

    /// Returns the pairs whose chord differs by at most `tolerance` from `chord`.
    pub(super) fn within(&self, chord: f64, tolerance: f64) -> &[StarPair] {
        let before = |limit: f64| self.0.partition_point(|pair| f64::from(pair.chord) < limit);
        self.0.get(before(chord - tolerance)..before(chord + tolerance)).unwrap_or_default()
    }

    /// Returns the largest chord of the list; 0 without pairs.
    pub(super) fn largest_chord(&self) -> f64 {
        self.0.last().map_or(0.0, |pair| f64::from(pair.chord))
    }
}
