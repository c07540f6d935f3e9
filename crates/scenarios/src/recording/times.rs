//! The two timelines of a recording: control steps and simulated time.

use rerun::TimeColumn;

/// Timeline of control steps.
pub(super) const STEP: &str = "step";

/// Timeline of simulated seconds.
pub(super) const SIM_TIME: &str = "sim_time";

/// Times of rows that wait.
#[derive(Clone, Debug, Default)]
pub(super) struct Times {
    steps: Vec<i64>,
    seconds: Vec<f64>,
}

impl Times {
    /// Room for `rows` rows.
    pub(super) fn with_capacity(rows: usize) -> Self {
        Self { steps: Vec::with_capacity(rows), seconds: Vec::with_capacity(rows) }
    }

    /// Adds a row.
    pub(super) fn push(&mut self, step: u64, time_s: f64) {
        self.steps.push(i64::try_from(step).unwrap_or(i64::MAX));
        self.seconds.push(time_s);
    }

    /// Number of rows.
    pub(super) fn len(&self) -> usize {
        self.steps.len()
    }

    /// The rows as time columns.
    pub(super) fn columns(&self) -> [TimeColumn; 2] {
        let steps = self.steps.iter().copied();
        [TimeColumn::new_sequence(STEP, steps), TimeColumn::new_duration_secs(SIM_TIME, self.seconds.iter().copied())]
    }

    /// Forgets all rows and keeps their room.
    pub(super) fn clear(&mut self) {
        self.steps.clear();
        self.seconds.clear();
    }
}
