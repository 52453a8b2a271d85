//! Mean and temporal noise of a stack, split into pixels, rows and columns.

use libm::sqrt;

use crate::stack::FrameStack;

/// Maps of a stack before any pixel is left out.
#[derive(Debug, Clone)]
pub(crate) struct PixelMaps {
    /// Mean of each pixel over the frames, DN.
    pub(crate) mean: Vec<f32>,
    /// Temporal variance of each pixel, DN².
    pub(crate) variance: Vec<f32>,
}

/// A variance with its standard deviation, DN².
pub(crate) type Variance = [f64; 2];

/// Moments of the good pixels of a stack.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct StackMoments {
    /// Number of frames.
    pub(crate) frames: usize,
    /// Mean of all good pixels, DN.
    pub(crate) mean: f64,
    /// Standard deviation of the mean by the temporal noise of pixels, rows and columns, DN.
    pub(crate) mean_sigma: f64,
    /// Temporal variance of a pixel, without the noise common to rows and columns.
    pub(crate) pixel: Variance,
    /// Temporal variance of the offset common to a row.
    pub(crate) row: Variance,
    /// Temporal variance of the offset common to a column.
    pub(crate) column: Variance,
    /// Variance of the pixels of one frame, temporal and spatial.
    pub(crate) total: Variance,
    /// Variance of the frames' means, and that expected from the temporal noise.
    pub(crate) frame_mean: [f64; 2],
    /// Share of the samples at the largest digital number of all stacks.
    pub(crate) share_at_top: f64,
    /// Share of the samples at 0.
    pub(crate) share_at_zero: f64,
}

/// Change of a frame against the mean of its stack.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum FrameChange {
    /// Offset: frames without light.
    Offset,
    /// Factor of the light above a level, DN.
    Factor(f64),
}

/// Returns mean and variance of every pixel. The frames' means are made equal first.
pub(crate) fn pixel_maps(stack: &FrameStack) -> PixelMaps {
    let count = stack.frames.len() as f64;
    let pixels = stack.frames.first().map_or(0, Vec::len);
    let frame_means: Vec<f64> = stack.frames.iter().map(|frame| mean_of(frame)).collect();
    let mean = frame_means.iter().sum::<f64>() / count;
    let mut sums = vec![[0.0_f32; 2]; pixels];
    for (frame, frame_mean) in stack.frames.iter().zip(&frame_means) {
        for (sum, dn) in sums.iter_mut().zip(frame) {
            // About the mean of the stack, so that single precision loses nothing.
            let off = (f64::from(*dn) - frame_mean) as f32;
            sum[0] += off;
            sum[1] += off * off;
        }
    }
    let n = count as f32;
    PixelMaps {
        mean: sums.iter().map(|sum| (mean + f64::from(sum[0] / n)) as f32).collect(),
        variance: sums.iter().map(|sum| ((sum[1] - sum[0] * sum[0] / n) / (n - 1.0)).max(0.0)).collect(),
    }
}

fn mean_of(frame: &[u16]) -> f64 {
    frame.iter().map(|dn| u64::from(*dn)).sum::<u64>() as f64 / frame.len().max(1) as f64
}

/// Geometry and good pixels of a sensor.
#[derive(Debug, Clone)]
pub(crate) struct GoodPixels {
    pub(crate) columns: usize,
    pub(crate) rows: usize,
    /// True for each pixel that takes part, row by row.
    pub(crate) is_good: Vec<bool>,
}

impl GoodPixels {
    /// Number of pixels that take part.
    pub(crate) fn count(&self) -> usize {
        self.is_good.iter().filter(|good| **good).count()
    }

    /// Numbers of good pixels of each row and of each column.
    pub(crate) fn line_counts(&self) -> [Vec<f64>; 2] {
        let (mut rows, mut columns) = (vec![0.0; self.rows], vec![0.0; self.columns]);
        for (index, _) in self.is_good.iter().enumerate().filter(|(_, good)| **good) {
            rows[index / self.columns] += 1.0;
            columns[index % self.columns] += 1.0;
        }
        [rows, columns]
    }
}

/// Sums of squares of an image about its mean: of the means of rows, of the means of columns, and of the
/// rest. A balanced two-way analysis of variance; with few pixels left out, its means are those of the good
/// pixels.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct LineVariances {
    /// Mean squares of rows, columns and the rest.
    pub(crate) mean_squares: [f64; 3],
    /// Degrees of freedom of each.
    pub(crate) degrees: [f64; 3],
    /// Mean numbers of good pixels in a row and in a column.
    pub(crate) lengths: [f64; 2],
    /// Variance of the mean squares of the rest, from the scatter of the pixels' squares.
    pub(crate) rest_sigma: f64,
}

