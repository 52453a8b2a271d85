//! Search for triangles of sources among the stars.

use contract::{CameraFrame, Direction, ListedStar};

use super::separations::{Neighbours, StarPairs};
use super::source::SOURCE_SIGMA_PX;
use crate::CameraModel;

/// Largest error of the separation of two sources, px: three standard deviations.
const SEPARATION_TOLERANCE_PX: f64 = 3.0 * std::f64::consts::SQRT_2 * SOURCE_SIGMA_PX;

/// Smallest height of a triangle, px. Below it, the orientation is uncertain and the attitude imprecise.
const MIN_HEIGHT_PX: f64 = 5.0;

/// Returns all triples of 0..n in an order that quickly leaves a source that is not a star: neighbours in
/// brightness first, the first source changing fastest (Mortari et al. 2004, Eq. 20).
pub(super) fn pyramid_order(n: usize) -> impl Iterator<Item = [usize; 3]> {
    (1..n.saturating_sub(1)).flat_map(move |dj| {
        (1..n - dj).flat_map(move |dk| (0..n - dj - dk).map(move |i| [i, i + dj, i + dj + dk]))
    })
}

/// Shape of three sources at a focal length.
#[derive(Debug, Clone, Copy)]
pub(super) struct Shape {
    /// Chords of the sides opposite to the sources.
    sides: [f64; 3],
    /// Triple product of the directions: its sign is the sense of rotation.
    turn: f64,
}

impl Shape {
    pub(super) fn new(corners: [Direction<CameraFrame>; 3]) -> Self {
        let chord = |a: usize, b: usize| (corners[a].vector() - corners[b].vector()).norm();
        let turn = turn_of(corners.each_ref().map(|corner| corner.vector()));
        Self { sides: [chord(1, 2), chord(2, 0), chord(0, 1)], turn }
    }
}

/// Returns the triple product of three vectors.
fn turn_of([a, b, c]: [&nalgebra::Vector3<f64>; 3]) -> f64 {
    a.dot(&b.cross(c))
}

/// Search for triangles of sources among the stars, with its buffers.
pub(super) struct TriangleSearch<'a> {
    stars: &'a [ListedStar],
    pairs: &'a StarPairs,
    /// Tolerance of a chord, taken as an angle, which is larger than the change of its chord.
    tolerance: f64,
    least_height: f64,
    visited: usize,
    /// Index of the last link of each star, NONE before and after a search.
    last: Vec<u32>,
    links: Vec<Link>,
}

/// Star at the required separation from another star, in a chain of such stars.
struct Link {
    from: u32,
    to: u32,
    before: u32,
}

const NONE: u32 = u32::MAX;

impl<'a> TriangleSearch<'a> {
    pub(super) fn new(stars: &'a [ListedStar], pairs: &'a StarPairs, model: &CameraModel) -> Self {
        let (fx, fy) = model.focal_px();
        let focal_px = fx.min(fy);
        Self {
            stars,
            pairs,
            tolerance: SEPARATION_TOLERANCE_PX / focal_px,
            least_height: MIN_HEIGHT_PX / focal_px,
            visited: 0,
            last: vec![NONE; stars.len()],
            links: Vec::new(),
        }
    }

    /// Returns the largest difference of the separations of two sources and their stars, as a chord.
    pub(super) fn tolerance(&self) -> f64 {
        self.tolerance
    }

    /// Returns the number of star pairs visited so far.
    pub(super) fn visited(&self) -> usize {
        self.visited
    }

    /// Returns the triples of star indices that have the separations of the corners and their sense of
    /// rotation.
    pub(super) fn matching_triples(&mut self, corners: [Direction<CameraFrame>; 3]) -> Vec<[u32; 3]> {
        let chord = |a: usize, b: usize| (corners[a].vector() - corners[b].vector()).norm();
        // Sides opposite to the corners.
        let sides = [chord(1, 2), chord(2, 0), chord(0, 1)];
        let longest = sides.into_iter().fold(0.0, f64::max);
        let seen = turn_of([0, 1, 2].map(|corner| corners[corner].vector()));
        // Height: twice the area over the base.
        if longest > self.pairs.largest_chord() + self.tolerance || seen.abs() < self.least_height * longest {
            return Vec::new();
        }
        let windows = sides.map(|side| self.pairs.within(side, self.tolerance));
        // The corner opposite to the side with the most pairs joins the other two.
        let joint = (0..3).max_by_key(|&corner| windows[corner].len()).unwrap_or(0);
        let (second, third) = ((joint + 1) % 3, (joint + 2) % 3);
        self.visited += windows[second].len() + windows[third].len();
        self.link(windows[third]);
        let mut found = Vec::new();
        for pair in windows[second] {
            for [at_joint, at_third] in [pair.stars, [pair.stars[1], pair.stars[0]]] {
                let mut next = self.last[at_joint as usize];
                while let Some(link) = self.links.get(next as usize) {
                    let mut stars = [0; 3];
                    stars[joint] = at_joint;
                    stars[second] = link.to;
                    stars[third] = at_third;
                    let directions = stars.map(|star| self.stars[star as usize].direction);
                    let [_, b, c] = [joint, second, third].map(|corner| directions[corner]);
                    if ((b.vector() - c.vector()).norm() - sides[joint]).abs() <= self.tolerance
                        && turn_of(directions.each_ref().map(|direction| direction.vector())) * seen > 0.0
                    {
                        found.push(stars);
                    }
                    next = link.before;
                }
            }
        }
        for link in self.links.drain(..) {
            self.last[link.from as usize] = NONE;
        }
        found
    }

