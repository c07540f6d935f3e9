//! A run in space without physics: a hand with a knife over a body that comes apart once, and falling grains.

use nalgebra::{Isometry3, Point3, UnitQuaternion, Vector3, Vector6};
use sim::spatial::{
    ArmDescription, BodyDrawing, Drawing, DrawnShape, Event, EventLevel, GrainDescription, LinkDrawing, Observer, Rgba,
    Sample, SceneDescription, Series, Target, TriangleMesh,
};

use super::run::STEPS;

const CONTROL_PERIOD_S: f64 = 0.001;
const GRAY: Rgba = [0.8, 0.8, 0.8, 1.0];

/// Control step from which on the body is two; no row of 100 Hz falls on it.
pub const SPLIT_STEP: u64 = 4_003;
/// Number of grains.
pub const GRAINS: usize = 300;
/// Joints of the arm.
pub const JOINTS: [&str; 2] = ["shoulder", "elbow"];

/// What a recording must end with.
pub struct Last {
    /// Place of the tool, m.
    pub tool: [f32; 3],
    /// Places of the bodies `left` and `right`, m.
    pub bodies: [[f32; 3]; 2],
    /// Place of the first grain, m.
    pub grain: [f32; 3],
    /// The task's only curve.
    pub flow: f64,
}

fn boxed(x_m: f64) -> Drawing {
    let shape = DrawnShape::Box { size_m: Vector3::new(x_m, 0.03, 0.02) };
    Drawing { shape, body_from_shape: Isometry3::identity(), color: GRAY }
}

fn mesh() -> Drawing {
    let vertices = [[0.0, 0.0, 0.0], [0.03, 0.0, 0.0], [0.0, 0.03, 0.0], [0.0, 0.0, 0.02]].map(Point3::from).to_vec();
    let triangles = vec![[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]];
    let mesh = TriangleMesh { vertices, triangles, ..TriangleMesh::default() };
    Drawing { shape: DrawnShape::Mesh(mesh), body_from_shape: Isometry3::identity(), color: GRAY }
}

fn body(name: &str, drawings: Vec<Drawing>) -> BodyDrawing {
    BodyDrawing { name: name.into(), drawings }
}

/// The scene of the run.
pub fn scene() -> SceneDescription {
    let link = |name: &str| LinkDrawing { name: name.into(), drawings: vec![boxed(0.1)] };
    SceneDescription {
        fixed: vec![boxed(0.5)],
        arm: ArmDescription {
            joints: JOINTS.map(String::from).to_vec(),
            torque_limits_nm: vec![87.0, f64::INFINITY],
            links: vec![link("base"), link("upper arm"), link("forearm")],
            tool: vec![boxed(0.15)],
        },
        // a tray that stays, and a food in two shapes of which one stays under its name
        bodies: vec![body("tray", vec![boxed(0.2)]), body("left", vec![boxed(0.06), mesh()])],
        grains: Some(GrainDescription { half_sizes_m: vec![[0.003, 0.003, 0.004]; GRAINS], color: GRAY }),
        series: vec![Series { plot: "flow [g/s]".into(), name: "flow [g/s]".into() }],
        targets_world: vec![Target { name: "over the food".into(), world_from_target: Isometry3::identity() }],
        main_plots: Vec::new(),
        phases: ["approach", "press"].map(String::from).to_vec(),
        tool_path_world: (0..=10).map(|k| Point3::from(tool_at(f64::from(k)))).collect(),
        focus_world: (Point3::new(0.4, 0.0, 0.2), 0.3),
        control_period_s: CONTROL_PERIOD_S,
    }
}

fn tool_at(time_s: f64) -> Vector3<f64> {
    Vector3::new(0.4 + 0.1 * time_s.sin(), 0.05 * time_s, 0.2)
}

fn bodies_at(step: u64, time_s: f64) -> Vec<Isometry3<f64>> {
    let left = Isometry3::translation(0.4 - 0.001 * time_s, 0.0, 0.01);
    let other =
        if step < SPLIT_STEP { Isometry3::identity() } else { Isometry3::translation(0.4, 0.002 * time_s, 0.01) };
    if step < SPLIT_STEP { vec![other, left] } else { vec![left, other] }
}

fn grain_at(grain: usize, time_s: f64) -> Point3<f64> {
    let (column, row) = ((grain % 20) as f64, (grain / 20) as f64);
    // every grain goes its own way in all directions, as grains do: a recorder cannot save what is alike
    let wander = |rate: f64| 0.01 * (time_s * (rate + 0.01 * grain as f64)).sin();
    Point3::new(0.3 + 0.008 * column + wander(1.3), 0.008 * row + wander(1.7), 0.3 / (1.0 + time_s) + wander(1.0))
}

fn flow(time_s: f64) -> f64 {
    12.0 * (0.5 * time_s).sin()
}

/// Plays the run to an observer; returns the state at its end.
pub fn play(observer: &mut impl Observer, scene: &SceneDescription) -> Last {
    observer.begin(scene);
    let mut grains = vec![Point3::origin(); GRAINS];
    for step in 0..STEPS {
        let time_s = step as f64 * CONTROL_PERIOD_S;
        if step == SPLIT_STEP {
            observer.event(&Event { time_s, level: EventLevel::Info, text: "the food is in two pieces".into() });
            // the tray is gone; what is left has one shape instead of two
            observer.bodies(time_s, &[body("left", vec![mesh()]), body("right", vec![mesh()])]);
        }
        grains.iter_mut().enumerate().for_each(|(grain, center)| *center = grain_at(grain, time_s));
        observer.sample(&Sample {
            step,
            time_s,
            phase: usize::from(step >= SPLIT_STEP),
            world_from_tool: Isometry3::from_parts(tool_at(time_s).into(), UnitQuaternion::identity()),
            world_from_tool_reference: Isometry3::from_parts(tool_at(time_s).into(), UnitQuaternion::identity()),
            world_from_links: &[Isometry3::identity(); 3],
            q_rad: &[0.1 * time_s, 0.2],
            dq_rad_per_s: &[0.1, 0.0],
            q_reference_rad: &[0.1 * time_s, 0.21],
            torque_nm: &[3.0 * time_s.sin(), 1.0],
            tool_wrench: Vector6::new(0.0, 0.0, 5.0 * time_s.sin(), 0.0, 0.0, 0.0),
            world_from_bodies: &bodies_at(step, time_s),
            grain_centers_world: &grains,
            grain_turns: &[],
            series: &[flow(time_s)],
        });
    }
    let last_s = (STEPS - 1) as f64 * CONTROL_PERIOD_S;
    let bodies = bodies_at(STEPS - 1, last_s);
    let plain = |place: Vector3<f64>| [place.x as f32, place.y as f32, place.z as f32];
    Last {
        tool: plain(tool_at(last_s)),
        bodies: [0, 1].map(|body| plain(bodies[body].translation.vector)),
        grain: plain(grain_at(0, last_s).coords),
        flow: flow(last_s),
    }
}
