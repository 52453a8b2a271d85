//! Coverage of a patch's pixels and their equations at a pose, chunk by chunk.

use pulp::{Simd, WithSimd};

use super::chunk::{CHUNK, COLUMNS, Coverages, Equations, FIRST_GLOBAL, Gram, IdealPositions, Steps};
use super::coverage::{CrossImage, EDGES, MarkImage};
use super::sampled::Tables;
use super::samples::{Patch, Sample};
use super::unknowns::{GRID, LOCALS, SIDES};

/// Unit of coordinates within a patch, px. Gives levels and slopes a similar size.
const PATCH_UNIT_PX: f64 = 10.0;

/// Number of columns without the derivatives by the side faces, which are invisible in many chunks.
const WITHOUT_SIDES: usize = FIRST_GLOBAL + SIDES + 1;

/// Image of a feature at a pose, with the tables of its profiles.
#[derive(Clone, Copy)]
pub(super) struct FeatureModel<'a> {
    pub(super) image: Image<'a>,
    pub(super) tables: &'a Tables,
    /// Share of the blur that acts on pixel values.
    pub(super) share: f64,
}

/// Image of a feature.
#[derive(Clone, Copy)]
pub(super) enum Image<'a> {
    Mark(&'a MarkImage),
    Cross(&'a CrossImage),
}

/// Buffer for a chunk of pixels.
pub(super) struct ChunkBuffers {
    positions: IdealPositions<CHUNK>,
    corner: [f64; CHUNK],
    steps: [Steps<CHUNK>; EDGES],
    coverage: Coverages<CHUNK>,
    equations: Equations,
    gram: Gram,
}

impl ChunkBuffers {
    pub(super) const NEW: Self = Self {
        positions: IdealPositions { u: [0.0; CHUNK], v: [0.0; CHUNK] },
        corner: [0.0; CHUNK],
        steps: [const { Steps::FAR }; EDGES],
        coverage: Coverages::NONE,
        equations: [[0.0; CHUNK]; COLUMNS],
        gram: Gram::ZERO,
    };

    fn set_pixel(&mut self, l: usize, pixel: &Sample) {
        (self.positions.u[l], self.positions.v[l]) = (pixel.u, pixel.v);
        self.corner[l] = pixel.corner;
    }

    #[inline(always)]
    fn cover(&mut self, feature_model: &FeatureModel) {
        let Self { positions, steps, coverage, .. } = self;
        match feature_model.image {
            Image::Mark(mark) => mark.cover(feature_model.tables, positions, steps, coverage),
            Image::Cross(cross) => cross.cover(feature_model.tables, positions, steps, coverage),
        }
        for l in 0..CHUNK {
            coverage.value[l] += feature_model.share * self.corner[l];
            coverage.by[GRID][l] += self.corner[l];
        }
    }
}

/// Computation of the coverage of a chunk of pixels with its derivatives. A chunk that is not full is padded
/// with its last pixel.
pub(super) struct CoverageKernel<'a> {
    pub(super) feature_model: FeatureModel<'a>,
    pub(super) pixels: &'a [Sample],
    pub(super) work: &'a mut ChunkBuffers,
}

impl<'a> WithSimd for CoverageKernel<'a> {
    type Output = &'a Coverages<CHUNK>;

    // Only fully inlined code is compiled for the registers of the machine.
    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) -> Self::Output {
        let Self { feature_model, pixels, work } = self;
        for l in 0..CHUNK {
            let Some(pixel) = pixels.get(l).or(pixels.last()) else { break };
            work.set_pixel(l, pixel);
        }
        work.cover(&feature_model);
        &work.coverage
    }
}

/// Normal equations of a patch's used pixels, evaluated for every `stride`-th pixel. Updates the coverages of
/// these pixels.
pub(super) struct NormalEquations<'a> {
    pub(super) feature_model: FeatureModel<'a>,
    /// Centre of the patch, and the current level of the feature in it.
    pub(super) centre: (f64, f64),
    pub(super) level: f64,
    pub(super) pixels: &'a mut [Sample],
    /// Offset subtracted from DN.
    pub(super) origin: f64,
    pub(super) stride: usize,
    pub(super) work: &'a mut ChunkBuffers,
}

impl<'a> WithSimd for NormalEquations<'a> {
    /// Products of the equations, and the number of pixels used.
    type Output = (&'a Gram, usize);

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) -> Self::Output {
        let Self { feature_model, centre, level, pixels, origin, stride, work } = self;
        // In a shadow, the feature stands out more because the plate is darker; this excess is expressed in
        // units of the feature's level over the lit plate.
        let per_level = if level > 0.0 { 1.0 / level } else { 0.0 };
        let mut used = 0;
        for (index, pixels) in pixels.chunks_mut(CHUNK * stride).enumerate() {
            let count = pixels.len().div_ceil(stride);
            let mut over = [0.0; CHUNK];
            let (mut dn, mut shadow_dn) = ([0.0; CHUNK], [0.0; CHUNK]);
            for l in 0..CHUNK {
                let pixel = &pixels[l.min(count - 1) * stride];
                work.set_pixel(l, pixel);
                let weight = if l < count && pixel.is_used { 1.0 } else { 0.0 };
                used += usize::from(weight > 0.0);
                (dn[l], shadow_dn[l]) = (pixel.dn, pixel.shadow_dn);
                work.equations[1][l] = weight;
                work.equations[4][l] = weight * pixel.beyond_rim;
                over[l] = weight * (1.0 + pixel.shadow_dn * per_level);
            }
            work.cover(&feature_model);
            let ChunkBuffers { positions, coverage, equations, gram, .. } = &mut *work;
            for l in 0..CHUNK {
                let weight = equations[1][l];
                // A shadow darkens the plate where it is not covered by the feature.
                equations[0][l] = weight * (dn[l] + shadow_dn[l] * (1.0 - coverage.value[l]) - origin);
                equations[2][l] = weight * ((positions.u[l] - centre.0) / PATCH_UNIT_PX);
                equations[3][l] = weight * ((positions.v[l] - centre.1) / PATCH_UNIT_PX);
                equations[LOCALS][l] = weight * coverage.value[l];
            }
            for (column, by) in equations[FIRST_GLOBAL..].iter_mut().zip(&coverage.by) {
                for l in 0..CHUNK {
                    column[l] = over[l] * by[l];
                }
            }
            let columns = if coverage.has_sides { COLUMNS } else { WITHOUT_SIDES };
            gram.add(simd, equations, columns, index == 0);
            for (pixel, value) in pixels.iter_mut().step_by(stride).zip(&coverage.value) {
                pixel.coverage = *value;
            }
        }
        (&work.gram, used)
    }
}

/// Returns the regressors of a pixel's levels.
pub(super) fn regressors(patch: &Patch, pixel: &Sample, coverage: f64) -> [f64; LOCALS] {
    let across = (pixel.u - patch.centre.0) / PATCH_UNIT_PX;
    let down = (pixel.v - patch.centre.1) / PATCH_UNIT_PX;
    [1.0, across, down, pixel.beyond_rim, coverage]
}
