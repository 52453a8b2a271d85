//! Background of an expected image, in layers.

use optics::pixel_factors::PixelFactors;
use optics::smooth_field::SmoothField;

/// Background of every pixel: (light + smooth + field) · response + dark + pattern.
#[derive(Debug, Clone, Default)]
pub(super) struct Background {
    /// Flat background light, electrons.
    pub(super) light_e: f64,
    /// Smooth field of background light, and the factor that converts it to electrons.
    pub(super) smooth: Option<(SmoothField, f64)>,
    /// Further background light by pixel, electrons, row by row; empty if there is none.
    pub(super) field: Vec<f64>,
    /// Response factors of the light; 1 if absent.
    pub(super) response: Option<PixelFactors>,
    /// Flat electrons to which the response is not applied.
    pub(super) dark_e: f64,
    /// Electrons to which the response is not applied, and their factor for each pixel; zero where a factor
    /// is missing.
    pub(super) pattern: Option<(f64, PixelFactors)>,
}

impl Background {
    /// Computes the background of the pixels of row `y` from column `x` on, in an image of `columns`.
    #[inline(always)]
    pub(super) fn span(&self, x: usize, y: usize, columns: usize, out: &mut [f64]) {
        if !self.is_uneven() {
            out.fill(self.light_e + self.dark_e);
            return;
        }
        let pixels = y * columns + x..y * columns + x + out.len();
        match &self.smooth {
            Some((smooth, scale)) => {
                out.fill(0.0);
                smooth.span(x, y, out);
                for out in out.iter_mut() {
                    *out = self.light_e + scale * *out;
                }
            }
            None => out.fill(self.light_e),
        }
        if let Some(field) = self.field.get(pixels) {
            for (out, field) in out.iter_mut().zip(field) {
                *out += field;
            }
        }
        if let Some(response) = self.response.as_ref().filter(|response| response.has_row(y, columns)) {
            for (pixels, factors) in response.span(x, y, out.len()) {
                for (out, &factor) in out[pixels].iter_mut().zip(factors) {
                    *out *= f64::from(factor);
                }
            }
        }
        match self.pattern.as_ref().filter(|(_, factors)| factors.has_row(y, columns)) {
            Some((electrons, factors)) => {
                for (pixels, factors) in factors.span(x, y, out.len()) {
                    for (out, &factor) in out[pixels].iter_mut().zip(factors) {
                        *out += self.dark_e + electrons * f64::from(factor);
                    }
                }
            }
            None => {
                for out in out.iter_mut() {
                    *out += self.dark_e;
                }
            }
        }
    }

    /// Computes [`Background::span`] for one pixel of an image of `columns`, by identical steps.
    pub(super) fn electrons_at(&self, x: usize, y: usize, columns: usize) -> f64 {
        let index = y * columns + x;
        let mut electrons = match &self.smooth {
            Some((smooth, scale)) => self.light_e + scale * smooth.value_at(x, y),
            None => self.light_e,
        };
        if let Some(field) = self.field.get(index).filter(|_| self.field.len() >= (y + 1) * columns) {
            electrons += field;
        }
        let of_pixel = |factors: &PixelFactors| {
            factors.factor_at(x, y).filter(|_| factors.has_row(y, columns)).map(f64::from)
        };
        if let Some(response) = self.response.as_ref().and_then(of_pixel) {
            electrons *= response;
        }
        match self.pattern.as_ref().and_then(|(e, factors)| Some((e, of_pixel(factors)?))) {
            Some((e, factor)) => electrons + (self.dark_e + e * factor),
            None => electrons + self.dark_e,
        }
    }

    /// Background in one pixel of an image of `columns`, for pixels of uniform response and dark current.
    pub(super) fn uniform_response_electrons_at(&self, x: usize, y: usize, columns: usize) -> f64 {
        let smooth_e = self.smooth.as_ref().map_or(0.0, |(smooth, scale)| scale * smooth.value_at(x, y));
        let field_e = self.field.get(y * columns + x).copied().unwrap_or(0.0);
        let pattern_e = self.pattern.as_ref().map_or(0.0, |(electrons, _)| *electrons);
        self.light_e + smooth_e + field_e + (self.dark_e + pattern_e)
    }

    /// Upper bound of the background of all pixels.
    pub(super) fn bound_e(&self) -> f64 {
        let smooth_e = self.smooth.as_ref().map_or(0.0, |(smooth, scale)| scale * smooth.largest());
        self.bound_with(smooth_e, &self.field)
    }

    /// Upper bound of the background of all pixels of a row, in an image of `columns`.
    #[inline(always)]
    pub(super) fn row_bound_e(&self, y: usize, columns: usize) -> f64 {
        let smooth_e = self.smooth.as_ref().map_or(0.0, |(smooth, scale)| scale * smooth.largest_of_row(y));
        self.bound_with(smooth_e, self.field.get(y * columns..(y + 1) * columns).unwrap_or_default())
    }

    /// Upper bound of the background of pixels with smooth light of at most `smooth_e` and further light from
    /// `field`.
    #[inline(always)]
    fn bound_with(&self, smooth_e: f64, field: &[f64]) -> f64 {
        let field_e = field.iter().copied().fold(0.0, f64::max);
        let response = self.response.as_ref().map_or(1.0, |response| response.largest().max(1.0));
        let pattern_e =
            self.pattern.as_ref().map_or(0.0, |(electrons, factors)| electrons * factors.largest());
        // Relative margin of 1 in 10^12 for intermediate rounding.
        ((self.light_e + smooth_e + field_e) * response + self.dark_e + pattern_e) * (1.0 + 1e-12)
    }

    /// Returns true if the background may differ from pixel to pixel.
    pub(super) fn is_uneven(&self) -> bool {
        self.smooth.is_some() || !self.field.is_empty() || self.response.is_some() || self.pattern.is_some()
    }
}
