//! What arrives on the ground: the whole image, or the pixels of its regions.

use contract::{Frame, Window};

use crate::SimError;
use crate::sensor::RawImage;

/// Bytes that say where a region is: its first column and row, its columns and rows, two bytes each.
const REGION_HEADER_BYTES: usize = 8;

/// The frame that arrives: with `windows`, every pixel outside them is 0; without, the whole image.
///
/// # Errors
/// [`SimError::Contract`] when a window leaves the image.
pub fn downlink(image: &RawImage, number: u64, windows: Option<Vec<Window>>) -> Result<Frame, SimError> {
    let (columns, rows) = image.size();
    let dn = match &windows {
        None => image.dn().to_vec(),
        Some(windows) => {
            let mut dn = vec![0; columns * rows];
            for window in windows {
                for y in window.y..window.y.saturating_add(window.rows).min(rows) {
                    let from = y * columns + window.x.min(columns);
                    let to = y * columns + window.x.saturating_add(window.columns).min(columns);
                    dn[from..to].copy_from_slice(&image.dn()[from..to]);
                }
            }
            dn
        }
    };
    Ok(Frame::new(number, columns, rows, image.bit_depth(), dn, windows)?)
}

/// Size of a frame in telemetry, bytes: the pixels of each region, packed to the bits of the converter and filled up
/// to a byte, and eight bytes to say where it is; the whole image needs no such header. Pixels that regions share
/// are sent with each.
pub fn downlink_bytes(frame: &Frame) -> usize {
    let bits = frame.bit_depth();
    match frame.windows() {
        None => image_bytes(frame.columns(), frame.rows(), bits),
        Some(windows) => windows.iter().map(|window| region_bytes(window.columns, window.rows, bits)).sum(),
    }
}

/// Size of a whole image of `columns` × `rows` in telemetry, bytes.
pub fn image_bytes(columns: usize, rows: usize, bit_depth: u8) -> usize {
    (columns * rows * usize::from(bit_depth)).div_ceil(8)
}

/// Size of a region in telemetry, bytes, with what says where it is.
pub(super) fn region_bytes(columns: usize, rows: usize, bit_depth: u8) -> usize {
    REGION_HEADER_BYTES + image_bytes(columns, rows, bit_depth)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn image() -> RawImage {
        RawImage::from_dn(10, 5, 12, (1..=50).collect())
    }

    #[test]
    fn outside_the_regions_everything_is_zero() {
        let windows =
            vec![Window { x: 2, y: 1, columns: 3, rows: 2 }, Window { x: 4, y: 2, columns: 6, rows: 3 }];
        let frame = downlink(&image(), 7, Some(windows.clone())).unwrap();
        for y in 0..5 {
            for x in 0..10 {
                let sent = windows.iter().any(|window| window.contains(x, y));
                assert_eq!(frame.at(x, y), if sent { (y * 10 + x + 1) as u16 } else { 0 });
            }
        }
        // 6 pixels of 12 bits are 9 bytes, 18 are 27; two headers of 8.
        assert_eq!(downlink_bytes(&frame), 9 + 27 + 16);
    }

    #[test]
    fn without_regions_the_whole_image_arrives() {
        let frame = downlink(&image(), 7, None).unwrap();
        assert_eq!((frame.number(), frame.dn()), (7, image().dn()));
        assert_eq!(downlink_bytes(&frame), 75);
    }

    #[test]
    fn a_region_outside_the_image_is_refused() {
        for (x, y) in [(8, 0), (0, 5), (1 << 40, 1 << 20)] {
            let window = Window { x, y, columns: 3, rows: 1 };
            assert!(downlink(&image(), 0, Some(vec![window])).is_err());
        }
    }
}
