//! Point-spread function of the lens for a whole image: a separable Gaussian, applied only to the rows that
//! are kept.

use contract::docking::Lines;

use crate::simd_kernel::arch;

/// Half width of a kernel in standard deviations: 6e-5 of a Gaussian's flux lies beyond it on one axis.
const REACH_SIGMAS: f64 = 4.0;

/// Number of values that are summed in parallel: few enough for a processor's registers.
const LANES: usize = 32;

/// Writes the sum of `kernel[j] × padded[x + j]` over all j, in their order, to `out[x]`. `padded` is
/// `kernel.len()` − 1 longer than `out`.
pub fn correlate(padded: &[f32], kernel: &[f32], out: &mut [f32]) {
    arch().dispatch(WeightedSum { kernel, row: |j: usize| &padded[j..], out });
}

/// Writes the sum of `kernel[j] × row(j)[x]` over all j, in their order, to `out[x]`. Rows may be longer than
/// `out`.
struct WeightedSum<'a, R> {
    kernel: &'a [f32],
    row: R,
    out: &'a mut [f32],
}

impl<'a, R: Fn(usize) -> &'a [f32]> pulp::WithSimd for WeightedSum<'_, R> {
    type Output = ();

    // Inlining is required to compile this function for the registers of the machine. The result is
    // bit-identical on all registers.
    #[inline(always)]
    fn with_simd<S: pulp::Simd>(self, _: S) {
        weighted_sum(self.kernel, self.row, self.out);
    }
}

#[inline(always)]
fn weighted_sum<'a>(kernel: &[f32], row: impl Fn(usize) -> &'a [f32], out: &mut [f32]) {
    let whole = out.len() - out.len() % LANES;
    let (blocks, rest) = out.split_at_mut(whole);
    for (i, block) in blocks.chunks_exact_mut(LANES).enumerate() {
        let mut sums = [0.0_f32; LANES];
        for (j, &weight) in kernel.iter().enumerate() {
            let values = &row(j)[i * LANES..][..LANES];
            for (sum, &value) in sums.iter_mut().zip(values) {
                *sum += weight * value;
            }
        }
        block.copy_from_slice(&sums);
    }
    rest.fill(0.0);
    for (j, &weight) in kernel.iter().enumerate() {
        for (sum, &value) in rest.iter_mut().zip(&row(j)[whole..]) {
            *sum += weight * value;
        }
    }
}

/// Copies a row to `padded`, with its first value repeated `before` times in front and its last value
/// repeated `after` times at the end.
pub fn pad(row: &[f32], before: usize, after: usize, padded: &mut Vec<f32>) {
    padded.clear();
    padded.resize(before, row.first().copied().unwrap_or(0.0));
    padded.extend_from_slice(row);
    padded.resize(before + row.len() + after, row.last().copied().unwrap_or(0.0));
}

/// Sampled Gaussian of unit sum, out to four standard deviations on each side.
pub fn gaussian_kernel(sigma_px: f64) -> Vec<f32> {
    if sigma_px <= 0.0 {
        return vec![1.0];
    }
    let reach = (REACH_SIGMAS * sigma_px).ceil() as i32;
    let weights: Vec<f64> = (-reach..=reach)
        .map(|i| libm::exp(-0.5 * (f64::from(i) / sigma_px) * (f64::from(i) / sigma_px)))
        .collect();
    let sum: f64 = weights.iter().sum();
    weights.iter().map(|w| (w / sum) as f32).collect()
}

/// Blurs pixel-integrated images by a Gaussian, and keeps the rows of one field.
///
/// The image continues beyond its border with its border values, so that a uniform image stays uniform;
/// inside, flux is preserved (the kernel has unit sum). The kernel is sampled at integer pixels: its variance
/// is that of the Gaussian to 1e-4 px² from σ = 0.6 px up, and smaller below.
#[derive(Debug, Clone, PartialEq)]
pub struct ImageBlur {
    kernel: Vec<f32>,
    column: Vec<f32>,
    padded: Vec<f32>,
}

impl ImageBlur {
    /// Creates a blur with a standard deviation in px; 0 leaves images unchanged.
    pub fn new(sigma_px: f64) -> Self {
        Self { kernel: gaussian_kernel(sigma_px), column: Vec::new(), padded: Vec::new() }
    }

