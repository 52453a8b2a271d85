//! `boresight study`: the rows do not depend on how they are made or on interruptions, and studies are never
//! mixed.

use std::fs;
use std::os::unix::process::ExitStatusExt;
use std::path::PathBuf;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

use serde_json::Value;

use crate::support::{Bench, STUDY, check_same_files, figure};

fn bench() -> Bench {
    let bench = Bench::new();
    bench.write("study.toml", STUDY);
    bench
}

/// Returns the rows of a study from its file.
fn rows(bench: &Bench, out: &str) -> Vec<String> {
    use parquet::file::reader::{FileReader, SerializedFileReader};
    let file = fs::File::open(bench.path(out).join("cases.parquet")).unwrap();
    let reader = SerializedFileReader::new(file).unwrap();
    reader.get_row_iter(None).unwrap().map(|row| row.unwrap().to_string()).collect()
}

fn shard(out: &str, name: &str) -> PathBuf {
    PathBuf::from(out).join("shards").join(name)
}

#[test]
fn rows_do_not_depend_on_shards_threads_or_order() {
    let bench = bench();
    bench.boresight("study run study.toml --out whole --shards 1 --jobs 2").done();
    for i in [3, 1, 2] {
        bench.boresight(&format!("study run study.toml --out parts --shard {i}/3 --jobs 1")).done();
    }
    bench.boresight("study merge study.toml --out parts").done();
    assert_eq!(rows(&bench, "whole").len(), 6);
    assert_eq!(rows(&bench, "whole"), rows(&bench, "parts"));
    bench.check_same("whole/cases.parquet", "parts/cases.parquet");
    bench.check_same("whole/summary.json", "parts/summary.json");
}

#[test]
fn complete_shards_are_kept_and_missing_or_damaged_ones_are_repeated() {
    let bench = bench();
    bench.boresight("study run study.toml --out out --shards 3").done();
    let before = bench.tree("out");
    let paths = [1, 2, 3].map(|i| bench.path("").join(shard("out", &format!("{i}-of-3.parquet"))));
    let modified = |path: &PathBuf| fs::metadata(path).unwrap().modified().unwrap();
    let first = modified(&paths[0]);
    fs::remove_file(&paths[1]).unwrap();
    let mut bytes = fs::read(&paths[2]).unwrap();
    let middle = bytes.len() / 2;
    bytes[middle] ^= 0x10;
    fs::write(&paths[2], &bytes).unwrap();
    bench.boresight("study run study.toml --out out").done();
    check_same_files(&before, &bench.tree("out"));
    assert_eq!(modified(&paths[0]), first);

    fs::write(&paths[2], &bytes[..middle]).unwrap();
    let answer = bench.boresight("study merge study.toml --out out");
    answer.refused(&["shards 3 of 3 are missing or damaged"]);
}

#[test]
fn a_killed_run_leaves_nothing_half_written_and_is_continued() {
    let bench = bench();
    bench.write("long.toml", STUDY.replace("cases = 6", "cases = 24").replace("2002", "2010"));
    let mut child = Command::new(assert_cmd::cargo::cargo_bin!("boresight"))
        .args(["study", "run", "long.toml", "--out", "out", "--shards", "8", "--jobs", "1"])
        .current_dir(bench.path(""))
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .spawn()
        .unwrap();
    let begun = Instant::now();
    let first = bench.path("").join(shard("out", "1-of-8.parquet"));
    while !first.exists() && begun.elapsed() < Duration::from_secs(100) {
        std::thread::sleep(Duration::from_millis(5));
    }
    child.kill().unwrap();
    assert_eq!(child.wait().unwrap().signal(), Some(9), "it was done before it could be killed");
    let kept = fs::metadata(&first).unwrap().modified().unwrap();
    bench.boresight("study run long.toml --out out").done();
    assert_eq!(fs::metadata(&first).unwrap().modified().unwrap(), kept);
    bench.boresight("study run long.toml --out whole --shards 8").done();
    bench.check_same("out/cases.parquet", "whole/cases.parquet");
}

