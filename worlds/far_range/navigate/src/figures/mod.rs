//! Figures of a navigation, as studies and gates use them.

pub(crate) mod after_run;

use contract::navigation::Event;
use files::Failure;
use hifitime::Epoch;
use navigation::{BatchConfig, Bound};
use run::NavigationFigure;
use score::{FigureTerms, Reduction, Term};

use crate::campaign::Campaign;
use crate::result::NavigationResult;
use crate::row::NavigationRow;

fn rate(name: &'static str, count: u64, of: u64) -> NavigationFigure {
    NavigationFigure { name, value: (of > 0).then(|| count as f64 / of as f64), count, of }
}

fn mean(name: &'static str, values: &[f64]) -> NavigationFigure {
    let of = values.len() as u64;
    let value = (of > 0).then(|| values.iter().sum::<f64>() / of as f64);
    NavigationFigure { name, value, count: 0, of }
}

/// Computes the figures of a navigation, with the bound of the campaign at the times of its estimates.
///
/// # Errors
/// [`Failure::Contract`] for a campaign without a usable measurement.
pub fn navigation_figures(
    campaign: &Campaign,
    result: &NavigationResult,
) -> Result<Vec<NavigationFigure>, Failure> {
    let rows: Vec<(&NavigationRow, [f64; 3], [f64; 3])> = result
        .rows
        .iter()
        .filter_map(|row| Some((row, row.position_error_m?, row.position_sigma_m?)))
        .collect();
    let estimates = rows.len() as u64;
    let squares = |axis: usize| -> Vec<f64> {
        rows.iter().filter_map(|(_, error, _)| error.get(axis).map(|error| error * error)).collect()
    };
    let rms = |name: &'static str, squares: &[f64]| {
        let mean = mean(name, squares);
        NavigationFigure { value: mean.value.map(f64::sqrt), ..mean }
    };
    let axes = rows.iter().flat_map(|(_, error, sigma)| error.iter().zip(sigma));
    let within = axes.filter(|(error, sigma)| error.abs() <= 3.0 * **sigma).count() as u64;
    let nees = |of: fn(&NavigationRow) -> Option<f64>, dimensions: f64| -> Vec<f64> {
        rows.iter().filter_map(|(row, _, _)| Some(of(row)? / dimensions)).collect()
    };
    let range: Vec<f64> = rows
        .iter()
        .filter_map(|(row, _, _)| {
            let relative = row.range_error_m()? / row.true_range_m();
            Some(1e4 * relative * relative)
        })
        .collect();
    let convergence_s: Vec<f64> = result.score.convergence_s.into_iter().collect();
    let over_bound = squares_over_bound(campaign, &rows)?;
    Ok(vec![
        rate("navigation_estimate_rate", estimates, result.rows.len() as u64),
        rms("navigation_r_rms_m", &squares(0)),
        rms("navigation_t_rms_m", &squares(1)),
        rms("navigation_n_rms_m", &squares(2)),
        rate("navigation_within_3_sigma", within, 3 * estimates),
        mean("navigation_position_nees_mean", &nees(|row| row.nees_position, 3.0)),
        mean("navigation_state_nees_mean", &nees(|row| row.nees_state, 6.0)),
        rms("navigation_range_rms_percent", &range),
        mean("navigation_convergence_s", &convergence_s),
        mean("navigation_r_square_over_bound", &over_bound[0]),
        mean("navigation_t_square_over_bound", &over_bound[1]),
        mean("navigation_n_square_over_bound", &over_bound[2]),
    ])
}

/// Contributions of the estimates of a run to the figures, one term per frame: each estimate counts for the
/// frame nearest in time, the first one if there are several. Convergence and bound are not figures of single
/// times.
pub fn navigation_terms(rows: &[NavigationRow], frames: &[Epoch]) -> Vec<FigureTerms> {
    let mut of_frames: Vec<Option<&NavigationRow>> = vec![None; frames.len()];
    for row in rows {
        let Some(place) = row.time().and_then(|time| nearest(frames, time)) else { continue };
        if let Some(taken) = of_frames.get_mut(place) {
            taken.get_or_insert(row);
        }
    }
    let terms = |name: &str, reduction: Reduction, values: &dyn Fn(&NavigationRow) -> Option<(f64, u32)>| {
        let term = |row: &Option<&NavigationRow>| {
            let found = row.and_then(values);
            found.map_or(Term::default(), |(sum, count)| Term { sum, count })
        };
        FigureTerms::from_terms(name, reduction, of_frames.iter().map(term).collect())
    };
    let error =
        |axis: usize| move |row: &NavigationRow| Some((*row.position_error_m.as_ref()?.get(axis)?, 1));
    let within = |row: &NavigationRow| {
        let pairs = row.position_error_m?.into_iter().zip(row.position_sigma_m?);
        Some((pairs.filter(|(error, sigma)| error.abs() <= 3.0 * sigma).count() as f64, 3))
    };
    let range = |row: &NavigationRow| Some((100.0 * row.range_error_m()? / row.true_range_m(), 1));
    vec![
        terms("navigation_estimate_rate", Reduction::Rate, &|row| {
            Some((f64::from(u8::from(row.position_error_m.is_some())), 1))
        }),
        terms("navigation_r_rms_m", Reduction::Rms, &error(0)),
        terms("navigation_t_rms_m", Reduction::Rms, &error(1)),
        terms("navigation_n_rms_m", Reduction::Rms, &error(2)),
        terms("navigation_within_3_sigma", Reduction::Rate, &within),
        terms("navigation_position_nees_mean", Reduction::Mean, &|row| Some((row.nees_position? / 3.0, 1))),
        terms("navigation_state_nees_mean", Reduction::Mean, &|row| Some((row.nees_state? / 6.0, 1))),
        terms("navigation_range_rms_percent", Reduction::Rms, &range),
    ]
}

