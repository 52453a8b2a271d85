//! Selection of pixels for the fit: bands along the edges of marks and cross, away from structures that are
//! not in the model.

use std::ops::{Range, RangeInclusive};

use contract::PixelPoint;
use contract::docking::{Field, MarkUse, TargetModel};
use nalgebra::{SMatrix, Vector3};

use super::blur::{BOX_VARIANCE, Blur};
use super::coverage::CrossImage;
use super::sampled::Tables;
use super::scene::Scene;
use super::shadow::ShadowFinder;
use super::unknowns::{BLUR, GLOBALS, Globals, LOCALS, SIDES};
use crate::CameraModel;
use crate::docking::pose::geometry::{PoseProjection, to_pose};

/// Pixel used by the fit.
#[derive(Debug, Clone, Copy)]
pub(super) struct Sample {
    /// Ideal image coordinates, px.
    pub(super) u: f64,
    pub(super) v: f64,
    /// Column, and row of the field.
    pub(super) column: usize,
    pub(super) row: usize,
    pub(super) dn: f64,
    /// Blurred share of the area beyond the plate's rim.
    pub(super) beyond_rim: f64,
    /// Darkening of the plate by a shadow, DN.
    pub(super) shadow_dn: f64,
    /// Exact coverage of a mark minus the product of its profiles, for a blur that acts on pixels only.
    pub(super) corner: f64,
    /// Coverage at the last evaluation.
    pub(super) coverage: f64,
    pub(super) is_used: bool,
}

/// Feature in a patch.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Feature {
    Mark(usize),
    Cross,
}

/// Mark, or piece of an arm of the cross, with separate levels: a shadow on one patch does not affect the
/// others.
#[derive(Debug, Clone)]
pub(super) struct Patch {
    pub(super) feature: Feature,
    pub(super) first: usize,
    pub(super) end: usize,
    pub(super) centre: (f64, f64),
    pub(super) levels: [f64; LOCALS],
    pub(super) squares: f64,
    /// Inverse of the levels' normal equations, and its product with their mixed terms with the globals'
    /// derivatives.
    pub(super) levels_inverse: SMatrix<f64, LOCALS, LOCALS>,
    pub(super) levels_by_globals: SMatrix<f64, LOCALS, GLOBALS>,
    pub(super) used_samples: usize,
    pub(super) is_used: bool,
    /// True if a shadow falls on the mark. The patch is then not used again.
    pub(super) is_shaded: bool,
}

impl Patch {
    /// Creates the patch of some pixels, with unknown levels.
    pub(super) fn new(feature: Feature, pixels: Range<usize>, centre: (f64, f64)) -> Self {
        Self {
            feature,
            first: pixels.start,
            end: pixels.end,
            centre,
            levels: [0.0; LOCALS],
            squares: 0.0,
            levels_inverse: SMatrix::zeros(),
            levels_by_globals: SMatrix::zeros(),
            used_samples: 0,
            is_used: true,
            is_shaded: false,
        }
    }
}

/// Number of pixels below which a patch determines no more than its levels.
const MIN_SAMPLES: usize = 10;

/// Distance from an edge, in σ of its blur, beyond which pixels determine only the levels. Where there are
/// many such pixels, only some of them are used.
const FLAT_FROM: f64 = 1.7;
const MANY_SAMPLES: f64 = 6_000.0;
const FLAT_THIN: usize = 4;

/// Length of an arm below which the arms share one patch, px. Longer arms are cut into pieces of about twice
/// this length.
const SHORT_ARM_PX: f64 = 15.0;

/// Share of a shadow at any point of a mark above which the mark counts as shaded.
const MIN_SHADED_SHARE: f64 = 0.02;

/// Share of a shadow above which a pixel of a mark's patch is dropped. Beside the mark, the shadow reduces
/// the plate's signal a little; on the mark, it reduces the mark's signal twenty times as much.
const MAX_SHADOW_SHARE: f64 = 5e-4;

/// Range of the shadow's share in which a pixel is at the shadow's edge. Where this edge meets the cross's
/// edge, the blurred visible part of the shadow is not the product of the two blurred shares: for parallel
/// edges the product is wrong by a quarter.
const EDGE_OF_SHADOW: RangeInclusive<f64> = 0.01..=0.99;

