//! Scenarios that are embedded in the binary.

/// A file of the directory `scenarios/`, embedded in the binary.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct BuiltIn {
    /// Name on the command line.
    pub name: &'static str,
    /// TOML text of the file.
    pub text: &'static str,
}

/// Built-in scenarios, by name.
pub const BUILT_IN: &[BuiltIn] = &[
    BuiltIn { name: "argon", text: include_str!("../../../scenarios/argon.toml") },
    BuiltIn { name: "argon-numerical", text: include_str!("../../../scenarios/argon-numerical.toml") },
    BuiltIn { name: "demo-docking", text: include_str!("../../../scenarios/demo-docking.toml") },
    BuiltIn { name: "demo-far-range", text: include_str!("../../../scenarios/demo-far-range.toml") },
    BuiltIn { name: "docking", text: include_str!("../../../scenarios/docking.toml") },
    BuiltIn { name: "middle-range", text: include_str!("../../../scenarios/middle-range.toml") },
    BuiltIn { name: "starting-point", text: include_str!("../../../scenarios/starting-point.toml") },
];

/// Returns the built-in scenario with this name.
pub fn built_in(name: &str) -> Option<BuiltIn> {
    BUILT_IN.iter().copied().find(|built_in| built_in.name == name)
}
