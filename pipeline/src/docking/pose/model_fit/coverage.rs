//! Blurred coverage of marks and cross, in closed form.
//!
//! Between two opposite edges the blurred coverage is F1 + F2 − 1. For a quadrilateral it is the product over
//! its two pairs of edges, which is exact for a rectangle whose edges' blurs do not correlate. Where they do
//! (oblique corners, oblique edges under unequal blur), each corner adds the first term of the bivariate
//! normal's series in the correlation ρ: + ρ φ φ.

use contract::docking::{StandOffCross, TargetModel};
use nalgebra::Vector3;

use super::blur::Blur;
use super::chunk::{Coverages, IdealPositions, Steps};
use super::edge::Edge;
use super::gaussian::LIMIT;
use super::sampled::Tables;
use super::unknowns::{ByGlobals, GLOBALS, SIDES};
use crate::docking::pose::geometry::{PoseProjection, ProjectedPoint};

/// Number of edges of a feature. The largest is that of the cross, front and back.
pub(super) const EDGES: usize = 16;

/// Returns the blurred coverage between two opposite edges.
#[inline(always)]
fn slab<const N: usize>(one: &Steps<N>, other: &Steps<N>) -> [f64; N] {
    let mut between = [0.0; N];
    for l in 0..N {
        between[l] = one.inside[l] + other.inside[l] - 1.0;
    }
    between
}

/// Image of a mark at a pose.
#[derive(Debug, Clone)]
pub(super) struct MarkImage {
    edges: [Edge; 4],
    /// Correlations of the blurs of edges k and k + 1.
    correlations: [f64; 4],
}

impl MarkImage {
    /// Computes the image of a mark. Returns `None` when a corner is behind the camera.
    pub(super) fn new(
        corners: &[[f64; 2]; 4],
        view: &PoseProjection,
        blur: Blur,
        tables: &Tables,
    ) -> Option<Self> {
        let seen = corners.map(|[y1, y2]| view.project_with_derivatives(&Vector3::new(y1, y2, 0.0)));
        let [Some(a), Some(b), Some(c), Some(d)] = seen else { return None };
        let middle = (0.25 * (a.u + b.u + c.u + d.u), 0.25 * (a.v + b.v + c.v + d.v));
        let edges = [(a, b), (b, c), (c, d), (d, a)]
            .map(|(p, q)| Edge::from_points(&p, &q, middle, blur, &tables.profiles));
        let correlations = [0, 1, 2, 3].map(|k: usize| edges[k].correlation(&edges[(k + 1) % 4], blur));
        Some(Self { edges, correlations })
    }

    /// Computes the coverage with its derivatives.
    #[inline(always)]
    pub(super) fn cover<const N: usize>(
        &self,
        tables: &Tables,
        at: &IdealPositions<N>,
        steps: &mut [Steps<N>; EDGES],
        coverage: &mut Coverages<N>,
    ) {
        let across = self.step(tables, at, steps);
        self.corners(&across, steps, &mut coverage.value);
        coverage.by = [[0.0; N]; GLOBALS];
        coverage.has_sides = false;
        for k in 0..4 {
            if steps[k].is_near {
                self.edges[k].add_derivatives(&steps[k], at, &across[(k + 1) % 2], &mut coverage.by);
            }
        }
    }

    /// Computes the steps of the edges. Returns the coverage between opposite edges.
    #[inline(always)]
    fn step<const N: usize>(
        &self,
        tables: &Tables,
        at: &IdealPositions<N>,
        steps: &mut [Steps<N>],
    ) -> [[f64; N]; 2] {
        for (steps, edge) in steps.iter_mut().zip(&self.edges) {
            edge.steps(tables, at, steps);
        }
        [slab(&steps[0], &steps[2]), slab(&steps[1], &steps[3])]
    }

    #[inline(always)]
    fn corners<const N: usize>(&self, across: &[[f64; N]; 2], steps: &[Steps<N>], value: &mut [f64; N]) {
        for l in 0..N {
            value[l] = across[0][l] * across[1][l];
        }
        for k in 0..4 {
            let (one, next) = (&steps[k], &steps[(k + 1) % 4]);
            if one.is_near && next.is_near {
                for l in 0..N {
                    value[l] += self.correlations[k] * one.density[l] * next.density[l];
                }
            }
        }
    }

