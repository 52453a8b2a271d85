//! Programs in the place of the pipeline end with this process, also when it is interrupted, and its temporary directories go.
//!
//! Programs run in process groups of their own, which the interrupt of a terminal does not reach, and one that hangs does not notice that its
//! input is closed. A process that is killed (SIGKILL) cannot end them: then the closed input is all that they get.

#[cfg(unix)]
use std::io::Write;
use std::sync::{Mutex, PoisonError};

use files::Failure;
#[cfg(unix)]
use pipeline::external::protocol::harmless;

use super::scratch_directory::ScratchDirectory;
#[cfg(unix)]
use super::scratch_directory::remove_all;

/// What is told when the process is interrupted: what was kept, and how to go on.
static KEPT: Mutex<Option<Box<dyn Fn() -> String + Send>>> = Mutex::new(None);

/// What is told of a command that says nothing else.
const NOTHING_HALF: &str = "no file was left half written; the same command begins anew";

/// Has an interrupt tell from now on what the command keeps and how to go on; an empty text tells nothing.
pub(super) fn report_interruption(kept: impl Fn() -> String + Send + 'static) {
    *KEPT.lock().unwrap_or_else(PoisonError::into_inner) = Some(Box::new(kept));
}

/// Tells it.
#[cfg(unix)]
fn print_interruption() {
    let kept = KEPT.lock().unwrap_or_else(PoisonError::into_inner);
    let text = kept.as_ref().map_or_else(|| NOTHING_HALF.to_owned(), |kept| kept());
    if !text.is_empty() {
        // Nobody may be there to read it.
        let _ = writeln!(std::io::stderr(), "\ninterrupted: {}", harmless(&text));
    }
}

/// A directory for files that nobody keeps; gone with the value, or when the process is asked to end.
pub(super) fn scratch_directory() -> Result<ScratchDirectory, Failure> {
    clean_up_when_interrupted();
    ScratchDirectory::create(&std::env::temp_dir())
}

/// Ends the programs of pipelines on SIGINT, SIGTERM and SIGHUP, removes temporary directories, and then ends this process as the signal
/// would have: whoever waits for it sees the signal. Asked again, it does nothing.
#[cfg(unix)]
pub(super) fn clean_up_when_interrupted() {
    static STARTED: std::sync::Once = std::sync::Once::new();
    STARTED.call_once(|| {
        // Without a thread, or without signals, they are what they are without this: a closed input.
        let _ = std::thread::Builder::new().name("interrupt".to_owned()).spawn(|| {
            if let Ok(number) = first_signal() {
                pipeline::external::end_all();
                remove_all();
                print_interruption();
                // It does not come back from any of the three.
                let _ = signal_hook::low_level::emulate_default_handler(number);
                std::process::exit(128 + number);
            }
        });
    });
}

/// Waits for the first of the signals that end a process and returns its number.
#[cfg(unix)]
fn first_signal() -> std::io::Result<i32> {
    use signal_hook::consts::{SIGHUP, SIGINT, SIGTERM};
    let mut signals = signal_hook::iterator::Signals::new([SIGINT, SIGTERM, SIGHUP])?;
    signals.forever().next().ok_or_else(|| std::io::ErrorKind::UnexpectedEof.into())
}

/// Elsewhere a program ends when its input does, and the next process removes the directories.
#[cfg(not(unix))]
pub(super) fn clean_up_when_interrupted() {}
