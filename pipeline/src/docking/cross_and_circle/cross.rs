//! Measurement of the target's cross: pairs of points on the edges of its bars, and the centre by least
//! squares (docking paper, section 3).

use contract::PixelPoint;
use contract::docking::StandOffCross;
use nalgebra::Vector2;

use super::profile::{Levels, bar_edges, falling_edge};
use crate::docking::preprocessing::view::{Lens, View};

/// Approximate position, size and orientation of a cross in the ideal image.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct CrossSeed {
    /// Centre of the cross, px from the principal point.
    pub(crate) centre: Vector2<f64>,
    /// Distance from the centre to the end of a bar, px.
    pub(crate) half_length_px: f64,
    /// Slope a of the horizontal bar.
    pub(crate) slope: f64,
}

impl CrossSeed {
    /// Returns a position on the cross: `along` the horizontal bar to the right and `down` the vertical one,
    /// px.
    pub(crate) fn point_at(&self, along: f64, down: f64) -> Vector2<f64> {
        let cos = 1.0 / (1.0 + self.slope * self.slope).sqrt();
        let sin = self.slope * cos;
        self.centre + Vector2::new(along * cos - down * sin, along * sin + down * cos)
    }
}

/// Centre lines of the two bars: a x − y = c1 and x + a y = c2.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct BarLines {
    pub(crate) a: f64,
    pub(crate) c1: f64,
    pub(crate) c2: f64,
}

impl BarLines {
    /// Fits the lines by least squares: minimises Σ (a X − Y − c1)² + Σ (U + a V − c2)² over points (X, Y) of
    /// the horizontal bar and (U, V) of the vertical one. `None` when the points do not determine a, c1 and
    /// c2.
    pub(crate) fn fit(horizontal: &[Vector2<f64>], vertical: &[Vector2<f64>]) -> Option<Self> {
        if horizontal.is_empty() || vertical.is_empty() {
            return None;
        }
        let mean = |points: &[Vector2<f64>]| points.iter().sum::<Vector2<f64>>() / points.len() as f64;
        let (h, v) = (mean(horizontal), mean(vertical));
        // Normal equations with c1 and c2 eliminated: with coordinates relative to the means, only a remains.
        let (mut moment, mut square) = (0.0, 0.0);
        for point in horizontal {
            moment += (point.x - h.x) * (point.y - h.y);
            square += (point.x - h.x) * (point.x - h.x);
        }
        for point in vertical {
            moment -= (point.x - v.x) * (point.y - v.y);
            square += (point.y - v.y) * (point.y - v.y);
        }
        let a = moment / square;
        (square > 0.0 && a.is_finite()).then_some(Self { a, c1: a * h.x - h.y, c2: v.x + a * v.y })
    }

    /// Returns the intersection of the lines: Xc = (a c1 + c2)/(1 + a²), Yc = (a c2 − c1)/(1 + a²).
    pub(crate) fn centre(&self) -> Vector2<f64> {
        let scale = 1.0 + self.a * self.a;
        Vector2::new((self.a * self.c1 + self.c2) / scale, (self.a * self.c2 - self.c1) / scale)
    }

    fn horizontal_residual(&self, p: &Vector2<f64>) -> f64 {
        self.a * p.x - p.y - self.c1
    }

    fn vertical_residual(&self, p: &Vector2<f64>) -> f64 {
        p.x + self.a * p.y - self.c2
    }
}

/// Measured cross.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct CrossFit {
    /// Centre, slope and half length after least squares, in the ideal image.
    pub(crate) seed: CrossSeed,
    /// Centre from the medians of the pairs, before least squares, in the ideal image.
    pub(crate) raw_centre: Vector2<f64>,
    /// Numbers of pairs on the horizontal and the vertical bar, N1 and N2.
    pub(crate) pairs: (usize, usize),
    /// Grey levels of plate and cross.
    pub(crate) levels: Levels,
}

