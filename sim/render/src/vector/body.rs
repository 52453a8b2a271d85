//! Parts that touch at a corner: in a pixel where they meet, the background does not show through between
//! them.
//!
//! If two parts that each cover half a pixel were composited independently, a quarter of the background would
//! remain visible. For parts whose corners touch, the coverages are therefore treated as disjoint as long as
//! they fit into the pixel; beyond that, the later part covers the earlier: Porter and Duff's *over* for
//! disjoint coverage (SIGGRAPH 1984, 4.1; OpenGL's `DISJOINT_NV`).

use std::ops::Range;

/// Image behind the body being composited, and the fraction of every pixel that the body covers.
#[derive(Debug, Clone, Default)]
pub(super) struct Body {
    columns: usize,
    behind: Vec<f32>,
    covered: Vec<f32>,
    /// Columns of each row for which `behind` and `covered` hold values; the body does not cover the
    /// remainder of the row.
    kept: Vec<Range<usize>>,
}

impl Body {
    /// Begins a body in front of an image with the given number of columns and pixels.
    pub(super) fn begin(&mut self, columns: usize, pixels: usize) {
        self.columns = columns;
        self.behind.resize(pixels, 0.0);
        self.covered.resize(pixels, 0.0);
        self.kept.clear();
        self.kept.resize(pixels / columns, 0..0);
    }

    /// Saves the image in these columns of a row before the body covers them, unless already saved.
    fn keep(&mut self, image: &[f32], row: usize, columns: Range<usize>) {
        let kept = &mut self.kept[row];
        let is_new = kept.start == kept.end;
        let new = if is_new {
            [columns.clone(), 0..0]
        } else {
            // The gap between two runs is saved as well.
            [columns.start.min(kept.start)..kept.start, kept.end..columns.end.max(kept.end)]
        };
        *kept = if is_new { columns } else { columns.start.min(kept.start)..columns.end.max(kept.end) };
        for Range { start, end } in new {
            let pixels = row * self.columns + start..row * self.columns + end;
            self.behind[pixels.clone()].copy_from_slice(&image[pixels.clone()]);
            self.covered[pixels].fill(0.0);
        }
    }

    /// Adds a further part to the body, on the pixels of a row from `column` on, each as (coverage,
    /// radiance).
    pub(super) fn join(
        &mut self,
        image: &mut [f32],
        row: usize,
        column: usize,
        part: impl ExactSizeIterator<Item = [f32; 2]>,
    ) {
        self.keep(image, row, column..column + part.len());
        let start = row * self.columns + column;
        let end = start + part.len();
        let behind = &self.behind[start..end];
        let pixels = image[start..end].iter_mut().zip(&mut self.covered[start..end]).zip(behind);
        for (((pixel, body), behind), [covered, light]) in pixels.zip(part) {
            let covered = covered.clamp(0.0, 1.0);
            let shows = if *body > 0.0 { body.min(1.0 - covered) / *body } else { 0.0 };
            let of_body = *pixel - behind * (1.0 - *body);
            *body = (*body + covered).min(1.0);
            *pixel = (behind * (1.0 - *body) + of_body * shows + light).max(0.0);
        }
    }
}
