//! The pipeline's best mode beside the Cramér–Rao bound: fitted centroids, weighted attitude, and images that are saturated
//! and cut. The bounds are computed here, from a Gaussian of its own integrated over pixels.

use contract::{
    Camera, CameraFrame, Direction, Frame, Icrs, ListedStar, Outcome, Pipeline, PixelPoint, Readout,
    Rotation, Setup, Telemetry,
};
use hifitime::Epoch;
use nalgebra::{Matrix2x3, Matrix3, Matrix4, Vector3, Vector4};
use pipeline::far_range::{
    AberrationConfig, AttitudeConfig, CentroidConfig, FarRangeConfig, FarRangePipeline, StarWeights,
};
use sim::onboard::{RoiConfig, RoiExtractor, ScanOrder, downlink};
use sim::optics::{Psf, PsfConfig, Stamp};
use sim::randomness::Seed;
use sim::sensor::{FlatLaws, Opening, RawImage, Sensor, SensorConfig};

const SIGMA_PX: f64 = 0.8;
const BACKGROUND_E: f64 = 20.0;
const GAIN_E_PER_DN: f64 = 10.0;
const READ_NOISE_E: f64 = 15.0;
const BIAS_DN: f64 = 40.3;
const FOCAL_PX: f64 = 2000.0;

/// Sides of the lattice of phases and places: the fractional parts of multiples of the powers of the plastic number's inverse
/// fill the square evenly (Roberts 2018).
fn lattice(k: usize) -> (f64, f64) {
    let fraction = |v: f64| v - v.floor();
    (fraction(0.754_877_666_246_692_7 * k as f64), fraction(0.569_840_290_998_053_2 * k as f64))
}

fn sensor(columns: usize, rows: usize) -> Sensor {
    let config = SensorConfig {
        bit_depth: 12,
        gain_e_per_dn: GAIN_E_PER_DN,
        bias_dn: BIAS_DN,
        full_well_e: 60_000.0,
        read_noise_e: READ_NOISE_E,
        ..SensorConfig::default()
    };
    Sensor::new(&config, columns, rows).unwrap()
}

/// Draws points of light, by place and electrons, with a frame's noise.
fn draw(sensor: &Sensor, psf: &PsfConfig, points: &[(PixelPoint, f64)], number: u64) -> RawImage {
    let mut psf = Psf::new(psf).unwrap();
    let mut image = sensor.new_expected();
    image.clear(BACKGROUND_E);
    let mut stamp = Stamp::new();
    for (centre, electrons) in points {
        psf.stamp(*centre, *electrons, Psf::FLOOR_E, image.size(), &mut stamp);
        image.add(&stamp);
    }
    let mut raw = sensor.new_raw();
    let seed = Seed { seed: 20_120_423, case: 0 };
    let charge = sensor.collect(&mut image, &Opening { seed, middle_s: 0.0, exposure_s: 0.25 });
    sensor.read_out(&charge, &seed, number, &mut FlatLaws::new(), &mut raw).unwrap();
    raw
}

fn camera(columns: usize, rows: usize) -> Camera {
    Camera {
        columns,
        rows,
        focal_length_mm: FOCAL_PX / 100.0,
        pixel_width_um: 10.0,
        pixel_height_um: 10.0,
        principal_x_px: 0.5 * columns as f64,
        principal_y_px: 0.5 * rows as f64,
        radial: [0.0; 3],
        tangential: [0.0; 2],
    }
}

fn fit() -> CentroidConfig {
    CentroidConfig::Fit { psf_sigma_px: Some(SIGMA_PX) }
}