/// Distance from the cross's edge, in σ of its blur, from which on the plate's brightness can be separated
/// from the cross's blurred signal. A shadow almost hidden behind the cross is visible only there. At 1.6 σ
/// this signal is a twentieth of the cross's level, known to about 1 DN.
const BESIDE_CROSS: f64 = 1.6;

/// Collection of samples, with reusable buffers.
#[derive(Debug, Default)]
pub(super) struct Samples {
    pub(super) pixels: Vec<Sample>,
    pub(super) patches: Vec<Patch>,
    pub(super) marks: Vec<MarkUse>,
    /// Number of the last collection that contains each pixel.
    taken: Vec<u32>,
    collection: u32,
}

/// Parameters of one collection.
struct Search<'a> {
    field: &'a Field,
    camera: &'a CameraModel,
    target: &'a TargetModel,
    view: &'a PoseProjection,
    tables: &'a Tables,
    reach_px: f64,
    blur_px: f64,
    /// Scales on the plate and on the cross, px/m.
    plate_scale: f64,
    cross_scale: f64,
    /// Extent of the side faces beyond the front face, px.
    side_px: f64,
    /// Post between plate and cross, if it extends beyond the cross in the image: the image points of its
    /// ends.
    post: Option<[(f64, f64); 2]>,
    /// Thinning factors near the edges and in the outer part of the bands, and width of the outer part on
    /// either side, px.
    thin: usize,
    flat_thin: usize,
    flat_px: f64,
    /// Indices of marks so near the cross in the image that pixels of one must avoid the other.
    crowded: Vec<usize>,
    /// Circle around each mark, including the reach of its blur: centre and radius, m.
    about_marks: Vec<([f64; 2], f64)>,
}

impl Samples {
    /// Returns true if the cross is at most a single patch, used or not.
    pub(super) fn is_small_cross(&self) -> bool {
        self.patches.iter().filter(|patch| patch.feature == Feature::Cross).count() <= 1
    }

    /// Collects about `most` of the pixels within `slack_px` + the blur's reach of an edge, for a given pose.
    /// Returns `None` when the features are not in front of the camera.
    #[allow(clippy::too_many_arguments, reason = "the parts of the scene and the resolution")]
    pub(super) fn collect(
        &mut self,
        field: &Field,
        camera: &CameraModel,
        target: &TargetModel,
        tables: &Tables,
        view: &PoseProjection,
        blur: Blur,
        slack_px: f64,
        most: f64,
    ) -> Option<()> {
        let image = field.image();
        self.taken.resize(image.columns() * image.rows(), 0);
        self.collection = self.collection.wrapping_add(1);
        if self.collection == 0 {
            self.taken.fill(0);
            self.collection = 1;
        }
        self.pixels.clear();
        self.patches.clear();
        self.marks.clear();
        let search = Search::new(field, camera, target, view, tables, blur, slack_px, most)?;
        for index in 0..target.marks.len() {
            let usage = self.collect_mark(&search, index);
            self.marks.push(usage);
        }
        self.collect_cross(&search);
        Some(())
    }

    /// Returns the mean level of the cross over the plate, DN; 0 if no piece of the cross has been solved
    /// for.
    pub(super) fn cross_dn(&self) -> f64 {
        let levels = self
            .patches
            .iter()
            .filter(|patch| patch.feature == Feature::Cross && patch.is_used)
            .map(|patch| patch.levels[LOCALS - 1]);
        let (sum, count) = levels.fold((0.0, 0.0), |(sum, count), level| (sum + level, count + 1.0));
        if sum > 0.0 { sum / count } else { 0.0 }
    }

