//! Sources of an image: local maxima above the noise, with windowed centroids.
//!
//! Detection is by the image smoothed with a Gaussian (the matched filter of a star). The position is that of
//! SExtractor's windowed centroid (XWIN_IMAGE: Bertin & Arnouts 1996; the manual, section "Windowed
//! positional parameters"), whose error is close to that of a fit of the profile.

use contract::PixelPoint;
use files::GreyImage;

use crate::background::{Background, CELL_PX, FINE_CELL_PX, clipped};

/// Smoothing of the image for detection, standard deviation, px, and reach of its kernel.
const SMOOTHING_PX: f64 = 1.0;
const SMOOTHING_REACH: usize = 3;

/// Smallest height of a source in the smoothed image, standard deviations of its noise.
const MIN_SIGMAS: f64 = 5.0;

/// Standard deviation of the window of a centroid, px, and its reach.
const WINDOW_PX: f64 = 1.5;
const WINDOW_REACH: i64 = FLUX_REACH_PX as i64;

/// Distance from the pixel of its maximum, along both axes, up to which the flux of a source is summed, px.
pub const FLUX_REACH_PX: u32 = 4;

/// Distance from the edge of the image below which a source is left out, px.
const EDGE_PX: usize = WINDOW_REACH as usize + 1;

/// Largest number of rounds of a centroid, largest last step, px, and largest way from the maximum, px.
const CENTROID_ROUNDS: usize = 40;
const CENTROID_STEP_PX: f64 = 1e-4;
const CENTROID_WAY_PX: f64 = 2.0;

/// Share of its 3 × 3 pixels in the central one above which a source is a hot pixel or a cosmic-ray hit. A
/// star of σ = 0.5 px, centred on a pixel, has 0.47.
const SPIKE_SHARE: f64 = 0.7;

/// Share of the saturation level above which a pixel is saturated.
const SATURATED_SHARE: f64 = 0.98;

/// Noise of the smoothed image above a background in fine cells, over that above one in large cells, below
/// which the sky has structure: clouds, the halo of the Moon.
const STRUCTURE_SHARE: f64 = 0.7;

/// Noise in a part of the image, over that of the whole, above which it is used there.
const ROUGH_SHARE: f64 = 1.3;

/// Significance of a source that counts for the shape of all, and smallest number of such sources.
const SHAPE_SIGNIFICANCE: f64 = 10.0;
const SHAPE_SOURCES: usize = 5;

/// Elongation of all sources in a common direction above which they are trails: that of a uniform trail of 7
/// px.
const TRAIL_ELONGATION: f64 = 0.36;

/// Largest number of sources of an image, most significant first.
const MAX_SOURCES: usize = 600;

/// A source of an image.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Source {
    /// Position, px; the centre of the first pixel is 0.
    pub position: PixelPoint,
    /// Sum of the pixels above the background within 4 px, DN.
    pub flux_dn: f64,
    /// Height in the smoothed image, standard deviations of its noise: the order of the sources.
    pub significance: f64,
    /// Error of the position along an axis by the noise of the background, px.
    pub sigma_px: f64,
    /// Width of the profile, standard deviation of a Gaussian, px; NaN if it is wider than the window.
    pub width_px: f64,
    /// Elongation by the second moments Q in the window: (Q_xx − Q_yy, 2 Q_xy)/(Q_xx + Q_yy), 0 for a round
    /// source, of length 1 for a line.
    pub elongation: [f64; 2],
    /// Pixel of the maximum.
    pub peak: [usize; 2],
    /// True for a hot pixel or a cosmic-ray hit.
    pub is_spike: bool,
    /// True if a pixel is saturated.
    pub is_saturated: bool,
}

/// Sources of an image, most significant first, and its background.
#[derive(Debug, Clone)]
pub struct ImageSources {
    /// Sources.
    pub sources: Vec<Source>,
    /// Median of the background, DN.
    pub background_dn: f64,
    /// Standard deviation of a pixel about the background, DN.
    pub noise_dn: f64,
}

impl ImageSources {
    /// Returns the direction of trails in the image, the angle from the columns' axis towards that of the
    /// rows, 0 to 180 degrees; `None` if the sources are no trails. A trail of more than some 7 px has no
    /// position along it: the window of the centroid is shorter.
    pub fn trail_deg(&self) -> Option<f64> {
        let is_shaped = |source: &&Source| {
            !source.is_spike && !source.is_saturated && source.significance > SHAPE_SIGNIFICANCE
        };
        let shaped: Vec<&Source> = self.sources.iter().filter(is_shaped).collect();
        let median = |axis: usize| {
            let mut values: Vec<f64> = shaped.iter().map(|source| source.elongation[axis]).collect();
            values.sort_by(f64::total_cmp);
            values.get(values.len() / 2).copied().unwrap_or(0.0)
        };
        let (along, across) = (median(0), median(1));
        let is_trailed = shaped.len() >= SHAPE_SOURCES && libm::hypot(along, across) > TRAIL_ELONGATION;
        is_trailed.then(|| (0.5 * libm::atan2(across, along)).to_degrees().rem_euclid(180.0))
    }
}

