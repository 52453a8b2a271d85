//! Text rendering with pre-rasterised glyphs of Noto Sans Mono.

use noto_sans_mono_bitmap::{FontWeight, RasterHeight, RasterizedChar, get_raster};

/// A font at one size.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Font {
    /// Labels beside marks.
    Label,
    /// All other text.
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

    /// Returns the height of a line, px.
    pub(crate) fn height(self) -> usize {
        self.face().1.val()
    }

    /// Returns the distance from one character to the next, px.
    pub(crate) fn advance(self) -> usize {
        self.glyph(' ').map_or(0, |glyph| glyph.width())
    }

    /// Returns the width of a text, px.
    pub(crate) fn width(self, text: &str) -> usize {
        self.advance() * text.chars().count()
    }

    /// Returns the glyph of a character. The font has only Latin characters: a few others are replaced by
    /// similar ones, all remaining ones by `?`.
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

    /// Shortens a text to at most `width`: a text that is too long ends in `..`.
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
