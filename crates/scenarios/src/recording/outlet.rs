//! Where live data go: a viewer that listens, or a server that viewers ask.

use std::net::{Ipv4Addr, TcpListener};
use std::str::FromStr;
use std::sync::Arc;
use std::time::Duration;

use rerun::external::re_uri::ProxyUri;
use rerun::grpc_server::GrpcServerSink;
use rerun::log::LogMsg;
use rerun::sink::{GrpcSink, GrpcSinkConnectionState, LogSink};

use super::RecordingError;

/// Whether an outlet takes messages.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum OutletState {
    /// Nobody there yet.
    Waiting,
    /// Somebody listens.
    Open,
    /// Nobody will come any more.
    Closed,
}

/// A receiver of messages that may be slow, absent or gone; only its own thread calls it.
pub(super) trait Outlet: Send + 'static {
    /// Whether it takes messages now.
    fn state(&self) -> OutletState;
    /// Sends one message; may block for as long as the receiver likes.
    fn send(&self, message: LogMsg);
    /// Waits until all messages have left, at most for `timeout`; whether they have.
    fn flush(&self, timeout: Duration) -> bool;
}

/// A viewer that listens at an address.
pub(super) struct ViewerOutlet(GrpcSink);

impl ViewerOutlet {
    /// Begins to look for the viewer.
    pub(super) fn connect(url: &str) -> Result<Self, RecordingError> {
        let refuse =
            |error: rerun::external::re_uri::Error| RecordingError::Url { url: url.into(), reason: error.to_string() };
        Ok(Self(GrpcSink::new(ProxyUri::from_str(url).map_err(refuse)?)))
    }
}

impl Outlet for ViewerOutlet {
    fn state(&self) -> OutletState {
        match self.0.status() {
            GrpcSinkConnectionState::Connecting { .. } => OutletState::Waiting,
            GrpcSinkConnectionState::Connected => OutletState::Open,
            GrpcSinkConnectionState::Disconnected(_) => OutletState::Closed,
        }
    }

    fn send(&self, message: LogMsg) {
        self.0.send(message);
    }

    fn flush(&self, timeout: Duration) -> bool {
        self.0.flush_blocking(timeout).is_ok()
    }
}

/// A server on this machine that hands the recording to every viewer that asks, for as long as a clone of this lives.
#[derive(Clone)]
pub struct Served {
    sink: Arc<GrpcServerSink>,
}

impl Served {
    /// Starts the server on 127.0.0.1.
    pub(super) fn start(port: u16) -> Result<Self, RecordingError> {
        let refuse = |reason: String| RecordingError::Port { port, reason };
        // the library's server does not tell that its port is taken: ask the system first
        let free = TcpListener::bind((Ipv4Addr::LOCALHOST, port)).map_err(|error| refuse(error.to_string()))?;
        let port = free.local_addr().map_err(|error| refuse(error.to_string()))?.port();
        drop(free);
        let sink = GrpcServerSink::new("127.0.0.1", port, rerun::ServerOptions::default())
            .map_err(|error| refuse(error.to_string()))?;
        Ok(Self { sink: Arc::new(sink) })
    }

    /// The address that a viewer opens: `rerun rerun+http://127.0.0.1:9876/proxy`.
    #[must_use]
    pub fn url(&self) -> String {
        self.sink.uri().to_string()
    }

    /// The side at which messages enter.
    pub(super) fn outlet(&self) -> ServerOutlet {
        ServerOutlet(Arc::clone(&self.sink))
    }
}

/// The side of a server at which messages enter.
pub(super) struct ServerOutlet(Arc<GrpcServerSink>);

impl Outlet for ServerOutlet {
    fn state(&self) -> OutletState {
        OutletState::Open
    }

    fn send(&self, message: LogMsg) {
        self.0.send(message);
    }

    fn flush(&self, timeout: Duration) -> bool {
        self.0.flush_blocking(timeout).is_ok()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_bad_address_is_refused() {
        for url in ["", "127.0.0.1", "http:/nowhere", "rerun+http://127.0.0.1:9876/dataset"] {
            assert!(matches!(ViewerOutlet::connect(url), Err(RecordingError::Url { .. })), "{url}");
        }
    }

    #[test]
    fn a_taken_port_is_refused() {
        let taken = TcpListener::bind((Ipv4Addr::LOCALHOST, 0)).unwrap();
        let port = taken.local_addr().unwrap().port();
        assert!(matches!(Served::start(port), Err(RecordingError::Port { port: refused, .. }) if refused == port));
    }
}