/// The answer of a fresh pipeline to one frame.
fn answer(
    config: FarRangeConfig,
    frame: &Frame,
    stars: &[ListedStar],
    truth: Rotation<CameraFrame, Icrs>,
) -> Outcome {
    let setup = Setup {
        camera: camera(frame.columns(), frame.rows()),
        camera_from_body: Rotation::identity(),
        bit_depth: 12,
        readout: Some(Readout {
            gain_e_per_dn: GAIN_E_PER_DN,
            bias_dn: BIAS_DN,
            read_noise_e: READ_NOISE_E,
            saturation_dn: 4095,
        }),
        calibration: contract::Calibration::default(),
        zero_suppression_dn: None,
        stars: stars.to_vec(),
    };
    let telemetry = Telemetry {
        time: Epoch::from_gregorian_utc_at_midnight(2012, 4, 25),
        exposure_s: 0.25,
        body_from_icrs: Rotation::from_unit_quaternion(*truth.quaternion()),
        velocity_km_s: None,
    };
    FarRangePipeline::new(config, &setup).unwrap().process(frame, &telemetry)
}

/// The centre of the only cluster within 2 px of a place.
fn cluster_at(outcome: &Outcome, place: PixelPoint) -> PixelPoint {
    let mut near = outcome.clusters.iter().map(|c| c.position).filter(|p| p.distance(place) < 2.0);
    let found = near.next().unwrap_or_else(|| panic!("no cluster at {place:?}"));
    assert_eq!(near.next(), None, "two clusters at {place:?}");
    found
}

/// Half the side of the square of pixels that a bound uses: all that could tell anything.
const BOUND_REACH_PX: i64 = 8;

/// The Cramér–Rao bound of a star's centre: variances along x and y, px², flux and background unknown too. A pixel has a
/// variance of its expected electrons + read noise² + gain²/12 for the rounding.
fn bound(centre: PixelPoint, electrons: f64) -> (f64, f64) {
    let expected = |p: &Vector4<f64>, column: i64, row: i64| {
        let share = |pixel: i64, centre: f64| {
            let edge = |at: f64| libm::erf((at - centre) / (SIGMA_PX * std::f64::consts::SQRT_2));
            0.5 * (edge(pixel as f64 + 0.5) - edge(pixel as f64 - 0.5))
        };
        p[3] + p[2] * share(column, p[0]) * share(row, p[1])
    };
    let at = Vector4::new(centre.x, centre.y, electrons, BACKGROUND_E);
    let steps = Vector4::new(1e-4, 1e-4, 1.0, 0.01);
    let (x, y) = (centre.x.round() as i64, centre.y.round() as i64);
    let mut fisher = Matrix4::zeros();
    for row in y - BOUND_REACH_PX..=y + BOUND_REACH_PX {
        for column in x - BOUND_REACH_PX..=x + BOUND_REACH_PX {
            let by = Vector4::from_fn(|i, _| {
                let mut step = Vector4::zeros();
                step[i] = steps[i];
                (expected(&(at + step), column, row) - expected(&(at - step), column, row)) / (2.0 * steps[i])
            });
            let rounding_e2 = GAIN_E_PER_DN * GAIN_E_PER_DN / 12.0;
            let variance = expected(&at, column, row) + READ_NOISE_E * READ_NOISE_E + rounding_e2;
            fisher += by * by.transpose() / variance;
        }
    }
    let covariance = fisher.try_inverse().unwrap();
    (covariance[(0, 0)], covariance[(1, 1)])
}

/// Errors of a coordinate.
#[derive(Default)]
struct Errors {
    sum: f64,
    squares: f64,
    n: f64,
}

impl Errors {
    fn add(&mut self, error: f64) {
        self.sum += error;
        self.squares += error * error;
        self.n += 1.0;
    }

    fn rms(&self) -> f64 {
        (self.squares / self.n).sqrt()
    }

    fn mean(&self) -> f64 {
        self.sum / self.n
    }
}

