//! Child process that answers requests line by line, within limits of time and size.

use std::collections::VecDeque;
use std::io::{BufRead, BufReader, Read, Write};
use std::path::PathBuf;
use std::process::{Child, Command, Stdio};
use std::sync::mpsc::{Receiver, RecvTimeoutError, SyncSender, TryRecvError, TrySendError, sync_channel};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

use super::group;
use super::protocol::{MAX_LINE_BYTES, harmless};
use super::sandbox::Sandbox;

/// Running child. Three threads move its lines, so a full or empty pipe cannot block the caller for longer
/// than a limit.
pub(super) struct Process {
    child: Child,
    /// Lines for the child; `None` once its input is closed.
    requests: Option<SyncSender<Vec<u8>>>,
    events: Receiver<Event>,
    /// The last answer arrived together with a further line.
    is_ahead: bool,
    errors: Arc<Mutex<Tail>>,
    errors_reader: JoinHandle<()>,
}

/// Events of the child, in order.
enum Event {
    Line {
        text: Vec<u8>,
        /// A further line arrived together with this one: its event may be later than the next request.
        is_ahead: bool,
    },
    LineTooLong,
    OutputClosed,
    InputClosed,
}

/// Reason for ending a child.
pub(super) enum Fault {
    /// Violation of the protocol, with a description.
    Broken(String),
    /// No answer within this time.
    Late(Duration),
    /// Pipe closed by the child, which has probably ended; the text names the pipe.
    Closed(&'static str),
}

/// Prefix of this program's environment variables.
const OWN_VARIABLES: &str = "BORESIGHT_";

/// Largest number of unread lines kept: a child that floods its output is blocked by its full pipe.
const UNREAD_LINES: usize = 4;

/// Time allowed for a child to end after it closed a pipe or after its input was closed.
const GRACE: Duration = Duration::from_millis(300);

/// Interval between checks if a child has ended.
const POLL: Duration = Duration::from_millis(2);

impl Process {
    /// Starts a program with its memory limited to `memory_bytes`, and in a sandbox with the directory of the
    /// images, if one is given.
    ///
    /// # Errors
    /// The error of the operating system, when the program cannot be started or limited.
    pub(super) fn start(
        program: &str,
        arguments: &[String],
        memory_bytes: u64,
        sandbox: Option<&(Sandbox, PathBuf)>,
    ) -> std::io::Result<Self> {
        let mut command = Command::new(program);
        command.args(arguments).stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped());
        for (name, _) in std::env::vars_os() {
            // This program's variables may name scenarios, runs and caches.
            if name.to_string_lossy().starts_with(OWN_VARIABLES) {
                command.env_remove(name);
            }
        }
        let mut child = match sandbox {
            Some((sandbox, scratch)) => sandbox.spawn(&mut command, scratch, group::spawn)?,
            None => group::spawn(&mut command)?,
        };
        match group::limit_memory(&child, memory_bytes).and_then(|()| Pipes::connect(&mut child)) {
            Ok(Pipes { requests, events, errors, errors_reader }) => {
                Ok(Self { child, requests: Some(requests), events, is_ahead: false, errors, errors_reader })
            }
            Err(error) => {
                group::kill(&mut child);
                child.wait()?;
                Err(error)
            }
        }
    }

