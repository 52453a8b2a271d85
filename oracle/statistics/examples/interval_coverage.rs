//! Coverage of the 95 % intervals of rates and means over draws, on skewed and clustered distributions.
//!
//!     cargo run --release -p boresight-statistics --example interval_coverage             # made-up ones
//!     cargo run --release -p boresight-statistics --example interval_coverage -- FILE...  # of real cases
//!
//! FILE is a CSV file with a line `count,of` per case: the frames that count for a rate, of the frames of the
//! case. The cases of a file are a population: studies are drawn from it with replacement, and its rate is
//! the truth. `research/interval_coverage/run.py` makes such files from studies.
//!
//! For each distribution and number of draws a line has the percentage of intervals that hold the truth, of
//! those that lie below it and above it, and the mean width. `until` is a study that ends when the half
//! width is at most a fifth of the standard deviation of a draw, tested after 16 draws, 32, 48 and so on.

use draws::{Effect, Seed, Stream, normal, uniform};
use std::process::ExitCode;

use boresight_statistics::{ClusterSum, Interval, cluster_mean_interval, cluster_rate_interval};
use rand::Rng;

const STUDIES: u64 = 4000;
const DRAWS: [usize; 4] = [12, 20, 40, 100];
/// Frames of a draw.
const FRAMES: u32 = 25;
/// Draws of which the mean is the truth of a made-up distribution.
const DRAWS_OF_TRUTH: usize = 2_000_000;
/// Smallest number of draws that differ from the most frequent one, and number of draws between two tests.
const MIN_OTHER_VALUES: usize = 8;
const STEP: usize = 16;
const MAX_DRAWS: usize = 2000;

