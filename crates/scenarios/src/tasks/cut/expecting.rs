//! The cutting force that a controller expects: what the cutting law makes of the planned motion and the stated toughness.

use nalgebra::{Isometry3, Vector3, Vector6};
use sim::cutting::food::Food;
use sim::cutting::knife::Knife;
use sim::cutting::mechanics::edge_force_n_per_m;
use sim::spatial::{ReferenceSource, SpatialReference};
use skills::spatial::{SpatialAction, SpatialPlan};

use super::places::Place;
use crate::tasks::spatial::PlanSource;

/// Time between two looks at the planned motion, s.
const STEP_S: f64 = 0.005;
/// Speed into the food below which a stroke rests, m/s.
const RESTING_M_PER_S: f64 = 1e-5;
/// Slices in which the area of the blade inside the food is summed up.
const SLICES: usize = 24;

/// Wrenches that are expected in one action of a plan, every [`STEP_S`].
struct Expected {
    action: usize,
    wrenches: Vec<Vector6<f64>>,
}

/// A plan together with the cutting forces to be expected.
pub(super) struct WithCuttingForces<'a> {
    source: PlanSource<'a>,
    plan: &'a SpatialPlan,
    cuts: Vec<Expected>,
}

impl<'a> WithCuttingForces<'a> {
    /// Follows `plan` and expects nothing.
    pub fn none(plan: &'a SpatialPlan) -> Self {
        Self { source: PlanSource::new(plan), plan, cuts: Vec::new() }
    }

    /// Follows `plan`, whose actions `cuts` cut the places of `food`; `tool_from_edge` is the middle of the planned part of the
    /// edge in the tool's frame.
    pub fn new(
        plan: &'a SpatialPlan,
        cuts: &[(usize, &Place)],
        food: &Food,
        knife: &Knife,
        tool_from_edge: &Isometry3<f64>,
    ) -> Self {
        let mut expecting = Self::none(plan);
        let found = cuts.iter().filter_map(|(action, place)| {
            let stroke = Stroke { place, food, knife, tool_from_edge };
            let wrenches = stroke.wrenches(plan.actions().get(*action)?);
            Some(Expected { action: *action, wrenches })
        });
        expecting.cuts = found.collect();
        expecting
    }

    fn expected(&self, time_s: f64, phase: usize) -> Vector6<f64> {
        let Some(cut) = self.cuts.iter().find(|cut| cut.action == phase) else { return Vector6::zeros() };
        let (_, since_s) = self.plan.due_at(time_s);
        let looks = since_s / STEP_S;
        let (row, share) = (looks.floor() as usize, looks.fract());
        let at = |row: usize| cut.wrenches.get(row).copied().unwrap_or_else(Vector6::zeros);
        at(row) * (1.0 - share) + at(row + 1) * share
    }
}

impl ReferenceSource for WithCuttingForces<'_> {
    fn next(&mut self, time_s: f64, world_from_tool: &Isometry3<f64>) -> SpatialReference {
        let mut reference = self.source.next(time_s, world_from_tool);
        reference.expected_wrench = self.expected(time_s, reference.phase);
        reference
    }
}

/// One cut, as the law sees it.
struct Stroke<'a> {
    place: &'a Place,
    food: &'a Food,
    knife: &'a Knife,
    tool_from_edge: &'a Isometry3<f64>,
}

impl Stroke<'_> {
    fn wrenches(&self, action: &SpatialAction) -> Vec<Vector6<f64>> {
        let looks = (action.track.duration_s() / STEP_S).ceil() as usize;
        let mut deepest_m = f64::NEG_INFINITY;
        (0..=looks).map(|look| self.wrench(action, look as f64 * STEP_S, &mut deepest_m)).collect()
    }

    /// Force and moment about the tool's origin, world axes, at a time of the action; fracture only where the cut gets deeper.
    fn wrench(&self, action: &SpatialAction, time_s: f64, deepest_m: &mut f64) -> Vector6<f64> {
        let motion = action.track.at(time_s);
        let world_from_section = &self.place.section.world_from_section;
        let edge = world_from_section.inverse() * motion.pose * self.tool_from_edge;
        let velocity = world_from_section.rotation.inverse() * motion.velocity.fixed_rows::<3>(0);
        let depth_m = edge.translation.y.min(self.place.section.height_m);
        let advances = depth_m > *deepest_m && velocity.y > RESTING_M_PER_S;
        *deepest_m = deepest_m.max(depth_m);
        if depth_m <= 0.0 || velocity.norm() < RESTING_M_PER_S {
            return Vector6::zeros();
        }
        let mut force = Vector3::zeros();
        if advances && !self.broken(depth_m) {
            let material = &self.food.material;
            let rate = (velocity.norm() / material.reference_speed_m_per_s).powf(material.rate_exponent);
            let ratio = velocity.x / velocity.y;
            let [push, slice] = edge_force_n_per_m(
                material.toughness_j_per_m2 * rate,
                ratio,
                material.slice_efficiency,
                self.knife.edge.tooth_ratio,
            );
            let width_m = self.place.outline.width_at(depth_m);
            force -= Vector3::new(slice * velocity.x.signum(), push, 0.0) * width_m;
        }
        force -= velocity.normalize() * 2.0 * self.food.material.flank_shear_pa * self.flank_m2(depth_m);
        // at the middle of the food's chord
        let at = Vector3::new(0.0, depth_m, 0.0);
        let arm =
            world_from_section * nalgebra::Point3::from(at) - nalgebra::Point3::from(motion.pose.translation.vector);
        let force_in_world = world_from_section.rotation * force;
        let moment = arm.cross(&force_in_world);
        Vector6::new(force_in_world.x, force_in_world.y, force_in_world.z, moment.x, moment.y, moment.z)
    }

    /// Whether a brittle food has run apart by now.
    fn broken(&self, depth_m: f64) -> bool {
        let share = self.food.material.brittle_depth_share;
        share.is_some_and(|share| depth_m > share * self.place.section.height_m)
    }

    /// Area of one face of the blade inside the food at a depth, m².
    fn flank_m2(&self, depth_m: f64) -> f64 {
        if self.broken(depth_m) {
            return 0.0;
        }
        let height_m = depth_m.min(self.knife.edge.blade_height_m);
        let slice_m = height_m / SLICES as f64;
        let width_m = |slice: usize| self.place.outline.width_at(depth_m - (slice as f64 + 0.5) * slice_m);
        (0..SLICES).map(|slice| width_m(slice) * slice_m).sum()
    }
}
