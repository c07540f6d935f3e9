//! The cutting force that a controller expects: what is expected of the plan, times how much tougher the food was found to be,
//! until the edge is at the board.

use nalgebra::{Isometry3, Point3, Vector6};
use sim::cutting::food::Food;
use sim::cutting::knife::Knife;
use sim::spatial::{ReferenceSource, SpatialReference};
use skills::spatial::SpatialPlan;

use super::expected::{Expected, Stroke};
use super::places::{Place, lowest_m};
use super::toughness::Toughness;
use crate::tasks::spatial::PlanSource;

/// Height above the board below which nothing is learned of the food, m: the board may hold the knife up, too.
const NEAR_BOARD_M: f64 = 0.0005;
/// Heights above the board between which the expected force fades out, m: a food comes apart while the edge is there, and what
/// then still pushes strikes the board. A step at one height would let go of foods that have not come apart yet.
const FADING_M: [f64; 2] = [0.00005, 0.0003];

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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_push_fades_out_above_the_board() {
        assert_eq!([0.01, 0.0003, 0.00005, 0.0, -0.001].map(pushed_share), [1.0, 1.0, 0.0, 0.0, 0.0]);
        assert!((pushed_share(0.000175) - 0.5).abs() < 1e-9);
    }
}