/// Returns the index of the time nearest to `time` in ascending times.
fn nearest(times: &[Epoch], time: Epoch) -> Option<usize> {
    let after = times.partition_point(|other| *other < time);
    let distance = |place: &usize| times.get(*place).map(|other| (*other - time).abs());
    [after.saturating_sub(1), after].into_iter().filter(|place| *place < times.len()).min_by_key(distance)
}

/// Returns the squared errors along R, T, N over the variances of the batch's bound at the same times.
fn squares_over_bound(
    campaign: &Campaign,
    rows: &[(&NavigationRow, [f64; 3], [f64; 3])],
) -> Result<[Vec<f64>; 3], Failure> {
    let config = BatchConfig { osculation: campaign.truth.osculation(), ..BatchConfig::default() };
    let events: Vec<Event> = campaign.arrivals.iter().map(|arrival| arrival.event).collect();
    let elements = campaign.truth.elements(campaign.epoch())?;
    let bound = Bound::new(&campaign.setup, &config, &events, &elements)?;
    let timed: Vec<_> = rows.iter().filter_map(|(row, error, _)| Some((row.time()?, *error))).collect();
    let epochs: Vec<_> = timed.iter().map(|(time, _)| *time).collect();
    let mut ratios = [const { Vec::new() }; 3];
    for ((_, error), answer) in timed.iter().zip(bound.of_batch(&epochs)) {
        let Ok(estimate) = answer else { continue };
        let variances = estimate.covariance.matrix().diagonal();
        for ((ratios, error), variance) in ratios.iter_mut().zip(error).zip(&variances) {
            ratios.push(error * error / variance);
        }
    }
    Ok(ratios)
}

#[cfg(test)]
mod tests {
    use super::*;
    use hifitime::Unit;

    fn row(minute: f64, error: Option<[f64; 3]>) -> NavigationRow {
        NavigationRow {
            time_utc: files::format_utc(start() + Unit::Minute * minute),
            status: if error.is_some() { "estimated" } else { "no_initial_orbit" }.to_owned(),
            true_position_m: [0.0, -1000.0, 0.0],
            position_error_m: error,
            position_sigma_m: error.map(|_| [1.0, 10.0, 1.0]),
            velocity_error_m_s: None,
            velocity_sigma_m_s: None,
            state_correlations: None,
            true_elements_m: [0.0; 6],
            elements_error_m: None,
            elements_sigma_m: None,
            nees_state: None,
            nees_position: error.map(|_| 1.5),
            nees_elements: None,
        }
    }

    fn start() -> Epoch {
        Epoch::from_gregorian_utc_at_midnight(2012, 4, 26)
    }

    /// Frames every minute; estimates at 0, 1.2, 1.4 and 9 minutes count for the frames 0, 1 and 3.
    #[test]
    fn an_estimate_counts_for_the_frame_nearest_in_time() {
        let frames: Vec<Epoch> = (0..4).map(|k| start() + Unit::Minute * f64::from(k)).collect();
        let rows = [
            row(0.0, None),
            row(1.2, Some([2.0, -10.0, 4.0])),
            row(1.4, Some([9.0, 9.0, 9.0])),
            row(9.0, Some([0.5, 20.0, 0.0])),
        ];
        let figures = navigation_terms(&rows, &frames);
        let of = |name: &str| figures.iter().find(|figure| figure.name == name).unwrap().terms.clone();
        let term = |sum: f64, count: u32| Term { sum, count };
        let none = Term::default();
        assert_eq!(of("navigation_estimate_rate"), [term(0.0, 1), term(1.0, 1), none, term(1.0, 1)]);
        assert_eq!(of("navigation_r_rms_m"), [none, term(2.0, 1), none, term(0.5, 1)]);
        assert_eq!(of("navigation_within_3_sigma"), [none, term(2.0, 3), none, term(3.0, 3)]);
        assert_eq!(of("navigation_position_nees_mean"), [none, term(0.5, 1), none, term(0.5, 1)]);
        // 20 m nearer of 1000 m.
        assert!((of("navigation_range_rms_percent")[3].sum + 2.0).abs() < 1e-3);
        // Every figure is declared.
        let declared: Vec<String> = score::navigation_figures().into_iter().map(|f| f.name).collect();
        assert!(figures.iter().all(|figure| declared.contains(&figure.name)));
    }
}
