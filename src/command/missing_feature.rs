//! Commands that may be missing from a build.

use files::Failure;

/// Returns the failure of a command that needs a feature missing from this build.
pub(super) fn missing_feature(feature: &str) -> Failure {
    Failure::Usage(format!(
        "this boresight was built without the feature `{feature}`; install it with: cargo install --path . \
         --features {feature}"
    ))
}
