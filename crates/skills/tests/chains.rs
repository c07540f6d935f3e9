//! Random chains of pushes and flips made of minimum-jerk motions: strict as they are, refused with a jump put in.

#![allow(clippy::unwrap_used, clippy::panic, clippy::indexing_slicing)]

use nalgebra::{Point2, Vector2, Vector3};
use proptest::prelude::*;
use skills::outline::{Outline, PlacedOutline};
use skills::plan::{Action, ActionKind, ChainError, ChainTolerances, Plan, PlanarMotion, Push, Setting, Track};
use skills::time_law::{minimum_jerk, minimum_jerk_first_derivative, minimum_jerk_second_derivative};
use skills::tool::{ContactSurface, SurfaceShape, Tool};

const STEP_S: f64 = 0.01;
const RADIUS_M: f64 = 0.012;
const DISC: Outline = Outline::Disc { radius_m: RADIUS_M };
/// Mean speed of every motion, m/s.
const SPEED_M_PER_S: f64 = 0.05;

/// A square that pushes to the left and forward with the middles of its sides.
fn square() -> Tool {
    let face = |name: &str, start_m, end_m| ContactSurface::new(name, SurfaceShape::Face { start_m, end_m });
    Tool {
        name: "square".into(),
        description: String::new(),
        mass_kg: 0.01,
        friction: 0.3,
        pieces: vec![PlacedOutline {
            shape: Outline::Box { width_m: 0.02, height_m: 0.02 },
            position_m: [0.0; 2],
            angle_rad: 0.0,
        }],
        surfaces: vec![face("left", [-0.01, 0.005], [-0.01, -0.005]), face("front", [0.005, 0.01], [-0.005, 0.01])],
    }
}

const NORMALS: [[f64; 2]; 2] = [[-1.0, 0.0], [0.0, 1.0]];
/// Distance of the tool's origin from the object's center in a hold, m.
const HOLD_M: f64 = 0.01 + RADIUS_M;
/// Where the tool may go from hold to hold, from the object's center, m.
const AWAY: Vector2<f64> = Vector2::new(0.05, -0.05);

fn steps(length_m: f64) -> usize {
    (length_m / SPEED_M_PER_S / STEP_S).ceil().max(10.0) as usize
}

/// A minimum-jerk motion between two places.
fn track(from: Point2<f64>, to: Point2<f64>, steps: usize) -> Track {
    let (duration_s, way) = (steps as f64 * STEP_S, (to - from).push(0.0));
    let motion = |row: usize| {
        let ratio = row as f64 / steps as f64;
        PlanarMotion {
            position: Vector3::new(from.x, from.y, 0.0) + way * minimum_jerk(ratio),
            velocity: way * (minimum_jerk_first_derivative(ratio) / duration_s),
            acceleration: way * (minimum_jerk_second_derivative(ratio) / duration_s.powi(2)),
        }
    };
    Track::new(STEP_S, (0..=steps).map(motion).collect()).unwrap()
}

/// A chain of pushes with the ways of the tool between them.
fn chain(pushes: &[(usize, f64)]) -> Plan {
    let mut center = Point2::new(0.02, -0.01);
    let mut tool = center + AWAY;
    let mut actions = Vec::new();
    for (surface, length_m) in pushes {
        let normal = Vector2::from(NORMALS[*surface]);
        let hold = center - normal * HOLD_M;
        // out along the hold's own normal or in along the next one, never past the object
        let corner = center - normal * AWAY.x;
        for (name, to) in [("to corner", center + AWAY), ("to normal", corner), ("approach", hold)] {
            let steps = steps((to - tool).norm());
            let (way, object) = (track(tool, to, steps), track(center, center, steps));
            actions.push(Action { name: name.into(), kind: ActionKind::ToolFlipping, tool: way, object });
            tool = to;
        }
        let to = center + normal * *length_m;
        let push = Push { surface: *surface, place_m: 0.0, from_world: center, to_world: to };
        actions.push(Action {
            name: "push".into(),
            kind: ActionKind::ObjectOperating(push),
            tool: track(tool, tool + normal * *length_m, steps(*length_m)),
            object: track(center, to, steps(*length_m)),
        });
        (center, tool) = (to, tool + normal * *length_m);
        let away = center - normal * AWAY.x;
        let steps = steps((away - tool).norm());
        let (out, object) = (track(tool, away, steps), track(center, center, steps));
        actions.push(Action { name: "leave".into(), kind: ActionKind::ToolFlipping, tool: out, object });
        tool = away;
    }
    Plan::new(actions).unwrap()
}

