//! Conformance checks of navigators.

use hifitime::{Duration, Epoch, Unit};
use nalgebra::{Rotation3, Vector3};

use crate::navigation::{
    AngleErrors, Answer, ChaserOrbit, Covariance6, DifferentialDrag, Event, LineOfSightErrors,
    LineOfSightMeasurement, ManoeuvreReport, MeanElements, Mode, NavigationSetup, NavigatorFactory,
    NoEstimate, PriorOrbit, RelativeElements, SlowDisplacement, Use,
};
use crate::{Direction, Rotation};

use super::Violation;

/// Interval of the measurements, s.
const INTERVAL_S: f64 = 60.0;

/// Distance of the chaser behind the target, m.
const DISTANCE_M: f64 = 10_000.0;

/// Orbital radius, km, and rate of the mean argument of latitude, rad/s, of a polar circular orbit: n − γ
/// with n = √(GM/a³) and γ = 3/2 J2 (R/a)² n (EGM96).
const RADIUS_KM: f64 = 7130.0;
const LATITUDE_RATE: f64 = 1.0472969948e-3;

/// Runs the conformance checks with lines of sight of a chaser that follows the target on the same circular
/// orbit:
///
/// - the navigator answers each requested epoch, before, between and after the events, without a panic;
/// - no answer contains NaN, and σ are positive (which [`Covariance6`] guarantees) and finite;
/// - without any event there is a reason or the prior, and no estimate without a prior;
/// - two fresh navigators give the same answers, and answers do not change later ones;
/// - one measurement, a repeated one, a late one, one in the wrong order, a gap of days, a wild direction and
///   a manoeuvre cause no failure;
/// - the position is within 5 σ and 30 m of the true one;
/// - dispositions, if reported, are one per measurement, with one duplicate for a repeated one.
///
/// # Errors
/// Every violation found, in the order of the checks.
pub fn check(factory: &dyn NavigatorFactory) -> Result<(), Vec<Violation>> {
    let mut violations = Vec::new();
    for (input, prior, events) in inputs() {
        let mut broke = |broken: String| violations.push(Violation { input, broken });
        let setup = setup(prior);
        let run = |peek: bool| -> Result<Vec<Answer>, String> {
            let mut navigator = factory.build(&setup).map_err(|error| error.to_string())?;
            for event in &events {
                navigator.receive(event);
                if peek && factory.mode() == Mode::Sequential {
                    navigator.estimates(&[event.time()]);
                }
            }
            let answers = navigator.estimates(&epochs());
            let dispositions = navigator.dispositions();
            let count = events.iter().filter(|event| matches!(event, Event::LineOfSight(_))).count();
            if !dispositions.is_empty() && dispositions.len() != count {
                return Err(format!("{} dispositions of {count} measurements", dispositions.len()));
            }
            if input == "a repeated measurement" {
                let repeated = dispositions.iter().filter(|d| d.used == Use::Duplicate).count();
                if !dispositions.is_empty() && repeated != 1 {
                    return Err(format!("{repeated} duplicates, expected 1"));
                }
            }
            Ok(answers)
        };
        let (first, second) = match (run(false), run(true)) {
            (Ok(first), Ok(second)) => (first, second),
            (Err(broken), _) | (_, Err(broken)) => {
                broke(broken);
                continue;
            }
        };
        if first != second {
            broke("two new navigators, one asked more often, return different answers".to_owned());
        }
        if first.len() != epochs().len() {
            broke(format!("{} answers to {} epochs", first.len(), epochs().len()));
        }
        for (epoch, answer) in epochs().iter().zip(&first) {
            if let Some(broken) = violation(answer, *epoch, prior, events.len()) {
                broke(format!("{broken} at {epoch}"));
            }
        }
    }
    if violations.is_empty() { Ok(()) } else { Err(violations) }
}

/// Returns the reason why an answer is unusable.
fn violation(answer: &Answer, epoch: Epoch, prior: bool, events: usize) -> Option<String> {
    let estimate = match answer {
        Ok(_) if !prior && events < 3 => return Some("an estimate from nothing".to_owned()),
        Ok(estimate) => estimate,
        // A prior and a sound campaign determine an orbit.
        Err(reason) if prior && events >= 3 => return Some(format!("no estimate: {reason}")),
        Err(NoEstimate::Failed(reason)) => return Some(format!("a failure: {reason}")),
        Err(_) => return None,
    };
    let numbers = estimate.position_m.iter().chain(&estimate.velocity_m_s).copied();
    if !numbers.chain(estimate.elements.vector().iter().copied()).all(f64::is_finite) {
        return Some(format!("an estimate is not finite: {estimate:?}"));
    }
    if estimate.time != epoch {
        return Some(format!("an estimate is for {}", estimate.time));
    }
    let sigmas = estimate.covariance.sigmas();
    let angle = DISTANCE_M / (RADIUS_KM * 1000.0);
    let true_m = Vector3::new(-0.5 * angle * DISTANCE_M, -DISTANCE_M, 0.0);
    // Metres for the difference of mean and osculating elements, on which navigators may differ.
    let far = (0..3).find(|k| (estimate.position_m[*k] - true_m[*k]).abs() > 5.0 * sigmas[*k] + 30.0);
    let is_near = (epoch - start()).abs() < Unit::Hour * 12;
    far.filter(|_| is_near).map(|axis| {
        format!("component {axis} of {:?} is not within 5 σ {sigmas:?} of {true_m:?}", estimate.position_m)
    })
}

