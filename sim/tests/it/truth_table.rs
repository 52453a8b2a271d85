//! The truth table is complete, and each column follows its definition.

use std::collections::BTreeSet;

use boresight_sim::catalog::{Catalog, CatalogConfig};
use boresight_sim::optics::{OpticsConfig, Projection, Psf, PsfConfig, Stamp};
use boresight_sim::scene::TargetConfig;
use boresight_sim::truth::{
    FrameTruth, Guidance, ObjectKind, ObjectTruth, Observer, Shadow, StarMotion, Trajectory, Visibility,
    clock, ephemeris, shadow,
};
use boresight_sim::{Exposure, Simulation};
use contract::{Angle, Direction, Icrs, PixelPoint};
use nalgebra::Vector3;

use crate::small_scene::{looking_at, orbit_of, restless, simulator, still};

const LIGHT_SPEED_KM_S: f64 = 299_792.458;

fn one(simulation: &Simulation, frame: u64) -> Exposure {
    simulator(simulation).camera().unwrap().expose(frame).unwrap()
}

fn stars(exposure: &Exposure) -> Vec<&ObjectTruth> {
    exposure.objects.iter().filter(|object| object.kind == ObjectKind::Star).collect()
}

/// Both poles, both sides of the discontinuity in right ascension, and a spiral over the remainder of the
/// sky.
fn pointings() -> Vec<(f64, f64)> {
    let mut pointings =
        vec![(0.0, 90.0), (123.0, -90.0), (0.0, 0.0), (359.99, -0.7), (0.3, 89.2), (200.0, -88.9)];
    let spiral = (0..14).map(|i| {
        let dec_deg = libm::asin((f64::from(i) + 0.5) / 7.0 - 1.0).to_degrees();
        ((222.49 * f64::from(i)) % 360.0, dec_deg)
    });
    pointings.extend(spiral);
    pointings
}

/// Reference without a sky index or search cone: every star of the catalogue is moved, aberrated and
/// projected, and its image drawn. The table must contain exactly the stars with signal on the detector.
#[test]
fn every_star_of_the_catalogue_with_flux_on_the_detector_is_in_the_table() {
    let catalog = Catalog::hipparcos2();
    let motions: Vec<StarMotion> = catalog.stars().iter().map(StarMotion::new).collect();
    for (i, (ra_deg, dec_deg)) in pointings().into_iter().enumerate() {
        // Also at the ends of the ephemeris, where proper motion has moved the stars farthest.
        let start_utc = ["2012-04-25T12:00:00Z", "1990-01-02T00:00:00Z", "2050-01-04T00:00:00Z"][i % 3];
        let mut simulation = Simulation {
            catalog: CatalogConfig::default(),
            attitude: looking_at(ra_deg, dec_deg),
            ..still()
        };
        if i % 2 == 1 {
            // With wings, brighter stars contribute from farther off the detector.
            simulation.psf = PsfConfig::Moffat { fwhm_px: 1.8, beta: 2.5 };
        }
        orbit_of(&mut simulation).epoch_utc = start_utc.into();
        simulation.schedule[0].start_utc = start_utc.into();
        let exposure = one(&simulation, 0);
        let truth = &exposure.truth;

        let projection = Projection::new(&simulation.camera).unwrap();
        let mut psf = Psf::new(&simulation.psf).unwrap();
        let mut stamp = Stamp::new();
        let observer = Observer::new(truth.time, truth.position_km, truth.velocity_km_s).unwrap();
        let mut expected = BTreeSet::new();
        for (star, motion) in catalog.stars().iter().zip(&motions) {
            let Some(at) = projection.project(&(truth.camera_from_icrs * observer.apparent(motion))) else {
                continue;
            };
            let electrons = 1.5e6 * libm::pow(10.0, -0.4 * star.v_mag()) * truth.exposure_s;
            psf.stamp(at, electrons, Psf::FLOOR_E, (160, 120), &mut stamp);
            if stamp.truth(0.0, 0.0, f64::INFINITY).electrons > 0.0 {
                expected.insert(star.id);
            }
        }
        let reported: Vec<u32> = stars(&exposure).iter().map(|star| star.id).collect();
        assert!(reported.is_sorted_by(|a, b| a < b), "stars are in ascending order, each once");
        assert_eq!(
            reported.into_iter().collect::<BTreeSet<_>>(),
            expected,
            "at RA {ra_deg}°, Dec {dec_deg}°"
        );
        // 2.9 stars per square degree on average, 11 square degrees; about half of this at the galactic pole.
        assert!(expected.len() > 8, "{} stars at RA {ra_deg}°, Dec {dec_deg}°", expected.len());
    }
}

