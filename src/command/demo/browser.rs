//! Opening of a page in the user's browser.

use std::path::Path;
use std::process::{Command, Stdio};

/// Opens a file with the desktop's default program. Returns true if a program for this was started; a machine
/// without a desktop has none.
pub(super) fn open(file: &Path) -> bool {
    let Ok(file) = std::path::absolute(file) else { return false };
    let Some(mut command) = opener() else { return false };
    command.arg(file).stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::null());
    command.spawn().is_ok()
}

/// Returns the command that opens its last argument.
#[cfg(target_os = "macos")]
fn opener() -> Option<Command> {
    Some(Command::new("open"))
}

/// Returns the command that opens its last argument.
#[cfg(windows)]
fn opener() -> Option<Command> {
    Some(Command::new("explorer"))
}

/// Returns the command that opens its last argument; `None` without a desktop, where it would open a browser
/// in the terminal.
#[cfg(not(any(target_os = "macos", windows)))]
fn opener() -> Option<Command> {
    let has_desktop = ["WAYLAND_DISPLAY", "DISPLAY"].iter().any(|name| std::env::var_os(name).is_some());
    has_desktop.then(|| Command::new("xdg-open"))
}
