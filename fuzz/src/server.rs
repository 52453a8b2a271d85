//! Fuzz target for the monitor's server.

use std::io::{Read, Write};
use std::net::{Shutdown, SocketAddr, TcpStream};
use std::path::Path;
use std::sync::{OnceLock, mpsc};
use std::time::Duration;

use boresight::monitor::{Feed, Measurements, serve};
use boresight::pipeline_choice::PipelineChoice;
use boresight::run::{Options, ScenarioSource};

use crate::Sandbox;

/// Placeholder in an input for the address of the server, which differs in every run.
const ADDRESS: &[u8] = b"@@";
/// Read timeout, longer than any response takes.
const PATIENCE: Duration = Duration::from_secs(20);

/// Sends bytes to the server and checks that the response is empty or begins as an HTTP response.
pub(crate) fn http(_: &Sandbox, bytes: &[u8]) {
    let address = address();
    let Ok(mut stream) = TcpStream::connect(address) else { return };
    let _ = stream.set_read_timeout(Some(PATIENCE));
    // A server that has received enough closes the connection while more bytes are being sent.
    let _ = stream.write_all(&addressed(bytes, address));
    let _ = stream.shutdown(Shutdown::Write);
    let mut answer = Vec::new();
    let _ = stream.read_to_end(&mut answer);
    assert!(answer.is_empty() || answer.starts_with(b"HTTP/1."), "{}", String::from_utf8_lossy(&answer));
    let lower = answer.to_ascii_lowercase();
    let has = |text: &[u8]| lower.windows(text.len()).any(|window| window == text);
    assert!(!has(b"access-control-allow"), "the response can be read by other pages");
}

fn addressed(bytes: &[u8], address: SocketAddr) -> Vec<u8> {
    let address = address.to_string();
    let mut whole = Vec::with_capacity(bytes.len() + address.len());
    let mut rest = bytes;
    while let Some((&first, others)) = rest.split_first() {
        if let Some(after) = rest.strip_prefix(ADDRESS) {
            whole.extend_from_slice(address.as_bytes());
            rest = after;
        } else {
            whole.push(first);
            rest = others;
        }
    }
    whole
}

/// Starts a monitor of two fields on the first call and returns its address.
#[expect(clippy::expect_used, reason = "without a server no input is tested, and the run must not pass")]
fn address() -> SocketAddr {
    static ADDRESS: OnceLock<SocketAddr> = OnceLock::new();
    *ADDRESS.get_or_init(|| {
        let (told, address) = mpsc::channel();
        std::thread::spawn(move || {
            let ready = move |address| told.send(address).expect("the caller waits for the address");
            let bind = SocketAddr::from(([127, 0, 0, 1], 0));
            serve(&docking(), bind, ready, std::future::pending()).expect("the monitor serves")
        });
        address.recv().expect("the monitor is bound")
    })
}

#[expect(clippy::expect_used, reason = "built-in text, independent of the input")]
fn docking() -> Feed {
    let source = ScenarioSource::read("docking").expect("a built-in scenario");
    let choice = PipelineChoice { word: None, timeout_s: 1.0, memory_mb: 2048, sandbox: None };
    let prepared = source.prepare(Options::default()).expect("a built-in scenario");
    let factory = prepared.factory(&choice, Path::new("")).expect("the built-in pipeline");
    let measurements = Measurements::Live { factory, frames: 24000..24002, jobs: 1 };
    Feed::new(prepared, measurements).expect("a world of the page")
}
