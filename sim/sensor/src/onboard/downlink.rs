//! Transmitted image: the whole image, or the pixels of its regions.

use contract::{Frame, Window};
use truth::SimError;

use crate::RawImage;

/// Size of a region's header, bytes: its first column and row, its columns and rows, two bytes each.
const REGION_HEADER_BYTES: usize = 8;

/// Returns the transmitted frame: with `windows`, every pixel outside them is 0; without, the whole image.
///
/// # Errors
/// [`SimError::Contract`] if a window extends beyond the image.
pub fn downlink(image: &RawImage, number: u64, windows: Option<Vec<Window>>) -> Result<Frame, SimError> {
    downlink_in(None, image, number, windows)
}

/// Performs [`downlink`] in the memory of `spare`, if it has the size of the image.
///
/// # Errors
/// Those of [`downlink`].
pub fn downlink_in(
    spare: Option<Frame>,
    image: &RawImage,
    number: u64,
    windows: Option<Vec<Window>>,
) -> Result<Frame, SimError> {
    let (columns, rows) = image.size();
    let spare = spare.filter(|frame| (frame.columns(), frame.rows()) == (columns, rows));
    let dn = match (&windows, spare) {
        (None, None) => image.dn().to_vec(),
        (None, Some(frame)) => {
            let mut dn = frame.into_dn();
            dn.copy_from_slice(image.dn());
            dn
        }
        (Some(windows), spare) => {
            let mut dn = spare.map_or_else(|| vec![0; columns * rows], blank);
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

/// Clears the memory of a frame to zero: if it had regions, only their pixels have to be cleared.
fn blank(frame: Frame) -> Vec<u16> {
    let columns = frame.columns();
    let windows = frame.windows().map(<[_]>::to_vec);
    let mut dn = frame.into_dn();
    match windows {
        None => dn.fill(0),
        Some(windows) => {
            for Window { x, y, columns: width, rows } in windows {
                (y..y + rows).for_each(|y| dn[y * columns + x..y * columns + x + width].fill(0));
            }
        }
    }
    dn
}

/// Size of a frame in telemetry, bytes: for each region the pixels, packed to the bits of the converter and
/// padded to a byte, and a header of eight bytes with its position; the whole image needs no header. Pixels
/// that regions share are sent with each region.
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

/// Size of a region in telemetry, bytes, including its header.
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
                assert_eq!(frame.dn_at(x, y), if sent { (y * 10 + x + 1) as u16 } else { 0 });
            }
        }
        // 6 pixels of 12 bits are 9 bytes, 18 pixels are 27 bytes, and each of the two headers is 8 bytes.
        assert_eq!(downlink_bytes(&frame), 9 + 27 + 16);
    }

    #[test]
    fn without_regions_the_whole_image_arrives() {
        let frame = downlink(&image(), 7, None).unwrap();
        assert_eq!((frame.number(), frame.dn()), (7, image().dn()));
        assert_eq!(downlink_bytes(&frame), 75);
    }

    #[test]
    fn a_frame_is_the_same_in_reused_and_in_new_memory() {
        let windows = |x, y| {
            Some(vec![Window { x, y, columns: 3, rows: 2 }, Window { x: 7, y: 0, columns: 3, rows: 5 }])
        };
        let kinds = [None, windows(0, 0), windows(2, 3), Some(Vec::new())];
        let made =
            |windows: &Option<Vec<Window>>, spare| downlink_in(spare, &image(), 7, windows.clone()).unwrap();
        for before in &kinds {
            for after in &kinds {
                assert_eq!(made(after, Some(made(before, None))), made(after, None));
            }
        }
        let other = downlink(&RawImage::from_dn(5, 10, 12, vec![3; 50]), 1, None).unwrap();
        assert_eq!(made(&kinds[1], Some(other)), made(&kinds[1], None));
    }

    #[test]
    fn a_region_outside_the_image_is_refused() {
        for (x, y) in [(8, 0), (0, 5), (1 << 40, 1 << 20)] {
            let window = Window { x, y, columns: 3, rows: 1 };
            assert!(downlink(&image(), 0, Some(vec![window])).is_err());
        }
    }
}
