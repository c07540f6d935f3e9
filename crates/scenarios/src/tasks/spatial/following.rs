//! A plan as the reference of an arm.

use nalgebra::{Isometry3, Vector6};
use sim::spatial::{ReferenceSource, SpatialReference};
use skills::spatial::SpatialPlan;

/// Gives the tool pose of a plan at each control instant, whatever the tool does.
pub(crate) struct PlanSource<'a> {
    plan: &'a SpatialPlan,
    /// Wrench that the surroundings are expected to exert on the tool in each action, world axes, N and N m; none if empty.
    expected: Vec<Vector6<f64>>,
}

impl<'a> PlanSource<'a> {
    /// Follows `plan` and expects nothing.
    pub(crate) fn new(plan: &'a SpatialPlan) -> Self {
        Self { plan, expected: Vec::new() }
    }
}

impl ReferenceSource for PlanSource<'_> {
    fn next(&mut self, time_s: f64, _world_from_tool: &Isometry3<f64>) -> SpatialReference {
        let (phase, _) = self.plan.due_at(time_s);
        let motion = self.plan.at(time_s);
        SpatialReference {
            world_from_tool: motion.pose,
            velocity: motion.velocity,
            acceleration: motion.acceleration,
            expected_wrench: self.expected.get(phase).copied().unwrap_or_else(Vector6::zeros),
            phase,
            finished: time_s >= self.plan.duration_s(),
        }
    }
}
