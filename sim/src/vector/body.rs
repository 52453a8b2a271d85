//! Parts that touch at a corner: where they meet in a pixel, nothing between them shows what lies behind.
//!
//! Laid one over the other, two parts that cover a pixel by halves would let a quarter of it through. Of parts whose
//! corners touch the coverages are taken as disjoint as far as there is room, and what is behind the later one gives way:
//! Porter and Duff's *over* for disjoint coverage (SIGGRAPH 1984, 4.1; OpenGL's `DISJOINT_NV`).

use std::ops::Range;

/// What lies behind the body that is being laid, and how much of every pixel the body covers.
#[derive(Debug, Clone, Default)]
pub(super) struct Body {
    columns: usize,
    behind: Vec<f32>,
    covered: Vec<f32>,
    /// Of each row, the columns that the two hold; the rest of a row is not covered.
    kept: Vec<Range<usize>>,
}

impl Body {
    /// Begins a body before an image of so many pixels.
    pub(super) fn begin(&mut self, columns: usize, pixels: usize) {
        self.columns = columns;
        self.behind.resize(pixels, 0.0);
        self.covered.resize(pixels, 0.0);
        self.kept.clear();
        self.kept.resize(pixels / columns, 0..0);
    }

    /// Keeps what is in the image before the body covers these columns of a row, as far as that is not done.
    fn keep(&mut self, image: &[f32], row: usize, columns: Range<usize>) {
        let kept = &mut self.kept[row];
        let is_new = kept.start == kept.end;
        let new = if is_new {
            [columns.clone(), 0..0]
        } else {
            // What lies between two runs is kept with them.
            [columns.start.min(kept.start)..kept.start, kept.end..columns.end.max(kept.end)]
        };
        *kept = if is_new { columns } else { columns.start.min(kept.start)..columns.end.max(kept.end) };
        for Range { start, end } in new {
            let pixels = row * self.columns + start..row * self.columns + end;
            self.behind[pixels.clone()].copy_from_slice(&image[pixels.clone()]);
            self.covered[pixels].fill(0.0);
        }
    }

    /// Lays a further part over the body, on a row's pixels from a column on, each (coverage, light).
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