    /// Sends a line and waits for the child's answer, for at most `limit`.
    pub(super) fn exchange(&mut self, request: Vec<u8>, limit: Duration) -> Result<Vec<u8>, Fault> {
        let unsolicited = || Fault::Broken("it wrote a line without a request".to_owned());
        match self.events.try_recv() {
            _ if self.is_ahead => return Err(unsolicited()),
            Err(TryRecvError::Empty) => {}
            Err(TryRecvError::Disconnected) => return Err(Fault::Closed("its output")),
            Ok(Event::Line { .. }) => return Err(unsolicited()),
            Ok(event) => return Err(fault(&event)),
        }
        let sent = self
            .requests
            .as_ref()
            .map_or(Err(TrySendError::Disconnected(Vec::new())), |requests| requests.try_send(request));
        match sent {
            Ok(()) => {}
            Err(TrySendError::Full(_)) => {
                return Err(Fault::Broken("it answered without reading the request".to_owned()));
            }
            Err(TrySendError::Disconnected(_)) => return Err(Fault::Closed("its input")),
        }
        match self.events.recv_timeout(limit) {
            Ok(Event::Line { text, is_ahead }) => {
                self.is_ahead = is_ahead;
                Ok(text)
            }
            Ok(event) => Err(fault(&event)),
            Err(RecvTimeoutError::Timeout) => Err(Fault::Late(limit)),
            Err(RecvTimeoutError::Disconnected) => Err(Fault::Closed("its output")),
        }
    }

    /// Ends the child and its descendants. Returns a description of the fault, with the last lines of the
    /// child's error output.
    pub(super) fn end(&mut self, fault: Fault) -> String {
        let ended_by_itself = match fault {
            Fault::Broken(_) => false,
            Fault::Late(_) => self.ends_within(Duration::ZERO),
            Fault::Closed(_) => self.ends_within(GRACE),
        };
        let status = self.kill().filter(|_| ended_by_itself);
        let mut text = match (fault, status) {
            (Fault::Broken(text), _) => text,
            (Fault::Late(limit), None) => format!("it gave no answer within {} s", limit.as_secs_f64()),
            // A descendant holds the pipes open, so they did not report the end.
            (Fault::Late(limit), Some(status)) => {
                format!("it gave no answer within {} s, and had ended with {status}", limit.as_secs_f64())
            }
            (Fault::Closed(_), Some(status)) => format!("it ended with {status}"),
            (Fault::Closed(pipe), None) => format!("it closed {pipe}"),
        };
        // The kill closes the pipe, but a descendant that left the group may hold it open for ever.
        let deadline = Instant::now() + GRACE;
        while !self.errors_reader.is_finished() && Instant::now() < deadline {
            std::thread::sleep(POLL);
        }
        let errors = self.errors.lock().unwrap_or_else(PoisonError::into_inner).last_lines();
        if !errors.is_empty() {
            text.push_str("; last error output: ");
            text.push_str(&errors);
        }
        text
    }

    fn ends_within(&mut self, limit: Duration) -> bool {
        let deadline = Instant::now() + limit;
        loop {
            if group::has_ended(&mut self.child) {
                return true;
            }
            if Instant::now() >= deadline {
                return false;
            }
            std::thread::sleep(POLL);
        }
    }

    fn kill(&mut self) -> Option<std::process::ExitStatus> {
        self.requests = None;
        group::kill(&mut self.child);
        self.child.wait().ok()
    }
}

impl Drop for Process {
    /// Closes the child's input, waits briefly for the child to end, and kills its remaining processes.
    fn drop(&mut self) {
        // `None`: the child was ended and reaped, and its identifier may belong to another process.
        if self.requests.take().is_some() {
            self.ends_within(GRACE);
            self.kill();
        }
    }
}

/// Caller's ends of a child's pipes.
struct Pipes {
    requests: SyncSender<Vec<u8>>,
    events: Receiver<Event>,
    errors: Arc<Mutex<Tail>>,
    errors_reader: JoinHandle<()>,
}

impl Pipes {
    /// Starts the threads that serve the pipes.
    fn connect(child: &mut Child) -> std::io::Result<Self> {
        let (Some(input), Some(output), Some(error_output)) =
            (child.stdin.take(), child.stdout.take(), child.stderr.take())
        else {
            return Err(std::io::Error::other("its pipes are missing"));
        };
        let (event_sender, events) = sync_channel(UNREAD_LINES);
        let (requests, request_receiver) = sync_channel(1);
        let errors = Arc::new(Mutex::new(Tail::default()));
        spawn("external-out", {
            let events = event_sender.clone();
            move || read_lines(BufReader::new(output), &events)
        })?;
        spawn("external-in", move || write_lines(input, &request_receiver, &event_sender))?;
        let errors_reader = spawn("external-err", {
            let errors = Arc::clone(&errors);
            move || read_errors(error_output, &errors)
        })?;
        Ok(Self { requests, events, errors, errors_reader })
    }
}

