//! Cameras that are drawn at random, with images of their stars by a renderer of its own: Gaussians
//! integrated over the pixels, photon noise, read noise, hot pixels.

use boresight_camera_fit::adjustment::Term;
use boresight_camera_fit::{CameraFit, FirstGuess, FitError, Reading, SkyFrame, fit_camera};
use contract::{Camera, CameraFrame, Direction, Icrs, Rotation};
use files::{GreyImage, PixelConversion};
use hifitime::Epoch;
use nalgebra::{Quaternion, UnitQuaternion, Vector3};
use pipeline::CameraModel;
use sim::catalog::Catalog;
use sim::truth::{Observer, StarMotion};

/// Random numbers: SplitMix64 (Steele, Lea & Flood 2014) and Box & Muller.
struct Random(u64);

impl Random {
    fn uniform(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        ((z ^ (z >> 31)) >> 11) as f64 / (1u64 << 53) as f64 + 1e-17
    }

    fn normal(&mut self) -> f64 {
        let (u, v) = (self.uniform(), self.uniform());
        (-2.0 * libm::log(u)).sqrt() * libm::cos(std::f64::consts::TAU * v)
    }

    fn attitude(&mut self) -> Rotation<CameraFrame, Icrs> {
        let [w, x, y, z] = [(); 4].map(|()| self.normal());
        Rotation::from_unit_quaternion(UnitQuaternion::new_normalize(Quaternion::new(w, x, y, z)))
    }
}

fn time() -> Epoch {
    Epoch::from_gregorian_utc_at_midnight(2026, 3, 1)
}

/// Apparent directions and magnitudes of the stars at [`time`].
fn sky() -> Vec<(Direction<Icrs>, f64)> {
    let observer =
        Observer::new(time(), Vector3::zeros(), Vector3::zeros()).expect("a time of the ephemerides");
    let catalog = Catalog::hipparcos2();
    let stars = catalog.stars().iter().filter(|star| star.v_mag() < 10.0);
    stars.map(|star| (observer.apparent(&StarMotion::new(star)), star.v_mag())).collect()
}

/// A camera of a random field, with the first guess of its owner.
fn random_camera(random: &mut Random) -> (Camera, FirstGuess) {
    let (columns, rows) = (800, 600);
    let field_deg = libm::exp(libm::log(6.0) + random.uniform() * libm::log(30.0 / 6.0));
    let half_diagonal_px = 0.5 * libm::hypot(columns as f64, rows as f64);
    let focal_px = 0.5 * columns as f64 / libm::tan(0.5 * field_deg.to_radians());
    let camera = Camera {
        columns,
        rows,
        focal_length_mm: focal_px * 5e-3,
        pixel_width_um: 5.0,
        pixel_height_um: 5.0,
        principal_x_px: 399.5 + 8.0 * random.normal(),
        principal_y_px: 299.5 + 8.0 * random.normal(),
        radial: [0.02 * random.normal() / (half_diagonal_px * half_diagonal_px), 0.0, 0.0],
        tangential: [0.0; 2],
    };
    let guess = FirstGuess {
        field_deg: field_deg * (1.0 + 0.08 * (2.0 * random.uniform() - 1.0)),
        tolerance: 0.1,
        pixel_um: [5.0; 2],
        time: time(),
    };
    (camera, guess)
}

/// Electrons per frame of a star of V = 0, background and read noise, and width of a star.
const ZERO_MAGNITUDE_E: f64 = 4e7;
const BACKGROUND_E: f64 = 40.0;
const READ_NOISE_E: f64 = 8.0;
const SIGMA_PX: f64 = 0.9;

