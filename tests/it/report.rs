//! `boresight report`: required content of a page, agreement of its numbers with those of the files, and
//! absence of network requests.

use std::collections::BTreeSet;
use std::fs;

use boresight::far_range::scoring::Verdict;
use boresight::far_range_views::report::{FarRangeRun, FrameDetail, far_range_page};
use boresight::report::RunFiles;
use boresight::report::page::Block;
use contract::Angle;
use serde_json::Value;

use crate::support::{Bench, STUDY};

/// Maximum length of a page, bytes.
const MAX_BYTES: usize = 3_000_000;

/// A page without the charting library, which contains addresses that it never requests.
struct PageText {
    html: String,
    bytes: usize,
}

impl PageText {
    fn read(bench: &Bench, name: &str) -> Self {
        let html = bench.read(name);
        let bytes = html.len();
        let start = html.find("<script>/**").or_else(|| html.find("<script>\n/**")).expect("plotly.js");
        let end = start + html[start..].find("</script>").unwrap();
        Self { html: html[..start].to_owned() + &html[end..], bytes }
    }

    /// Returns the JSON of the script tags of a type, in order.
    fn documents(&self, tag: &str) -> Vec<Value> {
        let parts = self.html.split(tag).skip(1);
        parts
            .map(|part| part.split_once('>').unwrap().1.split("</script>").next().unwrap())
            .map(|json| serde_json::from_str(json).unwrap_or_else(|error| panic!("{error} in {json:.200}")))
            .collect()
    }

