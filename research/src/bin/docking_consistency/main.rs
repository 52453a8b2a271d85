//! Compares the errors of the docking pipeline with its standard deviations.
//!
//!     cargo run --release -p boresight-research --bin docking_consistency -- [--approaches 200] [--portions
//!     6] [--seed 1] [--only steady]
//!
//! Seeded approaches are drawn and measured field by field by the built-in pipeline: constant velocity with
//! noise only, constant velocity with every artefact, and swinging approaches. For the portions from the
//! second on, the program prints the share of errors within 3σ by parameter, the mean normalised estimation
//! error squared (NEES) over its dimension, σ against range (Fig. 6 of the docking paper), the effect of
//! doubled noise on σ, and the time between reports.

use std::error::Error;

use rayon::prelude::*;
use sim::television::TelevisionConfig;

use boresight_research::docking_consistency::approaches::{
    Course, Estimator, Lens, MeasuredApproach, Plan, simulate,
};
use boresight_research::docking_consistency::tally::{self, GROUPS, Mean, NAMES, Tally};

/// Video noise, DN.
const NOISE_DN: f64 = 2.0;
/// Number of approaches repeated with twice the noise.
const DOUBLED: u64 = 40;
/// Limits of the range bins in the table of σ, m.
const RANGES_M: [f64; 8] = [0.0, 1.5, 2.5, 4.0, 6.0, 10.0, 16.0, 30.0];

struct Arguments {
    approaches: u64,
    portions: u64,
    seed: u64,
    only: Option<String>,
}

fn arguments() -> Result<Arguments, Box<dyn Error + Send + Sync>> {
    let mut words = std::env::args().skip(1);
    let mut arguments = Arguments { approaches: 200, portions: 6, seed: 1, only: None };
    while let Some(option) = words.next() {
        let value = words.next().ok_or_else(|| format!("{option} has no value"))?;
        match option.as_str() {
            "--approaches" => arguments.approaches = value.parse()?,
            "--portions" => arguments.portions = value.parse::<u64>()?.max(2),
            "--seed" => arguments.seed = value.parse()?,
            "--only" => arguments.only = Some(value),
            _ => return Err(format!("{option} is not an option").into()),
        }
    }
    Ok(arguments)
}

fn simulate_approaches(
    plan: &Plan,
    approaches: u64,
) -> Result<Vec<MeasuredApproach>, Box<dyn Error + Send + Sync>> {
    (0..approaches).into_par_iter().map(|number| simulate(plan, number)).collect()
}

fn main() -> Result<(), Box<dyn Error + Send + Sync>> {
    let arguments = arguments()?;
    let is_asked = |name: &str| arguments.only.as_ref().is_none_or(|only| only == name);
    let plan = Plan::noise_only(arguments.seed, arguments.portions, NOISE_DN);
    if is_asked("steady") {
        let approaches = simulate_approaches(&plan, arguments.approaches)?;
        consistency("Constant velocity", &approaches);
        println!("longest time between reports: {:.2} s\n", tally::longest_interval_s(&approaches));
        sigma_by_range(&approaches);
    }
    if is_asked("doubled") {
        doubled_noise(&arguments)?;
    }
    if is_asked("swinging") {
        let plan = Plan { course: Course::Swinging, ..plan.clone() };
        consistency("Swinging", &simulate_approaches(&plan, arguments.approaches)?);
    }
    if is_asked("artefacts") {
        let plan = Plan { television: TelevisionConfig::all(), ..plan };
        consistency("Constant velocity, every artefact", &simulate_approaches(&plan, arguments.approaches)?);
    }
    Ok(())
}

/// Prints the shares within 3σ and the NEES of both estimators.
fn consistency(title: &str, approaches: &[MeasuredApproach]) {
    let fields: usize = approaches.iter().map(|approaches| approaches.fields.len()).sum();
    println!("{title}: {} approaches, {fields} fields measured", approaches.len());
    let tallies =
        [Estimator::Exact, Estimator::Paper].map(|estimator| Tally::from_approaches(approaches, estimator));
    println!("{:<20} {:>16} {:>16}", "", "exact geometry", "paper");
    println!("{:<20} {:>16} {:>16}", "portions judged", tallies[0].portions, tallies[1].portions);
    let line = |name: &str, scale: f64, of: &dyn Fn(&Tally) -> Option<Mean>| {
        let [exact, paper] = tallies.each_ref().map(|tally| cell(of(tally), scale));
        println!("{name:<20} {exact:>16} {paper:>16}");
    };
    for (i, name) in NAMES.iter().enumerate() {
        line(&format!("within 3σ, {name} %"), 100.0, &|tally| tally.within[i]);
    }
    line("within 3σ, all %", 100.0, &|tally| tally.within_all);
    for (i, name) in GROUPS.iter().enumerate() {
        line(&format!("NEES/6, {name}"), 1.0, &|tally| tally.nees[i]);
    }
    println!("{:<20} {:>16}", "NEES/6, one field", cell(tallies[0].field_nees, 1.0));
    for lens in Lens::ALL {
        let of_lens: Vec<MeasuredApproach> =
            approaches.iter().filter(|approaches| approaches.lens == lens).cloned().collect();
        let tally = Tally::from_approaches(&of_lens, Estimator::Exact);
        let [position, attitude, joint] = tally.nees.map(|nees| cell(nees, 1.0));
        println!(
            "{:<8} exact NEES/6: {position}, {attitude}, {joint}; of a field {}",
            lens.name,
            cell(tally.field_nees, 1.0)
        );
    }
    println!();
}

