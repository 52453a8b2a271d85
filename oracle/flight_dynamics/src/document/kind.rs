//! Kinds of messages, and their notations.

/// Notation of a message.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Notation {
    /// Lines `KEYWORD = value`, and lines of data.
    Kvn,
    /// XML of the navigation data messages (CCSDS 505.0-B).
    Xml,
}

/// Kind of a message.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Kind {
    Oem,
    Aem,
    Opm,
    Tdm,
}

impl Kind {
    /// Returns the name in capitals, as in `CCSDS_OEM_VERS`.
    pub(crate) fn name(self) -> &'static str {
        match self {
            Self::Oem => "OEM",
            Self::Aem => "AEM",
            Self::Opm => "OPM",
            Self::Tdm => "TDM",
        }
    }

    /// Returns the name of the root element.
    pub(crate) fn element(self) -> &'static str {
        match self {
            Self::Oem => "oem",
            Self::Aem => "aem",
            Self::Opm => "opm",
            Self::Tdm => "tdm",
        }
    }

    /// Returns the keyword of the version.
    pub(crate) fn version_keyword(self) -> &'static str {
        match self {
            Self::Oem => "CCSDS_OEM_VERS",
            Self::Aem => "CCSDS_AEM_VERS",
            Self::Opm => "CCSDS_OPM_VERS",
            Self::Tdm => "CCSDS_TDM_VERS",
        }
    }

    /// Returns the versions that are read, oldest first.
    pub(crate) fn versions(self) -> &'static [&'static str] {
        match self {
            Self::Oem | Self::Opm => &["1.0", "2.0", "3.0"],
            Self::Aem | Self::Tdm => &["1.0", "2.0"],
        }
    }
}
