//! `boresight examples`: the example files of the book, which a program without its source tree carries.

use std::io::Write;
use std::path::{Path, PathBuf};

use clap::Args;
use files::{AtomicFile, Failure, FileError, create_empty_directory};
use serde_json::json;
use sim::catalog::HIPPARCOS_BYTES;

use super::Answer;
use super::options::output_path;
use super::output::Output;

#[derive(Debug, Args)]
pub(super) struct ExamplesArguments {
    /// Directory to write, new or empty
    #[arg(short, long, value_name = "DIR", default_value = "examples", value_parser = output_path())]
    out: PathBuf,
}

/// A file for users to run or to change.
struct Example {
    /// Name in the directory.
    name: &'static str,
    bytes: &'static [u8],
    /// What it is, for the list on the terminal.
    words: &'static str,
}

/// The files, those of one subject together. A test compares the list with the folder `examples/` of the
/// source tree.
const EXAMPLES: [Example; 15] = [
    Example {
        name: "brightest.py",
        bytes: include_bytes!("../../examples/brightest.py"),
        words: "pipeline: the brightest object, standard library only",
    },
    Example {
        name: "argmax.py",
        bytes: include_bytes!("../../examples/argmax.py"),
        words: "pipeline: the brightest pixel, with numpy",
    },
    Example {
        name: "sep_brightest.py",
        bytes: include_bytes!("../../examples/sep_brightest.py"),
        words: "pipeline: the brightest object at no listed star, with SEP",
    },
    Example {
        name: "photutils_brightest.py",
        bytes: include_bytes!("../../examples/photutils_brightest.py"),
        words: "the same with photutils",
    },
    Example {
        name: "listed_stars.py",
        bytes: include_bytes!("../../examples/listed_stars.py"),
        words: "listed stars in an image, for the two above",
    },
    Example {
        name: "fixed_pose.py",
        bytes: include_bytes!("../../examples/fixed_pose.py"),
        words: "pipeline of television fields: the protocol, with a constant pose",
    },
    Example {
        name: "prior_orbit.py",
        bytes: include_bytes!("../../examples/prior_orbit.py"),
        words: "navigator: the orbit known before, standard library only",
    },
    Example {
        name: "night_sky.py",
        bytes: include_bytes!("../../examples/night_sky.py"),
        words: "images of a night sky, and their comparison with a solution",
    },
    Example {
        name: "argon-campaigns.toml",
        bytes: include_bytes!("../../scenarios/studies/argon-campaigns.toml"),
        words: "study: many campaigns of ARGON",
    },
    Example {
        name: "argon-optics.toml",
        bytes: include_bytes!("../../scenarios/studies/argon-optics.toml"),
        words: "study: ten minutes of ARGON over optics and detector",
    },
    Example {
        name: "camera-requirement.toml",
        bytes: include_bytes!("../../scenarios/requirements/uasc-far-range.toml"),
        words: "requirements on a camera, for `boresight visibility`",
    },
    Example {
        name: "tango.toml",
        bytes: include_bytes!("../../examples/tango.toml"),
        words: "section [target]: a satellite of plates",
    },
    Example {
        name: "smallsat.toml",
        bytes: include_bytes!("../../examples/smallsat.toml"),
        words: "section [target]: a satellite as a mesh",
    },
    Example {
        name: "targets/smallsat.obj",
        bytes: include_bytes!("../../scenarios/targets/smallsat.obj"),
        words: "its mesh",
    },
    Example {
        name: "targets/smallsat.mtl",
        bytes: include_bytes!("../../scenarios/targets/smallsat.mtl"),
        words: "its materials",
    },
];

/// Name of the star catalogue, which `night_sky.py` reads. Its bytes are those of the simulator: in the table
/// above, the program would contain them twice.
const CATALOGUE: &str = "hipparcos2.bin";

/// Writes the example files into a directory that is new or empty.
pub(super) fn examples(arguments: &ExamplesArguments, output: &Output) -> Result<Answer, Failure> {
    let folder = &arguments.out;
    create_empty_directory(folder)?;
    let targets = folder.join("targets");
    std::fs::create_dir(&targets).map_err(|source| FileError::io(&targets, "create", source))?;
    for example in &EXAMPLES {
        write(&folder.join(example.name), example.bytes)?;
    }
    write(&folder.join(CATALOGUE), HIPPARCOS_BYTES)?;
    let mut names: Vec<&str> = EXAMPLES.iter().map(|example| example.name).collect();
    names.push(CATALOGUE);
    output.answer(&json!({ "folder": folder, "files": names }), listing(arguments))?;
    Ok(Answer::Yes)
}

/// Writes a new file, which appears when it is complete.
fn write(path: &Path, bytes: &[u8]) -> Result<(), FileError> {
    let file = AtomicFile::create_new(path)?;
    file.file().write_all(bytes).map_err(|source| FileError::io(path, "write", source))?;
    file.commit_new()
}

/// Returns the files with their descriptions, a line each, and a command to try.
fn listing(arguments: &ExamplesArguments) -> String {
    let folder = arguments.out.display();
    let mut text = format!("{} files in {folder}:\n", EXAMPLES.len() + 1);
    for example in &EXAMPLES {
        text += &format!("  {:<24}{}\n", example.name, example.words);
    }
    text += &format!("  {CATALOGUE:<24}star catalogue of the simulator, for night_sky.py\n");
    text + &format!(
        "try: boresight run argon --frames 8000..8010 --pipeline \"exec:python3 {folder}/brightest.py\""
    )
}
