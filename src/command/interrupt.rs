//! External pipeline programs end with this process, even when it is interrupted, and its temporary
//! directories are removed.
//!
//! Programs run in separate process groups, which the interrupt of a terminal does not reach, and a program
//! that hangs does not notice that its input is closed. A process that is killed (SIGKILL) cannot end its
//! programs: they only receive a closed input.

#[cfg(unix)]
use std::io::Write;
use std::sync::{Mutex, PoisonError};

use files::Failure;
#[cfg(unix)]
use pipeline::external::protocol::harmless;

use super::scratch_directory::ScratchDirectory;
#[cfg(unix)]
use super::scratch_directory::remove_all;

/// Message when the process is interrupted: which results were kept, and how to continue.
static KEPT: Mutex<Option<Box<dyn Fn() -> String + Send>>> = Mutex::new(None);

/// Message for a command that sets no other message.
const NOTHING_HALF: &str = "no file is partly written; the same command starts again from the beginning";

/// Sets the message of an interrupt from now on: which results the command keeps, and how to continue. An
/// empty text prints nothing.
pub(super) fn report_interruption(kept: impl Fn() -> String + Send + 'static) {
    *KEPT.lock().unwrap_or_else(PoisonError::into_inner) = Some(Box::new(kept));
}

/// Prints the message.
#[cfg(unix)]
fn print_interruption() {
    let kept = KEPT.lock().unwrap_or_else(PoisonError::into_inner);
    let text = kept.as_ref().map_or_else(|| NOTHING_HALF.to_owned(), |kept| kept());
    if !text.is_empty() {
        // Standard error may have no reader.
        let _ = writeln!(std::io::stderr(), "\ninterrupted: {}", harmless(&text));
    }
}

/// Creates a temporary directory; removed when the value is dropped, or when the process is requested to end.
pub(super) fn scratch_directory() -> Result<ScratchDirectory, Failure> {
    clean_up_when_interrupted();
    // Programs may change their directory: a relative TMPDIR would then be another one.
    let folder = std::env::temp_dir();
    ScratchDirectory::create(&std::path::absolute(&folder).unwrap_or(folder))
}

/// Installs a handler for SIGINT, SIGTERM and SIGHUP. The handler ends the programs of pipelines, removes
/// temporary directories, and then ends this process as the signal would have: a waiting parent sees the
/// signal. Further calls have no effect.
#[cfg(unix)]
pub(super) fn clean_up_when_interrupted() {
    static STARTED: std::sync::Once = std::sync::Once::new();
    STARTED.call_once(|| {
        // Without a thread, or without signals, programs are in the same situation as without this function:
        // their input is closed.
        let _ = std::thread::Builder::new().name("interrupt".to_owned()).spawn(|| {
            if let Ok(number) = first_signal() {
                pipeline::external::end_all();
                remove_all();
                print_interruption();
                // The call does not return for any of the three signals.
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

/// On other systems, a program ends when its input does, and the next process removes the directories.
#[cfg(not(unix))]
pub(super) fn clean_up_when_interrupted() {}
