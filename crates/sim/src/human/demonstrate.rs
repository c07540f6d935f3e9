//! One demonstration: a human with a tool, an object on a table, and two recorders with clocks of their own.

use nalgebra::{DMatrix, Isometry2, Point2, Unit, Vector2};
use skills::Trajectory;
use skills::demonstration::Demonstration;
use skills::outline::PlacedOutline;
use skills::tool::Tool;
use skills::tool_use::{Undivided, divide};

use super::config::HumanConfig;
use super::hand::Hand;
use super::motor::MotorNoise;
use super::operator::{Leg, Operator};
use crate::error::SimError;
use crate::planar::{EngineConfig, ObjectConfig, Party, PlanarWorld, Tracker, WorldConfig};
use crate::random::{Purpose, stream};
use crate::sensing::{Camera, CameraConfig};

/// What the human is asked to show.
#[derive(Clone, Debug)]
pub struct DemonstrationTask<'a> {
    /// The table.
    pub world: &'a WorldConfig,
    /// The object.
    pub object: &'a ObjectConfig,
    /// The tool.
    pub tool: &'a Tool,
    /// Contact surfaces to push with, in their order: indices into the tool's list.
    pub surfaces: &'a [usize],
    /// Where the object starts, world frame.
    pub start_world: Point2<f64>,
    /// Where the object is wanted, world frame.
    pub goal_world: Point2<f64>,
    /// Where the tool waits before, world frame.
    pub home_world: Point2<f64>,
    /// Where the tool is put afterwards, world frame.
    pub park_world: Point2<f64>,
    /// The human.
    pub human: &'a HumanConfig,
    /// The camera that records the object.
    pub camera: &'a CameraConfig,
    /// Time step and contact solver.
    pub engine: &'a EngineConfig,
}

/// A demonstration and what became of it.
#[derive(Clone, Debug)]
pub struct Trial {
    /// What the recorders saw.
    pub demonstration: Demonstration,
    /// Why the trial failed; `None` if it succeeded.
    pub failure: Option<String>,
    /// True distance of the object from the goal at the end, m.
    pub goal_error_m: f64,
    /// Times that the human let go and took hold again within a push.
    pub renewed_holds: usize,
    /// Rows (start, end, s) in which the tool truly touched the object: the truth that recordings do not show.
    pub touches_s: Vec<(f64, f64)>,
}

/// Rate at which the tool's pose is recorded, Hz.
const TOOL_RECORDING_HZ: f64 = 200.0;
/// Resolution of the tool's recorded position, m: a desktop haptic device.
const TOOL_GRID_M: f64 = 0.000_055;
/// Error of a human eye on the object's place, standard deviation, m, and frames per second.
const EYE_NOISE_M: f64 = 0.0003;
const EYE_RATE_HZ: f64 = 60.0;

/// Lets a human show the task once; `trial` selects the random numbers. It counts from 0, names count from 1.
///
/// # Errors
/// A [`SimError`] if the scene is invalid, the surfaces cannot show the task, or the state diverges. A trial that misses
/// its goal is no error: it says so.
pub fn demonstrate(task: &DemonstrationTask<'_>, seed: u64, trial: u64) -> Result<Trial, SimError> {
    let radius_m = task.object.shape.inscribed_radius_m();
    let length_m = task.object.shape.mean_radius_m();
    let obstacles: Vec<PlacedOutline> = task.world.obstacles.iter().map(crate::planar::Obstacle::placed).collect();
    let start = Isometry2::new(task.start_world.coords, 0.0);
    let mut world = PlanarWorld::new(task.world, task.object, task.engine, &start)?;
    let hand = Hand::insert(&mut world, task.tool, task.human, &Isometry2::new(task.home_world.coords, 0.0));
    let noise = MotorNoise::new(task.human, stream(seed, Purpose::Hand, trial));
    let legs = legs(task)?;
    let mut operator = Operator::new(
        task.tool,
        &obstacles,
        task.human,
        legs,
        [task.home_world, task.park_world],
        &task.object.shape,
        noise,
    );
    let steps = task.engine.steps_per_period();
    // the human decides as often as a controller would; what is decided changes no faster than the reaction time allows
    let period_s = steps as f64 * world.time_step_s();
    let eyes = eyes_of(task.human);
    let mut belief = Tracker::new(task.tool, radius_m, length_m, task.start_world, &eyes, period_s);
    let mut eyes = Camera::new(&eyes, stream(seed, Purpose::Eyes, trial));
    let mut camera = Camera::new(task.camera, stream(seed, Purpose::Recorder, trial));
    let mut recorder = Recorder::default();
    let mut hit_obstacle_s = None;
    while !operator.is_done() && world.time_s() < task.human.patience_s {
        let (time_s, object) = (world.time_s(), world.world_from_object());
        let tool = hand.world_from_tool(&world);
        recorder.tool(time_s, &tool);
        recorder.object(camera.look(time_s, &object));
        recorder.touch(
            time_s,
            world.contacts().iter().any(|contact| contact.involves(Party::Tool) && contact.involves(Party::Object)),
        );
        belief.advance(time_s, &tool, eyes.look(time_s, &object).as_ref());
        let (place, velocity) = operator.act(time_s, period_s, &tool, &belief);
        for _ in 0..steps {
            hand.pull(&mut world, &place, &velocity, 0.0);
            world.step();
            let hit = world.contacts().iter().any(crate::planar::ContactForce::involves_obstacle);
            hit_obstacle_s = hit_obstacle_s.or(hit.then_some(time_s));
        }
        if !world.world_from_object().translation.vector.norm().is_finite() {
            return Err(SimError::Diverged { quantity: "the object's place".into(), value: f64::NAN, time_s });
        }
    }
    let goal_error_m = (Point2::from(world.world_from_object().translation.vector) - task.goal_world).norm();
    let failure = if let Some(time_s) = hit_obstacle_s {
        Some(format!("touched an obstacle at {time_s:.2} s"))
    } else if !operator.is_done() {
        Some(format!("took longer than {} s", task.human.patience_s))
    } else if goal_error_m > task.human.satisfied_m {
        Some(format!("left the object {:.1} mm from where it was wanted", 1e3 * goal_error_m))
    } else {
        None
    };
    let renewed_holds = operator.renewed_holds;
    let touches_s = recorder.touches_s.clone();
    let demonstration = recorder.finish(&format!("trial {}", trial + 1))?;
    Ok(Trial { demonstration, failure, goal_error_m, renewed_holds, touches_s })
}

