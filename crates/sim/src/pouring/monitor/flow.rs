//! Flow out of the source over time, in memory that does not grow.

use super::config::MonitorConfig;

/// Sums over finished intervals.
#[derive(Clone, Copy, Debug, Default)]
struct Sums {
    intervals: f64,
    flow: f64,
    flow_squared: f64,
}

/// Flow per interval, its statistics, and stops that are clogs.
#[derive(Debug)]
pub(super) struct FlowMeter {
    interval_s: f64,
    clog_s: f64,
    empty_share: f64,
    /// Less than this is no flow: half of a mean grain, kg.
    least_kg: f64,
    interval_mass_kg: f64,
    in_interval_s: f64,
    last: f64,
    peak: f64,
    /// From the first interval with flow to now, and up to the last interval with flow.
    open: Sums,
    closed: Sums,
    has_flowed: bool,
    stopped_s: f64,
    is_clogged: bool,
    clogs: usize,
}

impl FlowMeter {
    pub(super) fn new(config: &MonitorConfig, total_kg: f64) -> Self {
        Self {
            interval_s: config.flow_interval_s,
            clog_s: config.clog_s,
            empty_share: config.empty_share,
            least_kg: 1e-9 * total_kg,
            interval_mass_kg: 0.0,
            in_interval_s: 0.0,
            last: 0.0,
            peak: 0.0,
            open: Sums::default(),
            closed: Sums::default(),
            has_flowed: false,
            stopped_s: 0.0,
            is_clogged: false,
            clogs: 0,
        }
    }

    /// Forgets what was noted before the first step.
    pub(super) fn start(&mut self) {
        (self.interval_mass_kg, self.has_flowed, self.stopped_s) = (0.0, false, 0.0);
    }

    /// A grain left the source, or came back (negative).
    pub(super) fn note(&mut self, mass_kg: f64) {
        self.interval_mass_kg += mass_kg;
        if mass_kg > 0.0 {
            (self.has_flowed, self.stopped_s, self.is_clogged) = (true, 0.0, false);
        }
    }

    pub(super) fn advance(&mut self, dt: f64, tilted: bool, left: usize, total: usize) {
        self.in_interval_s += dt;
        if self.in_interval_s >= self.interval_s - 0.5 * dt {
            self.finish_interval();
        }
        let can_clog = tilted && self.has_flowed && left as f64 > self.empty_share * total as f64;
        self.stopped_s = if can_clog { self.stopped_s + dt } else { 0.0 };
        if self.stopped_s >= self.clog_s && !self.is_clogged {
            self.is_clogged = true;
            self.clogs += 1;
        }
    }

    fn finish_interval(&mut self) {
        let flow = self.interval_mass_kg / self.in_interval_s;
        let flows = self.interval_mass_kg > self.least_kg;
        (self.last, self.interval_mass_kg, self.in_interval_s) = (flow, 0.0, 0.0);
        self.peak = self.peak.max(flow);
        if !flows && self.open.intervals == 0.0 {
            return;
        }
        self.open.intervals += 1.0;
        self.open.flow += flow;
        self.open.flow_squared += flow * flow;
        if flows {
            self.closed = self.open;
        }
    }

    pub(super) fn last_kg_per_s(&self) -> f64 {
        self.last
    }

    pub(super) fn peak_kg_per_s(&self) -> f64 {
        self.peak
    }

    pub(super) fn mean_kg_per_s(&self) -> f64 {
        self.closed.flow / self.closed.intervals.max(1.0)
    }

    pub(super) fn variation(&self) -> f64 {
        let (mean, count) = (self.mean_kg_per_s(), self.closed.intervals.max(1.0));
        if mean <= 0.0 {
            return 0.0;
        }
        (self.closed.flow_squared / count - mean * mean).max(0.0).sqrt() / mean
    }

    pub(super) fn clogs(&self) -> usize {
        self.clogs
    }
}
