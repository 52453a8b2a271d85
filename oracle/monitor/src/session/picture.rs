//! Pictures in the form that the page draws: one grey byte per pixel, row by row.

use axum::body::Bytes;
use contract::Frame;

/// Fraction of full scale at which the stretch changes from linear to logarithmic: faint stars are visible,
/// and bright ones still differ.
const SOFTENING: f64 = 1.0 / 1500.0;

/// Table from digital numbers to grey levels.
#[derive(Debug, Clone)]
pub struct Stretch(Vec<u8>);

impl Stretch {
    /// Returns the identity for eight-bit pixels.
    pub fn plain() -> Self {
        Self((0..=u8::MAX).collect())
    }

    /// Returns the inverse hyperbolic sine from the bias of a detector to its full scale, DN.
    pub fn from_range(bias_dn: f64, full_scale_dn: u16) -> Self {
        let full_dn = f64::from(full_scale_dn);
        let span = (full_dn - bias_dn).max(1.0);
        let grey = |dn: u16| {
            let level = ((f64::from(dn) - bias_dn) / span).clamp(0.0, 1.0);
            255.0 * libm::asinh(level / SOFTENING) / libm::asinh(1.0 / SOFTENING)
        };
        Self((0..=full_scale_dn).map(|dn| grey(dn).round() as u8).collect())
    }

    /// Returns the picture of a frame; values above full scale become white.
    pub fn picture(&self, frame: &Frame) -> Bytes {
        let grey = |dn: &u16| self.0.get(usize::from(*dn)).copied().unwrap_or(u8::MAX);
        frame.dn().iter().map(grey).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_stretch_rises_from_black_at_the_bias_to_white_at_full_scale() {
        // The detector of ARGON.
        let (bias_dn, full_scale_dn) = (40.0, 4095);
        let Stretch(table) = Stretch::from_range(bias_dn, full_scale_dn);
        assert_eq!((table[0], table[bias_dn as usize]), (0, 0));
        assert_eq!((table.len(), table.last()), (usize::from(full_scale_dn) + 1, Some(&255)));
        assert!(table.windows(2).all(|pair| pair[0] <= pair[1]));
        // A pixel of a star with ten times the read noise, 15 DN, is well above black.
        assert!(table[bias_dn as usize + 15] > 64);
    }
}
