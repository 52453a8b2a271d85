//! A separate world, registered in one line: it runs through render, process, run, score, study, gate and
//! report, none of which refers to it.

mod world;

use std::sync::Once;

use boresight::run::plain::Plain;
use boresight::run::{ErasedWorld, register};
use boresight::score::Figure;
use indexmap::IndexMap;
use serde_json::Value;

use self::world::{BlinkingDot, SCENARIO};
use crate::support::Bench;

/// Runs the command with these words in this process, in which the world is registered, and returns its exit
/// status.
fn boresight(words: &str) -> u8 {
    static REGISTERED: Once = Once::new();
    boresight::register_worlds();
    REGISTERED.call_once(|| register(&ErasedWorld::<Plain<BlinkingDot>>::NEW));
    boresight::command::run_words(["boresight"].into_iter().chain(words.split(' ')).map(Into::into))
}

#[test]
fn a_separate_world_runs_through_every_command() {
    let bench = Bench::new();
    let at = |name: &str| bench.path(name).display().to_string();
    let (scenario, run, set) = (at("dot.toml"), at("run"), at("set"));

    assert_eq!(boresight(&format!("scenario new {scenario} --world blinking_dot")), 0);
    assert_eq!(boresight(&format!("scenario check {scenario}")), 0);
    assert_eq!(boresight(&format!("run {scenario} --out {run}")), 0);
    let score: IndexMap<String, Figure> = serde_json::from_str(&bench.read("run/score.json")).unwrap();
    // The noise never exceeds the threshold in a line without a dot, and never moves the brightest pixel in a
    // line with a dot.
    assert_eq!(score["correct_rate"].value, Some(1.0));
    assert_eq!((score["column_rms_px"].value, score["column_rms_px"].of), (Some(0.0), 200));
    let report = bench.read("run/report.html");
    assert!(report.contains("A dot that blinks") && report.contains("column_rms_px"));

    // The rendered dataset gives the same measurements, and the same score.
    assert_eq!(boresight(&format!("render {scenario} --out {set}")), 0);
    assert_eq!(boresight(&format!("process {set}")), 0);
    assert_eq!(bench.read("set/measurements.csv"), bench.read("run/measurements.csv"));
    assert_eq!(boresight(&format!("score {run} {set}/measurements.csv")), 0);
    assert_eq!(boresight(&format!("report {run} -o {}", at("report.html"))), 0);

    // A pipeline that mistakes noise for the dot is worse than the baseline.
    assert_eq!(boresight(&format!("gate baseline {run} --out {} --reason first", at("baseline"))), 0);
    assert_eq!(boresight(&format!("gate {} {run}", at("baseline"))), 0);
    bench.write("low.toml", SCENARIO.replace("threshold_dn = 50", "threshold_dn = 5"));
    assert_eq!(boresight(&format!("run {} --out {}", at("low.toml"), at("low"))), 0);
    assert_eq!(boresight(&format!("gate {} {}", at("baseline"), at("low"))), 1);

    // A study with varying threshold.
    let distribution = "distribution = { kind = \"choice\", values = [5, 50] }";
    let study = format!(
        "title = \"\"\nscenario = \"dot.toml\"\nseed = 1\n[stop]\ncases = 8\n[[vary]]\npath = \"blinking_dot.threshold_dn\"\n{distribution}\n"
    );
    bench.write("study.toml", study);
    assert_eq!(boresight(&format!("study run {} --out {}", at("study.toml"), at("study"))), 0);
    let summary: Value = serde_json::from_str(&bench.read("study/summary.json")).unwrap();
    assert_eq!(summary["cases"], 8);
    let words = format!("study replay {} --case 0 --save-frames png --out {}", at("study.toml"), at("case"));
    let replayed = summary.to_string();
    assert!(replayed.contains("--case 0 --hash ") && replayed.contains(" --save-frames png"));
    assert_eq!(boresight(&words), 0);
    assert_eq!(boresight(&format!("report {} -o {}", at("study"), at("study.html"))), 0);

    // An unknown world is rejected.
    bench.write("other.toml", SCENARIO.replace("world = \"blinking_dot\"", "world = \"blinking_dott\""));
    assert_eq!(boresight(&format!("run {} --out {}", at("other.toml"), at("other"))), 2);
}

/// A trajectory that depends on the answers: the same on any number of threads, logged, and each frame can be
/// made again alone.
#[test]
fn a_frame_that_depends_on_answers_is_made_again_alone() {
    let bench = Bench::new();
    let at = |name: &str| bench.path(name).display().to_string();
    bench.write("flees.toml", SCENARIO.replace("noise_dn = 40", "noise_dn = 40\nflees = true"));
    assert_eq!(
        boresight(&format!("run {} --jobs 1 --save-frames png --out {}", at("flees.toml"), at("one"))),
        0
    );
    assert_eq!(
        boresight(&format!("run {} --jobs 3 --save-frames png --out {}", at("flees.toml"), at("three"))),
        0
    );
    let image =
        |run: &str, frame: u64| std::fs::read(bench.path(&format!("{run}/frames/{frame:06}.png"))).unwrap();
    for frame in 0..300 {
        assert_eq!(image("one", frame), image("three", frame), "frame {frame}");
    }
    assert!(bench.read("one/truth/states.jsonl").starts_with("{\"frame\":2,\"state\":1}\n"));

    // Without answers the dot stays where it is.
    assert_eq!(boresight(&format!("render {} --out {}", at("flees.toml"), at("unanswered"))), 0);
    assert_ne!(image("one", 101), image("unanswered", 101));
    for frame in [0, 1, 2, 101, 299] {
        let again = format!("frame-{frame}");
        let words =
            format!("render {} --frames {frame}..{} --out {}", at("one/run.toml"), frame + 1, at(&again));
        assert_eq!(boresight(&words), 0);
        assert_eq!(image(&again, frame), image("one", frame), "frame {frame}");
    }
}
