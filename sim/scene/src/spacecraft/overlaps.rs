//! Facets that may lie in front of a facet, as the Sun or the camera sees them.

use nalgebra::{Vector2, Vector3};

use super::facet::Facet;
use crate::shadow::Source;

/// Number of facets up to which all are candidates: a search would cost more than it saves.
const FEW: usize = 32;
/// Smallest distance of a corner in front of the camera, m: the projection of a nearer corner says little
/// about its facet.
const NEAR_M: f64 = 1e-3;
/// Margin of the rectangles and of the distances, as a share of their size, for rounding.
const MARGIN: f64 = 1e-9;

/// Rectangle that a facet fills across the direction of a source, and its distances towards the source.
#[derive(Debug, Clone, Copy)]
struct Extent {
    low: Vector2<f64>,
    high: Vector2<f64>,
    /// Distance of the corner nearest to the source, with the margin, and of the farthest corner: both
    /// increase away from the source.
    nearest: f64,
    farthest: f64,
}

impl Extent {
    /// Extent of a facet that may lie in front of any other, and behind any other.
    const EVERYWHERE: Self = Self {
        low: Vector2::new(f64::NEG_INFINITY, f64::NEG_INFINITY),
        high: Vector2::new(f64::INFINITY, f64::INFINITY),
        nearest: f64::NEG_INFINITY,
        farthest: f64::INFINITY,
    };

    /// Returns true if `other` may cover a part of this extent.
    fn may_be_covered_by(&self, other: &Self) -> bool {
        other.nearest < self.farthest
            && other.low.x <= self.high.x
            && other.low.y <= self.high.y
            && other.high.x >= self.low.x
            && other.high.y >= self.low.y
    }
}

/// Projection across the direction of a source.
struct Screen {
    source: Source,
    /// Unit vectors: away from the source, and two across it.
    away: Vector3<f64>,
    across: [Vector3<f64>; 2],
}

impl Screen {
    /// Returns the projection of a body at the origin of its frame.
    fn new(source: Source) -> Self {
        let away = match source {
            Source::Parallel(towards) => -towards,
            Source::Point(at_m) => (-at_m).try_normalize(0.0).unwrap_or_else(Vector3::x),
        };
        // The first vector across is derived from a coordinate axis well away from the direction.
        let axis = if away.x.abs() < 0.6 { Vector3::x() } else { Vector3::y() };
        let first = away.cross(&axis).normalize();
        Self { source, away, across: [first, away.cross(&first)] }
    }

    /// Returns the extent of a facet.
    fn extent(&self, facet: &Facet) -> Extent {
        let nothing = Extent {
            low: Vector2::repeat(f64::INFINITY),
            high: Vector2::repeat(f64::NEG_INFINITY),
            nearest: f64::INFINITY,
            farthest: f64::NEG_INFINITY,
        };
        let mut extent = nothing;
        for corner in facet.corners_m() {
            let (offset, is_point) = match self.source {
                Source::Parallel(_) => (corner, false),
                Source::Point(at_m) => (corner - at_m, true),
            };
            let distance = offset.dot(&self.away);
            if is_point && distance < NEAR_M {
                return Extent::EVERYWHERE;
            }
            let scale = if is_point { 1.0 / distance } else { 1.0 };
            let at = Vector2::new(offset.dot(&self.across[0]), offset.dot(&self.across[1])) * scale;
            extent.low = extent.low.inf(&at);
            extent.high = extent.high.sup(&at);
            extent.nearest = extent.nearest.min(distance);
            extent.farthest = extent.farthest.max(distance);
        }
        let margin = (extent.high - extent.low).amax() * MARGIN;
        extent.low.add_scalar_mut(-margin);
        extent.high.add_scalar_mut(margin);
        extent.nearest -= extent.nearest.abs() * MARGIN;
        extent
    }
}

/// Facets that may cover others, sorted into the cells of a grid across the direction of a source.
#[derive(Debug)]
pub(super) struct Overlaps {
    extents: Vec<Extent>,
    /// Corner of the grid, and number of cells per unit of length along each axis.
    low: Vector2<f64>,
    per_length: Vector2<f64>,
    /// Number of cells along each axis.
    cells: usize,
    /// Facets of each cell, cell by cell, and the end of each cell's part.
    members: Vec<u32>,
    ends: Vec<usize>,
    /// Facets that may cover all others, wherever they are.
    everywhere: Vec<u32>,
}

