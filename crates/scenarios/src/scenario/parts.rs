//! Checks of each part of a scenario on its own; every part is looked at, whatever is wrong with the others.

use std::path::Path;

use skills::field::{FieldError, finite, not_negative, positive, within};

use super::{DemonstrationsConfig, Header, Limits, RecordingConfig, RobotConfig, Scenario, SyntheticConfig};

/// Control periods per simulated second, Hz: nothing happens more often than this in a recording.
pub const CONTROL_RATE_HZ: f64 = 1000.0;

/// Largest seed: TOML's whole numbers are signed.
pub const LARGEST_SEED: u64 = i64::MAX as u64;

/// More demonstrations than this say nothing new and take hours.
pub(crate) const MOST_DEMONSTRATIONS: usize = 1000;

impl Scenario {
    /// Checks every part on its own, and returns at most one refused value of each.
    ///
    /// The number of joints, against which lists of gains are checked, is known only with the arm: see
    /// [`load`](super::load()).
    #[must_use]
    pub fn refused_values(&self) -> Vec<FieldError> {
        let parts: [(&str, Result<(), FieldError>); 13] = [
            ("scenario", self.scenario.validate()),
            ("world", self.world.validate()),
            ("object", self.object.validate()),
            ("robot", self.robot.validate()),
            ("task", self.task.validate()),
            ("demonstrations", self.demonstrations.validate()),
            ("primitive", self.primitive.validate()),
            ("execution", self.execution.validate()),
            ("camera", self.camera.validate()),
            ("engine", self.engine.validate()),
            ("variation", self.variation.validate()),
            ("limits", self.limits.validate()),
            ("recording", self.recording.validate()),
        ];
        parts.into_iter().filter_map(|(part, result)| Some(result.err()?.within(part))).collect()
    }
}

impl Header {
    fn validate(&self) -> Result<(), FieldError> {
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
        Ok(())
    }
}

/// Whether `letter` may stand in a scenario's name, which is also that of a folder.
fn is_in_name(letter: char) -> bool {
    letter.is_alphanumeric() || letter == '_' || letter == '-'
}

/// The name of a scenario that states none: its file's name without ending, `_` for what a name may not hold.
pub(crate) fn name_of_file(file: &Path) -> String {
    let stem = file.file_stem().unwrap_or_default().to_string_lossy();
    let name: String = stem.chars().map(|letter| if is_in_name(letter) { letter } else { '_' }).collect();
    if name.is_empty() { "scenario".into() } else { name }
}

impl RobotConfig {
    fn validate(&self) -> Result<(), FieldError> {
        finite("base_m", &self.base_m)?;
        finite("base_angle_rad", &[self.base_angle_rad])?;
        self.rotor_inertia_kg_m2.iter().try_for_each(|&inertia| not_negative("rotor_inertia_kg_m2", inertia))
    }
}

impl DemonstrationsConfig {
    fn validate(&self) -> Result<(), FieldError> {
        match self {
            Self::Synthetic(config) => config.validate().map_err(|error| error.within("synthetic")),
            Self::Recorded { assets, .. } if assets.is_empty() => Err(FieldError::new(
                "recorded.assets",
                "an empty list",
                "the name of at least one recorded demonstration",
            )),
            Self::Recorded { .. } | Self::Learned { .. } => Ok(()),
        }
    }
}

impl SyntheticConfig {
    fn validate(&self) -> Result<(), FieldError> {
        if !(1..=MOST_DEMONSTRATIONS).contains(&self.count) {
            return Err(FieldError::new(
                "count",
                self.count,
                format!("a whole number from 1 to {MOST_DEMONSTRATIONS}"),
            ));
        }
        finite("start_m", &self.start_m)?;
        finite("goal_m", &self.goal_m)?;
        self.human.validate().map_err(|error| error.within("human"))
    }
}

impl Limits {
    fn validate(&self) -> Result<(), FieldError> {
        positive("goal_error_m", self.goal_error_m)?;
        not_negative("clearance_m", self.clearance_m)?;
        self.object_clearance_m.map_or(Ok(()), |clearance_m| not_negative("object_clearance_m", clearance_m))?;
        self.knocked_m.map_or(Ok(()), |knocked_m| not_negative("knocked_m", knocked_m))
    }
}

impl RecordingConfig {
    fn validate(&self) -> Result<(), FieldError> {
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
        Header { name: Some(name.to_owned()), title, description, seed: 1 }.validate()
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
