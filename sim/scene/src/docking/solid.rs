//! Flat facets, and bodies made of them.

use nalgebra::Vector3;

/// A flat, Lambertian, one-sided polygon, possibly with holes.
#[derive(Debug, Clone, PartialEq)]
pub struct Facet {
    /// Outer boundary, m, target frame, counter-clockwise seen from outside (from where `normal` points to).
    pub outer: Vec<Vector3<f64>>,
    /// Holes, clockwise seen from outside; disjoint, inside `outer`.
    pub holes: Vec<Vec<Vector3<f64>>>,
    /// Outward unit normal.
    pub normal: Vector3<f64>,
    /// Lambertian reflectance, 0 to 1.
    pub reflectance: f64,
}

/// Assembly that a part of the scene belongs to: an object of its own in labels.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Assembly {
    /// Docking target: plate with marks, and stand-off cross.
    Target,
    /// Docking unit.
    DockingUnit,
    /// Everything else: the station's end with its fittings, and the structure behind it.
    Station,
}

/// Body or surface: facets that do not cover each other, from any viewpoint in front of them.
#[derive(Debug, Clone, PartialEq)]
pub struct Part {
    /// Name, for messages and for Mitsuba's shapes.
    pub name: String,
    /// Assembly that the part belongs to.
    pub assembly: Assembly,
    /// The facets; those that face away from a camera are invisible to it.
    pub facets: Vec<Facet>,
    /// True if the part casts shadows on parts behind it; every facet does so, also those that face away.
    pub casts_shadow: bool,
    /// True if cameras see the part; an invisible part may still cast a shadow.
    pub visible: bool,
}

/// Scene: parts from back to front as seen by any camera in front of the target (y3 > 0). A part never lies
/// in front of a later part.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct DockingScene {
    /// The parts, back to front.
    pub parts: Vec<Part>,
}
