//! Time and memory of merging a million cases.

use std::fs;
use std::time::Instant;

use boresight::pipeline_choice::PipelineChoice;
use boresight::run::figure_by_name;
use boresight::study::{Campaign, CaseFigure, CaseRow, CaseTable, DrawnValue, Study};
use draws::{Effect, Seed, normal, uniform};

const STUDY: &str = r#"
title = "Scale"
scenario = "argon"
seed = 1
frames = "2000..2001"

[stop]
cases = CASES

[[vary]]
path = "psf.sigma_px"
distribution = { kind = "uniform", min = 0.6, max = 1.0 }

[[vary]]
path = "sensor.read_noise_e"
distribution = { kind = "uniform", min = 5.0, max = 45.0 }
"#;

/// Returns an artificial case of ten frames.
fn row(table: &CaseTable, case: u64) -> CaseRow {
    let mut random = Seed { seed: 3, case }.stream(0, Effect::StudyParameter, 0);
    let drawn = [0.6 + 0.4 * uniform(&mut random), 5.0 + 40.0 * uniform(&mut random)];
    let mut figure = |name: &String| {
        if figure_by_name(name).is_rate() {
            let count = (0..10).filter(|_| uniform(&mut random) < 0.9 - 0.2 * drawn[0]).count() as u64;
            CaseFigure { value: Some(count as f64 / 10.0), count, of: 10 }
        } else {
            CaseFigure { value: Some(drawn[1] + normal(&mut random)), count: 10, of: 10 }
        }
    };
    let figures = table.figures.iter().map(&mut figure).collect();
    let causes =
        (0..table.causes.len()).map(|place| u32::from(case.is_multiple_of(7 + place as u64))).collect();
    CaseRow {
        case,
        seed: Seed { seed: 1, case }.streams(0, Effect::CaseSeed).word(0) >> 1,
        has_failed: false,
        error: None,
        frames: 10,
        drawn: drawn.map(DrawnValue::Number).to_vec(),
        figures,
        causes,
    }
}

/// Returns the peak resident memory since the last call of [`forget_peak`], MB (10⁶ bytes); Linux.
fn peak_mb() -> f64 {
    let status = fs::read_to_string("/proc/self/status").unwrap();
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:")).unwrap();
    line.trim().trim_end_matches(" kB").parse::<f64>().unwrap() * 1024.0 / 1e6
}

fn forget_peak() {
    fs::write("/proc/self/clear_refs", "5").unwrap();
}

/// `cargo test --release --test it study_scale:: -- --ignored --nocapture`; `SCALE_CASES`
/// sets another number of cases.
#[test]
#[ignore = "minutes"]
fn a_merge_of_many_cases_keeps_little_of_each() {
    let cases: u64 = std::env::var("SCALE_CASES").map_or(1_000_000, |text| text.parse().unwrap());
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("scale.toml");
    fs::write(&path, STUDY.replace("CASES", &cases.to_string())).unwrap();
    boresight::register_worlds();
    let study = Study::read(&path).unwrap();
    let choice = PipelineChoice { word: None, timeout_s: 10.0, memory_mb: 4000, sandbox: None };
    let campaign = Campaign::open(&study, &choice, &folder.path().join("out"), None).unwrap();
    let empty = study.table();
    let started = Instant::now();
    for shard in 1..=campaign.store().plan().shards {
        let rows = campaign.store().plan().cases_of(shard).map(|case| row(&empty, case)).collect();
        campaign.store().write(shard, &empty.with_rows(rows)).unwrap();
    }
    println!("{cases} cases written in {:.1} s", started.elapsed().as_secs_f64());
    forget_peak();
    let before_mb = peak_mb();
    let started = Instant::now();
    let table = campaign.merge().unwrap();
    println!("  gathered after {:.1} s, peak {:.0} MB", started.elapsed().as_secs_f64(), peak_mb());
    let summary = campaign.finish(&path, &table).unwrap();
    println!(
        "merged in {:.1} s, peak {:.0} MB, {before_mb:.0} MB before",
        started.elapsed().as_secs_f64(),
        peak_mb()
    );
    assert_eq!(summary.cases, cases);
}