fn start() -> Epoch {
    Epoch::from_gregorian_utc_at_midnight(2012, 4, 23)
}

fn at(seconds: f64) -> Epoch {
    start() + Duration::from_seconds(seconds)
}

fn epochs() -> Vec<Epoch> {
    [-600.0, 0.0, 30.0, 3000.0, 9000.0, 40_000.0].map(at).to_vec()
}

fn setup(prior: bool) -> NavigationSetup {
    let elements = RelativeElements { a_dlambda_m: -DISTANCE_M, ..RelativeElements::default() };
    let covariance = Covariance6::from_sigmas([2.0, 300.0, 20.0, 20.0, 20.0, 20.0]).ok();
    // Wide enough for short-period variations, by which navigators may differ: 200″.
    let errors = AngleErrors { white_arcsec: [200.0; 2], slow: Vec::new(), constant_arcsec: [100.0; 3] };
    NavigationSetup {
        epoch: start(),
        chaser_orbit: ChaserOrbit::Mean(MeanElements {
            semi_major_axis_km: RADIUS_KM,
            eccentricity: 0.0,
            inclination_deg: 90.0,
            raan_deg: 0.0,
            argument_of_perigee_deg: 0.0,
            mean_anomaly_deg: 0.0,
        }),
        camera_from_body: Rotation::identity(),
        prior: covariance.filter(|_| prior).map(|covariance| PriorOrbit { elements, covariance }),
        errors: LineOfSightErrors {
            with_stars: errors.clone(),
            without_stars: errors,
            displacements: vec![SlowDisplacement { sigma_m: [0.2; 2], memory_s: 6000.0, period_s: None }],
        },
        drag: DifferentialDrag::default(),
    }
}

/// Line of sight of a chaser on a polar circular orbit to a target ahead on the same orbit, with a
/// deterministic error of up to an arc minute.
fn sight(number: u64) -> LineOfSightMeasurement {
    let seconds = INTERVAL_S * number as f64;
    let u = LATITUDE_RATE * seconds;
    let (sin, cos) = libm::sincos(u);
    let (radial, along) = (Vector3::new(cos, 0.0, sin), Vector3::new(-sin, 0.0, cos));
    let normal = radial.cross(&along);
    let camera = Rotation::from_axes(&-normal, &-radial, &along);
    let half = 0.5 * DISTANCE_M / (RADIUS_KM * 1000.0);
    let exact = along * libm::cos(half) - radial * libm::sin(half);
    let error = 3e-4 * libm::sin(number as f64 * 1.7);
    let turned = Rotation3::from_scaled_axis(normal * error) * exact;
    LineOfSightMeasurement {
        frame: number,
        time: at(seconds),
        line_of_sight: Direction::from_unit(turned.normalize()),
        camera_from_icrs: camera,
        covariance: None,
        attitude_source: None,
    }
}

/// Name of the input, presence of a prior, events in order of arrival.
fn inputs() -> Vec<(&'static str, bool, Vec<Event>)> {
    let sights = |numbers: &[u64]| -> Vec<Event> {
        numbers.iter().map(|number| Event::LineOfSight(sight(*number))).collect()
    };
    let hours: Vec<u64> = (0..150).collect();
    let mut reversed = hours.clone();
    reversed.swap(20, 21);
    let mut late = hours.clone();
    late.remove(10);
    late.push(10);
    let gap: Vec<u64> = (0..100).chain(4000..4010).collect();
    let mut wild = sights(&hours);
    let away = sight(40);
    wild[40] = Event::LineOfSight(LineOfSightMeasurement {
        line_of_sight: Direction::from_unit(-*away.line_of_sight.vector()),
        ..away
    });
    let mut manoeuvre = sights(&hours);
    manoeuvre.insert(
        100,
        Event::Manoeuvre(ManoeuvreReport {
            time: at(5990.0),
            dv_rtn_m_s: Vector3::zeros(),
            sigma_rtn_m_s: Vector3::repeat(1e-5),
        }),
    );
    vec![
        ("no event and no prior", false, Vec::new()),
        ("no event", true, Vec::new()),
        ("one measurement without a prior", false, sights(&[0])),
        ("one measurement", true, sights(&[0])),
        ("hours of measurements", true, sights(&hours)),
        ("a repeated measurement", true, [sights(&hours), sights(&[149])].concat()),
        ("measurements in the wrong order", true, sights(&reversed)),
        ("a late measurement", true, sights(&late)),
        ("a gap of days", true, sights(&gap)),
        ("a direction away from the target", true, wild),
        ("a manoeuvre", true, manoeuvre),
    ]
}
