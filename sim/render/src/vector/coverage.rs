//! Exact area coverage of polygons on pixels.
//!
//! Each edge adds the signed area to its right to every pixel that it crosses, and the remainder of its
//! height to the next pixel. The running sum along a row is then the area of each pixel inside the closed
//! polygon, without sampling. Font rasterisers use this method (R. Levien, "Inside the fastest font renderer
//! in the world", 2016). The sums are linear: any number of polygons can be added, each with its weights, and
//! each row is summed once.

/// A rectangle of whole pixels: columns `left` to `right`, rows `top` to `bottom`, ends excluded.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Window {
    pub(super) left: usize,
    pub(super) right: usize,
    pub(super) top: usize,
    pub(super) bottom: usize,
}

/// Consecutive pixels of a row.
#[derive(Clone, Copy)]
pub(super) enum Run<'a> {
    /// Pixels with individual sums.
    Each(&'a [[f32; 2]]),
    /// Pixels with identical sums: the sums, and the number of pixels.
    Same([f32; 2], usize),
}

/// Weighted coverage of every pixel of a window, two sums per pixel. Empty between [`Coverage::sweep`] and
/// the next [`Coverage::open`].
#[derive(Debug, Clone)]
pub(super) struct Coverage {
    columns: usize,
    rows: usize,
    /// Steps per row: one more than the columns, for the remainder beyond the last pixel.
    stride: usize,
    /// Increment of the running sums at each pixel of each row.
    steps: Vec<[f32; 2]>,
    /// Bit mask per row: a bit is set for each block that contains a step.
    touched: Vec<u64>,
    /// Columns per block: 2^shift.
    shift: u32,
    window: Window,
}

/// Returns the integer part of a coordinate in an image. Image dimensions fit into 32 bits, to which a
/// processor converts in a third of the steps.
#[inline(always)]
fn pixel_index(position: f64) -> usize {
    position as u32 as usize
}

impl Coverage {
    /// Smallest shift: blocks of 16 pixels; larger blocks where a row would have more than 64 of them.
    const MIN_SHIFT: u32 = 4;
    /// Smallest first sum of a run that is painted; rounding leaves smaller sums behind a closed polygon.
    pub(super) const RESIDUE: f32 = 1e-5;

    pub(super) fn new(columns: usize, rows: usize) -> Self {
        let mut shift = Self::MIN_SHIFT;
        while (columns >> shift) >= 64 {
            shift += 1;
        }
        Self {
            columns,
            rows,
            stride: columns + 1,
            steps: vec![[0.0; 2]; (columns + 1) * rows],
            touched: vec![0; rows],
            shift,
            window: Window { left: 0, right: columns, top: 0, bottom: rows },
        }
    }

    /// Returns the window of the whole image.
    pub(super) fn full_window(&self) -> Window {
        Window { left: 0, right: self.columns, top: 0, bottom: self.rows }
    }

    /// Confines subsequent operations to a window inside the image.
    pub(super) fn open(&mut self, window: Window) {
        self.window = window;
    }

    /// Adds a closed polygon. Points are (x, y) with the corner of the first pixel at (0, 0), y down. A
    /// polygon that runs anticlockwise as displayed has positive coverage; holes are polygons that run
    /// clockwise.
    pub(super) fn add(&mut self, polygon: &[[f64; 2]], weights: [f32; 2]) {
        let Some(mut from) = polygon.last() else { return };
        for to in polygon {
            self.add_edge(*from, *to, weights);
            from = to;
        }
    }

    fn add_edge(&mut self, from: [f64; 2], to: [f64; 2], weights: [f32; 2]) {
        let (upper, lower, sign) = if from[1] < to[1] { (from, to, 1.0_f32) } else { (to, from, -1.0_f32) };
        let top = upper[1].max(self.window.top as f64);
        let bottom = lower[1].min(self.window.bottom as f64);
        // In this form of the condition a coordinate that is not a number adds nothing.
        let crosses_rows = top < bottom && (upper[0] + lower[0]).is_finite();
        if !crosses_rows {
            return;
        }
        let per_row = (lower[0] - upper[0]) / (lower[1] - upper[1]);
        let x_at = |y: f64| if y == lower[1] { lower[0] } else { upper[0] + (y - upper[1]) * per_row };
        let (x_top, x_bottom) = (x_at(top), x_at(bottom));
        let weights = weights.map(|weight| sign * weight);
        let (left, right) = (self.window.left as f64, self.window.right as f64);
        if x_top >= left && x_bottom >= left && x_top <= right && x_bottom <= right {
            self.add_inside([x_top, top], [x_bottom, bottom], per_row, weights);
            return;
        }
        if x_top >= right && x_bottom >= right {
            return;
        }
        // The edge is cut where it enters and leaves the window. A piece to the left of the window covers its
        // rows completely; a piece to the right covers no part of it.
        let crossing = |x: f64| (top + (x - x_top) / per_row).clamp(top, bottom);
        let (mut first, mut second) = (top, bottom);
        if per_row != 0.0 {
            (first, second) = (crossing(left), crossing(right));
            if second < first {
                (first, second) = (second, first);
            }
        }
        let mut y = top;
        let mut x = x_top;
        for end in [first, second, bottom] {
            let x_end = if end == bottom { x_bottom } else { x_at(end) };
            let middle = 0.5 * (x + x_end);
            if end > y && middle < right {
                let (from, to) = (x.clamp(left, right), x_end.clamp(left, right));
                self.add_inside([from, y], [to, end], (to - from) / (end - y), weights);
            }
            (y, x) = (end, x_end);
        }
    }

