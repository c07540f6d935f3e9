//! Where the lip is and how far the cup is tilted while the grains leave it.

use rapier3d::prelude::PhysicsWorld;

use super::lip_to_mouth_m;
use crate::pouring::monitor::PourMonitor;

/// Share of the grains that has left when the flow counts as begun: single ones jump earlier.
const BEGUN_SHARE: f64 = 0.01;

/// The lip at one instant.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Lip {
    /// Distance from the opening of the mouth, m.
    pub(super) distance_m: f64,
    /// Tilt of the cup, rad.
    pub(super) tilt_rad: f64,
}

/// The lip while grains left the cup. `None` in a run in which they did not.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct LipReport {
    /// Tilt at which 1 % of the grains had left, rad.
    pub onset_tilt_rad: Option<f64>,
    /// Tilt at which the last grain left, rad.
    pub stop_tilt_rad: Option<f64>,
    /// Distance of the lip from the opening of the mouth at the onset, m.
    pub onset_distance_m: Option<f64>,
    /// Mean distance from the onset to the last grain, m.
    pub mean_distance_m: Option<f64>,
    /// Largest distance from the onset to the last grain, m.
    pub largest_distance_m: Option<f64>,
}

/// Sums over the steps from the onset on.
#[derive(Clone, Copy, Debug, Default)]
struct Sums {
    steps: f64,
    distance_m: f64,
    largest_m: f64,
}

/// Watches the lip.
#[derive(Clone, Debug)]
pub(super) struct LipWatch {
    begun_below: usize,
    held: usize,
    now: Lip,
    onset: Option<Lip>,
    last: Option<Lip>,
    /// Until now, and until the last grain.
    open: Sums,
    closed: Sums,
}

impl LipWatch {
    pub(super) fn new(grains: usize) -> Self {
        let gone = ((BEGUN_SHARE * grains as f64).ceil() as usize).max(1);
        Self {
            begun_below: (grains + 1).saturating_sub(gone),
            held: grains,
            now: Lip::default(),
            onset: None,
            last: None,
            open: Sums::default(),
            closed: Sums::default(),
        }
    }

    /// Looks after a step, once the monitor has looked.
    pub(super) fn look(&mut self, monitor: &PourMonitor, physics: &PhysicsWorld) {
        let distance_m = monitor.target().map_or(0.0, |target| lip_to_mouth_m(monitor.source(), target, physics));
        self.note(Lip { distance_m, tilt_rad: monitor.source().tilt_rad(physics) }, monitor.counts().source);
    }

    fn note(&mut self, now: Lip, held: usize) {
        self.now = now;
        let has_left = held < self.held;
        self.held = held;
        if self.onset.is_none() && held < self.begun_below {
            self.onset = Some(now);
        }
        if self.onset.is_none() {
            return;
        }
        self.open.steps += 1.0;
        self.open.distance_m += now.distance_m;
        self.open.largest_m = self.open.largest_m.max(now.distance_m);
        if has_left {
            self.last = Some(now);
            self.closed = self.open;
        }
    }

    pub(super) fn now(&self) -> Lip {
        self.now
    }

    pub(super) fn report(&self) -> LipReport {
        let begun = self.closed.steps > 0.0;
        LipReport {
            onset_tilt_rad: self.onset.map(|lip| lip.tilt_rad),
            stop_tilt_rad: self.last.map(|lip| lip.tilt_rad),
            onset_distance_m: self.onset.map(|lip| lip.distance_m),
            mean_distance_m: begun.then(|| self.closed.distance_m / self.closed.steps),
            largest_distance_m: begun.then_some(self.closed.largest_m),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn lip(distance_m: f64) -> Lip {
        Lip { distance_m, tilt_rad: 10.0 * distance_m }
    }

    #[test]
    fn the_flow_begins_when_one_percent_has_left_and_ends_with_the_last_grain() {
        let mut watch = LipWatch::new(300);
        // two single grains first; then three more; one more later; then nothing
        for (distance_m, held) in [(0.5, 298), (0.4, 298), (0.02, 295), (0.04, 295), (0.03, 294), (0.9, 294)] {
            watch.note(lip(distance_m), held);
        }
        let report = watch.report();
        assert_eq!(report.onset_distance_m, Some(0.02));
        assert_eq!(report.onset_tilt_rad, Some(0.2));
        assert_eq!(report.stop_tilt_rad, Some(0.3));
        assert_eq!(report.largest_distance_m, Some(0.04));
        assert!((report.mean_distance_m.unwrap() - 0.03).abs() < 1e-12);
    }

    #[test]
    fn a_cup_that_is_not_poured_has_no_onset() {
        let mut watch = LipWatch::new(300);
        watch.note(lip(0.1), 300);
        assert_eq!(watch.report(), LipReport::default());
    }
}
