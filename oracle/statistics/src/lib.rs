//! Confidence intervals for sequences of dependent frames.
//!
//! Neighbouring frames show almost the same scene. 1000 of them therefore contain less information than 1000
//! independent trials. Every interval here is of 95 % and is widened by the effective sample size
//! ([`effective_size`]). Rates use the score interval of Wilson ([`wilson`]), means the normal distribution,
//! medians the order statistics. Frames that are independent by construction use the exact bounds of Clopper
//! and Pearson ([`clopper_pearson`]). Two runs are compared by exchanging blocks of frames ([`joint_test`]).

mod autocorrelation;
mod bound;
mod clopper_pearson;
mod clusters;
mod exchange;
mod interval;
mod location;
mod normal_quantile;
mod proportion;
mod quantile;
mod rank_correlation;

pub use autocorrelation::effective_size;
pub use bound::{Bounds, cluster_mean_bounds, cluster_quantile_bounds, cluster_rate_bounds};
pub use clopper_pearson::{binomial_at_least, clopper_pearson};
pub use clusters::{
    ClusterSum, MIN_CLUSTERS, cluster_mean_interval, cluster_rate_interval, clusters_needed,
    mean_difference_interval, rate_difference_interval,
};
pub use exchange::{
    BlockEffects, Exchanges, FigureTest, JointTest, MIN_BLOCKS_OF_INTERVAL, SETS, interval_by_sets,
    joint_test,
};
pub use interval::{Interval, Z_95};
pub use location::{below_median, mean_interval, median, median_interval, rms_interval};
pub use normal_quantile::normal_quantile;
pub use proportion::wilson;
pub use quantile::{ClusterValue, cluster_quantile_interval};
pub use rank_correlation::cluster_rank_correlation;
