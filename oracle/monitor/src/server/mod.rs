//! The server: provides any frame by its number and keeps no state of its clients.

pub(crate) mod assets;
pub(crate) mod guard;
pub(crate) mod listener;
pub(crate) mod overview;
use std::future::Future;
use std::net::SocketAddr;
use std::sync::Arc;
use std::time::Duration;

use axum::Router;
use axum::body::{Body, Bytes};
use axum::extract::{Path, Request, State};
use axum::http::header::{self, HeaderName, HeaderValue};
use axum::http::{StatusCode, Uri};
use axum::middleware::{self, Next};
use axum::response::{IntoResponse, Response};
use axum::routing::get;
use files::Failure;
use hifitime::Epoch;
use serde::Serialize;
use tokio::net::TcpListener;
use tokio::time::timeout;

use crate::feed::Feed;
use crate::ground::GroundTrack;
use crate::server::assets::asset;
use crate::server::guard::{Admission, Guard};
use crate::server::listener::{BoundedListener, Bounds};
use crate::server::overview::Overview;
use crate::session::painter::paint;
use crate::session::{PictureAnswer, Session};

/// Longest time that a request waits for a frame that is not yet processed, before the answer requests a
/// retry.
const MAX_WAIT: Duration = Duration::from_secs(5);
/// Time allowed for connections to end when the monitor stops.
const SHUTDOWN_TIME: Duration = Duration::from_secs(1);
/// Number of threads that draw pictures again.
const PAINTERS: usize = 2;

/// Headers of every answer. The page needs only its own files, and no other page may frame or read it.
const HEADERS: [(HeaderName, &str); 6] = [
    (
        header::CONTENT_SECURITY_POLICY,
        "default-src 'self'; object-src 'none'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'",
    ),
    (header::X_CONTENT_TYPE_OPTIONS, "nosniff"),
    (header::REFERRER_POLICY, "no-referrer"),
    (HeaderName::from_static("cross-origin-resource-policy"), "same-origin"),
    (HeaderName::from_static("cross-origin-opener-policy"), "same-origin"),
    (header::CACHE_CONTROL, "no-store"),
];

/// Serves the page of `monitored` at `bind` until `stop`; `ready` receives the address. Separate threads
/// simulate and process frames, or read them, as far as the page requests them.
///
/// # Errors
/// A [`Failure`] when the address cannot be bound, a run directory cannot be read, or there are too many
/// frames.
pub fn serve(
    monitored: &Feed,
    bind: SocketAddr,
    ready: impl FnOnce(SocketAddr),
    stop: impl Future<Output = ()> + Send + 'static,
) -> Result<(), Failure> {
    let Feed { world, measurements } = monitored;
    let context = world.context(measurements)?;
    let overview = Overview::from_feed(monitored, &context)?;
    let session = Arc::new(Session::new(context.frames.clone()));
    let shared = Arc::new(ServerState {
        overview,
        ground: context.ground.clone(),
        times: context.frames.clone().filter_map(|frame| world.time(frame)).collect(),
        first: context.frames.start,
        session: Arc::clone(&session),
    });
    // A failed thread reports its failure to the page, unless the session is already closed.
    let publish_failure = |result: Result<(), Failure>| {
        if let Err(failure) = result
            && !session.is_closed()
        {
            session.fail(failure.to_string());
        }
    };
    std::thread::scope(|scope| {
        scope.spawn(|| publish_failure(world.feed(measurements, &context, &session)));
        for _ in 0..PAINTERS {
            scope.spawn(|| publish_failure(paint(monitored, &context, &session)));
        }
        let served = answer_requests(&shared, bind, ready, stop);
        session.close();
        served
    })
}

/// Data shared by all requests.
struct ServerState {
    overview: Overview,
    ground: Option<GroundTrack>,
    times: Vec<Epoch>,
    first: u64,
    session: Arc<Session>,
}

fn answer_requests(
    shared: &Arc<ServerState>,
    bind: SocketAddr,
    ready: impl FnOnce(SocketAddr),
    stop: impl Future<Output = ()> + Send + 'static,
) -> Result<(), Failure> {
    let runtime = tokio::runtime::Builder::new_multi_thread()
        .worker_threads(2)
        .enable_all()
        .build()
        .map_err(|error| Failure::Usage(format!("the server's threads cannot be started: {error}")))?;
    let served = runtime.block_on(async {
        let refused =
            |error| Failure::Usage(format!("--bind is {bind}, expected a free address and port: {error}"));
        let listener = TcpListener::bind(bind).await.map_err(refused)?;
        let address = listener.local_addr().map_err(refused)?;
        ready(address);
        let (session, (ended, end)) = (Arc::clone(&shared.session), tokio::sync::oneshot::channel::<()>());
        let goodbye = async move {
            stop.await;
            session.close();
            // The receiver is gone if the server has already ended by itself.
            let _ = ended.send(());
        };
        let service = router(Arc::clone(shared), Guard::new(address));
        let server = axum::serve(BoundedListener::new(listener, Bounds::default()), service)
            .with_graceful_shutdown(goodbye);
        // Does not wait for clients that keep their connections open.
        tokio::select! {
            result = server.into_future() => {
                result.map_err(|error| Failure::Usage(format!("the server ended: {error}")))
            }
            () = async { let _ = end.await; tokio::time::sleep(SHUTDOWN_TIME).await } => Ok(()),
        }
    });
    runtime.shutdown_timeout(SHUTDOWN_TIME);
    served
}

