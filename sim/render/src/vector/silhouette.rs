//! Outline of the side of a body that faces a light, or of the side that faces away.
//!
//! Where two facets of that side meet, their shared edge occurs once in each direction: the two edges
//! together cover nothing, and both are omitted. The remaining edges close to polygons, regardless of how
//! they are joined where more than two edges meet.

use std::ops::Range;

use nalgebra::Vector3;
use scene::docking::Part;

use super::loops::Loops;

/// Edges of a part's facets, as indices of their ends in a list of the part's corners.
#[derive(Debug, Clone, Default)]
pub(super) struct FacetEdges {
    corners: Vec<Vector3<f64>>,
    /// Edges as corner indices [from, to]; holes run in the opposite sense to outer boundaries.
    edges: Vec<[u32; 2]>,
    /// For each edge, the edge that runs along it in the opposite direction.
    opposite: Vec<Option<u32>>,
    /// Range of the edges of each facet.
    of_facet: Vec<Range<usize>>,
}

impl FacetEdges {
    /// Collects the edges of a part; corners are identical if their coordinates have the same bits.
    pub(super) fn from_part(part: &Part) -> Self {
        let mut outlines = Self::default();
        let key = |corner: &Vector3<f64>| [corner.x.to_bits(), corner.y.to_bits(), corner.z.to_bits()];
        let mut indices = std::collections::BTreeMap::new();
        for facet in &part.facets {
            let start = outlines.edges.len();
            for polygon in std::iter::once(&facet.outer).chain(&facet.holes) {
                for (from, to) in polygon.iter().zip(polygon.iter().cycle().skip(1)) {
                    let edge = [from, to].map(|corner| {
                        *indices.entry(key(corner)).or_insert_with(|| {
                            outlines.corners.push(*corner);
                            (outlines.corners.len() - 1) as u32
                        })
                    });
                    outlines.edges.push(edge);
                }
            }
            outlines.of_facet.push(start..outlines.edges.len());
        }
        // If several edges connect two corners, each is paired with a different partner.
        let mut single = std::collections::BTreeMap::<[u32; 2], Vec<u32>>::new();
        outlines.opposite = vec![None; outlines.edges.len()];
        for (index, [from, to]) in outlines.edges.iter().enumerate() {
            if let Some(other) = single.get_mut(&[*to, *from]).and_then(Vec::pop) {
                outlines.opposite[index] = Some(other);
                outlines.opposite[other as usize] = Some(index as u32);
            } else {
                single.entry([*from, *to]).or_default().push(index as u32);
            }
        }
        outlines
    }
}

/// Outline of some facets of a part: closed polygons, not planar in general, in the sense of the facets'
/// boundaries.
#[derive(Debug, Clone, Default)]
pub(super) struct Silhouette {
    pub(super) loops: Loops,
    /// The polygon under construction.
    points: Vec<Vector3<f64>>,
    chosen: Vec<bool>,
    /// For each corner, the edges of the outline that leave it and have not been traversed.
    leaving: Vec<Vec<u32>>,
}

impl Silhouette {
    /// Finds the outline of the facets for whose index in the part `is_chosen` returns true.
    pub(super) fn find(&mut self, facets: &FacetEdges, is_chosen: impl Fn(usize) -> bool) {
        self.loops.clear();
        self.chosen.clear();
        self.chosen.resize(facets.edges.len(), false);
        for (index, edges) in facets.of_facet.iter().enumerate() {
            self.chosen[edges.clone()].fill(is_chosen(index));
        }
        self.leaving.resize_with(facets.corners.len(), Vec::new);
        self.leaving.iter_mut().for_each(Vec::clear);
        // In reverse order, to put the first edge of a corner at the end of its list.
        for (index, [from, _]) in facets.edges.iter().enumerate().rev() {
            let shared = facets.opposite[index].is_some_and(|other| self.chosen[other as usize]);
            if self.chosen[index] && !shared {
                self.leaving[*from as usize].push(index as u32);
            }
        }
        for start in 0..facets.corners.len() {
            while let Some(first) = self.leaving[start].pop() {
                let mut next = Some(first);
                self.points.clear();
                // Each corner has as many outgoing as incoming edges; the path therefore ends where it began.
                while let Some(edge) = next {
                    let [from, to] = facets.edges[edge as usize].map(|corner| corner as usize);
                    self.points.push(facets.corners[from]);
                    next = if to == start { None } else { self.leaving[to].pop() };
                }
                self.loops.push(self.points.drain(..));
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use scene::docking::TargetFile;

    fn area(polygon: &[Vector3<f64>]) -> Vector3<f64> {
        let origin = polygon[0];
        let next = polygon.iter().cycle().skip(1);
        polygon.iter().zip(next).map(|(a, b)| 0.5 * (a - origin).cross(&(b - origin))).sum()
    }

    #[test]
    fn a_silhouette_has_the_projected_area_of_the_facets_and_fewer_edges() {
        let scene = TargetFile::built_in("progress").unwrap().scene();
        let light = Vector3::new(0.3, 0.5, 0.8).normalize();
        let (mut all, mut left) = (0, 0);
        for part in &scene.parts {
            let lit = |facet: &scene::docking::Facet| facet.normal.dot(&light) > 0.0;
            let mut silhouette = Silhouette::default();
            silhouette.find(&FacetEdges::from_part(part), |index| lit(&part.facets[index]));
            let facets = part.facets.iter().filter(|facet| lit(facet));
            let polygons = facets.flat_map(|facet| std::iter::once(&facet.outer).chain(&facet.holes));
            let whole: f64 = polygons
                .map(|polygon| {
                    all += polygon.len();
                    area(polygon).dot(&light)
                })
                .sum();
            let outline: f64 = (0..silhouette.loops.len())
                .map(|index| {
                    let corners = silhouette.loops.stretches(index).flat_map(|(_, points)| points).copied();
                    let polygon: Vec<_> = corners.collect();
                    left += polygon.len();
                    area(&polygon).dot(&light)
                })
                .sum();
            // Rounding for areas of up to 10³ m² from corners at up to 60 m.
            assert!((whole - outline).abs() < 1e-10 * (1.0 + whole), "{}: {whole} {outline}", part.name);
        }
        assert!(left < all, "{left} of {all}");
    }
}
