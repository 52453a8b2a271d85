//! Cost of a frame: whole frames of the scenario `argon`, frames of other sizes and star counts, their
//! stages, and beside them the lower limits that no simulator undercuts: filling the memory of an image, and
//! its random numbers.
//!
//! `cargo bench -p boresight-sim --bench frame`; `docs/evidence/speed/benchmarks.py` makes tables and a chart
//! of the results.
#![allow(clippy::unwrap_used, reason = "a benchmark ends by panicking")]

use proptest::prelude::Rng;
#[path = "../tests/it/argon.rs"]
mod argon;
#[path = "../../benches/support/processor_time.rs"]
mod processor_time;

use std::cell::{LazyCell, RefCell};
use std::hint::black_box;
use std::path::Path;
use std::time::Duration;

use boresight_sim::draw::ExpectedImage;
use boresight_sim::optics::{Psf, PsfConfig, Stamp};
use boresight_sim::scene::{Lighting, MeshConfig, Spacecraft, TargetConfig};
use boresight_sim::sensor::{
    ExposureInterval, FixedPatternConfig, FrameCharge, LineNoiseConfig, PixelSampler, RawImage, Sensor,
    SensorConfig,
};
use boresight_sim::truth::{TargetAttitudeConfig, TrajectorySource};
use boresight_sim::{PixelSelection, Simulation, Simulator};
use contract::PixelPoint;
use criterion::{BenchmarkId, Criterion, Throughput};
use draws::{Effect, Seed};
use nalgebra::Vector3;
use processor_time::ProcessorTime;

const SEED: Seed = Seed { seed: 1, case: 0 };
/// Sizes of frames, thousands of pixels; 436 is the size in the scenario `argon`.
const KILOPIXELS: [usize; 5] = [250, 436, 1000, 4000, 25_000];
const OPENING: ExposureInterval = ExposureInterval { seed: SEED, middle_s: 0.0, exposure_s: 0.25 };
/// Number of stars in the frames of all sizes.
const STARS: u64 = 160;

/// Detectors that are simulated in different ways.
#[derive(Debug, Clone, Copy)]
enum Detector {
    /// Every pixel has the same mean.
    Even,
    /// Every pixel has a separate response and dark current.
    Uneven,
    /// Rows have offsets in addition.
    Rows,
}

impl Detector {
    const ALL: [(Self, &str); 3] =
        [(Self::Even, "even"), (Self::Uneven, "uneven"), (Self::Rows, "row offsets")];

    /// Detector of `kilopixels` thousand pixels, 4 columns to 3 rows.
    fn sensor(self, kilopixels: usize) -> Sensor {
        let pixels = kilopixels * 1000;
        let rows = (pixels as f64 * 0.75).sqrt() as usize;
        let argon: SensorConfig = argon::section(&argon::table(), "sensor");
        let uneven =
            FixedPatternConfig { prnu_fraction: 0.01, dsnu_fraction: 0.1, ..FixedPatternConfig::default() };
        let config = SensorConfig {
            fixed_pattern: match self {
                Self::Even => FixedPatternConfig::default(),
                Self::Uneven | Self::Rows => uneven,
            },
            line_noise: LineNoiseConfig {
                row_e: if matches!(self, Self::Rows) { 3.0 } else { 0.0 },
                column_e: 0.0,
            },
            background_e_per_s: 40.0,
            hot_pixels: Default::default(),
            blooming: None,
            cosmic_rays: None,
            ..argon
        };
        Sensor::new(&config, pixels / rows, rows).unwrap()
    }
}

/// Camera without a sky: stars of 600 electrons, the signal of most stars, at random positions.
struct Camera {
    sensor: Sensor,
    psf: Psf,
    stamp: Stamp,
    image: ExpectedImage,
    raw: RawImage,
    sampler: PixelSampler,
    frame: u64,
}