#[test]
fn vignetting_dims_every_object_by_its_factor() {
    let mut simulation = Simulation { psf: PsfConfig::Gaussian { sigma_px: 0.8 }, ..still() };
    let open = one(&simulation, 0);
    simulation.optics = OpticsConfig { vignetting: [0.4, 0.0, 0.0], ..OpticsConfig::default() };
    let vignetted = one(&simulation, 0);
    let camera = &simulation.camera;
    let [x_um, y_um] = [camera.pixel_width_um, camera.pixel_height_um];
    // The principal point is (81.3, 58.4); the farthest corner is therefore (−0.5, 119.5).
    let corner_um = libm::hypot(81.8 * x_um, 61.1 * y_um);
    let mut checked = 0;
    for (before, after) in open.objects.iter().zip(&vignetted.objects) {
        assert_eq!((before.kind, before.id, before.position), (after.kind, after.id, after.position));
        let (x, y) = (before.position.x - 81.3, before.position.y - 58.4);
        let rho = libm::hypot(x * x_um, y * y_um) / corner_um;
        let expected = match before.kind {
            // Dark current does not depend on the optics.
            ObjectKind::HotPixel => 1.0,
            _ if before.position.is_on_detector(160, 120) && before.electrons > 100.0 => {
                1.0 - 0.4 * rho * rho
            }
            _ => continue,
        };
        // A fainter image loses a slightly larger fraction at the floor of the stamps: 2πσ² · 0.01 e⁻ of 100.
        let ratio = after.electrons / before.electrons;
        assert!((ratio - expected).abs() < 0.003, "at ρ = {rho}: {ratio}, expected {expected}");
        checked += usize::from(expected < 0.95);
    }
    assert!(checked > 3, "{checked} objects lose light");
}

/// Pixel position of a direction for a camera without distortion, by similar triangles.
fn pinhole(simulation: &Simulation, truth: &FrameTruth, direction: &Vector3<f64>) -> PixelPoint {
    let camera = &simulation.camera;
    let seen = truth.camera_from_icrs.matrix() * direction;
    PixelPoint::new(
        camera.principal_x_px + camera.focal_length_mm * 1000.0 / camera.pixel_width_um * seen.x / seen.z,
        camera.principal_y_px + camera.focal_length_mm * 1000.0 / camera.pixel_height_um * seen.y / seen.z,
    )
}

/// An inertial camera without distortion.
fn straight() -> Simulation {
    let mut simulation = still();
    (simulation.camera.radial, simulation.camera.tangential) = ([0.0; 3], [0.0; 2]);
    simulation
}

/// Velocity of the chaser relative to the barycentre of the Solar System, km/s.
fn barycentric_velocity_km_s(truth: &FrameTruth) -> Vector3<f64> {
    let earth = ephemeris::earth(clock::tdb_j2000_s(truth.time)).unwrap();
    earth.velocity_km_s + truth.velocity_km_s
}

/// Bradley's aberration: the sum of the star's direction and the velocity divided by the speed of light,
/// without further terms. Relativity differs by (v/c)²/4 = 0.6 mas; the Sun deflects light by 4 mas at right
/// angles to its direction.
fn aberrated(direction: &Vector3<f64>, velocity_km_s: &Vector3<f64>) -> Vector3<f64> {
    (direction + velocity_km_s / LIGHT_SPEED_KM_S).normalize()
}

