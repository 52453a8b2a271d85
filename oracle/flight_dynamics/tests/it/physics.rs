//! Orbits and attitudes of valid form that no spacecraft flies are refused with line and likely slip, and
//! valid ones pass without a remark.

use std::fmt::Write;
use std::path::{Path, PathBuf};

use boresight_flight_dynamics::{Aem, InitialState, Oem};
use nalgebra::{Rotation3, Vector3};
use sim::truth::{EARTH_GM_KM3_S2, Elements, State};

/// First line of data of the first segment in the messages of this file.
const FIRST_LINE: usize = 14;

/// Low, polar and almost circular.
const LOW: Elements = Elements {
    semi_major_axis_km: 7_000.0,
    eccentricity: 0.002,
    inclination_rad: 1.7,
    raan_rad: 2.0,
    argument_of_perigee_rad: 0.4,
    mean_anomaly_rad: 0.7,
};

/// Geostationary but for a small inclination.
const GEOSTATIONARY: Elements = Elements {
    semi_major_axis_km: 42_164.0,
    eccentricity: 0.000_3,
    inclination_rad: 0.003,
    raan_rad: 1.0,
    argument_of_perigee_rad: 0.4,
    mean_anomaly_rad: 0.7,
};

/// Molniya, through its perigee.
const HIGHLY_ECCENTRIC: Elements = Elements {
    semi_major_axis_km: 26_600.0,
    eccentricity: 0.74,
    inclination_rad: 1.107,
    raan_rad: 1.0,
    argument_of_perigee_rad: 4.7,
    mean_anomaly_rad: 6.1,
};

fn kepler(elements: Elements, time_s: f64) -> State {
    let mean_anomaly_rad = elements.mean_anomaly_rad + elements.mean_motion_rad_s() * time_s;
    Elements { mean_anomaly_rad, ..elements }.state()
}

fn orbit(elements: Elements, step_s: f64, count: u32) -> Vec<(f64, State)> {
    (0..count).map(|k| f64::from(k) * step_s).map(|time_s| (time_s, kepler(elements, time_s))).collect()
}

/// Motion by leapfrog steps of 0.1 s under the attraction of a point mass and a thrust, km/s², which is a
/// function of time, position and velocity.
fn flown(
    mut state: State,
    step_s: f64,
    count: u32,
    thrust: impl Fn(f64, &State) -> Vector3<f64>,
) -> Vec<(f64, State)> {
    let mut states = Vec::new();
    for node in 0..count {
        let start_s = f64::from(node) * step_s;
        states.push((start_s, state));
        let steps = (step_s * 10.0) as u32;
        for step in 0..steps {
            let time_s = start_s + f64::from(step) * 0.1;
            let middle = state.position_km + state.velocity_km_s * 0.05;
            let distance = middle.norm();
            let gravity = -middle * (EARTH_GM_KM3_S2 / (distance * distance * distance));
            state.velocity_km_s += (gravity + thrust(time_s, &state)) * 0.1;
            state.position_km = middle + state.velocity_km_s * 0.05;
        }
    }
    states
}

fn time(seconds: f64) -> String {
    let milliseconds = (seconds * 1000.0).round() as u64;
    let (whole, rest) = (milliseconds / 1000, milliseconds % 1000);
    let (days, hours, minutes) = (whole / 86_400, whole / 3_600 % 24, whole / 60 % 60);
    format!("2012-04-{:02}T{hours:02}:{minutes:02}:{:02}.{rest:03}", 1 + days, whole % 60)
}

/// Segment with states, positions rounded to a metre and velocities to a millimetre per second.
fn segment(states: &[(f64, State)], degree: usize) -> String {
    let mut text = format!(
        "META_START\nOBJECT_NAME = A\nOBJECT_ID = 2010-028B\nCENTER_NAME = EARTH\nREF_FRAME = ICRF\n\
         TIME_SYSTEM = TAI\nSTART_TIME = {}\nSTOP_TIME = {}\nINTERPOLATION = LAGRANGE\n\
         INTERPOLATION_DEGREE = {degree}\nMETA_STOP\n",
        time(states[0].0),
        time(states[states.len() - 1].0)
    );
    // The header has 3 lines; the metadata above has 11 lines, of which the last is the marker.
    for (time_s, State { position_km: r, velocity_km_s: v }) in states {
        let numbers = format!("{:.3} {:.3} {:.3} {:.6} {:.6} {:.6}", r.x, r.y, r.z, v.x, v.y, v.z);
        writeln!(text, "{} {numbers}", time(*time_s)).unwrap();
    }
    text
}

