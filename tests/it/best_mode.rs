//! The best mode compared with the Cramér–Rao bound: centroid and covariance of the target, attitude, and
//! saturated and truncated images. The bounds are computed here, from an independent Gaussian integrated over
//! pixels.

use contract::{
    AttitudeKnowledge, AttitudeSource, Calibration, Camera, CameraFrame, Direction, Frame, Icrs, ListedStar,
    Outcome, Pipeline, PixelPoint, PsfCalibration, Readout, Rotation, Setup, TargetCalibration, Telemetry,
};
use draws::Seed;
use hifitime::{Duration, Epoch};
use nalgebra::{Matrix2x3, Matrix3, Matrix4, Vector3, Vector4};
use pipeline::far_range::{AberrationConfig, BestConfig, FarRangeConfig, FarRangePipeline};
use sim::onboard::{RoiConfig, RoiExtractor, ScanOrder, downlink};
use sim::optics::{Psf, PsfConfig, Stamp};
use sim::sensor::{BloomingConfig, ExposureInterval, FrameCharge, RawImage, Sensor, SensorConfig};

const SIGMA_PX: f64 = 0.8;
const BACKGROUND_E: f64 = 20.0;
const GAIN_E_PER_DN: f64 = 10.0;
const READ_NOISE_E: f64 = 15.0;
const BIAS_DN: f64 = 40.3;
const FOCAL_PX: f64 = 2000.0;
const ZERO_MAGNITUDE_E_PER_S: f64 = 1.5e6;

/// Coordinates of a lattice of phases and positions: the fractional parts of multiples of the powers of the
/// plastic number's inverse fill the square evenly (Roberts 2018).
fn lattice(k: usize) -> (f64, f64) {
    let fraction = |v: f64| v - v.floor();
    (fraction(0.754_877_666_246_692_7 * k as f64), fraction(0.569_840_290_998_053_2 * k as f64))
}

fn sensor(columns: usize, rows: usize, spill_fraction: Option<f64>) -> Sensor {
    let config = SensorConfig {
        blooming: spill_fraction.map(|spill_fraction| BloomingConfig { spill_fraction }),
        bit_depth: 12,
        gain_e_per_dn: GAIN_E_PER_DN,
        bias_dn: BIAS_DN,
        full_well_e: 60_000.0,
        read_noise_e: READ_NOISE_E,
        ..SensorConfig::default()
    };
    Sensor::new(&config, columns, rows).unwrap()
}

/// Draws point sources, given by position and electrons, with the noise of a frame.
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
    let charge = sensor.collect(&mut image, &ExposureInterval { seed, middle_s: 0.0, exposure_s: 0.25 });
    let collected = FrameCharge { charge: &charge, seed, frame: number };
    sensor.read_out(&collected, &mut sensor.new_sampler(), &mut raw).unwrap();
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

/// Best mode for a sky without aberration, with a point-spread function known to a thousandth and stars
/// exactly at their listed positions.
fn best() -> FarRangeConfig {
    FarRangeConfig {
        aberration: AberrationConfig::Ignore,
        best: BestConfig {
            star_floor_px: 0.0,
            psf_width_error: 0.001,
            max_stars: 100,
            // A single frame rarely shows that an object is no star; these tests are about its image.
            min_log_odds: -100.0,
            ..BestConfig::default()
        },
        ..FarRangeConfig::default()
    }
}

fn calibration(halo_fraction: f64, spill_fraction: f64) -> Calibration {
    Calibration {
        psf: Some(PsfCalibration { sigma_px: SIGMA_PX, halo_sigma_px: 4.0, halo_fraction }),
        full_well_e: Some(60_000.0),
        spill_fraction: Some(spill_fraction),
        response_sigma: Some(0.0),
        zero_magnitude_e_per_s: Some(ZERO_MAGNITUDE_E_PER_S),
        // A point target.
        target: Some(TargetCalibration { radius_m: 0.0, e_per_s_at_1_km: 1e9 }),
        attitude: None,
    }
}

/// Creates a pipeline for frames of a given size.
fn pipeline(
    config: FarRangeConfig,
    calibration: Calibration,
    (columns, rows): (usize, usize),
    stars: &[ListedStar],
) -> FarRangePipeline {
    let setup = Setup {
        camera: camera(columns, rows),
        camera_from_body: Rotation::identity(),
        bit_depth: 12,
        readout: Some(Readout {
            gain_e_per_dn: GAIN_E_PER_DN,
            bias_dn: BIAS_DN,
            read_noise_e: READ_NOISE_E,
            saturation_dn: 4095,
        }),
        calibration,
        zero_suppression_dn: None,
        stars: stars.to_vec(),
    };
    FarRangePipeline::new(config, &setup).unwrap()
}

