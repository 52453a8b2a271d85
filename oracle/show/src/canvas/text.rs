//! Text: glyphs of Noto Sans Mono, rasterised beforehand.

use noto_sans_mono_bitmap::{FontWeight, RasterHeight, RasterizedChar, get_raster};

/// A font at one size.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Font {
    /// Names beside marks.
    Label,
    /// Everything else.
    Body,
    /// Headings.
    Heading,
}

impl Font {
    fn face(self) -> (FontWeight, RasterHeight) {
        match self {
            Self::Label => (FontWeight::Regular, RasterHeight::Size16),
            Self::Body => (FontWeight::Regular, RasterHeight::Size20),
            Self::Heading => (FontWeight::Bold, RasterHeight::Size20),
        }
    }

    /// Height of a line, px.
    pub(crate) fn height(self) -> usize {
        self.face().1.val()
    }

    /// From a character to the next, px.
    pub(crate) fn advance(self) -> usize {
        self.glyph(' ').map_or(0, |glyph| glyph.width())
    }

    /// Width of a text, px.
    pub(crate) fn width(self, text: &str) -> usize {
        self.advance() * text.chars().count()
    }

    /// The picture of a character. The font has Latin characters alone: a few others are written by their like, the rest as `?`.
    pub(crate) fn glyph(self, character: char) -> Option<RasterizedChar> {
        let (weight, height) = self.face();
        let known = match character {
            '−' | '–' | '—' => '-',
            '′' | '’' | '‘' => '\'',
            '″' | '“' | '”' => '"',
            other => other,
        };
        get_raster(known, weight, height).or_else(|| get_raster('?', weight, height))
    }

    /// A text that is no wider than `width`: its end is left out where it must be.
    pub(crate) fn cut(self, text: &str, width: usize) -> String {
        let most = width / self.advance().max(1);
        if text.chars().count() <= most {
            return text.to_owned();
        }
        let kept: String = text.chars().take(most.saturating_sub(2)).collect();
        format!("{}..", kept.trim_end())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_text_is_cut_to_its_room_and_no_more() {
        let advance = Font::Body.advance();
        assert_eq!(Font::Body.cut("frame 12", 8 * advance), "frame 12");
        assert_eq!(Font::Body.cut("frame 123", 8 * advance), "frame..");
        assert_eq!(Font::Body.cut("frame", 0), "..");
    }

    #[test]
    fn every_character_has_a_glyph_of_the_same_width() {
        for font in [Font::Label, Font::Body, Font::Heading] {
            for character in "aZ0 °±×·−σ\u{1F680}\n".chars() {
                assert_eq!(font.glyph(character).unwrap().width(), font.advance(), "{character:?}");
            }
        }
    }
}