    /// Blurs the rows `lines` of `image`, whose rows are `columns` long, into `kept`.
    pub fn blur(&mut self, image: &[f32], columns: usize, lines: Lines, kept: &mut Vec<f32>) {
        let columns = columns.max(1);
        let camera_rows = image.len() / columns;
        let reach = self.kernel.len() / 2;
        kept.clear();
        kept.resize(lines.rows(camera_rows) * columns, 0.0);
        self.column.resize(columns, 0.0);
        for (k, out) in kept.chunks_exact_mut(columns).enumerate() {
            let y = lines.camera_row(k);
            let row = |j: usize| &image[(y + j).saturating_sub(reach).min(camera_rows - 1) * columns..];
            let (kernel, sums) = (&self.kernel, &mut self.column);
            arch().dispatch(WeightedSum { kernel, row, out: sums });
            pad(&self.column, reach, reach, &mut self.padded);
            correlate(&self.padded, &self.kernel, out);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::simd_kernel::registers::same_on_all_registers;

    fn blurred(sigma_px: f64, image: &[f32], columns: usize, lines: Lines) -> Vec<f32> {
        let mut kept = Vec::new();
        ImageBlur::new(sigma_px).blur(image, columns, lines, &mut kept);
        kept
    }

    #[test]
    fn a_sum_is_the_same_bits_on_all_registers() {
        let values: Vec<f32> = (0..177_u32).map(|x| libm::sinf((x * x) as f32)).collect();
        let kernel = gaussian_kernel(2.3);
        same_on_all_registers(|| {
            let mut out = vec![0.0; 150];
            correlate(&values, &kernel, &mut out);
            out.iter().map(|sum: &f32| sum.to_bits()).collect::<Vec<_>>()
        });
    }

    #[test]
    fn a_point_becomes_a_gaussian_of_the_same_flux() {
        let (n, centre) = (31_usize, 15_usize);
        let mut image = vec![0.0; n * n];
        image[centre * n + centre] = 1000.0;
        let sigma = 0.7;
        let kept = blurred(sigma, &image, n, Lines::All);
        let sum: f64 = kept.iter().map(|v| f64::from(*v)).sum();
        // Seven f32 roundings per pass.
        assert!((sum - 1000.0).abs() < 1e-3, "{sum}");
        let offset = |i: usize| i as f64 - centre as f64;
        let moment = |power: &dyn Fn(f64, f64) -> f64| {
            kept.iter()
                .enumerate()
                .map(|(i, v)| power(offset(i % n), offset(i / n)) * f64::from(*v) / 1000.0)
                .sum::<f64>()
        };
        // Variance of the sampled Gaussian: Poisson's summation gives 0.49 − 4e-3·…; measured 0.4892.
        assert!((moment(&|x, _| x * x) - sigma * sigma).abs() < 2e-3);
        assert!((moment(&|_, y| y * y) - sigma * sigma).abs() < 2e-3);
        assert!(moment(&|x, y| x * y).abs() < 1e-6);
        let peak = f64::from(kept[centre * n + centre]) / 1000.0;
        let theory = 1.0 / (2.0 * std::f64::consts::PI * sigma * sigma);
        assert!((peak / theory - 1.0).abs() < 1e-3, "{peak} {theory}");
    }

    #[test]
    fn a_field_has_the_rows_of_the_frame() {
        let (columns, rows) = (40, 30);
        let image: Vec<f32> = (0..columns * rows).map(|i| ((i * 7919) % 997) as f32).collect();
        let frame = blurred(1.3, &image, columns, Lines::All);
        for lines in [Lines::Even, Lines::Odd] {
            let field = blurred(1.3, &image, columns, lines);
            for (k, row) in field.chunks_exact(columns).enumerate() {
                let y = lines.camera_row(k);
                assert_eq!(row, &frame[y * columns..(y + 1) * columns]);
            }
        }
    }

    #[test]
    fn a_uniform_image_stays_uniform_and_zero_blur_changes_nothing() {
        for value in blurred(0.7, &[0.25; 200], 20, Lines::All) {
            assert!((value - 0.25).abs() < 1e-6);
        }
        let image: Vec<f32> = (0..200).map(|i| i as f32).collect();
        assert_eq!(blurred(0.0, &image, 20, Lines::All), image);
    }
}
