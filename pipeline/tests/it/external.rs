//! External pipelines: the example of the documentation, and processes that misbehave in every known way.

use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::{Duration, Instant};

use boresight_pipeline::external::ExternalFactory;
use contract::{
    Camera, FarRange, Frame, NoSolution, Outcome, Pipeline, PipelineFactory, Rotation, Setup, Solution,
    Telemetry, conformance,
};
use hifitime::{Epoch, Unit};

const COLUMNS: usize = 64;
const ROWS: usize = 48;

fn setup() -> Setup {
    Setup {
        camera: Camera {
            columns: COLUMNS,
            rows: ROWS,
            focal_length_mm: 20.0,
            pixel_width_um: 8.0,
            pixel_height_um: 8.0,
            principal_x_px: 31.5,
            principal_y_px: 23.5,
            radial: [0.0; 3],
            tangential: [0.0; 2],
        },
        camera_from_body: Rotation::identity(),
        bit_depth: 12,
        readout: None,
        calibration: contract::Calibration::default(),
        zero_suppression_dn: None,
        stars: Vec::new(),
    }
}

/// Frame of level 100 with bright squares of 2 × 2 pixels; each square is given by its first pixel and its
/// level.
fn frame(number: u64, squares: &[(usize, usize, u16)]) -> (Frame, Telemetry) {
    let mut dn = vec![100; COLUMNS * ROWS];
    for &(x, y, level) in squares {
        for i in [0, 1, COLUMNS, COLUMNS + 1] {
            dn[y * COLUMNS + x + i] = level;
        }
    }
    let telemetry = Telemetry {
        time: Epoch::from_gregorian_utc_at_midnight(2012, 4, 25) + Unit::Second * (15.0 * number as f64),
        exposure_s: 0.25,
        body_from_icrs: Rotation::identity(),
        velocity_km_s: None,
    };
    (Frame::new(number, COLUMNS, ROWS, 12, dn, None).unwrap(), telemetry)
}

/// Writes a minimal FITS file: 16 bits, BZERO 32768.
fn write_fits(frame: &Frame, _: &Telemetry, path: &Path) -> Result<(), String> {
    let cards = [
        ("SIMPLE", "T".to_owned()),
        ("BITPIX", "16".to_owned()),
        ("NAXIS", "2".to_owned()),
        ("NAXIS1", frame.columns().to_string()),
        ("NAXIS2", frame.rows().to_string()),
        ("BZERO", "32768".to_owned()),
        ("BSCALE", "1".to_owned()),
    ];
    let mut file: Vec<u8> = cards
        .iter()
        .flat_map(|(key, value)| format!("{key:<8}= {value:>20}{:50}", "").into_bytes())
        .collect();
    file.extend(format!("{:<80}", "END").into_bytes());
    file.resize(2880, b' ');
    file.extend(frame.dn().iter().flat_map(|&dn| ((i32::from(dn) - 32768) as i16).to_be_bytes()));
    file.resize(file.len().div_ceil(2880) * 2880, 0);
    std::fs::write(path, file).map_err(|error| error.to_string())
}

struct Bench {
    scratch: tempfile::TempDir,
    factory: ExternalFactory<FarRange>,
}

impl Bench {
    fn command(command: impl Into<String>) -> Self {
        let scratch = tempfile::tempdir().unwrap();
        let factory =
            ExternalFactory::new(command, scratch.path().to_owned(), Arc::new(write_fits), |time| {
                let (year, month, day, hour, minute, second, nanos) = time.to_gregorian_utc();
                format!("{year:04}-{month:02}-{day:02}T{hour:02}:{minute:02}:{second:02}.{nanos:09}Z")
            });
        Self { scratch, factory }
    }

    /// Runs a Python program that can call `hello()` to send a valid greeting, `ask()` to read the next
    /// request, and `say(text)`.
    fn python(body: &str) -> Self {
        let mut bench = Self::command("");
        let program = format!(
            "import json, os, sys, time\n\
             def say(text):\n    print(text, flush=True)\n\
             def ask():\n    line = sys.stdin.readline()\n    return json.loads(line) if line else sys.exit()\n\
             def hello():\n    ask(); say('{{\"boresight_pipeline\": 1, \"name\": \"test\"}}')\n\
             {body}\n"
        );
        let path = bench.scratch.path().join("program.py");
        std::fs::write(&path, program).unwrap();
        bench.factory.command = format!("python3 '{}'", path.display());
        bench
    }

