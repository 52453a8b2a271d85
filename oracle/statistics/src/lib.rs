//! Confidence intervals for sequences whose frames are not independent.
//!
//! Neighbouring frames show almost the same scene, so 1000 of them hold less evidence than 1000 throws of a coin.
//! Every interval here is of 95 % and is widened by the effective sample size ([`effective_size`]). Rates take
//! the score interval of Wilson ([`wilson`]), means the normal law, medians the order statistics. Frames that are independent by
//! construction take the exact bounds of Clopper and Pearson ([`clopper_pearson`]). Two runs are compared by exchanging blocks of
//! them ([`joint_test`]).

#![cfg_attr(
    not(test),
    deny(
        clippy::indexing_slicing,
        clippy::string_slice,
        clippy::expect_used,
        clippy::panic,
        clippy::unreachable
    )
)]

#[allow(
    clippy::indexing_slicing,
    reason = "indices are computed from the lengths of arrays made here; no input is read"
)]
mod autocorrelation;
mod clopper_pearson;
#[allow(
    clippy::indexing_slicing,
    reason = "indices are computed from the lengths of arrays made here; no input is read"
)]
mod exchange;
#[allow(
    clippy::indexing_slicing,
    reason = "indices are computed from the lengths of arrays made here; no input is read"
)]
mod location;
mod normal_quantile;
mod proportion;

pub use autocorrelation::effective_size;
pub use clopper_pearson::{binomial_at_least, clopper_pearson};
pub use exchange::{BlockEffects, Exchanges, JointTest, Tested, interval_by_sets, joint_test};
pub use location::{mean_interval, median, median_interval, rms_interval};
pub use normal_quantile::normal_quantile;
pub use proportion::wilson;

/// The 97.5 % quantile of the standard normal law: every interval is two-sided with a confidence of 95 %.
pub const Z_95: f64 = 1.959_963_984_540_054;

/// A two-sided confidence interval of 95 %.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Interval {
    /// Lower limit.
    pub low: f64,
    /// Upper limit.
    pub high: f64,
}
