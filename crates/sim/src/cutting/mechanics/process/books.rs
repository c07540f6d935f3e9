//! Energies of a cut, step by step.

use super::Cut;
use crate::cutting::mechanics::elements::{EdgeSums, PlanarWrench};
use crate::cutting::mechanics::flank_grip::FlankGrip;
use crate::cutting::mechanics::motion::EdgeMotion;

impl Cut {
    /// Adds one step to the energies; work is taken with the mean of the forces before and after.
    pub(super) fn keep_books(
        &mut self,
        motion: &EdgeMotion,
        edge: &EdgeSums,
        [along, friction]: [&PlanarWrench; 2],
        wrench: &PlanarWrench,
        dt: f64,
    ) {
        let along_edge: f64 = self.elements.iter().map(|element| element.giving.stored_j()).sum();
        let stored = along_edge + self.flanks.iter().map(FlankGrip::stored_j).sum::<f64>();
        let newly_stored = stored - std::mem::replace(&mut self.stored_along_j, stored);
        self.energy.work_j -= 0.5 * (wrench.power(motion) + self.previous.power(motion)) * dt;
        self.energy.friction_j -= friction.power(motion) * dt + newly_stored;
        // what a free food gives way by along the edge is lost but for what its springs store
        self.energy.friction_j += if self.begun { edge.giving * dt } else { -along.power(motion) * dt };
        self.energy.fracture_j += edge.fracture;
        self.energy.elastic_j = edge.elastic + stored;
        self.previous = *wrench;
    }
}