/// Stars in cells of 17 × 17 pixels, 32 × 32 of them a frame, ten frames: 10,240 draws a magnitude. An RMS of these is known
/// to 0.7 %.
#[test]
fn a_fitted_centroid_of_an_isolated_star_reaches_the_cramer_rao_bound() {
    const CELL_PX: usize = 17;
    const CELLS: usize = 32;
    let side = CELL_PX * CELLS;
    let sensor = sensor(side, side);
    let brightness = FarRangeConfig { max_clusters: 2000, ..FarRangeConfig::default() };
    let fitting = FarRangeConfig { centroid: fit(), ..brightness.clone() };
    let free = FarRangeConfig { centroid: CentroidConfig::Fit { psf_sigma_px: None }, ..brightness.clone() };
    println!(
        "electrons  bound/px   fitted/bound x, y   width free   bias/px x, y        brightness centre/px"
    );
    for (magnitude, electrons) in [1500.0, 5000.0, 15_000.0, 50_000.0, 150_000.0].into_iter().enumerate() {
        let (mut x, mut y, mut free_width, mut paper) =
            (Errors::default(), Errors::default(), Errors::default(), Errors::default());
        let (mut bound_x, mut bound_y, mut n) = (0.0, 0.0, 0.0);
        for number in 0..10 {
            let first = number * CELLS * CELLS;
            let points: Vec<(PixelPoint, f64)> = (0..CELLS * CELLS)
                .map(|k| {
                    let (u, v) = lattice(first + k);
                    let cell = |i: usize| (CELL_PX * i + CELL_PX / 2) as f64 - 0.5;
                    (PixelPoint::new(cell(k % CELLS) + u, cell(k / CELLS) + v), electrons)
                })
                .collect();
            let psf = PsfConfig::Gaussian { sigma_px: SIGMA_PX };
            let raw = draw(&sensor, &psf, &points, (10 * magnitude + number) as u64);
            let frame = downlink(&raw, 0, None).unwrap();
            let of = |config: &FarRangeConfig| answer(config.clone(), &frame, &[], Rotation::identity());
            let (fitted, centres) = (of(&fitting), of(&brightness));
            // One frame in five suffices to see what a free width costs.
            let with_free_width = (number % 5 == 0).then(|| of(&free));
            for (place, _) in &points {
                let got = cluster_at(&fitted, *place);
                x.add(got.x - place.x);
                y.add(got.y - place.y);
                paper.add(cluster_at(&centres, *place).x - place.x);
                if let Some(outcome) = &with_free_width {
                    free_width.add(cluster_at(outcome, *place).x - place.x);
                }
            }
            // Every twentieth phase is enough for the mean of a smooth function of the phase.
            for (place, _) in points.iter().step_by(20) {
                let (variance_x, variance_y) = bound(*place, electrons);
                (bound_x, bound_y, n) = (bound_x + variance_x, bound_y + variance_y, n + 1.0);
            }
        }
        let (bound_x, bound_y) = ((bound_x / n).sqrt(), (bound_y / n).sqrt());
        println!(
            "{electrons:9}  {bound_x:.5}    {:.4}, {:.4}      {:.4}       {:+.5}, {:+.5}  {:.5} = {:.2} × bound",
            x.rms() / bound_x,
            y.rms() / bound_y,
            free_width.rms() / bound_x,
            x.mean(),
            y.mean(),
            paper.rms(),
            paper.rms() / bound_x,
        );
        for (errors, bound) in [(&x, bound_x), (&y, bound_y)] {
            assert!(errors.rms() <= 1.03 * bound, "{electrons} e: {} of {bound} px", errors.rms());
            // Lower than the bound by more than chance (3 × 0.7 %) would be a wrong bound.
            assert!(errors.rms() >= 0.975 * bound, "{electrons} e: {} of {bound} px", errors.rms());
            assert!(errors.mean().abs() <= 0.003, "{electrons} e: bias {} px", errors.mean());
        }
    }
}

fn pixel(seen: &Vector3<f64>, side: usize) -> PixelPoint {
    let centre = 0.5 * side as f64;
    PixelPoint::new(centre + FOCAL_PX * seen.x / seen.z, centre + FOCAL_PX * seen.y / seen.z)
}

