//! Holds that are renewed during a push: what it mends, when it does not happen, what it costs.

use nalgebra::{Isometry2, Point2, Vector2, Vector3};
use sim::planar::{
    ClosedLoop, ClosedLoopConfig, EngineConfig, MapBounds, Obstacle, Party, PlanarWorld, Pusher, ReferenceSource,
    WorldConfig,
};
use sim::random::{Purpose, stream};
use sim::sensing::{Camera, CameraConfig};
use skills::outline::Outline;
use skills::plan::{Action, ActionKind, Plan, PlanarMotion, Push, Track};
use skills::pushing::{HoldRenewalConfig, SteeringConfig};
use skills::time_law;
use skills::transfer::{Everywhere, Reach, RectangularReach};

use super::steering::{object, stick};

const RADIUS_M: f64 = 0.012;
const TICK_S: f64 = 0.001;
/// Time between two motions of the plan, s.
const STEP_S: f64 = 0.002;
const LENGTH_M: f64 = 0.08;
const START: Point2<f64> = Point2::new(0.045, 0.09);
/// The side of the stick, a face of 10 mm that pushes along −x, and its head, which pushes along +y.
const SIDE: usize = 0;
const HEAD: usize = 1;

/// Comes from 10 mm behind and pushes 80 mm in four seconds.
fn plan(surface: usize) -> Plan {
    let contact = stick().surfaces[surface].middle();
    let normal = contact.normal.into_inner();
    let touching = START - normal * RADIUS_M - contact.point.coords;
    let track = |from: Vector2<f64>, way: Vector2<f64>, duration_s: f64| {
        let rows = (duration_s / STEP_S).round();
        let motion = |row: usize| {
            let ratio = row as f64 / rows;
            let first = time_law::minimum_jerk_first_derivative(ratio) / duration_s;
            let second = time_law::minimum_jerk_second_derivative(ratio) / (duration_s * duration_s);
            PlanarMotion {
                position: (from + way * time_law::minimum_jerk(ratio)).push(0.0),
                velocity: (way * first).push(0.0),
                acceleration: (way * second).push(0.0),
            }
        };
        Track::new(STEP_S, (0..=rows as usize).map(motion).collect()).expect("finite")
    };
    let way = normal * LENGTH_M;
    let kind = ActionKind::ObjectOperating(Push { surface, place_m: 0.0, from_world: START, to_world: START + way });
    let come = Action {
        name: "come".into(),
        kind: ActionKind::ToolFlipping,
        tool: track(touching.coords - normal * 0.01, normal * 0.01, 1.0),
        object: track(START.coords, Vector2::zeros(), 1.0),
    };
    let push = Action {
        name: "push".into(),
        kind,
        tool: track(touching.coords, way, 4.0),
        object: track(START.coords, way, 4.0),
    };
    Plan::new(vec![come, push]).expect("a chain")
}

/// What is done to a push.
struct Trial {
    surface: usize,
    /// How far to the left of its line the disc starts, m.
    aside_m: f64,
    /// Velocity to the left that the disc is given on its way, m/s, and how far before the end, m.
    kick_m_per_s: f64,
    kick_before_end_m: f64,
    camera: CameraConfig,
    seed: u64,
    most_per_push: usize,
    obstacles: Vec<Obstacle>,
    reach: Box<dyn Reach>,
}

impl Default for Trial {
    fn default() -> Self {
        Self {
            surface: SIDE,
            aside_m: 0.0,
            kick_m_per_s: 0.0,
            kick_before_end_m: LENGTH_M / 2.0,
            camera: CameraConfig::perfect(),
            seed: 1,
            most_per_push: HoldRenewalConfig::default().most_per_push,
            obstacles: Vec::new(),
            reach: Box::new(Everywhere),
        }
    }
}

#[derive(Debug, PartialEq)]
struct Ending {
    /// Where the disc is at the end, to the left of its line and short of its end, m.
    deviation_m: f64,
    short_m: f64,
    renewals: u32,
    /// Smallest gap to the disc while the tool goes past it, m.
    gap_m: f64,
    /// Largest change of the reference's velocity from one period to the next in a renewal, m/s.
    speed_step_m_per_s: f64,
    /// Farthest of its places from where velocities have led it, m.
    jump_m: f64,
    hits_obstacle: bool,
}

