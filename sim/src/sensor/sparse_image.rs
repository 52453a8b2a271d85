//! A raw image that is drawn in pieces.

use super::exceedance::DarkLimit;
use super::raw_image::RawImage;
use crate::draw::PIECE;

/// A raw image of which pieces are drawn. Reused from frame to frame.
#[derive(Debug)]
pub(crate) struct SparseImage {
    /// Pixels that are not drawn are 0, unless they are above the floor.
    pub(super) raw: RawImage,
    pub(super) pieces_per_row: usize,
    /// Of each piece, row by row: what of it is in the image.
    pub(super) pieces: Vec<Piece>,
    /// The limit of dark pixels in each row; empty where all pixels are drawn outright.
    pub(super) limits: Vec<DarkLimit>,
    /// Dark pixels above the floor.
    pub(super) exceeding: Vec<Pixel>,
    /// Pixels that overflow or receive what overflows, all of which are in the image.
    pub(super) bloomed: Vec<Pixel>,
    pub(super) floor_dn: u16,
}

/// What of a piece of a row is in the image.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Piece {
    /// Nothing: all is 0.
    Blank,
    /// Some pixels.
    Touched,
    /// To be drawn.
    Wanted,
    /// All pixels.
    Drawn,
}

/// A pixel by its index in the image, and its digital number.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Pixel {
    pub(super) index: usize,
    pub(super) dn: u16,
}

impl SparseImage {
    /// The image. Digital numbers are those of the whole frame where they are above the floor or were asked for.
    pub(crate) fn raw(&self) -> &RawImage {
        &self.raw
    }

    /// The image, to be drawn as a whole.
    pub(crate) fn whole(&mut self) -> &mut RawImage {
        self.pieces.fill(Piece::Drawn);
        &mut self.raw
    }

    /// The pixels that are in the image, piece by piece: index of the first, and their digital numbers. All others are 0.
    pub(crate) fn runs(&self) -> impl Iterator<Item = (usize, &[u16])> {
        let columns = self.raw.columns;
        self.pieces.iter().enumerate().filter(|(_, piece)| **piece != Piece::Blank).map(move |(i, _)| {
            let first = i / self.pieces_per_row * columns + i % self.pieces_per_row * PIECE;
            let length = PIECE.min(columns - i % self.pieces_per_row * PIECE);
            (first, &self.raw.dn[first..first + length])
        })
    }

    /// Makes 0 of all that is not above a floor.
    pub(crate) fn suppress(&mut self, floor_dn: u16) {
        let columns = self.raw.columns.max(1);
        let rows =
            self.raw.dn.chunks_exact_mut(columns).zip(self.pieces.chunks_exact(self.pieces_per_row.max(1)));
        for (row, pieces) in rows {
            let drawn = row.chunks_mut(PIECE).zip(pieces).filter(|(_, piece)| **piece != Piece::Blank);
            for dn in drawn.flat_map(|(pixels, _)| pixels) {
                *dn = if *dn > floor_dn { *dn } else { 0 };
            }
        }
    }

    /// Nothing drawn.
    pub(super) fn clear(&mut self) {
        let columns = self.raw.columns.max(1);
        let rows = self
            .raw
            .dn
            .chunks_exact_mut(columns)
            .zip(self.pieces.chunks_exact_mut(self.pieces_per_row.max(1)));
        for (row, pieces) in rows {
            for (pixels, piece) in
                row.chunks_mut(PIECE).zip(pieces).filter(|(_, piece)| **piece != Piece::Blank)
            {
                pixels.fill(0);
                *piece = Piece::Blank;
            }
        }
        self.limits.clear();
        self.exceeding.clear();
        self.bloomed.clear();
    }

    /// Asks for the pieces of a row in which `is_wanted`.
    #[inline(always)]
    pub(super) fn want(&mut self, y: usize, is_wanted: impl Fn(usize) -> bool) {
        let pieces = self.pieces.chunks_exact_mut(self.pieces_per_row.max(1)).nth(y).unwrap_or_default();
        for (p, piece) in pieces.iter_mut().enumerate() {
            if *piece != Piece::Drawn && is_wanted(p) {
                *piece = Piece::Wanted;
            }
        }
    }

    /// Sets the pixels that were drawn one by one, over those that were drawn in pieces.
    pub(super) fn set_single_pixels(&mut self) {
        let columns = self.raw.columns;
        for pixel in self.exceeding.iter().chain(&self.bloomed) {
            self.raw.dn[pixel.index] = pixel.dn;
            let piece =
                &mut self.pieces[pixel.index / columns * self.pieces_per_row + pixel.index % columns / PIECE];
            if *piece == Piece::Blank {
                *piece = Piece::Touched;
            }
        }
    }
}
