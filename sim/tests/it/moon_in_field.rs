//! The Moon in the field: compared with JPL's DE421, and in image and truth.

use std::fs;
use std::path::Path;

use boresight_sim::onboard::ShutterConfig;
use boresight_sim::optics::Projection;
use boresight_sim::sensor::Switch;
use boresight_sim::truth::clock;
use boresight_sim::truth::{ObjectKind, ObjectTruth, Trajectory};
use boresight_sim::{Exposure, Simulation};
use contract::{Direction, Icrs, PixelPoint};
use hifitime::Epoch;
use nalgebra::Vector3;

use crate::small_scene::{looking_at, orbit_of, simulator, still};

/// Position of DE421's Moon relative to the chaser at one instant, and the scene of a camera that points at
/// it.
struct MoonView {
    from_chaser_km: Vector3<f64>,
    simulation: Simulation,
}

/// The first instants of the reference at which the Earth is far from the line of sight to the Moon.
fn views() -> Vec<MoonView> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../golden/moon/moon_de421.csv");
    let text = fs::read_to_string(path).unwrap();
    text.lines().skip(1).step_by(4).filter_map(view).take(20).collect()
}

fn view(line: &str) -> Option<MoonView> {
    let [tdb_j2000_s, x, y, z] =
        *line.split(',').map(|cell| cell.parse::<f64>().unwrap()).collect::<Vec<_>>()
    else {
        panic!("four columns: {line}")
    };
    let j2000 = Epoch::from_gregorian(2000, 1, 1, 12, 0, 0, 0, hifitime::TimeScale::TDB);
    let time =
        Epoch::from_tdb_duration(hifitime::Duration::from_seconds(tdb_j2000_s) + j2000.to_tdb_duration());
    let utc = clock::format_utc(time);
    let mut simulation = still();
    orbit_of(&mut simulation).epoch_utc = utc.clone();
    simulation.schedule[0].start_utc = utc;
    simulation.solar_system = Switch::On;
    simulation.shutter = ShutterConfig::Fixed { exposure_s: 1e-6 };
    let states = Trajectory::new(simulation.trajectory.orbit().unwrap()).unwrap().states_at(time);
    let from_chaser_km = Vector3::new(x, y, z) - states.chaser.position_km;
    let towards: Direction<Icrs> = Direction::from_vector(from_chaser_km).unwrap();
    simulation.attitude = looking_at(towards.ra().degrees() + 0.3, towards.dec().degrees());
    let up = from_chaser_km.normalize().dot(&states.chaser.position_km.normalize());
    (up > -0.3).then_some(MoonView { from_chaser_km, simulation })
}

fn the_moon(exposure: &Exposure) -> Option<&ObjectTruth> {
    exposure.objects.iter().find(|object| object.kind == ObjectKind::Moon)
}

/// Pixel position of a direction in the image.
fn pixel_position(view: &MoonView, exposure: &Exposure, direction: Vector3<f64>) -> PixelPoint {
    let direction: Direction<Icrs> = Direction::from_vector(direction).unwrap();
    let projection = Projection::new(&view.simulation.camera).unwrap();
    projection.project(&(exposure.truth.camera_from_icrs * direction)).unwrap()
}

/// Angle Sun–Moon–chaser, degrees, with the Sun at 1 au: the effect of its actual distance is negligible.
fn phase_deg(view: &MoonView, exposure: &Exposure) -> f64 {
    let sun_km = exposure.truth.sun.vector() * 149_597_870.7 - view.from_chaser_km;
    sun_km.angle(&-view.from_chaser_km).to_degrees()
}

