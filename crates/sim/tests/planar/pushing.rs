//! Validation of planar pushing against closed forms and an independent quasi-static integrator.
//!
//! Disc of radius 12 mm, table friction 0.25, gravity 9.81 m/s² unless said otherwise.

use nalgebra::{Isometry2, Point2, Rotation2, Vector2, Vector3};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use sim::planar::{EngineConfig, MapBounds, ObjectConfig, Party, PlanarWorld, Pusher, WorldConfig};
use sim::support::SupportModel;
use skills::outline::{Outline, PlacedOutline};
use skills::tool::{ContactSurface, SurfaceShape, Tool};

use super::quasi_static;

const RADIUS: f64 = 0.012;
const TABLE: f64 = 0.25;
const GRAVITY: f64 = 9.81;
/// Moment-to-force ratio of a disc under uniform pressure: two thirds of its radius.
const DISC_LENGTH: f64 = 0.008;
/// Head and disc, or face and disc, touch without pressing.
const TOUCHING: f64 = 0.0;

fn world_config() -> WorldConfig {
    WorldConfig {
        map: MapBounds { min_m: [-1.0, -1.0], max_m: [1.0, 1.0] },
        gravity_m_per_s2: GRAVITY,
        obstacles: vec![],
    }
}

fn object(shape: Outline, support: SupportModel) -> ObjectConfig {
    ObjectConfig { name: "object".into(), shape, mass_kg: 0.0054, table_friction: TABLE, support }
}

fn disc(support: SupportModel) -> ObjectConfig {
    object(Outline::Disc { radius_m: RADIUS }, support)
}

fn square() -> ObjectConfig {
    object(Outline::Box { width_m: 0.04, height_m: 0.04 }, SupportModel::Ellipsoid)
}

fn tool(shape: Outline, friction: f64) -> Tool {
    let pieces = vec![PlacedOutline { shape, position_m: [0.0, 0.0], angle_rad: 0.0 }];
    let face = SurfaceShape::Face { start_m: [0.0, 0.0], end_m: [1.0, 0.0] };
    let surfaces = vec![ContactSurface::new("face", face)];
    Tool { name: "pusher".into(), description: String::new(), mass_kg: 0.02, friction, pieces, surfaces }
}

fn build(object: &ObjectConfig, engine: &EngineConfig) -> PlanarWorld {
    PlanarWorld::new(&world_config(), object, engine, &Isometry2::identity()).expect("valid scene")
}

/// Distance, duration and turn of a free slide from `twist`.
fn slide(support: SupportModel, twist: Vector3<f64>) -> (f64, f64, f64) {
    let mut world = build(&disc(support), &EngineConfig::default());
    world.set_object_twist(&twist);
    let mut turned = 0.0;
    while world.object_twist() != Vector3::zeros() {
        world.step();
        turned += world.object_twist().z * world.time_step_s();
        assert!(world.time_s() < 1.0, "never stops");
    }
    (world.world_from_object().translation.vector.norm(), world.time_s(), turned)
}

/// Moves a pusher with a constant velocity over `travel` and returns the object's pose (x, y, angle).
fn push(
    object: &ObjectConfig,
    engine: &EngineConfig,
    tool: &Tool,
    start: Vector2<f64>,
    velocity: Vector2<f64>,
    travel: f64,
) -> Vector3<f64> {
    let mut world = build(object, engine);
    let pusher = Pusher::insert(&mut world, tool, &Isometry2::new(start, 0.0));
    pusher.set_velocity(&mut world, &velocity, 0.0);
    let steps = (travel / velocity.norm() / world.time_step_s()).round() as usize;
    let mut turned = 0.0;
    for _ in 0..steps {
        world.step();
        turned += world.object_twist().z * world.time_step_s();
    }
    let at = world.world_from_object().translation;
    Vector3::new(at.x, at.y, turned)
}

fn assert_close(what: &str, seen: f64, expected: f64, tolerance: f64) {
    println!("{what}: {seen:.6} expected {expected:.6} ({:+.2} %)", 100.0 * (seen - expected) / expected);
    assert!(
        (seen - expected).abs() <= tolerance * expected.abs(),
        "{what}: {seen} differs from {expected} by more than {tolerance} of it"
    );
}

