//! `boresight monitor`: answers of the server, its access rules, and its survival of faulty clients. Without
//! a browser.

use std::io::{Read, Write};
use std::net::{Shutdown, SocketAddr, TcpStream};
use std::sync::mpsc;
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

use boresight::far_range::rows::FrameTruthRow;
use boresight::files::{TableReader, TableWriter};
use boresight::monitor::{Feed, Measurements, serve};
use boresight::pipeline_choice::PipelineChoice;
use boresight::run::{Options, ScenarioSource};
use serde_json::Value;

use crate::support::Bench;

/// Longer than the monitor takes on a busy machine for any request in this suite.
const HANGS: Duration = Duration::from_secs(60);

/// A monitor that runs on a separate thread until it is dropped.
struct Monitor {
    address: SocketAddr,
    stop: Option<tokio::sync::oneshot::Sender<()>>,
    thread: Option<JoinHandle<Result<(), String>>>,
}

impl Monitor {
    fn start(feed: impl FnOnce() -> Feed + Send + 'static) -> Self {
        let (told, address) = mpsc::channel();
        let (stop, stopped) = tokio::sync::oneshot::channel();
        let thread = std::thread::spawn(move || {
            let ready = |address| told.send(address).unwrap();
            let stop = async {
                let _ = stopped.await;
            };
            serve(&feed(), "127.0.0.1:0".parse().unwrap(), ready, stop).map_err(|error| error.to_string())
        });
        let address = address.recv_timeout(HANGS).unwrap();
        Self { address, stop: Some(stop), thread: Some(thread) }
    }

    fn docking(frames: std::ops::Range<u64>) -> Self {
        Self::start(move || live("docking", frames))
    }

    /// Sends raw bytes, and reads the answer until the server closes the connection.
    fn raw(&self, request: &[u8]) -> Vec<u8> {
        let mut stream = TcpStream::connect(self.address).unwrap();
        stream.set_read_timeout(Some(HANGS)).unwrap();
        // A server that has received enough closes the connection while garbage is still being sent.
        let _ = stream.write_all(request);
        let mut answer = Vec::new();
        let _ = stream.read_to_end(&mut answer);
        answer
    }

    fn request(&self, method: &str, path: &str, headers: &str) -> Answer {
        let request = format!("{method} {path} HTTP/1.1\r\nConnection: close\r\n{headers}\r\n");
        Answer::parse(&self.raw(request.as_bytes()))
    }

    fn get(&self, path: &str) -> Answer {
        self.request("GET", path, &format!("Host: {}\r\n", self.address))
    }

    /// Returns the body of a successful answer.
    fn body(&self, path: &str) -> Vec<u8> {
        let answer = self.get(path);
        assert_eq!(answer.status, 200, "{path}: {}", String::from_utf8_lossy(&answer.body));
        answer.body
    }

    fn json(&self, path: &str) -> Value {
        serde_json::from_slice(&self.body(path)).unwrap()
    }

    /// Checks that the server still answers.
    fn check_alive(&self) {
        assert_eq!(self.get("/api/progress.json").status, 200);
    }
}

impl Drop for Monitor {
    fn drop(&mut self) {
        drop(self.stop.take());
        let ended = self.thread.take().unwrap().join();
        if !std::thread::panicking() {
            ended.unwrap().unwrap();
        }
    }
}

struct Answer {
    status: u16,
    head: String,
    body: Vec<u8>,
}

impl Answer {
    fn parse(bytes: &[u8]) -> Self {
        let end = bytes.windows(4).position(|window| window == b"\r\n\r\n");
        let end = end.unwrap_or_else(|| panic!("no answer: {}", String::from_utf8_lossy(bytes)));
        let head = String::from_utf8(bytes[..end].to_vec()).unwrap().to_lowercase();
        let status = head.split(' ').nth(1).unwrap().parse().unwrap();
        Self { status, head, body: bytes[end + 4..].to_vec() }
    }
}

/// Feed of a built-in scenario, run with its built-in pipeline.
fn live(name: &str, frames: std::ops::Range<u64>) -> Feed {
    boresight::register_worlds();
    let source = ScenarioSource::read(name).unwrap();
    let choice = PipelineChoice { word: None, timeout_s: 1.0, memory_mb: 4000, sandbox: None };
    let scratch = std::env::temp_dir();
    let prepared = source.prepare(Options::default()).unwrap();
    let factory = prepared.factory(&choice, &scratch).unwrap();
    Feed::new(prepared, Measurements::Live { factory, frames, jobs: 1 }).unwrap()
}

