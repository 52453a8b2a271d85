//! Normal random numbers by the ziggurat method: nearly always one word, one multiplication and one
//! comparison.

use draws::{Stream, uniform};
use rand::Rng;

/// Number of layers of equal area that cover exp(−x²/2), x ≥ 0: 255 rectangles, and the lowest layer with the
/// tail.
const LAYERS: usize = 256;
/// Start of the tail: the abscissa for which 256 layers of equal area end at the top (Marsaglia & Tsang
/// 2000).
const TAIL_FROM: f64 = 3.654_152_885_361_009;

/// Sampler of the standard normal distribution (Marsaglia & Tsang, "The ziggurat method for generating random
/// variables", Journal of Statistical Software 5(8), 2000), from 64-bit words: the lowest eight bits select
/// the layer and the highest 53 the number, so the two are independent (Doornik 2005).
#[derive(Debug, Clone)]
pub(crate) struct Ziggurat {
    layers: Box<[Layer; LAYERS]>,
    short: Box<[ShortLayer; LAYERS]>,
}

/// Data of a layer for 32-bit words.
#[derive(Debug, Clone, Copy, Default)]
struct ShortLayer {
    /// Width of a step.
    width: f32,
    /// Number of steps below which a point is surely under the curve.
    sure: f32,
}

#[derive(Debug, Clone, Copy, Default)]
struct Layer {
    /// End of the layer.
    width: f64,
    /// Abscissa up to which the layer lies entirely under the curve.
    inner: f64,
    /// Values of the curve at `width` and at `inner`.
    low: f64,
    high: f64,
}

impl Default for Ziggurat {
    fn default() -> Self {
        let tail =
            libm::sqrt(std::f64::consts::FRAC_PI_2) * libm::erfc(TAIL_FROM * std::f64::consts::FRAC_1_SQRT_2);
        let area = TAIL_FROM * density(TAIL_FROM) + tail;
        let mut layers = Box::new([Layer::default(); LAYERS]);
        // The lowest layer as a rectangle of equal area: points beyond the inner end are drawn from the tail.
        let mut width = area / density(TAIL_FROM);
        let mut inner = TAIL_FROM;
        for (i, layer) in layers.iter_mut().enumerate() {
            *layer = Layer { width, inner, low: density(width), high: density(inner) };
            width = inner;
            let top = density(inner) + area / inner;
            inner = if i + 2 < LAYERS { libm::sqrt(-2.0 * libm::log(top)) } else { 0.0 };
        }
        let short = layers.map(|layer| ShortLayer {
            width: (layer.width / SHORT_STEPS) as f32,
            // Rounded down to an integer step: doubtful cases are decided in double precision.
            sure: (layer.inner / layer.width * SHORT_STEPS).floor() as f32,
        });
        Self { layers, short: Box::new(short) }
    }
}

fn density(x: f64) -> f64 {
    libm::exp(-0.5 * x * x)
}

impl Ziggurat {
    /// Draws a normal random number with mean 0 and standard deviation 1 from a uniform word. One word in a
    /// hundred is not sufficient: the remaining words then come from the stream that `more` returns.
    #[inline(always)]
    pub(crate) fn draw(&self, word: u64, more: impl FnOnce() -> Stream) -> f64 {
        let layer = &self.layers[(word % LAYERS as u64) as usize];
        let x = signed_unit(word) * layer.width;
        if x.abs() < layer.inner { x } else { self.draw_after_miss(word, &mut more()) }
    }

    /// Draws a number, as [`Ziggurat::draw`] does, from a 32-bit word: the lowest eight bits select the
    /// layer, the other bits the number, in steps of 2⁻²³ of the layer's width.
    #[inline(always)]
    pub(crate) fn draw_short(&self, word: u32, more: impl FnOnce() -> Stream) -> f32 {
        let layer = &self.short[(word % LAYERS as u32) as usize];
        let steps = (word as i32 >> 8) as f32 + 0.5;
        if steps.abs() < layer.sure {
            steps * layer.width
        } else {
            self.draw_after_miss(widened(word), &mut more()) as f32
        }
    }

    /// Draws the number when the first word lies outside the sure part of its layer.
    #[cold]
    fn draw_after_miss(&self, mut word: u64, stream: &mut Stream) -> f64 {
        loop {
            let index = (word % LAYERS as u64) as usize;
            let layer = &self.layers[index];
            let x = signed_unit(word) * layer.width;
            if x.abs() < layer.inner {
                return x;
            }
            if index == 0 {
                return tail(stream).copysign(x);
            }
            if layer.low + uniform(stream) * (layer.high - layer.low) < density(x) {
                return x;
            }
            word = stream.next_u64();
        }
    }
}

/// Number of steps of a 32-bit word on each side of a layer.
const SHORT_STEPS: f64 = 8_388_608.0;

/// Returns the 64-bit word with the layer and the number of a 32-bit word, in the middle of the step.
fn widened(word: u32) -> u64 {
    u64::from(word >> 8) << 40 | 1 << 39 | u64::from(word % LAYERS as u32)
}

