//! Written messages are read as the same messages, in both notations.

use std::path::Path;

use boresight_flight_dynamics::{
    Aem, AemSegment, AttitudeDirection, AttitudeNode, CAMERA_FRAME, Covariance, CovarianceFrame, Coverage,
    Header, Interpolation, Manoeuvre, Method, Notation, Observation, Oem, OemSegment, Opm, ReferenceFrame,
    SpacecraftParameters, StateNode, Tdm, TdmSegment, TimeSystem,
};
use contract::{Direction, Rotation};
use hifitime::{Duration, Epoch};
use nalgebra::Vector3;
use proptest::prelude::*;
use sim::truth::clock;

fn time(seconds: f64) -> Epoch {
    let nanoseconds = (seconds * 1e9).round() as i128;
    clock::parse_utc("2012-06-30T23:59:00Z").unwrap() + Duration::from_total_nanoseconds(nanoseconds)
}

fn header() -> Header {
    Header {
        originator: "A & B <C>".to_owned(),
        creation_time: time(0.0),
        message_id: None,
        comments: vec![],
    }
}

fn node(seconds: f64) -> StateNode {
    // A leap second is within the span: the states are a function of SI seconds.
    let (sin, cos) = libm::sincos(0.001 * seconds);
    StateNode {
        time: time(seconds),
        position_km: Vector3::new(7000.0 * cos, 7000.0 * sin, 1.0 / 3.0 - 1e-7 * seconds),
        velocity_km_s: Vector3::new(-7.0 * sin, 7.0 * cos, -1e-7),
    }
}

fn covariance(frame: CovarianceFrame) -> Covariance {
    let mut lower_triangle = [0.0; 21];
    for (index, number) in lower_triangle.iter_mut().enumerate() {
        *number = 3.3e-4 / (1.0 + index as f64);
    }
    Covariance { time: time(30.0), frame, lower_triangle }
}

fn oem(system: TimeSystem, frame: ReferenceFrame) -> Oem {
    let segment = |first: f64, covariances: Vec<Covariance>| OemSegment {
        object_name: "MANGO".to_owned(),
        object_id: "2010-028B".to_owned(),
        frame,
        time_system: system,
        coverage: Coverage { start: time(first + 10.0), stop: time(first + 110.0) },
        interpolation: Some(Interpolation { method: Method::Hermite, degree: 7 }),
        states: (0..13).map(|k| node(first + 10.0 * f64::from(k))).collect(),
        covariances,
    };
    let covariances = vec![
        covariance(CovarianceFrame::Reference(frame)),
        covariance(CovarianceFrame::Rtn),
        covariance(CovarianceFrame::Tnw),
    ];
    Oem { header: header(), segments: vec![segment(0.0, covariances), segment(100.0, vec![])] }
}

const NOTATIONS: [Notation; 2] = [Notation::Kvn, Notation::Xml];

#[test]
fn an_oem_comes_back_bit_for_bit() {
    let file = Path::new("file");
    for system in TimeSystem::ALL {
        for frame in [ReferenceFrame::Icrf, ReferenceFrame::Eme2000, ReferenceFrame::Teme] {
            for notation in NOTATIONS {
                let written = oem(system, frame);
                let read = Oem::parse(file, &written.to_text(notation)).unwrap();
                if system == TimeSystem::Tdb {
                    // TDB − TT is rounded to the nanosecond in both directions.
                    let pairs = written
                        .segments
                        .iter()
                        .zip(&read.segments)
                        .flat_map(|(a, b)| a.states.iter().zip(&b.states));
                    assert!(pairs.clone().count() == 26);
                    for (a, b) in pairs {
                        assert!((a.time - b.time).abs() <= Duration::from_nanoseconds(1.0));
                    }
                } else {
                    assert_eq!(read, written, "{system:?} {frame:?} {notation:?}");
                }
            }
        }
    }
}

#[test]
fn interpolation_meets_the_motion_also_over_a_leap_second() {
    let ephemeris = oem(TimeSystem::Utc, ReferenceFrame::Icrf).ephemeris();
    for tenth in 100..2100 {
        let seconds = f64::from(tenth) * 0.1;
        let (state, expected) = (ephemeris.state_at(time(seconds)).unwrap(), node(seconds));
        // The remainder of degree 7: (ωh)^8/8! with nodes every 10 s is 1e-21 of the radius; rounding is
        // left.
        assert!(
            (state.position_km - expected.position_km).norm() < 1e-11,
            "{seconds} {}",
            (state.position_km - expected.position_km).norm()
        );
        assert!((state.velocity_km_s - expected.velocity_km_s).norm() < 1e-11, "{seconds}");
    }
    assert!(ephemeris.state_at(time(9.99)).is_err() && ephemeris.state_at(time(210.01)).is_err());
}

