//! Files of docking: outcomes, features, truth, and the data that a pipeline receives before the first field.

mod covariance;
mod features;
mod measurements;
mod motion;
mod pose;
mod setup;
pub(crate) mod telemetry;
mod truth;

pub use features::FeatureRow;
pub(super) use measurements::FieldMeasurementLine;
pub use measurements::{FieldMeasurementWriter, outcome_as_filed, read_field_measurements};
pub(super) use motion::MotionLine;
pub use motion::{MotionWriter, read_motion, report_as_filed};
pub use setup::SetupFile;
pub use telemetry::{FieldRow, FieldTelemetryWriter, read_field_telemetry};
pub(super) use truth::FieldTruthRow;
pub use truth::truth_as_filed;
