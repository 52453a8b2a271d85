//! Worlds of this program.

use std::sync::Once;

/// Registers the worlds of this program, one line each, for the rest of the process. The first is that of
/// scenarios that name none. The command does so when it starts; a program that calls the library does so
/// before it reads a scenario or a run.
pub fn register_worlds() {
    static REGISTERED: Once = Once::new();
    REGISTERED.call_once(|| {
        far_range_views::register();
        docking_views::register();
        middle_range::register();
    });
}
