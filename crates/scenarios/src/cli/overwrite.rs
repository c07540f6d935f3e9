//! What a file may replace that the user names for output: nothing but a file of its own kind.

use std::fs::File;
use std::io::Read;
use std::path::Path;

/// How a file of a kind is known by what it begins with.
pub struct Kind {
    name: &'static str,
    mark: &'static str,
    /// The mark stands within this many bytes of the beginning.
    within: u64,
}

/// Recordings.
pub const RECORDING: Kind = Kind { name: "a recording", mark: "RRF", within: 3 };
/// Files of learned skills.
pub const SKILLS: Kind = Kind { name: "a file of learned skills", mark: "format = \"wield-skills\"", within: 4096 };

/// Refuses to replace `file` if something else stands there: a scenario named by mistake would be lost.
///
/// # Errors
/// In words that name `option`.
pub fn only(file: &Path, kind: Kind, option: &str) -> Result<(), String> {
    let Ok(there) = File::open(file) else { return Ok(()) };
    let mut beginning = Vec::new();
    // what cannot be read is not known to be one
    let _ = there.take(kind.within).read_to_end(&mut beginning);
    let empty = beginning.is_empty();
    if empty || beginning.windows(kind.mark.len()).any(|bytes| bytes == kind.mark.as_bytes()) {
        return Ok(());
    }
    Err(format!(
        "{option} {}: found a file there that is not {}; expected a new name, or an earlier one to replace",
        file.display(),
        kind.name
    ))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_a_file_of_its_own_kind_is_replaced() {
        let folder = tempfile::tempdir().unwrap();
        let at = |name: &str, text: &str| {
            let path = folder.path().join(name);
            std::fs::write(&path, text).unwrap();
            path
        };
        assert!(only(&folder.path().join("new.rrd"), RECORDING, "--record").is_ok());
        assert!(only(&at("old.rrd", "RRF2…"), RECORDING, "--record").is_ok());
        assert!(only(&at("empty.rrd", ""), RECORDING, "--record").is_ok());
        let skills = at("own.toml", "# Skills\nformat = \"wield-skills\"\nversion = 2\n");
        assert!(only(&skills, SKILLS, "--out").is_ok());
        for (file, kind) in [(at("mine.toml", "[scenario]\ntitle = \"\"\n"), SKILLS), (skills.clone(), RECORDING)] {
            let reason = only(&file, kind, "--out").unwrap_err();
            assert!(reason.contains("found a file there that is not a"), "{reason}");
        }
    }
}