#[test]
fn stars_are_aberrated_and_the_target_is_not() {
    let mut simulation = straight();
    // A sphere is located by its centre of brightness, which is not on the line of sight.
    simulation.target = TargetConfig::Beacon { magnitude_at_1_km: -5.0 };
    let exposure = one(&simulation, 3);
    let truth = &exposure.truth;
    let velocity = barycentric_velocity_km_s(truth);
    // 1 px is 85″ to 88″: 8 mas of neglected terms are 1e-4 px.
    let tolerance_px = 1e-4;

    let line_of_sight = truth.line_of_sight.vector();
    let target = exposure.objects[0].position;
    assert_eq!(exposure.objects[0].kind, ObjectKind::Target);
    // The position is the mean of the trail, which is curved by 1e-7 px.
    assert!(truth.target_position.unwrap().distance(target) < 1e-6);
    assert!(target.distance(pinhole(&simulation, truth, line_of_sight)) < 1e-6);
    let shifted = pinhole(&simulation, truth, &aberrated(line_of_sight, &velocity));
    assert!(target.distance(shifted) > 0.05, "the velocity is along the line of sight: nothing is tested");

    for star in stars(&exposure) {
        let catalogued = star.astrometric.unwrap();
        let with = pinhole(&simulation, truth, &aberrated(catalogued.vector(), &velocity));
        let against = pinhole(&simulation, truth, &aberrated(catalogued.vector(), &-velocity));
        assert!(star.position.distance(with) < tolerance_px, "HIP {}", star.id);
        assert!(star.position.distance(against) > 0.1, "HIP {}", star.id);
    }
    assert!(stars(&exposure).len() > 10, "{} stars", stars(&exposure).len());
}

/// Half a year later the Earth moves in the opposite direction; the chaser and the target, whose orbits do
/// not depend on the date, have the same positions as before.
#[test]
fn another_velocity_moves_the_stars_by_its_aberration_and_the_target_not_at_all() {
    let seen = |date: &str| {
        let mut simulation = straight();
        orbit_of(&mut simulation).epoch_utc = format!("{date}T00:00:00Z");
        simulation.schedule[0].start_utc = format!("{date}T12:00:00Z");
        one(&simulation, 0)
    };
    let (spring, autumn) = (seen("2012-04-25"), seen("2012-10-25"));
    assert_eq!(spring.truth.position_km, autumn.truth.position_km);
    assert_eq!(spring.truth.target_position, autumn.truth.target_position);

    let simulation = straight();
    let [before, after] = [&spring, &autumn].map(|exposure| barycentric_velocity_km_s(&exposure.truth));
    // 60 km/s out of 300,000 are 41″: half a pixel, if the motion is across the line of sight.
    assert!((after - before).norm() > 55.0);
    let aberration = |exposure: &Exposure, star: &ObjectTruth| {
        let still = pinhole(&simulation, &exposure.truth, star.astrometric.unwrap().vector());
        nalgebra::Vector2::new(star.position.x - still.x, star.position.y - still.y)
    };
    let mut compared = 0;
    for star in stars(&spring) {
        let Some(later) = stars(&autumn).into_iter().find(|later| later.id == star.id) else { continue };
        let change = aberration(&autumn, later) - aberration(&spring, star);
        let at = star.astrometric.unwrap();
        let [from, to] =
            [before, after].map(|v| pinhole(&simulation, &spring.truth, &aberrated(at.vector(), &v)));
        // Terms neglected as above, in both seasons; the star's proper motion between the seasons changes the
        // plate scale by 1e-7.
        assert!(
            (change - nalgebra::Vector2::new(to.x - from.x, to.y - from.y)).norm() < 2e-4,
            "HIP {}",
            star.id
        );
        assert!(change.norm() > 0.1, "HIP {}: {change}", star.id);
        compared += 1;
    }
    assert!(compared > 10, "{compared} stars in both seasons");
}