#[test]
fn two_studies_never_mix() {
    let bench = bench();
    bench.boresight("study run study.toml --out out --shards 2").done();
    let tree = bench.tree("out");
    bench.write("other.toml", STUDY.replace("mean = 0.8", "mean = 0.9"));
    bench.boresight("study run other.toml --out out").refused(&["plan.json", "`hash`", "another study"]);
    bench.boresight("study run study.toml --out out --shards 3").refused(&["`shards`", "`2`", "`3`"]);
    bench.boresight("study run study.toml --out out --pipeline exec:true").refused(&["`hash`"]);
    // Naming the built-in pipeline explicitly selects the same pipeline.
    bench.boresight("study run study.toml --out out --pipeline far_range").done();
    check_same_files(&tree, &bench.tree("out"));

    // A shard of another study under the right name is not a shard of this study.
    bench.boresight("study run other.toml --out theirs --shards 2").done();
    let name = shard("out", "1-of-2.parquet");
    fs::copy(bench.path("").join(shard("theirs", "1-of-2.parquet")), bench.path("").join(&name)).unwrap();
    bench.boresight("study merge study.toml --out out").refused(&["shards 1 of 2"]);
    bench.boresight("study run study.toml --out out").done();
    check_same_files(&tree, &bench.tree("out"));
    bench.write("out/shards/3-of-9.parquet", "");
    bench
        .boresight("study merge study.toml --out out")
        .refused(&["3-of-9.parquet", "not one of the 2 shards"]);
}

#[test]
fn a_replayed_case_is_the_case() {
    let bench = bench();
    let summary = bench.boresight("study run study.toml --out out --json").done().json();
    let worst = &summary["worst"][0];
    let case = worst["case"].as_u64().unwrap();
    let command = worst["replay"].as_str().unwrap();
    let words = command.strip_prefix("boresight ").unwrap();
    let score = bench.boresight(&format!("{words} --out again --json")).done().json();
    assert_eq!(figure(&score, "correct_rate"), worst["value"].as_f64().unwrap());
    assert!(bench.path("again/frames/002000.png").exists());
    // The run can be repeated from the run directory only.
    bench.boresight("run again/run.toml --frames 2000..2002 --out third").done();
    bench.check_same("again/measurements.csv", "third/measurements.csv");
    let refused = bench.boresight("study replay study.toml --case 6");
    refused.refused(&["--case is 6", "0 to 5"]);
    assert!(case < 6);
}

/// A program is identified by the files among the words of its command; a study reports the cases in which
/// the program failed, and each can be replayed with it.
#[test]
fn programs_are_part_of_a_study() {
    let bench = bench();
    let run = |pipeline: &str, out: &str| {
        bench.boresight_words(&["study", "run", "study.toml", "--out", out, "--json", "--pipeline", pipeline])
    };
    run("exec:no-such-program", "nothing").refused(&["program `no-such-program` not found"]);
    assert!(!bench.path("nothing").exists(), "nothing is begun for a program that is not there");

    bench.write("my pipeline.py", "import sys\nsys.exit('it is broken')\n");
    let words = "exec:python3 'my pipeline.py'";
    let answer = run(words, "out");
    assert!(
        answer.stderr.contains("the pipeline failed, first in case 0 at frame 2000"),
        "{}",
        answer.stderr
    );
    let summary = answer.done().json();
    assert_eq!(summary["failed_cases"], 6);
    let replay = shlex::split(summary["worst"][0]["replay"].as_str().unwrap()).unwrap();
    assert!(replay.contains(&words.to_owned()), "{replay:?}");
    let replay: Vec<&str> = replay[1..].iter().map(String::as_str).chain(["--out", "again"]).collect();
    bench.boresight_words(&replay).refused(&["failed to start", "it is broken"]);
    assert!(bench.read("again/measurements.csv").contains("failed: "));

    bench.write("my pipeline.py", "import sys\nsys.exit('it is broken in another way')\n");
    run(words, "out").refused(&["`hash`", "another study"]);
}

