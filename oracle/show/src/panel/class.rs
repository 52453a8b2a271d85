//! Kinds of marks, with their colours, legend symbols and names in files. A world declares its own; those of
//! every world are here.

use crate::canvas::colour::{self, Rgb};

/// Kind of object that a mark represents.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Class {
    /// Word used in files.
    pub code: &'static str,
    /// Words of the legend.
    pub words: &'static str,
    /// Colour of the mark and its label.
    pub colour: Colour,
    /// Symbol in the legend.
    pub symbol: Symbol,
    /// Place in the legend: lower first.
    pub rank: u8,
}

/// Colour of a class.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Colour {
    /// Orange.
    Orange,
    /// Blue.
    Blue,
    /// Violet.
    Violet,
    /// Red.
    Red,
    /// Yellow.
    Yellow,
    /// Green.
    Green,
    /// Grey-blue.
    Slate,
    /// White.
    White,
}

/// Symbol of a class in the legend.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Symbol {
    /// A circle.
    Circle,
    /// An upright cross.
    Cross,
    /// A diagonal cross.
    Saltire,
    /// A square.
    Square,
    /// A thin square.
    ThinSquare,
}

impl Class {
    /// True position of the target.
    pub const TARGET: Self = Self {
        code: "target",
        words: "target, truth",
        colour: Colour::Green,
        symbol: Symbol::Circle,
        rank: 0,
    };
    /// Measurement of the pipeline.
    pub const ANSWER: Self = Self {
        code: "answer",
        words: "measurement",
        colour: Colour::Orange,
        symbol: Symbol::Cross,
        rank: 100,
    };
    /// Region that the camera transmitted.
    pub const REGION: Self = Self {
        code: "region",
        words: "transmitted region",
        colour: Colour::Slate,
        symbol: Symbol::ThinSquare,
        rank: 200,
    };

    pub(crate) fn rgb(self) -> Rgb {
        match self.colour {
            Colour::Orange => colour::ORANGE,
            Colour::Blue => colour::BLUE,
            Colour::Violet => colour::VIOLET,
            Colour::Red => colour::RED,
            Colour::Yellow => colour::YELLOW,
            Colour::Green => colour::GREEN,
            Colour::Slate => colour::SLATE,
            Colour::White => colour::WHITE,
        }
    }
}
