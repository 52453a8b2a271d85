//! The Dask engine with workers that die: every shard is made once, with the rows of a single process. Needs
//! Python with `pip install './python[dask]'`, named by `BORESIGHT_PYTHON`; runs in continuous integration.

use std::fs;
use std::io::{BufRead, BufReader};
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

use crate::support::Bench;

const STUDY: &str = r#"
title = "ten frames of ARGON"
scenario = "argon"
seed = 9
frames = "2000..2010"
[stop]
cases = 40
[[vary]]
path = "psf.sigma_px"
distribution = { kind = "uniform", min = 0.6, max = 1.0 }
"#;

fn python() -> String {
    std::env::var("BORESIGHT_PYTHON").unwrap_or_else(|_| "python3".to_owned())
}

/// A process that is killed when the value is dropped.
struct Killed(Child);

impl Drop for Killed {
    fn drop(&mut self) {
        let _ = self.0.kill();
        let _ = self.0.wait();
    }
}

fn shards(bench: &Bench) -> usize {
    fs::read_dir(bench.path("out/shards")).map_or(0, |entries| {
        entries
            .filter(|entry| entry.as_ref().unwrap().path().extension().is_some_and(|e| e == "parquet"))
            .count()
    })
}

fn wait_for(what: &str, mut is_so: impl FnMut() -> bool) {
    let begun = Instant::now();
    while !is_so() {
        assert!(begun.elapsed() < Duration::from_secs(120), "{what}");
        std::thread::sleep(Duration::from_millis(10));
    }
}

/// Returns the command that runs the study in 20 shards on a cluster.
fn on_dask(bench: &Bench, engine: &str) -> Command {
    let mut command = Command::new(assert_cmd::cargo::cargo_bin!("boresight"));
    command
        .args([
            "study",
            "run",
            "study.toml",
            "--out",
            "out",
            "--shards",
            "20",
            "--jobs",
            "2",
            "--engine",
            engine,
        ])
        .env("BORESIGHT_PYTHON", python())
        .current_dir(bench.path(""))
        .stdout(Stdio::null());
    command
}

/// Starts a scheduler on this machine; returns it with its address.
fn scheduler() -> (Killed, String) {
    let mut child = Command::new(python())
        .args([
            "-m",
            "distributed.cli.dask_scheduler",
            "--host",
            "127.0.0.1",
            "--port",
            "0",
            "--no-dashboard",
            "--no-jupyter",
        ])
        .stderr(Stdio::piped())
        .stdout(Stdio::null())
        .spawn()
        .unwrap();
    let mut lines = BufReader::new(child.stderr.take().unwrap()).lines();
    let address = lines
        .by_ref()
        .map(Result::unwrap)
        .find_map(|line| line.find("tcp://").map(|at| line[at..].trim().to_owned()))
        .expect("the scheduler tells its address");
    // Its output must be read continuously.
    std::thread::spawn(move || lines.for_each(drop));
    (Killed(child), address)
}

/// Starts a worker in a separate directory.
fn worker(address: &str, bench: &Bench) -> Killed {
    fs::create_dir_all(bench.path("elsewhere")).unwrap();
    let child = Command::new(python())
        .current_dir(bench.path("elsewhere"))
        .args([
            "-m",
            "distributed.cli.dask_worker",
            address,
            "--nthreads",
            "1",
            "--no-nanny",
            "--no-dashboard",
        ])
        .args(["--host", "127.0.0.1", "--local-directory"])
        .arg(bench.path("dask"))
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .spawn()
        .unwrap();
    Killed(child)
}

#[test]
#[ignore = "needs Python with Dask; continuous integration runs it"]
fn a_killed_worker_loses_only_its_shard() {
    let bench = Bench::new();
    bench.write("study.toml", STUDY);
    bench.boresight("study run study.toml --out whole --shards 20").done();

    let (_scheduler, address) = scheduler();
    let mut workers = [worker(&address, &bench), worker(&address, &bench)];
    let driver = on_dask(&bench, &format!("dask={address}")).spawn().unwrap();
    let mut driver = Killed(driver);
    wait_for("six shards", || shards(&bench) >= 6);
    let before = bench.tree("out/shards");
    let when = |name: &std::path::Path| {
        fs::metadata(bench.path("out/shards").join(name)).unwrap().modified().unwrap()
    };
    let done: Vec<_> =
        before.keys().filter(|name| name.extension().is_some_and(|e| e == "parquet")).collect();
    let times: Vec<_> = done.iter().map(|name| when(name)).collect();
    workers[0].0.kill().unwrap();

    let mut status = None;
    wait_for("the study", || {
        status = driver.0.try_wait().unwrap();
        status.is_some()
    });
    assert!(status.unwrap().success());
    assert_eq!(shards(&bench), 20);
    assert_eq!(
        done.iter().map(|name| when(name)).collect::<Vec<_>>(),
        times,
        "a finished shard was made again"
    );
    bench.check_same("out/cases.parquet", "whole/cases.parquet");
    bench.check_same("out/summary.json", "whole/summary.json");
}

