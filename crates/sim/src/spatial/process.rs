//! What a task adds to the physics between two steps of the engine: resistance of a food, rolling of grains, a disturbance.

use nalgebra::{Isometry3, Point3, UnitQuaternion, Vector3, Vector6};

use super::arm::SpatialArm;
use super::observer::{BodyDrawing, Event, Observer};
use super::world::SpatialWorld;
use crate::error::SimError;

/// The engine and the arm, as a process meets them.
pub struct Step<'a> {
    /// The scene.
    pub world: &'a mut SpatialWorld,
    /// The arm; its link that holds the tool takes forces by [`SpatialArm::push_tool`].
    pub arm: &'a SpatialArm,
    /// Simulated time at the beginning of the step, s.
    pub time_s: f64,
    /// Time step of the physics, s.
    pub time_step_s: f64,
    /// Index of the plan's current action.
    pub phase: usize,
    /// Where the tool should be.
    pub world_from_tool_reference: Isometry3<f64>,
}

/// Physics of a task. Forces on bodies last for one step; the arm's motors are driven by the control loop.
///
/// Adding a task: implement this, and hand it to [`super::simulate`].
pub trait Process {
    /// Puts into the world what the task adds to the arm, which stands there already, before the first step.
    ///
    /// # Errors
    /// A [`SimError`] if that cannot be built.
    fn begin(&mut self, world: &mut SpatialWorld, arm: &SpatialArm) -> Result<(), SimError> {
        let _ = (world, arm);
        Ok(())
    }

    /// Acts before the engine's step: forces, torques.
    ///
    /// # Errors
    /// A [`SimError`] if the state is not finite.
    fn before_step(&mut self, step: &mut Step<'_>) -> Result<(), SimError> {
        let _ = step;
        Ok(())
    }

    /// Acts after the engine's step: contacts, counts, bodies that come apart.
    ///
    /// # Errors
    /// A [`SimError`] if the state is not finite.
    fn after_step(&mut self, step: &mut Step<'_>) -> Result<(), SimError> {
        let _ = step;
        Ok(())
    }

    /// Force (N) and moment about the tool's origin (N m) that the process exerted on the tool in the last step, world axes.
    fn tool_wrench(&self) -> Vector6<f64> {
        Vector6::zeros()
    }

    /// Writes the poses in the world of the bodies that it told an observer of, in their order.
    fn bodies(&self, world: &SpatialWorld, poses: &mut Vec<Isometry3<f64>>) {
        let _ = (world, poses);
    }

    /// Writes centers and orientations of the grains in the world, in their order.
    fn grains(&self, world: &SpatialWorld, centers: &mut Vec<Point3<f64>>, turns: &mut Vec<UnitQuaternion<f64>>) {
        let _ = (world, centers, turns);
    }

    /// Writes the values of the series that the scene's description names, in their order.
    fn series(&self, values: &mut Vec<f64>) {
        let _ = values;
    }

    /// Hands on what happened since the last call: events, bodies that appeared (all bodies anew, in the order of
    /// [`Process::bodies`], if any did).
    fn tell(&mut self, time_s: f64, observer: &mut dyn Observer) {
        let _ = (time_s, observer);
    }

    /// Adds the state of the process to the run's digest.
    fn digest(&self, world: &SpatialWorld, digest: &mut blake3::Hasher) {
        let _ = (world, digest);
    }

    /// Why the run should be broken off now; `None` to go on.
    fn gives_up(&self) -> Option<String> {
        None
    }
}

/// A scene in which nothing but the arm moves.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct NoProcess;

impl Process for NoProcess {}

/// Keeps event texts and changed bodies until [`Process::tell`] hands them on.
#[derive(Clone, Debug, Default)]
pub struct News {
    events: Vec<Event>,
    bodies: Option<Vec<BodyDrawing>>,
}

impl News {
    /// Notes an event.
    pub fn event(&mut self, event: Event) {
        self.events.push(event);
    }

    /// Notes that the bodies are these from now on.
    pub fn bodies(&mut self, bodies: Vec<BodyDrawing>) {
        self.bodies = Some(bodies);
    }

    /// Hands everything on and forgets it.
    pub fn tell(&mut self, time_s: f64, observer: &mut dyn Observer) {
        if let Some(bodies) = self.bodies.take() {
            observer.bodies(time_s, &bodies);
        }
        for event in self.events.drain(..) {
            observer.event(&event);
        }
    }
}

/// The wrench about `origin` of a force at a point, all in world axes (N, N m).
#[must_use]
pub fn wrench_of(force: &Vector3<f64>, at: &Point3<f64>, origin: &Point3<f64>) -> Vector6<f64> {
    let moment = (at - origin).cross(force);
    Vector6::new(force.x, force.y, force.z, moment.x, moment.y, moment.z)
}
