//! The cutting force that a controller expects: what the cutting law makes of the planned motion and the stated toughness,
//! and of how far the knife falls behind, which tells how much tougher the food is than stated.

use nalgebra::{Isometry3, Point3, Vector3, Vector6};
use sim::cutting::food::Food;
use sim::cutting::knife::Knife;
use sim::cutting::mechanics::edge_force_n_per_m;
use sim::spatial::{ReferenceSource, SpatialReference};
use skills::spatial::{SpatialPlan, SpatialTrack};

use super::places::{Place, lowest_m};
use crate::tasks::spatial::PlanSource;

/// Time between two looks at the planned motion, s.
const STEP_S: f64 = 0.005;
/// Speed into the food below which a stroke rests, m/s.
const RESTING_M_PER_S: f64 = 1e-5;
/// Height above the board below which nothing is learned of the food, m: the board may hold the knife up, too.
const NEAR_BOARD_M: f64 = 0.0005;
/// Heights above the board between which the expected force fades out, m: a food comes apart while the edge is there, and what
/// then still pushes strikes the board. A step at one height would let go of foods that have not come apart yet.
const FADING_M: [f64; 2] = [0.00005, 0.0003];
/// Slices in which the area of the blade inside the food is summed up.
const SLICES: usize = 24;

/// How fast the estimate follows, N/(m s): a knife that is late by the force that is missing over the stiffness of the arm at
/// the knife, 3 to 10 kN/m, is caught up with in 0.06 to 0.2 s.
const CATCH_UP_N_PER_M_S: f64 = 5e4;
/// Expected forces that are small beside this tell little, N.
const TELLING_N: f64 = 2.0;

/// Force of the food over that which is expected of the stated toughness, found from how far the knife falls behind.
///
/// The knife falls behind its reference along the force that is missing, e = (θ − θ̂) F/k with k the stiffness of the arm:
/// dθ̂/dt = g e·F/(F² + F₀²) brings the estimate to the truth within k/g. Nothing is learned where no force is expected.
#[derive(Clone, Copy, Debug)]
struct Toughness {
    factor: f64,
    /// That of the toughest food of its kind.
    most: f64,
    time_s: Option<f64>,
}

impl Toughness {
    /// As tough as stated, and at most `most` times so.
    fn stated(most: f64) -> Self {
        Self { factor: 1.0, most: most.max(1.0), time_s: None }
    }

    /// Takes in how far the tool is `behind` its reference (m, from the reference to the tool) where `expected` (N) is.
    fn learn(&mut self, time_s: f64, behind: &Vector3<f64>, expected: &Vector3<f64>) {
        let dt = self.time_s.replace(time_s).map_or(0.0, |before| time_s - before);
        let told = behind.dot(expected) / (expected.norm_squared() + TELLING_N * TELLING_N);
        self.factor = (self.factor + CATCH_UP_N_PER_M_S * told * dt).clamp(0.0, self.most);
    }
}

/// Wrenches that are expected in one action of a plan, every [`STEP_S`].
struct Expected {
    action: usize,
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
    fn height_m(&self, world_from_edge: &Isometry3<f64>) -> f64 {
        self.height_m - (self.section_from_world * world_from_edge).translation.y
    }

    /// What to expect at `since_s` of the action of an edge at this height above the board (m): what was planned for where
    /// the edge is, so that a knife that is late meets the food that is still before it, and not that before its reference.
    fn at(&self, since_s: f64, height_m: f64) -> Vector6<f64> {
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

/// Share of the expected force that is pushed with at a height above the board, m.
fn pushed_share(height_m: f64) -> f64 {
    let [none_m, all_m] = FADING_M;
    ((height_m - none_m) / (all_m - none_m)).clamp(0.0, 1.0)
}

/// A plan together with the cutting forces to be expected.
pub(super) struct WithCuttingForces<'a> {
    source: PlanSource<'a>,
    plan: &'a SpatialPlan,
    cuts: Vec<Expected>,
    tool_from_edge: Isometry3<f64>,
    /// All of the edge, in the tool's frame.
    edge_in_tool: Vec<Point3<f64>>,
    board_top_m: f64,
    /// None if the stated toughness is taken for true.
    toughness: Option<Toughness>,
}

impl<'a> WithCuttingForces<'a> {
    /// Follows `plan` and expects nothing.
    pub fn none(plan: &'a SpatialPlan) -> Self {
        Self {
            source: PlanSource::new(plan),
            plan,
            cuts: Vec::new(),
            tool_from_edge: Isometry3::identity(),
            edge_in_tool: Vec::new(),
            board_top_m: 0.0,
            toughness: None,
        }
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
            let track = &plan.actions().get(*action)?.track;
            Some(stroke.expected(*action, track))
        });
        expecting.cuts = found.collect();
        expecting.tool_from_edge = *tool_from_edge;
        expecting
    }

    /// Finds out meanwhile how tough the food is, up to `most` times as tough as stated, while all of the edge is well above
    /// a board whose upper side is at `board_top_m`.
    pub fn learning(self, most: f64, edge_in_tool: Vec<Point3<f64>>, board_top_m: f64) -> Self {
        Self { toughness: Some(Toughness::stated(most)), edge_in_tool, board_top_m, ..self }
    }

    /// What is stated to be expected, and how high the edge is above the board, m; zero between the cuts.
    fn stated(&self, time_s: f64, phase: usize, world_from_tool: &Isometry3<f64>) -> (Vector6<f64>, f64) {
        let Some(cut) = self.cuts.iter().find(|cut| cut.action == phase) else { return (Vector6::zeros(), 0.0) };
        let (_, since_s) = self.plan.due_at(time_s);
        let height_m = cut.height_m(&(world_from_tool * self.tool_from_edge));
        (cut.at(since_s, height_m), height_m)
    }
}

