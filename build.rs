//! Watches the monitor's page, which is built apart and embedded if it is there.

use std::path::Path;

fn main() {
    // A path that does not exist would count as changed at every build, so before the page is built its folder's parent is
    // watched: there `dist` appears.
    let dist = Path::new("monitor/dist");
    println!("cargo::rerun-if-changed={}", if dist.is_dir() { "monitor/dist" } else { "monitor" });
}
