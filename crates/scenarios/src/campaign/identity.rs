//! The identity of a run: a digest of everything that its result depends on.

use std::fmt;

use serde::{Deserialize, Serialize};

use crate::scenario::{Change, ResolvedScenario};

/// Identity of a run: 32 hexadecimal digits. Equal identities, equal results of the same program.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(transparent)]
pub struct RunId(String);

impl RunId {
    /// The digits.
    #[must_use]
    pub fn as_str(&self) -> &str {
        &self.0
    }
}

impl fmt::Display for RunId {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.0)
    }
}

/// The identity of a run: digest of the scenario with every default written out, of its seed, and of the files that it
/// names.
///
/// The scenario's name, title and description take part, too: they are in the outcome.
///
/// # Errors
/// In words, if the scenario cannot be written.
pub fn run_id(scenario: &ResolvedScenario, seed: u64) -> Result<RunId, String> {
    let text = scenario.text(seed)?;
    let assets = scenario.assets.iter().flat_map(|asset| [asset.kind.folder(), &asset.name, &asset.digest]);
    Ok(digest(std::iter::once(text.as_str()).chain(assets)))
}

/// The identity of a run whose values make no valid scenario: digest of the scenario's text, of these values and its seed.
pub(super) fn invalid_run_id(text: &str, changes: &[Change], seed: u64) -> RunId {
    let (changes, seed): (Vec<String>, String) = (changes.iter().map(Change::to_string).collect(), seed.to_string());
    digest(["invalid", text, &seed].into_iter().chain(changes.iter().map(String::as_str)))
}

fn digest<'a>(parts: impl Iterator<Item = &'a str>) -> RunId {
    let mut hasher = blake3::Hasher::new();
    for part in parts {
        // lengths keep "ab" + "c" and "a" + "bc" apart
        hasher.update(&(part.len() as u64).to_le_bytes());
        hasher.update(part.as_bytes());
    }
    RunId(hasher.finalize().to_hex().chars().take(32).collect())
}
