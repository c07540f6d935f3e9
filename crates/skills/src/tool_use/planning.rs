//! From skills to a plan: legs of pushes from start to goal, and the ways of the tool around them.
//!
//! A stick pushes in the directions of its surfaces only, so a displacement is divided among the surfaces in the order of
//! the demonstration: lengths that add up to the displacement and are nearest to the demonstrated ones.

use nalgebra::{DVector, Isometry2, Point2, Rotation2, UnitComplex, Vector2, Vector3};
use serde::{Deserialize, Serialize};

use super::legs::{Undivided, divide};
use super::library::{ObjectOperatingSkill, SkillLibrary, ToolFlippingSkill};
use crate::error::SkillError;
use crate::outline::Outline;
use crate::plan::{Action, ActionKind, Plan, PlanarMotion, Push, Track};
use crate::primitive::{MovementPrimitive, RolloutRequest};
use crate::tool::{Contact, ContactSurface, Tool};

/// How the tool is turned.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Orientation {
    /// As in the demonstrations: the tool keeps its angle.
    #[default]
    Fixed,
    /// With the task: by the angle between the demonstrated and the wanted displacement of the object.
    WithTask,
}

/// A pushing task for which a plan is wanted.
#[derive(Clone, Debug)]
pub struct PushProblem<'a> {
    /// Where the object's center starts, world frame.
    pub start_world: Point2<f64>,
    /// Where the object's center is wanted, world frame.
    pub goal_world: Point2<f64>,
    /// Where the tool's origin waits before, world frame.
    pub home_world: Point2<f64>,
    /// Where the tool's origin is put afterwards, world frame.
    pub park_world: Point2<f64>,
    /// Outline of the object.
    pub object: &'a Outline,
    /// The tool.
    pub tool: &'a Tool,
    /// How the tool is turned.
    pub orientation: Orientation,
    /// Speed of a push, m/s.
    pub push_speed_m_per_s: f64,
    /// Speed of the tool through free space, m/s.
    pub free_speed_m_per_s: f64,
    /// Time between two motions of the plan, s.
    pub time_step_s: f64,
}

/// Why there is no plan.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum PlanError {
    /// The demonstrated surfaces cannot push the object to the goal.
    #[error(
        "plan push: the goal needs {length_m:.4} m of push with the surface '{surface}'; expected at least 0, since a \
         surface cannot pull; choose another goal, or demonstrate with a surface that faces the other way"
    )]
    Pull {
        /// Name of the surface.
        surface: String,
        /// Length that it would have to push, m.
        length_m: f64,
    },
    /// The demonstrated surfaces do not span the displacement.
    #[error(
        "plan push: the demonstrated surfaces miss the goal by {miss_m:.4} m; expected directions that add up to the \
         displacement; demonstrate a push in the missing direction"
    )]
    Directions {
        /// What is left of the displacement, m.
        miss_m: f64,
    },
    /// A skill could not be rolled out.
    #[error(transparent)]
    Skill(#[from] SkillError),
}

/// Gap between tool and object at the end of an approach, m: the push closes it.
const APPROACH_GAP_M: f64 = 0.001;
/// A rolled-out way is closed to its goal within its last share, so that actions meet exactly.
const CLOSING_SHARE: f64 = 0.3;