fn replay(directory: std::path::PathBuf) -> Feed {
    boresight::register_worlds();
    let source = ScenarioSource::read(&directory.join("run.toml").to_string_lossy()).unwrap();
    Feed::new(source.prepare(Options::default()).unwrap(), Measurements::Replay(directory)).unwrap()
}

/// Checks that every number in both a row of the run and the report is the same; angles of a replay have been
/// converted twice.
fn check_parameters(report: &Value, row: &std::collections::BTreeMap<String, String>) {
    assert_eq!(report["status"], row["status"].as_str());
    let mut compared = 0;
    for parameter in report["parameters"].as_array().unwrap() {
        let name = parameter["name"].as_str().unwrap();
        for (column, value) in
            [(name.to_owned(), &parameter["measured"]), (format!("sigma_{name}"), &parameter["sigma"])]
        {
            let Some(cell) = row.get(&column).filter(|cell| !cell.is_empty()) else { continue };
            let (expected, got): (f64, f64) = (cell.parse().unwrap(), value.as_f64().unwrap_or(f64::NAN));
            let scale = expected.abs().max(1e-300);
            assert!(
                (got - expected).abs() <= 4.0 * f64::EPSILON * scale,
                "{column}: {got}, expected {expected}"
            );
            compared += 1;
        }
    }
    assert!(compared >= if row["status"] == "measured" || row["status"] == "detected" { 6 } else { 0 });
}

#[test]
fn a_live_docking_run_has_the_measurements_of_the_run_and_shows_its_pictures() {
    let bench = Bench::new();
    bench.boresight("run docking --frames 24000..24030 --out run").done();
    let monitor = Monitor::docking(24000..24030);
    for row in bench.csv("run/measurements.csv") {
        let report = monitor.json(&format!("/api/frames/{}.json", row["field"]));
        check_parameters(&report, &row);
    }
    let report = monitor.json("/api/frames/24029.json");
    let pixels = report["image"]["columns"].as_u64().unwrap() * report["image"]["rows"].as_u64().unwrap();
    assert_eq!(monitor.body("/api/frames/24029.gray").len() as u64, pixels);
}

#[test]
fn a_far_range_replay_shows_the_measurements_of_the_run_and_the_pictures_of_its_frames() {
    let bench = Bench::new();
    bench.boresight("run argon --frames 9000..9006 --out run").done();
    let directory = bench.path("run");
    let replayed = Monitor::start(move || replay(directory));
    let live = Monitor::start(|| live("argon", 9000..9006));
    for row in bench.csv("run/measurements.csv") {
        let frame = &row["frame"];
        let path = format!("/api/frames/{frame}.json");
        check_parameters(&replayed.json(&path), &row);
        check_parameters(&live.json(&path), &row);
        assert_eq!(replayed.json(&path)["overlay"], live.json(&path)["overlay"], "frame {frame}");
        let picture = format!("/api/frames/{frame}.gray");
        assert!(replayed.body(&picture) == live.body(&picture), "frame {frame}");
    }
    assert_eq!(replayed.json("/api/session.json")["mode"], "replay");
}

/// The largest possible frame number, which has no successor, and a changed table of measurements.
#[test]
fn a_run_that_is_damaged_is_not_replayed() {
    let bench = Bench::new();
    bench.boresight("run argon --frames 9000..9003 --no-report --out run").done();
    let refused = || {
        let address = "127.0.0.1:0".parse().unwrap();
        let served =
            serve(&replay(bench.path("run")), address, |_| panic!("it is served"), std::future::pending());
        served.unwrap_err().to_string()
    };
    let answers = bench.read("run/measurements.csv");
    bench.write("run/measurements.csv", answers.replacen("detected", "detecter", 1));
    let message = refused();
    assert!(message.contains("measurements.csv") && message.contains("SHA-256"), "{message}");
    bench.write("run/measurements.csv", answers);
    bench.unseal("run");
    let path = bench.path("run/truth/frames.parquet");
    let (_, mut truth) = TableReader::<FrameTruthRow>::open(&path).unwrap().next().unwrap().unwrap();
    truth[0].0.frame = u64::MAX;
    std::fs::remove_file(&path).unwrap();
    let mut table = TableWriter::create(&path).unwrap();
    table.write(truth).unwrap();
    table.finish().unwrap();
    assert!(refused().contains("frame is 18446744073709551615"), "{}", refused());
}

