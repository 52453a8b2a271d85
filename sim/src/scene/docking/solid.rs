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

/// A body or a surface: facets that do not cover each other, whoever looks at them from the front.
#[derive(Debug, Clone, PartialEq)]
pub struct Part {
    /// Name, for messages and for Mitsuba's shapes.
    pub name: String,
    /// The facets. Those that face away from a camera are not seen.
    pub facets: Vec<Facet>,
    /// Whether it casts shadows on parts behind it (all of it, facing away or not).
    pub casts_shadow: bool,
    /// Whether a camera sees it; an unseen part may still cast a shadow.
    pub visible: bool,
}

/// The scene: parts from back to front as seen by any camera in front of the target (y3 > 0). A part never lies in front
/// of one that comes after it.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct DockingScene {
    /// The parts, back to front.
    pub parts: Vec<Part>,
}
