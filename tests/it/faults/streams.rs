//! Standard output that is full, closed, or whose reader is gone.

#[cfg(target_os = "linux")]
use std::fs::File;
use std::io::Read;
use std::process::Stdio;

use super::{command, shell, small, stderr};
use crate::support::{Bench, check_same_files};

/// A device that is always full.
#[cfg(target_os = "linux")]
const FULL: &str = "/dev/full";

#[cfg(target_os = "linux")]
#[test]
fn a_full_standard_output_is_an_error_and_the_results_are_complete() {
    let bench = Bench::new();
    small(&bench);
    bench.boresight("run small.toml --frames 20..24 --out whole").done();
    for words in
        ["run small.toml --frames 20..24 --out full", "run small.toml --frames 20..24 --out full --json"]
    {
        let full = File::options().write(true).open(FULL).unwrap();
        let output = command(&bench, words).stdout(full).output().unwrap();
        assert_eq!(output.status.code(), Some(2), "{}", stderr(&output));
        assert!(
            stderr(&output).contains("stdout cannot be written: No space left on device"),
            "{}",
            stderr(&output)
        );
        check_same_files(&bench.tree("whole"), &bench.tree("full"));
        std::fs::remove_dir_all(bench.path("full")).unwrap();
    }
    for words in [
        "scenario list",
        "scenario schema --json",
        "completions bash",
        "render docking --frames 18000..18004 --format y4m --out -",
    ] {
        let full = File::options().write(true).open(FULL).unwrap();
        let output = command(&bench, words).stdout(full).output().unwrap();
        assert_eq!(output.status.code(), Some(2), "{words}: {}", stderr(&output));
        assert!(stderr(&output).contains("No space left on device"), "{words}: {}", stderr(&output));
    }
}

/// `| head`: a command completes its results even if its output is not read to the end; a stream without a
/// reader ends.
#[test]
fn a_reader_that_closes_the_pipe_ends_the_stream_and_spoils_no_result() {
    let bench = Bench::new();
    small(&bench);
    bench.boresight("run small.toml --frames 20..24 --out whole").done();
    let run = |words: &str, bytes: usize| {
        let mut child = command(&bench, words).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
        let mut beginning = vec![0; bytes];
        let mut pipe = child.stdout.take().unwrap();
        pipe.read_exact(&mut beginning).unwrap();
        drop(pipe);
        (child.wait_with_output().unwrap(), String::from_utf8_lossy(&beginning).into_owned())
    };
    let (output, _) = run("run small.toml --frames 20..24 --out cut --json", 0);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    check_same_files(&bench.tree("whole"), &bench.tree("cut"));

    let (output, beginning) = run("render docking --frames 18000..18200 --format y4m --out -", 10);
    assert_eq!((output.status.code(), beginning.as_str()), (Some(2), "YUV4MPEG2 "));
    assert!(
        stderr(&output).contains("standard output: cannot write: the reading process closed the stream"),
        "{}",
        stderr(&output)
    );

    bench.boresight("render docking --frames 18000..18100 --format y4m --out video").done();
    let (output, beginning) = run("process video --out -", 6);
    assert_eq!((output.status.code(), beginning.as_str()), (Some(2), "field,"));
    assert!(stderr(&output).contains("standard output"), "{}", stderr(&output));
    assert!(!stderr(&output).contains("panicked"), "{}", stderr(&output));
}

/// The descriptor of a closed stream is not reused for a file, into which the command's output would then be
/// written.
#[test]
fn closed_streams_spoil_no_result() {
    let bench = Bench::new();
    small(&bench);
    bench.boresight("run small.toml --frames 20..24 --out whole").done();
    for (i, closed) in [">&-", "2>&-", "<&-", "<&- >&- 2>&-"].into_iter().enumerate() {
        let output = shell(
            &bench,
            &format!("exec \"$BORESIGHT\" run small.toml --frames 20..24 --out out-{i} {closed}"),
        );
        assert_eq!(output.status.code(), Some(0), "{closed}: {}", stderr(&output));
        check_same_files(&bench.tree("whole"), &bench.tree(&format!("out-{i}")));
    }
}