fn telemetry(time_s: f64, truth: Rotation<CameraFrame, Icrs>) -> Telemetry {
    Telemetry {
        time: Epoch::from_gregorian_utc_at_midnight(2012, 4, 25) + Duration::from_seconds(time_s),
        exposure_s: 0.25,
        body_from_icrs: Rotation::from_unit_quaternion(*truth.quaternion()),
        velocity_km_s: None,
    }
}

/// Outcome of a new pipeline for one frame.
fn answer(
    calibration: Calibration,
    frame: &Frame,
    stars: &[ListedStar],
    truth: Rotation<CameraFrame, Icrs>,
) -> Outcome {
    pipeline(best(), calibration, (frame.columns(), frame.rows()), stars)
        .process(frame, &telemetry(0.0, truth))
}

/// Half the side of the square of pixels used for a bound: all pixels with any information.
const BOUND_REACH_PX: i64 = 8;

/// Cramér–Rao bound of a star's centre: variances along x and y, px², with flux and background also unknown.
/// The variance of a pixel is its expected electrons + read noise² + gain²/12 for the rounding.
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

/// A point source on an empty sky, 2,048 draws per brightness: the uncertainty of their RMS is 1.6 %.
#[test]
fn the_centroid_of_a_whole_target_reaches_the_cramer_rao_bound() {
    const SIDE: usize = 40;
    const DRAWS: usize = 2048;
    let sensor = sensor(SIDE, SIDE, None);
    let psf = PsfConfig::Gaussian { sigma_px: SIGMA_PX };
    println!("electrons  bound/px   RMS/bound x, y     bias/px x, y        NEES");
    for (i, electrons) in [3000.0, 5000.0, 15_000.0, 50_000.0, 150_000.0].into_iter().enumerate() {
        let (mut x, mut y, mut nees) = (Errors::default(), Errors::default(), Errors::default());
        let (mut bound_x, mut bound_y) = (0.0, 0.0);
        for k in 0..DRAWS {
            let (u, v) = lattice(k);
            let place = PixelPoint::new(19.0 + u, 19.0 + v);
            let raw = draw(&sensor, &psf, &[(place, electrons)], (DRAWS * i + k) as u64);
            let frame = downlink(&raw, 0, None).unwrap();
            let outcome = answer(calibration(0.0, 0.0), &frame, &[], Rotation::identity());
            let found =
                outcome.measurement().unwrap_or_else(|| panic!("{electrons} e, draw {k}: {outcome:?}"));
            let error = [found.position.x - place.x, found.position.y - place.y];
            x.add(error[0]);
            y.add(error[1]);
            nees.add(0.5 * found.position_covariance.unwrap().mahalanobis_squared(error));
            // Every sixteenth phase suffices for the mean of a smooth function of the phase.
            if k % 16 == 0 {
                let (variance_x, variance_y) = bound(place, electrons);
                bound_x += variance_x / (DRAWS / 16) as f64;
                bound_y += variance_y / (DRAWS / 16) as f64;
            }
        }
        let (bound_x, bound_y) = (bound_x.sqrt(), bound_y.sqrt());
        println!(
            "{electrons:9}  {bound_x:.5}    {:.4}, {:.4}     {:+.5}, {:+.5}   {:.3}",
            x.rms() / bound_x,
            y.rms() / bound_y,
            x.mean(),
            y.mean(),
            nees.mean(),
        );
        for (errors, bound) in [(&x, bound_x), (&y, bound_y)] {
            assert!(errors.rms() <= 1.1 * bound, "{electrons} e: {} of {bound} px", errors.rms());
            // A value below the bound by more than chance (3 × 1.6 %) would indicate a wrong bound.
            assert!(errors.rms() >= 0.95 * bound, "{electrons} e: {} of {bound} px", errors.rms());
            assert!(errors.mean().abs() <= 0.003, "{electrons} e: bias {} px", errors.mean());
        }
        // χ² with two degrees of freedom, divided by two: the uncertainty of a mean of 2,048 is 2.2 %.
        assert!((0.85..1.15).contains(&nees.mean()), "{electrons} e: NEES {}", nees.mean());
    }
}

fn pixel(seen: &Vector3<f64>, side: usize) -> PixelPoint {
    let centre = 0.5 * side as f64;
    PixelPoint::new(centre + FOCAL_PX * seen.x / seen.z, centre + FOCAL_PX * seen.y / seen.z)
}