impl PushProblem<'_> {
    /// Plans with the skills of `library`.
    ///
    /// # Errors
    /// A [`PlanError`] that says which surface or direction is in the way.
    pub fn plan(&self, library: &SkillLibrary) -> Result<Plan, PlanError> {
        let angle_rad = self.tool_angle_rad(library);
        let lengths = self.leg_lengths(library, angle_rad)?;
        let mut actions = Vec::new();
        let mut center = self.start_world;
        let mut tool_at = self.home_world;
        for (index, (skill, length)) in library.pushes.iter().zip(&lengths).enumerate() {
            let Some(surface) = self.tool.surfaces.get(skill.surface) else { continue };
            let contact = surface.middle();
            let end = center + self.direction(&contact, angle_rad) * *length;
            let hold = self.hold(&contact, &center, APPROACH_GAP_M, angle_rad);
            if let Some(flip) = library.flips.get(index) {
                let name =
                    if index == 0 { format!("approach {}", surface.name) } else { format!("flip to {}", surface.name) };
                actions.push(self.flip(flip, name, tool_at, hold, center, angle_rad)?);
            }
            actions.push(self.push(skill, surface, center, end, angle_rad)?);
            tool_at = self.hold(&contact, &end, 0.0, angle_rad);
            center = end;
        }
        if let Some(flip) = library.flips.last() {
            actions.push(self.flip(flip, "withdraw".into(), tool_at, self.park_world, center, angle_rad)?);
        }
        Ok(Plan::new(actions)?)
    }

    /// Angle of the tool in this task, rad.
    fn tool_angle_rad(&self, library: &SkillLibrary) -> f64 {
        match self.orientation {
            Orientation::Fixed => 0.0,
            Orientation::WithTask => {
                let shown: Vector2<f64> = library.pushes.iter().map(|push| push.displacement).sum();
                Rotation2::rotation_between(&shown, &(self.goal_world - self.start_world)).angle()
            }
        }
    }

    fn direction(&self, contact: &Contact, angle_rad: f64) -> Vector2<f64> {
        UnitComplex::new(angle_rad) * contact.normal.into_inner()
    }

    /// Distance from the contact to the object's center when the surface's normal points at it, m.
    fn object_depth_m(&self) -> f64 {
        match self.object {
            Outline::Disc { radius_m } => *radius_m,
            other => -other.signed_distance_m(&other.centroid()),
        }
    }

    /// Place of the tool's origin that holds the object at `center` with a gap.
    fn hold(&self, contact: &Contact, center: &Point2<f64>, gap_m: f64, angle_rad: f64) -> Point2<f64> {
        let pose = self.tool.pose_touching(contact, center, self.object_depth_m(), gap_m, angle_rad);
        Point2::from(pose.translation.vector)
    }

    /// Length of each push: adds up to the displacement, nearest to the demonstrated lengths.
    fn leg_lengths(&self, library: &SkillLibrary, angle_rad: f64) -> Result<Vec<f64>, PlanError> {
        let surfaces: Vec<&ContactSurface> =
            library.pushes.iter().filter_map(|push| self.tool.surfaces.get(push.surface)).collect();
        let normals: Vec<Vector2<f64>> =
            surfaces.iter().map(|surface| self.direction(&surface.middle(), angle_rad)).collect();
        let shown: Vec<f64> = library.pushes.iter().map(|push| push.displacement.norm()).collect();
        divide(&normals, &(self.goal_world - self.start_world), &shown).map_err(|undivided| match undivided {
            Undivided::Directions(miss_m) => PlanError::Directions { miss_m },
            Undivided::Pull(index, length_m) => {
                let surface = surfaces.get(index).map_or_else(String::new, |surface| surface.name.clone());
                PlanError::Pull { surface, length_m }
            }
        })
    }

    fn push(
        &self,
        skill: &ObjectOperatingSkill,
        surface: &ContactSurface,
        from: Point2<f64>,
        to: Point2<f64>,
        angle_rad: f64,
    ) -> Result<Action, PlanError> {
        let contact = surface.middle();
        let way = to - from;
        // the skill is rolled out as it was shown; the task may be turned against it
        let turn = Rotation2::new(angle_rad);
        let shown_way = turn.inverse() * way;
        let duration_s = (way.norm() / self.push_speed_m_per_s).max(self.shortest_s());
        let origin = Vector2::zeros();
        let object = self.rollout(skill.primitive.as_ref(), origin, shown_way, duration_s)?;
        let gap = turn.inverse() * -self.direction(&contact, angle_rad) * APPROACH_GAP_M;
        let pushed = self.rollout(skill.primitive.as_ref(), gap, shown_way, duration_s)?;
        let hold = self.hold(&contact, &from, 0.0, angle_rad);
        let place = |motions: Vec<PlanarMotion>, start: Point2<f64>, angle: f64| {
            let moved = motions.into_iter().map(|motion| turned(&motion, &turn, &start, angle)).collect();
            Track::new(self.time_step_s, moved)
        };
        Ok(Action {
            name: format!("push {}", surface.name),
            kind: ActionKind::ObjectOperating(Push { surface: skill.surface, from_world: from, to_world: to }),
            tool: place(pushed, hold, angle_rad)?,
            object: place(object, from, 0.0)?,
        })
    }

    fn flip(
        &self,
        skill: &ToolFlippingSkill,
        name: String,
        from: Point2<f64>,
        to: Point2<f64>,
        center: Point2<f64>,
        angle_rad: f64,
    ) -> Result<Action, PlanError> {
        let turn = Rotation2::new(angle_rad);
        let (start, goal) = (turn.inverse() * (from - center), turn.inverse() * (to - center));
        // the way shown tells how much longer than the straight one it is
        let length = skill.length_m.max((to - from).norm());
        let duration_s = (length / self.free_speed_m_per_s).max(self.shortest_s());
        let motions = self.rollout(skill.primitive.as_ref(), start, goal, duration_s)?;
        let rows = motions.len();
        let tool = motions.iter().map(|motion| turned(motion, &turn, &center, angle_rad)).collect();
        let rest = PlanarMotion::at_rest(Vector3::new(center.x, center.y, 0.0));
        Ok(Action {
            name,
            kind: ActionKind::ToolFlipping,
            tool: Track::new(self.time_step_s, tool)?,
            object: Track::new(self.time_step_s, vec![rest; rows])?,
        })
    }

    fn shortest_s(&self) -> f64 {
        10.0 * self.time_step_s
    }

    /// Rolls a primitive out and closes what is left at its end, so that it arrives exactly and at rest.
    fn rollout(
        &self,
        primitive: &dyn MovementPrimitive,
        start: Vector2<f64>,
        goal: Vector2<f64>,
        duration_s: f64,
    ) -> Result<Vec<PlanarMotion>, SkillError> {
        let vector = |v: Vector2<f64>| DVector::from_column_slice(&[v.x, v.y]);
        let request = RolloutRequest::new(vector(start), vector(goal), duration_s, self.time_step_s);
        let rollout = primitive.rollout(&request)?;
        let track = Track::from_rollout(&rollout, self.time_step_s, 0.0)?;
        Ok(closed(&track, Vector3::new(goal.x, goal.y, 0.0)))
    }
}

