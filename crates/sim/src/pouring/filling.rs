//! Filling a container: grains on a lattice above the floor, let fall until they are quiet.

use nalgebra::{Isometry3, Point3, Translation3, UnitQuaternion, Vector3};
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, StandardNormal};
use rapier3d::math::Vector;
use rapier3d::prelude::{ColliderHandle, InteractionGroups, PhysicsWorld, RigidBodyBuilder};
use serde::{Deserialize, Serialize};
use skills::field::{FieldError, within};

use super::container::Container;
use super::engine::GrainEngineConfig;
use super::grains::{GrainBatch, GrainConfig, Grains};
use crate::error::SimError;
use crate::random::symmetric;

/// Share of the volume that grains fill in a vessel about ten of them wide: measured of the default grain, of which 550
/// stand 51.5 mm high in a cup 70 mm wide. Grains that roll more easily pack more densely, up to 0.57.
pub const PACKING_FRACTION: f64 = 0.50;
/// Share that cannot be exceeded: random close packing.
const CLOSE_PACKING: f64 = 0.64;
/// Gap between the grains of the lattice, in grain lengths.
const LATTICE_PITCH: f64 = 1.04;
/// Quiet: nothing moves faster than this, m/s, for that long, s; the pile must be so within the time given, s.
const QUIET_M_PER_S: f64 = 0.005;
const QUIET_S: f64 = 0.1;
const PATIENCE_S: f64 = 8.0;
/// Most grains that a filling may have.
const MOST_GRAINS: usize = 20_000;

/// How much is filled in.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum FillAmount {
    /// That many grains.
    Count(usize),
    /// Up to this height above the inner floor, m, at the packing fraction of loosely poured balls.
    HeightM(f64),
}

/// Grains at rest in a container.
#[derive(Clone, Debug, PartialEq)]
pub struct Filling {
    /// The grains with their sizes.
    pub batch: GrainBatch,
    /// Pose of each grain in the container's frame.
    pub container_from_grains: Vec<Isometry3<f64>>,
    /// Remaining linear (m/s) and angular (rad/s) velocity of each grain, container axes.
    pub velocities_in_container: Vec<(Vector3<f64>, Vector3<f64>)>,
    /// Height of the fill above the inner floor, m: twice the height of the grains' common center of mass. Exact for a
    /// straight cup.
    pub fill_height_m: f64,
}

impl FillAmount {
    /// Number of grains of this amount in a container.
    ///
    /// # Errors
    /// A [`FieldError`] if it is none, or more than fit below the rim.
    pub fn count(&self, container: &Container, grain: &GrainConfig) -> Result<usize, FieldError> {
        let volume = grain.volume_m3();
        let most = ((CLOSE_PACKING * container.capacity_m3 / volume) as usize).min(MOST_GRAINS);
        match self {
            Self::Count(count) if (1..=most).contains(count) => Ok(*count),
            Self::Count(count) => {
                let expected = format!("a number from 1 to {most}, what fits below the rim of {}", container.name);
                Err(FieldError::new("count", count, expected))
            }
            Self::HeightM(height) => {
                let inner = container.rim.center_in_container.z - container.floor_m;
                within("height_m", *height, grain.diameter_m, inner)?;
                let count = (PACKING_FRACTION * container.volume_to_m3(*height) / volume).round() as usize;
                Self::Count(count).count(container, grain)
            }
        }
    }
}

/// Settles grains in an upright container and returns where they lie: the same for the same generator state.
///
/// While they settle, a wall on top of the rim keeps them in; it is taken away before the pile must be quiet.
///
/// # Errors
/// A field error if the amount or a configuration value cannot be used, or if grains fall out when that wall is gone.
pub fn fill(
    container: &Container,
    grain: &GrainConfig,
    engine: &GrainEngineConfig,
    amount: FillAmount,
    random: &mut ChaCha8Rng,
) -> Result<Filling, SimError> {
    grain.validate().map_err(|error| error.within("grain"))?;
    engine.validate().map_err(|error| error.within("engine"))?;
    let count = amount.count(container, grain).map_err(|error| error.within("fill"))?;
    let batch = GrainBatch::draw(grain, count, random)?;
    let poses = lattice(container, &batch, random)?;
    let mut settling = Settling::new(container, engine, batch, &poses)?;
    settling.until_quiet()?;
    settling.take_guide_away();
    settling.until_quiet()?;
    settling.finish(container)
}