#[test]
fn a_sweep_has_the_same_draws_at_each_of_its_points() {
    let bench = bench();
    let sweep = "\n[[sweep]]\npath = \"sensor.read_noise_e\"\nvalues = [5.0, 30.0]\n";
    bench.write("sweep.toml", STUDY.to_owned() + sweep);
    let summary = bench.boresight("study run sweep.toml --out out --json").done().json();
    let points = summary["sweep"].as_array().unwrap();
    assert_eq!(points.len(), 2);
    assert!(points.iter().all(|point| point["cases"] == 3));
    assert_eq!(summary["draws"], 3);
    // Both points have three draws: each figure appears once, and without an interval because there are so
    // few draws.
    let steps = summary["differences"].as_array().unwrap();
    let step = steps.iter().find(|step| step["figure"] == "stars_mean").unwrap();
    assert_eq!((&step["draws"], &step["low"]), (&3.into(), &Value::Null));
    let [from, to] = ["from", "to"].map(|end| step[end]["sensor.read_noise_e"].as_str().unwrap());
    assert_eq!((from, to), ("5", "30"));
    let at = |point: usize| points[point]["figures"]["stars_mean"]["all"]["value"].as_f64().unwrap();
    assert!((step["value"].as_f64().unwrap() - (at(1) - at(0))).abs() < 1e-9, "{step}");
    let rows = rows(&bench, "out");
    let cell = |row: &str, name: &str| -> String {
        row.split(&format!("{name}: ")).nth(1).unwrap().split([',', '}']).next().unwrap().to_owned()
    };
    let row = |name: &str, noise: f64| -> Vec<String> {
        let of = |row: &&String| cell(row, "set.sensor.read_noise_e").parse::<f64>().unwrap() == noise;
        rows.iter().filter(of).map(|row| cell(row, name)).collect()
    };
    for name in ["set.psf.sigma_px", "set.sensor.hot_pixels.count", "seed"] {
        assert_eq!(row(name, 5.0).len(), 3, "{name}");
        assert_eq!(row(name, 5.0), row(name, 30.0), "{name}");
    }
}

/// Three replications of two draws at two points of a sweep: the replications are the independent draws.
#[test]
fn replications_of_a_design_are_its_independent_draws() {
    let bench = bench();
    let study = STUDY.replace("seed = 5", "seed = 5\ndesign = \"latin_hypercube\"\nreplications = 3");
    let sweep = "\n[[sweep]]\npath = \"sensor.read_noise_e\"\nvalues = [5.0, 30.0]\n";
    bench.write("replicated.toml", study.replace("cases = 6", "cases = 12") + sweep);
    let summary = bench.boresight("study run replicated.toml --out out --json").done().json();
    assert_eq!((&summary["cases"], &summary["draws"]), (&12.into(), &3.into()));
    assert!(summary["differences"].as_array().unwrap().iter().all(|step| step["draws"].as_u64() <= Some(3)));
    // With a single design, its draws count as independent.
    bench.write(
        "one.toml",
        fs::read_to_string(bench.path("replicated.toml")).unwrap().replace("replications = 3", ""),
    );
    let one = bench.boresight("study run one.toml --out one --json").done().json();
    assert_eq!(one["draws"], 6);
    assert_ne!(one["hash"], summary["hash"]);
}

