//! PNG encoding of a picture, with a palette of 256 colours and a text chunk that names the program.

use std::borrow::Cow;
use std::collections::HashMap;
use std::io::Cursor;

use png::{BitDepth, ColorType, Compression, Decoder, Encoder, Limits};

use crate::ShowError;
use crate::canvas::colour::{ACCENTS, BACKGROUND, NO_DATA, Rgb};
use crate::layout::Picture;

/// Keyword of the text chunk, defined by the PNG standard.
const KEYWORD: &str = "Software";
/// Beginning of the chunk's text.
const PROGRAM: &str = "boresight show";
/// Number of shades between each accent and black, for smooth edges on a dark sky.
const SHADES: usize = 19;
/// Number of colours of a palette.
const COLOURS: usize = 256;
/// Largest amount of text that is read from a PNG, bytes.
const MAX_TEXT: usize = 1 << 20;

/// Encodes a picture as a PNG. The bytes depend only on the picture, its title and the version of Boresight.
/// A picture of more than 256 colours is reduced to about a hundred greys, and its smooth edges to the
/// nearest colour: the noise of a frame takes most of the bytes.
///
/// # Errors
/// [`ShowError::Encode`] when the encoder fails.
pub fn encode(picture: &Picture, title: &str) -> Result<Vec<u8>, ShowError> {
    let error = |error: png::EncodingError| ShowError::Encode(error.to_string());
    let (palette, indices) = indexed(&picture.rgb);
    let mut bytes = Vec::new();
    let size = ShowError::Size { width: picture.width, height: picture.height };
    let (Ok(width), Ok(height)) = (u32::try_from(picture.width), u32::try_from(picture.height)) else {
        return Err(size);
    };
    let mut encoder = Encoder::new(Cursor::new(&mut bytes), width, height);
    encoder.set_color(ColorType::Indexed);
    encoder.set_depth(BitDepth::Eight);
    encoder.set_palette(Cow::Owned(palette.concat()));
    encoder.set_compression(Compression::High);
    let software = format!("{PROGRAM} {}", env!("CARGO_PKG_VERSION"));
    encoder.add_text_chunk(KEYWORD.to_owned(), software).map_err(error)?;
    // The chunk holds only Latin-1 characters.
    let latin: String = title.chars().map(|c| if (' '..='\u{ff}').contains(&c) { c } else { '?' }).collect();
    encoder.add_text_chunk("Title".to_owned(), latin).map_err(error)?;
    let mut writer = encoder.write_header().map_err(error)?;
    writer.write_image_data(&indices).map_err(error)?;
    writer.finish().map_err(error)?;
    Ok(bytes)
}

/// Returns true if these bytes begin a PNG that [`encode`] made.
pub fn is_boresight_picture(bytes: &[u8]) -> bool {
    let mut decoder = Decoder::new_with_limits(Cursor::new(bytes), Limits { bytes: MAX_TEXT });
    let Ok(info) = decoder.read_header_info() else { return false };
    if info.color_type != ColorType::Indexed {
        return false;
    }
    // Reads the chunks that precede the pixels.
    decoder.read_info().is_ok_and(|reader| {
        let chunks = &reader.info().uncompressed_latin1_text;
        chunks.iter().any(|chunk| chunk.keyword == KEYWORD && chunk.text.starts_with(PROGRAM))
    })
}

/// Returns a palette, and the index of each pixel in it.
fn indexed(pixels: &[Rgb]) -> (Vec<Rgb>, Vec<u8>) {
    let mut known: HashMap<Rgb, u8> = HashMap::new();
    let mut palette: Vec<Rgb> = Vec::new();
    for pixel in pixels {
        if known.contains_key(pixel) {
            continue;
        }
        let Some(index) = u8::try_from(palette.len()).ok() else {
            return quantised(pixels);
        };
        known.insert(*pixel, index);
        palette.push(*pixel);
    }
    (palette, pixels.iter().map(|pixel| known.get(pixel).copied().unwrap_or(0)).collect())
}