/// Uniform number in (−1, 1) from the highest 53 bits.
#[inline(always)]
fn signed_unit(word: u64) -> f64 {
    ((word as i64 >> 11) as f64 + 0.5) * (1.0 / 4_503_599_627_370_496.0)
}

/// Draws a normal random number beyond [`TAIL_FROM`] (Marsaglia 1964).
fn tail(stream: &mut Stream) -> f64 {
    loop {
        let x = -libm::log(uniform(stream)) / TAIL_FROM;
        let y = -libm::log(uniform(stream));
        if 2.0 * y > x * x {
            return TAIL_FROM + x;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::distribution::tests::{chi_square_p, histogram};
    use super::*;
    use draws::{Effect, Seed};

    /// Numbers drawn as in the readout: one word of a row, and further words from another address.
    fn numbers(frame: u64, n: u64) -> impl Iterator<Item = f64> {
        let streams = Seed { seed: 31, case: 0 }.streams(frame, Effect::PixelNoise);
        let (ziggurat, mut row) = (Ziggurat::default(), streams.stream_at(0));
        (1..=n).map(move |row_index| ziggurat.draw(row.next_u64(), || streams.stream_at(row_index)))
    }

    fn cdf(x: f64) -> f64 {
        0.5 * libm::erfc(-x * std::f64::consts::FRAC_1_SQRT_2)
    }

    #[test]
    fn its_layers_have_equal_areas_and_end_at_the_top() {
        let layers = Ziggurat::default().layers;
        let area = layers[0].width * layers[0].high;
        for layer in &layers[1..] {
            // The abscissa of the tail is given to 17 digits, and its error grows from layer to layer.
            assert!((layer.width * (layer.high - layer.low) / area - 1.0).abs() < 1e-11, "{layer:?}");
        }
        assert_eq!(layers[LAYERS - 1].inner, 0.0);
    }

    #[test]
    fn its_numbers_follow_the_normal_distribution_in_fine_bins() {
        // −5 to 5 in steps of 1/50, far narrower than most layers.
        let bin = |x: f64| ((x + 5.0) * 50.0).floor().clamp(0.0, 499.0) as usize;
        let counts = histogram(numbers(0, 4_000_000).map(bin));
        let edge = |i: usize| cdf(i as f64 / 50.0 - 5.0);
        let law: Vec<f64> = (0..500).map(|i| edge(i + 1) - edge(i)).collect();
        let p = chi_square_p(&counts, &law);
        assert!(p > 1e-4, "p = {p}");
    }

    #[test]
    fn its_tail_is_that_of_the_normal_distribution() {
        // 2 Φ(−3.6541…) = 2.6e-4: a thousand of four million, in 40 bins of 1/40 and the remainder.
        let n = 4_000_000;
        let beyond: Vec<f64> = numbers(1, n).map(f64::abs).filter(|x| *x > TAIL_FROM).collect();
        let tail = |x: f64| 2.0 * cdf(-x);
        let expected = n as f64 * tail(TAIL_FROM);
        assert!((beyond.len() as f64 - expected).abs() < 5.0 * expected.sqrt(), "{}", beyond.len());
        let counts = histogram(beyond.iter().map(|x| ((x - TAIL_FROM) * 40.0) as usize));
        let edge = |i: usize| tail(TAIL_FROM + i as f64 / 40.0) / tail(TAIL_FROM);
        let law: Vec<f64> = (0..80).map(|i| edge(i) - edge(i + 1)).collect();
        assert!(chi_square_p(&counts, &law) > 1e-4);
    }

    #[test]
    fn its_moments_are_those_of_the_normal_distribution() {
        let n = 4_000_000;
        let mut moments = [0.0; 4];
        for x in numbers(2, n) {
            let mut power = 1.0;
            for moment in &mut moments {
                power *= x;
                *moment += power / n as f64;
            }
        }
        // The variances of the powers are 1, 2, 15 and 96; the tolerance is five standard errors.
        for ((moment, expected), variance) in
            moments.iter().zip([0.0, 1.0, 0.0, 3.0]).zip([1.0, 2.0, 15.0, 96.0_f64])
        {
            assert!((moment - expected).abs() < 5.0 * (variance / n as f64).sqrt(), "{moments:?}");
        }
    }

    #[test]
    fn a_decisive_word_draws_no_further_one() {
        let ziggurat = Ziggurat::default();
        let mut row = Seed { seed: 31, case: 0 }.stream(3, Effect::PixelNoise, 0);
        let mut extra_words = 0;
        for _ in 0..100_000 {
            ziggurat.draw(row.next_u64(), || {
                extra_words += 1;
                Seed { seed: 31, case: 0 }.stream(3, Effect::PixelNoise, 1)
            });
        }
        // 1.2 % for 256 layers.
        assert!((1000..1500).contains(&extra_words), "{extra_words}");
    }
}
