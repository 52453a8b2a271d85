//! Profile of a straight edge under a blur that acts on pixel values, tabulated by the edge's direction.
//!
//! A digital filter (a Gaussian sampled at integer pixels) sums neighbouring pixels, which have already
//! integrated the optical image over their squares. Along the axes, the profile of an edge is a chain of
//! straight segments; off the axes the segments are rounded, and near 45° the profile is almost the
//! continuous one. The table holds the exact sum minus the continuous profile.

use super::blur::{BOX_VARIANCE, Blur, TAPS};
use super::gaussian::{Gaussian, WHOLE};

/// Number of nodes per pixel. With an amplitude of 0.03 at one cycle per pixel, linear interpolation is
/// accurate to 2e-4.
const NODES: f64 = 32.0;

/// Distance beyond which the difference vanishes, px.
const REACH_PX: f64 = 4.0;

/// Size of a table: a power of two, so an index needs no bounds check. 128 entries are used.
const TABLE: usize = 256;

/// Variance above which a sampled Gaussian equals a continuous one, px².
pub(super) const SMOOTH_PX2: f64 = 1.5;

/// Largest differences in an edge's normal and in its blur, px², from an existing table. Beyond these, a new
/// table is made.
const SAME_NORMAL: f64 = 0.004;
const SAME_BLUR_PX2: f64 = 0.015;

/// Factor on these differences up to which an existing table is used, so edges keep their tables during the
/// solution. The profile changes by 0.001 per degree, and by 1 % of itself per 0.01 px².
const REUSE_FACTOR: f64 = 6.0;

/// Largest number of tables kept: a target has a few directions of edges, each of which turns slowly.
const MAX_TABLES: usize = 24;

/// Sampled minus continuous step at distances from 0 on. Odd in the distance.
#[derive(Debug, Clone)]
struct Table {
    /// |n_x|, |n_y|.
    normal: (f64, f64),
    blur: (f64, f64),
    /// Value at each node, and difference to the next node.
    steps: [(f64, f64); TABLE],
}

/// Tables for the profiles of edges.
#[derive(Debug, Clone)]
pub(super) struct Tables {
    pub(super) gaussian: Gaussian,
    pub(super) profiles: SampledProfiles,
}

impl Tables {
    pub(super) fn new() -> Self {
        Self { gaussian: Gaussian::new(), profiles: SampledProfiles::default() }
    }

    /// Prepares the sampled profiles for edges with these normals. Returns true if any profile is new.
    pub(super) fn prepare(&mut self, normals: &[(f64, f64)], blur: &Blur) -> bool {
        normals
            .iter()
            .fold(false, |is_new, normal| self.profiles.prepare(&self.gaussian, *normal, blur) | is_new)
    }
}

/// Tables of sampled profiles, made on demand.
#[derive(Debug, Clone, Default)]
pub(super) struct SampledProfiles {
    tables: Vec<Table>,
    /// Index of the table to be replaced next.
    oldest: usize,
}

impl SampledProfiles {
    /// Returns the index of the table nearest to an edge's normal and blur, if one is near enough.
    pub(super) fn find(&self, normal: (f64, f64), blur: &Blur) -> Option<usize> {
        self.nearest(normal, blur).filter(|(_, off)| *off < REUSE_FACTOR).map(|(index, _)| index)
    }

    /// Returns the nearest table and its difference, in units of the largest difference at which no new table
    /// is made.
    fn nearest(&self, normal: (f64, f64), blur: &Blur) -> Option<(usize, f64)> {
        let (nx, ny) = (normal.0.abs(), normal.1.abs());
        let mut nearest = None;
        for (index, table) in self.tables.iter().enumerate() {
            let turned = (table.normal.0 - nx).abs() + (table.normal.1 - ny).abs();
            let blurred = (table.blur.0 - blur.x).abs() + (table.blur.1 - blur.y).abs();
            let off = (turned / SAME_NORMAL).max(blurred / SAME_BLUR_PX2);
            if nearest.is_none_or(|(_, least)| off < least) {
                nearest = Some((index, off));
            }
        }
        nearest
    }

    /// Makes a table for an edge's normal unless one is near. Returns true if a table was made.
    fn prepare(&mut self, gaussian: &Gaussian, normal: (f64, f64), blur: &Blur) -> bool {
        let is_smooth = blur.x.min(blur.y) > SMOOTH_PX2;
        if is_smooth || self.nearest(normal, blur).is_some_and(|(_, off)| off < 1.0) {
            return false;
        }
        let table = Table::new(gaussian, (normal.0.abs(), normal.1.abs()), blur);
        if self.tables.len() < MAX_TABLES {
            self.tables.push(table);
        } else {
            self.tables[self.oldest] = table;
            self.oldest = (self.oldest + 1) % MAX_TABLES;
        }
        true
    }

    /// Returns the sampled minus the continuous step at distances across the edge, px, and its slope, 1/px.
    #[inline(always)]
    pub(super) fn step_and_slope<const N: usize>(
        &self,
        table: usize,
        distance: &[f64; N],
    ) -> ([f64; N], [f64; N]) {
        let steps = &self.tables[table].steps;
        let (mut from_node, mut node) = ([0.0; N], [0; N]);
        for l in 0..N {
            let position = distance[l].abs() * NODES;
            let position = if position < REACH_PX * NODES { position } else { REACH_PX * NODES };
            let whole = (position - 0.5) + WHOLE;
            node[l] = whole.to_bits();
            from_node[l] = position - (whole - WHOLE);
        }
        let (mut step, mut slope) = ([0.0; N], [0.0; N]);
        for l in 0..N {
            (step[l], slope[l]) = steps[node[l] as usize % TABLE];
        }
        for l in 0..N {
            let value = step[l] + slope[l] * from_node[l];
            step[l] = if distance[l] < 0.0 { -value } else { value };
            slope[l] *= NODES;
        }
        (step, slope)
    }
}