/// Places for a batch: layer upon layer within the narrowest part of the hollow, each grain turned and moved a little.
fn lattice(
    container: &Container,
    batch: &GrainBatch,
    random: &mut ChaCha8Rng,
) -> Result<Vec<Isometry3<f64>>, FieldError> {
    let longest = batch.longest_m();
    let pitch = LATTICE_PITCH * longest;
    // 0.995: the sides of the polygon lie a little inside the circle
    let reach = 0.995 * container.meridian.least_radius_m() - 0.5 * pitch;
    if reach < 0.0 {
        let expected = format!("less than {:.4}, the container's narrowest width", 2.0 * (reach + 0.5 * pitch));
        return Err(FieldError::new("grain.diameter_m", longest, expected));
    }
    let half = (reach / pitch).floor() as i32;
    let columns: Vec<(f64, f64)> = (-half..=half)
        .flat_map(|i| (-half..=half).map(move |j| (pitch * f64::from(i), pitch * f64::from(j))))
        .filter(|(x, y)| x.hypot(*y) <= reach)
        .collect();
    let lowest = container.floor_m + 0.5 * pitch;
    let place = |index: usize| {
        let layer = index / columns.len();
        let (x, y) = columns.get(index % columns.len()).copied().unwrap_or_default();
        let play = 0.4 * (pitch - longest);
        let moved = Translation3::new(
            x + play * symmetric(random),
            y + play * symmetric(random),
            lowest + pitch * layer as f64,
        );
        Isometry3::from_parts(moved, any_turn(random))
    };
    Ok((0..batch.len()).map(place).collect())
}

/// A rotation, all equally likely.
fn any_turn(random: &mut ChaCha8Rng) -> UnitQuaternion<f64> {
    let mut draw = || -> f64 { StandardNormal.sample(random) };
    UnitQuaternion::from_quaternion(nalgebra::Quaternion::new(draw(), draw(), draw(), draw()))
}

/// A world of its own, in which a filling comes to rest.
struct Settling {
    physics: PhysicsWorld,
    grains: Grains,
    guide: ColliderHandle,
}

impl Settling {
    fn new(
        container: &Container,
        engine: &GrainEngineConfig,
        batch: GrainBatch,
        poses: &[Isometry3<f64>],
    ) -> Result<Self, SimError> {
        let mut physics = PhysicsWorld::new();
        physics.gravity = Vector::new(0.0, 0.0, -9.81);
        engine.apply(&mut physics.integration_parameters);
        let body = physics.insert_body(RigidBodyBuilder::fixed());
        physics.insert_collider(container.collider(batch.config()), Some(body));
        let above_rim = poses.iter().map(|pose| pose.translation.z).fold(0.0, f64::max) - container.meridian.top_m();
        let guide = container.guide(batch.config(), above_rim.max(0.0) + 2.0 * batch.longest_m());
        let guide = physics.insert_collider(guide, Some(body));
        let grains = Grains::insert(&mut physics, batch, poses, InteractionGroups::all())?;
        Ok(Self { physics, grains, guide })
    }

    fn until_quiet(&mut self) -> Result<(), SimError> {
        let dt = self.physics.integration_parameters.dt;
        let (mut quiet_s, mut time_s) = (0.0, 0.0);
        while quiet_s < QUIET_S {
            self.grains.before_step(&mut self.physics);
            self.physics.step();
            time_s += dt;
            let speed = self.grains.greatest_speed_m_per_s(&self.physics);
            quiet_s = if speed < QUIET_M_PER_S { quiet_s + dt } else { 0.0 };
            if time_s > PATIENCE_S {
                let found = format!("a grain that still moves at {speed:.4} m/s after {PATIENCE_S} s");
                let expected = "a pile that comes to rest; reduce engine.time_step_s or the number of grains";
                return Err(FieldError::new("fill", found, expected).into());
            }
        }
        Ok(())
    }

    fn take_guide_away(&mut self) {
        self.physics.remove_collider(self.guide);
    }

    fn finish(self, container: &Container) -> Result<Filling, SimError> {
        let mut container_from_grains = Vec::with_capacity(self.grains.len());
        self.grains.poses(&self.physics, &mut container_from_grains);
        let fallen = container_from_grains.iter().filter(|pose| out_of(container, pose)).count();
        if fallen > 0 {
            let found = format!("{fallen} of {} grains fell out of {}", self.grains.len(), container.name);
            return Err(FieldError::new("fill", found, "a lower fill, or a larger container").into());
        }
        let vector = |v: Vector| Vector3::new(v.x, v.y, v.z);
        let velocities =
            self.grains.bodies(&self.physics).map(|body| (vector(body.linvel()), vector(body.angvel()))).collect();
        let masses: f64 = self.grains.batch().masses_kg().sum();
        let moment: f64 =
            self.grains.batch().masses_kg().zip(&container_from_grains).map(|(m, p)| m * p.translation.z).sum();
        Ok(Filling {
            fill_height_m: 2.0 * (moment / masses - container.floor_m),
            batch: self.grains.batch().clone(),
            container_from_grains,
            velocities_in_container: velocities,
        })
    }
}

/// Whether a grain lies beside or below the hollow; a heap above the rim is still in the container.
fn out_of(container: &Container, pose: &Isometry3<f64>) -> bool {
    let mut at = Point3::from(pose.translation.vector);
    at.z = at.z.min(container.meridian.top_m());
    !container.holds(&at)
}
