//! The states of a motion, gathered step by step into a rollout.

use nalgebra::{DMatrix, DVector};

use super::stepper::DmpStepper;
use crate::error::SkillError;
use crate::primitive::rollout::{Rollout, RolloutRequest};
use crate::trajectory::Trajectory;

/// Rollout in the making: as many rows as the request asks for, filled one by one.
#[derive(Debug)]
pub(super) struct Recording {
    times_s: Vec<f64>,
    row: usize,
    positions: DMatrix<f64>,
    velocities: DMatrix<f64>,
    accelerations: DMatrix<f64>,
}

impl Recording {
    /// Takes the memory that `request` needs and notes the state of `stepper` as the first row.
    pub(super) fn begin(request: &RolloutRequest, stepper: &DmpStepper) -> Self {
        let times_s = request.times_s();
        let table = DMatrix::zeros(times_s.len(), stepper.goal().len());
        let (positions, velocities, accelerations) = (table.clone(), table.clone(), table);
        let mut recording = Self { times_s, row: 0, positions, velocities, accelerations };
        recording.add(stepper);
        recording
    }

    /// Notes the state of `stepper` as the next row.
    pub(super) fn add(&mut self, stepper: &DmpStepper) {
        let note = |table: &mut DMatrix<f64>, values: &DVector<f64>| table.row_mut(self.row).tr_copy_from(values);
        note(&mut self.positions, stepper.position());
        note(&mut self.velocities, stepper.velocity());
        note(&mut self.accelerations, stepper.acceleration());
        self.row += 1;
    }

    /// Checks the rows and gives them away.
    ///
    /// # Errors
    /// If a value is not finite.
    pub(super) fn finish(self) -> Result<Rollout, SkillError> {
        Rollout::new(Trajectory::new(self.times_s, self.positions)?, self.velocities, self.accelerations)
    }
}