fn router(shared: Arc<ServerState>, guard: Guard) -> Router {
    Router::new()
        .route("/api/session.json", get(session))
        .route("/api/scene.json", get(scene))
        .route("/api/progress.json", get(progress))
        .route("/api/history.json", get(history))
        .route("/api/frames/{file}", get(frame))
        .route("/api/ground/{file}", get(ground))
        .fallback(page)
        .with_state(shared)
        .layer(middleware::from_fn_with_state(guard, check))
}

/// Refuses requests that are not for this server or not from its page, and sets the headers of all answers.
async fn check(State(guard): State<Guard>, request: Request, next: Next) -> Response {
    let mut response = match guard.admits(request.uri().path(), request.headers()) {
        Admission::Granted => next.run(request).await,
        Admission::OtherHost => (
            StatusCode::MISDIRECTED_REQUEST,
            "unknown host: open the page by the address that the monitor printed\n",
        )
            .into_response(),
        Admission::OtherPage => {
            (StatusCode::FORBIDDEN, "requests from other pages are rejected\n").into_response()
        }
    };
    for (name, value) in HEADERS {
        response.headers_mut().insert(name, HeaderValue::from_static(value));
    }
    response
}

/// Returns a file of the page by its exact name.
async fn page(uri: Uri, request: Request) -> Response {
    if request.method() != axum::http::Method::GET && request.method() != axum::http::Method::HEAD {
        return StatusCode::METHOD_NOT_ALLOWED.into_response();
    }
    let name = match uri.path() {
        "/" => "index.html",
        path => path.trim_start_matches('/'),
    };
    match asset(name) {
        Some((data, kind)) => ([(header::CONTENT_TYPE, kind)], Body::from(data)).into_response(),
        None => (StatusCode::NOT_FOUND, "no such file\n").into_response(),
    }
}

fn json(bytes: Bytes) -> Response {
    ([(header::CONTENT_TYPE, "application/json")], bytes).into_response()
}

fn document(status: StatusCode, value: &impl Serialize) -> Response {
    match serde_json::to_vec(value) {
        Ok(bytes) => (status, json(bytes.into())).into_response(),
        Err(error) => (StatusCode::INTERNAL_SERVER_ERROR, error.to_string()).into_response(),
    }
}

async fn session(State(shared): State<Arc<ServerState>>) -> Response {
    json(shared.overview.session.clone())
}

async fn scene(State(shared): State<Arc<ServerState>>) -> Response {
    json(shared.overview.scene.clone())
}

async fn progress(State(shared): State<Arc<ServerState>>) -> Response {
    document(StatusCode::OK, &shared.session.progress())
}

async fn history(State(shared): State<Arc<ServerState>>) -> Response {
    document(StatusCode::OK, &shared.session.history())
}

/// Returns the ground track around the time of a frame: longitude and latitude, degrees.
async fn ground(State(shared): State<Arc<ServerState>>, Path(file): Path<String>) -> Response {
    let number = file.strip_suffix(".json").and_then(|number| number.parse::<u64>().ok());
    let index = number.and_then(|number| usize::try_from(number.checked_sub(shared.first)?).ok());
    match index.and_then(|index| shared.times.get(index)) {
        Some(time) => {
            let path = shared.ground.as_ref().map(|track| track.path(*time)).unwrap_or_default();
            document(StatusCode::OK, &path)
        }
        None => not_a_frame(),
    }
}

/// Returns `N.json`, the report of a frame, or `N.gray`, its picture with one byte per pixel, row by row.
async fn frame(State(shared): State<Arc<ServerState>>, Path(file): Path<String>) -> Response {
    let Some((number, kind)) = file.split_once('.') else { return not_a_frame() };
    let Some(number) = number.parse().ok().filter(|number| shared.session.contains(*number)) else {
        return not_a_frame();
    };
    match kind {
        "json" => report(&shared.session, number).await,
        "gray" => picture(&shared.session, number).await,
        _ => not_a_frame(),
    }
}

async fn report(session: &Session, frame: u64) -> Response {
    if is_processed(session, frame).await
        && let Some(report) = session.report(frame)
    {
        return json(report);
    }
    not_yet(session)
}

async fn picture(session: &Session, frame: u64) -> Response {
    let grey = |bytes: Bytes| ([(header::CONTENT_TYPE, "application/octet-stream")], bytes).into_response();
    if !is_processed(session, frame).await {
        return not_yet(session);
    }
    match session.picture(frame) {
        PictureAnswer::Ready(picture) => grey(picture),
        PictureAnswer::Ordered(promise) => match timeout(MAX_WAIT, promise).await {
            Ok(Ok(picture)) => grey(picture),
            _ => not_yet(session),
        },
        PictureAnswer::NotYet | PictureAnswer::Busy => not_yet(session),
    }
}

/// Waits for a frame up to a time limit; returns true if the frame is processed.
async fn is_processed(session: &Session, frame: u64) -> bool {
    session.request(frame);
    let mut processed = session.subscribe();
    let arrived = async {
        loop {
            if *processed.borrow_and_update() > frame {
                return true;
            }
            let ended = session.is_closed() || session.progress().failure.is_some();
            if ended || processed.changed().await.is_err() {
                return false;
            }
        }
    };
    timeout(MAX_WAIT, arrived).await.unwrap_or(false)
}

/// Returns the progress of the run with a request to retry, or an error if the run has failed. A frame that
/// is not yet processed is no error, because a browser would log each.
fn not_yet(session: &Session) -> Response {
    let progress = session.progress();
    if progress.failure.is_some() {
        return document(StatusCode::INTERNAL_SERVER_ERROR, &progress);
    }
    let mut response = document(StatusCode::ACCEPTED, &progress);
    response.headers_mut().insert(header::RETRY_AFTER, HeaderValue::from_static("1"));
    response
}

fn not_a_frame() -> Response {
    (StatusCode::NOT_FOUND, "no such frame\n").into_response()
}