/// Carries out a trial with a tool that is exactly where its reference is.
fn run(trial: &Trial) -> Ending {
    let (plan, tool, object) = (plan(trial.surface), stick(), object());
    let map = MapBounds { min_m: [-0.09, 0.0], max_m: [0.09, 0.18] };
    let table = WorldConfig { map, gravity_m_per_s2: 9.81, obstacles: trial.obstacles.clone() };
    let forward = tool.surfaces[trial.surface].middle().normal.into_inner();
    let left = Vector2::new(-forward.y, forward.x);
    let start = Isometry2::from(START + left * trial.aside_m);
    let mut world = PlanarWorld::new(&table, &object, &EngineConfig::default(), &start).expect("a valid scene");
    let config = ClosedLoopConfig {
        steering: SteeringConfig::default(),
        response_s: 0.05,
        patience: 2.0,
        hold_renewal: HoldRenewalConfig { most_per_push: trial.most_per_push, ..HoldRenewalConfig::default() },
    };
    let source = ClosedLoop::new(&plan, &tool, &object, &trial.camera, config, TICK_S);
    let mut source = source.renewing_holds(&table, trial.reach.as_ref());
    let tool_start = plan.actions()[0].tool.start();
    let pusher = Pusher::insert(&mut world, &tool, &tool_start.pose());
    let mut camera = Camera::new(&trial.camera, stream(trial.seed, Purpose::Camera, 0));
    let mut result = Ending {
        deviation_m: 0.0,
        short_m: 0.0,
        renewals: 0,
        gap_m: f64::INFINITY,
        speed_step_m_per_s: 0.0,
        jump_m: 0.0,
        hits_obstacle: false,
    };
    let (mut kicks, mut renews, mut ticks) = (trial.kick_m_per_s != 0.0, false, 0u32);
    let (mut finished, mut last) = (false, tool_start);
    while !finished && ticks < 15_000 {
        let time_s = f64::from(ticks) * TICK_S;
        let pose = pusher.world_from_tool(&world);
        let at = world.world_from_object();
        let sighting = camera.look(time_s, &at);
        let mut reference = None;
        let counted = allocation_counter::measure(|| reference = Some(source.next(time_s, &pose, sighting.as_ref())));
        assert_eq!(counted.count_total, 0, "at {time_s} s: {counted:?}");
        let reference = reference.expect("just asked");
        let aim = reference.tool.position.xy() + reference.tool.velocity.xy() * TICK_S;
        pusher.set_velocity(&mut world, &((aim - pose.translation.vector) / TICK_S), 0.0);
        let center = Point2::from(at.translation.vector);
        if reference.renews_hold {
            result.renewals += u32::from(!renews);
            let mean = (reference.tool.velocity + last.velocity) / 2.0;
            let step = (reference.tool.velocity - last.velocity).norm();
            result.speed_step_m_per_s = result.speed_step_m_per_s.max(step);
            let jump = (reference.tool.position - last.position - mean * TICK_S).norm();
            result.jump_m = result.jump_m.max(jump);
            // sideways at more than half of the push's mean speed
            if reference.tool.velocity.xy().dot(&left).abs() > 0.01 {
                let gap_m = tool.signed_distance_m(&pose.inverse_transform_point(&center)) - RADIUS_M;
                result.gap_m = result.gap_m.min(gap_m);
            }
        }
        (renews, last) = (reference.renews_hold, reference.tool);
        if kicks && (center - START).dot(&forward) > LENGTH_M - trial.kick_before_end_m {
            kicks = false;
            let kick = left * trial.kick_m_per_s;
            let twist = world.object_twist() + Vector3::new(kick.x, kick.y, 0.0);
            world.set_object_twist(&twist);
        }
        for _ in 0..2 {
            world.step();
            let mut contacts = world.contacts().iter();
            result.hits_obstacle |=
                contacts.any(|contact| contact.force_on_n(Party::Tool, Party::Obstacle(0)).is_some());
        }
        finished = reference.finished;
        ticks += 1;
    }
    assert!(finished, "the push took longer than 15 s");
    let off = Point2::from(world.world_from_object().translation.vector) - START;
    (result.deviation_m, result.short_m) = (off.dot(&left), LENGTH_M - off.dot(&forward));
    result
}

/// The same trial without any renewal.
fn never(trial: Trial) -> Ending {
    run(&Trial { most_per_push: 0, ..trial })
}

#[test]
fn on_a_face_half_of_a_deviation_stays_unless_the_hold_is_renewed() {
    for aside_m in [0.003, 0.0035, -0.004] {
        let kept = never(Trial { aside_m, ..Trial::default() });
        // the disc rolls until its offset is 9/4 of what is left: half of it
        assert!((kept.deviation_m - aside_m / 2.0).abs() < 0.0001, "{kept:?}");
        let renewed = run(&Trial { aside_m, ..Trial::default() });
        assert_eq!(renewed.renewals, 1);
        assert!(renewed.deviation_m.abs() < 0.0003, "{renewed:?}");
        assert!(renewed.short_m.abs() < 0.0005, "{renewed:?}");
    }
}