/// Draws an image of 12 bits with 2 electrons per digital number.
fn image(
    random: &mut Random,
    camera: &Camera,
    attitude: &Rotation<CameraFrame, Icrs>,
    sky: &[(Direction<Icrs>, f64)],
) -> GreyImage {
    let mut electrons = vec![BACKGROUND_E; camera.columns * camera.rows];
    let (fx, _) = camera.focal_length_px();
    let model = CameraModel::new(camera).expect("a possible camera");
    let reach = 1.5 * camera.columns as f64 / fx;
    for (direction, magnitude) in sky {
        let seen = attitude.rotate(direction.vector());
        if seen.z <= 0.0 || seen.x.abs() > reach * seen.z || seen.y.abs() > reach * seen.z {
            continue;
        }
        let Some(at) = model.project_vector(&seen) else { continue };
        let flux_e = ZERO_MAGNITUDE_E * libm::pow(10.0, -0.4 * magnitude);
        let share = |pixel: i64, centre: f64| {
            let edge = |x: f64| 0.5 * libm::erf((x - centre) / (SIGMA_PX * std::f64::consts::SQRT_2));
            edge(pixel as f64 + 0.5) - edge(pixel as f64 - 0.5)
        };
        for row in at.y as i64 - 6..=at.y as i64 + 6 {
            for column in at.x as i64 - 6..=at.x as i64 + 6 {
                if (0..camera.rows as i64).contains(&row) && (0..camera.columns as i64).contains(&column) {
                    electrons[row as usize * camera.columns + column as usize] +=
                        flux_e * share(column, at.x) * share(row, at.y);
                }
            }
        }
    }
    for _ in 0..20 {
        let pixel = (random.uniform() * electrons.len() as f64) as usize;
        electrons[pixel] += 3000.0 * random.uniform();
    }
    let mut values = Vec::with_capacity(electrons.len());
    for expected in electrons {
        let noisy = expected + (expected + READ_NOISE_E * READ_NOISE_E).sqrt() * random.normal();
        values.push((0.5 * noisy + 50.0).round().clamp(0.0, 4095.0) as f32);
    }
    let (columns, rows) = (camera.columns, camera.rows);
    GreyImage { columns, rows, values, full_scale: 4095.0, conversion: PixelConversion::None }
}

fn frames(
    random: &mut Random,
    camera: &Camera,
    sky: &[(Direction<Icrs>, f64)],
    count: usize,
) -> Vec<SkyFrame> {
    let mut frames = Vec::new();
    for number in 0..count {
        let attitude = random.attitude();
        let image = image(random, camera, &attitude, sky);
        frames.push(SkyFrame { name: format!("{number}.png"), image });
    }
    frames
}

/// Returns the error of a term over its standard deviation.
fn normalised_error(fit: &CameraFit, truth: &Camera, term: Term) -> f64 {
    let (_, sigma, _) = fit.sigmas.iter().find(|(found, _, _)| *found == term).expect("a free term");
    (term.parameter(&fit.camera) - term.parameter(truth)) / sigma
}

/// Twenty cameras of 6° to 30°, 1 to 6 frames each: errors agree with their standard deviations.
#[test]
fn random_cameras_are_found_within_their_errors() {
    let sky = sky();
    let mut random = Random(44);
    let (mut squares, mut count, mut beyond) = (0.0, 0, 0);
    for number in 0..20 {
        let (truth, guess) = random_camera(&mut random);
        let frames = frames(&mut random, &truth, &sky, 1 + number % 6);
        let fit = fit_camera(&frames, &guess).unwrap();
        assert!(fit.unsolved.is_empty(), "{:?} of {}°", fit.unsolved, guess.field_deg);
        let mut errors = Vec::new();
        for term in [Term::FocalLength, Term::PrincipalX, Term::PrincipalY, Term::Radial1] {
            let error = normalised_error(&fit, &truth, term);
            squares += error * error;
            count += 1;
            beyond += usize::from(error.abs() > 3.0);
            errors.push(error);
        }
        println!(
            "{:.1}° {} frames, {} stars, {} terms, rms {:.3} px, left out {:.3} px: {errors:.2?}",
            guess.field_deg,
            frames.len(),
            fit.stars,
            fit.sigmas.len(),
            fit.rms_px,
            fit.left_out_rms_px
        );
    }
    let nees = squares / f64::from(count);
    println!("NEES per dimension {nees:.2}, {beyond} of {count} beyond 3 σ");
    // 80 errors, correlated within a camera.
    assert!((0.6..1.5).contains(&nees) && beyond <= 2, "{nees} {beyond}");
}