/// Analyses several images of the same pixels, for instance the residuals of frames, which have the degrees
/// of freedom of `degrees_of_images` images.
pub(crate) fn line_variances(
    images: &mut dyn Iterator<Item = Vec<f32>>,
    good: &GoodPixels,
    degrees_of_images: f64,
) -> LineVariances {
    let [row_counts, column_counts] = good.line_counts();
    let count = good.count() as f64;
    let used = |counts: &[f64]| counts.iter().filter(|count| **count > 0.0).count() as f64;
    let (rows, columns) = (used(&row_counts), used(&column_counts));
    let mut sums = [0.0_f64; 3];
    let mut squares = vec![0.0_f32; good.is_good.len()];
    for image in images {
        let (mut row_sums, mut column_sums) = (vec![0.0_f64; good.rows], vec![0.0_f64; good.columns]);
        for (index, value) in image.iter().enumerate().filter(|(index, _)| good.is_good[*index]) {
            row_sums[index / good.columns] += f64::from(*value);
            column_sums[index % good.columns] += f64::from(*value);
        }
        let mean = row_sums.iter().sum::<f64>() / count;
        let mean_lines = |sums: &mut [f64], counts: &[f64]| {
            for (sum, count) in sums.iter_mut().zip(counts) {
                *sum = if *count > 0.0 { *sum / count - mean } else { 0.0 };
            }
            sums.iter().zip(counts).map(|(line, count)| line * line * count).sum::<f64>()
        };
        sums[0] += mean_lines(&mut row_sums, &row_counts);
        sums[1] += mean_lines(&mut column_sums, &column_counts);
        for (index, value) in image.iter().enumerate().filter(|(index, _)| good.is_good[*index]) {
            let (row, column) = (row_sums[index / good.columns], column_sums[index % good.columns]);
            let rest = f64::from(*value) - mean - row - column;
            sums[2] += rest * rest;
            squares[index] += (rest * rest) as f32;
        }
    }
    let degrees = [rows - 1.0, columns - 1.0, count - rows - columns + 1.0].map(|d| d * degrees_of_images);
    let mean_squares = [0, 1, 2].map(|i| if degrees[i] > 0.0 { sums[i] / degrees[i] } else { 0.0 });
    // The scatter of the pixels' squares has the kurtosis of the noise and the different noise of pixels.
    let mean_square = sums[2] / count;
    let scatter: f64 = squares
        .iter()
        .zip(&good.is_good)
        .filter(|(_, good)| **good)
        .map(|(square, _)| (f64::from(*square) - mean_square) * (f64::from(*square) - mean_square))
        .sum::<f64>()
        / (count - 1.0);
    let scale = if degrees[2] > 0.0 { count / degrees[2] } else { 0.0 };
    LineVariances {
        mean_squares,
        degrees,
        lengths: [count / rows, count / columns],
        rest_sigma: scale * sqrt(scatter / count),
    }
}

impl LineVariances {
    /// Variances of rows, of columns and of single pixels, each with its standard deviation.
    pub(crate) fn components(&self) -> [Variance; 3] {
        let [row, column, rest] = self.mean_squares;
        let line = |mean_square: f64, degrees: f64, length: f64| {
            let sigma = mean_square * sqrt(2.0 / degrees.max(1.0)) / length;
            [(mean_square - rest) / length, sigma]
        };
        [
            line(row, self.degrees[0], self.lengths[0]),
            line(column, self.degrees[1], self.lengths[1]),
            [rest, self.rest_sigma],
        ]
    }
}

/// Returns the moments of the good pixels of a stack.
pub(crate) fn stack_moments(
    stack: &FrameStack,
    maps: &PixelMaps,
    good: &GoodPixels,
    change: FrameChange,
    top_dn: u16,
) -> StackMoments {
    let frames = stack.frames.len();
    let good_mean = |frame: &[u16]| {
        let sum: u64 =
            frame.iter().zip(&good.is_good).filter(|(_, good)| **good).map(|(dn, _)| u64::from(*dn)).sum();
        sum as f64 / good.count() as f64
    };
    let frame_means: Vec<f64> = stack.frames.iter().map(|frame| good_mean(frame)).collect();
    let mean = frame_means.iter().sum::<f64>() / frames as f64;
    // Residuals of each frame about the mean image, with the frame's offset or its factor of the light.
    let mut residuals = stack.frames.iter().zip(&frame_means).map(|(frame, frame_mean)| {
        frame
            .iter()
            .zip(&maps.mean)
            .map(|(dn, pixel_mean)| {
                let pixel_mean = f64::from(*pixel_mean);
                let expected = match change {
                    FrameChange::Factor(level) if mean - level > 1.0 => {
                        pixel_mean + (frame_mean - mean) / (mean - level) * (pixel_mean - level)
                    }
                    _ => pixel_mean + frame_mean - mean,
                };
                (f64::from(*dn) - expected) as f32
            })
            .collect()
    });
    let lines = line_variances(&mut residuals, good, frames as f64 - 1.0);
    let [row, column, pixel] = lines.components();
    let count = good.count() as f64;
    let frame_variance = pixel[0] / count
        + row[0].max(0.0) * lines.lengths[0] / count
        + column[0].max(0.0) * lines.lengths[1] / count;
    let scatter = frame_means.iter().map(|value| (value - mean) * (value - mean)).sum::<f64>();
    let (share_at_top, share_at_zero) = end_shares(stack, good, top_dn);
    StackMoments {
        frames,
        mean,
        mean_sigma: sqrt(frame_variance / frames as f64),
        pixel,
        row,
        column,
        total: total_variance(stack, good, &frame_means),
        frame_mean: [scatter / (frames as f64 - 1.0), frame_variance],
        share_at_top,
        share_at_zero,
    }
}

