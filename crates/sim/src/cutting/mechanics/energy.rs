//! Where the work of the knife goes.

/// Energies of one cut, J: the work of the knife in the section's plane and its parts.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Energy {
    /// Work of the knife on the food.
    pub work_j: f64,
    /// Work of the edge that made cut surface (and crushed food before a dull edge).
    pub fracture_j: f64,
    /// Work of friction on the flanks, and on the edge before the cut began.
    pub friction_j: f64,
    /// Energy now stored in the dent before the edge.
    pub elastic_j: f64,
    /// Stored energy that was lost when the cut began, or when food gave way that was dented.
    pub crush_j: f64,
}

impl Energy {
    /// Work that the parts do not account for, J: what the finite step leaves.
    #[must_use]
    pub fn balance_j(&self) -> f64 {
        self.work_j - self.fracture_j - self.friction_j - self.elastic_j - self.crush_j
    }
}