#[test]
#[ignore = "needs Python with Dask; continuous integration runs it"]
fn a_restarted_driver_makes_the_missing_cases() {
    let bench = Bench::new();
    bench.write("study.toml", STUDY);
    let mut driver = on_dask(&bench, "dask");
    driver.stderr(Stdio::null());
    let mut first = Killed(driver.spawn().unwrap());
    wait_for("five shards", || shards(&bench) >= 5);
    first.0.kill().unwrap();
    first.0.wait().unwrap();
    let made = bench.tree("out/shards");
    assert!(driver.status().unwrap().success());
    let after = bench.tree("out/shards");
    let is_kept = |(name, bytes): (&std::path::PathBuf, &Vec<u8>)| {
        name.extension().is_none_or(|e| e != "parquet") || after.get(name) == Some(bytes)
    };
    assert!(made.iter().all(is_kept));
    bench.boresight("study run study.toml --out whole --shards 20").done();
    bench.check_same("out/cases.parquet", "whole/cases.parquet");
}

/// A program and a scenario given by relative paths, and eight workers in another directory: the contents of
/// all files are sent to the workers.
#[test]
#[ignore = "needs Python with Dask; continuous integration runs it"]
fn a_study_travels_to_eight_workers_in_another_folder() {
    let bench = Bench::new();
    bench.write("study.toml", STUDY.replace("argon", "inputs/scenario.toml").replace("2000..2010", "0..10"));
    fs::create_dir(bench.path("inputs")).unwrap();
    let root = env!("CARGO_MANIFEST_DIR");
    fs::copy(format!("{root}/scenarios/starting-point.toml"), bench.path("inputs/scenario.toml")).unwrap();
    fs::copy(format!("{root}/examples/brightest.py"), bench.path("brightest.py")).unwrap();
    let program = ["--pipeline", "exec:python3 brightest.py"];

    let (_scheduler, address) = scheduler();
    let _workers: Vec<Killed> = (0..8).map(|_| worker(&address, &bench)).collect();
    let status = on_dask(&bench, &format!("dask={address}")).args(program).stderr(Stdio::null()).status();
    assert!(status.unwrap().success());
    let whole = ["study", "run", "study.toml", "--out", "whole", "--shards", "20"];
    bench.boresight_words(&[&whole[..], &program[..]].concat()).done();
    bench.check_same("out/cases.parquet", "whole/cases.parquet");
}

#[test]
#[ignore = "needs Python with Dask; continuous integration runs it"]
fn a_program_that_workers_do_not_find_is_reported_at_once() {
    let bench = Bench::new();
    bench.write("study.toml", STUDY);
    let output = on_dask(&bench, "dask").env("BORESIGHT_PROGRAM", "/nowhere/boresight").output().unwrap();
    let said = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(2), "{said}");
    let parts = ["/nowhere/boresight: No such file or directory", "BORESIGHT_PROGRAM names the program"];
    assert!(parts.iter().all(|part| said.contains(part)), "{said}");
}

#[test]
#[ignore = "needs Python with Dask; continuous integration runs it"]
fn a_scheduler_that_dies_is_reported_and_its_shards_are_kept() {
    let bench = Bench::new();
    bench.write("study.toml", STUDY);
    let (mut scheduler, address) = scheduler();
    let _worker = worker(&address, &bench);
    let driver = on_dask(&bench, &format!("dask={address}")).stderr(Stdio::piped()).spawn().unwrap();
    wait_for("three shards", || shards(&bench) >= 3);
    scheduler.0.kill().unwrap();
    let output = driver.wait_with_output().unwrap();
    let said = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(2), "{said}");
    let parts =
        [format!("the scheduler at {address} does not answer"), "of 20 shards were reported".to_owned()];
    assert!(parts.iter().all(|part| said.contains(part)) && !said.contains("Traceback"), "{said}");
    // Repeats the command on an available cluster.
    let mut again = on_dask(&bench, "dask");
    assert!(again.stderr(Stdio::null()).status().unwrap().success());
    bench.boresight("study run study.toml --out whole --shards 20").done();
    bench.check_same("out/cases.parquet", "whole/cases.parquet");
}
