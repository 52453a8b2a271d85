//! Picture of a frame with its description.

use std::collections::BTreeMap;

use contract::Window;
use serde_json::{Value, json};
use show::{Class, Panel, PanelLayout};

/// A panel, and its description in the output of `--json`.
pub struct AnnotatedFrame {
    /// Panel of the picture.
    pub panel: Panel,
    /// Number of the frame or field.
    pub frame: u64,
    /// Time, as text.
    pub time: String,
    /// Source of its pixels.
    pub pixels: PixelSource,
    /// Verdict; `None` if it was not scored.
    pub verdict: Option<String>,
    /// Cause of the verdict.
    pub cause: Option<String>,
}

/// Source of the pixels of a frame.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum PixelSource {
    /// The image in the directory.
    Stored,
    /// Drawn again from `run.toml`.
    DrawnAgain,
}

impl PixelSource {
    /// Returns the name in JSON.
    pub fn code(self) -> &'static str {
        match self {
            Self::Stored => "stored",
            Self::DrawnAgain => "drawn_again",
        }
    }

    /// Returns words for the reader.
    pub fn words(self) -> &'static str {
        match self {
            Self::Stored => "stored image",
            Self::DrawnAgain => "rendered again from run.toml",
        }
    }
}

impl AnnotatedFrame {
    /// Returns the description of the panel at its place in the picture.
    pub fn document(&self, place: &PanelLayout) -> Value {
        let mut drawn: BTreeMap<&str, usize> = BTreeMap::new();
        for mark in self.panel.marks.iter().filter(|mark| place.frame.shows(mark.at)) {
            *drawn.entry(mark.class.code).or_default() += 1;
        }
        let meets = |region: &&Window| {
            let view = &self.panel.view;
            let apart = |a: usize, long: usize, b: usize, long_b: usize| a + long <= b || b + long_b <= a;
            !(apart(region.x, region.columns, view.x, view.columns)
                || apart(region.y, region.rows, view.y, view.rows))
        };
        if let Some(regions) = &self.panel.regions {
            drawn.insert(Class::REGION.code, regions.iter().filter(meets).count());
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
pub fn display_name(word: &str) -> String {
    word.replace('_', " ")
}

/// Formats a time such as `2012-04-26T13:02:07.250000000Z` to the millisecond, without letters.
pub fn time_words(utc: &str) -> String {
    let (date, time) = utc.trim_end_matches('Z').split_once('T').unwrap_or((utc, ""));
    format!("{date} {}", time.get(..12).unwrap_or(time))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_time_is_shown_to_the_millisecond() {
        assert_eq!(time_words("2012-04-26T13:02:07.250000000Z"), "2012-04-26 13:02:07.250");
        assert_eq!(time_words("odd"), "odd ");
    }
}
