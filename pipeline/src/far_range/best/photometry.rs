//! Photometry of clusters, and fits of their images.

use contract::{Frame, PixelPoint, Readout, Window};

use super::hot_pixels::HotPixels;
use super::image_fit::{
    FittedImage, ImageFitter, ImageModel, MAX_NEIGHBOURS, Neighbour, Pixel, PixelNoise, PointImage, Prior,
};
use super::point_image::PointImageEstimate;
use crate::far_range::detect::{Blob, Detector};

/// Parameters for the photometry of a frame.
#[derive(Debug, Clone, Copy)]
pub(super) struct PhotometryModel {
    pub(super) readout: Readout,
    /// Variance of the response of single pixels, relative.
    pub(super) response: f64,
    /// Full well, electrons; infinite if unknown.
    pub(super) full_well_e: f64,
    /// True if charge above the full well may spill along the columns.
    pub(super) may_spill: bool,
    /// Background of the frame, electrons per pixel, and standard deviation of a pixel.
    pub(super) background_e: f64,
    pub(super) pixel_sigma_e: f64,
}

/// Cluster with its photometry.
#[derive(Debug, Clone, Copy)]
pub(super) struct Source {
    pub(super) blob: Blob,
    /// Centre of brightness above the background, px.
    pub(super) centre: PixelPoint,
    /// Flux above the background, electrons.
    pub(super) flux_e: f64,
    /// Number of saturated pixels.
    pub(super) saturated: usize,
    /// True if adjacent pixels were not transmitted.
    pub(super) is_cut: bool,
    /// Index of the brightest pixel, and its electrons above the background.
    pub(super) peak: (usize, f64),
    /// Σ n² of the brightest pixel and its brightest neighbour along columns and rows, n: electrons above the
    /// background.
    pub(super) pair_e2: f64,
    /// Index of an isolated bright pixel, narrower than any optical image; `None` for other clusters.
    pub(super) spike: Option<usize>,
}

/// Fitted source in the frame.
#[derive(Debug, Clone, Copy)]
pub(super) struct FittedSource {
    pub(super) position: PixelPoint,
    pub(super) image: FittedImage,
}

/// Margin of a window beyond the pixels of a bright cluster, px.
const MARGIN_PX: usize = 5;

/// Largest side of a window, px. Bounds the time of a fit.
const MAX_SIDE_PX: usize = 48;

/// Relative error of the calibrated full well.
const WELL_ERROR: f64 = 0.25;

/// Residual of a pixel from which on it is rejected, in standard deviations: a hot pixel or a cosmic-ray hit
/// in the window.
const REJECTED_SIGMAS: f64 = 6.0;

impl PhotometryModel {
    fn electrons(&self, dn: u16) -> f64 {
        (f64::from(dn) - self.readout.bias_dn) * self.readout.gain_e_per_dn
    }

    /// Returns the electrons per digital number, and the digital number of the background.
    pub(super) fn scale(&self) -> (f32, f32) {
        let gain = self.readout.gain_e_per_dn;
        (gain as f32, (self.readout.bias_dn + self.background_e / gain) as f32)
    }

    fn is_saturated(&self, frame: &Frame, dn: u16) -> bool {
        dn >= self.readout.saturation_dn.min(frame.full_scale_dn())
    }

    /// Returns the noise of a pixel. `response` is the relative standard deviation of the pixels' response.
    fn noise(&self, response: f64) -> PixelNoise {
        let Readout { gain_e_per_dn, read_noise_e, .. } = self.readout;
        PixelNoise {
            readout_e2: read_noise_e * read_noise_e + gain_e_per_dn * gain_e_per_dn / 12.0,
            response: response * response,
        }
    }

    /// Returns the prior of the background under a source.
    fn background_prior(&self) -> Prior {
        Prior::normal(self.background_e, 0.5 * self.pixel_sigma_e)
    }