/// The bound of an attitude from stars, the covariance of a small rotation about the camera's axes, rad².
fn attitude_bound(stars: &[(PixelPoint, f64)], side: usize) -> Matrix3<f64> {
    let mut fisher = Matrix3::zeros();
    for (place, electrons) in stars {
        let centre = 0.5 * side as f64;
        let ray = Vector3::new((place.x - centre) / FOCAL_PX, (place.y - centre) / FOCAL_PX, 1.0);
        let step = 1e-6;
        let by = Matrix2x3::from_fn(|row, axis| {
            let mut turn = Vector3::zeros();
            turn[axis] = step;
            let (plus, minus) =
                (pixel(&(ray + turn.cross(&ray)), side), pixel(&(ray - turn.cross(&ray)), side));
            let difference = if row == 0 { plus.x - minus.x } else { plus.y - minus.y };
            difference / (2.0 * step)
        });
        let (variance_x, variance_y) = bound(*place, *electrons);
        let weight = nalgebra::Matrix2::new(1.0 / variance_x, 0.0, 0.0, 1.0 / variance_y);
        fisher += by.transpose() * weight * by;
    }
    fisher.try_inverse().unwrap()
}

/// Sixteen stars a frame, 1000 frames: the RMS across the boresight is known to 1.6 %, that about it to 2.2 %.
#[test]
fn the_weighted_attitude_reaches_the_cramer_rao_bound() {
    const SIDE: usize = 160;
    const FRAMES: usize = 1000;
    const FLUXES_E: [f64; 5] = [3000.0, 6000.0, 15_000.0, 40_000.0, 120_000.0];
    let sensor = sensor(SIDE, SIDE);
    let config = |centroid: CentroidConfig, weights: StarWeights| FarRangeConfig {
        centroid,
        aberration: AberrationConfig::Ignore,
        // The stars are where the list says: no floor.
        attitude: AttitudeConfig { weights, weight_floor_px: 0.0, ..AttitudeConfig::default() },
        ..FarRangeConfig::default()
    };
    let modes = [
        ("fitted, weighted", config(fit(), StarWeights::InverseVariance)),
        ("fitted, equal weights", config(fit(), StarWeights::Equal)),
        ("brightness centres", config(CentroidConfig::Brightness, StarWeights::Equal)),
    ];
    let mut across: [Errors; 3] = Default::default();
    let mut roll: [Errors; 3] = Default::default();
    let (mut bound_across, mut bound_roll) = (0.0, 0.0);
    for number in 0..FRAMES {
        let stars: Vec<(PixelPoint, f64)> = (0..16)
            .map(|k| {
                let (u, v) = lattice(16 * number + k);
                let cell = |i: usize, jitter: f64| 40.0 * i as f64 + 12.0 + 15.0 * jitter;
                (PixelPoint::new(cell(k % 4, u), cell(k / 4, v)), FLUXES_E[(k + number) % FLUXES_E.len()])
            })
            .collect();
        let (u, v) = lattice(number);
        let truth: Rotation<CameraFrame, Icrs> =
            Rotation::from_rotation_vector(Vector3::new(3.0 * u, 3.0 * v, 1.0));
        let listed: Vec<ListedStar> = stars
            .iter()
            .zip(1..)
            .map(|((place, _), id)| {
                let centre = 0.5 * SIDE as f64;
                let ray = Vector3::new((place.x - centre) / FOCAL_PX, (place.y - centre) / FOCAL_PX, 1.0);
                let seen: Direction<CameraFrame> = Direction::from_vector(ray).unwrap();
                ListedStar { id, direction: truth.inverse() * seen, magnitude: 5.0 }
            })
            .collect();
        let raw = draw(&sensor, &PsfConfig::Gaussian { sigma_px: SIGMA_PX }, &stars, number as u64);
        let frame = downlink(&raw, 0, None).unwrap();
        for (mode, (_, config)) in modes.iter().enumerate() {
            let outcome = answer(config.clone(), &frame, &listed, truth);
            assert_eq!(outcome.n_stars, Some(16), "frame {number}");
            let error = (outcome.camera_from_icrs.unwrap() * truth.inverse()).quaternion().scaled_axis();
            across[mode].add(error.x);
            across[mode].add(error.y);
            roll[mode].add(error.z);
        }
        let covariance = attitude_bound(&stars, SIDE);
        bound_across += (covariance[(0, 0)] + covariance[(1, 1)]) / (2 * FRAMES) as f64;
        bound_roll += covariance[(2, 2)] / FRAMES as f64;
    }
    let (bound_across, bound_roll) = (bound_across.sqrt(), bound_roll.sqrt());
    for (mode, (name, _)) in modes.iter().enumerate() {
        println!(
            "{name}: across {:.2e} rad = {:.3} × bound, roll {:.2e} rad = {:.3} × bound",
            across[mode].rms(),
            across[mode].rms() / bound_across,
            roll[mode].rms(),
            roll[mode].rms() / bound_roll
        );
    }
    for (errors, bound) in [(&across[0], bound_across), (&roll[0], bound_roll)] {
        assert!(errors.rms() <= 1.1 * bound, "{} of {bound} rad", errors.rms());
        assert!(
            errors.rms() >= 0.93 * bound,
            "{} of {bound} rad: below the bound by more than chance",
            errors.rms()
        );
    }
    // The weights matter for stars of such different brightness: unweighted is far from the bound.
    assert!(across[1].rms() > 1.2 * bound_across && roll[1].rms() > 1.2 * bound_roll);
}