#[test]
fn a_study_stops_when_its_interval_is_narrow_enough() {
    let bench = bench();
    let until = |figure: &str, half_width: &str| {
        let until = format!("cases = 24\nuntil = {{ figure = \"{figure}\", half_width = {half_width} }}");
        STUDY.replace("cases = 6", &until)
    };
    bench.write("wide.toml", until("stars_mean", "100.0"));
    bench.write("narrow.toml", until("stars_mean", "1e-6"));
    // Every target is hit: the interval is narrow, and the scatter is unknown.
    bench.write("constant.toml", until("hit_rate", "0.2"));
    let cases = |name: &str, shards: u32| {
        let words = format!("study run {name}.toml --out {name}-{shards} --shards {shards} --json");
        let summary = bench.boresight(&words).done().json();
        (summary["cases"].as_u64().unwrap(), summary["waited"].as_str().unwrap().to_owned())
    };
    let ended = |cases: u64, waited: &str| (cases, waited.to_owned());
    // The stopping point does not depend on the number of shards, and unneeded cases are not missing.
    assert_eq!(cases("wide", 4), ended(16, "narrow_enough"));
    assert_eq!(cases("wide", 5), ended(16, "narrow_enough"));
    bench.check_same("wide-4/cases.parquet", "wide-5/cases.parquet");
    bench.check_same("wide-4/summary.json", "wide-5/summary.json");
    assert!(!bench.path("wide-4/shards/4-of-4.parquet").exists());
    bench.boresight("study merge wide.toml --out wide-4").done();
    bench.check_same("wide-4/cases.parquet", "wide-5/cases.parquet");
    assert_eq!(cases("narrow", 3), ended(24, "too_wide"));
    assert_eq!(cases("constant", 3), ended(24, "nearly_constant"));
    let told = bench.boresight("study merge constant.toml --out constant-3").done();
    assert!(told.stdout.contains("is equal in nearly every draw"), "{}", told.stdout);
    bench.boresight("study run wide.toml --out x --shard 1/3").refused(&["--shard", "stop.until"]);
    bench.boresight("study plan wide.toml").refused(&["stop.until"]);
}

#[test]
fn a_case_that_makes_no_scenario_is_a_row_with_its_error() {
    let bench = bench();
    let choice = |values: &str| {
        let vary =
            "\n[[vary]]\npath = \"sensor.read_noise_e\"\ndistribution = { kind = \"choice\", values = ";
        format!("{}{vary}{values} }}\n", STUDY.replace("cases = 6", "cases = 12"))
    };
    bench.write("some.toml", choice("[5.0, 5.0, 5.0, -1.0]"));
    let told = bench.boresight("study run some.toml --out out").done();
    assert!(
        told.stdout.contains("cannot be run") && told.stdout.contains("sensor.read_noise_e"),
        "{}",
        told.stdout
    );
    let summary: Value = serde_json::from_str(&bench.read("out/summary.json")).unwrap();
    let errors = summary["error_cases"].as_u64().unwrap();
    assert!((1..12).contains(&errors), "{errors}");
    assert!(summary["errors"][0]["error"].as_str().unwrap().contains("-1"), "{summary}");
    assert_eq!(summary["figures"]["hit_rate"]["cases"], 12 - errors);
    // The check tests each value of a choice, regardless of the case in which it occurs.
    bench.boresight("study check some.toml").refused(&["sensor.read_noise_e", "is -1"]);
    // Nothing is run again.
    let again = bench.boresight("study merge some.toml --out out --json").done().json();
    assert_eq!(again, summary);
    bench.write("none.toml", choice("[-1.0]"));
    bench.boresight("study run none.toml --out none").refused(&["sensor.read_noise_e", "is -1"]);
    assert!(!bench.path("none").exists());
}