/// A flat face below the disc, pushing upward at `angle` from its normal.
fn face_push(engine: &EngineConfig, support: SupportModel, angle: f64, friction: f64) -> Vector3<f64> {
    face_push_at(0.02, engine, support, angle, friction)
}

/// The same at another speed, m/s.
fn face_push_at(speed: f64, engine: &EngineConfig, support: SupportModel, angle: f64, friction: f64) -> Vector3<f64> {
    let face = tool(Outline::Box { width_m: 0.2, height_m: 0.01 }, friction);
    let velocity = Rotation2::new(-angle) * Vector2::new(0.0, speed);
    push(&disc(support), engine, &face, Vector2::new(0.0, -RADIUS - 0.005 - TOUCHING), velocity, 0.050)
}

#[test]
fn p1_a_slide_stops_after_v_squared_over_two_mu_g() {
    let (distance, time, _) = slide(SupportModel::Ellipsoid, Vector3::new(0.3, 0.0, 0.0));
    // one-step-per-dt schemes lose half a step of travel
    let lost = 0.3 * EngineConfig::default().time_step_s / 2.0;
    assert_close("distance", distance, 0.3 * 0.3 / (2.0 * TABLE * GRAVITY) - lost, 0.005);
    assert_close("time", time, 0.3 / (TABLE * GRAVITY), 0.005);
}

#[test]
fn p2_a_spin_stops_after_three_quarters_of_rim_speed_over_mu_g() {
    let (_, time, turned) = slide(SupportModel::Ellipsoid, Vector3::new(0.0, 0.0, 30.0));
    assert_close("time", time, 3.0 * RADIUS * 30.0 / (4.0 * TABLE * GRAVITY), 0.02);
    assert_close("turn", turned, 1.651, 0.02);
}

#[test]
fn p3_slide_and_spin_follow_the_chosen_law() {
    let twist = Vector3::new(0.3, 0.0, 25.0);
    let (ellipsoid, ..) = slide(SupportModel::Ellipsoid, twist);
    assert_close("ellipsoid", ellipsoid, 0.02247, 0.02);
    let (exact, time, _) = slide(SupportModel::SupportPoints { count: 256 }, twist);
    assert_close("exact pressure", exact, 0.02339, 0.02);
    assert_close("common end of both motions", time, 0.163, 0.02);
}

#[test]
fn p4_the_sticking_cone_of_a_disc_is_wider_than_the_friction_cone() {
    // atan(mu_c (1 + R²/c²)) for the ellipsoid; for exact pressure 51.55 degrees
    for (support, half_angle) in
        [(SupportModel::Ellipsoid, 44.27_f64), (SupportModel::SupportPoints { count: 256 }, 51.55)]
    {
        let slips = |angle: f64| {
            let mut world = build(&disc(support.clone()), &EngineConfig::default());
            let face = tool(Outline::Box { width_m: 0.2, height_m: 0.01 }, 0.3);
            let pusher = Pusher::insert(&mut world, &face, &Isometry2::translation(0.0, -RADIUS - 0.005));
            let velocity = Rotation2::new(-angle.to_radians()) * Vector2::new(0.0, 0.02);
            pusher.set_velocity(&mut world, &velocity, 0.0);
            let mut slipped = 0.0;
            for step in 0..1000 {
                world.step();
                let slip: f64 = world.contacts().iter().map(|contact| contact.slip_m_per_s.abs()).sum();
                slipped += if step >= 500 { slip * world.time_step_s() } else { 0.0 };
            }
            // a slip of 1 % of the way pushed in the second half counts
            slipped > 0.01 * 0.02 * 500.0 * world.time_step_s()
        };
        assert!(!slips(half_angle - 1.0), "slips inside the cone of {half_angle} degrees");
        assert!(slips(half_angle + 1.0), "sticks outside the cone of {half_angle} degrees");
    }
}

