//! Commands that a build may be without.

use files::Failure;

/// The failure of a command that needs a feature which this build does not have.
pub(super) fn missing_feature(feature: &str) -> Failure {
    Failure::Usage(format!(
        "this boresight was built without the feature `{feature}`, expected a build with it: cargo install --path . --features {feature}"
    ))
}