impl Camera {
    fn new(detector: Detector, kilopixels: usize) -> RefCell<Self> {
        let sensor = detector.sensor(kilopixels);
        let psf = PsfConfig::GaussianHalo { sigma_px: 0.8, halo_sigma_px: 4.0, halo_fraction: 0.0434 };
        RefCell::new(Self {
            psf: Psf::new(&psf).unwrap(),
            stamp: Stamp::new(),
            image: sensor.new_expected(),
            raw: sensor.new_raw(),
            sampler: sensor.new_sampler(),
            frame: 0,
            sensor,
        })
    }

    fn draw(&mut self, stars: u64) {
        self.image.clear(self.sensor.sky_electrons(OPENING.exposure_s));
        let (columns, rows) = self.image.size();
        let mut stream = SEED.stream(0, Effect::HotPixels, 0);
        for _ in 0..stars {
            let word = stream.next_u64();
            let at = |word: u32, n: usize| f64::from(word) / 4_294_967_296.0 * n as f64;
            let centre = PixelPoint::new(at(word as u32, columns), at((word >> 32) as u32, rows));
            self.psf.stamp(centre, 600.0, Psf::FLOOR_E, (columns, rows), &mut self.stamp);
            self.image.add(&self.stamp);
        }
    }

    fn collect_and_read_out(&mut self) {
        self.frame += 1;
        let charge = self.sensor.collect(&mut self.image, &OPENING);
        let collected = FrameCharge { charge: &charge, seed: SEED, frame: self.frame };
        self.sensor.read_out(&collected, &mut self.sampler, &mut self.raw).unwrap();
    }
}

fn floors(c: &mut Criterion<ProcessorTime>) {
    let mut group = c.benchmark_group("floor");
    for kilopixels in KILOPIXELS {
        let pixels = kilopixels * 1000;
        group.throughput(Throughput::Elements(pixels as u64));
        let image = LazyCell::new(|| RefCell::new(vec![0_u16; pixels]));
        group.bench_function(BenchmarkId::new("memory filled", kilopixels), |b| {
            let mut image = image.borrow_mut();
            b.iter(|| black_box(&mut *image).fill(black_box(7)));
        });
        group.bench_function(BenchmarkId::new("random words one by one", kilopixels), |b| {
            let mut stream = SEED.stream(0, Effect::PixelNoise, 0);
            b.iter(|| (0..pixels).fold(0, |all, _| all ^ stream.next_u64()));
        });
    }
    group.finish();
}

fn argon_frames(c: &mut Criterion<ProcessorTime>) {
    let simulator = LazyCell::new(|| Simulator::new(&argon::simulation(), Path::new("")).unwrap());
    let mut group = c.benchmark_group("argon");
    for (drawing, name) in [(PixelSelection::Needed, "40 regions"), (PixelSelection::All, "all pixels drawn")]
    {
        for day_start in [0_u64, 1700, 5000, 9000, 14_000] {
            group.bench_function(BenchmarkId::new(name, day_start), |b| {
                let mut camera = simulator.camera().unwrap().with_pixel_selection(drawing);
                let mut number = 0;
                b.iter(|| {
                    number += 1;
                    camera.expose(day_start + number % 400).unwrap()
                });
            });
        }
    }
    group.finish();
}

/// Stages of one frame, each timed separately. The charge that is read out is collected outside the timing.
fn stages(c: &mut Criterion<ProcessorTime>) {
    let mut group = c.benchmark_group("stage");
    group.throughput(Throughput::Elements(436_000));
    for (detector, name) in Detector::ALL {
        let camera = LazyCell::new(|| Camera::new(detector, 436));
        group.bench_function(BenchmarkId::new("images of 160 stars", name), |b| {
            let mut camera = camera.borrow_mut();
            b.iter(|| camera.draw(STARS));
        });
        group.bench_function(BenchmarkId::new("collecting", name), |b| {
            let camera = &mut *camera.borrow_mut();
            b.iter_custom(|times| {
                let mut spent = Duration::ZERO;
                for _ in 0..times {
                    camera.draw(STARS);
                    let start = std::time::Instant::now();
                    black_box(camera.sensor.collect(&mut camera.image, &OPENING));
                    spent += start.elapsed();
                }
                spent
            });
        });
        group.bench_function(BenchmarkId::new("reading out", name), |b| {
            let Camera { sensor, image, raw, sampler, .. } = &mut *camera.borrow_mut();
            let charge = sensor.collect(image, &OPENING);
            let mut number = 0;
            b.iter(|| {
                number += 1;
                let collected = FrameCharge { charge: &charge, seed: SEED, frame: number };
                sensor.read_out(&collected, sampler, raw).unwrap();
            });
        });
    }
    group.finish();
}