/// A target so bright that its core is saturated, and whose image the region of interest cuts at the bottom: the first pixel
/// met stands two rows below the region's top, nine rows are sent.
#[test]
fn a_saturated_image_cut_by_a_region_is_fitted_where_it_is() {
    let sensor = sensor(48, 48);
    let psf = PsfConfig::GaussianHalo { sigma_px: SIGMA_PX, halo_sigma_px: 4.0, halo_fraction: 0.03 };
    let regions = RoiConfig {
        count: 1,
        columns: 20,
        rows: 9,
        anchor_column: 10,
        anchor_row: 2,
        threshold_dn: 60,
        scan: ScanOrder::Rows,
    };
    let mut worst_before = 0.0_f64;
    for (i, electrons) in [3e5, 1e6, 3e6].into_iter().enumerate() {
        let (mut x, mut y, mut before) = (Errors::default(), Errors::default(), Errors::default());
        for k in 0..100 {
            let (u, v) = lattice(k);
            let place = PixelPoint::new(23.5 + u, 23.5 + v);
            let raw = draw(&sensor, &psf, &[(place, electrons)], (100 * i + k) as u64);
            let windows = RoiExtractor::new(&regions, 48, 48).unwrap().extract(&raw);
            let frame = downlink(&raw, 0, Some(windows)).unwrap();
            let centre = |centroid: CentroidConfig| {
                let config = FarRangeConfig { centroid, ..FarRangeConfig::default() };
                let outcome = answer(config, &frame, &[], Rotation::identity());
                // The target's cluster is the largest.
                outcome.clusters.iter().max_by(|a, b| a.size.total_cmp(&b.size)).unwrap().position
            };
            let fitted = centre(fit());
            x.add(fitted.x - place.x);
            y.add(fitted.y - place.y);
            before.add(centre(CentroidConfig::Brightness).y - place.y);
        }
        println!(
            "{electrons:e} e: fitted bias {:+.4}, {:+.4} px, RMS {:.4}, {:.4} px; brightness centre {:+.3} px",
            x.mean(),
            y.mean(),
            x.rms(),
            y.rms(),
            before.mean()
        );
        assert!(x.mean().abs() < 0.1 && y.mean().abs() < 0.1, "{electrons} e");
        assert!(x.rms() < 0.2 && y.rms() < 0.2, "{electrons} e");
        worst_before = worst_before.min(before.mean());
    }
    // What the fit wins back: the centre of what is left lies higher by more than a pixel.
    assert!(worst_before < -1.0, "{worst_before}");
}