/// Smallest number of pairs on a bar.
const MIN_PAIRS: usize = 3;

/// Largest slope of the horizontal bar: a roll of 40°. Beyond it, the horizontal and the vertical bar would
/// be confused.
const MAX_SLOPE: f64 = 0.84;

/// Measures the cross near `seed`; `None` when there is no cross with the model's proportions that is at
/// least `min_contrast` grey values brighter than its surroundings.
pub(crate) fn measure(
    view: &View<'_>,
    lens: &Lens,
    model: &StandOffCross,
    seed: &CrossSeed,
    min_contrast: f64,
) -> Option<CrossFit> {
    let ratio = model.width_m / model.half_length_m;
    let mut now = *seed;
    let mut fit = None;
    // The first pass searches widely; the following passes measure near its result.
    for pass in 0..3 {
        let width = now.half_length_px * ratio;
        let levels = levels(view, lens, &now, width)?;
        if levels.contrast() < min_contrast {
            return None;
        }
        let margin = if pass == 0 {
            (0.8 * width).max(2.0 * view.step() + 1.0)
        } else {
            (0.5 * width).max(2.0 * view.step())
        };
        let scan = Scan { view, lens, seed: now, width, margin, levels };
        let (horizontal, vertical) = (scan.horizontal_pairs(), scan.vertical_pairs());
        if horizontal.len() < MIN_PAIRS || vertical.len() < MIN_PAIRS {
            return None;
        }
        let raw_centre = raw_centre(&horizontal, &vertical, now.slope);
        let (lines, pairs) = fit_lines(&horizontal, &vertical, &now, raw_centre)?;
        if lines.a.abs() > MAX_SLOPE {
            return None;
        }
        now = CrossSeed { centre: lines.centre(), slope: lines.a, ..now };
        now.half_length_px = half_length(view, lens, &now, &levels)?;
        if (now.centre - seed.centre).norm() > 0.5 * seed.half_length_px {
            return None;
        }
        fit = Some(CrossFit { seed: now, raw_centre, pairs, levels });
    }
    fit
}

/// Returns the grey levels of the cross (from the brighter half of the samples on its bars, since a part may
/// be in shadow) and of the plate around it.
fn levels(view: &View<'_>, lens: &Lens, seed: &CrossSeed, width: f64) -> Option<Levels> {
    let at = |along: f64, down: f64| view.sample(lens.to_camera(seed.point_at(along, down))?);
    let half = seed.half_length_px;
    let across = [-(0.3 * width).max(1.0), 0.0, (0.3 * width).max(1.0)];
    let brightest = |values: [Option<f64>; 3]| values.into_iter().flatten().max_by(f64::total_cmp);
    let mut bright = Vec::with_capacity(24);
    for share in [-0.85, -0.7, -0.55, -0.4, -0.3, 0.3, 0.4, 0.55, 0.7, 0.85] {
        bright.extend(brightest(across.map(|d| at(share * half, d))));
        bright.extend(brightest(across.map(|d| at(d, share * half))));
    }
    let mut dark = Vec::with_capacity(16);
    for (x, y) in [(1.0, 1.0), (1.0, -1.0), (-1.0, 1.0), (-1.0, -1.0)] {
        for share in [0.35, 0.5, 0.65] {
            dark.extend(at(share * half * x, share * half * y));
        }
    }
    // At least half of the sampled positions must be in the image.
    if bright.len() < 10 || dark.len() < 6 {
        return None;
    }
    bright.sort_by(f64::total_cmp);
    dark.sort_by(f64::total_cmp);
    Some(Levels { dark: dark[dark.len() / 2], bright: bright[bright.len() * 6 / 10] })
}

/// Input of the search for pairs.
struct Scan<'a> {
    view: &'a View<'a>,
    lens: &'a Lens,
    seed: CrossSeed,
    width: f64,
    margin: f64,
    levels: Levels,
}

/// Fraction of the half length in which pairs are taken: the ends of the bars are round in the image.
const REACH: f64 = 0.9;