#[test]
fn a_docking_replay_draws_the_fields_as_they_were_digitised() {
    let bench = Bench::new();
    bench.boresight("run docking --frames 20000..20020 --out run").done();
    let directory = bench.path("run");
    let replayed = Monitor::start(move || replay(directory));
    let live = Monitor::docking(20000..20020);
    for row in bench.csv("run/measurements.csv") {
        let (report, picture) =
            (format!("/api/frames/{}.json", row["field"]), format!("/api/frames/{}.gray", row["field"]));
        check_parameters(&replayed.json(&report), &row);
        assert_eq!(replayed.json(&report)["overlay"], live.json(&report)["overlay"]);
        assert!(replayed.body(&picture) == live.body(&picture), "field {}", row["field"]);
    }
}

#[test]
fn only_requests_to_the_own_address_from_the_own_page_are_answered() {
    let monitor = Monitor::docking(24000..24002);
    let own = monitor.address;
    let status = |headers: String| monitor.request("GET", "/api/progress.json", &headers).status;
    assert_eq!(status(format!("Host: {own}\r\nOrigin: http://{own}\r\n")), 200);
    assert_eq!(status(format!("Host: localhost:{}\r\n", own.port())), 200);
    assert_eq!(status(format!("Host: evil.example:{}\r\n", own.port())), 421);
    assert_eq!(status("Host: 127.0.0.1\r\n".to_owned()), 421);
    assert_eq!(status("Host: \u{e9}\r\n".to_owned()), 421);
    assert_eq!(status(format!("Host: {own}\r\nOrigin: http://evil.example\r\n")), 403);
    assert_eq!(status(format!("Host: {own}\r\nOrigin: null\r\n")), 403);
    let two = format!("Host: {own}\r\nHost: evil.example\r\n");
    assert!([400, 421].contains(&status(two)));
    assert!([400, 421].contains(&status(String::new())));
    for host in [
        format!("localhost.:{}", own.port()),
        format!("[::1]:{}", own.port()),
        format!("{own}.evil.example"),
        format!("user@{own}"),
        format!("{own}:{}", own.port()),
    ] {
        assert!([400, 421].contains(&status(format!("Host: {host}\r\n"))), "{host}");
    }
    // A request embedded in another page has no origin header.
    assert_eq!(status(format!("Host: {own}\r\nSec-Fetch-Site: same-origin\r\n")), 200);
    for site in ["cross-site", "same-site"] {
        assert_eq!(status(format!("Host: {own}\r\nSec-Fetch-Site: {site}\r\n")), 403);
    }
}

#[test]
fn every_answer_forbids_other_pages_to_read_frame_or_guess_it() {
    let monitor = Monitor::docking(24000..24002);
    let refused = monitor.request("GET", "/", "Host: evil.example\r\n");
    assert_eq!(refused.status, 421);
    let frame = monitor.get("/api/frames/24000.gray");
    for answer in
        [refused, frame, monitor.get("/"), monitor.get("/api/session.json"), monitor.get("/nothing")]
    {
        let head = &answer.head;
        let policy = head.lines().find_map(|line| line.strip_prefix("content-security-policy: ")).unwrap();
        assert!(
            policy.contains("default-src 'self'") && policy.contains("frame-ancestors 'none'"),
            "{policy}"
        );
        assert!(!policy.contains("unsafe"), "{policy}");
        for line in [
            "x-content-type-options: nosniff",
            "cross-origin-resource-policy: same-origin",
            "cross-origin-opener-policy: same-origin",
            "referrer-policy: no-referrer",
            "cache-control: no-store",
        ] {
            assert!(head.lines().any(|found| found == line), "{line}: {head}");
        }
        assert!(!head.contains("access-control"), "{head}");
    }
}

#[test]
fn headers_without_end_are_refused_with_their_status() {
    let monitor = Monitor::docking(24000..24002);
    let own = monitor.address;
    let many = "X: y\r\n".repeat(10_000);
    let long = format!("X: {}\r\n", "y".repeat(1 << 20));
    for headers in [many, long] {
        let answer = monitor.raw(format!("GET / HTTP/1.1\r\nHost: {own}\r\n{headers}\r\n").as_bytes());
        // The server either reports the error, or closes the connection while the remainder is still being
        // sent, and the answer is lost with it.
        let said = String::from_utf8_lossy(&answer[..answer.len().min(12)]).into_owned();
        assert!(said.is_empty() || said == "HTTP/1.1 431", "{said}");
    }
    monitor.check_alive();
}

