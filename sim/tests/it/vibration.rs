//! Vibration within an exposure: a blur that equals the sum of exposures at many attitudes.

use std::f64::consts::PI;

use boresight_sim::draw::ExpectedImage;
use boresight_sim::optics::RadiometryConfig;
use boresight_sim::truth::{ObjectKind, ObjectTruth};
use boresight_sim::{Exposure, Simulation, Simulator};
use contract::Mounting;

use crate::small_scene::{simulator, still};

const COLUMNS: usize = 160;

/// Vibration about x, y and z, arcsec: 0.7 px, 1.2 px, and 1.5 px at the edge.
const VIBRATION_ARCSEC: [f64; 3] = [60.0, 100.0, 4000.0];

/// Positive nodes of the rule of Gauss and Hermite with ten points, and their weights (Abramowitz & Stegun,
/// table 25.10): integrals over exp(−x²).
const NODES: [(f64, f64); 5] = [
    (0.342_901_327_223_704_6, 0.610_862_633_735_325_8),
    (1.036_610_829_789_514, 0.240_138_611_082_314_7),
    (1.756_683_649_299_882, 0.033_874_394_455_481_06),
    (2.532_731_674_232_79, 0.001_343_645_746_781_233),
    (3.436_159_118_837_738, 7.640_432_855_232_62e-6),
];

/// The small scene in a stronger light, in which the floor of a stamp cuts off no visible part of it.
fn scene() -> Simulation {
    let mut simulation = still();
    simulation.radiometry = RadiometryConfig::ZeroPoint { zero_point_e_per_s: 1.5e8, colour_term: 0.0 };
    simulation.sensor.hot_pixels.count = 0;
    simulation
}

fn expose(simulator: &Simulator) -> (Exposure, ExpectedImage) {
    let mut camera = simulator.camera().unwrap();
    let exposure = camera.expose(0).unwrap();
    (exposure, camera.expected().clone())
}

/// Nodes of a normal distribution with their probabilities, in standard deviations.
fn normal_nodes() -> Vec<(f64, f64)> {
    let mut nodes = Vec::new();
    for (x, weight) in NODES {
        for side in [-1.0, 1.0] {
            nodes.push((side * 2.0_f64.sqrt() * x, weight / PI.sqrt()));
        }
    }
    nodes
}

/// Mean of a thousand exposures whose attitudes differ by rotations of the vibration's distribution.
fn mean_of_a_thousand(simulation: &Simulation) -> Vec<f64> {
    let mut flying = simulator(simulation);
    let mut mean = vec![0.0; COLUMNS * 120];
    let nodes = normal_nodes();
    let degrees = |axis: usize, sigmas: f64| sigmas * VIBRATION_ARCSEC[axis] / 3600.0;
    for (x, of_x) in &nodes {
        for (y, of_y) in &nodes {
            for (z, of_z) in &nodes {
                let mut turned = simulation.clone();
                turned.mounting.actual =
                    Mounting { phi_deg: degrees(0, *x), theta_deg: degrees(1, *y), psi_deg: degrees(2, *z) };
                flying.fly(&turned).unwrap();
                let (_, image) = expose(&flying);
                for (sum, electrons) in mean.iter_mut().zip(image.iter()) {
                    *sum += of_x * of_y * of_z * electrons;
                }
            }
        }
    }
    mean
}

/// Electron-weighted mean position of the pixels about an object, above the background `level`.
fn centroid(image: &[f64], about: &ObjectTruth, level: f64) -> [f64; 2] {
    let (x, y) = (about.position.x.round() as usize, about.position.y.round() as usize);
    let (mut sum, mut moment) = (0.0, [0.0; 2]);
    for row in y - 9..y + 10 {
        for column in x - 9..x + 10 {
            let electrons = image[row * COLUMNS + column] - level;
            sum += electrons;
            moment[0] += electrons * column as f64;
            moment[1] += electrons * row as f64;
        }
    }
    moment.map(|moment| moment / sum)
}

/// Witness: the mean of a thousand exposures at other attitudes.
#[test]
fn an_image_equals_the_mean_of_a_thousand_exposures() {
    let simulation = scene();
    let mean = mean_of_a_thousand(&simulation);
    let mut vibrating = simulation;
    vibrating.attitude.control.vibration_arcsec = VIBRATION_ARCSEC;
    let (frame, image) = expose(&simulator(&vibrating));
    let image: Vec<f64> = image.iter().collect();
    let peak = mean.iter().copied().fold(0.0, f64::max);
    let mut worst: f64 = 0.0;
    for (a, b) in image.iter().zip(&mean) {
        worst = worst.max((a - b).abs());
    }
    assert!(worst < 1e-3 * peak, "{worst} of {peak}");

    let level = image.iter().copied().fold(f64::INFINITY, f64::min);
    let mut compared = 0;
    for object in &frame.objects {
        let is_alone = object.kind == ObjectKind::Star
            && (20.0..140.0).contains(&object.position.x)
            && (20.0..100.0).contains(&object.position.y)
            && object.snr > 5.0;
        if is_alone {
            let [of_image, of_mean] = [&image, &mean].map(|pixels| centroid(pixels, object, level));
            let off_px = libm::hypot(of_image[0] - of_mean[0], of_image[1] - of_mean[1]);
            assert!(off_px < 0.005, "{object:?}: {of_image:?} and {of_mean:?}");
            compared += 1;
        }
    }
    assert!(compared >= 2, "{compared} stars");
}

#[test]
fn vibration_moves_electrons_and_hardly_a_position() {
    let (plain, _) = expose(&simulator(&scene()));
    let mut vibrating = scene();
    vibrating.attitude.control.vibration_arcsec = VIBRATION_ARCSEC;
    let (blurred, _) = expose(&simulator(&vibrating));
    let mut compared = 0;
    for object in &plain.objects {
        let same = |other: &&ObjectTruth| (other.kind, other.id) == (object.kind, object.id);
        let Some(other) = blurred.objects.iter().find(same) else { continue };
        let is_inside =
            (12.0..148.0).contains(&object.position.x) && (12.0..108.0).contains(&object.position.y);
        if is_inside && object.snr > 10.0 {
            assert!(object.position.distance(other.position) < 0.02, "{object:?} {other:?}");
            assert!((other.electrons / object.electrons - 1.0).abs() < 0.02, "{object:?} {other:?}");
            assert!(other.peak_electrons < 0.8 * object.peak_electrons, "{object:?} {other:?}");
            compared += 1;
        }
    }
    assert!(compared >= 5, "{compared} objects");
    assert_eq!(plain.telemetry, blurred.telemetry);
    assert_eq!(plain.truth.camera_from_icrs, blurred.truth.camera_from_icrs);
}

#[test]
fn a_vibration_that_is_a_motion_is_refused() {
    let mut simulation = scene();
    simulation.attitude.control.vibration_arcsec = [0.0, 3600.0, 0.0];
    let error = Simulator::new(&simulation, std::path::Path::new("")).unwrap_err().to_string();
    assert!(error.contains("attitude.control.vibration_arcsec is 3600"), "{error}");
    assert!(error.contains("a blur of at most 4 px"), "{error}");
}