#[test]
fn p5_a_disc_rolls_along_an_oblique_face() {
    let angle = 20.0_f64.to_radians();
    let pose = face_push(&EngineConfig::default(), SupportModel::Ellipsoid, angle, 0.3);
    let oracle =
        quasi_static::disc_on_face(RADIUS, DISC_LENGTH, 0.3, Vector2::new(angle.sin(), angle.cos()) * 0.05, 1000);
    assert_close("oracle's normal", oracle.y, 0.04698, 0.001);
    assert_close("oracle's lateral", oracle.x, 0.00526, 0.001);
    assert_close("oracle's rotation", oracle.z, 0.987, 0.001);
    assert_close("normal", pose.y, oracle.y, 0.03);
    assert_close("lateral", pose.x, oracle.x, 0.03);
    assert_close("rotation", pose.z, oracle.z, 0.03);
}

#[test]
fn p5_holds_down_to_the_speed_at_which_friction_is_solved_with_the_contacts() {
    let angle = 20.0_f64.to_radians();
    let oracle =
        quasi_static::disc_on_face(RADIUS, DISC_LENGTH, 0.3, Vector2::new(angle.sin(), angle.cos()) * 0.05, 1000);
    // twice what friction takes off in one step of 0.5 ms: 2.45 mm/s; below it the object follows its inertia, not the law
    for (speed, tolerance) in [(0.005, 0.01), (0.003, 0.01), (0.002, 0.10)] {
        let pose = face_push_at(speed, &EngineConfig::default(), SupportModel::Ellipsoid, angle, 0.3);
        assert_close(&format!("lateral at {speed} m/s"), pose.x, oracle.x, tolerance);
        assert_close(&format!("rotation at {speed} m/s"), pose.z, oracle.z, tolerance);
    }
}

#[test]
fn a_surface_with_a_friction_of_its_own_pushes_with_it() {
    let angle = 20_f64.to_radians();
    let shape = Outline::Box { width_m: 0.2, height_m: 0.01 };
    let pushed = |friction: f64, own: Option<f64>| {
        let mut face = tool(shape.clone(), friction);
        face.surfaces[0].friction = own;
        let velocity = Rotation2::new(-angle) * Vector2::new(0.0, 0.02);
        let start = Vector2::new(0.0, -RADIUS - 0.005 - TOUCHING);
        push(&disc(SupportModel::Ellipsoid), &EngineConfig::default(), &face, start, velocity, 0.050)
    };
    assert_eq!(pushed(0.3, Some(0.0)), pushed(0.0, None));
    assert_eq!(pushed(0.0, Some(0.3)), pushed(0.3, None));
    // without friction a face moves a disc along its normal only; with it the disc rolls along
    let (slippery, rough) = (pushed(0.3, Some(0.0)), pushed(0.0, Some(0.3)));
    assert!(slippery.x.abs() < 1e-4 && rough.x > 0.004, "{slippery} {rough}");
}

#[test]
fn p6_a_disc_leaves_a_round_head_exponentially() {
    for (friction, expected_deg) in [(0.3, 9.30), (0.0, 18.30)] {
        let start = 2.0_f64.to_radians();
        let oracle = quasi_static::disc_on_head(RADIUS, 0.006, DISC_LENGTH, friction, start, 0.040, 4000);
        assert_close("oracle", oracle.to_degrees(), expected_deg, 0.005);
        let head = tool(Outline::Disc { radius_m: 0.006 }, friction);
        let offset = Rotation2::new(start) * Vector2::new(0.0, RADIUS + 0.006 + TOUCHING);
        let pose = push(
            &disc(SupportModel::Ellipsoid),
            &EngineConfig::default(),
            &head,
            -offset,
            Vector2::new(0.0, 0.02),
            0.040,
        );
        let line = pose.xy() - (-offset + Vector2::new(0.0, 0.040));
        assert_close("line of centers", (-line.x).atan2(line.y), oracle, 0.04);
    }
}