    /// Returns the photometry of a cluster with the pixels `members`. `psf` distinguishes a bright pixel from
    /// a point.
    pub(super) fn source(&self, frame: &Frame, blob: &Blob, members: &[u32], psf: &PointImage) -> Source {
        let columns = frame.columns();
        let (mut flux_e, mut sum_x, mut sum_y) = (0.0, 0.0, 0.0);
        let (mut saturated, mut is_cut) = (0, false);
        let mut peak = (0, 0);
        for &index in members {
            let (x, y) = (index as usize % columns, index as usize / columns);
            let dn = frame.dn_at(x, y);
            saturated += usize::from(self.is_saturated(frame, dn));
            if dn > peak.1 {
                peak = (index as usize, dn);
            }
            let electrons = (self.electrons(dn) - self.background_e).max(0.0);
            flux_e += electrons;
            sum_x += electrons * x as f64;
            sum_y += electrons * y as f64;
        }
        if let Some(windows) = frame.windows() {
            is_cut = members.iter().any(|&index| {
                let (x, y) = (index as usize % columns, index as usize / columns);
                touches_the_outside(windows, frame, x, y)
            });
        }
        let centre = if flux_e > 0.0 { PixelPoint::new(sum_x / flux_e, sum_y / flux_e) } else { blob.centre };
        let spike = (saturated <= 1 && self.is_spike(frame, peak.0, psf)).then_some(peak.0);
        let peak_e = self.electrons(peak.1) - self.background_e;
        let second_e = self.brightest_neighbour_e(frame, peak.0);
        let pair_e2 = peak_e * peak_e + second_e * second_e;

        Source { blob: *blob, centre, flux_e, saturated, is_cut, peak: (peak.0, peak_e), pair_e2, spike }
    }

    /// Returns the electrons above the background of the brightest neighbour of a pixel along columns and
    /// rows.
    fn brightest_neighbour_e(&self, frame: &Frame, index: usize) -> f64 {
        let (x, y) = (index % frame.columns(), index / frame.columns());
        let neighbours = [(x.wrapping_sub(1), y), (x + 1, y), (x, y.wrapping_sub(1)), (x, y + 1)];
        neighbours
            .into_iter()
            .filter(|&(x, y)| x < frame.columns() && y < frame.rows() && is_transmitted(frame, x, y))
            .map(|(x, y)| self.electrons(frame.dn_at(x, y)) - self.background_e)
            .fold(0.0, f64::max)
    }

    /// Returns true if the pixel's share of the surrounding flux significantly exceeds the mean of the
    /// central share of a point's image and 1.
    fn is_spike(&self, frame: &Frame, index: usize, psf: &PointImage) -> bool {
        let (x, y) = (index % frame.columns(), index / frame.columns());
        let above = |x: usize, y: usize| self.electrons(frame.dn_at(x, y)) - self.background_e;
        let peak_e = above(x, y);
        let mut around_e = 0.0;
        for row in y.saturating_sub(1)..(y + 2).min(frame.rows()) {
            for column in x.saturating_sub(1)..(x + 2).min(frame.columns()) {
                if is_transmitted(frame, column, row) {
                    around_e += above(column, row);
                }
            }
        }
        let limit = 0.5 + 0.5 * psf.central_share();
        let sigma_e = (8.0 * limit * limit * self.pixel_sigma_e * self.pixel_sigma_e
            + (1.0 - limit) * (1.0 - limit) * (self.pixel_sigma_e * self.pixel_sigma_e + peak_e.max(0.0)))
        .sqrt();
        peak_e - limit * around_e > 1.5 * sigma_e
    }
}

/// Fitter of source images, with reusable buffers.
#[derive(Debug, Default)]
pub(super) struct SourceFitter {
    fitter: ImageFitter,
    pixels: Vec<Pixel>,
    kept: Vec<Pixel>,
    saturated: Vec<(usize, usize)>,
}

/// Known source near the fitted one.
#[derive(Debug, Clone, Copy)]
pub(super) struct KnownSource {
    pub(super) position: PixelPoint,
    pub(super) flux_e: f64,
    /// Relative standard deviation of the flux.
    pub(super) flux_sigma: f64,
    pub(super) image: PointImage,
}

/// Frame with its clusters and the parameters of the camera.
#[derive(Clone, Copy)]
pub(super) struct PhotometryContext<'a> {
    pub(super) frame: &'a Frame,
    pub(super) detector: &'a Detector,
    pub(super) model: &'a PhotometryModel,
    pub(super) hot_pixels: &'a HotPixels,
    /// Flux of a point whose central pixel is at the threshold of clusters, electrons.
    pub(super) threshold_e: f64,
}