/// A swept value without a result is named in table, report and summary, and its requirement is not decided;
/// all other points keep their figures. A stop by a figure ends all points after the same number of draws.
#[test]
fn a_swept_value_without_a_result_is_named() {
    let bench = bench();
    let sweep = "\n[[sweep]]\npath = \"sensor.read_noise_e\"\nvalues = [5.0, -1.0]\n";
    let required = "\n[[require]]\nfigure = \"hit_rate\"\nat_least = 0.1\n";
    bench.write("study.toml", format!("{STUDY}{sweep}{required}"));
    let shown = bench.boresight("study run study.toml --out out --shards 2");
    assert_eq!(shown.status, Some(1), "{}", shown.stderr);
    let note = "1 of 2 sweep points without a result, because none of their cases can be run: differences and \
                curves leave them out. sensor.read_noise_e = -1.";
    // The text is wrapped at the width of a terminal.
    let unwrapped = |text: &str| text.split_whitespace().collect::<Vec<_>>().join(" ");
    assert!(unwrapped(&shown.stdout).contains(note), "{}", shown.stdout);
    assert!(shown.stdout.contains("not decided: no case can be run"), "{}", shown.stdout);
    assert!(bench.read("out/report.html").contains(note));
    let summary: Value = serde_json::from_str(&bench.read("out/summary.json")).unwrap();
    let [valid, invalid] = [&summary["sweep"][0], &summary["sweep"][1]];
    assert_eq!((&valid["cases"], &valid["error_cases"]), (&3.into(), &Value::Null));
    assert_eq!((&invalid["cases"], &invalid["error_cases"]), (&3.into(), &3.into()));
    assert_eq!(valid["figures"]["hit_rate"]["cases"], 3);
    assert_eq!(summary["requirements"][0]["verdict"], "met");
    assert_eq!(
        (&summary["requirements"][1]["verdict"], &summary["requirements"][1]["cases"]),
        (&"not_decided".into(), &0.into())
    );
    bench.boresight("study check study.toml").refused(&["sensor.read_noise_e", "is -1"]);

    // A program that fails at one of the values.
    let program = "import json, sys\n\
                   camera = json.loads(sys.stdin.readline())\n\
                   sys.exit('it needs a quiet detector')\n";
    bench.write("fails.py", program);
    bench.write("fails.toml", format!("{STUDY}{}", sweep.replace("-1.0", "9.0")));
    let words = ["study", "run", "fails.toml", "--out", "fails", "--pipeline", "exec:python3 fails.py"];
    let shown = bench.boresight_words(&words);
    assert!(
        unwrapped(&shown.stdout).contains("2 of 2 sweep points at which the pipeline failed in every case"),
        "{}",
        shown.stdout
    );

    let until = "cases = 40\nuntil = { figure = \"stars_mean\", half_width = 100.0 }";
    let sweep = sweep.replace("-1.0", "30.0");
    bench.write("until.toml", format!("{}{sweep}", STUDY.replace("cases = 6", until)));
    let summary = bench.boresight("study run until.toml --out until --shards 7 --json").done().json();
    assert_eq!(summary["waited"], "narrow_enough");
    let cases: Vec<u64> =
        summary["sweep"].as_array().unwrap().iter().map(|point| point["cases"].as_u64().unwrap()).collect();
    assert_eq!(cases, [16, 16]);
}

#[test]
fn a_damaged_plan_is_reported_as_such() {
    let bench = bench();
    bench.write("study.toml", STUDY);
    bench.boresight("study run study.toml --out out --shard 1/2").done();
    let plan = bench.read("out/plan.json");
    for (old, new) in [("\"cases\": 6", "\"cases\": 7"), ("\"shards\": 2", "\"shards\": 3"), ("{", "[")] {
        assert_ne!(plan.replacen(old, new, 1), plan, "{old}");
        bench.write("out/plan.json", plan.replacen(old, new, 1));
        for command in ["study run study.toml --out out --shard 2/2", "study merge study.toml --out out"] {
            bench.boresight(command).refused(&["plan.json", "is damaged", "delete it"]);
        }
    }
    // Following the message.
    fs::remove_file(bench.path("out/plan.json")).unwrap();
    bench.boresight("study run study.toml --out out --shard 2/2").done();
    bench.boresight("study merge study.toml --out out").done();
    let missing = ["study", "check", "study.toml", "--pipeline", "exec:python3 missing.py"];
    bench.boresight_words(&missing).refused(&["the pipeline failed", "missing.py"]);
}