/// Approximate number of pairs on each side of the centre.
const PAIRS_A_SIDE: f64 = 24.0;

impl Scan<'_> {
    /// Returns the midpoints of the pairs on the top and bottom edges of the horizontal bar, column by
    /// column.
    fn horizontal_pairs(&self) -> Vec<Vector2<f64>> {
        let (view, half) = (self.view, self.seed.half_length_px);
        // The secant accounts for profiles that cross the bar at an angle.
        let secant = (1.0 + self.seed.slope * self.seed.slope).sqrt();
        let reach = secant * (self.width / 2.0 + self.margin);
        let stride = (half / PAIRS_A_SIDE).max(1.0);
        let mut values = Vec::new();
        let mut found = Vec::new();
        self.each_side(stride, |along| {
            let centre = self.lens.to_camera(self.seed.point_at(along, 0.0))?;
            let column = pixel_index(centre.x, view.columns())?;
            let first = pixel_index(view.image_row(centre.y - reach).ceil(), view.rows())?;
            let last = pixel_index(view.image_row(centre.y + reach).floor(), view.rows())?;
            values.clear();
            values.extend((first..=last).map(|row| view.grey_at(column, row)));
            let edges =
                bar_edges(&values, view.camera_row(first), view.step(), secant * self.width, &self.levels)?;
            let at = |y: f64| self.lens.to_ideal(PixelPoint::new(column as f64, y));
            found.push((at(edges.0)? + at(edges.1)?) / 2.0);
            Some(())
        });
        found
    }

    /// Returns the midpoints of the pairs on the left and right edges of the vertical bar, row by row.
    fn vertical_pairs(&self) -> Vec<Vector2<f64>> {
        let (view, half) = (self.view, self.seed.half_length_px);
        let secant = (1.0 + self.seed.slope * self.seed.slope).sqrt();
        let reach = secant * (self.width / 2.0 + self.margin);
        let stride = (half / PAIRS_A_SIDE).max(view.step());
        let mut values = Vec::new();
        let mut found = Vec::new();
        self.each_side(stride, |down| {
            let near = self.lens.to_camera(self.seed.point_at(0.0, down))?;
            let row = pixel_index(view.image_row(near.y).round(), view.rows())?;
            let y = view.camera_row(row);
            // Moves along the centre line of the bar to the nearest existing row.
            let centre_x = near.x - self.seed.slope * (y - near.y);
            let first = pixel_index((centre_x - reach).ceil(), view.columns())?;
            let last = pixel_index((centre_x + reach).floor(), view.columns())?;
            values.clear();
            values.extend((first..=last).map(|column| view.grey_at(column, row)));
            let edges = bar_edges(&values, first as f64, 1.0, secant * self.width, &self.levels)?;
            let at = |x: f64| self.lens.to_ideal(PixelPoint::new(x, y));
            found.push((at(edges.0)? + at(edges.1)?) / 2.0);
            Some(())
        });
        found
    }

    /// Calls `at` at distances from the centre on both sides, beyond the other bar and short of the ends.
    fn each_side(&self, stride: f64, mut at: impl FnMut(f64) -> Option<()>) {
        let from = self.width / 2.0 + 2.0 + 0.1 * self.seed.half_length_px;
        let to = REACH * self.seed.half_length_px;
        for side in [-1.0, 1.0] {
            let mut distance = from;
            while distance <= to {
                // Positions without a pair are left out.
                let _ = at(side * distance);
                distance += stride;
            }
        }
    }
}

/// Rounds a value to an index below `n`.
fn pixel_index(value: f64, n: usize) -> Option<usize> {
    let value = value.round();
    (value >= 0.0 && value < n as f64).then_some(value as usize)
}

fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    values.get(values.len() / 2).copied().unwrap_or(0.0)
}