    fn build(&self) -> Box<dyn Pipeline<FarRange>> {
        self.factory.build(&setup()).unwrap()
    }

    fn images_left(&self) -> Vec<PathBuf> {
        let files = std::fs::read_dir(self.scratch.path()).unwrap().map(|entry| entry.unwrap().path());
        files.filter(|path| path.extension().is_some_and(|extension| extension == "fits")).collect()
    }
}

fn process(pipeline: &mut dyn Pipeline<FarRange>, number: u64) -> Outcome {
    let (frame, telemetry) = frame(number, &[(10, 10, 2000)]);
    pipeline.process(&frame, &telemetry)
}

fn reason(outcome: &Outcome) -> String {
    match &outcome.solution {
        Solution::NoSolution(NoSolution::Failed(reason)) => reason.clone(),
        other => panic!("expected a failure, got {other:?}"),
    }
}

/// Waits until a program has written a file, the sign that it has reached this point.
fn wait_for_text(path: &Path) {
    let deadline = Instant::now() + Duration::from_secs(20);
    while std::fs::read_to_string(path).unwrap_or_default().is_empty() {
        assert!(Instant::now() < deadline, "{} was not written", path.display());
        std::thread::sleep(Duration::from_millis(2));
    }
}

/// Checks that the first frame fails with a reason that contains `expected`, and that the next fails with an
/// identical reason.
fn dies(bench: &Bench, expected: &str) {
    let mut pipeline = bench.build();
    let first = reason(&process(&mut *pipeline, 0));
    assert!(first.contains(expected), "{first}");
    assert_eq!(reason(&process(&mut *pipeline, 1)), first);
    assert_eq!(bench.images_left(), Vec::<PathBuf>::new());
}

fn example() -> Bench {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../examples/brightest.py");
    Bench::command(format!("python3 '{}'", path.display()))
}

#[test]
fn the_example_finds_the_fixed_object_among_moving_stars() {
    let bench = example();
    let mut pipeline = bench.build();
    // A target that creeps by 1 px per frame, and a brighter star that moves by 12 px.
    let at = |i: u64| frame(i, &[(30 + i as usize, 20, 1000), (5 + 12 * i as usize, 40, 3000)]);
    let outcomes: Vec<Outcome> = (0..4).map(at).map(|(f, t)| pipeline.process(&f, &t)).collect();
    assert_eq!(outcomes[0].solution, Solution::NoSolution(NoSolution::NoPreviousFrame));
    for (i, outcome) in outcomes.iter().enumerate().skip(1) {
        let position = outcome.measurement().unwrap_or_else(|| panic!("frame {i}: {outcome:?}")).position;
        // Exact centre of a uniform square, two pixels wide.
        assert_eq!((position.x, position.y), (30.5 + i as f64, 20.5));
    }
    assert_eq!(bench.images_left(), Vec::<PathBuf>::new());
}

#[test]
fn the_example_keeps_the_contract() {
    assert_eq!(conformance::check(&example().factory, &setup()), Ok(()));
}

#[test]
fn a_missing_program_does_not_start() {
    dies(&Bench::command("/nowhere/pipeline --fast"), "`/nowhere/pipeline` cannot be started");
}

#[test]
fn a_command_that_cannot_be_meant_is_refused() {
    for (command, expected) in [("", "is empty"), ("python3 'a", "inside a quotation")] {
        let error = Bench::command(command).factory.build(&setup()).err().unwrap().to_string();
        assert!(error.contains(expected), "{error}");
    }
    let mut bench = example();
    bench.factory.timeout_s = f64::NAN;
    assert!(bench.factory.build(&setup()).is_err());
}

#[test]
fn another_version_is_refused() {
    let bench = Bench::python("ask(); say('{\"boresight_pipeline\": 2, \"name\": \"x\"}'); ask()");
    dies(&bench, "during the greeting, it uses version 2 of the protocol, expected 1");
}