#[test]
fn idle_connections_do_not_block_others() {
    let monitor = Monitor::docking(24000..24002);
    // Nearly all available connections.
    let idle: Vec<_> = (0..200).map(|_| TcpStream::connect(monitor.address).unwrap()).collect();
    let slow: Vec<_> = (0..40)
        .map(|_| {
            let mut stream = TcpStream::connect(monitor.address).unwrap();
            stream.write_all(b"GET / HTTP/1.1\r\nHo").unwrap();
            stream
        })
        .collect();
    monitor.check_alive();
    drop((idle, slow));
}

#[test]
fn no_path_reaches_the_file_system() {
    let monitor = Monitor::docking(24000..24002);
    for path in [
        "/../Cargo.toml",
        "/%2e%2e/Cargo.toml",
        "//etc/passwd",
        "/etc/passwd",
        "/monitor.js/../../package.json",
        "/..%2fpackage.json",
        "/.gitignore",
        "/api/frames/../../Cargo.toml",
        "/api/frames/24000.json%00",
        "/api/frames/24000.png",
        "/api/frames/-1.json",
        "/api/frames/23999.json",
        "/api/frames/24002.gray",
        "/api/frames/18446744073709551616.json",
        "/api/ground/0.json",
        "/api/ground/24000",
        "/api/",
    ] {
        assert_eq!(monitor.get(path).status, 404, "{path}");
    }
    for method in ["POST", "PUT", "DELETE", "OPTIONS", "BREW"] {
        let headers = format!("Host: {}\r\nContent-Length: 0\r\n", monitor.address);
        for path in ["/", "/api/progress.json"] {
            assert_eq!(monitor.request(method, path, &headers).status, 405, "{method} {path}");
        }
    }
}

#[test]
fn garbage_is_survived() {
    let monitor = Monitor::docking(24000..24002);
    let mut noise: u32 = 1;
    let random: Vec<u8> = (0..100_000)
        .map(|_| {
            noise = noise.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            (noise >> 24) as u8
        })
        .collect();
    let endless = [b"GET / HTTP/1.1\r\nHost: ".as_slice(), &[b'a'; 1_000_000]].concat();
    let many = format!("GET / HTTP/1.1\r\n{}\r\n", "X: y\r\n".repeat(10_000));
    for garbage in [
        &random,
        &endless,
        &many.into_bytes(),
        &b"\0\0\0\0\r\n\r\n".to_vec(),
        &b"\x16\x03\x01\x02\x00\x01\x00\x01\xfc\x03\x03".to_vec(),
        &b"GET / HTTP/9.9\r\n\r\n".to_vec(),
        &b"PRI * HTTP/2.0\r\n\r\nSM\r\n\r\n".to_vec(),
        &b"GET http://evil.example/ HTTP/1.1\r\nConnection: close\r\n\r\n".to_vec(),
    ] {
        let mut stream = TcpStream::connect(monitor.address).unwrap();
        let _ = stream.write_all(garbage);
        let _ = stream.shutdown(Shutdown::Write);
        monitor.check_alive();
    }
}

#[test]
fn clients_that_leave_in_the_middle_are_survived() {
    let monitor = Monitor::docking(24000..24400);
    for i in 0..200 {
        let mut stream = TcpStream::connect(monitor.address).unwrap();
        let number = 24000 + 2 * i;
        let kind = if i % 2 == 0 { "gray" } else { "json" };
        write!(stream, "GET /api/frames/{number}.{kind} HTTP/1.1\r\nHost: {}\r\n\r\n", monitor.address)
            .unwrap();
        if i % 3 == 0 {
            let _ = stream.read(&mut [0; 100]);
        }
    }
    monitor.check_alive();
}

