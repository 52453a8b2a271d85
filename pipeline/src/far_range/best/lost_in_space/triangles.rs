//! Search for triangles of sources among the stars.

use contract::{CameraFrame, Direction, ListedStar};

use super::separations::StarPairs;
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
    /// rotation. Each separation may also differ by the share `slack`, 0 for a known focal length.
    pub(super) fn matching_triples(
        &mut self,
        corners: [Direction<CameraFrame>; 3],
        slack: f64,
    ) -> Vec<[u32; 3]> {
        let chord = |a: usize, b: usize| (corners[a].vector() - corners[b].vector()).norm();
        // Sides opposite to the corners.
        let sides = [chord(1, 2), chord(2, 0), chord(0, 1)];
        let longest = sides.into_iter().fold(0.0, f64::max);
        let turn = |[a, b, c]: [&nalgebra::Vector3<f64>; 3]| a.dot(&b.cross(c));
        let seen = turn([0, 1, 2].map(|corner| corners[corner].vector()));
        // Height: twice the area over the base.
        if longest > self.pairs.largest_chord() + self.tolerance + slack * longest
            || seen.abs() < self.least_height * longest
        {
            return Vec::new();
        }
        let windows = sides.map(|side| self.pairs.within(side, self.tolerance + slack * side));
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
                    if ((b.vector() - c.vector()).norm() - sides[joint]).abs()
                        <= self.tolerance + slack * sides[joint]
                        && turn(directions.each_ref().map(|direction| direction.vector())) * seen > 0.0
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