impl Table {
    fn new(gaussian: &Gaussian, normal: (f64, f64), blur: &Blur) -> Self {
        let (nx, ny) = normal;
        let variance = nx * nx * (blur.x + BOX_VARIANCE) + ny * ny * (blur.y + BOX_VARIANCE);
        let kurtosis = (nx * nx * nx * nx + ny * ny * ny * ny) / (2880.0 * variance * variance);
        let step = |k: usize| {
            let distance = k as f64 / NODES;
            let z = distance / variance.sqrt();
            let (below, density) = gaussian.cdf_and_pdf(z);
            let continuous = below + kurtosis * z * (z * z - 3.0) * density;
            sampled(normal, &blur.taps, distance) - continuous
        };
        let mut steps = [(0.0, 0.0); TABLE];
        let mut here = step(0);
        for (k, node) in steps.iter_mut().enumerate().take((REACH_PX * NODES) as usize) {
            let next = step(k + 1);
            *node = (here, next - here);
            here = next;
        }
        Self { normal, blur: (blur.x, blur.y), steps }
    }
}

/// Returns the step of an edge after integration by pixels and blur by a sampled Gaussian.
fn sampled((nx, ny): (f64, f64), taps: &[[f64; TAPS]; 2], distance: f64) -> f64 {
    let reach = TAPS as i32 - 1;
    let mut sum = 0.0;
    for j in -reach..=reach {
        let row = taps[1][j.unsigned_abs() as usize];
        for i in -reach..=reach {
            let weight = row * taps[0][i.unsigned_abs() as usize];
            sum += weight * covered(nx, ny, distance + f64::from(i) * nx + f64::from(j) * ny);
        }
    }
    sum
}

/// Returns the share of a pixel inside a half plane whose border is at `distance` from the pixel's centre:
/// the integral of a trapezoid.
pub(super) fn covered(nx: f64, ny: f64, distance: f64) -> f64 {
    let (a, b) = (nx.max(ny), nx.min(ny).max(1e-4));
    let square = |x: f64| if x > 0.0 { x * x } else { 0.0 };
    let (wide, narrow) = (0.5 * (a + b), 0.5 * (a - b));
    if distance.abs() >= wide {
        return if distance > 0.0 { 1.0 } else { 0.0 };
    }
    (square(distance + wide) - square(distance + narrow) - square(distance - narrow)) / (2.0 * a * b)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns the coverage of a pixel by a half plane, counted on 400 × 400 points.
    fn counted(nx: f64, ny: f64, distance: f64) -> f64 {
        let position = |i: u32| (f64::from(i) + 0.5) / 400.0 - 0.5;
        let inside =
            (0..160_000).filter(|i| nx * position(i % 400) + ny * position(i / 400) + distance > 0.0);
        inside.count() as f64 / 160_000.0
    }

    #[test]
    fn a_pixel_is_covered_by_its_area() {
        for degrees in [0.0, 3.0, 30.0, 45.0, 80.0_f64] {
            let (ny, nx) = libm::sincos(degrees.to_radians());
            for distance in [-0.8, -0.5, -0.2, 0.0, 0.1, 0.6, 0.71] {
                // A line crosses 400 to 566 cells of the counted points; half of each cell is uncertain.
                let off = covered(nx, ny, distance) - counted(nx, ny, distance);
                assert!(off.abs() < 0.5 * 566.0 / 160_000.0 + 1e-4, "{degrees} {distance}: {off}");
            }
        }
    }

    #[test]
    fn an_edge_along_an_axis_is_a_chain_and_one_off_it_is_smooth() {
        let mut tables = Tables::new();
        let blur = Blur::on_grid(0.49, 0.49, 1.0);
        let largest = |profiles: &SampledProfiles, normal: (f64, f64)| {
            let table = profiles.find(normal, &blur).unwrap();
            (0..400)
                .map(|k| profiles.step_and_slope(table, &[f64::from(k - 200) / 50.0]).0[0].abs())
                .fold(0.0, f64::max)
        };
        let diagonal = (0.5f64.sqrt(), 0.5f64.sqrt());
        assert!(tables.prepare(&[(1.0, 0.0), diagonal], &blur));
        // The mirrored diagonal already has a table; the other axis gets a new one.
        assert!(!tables.prepare(&[(-diagonal.0, diagonal.1)], &blur));
        assert!(tables.prepare(&[(0.0, -1.0)], &blur) && tables.profiles.tables.len() == 3);
        // Reference values by a sum over pixels in another program: 0.035 at 2.9° and 0.0049 at 45°.
        let (chain, smooth) = (largest(&tables.profiles, (1.0, 0.0)), largest(&tables.profiles, diagonal));
        assert!((0.030..0.042).contains(&chain), "{chain}");
        assert!((0.004..0.006).contains(&smooth), "{smooth}");
        // Odd in the distance, and zero far away.
        let table = tables.profiles.find((1.0, 0.0), &blur).unwrap();
        let at = |distance: f64| tables.profiles.step_and_slope(table, &[distance]).0[0];
        assert!((at(0.3) + at(-0.3)).abs() < 1e-12 && at(3.9).abs() < 1e-4 && at(5.0) == 0.0);
    }
}