/// The numbers of frames by cause add up to the rates of misses and wrong results.
#[test]
fn misses_have_their_causes() {
    let bench = bench();
    bench.write("study.toml", STUDY);
    let summary = bench.boresight("study run study.toml --out out --json").done().json();
    for (verdict, rate) in [("missed.", "miss_rate"), ("wrong.", "wrong_rate")] {
        let causes = summary["causes"].as_object().unwrap().iter();
        let shares: f64 = causes
            .filter(|(name, _)| name.starts_with(verdict))
            .map(|(_, cause)| cause["share"]["value"].as_f64().unwrap())
            .sum();
        let all = summary["figures"][rate]["all"]["value"].as_f64().unwrap();
        assert!((all - shares).abs() < 1e-12, "{rate}: {all} {shares}");
    }
    assert!(!summary["causes"].as_object().unwrap().is_empty());
}

#[test]
fn docking_is_studied_too() {
    let bench = Bench::new();
    bench.write(
        "docking.toml",
        r#"
        title = "four fields of an approach, over the Sun"
        scenario = "docking"
        seed = 2
        frames = "18000..18004"
        [stop]
        cases = 4
        [[vary]]
        path = "television.noise.sigma_dn8"
        distribution = { kind = "uniform", min = 0.5, max = 4.0 }
        "#,
    );
    let summary = bench.boresight("study run docking.toml --out out --json").done().json();
    assert_eq!(summary["figures"]["success_rate"]["all"]["value"], 1.0);
    // A replayed case has the figures of its row, to the bit.
    let score = bench.boresight("study replay docking.toml --case 2 --out again --json").done().json();
    let row = rows(&bench, "out").remove(2);
    let range_rms_m = row.split("range_rms_m: ").nth(1).unwrap().split(',').next().unwrap().to_owned();
    assert_eq!(range_rms_m.parse::<f64>().unwrap(), figure(&score, "range_rms_m"));
}

#[test]
fn the_plan_holds_the_command_of_every_shard() {
    let bench = bench();
    let plan: Value = bench.boresight("study plan study.toml --shards 4 --json").done().json();
    let pieces = plan["pieces"].as_array().unwrap();
    assert_eq!(pieces.iter().map(|piece| piece["cases"].as_u64().unwrap()).sum::<u64>(), 6);
    for piece in pieces {
        let words: Vec<&str> =
            piece["arguments"].as_array().unwrap().iter().map(|word| word.as_str().unwrap()).collect();
        let manifest =
            bench.boresight_words(&[&words[..], &["--out", "out", "--json"]].concat()).done().json();
        assert_eq!(manifest["first_case"], piece["first_case"]);
        assert_eq!(manifest["study_hash"], plan["hash"]);
    }
    bench.boresight("study merge study.toml --out out").done();
}

/// The study of docs/evidence/studies.md without drawing of dark pixels runs as printed, and is rejected with
/// thresholds below the floor.
#[test]
fn whole_images_are_drawn_above_a_floor_by_one_word_and_never_read_below() {
    let bench = Bench::new();
    let page = include_str!("../../docs/evidence/studies.md");
    let study = page.split("```toml").find(|part| part.contains("zero_suppression_dn\"\nvalues")).unwrap();
    let study = study.split("```").next().unwrap();
    bench.write("study.toml", study);
    bench.boresight("study check study.toml").done();
    bench.boresight("study run study.toml --out out --no-report").done();
    let summary: Value = serde_json::from_slice(&fs::read(bench.path("out/summary.json")).unwrap()).unwrap();
    let hit_rate = &summary["figures"]["hit_rate"]["all"]["value"];
    assert!(hit_rate.as_f64() > Some(0.9), "{hit_rate}");
    let refused = |old: &str, new: &str, parts: &[&str]| {
        assert_eq!(study.matches(old).count(), 1, "`{old}`");
        bench.write("study.toml", study.replace(old, new));
        bench.boresight("study check study.toml").refused(parts);
        bench.boresight("study plan study.toml").refused(parts);
        bench.boresight("study run study.toml --out never --no-report").refused(parts);
        assert!(!bench.path("never").exists());
    };
    refused("low = 0.0165", "low = 0.016", &["thresholds.low", "is 0.016, 65 DN"]);
    refused("values = [67]", "values = [67, 100]", &["thresholds.low", "is 0.0165, 67 DN"]);
    let constant = "{ mode = \"constant\", low = 0.0165, high = 0.03 }";
    refused(constant, "{ mode = \"automatic\" }", &["thresholds.mode", "is automatic"]);
}