    /// Searches for the shadow of the cross. Stores the darkening of the plate at each pixel, and excludes
    /// the marks on which the shadow falls. `cross_dn` is the level of the cross over the plate, DN.
    pub(super) fn shade(
        &mut self,
        finder: &mut ShadowFinder,
        field: &Field,
        scene: &Scene,
        globals: &Globals,
        cross_dn: f64,
    ) {
        let Scene { camera, target, tables } = *scene;
        let pose = to_pose(globals);
        let view = &PoseProjection::new(camera, &pose);
        let blur = Blur::new(globals[BLUR], globals[BLUR + 1]);
        let sides = [0, 1, 2, 3].map(|k| globals[SIDES + k]);
        let cross = CrossImage::new(target, view, &pose.position_m, blur, sides, tables);
        let search = Search::new(field, camera, target, view, tables, blur, 0.0, f64::INFINITY);
        let (Some(cross), Some(search)) = (cross, search) else { return };
        let lit_dn = |u: f64, v: f64, y1: f64, y2: f64| {
            let inside_px = (target.plate_radius_m - norm(y1, y2)) * search.plate_scale;
            let is_bare = inside_px > search.reach_px
                && !search.is_on_marks(y1, y2, 0..target.marks.len())
                && !search.is_near_post(u, v);
            let beside_px = search.distance_from_cross_px(u, v) - search.side_px;
            if !is_bare || beside_px <= BESIDE_CROSS * search.blur_px {
                None
            } else if beside_px > search.reach_px {
                Some(0.0)
            } else {
                Some(cross_dn * cross.value_at(tables, u, v))
            }
        };
        let shadow = finder.find(field, camera, target, tables, view, blur, cross_dn, lit_dn);
        let Some(shadow) = shadow else { return };
        let mut shares = Vec::new();
        shadow.shares(tables, self.pixels.iter().map(|pixel| (pixel.u, pixel.v)), &mut shares);
        for (pixel, share) in self.pixels.iter_mut().zip(&shares) {
            pixel.shadow_dn = shadow.depth_dn * share;
        }
        for patch in &mut self.patches {
            let Feature::Mark(index) = patch.feature else { continue };
            let corners = &target.marks[index];
            // Corners, midpoints of the sides, centre.
            let weights = [[1.0, 0.0, 0.0, 0.0], [0.5, 0.5, 0.0, 0.0], [0.25; 4]];
            let is_shaded = (0..4).any(|turn| {
                weights.iter().any(|weight| {
                    let along = |axis: usize| -> f64 {
                        (0..4).map(|k| weight[k] * corners[(k + turn) % 4][axis]).sum()
                    };
                    let seen = view.project_with_derivatives(&Vector3::new(along(0), along(1), 0.0));
                    seen.is_some_and(|seen| shadow.share_at(tables, seen.u, seen.v) > MIN_SHADED_SHARE)
                })
            });
            patch.is_shaded = is_shaded;
            patch.is_used &= !is_shaded;
        }
        if search.is_small() {
            // A hundredth of a pixel is negligible against the noise of a small cross, and its pixels are
            // few.
            return;
        }
        let edge_px = search.reach_px;
        self.leave_out(|patch, pixel, index| {
            let share = shares[index];
            match patch.feature {
                Feature::Mark(_) => share > MAX_SHADOW_SHARE,
                Feature::Cross => {
                    EDGE_OF_SHADOW.contains(&share)
                        && search.distance_from_cross_px(pixel.u, pixel.v).abs() < edge_px
                }
            }
        });
    }

    /// Drops the pixels for which `is_out` returns true (its last argument is the index among all pixels),
    /// and patches left with too few pixels.
    fn leave_out(&mut self, is_out: impl Fn(&Patch, &Sample, usize) -> bool) {
        let mut kept = 0;
        for patch in &mut self.patches {
            let first = kept;
            for index in patch.first..patch.end {
                let pixel = self.pixels[index];
                if !is_out(patch, &pixel, index) {
                    self.pixels[kept] = pixel;
                    kept += 1;
                }
            }
            if kept - first < MIN_SAMPLES {
                kept = first;
            }
            (patch.first, patch.end) = (first, kept);
        }
        self.pixels.truncate(kept);
        self.patches.retain(|patch| patch.end > patch.first);
    }

    fn collect_mark(&mut self, search: &Search, index: usize) -> MarkUse {
        let corners = search.target.marks[index].map(|[y1, y2]| search.pixel(y1, y2, 0.0));
        let [Some(a), Some(b), Some(c), Some(d)] = corners else { return MarkUse::OutOfField };
        if ![a, b, c, d].iter().all(|corner| search.camera.is_on_detector(*corner)) {
            return MarkUse::OutOfField;
        }
        let is_crowded = search.crowded.contains(&index);
        let first = self.pixels.len();
        for (from, to) in [(a, b), (b, c), (c, d), (d, a)] {
            self.collect_band(search, from, to, search.reach_px, |u, v| {
                let (beyond_rim, _) = search.beyond_rim(u, v)?;
                (!(is_crowded && search.is_near_cross(u, v))).then_some(beyond_rim)
            });
        }
        if self.close_patch(Feature::Mark(index), first) { MarkUse::Used } else { MarkUse::Missing }
    }

