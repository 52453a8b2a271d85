//! Measurement of the target's marks: search in a ring-shaped region predicted from the cross, then mark by
//! mark.

use contract::PixelPoint;
use contract::docking::{Mark, MarkUse, TargetModel};
use nalgebra::Vector2;

use super::profile::Levels;
use crate::docking::preprocessing::view::{Lens, View};

/// Plane of the disk in the ideal image, viewed face-on: the point (y1, y2) of the plane is imaged at
/// centre + scale (y1 h + y2 v), with h = (cos, sin) and v = (sin, −cos) of the roll.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Plane {
    /// Centre of the disk, px from the principal point.
    pub(crate) centre: Vector2<f64>,
    /// Scale, px per metre: f/d3.
    pub(crate) scale_px_m: f64,
    /// Rotation of y1 from the direction of increasing columns towards increasing rows, rad.
    pub(crate) roll_rad: f64,
}

impl Plane {
    /// Returns the image position of a point of the plane.
    pub(crate) fn project(&self, [y1, y2]: [f64; 2]) -> Vector2<f64> {
        let (sin, cos) = libm::sincos(self.roll_rad);
        self.centre + self.scale_px_m * Vector2::new(y1 * cos + y2 * sin, y1 * sin - y2 * cos)
    }

    /// Returns the point of the plane at an image position.
    #[cfg(test)]
    pub(crate) fn locate(&self, ideal: Vector2<f64>) -> [f64; 2] {
        let (sin, cos) = libm::sincos(self.roll_rad);
        let p = (ideal - self.centre) / self.scale_px_m;
        [p.x * cos + p.y * sin, p.x * sin - p.y * cos]
    }

    /// Fits the plane by least squares to pairs of a point of the plane and its image position; `None` for
    /// fewer than two different points.
    pub(crate) fn fit(pairs: &[([f64; 2], Vector2<f64>)]) -> Option<Self> {
        let n = pairs.len() as f64;
        let mean_y = pairs.iter().map(|(y, _)| Vector2::new(y[0], y[1])).sum::<Vector2<f64>>() / n;
        let mean_p = pairs.iter().map(|(_, p)| *p).sum::<Vector2<f64>>() / n;
        // The model x = ox + p y1 + q y2, y = oy + q y1 − p y2 with (p, q) = scale (cos, sin) is linear.
        let (mut p, mut q, mut square) = (0.0, 0.0, 0.0);
        for (y, seen) in pairs {
            let (y1, y2) = (y[0] - mean_y.x, y[1] - mean_y.y);
            let d = seen - mean_p;
            p += d.x * y1 - d.y * y2;
            q += d.x * y2 + d.y * y1;
            square += y1 * y1 + y2 * y2;
        }
        if !(square > 0.0 && p.is_finite() && q.is_finite()) {
            return None;
        }
        let (p, q) = (p / square, q / square);
        let scale_px_m = libm::hypot(p, q);
        let centre = mean_p - Vector2::new(p * mean_y.x + q * mean_y.y, q * mean_y.x - p * mean_y.y);
        (scale_px_m > 0.0).then_some(Self { centre, scale_px_m, roll_rad: libm::atan2(q, p) })
    }
}

/// Bar shape of a mark: position, length and width, in the target plane, m.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct MarkShape {
    /// Centre (y1, y2).
    pub(crate) centre_m: [f64; 2],
    /// Unit vector along the mark.
    along: [f64; 2],
    half_length_m: f64,
    half_width_m: f64,
}

impl MarkShape {
    /// Creates the shape from the four corners of a bar.
    pub(crate) fn new(corners: &[[f64; 2]; 4]) -> Self {
        let mean = |k: usize| corners.iter().map(|c| c[k]).sum::<f64>() / 4.0;
        let middle = |a: usize, b: usize| {
            [(corners[a][0] + corners[b][0]) / 2.0, (corners[a][1] + corners[b][1]) / 2.0]
        };
        // The longer of the two lines that join the midpoints of opposite sides is along the mark.
        let across = |from: [f64; 2], to: [f64; 2]| (to[0] - from[0], to[1] - from[1]);
        let (first, second) = (across(middle(0, 3), middle(1, 2)), across(middle(0, 1), middle(3, 2)));
        let length = |v: (f64, f64)| libm::hypot(v.0, v.1);
        let (long, short) = if length(first) >= length(second) { (first, second) } else { (second, first) };
        let norm = length(long).max(f64::MIN_POSITIVE);
        Self {
            centre_m: [mean(0), mean(1)],
            along: [long.0 / norm, long.1 / norm],
            half_length_m: length(long) / 2.0,
            half_width_m: length(short) / 2.0,
        }
    }