/// Every error message names the file, the field, the value and the expected value.
#[test]
fn an_invalid_study_is_reported_with_the_position() {
    let bench = Bench::new();
    let refused = |old: &str, new: &str, parts: &[&str]| {
        assert_eq!(STUDY.matches(old).count(), 1, "`{old}`");
        bench.write("study.toml", STUDY.replace(old, new));
        let all = [&["study.toml"], parts].concat();
        bench.boresight("study check study.toml").refused(&all);
    };
    refused("\"argon\"", "\"argom\"", &["scenario", "did you mean `argon`"]);
    refused("psf.sigma_px", "psf.sigma", &["case 0", "psf", "sigma"]);
    refused("psf.sigma_px", "psff.sigma_px", &["vary[0].path", "no key `psff`"]);
    refused("\"psf.sigma_px\"", "\"title\"", &["vary[0].path", "is `title`", "seeds already differ"]);
    // The scoring of cases is not a parameter: figures with different limits, or with different attitudes,
    // have no common mean.
    refused("\"psf.sigma_px\"", "\"score.within_deg[0]\"", &["vary[0].path", "is `score.within_deg[0]`"]);
    refused("psf.sigma_px", "schedule[9].count", &["vary[0].path", "has 5 elements"]);
    refused("psf.sigma_px", "sensor.hot_pixels", &["vary[1].path", "sensor.hot_pixels"]);
    refused("sigma = 0.1", "sigma = -0.1", &["vary[0].distribution.sigma", "-0.1", "above 0"]);
    refused("kind = \"normal\"", "kind = \"normale\"", &["normale"]);
    // Names of earlier versions are refused with those of today.
    refused(
        "distribution = { kind = \"normal\"",
        "law = { kind = \"normal\"",
        &["study.toml:", "unknown field `law`", "`law` is now called `distribution`"],
    );
    refused(
        "kind = \"integer\"",
        "kind = \"whole\"",
        &["study.toml:", "unknown variant `whole`", "`whole` is now called `integer`"],
    );
    refused("max = 40", "max = -1", &["max"]);
    refused("cases = 6", "cases = 0", &["stop.cases", "is 0"]);
    refused(
        "cases = 6",
        "cases = 6\nuntil = { figure = \"hit_rate\", half_width = 5 }",
        &["stop.until.half_width", "is 5, expected a fraction from 0 to 0.5", "write 0.05 for 5 %"],
    );
    refused("frames = \"2000..2002\"", "frames = \"2..1\"", &["frames", "2..1", "A < B"]);
    refused("seed = 5", "seed = 5\ndesign = \"sobel\"", &["design", "sobel", "did you mean `sobol`"]);
    refused("seed = 5", "seed = 5\ndesign = \"saltelli\"", &["stop.cases", "multiple of 4"]);
    refused("seed = 5", "seed = 5\nreplications = 3", &["replications", "is 3", "latin_hypercube and sobol"]);
    refused("seed = 5", "seed = 5\nreplications = 0", &["replications", "is 0", "1 to 10000"]);
    refused("seed = 5", "seed = 5\ndesign = \"sobol\"\nreplications = 4", &["stop.cases", "multiple of 4"]);
    refused(
        "[stop]",
        "[record]\nfigures = [\"hitrate\"]\n[stop]",
        &["record.figures[0]", "hitrate", "did you mean `hit_rate`"],
    );
    refused(
        "kind = \"integer\", min = 0, max = 40",
        "kind = \"table\", path = \"none.csv\", column = \"x\"",
        &["vary[1].distribution.path", "none.csv"],
    );
    refused(
        "path = \"psf.sigma_px\"\ndistribution = { kind = \"normal\", mean = 0.8, sigma = 0.1 }",
        "path = \"psf\"\ndistribution = { kind = \"isotropic_attitude\" }",
        &["vary[0].path", "ra_deg", "phi_deg"],
    );
    // A distribution that leaves the valid range of a parameter: the message names the case and the value in
    // its scenario.
    refused("mean = 0.8, sigma = 0.1", "mean = -3.0, sigma = 0.1", &["case 0", "psf.sigma_px"]);
    bench.boresight("study check nothing.toml").refused(&["nothing.toml", "cannot be read"]);
}

