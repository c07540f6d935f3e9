//! Cost of one step of the engine with grains in a cup, at rest and while the cup pours; divide by the number of grains.

#![expect(clippy::expect_used, reason = "a bench stops at the first surprise")]

use criterion::{Criterion, criterion_group, criterion_main};
use nalgebra::{Isometry3, UnitQuaternion, Vector3};
use rapier3d::math::{Pose, Vector};
use rapier3d::prelude::*;
use sim::pouring::*;
use sim::random::{Purpose, stream};

/// A cup with its grains, and how it moves.
struct Cup {
    physics: PhysicsWorld,
    grains: Grains,
    monitor: PourMonitor,
    body: RigidBodyHandle,
}

impl Cup {
    /// The shipped cup, enlarged such that it is as full with any number of grains as with 300.
    fn new(count: usize) -> Self {
        let scale = (count as f64 / 300.0).cbrt();
        let mut file: ContainerFile =
            toml::from_str(include_str!("../../../assets/containers/source_cup.toml")).expect("a valid file");
        file.profile = Profile::Straight(Straight { radius_m: 0.035 * scale, height_m: 0.09 * scale });
        let cup = Container::new(&file).expect("a valid container");
        let (engine, grain) = (GrainEngineConfig::default(), GrainConfig::default());
        let mut random = stream(1, Purpose::Variation, 0);
        let filling = fill(&cup, &grain, &engine, FillAmount::Count(count), &mut random).expect("it fits");
        let mut physics = PhysicsWorld::new();
        physics.gravity = Vector::new(0.0, 0.0, -9.81);
        engine.apply(&mut physics.integration_parameters);
        let start = Isometry3::translation(0.0, 0.0, 0.3);
        let table = ColliderBuilder::cuboid(1.0, 1.0, 0.05).translation(Vector::new(0.0, 0.0, -0.05));
        physics.insert_collider(grain.wall(table, 0.4, 0.5), None);
        let body = physics.insert_body(RigidBodyBuilder::kinematic_position_based().pose(Pose::from(start)));
        let all = InteractionGroups::all();
        let held = cup.attach(&mut physics, body, &Isometry3::identity(), all, &grain);
        let grains = Grains::insert_filling(&mut physics, &filling, &start, all).expect("filled");
        let monitor = PourMonitor::new(MonitorConfig::default(), &physics, &grains, held, None);
        Self { physics, grains, monitor, body }
    }

    fn step(&mut self, tilt_rad: f64) {
        let turn = UnitQuaternion::from_axis_angle(&Vector3::y_axis(), tilt_rad);
        if let Some(body) = self.physics.bodies.get_mut(self.body) {
            body.set_next_kinematic_position(Pose::from(Isometry3::translation(0.0, 0.0, 0.3) * turn));
        }
        self.grains.before_step(&mut self.physics);
        self.physics.step();
        self.monitor.after_step(&self.physics, &self.grains);
    }
}

/// A pour lasts two seconds, from upright to 130°.
const POUR_STEPS: u64 = 1000;

/// Time of `steps` steps out of whole pours; building the worlds is left out.
fn poured(count: usize, steps: u64) -> std::time::Duration {
    let pours = steps.div_ceil(POUR_STEPS);
    let time: std::time::Duration = (0..pours)
        .map(|_| {
            let mut cup = Cup::new(count);
            let start = std::time::Instant::now();
            for step in 0..POUR_STEPS {
                cup.step(130.0_f64.to_radians() * step as f64 / POUR_STEPS as f64);
            }
            start.elapsed()
        })
        .sum();
    time.mul_f64(steps as f64 / (pours * POUR_STEPS) as f64)
}

fn grains(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("one step of 2 ms");
    group.sample_size(10);
    for count in [100, 300, 1000] {
        let mut cup = Cup::new(count);
        group.bench_function(format!("{count} grains at rest"), |bench| bench.iter(|| cup.step(0.0)));
        group.bench_function(format!("{count} grains poured"), |bench| bench.iter_custom(|steps| poured(count, steps)));
    }
    group.finish();
}

criterion_group!(benches, grains);
criterion_main!(benches);