/// A distribution of draws: name, and function that draws the success probability, or the value, of one.
type Distribution = (&'static str, fn(&mut Stream) -> f64);

/// Distributions of the success probability of a draw.
const RATES: [Distribution; 14] = [
    ("beta 8, 2", |random| beta(random, 8, 2)),
    ("beta 40, 10", |random| beta(random, 40, 10)),
    ("uniform", uniform),
    ("perfect, 5 % of draws beta 2, 2", |random| mixture(random, 0.05, |_| 1.0)),
    ("perfect, 10 %", |random| mixture(random, 0.1, |_| 1.0)),
    ("perfect, 20 %", |random| mixture(random, 0.2, |_| 1.0)),
    ("perfect, 40 %", |random| mixture(random, 0.4, |_| 1.0)),
    ("beta 50, 1, 3 % of draws beta 2, 2", |random| mixture(random, 0.03, |random| beta(random, 50, 1))),
    ("beta 50, 1, 20 %", |random| mixture(random, 0.2, |random| beta(random, 50, 1))),
    ("failures log-normal, median 5 %, σ 1", |random| failing(random, 0.05, 1.0)),
    ("failures log-normal, median 1.8 %, σ 1.5", |random| failing(random, 0.018, 1.5)),
    ("failures log-normal, median 0.7 %, σ 2", |random| failing(random, 0.007, 2.0)),
    ("draws fail as a whole, 10 %", |random| f64::from(u8::from(uniform(random) < 0.9))),
    ("three levels: 1, 0.8, 0.1", |random| match uniform(random) {
        x if x < 0.6 => 1.0,
        x if x < 0.9 => 0.8,
        _ => 0.1,
    }),
];

/// Distributions of the value of a draw.
const MEANS: [Distribution; 6] = [
    ("normal", normal),
    ("half normal", |random| normal(random).abs()),
    ("exponential", |random| -libm::log(1.0 - uniform(random))),
    ("log-normal, σ 0.5", |random| libm::exp(0.5 * normal(random))),
    ("log-normal, σ 1", |random| libm::exp(normal(random))),
    ("a tenth ten times as large", |random| {
        (1.0 + 0.2 * normal(random)) * if uniform(random) < 0.1 { 10.0 } else { 1.0 }
    }),
];

fn main() -> ExitCode {
    let files: Vec<String> = std::env::args().skip(1).collect();
    println!("| draws from | number | held, % | below, above | width |\n| --- | --- | --- | --- | --- |");
    if files.is_empty() {
        made_up();
        return ExitCode::SUCCESS;
    }
    for file in &files {
        match cases(file) {
            Ok(cases) => of_cases(file, &cases),
            Err(message) => {
                eprintln!("{message}");
                return ExitCode::from(2);
            }
        }
    }
    ExitCode::SUCCESS
}

fn made_up() {
    for (name, draw) in RATES {
        let draw_sum = |random: &mut Stream| {
            let probability = draw(random);
            let hits = (0..FRAMES).filter(|_| uniform(random) < probability).count();
            ClusterSum { sum: hits as f64, count: f64::from(FRAMES) }
        };
        print_coverage(name, mean_of(draw), draw_sum, cluster_rate_interval);
    }
    for (name, draw) in MEANS {
        let draw_sum = |random: &mut Stream| ClusterSum { sum: draw(random), count: 1.0 };
        print_coverage(&format!("mean: {name}"), mean_of(draw), draw_sum, cluster_mean_interval);
    }
}

fn of_cases(file: &str, cases: &[ClusterSum]) {
    let (sum, of) = cases.iter().fold((0.0, 0.0), |(sum, of), case| (sum + case.sum, of + case.count));
    let pick = |random: &mut Stream| {
        let number = (u128::from(random.next_u64()) * cases.len() as u128) >> 64;
        cases.get(number as usize).copied().unwrap_or_default()
    };
    let name = file.rsplit('/').next().unwrap_or(file);
    print_coverage(&format!("{name}, rate {:.4}", sum / of), sum / of, pick, cluster_rate_interval);
}

/// Reads the cases of a CSV file with the columns `count` and `of`.
fn cases(file: &str) -> Result<Vec<ClusterSum>, String> {
    let text = std::fs::read_to_string(file).map_err(|error| format!("{file}: {error}"))?;
    let mut cases = Vec::new();
    for (line, text) in text.lines().enumerate().skip(1) {
        let number = |column: usize| text.split(',').nth(column)?.trim().parse::<f64>().ok();
        match (number(0), number(1)) {
            (Some(sum), Some(count)) if count > 0.0 && (0.0..=count).contains(&sum) => {
                cases.push(ClusterSum { sum, count });
            }
            _ => return Err(format!("{file}, line {}: expected `count,of`, found `{text}`", line + 1)),
        }
    }
    if cases.is_empty() { Err(format!("{file}: no case, expected `count,of` per line")) } else { Ok(cases) }
}

/// Prints the coverage for each number of draws, and after a stop.
fn print_coverage(
    name: &str,
    truth: f64,
    draw: impl Fn(&mut Stream) -> ClusterSum,
    interval: fn(&[ClusterSum]) -> Option<Interval>,
) {
    let study = |number| Seed { seed: 40, case: number }.stream(0, Effect::StudyParameter, 0);
    for draws in DRAWS {
        let held = (0..STUDIES).filter_map(|number| {
            let random = &mut study(number);
            interval(&(0..draws).map(|_| draw(random)).collect::<Vec<_>>())
        });
        print_line(name, &draws.to_string(), truth, held);
    }
    let half_width = 0.2 * spread(&draw);
    let mut total = 0_usize;
    let stopped: Vec<Interval> = (0..STUDIES / 4)
        .filter_map(|number| {
            let (draws, interval) = stopped(&mut study(number), half_width, &draw, interval)?;
            total += draws;
            Some(interval)
        })
        .collect();
    if let Some(mean) = total.checked_div(stopped.len()) {
        print_line(name, &format!("until, {mean} on average"), truth, stopped.into_iter());
    }
}

/// Standard deviation of the ratio of a draw.
fn spread(draw: &impl Fn(&mut Stream) -> ClusterSum) -> f64 {
    let random = &mut Seed { seed: 41, case: 0 }.stream(0, Effect::StudyParameter, 0);
    let values: Vec<f64> = (0..20_000).map(|_| draw(random)).map(|draw| draw.sum / draw.count).collect();
    let mean = values.iter().sum::<f64>() / values.len() as f64;
    (values.iter().map(|value| (value - mean) * (value - mean)).sum::<f64>() / values.len() as f64).sqrt()
}

/// Number of draws and interval of a study that ends when its interval is narrow enough; `None` if it does
/// not.
fn stopped(
    random: &mut Stream,
    half_width: f64,
    draw: &impl Fn(&mut Stream) -> ClusterSum,
    interval: fn(&[ClusterSum]) -> Option<Interval>,
) -> Option<(usize, Interval)> {
    let mut draws = Vec::new();
    while draws.len() < MAX_DRAWS {
        draws.extend((0..STEP.max(draws.len() / 16)).map(|_| draw(random)));
        let found = interval(&draws)?;
        let is_narrow = found.high - found.low <= 2.0 * half_width;
        if is_narrow && other_values(&draws) >= MIN_OTHER_VALUES {
            return Some((draws.len(), found));
        }
    }
    None
}

/// Number of draws with a value other than the most frequent one.
fn other_values(draws: &[ClusterSum]) -> usize {
    let mut values: Vec<f64> = draws.iter().map(|draw| draw.sum / draw.count).collect();
    values.sort_by(f64::total_cmp);
    draws.len() - values.chunk_by(|a, b| a == b).map(<[f64]>::len).max().unwrap_or_default()
}

fn print_line(name: &str, draws: &str, truth: f64, intervals: impl Iterator<Item = Interval>) {
    let (mut count, mut below, mut above, mut width) = (0.0, 0.0, 0.0, 0.0);
    for interval in intervals {
        count += 1.0;
        width += interval.high - interval.low;
        below += f64::from(u8::from(interval.high < truth));
        above += f64::from(u8::from(interval.low > truth));
    }
    let percent = |number: f64| 100.0 * number / count;
    println!(
        "| {name} | {draws} | {:.1} | {:.1}, {:.1} | {:.3} |",
        percent(count - below - above),
        percent(below),
        percent(above),
        width / count
    );
}

fn mean_of(draw: fn(&mut Stream) -> f64) -> f64 {
    let random = &mut Seed { seed: 42, case: 0 }.stream(0, Effect::StudyParameter, 0);
    (0..DRAWS_OF_TRUTH).map(|_| draw(random)).sum::<f64>() / DRAWS_OF_TRUTH as f64
}

/// Draws `good`, or with the given probability a bad success probability.
fn mixture(random: &mut Stream, share: f64, good: fn(&mut Stream) -> f64) -> f64 {
    if uniform(random) < share { beta(random, 2, 2) } else { good(random) }
}

/// Draws a success probability whose complement is log-normal, cut off at 1.
fn failing(random: &mut Stream, median: f64, sigma: f64) -> f64 {
    1.0 - (median * libm::exp(sigma * normal(random))).min(1.0)
}

/// Draws from the beta distribution of two integers, as a ratio of sums of exponential draws.
fn beta(random: &mut Stream, a: u32, b: u32) -> f64 {
    let mut sum = |count: u32| (0..count).map(|_| -libm::log(1.0 - uniform(random))).sum::<f64>();
    let (a, b) = (sum(a), sum(b));
    a / (a + b)
}
