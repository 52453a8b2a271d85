//! Identity by content: two results belong to the same subject if the files that they read have the same
//! content, regardless of the location of the files.

use crate::support::{Bench, STUDY};

const STARS: &str = "id,ra_deg,dec_deg,hp_mag\n5,100,20,3\n7,101,21,3.5\n";
const OTHER_STARS: &str = "id,ra_deg,dec_deg,hp_mag\n5,100,20,3\n7,101,21,2.5\n";

/// Writes a directory with a scenario that reads a catalogue.
fn folder(bench: &Bench, name: &str, stars: &str) {
    std::fs::create_dir_all(bench.path(name)).unwrap();
    bench.write(&format!("{name}/stars.csv"), stars);
    bench.scenario(&format!("{name}/sky.toml"), "starting-point", |table| {
        let camera = table["camera"].as_table_mut().unwrap();
        camera.extend([("columns", 160), ("rows", 120)].map(|(key, value)| (key.to_owned(), value.into())));
        let principal = [("principal_x_px", 79.5), ("principal_y_px", 59.5)];
        camera.extend(principal.map(|(key, value)| (key.to_owned(), value.into())));
        let source = toml::Table::from_iter([("source".to_owned(), "stars.csv".into())]);
        table.insert("catalog".to_owned(), source.into());
    });
}

fn hash(bench: &Bench, run: &str) -> String {
    bench.read(&format!("{run}/run.toml")).parse::<toml::Table>().unwrap()["hash"].to_string()
}

#[test]
fn a_run_is_identified_by_the_content_of_its_files() {
    let bench = Bench::new();
    for (name, stars) in [("a", STARS), ("b", STARS), ("c", OTHER_STARS)] {
        folder(&bench, name, stars);
        bench.boresight(&format!("run {name}/sky.toml --frames 0..60 --out run-{name} --no-report")).done();
    }
    assert_eq!(hash(&bench, "run-a"), hash(&bench, "run-b"));
    assert_ne!(hash(&bench, "run-a"), hash(&bench, "run-c"));
    let digest = "\n[files]\n\"catalog.source\" = \"";
    assert!(bench.read("run-a/run.toml").contains(digest), "{}", bench.read("run-a/run.toml"));

    bench.boresight("gate baseline run-a --out good --reason test --block-length 10").done();
    let same = bench.boresight("gate good run-b --json").done().json();
    assert_eq!(same["pairing"], "frames", "{same}");
    bench.boresight("gate good run-c").refused(&["`catalog_sha256`", "in the baseline"]);

    // A run is repeated with the files that it read, or not at all.
    bench.boresight("run run-a/run.toml --frames 0..2 --out again --no-report").done();
    bench.write("a/stars.csv", OTHER_STARS);
    bench.boresight("run run-a/run.toml --frames 0..2 --out other --no-report").refused(&[
        "run.toml",
        "catalog.source",
        "stars.csv",
        "has changed",
    ]);
}

#[test]
fn shards_of_a_catalogue_that_changed_are_not_mixed() {
    let bench = Bench::new();
    folder(&bench, "a", STARS);
    bench.write("a/study.toml", STUDY.replace("\"argon\"", "\"sky.toml\"").replace("2000..2002", "0..2"));
    let run = |words: &str| bench.boresight(&format!("study {words}"));
    run("run a/study.toml --out out --shard 1/2").done();
    std::fs::rename(bench.path("a"), bench.path("b")).unwrap();
    run("run b/study.toml --out out --shard 1/2").done();

    bench.write("b/stars.csv", OTHER_STARS);
    for words in [
        "run b/study.toml --out out --shard 2/2",
        "run b/study.toml --out out",
        "merge b/study.toml --out out",
    ] {
        run(words).refused(&["plan.json", "`hash`", "another study"]);
    }
    bench.write("b/stars.csv", STARS);
    let summary = run("run b/study.toml --out out --json").done().json();
    let line = summary["worst"][0]["replay"].as_str().unwrap_or_else(|| panic!("{summary}")).to_owned();
    assert!(line.contains(" --hash "), "{line}");
    let replay = format!("{} --out replay --no-report", line.strip_prefix("boresight ").unwrap());
    bench.write("b/stars.csv", OTHER_STARS);
    bench.boresight(&replay).refused(&["--hash", "was changed"]);
    bench.write("b/stars.csv", STARS);
    bench.boresight(&replay).done();
}

