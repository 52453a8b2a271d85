//! Files that other tools wrote (golden/flight_dynamics/make.py), read and interpolated as those tools do.

use std::path::{Path, PathBuf};

use boresight_flight_dynamics::{
    Aem, CovarianceFrame, InitialState, Oem, Opm, OrbitEphemeris, ReferenceFrame, SpacecraftParameters, Spk,
    Tdm, TimeSystem, Tle,
};
use contract::{Angle, Direction, Icrs};
use hifitime::Epoch;
use nalgebra::Vector3;
use sim::truth::ManoeuvreAxes;

fn golden(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../golden/flight_dynamics").join(name)
}

/// Rows of a table: text columns first, then numbers.
fn rows(name: &str, texts: usize) -> Vec<(Vec<String>, Vec<f64>)> {
    let text = std::fs::read_to_string(golden(name)).unwrap();
    let row = |line: &str| {
        let words: Vec<&str> = line.split(',').collect();
        let (head, numbers) = words.split_at(texts);
        let numbers = numbers.iter().map(|number| number.parse().unwrap()).collect();
        (head.iter().map(ToString::to_string).collect(), numbers)
    };
    text.lines().skip(1).map(row).collect()
}

fn tai(text: &str) -> Epoch {
    TimeSystem::Tai.parse_time(text).unwrap()
}

/// Largest differences of position, km, and velocity, km/s, from the rows of a file.
fn worst(name: &str, table: &str, ephemeris: &OrbitEphemeris) -> (f64, f64) {
    let (mut position, mut velocity, mut count) = (0.0_f64, 0.0_f64, 0);
    for (head, numbers) in rows(table, 2).iter().filter(|(head, _)| head[0] == name) {
        let state = ephemeris.state_at(tai(&head[1])).unwrap();
        position = position.max((state.position_km - Vector3::from_column_slice(&numbers[..3])).norm());
        velocity = velocity.max((state.velocity_km_s - Vector3::from_column_slice(&numbers[3..])).norm());
        count += 1;
    }
    assert!(count >= 12, "{name}: {count} rows");
    (position, velocity)
}

#[test]
fn ephemerides_of_orekit_and_oem_are_interpolated_as_they_do() {
    // Rounding: positions of 7000 km have a resolution of 1e-12 km, times of 0.1 ns (7e-10 km); the frame
    // bias of SOFA and Orekit differs by 0.2 µas from its rounded angles; Orekit's velocity of LAGRANGE is
    // the derivative of the positions.
    for (name, position_km, velocity_km_s) in [
        ("orekit-hermite.oem", 1e-8, 3e-11),
        // Three nodes of degree 5: Orekit takes other neighbours, and the remainder is 3e-8 km.
        ("orekit-hermite.oem.xml", 6e-8, 1e-8),
        ("orekit-lagrange.oem", 3e-9, 1e-6),
        ("oem-hermite.oem", 1e-8, 3e-11),
        ("oem-lagrange.oem.xml", 1e-8, 3e-11),
        // Nutation: Orekit's is that of 1980 in full, 20 mas are 0.7 m.
        ("orekit-teme.oem", 7e-4, 7e-7),
    ] {
        let oem = Oem::read(&golden(name)).unwrap();
        let (position, velocity) = worst(name, "states.csv", &oem.ephemeris());
        println!("{name}: {position:.1e} km, {velocity:.1e} km/s");
        assert!(position < position_km && velocity < velocity_km_s, "{name}: {position:e} {velocity:e}");
    }
}

#[test]
fn metadata_and_covariance_of_orekit_are_read() {
    for name in ["orekit-hermite.oem", "orekit-hermite.oem.xml"] {
        let oem = Oem::read(&golden(name)).unwrap();
        let segment = &oem.segments[0];
        assert_eq!((oem.header.originator.as_str(), segment.object_id.as_str()), ("OREKIT", "2010-028B"));
        assert_eq!(segment.frame, ReferenceFrame::Eme2000);
        let [covariance] = segment.covariances.as_slice() else { panic!("{}", segment.covariances.len()) };
        assert_eq!(covariance.frame, CovarianceFrame::Reference(ReferenceFrame::Eme2000));
        let expected = [
            4e-4, 1e-4, 9e-4, 0.0, 0.0, 1e-4, 0.0, 0.0, 0.0, 4e-10, 0.0, 0.0, -3e-8, 0.0, 1e-10, 0.0, 0.0,
            0.0, 0.0, 0.0, 9e-10,
        ];
        for (got, expected) in covariance.lower_triangle.iter().zip(expected) {
            assert!((got - expected).abs() <= 1e-12 * expected.abs(), "{got} {expected}");
        }
    }
    assert_eq!(Oem::read(&golden("orekit-lagrange.oem")).unwrap().segments.len(), 2);
}

