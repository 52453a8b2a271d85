//! Blurred coverage of marks and cross, in closed form.
//!
//! Between two opposite edges the blurred coverage is F1 + F2 − 1; that of a quadrilateral is the product across its two pairs,
//! exact for a rectangle whose edges' blurs do not correlate. Where they do (oblique corners, oblique edges under unequal
//! blur) each corner gets the first term of the bivariate normal's series in the correlation ρ: + ρ φ φ.

use contract::docking::{StandOffCross, TargetModel};
use nalgebra::Vector3;

use super::edge::{Blur, ByGlobals, Edge, GLOBALS, SIDES, Step};
use super::gaussian::LIMIT;
use super::sampled::Tables;
use crate::docking::geometry::{Seen, View};

/// Coverage at a pixel with its derivatives.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Coverage {
    pub(super) value: f64,
    pub(super) by: ByGlobals,
}

/// The image of a mark at a pose.
#[derive(Debug, Clone)]
pub(super) struct MarkImage {
    edges: [Edge; 4],
    /// Of the edges k and k + 1.
    correlations: [f64; 4],
}

impl MarkImage {
    /// `None` when a corner is behind the camera.
    pub(super) fn new(corners: &[[f64; 2]; 4], view: &View, blur: Blur, tables: &Tables) -> Option<Self> {
        let seen = corners.map(|[y1, y2]| view.see(&Vector3::new(y1, y2, 0.0)));
        let [Some(a), Some(b), Some(c), Some(d)] = seen else { return None };
        let middle = (0.25 * (a.u + b.u + c.u + d.u), 0.25 * (a.v + b.v + c.v + d.v));
        let edges = [(a, b), (b, c), (c, d), (d, a)]
            .map(|(p, q)| Edge::through(&p, &q, middle, blur, &tables.profiles));
        let correlations = [0, 1, 2, 3].map(|k: usize| edges[k].correlation(&edges[(k + 1) % 4], blur));
        Some(Self { edges, correlations })
    }

    pub(super) fn at(&self, tables: &Tables, u: f64, v: f64) -> Coverage {
        let steps = self.steps(tables, u, v);
        let across = [steps[0].inside + steps[2].inside - 1.0, steps[1].inside + steps[3].inside - 1.0];
        let mut coverage = Coverage { value: across[0] * across[1], by: [0.0; GLOBALS] };
        for k in 0..4 {
            coverage.value += self.correlations[k] * steps[k].density * steps[(k + 1) % 4].density;
            self.edges[k].add_derivative(&steps[k], u, v, across[(k + 1) % 2], &mut coverage.by);
        }
        coverage
    }

    fn steps(&self, tables: &Tables, u: f64, v: f64) -> [Step; 4] {
        let mut steps = [Step::default(); 4];
        for (step, edge) in steps.iter_mut().zip(&self.edges) {
            *step = edge.step(tables, u, v);
        }
        steps
    }

    /// The coverage alone.
    pub(super) fn value_at(&self, tables: &Tables, u: f64, v: f64) -> f64 {
        let steps = self.steps(tables, u, v);
        let corners: f64 =
            (0..4).map(|k| self.correlations[k] * steps[k].density * steps[(k + 1) % 4].density).sum();
        (steps[0].inside + steps[2].inside - 1.0) * (steps[1].inside + steps[3].inside - 1.0) + corners
    }

    /// Of the edges.
    pub(super) fn normals(&self) -> impl Iterator<Item = (f64, f64)> {
        self.edges.iter().map(Edge::normal)
    }

    pub(super) fn shift(&self, by: &ByGlobals) -> f64 {
        self.edges.iter().map(|edge| edge.shift(by)).fold(0.0, f64::max)
    }
}

// The edges of the cross: of the vertical bar (V) and of the horizontal one (H), left (−y1), right, bottom (−y2), top.
const VL: usize = 0;
const VR: usize = 1;
const VB: usize = 2;
const VT: usize = 3;
const HL: usize = 4;
const HR: usize = 5;
const HB: usize = 6;
const HT: usize = 7;

/// The side face of each edge: +y1, −y1, +y2, −y2.
const SIDE_OF: [usize; 8] = [1, 0, 3, 2, 1, 0, 3, 2];

/// Pairs of edges that meet at a corner, and the sign of their product in the coverage.
const CORNERS: [(usize, usize, f64); 12] = [
    (VL, VB, 1.0),
    (VL, VT, 1.0),
    (VR, VB, 1.0),
    (VR, VT, 1.0),
    (HL, HB, 1.0),
    (HL, HT, 1.0),
    (HR, HB, 1.0),
    (HR, HT, 1.0),
    (VL, HB, -1.0),
    (VL, HT, -1.0),
    (VR, HB, -1.0),
    (VR, HT, -1.0),
];

/// The image of the cross at a pose: the union of two bars, and the side faces that are seen from off the axis.
///
/// A side face reaches from an edge of the front face to the same edge of the back face. What the two bars' side faces hide of
/// each other, and the slanted ends of side faces, are neglected: both are of second order in the faces' widths.
#[derive(Debug, Clone)]
pub(super) struct CrossImage {
    front: [Edge; 8],
    /// Edges of the back face, where the side face is seen.
    back: [Option<Edge>; 8],
    correlations: [f64; 12],
    sides: [f64; 4],
}

