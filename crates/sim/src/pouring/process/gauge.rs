//! What is measured while beans are poured, shared with whoever decides when to stop.

use std::cell::Cell;
use std::rc::Rc;

use nalgebra::Vector6;

/// What is in the cup and in the target at one instant.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PourReading {
    /// Mass in the target, kg.
    pub collected_kg: f64,
    /// Mass in the cup, kg.
    pub held_kg: f64,
    /// Weight of what is in the cup: force (N, rows 0–2) and moment about the tool's origin (N m, rows 3–5), world axes.
    pub weight_wrench: Vector6<f64>,
}

/// Reads what the process measured in the last step; clones read the same.
#[derive(Clone, Debug, Default)]
pub struct PourGauge {
    reading: Rc<Cell<PourReading>>,
}

impl PourGauge {
    /// The last reading; zeros before the run.
    #[must_use]
    pub fn read(&self) -> PourReading {
        self.reading.get()
    }

    pub(super) fn set(&self, reading: PourReading) {
        self.reading.set(reading);
    }
}
