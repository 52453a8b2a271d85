//! Files that are truncated or have a flipped bit at any position: an error that names the file.

use std::fs;
use std::path::Path;

use boresight::pipeline_choice::PipelineChoice;
use boresight::study::{Plan, ShardStore, Study};

use super::small;
use crate::support::{Bench, check_same_files};

/// Byte positions of a file that are tested: the ends, where formats have their marks, lengths and checksums,
/// and positions throughout the file.
fn byte_positions(length: usize, step: usize) -> Vec<usize> {
    let end = length.saturating_sub(16);
    (0..length.min(16)).chain((16..end).step_by(step)).chain(end.max(16)..length).collect()
}

/// Calls `check` with the file truncated, empty, and with one bit flipped at each of several positions; then
/// restores the file.
fn damaged(bench: &Bench, name: &str, step: usize, mut check: impl FnMut(&str)) {
    let path = bench.path(name);
    let bytes = fs::read(&path).unwrap();
    for length in [0, 1, bytes.len() / 2, bytes.len() - 1] {
        fs::write(&path, &bytes[..length]).unwrap();
        check(&format!("{name} cut to {length} of {} bytes", bytes.len()));
    }
    for (i, place) in byte_positions(bytes.len(), step).into_iter().enumerate() {
        let mut flipped = bytes.clone();
        // In a text, a low bit changes a digit into another digit, the most dangerous kind of damage.
        flipped[place] ^= 1 << (i % 8);
        fs::write(&path, &flipped).unwrap();
        check(&format!("{name} with bit {} of byte {place} flipped", i % 8));
    }
    fs::write(&path, &bytes).unwrap();
}

/// Checks that the command rejects the damage and names the file.
fn check_refused(bench: &Bench, words: &str, name: &str, what: &str) {
    let answer = bench.boresight(words);
    assert_eq!(answer.status, Some(2), "{what}: `{words}` is content\n{}{}", answer.stdout, answer.stderr);
    let file = Path::new(name).file_name().unwrap().to_str().unwrap();
    // Long messages are wrapped.
    let message = answer.refused(&[]).stderr.replace("\n  | ", "");
    assert!(message.contains(file), "{what}: `{words}` does not name it: {message}");
}

#[test]
fn damage_in_a_run_is_found_by_whoever_reads_it() {
    let bench = Bench::new();
    small(&bench);
    bench.boresight("run small.toml --frames 20..30 --save-frames fits --no-report --out run").done();
    let whole = bench.tree("run");
    let score = "score run run/measurements.csv";
    let process = "process run --out answers.csv";
    for (name, reader, tried) in [
        ("run/run.toml", score, 12),
        ("run/measurements.csv", score, 12),
        ("run/clusters.parquet", score, 12),
        ("run/truth/frames.parquet", score, 12),
        ("run/truth/objects.parquet", score, 12),
        ("run/score.json", "report run --out page.html", 6),
        ("run/telemetry.csv", process, 6),
        ("run/stars.csv", process, 6),
        ("run/camera.toml", process, 6),
        ("run/frames/000024.fits", process, 12),
    ] {
        let step = bench.path(name).metadata().unwrap().len() as usize / tried;
        damaged(&bench, name, step, |what| check_refused(&bench, reader, name, what));
    }
    check_same_files(&whole, &bench.tree("run"));
    bench.boresight(score).done();
    bench.boresight(process).done();
}

#[test]
fn damage_in_a_docking_dataset_is_found() {
    let bench = Bench::new();
    bench.boresight("run docking --frames 18000..18004 --save-frames png --no-report --out run").done();
    let score = "score run run/measurements.csv";
    let process = "process run --out new/answers.csv";
    fs::create_dir(bench.path("new")).unwrap();
    for (name, reader, tried) in [
        ("run/truth/fields.parquet", score, 8),
        ("run/measurements.csv", score, 8),
        ("run/motion.csv", score, 8),
        ("run/setup.toml", process, 4),
        ("run/telemetry.csv", process, 4),
    ] {
        let step = bench.path(name).metadata().unwrap().len() as usize / tried;
        damaged(&bench, name, step, |what| check_refused(&bench, reader, name, what));
    }
    // In a PNG, all positions but its end, which contains no data: 12 bytes that are always the same.
    let name = "run/frames/018001.png";
    let path = bench.path(name);
    let bytes = fs::read(&path).unwrap();
    for place in [0, 20, 60, bytes.len() / 3, bytes.len() / 2, bytes.len() - 20] {
        let mut flipped = bytes.clone();
        flipped[place] ^= 1;
        for damaged in [flipped, bytes[..place].to_vec()] {
            fs::write(&path, damaged).unwrap();
            check_refused(&bench, process, name, &format!("byte {place}"));
        }
    }
}