impl PhotometryContext<'_> {
    /// Returns true if all pixels within a distance of a position, along columns and rows, were transmitted.
    pub(super) fn is_well_inside(&self, position: PixelPoint, distance_px: f64) -> bool {
        let [x, y] = [position.x, position.y];
        let corners = [-distance_px, distance_px].map(|d| ((x + d).round(), (y + d).round()));
        let (columns, rows) = (self.frame.columns() as f64, self.frame.rows() as f64);
        corners.iter().all(|(x, y)| (0.0..columns).contains(x) && (0.0..rows).contains(y))
            && match self.frame.windows() {
                None => true,
                Some(windows) => windows
                    .iter()
                    .any(|window| corners.iter().all(|(x, y)| window.contains(*x as usize, *y as usize))),
            }
    }

    /// Returns true if a pixel of a cluster is within a distance of a position, along columns and rows.
    pub(super) fn is_near_cluster(&self, position: PixelPoint, distance_px: f64) -> bool {
        let range = |at: f64, size: usize| {
            let first = (at - distance_px).ceil().max(0.0) as usize;
            first..=((at + distance_px).floor().max(0.0) as usize).min(size - 1)
        };
        let (columns, rows) = (self.frame.columns(), self.frame.rows());
        range(position.y, rows)
            .any(|y| range(position.x, columns).any(|x| self.detector.is_in_cluster(y * columns + x)))
    }
}

/// Rectangle of pixels, clipped to the frame.
#[derive(Debug, Clone, Copy)]
struct FitWindow {
    x: usize,
    y: usize,
    columns: usize,
    rows: usize,
}

impl SourceFitter {
    /// Fits a star, or a candidate treated as a point. Returns `None` when there is no maximum. The halo, a
    /// few percent of the flux, counts as background.
    pub(super) fn point(
        &mut self,
        context: PhotometryContext<'_>,
        source: &Source,
        members: &[u32],
        psf: &PointImageEstimate,
        trail_px: [f64; 2],
    ) -> Option<FittedSource> {
        let image = psf.image(trail_px);
        let reach = (3.5 * image.sigma_px + 0.5 * trail_px[0].max(trail_px[1])).ceil().max(2.0) as usize;
        let extent = Extent::from_members(context.frame, members);
        let window = if source.saturated == 0 && extent.side() <= 2 * reach + 1 {
            FitWindow::about(context.frame, extent.rounded(source.centre), reach)?
        } else {
            FitWindow::around(context.frame, extent, MARGIN_PX)?
        };
        self.gather(context, window, members, &[], context.model.may_spill);
        let centre = source.centre;
        let model = ImageModel {
            x_px: Prior::free(centre.x - window.x as f64),
            y_px: Prior::free(centre.y - window.y as f64),
            flux_e: Prior::free(source.flux_e.max(1.0)),
            background_e: context.model.background_prior(),
            log_width: Prior::normal(0.0, psf.log_width_sigma()),
            log_elongation: Prior::fixed(0.0),
            halo_fraction: Prior::fixed(0.0),
            image,
            neighbours: &[],
        };
        let noise = context.model.noise(context.model.response);
        let fitted = self.fitter.fit(&self.pixels, window.size(), noise, &model)?;
        Some(window.in_frame(fitted))
    }

    /// Fits the image of the target, a point or a small body at `start`, with its known neighbours. The
    /// start's `position_sigma_px` is the standard deviation of a predicted position, or infinite for a
    /// cluster's position.
    pub(super) fn target(
        &mut self,
        context: PhotometryContext<'_>,
        start: &TargetStart<'_>,
        psf: &PointImageEstimate,
        known: &[KnownSource],
    ) -> Option<FittedSource> {
        let image = psf.image([0.0; 2]);
        let reach = (4.0 * image.sigma_px).ceil().max(3.0) as usize + 1;
        let window = match start.members {
            [] => FitWindow::about(context.frame, rounded(context.frame, start.position)?, reach)?,
            members => {
                let extent = Extent::from_members(context.frame, members);
                let margin = if start.is_saturated { MARGIN_PX + 2 } else { reach - 1 };
                FitWindow::around(context.frame, extent, margin)?
            }
        };
        let near = |source: &&KnownSource| window.distance_px(source.position) <= 3.0;
        let mut near: Vec<&KnownSource> = known.iter().filter(near).collect();
        near.sort_by(|a, b| b.flux_e.total_cmp(&a.flux_e));
        near.truncate(MAX_NEIGHBOURS);
        let neighbours: Vec<Neighbour> = near
            .iter()
            .map(|source| Neighbour {
                x_px: source.position.x - window.x as f64,
                y_px: source.position.y - window.y as f64,
                flux_e: Prior::normal(source.flux_e, source.flux_sigma * source.flux_e),
                image: source.image,
            })
            .collect();
        let mut fitted =
            self.fit_from_all_starts(context, window, start, psf, &neighbours, context.model.may_spill)?;
        if context.model.may_spill
            && !self.saturated.is_empty()
            && !self.spills(&fitted, context.model, &image)
        {
            // No well overflows, so the pixels beside saturated ones contain only their own charge.
            fitted =
                self.fit_from_all_starts(context, window, start, psf, &neighbours, false).unwrap_or(fitted);
        }
        Some(window.in_frame(fitted))
    }