/// Requirements are decided at each point of the sweep. They change no row; a study with different
/// requirements is therefore the same study.
#[test]
fn requirements_are_decided_with_their_confidence() {
    let bench = bench();
    let with = |required: &str| bench.write("study.toml", format!("{STUDY}\n{required}"));
    with(
        "[[require]]\nfigure = \"hit_rate\"\nat_least = 0.0\n[[require]]\nfigure = \"hit_rate\"\nat_most = 1.0\n",
    );
    let met = bench.boresight("study run study.toml --out out --json").done().json();
    let verdicts = |summary: &Value| -> Vec<String> {
        let results = summary["requirements"].as_array().unwrap();
        results.iter().map(|result| result["verdict"].as_str().unwrap().to_owned()).collect()
    };
    assert!(!verdicts(&met).is_empty());
    assert!(verdicts(&met).iter().all(|verdict| verdict == "met"), "{met}");
    // Stricter requirements on unchanged rows: no row is run again.
    with("[[require]]\nfigure = \"hit_rate\"\nat_least = 0.999999\nconfidence = 0.99\n");
    let open = bench.boresight("study merge study.toml --out out --json");
    assert_eq!(open.status, Some(1), "{}", open.stderr);
    assert_eq!(open.json()["hash"], met["hash"]);
    assert!(verdicts(&open.json()).iter().any(|verdict| verdict != "met"), "{:?}", open.json());
    let shown = bench.boresight("study merge study.toml --out out");
    assert!(shown.stdout.contains("Not all requirements are"), "{}", shown.stdout);
    let page = bench.read("out/report.html");
    assert!(page.contains("Requirements") && page.contains("confidence 99"), "no requirements in the report");
    for (required, words) in [
        ("[[require]]\nfigure = \"hit_rate\"", ["require[0].figure", "at_least or at_most"]),
        (
            "[[require]]\nfigure = \"hit_rate\"\nat_least = 0.5\nat_most = 0.9",
            ["require[0].at_most", "one of the two"],
        ),
        (
            "[[require]]\nfigure = \"hit_rat\"\nat_least = 0.5",
            ["require[0].figure", "did you mean `hit_rate`"],
        ),
        ("[[require]]\nfigure = \"hit_rate\"\nat_least = 0.5\nconfidence = 1.0", ["confidence", "0.9999"]),
        (
            "[[require]]\nfigure = \"hit_rate\"\nat_least = 95",
            [
                "require[0].at_least",
                "is 95, expected a fraction from 0 to 1, because hit_rate is a rate; write 0.95 for 95 %",
            ],
        ),
        (
            "[[require]]\nfigure = \"hit_rate\"\nat_most = 99.9",
            ["require[0].at_most", "write 0.999 for 99.9 %"],
        ),
        (
            "[[require]]\nfigure = \"hit_rate\"\nat_least = -0.5",
            ["require[0].at_least", "is -0.5, expected a fraction"],
        ),
        (
            "[[require]]\nfigure = \"x_rms_px\"\nat_most = 95\nconfidence = 2.0",
            ["require[0].confidence", "is 2"],
        ),
    ] {
        with(required);
        bench.boresight("study check study.toml").refused(&words);
    }
}