#[test]
fn damage_in_a_baseline_or_a_study_is_found_by_the_gate() {
    let bench = Bench::new();
    small(&bench);
    bench.write(
        "study.toml",
        "title = \"two frames\"\nscenario = \"small.toml\"\nseed = 5\nframes = \"20..22\"\n[stop]\ncases = 60\n\
         [[vary]]\npath = \"psf.sigma_px\"\ndistribution = { kind = \"uniform\", min = 0.7, max = 0.9 }\n",
    );
    bench.boresight("study run study.toml --out study --shards 2").done();
    bench.boresight("gate baseline study --out base --reason test").done();
    let gate = "gate base study";
    for (name, reader) in [
        ("base/baseline.toml", gate),
        ("base/rows.parquet", gate),
        ("study/cases.parquet", gate),
        ("study/study.json", gate),
        ("study/summary.json", "report study --out page.html"),
    ] {
        let step = bench.path(name).metadata().unwrap().len() as usize / 8;
        damaged(&bench, name, step, |what| check_refused(&bench, reader, name, what));
    }
    bench.boresight(gate).done();
    // Derived files are written again.
    bench.write("study/cases.parquet", "damaged");
    bench.boresight("study merge study.toml --out study").done();
    bench.boresight(gate).done();
}

/// A shard with any flipped bit is invalid, wherever the bit is: magic, pages, their headers, the hash, the
/// footer, its length.
#[test]
fn a_shard_with_any_bit_flipped_is_no_shard() {
    let bench = Bench::new();
    small(&bench);
    bench.write(
        "study.toml",
        "title = \"a frame\"\nscenario = \"small.toml\"\nseed = 5\nframes = \"20..21\"\n[stop]\ncases = 2\n\
         [record]\nfigures = [\"hit_rate\"]\nworst_by = \"hit_rate\"\n\
         [[vary]]\npath = \"psf.sigma_px\"\ndistribution = { kind = \"uniform\", min = 0.7, max = 0.9 }\n",
    );
    bench.boresight("study run study.toml --out study --shards 1 --no-report").done();
    boresight::register_worlds();
    let study = Study::read(&bench.path("study.toml")).unwrap();
    let choice = PipelineChoice { word: None, timeout_s: 10.0, memory_mb: 4000, sandbox: None };
    let plan = Plan::new(&study, study.hash_with(&choice), Some(1)).unwrap();
    let store = ShardStore::open(&bench.path("study"), plan).unwrap();
    let empty = study.table();
    assert!(store.read(1, &empty).unwrap().is_some());
    let mut tried = 0;
    damaged(&bench, "study/shards/1-of-1.parquet", 7, |what| {
        tried += 1;
        assert!(store.read(1, &empty).unwrap().is_none(), "{what} is taken for whole");
    });
    assert!(tried > 200, "{tried} places");
    assert!(store.read(1, &empty).unwrap().is_some());
    // A damaged plan is reported and not replaced; or, if the damage is in irrelevant text (the name, a
    // space), the rows are the same.
    let rows = fs::read(bench.path("study/cases.parquet")).unwrap();
    damaged(&bench, "study/plan.json", 40, |what| {
        let answer = bench.boresight("study run study.toml --out study --no-report");
        if answer.status == Some(0) {
            assert!(fs::read(bench.path("study/cases.parquet")).unwrap() == rows, "{what}");
        } else {
            answer.refused(&["plan.json"]);
        }
    });
}
