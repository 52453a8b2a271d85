//! Disks that are full or read-only: an error that names the file, and no partial result that appears
//! complete.

use std::path::{Path, PathBuf};
use std::process::Output;

use super::{complete_files, shell, small, stderr};
use crate::support::{Bench, check_same_files};

/// Runs a command whose files are limited to `blocks` blocks of 512 bytes: a write beyond this fails, as on a
/// full disk.
fn with_short_files(bench: &Bench, blocks: u32, words: &str) -> Output {
    shell(bench, &format!("trap '' XFSZ; ulimit -f {blocks}; exec \"$BORESIGHT\" {words}"))
}

/// Checks that the command failed for lack of space, and named the file.
fn check_no_room(output: &Output, directory: &str) {
    let text = stderr(output);
    assert_eq!(output.status.code(), Some(2), "{text}");
    assert!(text.contains(directory) && text.contains("cannot"), "{text}");
    assert!(text.contains("File too large") || text.contains("No space left"), "{text}");
    assert!(!text.contains("panicked") && !text.contains("not a readable"), "{text}");
}

/// Runs a command that creates a directory, with every file-size limit that stops it at a different point;
/// returns the number of times that it was stopped.
fn check_stopped_anywhere(bench: &Bench, making: &str, reader: &str) -> u32 {
    bench.boresight(&format!("{making} --out whole")).done();
    let whole = bench.tree("whole");
    // Each file of the result is the first to exceed the limit, and each exceeds it in the middle.
    let mut lengths: Vec<u32> =
        whole.values().flat_map(|bytes| [bytes.len() / 1024, bytes.len() / 512]).map(|n| n as u32).collect();
    lengths.sort_unstable();
    lengths.dedup();
    let mut stopped = 0;
    for blocks in lengths {
        let output = with_short_files(bench, blocks, &format!("{making} --out short"));
        if output.status.code() == Some(0) {
            // Results are valid without their report, whose absence is noted.
            let mut left = bench.tree("short");
            let has_report = left.contains_key(Path::new("report.html"));
            assert!(
                has_report || stderr(&output).contains("the report was not written"),
                "{}",
                stderr(&output)
            );
            if let Some(report) = whole.get(Path::new("report.html")) {
                left.insert(PathBuf::from("report.html"), report.clone());
            }
            check_same_files(&whole, &left);
        } else {
            stopped += 1;
            check_no_room(&output, "short");
            for (path, bytes) in complete_files(bench, "short") {
                let is_image = path.starts_with("frames");
                assert!(
                    is_image || whole[&path] == bytes,
                    "{blocks} blocks: {} is not whole",
                    path.display()
                );
            }
            let read = bench.boresight(reader);
            assert!(read.status == Some(2), "{blocks} blocks: `{reader}` is content: {}", read.stdout);
            bench.boresight(&format!("{making} --out short")).refused(&["short", "nothing is overwritten"]);
        }
        let _ = std::fs::remove_dir_all(bench.path("short"));
    }
    stopped
}

#[test]
fn a_run_that_has_no_room_names_the_file_and_is_no_run() {
    let bench = Bench::new();
    small(&bench);
    let making = "run small.toml --frames 20..24 --save-frames fits";
    let stopped = check_stopped_anywhere(&bench, making, "report short --out page.html");
    assert!(stopped >= 6, "{stopped}");
}

#[test]
fn a_dataset_that_has_no_room_names_the_file_and_is_no_dataset() {
    for format in ["fits", "png", "exr"] {
        let bench = Bench::new();
        small(&bench);
        let making = format!("render small.toml --frames 20..22 --format {format}");
        let stopped = check_stopped_anywhere(&bench, &making, "process short --out answers.csv");
        assert!(stopped >= 4, "{format}: {stopped}");
    }
}

#[test]
fn a_docking_dataset_that_has_no_room_names_the_file_and_is_no_dataset() {
    for format in ["png", "avi", "mjpeg", "y4m"] {
        let bench = Bench::new();
        let making = format!("render docking --frames 18000..18004 --format {format}");
        let stopped = check_stopped_anywhere(&bench, &making, "process short --out answers.csv");
        assert!(stopped >= 3, "{format}: {stopped}");
    }
}