/// Returns the centre for a given slope and the medians of the pairs' offsets.
fn raw_centre(horizontal: &[Vector2<f64>], vertical: &[Vector2<f64>], slope: f64) -> Vector2<f64> {
    let c1 = median(horizontal.iter().map(|p| slope * p.x - p.y).collect());
    let c2 = median(vertical.iter().map(|p| p.x + slope * p.y).collect());
    BarLines { a: slope, c1, c2 }.centre()
}

/// Fits the lines by least squares without outliers (pairs disturbed by a reticle, a shadow's edge, a jumped
/// line).
fn fit_lines(
    horizontal: &[Vector2<f64>],
    vertical: &[Vector2<f64>],
    seed: &CrossSeed,
    raw_centre: Vector2<f64>,
) -> Option<(BarLines, (usize, usize))> {
    let a = seed.slope;
    let start = BarLines { a, c1: a * raw_centre.x - raw_centre.y, c2: raw_centre.x + a * raw_centre.y };
    // The first round must accept the displacement of the bars' ends that an error of the slope causes.
    let mut tolerance = 1.0 + 0.12 * seed.half_length_px;
    let mut lines = start;
    let mut kept = (Vec::new(), Vec::new());
    for _ in 0..4 {
        let choose = |points: &[Vector2<f64>], residual: &dyn Fn(&Vector2<f64>) -> f64| {
            let spread = median(points.iter().map(|p| residual(p).abs()).collect());
            let limit = tolerance.max(3.0 * 1.4826 * spread);
            points.iter().filter(|p| residual(p).abs() <= limit).copied().collect::<Vec<_>>()
        };
        kept = (
            choose(horizontal, &|p| lines.horizontal_residual(p)),
            choose(vertical, &|p| lines.vertical_residual(p)),
        );
        if kept.0.len() < MIN_PAIRS || kept.1.len() < MIN_PAIRS {
            return None;
        }
        lines = BarLines::fit(&kept.0, &kept.1)?;
        tolerance = 0.35;
    }
    // Bars are rejected when their pairs do not lie on lines.
    let rms = |points: &[Vector2<f64>], residual: &dyn Fn(&Vector2<f64>) -> f64| {
        (points.iter().map(|p| residual(p) * residual(p)).sum::<f64>() / points.len() as f64).sqrt()
    };
    let limit = 0.7 + 0.01 * seed.half_length_px;
    let straight = rms(&kept.0, &|p| lines.horizontal_residual(p)) < limit
        && rms(&kept.1, &|p| lines.vertical_residual(p)) < limit;
    straight.then_some((lines, (kept.0.len(), kept.1.len())))
}