    /// Returns the triples of star indices that have the shape of three sources and their sense of rotation,
    /// each with the index of the focal length nearest to it. `shapes` are those of the sources at increasing
    /// focal lengths.
    ///
    /// Each pair of stars at the shortest side gives the focal length, and with it the other two sides within
    /// narrow limits.
    pub(super) fn similar_triples(
        &mut self,
        shapes: &[Shape],
        neighbours: &Neighbours,
    ) -> Vec<(usize, [u32; 3])> {
        let (Some(longest_focal), Some(shortest_focal)) = (shapes.last(), shapes.first()) else {
            return Vec::new();
        };
        // The corner opposite to the longest side joins the other two.
        let mut order = [0, 1, 2];
        order.sort_by(|&a, &b| longest_focal.sides[a].total_cmp(&longest_focal.sides[b]));
        let [base, second, joint] = order;
        let largest = self.pairs.largest_chord() + self.tolerance;
        if longest_focal.sides[joint] > largest
            || longest_focal.turn.abs() < self.least_height * longest_focal.sides[joint]
        {
            return Vec::new();
        }
        let between = (longest_focal.sides[base], shortest_focal.sides[base]);
        let window = self.pairs.between(between.0 - self.tolerance, between.1 + self.tolerance);
        self.visited += window.len();
        let mut found = Vec::new();
        // Chords increase in the window, and with them the focal length decreases.
        let mut index = shapes.len() - 1;
        for pair in window {
            let chord = f64::from(pair.chord);
            let distance = |index: usize| (shapes[index].sides[base] - chord).abs();
            while index > 0 && distance(index - 1) <= distance(index) {
                index -= 1;
            }
            let Shape { sides, turn } = &shapes[index];
            if sides[joint] > largest {
                break;
            }
            // An error of the base is one of the focal length, and of the other sides. Chords are inversely
            // proportional to the focal length but for the square of the field.
            let size = chord / sides[base];
            let of_base = self.tolerance / sides[base];
            let of_base = of_base * (1.0 + sides[joint] * sides[joint]);
            let limits = [second, joint].map(|side| self.tolerance + sides[side] * of_base);
            // The base joins the joint and the corner opposite to the second side.
            for [at_joint, at_second] in [pair.stars, [pair.stars[1], pair.stars[0]]] {
                let joined = neighbours.within(at_joint, sides[second] * size, limits[0]);
                self.visited += joined.len();
                for neighbour in joined {
                    let directions =
                        [at_joint, at_second, neighbour.star].map(|star| self.stars[star as usize].direction);
                    let [_, b, c] = &directions;
                    if ((b.vector() - c.vector()).norm() - sides[joint] * size).abs() > limits[1] {
                        continue;
                    }
                    let mut stars = [0; 3];
                    (stars[joint], stars[second], stars[base]) = (at_joint, at_second, neighbour.star);
                    let directions = stars.map(|star| self.stars[star as usize].direction);
                    if turn_of(directions.each_ref().map(|direction| direction.vector())) * turn > 0.0 {
                        found.push((index, stars));
                    }
                }
            }
        }
        found
    }

    /// Chains, for each star, the stars paired with it.
    fn link(&mut self, pairs: &[super::separations::StarPair]) {
        for pair in pairs {
            for [from, to] in [pair.stars, [pair.stars[1], pair.stars[0]]] {
                let last = &mut self.last[from as usize];
                let before = std::mem::replace(last, self.links.len() as u32);
                self.links.push(Link { from, to, before });
            }
        }
    }
}