#[test]
fn ten_clients_are_served_the_same_at_the_same_time() {
    let monitor = Monitor::docking(24000..24020);
    let answers: Vec<Vec<Vec<u8>>> = std::thread::scope(|scope| {
        let client = |first: u64| {
            let monitor = &monitor;
            // Each client begins at a different frame, and no two are ever at the same frame.
            let path = move |i: u64| format!("/api/frames/{}.gray", 24000 + (first + i) % 20);
            move || (0..20).map(|i| monitor.body(&path(i))).collect::<Vec<_>>()
        };
        let clients: Vec<_> = (0..10).map(|first| scope.spawn(client(2 * first))).collect();
        clients.into_iter().map(|client| client.join().unwrap()).collect()
    });
    for (first, pictures) in answers.iter().enumerate() {
        for (i, picture) in pictures.iter().enumerate() {
            let same = &answers[0][(2 * first + i) % 20];
            assert!(picture == same && !picture.is_empty(), "client {first}, picture {i}");
        }
    }
}

#[test]
fn a_page_that_is_left_alone_leaves_the_processor_alone() {
    let monitor = Monitor::docking(24000..25000);
    monitor.json("/api/frames/24000.json");
    let processed = || monitor.json("/api/progress.json")["processed"].as_u64().unwrap();
    let deadline = Instant::now() + HANGS;
    // 120 frames ahead of the requested frame; the frame that waits there is not counted.
    while processed() < 24121 {
        assert!(Instant::now() < deadline, "{}", processed());
        std::thread::sleep(Duration::from_millis(20));
    }
    std::thread::sleep(Duration::from_millis(300));
    assert_eq!(processed(), 24121);
}

#[test]
fn the_page_is_served_with_the_licences_of_its_packages() {
    let monitor = Monitor::docking(24000..24002);
    for (path, part) in [
        ("/", "src=\"monitor.js\""),
        ("/monitor.js", "api/"),
        ("/monitor.css", "{"),
        ("/icon.svg", "<svg"),
        ("/licences.txt", "three"),
    ] {
        let text = String::from_utf8(monitor.body(path)).unwrap();
        assert!(text.contains(part), "`{part}` in {path}: {text:.200}");
    }
}

#[test]
fn mistakes_are_reported_before_anything_is_served() {
    let bench = Bench::new();
    bench.write("empty/nothing", "");
    for (words, expected) in [
        ("monitor nowhere", "nowhere"),
        ("monitor empty", "run.toml"),
        ("monitor docking --from 25169", "--from is 25169"),
        ("monitor docking --frames 5..99999", "--frames is 5..99999"),
        ("monitor docking --bind everywhere", "everywhere"),
        ("monitor docking --from 3 --frames 0..5", "--frames"),
        ("monitor docking --pipeline far_range", "far_range"),
    ] {
        bench.boresight(words).refused(&[expected]);
    }
    bench.boresight("run docking --frames 24000..24002 --out run").done();
    bench.boresight("monitor run --from 24001").refused(&["--from", "replayed unchanged"]);
    for table in ["measurements.csv", "truth/fields.parquet"] {
        std::fs::remove_file(bench.path("run").join(table)).unwrap();
        let told = format!("run: has run.toml but no {table}");
        bench.boresight("monitor run").refused(&[&told, "still in progress", "monitor SCENARIO"]);
    }
}

#[test]
fn a_built_in_scenario_is_itself_beside_a_folder_of_its_name() {
    let bench = Bench::new();
    bench.write("docking/nothing", "");
    bench.boresight("monitor docking --from 25169").refused(&["--from is 25169"]);
    bench.boresight("monitor ./docking").refused(&["./docking", "run.toml"]);
}

#[test]
fn of_the_true_positions_that_of_the_target_has_a_name() {
    let monitor = Monitor::start(|| live("argon", 145..146));
    let report = monitor.json("/api/frames/145.json");
    let labels = report["truth_overlay"].as_array().unwrap().iter();
    let named: Vec<_> = labels.filter_map(|shape| Some((&shape["kind"], shape["label"].as_str()?))).collect();
    assert_eq!(named, [(&Value::from("truth target"), "target")]);
}

#[test]
fn the_page_marks_the_beginning_of_each_day() {
    let monitor = Monitor::start(|| live("argon", 0..1));
    let session = monitor.json("/api/session.json");
    let begins: Vec<u64> =
        session["begins"].as_array().unwrap().iter().map(|n| n.as_u64().unwrap()).collect();
    assert_eq!(begins.first(), Some(&0));
    assert_eq!(begins.len(), 5);
    assert_eq!(session["plan"]["points"][0][0], 0);
    assert_eq!(Monitor::docking(24000..24002).json("/api/session.json")["begins"], serde_json::json!([]));
}
