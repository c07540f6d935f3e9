//! Why a recording could not begin.

use std::path::PathBuf;

/// How to install the viewer that fits.
const INSTALL: &str =
    "install it with `pip install rerun-sdk==0.36.3` or `cargo install rerun-cli --version 0.36.3 --locked`";

/// Why a recording could not begin.
#[derive(Debug, thiserror::Error)]
pub enum RecordingError {
    /// The file cannot be written.
    #[error("record: cannot write the recording: {reason}; expected a writable file in an existing folder ({})", path.display())]
    File {
        /// The file that was asked for.
        path: PathBuf,
        /// What the system said.
        reason: String,
    },
    /// The address is not that of a viewer.
    #[error("connect: '{url}' is no address of a viewer: {reason}; expected rerun+http://127.0.0.1:9876/proxy")]
    Url {
        /// The address that was asked for.
        url: String,
        /// What is wrong with it.
        reason: String,
    },
    /// The port cannot be listened on.
    #[error("serve: cannot listen on 127.0.0.1:{port}: {reason}; choose another port")]
    Port {
        /// The port that was asked for.
        port: u16,
        /// What the system said.
        reason: String,
    },
    /// There is no viewer to show the run in.
    #[error("view: found no viewer: no program `{program}`; {INSTALL}")]
    NoViewer {
        /// The program that was looked for.
        program: String,
    },
    /// The viewer did not start.
    #[error(
        "view: the viewer `{program}` did not start: {reason}; write a file instead and open it where there is a screen"
    )]
    Viewer {
        /// The program that was started.
        program: String,
        /// What went wrong.
        reason: String,
    },
    /// The Rerun library refused to begin.
    #[error("record: {0}")]
    Stream(#[from] rerun::RecordingStreamError),
    /// A thread could not be started.
    #[error("record: cannot start a thread: {0}")]
    Thread(std::io::Error),
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_missing_viewer_is_told_with_its_installation() {
        let text = RecordingError::NoViewer { program: "rerun".into() }.to_string();
        assert!(text.contains("pip install rerun-sdk==0.36.3"), "{text}");
        assert!(text.contains("cargo install rerun-cli --version 0.36.3 --locked"), "{text}");
    }
}
