//! A table, containers on it, a cup that is moved from outside, grains, and their monitor.

use nalgebra::{Isometry3, Point3, Translation3, UnitQuaternion, Vector3};
use rapier3d::math::{Pose, Vector};
use rapier3d::prelude::*;
use sim::pouring::*;
use sim::random::{Purpose, stream};

pub const GRAVITY: f64 = 9.81;
/// Friction and restitution of the table.
const TABLE: (f64, f64) = (0.4, 0.5);

pub fn container(name: &str) -> Container {
    let path = format!("{}/../../assets/containers/{name}.toml", env!("CARGO_MANIFEST_DIR"));
    let text = std::fs::read_to_string(path).expect("a shipped container");
    let file: ContainerFile = toml::from_str(&text).expect("a valid file");
    Container::new(&file).expect("a valid container")
}

pub fn straight(radius_m: f64, height_m: f64) -> Container {
    let file = ContainerFile {
        name: "cup".into(),
        description: String::new(),
        mass_kg: 0.1,
        friction: 0.3,
        restitution: 0.5,
        wall_m: 0.003,
        facets: 32,
        profile: Profile::Straight(Straight { radius_m, height_m }),
        spout: None,
    };
    Container::new(&file).expect("a valid container")
}

pub fn filling(
    container: &Container,
    grain: &GrainConfig,
    engine: &GrainEngineConfig,
    count: usize,
    seed: u64,
) -> Filling {
    let mut random = stream(seed, Purpose::Variation, 0);
    fill(container, grain, engine, FillAmount::Count(count), &mut random).expect("it fits")
}

/// An empty world with gravity along −z.
pub fn world(engine: &GrainEngineConfig) -> PhysicsWorld {
    let mut physics = PhysicsWorld::new();
    physics.gravity = Vector::new(0.0, 0.0, -GRAVITY);
    engine.apply(&mut physics.integration_parameters);
    physics
}

/// A flat top at height `z_m`.
pub fn table(physics: &mut PhysicsWorld, grain: &GrainConfig, z_m: f64) -> ColliderHandle {
    let body = physics.insert_body(RigidBodyBuilder::fixed().translation(Vector::new(0.0, 0.0, z_m - 0.05)));
    let collider = grain.wall(ColliderBuilder::cuboid(1.0, 1.0, 0.05), TABLE.0, TABLE.1);
    physics.insert_collider(collider, Some(body))
}

/// A cup with grains, moved from outside, and perhaps a target on the table.
pub struct Scene {
    pub physics: PhysicsWorld,
    pub grains: Grains,
    pub monitor: PourMonitor,
    pub cup: RigidBodyHandle,
    pub lip: Point3<f64>,
    pub steps: u64,
}

impl Scene {
    /// The source, filled, with its lip at `world_lip` and upright; the target upright on the table, at the origin.
    pub fn new(
        source: &Container,
        filling: &Filling,
        target: Option<&Container>,
        engine: &GrainEngineConfig,
        world_lip: Point3<f64>,
    ) -> Self {
        let mut physics = world(engine);
        let grain = filling.batch.config().clone();
        table(&mut physics, &grain, 0.0);
        let world_from_cup = pose_with_lip(source, world_lip, 0.0);
        let cup = physics.insert_body(RigidBodyBuilder::kinematic_position_based().pose(Pose::from(world_from_cup)));
        let all = InteractionGroups::all();
        let held = source.attach(&mut physics, cup, &Isometry3::identity(), all, &grain);
        let target = target.map(|target| {
            let body = physics.insert_body(RigidBodyBuilder::fixed());
            target.attach(&mut physics, body, &Isometry3::identity(), all, &grain)
        });
        let grains = Grains::insert_filling(&mut physics, filling, &world_from_cup, all).expect("as many as filled");
        let monitor = PourMonitor::new(MonitorConfig::default(), &physics, &grains, held, target);
        Self { physics, grains, monitor, cup, lip: source.lip.point_in_container, steps: 0 }
    }

    pub fn time_s(&self) -> f64 {
        self.steps as f64 * self.physics.integration_parameters.dt
    }

    /// One step, in which the cup goes to the pose that has its lip at `world_lip` and that tilt.
    pub fn step(&mut self, world_lip: Point3<f64>, tilt_rad: f64) {
        let next = pose_of_lip(self.lip, world_lip, tilt_rad);
        if let Some(cup) = self.physics.bodies.get_mut(self.cup) {
            cup.set_next_kinematic_position(Pose::from(next));
        }
        self.advance();
    }

    pub fn advance(&mut self) {
        self.grains.before_step(&mut self.physics);
        self.physics.step();
        self.monitor.after_step(&self.physics, &self.grains);
        self.steps += 1;
    }
}

fn pose_of_lip(lip: Point3<f64>, world_lip: Point3<f64>, tilt_rad: f64) -> Isometry3<f64> {
    let turn = UnitQuaternion::from_axis_angle(&Vector3::y_axis(), tilt_rad);
    Isometry3::from_parts(Translation3::from(world_lip.coords), turn) * Translation3::from(-lip.coords)
}

pub fn pose_with_lip(source: &Container, world_lip: Point3<f64>, tilt_rad: f64) -> Isometry3<f64> {
    pose_of_lip(source.lip.point_in_container, world_lip, tilt_rad)
}

/// Minimum jerk from 0 to 1.
pub fn smooth(share: f64) -> f64 {
    let s = share.clamp(0.0, 1.0);
    s * s * s * (10.0 - 15.0 * s + 6.0 * s * s)
}