/// Noise alone, a camera of another field, and images of different sizes have no camera.
#[test]
fn frames_without_a_camera_are_refused_with_the_reason() {
    let sky = sky();
    let mut random = Random(45);
    let (truth, guess) = random_camera(&mut random);
    assert!(matches!(fit_camera(&[], &guess), Err(FitError::NoFrames)));
    let dark = frames(&mut random, &truth, &[], 2);
    let Err(FitError::NoAttitude(unsolved)) = fit_camera(&dark, &guess) else { panic!() };
    assert_eq!(unsolved.len(), 2);
    let mut mixed = frames(&mut random, &truth, &sky, 1);
    mixed.push(SkyFrame {
        name: "small.png".to_owned(),
        image: GreyImage { columns: 64, rows: 64, values: vec![0.0; 4096], ..mixed[0].image.clone() },
    });
    let told = fit_camera(&mixed, &guess).unwrap_err().to_string();
    assert!(told.contains("small.png: is 64 × 64 pixels, expected 800 × 600"), "{told}");
    mixed.pop();
    // A mirrored image.
    let mut mirrored = mixed.clone();
    mirrored[0].image.values.chunks_exact_mut(800).for_each(<[f32]>::reverse);
    let reading = |frames: &[SkyFrame]| match fit_camera(frames, &guess) {
        Err(FitError::Reading { name, reading }) => Some((name, reading)),
        _ => None,
    };
    assert_eq!(reading(&mirrored), Some(("0.png".to_owned(), Reading::Mirrored)));
    let mut negative = mixed.clone();
    negative[0].image.values.iter_mut().for_each(|value| *value = 4095.0 - *value);
    assert_eq!(reading(&negative), Some(("0.png".to_owned(), Reading::Negative)));
    let mut swapped = mixed.clone();
    let swap = |value: &mut f32| *value = f32::from((*value as u16).swap_bytes());
    swapped[0].image.values.iter_mut().for_each(swap);
    assert_eq!(reading(&swapped), Some(("0.png".to_owned(), Reading::BytesSwapped)));
    let narrow = FirstGuess { field_deg: 0.5 * guess.field_deg, ..guess };
    assert!(matches!(fit_camera(&mixed, &narrow), Err(FitError::NoAttitude(_))));
}

/// Frames of a camera with another focal length or another distortion are left out by name, and do not change
/// the camera of the others.
#[test]
fn frames_of_another_camera_are_left_out() {
    let sky = sky();
    let mut random = Random(46);
    let (truth, guess) = random_camera(&mut random);
    let alone = frames(&mut random, &truth, &sky, 3);
    let longer = Camera { focal_length_mm: 1.02 * truth.focal_length_mm, ..truth.clone() };
    // 3 % more at half the diagonal of 500 px.
    let bent = Camera { radial: [truth.radial[0] + 0.03 / 250_000.0, 0.0, 0.0], ..truth.clone() };
    for (other, part) in
        [(longer, "its own focal length is"), (bent, "do not fit the camera of the other frames")]
    {
        let mut mixed = alone.clone();
        let mut strange = frames(&mut random, &other, &sky, 1);
        strange[0].name = "strange.png".to_owned();
        mixed.insert(1, strange.remove(0));
        let fit = fit_camera(&mixed, &guess).unwrap();
        assert_eq!((fit.frames.len(), fit.other_cameras), (3, 1));
        let [left_out] = &fit.unsolved[..] else { panic!("{:?}", fit.unsolved) };
        assert!(left_out.name == "strange.png" && left_out.reason.contains(part), "{left_out:?}");
        assert!(normalised_error(&fit, &truth, Term::FocalLength).abs() < 4.0);
        assert!(fit.epoch.is_some_and(|epoch| !epoch.is_contradiction()), "{:?}", fit.epoch);
    }
}
