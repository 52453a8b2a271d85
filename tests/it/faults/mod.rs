//! Faults of the environment: killed processes, full disks, damaged files, two processes at the same path.
//! Each causes a clear error or no problem at all; nothing is lost, and nothing is silently wrong.

mod concurrent_processes;
mod damage;
mod disk;
mod kill;
mod killed_commands;
mod killed_study;
mod streams;

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use crate::support::Bench;

/// Writes a scenario with small frames and a short star list, because the tests here repeat it many times.
fn small(bench: &Bench) {
    bench.scenario("small.toml", "starting-point", |table| {
        let camera = table["camera"].as_table_mut().unwrap();
        for (key, value) in [("columns", 160), ("rows", 120)] {
            camera.insert(key.to_owned(), value.into());
        }
        for (key, value) in [("principal_x_px", 79.5), ("principal_y_px", 59.5)] {
            camera.insert(key.to_owned(), value.into());
        }
        table["star_list"].as_table_mut().unwrap().insert("magnitude_limit".to_owned(), 5.0.into());
    });
}

/// Path of the command's executable.
fn program() -> &'static Path {
    assert_cmd::cargo::cargo_bin!("boresight")
}

/// Returns the command with these words, separated by spaces, not yet started.
fn command(bench: &Bench, words: &str) -> Command {
    let mut command = Command::new(program());
    command.args(words.split_whitespace()).current_dir(bench.path(""));
    command
}

/// Runs a shell line in which `$BORESIGHT` is the executable.
fn shell(bench: &Bench, line: &str) -> Output {
    let mut command = Command::new("sh");
    command.args(["-c", line]).env("BORESIGHT", program()).current_dir(bench.path(""));
    command.output().unwrap()
}

fn stderr(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}

/// Returns the files of a directory that have their final names, without the unfinished files of killed
/// processes.
fn complete_files(bench: &Bench, directory: &str) -> BTreeMap<PathBuf, Vec<u8>> {
    let is_partial = |path: &Path| {
        let name = path.file_name().map(|name| name.to_string_lossy().into_owned());
        name.is_some_and(|name| {
            name.starts_with(".partial-")
                || name.starts_with(".rows-")
                || name == "UNFINISHED.txt"
                || name.ends_with(".journal")
        })
    };
    bench.tree(directory).into_iter().filter(|(path, _)| !is_partial(path)).collect()
}
