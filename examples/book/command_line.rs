//! The page of the command line: the help of every command.

use std::error::Error;

/// Returns the page.
pub(super) fn page(program: &str) -> Result<String, Box<dyn Error>> {
    let mut page = "# Command line\n\nThe help of every command, as the program prints it.\n".to_owned();
    append_help(&mut page, program, &[])?;
    Ok(page)
}

/// Appends the help of a command and of its subcommands.
fn append_help(page: &mut String, program: &str, command: &[&str]) -> Result<(), Box<dyn Error>> {
    let arguments: Vec<&str> = command.iter().copied().chain(["--help"]).collect();
    let help = super::output(program, &arguments)?;
    let title = ["boresight"].iter().chain(command).copied().collect::<Vec<&str>>().join(" ");
    let level = "#".repeat(2 + command.len().saturating_sub(1));
    let lines: Vec<&str> = help.lines().map(str::trim_end).collect();
    page.push_str(&format!("\n{level} {title}\n\n```text\n{}\n```\n", lines.join("\n")));
    for name in subcommands(&help) {
        append_help(page, program, &command.iter().copied().chain([name]).collect::<Vec<&str>>())?;
    }
    Ok(())
}

/// Names of the subcommands that a help text lists.
fn subcommands(help: &str) -> Vec<&str> {
    let listed = help.lines().skip_while(|line| *line != "Commands:").skip(1);
    listed
        .take_while(|line| !line.is_empty())
        .filter_map(|line| line.strip_prefix("  ")?.split(' ').next())
        .filter(|name| !name.is_empty() && *name != "help")
        .collect()
}
