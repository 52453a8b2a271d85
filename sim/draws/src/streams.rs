//! Streams of random numbers by their address.

use rand::Rng;
use rand_xoshiro::Xoshiro256PlusPlus;
use rand_xoshiro::rand_core::SeedableRng;

/// Purpose of a draw. Each effect has separate streams, so that switching one effect off leaves all other
/// draws unchanged. The numbers are part of the address and never change.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[repr(u64)]
pub enum Effect {
    /// Shot, dark and read noise of a pixel: one effect, one draw.
    PixelNoise = 1,
    /// Positions and strengths of hot pixels (addressed with the sensor's seed).
    HotPixels = 2,
    /// Error of the attitude control.
    AttitudeControl = 3,
    /// Error of the attitude reported in telemetry.
    AttitudeKnowledge = 4,
    /// Execution error of a manoeuvre (frame 0; three numbers per manoeuvre).
    ManoeuvreExecution = 5,
    /// Error of the report of a manoeuvre (frame 0; three numbers per manoeuvre).
    ManoeuvreReport = 6,
    /// Sensitivity of each pixel (addressed with the sensor's seed).
    PixelResponse = 20,
    /// Dark current of each pixel (addressed with the sensor's seed).
    DarkPattern = 21,
    /// Positions of dead pixels (addressed with the sensor's seed).
    DeadPixels = 22,
    /// Positions of dead columns (addressed with the sensor's seed).
    DeadColumns = 23,
    /// Fixed offset of each column (addressed with the sensor's seed).
    ColumnOffset = 24,
    /// Noise common to a row of a frame.
    RowNoise = 25,
    /// Noise common to a column of a frame.
    ColumnNoise = 26,
    /// Switching of hot pixels; addressed by time cells, not by frames.
    Telegraph = 27,
    /// Cosmic-ray hits.
    CosmicRays = 28,
    /// Layout of the blankets on a docking target's station (addressed with the target's seed).
    Blankets = 40,
    /// Noise of a video signal, pixel by pixel.
    VideoNoise = 41,
    /// Phases of the slow drift of a video signal's contrast and brightness.
    VideoDrift = 42,
    /// Shift of each line of a field.
    LineJitter = 43,
    /// Selection of the lost lines of a field, and the signal that replaces them.
    LostLines = 44,
    /// Level of each line of a field.
    LineLevel = 45,
    /// Errors of range and range rate in the overlay of a video picture, by the second.
    OverlayReading = 46,
    /// Selection of the dark pixels above the floor of a camera that reads no lower values, and the redrawn
    /// values of dark pixels that must not exceed it.
    Exceedance = 47,
    /// Further numbers of the few pixels for which the words at their own address are not sufficient.
    PixelReserve = 48,
    /// Values of a study's dispersed parameters (addressed with the study's seed and the case).
    StudyParameter = 60,
    /// Shifts and permutations of a study's design (addressed with the study's seed).
    StudyDesign = 61,
    /// Seed of a case's scenario (addressed with the study's seed and the case).
    CaseSeed = 62,
    /// Resampling of cases for the intervals of a study's figures (addressed with the study's seed).
    Bootstrap = 63,
    /// Selection of the blocks that a gate exchanges between baseline and result (addressed with the number
    /// of blocks).
    BlockExchange = 64,
    /// Choice among equally bad cases of a study that are listed (addressed with the study's seed and the
    /// case).
    WorstCases = 65,
    /// Error of the states of its own orbit that the chaser reports to a navigator (frame: number of the
    /// state; six numbers).
    ReportedOrbit = 80,
    /// Error of the relative orbit that a navigator receives as its prior (frame 0; six numbers).
    RelativePrior = 81,
}

/// Generator of every draw.
pub type Stream = Xoshiro256PlusPlus;

/// Seed and case, common to all streams of one simulated sequence.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Seed {
    /// Seed of the scenario or study.
    pub seed: u64,
    /// Number of the case in a study; 0 outside one.
    pub case: u64,
}