#[test]
fn the_columns_of_a_frame_follow_their_definitions() {
    let simulation = restless();
    let simulator = simulator(&simulation);
    let trajectory = Trajectory::new(simulation.trajectory.orbit().unwrap()).unwrap();
    let mut camera = simulator.camera().unwrap();
    for frame in [0, 1, 5, 77, 400, 999] {
        let Exposure { truth, telemetry, frame: image, .. } = camera.expose(frame).unwrap();
        let start = clock::parse_utc("2012-04-25T12:00:00Z").unwrap();
        assert_eq!((truth.frame, truth.group.as_str(), image.number()), (frame, "only", frame));
        assert_eq!(truth.time, start + hifitime::Unit::Second * (15.0 * frame as f64));
        assert_eq!((telemetry.time, telemetry.exposure_s), (truth.time, truth.exposure_s));

        let states = trajectory.states_at(truth.time);
        let (chaser, target) = (states.chaser.position_km, states.target.position_km);
        assert_eq!((truth.position_km, truth.velocity_km_s), (chaser, states.chaser.velocity_km_s));
        // Positions of 7000 km are accurate to 1e-12 km.
        assert!((truth.range_km - (target - chaser).norm()).abs() < 1e-11);
        assert!((truth.line_of_sight.vector() * truth.range_km - (target - chaser)).norm() < 1e-11);

        let earth = ephemeris::earth(clock::tdb_j2000_s(truth.time)).unwrap();
        let sun = earth.sun_geocentric_km();
        // Sums of 1.5e8 km have a rounding error of 3e-8 km: 2e-16 rad.
        assert!((truth.sun.vector() - (sun - chaser).normalize()).norm() < 1e-14);
        let cosine = (sun - target).normalize().dot(&(chaser - target).normalize());
        // The arc cosine loses half its digits near 0° and 180°; elsewhere the error is 1e-12 relative to the
        // range of 10 km.
        let phase_deg = libm::acos(cosine).to_degrees();
        assert!((truth.phase_deg - phase_deg).abs() < 1e-5, "{} and {phase_deg}", truth.phase_deg);

        let nominal = simulation.mounting.nominal.camera_from_body();
        let actual = simulation.mounting.actual.camera_from_body();
        assert!((actual * truth.body_from_icrs).angle_to(&truth.camera_from_icrs).radians() < 1e-15);
        assert!(
            ((nominal * truth.body_from_icrs).angle_to(&truth.camera_from_icrs).degrees() - 0.05).abs()
                < 1e-9
        );
        assert_eq!(truth.shadow, Shadow::Sunlit);
        assert_eq!(truth.sunlit_fraction, 1.0);
    }
}

/// With the target as the only object on the detector: its row is computed from the expected image, pixel by
/// pixel.
#[test]
fn the_columns_of_an_object_follow_their_definitions() {
    let mut simulation = restless();
    simulation.catalog.magnitude_limit = Some(-2.0);
    simulation.sensor.hot_pixels.count = 0;
    let simulator = simulator(&simulation);
    let mut camera = simulator.camera().unwrap();
    for frame in [0, 3, 50, 400] {
        let exposure = camera.expose(frame).unwrap();
        let [target] = exposure.objects.as_slice() else { panic!("frame {frame}: {:?}", exposure.objects) };
        let (image, windows) = (camera.expected(), exposure.frame.windows().unwrap());
        // Read noise of 15 e⁻, gain of 10 e⁻ per digital number.
        let variance = image.flat_e() + 15.0 * 15.0 + 10.0 * 10.0 / 12.0;
        let (mut electrons, mut peak, mut snr2, mut radius, mut lost) = (0.0, 0.0_f64, 0.0, 0.5_f64, 0.0);
        let (mut moment_x, mut moment_y) = (0.0, 0.0);
        for y in 0..120 {
            for x in 0..160 {
                let signal = image.electrons_at(x, y) - image.flat_e();
                electrons += signal;
                (moment_x, moment_y) = (moment_x + signal * x as f64, moment_y + signal * y as f64);
                peak = peak.max(signal);
                snr2 += signal * signal / (signal + variance);
                if signal > variance.sqrt() {
                    radius = radius.max(target.position.distance(PixelPoint::new(x as f64, y as f64)));
                }
                if !windows.iter().any(|window| window.contains(x, y)) {
                    lost += signal;
                }
            }
        }
        // Signals here are differences from the flat level, with an error of 1e-14 of that level in each of
        // 19,200 pixels.
        let close = |a: f64, b: f64| (a - b).abs() < 1e-8 * b.abs().max(1e-3);
        assert!(close(target.electrons, electrons), "{} {electrons}", target.electrons);
        assert!(close(target.peak_electrons, peak), "{} {peak}", target.peak_electrons);
        assert!(close(target.snr, snr2.sqrt()), "{} {}", target.snr, snr2.sqrt());
        assert!(close(target.radius_px, radius), "{} {radius}", target.radius_px);
        assert!(close(target.cut, lost / electrons), "{} {}", target.cut, lost / electrons);
        assert_eq!(exposure.truth.target_visibility, Visibility::from_snr(target.snr));
        // The centroid of a pixel-integrated Gaussian of 0.8 px has an error of 1e-6 px. The signal below the
        // floor of 0.01 e⁻ per pixel is about 2 e⁻ at about 12 px, distributed symmetrically.
        let centroid = PixelPoint::new(moment_x / electrons, moment_y / electrons);
        assert!(centroid.distance(target.position) < 1e-3, "{centroid:?} {:?}", target.position);
        // Pogson: the magnitude corresponds to the electrons, apart from the 2 e⁻ below the floor.
        let magnitude = -2.5 * libm::log10(electrons / exposure.truth.exposure_s / 1.5e6);
        assert!((target.magnitude.unwrap() - magnitude).abs() < 0.01, "{magnitude}");
    }
}

