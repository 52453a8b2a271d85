//! `boresight monitor`: the page of an operator, served on loopback.

#[cfg(feature = "monitor")]
mod page;

use std::net::{IpAddr, Ipv4Addr, SocketAddr};

use clap::Args;

#[cfg(feature = "monitor")]
pub(super) use page::monitor;

use super::options::{PipelineOptions, Selection};

/// The address without `--bind`: this machine alone.
const DEFAULT: SocketAddr = SocketAddr::new(IpAddr::V4(Ipv4Addr::LOCALHOST), 7321);

#[derive(Debug, Args)]
pub(super) struct MonitorArguments {
    #[command(flatten)]
    selection: Selection,
    /// Begin at this frame (docking: field): --frames N.. up to the last one
    #[arg(long, value_name = "N", conflicts_with = "frames")]
    from: Option<u64>,
    #[command(flatten)]
    pipeline: PipelineOptions,
    /// Address and port of the page; port 0: any that is free. Whoever reaches it sees the page
    #[arg(long, value_name = "ADDRESS:PORT", default_value_t = DEFAULT)]
    bind: SocketAddr,
}

/// Fails: this build has no server of the page.
#[cfg(not(feature = "monitor"))]
pub(super) fn monitor(
    _: &MonitorArguments,
    _: &super::output::Output,
) -> Result<super::Answer, files::Failure> {
    Err(super::missing_feature("monitor"))
}
