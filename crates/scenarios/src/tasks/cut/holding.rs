//! The knife in the hand: the part of its edge that strokes are planned for, and what of a plan that makes the tool do.

use nalgebra::{Isometry3, Point3, Translation3};
use sim::cutting::knife::{Edge, Knife};
use skills::cutting::Blade;
use skills::spatial::{SpatialAction, SpatialError, SpatialKnot, SpatialMotion, SpatialPlan, SpatialTrack};

/// How much the edge may rise above its straight part to be used like it, m: half of what a stroke goes past the board.
const LEVEL_M: f64 = 0.0001;
/// Length at each end of the level part that is not used, m.
const SPARE_M: f64 = 0.002;

/// The part of a knife's edge that is level, as skills see it: an edge with its frame in the middle.
#[derive(Clone, Debug)]
pub(super) struct LevelEdge {
    /// The level part: straight.
    pub blade: Blade,
    /// Pose of its frame, in its middle, in the knife's.
    pub knife_from_blade: Isometry3<f64>,
}

impl LevelEdge {
    /// The level part of a knife, from its heel on: a belly that rises toward the tip is left out of it.
    pub fn of(knife: &Knife) -> Self {
        let (begin_m, end_m) = level_m(&knife.edge);
        let blade = Blade { edge_m: end_m - begin_m, belly_radius_m: None, spare_m: SPARE_M };
        Self { blade, knife_from_blade: Translation3::new(0.5 * (begin_m + end_m), 0.0, 0.0).into() }
    }
}

/// Where the edge begins and where it first rises above its heel by more than [`LEVEL_M`], along x of the knife, m.
fn level_m(edge: &Edge) -> (f64, f64) {
    let Some(heel) = edge.points.first() else { return (0.0, 0.0) };
    let rise = |y: f64| heel.y - y;
    let mut end_m = heel.x;
    for pair in edge.points.windows(2) {
        let (from, to) = (pair[0], pair[1]);
        if rise(to.y) <= LEVEL_M {
            end_m = to.x;
            continue;
        }
        let share = ((LEVEL_M - rise(from.y)) / (rise(to.y) - rise(from.y))).clamp(0.0, 1.0);
        end_m = from.x + share * (to.x - from.x);
        break;
    }
    (heel.x, end_m)
}

/// The edge as a polyline in another frame.
pub(super) fn edge_in(knife: &Knife, frame_from_knife: &Isometry3<f64>) -> Vec<Point3<f64>> {
    knife.edge.points.iter().map(|point| frame_from_knife * Point3::new(point.x, point.y, 0.0)).collect()
}

/// The plan of another frame that is fixed to the tool: `frame_from_other` is its pose in the plan's frame.
pub(super) fn carried(plan: &SpatialPlan, frame_from_other: &Isometry3<f64>) -> Result<SpatialPlan, SpatialError> {
    let knot = |knot: &SpatialKnot| SpatialKnot { time_s: knot.time_s, motion: moved(&knot.motion, frame_from_other) };
    let actions = plan.actions().iter().map(|action| {
        let track = SpatialTrack::new(action.track.knots().iter().map(knot).collect())?;
        Ok(SpatialAction::new(action.name.clone(), action.phase, track))
    });
    SpatialPlan::new(actions.collect::<Result<_, SpatialError>>()?)
}

/// Motion of a frame that is fixed to another: v + ω×r, and a + α×r + ω×(ω×r).
fn moved(motion: &SpatialMotion, frame_from_other: &Isometry3<f64>) -> SpatialMotion {
    let arm = motion.pose.rotation * frame_from_other.translation.vector;
    let part = |twist: &nalgebra::Vector6<f64>, from: usize| twist.fixed_rows::<3>(from).into_owned();
    let (spin, spin_change) = (part(&motion.velocity, 3), part(&motion.acceleration, 3));
    let velocity = part(&motion.velocity, 0) + spin.cross(&arm);
    let acceleration = part(&motion.acceleration, 0) + spin_change.cross(&arm) + spin.cross(&spin.cross(&arm));
    SpatialMotion::new(motion.pose * frame_from_other, [velocity, spin], [acceleration, spin_change])
}

#[cfg(test)]
mod tests {
    use approx::assert_relative_eq;
    use nalgebra::{UnitQuaternion, Vector3};
    use sim::cutting::knife::KnifeFile;
    use skills::spatial::{ActionPhase, FreeMoveConfig, free_move};

    use super::*;

    fn knife(text: &str) -> Knife {
        toml::from_str::<KnifeFile>(text).unwrap().knife().unwrap()
    }

    #[test]
    fn a_straight_edge_is_level_and_a_belly_is_left_out() {
        let cleaver = LevelEdge::of(&knife(include_str!("../../../../../assets/knives/cleaver.toml")));
        assert_relative_eq!(cleaver.blade.edge_m, 0.180, epsilon = 1e-12);
        assert_relative_eq!(cleaver.knife_from_blade.translation.x, 0.090, epsilon = 1e-12);
        // 35 % of 200 mm are straight; the belly of 400 mm rises by 0.1 mm in 8.9 mm, on its chords a little sooner
        let chef = LevelEdge::of(&knife(include_str!("../../../../../assets/knives/chef.toml")));
        assert!((0.0740..0.0790).contains(&chef.blade.edge_m), "{}", chef.blade.edge_m);
    }

    #[test]
    fn a_carried_plan_moves_as_its_poses_do() {
        let turn = UnitQuaternion::from_euler_angles(0.4, -0.3, 0.9);
        let ends = [Isometry3::identity(), Isometry3::from_parts(Translation3::new(0.1, 0.2, -0.1), turn)];
        let track = free_move(&FreeMoveConfig::default(), &ends).unwrap();
        let plan = SpatialPlan::new(vec![SpatialAction::new("go", ActionPhase::Travel, track)]).unwrap();
        let offset = Isometry3::translation(0.05, -0.02, 0.01);
        let carried = carried(&plan, &offset).unwrap();
        // at the knots the poses are those of the body, and the rates are their derivatives
        assert_eq!(carried.duration_s(), plan.duration_s());
        let step_s = 1e-6;
        let time_s = 0.4 * plan.duration_s();
        let rate = (carried.at(time_s + step_s).pose.translation.vector
            - carried.at(time_s - step_s).pose.translation.vector)
            / (2.0 * step_s);
        let told: Vector3<f64> = carried.at(time_s).velocity.fixed_rows::<3>(0).into_owned();
        assert_relative_eq!(rate, told, epsilon = 1e-6);
        let end = carried.at(plan.duration_s()).pose;
        assert_relative_eq!(end.translation.vector, (ends[1] * offset).translation.vector, epsilon = 1e-9);
    }
}