fn eyes_of(human: &HumanConfig) -> CameraConfig {
    CameraConfig {
        rate_hz: EYE_RATE_HZ,
        latency_s: human.reaction_s,
        noise_m: EYE_NOISE_M,
        ..CameraConfig { jitter_s: 0.0, bias_m: 0.0, angle_noise_rad: 0.0, drop_out: 0.0, ..CameraConfig::default() }
    }
}

/// The pushes that bring the object from start to goal with the given surfaces.
fn legs(task: &DemonstrationTask<'_>) -> Result<Vec<Leg>, SimError> {
    let chosen =
        task.surfaces.iter().filter_map(|&surface| task.tool.surfaces.get(surface).map(|shape| (surface, shape)));
    let directions: Vec<(usize, Vector2<f64>)> =
        chosen.map(|(surface, shape)| (surface, shape.middle().normal.into_inner())).collect();
    let normals: Vec<Vector2<f64>> = directions.iter().map(|(_, normal)| *normal).collect();
    let displacement = task.goal_world - task.start_world;
    let lengths = divide(&normals, &displacement, &vec![0.0; normals.len()]).map_err(|undivided| {
        let found = match undivided {
            Undivided::Pull(index, length) => {
                format!("a task in which surface {index} of the list would pull by {:.4} m", -length)
            }
            Undivided::Directions(miss) => format!("surfaces that miss the demonstration's goal by {miss:.4} m"),
        };
        skills::field::FieldError::new(
            "surfaces",
            found,
            "surfaces whose pushes add up to the demonstrated displacement",
        )
    })?;
    let mut at = task.start_world;
    let legs = directions.iter().zip(&lengths).map(|((surface, normal), length)| {
        at += normal * *length;
        Leg { surface: *surface, to_world: at, direction: Unit::new_normalize(*normal) }
    });
    Ok(legs.collect())
}

/// What the recorders write down.
#[derive(Default)]
struct Recorder {
    tool: Vec<(f64, [f64; 3])>,
    object: Vec<(f64, [f64; 3])>,
    touches_s: Vec<(f64, f64)>,
}

impl Recorder {
    fn tool(&mut self, time_s: f64, pose: &Isometry2<f64>) {
        let due = self.tool.len() as f64 / TOOL_RECORDING_HZ;
        if time_s + 1e-9 >= due {
            let grid = |value: f64| (value / TOOL_GRID_M).round() * TOOL_GRID_M;
            self.tool.push((time_s, [grid(pose.translation.x), grid(pose.translation.y), pose.rotation.angle()]));
        }
    }

    fn object(&mut self, sighting: Option<crate::sensing::Sighting>) {
        let Some(sighting) = sighting else { return };
        if self.object.last().is_none_or(|last| sighting.exposed_s > last.0) {
            let pose = sighting.world_from_object;
            self.object.push((sighting.exposed_s, [pose.translation.x, pose.translation.y, pose.rotation.angle()]));
        }
    }

    fn touch(&mut self, time_s: f64, touches: bool) {
        match self.touches_s.last_mut() {
            // touches that follow at once are one touch
            Some(last) if touches && time_s - last.1 < 0.02 => last.1 = time_s,
            _ if touches => self.touches_s.push((time_s, time_s)),
            _ => {}
        }
    }

    fn finish(self, name: &str) -> Result<Demonstration, SimError> {
        Ok(Demonstration::new(name, trajectory(&self.tool)?, trajectory(&self.object)?)?)
    }
}

fn trajectory(rows: &[(f64, [f64; 3])]) -> Result<Trajectory, SimError> {
    let times = rows.iter().map(|(time, _)| *time).collect();
    Ok(Trajectory::new(times, DMatrix::from_fn(rows.len(), 3, |row, column| rows[row].1[column]))?)
}
