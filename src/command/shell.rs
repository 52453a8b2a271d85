//! `boresight completions` and `boresight man`: shell completions and manual pages, from the command's
//! definition.
use std::io::Write;
use std::path::{Path, PathBuf};

use clap::{Args, Command};
use clap_complete::Shell;
use files::{AtomicFile, Failure, FileError, ReplaceableFile};

use super::Answer;
use super::options::output_path;
use super::output::Output;

#[derive(Debug, Args)]
pub(super) struct CompletionsArguments {
    /// Shell to complete for
    #[arg(value_enum)]
    shell: Shell,
}

#[derive(Debug, Args)]
pub(super) struct ManArguments {
    /// Directory of the pages, created if it does not exist; existing pages are replaced
    #[arg(short, long, value_name = "DIR", value_parser = output_path())]
    out: PathBuf,
}

/// Prints a completion script for `root`, to be sourced by a shell.
pub(super) fn completions(
    arguments: &CompletionsArguments,
    mut root: Command,
    output: &Output,
) -> Result<Answer, Failure> {
    output.check_free("completions")?;
    let mut script = Vec::new();
    clap_complete::generate(arguments.shell, &mut root, "boresight", &mut script);
    match std::io::stdout().write_all(&script) {
        // A reader that has closed the pipe is not an error.
        Err(error) if error.kind() != std::io::ErrorKind::BrokenPipe => {
            Err(Failure::Usage(format!("stdout cannot be written: {error}")))
        }
        _ => Ok(Answer::Yes),
    }
}

/// Writes a manual page for `root` and each of its commands.
pub(super) fn man(arguments: &ManArguments, root: Command, output: &Output) -> Result<Answer, Failure> {
    let folder = &arguments.out;
    std::fs::create_dir_all(folder).map_err(|source| FileError::io(folder, "create", source))?;
    let mut root = root.disable_help_subcommand(true);
    root.build();
    let mut pages = Vec::new();
    write_pages(&root, "boresight", folder, &mut pages)?;
    output.answer(&pages, format!("{} pages in {}", pages.len(), folder.display()))?;
    Ok(Answer::Yes)
}

/// Manual pages of the command, which newer pages replace.
const PAGES: ReplaceableFile<'static> =
    ReplaceableFile { description: "an earlier page of this manual", matches: &is_page };

fn is_page(beginning: &[u8]) -> bool {
    let title = b".TH boresight";
    beginning.windows(title.len()).any(|window| window == title)
}

fn write_pages(
    command: &Command,
    name: &str,
    folder: &Path,
    pages: &mut Vec<PathBuf>,
) -> Result<(), Failure> {
    let path = folder.join(format!("{name}.1"));
    let io = |source| FileError::io(&path, "write", source);
    let mut page = Vec::new();
    let command_with_usage = command.clone().override_usage(usage(command));
    clap_mangen::Man::new(command_with_usage).title(name).render(&mut page).map_err(io)?;
    let file = AtomicFile::create(&path)?;
    file.file().write_all(&page).map_err(io)?;
    file.replace(PAGES)?;
    pages.push(path);
    for below in command.get_subcommands().filter(|below| !below.is_hide_set()) {
        write_pages(below, &format!("{name}-{}", below.get_name()), folder, pages)?;
    }
    Ok(())
}

/// Returns the synopsis of a page. The synopsis of clap_mangen shows options without their values.
fn usage(command: &Command) -> String {
    let name = command.get_bin_name().unwrap_or_else(|| command.get_name()).to_owned();
    let shown = || command.get_arguments().filter(|argument| !argument.is_hide_set());
    let options = shown()
        .filter(|argument| !argument.is_positional())
        .map(|option| if option.is_required_set() { option.to_string() } else { format!("[{option}]") });
    let positionals =
        command.get_positionals().filter(|positional| !positional.is_hide_set()).map(ToString::to_string);
    let below = match (command.has_subcommands(), command.is_subcommand_required_set()) {
        (false, _) => None,
        (true, true) => Some("<COMMAND>".to_owned()),
        (true, false) => Some("[COMMAND]".to_owned()),
    };
    std::iter::once(name).chain(options).chain(positionals).chain(below).collect::<Vec<_>>().join(" ")
}
