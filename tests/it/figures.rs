//! Figures of the worlds: their words, units and directions.

use boresight::docking::scoring as docking;
use boresight::far_range::scoring as far_range;
use boresight::score::{Better, FigureSpec, FigureTerms, Reduction, is_of_navigation};

/// Figures of all worlds.
fn all() -> Vec<FigureSpec> {
    far_range::figures().into_iter().chain(docking::figures()).collect()
}

#[test]
fn figures_are_read_with_their_units_and_have_a_direction() {
    let is = |name: &str, label: &str, better| {
        let figure = all().into_iter().find(|figure| figure.name == name).unwrap();
        assert_eq!((figure.to_string().as_str(), figure.sense.better), (label, better), "{name}");
    };
    is("ra_rms_deg", "RMS across columns, °", Better::Less);
    is("ra_mean_deg", "mean across columns, °", Better::Near(0.0));
    is("dec_within_1px", "within 1 px across rows, %", Better::More);
    is("correct_rate", "correct rate, %", Better::More);
    is("wrong_rate", "wrong rate, %", Better::Less);
    is("motion_range_rate_rms_m_s", "motion range rate RMS, m/s", Better::Less);
    is("phi3_within_3_sigma", "φ3 within 3 σ, %", Better::Near(0.9973));
    is("motion_position_nees_mean", "motion position NEES mean", Better::Near(1.0));
    is("paper_success_rate", "paper success rate, %", Better::More);
    is("latency_fields", "latency fields", Better::Less);
    is("stars_mean", "stars mean", Better::More);
}

/// The declared kind and unit agree with those that the key implies.
#[test]
fn every_figure_has_a_label_and_the_unit_of_its_key() {
    const UNITS: [(&str, &str); 5] =
        [("_m_s", "m/s"), ("_deg", "°"), ("_percent", "%"), ("_m", "m"), ("_px", "px")];
    for figure in all() {
        let name = &figure.name;
        assert!(!figure.to_string().contains('_'), "{figure}");
        let is_rate = name.ends_with("_rate") || name.contains("within_");
        assert_eq!(figure.is_rate(), is_rate, "{name}");
        let unit = UNITS.iter().find(|(ending, _)| name.ends_with(ending)).map(|(_, unit)| *unit);
        assert_eq!(figure.unit, unit.or(is_rate.then_some("%")), "{name}");
        // A bias is the only amount that is best at 0.
        let is_bias = name.contains("_mean_") || name.contains("_median_");
        assert_eq!(figure.sense.better == Better::Near(0.0), is_bias, "{name}");
    }
}

/// A file names a figure by its key only, without its world.
#[test]
fn a_key_is_the_same_figure_in_both_worlds() {
    for figure in far_range::figures() {
        for other in docking::figures().iter().filter(|other| other.name == figure.name) {
            assert_eq!(*other, figure);
        }
    }
}

#[test]
fn figures_of_lines_of_sight_alone_rest_on_an_attitude() {
    for figure in far_range::figures() {
        let terms = FigureTerms::from_terms(&figure.name, Reduction::Mean, Vec::new());
        let rests = terms.with_attitude(&figure, Some(&"true".to_owned())).attitude.is_some();
        let is_of_lines_of_sight = ["ra_", "dec_"].iter().any(|axis| figure.name.starts_with(axis));
        assert_eq!(rests, is_of_lines_of_sight, "{figure}");
    }
}

#[test]
fn no_figure_of_a_world_is_one_of_the_navigation() {
    assert!(all().iter().all(|figure| !is_of_navigation(&figure.name)));
}
