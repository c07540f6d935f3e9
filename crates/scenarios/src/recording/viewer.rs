//! Starts an installed viewer and waits until it listens.

use std::io::ErrorKind;
use std::net::{Ipv4Addr, SocketAddr, TcpStream};
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

use super::RecordingError;

/// The viewer's program.
pub(super) const PROGRAM: &str = "rerun";

/// A viewer opens its port within this time; then the run begins without it.
const PATIENCE: Duration = Duration::from_secs(10);

/// Time between two looks at the port.
const LOOK: Duration = Duration::from_millis(50);

/// A viewer that was found or started.
pub(super) struct Shown {
    /// Where it listens.
    pub(super) url: String,
    /// What a reader should know.
    pub(super) warning: Option<String>,
}

/// Starts `program` on `port` of this machine, unless something listens there already.
pub(super) fn open(program: &str, port: u16) -> Result<Shown, RecordingError> {
    let url = format!("rerun+http://127.0.0.1:{port}/proxy");
    if listens(port) {
        return Ok(Shown { url, warning: None });
    }
    let mut child = start(program, port)?;
    let end = Instant::now() + PATIENCE;
    while Instant::now() < end {
        if listens(port) {
            return Ok(Shown { url, warning: None });
        }
        check_alive(program, &mut child)?;
        std::thread::sleep(LOOK);
    }
    let warning = format!("view: the viewer `{program}` did not listen on port {port} within {} s", PATIENCE.as_secs());
    Ok(Shown { url, warning: Some(warning) })
}

fn start(program: &str, port: u16) -> Result<Child, RecordingError> {
    let mut command = Command::new(program);
    // a viewer listens on every interface unless it is told otherwise
    command.args(["--bind", "127.0.0.1", "--port", &port.to_string(), "--expect-data-soon", "--hide-welcome-screen"]);
    command.stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::null());
    #[cfg(unix)]
    {
        // the window outlives the run, also when the run is interrupted from the keyboard
        use std::os::unix::process::CommandExt as _;
        command.process_group(0);
    }
    command.spawn().map_err(|error| match error.kind() {
        ErrorKind::NotFound => RecordingError::NoViewer { program: program.into() },
        _ => RecordingError::Viewer { program: program.into(), reason: error.to_string() },
    })
}

/// A launcher may end well while its window lives on; one that fails has no window.
fn check_alive(program: &str, child: &mut Child) -> Result<(), RecordingError> {
    match child.try_wait() {
        Ok(Some(status)) if !status.success() => {
            Err(RecordingError::Viewer { program: program.into(), reason: format!("it ended with {status}") })
        }
        _ => Ok(()),
    }
}

fn listens(port: u16) -> bool {
    let address = SocketAddr::from((Ipv4Addr::LOCALHOST, port));
    TcpStream::connect_timeout(&address, Duration::from_millis(200)).is_ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn free_port() -> u16 {
        std::net::TcpListener::bind((Ipv4Addr::LOCALHOST, 0)).unwrap().local_addr().unwrap().port()
    }

    #[test]
    fn a_viewer_that_is_not_installed_is_told() {
        let result = open("no-such-viewer-is-installed", free_port());
        assert!(matches!(result, Err(RecordingError::NoViewer { .. })));
    }

    #[test]
    #[cfg(unix)]
    fn a_viewer_that_ends_at_once_is_told() {
        assert!(matches!(open("false", free_port()), Err(RecordingError::Viewer { .. })));
    }

    #[test]
    fn whoever_listens_already_is_used() {
        let listener = std::net::TcpListener::bind((Ipv4Addr::LOCALHOST, 0)).unwrap();
        let port = listener.local_addr().unwrap().port();
        assert!(open("no-such-viewer-is-installed", port).is_ok());
    }
}
