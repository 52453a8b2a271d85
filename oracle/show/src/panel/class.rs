//! Kinds of marks, with their colours, legend symbols and names in files.

use crate::canvas::colour::{BLUE, GREEN, ORANGE, RED, Rgb, SLATE, VIOLET, WHITE, YELLOW};

/// Kind of object that a mark represents.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Class {
    /// True position of the target.
    Target,
    /// True position of a star.
    Star,
    /// True position of a planet or of the Moon.
    Planet,
    /// A hot pixel.
    HotPixel,
    /// A cosmic-ray hit.
    CosmicRay,
    /// Measurement of the pipeline.
    Answer,
    /// Region that the camera transmitted.
    Region,
    /// True centre of the docking target's cross or disk.
    TrueCentre,
    /// Detected cross of the docking target.
    Cross,
    /// Detected circle of the docking target's marks.
    Circle,
    /// Detected outline of the station.
    Station,
    /// Detected outline of the docking unit.
    DockingUnit,
    /// Mark of the docking target that was used to measure the pose.
    UsedMark,
    /// Mark of the docking target that was rejected.
    RejectedMark,
}

/// Symbol of a class in the legend.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Symbol {
    Circle,
    Cross,
    Saltire,
    Square,
}

impl Class {
    /// All classes, in the order of the legend.
    pub const ALL: [Self; 14] = [
        Self::Target,
        Self::Star,
        Self::Planet,
        Self::HotPixel,
        Self::CosmicRay,
        Self::TrueCentre,
        Self::Answer,
        Self::Cross,
        Self::Circle,
        Self::UsedMark,
        Self::RejectedMark,
        Self::Station,
        Self::DockingUnit,
        Self::Region,
    ];

    /// Returns the word used in files.
    pub fn code(self) -> &'static str {
        match self {
            Self::Target => "target",
            Self::Star => "star",
            Self::Planet => "planet",
            Self::HotPixel => "hot_pixel",
            Self::CosmicRay => "cosmic_ray",
            Self::Answer => "answer",
            Self::Region => "region",
            Self::TrueCentre => "true_centre",
            Self::Cross => "cross",
            Self::Circle => "circle",
            Self::Station => "station",
            Self::DockingUnit => "docking_unit",
            Self::UsedMark => "used_mark",
            Self::RejectedMark => "rejected_mark",
        }
    }

    /// Returns the words of the legend.
    pub(crate) fn words(self) -> &'static str {
        match self {
            Self::Target => "target, truth",
            Self::Star => "star, truth",
            Self::Planet => "planet or Moon, truth",
            Self::HotPixel => "hot pixel, truth",
            Self::CosmicRay => "cosmic-ray hit, truth",
            Self::Answer => "measurement",
            Self::Region => "transmitted region",
            Self::TrueCentre => "cross and disk, truth",
            Self::Cross => "cross, recognised",
            Self::Circle => "circle of marks",
            Self::Station => "station outline",
            Self::DockingUnit => "docking unit",
            Self::UsedMark => "mark, used",
            Self::RejectedMark => "mark, rejected",
        }
    }

    pub(crate) fn colour(self) -> Rgb {
        match self {
            Self::Target | Self::Cross => ORANGE,
            Self::Star | Self::Circle | Self::UsedMark => BLUE,
            Self::Planet | Self::DockingUnit => VIOLET,
            Self::HotPixel | Self::RejectedMark => RED,
            Self::CosmicRay => YELLOW,
            Self::Answer | Self::Station => GREEN,
            Self::Region => SLATE,
            Self::TrueCentre => WHITE,
        }
    }

    pub(crate) fn symbol(self) -> Symbol {
        match self {
            Self::Target
            | Self::Star
            | Self::Planet
            | Self::HotPixel
            | Self::CosmicRay
            | Self::Circle
            | Self::Station
            | Self::DockingUnit => Symbol::Circle,
            Self::Answer | Self::Cross => Symbol::Cross,
            Self::TrueCentre => Symbol::Saltire,
            Self::Region | Self::UsedMark | Self::RejectedMark => Symbol::Square,
        }
    }
}
