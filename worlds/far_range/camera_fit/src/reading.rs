//! Images that do not show the sky as a camera sees it: mirrored, negative, with swapped bytes.

use contract::{Camera, ContractError, ListedStar, PixelPoint};
use files::{GreyImage, PixelConversion};
use pipeline::far_range::PlateSolver;
use rayon::prelude::*;

use crate::fit::SkyFrame;
use crate::solution::star_like_sources;
use crate::sources::{ImageSources, find_sources};

/// Number of frames, those with the most sources, that are tried with each reading.
const TRIED_FRAMES: usize = 3;

/// Roughness of an image as stored over that with swapped bytes, from which on its bytes are swapped.
/// Neighbouring pixels differ by the noise; with swapped bytes by 256 times as much.
const SWAPPED_ROUGHNESS: f64 = 16.0;

/// Way in which images must be read so that their stars fit the catalogue.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Reading {
    /// Columns from right to left. An image whose rows are reversed is the same, turned by 180°.
    Mirrored,
    /// Dark stars on a bright sky.
    Negative,
    /// The bytes of 16-bit values in the other order.
    BytesSwapped,
}

impl std::fmt::Display for Reading {
    fn fmt(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        formatter.write_str(match self {
            Self::Mirrored => {
                "the images are mirrored left to right: flip them (images mirrored top to bottom are the same, \
                 turned by 180°). Their stars fit the catalogue only so"
            }
            Self::Negative => {
                "the images are negatives, with dark stars: invert them. Their stars fit the catalogue only so"
            }
            Self::BytesSwapped => {
                "the bytes of the 16-bit values are swapped: neighbouring pixels differ by multiples of 256. Write \
                 the image with the other order of bytes"
            }
        })
    }
}

/// Returns true if the bytes of the values of an image of 16 bits are in the wrong order.
pub(crate) fn has_swapped_bytes(image: &GreyImage) -> bool {
    if image.full_scale <= 255.0 || image.conversion != PixelConversion::None {
        return false;
    }
    let swapped = |value: f32| f64::from((value as u16).swap_bytes());
    let (mut as_stored, mut as_swapped) = (0.0, 0.0);
    for row in image.values.chunks_exact(image.columns.max(1)) {
        for (left, right) in row.iter().zip(row.iter().skip(1)) {
            as_stored += f64::from((left - right).abs());
            as_swapped += (swapped(*left) - swapped(*right)).abs();
        }
    }
    // Eight bits times 256 are a brighter image, whose swapped form is the fainter one.
    let has_low_byte = image.values.iter().any(|value| (*value as u16) & 0xFF != 0);
    has_low_byte && as_stored > SWAPPED_ROUGHNESS * as_swapped
}

/// Returns the reading with which the stars of a frame fit the catalogue, and the name of the frame, after
/// all frames failed as they are: at the same odds, for the frames with the most sources.
///
/// # Errors
/// Those of [`PlateSolver::new`].
pub(crate) fn other_reading(
    frames: &[SkyFrame],
    sources: &[ImageSources],
    stars: &[ListedStar],
    camera: &Camera,
    tolerance: f64,
) -> Result<Option<(String, Reading)>, ContractError> {
    let solver = PlateSolver::new(stars, camera, tolerance)?;
    let mirrored = |at: PixelPoint| PixelPoint::new(camera.columns as f64 - 1.0 - at.x, at.y);
    for frame in richest(sources) {
        let mut list = star_like_sources(&sources[frame]);
        for (position, _) in &mut list {
            *position = mirrored(*position);
        }
        if solver.solve(&list).is_some() {
            return Ok(Some((frames[frame].name.clone(), Reading::Mirrored)));
        }
    }
    let negatives: Vec<ImageSources> = frames
        .par_iter()
        .map(|frame| find_sources(&inverted(&frame.image), frame.image.full_scale))
        .collect();
    for frame in richest(&negatives) {
        if solver.solve(&star_like_sources(&negatives[frame])).is_some() {
            return Ok(Some((frames[frame].name.clone(), Reading::Negative)));
        }
    }
    Ok(None)
}

/// Returns the frames with the most sources, by their index; none with trails.
fn richest(sources: &[ImageSources]) -> Vec<usize> {
    let mut order: Vec<usize> =
        (0..sources.len()).filter(|&frame| sources[frame].trail_deg().is_none()).collect();
    order.sort_by_key(|&frame| std::cmp::Reverse(sources[frame].sources.len()));
    order.truncate(TRIED_FRAMES);
    order
}

/// Returns the negative of an image.
fn inverted(image: &GreyImage) -> GreyImage {
    let highest = image.values.iter().copied().fold(f32::NEG_INFINITY, f32::max);
    GreyImage { values: image.values.iter().map(|value| highest - value).collect(), ..image.clone() }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// An image of noise about a level, of values times `factor`.
    fn image(level: u16, noise: u16, factor: u16) -> GreyImage {
        let mut state = 1_u32;
        let mut next = || {
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            (state >> 16) as u16
        };
        GreyImage {
            columns: 64,
            rows: 64,
            values: (0..4096).map(|_| f32::from((level + next() % noise) * factor)).collect(),
            full_scale: 65_535.0,
            conversion: PixelConversion::None,
        }
    }

    #[test]
    fn swapped_bytes_are_recognised_and_no_others() {
        let swapped = |image: &GreyImage| GreyImage {
            values: image.values.iter().map(|value| f32::from((*value as u16).swap_bytes())).collect(),
            ..image.clone()
        };
        // 12 bits, 12 bits in the upper 12 of 16, 16 bits, and 8 bits times 257.
        for (level, noise, factor) in [(250, 12, 1), (80, 12, 16), (20_000, 900, 1), (70, 9, 257)] {
            let image = image(level, noise, factor);
            assert!(!has_swapped_bytes(&image), "{level} {noise} {factor}");
            let is_symmetric = factor == 257;
            assert_eq!(has_swapped_bytes(&swapped(&image)), !is_symmetric, "{level} {noise} {factor}");
        }
        // Eight bits times 256 look the same either way.
        assert!(!has_swapped_bytes(&image(70, 9, 256)));
        assert!(!has_swapped_bytes(&GreyImage { full_scale: 255.0, ..image(70, 9, 1) }));
    }
}
