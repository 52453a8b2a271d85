//! Centres of clusters: the brightness centre of Eq. 1, or a fitted one.

use contract::{Frame, PixelPoint, Readout};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::detect::{Blob, Detector, FittedCentre};
use super::profile_fit::{MAX_COMPONENTS, ProfileFit, Sample, Shape, Start};

/// How the centre of a cluster is measured.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "mode", rename_all = "snake_case", deny_unknown_fields)]
pub enum CentroidConfig {
    /// The brightness centre of the cluster's pixels (Eq. 1), the paper's.
    #[default]
    Brightness,
    /// A circular image fitted to the pixels about the cluster by maximum likelihood, which knows the noise of each and
    /// leaves out those that are saturated, not transmitted or another cluster's. Needs the camera's readout. Where no fit
    /// is found, the brightness centre stays. Detection, identification, tracking and motion segmentation keep the
    /// brightness centre; the attitude (Eq. 14), the line of sight (Eq. 17) and the reported places take the fitted one.
    Fit {
        /// Width of the image of a point, standard deviation, px, 0.3 to 10; without it the width of every cluster is fitted
        /// with it, which costs faint stars some accuracy.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        #[schemars(range(min = 0.3, max = 10))]
        psf_sigma_px: Option<f64>,
    },
}

impl CentroidConfig {}

/// Width that a fit of the width starts from, px: a sharp star tracker lens.
const TYPICAL_SIGMA_PX: f64 = 0.8;

/// Half the side of the window about a point, in widths of its image, and px beyond the outermost bright pixel about
/// anything larger: enough dark pixels to know the background by.
const REACH_SIGMAS: f64 = 5.0;
const MARGIN_PX: usize = 4;

/// Largest side of a window, px: bounds the time of a fit, about 1 ms.
const MAX_SIDE_PX: usize = 64;

/// A fitted centre less certain than this is worth no more than the brightness centre, px.
const MAX_SIGMA_PX: f64 = 1.0;

/// Fits the centres of clusters; owns its buffers.
#[derive(Debug)]
pub(super) struct CentroidFitter {
    psf_sigma_px: Option<f64>,
    readout: Readout,
    profile: ProfileFit,
    samples: Vec<Sample>,
    own: Vec<bool>,
}

/// A rectangle of pixels, clipped to the frame.
#[derive(Debug, Clone, Copy)]
struct FitWindow {
    x: usize,
    y: usize,
    columns: usize,
    rows: usize,
}

/// What the pixels of a cluster tell before anything is fitted.
#[derive(Debug, Clone, Copy)]
struct Extent {
    /// First and last column and row.
    x: (usize, usize),
    y: (usize, usize),
    /// Mean place of the saturated pixels, if there are any.
    saturated: Option<PixelPoint>,
}

impl CentroidFitter {
    pub(super) fn new(psf_sigma_px: Option<f64>, readout: Readout) -> Self {
        Self { psf_sigma_px, readout, profile: ProfileFit::default(), samples: Vec::new(), own: Vec::new() }
    }

    /// Fits the centre of every cluster of the last frame detected.
    pub(super) fn fit(&mut self, frame: &Frame, detector: &Detector, blobs: &mut [Blob]) {
        for (i, blob) in blobs.iter_mut().enumerate() {
            blob.fitted = self.fitted(frame, detector, detector.members(i), blob);
        }
    }