/// Whole frames of all sizes: 160 stars, collecting, noise, converter.
fn sizes(c: &mut Criterion<ProcessorTime>) {
    let mut group = c.benchmark_group("size");
    for (detector, name) in Detector::ALL {
        for kilopixels in KILOPIXELS {
            let camera = LazyCell::new(|| Camera::new(detector, kilopixels));
            group.throughput(Throughput::Elements(kilopixels as u64 * 1000));
            group.bench_function(BenchmarkId::new(name, kilopixels), |b| {
                let mut camera = camera.borrow_mut();
                b.iter(|| {
                    camera.draw(STARS);
                    camera.collect_and_read_out();
                });
            });
        }
    }
    group.finish();
}

/// Frames of a million pixels with few and with many stars.
fn stars(c: &mut Criterion<ProcessorTime>) {
    let mut group = c.benchmark_group("stars");
    for (detector, name) in Detector::ALL {
        let camera = LazyCell::new(|| Camera::new(detector, 1000));
        for count in [10_u64, 100, 1000, 10_000, 100_000] {
            group.throughput(Throughput::Elements(count));
            group.bench_function(BenchmarkId::new(name, count), |b| {
                let mut camera = camera.borrow_mut();
                b.iter(|| {
                    camera.draw(count);
                    camera.collect_and_read_out();
                });
            });
        }
    }
    group.finish();
}

/// The satellite of `scenarios/targets/` at several ranges: its visible, sunlit parts, its brightness and the
/// points of its image, with 2300 px per radian.
fn meshes(c: &mut Criterion<ProcessorTime>) {
    let folder = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../scenarios/targets"));
    let config = MeshConfig {
        path: "smallsat.glb".to_owned(),
        material_path: None,
        unit_m: 1.0,
        radius_m: 2.07,
        attitude: TargetAttitudeConfig::default(),
        surface: None,
        materials: Vec::new(),
    };
    let target = Spacecraft::load(&TargetConfig::Mesh(config), folder).unwrap();
    let mut group = c.benchmark_group("mesh");
    for range_m in [100.0, 1000.0, 30_000.0] {
        // From the direction z of the body, with the antenna, the wings and the baffle in view.
        let chaser_km = Vector3::new(0.0, 0.0, 1e-3 * range_m);
        let lighting =
            Lighting { chaser_km, sun_km: Vector3::new(1.0, -0.3, 0.8) * 1.2e8, sunlit_fraction: 1.0 };
        let project = |point: &Vector3<f64>| {
            let depth_m = range_m - point.z;
            Some(PixelPoint::new(400.0 + 2300.0 * point.x / depth_m, 300.0 + 2300.0 * point.y / depth_m))
        };
        let mut points = Vec::new();
        group.bench_function(BenchmarkId::new("image of a satellite", range_m), |b| {
            b.iter(|| {
                points.clear();
                let appearance = target.appearance(&lighting, None);
                appearance.image(&project, 1 << 18, &mut points);
                appearance.peak_share(&project, 0.2)
            });
        });
    }
    group.finish();
}

fn main() {
    // Every frame is the same amount of work, so one second of measurement is enough.
    let mut criterion = Criterion::default()
        .with_measurement(ProcessorTime)
        .sample_size(20)
        .warm_up_time(Duration::from_millis(300))
        .measurement_time(Duration::from_secs(1))
        .configure_from_args();
    for group in [floors, argon_frames, stages, sizes, stars, meshes] {
        group(&mut criterion);
    }
    criterion.final_summary();
}