/// Bound of an attitude from stars: covariance of a small rotation about the camera's axes, rad².
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

/// Side of the images of star fields, px.
const FIELD_SIDE: usize = 160;

/// Sixteen stars, one in each cell of a grid, which keeps them from merging; with an attitude, and a list of
/// the stars at these positions.
fn star_grid(number: usize) -> StarField {
    const FLUXES_E: [f64; 5] = [3000.0, 6000.0, 15_000.0, 40_000.0, 120_000.0];
    let star = |k: usize| {
        let (u, v) = lattice(16 * number + k);
        let cell = |i: usize, jitter: f64| 40.0 * i as f64 + 12.0 + 15.0 * jitter;
        (PixelPoint::new(cell(k % 4, u), cell(k / 4, v)), FLUXES_E[(k + number) % FLUXES_E.len()])
    };
    StarField::from_stars((0..16).map(star).collect(), number)
}

/// Twenty stars at random positions with random fluxes, N(> F) ∝ F^−1.2.
fn random_stars(number: usize) -> StarField {
    // SplitMix64 (Steele, Lea & Flood 2014).
    let uniform = |i: usize| {
        let mut z = (20 * number as u64 * 3 + i as u64).wrapping_mul(0x9e37_79b9_7f4a_7c15);
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 / (1_u64 << 53) as f64
    };
    let star = |k: usize| {
        let [x, y, flux] = [0, 1, 2].map(|i| uniform(3 * k + i));
        let place = PixelPoint::new(FIELD_SIDE as f64 * x, FIELD_SIDE as f64 * y);
        (place, 2500.0 * libm::pow(flux, -1.0 / 1.2))
    };
    StarField::from_stars((0..20).map(star).collect(), number)
}

struct StarField {
    /// Position and electrons of each star.
    stars: Vec<(PixelPoint, f64)>,
    camera_from_icrs: Rotation<CameraFrame, Icrs>,
    /// List of the stars at these positions.
    listed: Vec<ListedStar>,
}

impl StarField {
    fn from_stars(stars: Vec<(PixelPoint, f64)>, number: usize) -> Self {
        let (u, v) = lattice(number);
        let camera_from_icrs = Rotation::from_rotation_vector(Vector3::new(3.0 * u, 3.0 * v, 1.0));
        let listed = |((place, electrons), id): (&(PixelPoint, f64), u32)| {
            let centre = 0.5 * FIELD_SIDE as f64;
            let ray = Vector3::new((place.x - centre) / FOCAL_PX, (place.y - centre) / FOCAL_PX, 1.0);
            let seen: Direction<CameraFrame> = Direction::from_vector(ray).unwrap();
            let magnitude = -2.5 * libm::log10(electrons / (0.25 * ZERO_MAGNITUDE_E_PER_S));
            ListedStar { id, direction: camera_from_icrs.inverse() * seen, magnitude }
        };
        let listed = stars.iter().zip(1..).map(listed).collect();
        Self { stars, camera_from_icrs, listed }
    }
}

/// Sixteen stars per frame, 1000 frames: the uncertainty of the RMS is 1.6 % across the boresight, and 2.2 %
/// about it.
#[test]
fn the_weighted_attitude_reaches_the_cramer_rao_bound() {
    const FRAMES: usize = 1000;
    let sensor = sensor(FIELD_SIDE, FIELD_SIDE, None);
    let (mut across, mut roll) = (Errors::default(), Errors::default());
    let (mut bound_across, mut bound_roll) = (0.0, 0.0);
    for number in 0..FRAMES {
        let StarField { stars, camera_from_icrs: truth, listed } = star_grid(number);
        let raw = draw(&sensor, &PsfConfig::Gaussian { sigma_px: SIGMA_PX }, &stars, number as u64);
        let frame = downlink(&raw, 0, None).unwrap();
        let outcome = answer(calibration(0.0, 0.0), &frame, &listed, truth);
        assert_eq!(outcome.n_stars, Some(16), "frame {number}");
        let error = (outcome.camera_from_icrs.unwrap() * truth.inverse()).quaternion().scaled_axis();
        across.add(error.x);
        across.add(error.y);
        roll.add(error.z);
        let covariance = attitude_bound(&stars, FIELD_SIDE);
        bound_across += (covariance[(0, 0)] + covariance[(1, 1)]) / (2 * FRAMES) as f64;
        bound_roll += covariance[(2, 2)] / FRAMES as f64;
    }
    let (bound_across, bound_roll) = (bound_across.sqrt(), bound_roll.sqrt());
    println!(
        "across {:.2e} rad = {:.3} × bound, roll {:.2e} rad = {:.3} × bound",
        across.rms(),
        across.rms() / bound_across,
        roll.rms(),
        roll.rms() / bound_roll
    );
    for (errors, bound) in [(&across, bound_across), (&roll, bound_roll)] {
        assert!(errors.rms() <= 1.1 * bound, "{} of {bound} rad", errors.rms());
        assert!(
            errors.rms() >= 0.93 * bound,
            "{} of {bound} rad: below the bound by more than chance",
            errors.rms()
        );
    }
}

