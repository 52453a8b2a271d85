//! What a figure is, and which way is better: by its name.

/// What is counted.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kind {
    /// So many of so many; from 0 to 1.
    Rate,
    /// A mean, a median, a root mean square.
    Amount,
}

/// Which way is better.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Better {
    /// More of it.
    More,
    /// Less of it.
    Less,
    /// Nearer to a value: no bias is 0, honest sigmas have a NEES of 1.
    Near(f64),
}

/// Kind and direction of a figure.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sense {
    /// What is counted.
    pub kind: Kind,
    /// Which way is better.
    pub better: Better,
}

/// Share of errors within three standard deviations under the normal law.
const WITHIN_3_SIGMA: f64 = 0.9973;

/// What the figure of a name is, of either world.
pub fn sense(name: &str) -> Sense {
    let kind = if name.ends_with("_rate") || name.contains("within_") { Kind::Rate } else { Kind::Amount };
    let better = if name.contains("within_3_sigma") {
        Better::Near(WITHIN_3_SIGMA)
    } else if name.contains("nees") {
        Better::Near(1.0)
    } else if name.ends_with("miss_rate") || name.ends_with("wrong_rate") || name.ends_with("range_only_rate")
    {
        Better::Less
    } else if kind == Kind::Rate || name == "stars_mean" {
        Better::More
    } else if name.contains("_rms_") || name.contains("latency") || name.contains("score") {
        Better::Less
    } else {
        Better::Near(0.0)
    };
    Sense { kind, better }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{docking, figure_names};

    #[test]
    fn every_figure_has_a_sense() {
        let is = |name: &str, kind, better| assert_eq!(sense(name), Sense { kind, better }, "{name}");
        is("hit_rate", Kind::Rate, Better::More);
        is("dec_within_1px", Kind::Rate, Better::More);
        is("wrong_rate", Kind::Rate, Better::Less);
        is("ra_rms_deg", Kind::Amount, Better::Less);
        is("ra_mean_deg", Kind::Amount, Better::Near(0.0));
        is("motion_range_rate_rms_m_s", Kind::Amount, Better::Less);
        is("motion_position_nees_mean", Kind::Amount, Better::Near(1.0));
        is("paper_success_rate", Kind::Rate, Better::More);
        // A bias is the only amount that is best at nought.
        for name in figure_names().into_iter().chain(docking::figure_names()) {
            let is_bias = name.contains("_mean_") || name.contains("_median_");
            assert_eq!(sense(&name).better == Better::Near(0.0), is_bias, "{name}");
        }
    }
}