impl Seed {
    /// Returns the stream at an address. `index` is that by which the effect counts, for instance of a row, a
    /// pixel or a component.
    pub fn stream(&self, frame: u64, effect: Effect, index: u64) -> Stream {
        self.streams(frame, effect).stream_at(index)
    }

    /// Returns all streams of an effect in a frame, for loops over many indices.
    pub fn streams(&self, frame: u64, effect: Effect) -> Streams {
        let mut key = 0x426f_7265_7369_6768; // "Boresigh"
        for word in [self.seed, self.case, frame, effect as u64] {
            key = split_mix(key ^ word);
        }
        Streams { key }
    }
}

/// Streams of one effect in one frame: an address without its index.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Streams {
    key: u64,
}

impl Streams {
    /// Returns the stream at an index, equal to that of [`Seed::stream`].
    pub fn stream_at(&self, index: u64) -> Stream {
        Stream::seed_from_u64(self.key_at(index))
    }

    /// Returns the first uniform number of the stream at an index, without the cost of the stream.
    #[inline(always)]
    pub fn first_uniform(&self, index: u64) -> f64 {
        let key = self.key_at(index);
        // The first word of xoshiro256++ depends on the first and the fourth of the numbers that key the
        // generator.
        let [first, fourth] =
            [0, 3].map(|number| split_mix(key.wrapping_add(GOLDEN_GAMMA.wrapping_mul(number))));
        in_unit_interval(first.wrapping_add(fourth).rotate_left(23).wrapping_add(first))
    }

    /// Key of the generators at an index.
    pub(crate) fn key_at(&self, index: u64) -> u64 {
        split_mix(self.key ^ index)
    }

    /// Returns the first of the words at an index.
    pub fn word(&self, index: u64) -> u64 {
        let [word] = self.words(index);
        word
    }

    /// Returns `N` words of 64 random bits at an index, without the cost of a generator: the first numbers of
    /// the SplitMix64 that keys the stream of this index. An index uses either its stream or its words.
    #[inline(always)]
    pub fn words<const N: usize>(&self, index: u64) -> [u64; N] {
        let key = self.key_at(index);
        let mut words = [0; N];
        for (number, word) in (0..).zip(&mut words) {
            *word = split_mix(key.wrapping_add(GOLDEN_GAMMA.wrapping_mul(number)));
        }
        words
    }
}

/// Increment of SplitMix64's state from one number to the next.
pub(crate) const GOLDEN_GAMMA: u64 = 0x9e37_79b9_7f4a_7c15;

/// One step of SplitMix64: a bijection that spreads every bit.
#[inline(always)]
pub(crate) fn split_mix(word: u64) -> u64 {
    let mut z = word.wrapping_add(GOLDEN_GAMMA);
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^ (z >> 31)
}

/// Returns a uniform number in the open interval (0, 1), with 53 bits.
pub fn uniform(stream: &mut Stream) -> f64 {
    in_unit_interval(stream.next_u64())
}

/// Converts a word to a uniform number.
#[inline(always)]
fn in_unit_interval(word: u64) -> f64 {
    // The half step excludes 0, so that its logarithm can be taken.
    ((word >> 11) as f64 + 0.5) * (1.0 / 9_007_199_254_740_992.0)
}

/// Returns a normal number of mean 0 and standard deviation 1 (Box & Muller 1958, the cosine half).
pub fn normal(stream: &mut Stream) -> f64 {
    let radius = (-2.0 * libm::log(uniform(stream))).sqrt();
    radius * libm::cos(2.0 * std::f64::consts::PI * uniform(stream))
}

#[cfg(test)]
mod tests {
    use super::*;

    const SEED: Seed = Seed { seed: 42, case: 0 };

    #[test]
    fn an_address_gives_the_same_numbers_again() {
        let draw = || SEED.stream(7000, Effect::PixelNoise, 3).next_u64();
        assert_eq!(draw(), draw());
    }

    /// The numbers are frozen: a change here changes every result and is a change of the contract.
    #[test]
    fn the_first_number_is_frozen() {
        assert_eq!(SEED.stream(0, Effect::PixelNoise, 0).next_u64(), FIRST_OF_42);
    }

