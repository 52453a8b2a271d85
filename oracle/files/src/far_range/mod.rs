//! Tables of the far range: outcomes, clusters, truth, star list and telemetry.

pub(crate) mod clusters;
pub(crate) mod manoeuvres;
pub(crate) mod measurements;
pub(crate) mod stars;
pub(crate) mod telemetry;
mod truth;

pub use clusters::FrameCluster;
pub use manoeuvres::write_manoeuvres;
pub use measurements::{MeasurementWriter, outcome_as_filed, read_measurements};
pub use stars::{StarRow, read_stars, write_stars};
pub use telemetry::{TelemetryRow, TelemetryWriter, read_telemetry};