/// Reduces pixels to the nearest colours of a palette that is common to all pictures.
fn quantised(pixels: &[Rgb]) -> (Vec<Rgb>, Vec<u8>) {
    let palette = palette();
    let mut nearest: HashMap<Rgb, u8> = HashMap::new();
    let find = |pixel: &Rgb| {
        let distance = |colour: &Rgb| -> i32 {
            let square = |(a, b): (&u8, &u8)| (i32::from(*a) - i32::from(*b)).pow(2);
            pixel.iter().zip(colour).map(square).sum()
        };
        let is_grey = |colour: &Rgb| colour.iter().all(|part| Some(part) == colour.first());
        let allowed = palette.iter().enumerate().filter(|(_, colour)| !is_grey(pixel) || is_grey(colour));
        let index = allowed.min_by_key(|(_, colour)| distance(colour)).map_or(0, |(i, _)| i);
        u8::try_from(index).unwrap_or(u8::MAX)
    };
    let indices = pixels.iter().map(|pixel| *nearest.entry(*pixel).or_insert_with(|| find(pixel))).collect();
    (palette, indices)
}

/// Returns the common palette: shades of every accent, and greys in the remaining entries.
fn palette() -> Vec<Rgb> {
    let mut palette = vec![BACKGROUND, NO_DATA];
    for accent in ACCENTS.into_iter().filter(|colour| ![BACKGROUND, NO_DATA].contains(colour)) {
        let shade = |part: usize| accent.map(|value| (usize::from(value) * part / SHADES) as u8);
        palette.extend((1..=SHADES).map(shade));
    }
    let greys = COLOURS - palette.len();
    palette.extend((0..greys).map(|i| [(255 * i / (greys - 1)) as u8; 3]));
    palette
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::canvas::colour::ORANGE;

    fn picture(rgb: Vec<Rgb>, width: usize) -> Picture {
        Picture { width, height: rgb.len() / width, rgb, panels: Vec::new() }
    }

    fn decoded(bytes: &[u8]) -> Vec<Rgb> {
        let image = image::load_from_memory(bytes).unwrap().to_rgb8();
        image.pixels().map(|pixel| pixel.0).collect()
    }

    #[test]
    fn few_colours_are_exact_and_many_are_approximated() {
        let few: Vec<Rgb> = (0..240_u8).map(|i| [i, 255 - i, i / 2]).collect();
        assert_eq!(decoded(&encode(&picture(few.clone(), 24), "few").unwrap()), few);
        let mut many: Vec<Rgb> = (0..=255_u8).map(|i| [i; 3]).collect();
        many.extend(ACCENTS);
        many.extend([[1, 2, 3], [200, 10, 10], ORANGE, BACKGROUND, NO_DATA, [255; 3]]);
        let back = decoded(&encode(&picture(many.clone(), 16), "many").unwrap());
        let off = |(a, b): (&Rgb, &Rgb)| a.iter().zip(b).map(|(a, b)| a.abs_diff(*b)).max().unwrap();
        assert!(many[..256].iter().zip(&back).map(off).max().unwrap() <= 2);
        assert!(back[..256].iter().all(|[red, green, blue]| red == green && green == blue));
        for (colour, back) in many[256..].iter().zip(&back[256..]).filter(|(c, _)| ACCENTS.contains(c)) {
            assert_eq!(colour, back);
        }
        assert_eq!(palette().len(), COLOURS);
    }

    #[test]
    fn a_picture_names_its_program_and_is_reproducible() {
        let drawn = picture(vec![[1, 2, 3]; 12], 4);
        let bytes = encode(&drawn, "argon, frame 12 – σ").unwrap();
        assert_eq!(bytes, encode(&drawn, "argon, frame 12 – σ").unwrap());
        assert!(is_boresight_picture(&bytes));
        let header = Decoder::new(Cursor::new(&bytes)).read_info().unwrap();
        let texts = &header.info().uncompressed_latin1_text;
        let of = |keyword: &str| texts.iter().find(|chunk| chunk.keyword == keyword).unwrap().text.clone();
        assert_eq!(of("Title"), "argon, frame 12 ? ?");
        assert_eq!(of("Software"), format!("boresight show {}", env!("CARGO_PKG_VERSION")));
    }

    #[test]
    fn pictures_of_other_programs_are_recognised() {
        let own = encode(&picture(vec![[1, 2, 3]; 12], 4), "own").unwrap();
        let mut other = Cursor::new(Vec::new());
        image::GrayImage::new(4, 3).write_to(&mut other, image::ImageFormat::Png).unwrap();
        assert!(!is_boresight_picture(other.get_ref()));
        for bytes in [&b""[..], b"GIF89a", &own[..20], &own[..45], &own[1..]] {
            assert!(!is_boresight_picture(bytes));
        }
    }
}
