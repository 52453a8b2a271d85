//! Field as a video signal, and its conversion by the frame grabber.

use contract::Frame;
use contract::docking::{Digitiser, Field, Lines};
use optics::simd_kernel::arch;

/// Bit depth of the frame grabber.
pub const BIT_DEPTH: u8 = 8;

/// One field before the digitiser: 0 is the black level of the video and 1 its white level.
#[derive(Debug, Clone, PartialEq)]
pub struct VideoField {
    number: u64,
    columns: usize,
    camera_rows: usize,
    lines: Lines,
    signal: Vec<f32>,
}

impl VideoField {
    /// Creates a field from the rows `lines` of a camera of `columns` × `camera_rows`; `None` if `signal`
    /// does not have that number of values.
    pub fn new(
        number: u64,
        columns: usize,
        camera_rows: usize,
        lines: Lines,
        signal: Vec<f32>,
    ) -> Option<Self> {
        (lines.rows(camera_rows).checked_mul(columns) == Some(signal.len())).then_some(Self {
            number,
            columns,
            camera_rows,
            lines,
            signal,
        })
    }

    /// Number of the field in its sequence.
    pub fn number(&self) -> u64 {
        self.number
    }

    /// Number of columns.
    pub fn columns(&self) -> usize {
        self.columns
    }

    /// Rows of the camera that the field holds.
    pub fn lines(&self) -> Lines {
        self.lines
    }

    /// The signal, row by row.
    pub fn signal(&self) -> &[f32] {
        &self.signal
    }

    /// Returns digital numbers of eight bits: 255 × (contrast × signal + brightness), clipped to 0 to 255 and
    /// rounded, halves upwards.
    pub fn digitise(&self, digitiser: &Digitiser) -> Field {
        let full_scale = 255.0_f32;
        let slope = full_scale * digitiser.contrast as f32;
        let offset = full_scale * digitiser.brightness as f32;
        let mut dn = vec![0; self.signal.len()];
        arch().dispatch(Digits { signal: &self.signal, slope, offset, full_scale, dn: &mut dn });
        Frame::new(self.number, self.columns, self.lines.rows(self.camera_rows), BIT_DEPTH, dn, None)
            .and_then(|image| Field::new(image, self.lines, self.camera_rows))
            .expect("the number of values was checked when the field was made")
    }
}

/// Task of converting signal levels to integers.
struct Digits<'a> {
    signal: &'a [f32],
    slope: f32,
    offset: f32,
    full_scale: f32,
    dn: &'a mut [u16],
}

impl pulp::WithSimd for Digits<'_> {
    type Output = ();

    // Inlined: only then is it compiled for the registers of the machine. The bits of the result do not
    // depend on the registers.
    #[inline(always)]
    fn with_simd<S: pulp::Simd>(self, _: S) {
        for (dn, s) in self.dn.iter_mut().zip(self.signal) {
            let level = self.slope * s + self.offset;
            // `clamp` is not used, because NaN must become black.
            let level = if level > 0.0 { level } else { 0.0 };
            *dn = whole_part(if level < self.full_scale { level } else { self.full_scale } + 0.5);
        }
    }
}

/// Integer part of a number from 0 to 65535. It is computed by additions, which a processor does for many
/// numbers at once; a cast would have to check for values that do not fit. At 2²³ the last bit of single
/// precision is worth 1.
#[inline(always)]
fn whole_part(value: f32) -> u16 {
    const ONES: f32 = 8_388_608.0;
    let nearest = (value + ONES) - ONES;
    let whole = if nearest > value { nearest - 1.0 } else { nearest };
    (whole + ONES).to_bits() as u16
}

#[cfg(test)]
mod tests {
    use super::*;
    use optics::simd_kernel::registers::same_on_all_registers;

    fn digits(signal: &[f32], contrast: f64, brightness: f64) -> Vec<u16> {
        let video = VideoField::new(3, signal.len(), 1, Lines::All, signal.to_vec()).unwrap();
        video.digitise(&Digitiser { contrast, brightness }).image().dn().to_vec()
    }

    #[test]
    fn digits_are_the_same_on_all_registers() {
        let signal: Vec<f32> = (0..177_u32).map(|x| libm::sinf((x * x) as f32)).collect();
        same_on_all_registers(|| digits(&signal, 0.9, 0.3));
    }

    #[test]
    fn signals_are_stretched_rounded_and_clipped() {
        let signal = [-0.5, 0.0, 0.4999 / 255.0, 0.5001 / 255.0, 0.5, 1.0, 1.5];
        assert_eq!(digits(&signal, 1.0, 0.0), [0, 0, 0, 1, 128, 255, 255]);
        assert_eq!(digits(&[0.1, 0.2, 0.6], 2.0, -0.2), [0, 51, 255]);
        assert_eq!(digits(&[f32::NAN], 1.0, 0.0), [0]);
    }

    #[test]
    fn a_whole_part_is_that_of_a_cast() {
        for i in 0..65_535_u32 {
            for value in [i as f32, i as f32 + 0.5, (i as f32 + 1.0).next_down()] {
                assert_eq!(u32::from(whole_part(value)), i, "{value}");
            }
        }
    }

    #[test]
    fn a_field_keeps_its_number_and_rows() {
        let video = VideoField::new(7, 4, 5, Lines::Odd, vec![0.0; 8]).unwrap();
        let field = video.digitise(&Digitiser::default());
        assert_eq!((field.number(), field.lines(), field.camera_rows()), (7, Lines::Odd, 5));
        assert_eq!(VideoField::new(7, 4, 5, Lines::Even, vec![0.0; 8]), None);
    }
}