    /// Returns the coverage without derivatives.
    #[inline(always)]
    pub(super) fn values<const N: usize>(&self, tables: &Tables, at: &IdealPositions<N>) -> [f64; N] {
        let mut steps = [const { Steps::FAR }; 4];
        let across = self.step(tables, at, &mut steps);
        let mut value = [0.0; N];
        self.corners(&across, &steps, &mut value);
        value
    }

    /// Returns the coverage of one pixel without derivatives.
    pub(super) fn value_at(&self, tables: &Tables, u: f64, v: f64) -> f64 {
        let [value] = self.values(tables, &IdealPositions { u: [u], v: [v] });
        value
    }

    /// Returns the normals of the edges.
    pub(super) fn normals(&self) -> impl Iterator<Item = (f64, f64)> {
        self.edges.iter().map(Edge::normal)
    }

    pub(super) fn shift(&self, by: &ByGlobals) -> f64 {
        self.edges.iter().map(|edge| edge.shift(by)).fold(0.0, f64::max)
    }
}

// Edges of the cross, for the vertical bar (V) and the horizontal bar (H): left (−y1), right, bottom (−y2),
// top.
const VL: usize = 0;
const VR: usize = 1;
const VB: usize = 2;
const VT: usize = 3;
const HL: usize = 4;
const HR: usize = 5;
const HB: usize = 6;
const HT: usize = 7;

/// Index of the side face of each edge: +y1, −y1, +y2, −y2.
const SIDE_OF: [usize; 8] = [1, 0, 3, 2, 1, 0, 3, 2];

/// True for the edges at the end of their bar.
const IS_END: [bool; 8] = [false, false, true, true, true, true, false, false];

/// Pairs of edges that meet at a corner, with the sign of their product in the coverage.
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

/// Image of the cross at a pose: the union of two bars, and the side faces visible from off the axis.
///
/// A side face extends from an edge of the front face to the same edge of the back face. Mutual occlusion of
/// the two bars' side faces and the slanted ends of side faces are neglected: both are of second order in the
/// faces' widths.
#[derive(Debug, Clone)]
pub(super) struct CrossImage {
    front: [Edge; 8],
    /// Edges of the back face, where the side face is visible.
    back: [Option<Edge>; 8],
    correlations: [f64; 12],
    sides: [f64; 4],
}