    fn fitted(
        &mut self,
        frame: &Frame,
        detector: &Detector,
        members: &[u32],
        blob: &Blob,
    ) -> Option<FittedCentre> {
        let extent = self.extent(frame, members)?;
        let sigma = self.psf_sigma_px.unwrap_or(TYPICAL_SIGMA_PX);
        let reach = (REACH_SIGMAS * sigma).ceil() as usize;
        let (width, height) = (extent.x.1 - extent.x.0 + 1, extent.y.1 - extent.y.0 + 1);
        let is_point = extent.saturated.is_none() && width.max(height) <= 2 * reach + 1;
        let (shape, window, start) = if is_point {
            let mut sigmas_px = [0.0; MAX_COMPONENTS];
            sigmas_px[0] = sigma;
            let shape = Shape { sigmas_px, components: 1, is_width_free: self.psf_sigma_px.is_none() };
            let (x, y) = (blob.centre.x.round() as usize, blob.centre.y.round() as usize);
            (shape, FitWindow::about(frame, (x, x), (y, y), reach), blob.centre)
        } else {
            // Core and halo, saturated and cut, or a body that is no point: any circular profile.
            let sigmas_px = [sigma, 2.0 * sigma, 4.0 * sigma, 8.0 * sigma];
            let shape = Shape { sigmas_px, components: MAX_COMPONENTS, is_width_free: false };
            // A cut image's brightness centre is that of what is left; its saturated core is nearer.
            (
                shape,
                FitWindow::about(frame, extent.x, extent.y, MARGIN_PX),
                extent.saturated.unwrap_or(blob.centre),
            )
        };
        if window.columns.max(window.rows) > MAX_SIDE_PX {
            return None;
        }
        self.gather(frame, detector, members, window);
        let background_e = self.lower_quartile_e()?;
        let light_e: f64 = self.samples.iter().map(|sample| (sample.electrons - background_e).max(0.0)).sum();
        let start = Start {
            x_px: start.x - window.x as f64,
            y_px: start.y - window.y as f64,
            background_e,
            flux_e: light_e.max(1.0),
        };
        let noise_e2 = self.readout.read_noise_e * self.readout.read_noise_e
            + self.readout.gain_e_per_dn * self.readout.gain_e_per_dn / 12.0;
        let fitted =
            self.profile.fit(&self.samples, (window.columns, window.rows), noise_e2, &shape, start)?;
        // A form that is not the image's is believed less; noise alone must not change weights much.
        let misfit = fitted.misfit.max(1.0).sqrt();
        let variance = fitted.sigma_x_px * fitted.sigma_x_px + fitted.sigma_y_px * fitted.sigma_y_px;
        let sigma_px = misfit * (0.5 * variance).sqrt();
        let position = PixelPoint::new(window.x as f64 + fitted.x_px, window.y as f64 + fitted.y_px);
        (sigma_px <= MAX_SIGMA_PX).then_some(FittedCentre { position, sigma_px })
    }

    fn extent(&self, frame: &Frame, members: &[u32]) -> Option<Extent> {
        let columns = frame.columns();
        let first = *members.first()? as usize;
        let (mut x, mut y) = ((first % columns, first % columns), (first / columns, first / columns));
        let (mut sum_x, mut sum_y, mut saturated) = (0.0, 0.0, 0.0);
        for &index in members {
            let at = (index as usize % columns, index as usize / columns);
            x = (x.0.min(at.0), x.1.max(at.0));
            y = (y.0.min(at.1), y.1.max(at.1));
            if self.is_saturated(frame, frame.at(at.0, at.1)) {
                (sum_x, sum_y, saturated) = (sum_x + at.0 as f64, sum_y + at.1 as f64, saturated + 1.0);
            }
        }
        let saturated = (saturated > 0.0).then(|| PixelPoint::new(sum_x / saturated, sum_y / saturated));
        Some(Extent { x, y, saturated })
    }

    fn is_saturated(&self, frame: &Frame, dn: u16) -> bool {
        dn >= self.readout.saturation_dn.min(frame.full_scale_dn())
    }

    /// Collects the pixels of the window that are believed: transmitted, not saturated, and neither another cluster's nor
    /// beside one.
    fn gather(&mut self, frame: &Frame, detector: &Detector, members: &[u32], window: FitWindow) {
        let columns = frame.columns();
        self.own.clear();
        self.own.resize(window.columns * window.rows, false);
        for &index in members {
            let (x, y) = (index as usize % columns, index as usize / columns);
            if window.contains(x, y) {
                self.own[(y - window.y) * window.columns + x - window.x] = true;
            }
        }
        self.samples.clear();
        for row in 0..window.rows {
            for column in 0..window.columns {
                let (x, y) = (window.x + column, window.y + row);
                let dn = frame.at(x, y);
                if !self.is_saturated(frame, dn)
                    && is_transmitted(frame, x, y)
                    && !self.is_beside_another(frame, detector, window, (x, y))
                {
                    let electrons = (f64::from(dn) - self.readout.bias_dn) * self.readout.gain_e_per_dn;
                    self.samples.push(Sample { column, row, electrons });
                }
            }
        }
    }

    /// Whether a pixel or one of its neighbours in the window belongs to another cluster.
    fn is_beside_another(
        &self,
        frame: &Frame,
        detector: &Detector,
        window: FitWindow,
        (x, y): (usize, usize),
    ) -> bool {
        let xs = x.saturating_sub(1).max(window.x)..(x + 2).min(window.x + window.columns);
        let ys = y.saturating_sub(1).max(window.y)..(y + 2).min(window.y + window.rows);
        ys.flat_map(|y| xs.clone().map(move |x| (x, y))).any(|(x, y)| {
            !self.own[(y - window.y) * window.columns + x - window.x]
                && detector.is_in_cluster(y * frame.columns() + x)
        })
    }