#[test]
fn the_disk_is_where_de421_has_it_as_large_as_it_is_and_lit_from_the_sun() {
    let views = views();
    assert_eq!(views.len(), 20);
    let mut phases = Vec::new();
    for view in &views {
        let simulator = simulator(&view.simulation);
        let mut camera = simulator.camera().unwrap();
        let exposure = camera.expose(0).unwrap();
        let phase = phase_deg(view, &exposure);
        phases.push(phase);
        let Some(moon) = the_moon(&exposure) else {
            assert!(phase > 170.0, "no Moon at {phase}°");
            continue;
        };
        // A pixel is 1.4′; the ephemeris has an error of 0.02°, 0.85 px; the orbital velocity adds 6″ of
        // aberration.
        let towards: Direction<Icrs> = Direction::from_vector(view.from_chaser_km).unwrap();
        let error = moon.astrometric.unwrap().separation(&towards).degrees();
        assert!(error < 0.032, "{error}°");
        let centre = pixel_position(view, &exposure, view.from_chaser_km);

        // The lit pixels around the centre: none outside the disk, and the bright half towards the Sun.
        let sun_side = view.from_chaser_km + exposure.truth.sun.vector() * 300.0;
        let to_sun = pixel_position(view, &exposure, sun_side);
        let (dx, dy) = (to_sun.x - centre.x, to_sun.y - centre.y);
        let (bx, by) = (moon.position.x - centre.x, moon.position.y - centre.y);
        let along = (bx * dx + by * dy) / libm::hypot(dx, dy);
        let aside = (bx * dy - by * dx) / libm::hypot(dx, dy);
        assert!(aside.abs() < 1.2, "{aside} px aside at {phase}°");
        let radius_rad = libm::asin(1737.4 / view.from_chaser_km.norm());
        let camera_config = &view.simulation.camera;
        let (fx, fy) = camera_config.focal_length_px();
        let radius_px = radius_rad * (fx * fy).sqrt();
        assert!(phase < 60.0 || along > 0.1 * radius_px, "{along} px towards the Sun at {phase}°");
        assert!(along < radius_px + 1.2);

        if phase < 60.0 {
            // Lommel–Seeliger: the disk is nearly uniform, and half the level marks the limb; the terminator
            // cuts off its part.
            let expected = camera.expected();
            let (columns, rows) = expected.size();
            let level = expected.electrons_at(centre.x.round() as usize, centre.y.round() as usize);
            let lit = (0..columns * rows)
                .filter(|i| expected.electrons_at(i % columns, i / columns) > 0.5 * level)
                .count() as f64;
            let disk = std::f64::consts::PI * radius_rad * radius_rad * fx * fy;
            let part = 0.5 * (1.0 + libm::cos(phase.to_radians()));
            assert!((lit / (disk * part) - 1.0).abs() < 0.15, "{lit} px of {} at {phase}°", disk * part);
        }
    }
    assert!(phases.iter().any(|p| *p < 40.0) && phases.iter().any(|p| *p > 110.0), "{phases:?}");
}

/// Allen, Astrophysical Quantities (3rd ed. 1973), p. 143: phase angle, degrees, and magnitude difference
/// from the full Moon, positive when fainter.
const ALLEN: [(f64, f64); 17] = [
    (0.0, 0.00),
    (5.0, 0.08),
    (10.0, 0.23),
    (20.0, 0.51),
    (30.0, 0.79),
    (40.0, 1.06),
    (50.0, 1.35),
    (60.0, 1.62),
    (70.0, 1.91),
    (80.0, 2.24),
    (90.0, 2.63),
    (100.0, 3.04),
    (110.0, 3.48),
    (120.0, 3.93),
    (130.0, 4.44),
    (140.0, 5.07),
    (150.0, 5.9),
];

/// V magnitude of the Moon at a distance, by Allen's table, with the Sun at another distance (au). The full
/// Moon, with the Sun at its mean distance, reflects a geometric albedo of 0.12 (NASA's Moon Fact Sheet) of a
/// Sun of −26.76 (Willmer 2018) on a disk of radius 1737.4 km.
fn published_magnitude(phase_deg: f64, distance_km: f64, sun_au: f64) -> f64 {
    let full = -26.76 - 2.5 * libm::log10(0.12 * (1737.4 / distance_km) * (1737.4 / distance_km));
    let next = ALLEN.iter().position(|(phase, _)| *phase >= phase_deg).unwrap().max(1);
    let ((phase_0, fainter_0), (phase_1, fainter_1)) = (ALLEN[next - 1], ALLEN[next]);
    let part = (phase_deg - phase_0) / (phase_1 - phase_0);
    full + fainter_0 + part * (fainter_1 - fainter_0) + 5.0 * libm::log10(sun_au)
}

/// Distance of the Sun, au, accurate to 1e-4 (Astronomical Almanac, low-precision formulas).
fn sun_distance_au(time: Epoch) -> f64 {
    let anomaly_deg = 357.528 + 0.985_600_3 * clock::tt_j2000_s(time) / 86_400.0;
    let (once, twice) = (libm::cos(anomaly_deg.to_radians()), libm::cos(2.0 * anomaly_deg.to_radians()));
    1.000_14 - 0.016_71 * once - 0.000_14 * twice
}