fn verify(plan: &Plan) -> Result<(), ChainError> {
    let tool = square();
    let setting = Setting { tool: &tool, object: &DISC, obstacles: &[] };
    plan.verify(Some(&setting), &ChainTolerances::default()).map(|_| ())
}

fn pushes() -> impl Strategy<Value = Vec<(usize, f64)>> {
    prop::collection::vec((0usize..2, 0.01f64..0.1), 1..5)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn random_chains_are_strict(pushes in pushes()) {
        let plan = chain(&pushes);
        prop_assert_eq!(verify(&plan), Ok(()));
        let (built, report) = Plan::verified(plan.actions().to_vec(), None, &ChainTolerances::default()).unwrap();
        prop_assert_eq!((&built, report.violations().count()), (&plan, 0));
        // minimum-jerk motions begin and end without acceleration: the chain is C2
        prop_assert!(plan.joints().iter().all(|joint| joint.tool.acceleration_m_per_s2 < 1e-9));
    }

    #[test]
    fn a_chain_with_a_jump_is_refused_wherever_it_is(
        pushes in pushes(), action in 0.0f64..1.0, row in 0.0f64..1.0, beyond in 1.01f64..100.0, kind in 0usize..4,
        of_tool in any::<bool>(),
    ) {
        let mut actions = chain(&pushes).actions().to_vec();
        let index = (action * actions.len() as f64) as usize;
        let chosen = &mut actions[index];
        let target = if of_tool { &mut chosen.tool } else { &mut chosen.object };
        let mut motions = target.motions().to_vec();
        // within, where the joints do not see it
        let row = 1 + (row * (motions.len() - 2) as f64) as usize;
        let limits = ChainTolerances::default();
        match kind {
            0 => motions[row].position.x += beyond * limits.position_m,
            1 => motions[row].position.z -= beyond * limits.angle_rad,
            2 => motions[row].velocity.y -= beyond * limits.velocity_m_per_s,
            _ => motions[row].velocity.z += beyond * limits.angular_velocity_rad_per_s,
        }
        *target = Track::new(STEP_S, motions).unwrap();
        let refused = verify(&Plan::new(actions).unwrap());
        prop_assert!(matches!(refused, Err(ChainError::Inside { .. })), "{refused:?}");
    }

    #[test]
    fn a_velocity_that_jumps_at_a_joint_is_refused(pushes in pushes(), action in 0.0f64..1.0, beyond in 1.01f64..100.0) {
        let mut actions = chain(&pushes).actions().to_vec();
        let index = 1 + (action * (actions.len() - 1) as f64) as usize;
        let mut motions = actions[index].tool.motions().to_vec();
        motions[0].velocity.x += beyond * ChainTolerances::default().velocity_m_per_s;
        actions[index].tool = Track::new(STEP_S, motions).unwrap();
        let refused = verify(&Plan::new(actions.clone()).unwrap());
        prop_assert!(matches!(refused, Err(ChainError::Joint { .. })), "{refused:?}");
        // and never built by who asks for a strict chain
        prop_assert_eq!(Plan::verified(actions, None, &ChainTolerances::default()).map(|_| ()), refused);
    }

    #[test]
    fn a_chain_is_strict_at_any_pace(pushes in pushes(), action in 0.0f64..1.0, factor in 0.7f64..4.0) {
        let plan = chain(&pushes);
        let index = (action * plan.actions().len() as f64) as usize;
        prop_assert_eq!(verify(&plan.retimed(index, factor).unwrap()), Ok(()));
    }
}
