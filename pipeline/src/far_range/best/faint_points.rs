//! Points too faint for a cluster: maxima of the image convolved with the image of a point (matched filter).

use contract::{PixelPoint, Window};

use super::image_fit::PointImage;
use super::photometry::PhotometryContext;

/// Point below the threshold of clusters.
#[derive(Debug, Clone, Copy)]
pub(super) struct FaintPoint {
    pub(super) position: PixelPoint,
    /// Variance of the position along an axis, px².
    pub(super) variance_px2: f64,
    /// Flux, electrons.
    pub(super) flux_e: f64,
    /// Natural logarithm of the ratio of the likelihoods of the image of a point and of one or two bright
    /// pixels.
    pub(super) point_over_pixel: f64,
}

/// Search for [`FaintPoint`]s, with reusable buffers.
#[derive(Debug, Default)]
pub(super) struct FaintPoints {
    /// Electrons above the background, 0 at hot pixels and clusters.
    context: Vec<f32>,
    along_rows: Vec<f32>,
    filtered: Vec<f32>,
    points: Vec<(f32, FaintPoint)>,
}

/// Smallest signal-to-noise ratio of a point's flux: noise alone exceeds it about ten times in half a million
/// pixels.
const MIN_SNR: f64 = 4.0;

/// Largest number of points of a frame, brightest first.
const MAX_POINTS: usize = 24;

/// Distance from a cluster or a listed star within which a maximum is part of it, px, in addition to the
/// reach of the filter.
const APART_PX: f64 = 2.0;

impl FaintPoints {
    /// Finds the points of a frame that are apart from clusters and from the positions of `stars`, brightest
    /// first. The noise of the background is assumed for every pixel.
    pub(super) fn find(
        &mut self,
        context: PhotometryContext<'_>,
        image: &PointImage,
        stars: &[PixelPoint],
    ) -> Vec<FaintPoint> {
        let kernel = kernel(image.sigma_px);
        self.points.clear();
        let whole = [Window { x: 0, y: 0, columns: context.frame.columns(), rows: context.frame.rows() }];
        for window in context.frame.windows().unwrap_or(&whole) {
            self.find_in(context, image, window, &kernel, stars);
        }
        self.points.sort_by(|a, b| b.0.total_cmp(&a.0));
        self.points.truncate(MAX_POINTS);
        self.points.iter().map(|(_, point)| *point).collect()
    }

    fn find_in(
        &mut self,
        context: PhotometryContext<'_>,
        image: &PointImage,
        window: &Window,
        kernel: &[f32],
        stars: &[PixelPoint],
    ) {
        let (columns, rows, reach) = (window.columns, window.rows, kernel.len() / 2);
        if columns < kernel.len() || rows < kernel.len() {
            return;
        }
        self.load(context, window);
        self.convolve(columns, rows, kernel);
        // The filter's output is the flux if its weights are k/Σk²; its noise is then σ/√Σk², with the
        // pixels' σ.
        let power: f32 = kernel.iter().map(|k| k * k).sum();
        let power = f64::from(power * power);
        let limit = MIN_SNR * context.model.pixel_sigma_e * power.sqrt();
        let sigma2 = image.sigma_px * image.sigma_px;
        let apart_px = APART_PX + reach as f64;
        for y in reach..rows - reach {
            let row = &self.filtered[y * columns..(y + 1) * columns];
            for (x, &value) in row.iter().enumerate().take(columns - reach).skip(reach) {
                if f64::from(value) < limit || !self.is_maximum(x, y, columns) {
                    continue;
                }
                let position = self.vertex(x, y, columns, window);
                let is_taken = context.is_near_cluster(position, apart_px)
                    || stars.iter().any(|star| star.distance(position) < apart_px);
                if !is_taken {
                    let flux_e = f64::from(value) / power;
                    let snr = f64::from(value) / (context.model.pixel_sigma_e * power.sqrt());
                    // Reduction of χ² by a point of this flux, and by the two brightest pixels.
                    let pair = self.pair(x, y, columns).map(|e| f64::from(e) / context.model.pixel_sigma_e);
                    let point = FaintPoint {
                        position,
                        // Position variance of a Gaussian in uniform noise: 2 σ²/snr².
                        variance_px2: 2.0 * sigma2 / (snr * snr),
                        flux_e,
                        point_over_pixel: 0.5 * (snr * snr - pair[0] * pair[0] - pair[1] * pair[1]),
                    };
                    self.points.push((value, point));
                }
            }
        }
    }

