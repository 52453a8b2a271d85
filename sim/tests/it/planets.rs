//! Planets: compared with JPL's DE421, and in the field.

use std::fs;
use std::path::Path;

use boresight_sim::onboard::ShutterConfig;
use boresight_sim::optics::Projection;
use boresight_sim::sensor::Switch;
use boresight_sim::truth::{ObjectKind, ObjectTruth, Observer, Planet, clock};
use boresight_sim::{Exposure, Simulation};
use contract::{Direction, Icrs};
use hifitime::Epoch;
use nalgebra::Vector3;

use crate::small_scene::{looking_at, orbit_of, simulator, still};

struct Reference {
    tdb_j2000_s: f64,
    planet: Planet,
    direction: Direction<Icrs>,
    distance_au: f64,
}

fn references() -> Vec<Reference> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../golden/planets/planets.csv");
    let text = fs::read_to_string(path).unwrap();
    text.lines()
        .skip(1)
        .map(|line| {
            let [seconds, number, x, y, z, distance_au] =
                *line.split(',').map(|cell| cell.parse::<f64>().unwrap()).collect::<Vec<_>>()
            else {
                panic!("six columns: {line}")
            };
            Reference {
                tdb_j2000_s: seconds,
                planet: Planet::ALL.into_iter().find(|p| f64::from(p.number()) == number).unwrap(),
                direction: Direction::from_vector(Vector3::new(x, y, z)).unwrap(),
                distance_au,
            }
        })
        .collect()
}

fn epoch(tdb_j2000_s: f64) -> Epoch {
    Epoch::from_tdb_duration(
        hifitime::Duration::from_seconds(tdb_j2000_s)
            + Epoch::from_gregorian(2000, 1, 1, 12, 0, 0, 0, hifitime::TimeScale::TDB).to_tdb_duration(),
    )
}

#[test]
fn directions_and_distances_are_those_of_de421_to_minutes_of_arc() {
    let references = references();
    assert_eq!(references.len(), 350);
    let mut worst = [0.0_f64; 9];
    let mut worst_distance = [0.0_f64; 9];
    for Reference { tdb_j2000_s, planet, direction, distance_au } in references {
        let observer = Observer::new(epoch(tdb_j2000_s), Vector3::zeros(), Vector3::zeros()).unwrap();
        let sight = planet.apparent(tdb_j2000_s, &observer).unwrap();
        let error_arcmin = sight.astrometric.separation(&direction).arcsec() / 60.0;
        let number = planet.number() as usize;
        worst[number] = worst[number].max(error_arcmin);
        let distance = (sight.distance_au / distance_au - 1.0).abs();
        worst_distance[number] = worst_distance[number].max(distance);
    }
    // Errors stated by Standish and Williams, as seen from the Earth; see golden/manifest.toml.
    for (number, bound) in [(1, 0.3), (2, 0.6), (4, 2.5), (5, 9.0), (6, 13.0), (7, 2.5), (8, 1.5)] {
        assert!(worst[number] < bound, "planet {number}: {worst:?}");
    }
    assert!(worst_distance.iter().all(|error| *error < 3e-3), "{worst_distance:?}");
    // The bounds are meaningful: the largest errors come near them.
    assert!(worst[5] > 1.0 && worst[6] > 1.0, "{worst:?}");
}

/// A camera that points at DE421's position of the planet.
fn towards(reference: &Reference) -> Simulation {
    let utc = clock::format_utc(epoch(reference.tdb_j2000_s));
    let mut simulation = still();
    simulation.attitude = looking_at(reference.direction.ra().degrees(), reference.direction.dec().degrees());
    orbit_of(&mut simulation).epoch_utc = utc.clone();
    simulation.schedule[0].start_utc = utc;
    simulation.solar_system = Switch::On;
    simulation
}

fn planets(exposure: &Exposure) -> Vec<&ObjectTruth> {
    exposure.objects.iter().filter(|object| object.kind == ObjectKind::Planet).collect()
}

#[test]
fn a_planet_is_where_de421_has_it_in_the_image_and_in_the_table() {
    for reference in references().iter().filter(|r| [2, 5].contains(&r.planet.number())).take(20) {
        let simulation = towards(reference);
        let simulator = simulator(&simulation);
        let mut camera = simulator.camera().unwrap();
        let exposure = camera.expose(0).unwrap();
        let seen = planets(&exposure);
        let planet = *seen.iter().find(|planet| planet.id == reference.planet.number()).unwrap();
        let expected = Projection::new(&simulation.camera)
            .unwrap()
            .project(&(exposure.truth.camera_from_icrs * reference.direction))
            .unwrap();
        // A pixel is 1.4′: the error of the ephemeris (9′ for Jupiter, 2.5′ for Venus), 0.4′ of aberration,
        // and the parallax of a low orbit, 0.5′ for Venus at its nearest.
        let bound_px = if planet.id == 5 { 7.0 } else { 2.5 };
        assert!(
            planet.position.distance(expected) < bound_px,
            "{} from {expected:?}",
            planet.position.distance(expected)
        );
        assert!(planet.magnitude.unwrap() < -1.5);
        // The planet's electrons are in the image.
        let (x, y) = (planet.position.x.round() as usize, planet.position.y.round() as usize);
        assert!(camera.expected().electrons_at(x, y) > 0.5 * planet.peak_electrons);
        // No catalogue star is listed instead of the planet because of an equal number.
        let star = exposure.objects.iter().filter(|object| object.kind == ObjectKind::Star);
        assert!(star.clone().all(|star| star.magnitude.unwrap() > planet.magnitude.unwrap()));
    }
}

#[test]
fn without_the_switch_there_are_no_planets_and_all_else_is_as_it_was() {
    let reference = references().into_iter().find(|r| r.planet == Planet::Venus).unwrap();
    let on = towards(&reference);
    let off = Simulation { solar_system: Switch::Off, ..on.clone() };
    let [on, off] = [on, off].map(|simulation| simulator(&simulation).camera().unwrap().expose(0).unwrap());
    assert!(planets(&off).is_empty() && !planets(&on).is_empty());
    let others: Vec<_> = on.objects.iter().filter(|object| object.kind != ObjectKind::Planet).collect();
    assert_eq!(others, off.objects.iter().collect::<Vec<_>>());
}

#[test]
fn the_shutter_follows_a_planet() {
    let reference = references().into_iter().find(|r| r.planet == Planet::Venus).unwrap();
    let mut on = towards(&reference);
    on.shutter = ShutterConfig::Automatic {
        min_s: 1e-5,
        max_s: 0.25,
        target_level: 0.5,
        step_factor: 1.2,
        lag_s: 0.0,
    };
    let off = Simulation { solar_system: Switch::Off, ..on.clone() };
    let [on, off] = [on, off].map(|simulation| simulator(&simulation).camera().unwrap().expose(0).unwrap());
    assert!(on.truth.exposure_s < 0.1 * off.truth.exposure_s, "{} s", on.truth.exposure_s);
    // 0.5 of the saturation of 40,550 electrons, within one step of the ladder.
    let peak = planets(&on).iter().map(|planet| planet.peak_electrons).fold(0.0, f64::max);
    assert!((5_000.0..=20_300.0).contains(&peak), "{peak}");
}
