//! External navigators: the example of the documentation, and processes that misbehave.

use std::path::Path;

use boresight_pipeline::external::ExternalNavigatorFactory;
use contract::conformance::navigation::check;
use contract::navigation::{
    Answer, ChaserOrbit, Covariance6, DifferentialDrag, Event, LineOfSightErrors, ManoeuvreReport,
    MeanElements, Mode, NavigationSetup, NavigatorFactory, NoEstimate, PriorOrbit, RelativeElements,
};
use contract::{ContractError, Rotation};
use hifitime::{Epoch, Unit};
use nalgebra::Vector3;
use tempfile::TempDir;

fn write_time(time: Epoch) -> String {
    let (year, month, day, hour, minute, second, nanos) = time.to_gregorian_utc();
    format!("{year:04}-{month:02}-{day:02}T{hour:02}:{minute:02}:{second:02}.{nanos:09}Z")
}

fn start() -> Epoch {
    Epoch::from_gregorian_utc_at_midnight(2012, 4, 25)
}

fn setup() -> NavigationSetup {
    NavigationSetup {
        epoch: start(),
        chaser_orbit: ChaserOrbit::Mean(MeanElements {
            semi_major_axis_km: 7130.0,
            eccentricity: 0.0,
            inclination_deg: 98.0,
            raan_deg: 0.0,
            argument_of_perigee_deg: 0.0,
            mean_anomaly_deg: 0.0,
        }),
        camera_from_body: Rotation::identity(),
        prior: Some(PriorOrbit {
            elements: RelativeElements { a_dlambda_m: -1e4, ..RelativeElements::default() },
            covariance: Covariance6::from_sigmas([2.0, 300.0, 20.0, 20.0, 20.0, 20.0]).unwrap(),
        }),
        errors: LineOfSightErrors::default(),
        drag: DifferentialDrag::default(),
    }
}

/// A factory whose program can call `hello(mode)`, `ask()` to read the next line, and `say(text)`.
fn python(body: &str) -> (TempDir, ExternalNavigatorFactory) {
    let scratch = tempfile::tempdir().unwrap();
    let program = format!(
        "import json, sys, time\n\
         def say(text):\n    print(text, flush=True)\n\
         def ask():\n    line = sys.stdin.readline()\n    return json.loads(line) if line else sys.exit()\n\
         def hello(mode='batch'):\n    ask(); say('{{\"boresight_navigator\": 1, \"name\": \"test\", \"mode\": \"' + mode + '\"}}')\n\
         {body}\n"
    );
    let path = scratch.path().join("program.py");
    std::fs::write(&path, program).unwrap();
    let command = format!("python3 '{}'", path.display());
    let factory = ExternalNavigatorFactory::new(command, scratch.path().to_owned(), write_time);
    (scratch, factory)
}

fn example() -> ExternalNavigatorFactory {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../examples/prior_orbit.py");
    ExternalNavigatorFactory::new(format!("python3 '{}'", path.display()), std::env::temp_dir(), write_time)
}

fn at_hours(hours: f64) -> Epoch {
    start() + Unit::Hour * hours
}

fn failure(answer: &Answer) -> String {
    match answer {
        Err(NoEstimate::Failed(reason)) => reason.clone(),
        other => panic!("expected a failure, got {other:?}"),
    }
}

#[test]
fn the_example_keeps_the_contract() {
    let factory = example();
    assert_eq!(check(&factory), Ok(()));
    assert_eq!(factory.mode(), Mode::Sequential);
}

#[test]
fn the_example_moves_the_prior_through_a_manoeuvre() {
    let mut navigator = example().build(&setup()).unwrap();
    let dv_m_s = 0.01;
    navigator.receive(&Event::Manoeuvre(ManoeuvreReport {
        time: at_hours(1.0),
        dv_rtn_m_s: Vector3::new(0.0, dv_m_s, 0.0),
        sigma_rtn_m_s: Vector3::zeros(),
    }));
    let answers = navigator.estimates(&[at_hours(0.5), at_hours(3.0)]);
    let [before, after] = [0, 1].map(|place| answers[place].clone().unwrap());
    assert_eq!(before.elements.a_dlambda_m, -1e4);
    assert_eq!(after.time, at_hours(3.0));
    // An impulse along T: aδa = 2 Δv/n, and aδλ falls by 3/2 n aδa a second, thus by 3 Δv.
    let rate = (398_600.441_5_f64 / (7130.0 * 7130.0 * 7130.0)).sqrt();
    assert!((after.elements.a_da_m - 2.0 * dv_m_s / rate).abs() < 1e-6, "{after:?}");
    assert!((after.elements.a_dlambda_m + 1e4 + 3.0 * dv_m_s * 7200.0).abs() < 1e-6, "{after:?}");
}