impl Overlaps {
    /// Sorts the facets that `covers` selects.
    pub(super) fn new(facets: &[Facet], source: Source, covers: impl Fn(&Facet) -> bool) -> Self {
        let screen = Screen::new(source);
        let extents: Vec<Extent> = facets.iter().map(|facet| screen.extent(facet)).collect();
        let chosen = facets.iter().zip(0_u32..).filter(|(facet, _)| covers(facet)).map(|(_, index)| index);
        let is_finite = |index: &u32| extents.get(*index as usize).is_some_and(|e| e.low.x.is_finite());
        let (bounded, mut everywhere): (Vec<u32>, Vec<u32>) = chosen.partition(is_finite);
        let (mut low, mut high) = (Vector2::repeat(f64::INFINITY), Vector2::repeat(f64::NEG_INFINITY));
        for extent in bounded.iter().filter_map(|index| extents.get(*index as usize)) {
            (low, high) = (low.inf(&extent.low), high.sup(&extent.high));
        }
        let cells = (bounded.len() as f64).sqrt().ceil() as usize;
        let per_length = (high - low).map(|size| if size > 0.0 { cells as f64 / size } else { 0.0 });
        let mut grid = Self {
            extents,
            low,
            per_length,
            cells,
            members: Vec::new(),
            ends: Vec::new(),
            everywhere: Vec::new(),
        };
        if bounded.len() <= FEW {
            everywhere.extend(bounded);
        } else {
            grid.fill(&bounded);
        }
        grid.everywhere = everywhere;
        grid
    }

    /// Sorts facets into the cells that their extents touch.
    fn fill(&mut self, facets: &[u32]) {
        let mut counts = vec![0_usize; self.cells * self.cells];
        let extents = std::mem::take(&mut self.extents);
        let touched = |index: &u32| extents.get(*index as usize).map(|extent| self.cells_of(extent));
        for cell in facets.iter().filter_map(touched).flatten() {
            if let Some(count) = counts.get_mut(cell) {
                *count += 1;
            }
        }
        // Start of each cell's part, which moves to its end as the part is filled.
        let mut next = Vec::with_capacity(counts.len());
        let mut total = 0;
        for count in counts {
            next.push(total);
            total += count;
        }
        let mut members = vec![0; total];
        for index in facets {
            for cell in touched(index).into_iter().flatten() {
                if let Some(at) = next.get_mut(cell) {
                    if let Some(member) = members.get_mut(*at) {
                        *member = *index;
                    }
                    *at += 1;
                }
            }
        }
        (self.extents, self.members, self.ends) = (extents, members, next);
    }

    /// Returns the cells that an extent touches.
    fn cells_of(&self, extent: &Extent) -> impl Iterator<Item = usize> + use<> {
        let cells = self.cells;
        let last = cells.saturating_sub(1) as f64;
        let [first, end] = [extent.low, extent.high].map(|at| {
            let cell = (at - self.low).component_mul(&self.per_length);
            // An infinite coordinate becomes the first or the last cell.
            cell.map(|position| position.max(0.0).min(last) as usize)
        });
        (first.y..=end.y).flat_map(move |row| (first.x..=end.x).map(move |column| row * cells + column))
    }

    /// Writes the facets that may cover a part of facet `index` into `found`, in ascending order.
    pub(super) fn find(&self, index: usize, found: &mut Vec<u32>) {
        found.clear();
        let Some(extent) = self.extents.get(index) else { return };
        let may_cover = |other: &&u32| {
            **other as usize != index
                && self.extents.get(**other as usize).is_some_and(|other| extent.may_be_covered_by(other))
        };
        found.extend(self.everywhere.iter().filter(may_cover));
        for cell in self.cells_of(extent) {
            let start = if cell == 0 { 0 } else { self.ends.get(cell - 1).copied().unwrap_or_default() };
            let end = self.ends.get(cell).copied().unwrap_or_default();
            let members = self.members.get(start..end).unwrap_or_default();
            found.extend(members.iter().filter(may_cover));
        }
        found.sort_unstable();
        found.dedup();
    }
}
