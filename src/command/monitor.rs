//! `boresight monitor`: an operator's page, served on loopback.

mod arguments;
#[cfg(feature = "monitor")]
mod page;

pub(super) use arguments::MonitorArguments;
#[cfg(feature = "monitor")]
pub(super) use page::monitor;

/// Returns a failure: this build has no server for the page.
#[cfg(not(feature = "monitor"))]
pub(super) fn monitor(
    _: &MonitorArguments,
    _: &super::output::Output,
) -> Result<super::Answer, files::Failure> {
    Err(super::missing_feature("monitor"))
}