    /// Returns the fit with the smallest χ² among those from the given start and, for an image truncated in
    /// its bright part, from positions beyond the cut.
    fn fit_from_all_starts(
        &mut self,
        context: PhotometryContext<'_>,
        window: FitWindow,
        start: &TargetStart<'_>,
        psf: &PointImageEstimate,
        neighbours: &[Neighbour],
        spills: bool,
    ) -> Option<FittedImage> {
        self.gather(context, window, start.members, neighbours, spills);
        let image = psf.image([0.0; 2]);
        let noise = context.model.noise(context.model.response);
        let position_prior =
            |mean: f64| Prior { mean, variance: start.position_sigma_px * start.position_sigma_px };
        let (x, y) = (start.position.x - window.x as f64, start.position.y - window.y as f64);
        let mut model = ImageModel {
            x_px: position_prior(x),
            y_px: position_prior(y),
            flux_e: Prior::free(start.flux_e.max(1.0)),
            background_e: context.model.background_prior(),
            log_width: Prior::normal(0.0, libm::hypot(psf.log_width_sigma(), start.body_log_width)),
            log_elongation: Prior::normal(0.0, start.body_log_width),
            halo_fraction: Prior::normal(image.halo_fraction, psf.halo_sigma),
            image,
            neighbours,
        };
        let mut best = self.fitter.fit(&self.pixels, window.size(), noise, &model);
        if start.is_cut && start.is_saturated && best.is_none_or(|best| best.misfit() > CUT_MISFIT) {
            let rows = self.pixels.iter().map(|pixel| pixel.row);
            let (first, last) = (rows.clone().min()? as f64, rows.max()? as f64);
            for y in [first - 0.5, 0.5 * (y + last), last, last + 0.7, last + 2.0, last + 4.0] {
                model.y_px = Prior::free(y);
                let fitted = self.fitter.fit(&self.pixels, window.size(), noise, &model);
                best = better(best, fitted);
            }
        }
        if best.is_none_or(|best| best.misfit() > EXTENDED_MISFIT) {
            // Assumes a body of several pixels.
            model.y_px = position_prior(best.map_or(y, |best| best.y_px));
            model.log_width = Prior::normal(0.5, 1.0);
            model.log_elongation = Prior::normal(0.0, 0.3);
            best = better(best, self.fitter.fit(&self.pixels, window.size(), noise, &model));
        }
        let fitted = best?;
        self.without_outliers(&fitted, window, noise, &model).or(best)
    }

    /// Repeats the fit without pixels whose residuals cannot be noise. Returns `None` if there are no such
    /// pixels, or too many.
    fn without_outliers(
        &mut self,
        fitted: &FittedImage,
        window: FitWindow,
        noise: PixelNoise,
        model: &ImageModel<'_>,
    ) -> Option<FittedImage> {
        if fitted.misfit() < 1.5 {
            return None;
        }
        let image = PointImage {
            sigma_px: model.image.sigma_px * fitted.width,
            halo_fraction: fitted.halo_fraction,
            ..model.image
        };
        self.kept.clear();
        self.kept.extend(self.pixels.iter().filter(|pixel| {
            let mean = fitted.background_e
                + fitted.flux_e
                    * image.share(pixel.column as f64 - fitted.x_px, pixel.row as f64 - fitted.y_px)
                + model
                    .neighbours
                    .iter()
                    .map(|n| {
                        n.flux_e.mean * n.image.share(pixel.column as f64 - n.x_px, pixel.row as f64 - n.y_px)
                    })
                    .sum::<f64>();
            // A model error of 5 % does not make an outlier.
            let sigma = (noise.readout_e2 + mean.max(0.0) + (0.05 * mean) * (0.05 * mean)).sqrt();
            pixel.electrons - mean < REJECTED_SIGMAS * sigma
        }));
        let rejected = self.pixels.len() - self.kept.len();
        if rejected == 0 || rejected > self.pixels.len() / 20 + 2 {
            return None;
        }
        let model = ImageModel {
            x_px: Prior { mean: fitted.x_px, ..model.x_px },
            y_px: Prior { mean: fitted.y_px, ..model.y_px },
            flux_e: Prior { mean: fitted.flux_e, ..model.flux_e },
            ..*model
        };
        self.fitter.fit(&self.kept, window.size(), noise, &model)
    }