/// Finds the sources of an image. `saturation_dn` is the value of a saturated pixel.
pub fn find_sources(image: &GreyImage, saturation_dn: f64) -> ImageSources {
    let (background, plane, smoothed, smoothed_noise_dn) = flattened(image);
    // Under clouds and moonlight the noise differs over the image.
    let deviations = Background::of_deviations(image.columns, image.rows, &smoothed.values);
    let saturation_dn = SATURATED_SHARE * saturation_dn - background.median_dn();
    let mut sources = Vec::new();
    for row in EDGE_PX..image.rows.saturating_sub(EDGE_PX) {
        for column in EDGE_PX..image.columns.saturating_sub(EDGE_PX) {
            let local_dn = deviations.at(column, row);
            let is_rough = local_dn > ROUGH_SHARE * smoothed_noise_dn;
            let noise_dn = if is_rough { local_dn } else { smoothed_noise_dn };
            if smoothed.at(column, row) < MIN_SIGMAS * noise_dn || !smoothed.is_local_maximum(column, row) {
                continue;
            }
            if let Some(mut source) = plane.measure(column, row, background.noise_dn, saturation_dn) {
                source.significance = smoothed.at(column, row) / noise_dn;
                sources.push(source);
            }
        }
    }
    sources.sort_by(|a, b| b.significance.total_cmp(&a.significance));
    sources.truncate(MAX_SOURCES);
    ImageSources { sources, background_dn: background.median_dn(), noise_dn: background.noise_dn }
}

/// Returns background, the image above it, that image smoothed, and the noise of the latter, DN: in cells
/// that follow the structure of the sky.
fn flattened(image: &GreyImage) -> (Background, Plane, Plane, f64) {
    let [large, fine] = [CELL_PX, FINE_CELL_PX].map(|cell_px| {
        let background = Background::in_cells(image, cell_px);
        let mut values = Vec::with_capacity(image.values.len());
        for row in 0..image.rows {
            for column in 0..image.columns {
                values.push(image.at(column, row) - background.at(column, row));
            }
        }
        let plane = Plane { columns: image.columns, rows: image.rows, values };
        let smoothed = plane.smoothed();
        // Measured, because neighbouring pixels of a camera with processing are not independent.
        let noise_dn = clipped(&smoothed.values).1;
        (background, plane, smoothed, noise_dn)
    });
    if fine.3 < STRUCTURE_SHARE * large.3 { fine } else { large }
}

/// Values of an image above its background.
struct Plane {
    columns: usize,
    rows: usize,
    values: Vec<f64>,
}

impl Plane {
    fn at(&self, column: usize, row: usize) -> f64 {
        self.values[row * self.columns + column]
    }

    /// Returns the plane smoothed by a Gaussian. A frame of the width of the kernel stays 0.
    fn smoothed(&self) -> Self {
        let reach = SMOOTHING_REACH as i64;
        let mut kernel: Vec<f64> = (-reach..=reach)
            .map(|i| libm::exp(-0.5 * (i * i) as f64 / (SMOOTHING_PX * SMOOTHING_PX)))
            .collect();
        let sum: f64 = kernel.iter().sum();
        kernel.iter_mut().for_each(|weight| *weight /= sum);
        self.convolved(&kernel, 1).convolved(&kernel, self.columns)
    }

    /// Returns the plane convolved with a kernel along an axis; `stride` is the distance of neighbours.
    fn convolved(&self, kernel: &[f64], stride: usize) -> Self {
        let reach = kernel.len() / 2;
        let mut values = vec![0.0; self.values.len()];
        for row in SMOOTHING_REACH..self.rows.saturating_sub(SMOOTHING_REACH) {
            for column in SMOOTHING_REACH..self.columns.saturating_sub(SMOOTHING_REACH) {
                let centre = row * self.columns + column;
                let mut sum = 0.0;
                for (index, weight) in kernel.iter().enumerate() {
                    sum += weight * self.values[centre + index * stride - reach * stride];
                }
                values[centre] = sum;
            }
        }
        Self { values, ..*self }
    }

    /// Returns true if no neighbour is higher, nor as high and before it.
    fn is_local_maximum(&self, column: usize, row: usize) -> bool {
        let height = self.at(column, row);
        for (y, is_before) in [(row - 1, true), (row, false), (row + 1, false)] {
            for x in column - 1..=column + 1 {
                let is_earlier = is_before || (y == row && x < column);
                let other = self.at(x, y);
                if other > height || (is_earlier && other == height) {
                    return false;
                }
            }
        }
        true
    }