#[test]
fn a_kick_that_the_surface_cannot_mend_in_one_hold_is_mended_in_several() {
    for kick_m_per_s in [0.12, 0.14, -0.14] {
        let kept = never(Trial { kick_m_per_s, ..Trial::default() });
        assert!(kept.deviation_m.abs() > 0.0025, "{kept:?}");
        let renewed = run(&Trial { kick_m_per_s, ..Trial::default() });
        assert!((1..=3).contains(&renewed.renewals));
        assert!(renewed.deviation_m.abs() < 0.001, "{renewed:?}");
    }
}

#[test]
fn a_late_and_noisy_camera_is_enough_to_renew_holds() {
    let camera = CameraConfig { bias_m: 0.0, ..CameraConfig::default() };
    for (aside_m, kick_m_per_s, seed) in [(0.0035, 0.0, 1), (-0.0035, 0.0, 2), (0.0, 0.14, 3), (0.0, -0.14, 4)] {
        let renewed = run(&Trial { aside_m, kick_m_per_s, camera: camera.clone(), seed, ..Trial::default() });
        assert!(renewed.renewals >= 1 && renewed.deviation_m.abs() < 0.001, "{renewed:?}");
    }
}

#[test]
fn an_undisturbed_push_keeps_its_hold() {
    let camera = CameraConfig { bias_m: 0.0, ..CameraConfig::default() };
    for (surface, seed) in [(SIDE, 1), (SIDE, 2), (HEAD, 1), (HEAD, 2)] {
        let trial = || Trial { surface, seed, camera: camera.clone(), ..Trial::default() };
        let usual = run(&trial());
        assert_eq!(usual.renewals, 0);
        assert_eq!(usual, never(trial()));
    }
}

#[test]
fn a_round_head_mends_by_leaning_and_keeps_its_hold() {
    for aside_m in [0.001, -0.003] {
        let trial = || Trial { surface: HEAD, aside_m, ..Trial::default() };
        let usual = run(&trial());
        assert_eq!(usual.renewals, 0);
        assert!(usual.deviation_m.abs() < aside_m.abs() / 2.0, "{usual:?}");
        assert_eq!(usual, never(trial()));
    }
}

#[test]
fn renewals_stop_at_their_number_and_before_the_end() {
    let once = run(&Trial { aside_m: 0.006, most_per_push: 1, ..Trial::default() });
    assert_eq!(once.renewals, 1);
    let late = run(&Trial { kick_m_per_s: 0.14, kick_before_end_m: 0.012, ..Trial::default() });
    assert_eq!(late.renewals, 0);
}

#[test]
fn a_renewal_passes_the_object_at_its_lift_and_without_jumps() {
    let renewed = run(&Trial { aside_m: 0.0035, ..Trial::default() });
    // 3 mm, less what the disc coasts and the belief errs
    assert!(renewed.gap_m > 0.0025, "{renewed:?}");
    // 3 mm in 0.2 s: 5.77·0.003/0.04 = 0.43 m/s²; what the push leaves adds (10/√3)·0.02/0.2
    assert!(renewed.speed_step_m_per_s < (0.43 + 0.58) * TICK_S * 1.1, "{renewed:?}");
    // the trapezoidal rule errs by jerk·dt³/12, with a jerk of up to 60·0.003/0.008 m/s³ and as much again
    assert!(renewed.jump_m < 1e-8, "{renewed:?}");
}

#[test]
fn no_hold_is_renewed_where_an_obstacle_or_the_reach_leaves_no_room() {
    // the tool would have to go 5.7 mm aside; its rear end comes within 4.5 mm of the wall, or of where the arm ends
    let rear_y_m = START.y - 0.019;
    let wall = Obstacle {
        name: "wall".into(),
        shape: Outline::Box { width_m: 0.17, height_m: 0.02 },
        position_m: [0.0, rear_y_m - 0.0045 - 0.01],
        angle_rad: 0.0,
        friction: 0.3,
    };
    let reach = || Box::new(RectangularReach { min_m: [-1.0, rear_y_m - 0.0045], max_m: [1.0, 1.0] });
    let kept = never(Trial { aside_m: 0.0035, ..Trial::default() });
    let walled = |aside_m| run(&Trial { aside_m, obstacles: vec![wall.clone()], ..Trial::default() });
    assert_eq!(walled(0.0035), kept);
    assert_eq!(run(&Trial { aside_m: 0.0035, reach: reach(), ..Trial::default() }), kept);
    // the other side is free
    assert!(walled(-0.0035).renewals == 1 && !walled(-0.0035).hits_obstacle);
    assert_eq!(run(&Trial { aside_m: -0.0035, reach: reach(), ..Trial::default() }).renewals, 1);
}

#[test]
fn renewals_are_a_function_of_the_seed() {
    let ending = |seed| run(&Trial { aside_m: 0.0035, camera: CameraConfig::default(), seed, ..Trial::default() });
    assert_eq!(ending(5), ending(5));
    assert_ne!(ending(5), ending(6));
}
