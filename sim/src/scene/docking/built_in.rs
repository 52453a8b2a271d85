//! The targets of the folder `scenarios/targets/`, embedded.

use super::TargetFile;

/// Name and text of each.
const BUILT_IN: [(&str, &str); 1] =
    [("progress", include_str!("../../../../scenarios/targets/progress.toml"))];

impl TargetFile {
    /// The names of the built-in targets.
    pub fn built_in_names() -> impl Iterator<Item = &'static str> {
        BUILT_IN.iter().map(|(name, _)| *name)
    }

    /// A built-in target by its name; `None` when there is none of that name.
    pub fn built_in(name: &str) -> Option<Self> {
        let text = Self::built_in_text(name)?;
        // That each can be read is tested.
        toml::from_str(text).ok()
    }

    /// The text of a built-in target's file.
    pub fn built_in_text(name: &str) -> Option<&'static str> {
        BUILT_IN.iter().find(|(built_in, _)| *built_in == name).map(|(_, text)| *text)
    }
}