    /// Returns a point of the plane, at `along` and `across` from the centre of the mark, m.
    fn point_on_plane(&self, along: f64, across: f64) -> [f64; 2] {
        let [u, v] = self.along;
        [self.centre_m[0] + along * u - across * v, self.centre_m[1] + along * v + across * u]
    }

    /// Distance of the mark's centre from the disk's centre, m.
    pub(crate) fn radius_m(&self) -> f64 {
        libm::hypot(self.centre_m[0], self.centre_m[1])
    }

    /// Returns true if the mark lies towards a diagonal of the cross. Such a mark is never beside the end of
    /// a bar.
    fn is_diagonal(&self) -> bool {
        let (x, y) = (self.centre_m[0].abs(), self.centre_m[1].abs());
        x.min(y) > 0.4 * x.max(y)
    }
}

/// Returns the shapes of a target's marks.
pub(crate) fn shapes(model: &TargetModel) -> Vec<MarkShape> {
    model.marks.iter().map(MarkShape::new).collect()
}

/// Mark measured in a field.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct MarkObservation {
    /// Mark as reported in the features: index, pixel position, usage.
    pub(crate) mark: Mark,
    /// Centroid of the mark in the ideal image, or its predicted position.
    pub(crate) ideal: Vector2<f64>,
}

/// Marks found around a cross. They decide which of the many cross-shaped regions of a field is the target's.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct MarksFit {
    /// Plane fitted to the used marks.
    pub(crate) plane: Plane,
    /// All marks of the target.
    pub(crate) marks: Vec<MarkObservation>,
}

impl MarksFit {
    /// Returns the number of marks with the given usage.
    pub(crate) fn count(&self, usage: MarkUse) -> usize {
        self.marks.iter().filter(|m| m.mark.usage == usage).count()
    }
}

/// Search for the marks in a field.
pub(crate) struct MarkSearch<'a> {
    pub(crate) view: &'a View<'a>,
    pub(crate) lens: &'a Lens,
    pub(crate) shapes: &'a [MarkShape],
    pub(crate) plate_radius_m: f64,
    pub(crate) levels: Levels,
}

/// Blur by lens and video, px: standard deviation, including that of the pixel's box.
const BLUR_PX: f64 = 0.85;