#[test]
fn a_target_behind_the_camera_has_no_position_and_no_row() {
    let mut simulation = restless();
    simulation.attitude.guidance = Guidance::LocalOrbital { phi_deg: 180.0, theta_deg: 0.0, psi_deg: 0.0 };
    let exposure = one(&simulation, 2);
    assert_eq!(exposure.truth.target_position, None);
    assert_eq!(exposure.truth.target_visibility, Visibility::Invisible);
    assert!(exposure.objects.iter().all(|object| object.kind != ObjectKind::Target));
    assert!(!stars(&exposure).is_empty());
}

/// Shadow by the cones tangent to Sun and Earth; `None` within a metre of the cones' surfaces.
fn shadow_of(position_km: &Vector3<f64>, sun_km: &Vector3<f64>) -> Option<Shadow> {
    let (sun_radius, earth_radius) = (695_700.0, 6_378.136_6);
    let distance = sun_km.norm();
    let axis = -sun_km / distance;
    let along = position_km.dot(&axis);
    if along < 0.0 {
        return Some(Shadow::Sunlit);
    }
    let off_axis = (position_km - axis * along).norm();
    // A cone tangent to both spheres: its half angle follows from the radii, its radius at `along` from the
    // Earth's radius.
    let radius_at = |sine: f64| {
        let cosine = (1.0 - sine * sine).sqrt();
        (earth_radius + along * sine) / cosine
    };
    let umbra = radius_at(-(sun_radius - earth_radius) / distance);
    let penumbra = radius_at((sun_radius + earth_radius) / distance);
    if (off_axis - umbra).abs() < 1e-3 || (off_axis - penumbra).abs() < 1e-3 {
        None
    } else if off_axis < umbra {
        Some(Shadow::Umbra)
    } else if off_axis < penumbra {
        Some(Shadow::Penumbra)
    } else {
        Some(Shadow::Sunlit)
    }
}

