//! Picture of a frame with its description.

use std::collections::BTreeMap;

use contract::Window;
use serde_json::{Value, json};
use show::{Class, Panel, PanelLayout};

/// A panel, and its description in the output of `--json`.
pub(super) struct AnnotatedFrame {
    pub(super) panel: Panel,
    pub(super) frame: u64,
    pub(super) time: String,
    pub(super) pixels: PixelSource,
    pub(super) verdict: Option<String>,
    pub(super) cause: Option<String>,
}

/// Source of the pixels of a frame.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum PixelSource {
    /// The image in the directory.
    Stored,
    /// Drawn again from `run.toml`.
    DrawnAgain,
}

impl PixelSource {
    pub(super) fn code(self) -> &'static str {
        match self {
            Self::Stored => "stored",
            Self::DrawnAgain => "drawn_again",
        }
    }

    pub(super) fn words(self) -> &'static str {
        match self {
            Self::Stored => "stored image",
            Self::DrawnAgain => "rendered again from run.toml",
        }
    }
}

impl AnnotatedFrame {
    pub(super) fn document(&self, place: &PanelLayout) -> Value {
        let mut drawn: BTreeMap<&str, usize> = BTreeMap::new();
        for mark in self.panel.marks.iter().filter(|mark| place.frame.shows(mark.at)) {
            *drawn.entry(mark.class.code()).or_default() += 1;
        }
        let meets = |region: &&Window| {
            let view = &self.panel.view;
            let apart = |a: usize, long: usize, b: usize, long_b: usize| a + long <= b || b + long_b <= a;
            !(apart(region.x, region.columns, view.x, view.columns)
                || apart(region.y, region.rows, view.y, view.rows))
        };
        if let Some(regions) = &self.panel.regions {
            drawn.insert(Class::Region.code(), regions.iter().filter(meets).count());
        }
        json!({
            "frame": self.frame,
            "time": self.time,
            "pixels": self.pixels.code(),
            "stretch": self.panel.stretch.code(),
            "verdict": self.verdict,
            "cause": self.cause,
            "panel": place.frame,
            "close_up": place.close_up,
            "drawn": drawn,
        })
    }
}

/// Returns a code from a file in readable form: `cut by roi`.
pub(super) fn display_name(word: &str) -> String {
    word.replace('_', " ")
}