impl MarkSearch<'_> {
    /// Finds the circle of the marks coarsely, from the marks towards the diagonals, which are fragments of
    /// the circle. Searches for the disk's centre up to `reach_px` from that of `start`, and for the scale
    /// within a fraction `stretch` of that of `start`. Returns the plane with the highest contrast of the
    /// marks.
    pub(crate) fn coarse(&self, start: &Plane, reach_px: f64, stretch: f64) -> Plane {
        let diagonal: Vec<&MarkShape> = self.shapes.iter().filter(|shape| shape.is_diagonal()).collect();
        let shapes = if diagonal.len() >= 4 { diagonal } else { self.shapes.iter().collect() };
        let width = 2.0 * start.scale_px_m * shapes.first().map_or(0.0, |shape| shape.half_width_m);
        let step = (0.5 * width).clamp(0.8, 6.0);
        let mut best = (*start, self.contrast(start, &shapes, f64::NEG_INFINITY));
        let count = (reach_px / step).ceil().clamp(1.0, 40.0) as i32;
        let consider = |plane: Plane, best: &mut (Plane, f64)| {
            let contrast = self.contrast(&plane, &shapes, best.1);
            if contrast > best.1 {
                *best = (plane, contrast);
            }
        };
        for i in -count..=count {
            for j in -count..=count {
                if i * i + j * j > count * count {
                    continue;
                }
                let shift = Vector2::new(f64::from(i), f64::from(j)) * step;
                consider(Plane { centre: start.centre + shift, ..*start }, &mut best);
            }
        }
        let around = best.0;
        for k in -3..=3 {
            for i in -2..=2 {
                for j in -2..=2 {
                    let shift = Vector2::new(f64::from(i), f64::from(j)) * (0.5 * step);
                    let scale_px_m = around.scale_px_m * (1.0 + stretch * f64::from(k) / 3.0);
                    consider(Plane { centre: around.centre + shift, scale_px_m, ..around }, &mut best);
                }
            }
        }
        best.0
    }

    /// Returns the mean height of the marks over their surroundings, grey values. The contribution of a mark
    /// is limited to the height of the cross. Marks outside the image do not count; the result is 0 when no
    /// mark is inside. Stops early and returns minus infinity when the mean cannot exceed `least`.
    fn contrast(&self, plane: &Plane, shapes: &[&MarkShape], least: f64) -> f64 {
        let top = self.levels.contrast();
        let (mut sum, mut count) = (0.0, 0u32);
        for (index, shape) in shapes.iter().enumerate() {
            // Upper bound: all remaining marks are seen at the largest height that counts.
            let left = (shapes.len() - index) as f64;
            if sum + left * top < least * (f64::from(count) + left) {
                return f64::NEG_INFINITY;
            }
            let at = |along: f64, across: f64| {
                self.view.sample(self.lens.to_camera(plane.project(shape.point_on_plane(along, across)))?)
            };
            let beside = shape.half_width_m + (2.0 * BLUR_PX + 0.5) / plane.scale_px_m;
            let (mut on, mut off, mut seen) = (0.0, 0.0, true);
            for share in [-0.6, 0.0, 0.6] {
                let along = share * shape.half_length_m;
                match (at(along, 0.0), at(along, beside), at(along, -beside)) {
                    (Some(middle), Some(left), Some(right)) => {
                        on += middle;
                        off += left.max(right);
                    }
                    _ => seen = false,
                }
            }
            if seen {
                sum += ((on - off) / 3.0).clamp(-top, top);
                count += 1;
            }
        }
        if count == 0 { 0.0 } else { sum / f64::from(count) }
    }

    /// Measures every mark near its position by `plane`, classifies the marks, and fits the plane to the good
    /// ones; then repeats this with the fitted plane. Returns `None` when fewer than three marks are good.
    pub(crate) fn measure(&self, plane: &Plane) -> Option<MarksFit> {
        let first = self.pass(plane)?;
        self.pass(&first.plane).or(Some(first))
    }

    fn pass(&self, plane: &Plane) -> Option<MarksFit> {
        let mut marks: Vec<MarkObservation> = Vec::with_capacity(self.shapes.len());
        let mut heights = Vec::with_capacity(self.shapes.len());
        for (index, shape) in self.shapes.iter().enumerate() {
            let predicted = plane.project(shape.centre_m);
            let position = self.lens.to_camera(predicted);
            let blank = |usage| MarkObservation {
                mark: Mark { index: index as u32, position: position.unwrap_or_default(), usage },
                ideal: predicted,
            };
            let Some(position) = position else {
                marks.push(blank(MarkUse::OutOfField));
                heights.push(0.0);
                continue;
            };
            let half_diagonal =
                plane.scale_px_m * libm::hypot(shape.half_length_m, shape.half_width_m) + 2.0 * BLUR_PX;
            if !self.view.contains(position, half_diagonal) {
                marks.push(blank(MarkUse::OutOfField));
                heights.push(0.0);
                continue;
            }
            match self.centroid(plane, shape) {
                Some((position, height)) => {
                    let ideal = self.lens.to_ideal(position);
                    marks.push(match ideal {
                        Some(ideal) => MarkObservation {
                            mark: Mark { index: index as u32, position, usage: MarkUse::Used },
                            ideal,
                        },
                        None => blank(MarkUse::OutOfField),
                    });
                    heights.push(height);
                }
                None => {
                    marks.push(blank(MarkUse::Missing));
                    heights.push(0.0);
                }
            }
        }
        reject_by_height(&mut marks, &heights);
        let plane = self.reject_by_position(&mut marks)?;
        Some(MarksFit { plane, marks })
    }

    /// Returns the centroid of a mark's signal over the plate, and the signal as a share of the signal that a
    /// mark as bright as the cross would have. Returns `None` when the share is at most 0.15.
    fn centroid(&self, plane: &Plane, shape: &MarkShape) -> Option<(PixelPoint, f64)> {
        let to_m = 1.0 / plane.scale_px_m;
        // Wide enough for the blur and for an error of the prediction. Along the mark, the window ends before
        // the plate's rim, whose bright surroundings would pull the centroid outwards.
        let pad_m = (3.0 * BLUR_PX * to_m).max(0.6 * shape.half_width_m);
        let to_rim_m = self.plate_radius_m - shape.radius_m() - shape.half_length_m;
        let pad_along_m = pad_m.min((0.5 * to_rim_m).max(1.2 * to_m));
        let (reach_along, reach_across) =
            (shape.half_length_m + pad_along_m, shape.half_width_m + pad_m + to_m);
        let middle = self.lens.to_camera(plane.project(shape.centre_m))?;
        let reach_px = libm::hypot(reach_along, reach_across) * plane.scale_px_m + 1.0;
        let columns = span(middle.x - reach_px, middle.x + reach_px, self.view.columns());
        let rows = span(
            self.view.image_row(middle.y - reach_px),
            self.view.image_row(middle.y + reach_px),
            self.view.rows(),
        );
        // Large marks have more pixels than their centroid needs: only every `stride`-th column is used.
        let stride = ((columns.len() * rows.len()) / 3000 + 1).min(4);
        let mut inside: Vec<(f64, f64, f64)> = Vec::with_capacity(256);
        let mut beside: Vec<f64> = Vec::with_capacity(256);
        let (sin, cos) = libm::sincos(plane.roll_rad);
        let [u, v] = shape.along;
        for row in rows {
            let y = self.view.camera_row(row);
            for column in columns.clone().step_by(stride) {
                // Offset from the mark's centre. Distortion is negligible over so short a distance.
                let (dx, dy) = ((column as f64 - middle.x) * to_m, (y - middle.y) * to_m);
                let (y1, y2) = (dx * cos + dy * sin, dx * sin - dy * cos);
                let (along, across) = ((y1 * u + y2 * v).abs(), (y2 * u - y1 * v).abs());
                if along > reach_along || across > reach_across {
                    continue;
                }
                let grey = self.view.grey_at(column, row);
                inside.push((column as f64, y, grey));
                if across > shape.half_width_m + 1.8 * BLUR_PX * to_m {
                    beside.push(grey);
                }
            }
        }
        if inside.len() < 6 || beside.len() < 4 {
            return None;
        }
        beside.sort_by(f64::total_cmp);
        let background = beside[beside.len() / 2];
        let (mut sum, mut sum_x, mut sum_y) = (0.0, 0.0, 0.0);
        for (x, y, grey) in &inside {
            let weight = grey - background;
            sum += weight;
            sum_x += weight * (x - middle.x);
            sum_y += weight * (y - middle.y);
        }
        let area_px = sum * self.view.step() * stride as f64 / self.levels.contrast();
        let nominal_px = 4.0 * shape.half_length_m * shape.half_width_m * plane.scale_px_m * plane.scale_px_m;
        let height = area_px / nominal_px;
        (height > 0.15).then(|| (PixelPoint::new(middle.x + sum_x / sum, middle.y + sum_y / sum), height))
    }

    /// Rejects marks whose position contradicts the other marks, worst first, and fits the plane to the
    /// remaining ones.
    fn reject_by_position(&self, marks: &mut [MarkObservation]) -> Option<Plane> {
        loop {
            let pairs: Vec<_> = marks
                .iter()
                .filter(|m| m.mark.usage == MarkUse::Used)
                .filter_map(|m| Some((self.shapes.get(m.mark.index as usize)?.centre_m, m.ideal)))
                .collect();
            if pairs.len() < 3 {
                return None;
            }
            let plane = Plane::fit(&pairs)?;
            let mut errors: Vec<f64> = pairs.iter().map(|(y, p)| (plane.project(*y) - p).norm()).collect();
            errors.sort_by(f64::total_cmp);
            let mark_radius_px =
                plane.scale_px_m * self.shapes.iter().map(MarkShape::radius_m).fold(0.0, f64::max);
            // A tilt of ten degrees moves marks by 0.8 % of the radius from their positions in a plane seen
            // head on.
            let limit = (0.5 + 0.012 * mark_radius_px).max(3.0 * errors[errors.len() / 2]);
            let error = |m: &MarkObservation| {
                self.shapes
                    .get(m.mark.index as usize)
                    .map_or(0.0, |shape| (plane.project(shape.centre_m) - m.ideal).norm())
            };
            let worst = marks
                .iter_mut()
                .filter(|m| m.mark.usage == MarkUse::Used)
                .max_by(|a, b| error(a).total_cmp(&error(b)));
            match worst {
                Some(worst) if error(worst) > limit => worst.mark.usage = MarkUse::Rejected,
                _ => return Some(plane),
            }
        }
    }
}

