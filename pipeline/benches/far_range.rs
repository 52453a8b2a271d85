//! What the far-range pipeline costs on a whole frame of 752 × 580 pixels of noise with stars in it, and beside it the floor: one look
//! at every pixel.
//!
//! `cargo bench -p boresight-pipeline --bench far_range`
#![allow(clippy::unwrap_used, reason = "a benchmark ends by panicking")]

use std::hint::black_box;

use boresight_pipeline::far_range::{FarRange, FarRangeConfig};
use contract::{Camera, Frame, Pipeline, Rotation, Setup, Telemetry};
use criterion::Criterion;
use hifitime::{Epoch, Unit};

const COLUMNS: usize = 752;
const ROWS: usize = 580;

fn setup() -> Setup {
    Setup {
        camera: Camera {
            columns: COLUMNS,
            rows: ROWS,
            focal_length_mm: 20.187,
            pixel_width_um: 8.6,
            pixel_height_um: 8.3,
            principal_x_px: 395.0,
            principal_y_px: 288.0,
            radial: [0.0; 3],
            tangential: [0.0; 2],
        },
        camera_from_body: Rotation::identity(),
        bit_depth: 12,
        readout: None,
        stars: Vec::new(),
    }
}

/// A level of 50 DN with the sum of four even numbers as noise, 2.6 DN, and stars of 3 × 3 pixels.
fn frame(number: u64, stars: usize) -> Frame {
    // A step of a linear congruential generator (Knuth's MMIX); its high bits are good enough for a benchmark.
    let mut state = number;
    let mut next = || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        state >> 33
    };
    let mut dn: Vec<u16> =
        (0..COLUMNS * ROWS).map(|_| 45 + (0..4).map(|_| (next() % 4) as u16).sum::<u16>()).collect();
    for star in 0..stars {
        let (x, y) = (next() as usize % (COLUMNS - 2), next() as usize % (ROWS - 2));
        for (i, share) in [1, 2, 1, 2, 4, 2, 1, 2, 1].into_iter().enumerate() {
            dn[(y + i / 3) * COLUMNS + x + i % 3] += share * (20 + star as u16 % 200);
        }
    }
    Frame::new(number, COLUMNS, ROWS, 12, dn, None).unwrap()
}

fn main() {
    let mut criterion = Criterion::default().configure_from_args();
    let start = Epoch::from_gregorian_utc_at_midnight(2012, 4, 23);
    for stars in [0, 10, 40, 160] {
        let frames: Vec<Frame> = (0..8).map(|number| frame(number, stars)).collect();
        let mut pipeline = FarRange::new(FarRangeConfig::default(), &setup()).unwrap();
        let mut number = 0_u64;
        criterion.bench_function(&format!("process, {stars} stars"), |b| {
            b.iter(|| {
                number += 1;
                let telemetry = Telemetry {
                    time: start + 15.0 * number as f64 * Unit::Second,
                    exposure_s: 0.25,
                    body_from_icrs: Rotation::identity(),
                    velocity_km_s: None,
                };
                pipeline.process(&frames[number as usize % frames.len()], &telemetry)
            });
        });
    }
    let frame = frame(0, 0);
    criterion.bench_function("floor: the largest of all pixels", |b| {
        b.iter(|| black_box(&frame).dn().iter().copied().fold(0, u16::max));
    });
    criterion.final_summary();
}
