//! The Earth in the field hides the objects behind it, and objects that it outshines are undetectable.

use boresight_sim::catalog::Catalog;
use boresight_sim::optics::{KnownDetector, Projection, QuantumEfficiency, RadiometryConfig};
use boresight_sim::scene::{EarthLightConfig, StrayLightConfig};
use boresight_sim::truth::{ObjectKind, ObjectTruth, Visibility};
use boresight_sim::{Exposure, Simulation};
use contract::{Direction, Icrs};
use nalgebra::{Rotation3, Unit, Vector3};

use crate::small_scene::{looking_at, simulator, still};

/// Equatorial radius of WGS 84, which defines the limb in this test.
const EQUATORIAL_RADIUS_KM: f64 = 6378.137;

fn first(simulation: &Simulation) -> Exposure {
    simulator(simulation).camera().unwrap().expose(0).unwrap()
}

/// The small scene with a black Earth, which emits no light: hidden and outshone objects are thereby
/// distinguished.
fn with_black_earth() -> Simulation {
    let mut simulation = still();
    simulation.radiometry = RadiometryConfig::Spectral {
        aperture_diameter_mm: 14.6,
        transmission: 0.8,
        quantum_efficiency: QuantumEfficiency::Known(KnownDetector::SiliconCcd),
        band_nm: None,
    };
    let scatter =
        StrayLightConfig { exclusion_deg: 30.0, transmittance: 1e-9, power: 3.0, power_inside: 6.0 };
    simulation.background.earth = Some(EarthLightConfig { albedo: 0.0, scatter });
    simulation
}

fn stars(exposure: &Exposure) -> impl Iterator<Item = &ObjectTruth> {
    exposure.objects.iter().filter(|object| object.kind == ObjectKind::Star)
}

#[test]
fn stars_are_seen_above_the_limb_and_none_below_it() {
    let catalog = Catalog::hipparcos2();
    let down = -first(&still()).truth.position_km;
    let limb = libm::asin(EQUATORIAL_RADIUS_KM / down.norm());
    let axis = Unit::new_normalize(down.cross(&Vector3::z()));
    let (mut above, mut below) = (0, 0);
    for sixth in 0..6 {
        // The boresight points at the limb, at several positions around the Earth.
        let around = Rotation3::from_axis_angle(&Unit::new_normalize(down), f64::from(sixth));
        let at_limb: Direction<Icrs> =
            Direction::from_vector(around * Rotation3::from_axis_angle(&axis, limb) * down).unwrap();
        let mut simulation = with_black_earth();
        simulation.attitude = looking_at(at_limb.ra().degrees(), at_limb.dec().degrees());
        let projection = Projection::new(&simulation.camera).unwrap();
        let exposure = first(&simulation);
        let seen: Vec<u32> = stars(&exposure).map(|star| star.id).collect();
        for star in catalog.stars().iter().filter(|star| star.v_mag() < 9.5) {
            let direction = star.direction();
            let Some(at) = projection.project(&(exposure.truth.camera_from_icrs * direction)) else {
                continue;
            };
            // Catalogued positions differ by aberration and proper motion, by three pixels or more at worst.
            if !((5.0..154.0).contains(&at.x) && (5.0..114.0).contains(&at.y)) {
                continue;
            }
            let height_deg = (direction.vector().angle(&down) - limb).to_degrees();
            if height_deg > 0.1 {
                assert!(seen.contains(&star.id), "star {} is {height_deg}° above the limb", star.id);
                above += 1;
            } else if height_deg < -0.1 {
                assert!(!seen.contains(&star.id), "star {} shines through the Earth", star.id);
                below += 1;
            }
        }
    }
    assert!(above > 50 && below > 50, "{above} above, {below} below");
}

#[test]
fn no_object_is_detectable_where_the_background_fills_the_pixels() {
    let mut simulation = still();
    let detectable = |exposure: &Exposure| {
        let detectable = |snr| Visibility::from_snr(snr) == Visibility::Detectable;
        stars(exposure).filter(|star| detectable(star.snr)).count()
    };
    assert!(detectable(&first(&simulation)) > 3);
    // In 0.25 s, 1.2 times the largest signal that the converter can represent.
    simulation.sensor.background_e_per_s = 4.0 * 1.2 * simulation.sensor.saturation_e();
    let blinded = first(&simulation);
    assert!(stars(&blinded).count() > 3, "they are there all the same");
    assert!(blinded.objects.iter().all(|object| object.snr == 0.0));
    assert_eq!(blinded.truth.target_visibility, Visibility::Invisible);
}
