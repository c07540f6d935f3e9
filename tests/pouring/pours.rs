//! Runs of pours by the built program, and their outcomes.

use std::fs;
use std::path::Path;

use serde_json::Value;

use crate::program::{PROJECT, replaced, wield};

/// One run of a pouring scenario.
pub struct Pour {
    /// Exit code.
    pub code: Option<i32>,
    /// What the run left, parsed.
    pub outcome: Value,
    /// The same as text, or what the program complained of.
    pub text: String,
}

/// Text of a shipped scenario.
pub fn shipped(file: &str) -> String {
    fs::read_to_string(Path::new(PROJECT).join("scenarios").join(file)).unwrap()
}

/// A shipped scenario with fewer beans, and a quicker approach.
pub fn few_beans(file: &str, count: usize) -> String {
    let text = replaced(&shipped(file), "fill.count = 300", &format!("fill.count = {count}"));
    replaced(&text, "options.floor_m", "options.approach_speed_m_per_s = 0.2\noptions.floor_m")
}

impl Pour {
    /// Runs a scenario's text.
    pub fn of(text: &str, seed: u64) -> Self {
        let folder = tempfile::tempdir().unwrap();
        fs::write(folder.path().join("pour.toml"), text).unwrap();
        let assets = Path::new(PROJECT).join("assets");
        let seed_text = seed.to_string();
        let arguments = ["run", "pour.toml", "--no-record", "--quiet", "--seed", &seed_text, "--out", "o"];
        let output = wield(folder.path(), Some(&assets), &arguments);
        let left = fs::read_to_string(folder.path().join(format!("o/seed-{seed}/outcome.json")));
        let text = left.unwrap_or_else(|_| String::from_utf8_lossy(&output.stderr).into_owned());
        Self { code: output.status.code(), outcome: serde_json::from_str(&text).unwrap_or_default(), text }
    }

    /// Outcomes of two seeds, run on so many threads.
    pub fn pair_on_threads(text: &str, threads: usize) -> [String; 2] {
        let folder = tempfile::tempdir().unwrap();
        fs::write(folder.path().join("pour.toml"), text).unwrap();
        let assets = Path::new(PROJECT).join("assets");
        let threads = threads.to_string();
        let trials = ["--trials", "2", "--seed", "1", "--threads", &threads];
        let arguments = [&["run", "pour.toml", "--no-record", "--quiet", "--out", "o"][..], &trials].concat();
        let output = wield(folder.path(), Some(&assets), &arguments);
        let told = String::from_utf8_lossy(&output.stderr).into_owned();
        [1, 2].map(|seed| {
            let outcome = fs::read_to_string(folder.path().join(format!("o/seed-{seed}/outcome.json")));
            assert!(outcome.is_ok(), "{told}");
            outcome.unwrap()
        })
    }

    /// Runs a shipped scenario as it is.
    pub fn shipped(file: &str, seed: u64) -> Self {
        Self::of(&shipped(file), seed)
    }

    /// Value of a measure.
    pub fn value(&self, name: &str) -> f64 {
        let measures = self.outcome["measures"].as_array().map_or(&[][..], Vec::as_slice);
        let measure = measures.iter().find(|measure| measure["name"] == name);
        let value = measure.and_then(|measure| measure["value"].as_f64());
        assert!(value.is_some(), "no {name}: {}", self.text);
        value.unwrap()
    }

    /// Value of a measure that counts.
    pub fn count(&self, name: &str) -> usize {
        self.value(name) as usize
    }

    /// Asserts that every bean and every gram is somewhere, once.
    pub fn assert_conserved(&self, beans: usize) {
        let counts = ["collected_count", "spilt_count", "left_count", "flying_count"].map(|name| self.count(name));
        assert_eq!((counts.iter().sum::<usize>(), self.count("beans")), (beans, beans), "{counts:?}");
        let percent: f64 =
            ["collected_percent", "spilt_percent", "left_percent"].map(|name| self.value(name)).iter().sum();
        let flying = 100.0 * counts[3] as f64 / beans as f64;
        assert!((percent + flying - 100.0).abs() < 1e-9, "{percent}");
    }

    /// Asserts that nothing was simulated, and that all `parts` stand in the one failure.
    pub fn assert_infeasible(&self, parts: &[&str]) {
        assert_eq!(self.outcome["trajectory_digest"], "", "{}", self.text);
        let reason = self.outcome["failures"][0].as_str().unwrap_or_default();
        assert!(parts.iter().all(|part| reason.contains(part)), "{reason}");
    }
}