fn fault(event: &Event) -> Fault {
    match event {
        Event::Line { .. } | Event::OutputClosed => Fault::Closed("its output"),
        Event::LineTooLong => Fault::Broken(format!("it wrote a line longer than {MAX_LINE_BYTES} bytes")),
        Event::InputClosed => Fault::Closed("its input"),
    }
}

fn spawn(name: &str, work: impl FnOnce() + Send + 'static) -> std::io::Result<JoinHandle<()>> {
    std::thread::Builder::new().name(name.to_owned()).spawn(work)
}

/// Reads lines until the output ends, a line is too long, or the receiver is gone.
fn read_lines(mut output: BufReader<impl Read>, events: &SyncSender<Event>) {
    loop {
        let mut line = Vec::new();
        // An error of a pipe cannot be distinguished from its end.
        let read = (&mut output).take(MAX_LINE_BYTES as u64 + 1).read_until(b'\n', &mut line).unwrap_or(0);
        let event = match read {
            0 => Event::OutputClosed,
            n if n > MAX_LINE_BYTES && line.last() != Some(&b'\n') => Event::LineTooLong,
            // The last line of an output may lack its line end.
            _ => Event::Line { text: line, is_ahead: output.buffer().contains(&b'\n') },
        };
        let is_last = !matches!(event, Event::Line { .. });
        if events.send(event).is_err() || is_last {
            return;
        }
    }
}

/// Writes lines until there are no more, or the child closes its input.
fn write_lines(mut input: impl Write, requests: &Receiver<Vec<u8>>, events: &SyncSender<Event>) {
    for line in requests {
        if input.write_all(&line).and_then(|()| input.flush()).is_err() {
            // The receiver is gone when the child is being ended.
            let _ = events.send(Event::InputClosed);
            return;
        }
    }
}

/// Reads error output until it ends, so it never blocks the child, and keeps its tail.
fn read_errors(mut output: impl Read, errors: &Mutex<Tail>) {
    let mut buffer = [0; 4096];
    while let Ok(read @ 1..) = output.read(&mut buffer) {
        errors.lock().unwrap_or_else(PoisonError::into_inner).push(buffer.get(..read).unwrap_or_default());
    }
}

/// Last bytes of a stream.
#[derive(Default)]
struct Tail {
    bytes: VecDeque<u8>,
}

impl Tail {
    const BYTES: usize = 2048;
    const LINES: usize = 3;

    fn push(&mut self, bytes: &[u8]) {
        self.bytes.extend(bytes);
        let excess = self.bytes.len().saturating_sub(Self::BYTES);
        self.bytes.drain(..excess);
    }

    /// Returns the last lines joined into one, with bytes that are not text replaced.
    fn last_lines(&mut self) -> String {
        let text = String::from_utf8_lossy(self.bytes.make_contiguous());
        let lines: Vec<&str> = text.lines().map(str::trim).filter(|line| !line.is_empty()).collect();
        let last = lines.get(lines.len().saturating_sub(Self::LINES)..).unwrap_or_default();
        harmless(&last.join(" | "))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_tail_of_a_stream_is_bounded() {
        let mut tail = Tail::default();
        for i in 0..10_000 {
            tail.push(format!("line {i}\n").as_bytes());
        }
        assert!(tail.bytes.len() <= Tail::BYTES);
        assert_eq!(tail.last_lines(), "line 9997 | line 9998 | line 9999");
    }

    #[test]
    fn bytes_that_are_not_text_are_shown_as_such() {
        let mut tail = Tail::default();
        tail.push(b"\xff\xfe");
        assert_eq!(tail.last_lines(), "\u{fffd}\u{fffd}");
    }
}
