//! Conversion of digital numbers to shades of grey.

use std::fmt;
use std::str::FromStr;

/// Method of converting digital numbers to grey.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Stretch {
    /// Inverse hyperbolic sine from the median of the background to the brightest pixel: shows faint stars,
    /// and bright ones still differ.
    Asinh,
    /// Linear from the darkest to the brightest pixel.
    Linear,
    /// Linear from 0 to full scale, as on a television.
    Full,
}

/// Upper limit of white in the view of a whole frame, in standard deviations of the noise above the
/// background: prevents one bright object from darkening the stars.
const WHITE_SIGMAS: f64 = 150.0;
/// Ratio of white to the value at which asinh turns from linear to logarithmic.
const SOFTENING: f64 = 40.0;

impl Stretch {
    /// All stretches.
    pub const ALL: [Self; 3] = [Self::Asinh, Self::Linear, Self::Full];

    /// Returns the word used on the command line.
    pub fn code(self) -> &'static str {
        match self {
            Self::Asinh => "asinh",
            Self::Linear => "linear",
            Self::Full => "full",
        }
    }
}

impl fmt::Display for Stretch {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.code())
    }
}

impl FromStr for Stretch {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let known = Self::ALL.into_iter().find(|stretch| stretch.code() == text);
        known.ok_or_else(|| format!("stretch is `{text}`, expected asinh, linear or full"))
    }
}

/// Value that is drawn white.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum White {
    /// The brightest pixel, but at most [`WHITE_SIGMAS`] above the background.
    Sky,
    /// The brightest pixel.
    Brightest,
}

/// Lookup table from digital numbers to grey; never decreases.
#[derive(Debug, Clone)]
pub(crate) struct Greys(Vec<u8>);

impl Greys {
    /// Creates the table from the pixels that are shown. `samples` are sorted in place.
    pub(crate) fn new(stretch: Stretch, white: White, full_scale_dn: u16, samples: &mut [u16]) -> Self {
        samples.sort_unstable();
        let last = samples.last().copied().unwrap_or(0);
        let grey: Box<dyn Fn(f64) -> f64> = match stretch {
            Stretch::Full => Box::new(move |dn| dn / f64::from(full_scale_dn.max(1))),
            Stretch::Linear => {
                let low = f64::from(samples.first().copied().unwrap_or(0));
                let span = (f64::from(last) - low).max(1.0);
                Box::new(move |dn| (dn - low) / span)
            }
            Stretch::Asinh => {
                // A pixel of 0 was suppressed and contains no information about the noise.
                let lit = samples.partition_point(|&dn| dn == 0);
                let lit = samples.get(lit..).unwrap_or_default();
                let part = |of: usize| f64::from(lit.get(lit.len() / of).copied().unwrap_or(0));
                let (median, below) = (part(2), part(6));
                let sigma = (median - below).max(0.5);
                let black = median;
                let cap = match white {
                    White::Sky => black + WHITE_SIGMAS * sigma,
                    White::Brightest => f64::INFINITY,
                };
                let high = f64::from(last).min(cap).max(black + 20.0 * sigma);
                let softening = (high - black) / SOFTENING;
                let full = libm::asinh(SOFTENING);
                Box::new(move |dn| libm::asinh((dn - black).max(0.0) / softening) / full)
            }
        };
        let table = (0..=full_scale_dn.max(last)).map(|dn| {
            let level = grey(f64::from(dn)).clamp(0.0, 1.0);
            (255.0 * level).round() as u8
        });
        Self(table.collect())
    }

    /// Returns the grey of a digital number; white above the table.
    pub(crate) fn grey(&self, dn: u16) -> u8 {
        self.0.get(usize::from(dn)).copied().unwrap_or(u8::MAX)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_stretch_rises_with_the_digital_number_and_reaches_white() {
        let noise = (0..4000_u16).map(|i| 100 + i * 7 % 11);
        let samples: Vec<u16> = noise.chain([150, 300, 1500, 4000]).collect();
        for stretch in Stretch::ALL {
            for white in [White::Sky, White::Brightest] {
                let greys = Greys::new(stretch, white, 4095, &mut samples.clone());
                assert!((0..4095).all(|dn| greys.grey(dn) <= greys.grey(dn + 1)), "{stretch} {white:?}");
                assert!(greys.grey(4095) == 255 && greys.grey(u16::MAX) == 255, "{stretch} {white:?}");
            }
        }
    }

    /// With noise of ±3 DN, a pixel of five times this amount stands out from the sky by more than the sky's
    /// noise.
    #[test]
    fn asinh_shows_a_faint_star_beside_a_saturated_one() {
        let mut samples: Vec<u16> = (0..4000_u16).map(|i| 97 + i % 7).collect();
        samples.push(4095);
        let greys = Greys::new(Stretch::Asinh, White::Sky, 4095, &mut samples);
        let (sky, grain, faint, bright) =
            (greys.grey(100), greys.grey(103), greys.grey(115), greys.grey(400));
        assert!(sky < 20 && grain < 40, "{sky} {grain}");
        assert!(faint > grain + 30 && bright > faint + 60, "{faint} {bright}");
    }

    #[test]
    fn a_frame_without_signal_is_no_harm() {
        for stretch in Stretch::ALL {
            for mut samples in [vec![], vec![0; 9], vec![7; 9], vec![u16::MAX; 9]] {
                let greys = Greys::new(stretch, White::Sky, u16::MAX, &mut samples);
                assert!(greys.grey(0) <= greys.grey(u16::MAX), "{stretch}");
            }
        }
    }

    #[test]
    fn words_of_stretches_round_trip() {
        assert!(Stretch::ALL.into_iter().all(|stretch| stretch.code().parse() == Ok(stretch)));
        assert!("log".parse::<Stretch>().is_err_and(|message| message.contains("asinh, linear or full")));
    }
}
