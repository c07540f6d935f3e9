//! Cost of a whole cut by the simulated arm: divide the simulated seconds by the printed time for the real-time factor.

#![expect(clippy::expect_used, reason = "a bench stops at the first surprise")]

use std::f64::consts::{FRAC_PI_2, FRAC_PI_4};
use std::time::{Duration, Instant};

use criterion::{Criterion, criterion_group, criterion_main};
use nalgebra::{DVector, Isometry3, Translation3, UnitQuaternion, Vector3, Vector6};
use robot::Manipulator;
use sim::controllers::{Impedance, ImpedanceConfig};
use sim::cutting::food::FoodFile;
use sim::cutting::knife::KnifeFile;
use sim::cutting::mechanics::{CuttingConfig, Thresholds};
use sim::cutting::scene::{CuttingBoard, CuttingProcess, CuttingSetup, held_knife, knife_from_tool};
use sim::spatial::{
    ArmConfig, BodyDrawing, EngineConfig, Observer, Sample, SceneDescription, SpatialReference, SpatialSetup,
    SpatialWorld, arm_with_tool, check_reach, simulate, standard_gravity,
};

const BOARD: [f64; 3] = [0.5, 0.0, 0.15];
/// The knife sinks from 35 mm above the board to half a millimeter below it in this time, s; two simulated seconds in all.
const STROKE_S: f64 = 1.8;
const READY: [f64; 7] = [0.0, -FRAC_PI_4, 0.0, -3.0 * FRAC_PI_4, 0.0, FRAC_PI_2, FRAC_PI_4];

fn setup(text: &str) -> CuttingSetup {
    let food = toml::from_str::<FoodFile>(text).expect("a food file").food().expect("a food");
    let knife = include_str!("../../../assets/knives/cleaver.toml");
    let [x, y, z] = BOARD;
    let upright = UnitQuaternion::from_axis_angle(&Vector3::z_axis(), FRAC_PI_2);
    CuttingSetup {
        world_from_food: Isometry3::from_parts(Translation3::new(x, y, z - food.solid.bounds().0.z), upright),
        food,
        knife: toml::from_str::<KnifeFile>(knife).expect("a knife file").knife().expect("a knife"),
        board: CuttingBoard {
            world_from_board: Isometry3::translation(x, y, z),
            half_extents_m: [0.15, 0.2, 0.01],
            friction: 0.4,
        },
        config: CuttingConfig::default(),
        thresholds: Thresholds::default(),
        planned: Vec::new(),
    }
}

fn reference(time_s: f64) -> SpatialReference {
    let share = (time_s / STROKE_S).min(1.0);
    let down = UnitQuaternion::from_axis_angle(&Vector3::x_axis(), -FRAC_PI_2);
    let at = Translation3::new(BOARD[0], BOARD[1], BOARD[2] + 0.035 - 0.0355 * share);
    let speed = if share < 1.0 { -0.0355 / STROKE_S } else { 0.0 };
    let velocity = Vector6::new(0.0, 0.0, speed, 0.0, 0.0, 0.0);
    SpatialReference { velocity, finished: share >= 1.0, ..SpatialReference::at_rest(Isometry3::from_parts(at, down)) }
}

/// Clock time of the control period in which a food came apart: clipping, hulls, masses, new bodies, their pictures, and the
/// engine's step around it.
#[derive(Default)]
struct Splitting {
    before: Option<Instant>,
    came_apart: bool,
    longest: Duration,
}

impl Observer for Splitting {
    fn sample(&mut self, _: &Sample<'_>) {
        let now = Instant::now();
        if let Some(before) = self.before.filter(|_| self.came_apart) {
            self.longest = self.longest.max(now - before);
        }
        (self.before, self.came_apart) = (Some(now), false);
    }

    fn bodies(&mut self, _: f64, _: &[BodyDrawing]) {
        self.came_apart = true;
    }
}

/// Cuts one food; the number of its pieces.
fn cut(setup: &CuttingSetup, observer: &mut dyn Observer) -> usize {
    let engine = EngineConfig::default();
    let hand_from_knife = Isometry3::rotation(Vector3::x() * FRAC_PI_2) * setup.knife.knife_from_grip.inverse();
    let tool = held_knife(&setup.knife, hand_from_knife * knife_from_tool(&setup.knife));
    let arm = Manipulator::from_urdf_str(include_str!("../../../assets/robots/panda.urdf")).expect("a valid arm");
    let rotors = [0.195, 0.195, 0.195, 0.195, 0.074, 0.074, 0.074];
    let model = arm_with_tool(&arm, "panda_hand_tcp", &tool, &Isometry3::identity(), &standard_gravity(), &rotors)
        .expect("a valid arm");
    let mut world = SpatialWorld::new(&engine, &standard_gravity()).expect("a valid scene");
    let mut process = CuttingProcess::insert(&mut world, setup).expect("a valid setup");
    let mut source = |time_s: f64, _: &Isometry3<f64>| reference(time_s);
    let near = DVector::from_column_slice(&READY);
    let q = check_reach(&model, &near, STROKE_S, &mut source).expect("within reach");
    let gains = ImpedanceConfig {
        error_gain_per_s: 60.0,
        damping_nm_s_per_rad: vec![150.0, 150.0, 150.0, 150.0, 40.0, 40.0, 20.0],
    };
    let mut controller = Impedance::new(&gains, 7).expect("valid gains");
    let spatial = SpatialSetup {
        plant: &model,
        model: &model,
        tool: &tool,
        arm: &ArmConfig::default(),
        scene: &SceneDescription::default(),
        engine: &engine,
        settle_s: 2.0 - STROKE_S,
        longest_s: 3.0,
    };
    simulate(&spatial, world, &q, &mut source, &mut controller, &mut process, observer).expect("a finite run");
    process.record().pieces.len()
}

fn cutting(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("two simulated seconds of cutting");
    group.sample_size(10);
    let foods = [
        ("banana", include_str!("../../../assets/foods/banana.toml")),
        ("meatball", include_str!("../../../assets/foods/meatball.toml")),
    ];
    for (name, text) in foods {
        let setup = setup(text);
        group.bench_function(name, |bencher| bencher.iter(|| cut(&setup, &mut ())));
    }
    group.finish();
    let mut group = criterion.benchmark_group("control period in which a food comes apart");
    group.sample_size(10);
    for (name, text) in foods {
        let setup = setup(text);
        group.bench_function(name, |bencher| {
            bencher.iter_custom(|runs| {
                let one = |_| {
                    let mut splitting = Splitting::default();
                    assert!(cut(&setup, &mut splitting) > 1, "the food comes apart");
                    splitting.longest
                };
                (0..runs).map(one).sum()
            });
        });
    }
    group.finish();
}

criterion_group!(benches, cutting);
criterion_main!(benches);
