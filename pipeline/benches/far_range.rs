//! Benchmark of the far-range pipeline on whole frames of noise with stars, of several sizes and with few and
//! many stars, compared with a lower bound: reading every pixel once.
//!
//! `cargo bench -p boresight-pipeline --bench far_range`; `docs/evidence/speed/benchmarks.py` makes tables
//! and a chart of the results.
#![allow(clippy::unwrap_used, reason = "a benchmark ends by panicking")]

#[path = "../../benches/support/processor_time.rs"]
mod processor_time;

use std::cell::LazyCell;
use std::hint::black_box;
use std::time::Duration;

use boresight_pipeline::far_range::{FarRangeConfig, FarRangePipeline};
use contract::{Camera, Frame, Pipeline, Rotation, Setup, Telemetry};
use criterion::{BenchmarkId, Criterion, Throughput};
use hifitime::{Epoch, Unit};
use processor_time::ProcessorTime;

/// Frame sizes in thousands of pixels, with their columns and rows; 436 is that of the scenario `argon`.
const SIZES: [(usize, usize, usize); 5] =
    [(250, 577, 433), ARGON, (1000, 1154, 866), (4000, 2309, 1732), (25_000, 5773, 4330)];
const ARGON: (usize, usize, usize) = (436, 752, 580);

fn setup(columns: usize, rows: usize) -> Setup {
    Setup {
        camera: Camera {
            columns,
            rows,
            focal_length_mm: 20.187,
            pixel_width_um: 8.6,
            pixel_height_um: 8.3,
            principal_x_px: columns as f64 / 2.0,
            principal_y_px: rows as f64 / 2.0,
            radial: [0.0; 3],
            tangential: [0.0; 2],
        },
        camera_from_body: Rotation::identity(),
        bit_depth: 12,
        readout: None,
        calibration: contract::Calibration::default(),
        zero_suppression_dn: None,
        stars: Vec::new(),
    }
}

/// Returns a frame with a background of 51 DN (45 DN plus the sum of four uniform integers from 0 to 3,
/// standard deviation 2.2 DN) and stars of 3 × 3 pixels.
fn frame(number: u64, columns: usize, rows: usize, stars: usize) -> Frame {
    // Step of a linear congruential generator (Knuth's MMIX), whose high bits are good enough for a
    // benchmark.
    let mut state = number;
    let mut next = || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        state >> 33
    };
    let mut dn: Vec<u16> =
        (0..columns * rows).map(|_| 45 + (0..4).map(|_| (next() % 4) as u16).sum::<u16>()).collect();
    for star in 0..stars {
        let (x, y) = (next() as usize % (columns - 2), next() as usize % (rows - 2));
        for (i, share) in [1, 2, 1, 2, 4, 2, 1, 2, 1].into_iter().enumerate() {
            dn[(y + i / 3) * columns + x + i % 3] += share * (20 + star as u16 % 200);
        }
    }
    Frame::new(number, columns, rows, 12, dn, None).unwrap()
}

/// Measures the pipeline on a few frames in turn.
fn process(
    c: &mut Criterion<ProcessorTime>,
    name: BenchmarkId,
    (kilopixels, columns, rows): (usize, usize, usize),
    stars: usize,
) {
    let start = Epoch::from_gregorian_utc_at_midnight(2012, 4, 23);
    let frames =
        LazyCell::new(|| (0..4).map(|number| frame(number, columns, rows, stars)).collect::<Vec<Frame>>());
    let mut pipeline = FarRangePipeline::new(FarRangeConfig::default(), &setup(columns, rows)).unwrap();
    let mut number = 0_u64;
    let mut group = c.benchmark_group("pipeline");
    group.throughput(Throughput::Elements(1000 * kilopixels as u64));
    group.bench_function(name, |b| {
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
    group.finish();
}

fn main() {
    // The work per frame is constant: one second of measurement is enough.
    let mut criterion = Criterion::default()
        .with_measurement(ProcessorTime)
        .sample_size(20)
        .warm_up_time(Duration::from_millis(300))
        .measurement_time(Duration::from_secs(1))
        .configure_from_args();
    for size in SIZES {
        process(&mut criterion, BenchmarkId::new("size", size.0), size, 160);
        let frame = LazyCell::new(|| frame(0, size.1, size.2, 0));
        let mut group = criterion.benchmark_group("pipeline floor");
        group.throughput(Throughput::Elements(1000 * size.0 as u64));
        group.bench_function(BenchmarkId::new("largest pixel", size.0), |b| {
            let frame = &*frame;
            b.iter(|| black_box(frame).dn().iter().copied().fold(0, u16::max));
        });
        group.finish();
    }
    // More than 500 clusters are sorted, and the faintest of them are left out.
    for stars in [0, 10, 100, 1000, 10_000] {
        process(&mut criterion, BenchmarkId::new("stars", stars), ARGON, stars);
    }
    criterion.final_summary();
}
