//! The light that a part of one plane was laid with, kept for its shadows.
//!
//! All facets of a plane lose the same share of their light in the Sun's shadow, so that their outlines need not be drawn
//! a second time to know how much light there is to lose in a pixel.

use super::coverage::{Run, Window};

/// Light on the rows of a window.
#[derive(Debug, Clone, Default)]
pub(super) struct RadianceCache {
    window: Option<Window>,
    columns: usize,
    /// Whole rows.
    light: Vec<f32>,
}

impl RadianceCache {
    /// Begins anew, for the rows of a window of an image so many columns wide; keeps nothing without one.
    pub(super) fn open(&mut self, window: Option<Window>, columns: usize) {
        self.window = window;
        self.columns = columns;
        self.light.clear();
        if let Some(window) = window {
            self.light.resize((window.bottom - window.top) * columns, 0.0);
        }
    }

    /// The window that it was opened for.
    pub(super) fn window(&self) -> Option<Window> {
        self.window
    }

    /// Keeps the second sums of a run.
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

    /// What was kept of a row of the window, from a column on.
    pub(super) fn row(&self, row: usize, column: usize) -> &[f32] {
        let top = self.window.map_or(0, |window| window.top);
        &self.light[(row - top) * self.columns..][column..self.columns]
    }
}
