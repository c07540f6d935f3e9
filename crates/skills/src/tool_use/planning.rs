//! From skills to a plan: legs of pushes from start to goal, and the ways of the tool around them.
//!
//! A stick pushes in the directions of its surfaces only, so a displacement is divided among the surfaces in the order of
//! the demonstration: lengths that add up to the displacement and are nearest to the demonstrated ones.

use nalgebra::{DVector, Point2, Rotation2, UnitComplex, Vector2, Vector3};
use serde::{Deserialize, Serialize};

use super::closing::{closed, turned};
use super::legs::{Undivided, divide_within};
use super::library::{ObjectOperatingSkill, SkillLibrary};
use super::refusal::PlanError;
use super::routing::Surroundings;
use super::ways::{ROUND_M, round_object};
use crate::error::SkillError;
use crate::outline::Outline;
use crate::plan::{Action, ActionKind, Plan, PlanarMotion, Track};
use crate::primitive::{MovementPrimitive, RolloutRequest};
use crate::tool::{Contact, ContactSurface, Tool};

/// How the tool is turned.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Orientation {
    /// As in the demonstrations: the tool's axes stay along the world's.
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

/// Gap between tool and object at the end of an approach, m: the push closes it.
pub(super) const APPROACH_GAP_M: f64 = 0.001;
/// Shortest push worth a hold of its own, m: twice what a camera is usually off by. What is shorter is left out.
const SHORTEST_PUSH_M: f64 = 0.002;
/// A motion has at least this many time steps.
const FEWEST_STEPS: f64 = 10.0;

/// Where the plan has got to.
struct Progress {
    /// Place of the tool, and the direction in which it leaves its hold: zero without one.
    tool_world: (Point2<f64>, Vector2<f64>),
    object_world: Point2<f64>,
    /// Index of the next way of the tool that was not used yet.
    flip: usize,
}