/// Variance of the good pixels about the mean of their frame, mean of the frames.
fn total_variance(stack: &FrameStack, good: &GoodPixels, frame_means: &[f64]) -> Variance {
    let (mut second, mut fourth, mut count) = (0.0, 0.0, 0.0);
    for (frame, mean) in stack.frames.iter().zip(frame_means) {
        for (dn, _) in frame.iter().zip(&good.is_good).filter(|(_, good)| **good) {
            let square = (f64::from(*dn) - mean) * (f64::from(*dn) - mean);
            second += square;
            fourth += square * square;
            count += 1.0;
        }
    }
    let variance = second / count;
    // Fixed patterns repeat in every frame: the pixels of one frame count, not all samples.
    let independent = count / stack.frames.len() as f64;
    [variance, sqrt((fourth / count - variance * variance).max(0.0) / independent)]
}

/// Shares of the good samples at the largest digital number and at 0.
fn end_shares(stack: &FrameStack, good: &GoodPixels, top_dn: u16) -> (f64, f64) {
    let (mut top, mut zero, mut count) = (0_usize, 0_usize, 0_usize);
    for frame in &stack.frames {
        for (dn, _) in frame.iter().zip(&good.is_good).filter(|(_, good)| **good) {
            top += usize::from(*dn >= top_dn);
            zero += usize::from(*dn == 0);
            count += 1;
        }
    }
    (top as f64 / count as f64, zero as f64 / count as f64)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn good(columns: usize, rows: usize) -> GoodPixels {
        GoodPixels { columns, rows, is_good: vec![true; columns * rows] }
    }

    /// Numbers of a fixed sequence that look random, of mean 0 and variance 1.
    fn noise(count: usize, seed: u64) -> Vec<f64> {
        let mut state = seed;
        let mut uniform = || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 11) as f64 / (1_u64 << 53) as f64
        };
        (0..count).map(|_| (0..12).map(|_| uniform()).sum::<f64>() - 6.0).collect()
    }

    #[test]
    fn noise_of_pixels_rows_and_columns_is_separated() {
        let (columns, rows, frames) = (120, 100, 6);
        let stack = FrameStack {
            name: "bias".to_owned(),
            time_s: 0.0,
            light: 0.0,
            names: vec![],
            frames: (0..frames)
                .map(|frame| {
                    let pixels = noise(columns * rows, 3 + frame);
                    let (row, column) = (noise(rows, 100 + frame), noise(columns, 200 + frame));
                    // A fixed pattern of 300 DN must not matter.
                    let value = |i: usize| {
                        let fixed = 1000.0 + (i % 7) as f64 * 100.0;
                        fixed + 10.0 * pixels[i] + 4.0 * row[i / columns] + 3.0 * column[i % columns]
                    };
                    (0..columns * rows).map(|i| value(i).round() as u16).collect()
                })
                .collect(),
        };
        let moments =
            stack_moments(&stack, &pixel_maps(&stack), &good(columns, rows), FrameChange::Offset, u16::MAX);
        let within = |[value, sigma]: Variance, expected: f64| {
            assert!((value - expected).abs() < 4.0 * sigma, "{value} ± {sigma}, expected {expected}");
            assert!(sigma < 0.15 * expected, "{sigma}");
        };
        within(moments.pixel, 100.0 + 1.0 / 12.0);
        within(moments.row, 16.0);
        within(moments.column, 9.0);
    }

    #[test]
    fn a_lamp_that_changes_between_frames_adds_no_noise() {
        let (columns, rows) = (100, 100);
        let response = noise(columns * rows, 9);
        let frame = |number: u64, light: f64| {
            let noise = noise(columns * rows, 20 + number);
            (0..columns * rows)
                .map(|i| (100.0 + light * (1.0 + 0.05 * response[i]) + 20.0 * noise[i]).round() as u16)
                .collect()
        };
        let frames = vec![frame(0, 10_000.0), frame(1, 10_500.0)];
        let stack = FrameStack { name: "flat".to_owned(), time_s: 1.0, light: 1.0, names: vec![], frames };
        let maps = pixel_maps(&stack);
        let moments = |change| stack_moments(&stack, &maps, &good(columns, rows), change, u16::MAX).pixel;
        let [value, sigma] = moments(FrameChange::Factor(100.0));
        assert!((value - 400.0).abs() < 4.0 * sigma, "{value} ± {sigma}");
        // The difference of the offsets alone leaves 0.5 (0.05 · 500)² = 312.
        assert!(moments(FrameChange::Offset)[0] > 600.0);
    }
}