#[test]
fn an_aem_comes_back_bit_for_bit_in_both_directions() {
    for (direction, frame) in [
        (AttitudeDirection::BodyFromFrame, ReferenceFrame::Icrf),
        (AttitudeDirection::FrameFromBody, ReferenceFrame::Eme2000),
    ] {
        let rotation = |k: i32| Rotation::from_rotation_vector(Vector3::new(0.1, -0.7, 0.02 * f64::from(k)));
        let written = Aem {
            header: header(),
            segments: vec![AemSegment {
                object_name: "MANGO".to_owned(),
                object_id: "2010-028B".to_owned(),
                frame,
                body_frame: "SC_BODY_1".to_owned(),
                direction,
                time_system: TimeSystem::Utc,
                coverage: Coverage { start: time(0.0), stop: time(90.0) },
                interpolation: None,
                attitudes: (0..10)
                    .map(|k| AttitudeNode::from_rotation(time(10.0 * f64::from(k)), &rotation(k)))
                    .collect(),
            }],
        };
        for notation in NOTATIONS {
            let read = Aem::parse(Path::new("file"), &written.to_text(notation)).unwrap();
            assert_eq!(read, written);
            let attitude = read.ephemeris().rotation_at(time(30.0)).unwrap();
            if direction == AttitudeDirection::BodyFromFrame {
                assert!(attitude.angle_to(&rotation(3)).radians() < 1e-15);
            } else {
                // The other direction, and 23 mas of frame bias.
                assert!(attitude.angle_to(&rotation(3).inverse_as_body()).degrees() * 3600.0 < 0.024);
            }
        }
    }
}

/// The inverse rotation under the same frames, for the comparison of directions.
trait InverseAsBody {
    fn inverse_as_body(&self) -> Self;
}

impl InverseAsBody for Rotation<contract::Body, contract::Icrs> {
    fn inverse_as_body(&self) -> Self {
        Self::from_unit_quaternion(self.quaternion().inverse())
    }
}

#[test]
fn attitudes_of_a_camera_come_back_as_those_of_an_instrument() {
    let rotation = |k: u32| -> Rotation<contract::CameraFrame, contract::Icrs> {
        Rotation::from_rotation_vector(Vector3::new(0.1, -0.7, 0.02 * f64::from(k)))
    };
    let nodes = |range: std::ops::Range<u32>| -> Vec<AttitudeNode> {
        range.map(|k| AttitudeNode::from_rotation(time(10.0 * f64::from(k)), &rotation(k))).collect()
    };
    let segment = AemSegment::from_attitudes("CHASER", CAMERA_FRAME, nodes(0..4)).unwrap();
    let written = Aem { header: header(), segments: vec![segment] };
    for notation in NOTATIONS {
        assert_eq!(Aem::parse(Path::new("file"), &written.to_text(notation)).unwrap(), written);
    }
    assert_eq!(AemSegment::from_attitudes("CHASER", CAMERA_FRAME, nodes(0..1)), None);
    let reversed = nodes(0..4).into_iter().rev().collect();
    assert_eq!(AemSegment::from_attitudes("CHASER", CAMERA_FRAME, reversed), None);
}

#[test]
fn attitudes_between_nodes_lie_on_the_shortest_turn_or_the_polynomial() {
    let rotation =
        |seconds: f64| Rotation::from_rotation_vector(Vector3::new(0.0, 0.0, 3.0 + 0.01 * seconds));
    let aem = |interpolation, negate: bool| Aem {
        header: header(),
        segments: vec![AemSegment {
            object_name: "MANGO".to_owned(),
            object_id: "2010-028B".to_owned(),
            frame: ReferenceFrame::Icrf,
            body_frame: "SC_BODY_1".to_owned(),
            direction: AttitudeDirection::BodyFromFrame,
            time_system: TimeSystem::Tai,
            coverage: Coverage { start: time(0.0), stop: time(90.0) },
            interpolation,
            attitudes: (0..10)
                .map(|k| {
                    let node = AttitudeNode::from_rotation(
                        time(10.0 * f64::from(k)),
                        &rotation(10.0 * f64::from(k)),
                    );
                    // Both signs of a quaternion are the same attitude.
                    let sign = if negate && k % 2 == 0 { -1.0 } else { 1.0 };
                    AttitudeNode { q1_q2_q3_qc: node.q1_q2_q3_qc.map(|component| sign * component), ..node }
                })
                .collect(),
        }],
    };
    for (interpolation, tolerance) in [
        (None, 1e-14),
        (Some(Interpolation { method: Method::Linear, degree: 1 }), 1e-14),
        (Some(Interpolation { method: Method::Lagrange, degree: 5 }), 1e-10),
        (Some(Interpolation { method: Method::Hermite, degree: 7 }), 1e-12),
    ] {
        for negate in [false, true] {
            let ephemeris = aem(interpolation, negate).ephemeris();
            for seconds in [0.0, 3.3, 10.0, 44.4, 87.0, 90.0] {
                let attitude = ephemeris.rotation_at(time(seconds)).unwrap();
                let error = attitude.angle_to(&rotation(seconds)).radians();
                assert!(error < tolerance, "{interpolation:?} {seconds} {error:e}");
            }
            assert!(ephemeris.rotation_at(time(90.1)).is_err());
        }
    }
}