#[test]
fn a_greeting_that_is_no_greeting_is_refused() {
    dies(&Bench::python("say('Welcome!'); ask()"), "its answer `Welcome!` cannot be read");
}

#[test]
fn a_program_that_never_greets_is_ended() {
    let mut bench = Bench::python("time.sleep(60)");
    bench.factory.start_timeout_s = 0.3;
    dies(&bench, "during the greeting, it gave no answer within 0.3 s");
}

#[test]
fn a_program_that_hangs_is_ended_with_its_children() {
    let mut bench = Bench::python(
        "import subprocess\nhello()\nchild = subprocess.Popen(['sleep', '61'])\n\
         open(os.path.dirname(__file__) + '/child', 'w').write(str(child.pid))\nask()\ntime.sleep(60)",
    );
    bench.factory.timeout_s = 0.3;
    let mut pipeline = bench.build();
    // The child must exist before it can be ended: its process id is written before the first request is
    // read.
    let child = bench.scratch.path().join("child");
    wait_for_text(&child);
    let start = Instant::now();
    assert!(reason(&process(&mut *pipeline, 0)).contains("at frame 0, it gave no answer within 0.3 s"));
    assert!(start.elapsed() < Duration::from_secs(5));
    let number = std::fs::read_to_string(&child).unwrap();
    // Ended, or a zombie that its adoptive parent has not yet reaped.
    let is_running = || {
        std::fs::read_to_string(format!("/proc/{number}/stat"))
            .is_ok_and(|stat| !stat.rsplit(')').next().unwrap_or_default().trim_start().starts_with('Z'))
    };
    let deadline = Instant::now() + Duration::from_secs(5);
    while is_running() && Instant::now() < deadline {
        std::thread::sleep(Duration::from_millis(5));
    }
    assert!(!is_running(), "the grandchild {number} outlived the pipeline");
}

#[test]
fn a_crash_is_reported_with_its_status_and_last_output() {
    let bench = Bench::python("hello()\nask()\nsys.stderr.write('no film\\n')\nsys.exit(3)");
    dies(&bench, "at frame 0, it ended with exit status: 3; last error output: no film");
}

#[test]
fn a_crash_between_frames_is_reported_at_the_next() {
    let bench = Bench::python(
        "hello()\nask()\nsay('{\"frame\": 0, \"status\": \"no_target\"}')\nos.kill(os.getpid(), 9)",
    );
    let mut pipeline = bench.build();
    assert_eq!(process(&mut *pipeline, 0).solution, Solution::NoSolution(NoSolution::NoTarget));
    let second = reason(&process(&mut *pipeline, 1));
    assert!(second.contains("at frame 1, it ended with signal: 9"), "{second}");
}

#[test]
fn an_unusable_answer_fails_only_its_frame() {
    let bench = Bench::python(
        "hello()\n\
         for answer in ['garbage', '{\"frame\": 99, \"status\": \"no_target\"}', \
         '{\"frame\": 2, \"status\": \"detected\", \"x_px\": NaN, \"y_px\": 1}', \
         '{\"frame\": 3, \"status\": \"detected\", \"x_px\": null, \"y_px\": 1}', \
         '{\"frame\": 4, \"status\": \"detected\", \"x_px\": 64.0, \"y_px\": 1}', \
         '{\"frame\": 5, \"status\": \"detected\", \"x_px\": 63.0, \"y_px\": 1}']:\n    ask(); say(answer)\nask()",
    );
    let mut pipeline = bench.build();
    let expected = [
        "cannot be read",
        "frame 99, expected frame 1",
        "cannot be read",
        "x_px or y_px is missing",
        "not on the detector",
    ];
    for (number, expected) in expected.into_iter().enumerate() {
        let reason = reason(&process(&mut *pipeline, number as u64));
        assert!(reason.contains(expected), "frame {number}: {reason}");
    }
    assert!(process(&mut *pipeline, 5).measurement().is_some());
}

#[test]
fn a_line_without_end_is_cut() {
    let bench = Bench::python("hello()\nask()\nwhile True:\n    sys.stdout.write('x' * 65536)");
    dies(&bench, "it wrote a line longer than 1048576 bytes");
}