#[test]
fn a_request_has_at_most_a_hundred_epochs_and_follows_its_events() {
    let (_scratch, factory) = python(
        "hello()\nevents = 0\nwhile True:\n    line = ask()\n    if 'estimate' in line:\n        assert len(line['estimate']) <= 100\n        \
         say(json.dumps({'estimates': [{'no_estimate': f'failed: {events}'}] * len(line['estimate'])}))\n    \
         else:\n        events += 1",
    );
    let mut navigator = factory.build(&setup()).unwrap();
    let event = Event::Manoeuvre(ManoeuvreReport {
        time: start(),
        dv_rtn_m_s: Vector3::zeros(),
        sigma_rtn_m_s: Vector3::zeros(),
    });
    (0..3).for_each(|_| navigator.receive(&event));
    let epochs: Vec<Epoch> = (0..250).map(|k| at_hours(f64::from(k))).collect();
    let answers = navigator.estimates(&epochs);
    assert_eq!(answers.len(), 250);
    assert!(answers.iter().all(|answer| failure(answer) == "3"));
}

#[test]
fn an_unusable_answer_costs_its_request_only() {
    for (answer, reason) in [
        ("hello", "its answer `hello` cannot be read"),
        ("{\"estimates\": []}", "its 0 estimates, expected 1"),
        ("{\"estimates\": [{\"no_estimate\": \"rain\"}]}", "unknown reason"),
        ("{\"estimates\": [{\"position_rtn_m\": [NaN, 0, 0]}]}", "cannot be read"),
    ] {
        let (_scratch, factory) = python(&format!(
            "hello('sequential')\nask()\nsay('{answer}')\nask()\nsay('{{\"estimates\": [{{\"no_estimate\": \"no_convergence\"}}]}}')\nask()"
        ));
        let mut navigator = factory.build(&setup()).unwrap();
        let found = failure(&navigator.estimates(&[start()])[0]);
        assert!(found.contains(reason), "{found}");
        assert_eq!(navigator.estimates(&[start()]), [Err(NoEstimate::NoConvergence)]);
    }
}

#[test]
fn a_process_that_dies_or_is_late_fails_for_good() {
    for (body, reason) in [
        ("hello()\nask()\nprint('no light', file=sys.stderr)\nsys.exit(3)", "it ended with exit status: 3"),
        ("hello()\nask()\ntime.sleep(60)", "it gave no answer within 0.5 s"),
        ("hello()\nsay('early')\nask()\ntime.sleep(60)", "it wrote a line without a request"),
        ("hello()\nask()\nsay('x' * 1048577)", "it wrote a line longer than 1048576 bytes"),
    ] {
        let (_scratch, mut factory) = python(body);
        factory.timeout_s = 0.5;
        let mut navigator = factory.build(&setup()).unwrap();
        if reason.contains("without a request") {
            std::thread::sleep(std::time::Duration::from_millis(300));
        }
        let first = failure(&navigator.estimates(&[start()])[0]);
        assert!(
            first.starts_with("at the request for 2012-04-25T00:00:00.000000000Z, ")
                && first.contains(reason),
            "{first}"
        );
        assert_eq!(failure(&navigator.estimates(&[at_hours(1.0)])[0]), first);
    }
}

#[test]
fn a_program_that_does_not_start_or_greet_is_an_error() {
    let refused = |factory: &ExternalNavigatorFactory, reason: &str| {
        let error = factory.build(&setup()).err().unwrap();
        assert!(matches!(error, ContractError::CannotBuild { .. }), "{error:?}");
        assert!(error.to_string().contains(reason), "{error}");
    };
    let named = |command: &str| ExternalNavigatorFactory::new(command, std::env::temp_dir(), write_time);
    refused(&named("/nowhere/navigator"), "`/nowhere/navigator` cannot be started");
    refused(&named(""), "the command is empty");
    refused(&named("python3 'a"), "inside a quotation");
    assert!(named("/nowhere/navigator").check().unwrap_err().to_string().contains("not found"));
    let mut endless = named("python3");
    endless.timeout_s = f64::NAN;
    refused(&endless, "timeout_s is NaN");
    let (_a, other) =
        python("ask(); say('{\"boresight_navigator\": 2, \"name\": \"x\", \"mode\": \"batch\"}'); ask()");
    refused(&other, "during the greeting, it uses version 2 of the protocol, expected 1");
    let (_b, silent) = python("sys.exit(4)");
    refused(&silent, "during the greeting, it ended with exit status: 4");
    let (_c, modeless) =
        python("ask(); say('{\"boresight_navigator\": 1, \"name\": \"x\", \"mode\": \"daily\"}'); ask()");
    refused(&modeless, "cannot be read");
}
