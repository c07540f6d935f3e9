//! The wrench that is expected in one cut: what the cutting law makes of the planned motion and the stated toughness.

use nalgebra::{Isometry3, Point3, Vector3, Vector6};
use sim::cutting::food::Food;
use sim::cutting::knife::Knife;
use sim::cutting::mechanics::edge_force_n_per_m;
use skills::spatial::SpatialTrack;

use super::places::Place;

/// Time between two looks at the planned motion, s.
const STEP_S: f64 = 0.005;
/// Speed into the food below which a stroke rests, m/s.
const RESTING_M_PER_S: f64 = 1e-5;
/// Slices in which the area of the blade inside the food is summed up.
const SLICES: usize = 24;

/// Wrenches that are expected in one action of a plan, every [`STEP_S`].
pub(super) struct Expected {
    /// The action.
    pub action: usize,
    looks: Vec<Look>,
    /// The last look at which the edge is planned to be as deep as it goes.
    deepest: usize,
    section_from_world: Isometry3<f64>,
    height_m: f64,
}

/// What is planned at one time.
struct Look {
    wrench: Vector6<f64>,
    /// How deep the edge is to have been by then, at most down to the board, m.
    depth_m: f64,
}

impl Expected {
    /// Height of an edge above the board, m.
    pub fn height_m(&self, world_from_edge: &Isometry3<f64>) -> f64 {
        self.height_m - (self.section_from_world * world_from_edge).translation.y
    }

    /// What to expect at `since_s` of the action of an edge at this height above the board (m): what was planned for where
    /// the edge is, so that a knife that is late meets the food that is still before it, and not that before its reference.
    pub fn at(&self, since_s: f64, height_m: f64) -> Vector6<f64> {
        let planned = since_s / STEP_S;
        let withdrawn = planned > self.deepest as f64;
        let looks = if withdrawn { planned } else { planned.min(self.look_at(self.height_m - height_m)) };
        let (row, share) = (looks.floor() as usize, looks.fract());
        let at = |row: usize| self.looks.get(row).map_or_else(Vector6::zeros, |look| look.wrench);
        at(row) * (1.0 - share) + at(row + 1) * share
    }

    /// The look, and the part of the way to the next one, at which the edge is first planned to be at a depth.
    fn look_at(&self, depth_m: f64) -> f64 {
        let next = self.looks.partition_point(|look| look.depth_m < depth_m);
        let Some((before, after)) =
            next.checked_sub(1).and_then(|before| self.looks.get(before).zip(self.looks.get(next)))
        else {
            return next as f64;
        };
        (next - 1) as f64 + (depth_m - before.depth_m) / (after.depth_m - before.depth_m)
    }
}

/// One cut, as the law sees it.
pub(super) struct Stroke<'a> {
    pub place: &'a Place,
    pub food: &'a Food,
    pub knife: &'a Knife,
    pub tool_from_edge: &'a Isometry3<f64>,
}

impl Stroke<'_> {
    /// What is expected all along the `track` of an action.
    pub fn expected(&self, action: usize, track: &SpatialTrack) -> Expected {
        let count = (track.duration_s() / STEP_S).ceil() as usize;
        let section = &self.place.section;
        let section_from_world = section.world_from_section.inverse();
        let depth_m = |look: usize| {
            let world_from_edge = track.at(look as f64 * STEP_S).pose * self.tool_from_edge;
            (section_from_world * world_from_edge).translation.y.min(section.height_m)
        };
        let (mut deepest, mut deepest_m) = (0, f64::NEG_INFINITY);
        let looks = (0..=count).map(|look| {
            let wrench = self.wrench(track, look as f64 * STEP_S, deepest_m);
            if depth_m(look) >= deepest_m {
                (deepest, deepest_m) = (look, depth_m(look));
            }
            Look { wrench, depth_m: deepest_m }
        });
        let looks = looks.collect();
        Expected { action, looks, deepest, section_from_world, height_m: section.height_m }
    }

    /// Force and moment about the tool's origin, world axes, at a time of the action; fracture only where the cut gets deeper.
    fn wrench(&self, track: &SpatialTrack, time_s: f64, deepest_m: f64) -> Vector6<f64> {
        let motion = track.at(time_s);
        let world_from_section = &self.place.section.world_from_section;
        let edge = world_from_section.inverse() * motion.pose * self.tool_from_edge;
        let velocity = world_from_section.rotation.inverse() * motion.velocity.fixed_rows::<3>(0);
        let depth_m = edge.translation.y.min(self.place.section.height_m);
        let advances = depth_m > deepest_m && velocity.y > RESTING_M_PER_S;
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
        let arm = world_from_section * Point3::from(at) - Point3::from(motion.pose.translation.vector);
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

#[cfg(test)]
mod tests {
    use super::*;

    /// A stroke of 1 mm a look down to a board at 20 mm and up again, whose force in N is the depth in mm on its way down.
    fn stroke() -> Expected {
        let look = |look: usize| {
            let down = look.min(20) as f64;
            Look { wrench: Vector6::from_element(if look > 20 { 0.0 } else { down }), depth_m: 0.001 * down }
        };
        let looks = (0..=40).map(look).collect();
        Expected { action: 0, looks, deepest: 20, section_from_world: Isometry3::identity(), height_m: 0.020 }
    }

    #[test]
    fn a_late_knife_is_told_of_the_food_before_it_until_it_is_withdrawn() {
        let (stroke, look_s) = (stroke(), STEP_S);
        for (looks, height_m, expected) in
            [(10.0, 0.010, 10.0), (10.0, 0.0125, 7.5), (20.0, 0.001, 19.0), (10.0, 0.001, 10.0), (30.0, 0.005, 0.0)]
        {
            let found = stroke.at(looks * look_s, height_m)[0];
            assert!((found - expected).abs() < 1e-9, "{looks} looks, {height_m} m: {found}");
        }
    }
}