    /// Adds an edge that lies in the window, with `from` above `to`; `per_row` is the change of x per row.
    fn add_inside(&mut self, from: [f64; 2], to: [f64; 2], per_row: f64, weights: [f32; 2]) {
        let (low, high) = if from[0] < to[0] { (from[0], to[0]) } else { (to[0], from[0]) };
        let mut row = pixel_index(from[1]).min(self.window.bottom - 1);
        let last_row = pixel_index(to[1]).min(self.window.bottom - 1);
        let [mut x, mut y] = from;
        let mut floor = row as f64;
        while row < last_row {
            floor += 1.0;
            let next = (from[0] + (floor - from[1]) * per_row).clamp(low, high);
            self.add_in_row(row, x, next, floor - y, weights);
            (x, y) = (next, floor);
            row += 1;
        }
        self.add_in_row(row, x, to[0], to[1] - y, weights);
    }

    /// Adds a piece of an edge within one row: its height, and its x from `a` to `b`.
    #[inline(always)]
    fn add_in_row(&mut self, row: usize, a: f64, b: f64, height: f64, weights: [f32; 2]) {
        let (low, high) = if a < b { (a, b) } else { (b, a) };
        let right = self.window.right;
        let first = pixel_index(low).min(right - 1);
        let start = row * self.stride;
        // One step more than the columns of the window, for the remainder beyond it.
        let steps = &mut self.steps[start..start + right + 1];
        let mut step = |column: usize, area: f64| {
            let (step, area) = (&mut steps[column], area as f32);
            *step = [step[0] + area * weights[0], step[1] + area * weights[1]];
        };
        let end = (first + 1) as f64;
        let mut last = first;
        if high <= end {
            let area = height * (end - 0.5 * (low + high));
            step(first, area);
            step(first + 1, height - area);
        } else {
            // Along the piece, the height to the left of x grows linearly. The area of a pixel is the
            // integral of this height over the pixel: a triangle in the first pixel, and all but a triangle
            // in the last.
            last = pixel_index(high).min(right - 1);
            let slope = height / (high - low);
            let triangle = |side: f64| 0.5 * slope * side * side;
            let mut area = triangle(end - low);
            step(first, area);
            for column in first + 1..last {
                let next = slope * (column as f64 + 0.5 - low);
                step(column, next - area);
                area = next;
            }
            let next = height - triangle(high - last as f64);
            step(last, next - area);
            step(last + 1, height - next);
        }
        let (from, to) = (first >> self.shift, (last + 1).min(right - 1) >> self.shift);
        // Marks blocks `from` to `to`.
        self.touched[row] |= (u64::MAX >> (63 - (to - from))) << from;
    }

    /// Passes the sums of the window's pixels to `paint` (row, first column, run), row by row from the left,
    /// and clears them. Runs without coverage in the first sum are skipped.
    pub(super) fn sweep(&mut self, mut paint: impl FnMut(usize, usize, Run<'_>)) {
        let Window { left, right, top, bottom } = self.window;
        for row in top..bottom {
            let touched = std::mem::take(&mut self.touched[row]);
            if touched == 0 {
                continue;
            }
            let start = row * self.stride;
            let steps = &mut self.steps[start..start + right + 1];
            steps[right] = [0.0; 2];
            let mut sums = [0.0_f32; 2];
            let mut column = left;
            while column < right {
                let ahead = touched >> (column >> self.shift);
                if ahead & 1 == 1 {
                    let end = (((column >> self.shift) + 1) << self.shift).min(right);
                    let run = &mut steps[column..end];
                    for step in run.iter_mut() {
                        sums = [sums[0] + step[0], sums[1] + step[1]];
                        *step = sums;
                    }
                    paint(row, column, Run::Each(run));
                    run.fill([0.0; 2]);
                    column = end;
                } else {
                    let end = if ahead == 0 {
                        right
                    } else {
                        (((column >> self.shift) + ahead.trailing_zeros() as usize) << self.shift).min(right)
                    };
                    if sums[0].abs() > Self::RESIDUE {
                        paint(row, column, Run::Same(sums, end - column));
                    }
                    column = end;
                }
            }
        }
    }
}
