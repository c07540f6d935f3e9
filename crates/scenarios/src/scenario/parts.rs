//! Checks of the shared parts of a scenario, each on its own.

use std::path::Path;

use skills::field::{FieldError, finite, not_negative, within};

use super::changes::INTO_ASSET;
use super::{Header, RecordingConfig, RobotConfig, check_key};

/// Control periods per simulated second, Hz: nothing happens more often than this in a recording.
pub const CONTROL_RATE_HZ: f64 = 1000.0;

/// Largest seed: TOML's whole numbers are signed.
pub const LARGEST_SEED: u64 = i64::MAX as u64;

impl Header {
    /// Checks the values.
    ///
    /// # Errors
    /// A [`FieldError`] naming the offending one.
    pub(crate) fn validate(&self) -> Result<(), FieldError> {
        if let Some(name) = self.name.as_ref().filter(|name| name.is_empty() || !name.chars().all(is_in_name)) {
            let found = if name.is_empty() { "an empty text".into() } else { format!("{name:?}") };
            return Err(FieldError::new("name", found, "letters, digits, `_` and `-` only"));
        }
        if self.title.trim().is_empty() {
            return Err(FieldError::new("title", "an empty text", "one line that names the experiment"));
        }
        if self.seed > LARGEST_SEED {
            return Err(FieldError::new("seed", self.seed, format!("a whole number from 0 to {LARGEST_SEED}")));
        }
        let no_asset = |key: &&String| !key.contains(INTO_ASSET) || check_key(key).is_err();
        match self.asset_changes.keys().find(no_asset) {
            Some(key) => {
                Err(FieldError::new("asset_changes", format!("the key {key:?}"), "keys such as \"tool.asset:mass_kg\""))
            }
            None => Ok(()),
        }
    }
}

/// Whether `letter` may stand in a scenario's name, which is also that of a folder.
pub(crate) fn is_in_name(letter: char) -> bool {
    letter.is_alphanumeric() || letter == '_' || letter == '-'
}

/// The name of a scenario that states none: its file's name without ending, `_` for what a name may not hold.
pub(crate) fn name_of_file(file: &Path) -> String {
    let stem = file.file_stem().unwrap_or_default().to_string_lossy();
    let name: String = stem.chars().map(|letter| if is_in_name(letter) { letter } else { '_' }).collect();
    if name.is_empty() { "scenario".into() } else { name }
}

impl RobotConfig {
    /// Checks the values.
    ///
    /// # Errors
    /// A [`FieldError`] naming the offending one.
    pub(crate) fn validate(&self) -> Result<(), FieldError> {
        finite("base_m", &self.base_m)?;
        finite("base_angle_rad", &[self.base_angle_rad])?;
        self.rotor_inertia_kg_m2.iter().try_for_each(|&inertia| not_negative("rotor_inertia_kg_m2", inertia))
    }
}

impl RecordingConfig {
    /// Checks the values.
    ///
    /// # Errors
    /// A [`FieldError`] naming the offending one.
    pub(crate) fn validate(&self) -> Result<(), FieldError> {
        // a slower recording than one sample in a hundred seconds shows nothing
        within("rate_hz", self.rate_hz, 0.01, CONTROL_RATE_HZ).map_err(|error| FieldError {
            expected: format!("{}: the control rate is {CONTROL_RATE_HZ} Hz", error.expected),
            ..error
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn named(name: &str) -> Result<(), FieldError> {
        let (title, description) = ("a title".to_owned(), String::new());
        Header { name: Some(name.to_owned()), title, description, seed: 1, asset_changes: Default::default() }
            .validate()
    }

    #[test]
    fn a_name_is_fit_for_a_folder() {
        assert!(named("push_L-2").is_ok());
        for name in ["", "..", "a/b", "a b", "a\nb", "a.b"] {
            assert_eq!(named(name).unwrap_err().field, "name", "{name:?}");
        }
    }

    #[test]
    fn every_file_gives_a_name() {
        for (file, name) in [("a/push.toml", "push"), ("a b.v2.toml", "a_b_v2"), (".toml", "_toml"), ("", "scenario")] {
            assert_eq!(name_of_file(Path::new(file)), name);
            assert!(named(&name_of_file(Path::new(file))).is_ok());
        }
    }
}
