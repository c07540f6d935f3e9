//! The identity of a run: a digest of everything that its result depends on.

use std::fmt;

use serde::{Deserialize, Serialize};

use crate::scenario::ResolvedScenario;

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
    let mut hasher = blake3::Hasher::new();
    let mut part = |text: &str| {
        // lengths keep "ab" + "c" and "a" + "bc" apart
        hasher.update(&(text.len() as u64).to_le_bytes());
        hasher.update(text.as_bytes());
    };
    part(&scenario.text(seed)?);
    for asset in &scenario.assets {
        [asset.kind.folder(), &asset.name, &asset.digest].into_iter().for_each(&mut part);
    }
    let digest = hasher.finalize().to_hex();
    Ok(RunId(digest.chars().take(32).collect()))
}