    fn data(&self) -> Value {
        self.documents(r#"<script type="application/json" id="report-data""#).remove(0)
    }

    fn charts(&self) -> Vec<Value> {
        self.documents(r#"px"><script type="application/json""#)
    }

    /// Checks the requirements for every page.
    fn check(&self, sections: &[&str]) {
        assert!(self.bytes < MAX_BYTES, "{} bytes", self.bytes);
        for section in sections {
            assert!(self.html.contains(&format!("<section id=\"{section}\"")), "no section {section}");
        }
        self.check_makes_no_request();
        self.check_shows_no_keys();
        assert!(self.html.contains("prefers-color-scheme: dark") && self.html.contains("@media print"));
        let charts = self.charts();
        assert!(!charts.is_empty());
        let count = |text: &str| self.html.matches(text).count();
        assert_eq!(count("<figure class=\"chart\">"), charts.len());
        assert_eq!(count("<summary>Data</summary>"), charts.len(), "a table behind every chart");
        for chart in charts {
            assert!(!chart["data"].as_array().unwrap().is_empty() && chart["layout"].is_object());
        }
        self.check_drawn_charts();
    }

    /// Checks that figures and causes appear in words, never as the keys used in files. Settings and names of
    /// files appear as written.
    fn check_shows_no_keys(&self) {
        const CAUSES: [&str; 10] = [
            "not_reported",
            "lost_motion_test",
            "not_linked",
            "taken_for_star",
            "cut_by_roi",
            "no_previous_frame",
            "too_few_features",
            "lost_lines",
            "pipeline_failed",
            "outside_field",
        ];
        let mut shown = String::new();
        // Excludes the machine-readable data; the content of charts is in their JSON.
        for (n, part) in self.html.split("<script").enumerate() {
            let (script, text) = if n == 0 { ("", part) } else { part.split_once("</script>").unwrap() };
            shown += if script.contains("report-data") { "" } else { script };
            shown += text;
        }
        boresight::register_worlds();
        let figures = run::worlds().into_iter().flat_map(|world| world.figure_names());
        for key in figures.chain(CAUSES.map(str::to_owned)).filter(|key| key.contains('_')) {
            let found = shown
                .find(&key)
                .map(|at| shown[at.saturating_sub(80)..].chars().take(200).collect::<String>());
            assert_eq!(found, None, "{key}");
        }
    }

    /// Returns the charts with their captions.
    fn captioned(&self) -> Vec<(String, Value)> {
        let figures = self.html.split("<figure class=\"chart\">").skip(1);
        let captions = figures.map(|figure| {
            let caption = figure.split("<figcaption>").nth(1).unwrap();
            caption.split("</figcaption>").next().unwrap().to_owned()
        });
        captions.zip(self.charts()).collect()
    }

    /// Checks that no chart omits a point that its caption describes as drawn.
    fn check_drawn_charts(&self) {
        for (caption, chart) in self.captioned() {
            let Some((_, words)) = caption.split_once("Drawn: ") else { continue };
            check_points(words.split('.').next().unwrap(), &chart);
        }
    }

    /// Checks that no attribute or style refers to anything outside the page, and that the page instructs the
    /// browser to refuse external content.
    fn check_makes_no_request(&self) {
        assert!(self.html.contains(
            "http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; img-src data: blob:;"
        ));
        for opening in ["src=\"", "href=\"", "srcset=\"", "action=\"", "url(", "@import", "data-src=\""] {
            for (at, _) in self.html.match_indices(opening) {
                let value = &self.html[at + opening.len()..];
                assert!(value.starts_with("data:") || value.starts_with('#'), "{opening}{value:.80}");
            }
        }
        for (at, tag) in self.html.match_indices("<link").chain(self.html.match_indices("<iframe")) {
            assert!(self.html[at..].starts_with("<link rel=\"icon\" href=\"data:,\""), "{tag}");
        }
    }
}

/// Compares a caption such as "2500 of 9000 correct measurements and 3 of 3 wrong ones" with the points of
/// every panel, except rings.
fn check_points(words: &str, chart: &Value) {
    let told: usize = words
        .split(" and ")
        .map(|part| {
            let number = part.split(' ').next().unwrap();
            number.parse::<usize>().unwrap_or_else(|_| panic!("no number in `{words}`"))
        })
        .sum();
    let traces = chart["data"].as_array().unwrap();
    let axes: BTreeSet<_> = traces.iter().map(|trace| trace["yaxis"].as_str()).collect();
    for axis in axes {
        let is_point = |trace: &&Value| {
            trace["yaxis"].as_str() == axis
                && trace["mode"] == "markers"
                && trace["marker"]["symbol"] != "circle-open"
        };
        let drawn: usize =
            traces.iter().filter(is_point).map(|trace| trace["y"].as_array().unwrap().len()).sum();
        assert_eq!(drawn, told, "`{words}` on axis {axis:?}");
    }
}

#[test]
fn the_drawn_points_of_a_long_run_are_distributed_as_all_its_errors() {
    let bench = Bench::new();
    bench.boresight("run argon --frames 40..60 --out run --no-report").done();
    let mut run = FarRangeRun::read(&RunFiles::of_directory(&bench.path("run"))).unwrap();
    // Many copies of the frames, with errors that have a sharp peak and long tails: a few in each stretch are
    // far out.
    let (verdicts, truths) = (run.verdicts.clone(), run.truths.clone());
    let (outcomes, telemetry) = (run.outcomes.clone(), run.telemetry.clone());
    let right = verdicts.iter().position(|v| matches!(v.verdict, Verdict::Correct { .. })).unwrap();
    let law = |i: usize| {
        let uniform =
            ((i as u64).wrapping_mul(0x9e37_79b9_7f4a_7c15) >> 11) as f64 / (1_u64 << 53) as f64 - 0.5;
        0.4 * uniform * uniform * uniform
    };
    let count = 12_000;
    let pick = |i: usize| i * verdicts.len() / count;
    run.truths = (0..count).map(|i| truths[pick(i)].clone()).collect();
    run.outcomes = (0..count).map(|i| outcomes[pick(i)].clone()).collect();
    run.telemetry = (0..count).map(|i| telemetry[pick(i)].clone()).collect();
    run.verdicts = (0..count)
        .map(|i| {
            let mut verdict = verdicts[right].clone();
            if let Verdict::Correct { error } = &mut verdict.verdict {
                let error = error.line_of_sight.as_mut().unwrap();
                error.ra = Angle::from_degrees(law(i));
                error.dec = Angle::from_degrees(-law(i));
            }
            verdict
        })
        .collect();
    let page = far_range_page(&run, &FrameDetail::open(&RunFiles::of_directory(&bench.path("run"))).unwrap())
        .unwrap();
    let bytes = page.html().unwrap().len();
    assert!(bytes < MAX_BYTES, "{bytes} bytes");
    let section = page.sections.iter().find(|section| section.id == "errors").unwrap();
    let chart = section.blocks.iter().find_map(|block| match block {
        Block::Chart(chart) => Some(chart),
        _ => None,
    });
    let chart = chart.unwrap();
    let json: Value = serde_json::from_str(&chart.json()).unwrap();
    let (_, words) = chart.caption.split_once("Drawn: ").unwrap();
    assert!(words.starts_with("2500 of 12000 correct measurements."), "{words}");
    check_points(words.split('.').next().unwrap(), &json);
    let numbers = |trace: &Value| -> Vec<f64> {
        let mut y: Vec<f64> = trace["y"].as_array().unwrap().iter().map(|y| y.as_f64().unwrap()).collect();
        y.sort_by(f64::total_cmp);
        y
    };
    let traces = json["data"].as_array().unwrap();
    let drawn = numbers(traces.iter().find(|trace| trace["name"] == "correct").unwrap());
    let mut all: Vec<f64> = (0..count).map(law).collect();
    all.sort_by(f64::total_cmp);
    let below = |of: &[f64], level: f64| of.partition_point(|&value| value < level) as f64 / of.len() as f64;
    for level in [-0.03, -0.01, -0.001, 0.001, 0.01, 0.03] {
        let difference = below(&drawn, level) - below(&all, level);
        assert!(difference.abs() < 0.03, "{difference} at {level}");
    }
    // The extremes of all errors are shown, but not as points of the distribution.
    let rings = numbers(traces.iter().find(|trace| trace["marker"]["symbol"] == "circle-open").unwrap());
    assert!((rings[0] - all[0]).abs() < 1e-5 && (rings[rings.len() - 1] - all[count - 1]).abs() < 1e-5);
}

#[test]
fn the_page_of_a_far_range_run_has_its_figures_and_the_numbers_of_its_score() {
    let bench = Bench::new();
    bench.boresight("run argon --frames 40..60 --out run").done();
    let page = PageText::read(&bench, "run/report.html");
    page.check(&["verdict", "frames", "figures", "images", "track", "relative-position", "errors"]);
    page.check(&["stars", "mounting", "aberration", "causes", "left-out"]);
    assert!(page.html.contains("<dt>Error budget by stage</dt>"), "the budget is offered");
    assert!(page.html.contains("the superimposed images of an orbit") && page.html.contains("--budget all"));
    let km: Vec<f64> = bench.frames("run").iter().map(|truth| truth.range_km).collect();
    let (least, most) = (km.iter().copied().fold(f64::MAX, f64::min), km.iter().copied().fold(0.0, f64::max));
    assert!(page.html.contains(&format!("<dt>Range</dt><dd>{least:.2} to {most:.2} km</dd>")));
    let score = bench.json("run/score.json");
    assert_eq!(page.data()["score"], score);
    // Every kind of miss and of wrong result has a picture.
    for (kind, title) in [("misses", "Missed: "), ("wrong", "Wrong: ")] {
        for cause in score[kind].as_object().unwrap().keys() {
            let words = format!("<b>{title}{}", cause.replace('_', " ").replace("roi", "ROI"));
            assert!(page.html.contains(&words), "no picture of {kind}: {cause}");
        }
    }
    assert!(page.html.contains("<image href=\"data:image/png;base64,"));
    assert!(page.html.contains("class=\"truth\"") && page.html.contains("class=\"measured\""));
    // Published rates of day 1.
    assert!(page.html.contains("<td>94.92</td>"));
    // The relative orbit ends at the true position of the target.
    let orbit = page.charts().into_iter().find(|chart| chart.to_string().contains("cross-track")).unwrap();
    let last = |panel: usize, axis: &str| {
        orbit["data"][panel][axis].as_array().unwrap().last().unwrap().as_f64().unwrap()
    };
    let squares = [last(0, "x"), last(0, "y"), last(1, "y")].map(|km| km * km);
    let range_km = bench.frames("run").last().unwrap().range_km;
    // Written with a resolution of 0.1 m.
    assert!((squares.iter().sum::<f64>().sqrt() - range_km).abs() < 5e-4, "{squares:?}, {range_km}");
    // The chart of errors holds the errors of the detected frames, one per frame.
    let errors =
        page.charts().into_iter().find(|chart| chart.to_string().contains("across columns, °")).unwrap();
    let drawn: usize = ["correct", "wrong"]
        .iter()
        .map(|name| {
            let traces = errors["data"].as_array().unwrap();
            traces.iter().find(|trace| trace["name"] == *name).unwrap()["y"].as_array().unwrap().len()
        })
        .sum();
    assert_eq!(drawn as u64, score["figures"]["ra_within_1px"]["of"].as_u64().unwrap());
}

#[test]
fn a_report_is_the_same_bytes_from_the_same_directory_wherever_it_is_written() {
    let bench = Bench::new();
    bench.boresight("run argon --frames 300..306 --out run").done();
    let answer = bench.boresight("report run --out again.html --json").done().json();
    bench.check_same("run/report.html", "again.html");
    assert_eq!(answer["report"], "again.html");
    assert_eq!(answer["bytes"].as_u64().unwrap(), fs::metadata(bench.path("again.html")).unwrap().len());
    fs::rename(bench.path("run"), bench.path("moved")).unwrap();
    bench.boresight("report moved").done();
    bench.check_same("moved/report.html", "again.html");
    let names: BTreeSet<_> = bench.tree("moved").into_keys().collect();
    assert!(names.iter().all(|name| !name.to_string_lossy().contains("partial")), "{names:?}");
}

#[test]
fn no_report_writes_no_report() {
    let bench = Bench::new();
    bench.boresight("run starting-point --frames 0..3 --out run --no-report").done();
    assert!(!bench.path("run/report.html").exists());
}

#[test]
fn a_run_with_injected_truth_is_marked() {
    let bench = Bench::new();
    bench.boresight("run argon --frames 300..303 --inject roi --out run").done();
    let page = PageText::read(&bench, "run/report.html");
    page.check(&["figures"]);
    assert!(page.html.contains("The truth replaced roi"));
    assert!(page.html.contains("transmits whole images"));
}

#[test]
fn an_error_budget_has_a_line_for_every_stage_and_refuses_other_frames() {
    let bench = Bench::new();
    bench.boresight("run argon --frames 5000..5020 --out plain --no-report").done();
    for stage in ["roi", "attitude"] {
        bench
            .boresight(&format!("run argon --frames 5000..5020 --inject {stage} --out {stage} --no-report"))
            .done();
    }
    bench.boresight("report plain --budget roi --budget attitude").done();
    let page = PageText::read(&bench, "plain/report.html");
    page.check(&["budget"]);
    let chart = page.charts().into_iter().find(|chart| chart.to_string().contains("RMS error")).unwrap();
    assert_eq!(chart["data"][0]["x"], serde_json::json!(["none (unmodified run)", "attitude", "roi"]));
    let own = bench.json("attitude/score.json")["figures"]["ra_rms_deg"]["value"].as_f64().unwrap();
    assert!((chart["data"][0]["y"][1].as_f64().unwrap() - own).abs() < 1e-6);

    bench.boresight("report plain --budget plain").refused(&["plain/run.toml", "`inject` is missing"]);
    bench.boresight("report roi --budget attitude").refused(&["--budget", "without --inject"]);
    bench.boresight("run argon --frames 5000..5019 --inject attitude --out short --no-report").done();
    bench.boresight("report plain --budget short").refused(&["short/run.toml", "the frames differ"]);
    bench.boresight("run argon --seed 5 --frames 5000..5020 --inject attitude --out seed --no-report").done();
    bench.boresight("report plain --budget seed").refused(&["seed/run.toml", "`scenario`"]);
    bench.boresight("report plain --budget nowhere").refused(&["nowhere/run.toml"]);
    bench.boresight("run docking --frames 24000..24001 --out docking --no-report").done();
    bench.boresight("report plain --budget docking").refused(&["docking/run.toml", "`scenario.world`"]);
    bench.boresight("report docking --budget roi").refused(&["--budget", "runs of far_range", "docking"]);
}

#[test]
fn the_runs_of_an_error_budget_are_flown_once_and_kept() {
    let bench = Bench::new();
    bench.boresight("run argon --frames 5000..5020 --out run --no-report").done();
    bench.boresight("report run --budget all").done();
    let page = PageText::read(&bench, "run/report.html");
    page.check(&["budget"]);
    let chart = page.charts().into_iter().find(|chart| chart.to_string().contains("RMS error")).unwrap();
    let stages = ["centroids", "identities", "attitude", "roi", "aberration", "brightness"];
    let told = chart["data"][0]["x"].as_array().unwrap();
    assert_eq!(told[0], "none (unmodified run)");
    assert!(told[1..].iter().zip(stages).all(|(told, stage)| *told == stage), "{told:?}");
    let kept: BTreeSet<_> = bench.tree("run/budget").into_keys().collect();
    let files =
        stages.iter().flat_map(|stage| ["run.toml", "score.json"].map(|name| format!("{stage}/{name}")));
    assert_eq!(kept, files.map(Into::into).collect());
    // Identical to a manual run.
    bench.boresight("run argon --frames 5000..5020 --inject attitude --out attitude --no-report").done();
    bench.check_same("attitude/score.json", "run/budget/attitude/score.json");
    // Existing results are not run again, and are in every later report.
    fs::remove_dir_all(bench.path("run/budget/roi")).unwrap();
    bench.boresight("report run --budget all --out again.html").done();
    bench.check_same("run/report.html", "again.html");
    bench.boresight("report run --out later.html").done();
    bench.check_same("run/report.html", "later.html");

    bench.boresight("report run --budget all --budget attitude").refused(&["--budget", "only `all`"]);
    bench.boresight("report attitude --budget all").refused(&["--budget is all", "without --inject"]);
    bench.boresight("run docking --frames 24000..24001 --out docking --no-report").done();
    bench.boresight("report docking --budget all").refused(&["--budget", "runs of far_range", "docking"]);
}

#[test]
fn the_page_of_a_docking_run_has_its_figures_and_the_numbers_of_its_score() {
    let bench = Bench::new();
    bench.boresight("run docking --frames 15000..15060 --out run").done();
    let page = PageText::read(&bench, "run/report.html");
    page.check(&["verdict", "worst-fields", "figures", "motion", "motion-errors"]);
    page.check(&["field-errors", "verdicts", "fields"]);
    let score = bench.json("run/score.json");
    assert_eq!(page.data()["score"], score);
    assert!(page.html.contains("<b>Measured.</b>") && page.html.contains("cross, recognised"));
    let motion = bench.csv("run/motion.csv");
    let best = motion.iter().filter(|row| row["estimator"] == "best").count();
    let parameters = page.charts().into_iter().find(|chart| chart.to_string().contains("ρ, m")).unwrap();
    let rho = &parameters["data"].as_array().unwrap()[2];
    assert_eq!((rho["name"].as_str(), rho["y"].as_array().unwrap().len()), (Some("best estimate"), best));
}

#[test]
fn the_page_of_a_study_has_its_summary_and_the_commands_of_its_worst_cases() {
    let bench = Bench::new();
    bench.write("study.toml", STUDY);
    bench.boresight("study run study.toml --out out --shards 1").done();
    let page = PageText::read(&bench, "out/report.html");
    page.check(&["verdict", "worst", "figures", "sensitivities", "settings"]);
    assert!(page.html.contains("The figure is equal in all cases."), "the empty section has a reason");
    let summary = bench.json("out/summary.json");
    assert_eq!(page.data()["summary"], summary);
    let title = STUDY.lines().find_map(|line| line.strip_prefix("title = ")).unwrap().trim_matches('"');
    assert!(page.html.contains(&format!("<h1>{title}</h1>")), "no title {title}");
    bench.boresight("study replay study.toml --case 3 --out again").done();
    PageText::read(&bench, "again/report.html").check(&["track", "frames"]);
    bench.boresight("study replay study.toml --case 3 --out silent --no-report").done();
    assert!(!bench.path("silent/report.html").exists());
    assert!(page.html.contains(summary["worst"][0]["replay"].as_str().unwrap()));
    check_same_report(&bench, "out");

    for i in 1..=2 {
        bench.boresight(&format!("study run study.toml --out parts --shard {i}/2")).done();
        assert!(!bench.path("parts/report.html").exists(), "a shard is no study");
    }
    bench.boresight("study merge study.toml --out parts --no-report").done();
    assert!(!bench.path("parts/report.html").exists());
    bench.boresight("study merge study.toml --out parts").done();
    assert!(bench.path("parts/report.html").exists());
}

#[test]
fn the_page_of_requirements_has_table_curves_and_sky() {
    let bench = Bench::new();
    bench.boresight("visibility uasc-far-range --frames 0 --out out --report beside.html");
    let page = PageText::read(&bench, "out/report.html");
    page.check(&[
        "verdict",
        "requirements",
        "detection",
        "limiting-magnitude",
        "sky",
        "exposure-window",
        "target-range",
    ]);
    assert_eq!(page.data()["visibility"], bench.json("out/visibility.json"));
    bench.check_same("out/report.html", "beside.html");
    check_same_report(&bench, "out");
    // The map contains the numbers of the pointings that count, and no others.
    let map = page.charts().into_iter().find(|chart| chart["data"][0]["type"] == "heatmap").unwrap();
    let sky = bench.csv("out/sky.csv");
    let rounded = |stars: f64| (100.0 * stars).round() as i64;
    let counted: BTreeSet<i64> = sky
        .iter()
        .filter(|row| row["excluded"].is_empty())
        .map(|row| rounded(row["stars"].parse().unwrap()))
        .collect();
    let rows = map["data"][0]["z"].as_array().unwrap();
    let shown: Vec<f64> =
        rows.iter().flat_map(|row| row.as_array().unwrap()).filter_map(Value::as_f64).collect();
    assert!(shown.len() > 10_000 && shown.iter().all(|&stars| counted.contains(&rounded(stars))));
}

#[test]
fn the_page_of_a_gate_lists_the_flipped_units() {
    let bench = Bench::new();
    bench.boresight("run argon --frames 0..60 --out run --no-report").done();
    bench.boresight("gate baseline run --out base --reason first --block-length 6").done();
    bench.scenario("other.toml", "argon", |scenario| {
        let table = scenario.entry("far_range").or_insert(toml::Value::Table(toml::Table::new()));
        let identification: toml::Table = "radius_px = 0.3".parse().unwrap();
        table.as_table_mut().unwrap().insert("identification".into(), identification.into());
    });
    bench.boresight("run other.toml --frames 0..60 --out other --no-report").done();
    let report = bench.boresight("gate base other --report gate.html --json").json();
    let page = PageText::read(&bench, "gate.html");
    page.check(&["verdict", "effects", "flips"]);
    let rates = page.charts().into_iter().find(|chart| chart.to_string().contains("difference, points"));
    assert!(rates.unwrap().to_string().contains("correct rate"), "the rates are drawn, tolerated or not");
    assert_eq!(page.data()["figures"], report["figures"]);
    let flips = report["flips"]["units"].as_array().unwrap();
    assert!(!flips.is_empty(), "the test needs a frame that flips");
    assert!(page.html.contains("<figure class=\"picture\">") && page.html.contains(" → "));
    assert_eq!(page.html.matches("<figure class=\"picture\">").count(), flips.len().min(12));
}

/// A run has headings of its own subject; only a reproduction names the figures of its paper.
#[test]
fn only_a_reproduction_names_figures_of_a_paper() {
    let bench = Bench::new();
    bench.boresight("reproduce docking --frames 24000..24020 --out paper").done();
    bench.boresight("run docking --frames 24000..24020 --out run").done();
    let heading = |name: &str, text: &str| bench.read(&format!("{name}/report.html")).contains(text);
    assert!(heading("paper", "<h2>Fig. 6: Accuracy of the motion</h2>"));
    assert!(heading("run", "<h2>Accuracy of the motion</h2>"));
    bench.boresight("report paper --out again.html").done();
    bench.check_same("run/report.html", "again.html");
}

/// The verdict is computed from the score by the rules of docs/report.md.
#[test]
fn the_verdict_follows_the_score() {
    let bench = Bench::new();
    bench.boresight("run starting-point --frames 100..140 --out run").done();
    let score = bench.json("run/score.json");
    let html = bench.read("run/report.html");
    let finding = |subject: &str| {
        let item = html.split("<li class=").find(|item| item.contains(&format!("<b>{subject}</b>"))).unwrap();
        item[..item.find("</li>").unwrap()].to_owned()
    };
    let figure = |name: &str| score["figures"][name]["value"].as_f64();
    assert_eq!(figure("wrong_rate"), Some(0.0), "the test needs a run without wrong answers");
    assert!(finding("Wrong answers").starts_with("\"good\""), "{}", finding("Wrong answers"));
    assert!(finding("Wrong answers").contains("None of 40."));
    let nees = figure("centroid_nees_mean").expect("the best mode states covariances");
    let grade = if (0.8..=1.25).contains(&nees) { "\"good\"" } else { "\"fair\"" };
    assert!(finding("σ of the position in the image").starts_with(grade), "{nees}");
    // Nothing is good that was not measured.
    assert!(figure("false_alarm_rate").is_none());
    assert!(finding("False alarms").starts_with("\"unjudged\""));
}

#[test]
fn directories_that_are_no_results_are_refused_by_name() {
    let bench = Bench::new();
    bench.boresight("report nowhere").refused(&["nowhere", "expected a directory"]);
    bench.write("empty/notes.txt", "nothing");
    bench.boresight("report empty").refused(&["empty", "run.toml", "summary.json", "visibility.json"]);
    bench.boresight("render argon --frames 300..302 --out set").done();
    bench.boresight("report set").refused(&["set/measurements.csv", "is missing", "boresight process set"]);
    bench.boresight("run argon --frames 300..302 --out run --no-report").done();
    for (name, part) in [
        ("measurements.csv", "is missing"),
        ("truth/objects.parquet", "is missing"),
        ("telemetry.csv", "is missing"),
    ] {
        let kept = fs::read(bench.path("run").join(name)).unwrap();
        fs::remove_file(bench.path("run").join(name)).unwrap();
        bench.boresight("report run").refused(&[name, part]);
        assert!(!bench.path("run/report.html").exists());
        bench.write(&format!("run/{name}"), kept);
    }
    let score = bench.read("run/score.json");
    bench.write("run/score.json", &score[..score.len() / 2]);
    bench.boresight("report run --json").refused(&["run/score.json", "score"]);
    bench.write("run/score.json", score.replacen("\"frames\": 2", "\"frames\": 3", 1));
    bench.boresight("report run").refused(&["run/score.json", "`frames` is 3", "truth/frames.parquet"]);
    bench.write("run/score.json", &score);
    bench.boresight("report run --out empty/notes.txt/report.html").refused(&["empty/notes.txt"]);
    bench.boresight("report run").done();
}

/// The frames of the warm-up are in no figure over all frames; the report covers the whole run, even if all
/// of it is warm-up.
#[test]
fn a_run_with_a_warm_up_has_a_report() {
    let bench = Bench::new();
    for (built_in, frames, warm_up) in [("starting-point", 6, 4), ("starting-point", 2, 4), ("docking", 6, 4)]
    {
        let name = format!("{built_in}-{frames}");
        bench.scenario("mine.toml", built_in, |table| {
            table.insert("score".to_owned(), toml::toml! { warm_up_frames = 4 }.into());
        });
        bench.boresight(&format!("run mine.toml --frames 0..{frames} --out {name}")).done();
        let score = bench.json(&format!("{name}/score.json"));
        assert_eq!(score["frames"].as_u64(), Some(frames.max(warm_up) - warm_up));
        assert!(bench.read(&format!("{name}/report.html")).contains("warm-up"), "{name}");
        bench.boresight(&format!("report {name}")).done();
    }
}

#[test]
fn hostile_text_is_shown_and_not_run() {
    let hostile = "</script><script>alert(1)</script><img src=\"http://a.invalid/x\">";
    let bench = Bench::new();
    bench.scenario("hostile.toml", "argon", |scenario| {
        scenario.insert("title".into(), hostile.into());
        scenario["schedule"][0].as_table_mut().unwrap().insert("name".into(), hostile.into());
    });
    bench.boresight("run hostile.toml --frames 0..4 --out run").done();
    let page = PageText::read(&bench, "run/report.html");
    page.check(&["figures"]);
    assert!(!page.html.contains("<script>alert") && !page.html.contains("<img"), "markup of somebody else's");
    assert!(page.html.contains("alert(1)"), "the title is shown");
    assert_eq!(page.data()["score"], bench.json("run/score.json"));
}

/// Checks that the report written by the command that made a directory is the one that `report` writes for
/// it.
fn check_same_report(bench: &Bench, directory: &str) {
    bench.boresight(&format!("report {directory} --out once-more.html")).done();
    bench.check_same(&format!("{directory}/report.html"), "once-more.html");
}
