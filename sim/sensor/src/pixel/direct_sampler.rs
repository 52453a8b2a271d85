//! Draws of a pixel's number in the steps of the detector: electrons, full well, amplifier, read noise,
//! converter.

use truth::Switch;

use super::distribution::PixelDistribution;
use super::poisson::poisson;
use super::poisson_digits::PoissonDigits;
use super::words::PixelWords;
use super::ziggurat::Ziggurat;

/// Sampler for pixels of any mean and offset. Its tables do not depend on the detector.
#[derive(Debug, Clone, Default)]
pub(super) struct DirectSampler {
    digits: PoissonDigits,
    normal: Ziggurat,
}

/// Mean from which on shot noise is neglected, electrons: it is less than 3e-8 of the mean.
const NO_SHOT_NOISE_FROM_E: f64 = 1e15;

impl DirectSampler {
    /// Draws the digital number of a pixel with a mean of `mean_e` electrons, 0 or more, to which the readout
    /// adds `offset_e` electrons.
    #[inline(always)]
    pub(super) fn draw(
        &mut self,
        distribution: &PixelDistribution,
        mean_e: f64,
        offset_e: f64,
        words: &PixelWords,
    ) -> u16 {
        let collected_e = self.collect(distribution, mean_e, words);
        self.convert(distribution, collected_e, offset_e, words)
    }

    /// Draws the electrons that a pixel of mean `mean_e` collects, before the limit of the full well.
    #[inline(always)]
    pub(super) fn collect(
        &mut self,
        distribution: &PixelDistribution,
        mean_e: f64,
        words: &PixelWords,
    ) -> f64 {
        if distribution.shot == Switch::Off {
            mean_e
        } else if mean_e < PoissonDigits::END_E {
            f64::from(self.digits.draw(mean_e, words.electrons))
        } else if mean_e < NO_SHOT_NOISE_FROM_E {
            poisson(mean_e, &mut words.more_for_electrons())
        } else {
            mean_e
        }
    }

    /// Draws the digital number of a pixel that collected `collected_e` electrons.
    #[inline(always)]
    pub(super) fn convert(
        &self,
        distribution: &PixelDistribution,
        collected_e: f64,
        offset_e: f64,
        words: &PixelWords,
    ) -> u16 {
        let noise = self.normal.draw(words.noise, || words.more_for_noise());
        distribution.read(collected_e, noise, offset_e)
    }
}
