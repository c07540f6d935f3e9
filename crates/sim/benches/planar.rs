//! Cost of planar physics and of the control loop, without demonstrations, planning or recording.
//!
//! One iteration is one simulated millisecond: divide a millisecond by the printed time for the real-time factor.

#![expect(clippy::expect_used, reason = "a bench stops at the first surprise")]

use criterion::{Criterion, criterion_group, criterion_main};
use nalgebra::{DVector, Isometry2, Vector2};
use robot::{JointReference, JointState, Manipulator};
use sim::controllers::{Controller, Impedance, ImpedanceConfig};
use sim::planar::{EngineConfig, MapBounds, ObjectConfig, PlanarArm, PlanarWorld, Pusher, WorldConfig, arm_with_tool};
use sim::support::SupportModel;
use skills::outline::Outline;
use skills::tool::Tool;

const MILLISECOND_S: f64 = 0.001;
/// The object starts anew after this many iterations, before it leaves the tool.
const RESTART: u32 = 3000;

fn stick() -> Tool {
    toml::from_str(include_str!("../../../assets/tools/stick.toml")).expect("a valid tool")
}

fn world(support: SupportModel) -> PlanarWorld {
    let map = MapBounds { min_m: [-1.0, -1.0], max_m: [1.0, 1.0] };
    let world = WorldConfig { map, gravity_m_per_s2: 9.81, obstacles: vec![] };
    let shape = Outline::Disc { radius_m: 0.012 };
    let object = ObjectConfig { name: "disc".into(), shape, mass_kg: 0.0054, table_friction: 0.25, support };
    PlanarWorld::new(&world, &object, &EngineConfig::default(), &Isometry2::translation(0.0, 0.042)).expect("valid")
}

/// A disc pushed by a tool on rails.
fn pusher(support: &SupportModel) -> impl FnMut() {
    let (mut scene, mut held, mut count) = (None, None, 0);
    let support = support.clone();
    move || {
        if count % RESTART == 0 {
            let mut fresh = world(support.clone());
            let tool = Pusher::insert(&mut fresh, &stick(), &Isometry2::identity());
            tool.set_velocity(&mut fresh, &Vector2::new(0.0, 0.02), 0.0);
            (scene, held) = (Some(fresh), Some(tool));
        }
        count += 1;
        if let (Some(scene), Some(_)) = (&mut scene, &held) {
            for _ in 0..(MILLISECOND_S / scene.time_step_s()).round() as usize {
                scene.step();
            }
        }
    }
}

/// The arm under the impedance controller, holding its posture against the table's world.
fn arm() -> impl FnMut() {
    let urdf = include_str!("../../../assets/robots/planar_3r.urdf");
    let arm = Manipulator::from_urdf_str(urdf).expect("a valid arm");
    let base = Isometry2::translation(0.0, -0.25);
    let model = arm_with_tool(&arm, "flange", &stick(), &base, 9.81, &[0.01; 3]).expect("a valid arm");
    let posture = DVector::from_column_slice(&[-0.9, 1.8, -0.9]);
    let mut scene = world(SupportModel::Ellipsoid);
    let mut arm = PlanarArm::insert(&mut scene, &model, "flange", &stick(), &posture).expect("a planar arm");
    let gains = ImpedanceConfig { error_gain_per_s: 3.0, damping_nm_s_per_rad: vec![10.0] };
    let mut controller = Impedance::new(&gains, 3).expect("valid gains");
    let (mut workspace, mut torque) = (model.workspace(), DVector::zeros(3));
    let (mut state, reference) = (JointState::at_rest(posture.clone()), JointReference::at_rest(posture));
    move || {
        arm.read_state(&scene, &mut state);
        controller.torque(&mut workspace, &state, &reference, &mut torque).expect("three joints");
        arm.apply_torques(&mut scene, &torque);
        for _ in 0..(MILLISECOND_S / scene.time_step_s()).round() as usize {
            scene.step();
        }
    }
}

fn planar(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("one simulated millisecond");
    group.bench_function("pushed disc, ellipsoid", |bench| bench.iter(pusher(&SupportModel::Ellipsoid)));
    let points = SupportModel::SupportPoints { count: 64 };
    group.bench_function("pushed disc, 64 support points", |bench| bench.iter(pusher(&points)));
    group.bench_function("arm under control", |bench| bench.iter(arm()));
    group.finish();
}

criterion_group!(benches, planar);
criterion_main!(benches);