    /// Returns true if the fitted image fills a well until charge spills, if the full well is too high by
    /// [`WELL_ERROR`].
    fn spills(&self, fitted: &FittedImage, model: &PhotometryModel, image: &PointImage) -> bool {
        let image = PointImage { sigma_px: image.sigma_px * fitted.width, ..*image };
        // The brightest pixel of a column decides, transmitted or not.
        let brightest_row = fitted.y_px.round() - fitted.y_px;
        self.saturated.iter().any(|&(column, _)| {
            let share = image.share(column as f64 - fitted.x_px, brightest_row);
            fitted.background_e + fitted.flux_e * share > (1.0 - WELL_ERROR) * model.full_well_e
        })
    }

    /// Collects the pixels of a window that are free of foreign signal: transmitted, not saturated, not hot,
    /// without spilt charge, and in no other clusters than those of known sources.
    fn gather(
        &mut self,
        context: PhotometryContext<'_>,
        window: FitWindow,
        members: &[u32],
        known: &[Neighbour],
        spills: bool,
    ) {
        let PhotometryContext { frame, detector, model, hot_pixels, .. } = context;
        let columns = frame.columns();
        self.saturated.clear();
        for row in 0..window.rows {
            for column in 0..window.columns {
                let dn = frame.dn_at(window.x + column, window.y + row);
                if model.is_saturated(frame, dn) {
                    self.saturated.push((column, row));
                }
            }
        }
        let windows: Option<Vec<&Window>> =
            frame.windows().map(|all| all.iter().filter(|sent| window.overlaps(sent)).collect());
        let is_own = |index: usize| members.contains(&(index as u32));
        let is_of_known = |x: usize, y: usize| {
            let (x, y) = (x as f64 - window.x as f64, y as f64 - window.y as f64);
            known.iter().any(|at| (at.x_px - x).abs() <= 4.0 && (at.y_px - y).abs() <= 4.0)
        };
        let is_foreign = |x: usize, y: usize| {
            let index = y * columns + x;
            detector.is_in_cluster(index) && !is_own(index) && !is_of_known(x, y)
        };
        self.pixels.clear();
        for row in 0..window.rows {
            for column in 0..window.columns {
                let (x, y) = (window.x + column, window.y + row);
                let dn = frame.dn_at(x, y);
                let is_sent = windows.as_ref().is_none_or(|sent| sent.iter().any(|sent| sent.contains(x, y)));
                if !is_sent || model.is_saturated(frame, dn) || hot_pixels.contains(y * columns + x) {
                    continue;
                }
                if spills && self.saturated.iter().any(|&(c, r)| c == column && r.abs_diff(row) <= 1) {
                    continue;
                }
                let beside = (x.saturating_sub(1)..(x + 2).min(columns))
                    .any(|x| (y.saturating_sub(1)..(y + 2).min(frame.rows())).any(|y| is_foreign(x, y)));
                if beside && !is_own(y * columns + x) {
                    continue;
                }
                self.pixels.push(Pixel { column, row, electrons: model.electrons(dn) });
            }
        }
    }
}

/// Misfit of the image of a truncated cluster above which other positions are tried.
const CUT_MISFIT: f64 = 1.4;

/// Misfit above which a wider image is tried.
const EXTENDED_MISFIT: f64 = 4.0;

/// Start of a fit of the target's image.
#[derive(Debug, Clone, Copy)]
pub(super) struct TargetStart<'a> {
    pub(super) position: PixelPoint,
    /// Standard deviation of the position along an axis, px, if the position is a prior; otherwise infinite.
    pub(super) position_sigma_px: f64,
    pub(super) flux_e: f64,
    /// Standard deviation of the logarithm of the image's width relative to that of a point, due to the size
    /// of the body.
    pub(super) body_log_width: f64,
    /// Pixels of the start's cluster; empty without a cluster.
    pub(super) members: &'a [u32],
    pub(super) is_saturated: bool,
    pub(super) is_cut: bool,
}

