//! Usual size of the residuals of a small target. A fit that ends in a wrong minimum leaves more.
//!
//! The features of a small target are narrower than pixels and lines, so that a fit from a rough pose may
//! assign pixels of a mark to the cross or to the plate. Its residuals then contain a part of the features'
//! signal and are two to five times the usual ones. The noise of the sky is no reference for the residuals:
//! the sky is clipped at black.

/// Ratio to the usual residuals above which a fit is poor. In the approach on which it was chosen
/// (docs/evidence/docking-consistency.md, case 7), fits at the best minimum have up to 1.5, others 2 and
/// more.
const MAX_RATIO: f64 = 1.6;

/// Rate at which larger residuals become usual, per field: within a second or two.
const ADAPTATION: f64 = 0.02;

/// Usual size of the residuals, relative to the level of the marks; `None` before the first field.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct UsualResidual(Option<f64>);

impl UsualResidual {
    /// Adds the residuals of a fit, relative to the level of the marks. Returns true if they are larger than
    /// usual.
    pub(super) fn add(&mut self, residual: f64) -> bool {
        let usual = self.0.unwrap_or(residual);
        self.0 = Some(if residual < usual { residual } else { usual + ADAPTATION * (residual - usual) });
        residual > MAX_RATIO * usual
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn residuals_of_a_wrong_minimum_are_larger_than_usual() {
        let mut usual = UsualResidual::default();
        assert!(!usual.add(0.12), "the first field has nothing to be compared with");
        assert!(!usual.add(0.04));
        assert!(usual.add(0.12) && !usual.add(0.05) && usual.add(0.09));
    }

    #[test]
    fn a_change_of_the_video_becomes_usual() {
        let mut usual = UsualResidual::default();
        usual.add(0.03);
        let poor = (0..200).filter(|_| usual.add(0.06)).count();
        assert!((10..60).contains(&poor), "{poor}");
    }
}
