//! Judging by hand-made plans and episodes.

use nalgebra::Vector3;
use sim::planar::MapBounds;
use sim::support::SupportModel;
use skills::outline::Outline;
use skills::plan::{Action, PlanarMotion, Track};

use super::*;

fn stick() -> Tool {
    toml::from_str(include_str!("../../../../../assets/tools/stick.toml")).unwrap()
}

/// A way of the tool's origin along y at `x_m`, past a disc that rests at (0.05, 0.10).
fn way_past_the_disc(x_m: f64) -> Plan {
    let rest = PlanarMotion::at_rest(Vector3::new(0.05, 0.10, 0.0));
    let at = |row: i32| PlanarMotion::at_rest(Vector3::new(x_m, 0.001 * f64::from(row), 0.0));
    let tool = Track::new(0.01, (0..150).map(at).collect()).unwrap();
    let object = Track::new(0.01, vec![rest; 150]).unwrap();
    Plan::new(vec![Action { name: "flip".into(), kind: ActionKind::ToolFlipping, tool, object }]).unwrap()
}

fn checked(x_m: f64) -> Result<(), String> {
    let object = ObjectConfig {
        name: "disc".into(),
        shape: Outline::Disc { radius_m: 0.012 },
        mass_kg: 0.0054,
        table_friction: 0.25,
        support: SupportModel::Ellipsoid,
    };
    let map = MapBounds { min_m: [-0.2, -0.2], max_m: [0.2, 0.2] };
    let world = WorldConfig { map, gravity_m_per_s2: 9.81, obstacles: vec![] };
    check_plan(&way_past_the_disc(x_m), &stick(), &object, &world)
}

#[test]
fn a_way_through_the_object_is_refused_wherever_the_object_stands() {
    // half the stick and the disc's radius: 18 mm from center to center
    assert!(checked(0.05).unwrap_err().contains("into the object in the action 'flip'"));
    assert!(checked(0.05 + 0.0175).is_err());
    assert_eq!(checked(0.05 + 0.0185), Ok(()));
    assert_eq!(checked(0.05 - 0.0185), Ok(()));
}

#[test]
fn a_collision_and_a_renewed_hold_are_counted_when_they_begin() {
    let sample = |hits_obstacle, renews_hold| EpisodeSample {
        time_s: 0.0,
        phase: 0,
        world_from_tool: Isometry2::identity(),
        world_from_tool_reference: Isometry2::identity(),
        world_from_object: Isometry2::identity(),
        world_from_object_expected: Isometry2::identity(),
        renews_hold,
        tool_force_n: 0.0,
        slip_m_per_s: 0.0,
        hits_obstacle,
        joint_error_rad: 0.0,
        torque_share: 0.0,
        power_w: 0.0,
    };
    let count = |all: &[bool]| {
        let episode = |samples| {
            let digest = String::new();
            Episode { samples, control_period_s: 0.001, finished: true, interruption: None, digest }
        };
        let hit = episode(all.iter().map(|hit| sample(*hit, false)).collect());
        let renewed = episode(all.iter().map(|renews| sample(false, *renews)).collect());
        assert_eq!((renewed_holds(&hit), collisions(&renewed)), (0.0, 0.0));
        assert_eq!(renewed_holds(&renewed), collisions(&hit));
        collisions(&hit)
    };
    assert_eq!(count(&[]), 0.0);
    assert_eq!(count(&[false, false]), 0.0);
    assert_eq!(count(&[true, true, false, true, false]), 2.0);
    assert_eq!(count(&[false, true, true]), 1.0);
}