const STUDY: &str = "title = \"two frames\"\nscenario = \"small.toml\"\nseed = 5\nframes = \"20..22\"\n[stop]\ncases = 60\n\
                     [[vary]]\npath = \"psf.sigma_px\"\ndistribution = { kind = \"uniform\", min = 0.7, max = 0.9 }\n";

#[test]
fn a_study_on_a_full_disk_continues_when_there_is_space() {
    let bench = Bench::new();
    small(&bench);
    bench.write("study.toml", STUDY);
    let making = "study run study.toml --shards 2";
    bench.boresight(&format!("{making} --out whole")).done();
    let mut stopped = 0;
    for blocks in [0, 4, 30, 60] {
        let output = with_short_files(&bench, blocks, &format!("{making} --out out"));
        if output.status.code() != Some(0) {
            stopped += 1;
            check_no_room(&output, "out");
        }
        for (path, bytes) in complete_files(&bench, "out") {
            assert!(bench.tree("whole")[&path] == bytes, "{blocks} blocks: {} is not whole", path.display());
        }
    }
    assert!(stopped >= 2, "{stopped}");
    bench.boresight(&format!("{making} --out out")).done();
    check_same_files(&bench.tree("whole"), &bench.tree("out"));

    bench.boresight("gate baseline whole --out base --reason first").done();
    let baseline = bench.tree("base");
    let output = with_short_files(&bench, 1, "gate baseline whole --out base --reason again --replace");
    check_no_room(&output, "base");
    check_same_files(&baseline, &bench.tree("base"));
    let output = with_short_files(&bench, 0, "gate base whole --junit gate.xml");
    check_no_room(&output, "gate.xml");
    assert!(!bench.path("gate.xml").exists());
}

#[test]
fn measurements_on_a_full_disk_leave_no_file() {
    let bench = Bench::new();
    small(&bench);
    bench.boresight("render small.toml --frames 20..40 --format png --out set").done();
    let before = bench.tree("set");
    check_no_room(&with_short_files(&bench, 2, "process set"), "set");
    check_same_files(&before, &bench.tree("set"));
    // If the images cannot be passed to a program, nothing is scored.
    let words = "process set --pipeline 'exec:python3 program.py' --out answers.csv";
    bench.write(
        "program.py",
        "input()\nprint('{\"boresight_pipeline\": 1, \"name\": \"x\"}', flush=True)\ninput()\n",
    );
    let output = with_short_files(&bench, 20, words);
    assert_eq!(output.status.code(), Some(2), "{}", stderr(&output));
    assert!(stderr(&output).contains("the image cannot be written"), "{}", stderr(&output));
    assert!(!bench.path("answers.csv").exists());
    // Without a directory for the images, nothing begins.
    let output = shell(
        &bench,
        &format!(
            "TMPDIR=/nowhere exec \"$BORESIGHT\" {} --out b.csv",
            words.replace(" --out answers.csv", "")
        ),
    );
    assert_eq!(output.status.code(), Some(2));
    assert!(stderr(&output).contains("a temporary directory cannot be made"), "{}", stderr(&output));
}

/// Below a file, and in a directory of the kernel: paths where no user, not even root, can create a
/// directory.
#[test]
fn a_path_that_cannot_be_written_to_is_named() {
    let bench = Bench::new();
    small(&bench);
    bench.write("study.toml", STUDY);
    bench.write("file", "mine");
    let places: &[&str] =
        if cfg!(target_os = "linux") { &["file/out", "/proc/boresight"] } else { &["file/out"] };
    for &place in places {
        for words in [
            "run small.toml --frames 0..2 --out",
            "render small.toml --frames 0..2 --out",
            "study run study.toml --out",
            "study run study.toml --shard 1/2 --out",
        ] {
            bench.boresight(&format!("{words} {place}")).refused(&[place, "cannot create"]);
        }
    }
    assert_eq!(bench.read("file"), "mine");
}

