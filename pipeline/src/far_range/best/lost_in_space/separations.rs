//! Star pairs in order of their separation.

use contract::ListedStar;

use super::selection::Grid;

/// Indices of two stars, and their separation.
#[derive(Debug, Clone, Copy)]
pub(super) struct StarPair {
    /// Chord between the directions, 2 sin(θ/2).
    pub(super) chord: f32,
    pub(super) stars: [u32; 2],
}

/// All pairs of stars up to a separation, in order of separation.
#[derive(Debug)]
pub(super) struct StarPairs(Vec<StarPair>);

/// Star beside another one, and their separation.
#[derive(Debug, Clone, Copy)]
pub(super) struct Neighbour {
    /// Chord between the directions.
    pub(super) chord: f32,
    pub(super) star: u32,
}

/// Neighbours of each star, in order of their separation.
#[derive(Debug, Default)]
pub(super) struct Neighbours {
    /// Index of the first neighbour of each star, and their number after the last.
    first: Vec<u32>,
    neighbours: Vec<Neighbour>,
}

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
        self.between(chord - tolerance, chord + tolerance)
    }

    /// Returns the pairs whose chord is from `shortest` to `longest`.
    pub(super) fn between(&self, shortest: f64, longest: f64) -> &[StarPair] {
        let before = |limit: f64| self.0.partition_point(|pair| f64::from(pair.chord) < limit);
        self.0.get(before(shortest)..before(longest)).unwrap_or_default()
    }

    /// Returns the largest chord of the list; 0 without pairs.
    pub(super) fn largest_chord(&self) -> f64 {
        self.0.last().map_or(0.0, |pair| f64::from(pair.chord))
    }
}

impl Neighbours {
    /// Creates the lists of the neighbours of `stars` stars from their pairs.
    pub(super) fn new(pairs: &StarPairs, stars: usize) -> Self {
        let mut first = vec![0_u32; stars + 1];
        for star in pairs.0.iter().flat_map(|pair| pair.stars) {
            first[star as usize + 1] += 1;
        }
        for star in 0..stars {
            first[star + 1] += first[star];
        }
        let mut next = first.clone();
        let mut neighbours = vec![Neighbour { chord: 0.0, star: 0 }; 2 * pairs.0.len()];
        // The pairs are in order of their chords, and so are the neighbours of every star.
        for pair in &pairs.0 {
            for [star, other] in [pair.stars, [pair.stars[1], pair.stars[0]]] {
                let place = &mut next[star as usize];
                neighbours[*place as usize] = Neighbour { chord: pair.chord, star: other };
                *place += 1;
            }
        }
        Self { first, neighbours }
    }

    /// Returns the neighbours of a star whose chord differs by at most `tolerance` from `chord`.
    pub(super) fn within(&self, star: u32, chord: f64, tolerance: f64) -> &[Neighbour] {
        let star = star as usize;
        let of_star = self.neighbours.get(self.first[star] as usize..self.first[star + 1] as usize);
        let of_star = of_star.unwrap_or_default();
        let from = first_from(of_star, (chord - tolerance) as f32);
        let rest = of_star.get(from..).unwrap_or_default();
        let count = rest.iter().take_while(|other| f64::from(other.chord) < chord + tolerance).count();
        rest.get(..count).unwrap_or_default()
    }
}

/// Returns the index of the first neighbour with a chord of at least `chord`. The search begins where it is
/// in a sky of even density, in which the number of neighbours grows with the square of the chord.
fn first_from(neighbours: &[Neighbour], chord: f32) -> usize {
    let Some(last) = neighbours.last() else { return 0 };
    let share = (chord / last.chord).clamp(0.0, 1.0);
    let mut index = ((share * share) * neighbours.len() as f32) as usize;
    while neighbours.get(index).is_some_and(|neighbour| neighbour.chord < chord) {
        index += 1;
    }
    while index > 0 && neighbours.get(index - 1).is_none_or(|neighbour| neighbour.chord >= chord) {
        index -= 1;
    }
    index.min(neighbours.len())
}