fn cell(mean: Option<Mean>, scale: f64) -> String {
    mean.map_or_else(|| "-".to_owned(), |m| format!("{:.2} ± {:.2}", scale * m.value, scale * m.error))
}

/// Prints the medians of σ of ρ, u, α, β in bins of range.
fn sigma_by_range(approaches: &[MeasuredApproach]) {
    println!("σ by range, medians, exact geometry (paper)");
    println!(
        "{:<7} {:>11} {:>6} {:>18} {:>18} {:>20} {:>20}",
        "lens", "range m", "n", "ρ mm", "u mm/s", "α °", "β °"
    );
    for lens in Lens::ALL {
        for bin in RANGES_M.windows(2) {
            let sigmas = |estimator: Estimator| -> Vec<[f64; 16]> {
                let portions = approaches
                    .iter()
                    .filter(|approaches| approaches.lens == lens)
                    .flat_map(|approaches| &approaches.portions);
                portions
                    .filter(|portion| {
                        portion.number > 0 && (bin[0]..bin[1]).contains(&portion.truth.range_m())
                    })
                    .filter_map(|portion| {
                        tally::Errors::from_motion(portion.motion(estimator)?, &portion.truth)
                    })
                    .map(|errors| errors.sigmas)
                    .collect()
            };
            let (exact, paper) = (sigmas(Estimator::Exact), sigmas(Estimator::Paper));
            if exact.is_empty() {
                continue;
            }
            let pair = |i: usize, scale: f64, digits: usize| {
                let [exact, paper] =
                    [&exact, &paper].map(|all| scale * median(all.iter().map(|s| s[i]).collect()));
                format!("{exact:.digits$} ({paper:.digits$})")
            };
            let degrees = 1f64.to_degrees();
            println!(
                "{:<7} {:>4.1} – {:>4.1} {:>6} {:>18} {:>18} {:>20} {:>20}",
                lens.name,
                bin[0],
                bin[1],
                exact.len(),
                pair(12, 1e3, 3),
                pair(13, 1e3, 2),
                pair(14, degrees, 4),
                pair(15, degrees, 4)
            );
        }
    }
    println!();
}

fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    values.get(values.len() / 2).copied().unwrap_or(f64::NAN)
}

/// Prints the ratio of σ with twice the noise to σ, for identical approaches.
fn doubled_noise(arguments: &Arguments) -> Result<(), Box<dyn Error + Send + Sync>> {
    let simulate = |noise_dn: f64| {
        simulate_approaches(&Plan::noise_only(arguments.seed, 2, noise_dn), arguments.approaches.min(DOUBLED))
    };
    let (once, twice) = (simulate(NOISE_DN)?, simulate(2.0 * NOISE_DN)?);
    println!(
        "σ at {} DN over σ at {} DN, second portion, medians of {} approaches",
        2.0 * NOISE_DN,
        NOISE_DN,
        once.len()
    );
    for (name, estimator) in [("exact geometry", Estimator::Exact), ("paper", Estimator::Paper)] {
        let ratios: Vec<[f64; 16]> = once
            .iter()
            .zip(&twice)
            .flat_map(|(once, twice)| {
                tally::errors(once, estimator).into_iter().zip(tally::errors(twice, estimator))
            })
            .map(|(once, twice)| std::array::from_fn(|i| twice.sigmas[i] / once.sigmas[i]))
            .collect();
        let shown: Vec<String> = NAMES
            .iter()
            .enumerate()
            .map(|(i, name)| format!("{name} {:.2}", median(ratios.iter().map(|r| r[i]).collect())))
            .collect();
        println!("{name}: {}", shown.join(", "));
    }
    println!();
    Ok(())
}