impl ReferenceSource for WithCuttingForces<'_> {
    fn next(&mut self, time_s: f64, world_from_tool: &Isometry3<f64>) -> SpatialReference {
        let mut reference = self.source.next(time_s, world_from_tool);
        let (stated, height_m) = self.stated(time_s, reference.phase, world_from_tool);
        let edge_above_m = lowest_m(world_from_tool, &self.edge_in_tool) - self.board_top_m;
        let factor = self.toughness.as_mut().map_or(1.0, |toughness| {
            let behind = world_from_tool.translation.vector - reference.world_from_tool.translation.vector;
            // the board, which holds the knife up too, is not taken for food
            let telling = if edge_above_m > NEAR_BOARD_M { 1.0 } else { 0.0 };
            toughness.learn(time_s, &behind, &(stated.fixed_rows::<3>(0) * telling));
            toughness.factor
        });
        reference.expected_wrench = stated * (factor * pushed_share(height_m));
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
    /// What is expected all along the `track` of an action.
    fn expected(&self, action: usize, track: &SpatialTrack) -> Expected {
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

    const STEP_S: f64 = 0.001;

    /// The factor after `seconds` of cutting a food with `truth` times the expected 10 N, with an arm of 5 kN/m.
    fn learned(truth: f64, seconds: f64) -> f64 {
        let (mut toughness, expected) = (Toughness::stated(4.0), Vector3::new(0.0, 0.0, 10.0));
        for step in 0..(seconds / STEP_S) as usize {
            let behind = expected * ((truth - toughness.factor) / 5e3);
            toughness.learn(step as f64 * STEP_S, &behind, &expected);
        }
        toughness.factor
    }

    #[test]
    fn the_toughness_is_found_in_some_tenths_of_a_second() {
        for truth in [0.4, 1.0, 3.0] {
            // e^(−10) of the error is left: 1 s over k/g = 0.1 s, 4 % slower for the forces that tell little
            assert!((learned(truth, 1.0) / truth - 1.0).abs() < 2e-3, "{truth}: {}", learned(truth, 1.0));
        }
    }

    #[test]
    fn no_food_is_taken_to_be_tougher_than_the_toughest_of_its_kind() {
        assert_eq!(learned(9.0, 5.0), 4.0);
    }

    #[test]
    fn a_board_that_holds_the_knife_up_teaches_nothing() {
        let mut toughness = Toughness::stated(4.0);
        for step in 0..1000 {
            toughness.learn(f64::from(step) * STEP_S, &Vector3::new(0.0, 0.0, 0.002), &Vector3::zeros());
        }
        assert_eq!(toughness.factor, 1.0);
    }

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
        let (stroke, look_s) = (stroke(), super::STEP_S);
        for (looks, height_m, expected) in
            [(10.0, 0.010, 10.0), (10.0, 0.0125, 7.5), (20.0, 0.001, 19.0), (10.0, 0.001, 10.0), (30.0, 0.005, 0.0)]
        {
            let found = stroke.at(looks * look_s, height_m)[0];
            assert!((found - expected).abs() < 1e-9, "{looks} looks, {height_m} m: {found}");
        }
    }

    #[test]
    fn the_push_fades_out_above_the_board() {
        assert_eq!([0.01, 0.0003, 0.00005, 0.0, -0.001].map(pushed_share), [1.0, 1.0, 0.0, 0.0, 0.0]);
        assert!((pushed_share(0.000175) - 0.5).abs() < 1e-9);
    }
}
