//! Pouring with an arm: the cup in its hand, grains in it, and the container that they are poured into.

mod arm_watch;
mod clearance;
mod gauge;
mod held;
mod lip_watch;
mod result;
mod touches;

use nalgebra::{Isometry3, Point3, UnitQuaternion, Vector3};
use rapier3d::prelude::{ColliderBuilder, InteractionGroups, PhysicsWorld, RigidBodyBuilder};
use serde::{Deserialize, Serialize};
use skills::field::{FieldError, within};

use super::container::{AttachedContainer, Container};
use super::filling::Filling;
use super::grains::{GrainBatch, GrainConfig, GrainShape, Grains};
use super::monitor::{MonitorConfig, Place, PourMonitor};
use crate::error::SimError;
use crate::spatial::{GrainDescription, Process, Rgba, Series, SpatialArm, SpatialWorld, Step, wrench_of};

pub use arm_watch::ArmClearance;
use arm_watch::ArmWatch;
pub use clearance::VesselClearance;
pub use gauge::{PourGauge, PourReading};
pub use held::{Grip, container_drawing, held_container};
pub use lip_watch::LipReport;
use lip_watch::LipWatch;
pub use result::{Masses, PourResult};
use touches::Touches;

/// Half width and half thickness of the table, m.
const TABLE_HALF_WIDTH_M: f64 = 1.5;
const TABLE_HALF_THICKNESS_M: f64 = 0.05;
/// A grain faster than this did not get there by falling off an arm, m/s.
const FASTEST_GRAIN_M_PER_S: f64 = 8.0;
const GRAMS: f64 = 1e3;
const MM: f64 = 1e3;

/// The table top, at height 0.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct TableConfig {
    /// Coefficient of friction between table and grain.
    #[schemars(range(min = 0.0, max = 2.0))]
    pub friction: f64,
    /// Coefficient of restitution between table and grain.
    #[schemars(range(min = 0.0, max = 1.0))]
    pub restitution: f64,
}

impl Default for TableConfig {
    fn default() -> Self {
        // soybean on wood: friction 0.30 to 0.44 (Kibar and Öztürk 2008)
        Self { friction: 0.4, restitution: 0.5 }
    }
}

impl TableConfig {
    /// Checks the numbers.
    ///
    /// # Errors
    /// A [`FieldError`] naming the offending value.
    pub fn validate(&self) -> Result<(), FieldError> {
        within("friction", self.friction, 0.0, 2.0)?;
        within("restitution", self.restitution, 0.0, 1.0)
    }
}

/// What a pour is made of, besides the arm.
#[derive(Clone, Debug)]
pub struct PourSetup {
    /// The cup in the hand; its frame is the tool's.
    pub source: Container,
    /// The container that is poured into, which stands fixed.
    pub target: Container,
    /// Where it stands.
    pub world_from_target: Isometry3<f64>,
    /// The grains in the cup.
    pub filling: Filling,
    /// The table.
    pub table: TableConfig,
    /// What counts as spilt.
    pub monitor: MonitorConfig,
}

/// Grains in a held cup: they press on the arm's hand, and the arm moves them, within one step of the engine.
pub struct PouringProcess {
    setup: PourSetup,
    running: Option<Running>,
    gauge: PourGauge,
}

/// What exists once the arm stands in its world.
struct Running {
    grains: Grains,
    monitor: PourMonitor,
    lip: LipWatch,
    target_touches: Touches,
    table_touches: Touches,
    arm_watch: ArmWatch,
}

impl PouringProcess {
    /// Prepares a pour; what it is made of enters the world once the arm stands there.
    #[must_use]
    pub fn new(setup: PourSetup) -> Self {
        Self { setup, running: None, gauge: PourGauge::default() }
    }

    /// What is measured while it goes on, for a reference that depends on it.
    #[must_use]
    pub fn gauge(&self) -> PourGauge {
        self.gauge.clone()
    }

    /// Curves that it draws, in the order of [`Process::series`].
    #[must_use]
    pub fn series_names() -> Vec<Series> {
        let named = |plot: &str, name: &str| Series { plot: plot.into(), name: name.into() };
        vec![
            named("flow [g/s]", "out of the cup"),
            named("beans", "collected"),
            named("beans", "spilt"),
            named("beans", "left"),
            named("poured [g]", "collected"),
            named("lip [mm]", "to the mouth"),
            named("tilt [deg]", "of the cup"),
        ]
    }

    /// What became of the grains; `None` if nothing was simulated.
    #[must_use]
    pub fn result(&self) -> Option<PourResult> {
        let running = self.running.as_ref()?;
        let touches = [running.target_touches.count(), running.table_touches.count()];
        Some(PourResult::new(&running.monitor, running.lip.report(), touches, running.arm_watch.least()))
    }
}

impl Running {
    fn new(
        setup: &PourSetup,
        physics: &mut PhysicsWorld,
        arm: (&SpatialArm, Isometry3<f64>),
    ) -> Result<Self, SimError> {
        let (arm, world_from_tool) = arm;
        let grain = setup.filling.batch.config().clone();
        let all = InteractionGroups::all();
        let table = table(physics, &grain, &setup.table);
        let fixed = physics.insert_body(RigidBodyBuilder::fixed());
        let target = setup.target.attach(physics, fixed, &setup.world_from_target, all, &grain);
        let source = setup.source.attach(physics, arm.hand_body(), arm.hand_from_tool(), all, &grain);
        let grains = Grains::insert_filling(physics, &setup.filling, &world_from_tool, all)?;
        let colliders = (source.collider(), target.collider());
        let lip = LipWatch::new(grains.len());
        let monitor = PourMonitor::new(setup.monitor.clone(), physics, &grains, source, Some(target));
        Ok(Self {
            grains,
            monitor,
            lip,
            target_touches: Touches::between(colliders.0, colliders.1),
            table_touches: Touches::between(colliders.0, table),
            arm_watch: ArmWatch::new(arm, &setup.target, &setup.world_from_target),
        })
    }