impl PushProblem<'_> {
    /// Plans with the skills of `library`.
    ///
    /// Each push goes along the normal of its surface, as far as the goal needs; what no push of 2 mm or more can mend is
    /// left. A push that the task does not need is left out, and the tool goes directly to the next hold, by the shortest
    /// way round the object.
    ///
    /// # Errors
    /// A [`PlanError`] that says which surface or direction is in the way, or which argument is out of its range.
    pub fn plan(&self, library: &SkillLibrary) -> Result<Plan, PlanError> {
        self.validate()?;
        let angle_rad = self.tool_angle_rad(library);
        let surfaces = self.surfaces(library)?;
        let lengths = self.leg_lengths(library, &surfaces, angle_rad)?;
        let mut actions = Vec::new();
        let mut now =
            Progress { tool_world: (self.home_world, Vector2::zeros()), object_world: self.start_world, flip: 0 };
        for (index, ((skill, surface), length)) in library.pushes.iter().zip(&surfaces).zip(&lengths).enumerate() {
            if *length <= 0.0 {
                continue;
            }
            let contact = surface.middle();
            let along = self.direction(&contact, angle_rad);
            let end = now.object_world + along * *length;
            let hold = (self.hold(&contact, &now.object_world, APPROACH_GAP_M, angle_rad), -along);
            let verb = if actions.is_empty() { "approach" } else { "flip to" };
            actions.push(self.flip(library, &mut now, index, format!("{verb} {}", surface.name), hold, angle_rad)?);
            actions.push(self.push(skill, surface, now.object_world, end, angle_rad)?);
            now.tool_world = (self.hold(&contact, &end, 0.0, angle_rad), -along);
            now.object_world = end;
        }
        let last = library.pushes.len();
        actions.push(self.flip(
            library,
            &mut now,
            last,
            "withdraw".into(),
            (self.park_world, Vector2::zeros()),
            angle_rad,
        )?);
        Ok(Plan::new(actions)?)
    }

    /// Checks that places and speeds are numbers that a plan can be made of.
    fn validate(&self) -> Result<(), SkillError> {
        let refuse = |argument, found, expected| {
            Err(SkillError::InvalidArgument { operation: "plan push", argument, found, expected })
        };
        for (argument, place) in [
            ("start_world", self.start_world),
            ("goal_world", self.goal_world),
            ("home_world", self.home_world),
            ("park_world", self.park_world),
        ] {
            if let Some(found) = place.iter().find(|coordinate| !coordinate.is_finite()) {
                return refuse(argument, *found, "finite numbers");
            }
        }
        for (argument, value) in [
            ("push_speed_m_per_s", self.push_speed_m_per_s),
            ("free_speed_m_per_s", self.free_speed_m_per_s),
            ("time_step_s", self.time_step_s),
        ] {
            if !(value.is_finite() && value > 0.0) {
                return refuse(argument, value, "a finite number greater than 0");
            }
        }
        Ok(())
    }

    /// The surface of each push of the library.
    fn surfaces(&self, library: &SkillLibrary) -> Result<Vec<&ContactSurface>, PlanError> {
        let find = |skill: &ObjectOperatingSkill| {
            self.tool.surfaces.get(skill.surface).ok_or_else(|| PlanError::Surface {
                surface: skill.surface,
                tool: self.tool.name.clone(),
                surfaces: self.tool.surfaces.len(),
            })
        };
        library.pushes.iter().map(find).collect()
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

    pub(super) fn direction(&self, contact: &Contact, angle_rad: f64) -> Vector2<f64> {
        UnitComplex::new(angle_rad) * contact.normal.into_inner()
    }

    /// Place of the tool's origin that holds the object at `center` with a gap, its nearest side to the contact.
    pub(super) fn hold(&self, contact: &Contact, center: &Point2<f64>, gap_m: f64, angle_rad: f64) -> Point2<f64> {
        let pose = self.tool.pose_touching(contact, center, self.object.inscribed_radius_m(), gap_m, angle_rad);
        Point2::from(pose.translation.vector)
    }

    /// Length of each push, m, zero if it is not needed: adds up to the displacement, nearest to the demonstrated lengths.
    fn leg_lengths(
        &self,
        library: &SkillLibrary,
        surfaces: &[&ContactSurface],
        angle_rad: f64,
    ) -> Result<Vec<f64>, PlanError> {
        let wanted = self.goal_world - self.start_world;
        if wanted.norm() < SHORTEST_PUSH_M {
            return Err(PlanError::AtGoal { distance_m: wanted.norm(), least_m: SHORTEST_PUSH_M });
        }
        let normals: Vec<Vector2<f64>> =
            surfaces.iter().map(|surface| self.direction(&surface.middle(), angle_rad)).collect();
        let shown: Vec<f64> = library.pushes.iter().map(|push| push.displacement.norm()).collect();
        divide_within(&normals, &wanted, &shown, SHORTEST_PUSH_M).map_err(|undivided| match undivided {
            Undivided::Directions(miss_m) => PlanError::Directions { miss_m },
            Undivided::Pull(index, length_m) => {
                let surface = surfaces.get(index).map_or_else(String::new, |surface| surface.name.clone());
                PlanError::Pull { surface, length_m }
            }
        })
    }

    /// The way of the tool to a hold or its park: the flip `last` if it is the next one, else one that was not shown.
    fn flip(
        &self,
        library: &SkillLibrary,
        now: &mut Progress,
        last: usize,
        name: String,
        to: (Point2<f64>, Vector2<f64>),
        angle_rad: f64,
    ) -> Result<Action, PlanError> {
        let center = now.object_world;
        let turn = Rotation2::new(angle_rad);
        let direct;
        let skill = match library.flips.get(last).filter(|_| now.flip == last) {
            Some(skill) => skill,
            None => {
                let places = round_object(&self.surroundings(center, angle_rad), now.tool_world, to);
                direct = library.way_along(places.into_iter().map(|place| turn.inverse() * place).collect())?;
                &direct
            }
        };
        now.flip = last + 1;
        let (from, to) = (now.tool_world.0, to.0);
        let (start, goal) = (turn.inverse() * (from - center), turn.inverse() * (to - center));
        // a way round the object is longer than the straight one, as it was shown
        let length = skill.length_m.max((to - from).norm());
        let duration_s = self.whole_steps_s(length / self.free_speed_m_per_s);
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

    fn surroundings(&self, center: Point2<f64>, angle_rad: f64) -> Surroundings<'_> {
        Surroundings {
            tool: self.tool,
            angle_rad,
            object_world: center,
            object_radius_m: self.object.radius_m(),
            obstacles: &[],
            margin_m: ROUND_M,
        }
    }

    /// The next whole number of time steps, s: tracks lie on a uniform grid.
    pub(super) fn whole_steps_s(&self, duration_s: f64) -> f64 {
        // a rounding above a whole number is no further step
        (duration_s / self.time_step_s - 1e-6).ceil().max(FEWEST_STEPS) * self.time_step_s
    }

    /// Rolls a primitive out and closes what is left at its end, so that it arrives exactly and at rest.
    pub(super) fn rollout(
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
        Ok(closed(&track, &Vector3::new(goal.x, goal.y, 0.0)))
    }
}