    fn collect_cross(&mut self, search: &Search) {
        let cross = &search.target.cross;
        let (half, length) = (0.5 * cross.width_m, cross.half_length_m);
        let (arm_px, is_whole) = (search.arm_px(), search.is_small());
        let pieces = ((arm_px / (2.0 * SHORT_ARM_PX)) as usize).clamp(1, 6);
        let mut first = self.pixels.len();
        for (c, s) in [(0.0, 1.0), (0.0, -1.0), (1.0, 0.0), (-1.0, 0.0)] {
            // Along and across the arm.
            let pixel = |along: f64, across: f64| {
                search.pixel(c * along - s * across, s * along + c * across, cross.height_m)
            };
            for piece in 0..pieces {
                let at = |k: usize| half + (length - half) * k as f64 / pieces as f64;
                let (near, far) = (at(piece), at(piece + 1));
                let mut lines = [
                    Some((pixel(near, -half), pixel(far, -half))),
                    Some((pixel(near, half), pixel(far, half))),
                    None,
                ];
                if piece + 1 == pieces {
                    lines[2] = Some((pixel(far, -half), pixel(far, half)));
                }
                for (from, to) in lines.into_iter().flatten() {
                    let (Some(from), Some(to)) = (from, to) else { continue };
                    self.collect_band(search, from, to, search.reach_px + search.side_px, |u, v| {
                        let (beyond_rim, inside_px) = search.beyond_rim(u, v)?;
                        let is_clear = inside_px > search.reach_px
                            && !search.is_near_mark(u, v)
                            && (is_whole || !search.is_near_post(u, v));
                        is_clear.then_some(beyond_rim)
                    });
                }
                if !is_whole {
                    self.close_patch(Feature::Cross, first);
                    first = self.pixels.len();
                }
            }
        }
        if is_whole {
            self.close_patch(Feature::Cross, first);
        }
    }

    /// Makes a patch of the pixels from `first` on, or drops them when they are too few.
    fn close_patch(&mut self, feature: Feature, first: usize) -> bool {
        let pixels = &self.pixels[first..];
        if pixels.len() < MIN_SAMPLES {
            self.pixels.truncate(first);
            return false;
        }
        let n = pixels.len() as f64;
        let centre =
            (pixels.iter().map(|p| p.u).sum::<f64>() / n, pixels.iter().map(|p| p.v).sum::<f64>() / n);
        self.patches.push(Patch::new(feature, first..self.pixels.len(), centre));
        true
    }

    /// Collects the free pixels within `reach_px` of a segment for which `admit` returns a share beyond the
    /// rim.
    fn collect_band(
        &mut self,
        search: &Search,
        from: PixelPoint,
        to: PixelPoint,
        reach_px: f64,
        admit: impl Fn(f64, f64) -> Option<f64>,
    ) {
        let (image, lines) = (search.field.image(), search.field.lines());
        let (dx, dy) = (to.x - from.x, to.y - from.y);
        let length = libm::hypot(dx, dy).max(f64::MIN_POSITIVE);
        let (tx, ty) = (dx / length, dy / length);
        let step = lines.step() as f64;
        let first_row = lines.camera_row(0) as f64;
        let (top, bottom) = (from.y.min(to.y) - reach_px, from.y.max(to.y) + reach_px);
        let begin = ((top - first_row) / step).ceil().max(0.0);
        let end = ((bottom - first_row) / step).floor().min(image.rows() as f64 - 1.0);
        if begin > end {
            return;
        }
        for row in begin as usize..=end as usize {
            let camera_row = lines.camera_row(row) as f64;
            let y = camera_row - from.y;
            // |across| ≤ reach and −reach ≤ along ≤ length + reach, both linear in x.
            let mut span = (0.0, image.columns() as f64 - 1.0);
            narrow(&mut span, -ty, -ty * -from.x + tx * y, -reach_px, reach_px);
            narrow(&mut span, tx, -tx * from.x + ty * y, -reach_px, length + reach_px);
            if span.0 > span.1 {
                continue;
            }
            for x in span.0.ceil() as usize..=span.1.floor() as usize {
                let across = (x as f64 - from.x) * ty - y * tx;
                let is_flat = across.abs() > reach_px - search.flat_px;
                if !(x + row).is_multiple_of(if is_flat { search.flat_thin } else { search.thin }) {
                    continue;
                }
                let taken = &mut self.taken[row * image.columns() + x];
                if *taken == self.collection {
                    continue;
                }
                let dn = image.dn_at(x, row);
                if dn >= image.full_scale_dn() {
                    continue;
                }
                let Some((u, v)) = search.camera.to_ideal(PixelPoint::new(x as f64, camera_row)) else {
                    continue;
                };
                let Some(beyond_rim) = admit(u, v) else { continue };
                *taken = self.collection;
                let dn = f64::from(dn);
                self.pixels.push(Sample {
                    u,
                    v,
                    column: x,
                    row,
                    dn,
                    beyond_rim,
                    shadow_dn: 0.0,
                    corner: 0.0,
                    coverage: 0.0,
                    is_used: true,
                });
            }
        }
    }
}