#[test]
fn tables_and_swept_files_of_a_study_are_identified_by_their_content() {
    let bench = Bench::new();
    for name in ["a", "b"] {
        folder(&bench, name, STARS);
        bench.write(&format!("{name}/other.csv"), OTHER_STARS);
        bench.write(&format!("{name}/draws.csv"), "sigma\n0.7\n0.8\n");
        let sweep = "[[sweep]]\npath = \"catalog.source\"\nvalues = [\"stars.csv\", \"other.csv\"]\n";
        let table = "[[vary]]\npath = \"psf.sigma_px\"\ndistribution = { kind = \"table\", path = \"draws.csv\", column = \"sigma\" }\n";
        let head = "title = \"t\"\nscenario = \"sky.toml\"\nseed = 5\nframes = \"0..1\"\n[stop]\ncases = 4\n";
        bench.write(&format!("{name}/study.toml"), format!("{head}{sweep}{table}"));
    }
    let hash = |name: &str| {
        let checked = bench.boresight(&format!("study check {name}/study.toml --json")).done().json();
        checked["hash"].as_str().unwrap().to_owned()
    };
    assert_eq!(hash("a"), hash("b"));
    let before = hash("b");
    for (file, text) in [("draws.csv", "sigma\n0.7\n0.9\n"), ("other.csv", STARS), ("stars.csv", OTHER_STARS)]
    {
        let old = bench.read(&format!("b/{file}"));
        bench.write(&format!("b/{file}"), text);
        assert_ne!(hash("b"), before, "{file}");
        bench.write(&format!("b/{file}"), old);
    }
    assert_eq!(hash("b"), before);
}

#[test]
fn the_same_frames_have_the_same_objects() {
    let bench = Bench::new();
    folder(&bench, "a", STARS);
    bench.boresight("run a/sky.toml --frames 0..60 --out run --no-report").done();
    bench.boresight("gate baseline run --out good --reason test --block-length 10").done();
    bench.edit("a/sky.toml", "count = 10", "count = 11");
    bench.boresight("run a/sky.toml --frames 0..60 --out other --no-report").done();
    bench.unseal("run");
    std::fs::copy(bench.path("other/truth/objects.parquet"), bench.path("run/truth/objects.parquet"))
        .unwrap();
    let compared = bench.boresight("gate good run --json").json();
    assert_eq!(compared["pairing"], "blocks", "{compared}");
}

#[test]
fn answers_of_other_frames_are_not_scored() {
    let bench = Bench::new();
    folder(&bench, "a", STARS);
    let run =
        |words: &str| bench.boresight(&format!("run a/sky.toml --frames 0..4 --no-report {words}")).done();
    run("--out first");
    run("--out second --seed 77");
    run("--out told --inject centroids");
    bench.boresight("score first first/measurements.csv").done();
    bench.boresight("score first second/measurements.csv").refused(&["second/run.toml", "`seed`", "77"]);
    bench.boresight("score first told/measurements.csv").refused(&["told/run.toml", "`inject`", "centroids"]);
    bench.edit("a/sky.toml", "sigma_px = ", "sigma_px = 1");
    run("--out third");
    bench
        .boresight("score first third/measurements.csv")
        .refused(&["third/run.toml", "`scenario.psf.sigma_px`"]);
    bench
        .boresight("score first first/measurements.csv --clusters second/clusters.parquet")
        .refused(&["second/run.toml", "`seed`"]);

    // Without a record beside them, measurements may state their origin.
    let telemetry = bench.csv("first/telemetry.csv");
    let (time, later) = (&telemetry[1]["time_utc"], &telemetry[2]["time_utc"]);
    let told = hash(&bench, "first").trim_matches('"').to_owned();
    let table = |time: &str, hash: &str| {
        format!(
            "frame,status,x_px,y_px,time_utc,configuration\n0,no_target,,,,\n1,detected,5,5,{time},{hash}\n"
        )
    };
    bench.write("mine.csv", table(time, &told));
    bench.boresight("score first mine.csv").done();
    bench.write("mine.csv", table(later, &told));
    bench.boresight("score first mine.csv").refused(&["mine.csv", "line 3", "`time_utc`", later]);
    bench.write("mine.csv", table(time, "ab"));
    bench.boresight("score first mine.csv").refused(&["mine.csv", "line 3", "`configuration`", "ab"]);
}
