//! A listener with a bounded number of connections; further clients wait in the queue of the operating
//! system. A connection is closed if no byte of an answer is sent on it for a minute, for instance because
//! its request is absent or never completed.

use std::io;
use std::net::SocketAddr;
use std::pin::Pin;
use std::sync::Arc;
use std::task::{Context, Poll};
use std::time::Duration;

use axum::serve::Listener;
use tokio::io::{AsyncRead, AsyncWrite, ReadBuf};
use tokio::net::{TcpListener, TcpStream};
use tokio::sync::{OwnedSemaphorePermit, Semaphore};
use tokio::time::{Instant, Sleep, sleep};

/// Limits on the clients of the server.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Bounds {
    /// Maximum number of simultaneous connections; a browser opens six per page.
    pub(crate) connections: usize,
    /// Longest time without a byte of an answer. A complete request is answered within seconds.
    pub(crate) quiet: Duration,
}

impl Default for Bounds {
    fn default() -> Self {
        Self { connections: 256, quiet: Duration::from_secs(60) }
    }
}

pub(crate) struct BoundedListener {
    listener: TcpListener,
    permits: Arc<Semaphore>,
    quiet: Duration,
}

impl BoundedListener {
    pub(crate) fn new(listener: TcpListener, bounds: Bounds) -> Self {
        Self { listener, permits: Arc::new(Semaphore::new(bounds.connections)), quiet: bounds.quiet }
    }
}

impl Listener for BoundedListener {
    type Io = Connection;
    type Addr = SocketAddr;

    async fn accept(&mut self) -> (Connection, SocketAddr) {
        // The semaphore is never closed. If it were, the connection would be accepted without a permit.
        let permit = Arc::clone(&self.permits).acquire_owned().await.ok();
        // The listener's `accept` waits until transient errors pass, such as too many open files.
        let (stream, address) = Listener::accept(&mut self.listener).await;
        // A delay of 40 ms to save a packet (Nagle's algorithm) is too long for a frame.
        let _ = stream.set_nodelay(true);
        let connection =
            Connection { stream, quiet: self.quiet, end: Box::pin(sleep(self.quiet)), _permit: permit };
        (connection, address)
    }

    fn local_addr(&self) -> io::Result<SocketAddr> {
        self.listener.local_addr()
    }
}

/// A connection that holds its permit until it is closed, or has been quiet for too long.
pub(crate) struct Connection {
    stream: TcpStream,
    quiet: Duration,
    /// Time at which the connection will have been quiet for too long.
    end: Pin<Box<Sleep>>,
    _permit: Option<OwnedSemaphorePermit>,
}

impl Connection {
    /// Returns an error once the connection has been quiet for too long. Bytes received from the client do
    /// not reset the time.
    fn poll_end(&mut self, context: &mut Context<'_>) -> io::Result<()> {
        match self.end.as_mut().poll(context) {
            Poll::Ready(()) => Err(io::ErrorKind::TimedOut.into()),
            Poll::Pending => Ok(()),
        }
    }
}

impl AsyncRead for Connection {
    fn poll_read(
        mut self: Pin<&mut Self>,
        context: &mut Context<'_>,
        buffer: &mut ReadBuf<'_>,
    ) -> Poll<io::Result<()>> {
        self.poll_end(context)?;
        Pin::new(&mut self.stream).poll_read(context, buffer)
    }
}

impl AsyncWrite for Connection {
    fn poll_write(
        mut self: Pin<&mut Self>,
        context: &mut Context<'_>,
        bytes: &[u8],
    ) -> Poll<io::Result<usize>> {
        let written = Pin::new(&mut self.stream).poll_write(context, bytes);
        match written {
            Poll::Ready(_) => {
                let end = Instant::now() + self.quiet;
                self.end.as_mut().reset(end);
            }
            // The client does not read its answer.
            Poll::Pending => self.poll_end(context)?,
        }
        written
    }

    fn poll_flush(mut self: Pin<&mut Self>, context: &mut Context<'_>) -> Poll<io::Result<()>> {
        Pin::new(&mut self.stream).poll_flush(context)
    }