const OEM_HEADER: &str = "CCSDS_OEM_VERS = 2.0\nCREATION_DATE = 2012-04-20T00:00:00\nORIGINATOR = TEST\n";

/// Result of a check of a message: the remarks, or the error.
fn read_oem(text: &str) -> Result<Vec<String>, String> {
    let file = tempfile::NamedTempFile::new().unwrap();
    std::fs::write(file.path(), text).unwrap();
    Oem::read_motion(file.path()).map(|(_, remarks)| remarks).map_err(|error| error.to_string())
}

fn check(states: &[(f64, State)]) -> Result<Vec<String>, String> {
    read_oem(&format!("{OEM_HEADER}{}", segment(states, 7)))
}

/// Checks that states are accepted without a remark.
#[track_caller]
fn passes(name: &str, states: &[(f64, State)]) {
    assert_eq!(check(states), Ok(Vec::new()), "{name}");
}

/// Checks that states are refused at the line of a node, from 0, with words.
#[track_caller]
fn refused(states: &[(f64, State)], node: usize, words: &str) {
    let message = check(states).expect_err("accepted");
    let line = format!(", line {}: ", FIRST_LINE + 1 + node);
    assert!(message.contains(&line) && message.contains(words), "{message}\nexpected{line}{words}");
}

fn changed(states: &[(f64, State)], change: impl Fn(&mut State)) -> Vec<(f64, State)> {
    let mut states = states.to_vec();
    states.iter_mut().for_each(|(_, state)| change(state));
    states
}

fn golden(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../golden/flight_dynamics").join(name)
}

#[test]
fn orbits_of_every_kind_pass_without_a_remark() {
    for (name, elements, step_s) in [
        ("low, 1 s", LOW, 1.0),
        ("low, 10 s", LOW, 10.0),
        ("low, 60 s", LOW, 60.0),
        ("low, 180 s", LOW, 180.0),
        ("geostationary, 60 s", GEOSTATIONARY, 60.0),
        ("geostationary, 1 h", GEOSTATIONARY, 3_600.0),
        ("highly eccentric, 60 s", HIGHLY_ECCENTRIC, 60.0),
        ("retrograde", Elements { inclination_rad: 2.9, ..LOW }, 60.0),
    ] {
        passes(name, &orbit(elements, step_s, 60));
    }
}

#[test]
fn hyperbolas_pass_without_a_remark() {
    let start = State {
        position_km: Vector3::new(-20_000.0, 9_000.0, 1_000.0),
        velocity_km_s: Vector3::new(9.0, 1.0, 1.0),
    };
    passes("hyperbola", &flown(start, 60.0, 60, |_, _| Vector3::zeros()));
}

#[test]
fn manoeuvres_pass_without_a_remark() {
    let start = kepler(LOW, 0.0);
    let along = |state: &State, acceleration: f64| state.velocity_km_s.normalize() * acceleration;
    // 10 m/s within a step; 20 m/s in 200 s; 0.2 mm/s² all the time.
    passes(
        "impulse",
        &flown(start, 60.0, 40, |time_s, state| {
            along(state, if (1_000.0..1_000.1).contains(&time_s) { 0.1 } else { 0.0 })
        }),
    );
    passes(
        "burn",
        &flown(start, 60.0, 40, |time_s, state| {
            along(state, if (1_000.0..1_200.0).contains(&time_s) { 1e-4 } else { 0.0 })
        }),
    );
    passes("electric", &flown(start, 60.0, 40, |_, state| along(state, 2e-7)));
}