#[test]
fn a_flood_of_lines_is_stopped() {
    let bench =
        Bench::python("hello()\nask()\nwhile True:\n    say('{\"frame\": 0, \"status\": \"no_target\"}')");
    let mut pipeline = bench.build();
    assert!(matches!(process(&mut *pipeline, 0).solution, Solution::NoSolution(NoSolution::NoTarget)));
    // A line in the pipe before the request is recognised as unsolicited, one while the request is still
    // unread as an answer without it; a line just after the request counts as an answer to the wrong frame.
    let endings = ["it wrote a line without a request", "it answered without reading the request"];
    let stopped = (1..1000).find_map(|number| {
        let reason = reason(&process(&mut *pipeline, number));
        endings.iter().any(|ending| reason.contains(ending)).then_some(reason)
    });
    assert!(stopped.is_some(), "not stopped in 1000 frames");
    assert_eq!(Some(reason(&process(&mut *pipeline, 1000))), stopped, "it stays ended");
}

#[test]
fn a_program_that_closes_its_input_is_ended() {
    let bench = Bench::python(
        "hello()\nos.close(0)\nopen(os.path.dirname(__file__) + '/closed', 'w').write('x')\ntime.sleep(60)",
    );
    let mut pipeline = bench.build();
    wait_for_text(&bench.scratch.path().join("closed"));
    let reason = reason(&process(&mut *pipeline, 0));
    assert!(reason.contains("it closed its input"), "{reason}");
}

#[test]
fn a_program_that_does_not_read_a_long_greeting_is_ended() {
    let mut bench = Bench::python("time.sleep(60)");
    bench.factory.start_timeout_s = 0.3;
    let mut setup = setup();
    let direction = contract::Direction::from_unit(nalgebra::Vector3::z());
    // More than a megabyte, larger than any pipe buffer.
    setup.stars = (0..30_000).map(|id| contract::ListedStar { id, direction, magnitude: 5.0 }).collect();
    let mut pipeline = bench.factory.build(&setup).unwrap();
    assert!(reason(&process(&mut *pipeline, 0)).contains("it gave no answer within 0.3 s"));
}

#[test]
fn error_output_does_not_block_and_is_kept_short() {
    let bench = Bench::python(
        "hello()\nfor i in range(100000):\n    sys.stderr.write(f'grumble {i}\\n')\n\
         ask(); say('{\"frame\": 0, \"status\": \"no_target\"}'); ask(); sys.exit(1)",
    );
    let mut pipeline = bench.build();
    assert!(matches!(process(&mut *pipeline, 0).solution, Solution::NoSolution(NoSolution::NoTarget)));
    let reason = reason(&process(&mut *pipeline, 1));
    assert!(reason.ends_with("grumble 99997 | grumble 99998 | grumble 99999"), "{reason}");
}

#[test]
fn an_image_that_cannot_be_written_is_a_fault_of_the_machine() {
    let mut bench = Bench::python("hello()\nask()");
    bench.factory.write_image = Arc::new(|_, _, _| Err("disk full".to_owned()));
    let mut pipeline = bench.build();
    assert_eq!(pipeline.machine_fault(), None);
    let expected = "at frame 0, the image cannot be written: disk full";
    assert_eq!(reason(&process(&mut *pipeline, 0)), expected);
    assert_eq!(pipeline.machine_fault().unwrap().reason, expected);
}

#[test]
fn the_request_holds_the_telemetry() {
    let bench = Bench::python(
        "hello()\nr = ask()\nt = r['telemetry']\n\
         ok = t == {'time_utc': '2012-04-25T00:00:15.000000000Z', 'exposure_s': 0.25, \
         'q_sc_j2000': [1, 0, 0, 0], 'v_orbital_j2000_km_s': None}\n\
         ok = ok and os.path.getsize(r['image']) == 2880 + 3 * 2880 and r['windows'] is None\n\
         say(json.dumps({'frame': r['frame'], 'status': 'no_target' if ok else 'failed: ' + str(r)}))\nask()",
    );
    let mut pipeline = bench.build();
    assert_eq!(process(&mut *pipeline, 1).solution, Solution::NoSolution(NoSolution::NoTarget));
}
