//! Scenarios that are embedded in the binary.

/// A scenario of the folder `scenarios/`, embedded.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct BuiltIn {
    /// Name on the command line.
    pub name: &'static str,
    /// The TOML text.
    pub text: &'static str,
}

/// Every built-in scenario, by name.
pub const BUILT_IN: &[BuiltIn] = &[
    BuiltIn { name: "argon", text: include_str!("../../scenarios/argon.toml") },
    BuiltIn { name: "starting-point", text: STARTING_POINT },
];

/// A small scenario with a comment on every line: what `scenario new` writes.
pub const STARTING_POINT: &str = include_str!("../../scenarios/starting-point.toml");
