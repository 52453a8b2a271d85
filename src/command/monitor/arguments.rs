//! Arguments of the operator's page.

use std::net::{IpAddr, Ipv4Addr, SocketAddr};

use clap::Args;

use crate::command::options::{PipelineOptions, Selection};

/// Default address of `--bind`: only this machine.
const DEFAULT: SocketAddr = SocketAddr::new(IpAddr::V4(Ipv4Addr::LOCALHOST), 7321);

#[derive(Debug, Args)]
pub(in crate::command) struct MonitorArguments {
    #[command(flatten)]
    pub(super) selection: Selection,
    /// Begin at this frame (docking: field): --frames N.. up to the last
    #[arg(long, value_name = "N", conflicts_with = "frames")]
    pub(super) from: Option<u64>,
    #[command(flatten)]
    pub(super) pipeline: PipelineOptions,
    /// Address and port of the page; port 0: any free port. Anyone who can reach it sees the page
    #[arg(long, value_name = "ADDRESS:PORT", default_value_t = DEFAULT)]
    pub(super) bind: SocketAddr,
}
