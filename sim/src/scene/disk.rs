//! The image of a sphere: points on a grid over its disk.

use contract::PixelPoint;
use nalgebra::{Matrix2, Vector2};

use crate::optics::ImagePoint;

/// Side of a cell in the image, px, where the number of points allows it; else it is a whole number of pixels.
const FINE_CELL_PX: f64 = 0.5;
/// Places that are looked at across the lit part, at least.
const LIT_SAMPLES: f64 = 4.0;
/// Places a cell is looked at along each side, at least and at most, and all cells of the image together.
const LEAST_SAMPLES: f64 = 4.0;
const SAMPLES: f64 = 32.0;
const ALL_SAMPLES: f64 = (1 << 22) as f64;

/// The disk of a sphere on a plane through its centre, across the line of sight.
pub(super) struct Disk<P> {
    /// From that plane, the centre at its origin, to the image; `None` where there is no image.
    pub to_image: P,
    /// Radius of the disk on the plane.
    pub radius: f64,
    /// Share of its diameter that is in sunlight, 0 to 1.
    pub lit: f64,
    /// Places along its diameter that are looked at, at least.
    pub samples_across: f64,
}

impl<P: Fn(Vector2<f64>) -> Option<PixelPoint>> Disk<P> {
    /// Half the width and half the height of its image, px; `None` when its centre has no image.
    pub(super) fn half_sides_px(&self) -> Option<[f64; 2]> {
        Some(self.half_sides_by(&self.scale()?))
    }

    /// Radius of its image, px: that of the circle of the same area.
    pub(super) fn radius_px(&self) -> Option<f64> {
        Some(self.radius_by(&self.scale()?))
    }

    /// Appends the points of its undisturbed image: `count_limit` points or so at most, their shares adding up to 1 as far as
    /// the image has a place for them. `light` is what a place of the plane sends to the camera, from equal areas. Nothing when
    /// no light comes from it.
    ///
    /// The points stand on a grid in step with the pixels. Whatever the PSF, the pixels' shares of all points of such a grid add
    /// up to the same in every pixel: an even disk is drawn even. A cell at limb or terminator counts by the part of it that is
    /// lit, at the mean of its light. Only of a disk with more than `count_limit` pixels are the cells larger than
    /// a pixel, and show as grains where the PSF is narrow.
    pub(super) fn image(
        &self,
        light: impl Fn(&Vector2<f64>) -> f64,
        count_limit: usize,
        points: &mut Vec<ImagePoint>,
    ) {
        let Some(scale) = self.scale() else { return };
        let (Some(centre), Some(to_plane)) = ((self.to_image)(Vector2::zeros()), scale.try_inverse()) else {
            return;
        };
        let sides_px = self.half_sides_by(&scale);
        let (cell_px, samples) = self.cells(self.radius_by(&scale), count_limit);

        // Cells lie between the edges of pixels, which are at half numbers.
        let cells = |at: f64, half_px: f64| {
            let first = ((at - half_px + 0.5) / cell_px).floor();
            let last = ((at + half_px + 0.5) / cell_px).floor();
            (0..=(last - first) as usize).map(move |i| (first + i as f64) * cell_px - 0.5)
        };
        let first = points.len();
        let mut total = 0.0;
        for top in cells(centre.y, sides_px[1]) {
            for left in cells(centre.x, sides_px[0]) {
                let (mut sum, mut mean) = (0.0, Vector2::zeros());
                for j in 0..samples {
                    for i in 0..samples {
                        let within = |i: usize| (i as f64 + 0.5) / samples as f64 * cell_px;
                        let offset = Vector2::new(left + within(i) - centre.x, top + within(j) - centre.y);
                        let at = to_plane * offset;
                        let light = light(&at);
                        sum += light;
                        mean += at * light;
                    }
                }
                if sum > 0.0 {
                    let share = sum / (samples * samples) as f64;
                    total += share;
                    // The grid is laid by a linear map; its distortion over the disk is in the place of each point.
                    points.extend((self.to_image)(mean / sum).map(|position| ImagePoint { position, share }));
                }
            }
        }
        if total > 0.0 {
            points[first..].iter_mut().for_each(|point| point.share /= total);
        }
    }

    /// Side of a cell, px, and places along it that are looked at: a few across the lit part, however thin.
    fn cells(&self, radius_px: f64, count_limit: usize) -> (f64, usize) {
        let lit_px = std::f64::consts::PI * radius_px * radius_px * self.lit;
        let limit = count_limit.max(1) as f64;
        let cell_px = if lit_px / (FINE_CELL_PX * FINE_CELL_PX) <= limit {
            // A disk within a pixel has no grid to be in step with.
            FINE_CELL_PX.min(0.5 * radius_px)
        } else {
            (lit_px / limit).sqrt().ceil()
        };
        let across = self.samples_across.max(LIT_SAMPLES / self.lit);
        let wanted = (across * cell_px / (2.0 * radius_px)).ceil().clamp(LEAST_SAMPLES, SAMPLES);
        let affordable = (ALL_SAMPLES.sqrt() * cell_px / (2.0 * radius_px)).floor().max(1.0);
        (cell_px, wanted.min(affordable) as usize)
    }

    /// Pixels a unit of the plane at the disk's centre: what its axes are in the image.
    fn scale(&self) -> Option<Matrix2<f64>> {
        let step = 0.01 * self.radius;
        let derivative = |along: Vector2<f64>| {
            let (before, after) = ((self.to_image)(-step * along)?, (self.to_image)(step * along)?);
            Some(Vector2::new(after.x - before.x, after.y - before.y) / (2.0 * step))
        };
        Some(Matrix2::from_columns(&[derivative(Vector2::x())?, derivative(Vector2::y())?]))
    }

    fn half_sides_by(&self, scale: &Matrix2<f64>) -> [f64; 2] {
        [0, 1].map(|axis| self.radius * scale.row(axis).norm())
    }

    fn radius_by(&self, scale: &Matrix2<f64>) -> f64 {
        self.radius * scale.determinant().abs().sqrt()
    }
}