/// Returns the distance from the centre to the ends of the bars: the mean of the middle two arms, among those
/// that end in the image.
fn half_length(view: &View<'_>, lens: &Lens, seed: &CrossSeed, levels: &Levels) -> Option<f64> {
    let half = seed.half_length_px;
    let (from, to) = (0.55 * half, 1.45 * half);
    let steps = ((to - from).ceil() as usize).clamp(8, 400);
    let step = (to - from) / steps as f64;
    let mut ends = Vec::with_capacity(4);
    for (x, y) in [(1.0, 0.0), (0.0, 1.0), (-1.0, 0.0), (0.0, -1.0)] {
        let values: Vec<f64> = (0..=steps)
            .map_while(|i| {
                let distance = from + step * i as f64;
                view.sample(lens.to_camera(seed.point_at(x * distance, y * distance))?)
            })
            .collect();
        ends.extend(falling_edge(&values, from, step, levels));
    }
    ends.sort_by(f64::total_cmp);
    match ends.as_slice() {
        [_, b, c, _] => Some((b + c) / 2.0),
        // A shadow shortens an arm, and nothing lengthens it.
        [_, b, c] => Some((b + c) / 2.0),
        [a, b] if (a - b).abs() < 0.2 * half => Some((a + b) / 2.0),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::docking::synthetic::{self, Scene};
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn exact_points_give_their_lines(a in -0.5..0.5f64, x in -300.0..300.0f64, y in -300.0..300.0f64) {
            let centre = Vector2::new(x, y);
            let seed = CrossSeed { centre, half_length_px: 50.0, slope: a };
            let along: Vec<_> = [-40.0, -20.0, 15.0, 30.0].iter().map(|d| seed.point_at(*d, 0.0)).collect();
            let down: Vec<_> = [-44.0, 12.0, 31.0].iter().map(|d| seed.point_at(0.0, *d)).collect();
            let lines = BarLines::fit(&along, &down).unwrap();
            // Tolerance for the rounding of coordinates of a few hundred pixels.
            prop_assert!((lines.a - a).abs() < 1e-12);
            prop_assert!((lines.centre() - centre).norm() < 1e-9);
            prop_assert!((lines.c1 - (a * x - y)).abs() < 1e-9 && (lines.c2 - (x + a * y)).abs() < 1e-9);
        }
    }

    #[test]
    fn the_fit_solves_the_normal_equations() {
        let horizontal = [(0.0, 1.0), (1.0, 1.4), (2.0, 1.1), (5.0, 2.0)].map(|(x, y)| Vector2::new(x, y));
        let vertical = [(3.0, -2.0), (2.6, 0.5), (2.5, 4.0)].map(|(x, y)| Vector2::new(x, y));
        let lines = BarLines::fit(&horizontal, &vertical).unwrap();
        let (mut da, mut dc1, mut dc2) = (0.0, 0.0, 0.0);
        for p in &horizontal {
            da += lines.horizontal_residual(p) * p.x;
            dc1 += lines.horizontal_residual(p);
        }
        for p in &vertical {
            da += lines.vertical_residual(p) * p.y;
            dc2 += lines.vertical_residual(p);
        }
        assert!(da.abs() < 1e-12 && dc1.abs() < 1e-12 && dc2.abs() < 1e-12, "{da} {dc1} {dc2}");
    }

    #[test]
    fn points_that_do_not_fix_the_lines_are_refused() {
        assert_eq!(BarLines::fit(&[], &[Vector2::zeros()]), None);
        assert_eq!(BarLines::fit(&[Vector2::zeros()], &[Vector2::zeros()]), None);
    }

    #[test]
    fn the_cross_of_a_clean_field_is_measured() {
        for (range_m, roll) in [(5.0, 0.0), (3.0, 0.1), (12.0, -0.15), (1.5, 0.03)] {
            let scene = Scene { range_m, roll_rad: roll, ..Scene::default() };
            let field = scene.field(contract::docking::Lines::Odd);
            let lens = synthetic::lens();
            let truth = scene.cross();
            let seed = CrossSeed {
                centre: truth.centre + Vector2::new(0.05, -0.04) * truth.half_length_px,
                half_length_px: 0.93 * truth.half_length_px,
                slope: truth.slope + 0.03,
            };
            let model = synthetic::target().cross;
            let fit = measure(&View::new(&field), &lens, &model, &seed, 10.0).unwrap();
            let off = (fit.seed.centre - truth.centre).norm();
            // The rows of a field sample a thin bar coarsely; the tolerance of the raw centre is the paper's
            // 1.5 px.
            assert!(off < 0.1, "{range_m} m: {off} px");
            assert!((fit.raw_centre - truth.centre).norm() < 1.5);
            assert!((fit.seed.slope - truth.slope).abs() < 0.15 / truth.half_length_px + 0.002);
            let length = fit.seed.half_length_px / truth.half_length_px;
            assert!((length - 1.0).abs() < 0.6 / truth.half_length_px + 0.01, "{range_m} m: {length}");
        }
    }

    #[test]
    fn a_disk_is_no_cross() {
        let scene = Scene { cross: false, ..Scene::default() };
        let field = scene.field(contract::docking::Lines::Even);
        let model = synthetic::target().cross;
        assert_eq!(measure(&View::new(&field), &synthetic::lens(), &model, &scene.cross(), 10.0), None);
    }
}
