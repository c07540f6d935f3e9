//! The kernelized movement primitive: a kernel solution through the reference distribution of demonstrations, bent to
//! start, goal and via points, and aware of how sure it is.
//!
//! The paper only claims that its framework takes this kind too. Source: Y. Huang, L. Rozo, J. Silvério and
//! D. G. Caldwell, "Kernelized movement primitives", The International Journal of Robotics Research 38(7), 2019,
//! doi:10.1177/0278364919846363. Departs from it: the reference distribution is a mean and a covariance at equal time over
//! duration instead of a Gaussian mixture; coordinates are apart; what is learned is the residual about a minimum-jerk
//! transfer, so that the shape moves with start and goal, whose places and velocities are given exactly.

mod config;
mod coordinate;
mod kernel;
mod motion;
mod reference;
mod saved;

pub use config::KernelizedConfig;
pub use motion::{KernelizedMotion, ViaPoint};
pub use reference::Reference;
pub use saved::SavedKernelized;

use super::{MovementPrimitive, Rollout, RolloutRequest, SavedPrimitive};
use crate::error::SkillError;
use crate::trajectory::Trajectory;
use coordinate::Coordinate;
use kernel::Kernel;

/// Kernelized movement primitive of d coordinates: ξ(u) = k(u)ᵀ(K + λΣ)⁻¹μ about x0 + (g − x0)·mj(u), u = t/T, and about
/// what brings the start velocity to rest within a quarter of the duration.
///
/// K is the kernel of values and rates at N instants, μ and Σ their mean and covariance over the demonstrations. A rollout
/// starts with the requested velocity and comes to rest at the goal at T.
#[derive(Debug, Clone)]
pub struct Kernelized {
    config: KernelizedConfig,
    kernel: Kernel,
    coordinates: Vec<Coordinate>,
}

impl Kernelized {
    /// Learns from one or more demonstrations: one Cholesky factorization of 2N rows per coordinate.
    ///
    /// Demonstrations share the dimension d, unit and frame; starts, goals, durations and sampling may differ. The velocity
    /// with which one starts or ends is not learned: a rollout has the requested one and ends at rest.
    ///
    /// # Errors
    /// If `config` is invalid, there is no demonstration, the dimensions differ, or the references do not determine the
    /// solution.
    pub fn learn(config: &KernelizedConfig, demonstrations: &[Trajectory]) -> Result<Self, SkillError> {
        config.validate()?;
        Self::solve(config.clone(), reference::references(config, demonstrations)?)
    }

    fn solve(config: KernelizedConfig, references: Vec<Reference>) -> Result<Self, SkillError> {
        let kernel = Kernel::new(config.length_scale);
        let solved = references.into_iter().map(|reference| Coordinate::solve(&config, kernel, reference));
        let rows = 2 * config.references;
        let undetermined = SkillError::Undetermined { samples: rows, bases: rows };
        let coordinates = solved.collect::<Option<Vec<_>>>().ok_or(undetermined)?;
        Ok(Self { config, kernel, coordinates })
    }

    /// Returns the reference distribution of each coordinate.
    pub fn references(&self) -> impl Iterator<Item = &Reference> {
        self.coordinates.iter().map(|coordinate| &coordinate.reference)
    }

    /// Prepares the motion of a request; its step and settling time are for rollouts of it.
    ///
    /// # Errors
    /// As [`MovementPrimitive::rollout`].
    pub fn motion(&self, request: &RolloutRequest) -> Result<KernelizedMotion<'_>, SkillError> {
        self.motion_through(request, &[])
    }

    /// Prepares the motion of a request that passes via points on its way.
    ///
    /// # Errors
    /// As [`MovementPrimitive::rollout`], and if a via point is not strictly within the motion, has another dimension, a
    /// value that is not finite or a negative deviation, or two are less than a thousandth of the duration apart.
    pub fn motion_through(
        &self,
        request: &RolloutRequest,
        via: &[ViaPoint],
    ) -> Result<KernelizedMotion<'_>, SkillError> {
        KernelizedMotion::new(self, request, via)
    }
}

impl MovementPrimitive for Kernelized {
    fn dimension(&self) -> usize {
        self.coordinates.len()
    }

    fn saved(&self) -> SavedPrimitive {
        SavedPrimitive::Kernelized(Self::saved(self))
    }

    fn rollout(&self, request: &RolloutRequest) -> Result<Rollout, SkillError> {
        self.motion(request)?.rollout()
    }
}

#[cfg(test)]
#[path = "kernelized_tests.rs"]
mod tests;