#[test]
fn p7_a_square_pushed_off_center_turns_about_the_predicted_center() {
    let length = Outline::Box { width_m: 0.04, height_m: 0.04 }.mean_radius_m();
    let (twist, sticks) =
        quasi_static::pushed_twist(Vector2::new(-0.02, 0.01), Vector2::x(), Vector2::x(), 0.5, length);
    assert!(sticks);
    assert_close("oracle vx", twist.x, 0.8638, 0.001);
    assert_close("oracle vy", twist.y, -0.2724, 0.001);
    assert_close("oracle w", twist.z, -13.62, 0.001);
    // a pusher of radius 0.5 mm stands for a point; it must be slow enough for inertia not to matter
    let point = tool(Outline::Disc { radius_m: 0.0005 }, 0.5);
    let pose = |travel: f64| {
        push(&square(), &EngineConfig::default(), &point, Vector2::new(-0.0205, 0.01), Vector2::new(0.01, 0.0), travel)
    };
    let first = (pose(0.0004) - pose(0.0002)) / 0.0002;
    assert_close("vx", first.x, twist.x, 0.03);
    assert_close("vy", first.y, twist.y, 0.03);
    assert_close("w", first.z, twist.z, 0.03);
    // over 4 mm the contact stays on the object while the object turns
    let mut at = Vector3::zeros();
    for _ in 0..400 {
        let turn = Rotation2::new(at.z);
        let arm = turn * Vector2::new(-0.02, 0.01);
        at += quasi_static::pushed_twist(arm, turn * Vector2::x(), Vector2::new(1e-5, 0.0), 0.5, length).0;
    }
    let mean = pose(0.004) / 0.004;
    assert_close("mean w over 4 mm", mean.z, at.z / 0.004, 0.08);
    assert_close("mean vy over 4 mm", mean.y, at.y / 0.004, 0.08);
}

/// Way that a square moves against a wide face that pushes it with the given motion of the face, m and rad.
fn line_push(velocity: Vector2<f64>, rate: f64, seconds: f64) -> f64 {
    let mut world = build(&square(), &EngineConfig::default());
    let face = tool(Outline::Box { width_m: 0.04, height_m: 0.01 }, 0.3);
    let pusher = Pusher::insert(&mut world, &face, &Isometry2::translation(0.0, -0.025));
    let mut start = None;
    for step in 0..(seconds / world.time_step_s()) as usize {
        // the given velocity turns with the face: it belongs to the object's center
        let face_pose = pusher.world_from_tool(&world);
        let arm = face_pose * Vector2::new(0.0, -0.025);
        pusher.set_velocity(&mut world, &(face_pose * velocity + Vector2::new(-arm.y, arm.x) * rate), rate);
        world.step();
        let relative = face_pose.inverse() * world.world_from_object();
        // what settles when contact is made does not count
        if step == 100 {
            start = Some(relative);
        }
    }
    let end = pusher.world_from_tool(&world).inverse() * world.world_from_object();
    let moved = start.expect("long enough").inverse() * end;
    moved.translation.vector.norm() + 0.02 * moved.rotation.angle().abs()
}

#[test]
fn p8_a_line_contact_holds_the_square_inside_the_stable_pushes_only() {
    let speed = 0.02;
    let oblique = |degrees: f64| line_push(Rotation2::new(-degrees.to_radians()) * Vector2::new(0.0, speed), 0.0, 2.0);
    let turning = |radius: f64| line_push(Vector2::new(0.0, speed), speed / radius, 0.5);
    // straight pushes up to atan(0.3) = 16.70 degrees; turns about a center beside the object down to 2c²/w = 11.71 mm
    let (inside, outside) = (oblique(16.70 * 0.97), oblique(16.70 * 1.03));
    println!("oblique {inside:.2e} {outside:.2e} m");
    let (wide, tight) = (turning(0.01171 * 1.03), turning(0.01171 * 0.97));
    println!("turning {wide:.2e} {tight:.2e} m");
    assert!(inside < HELD && outside > 3.0 * HELD);
    assert!(wide < HELD && tight > 3.0 * HELD);
}

/// An object that moves less than this against the face is held by it, m: a thousandth of the way pushed.
const HELD: f64 = 4e-5;

