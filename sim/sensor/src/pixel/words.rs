//! Random numbers of the pixels of a frame, by their addresses.

use draws::{Effect, GeneratorLanes, Seed, Stream, Streams};
use pulp::{Arch, Simd, WithSimd};

/// Random numbers of the pixels of one frame.
///
/// A pixel has one word in the words of its row, from which it is drawn if a table holds its distribution,
/// and three words at its own address, from which it is drawn otherwise. No pixel uses the numbers of
/// another, so the content of one pixel never changes the draw of another.
#[derive(Debug, Clone, Copy)]
pub(crate) struct PixelStreams {
    /// Words of the rows at the addresses 0 to rows − 1, words of the pixels from the address `rows` on.
    noise: Streams,
    /// Words of repeated draws.
    repeats: Streams,
    reserve: Streams,
    rows: u64,
    pixels: u64,
}

impl PixelStreams {
    /// Creates the addresses of a frame of `columns` × `rows`.
    pub(crate) fn new(seed: &Seed, frame: u64, columns: usize, rows: usize) -> Self {
        Self {
            noise: seed.streams(frame, Effect::PixelNoise),
            repeats: seed.streams(frame, Effect::Exceedance),
            reserve: seed.streams(frame, Effect::PixelReserve),
            rows: rows as u64,
            pixels: (columns * rows) as u64,
        }
    }

    /// Generators of the words of row `y`: one word per pixel, from the left.
    pub(crate) fn row_words(&self, registers: Arch, y: usize) -> GeneratorLanes {
        registers.dispatch(RowGenerators { noise: &self.noise, y })
    }

    /// Words at the own address of the pixel `index`, counted row by row.
    #[inline(always)]
    pub(crate) fn pixel_words(&self, index: usize) -> PixelWords {
        self.words_at(&self.noise, index as u64)
    }

    /// Words for draw `repeat` of the pixel `index`, 1 for the second draw.
    pub(crate) fn repeated_words(&self, index: usize, repeat: u64) -> PixelWords {
        self.words_at(&self.repeats, index as u64 + repeat * (self.rows + self.pixels))
    }

    #[inline(always)]
    fn words_at(&self, streams: &Streams, place: u64) -> PixelWords {
        let [first, second, noise] = streams.words(self.rows + place);
        PixelWords { electrons: [first, second], noise, reserve: self.reserve, place }
    }
}

/// Arguments of [`PixelStreams::row_words`] for vectorised code.
struct RowGenerators<'a> {
    noise: &'a Streams,
    y: usize,
}

impl WithSimd for RowGenerators<'_> {
    type Output = GeneratorLanes;

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) -> GeneratorLanes {
        GeneratorLanes::from_streams(self.noise, self.y as u64)
    }
}

/// Random numbers of a pixel that is drawn directly.
#[derive(Debug, Clone, Copy)]
pub(crate) struct PixelWords {
    /// Two words for the number of electrons.
    pub(crate) electrons: [u64; 2],
    /// Word for the read noise.
    pub(crate) noise: u64,
    reserve: Streams,
    place: u64,
}

impl PixelWords {
    /// Further numbers for the electrons.
    pub(crate) fn more_for_electrons(&self) -> Stream {
        self.reserve.stream_at(2 * self.place)
    }

    /// Further numbers for the read noise.
    pub(crate) fn more_for_noise(&self) -> Stream {
        self.reserve.stream_at(2 * self.place + 1)
    }
}
