//! Blur of an image.

/// Variance of the blur by lens and video along columns and rows, px², without the pixel's box.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Blur {
    pub(super) x: f64,
    pub(super) y: f64,
    /// Share of the blur that acts on pixel values rather than on the optical image.
    pub(super) grid: f64,
    /// Weights of a sampled Gaussian at 0, 1 … px along columns and rows.
    pub(super) taps: [[f64; TAPS]; 2],
}

/// Number of weights of the sampled Gaussian on one side, including the centre.
pub(super) const TAPS: usize = 6;

impl Blur {
    /// Returns a continuous blur.
    pub(super) fn new(x: f64, y: f64) -> Self {
        Self { x, y, grid: 0.0, taps: [[0.0; TAPS]; 2] }
    }

    /// Returns a blur of which a share acts on pixel values: a sampled Gaussian applied to values already
    /// integrated by the pixels, as in a digital filter.
    pub(super) fn on_grid(x: f64, y: f64, share: f64) -> Self {
        let taps = [x, y].map(|variance| {
            let mut taps = [0.0; TAPS];
            for (k, tap) in taps.iter_mut().enumerate() {
                *tap = libm::exp(-0.5 * (k * k) as f64 / variance);
            }
            let sum = 2.0 * taps.iter().sum::<f64>() - taps[0];
            taps.map(|tap| tap / sum)
        });
        Self { x, y, grid: share, taps }
    }
}

/// Variance of a pixel's box along one side, px².
pub(super) const BOX_VARIANCE: f64 = 1.0 / 12.0;
