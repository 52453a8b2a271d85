//! Confidence intervals of 95 %.

/// 97.5 % quantile of the standard normal distribution: every interval is two-sided with a confidence of 95
/// %.
pub const Z_95: f64 = 1.959_963_984_540_054;

/// Two-sided confidence interval of 95 %.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Interval {
    /// Lower limit.
    pub low: f64,
    /// Upper limit.
    pub high: f64,
}