#[test]
fn p9_the_oblique_face_push_is_the_same_in_every_engine_mode() {
    let angle = 20.0_f64.to_radians();
    let oracle =
        quasi_static::disc_on_face(RADIUS, DISC_LENGTH, 0.3, Vector2::new(angle.sin(), angle.cos()) * 0.05, 1000);
    let default = EngineConfig::default();
    let modes = [
        EngineConfig { time_step_s: default.time_step_s / 2.0, ..default.clone() },
        EngineConfig { substeps: 4, ..default.clone() },
        EngineConfig { contact_frequency_hz: 200.0, ..default.clone() },
        EngineConfig { length_unit_m: 0.01, ..default.clone() },
        default,
    ];
    for engine in modes {
        let pose = face_push(&engine, SupportModel::Ellipsoid, angle, 0.3);
        for (what, seen, expected) in
            [("normal", pose.y, oracle.y), ("lateral", pose.x, oracle.x), ("rotation", pose.z, oracle.z)]
        {
            assert_close(&format!("{what} with {engine:?}"), seen, expected, 0.05);
        }
    }
}

#[test]
fn p10_the_sense_of_rotation_follows_the_vote() {
    let mut random = ChaCha8Rng::seed_from_u64(10);
    let mut decided = 0;
    while decided < 200 {
        let along = random.random_range(-0.018..0.018);
        let friction = random.random_range(0.05..0.8_f64);
        let heading = random.random_range(-1.0..1.0_f64);
        let support =
            if random.random_bool(0.5) { SupportModel::Ellipsoid } else { SupportModel::SupportPoints { count: 100 } };
        // each voter is a line through the contact; it votes by the side of the center on which it passes
        let contact = Point2::new(along, -0.02);
        let side = |direction: Vector2<f64>| (Point2::origin() - contact).perp(&direction);
        let cone = friction.atan();
        let votes = [
            side(Rotation2::new(cone) * Vector2::y()),
            side(Rotation2::new(-cone) * Vector2::y()),
            side(Rotation2::new(heading) * Vector2::y()),
        ];
        let ballot: f64 = votes.iter().map(|vote| vote.signum()).sum();
        // a line through the center itself abstains: leave near ties out
        if votes.iter().any(|vote| vote.abs() < 1e-3) {
            continue;
        }
        decided += 1;
        let head = tool(Outline::Disc { radius_m: 0.0005 }, friction);
        let shape = Outline::Box { width_m: 0.04, height_m: 0.04 };
        let velocity = Rotation2::new(heading) * Vector2::new(0.0, 0.02);
        let pose = push(
            &object(shape, support),
            &EngineConfig::default(),
            &head,
            Vector2::new(along, -0.0205),
            velocity,
            0.0008,
        );
        assert!(
            -ballot.signum() * pose.z > 0.0,
            "contact at {along}, friction {friction}, heading {heading}: turned {}",
            pose.z
        );
    }
}

#[test]
fn contact_forces_balance_the_friction_of_a_steady_push() {
    let mut world = build(&disc(SupportModel::Ellipsoid), &EngineConfig::default());
    let face = tool(Outline::Box { width_m: 0.2, height_m: 0.01 }, 0.3);
    let pusher = Pusher::insert(&mut world, &face, &Isometry2::translation(0.0, -RADIUS - 0.005));
    pusher.set_velocity(&mut world, &(Rotation2::new(-0.3) * Vector2::new(0.0, 0.02)), 0.0);
    for _ in 0..1000 {
        world.step();
    }
    let force = world.force_on_object_n(Party::Tool);
    assert_close("force", force.norm(), oblique_push_force(), 0.02);
    assert!(force.x > 0.0 && force.y > 0.0, "the force follows the motion: {force}");
}

/// Force of a sticking push 0.3 rad off the normal of a face, from the limit surface.
fn oblique_push_force() -> f64 {
    let velocity = Vector2::new(0.3_f64.sin(), 0.3_f64.cos());
    let (twist, _) = quasi_static::pushed_twist(Vector2::new(0.0, -RADIUS), Vector2::y(), velocity, 0.3, DISC_LENGTH);
    let speed = (twist.xy().norm_squared() + (DISC_LENGTH * twist.z).powi(2)).sqrt();
    0.0054 * TABLE * GRAVITY * twist.xy().norm() / speed
}