    /// Measures the source at a maximum of the smoothed image; `None` if it has no centroid near it.
    fn measure(&self, column: usize, row: usize, noise_dn: f64, saturation_dn: f64) -> Option<Source> {
        let centre = self.centroid(column, row)?;
        let peak = self.highest_pixel(column, row);
        let (mut flux_dn, mut highest) = (0.0, f64::NEG_INFINITY);
        let (mut moment, mut weighted, mut variance) = (0.0, 0.0, 0.0);
        let (mut along, mut across) = (0.0, 0.0);
        let (first_column, first_row) = (column as i64 - WINDOW_REACH, row as i64 - WINDOW_REACH);
        for y in 0..=2 * WINDOW_REACH {
            for x in 0..=2 * WINDOW_REACH {
                let (pixel_column, pixel_row) = (first_column + x, first_row + y);
                let value = self.at(pixel_column as usize, pixel_row as usize);
                let (dx, dy) = (pixel_column as f64 - centre.x, pixel_row as f64 - centre.y);
                let weight = window(dx, dy);
                flux_dn += value;
                highest = value.max(highest);
                weighted += weight * value;
                moment += weight * value * 0.5 * (dx * dx + dy * dy);
                along += weight * value * 0.5 * (dx * dx - dy * dy);
                across += weight * value * dx * dy;
                variance += 0.5 * weight * weight * (dx * dx + dy * dy) * noise_dn * noise_dn;
            }
        }
        if flux_dn <= 0.0 || weighted <= 0.0 {
            return None;
        }
        // The window narrows a Gaussian of variance s² to s² w²/(s² + w²).
        let narrowed = moment / weighted;
        let window_variance = WINDOW_PX * WINDOW_PX;
        let width_px = (narrowed * window_variance / (window_variance - narrowed)).sqrt();
        Some(Source {
            position: centre,
            flux_dn,
            significance: 0.0,
            // The centroid follows a shift of the source by w²/(s² + w²) of it: the error is larger by as
            // much.
            sigma_px: (window_variance / (window_variance - narrowed)).min(2.0) * variance.sqrt() / weighted,
            width_px,
            elongation: [along / moment, across / moment],
            peak,
            is_spike: self.is_spike(peak),
            is_saturated: highest >= saturation_dn,
        })
    }

    /// Returns the windowed centroid: x ← x + 2 Σ w I (x_i − x)/Σ w I until the step vanishes. For a Gaussian
    /// whose width is that of the window the factor 2 makes the first step the last.
    fn centroid(&self, column: usize, row: usize) -> Option<PixelPoint> {
        let start = PixelPoint::new(column as f64, row as f64);
        let mut centre = start;
        for _ in 0..CENTROID_ROUNDS {
            let (mut sum, mut sum_x, mut sum_y) = (0.0, 0.0, 0.0);
            for y in row as i64 - WINDOW_REACH..=row as i64 + WINDOW_REACH {
                for x in column as i64 - WINDOW_REACH..=column as i64 + WINDOW_REACH {
                    let (dx, dy) = (x as f64 - centre.x, y as f64 - centre.y);
                    let weighted = window(dx, dy) * self.at(x as usize, y as usize);
                    sum += weighted;
                    sum_x += weighted * dx;
                    sum_y += weighted * dy;
                }
            }
            if sum <= 0.0 {
                return None;
            }
            let step = PixelPoint::new(2.0 * sum_x / sum, 2.0 * sum_y / sum);
            centre = PixelPoint::new(centre.x + step.x, centre.y + step.y);
            if centre.distance(start) > CENTROID_WAY_PX {
                return None;
            }
            if libm::hypot(step.x, step.y) < CENTROID_STEP_PX {
                return Some(centre);
            }
        }
        None
    }

    fn highest_pixel(&self, column: usize, row: usize) -> [usize; 2] {
        let mut highest = [column, row];
        for y in row - 1..=row + 1 {
            for x in column - 1..=column + 1 {
                if self.at(x, y) > self.at(highest[0], highest[1]) {
                    highest = [x, y];
                }
            }
        }
        highest
    }

    fn is_spike(&self, [column, row]: [usize; 2]) -> bool {
        let mut sum = 0.0;
        for y in row - 1..=row + 1 {
            for x in column - 1..=column + 1 {
                sum += self.at(x, y).max(0.0);
            }
        }
        self.at(column, row) > SPIKE_SHARE * sum
    }
}

/// Returns the weight of a pixel at an offset from the centre.
fn window(dx: f64, dy: f64) -> f64 {
    libm::exp(-0.5 * (dx * dx + dy * dy) / (WINDOW_PX * WINDOW_PX))
}