#[test]
fn messages_of_other_tools_pass_without_a_remark() {
    for name in [
        "oem-hermite.oem",
        "oem-lagrange.oem.xml",
        "orekit-hermite.oem",
        "orekit-hermite.oem.xml",
        "orekit-lagrange.oem",
        "orekit-teme.oem",
    ] {
        let (_, remarks) = Oem::read_motion(&golden(name)).unwrap();
        assert_eq!(remarks, Vec::<String>::new(), "{name}");
    }
    for name in ["orekit.aem", "orekit.aem.xml", "orekit-reverse.aem", "orekit-v2.aem"] {
        let (_, remarks) = Aem::read_pointing(&golden(name)).unwrap();
        assert_eq!(remarks, Vec::<String>::new(), "{name}");
    }
}

#[test]
fn velocities_that_are_no_derivative_are_refused_with_their_slip() {
    let states = orbit(LOW, 60.0, 40);
    let with =
        |change: &dyn Fn(&mut Vector3<f64>)| changed(&states, |state| change(&mut state.velocity_km_s));
    refused(&with(&|v| *v *= 0.0), 0, "the velocities are missing");
    refused(&with(&|v| *v = -*v), 1, "the velocities have the wrong sign");
    refused(&with(&|v| *v *= 1e3), 0, "m/s are 1000 times larger");
    refused(&with(&|v| *v *= 1e-3), 1, "1000 times too small");
    refused(&with(&|v| v.swap_rows(0, 1)), 1, "components of the velocities are in another order");
    // Far out, where the speed in another unit is that of some orbit.
    let far = orbit(GEOSTATIONARY, 600.0, 40);
    refused(&changed(&far, |state| state.velocity_km_s *= -1.0), 1, "the velocities have the wrong sign");
}

#[test]
fn axes_that_rotate_with_the_earth_are_recognised() {
    let rate = 7.292_115e-5;
    for (elements, step_s) in [(LOW, 60.0), (HIGHLY_ECCENTRIC, 60.0), (GEOSTATIONARY, 600.0)] {
        let mut states = orbit(elements, step_s, 40);
        for (_, State { position_km, velocity_km_s }) in &mut states {
            *velocity_km_s -= Vector3::new(0.0, 0.0, rate).cross(position_km);
        }
        let mut rotating = states.clone();
        for (time_s, State { position_km, velocity_km_s }) in &mut rotating {
            let turn = Rotation3::from_axis_angle(&Vector3::z_axis(), -rate * *time_s);
            (*position_km, *velocity_km_s) = (turn * *position_km, turn * *velocity_km_s);
        }
        let message = |states: &[(f64, State)]| check(states).expect_err("accepted");
        let relative = message(&states);
        let rotating = message(&rotating);
        assert!(relative.contains("relative to the rotating Earth"), "{relative}");
        assert!(rotating.contains("the axes rotate with the Earth"), "{rotating}");
    }
}

#[test]
fn a_state_off_its_neighbours_is_refused_with_its_line() {
    for (elements, step_s) in [(LOW, 60.0), (LOW, 10.0), (GEOSTATIONARY, 600.0), (HIGHLY_ECCENTRIC, 60.0)] {
        for change in [
            |state: &mut State| state.position_km.x += 50.0,
            |state: &mut State| state.position_km.z = -state.position_km.z,
            |state: &mut State| state.velocity_km_s.y += 0.5,
            |state: &mut State| state.velocity_km_s = -state.velocity_km_s,
        ] {
            let mut states = orbit(elements, step_s, 40);
            change(&mut states[17].1);
            refused(&states, 17, "");
        }
    }
    let mut states = orbit(LOW, 60.0, 40);
    states[0].1.position_km.x += 50.0;
    refused(&states, 1, "a jump between two states");
    let mut states = orbit(LOW, 60.0, 40);
    states[17].0 += 10.0;
    refused(&states, 17, "its time");
}