impl CrossImage {
    /// Computes the image of the cross. `sides` is the brightness of the side faces over the plate, in units
    /// of the front face's. Returns `None` when a corner is behind the camera.
    pub(super) fn new(
        target: &TargetModel,
        view: &PoseProjection,
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

    /// Computes the coverage with its derivatives.
    #[inline(always)]
    pub(super) fn cover<const N: usize>(
        &self,
        tables: &Tables,
        at: &IdealPositions<N>,
        steps: &mut [Steps<N>; EDGES],
        coverage: &mut Coverages<N>,
    ) {
        let (front, back) = steps.split_at_mut(8);
        for (steps, edge) in front.iter_mut().zip(&self.front) {
            edge.steps(tables, at, steps);
        }
        let (v_across, v_along) = (slab(&front[VL], &front[VR]), slab(&front[VB], &front[VT]));
        let (h_across, h_along) = (slab(&front[HB], &front[HT]), slab(&front[HL], &front[HR]));
        // Share of a side face beside each edge, not yet limited along the edge.
        let mut strips = [[0.0; N]; 8];
        // Brightness of the strips of V and H beside bars and at bar ends, in units of the front face's.
        let (mut sides, mut ends) = ([[0.0; N]; 2], [[0.0; N]; 2]);
        coverage.has_sides = false;
        for (k, edge) in self.back.iter().enumerate() {
            let Some(edge) = edge else { continue };
            coverage.has_sides = true;
            edge.steps(tables, at, &mut back[k]);
            let (strip, level) = (&mut strips[k], self.sides[SIDE_OF[k]]);
            let bright = if IS_END[k] { &mut ends[k / 4] } else { &mut sides[k / 4] };
            for l in 0..N {
                strip[l] = back[k].inside[l] - front[k].inside[l];
                bright[l] += level * strip[l];
            }
        }
        // The side faces of one bar are interrupted by the other bar.
        let (mut v_open, mut h_open) = ([0.0; N], [0.0; N]);
        let mut by_slab = [[0.0; N]; 4];
        for l in 0..N {
            v_open[l] = v_along[l] - h_across[l];
            h_open[l] = h_along[l] - v_across[l];
            coverage.value[l] = v_across[l] * v_along[l] + h_across[l] * h_along[l]
                - v_across[l] * h_across[l]
                + sides[0][l] * v_open[l]
                + sides[1][l] * h_open[l]
                + ends[0][l] * v_across[l]
                + ends[1][l] * h_across[l];
            by_slab[0][l] = v_open[l] - sides[1][l] + ends[0][l];
            by_slab[1][l] = v_across[l] + sides[0][l];
            by_slab[2][l] = h_across[l] + sides[1][l];
            by_slab[3][l] = h_open[l] - sides[0][l] + ends[1][l];
        }
        for ((i, j, _), correlation) in CORNERS.iter().zip(&self.correlations) {
            let (one, other) = (&front[*i], &front[*j]);
            if one.is_near && other.is_near {
                for l in 0..N {
                    coverage.value[l] += correlation * one.density[l] * other.density[l];
                }
            }
        }
        coverage.by = [[0.0; N]; GLOBALS];
        let bounds = [&v_open, &v_across, &h_across, &h_open];
        for k in 0..8 {
            let mut weight = by_slab[k / 2];
            if let Some(edge) = &self.back[k] {
                let (level, bound) = (self.sides[SIDE_OF[k]], bounds[k / 2]);
                let by_side = &mut coverage.by[SIDES + SIDE_OF[k]];
                let mut side = [0.0; N];
                for l in 0..N {
                    side[l] = level * bound[l];
                    weight[l] -= side[l];
                    by_side[l] += strips[k][l] * bound[l];
                }
                if back[k].is_near {
                    edge.add_derivatives(&back[k], at, &side, &mut coverage.by);
                }
            }
            if front[k].is_near {
                self.front[k].add_derivatives(&front[k], at, &weight, &mut coverage.by);
            }
        }
    }

    /// Returns the coverage at one point without derivatives.
    pub(super) fn value_at(&self, tables: &Tables, u: f64, v: f64) -> f64 {
        let mut steps = [const { Steps::FAR }; EDGES];
        let mut coverages = Coverages::NONE;
        self.cover(tables, &IdealPositions { u: [u], v: [v] }, &mut steps, &mut coverages);
        coverages.value[0]
    }

    /// Returns the normals of the front face's edges.
    pub(super) fn normals(&self) -> impl Iterator<Item = (f64, f64)> {
        self.front.iter().map(Edge::normal)
    }

    pub(super) fn shift(&self, by: &ByGlobals) -> f64 {
        self.front.iter().map(|edge| edge.shift(by)).fold(0.0, f64::max)
    }
}

/// Returns the eight edges of the two bars in the plane y3 = `height_m`.
fn bars(
    cross: &StandOffCross,
    view: &PoseProjection,
    height_m: f64,
    blur: Blur,
    tables: &Tables,
) -> Option<[Edge; 8]> {
    let (half, length) = (0.5 * cross.width_m, cross.half_length_m);
    let see = |y1: f64, y2: f64| view.project_with_derivatives(&Vector3::new(y1, y2, height_m));
    let middle: ProjectedPoint = see(0.0, 0.0)?;
    let bar = |across: f64, up: f64| -> Option<[Edge; 4]> {
        let (bl, br) = (see(-across, -up)?, see(across, -up)?);
        let (tl, tr) = (see(-across, up)?, see(across, up)?);
        Some(
            [(bl, tl), (br, tr), (bl, br), (tl, tr)]
                .map(|(a, b)| Edge::from_points(&a, &b, (middle.u, middle.v), blur, &tables.profiles)),
        )
    };
    let ([a, b, c, d], [e, f, g, h]) = (bar(half, length)?, bar(length, half)?);
    Some([a, b, c, d, e, f, g, h])
}

/// Returns the distance from an edge up to which its blur is significant, px.
pub(super) fn reach_px(blur: Blur) -> f64 {
    // At LIMIT the blur has vanished; slightly above three σ, 1e-3 of it remains.
    (0.6 * LIMIT) * (blur.x.max(blur.y) + super::blur::BOX_VARIANCE).sqrt() + 0.5
}
