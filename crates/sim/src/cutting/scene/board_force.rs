//! Force between knife and board, from the contacts of the engine.

use rapier3d::prelude::ColliderHandle;

use crate::spatial::SpatialWorld;

/// Time within which peaks are smoothed, s: as a force sensor of 30 Hz would. A stop within one time step has a force of
/// speed by mass by time step, which says more of the step than of the blow.
const RESPONSE_S: f64 = 0.0053;

/// Force that a board feels.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct BoardForce {
    /// Smoothed force now, N.
    pub now_n: f64,
    /// Its greatest value so far, N.
    pub peak_n: f64,
}

impl BoardForce {
    /// Reads the contacts between `tool` and `board` of the last step.
    pub fn read(&mut self, world: &SpatialWorld, tool: &[ColliderHandle], board: ColliderHandle) {
        let dt = world.time_step_s();
        let pairs = tool.iter().filter_map(|piece| world.physics.contact_pair(*piece, board));
        let impulse: f64 = pairs.map(|pair| pair.total_impulse_magnitude()).sum();
        self.now_n += (impulse / dt - self.now_n) * (dt / RESPONSE_S).min(1.0);
        self.peak_n = self.peak_n.max(self.now_n);
    }
}