#[test]
fn small_deviations_are_remarks() {
    let mut states = orbit(LOW, 60.0, 40);
    states[17].1.position_km.x += 0.4;
    let remarks = check(&states).unwrap();
    assert!(remarks.len() == 1 && remarks[0].contains("km off the motion under gravity"), "{remarks:?}");
    // A large manoeuvre.
    let burn = |time_s: f64, state: &State| {
        state.velocity_km_s.normalize() * if (1_000.0..1_100.0).contains(&time_s) { 0.005 } else { 0.0 }
    };
    let remarks = check(&flown(kepler(LOW, 0.0), 60.0, 40, burn)).unwrap();
    assert!(remarks.iter().any(|remark| remark.contains("beyond gravity; a manoeuvre")), "{remarks:?}");
}

#[test]
fn an_interpolation_that_leaves_the_orbit_is_a_remark() {
    let states = orbit(LOW, 60.0, 40);
    let remarks = read_oem(&format!("{OEM_HEADER}{}", segment(&states, 1))).unwrap();
    assert!(remarks.len() == 1 && remarks[0].contains("the interpolation of degree 1"), "{remarks:?}");
}

#[test]
fn a_jump_between_segments_is_found() {
    let states = orbit(LOW, 60.0, 41);
    for (jump_km, is_error) in [(50.0, true), (1.0, false)] {
        let mut later = states[20..].to_vec();
        later.iter_mut().for_each(|(_, state)| state.position_km.x += jump_km);
        let text = format!("{OEM_HEADER}{}{}", segment(&states[..=20], 7), segment(&later, 7));
        let line = format!(", line {}: ", FIRST_LINE + 21 + 12);
        match read_oem(&text) {
            Ok(remarks) => {
                assert!(!is_error && remarks.len() == 1 && remarks[0].contains(&line), "{remarks:?}");
            }
            Err(message) => assert!(is_error && message.contains(&line), "{message}"),
        }
    }
}

#[test]
fn the_state_of_a_parameter_message_has_a_velocity_of_an_orbit() {
    let opm = std::fs::read_to_string(golden("orekit.opm")).unwrap();
    let refused = |value: &dyn Fn(f64) -> f64| {
        let changed: Vec<String> = opm
            .lines()
            .map(|line| match line.split_once('=') {
                Some((keyword, rest)) if keyword.trim().ends_with("_DOT") => {
                    let number: f64 = rest.split('[').next().unwrap().trim().parse().unwrap();
                    format!("{keyword} = {}", value(number))
                }
                _ => line.to_owned(),
            })
            .collect();
        InitialState::parse(Path::new("a.opm"), &(changed.join("\n") + "\n")).err().map(|e| e.to_string())
    };
    assert_eq!(refused(&|v| v), None);
    assert!(refused(&|_| 0.0).unwrap().contains("the velocities are missing"));
    assert!(refused(&|v| v * 1e-3).unwrap().contains("in another unit"));
}

const AEM_HEADER: &str = "CCSDS_AEM_VERS = 1.0\nCREATION_DATE = 2012-04-20T00:00:00\nORIGINATOR = TEST\n";

/// Attitudes: time, s, and Q1, Q2, Q3, QC.
fn read_aem(nodes: &[(f64, [f64; 4])]) -> Result<Vec<String>, String> {
    let mut text = format!(
        "{AEM_HEADER}META_START\nOBJECT_NAME = A\nOBJECT_ID = 2010-028B\nREF_FRAME_A = ICRF\n\
         REF_FRAME_B = SC_BODY_1\nATTITUDE_DIR = A2B\nTIME_SYSTEM = TAI\nSTART_TIME = {}\nSTOP_TIME = {}\n\
         ATTITUDE_TYPE = QUATERNION\nMETA_STOP\nDATA_START\n",
        time(nodes[0].0),
        time(nodes[nodes.len() - 1].0)
    );
    for (time_s, [a, b, c, d]) in nodes {
        writeln!(text, "{} {a:.9} {b:.9} {c:.9} {d:.9}", time(*time_s)).unwrap();
    }
    text.push_str("DATA_STOP\n");
    let file = tempfile::NamedTempFile::new().unwrap();
    std::fs::write(file.path(), text).unwrap();
    Aem::read_pointing(file.path()).map(|(_, remarks)| remarks).map_err(|error| error.to_string())
}

