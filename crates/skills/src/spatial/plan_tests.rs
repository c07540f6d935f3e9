//! Plans in space: joints, times, limits, and free moves.

use nalgebra::{Isometry3, UnitQuaternion, Vector3};
use proptest::prelude::*;

use super::*;
use crate::spatial::{ActionPhase, FreeMoveConfig, SpatialAction, free_move, over};

fn place(x: f64, y: f64, z: f64) -> Isometry3<f64> {
    Isometry3::translation(x, y, z)
}

fn action(name: &str, poses: &[Isometry3<f64>]) -> SpatialAction {
    SpatialAction::new(name, ActionPhase::Travel, free_move(&FreeMoveConfig::default(), poses).unwrap())
}

fn plan() -> SpatialPlan {
    let (a, b, c) = (place(0.0, 0.0, 0.1), place(0.2, 0.0, 0.1), place(0.2, 0.1, 0.3));
    SpatialPlan::new(vec![action("there", &[a, b]), action("on", &[b, c])]).unwrap()
}

#[test]
fn actions_follow_each_other_in_time() {
    let plan = plan();
    let [first_s, second_s] = [0, 1].map(|k| plan.actions()[k].track.duration_s());
    assert_eq!(plan.duration_s(), first_s + second_s);
    assert_eq!(plan.due_at(first_s + 0.25).0, 1);
    assert!((plan.due_at(first_s + 0.25).1 - 0.25).abs() < 1e-12);
    assert_eq!(plan.at(0.5 * first_s).pose.translation.vector.x, 0.1);
    assert_eq!(plan.at(plan.duration_s()).pose, place(0.2, 0.1, 0.3));
    assert_eq!(plan.at(99.0).velocity, nalgebra::Vector6::zeros());
}

#[test]
fn a_gap_between_actions_is_refused_with_its_size() {
    let actions = vec![
        action("there", &[place(0.0, 0.0, 0.0), place(0.1, 0.0, 0.0)]),
        action("on", &[place(0.102, 0.0, 0.0), place(0.2, 0.0, 0.0)]),
    ];
    match SpatialPlan::new(actions) {
        Err(SpatialError::Joint { quantity: "place", found, .. }) => assert!((found - 0.002).abs() < 1e-12),
        other => panic!("{other:?}"),
    }
    assert_eq!(SpatialPlan::new(vec![]), Err(SpatialError::NoActions));
}

#[test]
fn the_workspace_is_checked_between_knots_and_rates_against_their_limits() {
    let plan = plan();
    let limits = SpatialLimits { workspace_m: Some([[-0.1, -0.1, 0.0], [0.3, 0.2, 0.29]]), ..Default::default() };
    assert!(matches!(plan.verify(&limits), Err(SpatialError::Workspace { axis: 'z', .. })));
    let limits = SpatialLimits { workspace_m: Some([[-0.1, -0.1, 0.0], [0.3, 0.2, 0.4]]), ..Default::default() };
    let report = plan.verify(&limits).unwrap();
    // the first leg lies 0.1 m above the floor of the box and beside two of its walls, the second ends below its lid
    assert!((report.workspace_margin_m - 0.1).abs() < 1e-9);
    assert!(report.rates.speed_m_per_s >= 0.2 && report.rates.speed_m_per_s < 0.21, "{report:?}");
    let slow = SpatialLimits { speed_m_per_s: 0.15, ..Default::default() };
    assert!(matches!(plan.verify(&slow), Err(SpatialError::Rate { quantity: "speed", .. })));
}

#[test]
fn a_move_over_an_obstacle_rises_before_it_travels() {
    let (from, to) = (place(0.0, 0.0, 0.0), place(0.4, 0.0, 0.05));
    let poses = over(&from, &to, 0.3);
    assert_eq!(poses.len(), 4);
    let track = free_move(&FreeMoveConfig { overlap: 0.0, ..Default::default() }, &poses).unwrap();
    for step in 0..=1000 {
        let at = track.at(track.duration_s() * f64::from(step) / 1000.0).pose.translation.vector;
        assert!(at.z > 0.3 - 1e-9 || at.x.abs() < 1e-9 || (at.x - 0.4).abs() < 1e-9);
    }
    // an end that is high enough needs no via point
    assert_eq!(over(&place(0.0, 0.0, 0.3), &place(0.1, 0.0, 0.3), 0.3).len(), 2);
}

proptest! {
    #[test]
    fn free_moves_keep_their_speed_their_ends_and_the_hull_of_their_places(
        places in prop::collection::vec(prop::array::uniform3(-0.3f64..0.3), 2..6), overlap in 0.0f64..0.5,
        turns in prop::collection::vec(prop::array::uniform3(-0.8f64..0.8), 6),
    ) {
        let poses: Vec<_> = places.iter().zip(&turns).map(|(place, turn)| {
            Isometry3::from_parts(Vector3::from(*place).into(), UnitQuaternion::from_scaled_axis(Vector3::from(*turn)))
        }).collect();
        let config = FreeMoveConfig { overlap, ..Default::default() };
        let track = free_move(&config, &poses).unwrap();
        let apart = |a: &Isometry3<f64>, b: &Isometry3<f64>| {
            (a.translation.vector - b.translation.vector).norm() + a.rotation.angle_to(&b.rotation)
        };
        prop_assert!(apart(&track.start().pose, &poses[0]) < 1e-7);
        prop_assert!(apart(&track.end().pose, &poses[poses.len() - 1]) < 1e-7);
        prop_assert!(track.start().velocity.norm() < 1e-12 && track.end().velocity.norm() < 1e-12);
        prop_assert!(track.start().acceleration.norm() < 1e-9 && track.end().acceleration.norm() < 1e-9);
        for axis in 0..3 {
            let (low, high) = places.iter().fold((f64::MAX, f64::MIN), |(low, high), place| {
                (low.min(place[axis]), high.max(place[axis]))
            });
            for step in 0..=200 {
                let at = track.at(track.duration_s() * f64::from(step) / 200.0);
                let x = at.pose.translation.vector[axis];
                prop_assert!((low - 1e-9..=high + 1e-9).contains(&x));
                // two legs at most are under way at once
                prop_assert!(at.linear_velocity().norm() <= 2.0 * config.speed_m_per_s + 1e-9);
            }
        }
    }
}