/// Returns the length of a vector of moderate size. The version in libm works for any size but takes ten
/// times as long.
fn norm(a: f64, b: f64) -> f64 {
    (a * a + b * b).sqrt()
}

/// Narrows an interval of x to the part with low ≤ slope x + offset ≤ high.
fn narrow(span: &mut (f64, f64), slope: f64, offset: f64, low: f64, high: f64) {
    if slope.abs() < 1e-9 {
        if !(low..=high).contains(&offset) {
            *span = (1.0, 0.0);
        }
        return;
    }
    let (a, b) = ((low - offset) / slope, (high - offset) / slope);
    *span = (span.0.max(a.min(b)), span.1.min(a.max(b)));
}

impl<'a> Search<'a> {
    #[allow(clippy::too_many_arguments, reason = "the parts of the scene and the resolution")]
    fn new(
        field: &'a Field,
        camera: &'a CameraModel,
        target: &'a TargetModel,
        view: &'a PoseProjection,
        tables: &'a Tables,
        blur: Blur,
        slack_px: f64,
        most: f64,
    ) -> Option<Self> {
        let cross = &target.cross;
        let at = |y1: f64, y2: f64, y3: f64| {
            view.project_with_derivatives(&Vector3::new(y1, y2, y3)).map(|seen| (seen.u, seen.v))
        };
        let scale = |radius: f64, height: f64| -> Option<f64> {
            let (a, b) = (at(-radius, 0.0, height)?, at(radius, 0.0, height)?);
            Some(libm::hypot(a.0 - b.0, a.1 - b.1) / (2.0 * radius))
        };
        let (plate_scale, cross_scale) =
            (scale(target.plate_radius_m, 0.0)?, scale(cross.half_length_m, cross.height_m)?);
        let back_m = cross.height_m - cross.thickness_m;
        let mut side_px = 0.0f64;
        let (half, length) = (0.5 * cross.width_m, cross.half_length_m);
        for (y1, y2) in [(-length, half), (length, half), (half, -length), (half, length)] {
            let (front, back) = (at(y1, y2, cross.height_m)?, at(y1, y2, back_m)?);
            side_px = side_px.max(libm::hypot(front.0 - back.0, front.1 - back.1));
        }
        let reach_px = super::coverage::reach_px(blur) + slack_px;
        let post = [at(0.0, 0.0, 0.0)?, at(0.0, 0.0, back_m)?];
        let post_px = libm::hypot(post[0].0 - post[1].0, post[0].1 - post[1].1);
        // Length of all edges times the width of the bands, divided by the row step of the field.
        let mark_px: f64 = target
            .marks
            .iter()
            .map(|[a, _, c, _]| 2.8 * libm::hypot(a[0] - c[0], a[1] - c[1]) * plate_scale)
            .sum();
        let edges_px = mark_px + 8.0 * length * cross_scale;
        let expected = edges_px * 2.0 * (reach_px + side_px) / field.lines().step() as f64;
        let thin = ((expected / most).ceil() as usize).max(1);
        let blur_px = (0.5 * (blur.x + blur.y) + BOX_VARIANCE).sqrt();
        let mut search = Self {
            field,
            camera,
            target,
            view,
            tables,
            reach_px,
            blur_px,
            plate_scale,
            cross_scale,
            side_px,
            post: (post_px > (half - 0.5 * cross.post_width_m) * cross_scale).then_some(post),
            thin,
            flat_thin: if expected > MANY_SAMPLES { FLAT_THIN * thin } else { thin },
            flat_px: (reach_px - slack_px - FLAT_FROM * blur_px).max(0.0),
            crowded: Vec::new(),
            about_marks: target
                .marks
                .iter()
                .map(|[a, _, c, _]| {
                    let half_diagonal = 0.5 * libm::hypot(a[0] - c[0], a[1] - c[1]);
                    ([0.5 * (a[0] + c[0]), 0.5 * (a[1] + c[1])], half_diagonal + reach_px / plate_scale)
                })
                .collect(),
        };
        search.crowded = (0..target.marks.len())
            .filter(|index| {
                target.marks[*index].iter().any(|[y1, y2]| {
                    at(*y1, *y2, 0.0)
                        .is_some_and(|(u, v)| search.distance_from_cross_px(u, v) < 2.0 * reach_px + side_px)
                })
            })
            .collect();
        Some(search)
    }

