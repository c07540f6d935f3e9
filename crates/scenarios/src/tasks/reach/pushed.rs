//! The forces that push the tool, and what the controller knows of them.

use nalgebra::{Isometry3, Point3, Vector3, Vector6};
use sim::SimError;
use sim::spatial::{Process, ReferenceSource, SpatialReference, Step};
use skills::spatial::SpatialPlan;

use super::config::Disturbance;
use crate::tasks::spatial::PlanSource;

/// Pushes the tool with the forces of a scenario.
pub(super) struct Pushed<'a> {
    forces: &'a [Disturbance],
    wrench: Vector6<f64>,
}

impl<'a> Pushed<'a> {
    pub(super) fn new(forces: &'a [Disturbance]) -> Self {
        Self { forces, wrench: Vector6::zeros() }
    }
}

impl Process for Pushed<'_> {
    fn before_step(&mut self, step: &mut Step<'_>) -> Result<(), SimError> {
        let force: Vector3<f64> = self.forces.iter().map(|force| force.force_at_n(step.time_s)).sum();
        self.wrench = Vector6::new(force.x, force.y, force.z, 0.0, 0.0, 0.0);
        let at = Point3::from(step.arm.world_from_tool(step.world).translation.vector);
        step.arm.push_tool(step.world, &force, &at);
        Ok(())
    }

    fn tool_wrench(&self) -> Vector6<f64> {
        self.wrench
    }
}

/// A plan together with the forces that the controller knows of.
pub(super) struct WithKnownForces<'a> {
    plan: PlanSource<'a>,
    forces: &'a [Disturbance],
}

impl<'a> WithKnownForces<'a> {
    pub(super) fn new(plan: &'a SpatialPlan, forces: &'a [Disturbance]) -> Self {
        Self { plan: PlanSource::new(plan), forces }
    }
}

impl ReferenceSource for WithKnownForces<'_> {
    fn next(&mut self, time_s: f64, world_from_tool: &Isometry3<f64>) -> SpatialReference {
        let mut reference = self.plan.next(time_s, world_from_tool);
        let known = self.forces.iter().filter(|force| force.known);
        let force: Vector3<f64> = known.map(|force| force.force_at_n(time_s)).sum();
        reference.expected_wrench = Vector6::new(force.x, force.y, force.z, 0.0, 0.0, 0.0);
        reference
    }
}