#[test]
fn kernels_of_spice_are_evaluated_as_it_does() {
    for kind in [2, 3, 8, 9, 13] {
        let name = format!("spice-type{kind}.bsp");
        for target in [None, Some(-200)] {
            let spk = Spk::read(&golden(&name), target).unwrap();
            assert_eq!(spk.target(), -200);
            // TDB as a 64-bit number of seconds: 0.06 µs, 5e-7 km along the orbit; 5e-10 km/s of its
            // velocity.
            let (position, velocity) = worst(&name, "states.csv", &spk.into());
            println!("{name}: {position:.1e} km, {velocity:.1e} km/s");
            assert!(position < 1e-6 && velocity < 1e-9, "{name}: {position:e} {velocity:e}");
        }
        let error = Spk::read(&golden(&name), Some(399)).unwrap_err().to_string();
        assert!(
            error.ends_with("`body` is `399`, expected NAIF's number of a body in the file: -200"),
            "{error}"
        );
    }
}

#[test]
fn states_in_teme_are_turned_as_by_orekit() {
    let mut worst = 0.0_f64;
    for (head, numbers) in rows("teme.csv", 1) {
        let vector = |first: usize| Vector3::from_column_slice(&numbers[first..first + 3]);
        let text = format!(
            "CCSDS_OPM_VERS = 2.0\nCREATION_DATE = 2012-04-20T00:00:00\nORIGINATOR = X\nOBJECT_NAME = X\nOBJECT_ID = X\n\
             CENTER_NAME = EARTH\nREF_FRAME = TEME\nTIME_SYSTEM = TAI\nEPOCH = {}\nX = {}\nY = {}\nZ = {}\nX_DOT = {}\n\
             Y_DOT = {}\nZ_DOT = {}\n",
            head[0], numbers[0], numbers[1], numbers[2], numbers[3], numbers[4], numbers[5]
        );
        let opm = Opm::parse(Path::new("file"), &text).unwrap();
        let direction = |vector: Vector3<f64>| Direction::<Icrs>::from_vector(vector).unwrap();
        let angle = direction(opm.icrs_state().position_km).separation(&direction(vector(6)));
        worst = worst.max(angle.degrees() * 3600.0);
    }
    println!("TEME: {worst:.4} arcsec");
    // 20 mas of nutation, and the terms of 2.6 mas that the equation of the equinoxes has in Orekit.
    assert!(worst < 0.025 && worst > 1e-5, "{worst} arcsec");
}

#[test]
fn elements_are_propagated_as_by_sgp4() {
    for (name, position_km, velocity_km_s) in [("test.tle", 1e-3, 1e-6), ("deep.tle", 5e-3, 3e-6)] {
        let tle = Tle::read(&golden(name)).unwrap();
        let (position, velocity) = worst(name, "tle.csv", &tle.into());
        println!("{name}: {position:.1e} km, {velocity:.1e} km/s");
        // 20 mas of nutation: 0.7 m at 6800 km, 4.5 m at the apogee of 46,000 km.
        assert!(position < position_km && velocity < velocity_km_s, "{name}: {position:e} {velocity:e}");
    }
}

#[test]
fn attitudes_of_orekit_turn_vectors_as_it_does() {
    for name in ["orekit.aem", "orekit-v2.aem", "orekit.aem.xml", "orekit-reverse.aem"] {
        let attitude = Aem::read(&golden(name)).unwrap().ephemeris();
        let mut count = 0;
        for (head, numbers) in rows("attitudes.csv", 2).iter().filter(|(head, _)| head[0] == name) {
            let body_from_icrs = attitude.rotation_at(tai(&head[1])).unwrap();
            for (axis, expected) in [Vector3::x(), Vector3::y(), Vector3::z()].iter().zip(numbers.chunks(3)) {
                let error = (body_from_icrs.rotate(axis) - Vector3::from_column_slice(expected)).norm();
                // Orekit's frame bias of EME2000 is that of the conventions to 1 µas.
                assert!(error < 1e-11, "{name}: {error:e}");
                count += 1;
            }
        }
        assert_eq!(count, 15, "{name}");
    }
}