    /// What is in the cup and in the target, as the arm's controller may know it.
    fn reading(&self, physics: &PhysicsWorld, tool_origin: &Point3<f64>) -> PourReading {
        let (mut mass_kg, mut moment, mut collected_kg) = (0.0, Vector3::zeros(), 0.0);
        let grains = self.monitor.places().zip(self.grains.batch().masses_kg()).zip(self.grains.bodies(physics));
        for ((place, grain_kg), body) in grains {
            match place {
                Place::Source => {
                    let at = body.translation();
                    mass_kg += grain_kg;
                    moment += Vector3::new(at.x, at.y, at.z) * grain_kg;
                }
                Place::Target => collected_kg += grain_kg,
                Place::Flying | Place::Spilt => {}
            }
        }
        let gravity = physics.gravity;
        let weight = Vector3::new(gravity.x, gravity.y, gravity.z) * mass_kg;
        let center = if mass_kg > 0.0 { Point3::from(moment / mass_kg) } else { *tool_origin };
        PourReading { collected_kg, held_kg: mass_kg, weight_wrench: wrench_of(&weight, &center, tool_origin) }
    }
}

fn table(physics: &mut PhysicsWorld, grain: &GrainConfig, config: &TableConfig) -> rapier3d::prelude::ColliderHandle {
    let below = rapier3d::math::Vector::new(0.0, 0.0, -TABLE_HALF_THICKNESS_M);
    let body = physics.insert_body(RigidBodyBuilder::fixed().translation(below));
    let top = ColliderBuilder::cuboid(TABLE_HALF_WIDTH_M, TABLE_HALF_WIDTH_M, TABLE_HALF_THICKNESS_M);
    physics.insert_collider(grain.wall(top, config.friction, config.restitution), Some(body))
}

/// How the grains of a batch look.
#[must_use]
pub fn grain_description(batch: &GrainBatch, color: Rgba) -> GrainDescription {
    let half_size = |diameter_m: &f64| {
        let (radius, half_length) = batch.config().radius_and_half_length_m(*diameter_m);
        [radius + half_length, radius, radius]
    };
    GrainDescription { half_sizes_m: batch.diameters_m().iter().map(half_size).collect(), color }
}

impl Process for PouringProcess {
    fn begin(&mut self, world: &mut SpatialWorld, arm: &SpatialArm) -> Result<(), SimError> {
        let world_from_tool = arm.world_from_tool(world);
        let running = Running::new(&self.setup, &mut world.physics, (arm, world_from_tool))?;
        self.gauge.set(running.reading(&world.physics, &world_from_tool.translation.vector.into()));
        self.running = Some(running);
        Ok(())
    }

    fn before_step(&mut self, step: &mut Step<'_>) -> Result<(), SimError> {
        if let Some(running) = &mut self.running {
            running.grains.before_step(&mut step.world.physics);
        }
        Ok(())
    }

    fn after_step(&mut self, step: &mut Step<'_>) -> Result<(), SimError> {
        let Some(running) = &mut self.running else { return Ok(()) };
        let physics = &step.world.physics;
        running.grains.check_speed(physics, step.time_s, FASTEST_GRAIN_M_PER_S)?;
        running.monitor.after_step(physics, &running.grains);
        running.lip.look(&running.monitor, physics);
        running.target_touches.look(physics, step.time_step_s);
        running.table_touches.look(physics, step.time_step_s);
        running.arm_watch.look(step.arm, step.world, step.time_s);
        let origin = Point3::from(step.arm.world_from_tool(step.world).translation.vector);
        self.gauge.set(running.reading(&step.world.physics, &origin));
        Ok(())
    }

    fn grains(&self, world: &SpatialWorld, centers: &mut Vec<Point3<f64>>, turns: &mut Vec<UnitQuaternion<f64>>) {
        let Some(running) = &self.running else { return };
        let is_long = matches!(running.grains.batch().config().shape, GrainShape::Capsule { .. });
        for body in running.grains.bodies(&world.physics) {
            let pose = Isometry3::from(*body.position());
            centers.push(Point3::from(pose.translation.vector));
            if is_long {
                turns.push(pose.rotation);
            }
        }
    }

    fn series(&self, values: &mut Vec<f64>) {
        let Some(running) = &self.running else { return };
        let counts = running.monitor.counts();
        let lip = running.lip.now();
        values.extend([
            running.monitor.flow_kg_per_s() * GRAMS,
            counts.target as f64,
            counts.spilt as f64,
            counts.source as f64,
            self.gauge.read().collected_kg * GRAMS,
            lip.distance_m * MM,
            lip.tilt_rad.to_degrees(),
        ]);
    }

    fn digest(&self, world: &SpatialWorld, digest: &mut blake3::Hasher) {
        if let Some(running) = &self.running {
            running.grains.digest(&world.physics, digest);
        }
    }
}

/// The lip's distance from the opening of the target's mouth, m: from the disc that its rim bounds.
fn lip_to_mouth_m(source: &AttachedContainer, target: &AttachedContainer, physics: &PhysicsWorld) -> f64 {
    let (lip, _) = source.lip_in_world(physics);
    let (center, normal) = target.mouth_in_world(physics);
    let way = lip - center;
    let height = way.dot(&normal);
    let beside = (way - normal * height).norm() - target.container().rim.radius_m;
    height.hypot(beside.max(0.0))
}