#[test]
fn its_flux_is_that_of_allens_table_in_the_truth_and_in_the_image() {
    let (mut checked, mut distances_km) = (0, Vec::new());
    for view in views() {
        let simulator = simulator(&view.simulation);
        let mut camera = simulator.camera().unwrap();
        let exposure = camera.expose(0).unwrap();
        let phase = phase_deg(&view, &exposure);
        if phase > 150.0 {
            continue;
        }
        let moon = the_moon(&exposure).unwrap_or_else(|| panic!("no Moon at {phase}°"));
        let distance_km = view.from_chaser_km.norm();
        let expected = published_magnitude(phase, distance_km, sun_distance_au(exposure.truth.time));
        let magnitude = moon.magnitude.unwrap();
        // The table's values, given to hundredths, scatter by 0.05 about a smooth curve up to 120°, and by
        // 0.11 beyond.
        let tolerance = if phase < 120.0 { 0.06 } else { 0.12 };
        assert!((magnitude - expected).abs() < tolerance, "{magnitude}, expected {expected} at {phase}°");
        let electrons = 1.5e6 * libm::pow(10.0, -0.4 * magnitude) * exposure.truth.exposure_s;
        // Wings omitted by the floor of the stamp and by the detector's edge.
        assert!((moon.electrons / electrons - 1.0).abs() < 2e-3, "{} of {electrons}", moon.electrons);

        // The image has this number of electrons more than one without the Moon; a star contributes none in a
        // microsecond.
        let with: f64 = camera.expected().iter().sum();
        let dark = Simulation { solar_system: Switch::Off, ..view.simulation.clone() };
        let dark = crate::small_scene::simulator(&dark);
        let mut camera = dark.camera().unwrap();
        camera.expose(0).unwrap();
        let added = with - camera.expected().iter().sum::<f64>();
        assert!((added / moon.electrons - 1.0).abs() < 1e-3, "{added} in the image, {}", moon.electrons);
        checked += 1;
        distances_km.push(distance_km);
    }
    assert!(checked >= 12, "{checked} Moons");
    // The difference is 0.2 mag between the nearest and the farthest: a Moon placed always at its mean
    // distance would be detected.
    let (near, far) = distances_km.iter().fold((f64::MAX, 0.0_f64), |(a, b), &km| (a.min(km), b.max(km)));
    assert!(5.0 * libm::log10(far / near) > 0.15, "{near} to {far} km");
}

#[test]
fn switched_off_it_is_absent_and_switched_on_it_hides_only_the_stars_behind_it() {
    let stars = |exposure: &Exposure| -> Vec<u32> {
        let star = exposure.objects.iter().filter(|object| object.kind == ObjectKind::Star);
        star.map(|star| star.id).collect()
    };
    let (mut moons, mut hidden, mut brightest_e) = (0, 0, 0.0_f64);
    for view in views() {
        let mut on = view.simulation.clone();
        on.shutter = ShutterConfig::Fixed { exposure_s: 0.25 };
        on.catalog.magnitude_limit = Some(12.0);
        let off = Simulation { solar_system: Switch::Off, ..on.clone() };
        let [on, off] = [on, off].map(|s| simulator(&s).camera().unwrap().expose(0).unwrap());
        assert!(the_moon(&off).is_none());
        // A new Moon contributes no electrons, but still hides stars.
        let Some(moon) = the_moon(&on) else { continue };
        let centre = moon.astrometric.unwrap();
        let seen = stars(&on);
        for star in off.objects.iter().filter(|object| object.kind == ObjectKind::Star) {
            let apart = star.astrometric.unwrap().separation(&centre).degrees();
            // The disk's radius is 0.245° to 0.28°; apparent and astrometric directions differ by 0.006°.
            assert!(
                !(seen.contains(&star.id) && apart < 0.238),
                "a star {apart}° from the centre shines through"
            );
            assert!(seen.contains(&star.id) || apart < 0.29, "a star {apart}° from the centre is missing");
            hidden += usize::from(!seen.contains(&star.id));
        }
        brightest_e = brightest_e.max(moon.peak_electrons);
        moons += 1;
    }
    // The electrons exceed the full well: it overflows, and the frame is still produced.
    assert!(brightest_e > 1e6, "{brightest_e} e⁻");
    assert!(moons > 10 && hidden > 5, "{hidden} stars behind {moons} Moons");
}

#[test]
fn the_shutter_follows_its_brightest_pixel() {
    let mut checked = 0;
    for view in views().iter().take(6) {
        let mut simulation = view.simulation.clone();
        simulation.shutter = ShutterConfig::Automatic {
            min_s: 1e-6,
            max_s: 0.25,
            target_level: 0.5,
            step_factor: 1.2,
            lag_s: 0.0,
        };
        let exposure = simulator(&simulation).camera().unwrap().expose(0).unwrap();
        if let Some(moon) = the_moon(&exposure) {
            // Half of the saturation of 40,550 electrons, within one step of the ladder; accurate to 1 %, as
            // the predicted image is.
            let peak = moon.peak_electrons;
            assert!((16_700.0..=20_500.0).contains(&peak), "{peak} e⁻ in {} s", exposure.truth.exposure_s);
            checked += 1;
        }
    }
    assert!(checked > 2);
}
