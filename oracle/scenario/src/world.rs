//! The worlds that scenarios are about.

use std::fmt;
use std::str::FromStr;

use files::toml_file;

/// What a scenario is about: the key `world` of its file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum World {
    /// Star fields with a distant spacecraft; the world of a file without the key.
    FarRange,
    /// The approach to a docking target.
    Docking,
}

impl World {
    /// Both.
    pub const ALL: [Self; 2] = [Self::FarRange, Self::Docking];

    /// The word used in files and on the command line; also the name of the world's built-in pipeline.
    pub fn code(self) -> &'static str {
        match self {
            Self::FarRange => "far_range",
            Self::Docking => "docking",
        }
    }
}

impl fmt::Display for World {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.code())
    }
}

impl FromStr for World {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        Self::ALL.into_iter().find(|world| world.code() == text).ok_or_else(|| {
            let hint = toml_file::nearest(text, Self::ALL.map(Self::code))
                .map_or(String::new(), |name| format!("; did you mean `{name}`?"));
            format!("there is no world `{text}`, expected `far_range` or `docking`{hint}")
        })
    }
}
