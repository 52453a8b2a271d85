//! Kinds of marks in the pictures.

use show::{Class, Colour, Symbol};

/// True position of a star.
pub(super) const STAR: Class =
    Class { code: "star", words: "star, truth", colour: Colour::Blue, symbol: Symbol::Circle, rank: 10 };

/// True position of a planet or of the Moon.
pub(super) const PLANET: Class = Class {
    code: "planet",
    words: "planet or Moon, truth",
    colour: Colour::Violet,
    symbol: Symbol::Circle,
    rank: 20,
};

/// A hot pixel.
pub(super) const HOT_PIXEL: Class = Class {
    code: "hot_pixel",
    words: "hot pixel, truth",
    colour: Colour::Red,
    symbol: Symbol::Circle,
    rank: 30,
};

/// A cosmic-ray hit.
pub(super) const COSMIC_RAY: Class = Class {
    code: "cosmic_ray",
    words: "cosmic-ray hit, truth",
    colour: Colour::Yellow,
    symbol: Symbol::Circle,
    rank: 40,
};