/// Telemetry with an error of a multiple of the σ in the calibration: by chance, some of the twenty stars lie
/// at the expected positions of others.
#[test]
fn a_prior_beyond_its_sigma_gives_no_false_attitude() {
    const FRAMES: usize = 400;
    let sensor = sensor(FIELD_SIDE, FIELD_SIDE, None);
    let arcsec = |radians: f64| radians.to_degrees() * 3600.0;
    // 6 px instead of the required 30 px.
    let sigma = [0.0, 0.0, 0.0].map(|_: f64| arcsec(6.0 / FOCAL_PX));
    let attitude = AttitudeKnowledge {
        white_arcsec: sigma,
        slow_arcsec: [1.0; 3],
        slow_period_s: 1000.0,
        constant_arcsec: [1.0; 3],
    };
    let (mut wrong, mut right, mut refused) = (0, 0, 0);
    for number in 0..FRAMES {
        let StarField { stars, camera_from_icrs: truth, listed } = random_stars(number);
        let raw = draw(&sensor, &PsfConfig::Gaussian { sigma_px: SIGMA_PX }, &stars, number as u64);
        let frame = downlink(&raw, 0, None).unwrap();
        let off = Rotation::from_rotation_vector(Vector3::new(40.0 / FOCAL_PX, -35.0 / FOCAL_PX, 0.0));
        let calibration = Calibration { attitude: Some(attitude), ..calibration(0.0, 0.0) };
        let outcome = answer(calibration, &frame, &listed, off * truth);
        // Without a match many listed stars lack their image, and no attitude is stated.
        let error = outcome.camera_from_icrs.map(|found| (found * truth.inverse()).quaternion().angle());
        match outcome.attitude_source {
            Some(AttitudeSource::Stars) if error.unwrap() < 0.5 / FOCAL_PX => right += 1,
            Some(AttitudeSource::Stars) => wrong += 1,
            _ => refused += 1,
        }
    }
    println!("off beyond the search: {right} right, {wrong} wrong, {refused} refused of {FRAMES}");
    assert!(100 * wrong <= FRAMES, "{wrong} of {FRAMES}");
}

/// A target so bright that its core is saturated, with an image that the region of interest truncates at the
/// bottom: the first pixel found is two rows below the region's top, and nine rows are transmitted. Without
/// and with wells that spill along the columns.
#[test]
fn a_saturated_image_cut_by_a_region_is_fitted_where_it_is() {
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
    for (case, spill_fraction) in [None, Some(1.0)].into_iter().enumerate() {
        let sensor = sensor(64, 64, spill_fraction);
        for (i, electrons) in [3e5, 1e6, 2e6].into_iter().enumerate() {
            let (mut x, mut y, mut nees) = (Errors::default(), Errors::default(), Errors::default());
            for k in 0..200 {
                let (u, v) = lattice(k);
                let place = PixelPoint::new(31.5 + u, 31.5 + v);
                let raw = draw(&sensor, &psf, &[(place, electrons)], (1000 * case + 200 * i + k) as u64);
                let windows = RoiExtractor::new(&regions, 64, 64).unwrap().extract(&raw);
                let frame = downlink(&raw, 0, Some(windows)).unwrap();
                let outcome = answer(
                    calibration(0.03, spill_fraction.unwrap_or(0.0)),
                    &frame,
                    &[],
                    Rotation::identity(),
                );
                let found = outcome.measurement().unwrap();
                let error = [found.position.x - place.x, found.position.y - place.y];
                x.add(error[0]);
                y.add(error[1]);
                nees.add(0.5 * found.position_covariance.unwrap().mahalanobis_squared(error));
            }
            println!(
                "{electrons:e} e, spilt {spill_fraction:?}: bias {:+.4}, {:+.4} px, RMS {:.4}, {:.4} px, NEES {:.2}",
                x.mean(),
                y.mean(),
                x.rms(),
                y.rms(),
                nees.mean()
            );
            assert!(x.mean().abs() < 0.01 && y.mean().abs() < 0.02, "{electrons} e");
            assert!(x.rms() < 0.02 && y.rms() < 0.1, "{electrons} e");
            assert!((0.7..1.3).contains(&nees.mean()), "{electrons} e: NEES {}", nees.mean());
        }
    }
}