    /// Returns the length of an arm of the cross, px.
    fn arm_px(&self) -> f64 {
        let cross = &self.target.cross;
        (cross.half_length_m - 0.5 * cross.width_m) * self.cross_scale
    }

    /// Returns true if the cross is a single patch.
    fn is_small(&self) -> bool {
        self.arm_px() < SHORT_ARM_PX
    }

    fn pixel(&self, y1: f64, y2: f64, y3: f64) -> Option<PixelPoint> {
        self.camera.project_vector(&self.view.to_camera(&Vector3::new(y1, y2, y3)))
    }

    /// Returns the blurred share of the area beyond the plate's rim, and the distance inside the rim, px.
    /// Returns `None` on the rim and beyond it. The area beyond is assumed to have constant brightness along
    /// a mark's patch. In reality it has seams and shadows; where its share is above a half, they would shift
    /// small marks by more than the uncertainty of their positions.
    fn beyond_rim(&self, u: f64, v: f64) -> Option<(f64, f64)> {
        let (y1, y2) = self.view.on_plane(u, v, 0.0)?;
        let inside_px = (self.target.plate_radius_m - norm(y1, y2)) * self.plate_scale;
        (inside_px > 0.0).then(|| (self.tables.gaussian.cdf_and_pdf(-inside_px / self.blur_px).0, inside_px))
    }

    /// Returns the distance from the cross's front face, px, negative inside.
    fn distance_from_cross_px(&self, u: f64, v: f64) -> f64 {
        let cross = &self.target.cross;
        let Some((y1, y2)) = self.view.on_plane(u, v, cross.height_m) else { return f64::INFINITY };
        let bar = |half_1: f64, half_2: f64| {
            let (a, b) = (y1.abs() - half_1, y2.abs() - half_2);
            if a > 0.0 && b > 0.0 { norm(a, b) } else { a.max(b) }
        };
        let (half, length) = (0.5 * cross.width_m, cross.half_length_m);
        bar(half, length).min(bar(length, half)) * self.cross_scale
    }

    fn is_near_cross(&self, u: f64, v: f64) -> bool {
        self.distance_from_cross_px(u, v) < self.reach_px + self.side_px || self.is_near_post(u, v)
    }

    fn is_near_mark(&self, u: f64, v: f64) -> bool {
        if self.crowded.is_empty() {
            return false;
        }
        let Some((y1, y2)) = self.view.on_plane(u, v, 0.0) else { return true };
        self.is_on_marks(y1, y2, self.crowded.iter().copied())
    }

    /// Returns true if a point of the plate lies on one of the given marks or within reach of one.
    fn is_on_marks(&self, y1: f64, y2: f64, mut marks: impl Iterator<Item = usize>) -> bool {
        marks.any(|index| {
            let (centre, reach_m) = self.about_marks[index];
            let (a, b) = (y1 - centre[0], y2 - centre[1]);
            a * a + b * b < reach_m * reach_m
        })
    }

    /// Returns true if the post or its blurred edge may be visible at a point.
    fn is_near_post(&self, u: f64, v: f64) -> bool {
        let Some([a, b]) = self.post else { return false };
        let (du, dv) = (b.0 - a.0, b.1 - a.1);
        let along = (((u - a.0) * du + (v - a.1) * dv) / (du * du + dv * dv)).clamp(0.0, 1.0);
        let off = norm(u - a.0 - along * du, v - a.1 - along * dv);
        off < 0.5 * self.target.cross.post_width_m * self.cross_scale + 0.6 * self.reach_px
    }
}
