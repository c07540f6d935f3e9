//! The pushes of a plan: skills rolled out along the normals of their surfaces, as far as the task needs.

use nalgebra::{Point2, Rotation2, Vector2};

use super::closing::{goes_on, shrunk, straight_on, turned};
use super::library::ObjectOperatingSkill;
use super::planning::{APPROACH_GAP_M, PushProblem};
use super::refusal::PlanError;
use crate::error::SkillError;
use crate::plan::{Action, ActionKind, PlanarMotion, Push, Track};
use crate::tool::ContactSurface;

impl PushProblem<'_> {
    /// The push from one place of the object to another, along the normal of `surface`.
    pub(super) fn push(
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
        let duration_s = self.whole_steps_s(way.norm() / self.push_speed_m_per_s);
        let gap = turn.inverse() * -self.direction(&contact, angle_rad) * APPROACH_GAP_M;
        let [object, pushed] = self.pushed(skill, shown_way, gap, duration_s)?;
        let hold = self.hold(&contact, &from, 0.0, angle_rad);
        let place = |motions: Vec<PlanarMotion>, start: Point2<f64>, angle: f64| {
            let moved = motions.into_iter().map(|motion| turned(&motion, &turn, &start, angle)).collect();
            Track::new(self.time_step_s, moved)
        };
        Ok(Action {
            name: format!("push {}", surface.name),
            kind: ActionKind::ObjectOperating(Push {
                surface: skill.surface,
                place_m: 0.0,
                from_world: from,
                to_world: to,
            }),
            tool: place(pushed, hold, angle_rad)?,
            object: place(object, from, 0.0)?,
        })
    }

    /// Motions of the object along `way`, and of the tool that closes `gap` meanwhile, both relative to where the object
    /// begins.
    ///
    /// What a skill adds to the straight way does not depend on the goal. On a push shorter than shown it shrinks with the
    /// push: else it would lead the object back where it was shown to hesitate.
    fn pushed(
        &self,
        skill: &ObjectOperatingSkill,
        way: Vector2<f64>,
        gap: Vector2<f64>,
        duration_s: f64,
    ) -> Result<[Vec<PlanarMotion>; 2], SkillError> {
        let share = (way.norm() / skill.displacement.norm()).min(1.0);
        let motions = |start: Vector2<f64>| {
            let rollout = self.rollout(skill.primitive.as_ref(), start / share, way / share, duration_s)?;
            Ok::<Vec<_>, SkillError>(rollout.iter().map(|motion| shrunk(motion, share)).collect())
        };
        let [object, tool] = [motions(Vector2::zeros())?, motions(gap)?];
        if goes_on(&object, &way) {
            return Ok([object, tool]);
        }
        let steps = (duration_s / self.time_step_s).round();
        let straight = |start: Vector2<f64>| {
            let from_to = (start.push(0.0), way.push(0.0));
            (0..=steps as usize).map(|step| straight_on(&from_to, step as f64 / steps, duration_s)).collect()
        };
        Ok([straight(Vector2::zeros()), straight(gap)])
    }
}