    const FIRST_OF_42: u64 = 5_719_266_020_278_784_404;

    #[test]
    fn the_first_uniform_number_is_that_of_the_stream() {
        for index in 0..1000 {
            let streams = SEED.streams(index, Effect::Exceedance);
            assert_eq!(streams.first_uniform(index), uniform(&mut streams.stream_at(index)));
        }
    }

    #[test]
    fn every_word_of_the_address_matters() {
        let first = |seed: Seed, frame, effect, index| seed.stream(frame, effect, index).next_u64();
        let draws = [
            first(SEED, 0, Effect::PixelNoise, 0),
            first(Seed { seed: 43, case: 0 }, 0, Effect::PixelNoise, 0),
            first(Seed { seed: 42, case: 1 }, 0, Effect::PixelNoise, 0),
            first(SEED, 1, Effect::PixelNoise, 0),
            first(SEED, 0, Effect::HotPixels, 0),
            first(SEED, 0, Effect::PixelNoise, 1),
        ];
        for (i, a) in draws.iter().enumerate() {
            assert!(draws[i + 1..].iter().all(|b| a != b));
        }
    }

    #[test]
    fn a_stream_is_the_same_by_either_way() {
        let streams = SEED.streams(7, Effect::PixelNoise);
        assert_eq!(streams.stream_at(99).next_u64(), SEED.stream(7, Effect::PixelNoise, 99).next_u64());
    }

    /// Bits of words at one index, at neighbouring indices, and at one index in neighbouring frames, differ
    /// in half the cases.
    #[test]
    fn neighbouring_words_share_no_bits_but_by_chance() {
        let n = 20_000;
        let mut differ = [[0_u32; 64]; 3];
        for index in 0..n {
            let [word, next] = SEED.streams(1, Effect::PixelNoise).words(index);
            let [of_neighbour] = SEED.streams(1, Effect::PixelNoise).words(index + 1);
            let [of_next_frame] = SEED.streams(2, Effect::PixelNoise).words(index);
            let others = [next, of_neighbour, of_next_frame];
            for (counts, other) in differ.iter_mut().zip(others) {
                for (bit, count) in counts.iter_mut().enumerate() {
                    *count += ((word ^ other) >> bit & 1) as u32;
                }
            }
        }
        // Binomial with standard deviation sqrt(n)/2 = 71; the limit is five of them for 192 counts.
        for count in differ.into_iter().flatten() {
            assert!((f64::from(count) - n as f64 / 2.0).abs() < 354.0, "{count} of {n}");
        }
    }

    #[test]
    fn neighbouring_streams_are_uncorrelated() {
        let n = 20_000;
        let rows: Vec<(f64, f64)> = (0..n)
            .map(|row| {
                let at = |index| normal(&mut SEED.stream(1, Effect::PixelNoise, index));
                (at(row), at(row + 1))
            })
            .collect();
        let correlation = rows.iter().map(|(a, b)| a * b).sum::<f64>() / n as f64;
        // Standard error 1/sqrt(n) = 0.007; the limit is four of them.
        assert!(correlation.abs() < 0.028, "correlation {correlation}");
    }

    #[test]
    fn normal_numbers_have_the_normal_distribution() {
        use statrs::distribution::{ContinuousCDF, Normal};
        let standard = Normal::new(0.0, 1.0).unwrap();
        let mut stream = SEED.stream(0, Effect::AttitudeControl, 0);
        let n = 100_000;
        let mut draws: Vec<f64> = (0..n).map(|_| normal(&mut stream)).collect();
        draws.sort_by(f64::total_cmp);
        let distance = draws
            .iter()
            .enumerate()
            .map(|(i, x)| (standard.cdf(*x) - (i as f64 + 0.5) / n as f64).abs())
            .fold(0.0, f64::max);
        // Kolmogorov–Smirnov limit at the 1e-4 level: 2.23/sqrt(n).
        assert!(distance < 2.23 / (n as f64).sqrt(), "distance {distance}");
    }
}
