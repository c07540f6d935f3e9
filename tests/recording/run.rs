//! A run without physics: a disc pushed past an obstacle, told to an observer sample by sample.

use std::path::Path;

use nalgebra::{Isometry2, Point2, Unit, Vector2};
use scenarios::outcome::{Limit, Measure, OUTCOME_SCHEMA, Outcome};
use scenarios::scenario::ResolvedScenario;
use scenarios::tasks::ResolvedTask;
use scenarios::tasks::push::{PushScenario, ResolvedPush};
use sim::planar::{ArmDescription, ContactForce, Event, EventLevel, Observer, Party, Sample, SceneDescription};

/// Control steps of the run: ten seconds and a rest that falls on no row.
pub const STEPS: u64 = 10_005;

const CONTROL_PERIOD_S: f64 = 0.001;

/// The scenario that the recorder is told.
pub fn scenario() -> ResolvedScenario {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let read = |path: &str| std::fs::read_to_string(root.join(path)).unwrap();
    let source = read("scenarios/push_stick.toml");
    let tool: skills::tool::Tool = toml::from_str(&read("assets/tools/stick.toml")).unwrap();
    let push = ResolvedPush {
        scenario: toml::from_str::<PushScenario>(&source).unwrap(),
        tool: tool.clone(),
        demonstration_tool: tool,
        recorded: Vec::new(),
        learned: None,
    };
    ResolvedScenario {
        name: "push_stick".into(),
        arm: robot::Manipulator::from_urdf_str(&read("assets/robots/planar_3r.urdf")).unwrap(),
        source,
        assets: Vec::new(),
        task: ResolvedTask::Push(Box::new(push)),
    }
}

/// The object's way: to the left below the obstacle, then up beside it.
fn object_at(time_s: f64) -> Point2<f64> {
    let first = (time_s / 5.0).clamp(0.0, 1.0);
    let second = ((time_s - 5.0) / 4.0).clamp(0.0, 1.0);
    Point2::new(0.065 - 0.12 * first, 0.05 + 0.004 * (6.0 * first).sin() + 0.073 * second)
}

/// The scene of the run.
pub fn scene(scenario: &ResolvedScenario) -> SceneDescription {
    let push = scenario.as_push().unwrap();
    let object_path: Vec<_> = (0..=90).map(|k| object_at(f64::from(k) * 0.1) + Vector2::new(0.0, 0.001)).collect();
    SceneDescription {
        world: push.scenario.world.clone(),
        object: push.scenario.object.clone(),
        tool: push.tool.clone(),
        arm: ArmDescription {
            joints: ["shoulder", "elbow", "wrist"].map(String::from).to_vec(),
            torque_limits_nm: vec![5.0, 3.0, 1.0],
        },
        phases: ["push left with the side", "push forward with the head"].map(String::from).to_vec(),
        tool_path_world: object_path.iter().map(|point| point + Vector2::new(0.018, -0.019)).collect(),
        object_path_world: object_path,
        goal_world: Point2::new(-0.055, 0.125),
        control_period_s: CONTROL_PERIOD_S,
    }
}

/// Plays the run to an observer; returns the last position of the object.
pub fn play(observer: &mut impl Observer, scene: &SceneDescription, steps: u64) -> Point2<f64> {
    observer.begin(scene);
    observer.event(&Event { time_s: 0.0, level: EventLevel::Info, text: "push left begins".into() });
    for step in 0..steps {
        if step == 5000 {
            observer.event(&Event { time_s: 5.0, level: EventLevel::Info, text: "push forward begins".into() });
        }
        if step == 7000 {
            observer.event(&Event {
                time_s: 7.0,
                level: EventLevel::Warning,
                text: "the contact was lost for 24 ms".into(),
            });
        }
        play_step(observer, step);
    }
    object_at((steps - 1) as f64 * CONTROL_PERIOD_S)
}

fn play_step(observer: &mut impl Observer, step: u64) {
    let time_s = step as f64 * CONTROL_PERIOD_S;
    let object = object_at(time_s);
    let left = time_s < 5.0;
    let touches = time_s > 0.2 && time_s < 9.0 && !(7.0..7.024).contains(&time_s);
    let offset = if left { Vector2::new(0.018, -0.019) } else { Vector2::new(0.0, -0.042) };
    let tool = Isometry2::new((object + offset).coords, 0.0);
    let wave = (3.0 * time_s).sin();
    let normal = if left { -Vector2::x_axis() } else { Vector2::y_axis() };
    let contact = ContactForce {
        parties: [Party::Tool, Party::Object],
        point_world: object - normal.into_inner() * 0.012,
        normal_world: Unit::new_unchecked(normal.into_inner()),
        force_world_n: normal.into_inner() * (0.013 + 0.002 * wave) + Vector2::new(0.001, 0.002) * wave,
        slip_m_per_s: 0.0,
    };
    let base = Point2::new(0.0, -0.25);
    let flange = Point2::from(tool.translation.vector);
    let elbow = base + (flange - base) * 0.5 + Vector2::new(0.12, 0.0);
    let q = [0.5 + 0.1 * wave, 1.0 - 0.1 * time_s, 0.2 * wave];
    observer.sample(&Sample {
        step,
        time_s,
        phase: usize::from(!left),
        world_from_tool: tool,
        world_from_tool_reference: Isometry2::new(tool.translation.vector + Vector2::new(0.0004 * wave, 0.0002), 0.0),
        world_from_object: Isometry2::new(object.coords, 0.3 * time_s),
        world_from_object_expected: Isometry2::new(object.coords + Vector2::new(0.0, 0.001), 0.0),
        object_believed_world: None,
        world_from_object_seen: (time_s > 0.1)
            .then(|| Isometry2::new(object.coords + Vector2::new(0.0008, 0.0006) * wave, 0.0)),
        q_rad: &q,
        dq_rad_per_s: &[0.3 * wave, -0.1, 0.6 * wave],
        q_reference_rad: &q.map(|angle| angle + 0.002 * wave),
        torque_nm: &[0.4 * wave, 0.2, 0.05 * wave],
        joint_points_world: &[base, elbow, elbow + (flange - elbow) * 0.6, flange],
        contacts: if touches { std::slice::from_ref(&contact) } else { &[] },
    });
}

/// What came of it.
pub fn outcome() -> Outcome {
    Outcome {
        schema: OUTCOME_SCHEMA.into(),
        scenario: "push_stick".into(),
        task: "push".into(),
        seed: 1,
        version: env!("CARGO_PKG_VERSION").into(),
        success: true,
        failures: Vec::new(),
        measures: vec![
            Measure::judged("goal_error_mm", "distance of the object from its goal", 2.0, "mm", Limit::AtMost(5.0)),
            Measure::reported("path_deviation_mm", "largest distance of the object from its path", 3.1, "mm"),
            Measure::reported("contact_losses", "contacts lost for more than 20 ms", 1.0, "1"),
            Measure::reported("peak_force_n", "largest contact force", 0.0152, "N"),
        ],
        notes: vec!["five demonstrations, none refused".into()],
        trajectory_digest: "0".into(),
    }
}
