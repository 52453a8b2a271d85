//! The errors of the docking motion agree with the stated σ: a small part of the evaluation by
//! `docking_consistency` of the research programs.

use boresight_research::docking_consistency::approaches::{
    Estimator, Lens, MeasuredApproach, Plan, simulate,
};
use boresight_research::docking_consistency::tally::{GROUPS, Tally, errors};
use rayon::prelude::*;

/// Number of approaches with constant velocity, three portions each; `DOUBLED` of them are run again with
/// twice the noise, two portions each.
const APPROACHES: u64 = 24;
const DOUBLED: u64 = 8;

/// Index of ρ among the parameters.
const RANGE: usize = 12;

fn simulate_all(approaches: u64, portions: u64, noise_dn: f64) -> Vec<MeasuredApproach> {
    let plan = Plan::noise_only(1, portions, noise_dn);
    (0..approaches).into_par_iter().map(|number| simulate(&plan, number).unwrap()).collect()
}

#[test]
fn errors_agree_with_sigma_and_sigma_follows_noise_and_range() {
    let (once, twice) = (simulate_all(APPROACHES, 3, 2.0), simulate_all(DOUBLED, 2, 4.0));
    let tally = Tally::from_approaches(&once, Estimator::Exact);
    assert_eq!(tally.portions, 2 * APPROACHES as usize);
    // The standard error of the fields' mean, from the scatter between these approaches, is 0.026; the
    // tolerance is five times this.
    let of_field = tally.field_nees.unwrap().value;
    assert!((0.87..1.13).contains(&of_field), "{of_field}");
    // Required for 200 approaches: 0.7 to 1.3, with a standard error of the mean of 0.05. For 24 approaches
    // it is 0.14, and three times this is added.
    for (group, nees) in GROUPS.iter().zip(tally.nees) {
        let nees = nees.unwrap().value;
        assert!((0.7 - 0.42..1.3 + 0.42).contains(&nees), "{group}: {nees}");
    }
    // Required: at least 98.5 %. The standard error of the fraction for these approaches is 0.6 %, and three
    // times this is subtracted.
    let within = tally.within_all.unwrap().value;
    assert!(within >= 0.985 - 0.018, "{within}");

    let sigmas = |approach: &MeasuredApproach| errors(approach, Estimator::Exact)[0].sigmas;
    for parameter in 0..16 {
        let mut ratios: Vec<f64> =
            once.iter().zip(&twice).map(|(a, b)| sigmas(b)[parameter] / sigmas(a)[parameter]).collect();
        ratios.sort_by(f64::total_cmp);
        // Rounding to DN adds 1/12 DN²: √(16.08/4.08) = 1.985. Shifts of single patches and the assumed
        // acceleration, which are not noise, reduce the ratio by up to a sixth (1.68 to 1.95 were measured).
        let ratio = 0.5 * (ratios[3] + ratios[4]);
        assert!((1.6..2.1).contains(&ratio), "{parameter}: {ratio}");
    }
    for lens in Lens::ALL {
        let mut by_range: Vec<(f64, f64)> = once
            .iter()
            .filter(|approach| approach.lens == lens)
            .map(|approach| (approach.portions[1].truth.range_m(), sigmas(approach)[RANGE]))
            .collect();
        by_range.sort_by(|a, b| a.0.total_cmp(&b.0));
        let (near, far) = (by_range[0], by_range[by_range.len() - 1]);
        // σ of the range grows at least with the square of the range: from farther away, fewer pixels show
        // the same edges.
        let expected = (far.0 / near.0) * (far.0 / near.0);
        assert!(far.1 / near.1 > 0.7 * expected, "{}: {by_range:?}", lens.name);
    }
}