/// Rejects marks whose signal differs from that of the other marks: a mark in shadow has less, a mark with a
/// glint or crossed by a bright object has more.
fn reject_by_height(marks: &mut [MarkObservation], heights: &[f64]) {
    let mut seen: Vec<f64> = marks
        .iter()
        .zip(heights)
        .filter(|(m, _)| m.mark.usage == MarkUse::Used)
        .map(|(_, height)| *height)
        .collect();
    seen.sort_by(f64::total_cmp);
    // Lit marks are the brighter ones, but the brightest may be glints.
    let Some(&typical) = seen.get(seen.len() * 6 / 10) else { return };
    for (mark, height) in marks.iter_mut().zip(heights) {
        if mark.mark.usage == MarkUse::Used && !(*height > 0.7 * typical && *height < 1.45 * typical) {
            mark.mark.usage = MarkUse::Rejected;
        }
    }
}

fn span(from: f64, to: f64, n: usize) -> std::ops::Range<usize> {
    let clamp = |v: f64| v.clamp(0.0, n as f64) as usize;
    let (from, to) = (clamp(from.floor()), clamp(to.ceil() + 1.0));
    from..to.max(from)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::docking::synthetic::{self, Scene};
    use contract::docking::Lines;
    use proptest::prelude::*;

    const LEVELS: Levels = Levels { dark: 25.0, bright: 200.0 };

    proptest! {
        #[test]
        fn exact_positions_give_their_plane(
            x in -300.0..300.0f64, y in -300.0..300.0f64, scale in 10.0..1000.0f64, roll in -3.0..3.0f64,
        ) {
            let plane = Plane { centre: Vector2::new(x, y), scale_px_m: scale, roll_rad: roll };
            let pairs: Vec<_> = shapes(&synthetic::target())
                .iter()
                .take(5)
                .map(|shape| (shape.centre_m, plane.project(shape.centre_m)))
                .collect();
            let fit = Plane::fit(&pairs).unwrap();
            prop_assert!((fit.centre - plane.centre).norm() < 1e-9);
            prop_assert!((fit.scale_px_m - scale).abs() < 1e-9 && (fit.roll_rad - roll).abs() < 1e-12);
            let back = plane.locate(pairs[2].1);
            prop_assert!((back[0] - pairs[2].0[0]).abs() < 1e-12 && (back[1] - pairs[2].0[1]).abs() < 1e-12);
        }
    }

    fn measure(scene: &Scene, lines: Lines) -> MarksFit {
        let field = scene.field(lines);
        let shapes = shapes(&synthetic::target());
        let (view, lens) = (View::new(&field), synthetic::lens());
        let search =
            MarkSearch { view: &view, lens: &lens, shapes: &shapes, plate_radius_m: 0.30, levels: LEVELS };
        let truth = scene.plane();
        let radius = 0.25 * truth.scale_px_m;
        let start = Plane {
            centre: truth.centre + Vector2::new(0.15, 0.1) * radius,
            scale_px_m: 1.02 * truth.scale_px_m,
            roll_rad: truth.roll_rad + 0.01,
        };
        search.measure(&search.coarse(&start, 0.3 * radius, 0.05)).unwrap()
    }

    #[test]
    fn all_marks_of_a_clean_field_are_found() {
        for (range_m, roll_rad) in [(5.0, 0.0), (2.0, 0.05), (10.0, -0.1)] {
            let scene = Scene { range_m, roll_rad, ..Scene::default() };
            let fit = measure(&scene, Lines::Even);
            assert!(fit.count(MarkUse::Used) >= 11, "{range_m} m: {:?}", fit.marks);
            let truth = scene.plane();
            // Twelve marks, each accurate to a few tenths of a pixel where rows undersample it.
            assert!((fit.plane.centre - truth.centre).norm() < 0.12, "{range_m} m: {:?}", fit.plane);
            assert!((fit.plane.scale_px_m / truth.scale_px_m - 1.0).abs() < 0.1 / (0.25 * truth.scale_px_m));
        }
    }

    #[test]
    fn marks_in_shadow_are_rejected() {
        let scene = Scene { range_m: 3.0, shadow_from_m: 0.15, ..Scene::default() };
        let fit = measure(&scene, Lines::Odd);
        let mut used = 0;
        for seen in &fit.marks {
            let y1 = shapes(&synthetic::target())[seen.mark.index as usize].centre_m[0];
            assert_eq!(seen.mark.usage == MarkUse::Used, y1 < 0.15, "{seen:?}");
            used += usize::from(seen.mark.usage == MarkUse::Used);
        }
        assert!(used > 4 && used < fit.marks.len(), "{used} of {} are used", fit.marks.len());
        assert!((fit.plane.centre - scene.plane().centre).norm() < 0.1);
    }

    #[test]
    fn marks_outside_the_image_are_out_of_field() {
        let scene = Scene { range_m: 2.0, disk_px: Vector2::new(300.0, 0.0), ..Scene::default() };
        let fit = measure(&scene, Lines::Odd);
        assert!(fit.count(MarkUse::OutOfField) >= 3 && fit.count(MarkUse::Used) >= 7, "{:?}", fit.marks);
        assert!((fit.plane.centre - scene.plane().centre).norm() < 0.1);
    }
}
