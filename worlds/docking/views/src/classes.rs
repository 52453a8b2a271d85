//! Kinds of marks in the pictures.

use show::{Class, Colour, Symbol};

/// True centre of the target's cross or disk.
pub(super) const TRUE_CENTRE: Class = Class {
    code: "true_centre",
    words: "cross and disk, truth",
    colour: Colour::White,
    symbol: Symbol::Saltire,
    rank: 50,
};

/// Detected cross of the target.
pub(super) const CROSS: Class = Class {
    code: "cross",
    words: "cross, recognised",
    colour: Colour::Orange,
    symbol: Symbol::Cross,
    rank: 110,
};

/// Detected circle of the target's marks.
pub(super) const CIRCLE: Class = Class {
    code: "circle",
    words: "circle of marks",
    colour: Colour::Blue,
    symbol: Symbol::Circle,
    rank: 120,
};

/// Mark of the target that was used to measure the pose.
pub(super) const USED_MARK: Class =
    Class { code: "used_mark", words: "mark, used", colour: Colour::Blue, symbol: Symbol::Square, rank: 130 };

/// Mark of the target that was rejected.
pub(super) const REJECTED_MARK: Class = Class {
    code: "rejected_mark",
    words: "mark, rejected",
    colour: Colour::Red,
    symbol: Symbol::Square,
    rank: 140,
};

/// Detected outline of the station.
pub(super) const STATION: Class = Class {
    code: "station",
    words: "station outline",
    colour: Colour::Green,
    symbol: Symbol::Circle,
    rank: 150,
};

/// Detected outline of the docking unit.
pub(super) const DOCKING_UNIT: Class = Class {
    code: "docking_unit",
    words: "docking unit",
    colour: Colour::Violet,
    symbol: Symbol::Circle,
    rank: 160,
};
