//! Unshadowed radiance of a part that shows a single plane, kept until its shadows are subtracted.
//!
//! In the Sun's shadow, all facets of a plane lose the same fraction of their radiance. Their outlines
//! therefore need not be drawn a second time to find the radiance that a pixel can lose.

use super::coverage::{Run, Window};

/// Radiance on the rows of a window.
#[derive(Debug, Clone, Default)]
pub(super) struct RadianceCache {
    window: Option<Window>,
    columns: usize,
    /// Values of complete rows of the image.
    light: Vec<f32>,
}

impl RadianceCache {
    /// Starts anew for the rows of a window of an image with `columns` columns; keeps nothing if there is no
    /// window.
    pub(super) fn open(&mut self, window: Option<Window>, columns: usize) {
        self.window = window;
        self.columns = columns;
        self.light.clear();
        if let Some(window) = window {
            self.light.resize((window.bottom - window.top) * columns, 0.0);
        }
    }

    /// Returns the window passed to `open`.
    pub(super) fn window(&self) -> Option<Window> {
        self.window
    }

    /// Stores the second sums of a run.
    pub(super) fn store(&mut self, row: usize, column: usize, run: &Run<'_>) {
        let Some(window) = self.window.filter(|window| (window.top..window.bottom).contains(&row)) else {
            return;
        };
        let kept = &mut self.light[(row - window.top) * self.columns + column..];
        match run {
            Run::Each(sums) => {
                for (kept, [_, light]) in kept.iter_mut().zip(*sums) {
                    *kept = *light;
                }
            }
            Run::Same([_, light], length) => kept[..*length].fill(*light),
        }
    }

    /// Returns the kept values of a row of the window, from `column` on.
    pub(super) fn row(&self, row: usize, column: usize) -> &[f32] {
        let top = self.window.map_or(0, |window| window.top);
        &self.light[(row - top) * self.columns..][column..self.columns]
    }
}
