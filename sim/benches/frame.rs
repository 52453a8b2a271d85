//! What a frame costs: whole frames of the scenario `argon`, its stages, frames of other sizes and star counts, and beside them
//! the floors, which no simulator gets under: filling the memory of an image, and its random numbers.
//!
//! `cargo bench -p boresight-sim --bench frame`
#![allow(clippy::unwrap_used, reason = "a benchmark ends by panicking")]

#[path = "../tests/argon/mod.rs"]
mod argon;

use std::cell::{LazyCell, RefCell};
use std::hint::black_box;
use std::path::Path;

use boresight_sim::Simulator;
use boresight_sim::optics::{Psf, PsfConfig, Stamp};
use boresight_sim::randomness::{Effect, Seed};
use boresight_sim::sensor::{FixedPatternConfig, FlatLaws, Opening, Sensor, SensorConfig};
use contract::PixelPoint;
use criterion::{BenchmarkId, Criterion, Throughput};
use rand::Rng;

const SEED: Seed = Seed { seed: 1, case: 0 };

fn simulator() -> Simulator {
    Simulator::new(&argon::simulation(), Path::new("")).unwrap()
}

/// A detector of so many pixels, 4 columns to 3 rows, whose every pixel has a mean of its own.
fn uneven(pixels: usize) -> Sensor {
    let rows = (pixels as f64 * 0.75).sqrt() as usize;
    let table = argon::table();
    let config: SensorConfig = argon::section(&table, "sensor");
    let pattern =
        FixedPatternConfig { prnu_fraction: 0.01, dsnu_fraction: 0.1, ..config.fixed_pattern.clone() };
    Sensor::new(&SensorConfig { fixed_pattern: pattern, ..config }, pixels / rows, rows).unwrap()
}

fn floors(c: &mut Criterion) {
    let mut group = c.benchmark_group("floor");
    let pixels = 752 * 580;
    group.throughput(Throughput::Elements(pixels as u64));
    let mut image = vec![0_u16; pixels];
    group.bench_function("fill 752x580", |b| b.iter(|| black_box(&mut image).fill(black_box(7))));
    group.bench_function("random words 752x580", |b| {
        let mut stream = SEED.stream(0, Effect::PixelNoise, 0);
        b.iter(|| (0..pixels).fold(0, |all, _| all ^ stream.next_u64()));
    });
    group.finish();
}

fn whole_frames(c: &mut Criterion) {
    let simulator = simulator();
    let mut camera = simulator.camera().unwrap();
    let mut group = c.benchmark_group("argon");
    for day_start in [0_u64, 1700, 5000, 9000, 14_000] {
        group.bench_function(BenchmarkId::new("frames from", day_start), |b| {
            let mut number = 0;
            b.iter(|| {
                number += 1;
                camera.expose(day_start + number % 400).unwrap()
            });
        });
    }
    group.finish();
}

/// Collecting and reading out without any star: mean image, noise, converter, blooming.
fn readout(c: &mut Criterion) {
    let mut group = c.benchmark_group("collect and read out");
    for kilopixels in [250, 436, 1000, 4000, 25_000] {
        // Made when it is asked for: only what is measured is prepared.
        let detector = LazyCell::new(|| {
            let sensor = uneven(kilopixels * 1000);
            let buffers = RefCell::new((sensor.new_expected(), sensor.new_raw(), FlatLaws::new()));
            (sensor, buffers)
        });
        let opening = Opening { seed: SEED, middle_s: 0.0, exposure_s: 0.25 };
        group.throughput(Throughput::Elements(kilopixels as u64 * 1000));
        group.bench_function(BenchmarkId::from_parameter(format!("{kilopixels} kpx")), |b| {
            let (sensor, buffers) = &*detector;
            let (image, raw, laws) = &mut *buffers.borrow_mut();
            let mut number = 0;
            b.iter(|| {
                number += 1;
                image.clear(12.0);
                let charge = sensor.collect(image, &opening);
                sensor.read_out(&charge, &SEED, number, laws, raw).unwrap();
            });
        });
    }
    group.finish();
}

/// Images of stars of 200 electrons, most stars' lot, on a trail of no length.
fn stars(c: &mut Criterion) {
    let mut psf =
        Psf::new(&PsfConfig::GaussianHalo { sigma_px: 0.8, halo_sigma_px: 4.0, halo_fraction: 0.0434 })
            .unwrap();
    let sensor = uneven(436_000);
    let (mut image, mut stamp) = (sensor.new_expected(), Stamp::new());
    let (columns, rows) = image.size();
    let mut group = c.benchmark_group("stars");
    for count in [10_u64, 160, 1000, 10_000, 100_000] {
        group.throughput(Throughput::Elements(count));
        group.bench_function(BenchmarkId::from_parameter(count), |b| {
            b.iter(|| {
                image.clear(0.0);
                let mut stream = SEED.stream(0, Effect::HotPixels, 0);
                for _ in 0..count {
                    let word = stream.next_u64();
                    let (u, v) = (word as u32, (word >> 32) as u32);
                    let at = |u: u32, n: usize| f64::from(u) / 4_294_967_296.0 * n as f64;
                    let centre = PixelPoint::new(at(u, columns), at(v, rows));
                    psf.stamp(centre, 200.0, Psf::FLOOR_E, (columns, rows), &mut stamp);
                    image.add(&stamp);
                }
            });
        });
    }
    group.finish();
}

fn main() {
    let mut criterion = Criterion::default().configure_from_args();
    for group in [floors, whole_frames, readout, stars] {
        group(&mut criterion);
    }
    criterion.final_summary();
}
