//! Equality of a patch's equations on machines with different registers.

use contract::docking::Pose;
use nalgebra::Vector3;
use pulp::{Arch, Scalar, WithSimd};

use super::super::blur::Blur;
use super::super::chunk::{COLUMNS, FIRST_GLOBAL, Gram};
use super::super::coverage::{CrossImage, MarkImage};
use super::super::equations::{
    ChunkBuffers, CoverageKernel, FeatureModel, Image, NormalEquations, regressors,
};
use super::super::sampled::Tables;
use super::super::samples::{Feature, Patch, Sample};
use super::render::{camera, target};
use crate::CameraModel;
use crate::docking::pose::geometry::PoseProjection;

/// Returns 75 pixels around a point: two full chunks and a part of one.
fn samples(u: f64, v: f64) -> Vec<Sample> {
    let sample = |k: usize| Sample {
        u: u + (k % 15) as f64 - 7.0,
        v: v + (k / 15) as f64 - 2.0,
        column: k,
        row: 0,
        dn: 100.0 + (k * 37 % 101) as f64,
        beyond_rim: 0.01 * (k % 7) as f64,
        shadow_dn: 3.0 * (k % 2) as f64,
        corner: 1e-3 * (k % 5) as f64,
        coverage: 0.0,
        is_used: k % 11 != 3,
    };
    (0..75).map(sample).collect()
}

fn products(gram: &Gram) -> Vec<f64> {
    (0..COLUMNS).flat_map(|i| (i..COLUMNS).map(move |j| gram.column_product(i, j))).collect()
}

#[test]
fn equations_are_the_sums_over_pixels_and_the_same_bits_on_all_registers() {
    let model = CameraModel::new(&camera(super::WIDE_PX, [0.0; 3])).unwrap();
    let (target, mut tables) = (target(), Tables::new());
    let pose = Pose { position_m: Vector3::new(0.1, -0.05, 2.5), phi_rad: Vector3::new(0.02, -0.03, 0.1) };
    let (view, blur) = (PoseProjection::new(&model, &pose), Blur::on_grid(0.6, 0.5, 0.7));
    let sides = [0.3, 0.4, 0.5, 0.6];
    let image = |tables: &Tables| {
        let cross = CrossImage::new(&target, &view, &pose.position_m, blur, sides, tables).unwrap();
        (cross, MarkImage::new(&target.marks[2], &view, blur, tables).unwrap())
    };
    let normals: Vec<_> = image(&tables).0.normals().collect();
    assert!(tables.prepare(&normals, &blur));
    let (cross, mark) = image(&tables);
    let end_of_arm = view.project_with_derivatives(&Vector3::new(0.0, 0.15, 0.3)).unwrap();
    let on_ring = view.project_with_derivatives(&Vector3::new(0.125, 0.217, 0.0)).unwrap();
    for (image, at) in [(Image::Cross(&cross), end_of_arm), (Image::Mark(&mark), on_ring)] {
        let feature_model = FeatureModel { image, tables: &tables, share: 0.7 };
        let patch = Patch::new(Feature::Cross, 0..75, (at.u + 0.3, at.v));
        let (level, origin) = (80.0, 110.0);
        let found = |widest: bool, stride: usize| {
            let (mut pixels, mut work) = (samples(at.u, at.v), ChunkBuffers::NEW);
            let equations = NormalEquations {
                feature_model,
                centre: patch.centre,
                level,
                pixels: &mut pixels,
                origin,
                stride,
                work: &mut work,
            };
            let (gram, used) =
                if widest { Arch::new().dispatch(equations) } else { equations.with_simd(Scalar::new()) };
            (products(gram), used, pixels.iter().map(|pixel| pixel.coverage).collect::<Vec<_>>())
        };
        for stride in [1, 4] {
            assert_eq!(found(true, stride), found(false, stride));
        }
        // Sums computed pixel by pixel.
        let mut sums = [[0.0; COLUMNS]; COLUMNS];
        let mut work = ChunkBuffers::NEW;
        for pixel in samples(at.u, at.v).iter().filter(|pixel| pixel.is_used) {
            let cover =
                CoverageKernel { feature_model, pixels: std::slice::from_ref(pixel), work: &mut work };
            let coverage = cover.with_simd(Scalar::new());
            let mut row = [0.0; COLUMNS];
            row[0] = pixel.dn + pixel.shadow_dn * (1.0 - coverage.value[0]) - origin;
            row[1..FIRST_GLOBAL].copy_from_slice(&regressors(&patch, pixel, coverage.value[0]));
            for (slot, by) in row[FIRST_GLOBAL..].iter_mut().zip(&coverage.by) {
                *slot = (1.0 + pixel.shadow_dn / level) * by[0];
            }
            for i in 0..COLUMNS {
                for j in i..COLUMNS {
                    sums[i][j] += row[i] * row[j];
                }
            }
        }
        let (gram, used, _) = found(true, 1);
        assert_eq!(used, 68);
        let expected = (0..COLUMNS).flat_map(|i| sums[i][i..].to_vec());
        for (found, expected) in gram.into_iter().zip(expected) {
            // Sums of 68 terms of both signs, in another order.
            assert!((found - expected).abs() <= 1e-9 * (1.0 + expected.abs()), "{found} {expected}");
        }
    }
}
