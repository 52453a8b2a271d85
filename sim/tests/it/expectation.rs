//! The noise-free expected image holds the electrons of the truth table, and the frames scatter about it as
//! expected.

use boresight_sim::Simulation;
use boresight_sim::catalog::CatalogConfig;
use boresight_sim::onboard::ShutterConfig;
use boresight_sim::optics::PsfConfig;
use boresight_sim::sensor::Switch;
use boresight_sim::truth::ObjectKind;

use crate::small_scene::{restless, simulator, still};

#[test]
fn the_expected_image_holds_the_electrons_of_the_truth_table_and_the_flat_level() {
    // Without a magnitude limit, with an exposure of a hundredth of a second: objects of less than one
    // electron.
    let faint = Simulation {
        catalog: CatalogConfig::default(),
        shutter: ShutterConfig::Fixed { exposure_s: 0.01 },
        ..still()
    };
    for simulation in [still(), restless(), faint] {
        let simulator = simulator(&simulation);
        let mut camera = simulator.camera().unwrap();
        for frame in 0..20 {
            let exposure = camera.expose(frame).unwrap();
            let image = camera.expected();
            let flat_e = (60.0 + 40.0) * exposure.truth.exposure_s;
            assert!((image.flat_e() / flat_e - 1.0).abs() < 1e-14);
            let in_image: f64 = image.signal().iter().sum();
            let in_table: f64 = exposure.objects.iter().map(|object| object.electrons).sum();
            // Some thousand positive numbers are added in two different orders, with an error of 1e-13. An
            // omitted star would be detected.
            assert!((in_image / in_table - 1.0).abs() < 1e-9, "frame {frame}: {in_image} and {in_table} e⁻");
            let faintest = exposure.objects.iter().map(|o| o.electrons).fold(f64::INFINITY, f64::min);
            assert!(faintest > 1e-8 * in_table, "the tolerance would hide an object of {faintest} e⁻");
        }
    }
}

/// A camera fixed in the orbital frame rotates. The image of a star is smeared along its path, more for a
/// longer exposure, and its position in the table is the centroid of the signal in the image.
#[test]
fn motion_during_the_exposure_smears_stars_about_their_position_in_the_table() {
    let exposed = |exposure_s: f64, motion_smear: Switch| {
        let mut simulation = Simulation {
            shutter: ShutterConfig::Fixed { exposure_s },
            psf: PsfConfig::Gaussian { sigma_px: 0.8 },
            roi: None,
            ..restless()
        };
        simulation.attitude.motion_smear = motion_smear;
        simulation.sensor.hot_pixels.count = 0;
        let simulator = simulator(&simulation);
        let mut camera = simulator.camera().unwrap();
        let objects = camera.expose(3).unwrap().objects;
        let star = objects
            .iter()
            .filter(|o| o.kind == ObjectKind::Star)
            .filter(|o| (20.0..140.0).contains(&o.position.x) && (20.0..100.0).contains(&o.position.y))
            .max_by(|a, b| a.electrons.total_cmp(&b.electrons))
            .unwrap()
            .clone();
        // Centroid and variance along the rows, in a window without any other object of this brightness.
        let image = camera.expected();
        let (mut sum, mut first, mut second) = (0.0, 0.0, 0.0);
        for y in star.position.y as usize - 8..star.position.y as usize + 9 {
            for x in star.position.x as usize - 12..star.position.x as usize + 13 {
                let signal = image.electrons_at(x, y) - image.flat_e();
                sum += signal;
                first += signal * x as f64;
                second += signal * (x as f64 - star.position.x) * (x as f64 - star.position.x);
            }
        }
        (star, first / sum, second / sum)
    };
    let (_, _, still_px2) = exposed(1.0, Switch::Off);
    let (star, centroid, smeared_px2) = exposed(1.0, Switch::On);
    // Faint neighbours shift the centroid by some hundredths of a pixel.
    assert!((centroid - star.position.x).abs() < 0.05, "{centroid} and {}", star.position.x);
    // The orbital rate, 0.0602 °/s, is 2.46 px/s along the rows: a uniform trail of length L with variance
    // L²/12.
    let trail_px2 = 2.46 * 2.46 / 12.0;
    assert!((smeared_px2 - still_px2 - trail_px2).abs() < 0.05, "{smeared_px2} − {still_px2} px²");
}

const SEEDS: u64 = 5;
const FRAMES: u64 = 40;
/// Five standard deviations: exceeded by chance in one of 1.7 million tests; there are about ten tests here,
/// and the seeds are fixed.
const FIVE_SIGMA: f64 = 5.0;

/// Deviations of digital numbers from their expectation, over all frames of all seeds.
struct Scatter {
    /// For each pixel: sum of the deviations, sum of their variances, and mean signal above the flat level,
    /// e⁻.
    pixels: Vec<(f64, f64, f64)>,
    /// Products of normalised deviations: with the pixel to the right, with the pixel below, and with the
    /// same pixel one frame later.
    products: [Products; 3],
}

/// Sum of products of two independent numbers of unit variance.
#[derive(Default, Clone, Copy)]
struct Products {
    sum: f64,
    count: f64,
}

impl Products {
    fn add(&mut self, a: f64, b: f64) {
        self.sum += a * b;
        self.count += 1.0;
    }