    fn poll_shutdown(mut self: Pin<&mut Self>, context: &mut Context<'_>) -> Poll<io::Result<()>> {
        Pin::new(&mut self.stream).poll_shutdown(context)
    }
}

#[cfg(test)]
mod tests {
    use std::future::poll_fn;
    use std::io::Write;
    use std::sync::atomic::{AtomicBool, Ordering};

    use tokio::time::timeout;

    use super::*;

    const QUIET: Duration = Duration::from_millis(200);
    /// Longer than any operation of these tests takes on a busy machine.
    const HANGS: Duration = Duration::from_secs(30);

    async fn read_some(connection: &mut Connection) -> io::Result<()> {
        let mut bytes = [0];
        let mut buffer = ReadBuf::new(&mut bytes);
        poll_fn(|context| Pin::new(&mut *connection).poll_read(context, &mut buffer)).await
    }

    async fn write_some(connection: &mut Connection) -> io::Result<usize> {
        poll_fn(|context| Pin::new(&mut *connection).poll_write(context, &[0; 1 << 16])).await
    }

    fn with_listener<F: Future>(connections: usize, test: impl FnOnce(BoundedListener, SocketAddr) -> F) {
        let runtime = tokio::runtime::Builder::new_multi_thread().enable_all().build().unwrap();
        runtime.block_on(async {
            let listener = TcpListener::bind("127.0.0.1:0").await.unwrap();
            let address = listener.local_addr().unwrap();
            let bounds = Bounds { connections, quiet: QUIET };
            timeout(HANGS, test(BoundedListener::new(listener, bounds), address)).await.unwrap();
        });
    }

    #[test]
    fn a_connection_over_the_bound_waits_until_another_is_closed() {
        with_listener(2, async |mut listener, address| {
            let clients: Vec<_> = (0..3).map(|_| std::net::TcpStream::connect(address).unwrap()).collect();
            let (first, _) = listener.accept().await;
            let (_second, _) = listener.accept().await;
            assert!(timeout(QUIET, listener.accept()).await.is_err());
            drop(first);
            let (_third, _) = listener.accept().await;
            drop(clients);
        });
    }

    #[test]
    fn an_idle_or_very_slow_connection_is_closed() {
        with_listener(1, async |mut listener, address| {
            let idle = std::net::TcpStream::connect(address).unwrap();
            let (mut connection, _) = listener.accept().await;
            let error = read_some(&mut connection).await.unwrap_err();
            assert_eq!(error.kind(), io::ErrorKind::TimedOut);
            drop((connection, idle));

            let mut slow = std::net::TcpStream::connect(address).unwrap();
            let ended = Arc::new(AtomicBool::new(false));
            let has_ended = Arc::clone(&ended);
            let drip = std::thread::spawn(move || {
                while !has_ended.load(Ordering::Relaxed) && slow.write_all(b"X").is_ok() {
                    std::thread::sleep(QUIET / 20);
                }
            });
            let (mut connection, _) = listener.accept().await;
            let error = loop {
                if let Err(error) = read_some(&mut connection).await {
                    break error;
                }
            };
            assert_eq!(error.kind(), io::ErrorKind::TimedOut);
            ended.store(true, Ordering::Relaxed);
            drip.join().unwrap();
        });
    }

    #[test]
    fn a_client_that_does_not_take_its_answer_is_given_up_and_one_that_does_is_not() {
        with_listener(1, async |mut listener, address| {
            let client = std::net::TcpStream::connect(address).unwrap();
            let (mut connection, _) = listener.accept().await;
            // Sent answers keep the connection open for longer than `QUIET`; this number of answers fits into
            // the buffers of the operating system.
            for _ in 0..6 {
                sleep(QUIET / 4).await;
                write_some(&mut connection).await.unwrap();
            }
            let error = loop {
                if let Err(error) = write_some(&mut connection).await {
                    break error;
                }
            };
            assert_eq!(error.kind(), io::ErrorKind::TimedOut);
            drop(client);
        });
    }
}