/// A separate file system, unmounted when the value is dropped.
struct MountedFileSystem(PathBuf);

impl MountedFileSystem {
    /// Mounts a tmpfs of `kilobytes` kilobytes; `None` if mounting is not permitted.
    fn tmpfs(place: PathBuf, kilobytes: u32) -> Option<Self> {
        std::fs::create_dir(&place).unwrap();
        let size = format!("size={kilobytes}k,nr_inodes=400");
        let mount = ["-t", "tmpfs", "-o", &size, "boresight-test"];
        Self::mount(&mount, &place).then_some(Self(place))
    }

    fn remount(&self, options: &str) {
        let options = format!("remount,{options}");
        assert!(
            Self::mount(&["-o", &options], &self.0),
            "the file system cannot be mounted anew with {options}"
        );
    }

    fn mount(arguments: &[&str], place: &Path) -> bool {
        let mounted = std::process::Command::new("mount").args(arguments).arg(place).output();
        mounted.is_ok_and(|output| output.status.success())
    }
}

impl Drop for MountedFileSystem {
    fn drop(&mut self) {
        let _ = std::process::Command::new("umount").arg(&self.0).output();
    }
}

/// A disk that is really full, then larger, then read-only.
#[test]
#[ignore = "needs root, to mount; continuous integration has it"]
fn a_study_on_a_full_disk_continues_on_a_larger_one() {
    let bench = Bench::new();
    small(&bench);
    bench.write("study.toml", STUDY);
    let making = "study run study.toml --shards 6 --no-report";
    bench.boresight(&format!("{making} --out whole")).done();
    let Some(disk) = MountedFileSystem::tmpfs(bench.path("disk"), 8) else {
        panic!("mounting is not permitted here: run as root, or leave this test out");
    };
    let mut stopped = 0;
    for kilobytes in [8, 32, 64, 96, 128, 4000] {
        disk.remount(&format!("size={kilobytes}k"));
        let output = shell(&bench, &format!("exec \"$BORESIGHT\" {making} --out disk/out"));
        if output.status.code() != Some(0) {
            stopped += 1;
            check_no_room(&output, "disk/out");
        }
        for (path, bytes) in complete_files(&bench, "disk/out") {
            assert!(bench.tree("whole")[&path] == bytes, "{kilobytes} kB: {} is not whole", path.display());
        }
    }
    assert!(stopped >= 2, "{stopped}");
    check_same_files(&bench.tree("whole"), &complete_files(&bench, "disk/out"));

    bench.boresight("run small.toml --frames 20..24 --save-frames fits --no-report --out whole-run").done();
    disk.remount("size=5000k");
    let size = bench.tree("whole-run").values().map(Vec::len).sum::<usize>() / 1024;
    for part in 1..4 {
        disk.remount(&format!(
            "size={}k",
            1 + size * part / 4 + bench.tree("disk/out").values().map(Vec::len).sum::<usize>() / 1024
        ));
        let run = "run small.toml --frames 20..24 --save-frames fits --no-report --out disk/run";
        let output = shell(&bench, &format!("exec \"$BORESIGHT\" {run}"));
        check_no_room(&output, "disk/run");
        bench.boresight("report disk/run --out page.html").refused(&["disk/run"]);
        std::fs::remove_dir_all(bench.path("disk/run")).unwrap();
    }
    disk.remount("size=5000k,ro");
    bench
        .boresight("run small.toml --frames 20..24 --out disk/run")
        .refused(&["disk/run", "Read-only file system"]);
    bench.boresight("study run study.toml --out disk/new").refused(&["disk/new", "Read-only file system"]);
    // Complete results can be read on a read-only disk.
    bench.boresight("gate baseline disk/out --out base --reason x").done();
    let again = bench.boresight(&format!("{making} --out disk/out"));
    again.refused(&["disk/out", "Read-only file system"]);
}
