//! Parts that share an edge: where they meet in a pixel, nothing between them shows what lies behind.
//!
//! Laid one over the other, two parts that cover a pixel by halves would let a quarter of it through. Of parts that share an
//! edge the coverages are taken as disjoint as far as there is room, and what is behind the later one gives way:
//! Porter and Duff's *over* for disjoint coverage (SIGGRAPH 1984, 4.1; OpenGL's `DISJOINT_NV`).

/// What lies behind the body that is being laid, and how much of every pixel the body covers.
#[derive(Debug, Clone, Default)]
pub(super) struct Body {
    behind: Vec<f32>,
    covered: Vec<f32>,
}

impl Body {
    /// Begins a body before an image.
    pub(super) fn begin(&mut self, image: &[f32]) {
        self.behind.clear();
        self.behind.extend_from_slice(image);
        self.covered.clear();
        self.covered.resize(image.len(), 0.0);
    }

    /// Lays a further part over the body, on pixels from `start` on, each (coverage, light).
    pub(super) fn join(
        &mut self,
        image: &mut [f32],
        start: usize,
        part: impl ExactSizeIterator<Item = [f32; 2]>,
    ) {
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