/// A turn at a constant rate, degrees per second, from an attitude without symmetries.
fn turn(step_s: f64, count: u32, rate_deg_s: f64) -> Vec<(f64, [f64; 4])> {
    let start = nalgebra::UnitQuaternion::from_euler_angles(0.3, -0.8, 1.9);
    let axis = nalgebra::Unit::new_normalize(Vector3::new(0.2, 0.5, -0.7));
    (0..count)
        .map(|k| {
            let time_s = f64::from(k) * step_s;
            let by = nalgebra::UnitQuaternion::from_axis_angle(&axis, (rate_deg_s * time_s).to_radians());
            let q = by * start;
            (time_s, [q.i, q.j, q.k, q.w])
        })
        .collect()
}

#[test]
fn turns_of_every_rate_pass_without_a_remark() {
    for (step_s, rate_deg_s) in [(1.0, 0.0), (60.0, 0.06), (10.0, 1.0), (1.0, 6.0), (0.1, 30.0), (60.0, 1.5)]
    {
        let rate = if rate_deg_s * step_s > 60.0 { 60.0 / step_s } else { rate_deg_s };
        assert_eq!(read_aem(&turn(step_s, 50, rate)), Ok(Vec::new()), "{step_s} s, {rate_deg_s} °/s");
    }
    // A slew by 60° within a minute between two steady attitudes, and signs that alternate.
    let mut slew = turn(10.0, 50, 0.0);
    let turned = turn(10.0, 50, 1.0);
    for (node, (_, quaternion)) in slew.iter_mut().enumerate() {
        *quaternion = turned[node.clamp(20, 26) - 20].1;
        if node % 2 == 0 {
            *quaternion = quaternion.map(|component| -component);
        }
    }
    assert_eq!(read_aem(&slew), Ok(Vec::new()));
}

#[test]
fn scrambled_quaternions_are_refused_with_their_line() {
    let line = |node: usize| format!(", line {}: ", 16 + node);
    for (step_s, rate) in [(1.0, 0.05), (10.0, 0.05), (60.0, 0.06)] {
        for order in [[3, 0, 1, 2], [1, 0, 2, 3], [2, 1, 0, 3]] {
            let mut nodes = turn(step_s, 50, rate);
            let quaternion = nodes[20].1;
            nodes[20].1 = order.map(|index| quaternion[index]);
            let message = read_aem(&nodes).unwrap_err();
            let expected = "its components are in another order";
            assert!(message.contains(&line(20)) && message.contains(expected), "{message}");
        }
        let mut nodes = turn(step_s, 50, rate);
        let [a, b, c, d] = nodes[20].1;
        nodes[20].1 = [-a, -b, -c, d];
        let message = read_aem(&nodes).unwrap_err();
        assert!(message.contains(&line(20)), "{message}");
    }
    // From one node on.
    let mut nodes = turn(1.0, 50, 0.05);
    for (_, quaternion) in nodes.iter_mut().skip(30) {
        *quaternion = [quaternion[3], quaternion[0], quaternion[1], quaternion[2]];
    }
    let message = read_aem(&nodes).unwrap_err();
    assert!(message.contains(&line(30)) && message.contains("in another order"), "{message}");
}

#[test]
fn turns_whose_direction_is_ambiguous_are_a_remark() {
    let remarks = read_aem(&turn(60.0, 50, 2.5)).unwrap();
    assert!(remarks.len() == 1 && remarks[0].contains("ambiguous"), "{remarks:?}");
}

#[test]
fn version_1_needs_the_direction() {
    let text = std::fs::read_to_string(golden("orekit.aem")).unwrap();
    let without: Vec<&str> = text.lines().filter(|line| !line.starts_with("ATTITUDE_DIR")).collect();
    let message = Aem::parse(Path::new("a.aem"), &(without.join("\n") + "\n")).unwrap_err().to_string();
    assert!(message.contains("`ATTITUDE_DIR` is `missing`") && message.contains("line"), "{message}");
}