fn better(a: Option<FittedImage>, b: Option<FittedImage>) -> Option<FittedImage> {
    match (a, b) {
        (Some(a), Some(b)) => Some(if b.chi_squared < a.chi_squared && b.flux_e > 0.0 { b } else { a }),
        (a, b) => a.or(b),
    }
}

/// First and last column and row of the pixels of a cluster.
#[derive(Debug, Clone, Copy)]
struct Extent {
    x: (usize, usize),
    y: (usize, usize),
}

impl Extent {
    fn from_members(frame: &Frame, members: &[u32]) -> Self {
        let columns = frame.columns();
        let mut extent = Self { x: (usize::MAX, 0), y: (usize::MAX, 0) };
        for &index in members {
            let (x, y) = (index as usize % columns, index as usize / columns);
            extent.x = (extent.x.0.min(x), extent.x.1.max(x));
            extent.y = (extent.y.0.min(y), extent.y.1.max(y));
        }
        extent
    }

    fn side(&self) -> usize {
        (self.x.1 + 1).saturating_sub(self.x.0).max((self.y.1 + 1).saturating_sub(self.y.0))
    }

    /// Returns the pixel of a position, clamped to the extent.
    fn rounded(&self, position: PixelPoint) -> (usize, usize) {
        let within = |v: f64, (first, last): (usize, usize)| {
            (v.round().max(0.0) as usize).clamp(first, last.max(first))
        };
        (within(position.x, self.x), within(position.y, self.y))
    }
}

/// Returns the pixel of a position; `None` outside the detector.
fn rounded(frame: &Frame, position: PixelPoint) -> Option<(usize, usize)> {
    position
        .is_on_detector(frame.columns(), frame.rows())
        .then(|| (position.x.round().max(0.0) as usize, position.y.round().max(0.0) as usize))
}

impl FitWindow {
    fn about(frame: &Frame, (x, y): (usize, usize), reach: usize) -> Option<Self> {
        Self::around(frame, Extent { x: (x, x), y: (y, y) }, reach)
    }

    /// Returns the window of the pixels of an extent with `margin` around them, clipped to the frame; `None`
    /// if the window is too large.
    fn around(frame: &Frame, extent: Extent, margin: usize) -> Option<Self> {
        let clip = |(first, last): (usize, usize), n: usize| {
            let first = first.min(n - 1).saturating_sub(margin);
            (first, (last + margin + 1).min(n).saturating_sub(first))
        };
        let ((x, columns), (y, rows)) = (clip(extent.x, frame.columns()), clip(extent.y, frame.rows()));
        (columns.max(rows) <= MAX_SIDE_PX && columns.min(rows) > 0).then_some(Self { x, y, columns, rows })
    }

    fn size(&self) -> (usize, usize) {
        (self.columns, self.rows)
    }

    fn overlaps(&self, window: &Window) -> bool {
        window.x < self.x + self.columns
            && self.x < window.x + window.columns
            && window.y < self.y + self.rows
            && self.y < window.y + window.rows
    }

    /// Returns the distance of a position from the window, 0 inside, px.
    fn distance_px(&self, position: PixelPoint) -> f64 {
        let beyond =
            |v: f64, first: usize, n: usize| (first as f64 - v).max(v - (first + n - 1) as f64).max(0.0);
        beyond(position.x, self.x, self.columns).max(beyond(position.y, self.y, self.rows))
    }

    fn in_frame(&self, image: FittedImage) -> FittedSource {
        FittedSource {
            position: PixelPoint::new(self.x as f64 + image.x_px, self.y as f64 + image.y_px),
            image,
        }
    }
}

fn is_transmitted(frame: &Frame, x: usize, y: usize) -> bool {
    frame.windows().is_none_or(|windows| windows.iter().any(|window| window.contains(x, y)))
}

/// Returns true if a neighbour of a pixel is on the detector but was not transmitted.
fn touches_the_outside(windows: &[Window], frame: &Frame, x: usize, y: usize) -> bool {
    let sent = |x: usize, y: usize| windows.iter().any(|window| window.contains(x, y));
    (x > 0 && !sent(x - 1, y))
        || (x + 1 < frame.columns() && !sent(x + 1, y))
        || (y > 0 && !sent(x, y - 1))
        || (y + 1 < frame.rows() && !sent(x, y + 1))
}
