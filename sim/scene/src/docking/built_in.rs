//! Built-in targets: the files of the directory `scenarios/targets/`, embedded in the program.

use super::TargetFile;

/// Name and file text of each built-in target.
const BUILT_IN: [(&str, &str); 3] = [
    ("apollo", include_str!("../../../../scenarios/targets/apollo.toml")),
    ("idss", include_str!("../../../../scenarios/targets/idss.toml")),
    ("progress", include_str!("../../../../scenarios/targets/progress.toml")),
];

impl TargetFile {
    /// Returns the names of the built-in targets.
    pub fn built_in_names() -> impl Iterator<Item = &'static str> {
        BUILT_IN.iter().map(|(name, _)| *name)
    }

    /// Returns the built-in target of this name; `None` if the name is not built in.
    pub fn built_in(name: &str) -> Option<Self> {
        let text = Self::built_in_text(name)?;
        // A test confirms that each built-in file can be read.
        toml::from_str(text).ok()
    }

    /// Returns the text of a built-in target's file.
    pub fn built_in_text(name: &str) -> Option<&'static str> {
        BUILT_IN.iter().find(|(built_in, _)| *built_in == name).map(|(_, text)| *text)
    }
}