#[test]
fn an_opm_comes_back_bit_for_bit() {
    let written = Opm {
        header: header(),
        object_name: "MANGO".to_owned(),
        object_id: "2010-028B".to_owned(),
        frame: ReferenceFrame::Eme2000,
        time_system: TimeSystem::Gps,
        state: node(30.0),
        parameters: SpacecraftParameters {
            mass_kg: Some(145.0),
            solar_radiation_area_m2: Some(1.3),
            solar_radiation_coefficient: Some(1.3),
            drag_area_m2: None,
            drag_coefficient: Some(2.5),
        },
        covariance: Some(covariance(CovarianceFrame::Rtn)),
        manoeuvres: vec![
            Manoeuvre {
                ignition: time(60.0),
                duration_s: 2.5,
                mass_change_kg: -0.01,
                frame: CovarianceFrame::Rtn,
                velocity_change_km_s: Vector3::new(0.0, 1e-5, -2e-5),
            },
            Manoeuvre {
                ignition: time(90.0),
                duration_s: 0.0,
                mass_change_kg: 0.0,
                frame: CovarianceFrame::Reference(ReferenceFrame::Icrf),
                velocity_change_km_s: Vector3::new(1e-6, 0.0, 0.0),
            },
        ],
    };
    for notation in NOTATIONS {
        assert_eq!(
            Opm::parse(Path::new("file"), &written.to_text(notation)).unwrap(),
            written,
            "{notation:?}"
        );
    }
}

#[test]
fn a_tdm_comes_back_bit_for_bit() {
    let direction = |k: i32| Direction::from_vector(Vector3::new(1.0, 0.1 * f64::from(k), -0.3)).unwrap();
    let written = Tdm {
        header: header(),
        segments: vec![TdmSegment {
            comments: vec![],
            observer: "MANGO".to_owned(),
            target: "TANGO".to_owned(),
            frame: ReferenceFrame::Icrf,
            time_system: TimeSystem::Utc,
            observations: (0..5)
                .map(|k| Observation::from_direction(time(30.0 * f64::from(k)), &direction(k)))
                .collect(),
        }],
    };
    for notation in NOTATIONS {
        let read = Tdm::parse(Path::new("file"), &written.to_text(notation)).unwrap();
        assert_eq!(read, written);
        let segment = &read.segments[0];
        let error = segment.observations[3].direction(segment.frame).separation(&direction(3));
        assert!(error.radians() < 1e-15);
    }
}

proptest! {
    #[test]
    fn every_number_of_a_state_comes_back(position in prop::array::uniform3(-1e9_f64..1e9), velocity in prop::array::uniform3(prop::num::f64::NORMAL)) {
        let mut written = oem(TimeSystem::Tai, ReferenceFrame::Icrf);
        written.segments[0].states[0].position_km = position.into();
        written.segments[0].states[0].velocity_km_s = velocity.into();
        for notation in NOTATIONS {
            prop_assert_eq!(&Oem::parse(Path::new("file"), &written.to_text(notation)).unwrap(), &written);
        }
    }

    #[test]
    fn no_text_panics(text in "(CCSDS_OEM_VERS = 2.0\n)?([A-Z_]{0,12}( ?= ?)?[0-9TZ:.eE\\-\\[\\]<>/ é]{0,30}\n){0,12}") {
        let file = Path::new("file");
        let _ = (Oem::parse(file, &text), Aem::parse(file, &text), Opm::parse(file, &text), Tdm::parse(file, &text));
    }
}

#[test]
fn states_and_covariances_of_a_navigator_become_a_message() {
    let matrix = nalgebra::Matrix6::from_fn(|row, column| 1.0 / (1.0 + row as f64 + column as f64));
    let states: Vec<_> = (0..9)
        .map(|k| {
            let StateNode { time, position_km, velocity_km_s } = node(20.0 * f64::from(k));
            (time, sim::truth::State { position_km, velocity_km_s }, (k % 4 == 0).then_some(matrix))
        })
        .collect();
    let degree_7 = Interpolation { method: Method::Hermite, degree: 7 };
    let of_states = |states: &[_]| OemSegment::from_states("TARGET", degree_7, states);
    let oem = Oem { header: header(), segments: vec![of_states(&states).unwrap()] };
    let read = Oem::parse(Path::new("file"), &oem.to_kvn()).unwrap();
    assert_eq!(read, oem);
    assert_eq!((read.segments[0].states.len(), read.segments[0].covariances.len()), (9, 3));
    let lower_triangle = read.segments[0].covariances[1].lower_triangle;
    assert_eq!(
        (lower_triangle[2], lower_triangle[13], lower_triangle[20]),
        (1.0 / 3.0, 1.0 / 8.0, 1.0 / 11.0)
    );
    let reversed: Vec<_> = states.iter().rev().cloned().collect();
    assert!(of_states(&reversed).is_none());
    assert!(of_states(&states[..4]).is_some() && of_states(&states[..3]).is_none());
}
