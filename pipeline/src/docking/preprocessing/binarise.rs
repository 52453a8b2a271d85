//! Conversion of grey values to a binary image.

use imageproc::contrast::{ThresholdType, otsu_level, threshold};
use imageproc::image::GrayImage;

/// Returns the threshold between the two modes of a histogram (Otsu 1979).
pub(crate) fn level(grey: &GrayImage) -> u8 {
    otsu_level(grey)
}

/// Returns the thresholds for the search for bright regions, ascending and distinct: Otsu's threshold, that
/// of the values above it (a bright cross beside a grey station), and that of the values below it (a cross in
/// shadow).
pub(crate) fn levels(grey: &GrayImage) -> Vec<u8> {
    let middle = level(grey);
    let part = |keep: &dyn Fn(u8) -> bool| -> Option<u8> {
        let pixels: Vec<u8> = grey.pixels().map(|p| p.0[0]).filter(|&v| keep(v)).collect();
        // A single row suffices, because Otsu's method does not use positions.
        let width = u32::try_from(pixels.len()).ok().filter(|&n| n > 1)?;
        GrayImage::from_raw(width, 1, pixels).map(|image| level(&image))
    };
    let mut found = vec![middle];
    found.extend(part(&|v| v > middle));
    found.extend(part(&|v| v <= middle));
    found.sort_unstable();
    found.dedup();
    found
}

/// Returns an image that is white (255) where the grey value is above the threshold, else black.
pub(crate) fn above(grey: &GrayImage, level: u8) -> GrayImage {
    threshold(grey, level, ThresholdType::Binary)
}

#[cfg(test)]
mod tests {
    use super::*;
    use imageproc::image::Luma;

    #[test]
    fn the_threshold_lies_between_two_modes() {
        // 70 % near 40 and 30 % near 180, each ± 10.
        let grey = GrayImage::from_fn(100, 100, |x, y| {
            let spread = ((x * 7 + y * 13) % 21) as u8;
            Luma([if x < 70 { 30 + spread } else { 170 + spread }])
        });
        let level = level(&grey);
        assert!((50..170).contains(&level), "{level}");
        let white = above(&grey, level).pixels().filter(|p| p.0[0] == 255).count();
        assert_eq!(white, 3000);
    }

    #[test]
    fn a_third_mode_has_a_threshold_of_its_own() {
        // Sky, station and cross.
        let grey = GrayImage::from_fn(100, 100, |x, _| {
            Luma([if x < 50 {
                10
            } else if x < 95 {
                110
            } else {
                230
            }])
        });
        let levels = levels(&grey);
        assert!(levels.iter().any(|l| (10..110).contains(l)), "{levels:?}");
        assert!(levels.iter().any(|l| (110..230).contains(l)), "{levels:?}");
    }

    #[test]
    fn a_flat_image_does_not_disturb() {
        assert!(!levels(&GrayImage::from_pixel(10, 10, Luma([77]))).is_empty());
        assert!(!levels(&GrayImage::new(0, 0)).is_empty());
    }
}