/// One revolution of a noon-midnight orbit, with the camera pointed at the target.
#[test]
fn in_the_earths_shadow_the_target_fades_through_penumbra_and_is_gone_in_umbra() {
    let mut simulation = still();
    orbit_of(&mut simulation).target.raan_deg = 33.0;
    simulation.attitude.guidance = Guidance::TargetPointing {};
    simulation.catalog.magnitude_limit = Some(0.0);
    simulation.schedule[0].cadence_s = 2.0;
    simulation.schedule[0].count = 3000;
    let simulator = simulator(&simulation);
    let trajectory = Trajectory::new(simulation.trajectory.orbit().unwrap()).unwrap();
    let mut camera = simulator.camera().unwrap();
    let (mut umbra, mut penumbra, mut lit, mut changes) = (0, 0, 0, Vec::new());
    let mut before = None;
    for frame in 0..3000 {
        let Exposure { truth, objects, .. } = camera.expose(frame).unwrap();
        let target = objects.first().filter(|object| object.kind == ObjectKind::Target);
        let target_km = truth.position_km + truth.line_of_sight.vector() * truth.range_km;
        let earth = ephemeris::earth(clock::tdb_j2000_s(truth.time)).unwrap();
        let sun_km = earth.sun_geocentric_km();
        if let Some(expected) = shadow_of(&target_km, &sun_km) {
            assert_eq!(truth.shadow, expected, "frame {frame}");
        }
        match truth.shadow {
            Shadow::Umbra => {
                umbra += 1;
                assert_eq!((target, truth.sunlit_fraction), (None, 0.0), "frame {frame}");
                assert_eq!(truth.target_visibility, Visibility::Invisible);
                assert!(truth.target_position.is_some(), "it is dark, and still there");
            }
            Shadow::Penumbra => {
                penumbra += 1;
                assert!(truth.sunlit_fraction > 0.0 && truth.sunlit_fraction < 1.0);
            }
            Shadow::Sunlit => assert_eq!(truth.sunlit_fraction, 1.0),
        }
        if let Some(target) = target {
            // A Lambertian sphere of radius 0.1 m and albedo 0.3, with the range and the phase of the table.
            let phase = Angle::from_degrees(truth.phase_deg).radians();
            let (sin, cos) = libm::sincos(phase);
            let lambert = (sin + (std::f64::consts::PI - phase) * cos) / std::f64::consts::PI;
            let sun_au = (sun_km - target_km).norm() / 149_597_870.7;
            let ratio = 1e-4 / truth.range_km / sun_au;
            let flux = 2.0 / 3.0 * 0.3 * lambert * ratio * ratio * truth.sunlit_fraction;
            let magnitude = -26.76 - 2.5 * libm::log10(flux);
            // Phase and range of the table are accurate to 1e-12; the function has no steep slope near full
            // phase.
            assert!((target.magnitude.unwrap() - magnitude).abs() < 1e-9, "frame {frame}: {magnitude}");
            lit += 1;
        }
        if before.replace(truth.shadow) != Some(truth.shadow) {
            changes.push(truth.shadow);
            // The exact time of the change: the two preceding seconds in steps of 10 ms, or 75 m.
            for step in 0..200 {
                let at = trajectory
                    .states_at(truth.time - hifitime::Unit::Millisecond * (10 * step))
                    .target
                    .position_km;
                let reported = shadow::classify(shadow::sunlit_fraction(&at, &sun_km));
                assert!(
                    shadow_of(&at, &sun_km).is_none_or(|expected| reported == expected),
                    "{step} before {frame}"
                );
            }
        }
    }
    // One passage through the shadow: a third of a revolution of 5990 s, and on each side about 8 s in which
    // the Sun sets. The revolution may begin at any phase.
    let cycle = [Shadow::Sunlit, Shadow::Penumbra, Shadow::Umbra, Shadow::Penumbra];
    let turned = (0..4).any(|by| changes.iter().copied().eq((0..5).map(|i| cycle[(i + by) % 4])));
    assert!(turned, "{changes:?}");
    assert!((950..1100).contains(&umbra), "{umbra} frames in umbra");
    assert!((4..=12).contains(&penumbra), "{penumbra} frames in penumbra");
    assert_eq!(lit, 3000 - umbra, "the target is seen wherever the Sun is");
}

/// The direction listed for a star is its catalogue position, moved by proper motion and seen from the
/// chaser: for a star with negligible parallax, the catalogue direction with its proper motion.
#[test]
fn the_direction_of_a_star_is_astrometric() {
    let exposure = one(&still(), 0);
    let catalog = Catalog::hipparcos2();
    // 2012-04-25 12:00 is J2012.315; the catalogue's epoch is J1991.25.
    let years = 21.065;
    for row in stars(&exposure) {
        let star = catalog.star(row.id).unwrap();
        let mas = |value: f64| Angle::from_arcsec(value / 1000.0).radians();
        let moved: Direction<Icrs> = Direction::from_ra_dec(
            Angle::from_radians(star.ra_rad + mas(star.pm_ra_mas_per_yr * years) / libm::cos(star.dec_rad)),
            Angle::from_radians(star.dec_rad + mas(star.pm_dec_mas_per_yr * years)),
        );
        let off_mas = row.astrometric.unwrap().separation(&moved).arcsec() * 1000.0;
        // The parallax, plus 1 mas for the curvature of the parallels and the rounding of the epoch (0.001
        // years).
        assert!(
            off_mas < star.parallax_mas.max(0.0) * 1.02 + 1.0,
            "HIP {}: {off_mas} mas, parallax {}",
            row.id,
            star.parallax_mas
        );
    }
    assert!(stars(&exposure).len() > 10, "{} stars", stars(&exposure).len());
}
