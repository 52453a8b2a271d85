//! Kinds of marks: their colours, their symbols in the legend, their names in files.

use crate::canvas::colour::{BLUE, GREEN, ORANGE, RED, Rgb, SLATE, VIOLET, WHITE, YELLOW};

/// What a mark stands for.
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
    /// The pipeline's answer.
    Answer,
    /// A region that the camera transmitted.
    Region,
    /// True centre of the docking target's cross or disk.
    TrueCentre,
    /// The docking target's cross, recognised.
    Cross,
    /// The circle of the docking target's marks, recognised.
    Circle,
    /// The outline of the station, recognised.
    Station,
    /// The outline of the docking unit, recognised.
    DockingUnit,
    /// A mark of the docking target that the pose was measured with.
    UsedMark,
    /// A mark of the docking target that was rejected.
    RejectedMark,
}

/// How a class is drawn in the legend.
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

    /// The word used in files.
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

    /// The words of the legend.
    pub(crate) fn words(self) -> &'static str {
        match self {
            Self::Target => "target, truth",
            Self::Star => "star, truth",
            Self::Planet => "planet or Moon, truth",
            Self::HotPixel => "hot pixel, truth",
            Self::CosmicRay => "cosmic-ray hit, truth",
            Self::Answer => "answer of the pipeline",
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