/// Errors, px, of the outcomes for a sequence of frames every ten seconds, for a point that moves by half a
/// pixel per frame; infinite where there is no measurement.
fn sequence(electrons: impl Fn(usize) -> f64, frames: usize, number: u64) -> Vec<f64> {
    const SIDE: usize = 160;
    let sensor = sensor(SIDE, SIDE, None);
    let mut config = best();
    config.best.min_log_odds = BestConfig::default().min_log_odds;
    let mut pipeline = pipeline(config, calibration(0.0, 0.0), (SIDE, SIDE), &[]);
    let of_frame = |frame: usize| {
        let place = PixelPoint::new(60.2 + 0.5 * frame as f64, 80.7 - 0.25 * frame as f64);
        let points = [(place, electrons(frame))];
        let raw = draw(&sensor, &PsfConfig::Gaussian { sigma_px: SIGMA_PX }, &points, number + frame as u64);
        let image = downlink(&raw, frame as u64, None).unwrap();
        let outcome = pipeline.process(&image, &telemetry(10.0 * frame as f64, Rotation::identity()));
        outcome.measurement().map_or(f64::INFINITY, |found| found.position.distance(place))
    };
    (0..frames).map(of_frame).collect()
}

/// Electrons of a point source with this signal-to-noise ratio against the background, by a matched filter.
fn electrons_of(snr: f64) -> f64 {
    let pixel_e = (BACKGROUND_E + READ_NOISE_E * READ_NOISE_E + GAIN_E_PER_DN * GAIN_E_PER_DN / 12.0).sqrt();
    // Norm of a Gaussian over pixels: 1/(2 σ √π), with the variance of a pixel added to that of the Gaussian.
    let sigma_px = (SIGMA_PX * SIGMA_PX + 1.0 / 12.0).sqrt();
    snr * pixel_e * 2.0 * sigma_px * std::f64::consts::PI.sqrt()
}

/// No pixel of these targets exceeds the background by six standard deviations, as a cluster requires.
#[test]
fn frames_are_added_up_until_a_faint_target_is_found() {
    for (snr, least_correct) in [(5.0, 0.85), (6.0, 0.95)] {
        let (mut correct, mut wrong, mut n) = (0, 0, 0);
        for run in 0..10 {
            let errors = sequence(|_| electrons_of(snr), 50, 10_000 * (snr as u64) + 100 * run);
            let settled = &errors[12..];
            n += settled.len();
            correct += settled.iter().filter(|error| **error < 1.5).count();
            wrong += settled.iter().filter(|error| error.is_finite() && **error >= 1.5).count();
        }
        println!("SNR {snr}: correct {correct}, wrong {wrong} of {n} frames from the twelfth on");
        assert!(
            correct as f64 >= least_correct * n as f64 && wrong * 50 <= n,
            "SNR {snr}: {correct}, {wrong} of {n}"
        );
    }
}

#[test]
fn a_fading_target_is_followed_below_the_detection_limit_of_a_frame() {
    let (mut correct, mut wrong, mut n) = (0, 0, 0);
    for run in 0..10 {
        // From a signal-to-noise ratio of 15 to 3 in twenty frames.
        let snr = |frame: usize| (15.0 - 0.6 * frame as f64).max(3.0);
        let errors = sequence(|frame| electrons_of(snr(frame)), 60, 200_000 + 100 * run);
        let faint = &errors[20..];
        n += faint.len();
        correct += faint.iter().filter(|error| **error < 1.5).count();
        wrong += faint.iter().filter(|error| error.is_finite() && **error >= 1.5).count();
    }
    println!("SNR 3: correct {correct}, wrong {wrong} of {n} frames");
    assert!(correct * 10 >= 7 * n && wrong * 50 <= n, "{correct}, {wrong} of {n}");
}

#[test]
fn noise_alone_is_no_target() {
    let answered: usize = (0..5)
        .flat_map(|run| sequence(|_| 0.0, 60, 300_000 + 100 * run))
        .filter(|error| error.is_finite())
        .count();
    println!("{answered} answers to 300 frames of noise");
    assert!(answered <= 6, "{answered}");
}
