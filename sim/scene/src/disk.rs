//! Image of a sphere: points on a grid over its disk.

use contract::PixelPoint;
use nalgebra::{Matrix2, Vector2};
use optics::ImagePoint;

/// Side of a cell in the image, px, if the number of points allows it; otherwise the side is an integer
/// number of pixels.
const FINE_CELL_PX: f64 = 0.5;
/// Minimum number of samples across the lit part of the disk.
const MIN_LIT_SAMPLES: f64 = 4.0;
/// Minimum and maximum number of samples along each side of a cell, and maximum number over all cells of the
/// image.
const MIN_SAMPLES: f64 = 4.0;
const SAMPLES: f64 = 32.0;
const ALL_SAMPLES: f64 = (1 << 22) as f64;

/// Disk of a sphere on the plane through the sphere's centre, perpendicular to the line of sight.
pub(super) struct Disk<P> {
    /// Projection from that plane, with the sphere's centre as origin, to the image; `None` where a point has
    /// no image.
    pub to_image: P,
    /// Radius of the disk on the plane.
    pub radius: f64,
    /// Sunlit share of the diameter, 0 to 1.
    pub lit: f64,
    /// Minimum number of samples along the diameter.
    pub samples_across: f64,
}

impl<P: Fn(Vector2<f64>) -> Option<PixelPoint>> Disk<P> {
    /// Half the width and half the height of the disk's image, px; `None` if the disk's centre has no image.
    pub(super) fn half_sides_px(&self) -> Option<[f64; 2]> {
        Some(self.half_sides_by(&self.scale()?))
    }

    /// Radius of the circle with the area of the disk's image, px.
    pub(super) fn radius_px(&self) -> Option<f64> {
        Some(self.radius_by(&self.scale()?))
    }

    /// Appends the points of the disk's undistorted image: about `count_limit` points at most. Their shares
    /// add up to 1, except for the share of points without an image. `light` is the radiance of a point of
    /// the plane towards the camera, per unit area of the plane. Appends nothing if the radiance is zero
    /// everywhere.
    ///
    /// The points stand on a grid aligned with the pixels. For every PSF, the shares that all points of such
    /// a grid contribute add up to the same sum in every pixel, so a uniform disk has a uniform image. A cell
    /// at the limb or the terminator is weighted by its lit part and stands at the radiance-weighted mean of
    /// its positions. The cells are larger than a pixel only for a disk with more than `count_limit` pixels;
    /// they then show as grains where the PSF is narrow.
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

        // Cells start at pixel edges, which are at half-integer positions.
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
                    // The grid is laid out by a linear map; the position of each point includes the
                    // distortion over the disk.
                    points.extend((self.to_image)(mean / sum).map(|position| ImagePoint { position, share }));
                }
            }
        }
        if total > 0.0 {
            points[first..].iter_mut().for_each(|point| point.share /= total);
        }
    }

    /// Side of a cell, px, and number of samples along the side: at least a few across the lit part, even a
    /// thin one.
    fn cells(&self, radius_px: f64, count_limit: usize) -> (f64, usize) {
        let lit_px = std::f64::consts::PI * radius_px * radius_px * self.lit;
        let limit = count_limit.max(1) as f64;
        let cell_px = if lit_px / (FINE_CELL_PX * FINE_CELL_PX) <= limit {
            // A disk smaller than a pixel needs no grid aligned with the pixels.
            FINE_CELL_PX.min(0.5 * radius_px)
        } else {
            (lit_px / limit).sqrt().ceil()
        };
        let across = self.samples_across.max(MIN_LIT_SAMPLES / self.lit);
        let wanted = (across * cell_px / (2.0 * radius_px)).ceil().clamp(MIN_SAMPLES, SAMPLES);
        let affordable = (ALL_SAMPLES.sqrt() * cell_px / (2.0 * radius_px)).floor().max(1.0);
        (cell_px, wanted.min(affordable) as usize)
    }

    /// Image of the plane's axes at the disk's centre, px per unit of the plane.
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