    /// Loads the pixels of a window.
    fn load(&mut self, context: PhotometryContext<'_>, window: &Window) {
        let (gain, base_dn) = context.model.scale();
        self.context.clear();
        for y in window.y..window.y + window.rows {
            let row = &context.frame.row(y)[window.x..window.x + window.columns];
            self.context.extend(row.iter().map(|&dn| (f32::from(dn) - base_dn) * gain));
        }
        let columns = context.frame.columns();
        let taken_out = context.detector.pixels_in_clusters().chain(context.hot_pixels.indices());
        for (x, y) in taken_out.map(|index| (index % columns, index / columns)) {
            if window.contains(x, y) {
                self.context[(y - window.y) * window.columns + x - window.x] = 0.0;
            }
        }
    }

    /// Convolves along the rows, then along the columns. A margin of half a kernel remains 0.
    fn convolve(&mut self, columns: usize, rows: usize, kernel: &[f32]) {
        let reach = kernel.len() / 2;
        self.along_rows.clear();
        self.along_rows.resize(columns * rows, 0.0);
        for (to, from) in self.along_rows.chunks_exact_mut(columns).zip(self.context.chunks_exact(columns)) {
            let inner = &mut to[reach..columns - reach];
            for (k, &weight) in kernel.iter().enumerate() {
                for (to, from) in inner.iter_mut().zip(&from[k..]) {
                    *to += weight * from;
                }
            }
        }
        self.filtered.clear();
        self.filtered.resize(columns * rows, 0.0);
        for (i, to) in self.filtered.chunks_exact_mut(columns).enumerate().take(rows - reach).skip(reach) {
            for (k, &weight) in kernel.iter().enumerate() {
                let first = (i + k - reach) * columns;
                for (to, from) in to.iter_mut().zip(&self.along_rows[first..first + columns]) {
                    *to += weight * from;
                }
            }
        }
    }

    /// Returns true if no neighbour of the pixel is brighter; of equal neighbours the first counts.
    fn is_maximum(&self, x: usize, y: usize, columns: usize) -> bool {
        let at = y * columns + x;
        let value = self.filtered[at];
        let row = |y: usize| &self.filtered[y * columns + x - 1..=y * columns + x + 1];
        let before = row(y - 1).iter().chain(&self.filtered[at - 1..at]);
        let after = self.filtered[at + 1..=at + 1].iter().chain(row(y + 1));
        before.into_iter().all(|v| *v < value) && after.into_iter().all(|v| *v <= value)
    }

    /// Returns the electrons of the brightest pixel of 3 × 3 about a pixel, and of its brightest neighbour
    /// along columns and rows.
    fn pair(&self, x: usize, y: usize, columns: usize) -> [f32; 2] {
        let mut peak = (f32::NEG_INFINITY, 0);
        for row in y - 1..=y + 1 {
            for at in row * columns + x - 1..=row * columns + x + 1 {
                if self.context[at] > peak.0 {
                    peak = (self.context[at], at);
                }
            }
        }
        let neighbours = [peak.1.wrapping_sub(1), peak.1 + 1, peak.1.wrapping_sub(columns), peak.1 + columns];
        let second =
            neighbours.iter().filter_map(|at| self.context.get(*at)).fold(0.0, |a: f32, b| a.max(*b));
        [peak.0, second]
    }

    /// Returns the maximum, in frame coordinates, of the parabolas through a pixel and its neighbours along
    /// columns and rows.
    fn vertex(&self, x: usize, y: usize, columns: usize, window: &Window) -> PixelPoint {
        let at = y * columns + x;
        let offset = |step: usize| {
            let [before, here, after] = [at - step, at, at + step].map(|i| f64::from(self.filtered[i]));
            let curvature = 2.0 * here - before - after;
            if curvature > 0.0 { (0.5 * (after - before) / curvature).clamp(-0.5, 0.5) } else { 0.0 }
        };
        PixelPoint::new((window.x + x) as f64 + offset(1), (window.y + y) as f64 + offset(columns))
    }
}

/// Returns a Gaussian integrated over pixels, out to 2.5 widths.
fn kernel(sigma_px: f64) -> Vec<f32> {
    let sigma_px = sigma_px.clamp(0.4, 4.0);
    let reach = (2.5 * sigma_px).ceil() as i32;
    let edge = |at: f64| libm::erf(at / (sigma_px * std::f64::consts::SQRT_2));
    (-reach..=reach).map(|i| (0.5 * (edge(f64::from(i) + 0.5) - edge(f64::from(i) - 0.5))) as f32).collect()
}