    fn sigmas(self) -> f64 {
        self.sum / self.count.sqrt()
    }
}

/// Collects the deviations; `error_e` is added to every expected value as a planted fault.
fn scatter(simulation: &Simulation, error_e: f64) -> Scatter {
    let (columns, rows) = (simulation.camera.columns, simulation.camera.rows);
    let sensor = &simulation.sensor;
    let mut scatter =
        Scatter { pixels: vec![(0.0, 0.0, 0.0); columns * rows], products: [Products::default(); 3] };
    for seed in 0..SEEDS {
        let simulator = simulator(&Simulation { seed, ..simulation.clone() });
        let mut camera = simulator.camera().unwrap();
        let mut before: Option<Vec<f64>> = None;
        for frame in 0..FRAMES {
            let exposure = camera.expose(frame).unwrap();
            let image = camera.expected();
            let mut normalised = Vec::with_capacity(columns * rows);
            for ((expected_e, dn), pixel) in image.iter().zip(exposure.frame.dn()).zip(&mut scatter.pixels) {
                // Clipping at the full well or at the end of the converter's range would distort the
                // distribution.
                assert!(expected_e < 0.7 * sensor.saturation_e());
                let mean_dn = sensor.bias_dn + (expected_e + error_e) / sensor.gain_e_per_dn;
                let gain2 = sensor.gain_e_per_dn * sensor.gain_e_per_dn;
                // Poisson noise, read noise, and the converter's rounding (Sheppard).
                let variance = (expected_e + sensor.read_noise_e * sensor.read_noise_e) / gain2 + 1.0 / 12.0;
                let deviation = f64::from(*dn) - mean_dn;
                pixel.0 += deviation;
                pixel.1 += variance;
                pixel.2 += (expected_e - image.flat_e()) / (SEEDS * FRAMES) as f64;
                normalised.push(deviation / variance.sqrt());
            }
            for (i, &z) in normalised.iter().enumerate() {
                if i % columns + 1 < columns {
                    scatter.products[0].add(z, normalised[i + 1]);
                }
                if let Some(&below) = normalised.get(i + columns) {
                    scatter.products[1].add(z, below);
                }
                if let Some(before) = &before {
                    scatter.products[2].add(z, before[i]);
                }
            }
            before = Some(normalised);
        }
    }
    scatter
}

/// Returns the deviation of the mean of all pixels within a range of signal, in standard deviations, and the
/// number of these pixels.
fn mean_of(scatter: &Scatter, signal_e: std::ops::RangeInclusive<f64>) -> (f64, usize) {
    let chosen = || scatter.pixels.iter().filter(|(_, _, signal)| signal_e.contains(signal));
    let (sum, variance) =
        chosen().fold((0.0, 0.0), |(sum, variance), pixel| (sum + pixel.0, variance + pixel.1));
    (sum / variance.sqrt(), chosen().count())
}

#[test]
fn two_hundred_frames_agree_with_their_expectation() {
    use statrs::distribution::{ContinuousCDF, Normal};
    let scatter = scatter(&still(), 0.0);
    let z: Vec<f64> = scatter.pixels.iter().map(|(sum, variance, _)| sum / variance.sqrt()).collect();
    let n = z.len() as f64;

    // Each pixel separately, with Bonferroni correction: probability 1e-4 over all pixels.
    let limit = Normal::new(0.0, 1.0).unwrap().inverse_cdf(1.0 - 0.5e-4 / n);
    let worst = z.iter().fold(0.0_f64, |worst, z| worst.max(z.abs()));
    assert!(worst < limit, "a pixel is off by {worst} standard deviations, allowed {limit}");

    // All pixels together: chi-square has mean n and variance 2n.
    let chi2: f64 = z.iter().map(|z| z * z).sum();
    assert!(((chi2 - n) / (2.0 * n).sqrt()).abs() < FIVE_SIGMA, "chi-square of {chi2} for {n} pixels");

    // Each method of drawing a pixel: from the table, from the table with some additional electrons, from the
    // sampler; and the brightest pixels, which are the most sensitive to an error of the gain.
    for (signal_e, at_least) in [(0.0..=0.0, 2000), (1e-9..=4.0, 2000), (4.0..=1e6, 200), (1000.0..=1e6, 10)]
    {
        let (sigmas, count) = mean_of(&scatter, signal_e.clone());
        assert!(count > at_least, "{count} pixels of {signal_e:?} e⁻");
        assert!(sigmas.abs() < FIVE_SIGMA, "{count} pixels of {signal_e:?} e⁻: {sigmas} standard deviations");
    }
}

#[test]
fn the_noise_of_neighbours_in_space_and_time_is_independent() {
    for (products, neighbour) in scatter(&still(), 0.0).products.into_iter().zip(["right", "below", "later"])
    {
        assert!(
            products.sigmas().abs() < FIVE_SIGMA,
            "{neighbour}: {} standard deviations",
            products.sigmas()
        );
    }
}

/// Null control: a fault that the preceding test must detect. A tenth of an electron is a hundredth of a
/// digital number.
#[test]
fn saboteur_a_tenth_of_an_electron_too_much_is_seen() {
    let (sigmas, _) = mean_of(&scatter(&still(), 0.1), 0.0..=0.0);
    assert!(sigmas < -FIVE_SIGMA, "{sigmas}");
}