/// A track whose last share is bent so that it ends at `goal` with zero velocity and acceleration.
fn closed(track: &Track, goal: Vector3<f64>) -> Vec<PlanarMotion> {
    let duration = track.duration_s();
    let from_s = duration * (1.0 - CLOSING_SHARE);
    let end = track.end();
    // what is left at the end, as a quintic that starts at zero and cancels it
    let residual = |axis: usize| (goal[axis] - end.position[axis], -end.velocity[axis], -end.acceleration[axis]);
    let horizon = duration - from_s;
    track
        .motions()
        .iter()
        .enumerate()
        .map(|(row, motion)| {
            let time = row as f64 * track.time_step_s() - from_s;
            if time <= 0.0 {
                return *motion;
            }
            let mut bent = *motion;
            for axis in 0..3 {
                let (position, velocity, acceleration) = quintic(residual(axis), horizon, time);
                bent.position[axis] += position;
                bent.velocity[axis] += velocity;
                bent.acceleration[axis] += acceleration;
            }
            bent
        })
        .collect()
}

/// Quintic from rest at zero to the given position, velocity and acceleration at `horizon`, at `time`.
fn quintic((p, v, a): (f64, f64, f64), horizon: f64, time: f64) -> (f64, f64, f64) {
    let r = time / horizon;
    let (v, a) = (v * horizon, a * horizon * horizon);
    let (c3, c4, c5) = (10.0 * p - 4.0 * v + 0.5 * a, -15.0 * p + 7.0 * v - a, 6.0 * p - 3.0 * v + 0.5 * a);
    let position = r * r * r * (c3 + r * (c4 + r * c5));
    let velocity = r * r * (3.0 * c3 + r * (4.0 * c4 + r * 5.0 * c5)) / horizon;
    let acceleration = r * (6.0 * c3 + r * (12.0 * c4 + r * 20.0 * c5)) / (horizon * horizon);
    (position, velocity, acceleration)
}

fn turned(motion: &PlanarMotion, turn: &Rotation2<f64>, origin: &Point2<f64>, angle_rad: f64) -> PlanarMotion {
    let frame = Isometry2::new(origin.coords, turn.angle());
    let at = frame * motion.point();
    let free = |v: &Vector3<f64>| (turn * v.xy()).push(0.0);
    PlanarMotion {
        position: Vector3::new(at.x, at.y, angle_rad),
        velocity: free(&motion.velocity),
        acceleration: free(&motion.acceleration),
    }
}
