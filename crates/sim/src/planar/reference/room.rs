//! Room beside a planned push: how far to either side of its way the tool keeps clear of obstacles and within reach.

use nalgebra::{Isometry2, Translation2, Unit, Vector2};
use skills::plan::Action;
use skills::tool::Tool;
use skills::transfer::Reach;

use crate::planar::config::WorldConfig;

/// Distance that the tool keeps from obstacles beside its planned way, m.
const CLEARANCE_M: f64 = 0.001;
/// Distance of two places that are looked at beside the way, m.
const ASIDE_STEP_M: f64 = 0.001;
/// Distance of two places that are looked at along the way, m.
const ALONG_STEP_M: f64 = 0.005;
/// Nobody looks farther than this, m.
const WIDEST_M: f64 = 0.03;

/// How far the tool may be beside its planned way, m; not at all by default.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Room {
    left_m: f64,
    right_m: f64,
}

impl Room {
    /// Looks beside the way of `tool` in a push along `direction`, on that way and `lift_m` behind it.
    pub(super) fn beside(
        action: &Action,
        direction: &Unit<Vector2<f64>>,
        lift_m: f64,
        tool: &Tool,
        world: &WorldConfig,
        reach: &dyn Reach,
    ) -> Self {
        let length_m = (action.tool.end().point() - action.tool.start().point()).norm();
        let stations = (length_m / ALONG_STEP_M).ceil() as usize;
        let station =
            |row: usize| action.tool.at(action.tool.duration_s() * row as f64 / stations.max(1) as f64).pose();
        let is_free = |pose: &Isometry2<f64>| {
            let mut pieces = tool.pieces.iter().map(|piece| world.clearance_m(&piece.shape, &(pose * piece.pose())));
            pieces.all(|near| near.is_none_or(|near| near.1 >= CLEARANCE_M)) && reach.holds(pose)
        };
        let left = Vector2::new(-direction.y, direction.x);
        let widest = |side: f64| {
            let all_free = |aside_m: f64| {
                (0..=stations).all(|row| {
                    [0.0, lift_m].iter().all(|back_m| {
                        let shift = left * (side * aside_m) - direction.into_inner() * *back_m;
                        is_free(&(Translation2::from(shift) * station(row)))
                    })
                })
            };
            let asides = (0..=(WIDEST_M / ASIDE_STEP_M) as usize).map(|step| step as f64 * ASIDE_STEP_M);
            asides.take_while(|aside_m| all_free(*aside_m)).last().unwrap_or(0.0)
        };
        Self { left_m: widest(1.0), right_m: widest(-1.0) }
    }

    /// Whether the tool may be `aside_m` to the left of its way, m.
    pub(super) fn allows(&self, aside_m: f64) -> bool {
        (-self.right_m..=self.left_m).contains(&aside_m)
    }
}
