//! Check that a mesh is closed, wound consistently, and not inside out.
//!
//! Corners at the same position are one vertex. Each edge must be used as often in one direction as in the
//! other: on a closed surface with consistent winding, two triangles share an edge and run along it in
//! opposite directions. The volume inside each shell, a sixth of the sum of a · (b × c), must be positive.

use std::collections::BTreeMap;

use nalgebra::Vector3;

use super::{MeshFault, shown};

/// Vertex numbers of both ends of an edge, the lower first.
type Edge = [usize; 2];

/// Triangles at an edge, by the direction in which they run along it: from the lower to the higher vertex
/// number, and back.
#[derive(Debug, Clone, Default)]
struct EdgeUse {
    along: Vec<usize>,
    back: Vec<usize>,
}

/// Checks the surface of a mesh.
///
/// # Errors
/// A [`MeshFault`] with the position of the first fault, units of the file.
pub(super) fn check(triangles: &[[Vector3<f64>; 3]]) -> Result<(), MeshFault> {
    let vertices = vertex_numbers(triangles);
    let mut edges: BTreeMap<Edge, EdgeUse> = BTreeMap::new();
    let mut areal = 0;
    for (index, [a, b, c]) in vertices.iter().enumerate() {
        // A triangle with two corners at one position has no area, and its other edges cancel.
        if a == b || b == c || c == a {
            continue;
        }
        areal += 1;
        for [from, to] in [[*a, *b], [*b, *c], [*c, *a]] {
            let used = edges.entry([from.min(to), from.max(to)]).or_default();
            if from < to { used.along.push(index) } else { used.back.push(index) }
        }
    }
    if areal == 0 {
        return Err(MeshFault::new("whose triangles all have no area", "triangles with three corners"));
    }
    check_edges(triangles, &edges)?;
    check_shells(triangles, &edges)
}

/// Returns the vertex number of each corner. Corners at the same position, bit for bit, have the same number.
fn vertex_numbers(triangles: &[[Vector3<f64>; 3]]) -> Vec<[usize; 3]> {
    let mut numbers = BTreeMap::new();
    let mut number = |corner: &Vector3<f64>| {
        // Adding zero turns −0 into 0.
        let bits = [corner.x, corner.y, corner.z].map(|value| (value + 0.0).to_bits());
        let next = numbers.len();
        *numbers.entry(bits).or_insert(next)
    };
    triangles.iter().map(|[a, b, c]| [number(a), number(b), number(c)]).collect()
}

fn check_edges(triangles: &[[Vector3<f64>; 3]], edges: &BTreeMap<Edge, EdgeUse>) -> Result<(), MeshFault> {
    let unbalanced: Vec<&EdgeUse> =
        edges.values().filter(|used| used.along.len() != used.back.len()).collect();
    let Some(first) = unbalanced.iter().min_by_key(|used| used.along.iter().chain(&used.back).min()) else {
        return Ok(());
    };
    let index = first.along.iter().chain(&first.back).min().copied().unwrap_or_default();
    let at = triangles.get(index).map_or_else(String::new, |[a, b, c]| {
        format!("the triangle {}, {}, {}", shown(a), shown(b), shown(c))
    });
    let count = unbalanced.len();
    let is_open = |used: &&EdgeUse| used.along.len() + used.back.len() == 1;
    Err(if unbalanced.iter().any(is_open) {
        MeshFault::new(format!("with {count} open edges, the first at {at}"), "a closed surface")
    } else {
        let fault = format!("with inconsistent winding at {count} edges, the first at {at}");
        MeshFault::new(fault, "triangles counter-clockwise as seen from outside")
    })
}

/// Checks the volume of each shell. A shell is a set of triangles that are connected by edges of exactly two
/// triangles: shells may touch along an edge.
fn check_shells(triangles: &[[Vector3<f64>; 3]], edges: &BTreeMap<Edge, EdgeUse>) -> Result<(), MeshFault> {
    let mut shell: Vec<usize> = (0..triangles.len()).collect();
    for used in edges.values() {
        if let ([one], [other]) = (&used.along[..], &used.back[..]) {
            let (one, other) = (root(&mut shell, *one), root(&mut shell, *other));
            if let Some(above) = shell.get_mut(one.max(other)) {
                *above = one.min(other);
            }
        }
    }
    let mut volumes: BTreeMap<usize, f64> = BTreeMap::new();
    for (index, [a, b, c]) in triangles.iter().enumerate() {
        // From the first corner of the shell, so that a distant shell loses no digits.
        let first = root(&mut shell, index);
        let origin = triangles.get(first).map_or_else(Vector3::zeros, |[corner, ..]| *corner);
        *volumes.entry(first).or_default() += (a - origin).dot(&(b - origin).cross(&(c - origin))) / 6.0;
    }
    for (first, volume) in volumes {
        if let (true, Some([corner, ..])) = (volume < 0.0, triangles.get(first)) {
            let at = shown(corner);
            let fault =
                format!("with a shell that is inside out at {at}: its volume is {volume:e} cubic units");
            return Err(MeshFault::new(
                fault,
                "triangles counter-clockwise as seen from outside, and no cavities",
            ));
        }
    }
    Ok(())
}

/// Returns the lowest triangle of the shell that a triangle belongs to, and shortens the way to it.
fn root(shell: &mut [usize], mut index: usize) -> usize {
    while let Some(above) = shell.get(index).copied().filter(|above| *above != index) {
        if let (Some(beyond), Some(entry)) = (shell.get(above).copied(), shell.get_mut(index)) {
            *entry = beyond;
        }
        index = above;
    }
    index
}