#[test]
fn states_and_manoeuvres_of_orekit_are_read() {
    let rows = rows("parameters.csv", 2);
    for name in ["orekit.opm", "orekit.opm.xml"] {
        let opm = Opm::read(&golden(name)).unwrap();
        let (head, numbers) = rows.iter().find(|(head, _)| head[0] == name).unwrap();
        assert_eq!(opm.state.time, tai(&head[1]), "{name}");
        let state = opm.icrs_state();
        let error = (state.position_km - Vector3::from_column_slice(&numbers[..3])).norm();
        // 0.2 µas between two frame biases, as for ephemerides.
        assert!(error < 6e-9, "{name}: {error:e}");
        let error = (state.velocity_km_s - Vector3::from_column_slice(&numbers[3..])).norm();
        assert!(error < 6e-12, "{name}: {error:e}");
        let expected = SpacecraftParameters {
            mass_kg: Some(145.0),
            solar_radiation_area_m2: Some(1.3),
            solar_radiation_coefficient: Some(1.32),
            drag_area_m2: Some(1.1),
            drag_coefficient: Some(2.5),
        };
        assert_eq!(opm.parameters, expected, "{name}");
        let covariance = opm.covariance.unwrap();
        assert_eq!(covariance.frame, CovarianceFrame::Rtn);
        let [xx, yx, yy] = [0, 1, 2].map(|index| covariance.lower_triangle[index]);
        assert_eq!((xx, yx, yy, covariance.lower_triangle[12]), (4e-4, 1e-4, 9e-4, -3e-8), "{name}");

        // A burn of 12.5 s along R, T, N ten minutes after the state, and an impulse along the state's axes.
        let read = InitialState::read(&golden(name)).unwrap();
        let [burn, impulse] = read.manoeuvres.as_slice() else { panic!("{:?}", read.manoeuvres) };
        let after_s = |time: Epoch| (time - opm.state.time).to_seconds();
        assert!((after_s(burn.time) - 606.25).abs() < 1e-9 && after_s(impulse.time) == 1800.0, "{name}");
        assert_eq!((burn.duration_s, impulse.duration_s), (12.5, 0.0), "{name}");
        assert_eq!((burn.axes, impulse.axes), (ManoeuvreAxes::Rtn, ManoeuvreAxes::Icrs), "{name}");
        let error_m_s = |dv_m_s: [f64; 3], expected: Vector3<f64>| (Vector3::from(dv_m_s) - expected).norm();
        assert!(error_m_s(burn.dv_m_s, Vector3::new(0.01, -0.2, 0.03)) < 1e-15, "{name}");
        // 23 mas of 0.1 m/s between EME2000 and ICRS.
        let error = error_m_s(impulse.dv_m_s, Vector3::new(0.1, 0.0, -0.05));
        assert!(error < 2e-8 && (error > 1e-10) == (name == "orekit.opm"), "{name}: {error:e}");
        assert!((read.drag_m2_kg.unwrap() - 2.5 * 1.1 / 145.0).abs() < 1e-15, "{name}");
        assert!((read.radiation_m2_kg.unwrap() - 1.32 * 1.3 / 145.0).abs() < 1e-15, "{name}");
    }
}

#[test]
fn angles_of_orekit_are_read() {
    for name in ["orekit.tdm", "orekit.tdm.xml"] {
        let tdm = Tdm::read(&golden(name)).unwrap();
        let segment = &tdm.segments[0];
        assert_eq!((segment.observer.as_str(), segment.target.as_str()), ("MANGO", "TANGO"));
        let rows = rows("directions.csv", 2);
        let rows: Vec<_> = rows.iter().filter(|(head, _)| head[0] == name).collect();
        assert_eq!((rows.len(), segment.observations.len()), (6, 6));
        for ((head, numbers), observation) in rows.iter().zip(&segment.observations) {
            assert_eq!(observation.time, tai(&head[1]));
            assert!((observation.right_ascension_deg - numbers[0]).abs() < 1e-12);
            assert!((observation.declination_deg - numbers[1]).abs() < 1e-12);
            // The frame of the message is EME2000: 23 mas from ICRS.
            let plain = Direction::<Icrs>::from_ra_dec(
                Angle::from_degrees(numbers[0]),
                Angle::from_degrees(numbers[1]),
            );
            let bias = observation.direction(segment.frame).separation(&plain).degrees() * 3600.0;
            assert!(bias > 1e-3 && bias < 0.024, "{bias}");
        }
    }
}