    /// The lower quartile of the pixels: about the background, whatever shines in the window.
    fn lower_quartile_e(&self) -> Option<f64> {
        let mut electrons: Vec<f64> = self.samples.iter().map(|sample| sample.electrons).collect();
        electrons.sort_by(f64::total_cmp);
        electrons.get(electrons.len() / 4).copied()
    }
}

impl FitWindow {
    /// The pixels from the first to the last column and row and `margin` beyond, clipped to the frame.
    fn about(frame: &Frame, x: (usize, usize), y: (usize, usize), margin: usize) -> Self {
        let clip = |(first, last): (usize, usize), n: usize| {
            let first = first.min(n - 1).saturating_sub(margin);
            (first, (last + margin + 1).min(n) - first)
        };
        let ((x, columns), (y, rows)) = (clip(x, frame.columns()), clip(y, frame.rows()));
        Self { x, y, columns, rows }
    }

    fn contains(&self, x: usize, y: usize) -> bool {
        (self.x..self.x + self.columns).contains(&x) && (self.y..self.y + self.rows).contains(&y)
    }
}

/// Whether a pixel arrived: one that did not is 0 and means nothing.
fn is_transmitted(frame: &Frame, x: usize, y: usize) -> bool {
    frame.windows().is_none_or(|windows| windows.iter().any(|window| window.contains(x, y)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::far_range::threshold::Thresholds;

    const SIGMA_PX: f64 = 0.8;
    const READOUT: Readout =
        Readout { gain_e_per_dn: 1.0, bias_dn: 100.0, read_noise_e: 5.0, saturation_dn: 4095 };
    const BACKGROUND_E: f64 = 50.0;
    const FLUX_E: f64 = 2000.0;

    /// The share of a Gaussian image in the pixels `d` px from its centre along one axis, and how it grows with the centre.
    fn share(d: f64) -> (f64, f64) {
        let at = |edge: f64| edge / (SIGMA_PX * std::f64::consts::SQRT_2);
        let density =
            |edge: f64| libm::exp(-at(edge) * at(edge)) / (SIGMA_PX * (2.0 * std::f64::consts::PI).sqrt());
        (0.5 * (libm::erf(at(d + 0.5)) - libm::erf(at(d - 0.5))), density(d - 0.5) - density(d + 0.5))
    }

    /// With the image on the middle of a pixel its place goes with neither flux nor background, and its variance is
    /// 1/Σ (∂m/∂x)²/(m + r²) over the pixels of the fit (Cramér and Rao): the bias is no light and makes no noise.
    #[test]
    fn the_sigma_of_a_centre_is_the_bound_of_its_light_background_and_readout() {
        let offsets = || (-10..=10).map(f64::from);
        let mean = |x: f64, y: f64| BACKGROUND_E + FLUX_E * share(x).0 * share(y).0;
        let dn =
            offsets().flat_map(|y| offsets().map(move |x| (READOUT.bias_dn + mean(x, y)).round() as u16));
        let frame = Frame::new(0, 21, 21, 12, dn.collect(), None).unwrap();
        let mut detector = Detector::default();
        let thresholds = Thresholds { low_dn: 200, high_dn: 300 };
        detector.look(&frame, thresholds);
        let mut blobs = detector.detect(&frame, thresholds, 150.0, 10).to_vec();
        CentroidFitter::new(Some(SIGMA_PX), READOUT).fit(&frame, &detector, &mut blobs);
        let fitted = blobs[0].fitted.unwrap();
        // Four pixels to either side: five widths of the image.
        let inside = || offsets().filter(|d| d.abs() < 4.5);
        let information = inside().flat_map(|y| inside().map(move |x| (x, y))).map(|(x, y)| {
            let slope = FLUX_E * share(x).1 * share(y).0;
            slope * slope / (mean(x, y) + 25.0 + 1.0 / 12.0)
        });
        let bound_px = 1.0 / information.sum::<f64>().sqrt();
        // Rounding to whole electrons moves light and background by less than a percent.
        assert!((fitted.sigma_px / bound_px - 1.0).abs() < 0.01, "{} of {bound_px}", fitted.sigma_px);
        assert!(fitted.position.distance(PixelPoint::new(10.0, 10.0)) < 1e-3, "{:?}", fitted.position);
    }
}