impl CrossImage {
    /// `sides`: brightness of the side faces over the plate, in units of the front face's. `None` when a corner is behind the
    /// camera.
    pub(super) fn new(
        target: &TargetModel,
        view: &View,
        camera_at: &Vector3<f64>,
        blur: Blur,
        sides: [f64; 4],
        tables: &Tables,
    ) -> Option<Self> {
        let front = bars(&target.cross, view, target.cross.height_m, blur, tables)?;
        let (half, length) = (0.5 * target.cross.width_m, target.cross.half_length_m);
        let mut back = [None; 8];
        let beyond = [
            (VL, -camera_at.x - half),
            (VR, camera_at.x - half),
            (VB, -camera_at.y - length),
            (VT, camera_at.y - length),
            (HL, -camera_at.x - length),
            (HR, camera_at.x - length),
            (HB, -camera_at.y - half),
            (HT, camera_at.y - half),
        ];
        if beyond.iter().any(|(_, over)| *over > 0.0) {
            let behind =
                bars(&target.cross, view, target.cross.height_m - target.cross.thickness_m, blur, tables)?;
            for (edge, over) in beyond {
                back[edge] = (over > 0.0).then_some(behind[edge]);
            }
        }
        let correlations = CORNERS.map(|(i, j, sign)| sign * front[i].correlation(&front[j], blur));
        Some(Self { front, back, correlations, sides })
    }

    pub(super) fn at(&self, tables: &Tables, u: f64, v: f64) -> Coverage {
        let mut front = [Step::default(); 8];
        // Most edges are far away: only where two are near is a corner.
        let mut near = 0;
        for (step, edge) in front.iter_mut().zip(&self.front) {
            *step = edge.step(tables, u, v);
            near += usize::from(step.density != 0.0);
        }
        let mut back = front;
        for (step, edge) in back.iter_mut().zip(&self.back) {
            if let Some(edge) = edge {
                *step = edge.step(tables, u, v);
            }
        }
        let slab = |a: usize, b: usize| front[a].inside + front[b].inside - 1.0;
        let (v_across, v_along) = (slab(VL, VR), slab(VB, VT));
        let (h_across, h_along) = (slab(HB, HT), slab(HL, HR));
        // Share of a side face beside each edge, before what bounds it along the edge.
        let strip = |k: usize| back[k].inside - front[k].inside;
        let bright = |k: usize| self.sides[SIDE_OF[k]] * strip(k);
        let (v_sides, v_ends) = (bright(VL) + bright(VR), bright(VB) + bright(VT));
        let (h_sides, h_ends) = (bright(HB) + bright(HT), bright(HL) + bright(HR));
        // A bar's side faces are interrupted by the other bar.
        let (v_open, h_open) = (v_along - h_across, h_along - v_across);

        let mut coverage = Coverage {
            value: v_across * v_along + h_across * h_along - v_across * h_across
                + v_sides * v_open
                + h_sides * h_open
                + v_ends * v_across
                + h_ends * h_across,
            by: [0.0; GLOBALS],
        };
        if near > 1 {
            for ((i, j, _), correlation) in CORNERS.iter().zip(&self.correlations) {
                coverage.value += correlation * front[*i].density * front[*j].density;
            }
        }
        let by_v_across = v_open - h_sides + v_ends;
        let by_v_along = v_across + v_sides;
        let by_h_across = h_open - v_sides + h_ends;
        let by_h_along = h_across + h_sides;
        let by_slab = [
            by_v_across,
            by_v_across,
            by_v_along,
            by_v_along,
            by_h_along,
            by_h_along,
            by_h_across,
            by_h_across,
        ];
        let bound = [v_open, v_open, v_across, v_across, h_across, h_across, h_open, h_open];
        for k in 0..8 {
            let side = match &self.back[k] {
                Some(edge) => {
                    let side = self.sides[SIDE_OF[k]] * bound[k];
                    edge.add_derivative(&back[k], u, v, side, &mut coverage.by);
                    coverage.by[SIDES + SIDE_OF[k]] += strip(k) * bound[k];
                    side
                }
                None => 0.0,
            };
            self.front[k].add_derivative(&front[k], u, v, by_slab[k] - side, &mut coverage.by);
        }
        coverage
    }

    /// Of the front face's edges.
    pub(super) fn normals(&self) -> impl Iterator<Item = (f64, f64)> {
        self.front.iter().map(Edge::normal)
    }

    pub(super) fn shift(&self, by: &ByGlobals) -> f64 {
        self.front.iter().map(|edge| edge.shift(by)).fold(0.0, f64::max)
    }
}

/// The eight edges of the two bars in the plane y3 = `height_m`.
fn bars(cross: &StandOffCross, view: &View, height_m: f64, blur: Blur, tables: &Tables) -> Option<[Edge; 8]> {
    let (half, length) = (0.5 * cross.width_m, cross.half_length_m);
    let see = |y1: f64, y2: f64| view.see(&Vector3::new(y1, y2, height_m));
    let middle: Seen = see(0.0, 0.0)?;
    let bar = |across: f64, up: f64| -> Option<[Edge; 4]> {
        let (bl, br) = (see(-across, -up)?, see(across, -up)?);
        let (tl, tr) = (see(-across, up)?, see(across, up)?);
        Some(
            [(bl, tl), (br, tr), (bl, br), (tl, tr)]
                .map(|(a, b)| Edge::through(&a, &b, (middle.u, middle.v), blur, &tables.profiles)),
        )
    };
    let ([a, b, c, d], [e, f, g, h]) = (bar(half, length)?, bar(length, half)?);
    Some([a, b, c, d, e, f, g, h])
}

/// How far from an edge its blur is felt, px.
pub(super) fn reach_px(blur: Blur) -> f64 {
    // LIMIT is where nothing at all is left; three σ and a little leave 1e-3.
    (0.6 * LIMIT) * (blur.x.max(blur.y) + super::edge::BOX_VARIANCE).sqrt() + 0.5
}
