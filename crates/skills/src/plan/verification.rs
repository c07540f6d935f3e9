//! Verification of a plan: continuity of its chain, timing, and the conditions of its actions.
//!
//! The paper chains O2 and TF skills without saying when a chain is one. Here an action ends at rest where the next one
//! begins; a push touches the object with its surface, inside the usable length, and leads it along the normal; between
//! pushes the object rests and the tool does not overlap it.

use nalgebra::Vector3;
use serde::Serialize;

use super::condition::{Check, Condition, Moment, Scene, angle_rad};
use super::continuity::{Joint, Jump};
use super::refusal::ChainError;
use super::{Action, ActionKind, ChainTolerances, Plan, PlanarMotion, Push, Setting};
use crate::error::SkillError;
use crate::tool::ContactSurface;

/// What was measured of a plan.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ChainReport {
    /// Jumps where actions meet.
    pub joints: Vec<Joint>,
    /// What was measured of each action.
    pub actions: Vec<ActionReport>,
}

/// What was measured of one action.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ActionReport {
    /// Name of the action.
    pub name: String,
    /// Time of the plan at which it begins, s.
    pub begins_s: f64,
    /// Its duration, s.
    pub duration_s: f64,
    /// Largest jumps of the tool between its motions.
    pub tool: Jump,
    /// Largest jumps of the object between its motions.
    pub object: Jump,
    /// Its conditions; those of geometry only if a setting was given.
    pub checks: Vec<Check>,
}

impl Plan {
    /// Measures continuity, timing and conditions of the plan at every motion, whether they are met or not.
    ///
    /// Without a `setting` only what needs no tool is measured: rests, and places of the object.
    ///
    /// # Errors
    /// [`ChainError::Skill`] if tolerances or setting are none, [`ChainError::Surface`] if a push names a surface that the
    /// tool does not have.
    pub fn inspect(
        &self,
        setting: Option<&Setting<'_>>,
        tolerances: &ChainTolerances,
    ) -> Result<ChainReport, ChainError> {
        tolerances.validate().map_err(SkillError::from)?;
        setting.map_or(Ok(()), Setting::validate).map_err(SkillError::from)?;
        let mut actions = Vec::with_capacity(self.actions.len());
        for (index, (action, begins_s)) in self.actions.iter().zip(&self.starts_s).enumerate() {
            let mut inspection = Inspection { action, begins_s: *begins_s, tolerances, checks: Vec::new() };
            inspection.rests();
            if let Some(setting) = setting {
                inspection
                    .geometry(setting, [index.checked_sub(1), index.checked_add(1)].map(|other| self.push(other)))?;
            }
            actions.push(ActionReport {
                name: action.name.clone(),
                begins_s: *begins_s,
                duration_s: action.tool.duration_s(),
                tool: action.tool.largest_jump(),
                object: action.object.largest_jump(),
                checks: inspection.checks,
            });
        }
        Ok(ChainReport { joints: self.joints(), actions })
    }

    /// Verifies continuity (C0 and C1), timing and conditions of the plan, and reports them with their margins.
    ///
    /// # Errors
    /// As [`Plan::inspect`], and the first violation: timing, then joints, then jumps inside actions, then conditions, each in
    /// the order of the actions. It names action, condition, time and number, and what to do.
    pub fn verify(
        &self,
        setting: Option<&Setting<'_>>,
        tolerances: &ChainTolerances,
    ) -> Result<ChainReport, ChainError> {
        self.check_timing()?;
        let report = self.inspect(setting, tolerances)?;
        for joint in &report.joints {
            joint.check(tolerances)?;
        }
        for (action, report) in self.actions.iter().zip(&report.actions) {
            action.check_inside(report, tolerances)?;
        }
        report.check_conditions()?;
        Ok(report)
    }

    fn push(&self, index: Option<usize>) -> Option<Push> {
        match self.actions.get(index?)?.kind {
            ActionKind::ObjectOperating(push) => Some(push),
            ActionKind::ToolFlipping => None,
        }
    }

    /// Checks that every action takes time, on one grid.
    fn check_timing(&self) -> Result<(), ChainError> {
        let step_s = self.actions.first().map_or(0.0, |action| action.tool.time_step_s());
        for action in &self.actions {
            if action.tool.duration_s() <= 0.0 {
                return Err(ChainError::NoDuration { action: action.name.clone() });
            }
            let found_s = action.tool.time_step_s();
            if (found_s - step_s).abs() > ROUNDING * step_s {
                return Err(ChainError::Grid { action: action.name.clone(), found_s, expected_s: step_s });
            }
        }
        Ok(())
    }
}

/// Relative rounding of a time step that was computed.
const ROUNDING: f64 = 1e-9;

impl ChainReport {
    /// The largest jump of an acceleration where actions meet, m/s² of tool or object: how far the chain is from C2.
    #[must_use]
    pub fn largest_acceleration_jump_m_per_s2(&self) -> f64 {
        let jumps = self.joints.iter().flat_map(|joint| [joint.tool, joint.object]);
        jumps.map(|jump| jump.acceleration_m_per_s2).fold(0.0, f64::max)
    }

    /// Checks that do not hold, with the action that they belong to.
    pub fn violations(&self) -> impl Iterator<Item = (&ActionReport, &Check)> {
        let all = self.actions.iter().flat_map(|action| action.checks.iter().map(move |check| (action, check)));
        all.filter(|(_, check)| !check.holds())
    }

    fn check_conditions(&self) -> Result<(), ChainError> {
        match self.violations().next() {
            None => Ok(()),
            Some((action, check)) => {
                Err(ChainError::Condition { action: action.name.clone(), check: Box::new(check.clone()) })
            }
        }
    }
}

/// Angles count as the ways of a point at this distance from the origin, m: the size of a tool.
const ARM_M: f64 = 0.1;

/// Length of a displacement or velocity (x, y, angle), m or m/s: the larger of what the origin and the arm's end go.
fn length(motion: &Vector3<f64>) -> f64 {
    motion.xy().norm().max(motion.z.abs() * ARM_M)
}

/// An action under inspection.
struct Inspection<'a> {
    action: &'a Action,
    begins_s: f64,
    tolerances: &'a ChainTolerances,
    checks: Vec<Check>,
}

impl Inspection<'_> {
    /// Looks for the largest `number` of those at a moment; numbers of `None` do not count.
    fn check(
        &mut self,
        condition: Condition,
        moment: Moment,
        limit: f64,
        number: impl Fn(&PlanarMotion, &PlanarMotion) -> Option<f64>,
    ) {
        let (tool, object) = (self.action.tool.motions(), self.action.object.motions());
        let last = tool.len().saturating_sub(1);
        let rows = match moment {
            Moment::Start => 0..=0,
            Moment::Throughout => 0..=last,
            Moment::End => last..=last,
        };
        let mut worst: Option<(usize, f64)> = None;
        for row in rows {
            let found = tool.get(row).zip(object.get(row)).and_then(|(tool, object)| number(tool, object));
            // what is no number is the worst
            if let Some(found) = found.filter(|found| worst.is_none_or(|(_, most)| found.is_nan() || *found > most)) {
                worst = Some((row, found));
            }
        }
        if let Some((row, found)) = worst {
            let time_s = self.begins_s + row as f64 * self.action.tool.time_step_s();
            self.checks.push(Check { condition, moment, time_s, found, limit });
        }
    }

    /// Tool and object rest where the action begins and ends; on a flip the object rests throughout.
    fn rests(&mut self) {
        let limit = self.tolerances.velocity_m_per_s;
        for moment in [Moment::Start, Moment::End] {
            self.check(Condition::ToolAtRest, moment, limit, |tool, _| Some(length(&tool.velocity)));
            self.check(Condition::ObjectAtRest, moment, limit, |_, object| Some(length(&object.velocity)));
        }
        let position_m = self.tolerances.position_m;
        match self.action.kind {
            ActionKind::ToolFlipping => {
                let rest = self.action.object.start().position;
                let left = move |_: &PlanarMotion, object: &PlanarMotion| Some(length(&(object.position - rest)));
                self.check(Condition::ObjectStays, Moment::Throughout, position_m, left);
            }
            ActionKind::ObjectOperating(push) => {
                for (moment, place) in [(Moment::Start, push.from_world), (Moment::End, push.to_world)] {
                    let off = move |_: &PlanarMotion, object: &PlanarMotion| Some((object.point() - place).norm());
                    self.check(Condition::ObjectInPlace, moment, position_m, off);
                }
            }
        }
    }

    /// Contact, direction and clearance; `neighbors` are the pushes right before and after.
    fn geometry(&mut self, setting: &Setting<'_>, neighbors: [Option<Push>; 2]) -> Result<(), ChainError> {
        let scene =
            |tool: &PlanarMotion, object: &PlanarMotion| Scene { setting, tool: tool.pose(), object: object.pose() };
        match self.action.kind {
            ActionKind::ObjectOperating(push) => {
                let surface = self.surface(setting, &push)?;
                for moment in [Moment::Start, Moment::Throughout, Moment::End] {
                    self.contact(setting, surface, moment);
                }
                self.direction(setting, surface);
            }
            ActionKind::ToolFlipping => {
                for (push, moment) in neighbors.iter().zip([Moment::Start, Moment::End]) {
                    if let Some(push) = push {
                        self.contact(setting, self.surface(setting, push)?, moment);
                    }
                }
            }
        }
        let (moment, tolerances) = (Moment::Throughout, self.tolerances);
        self.check(Condition::ToolClearOfObject, moment, tolerances.overlap_m, |tool, object| {
            Some(scene(tool, object).overlap_m())
        });
        if !setting.obstacles.is_empty() {
            self.check(Condition::ToolClearOfObstacles, moment, 0.0, |tool, object| {
                Some(scene(tool, object).tool_lacks_m(tolerances))
            });
            self.check(Condition::ObjectClearOfObstacles, moment, 0.0, |tool, object| {
                Some(scene(tool, object).object_lacks_m(tolerances))
            });
        }
        Ok(())
    }

    fn surface<'s>(&self, setting: &Setting<'s>, push: &Push) -> Result<&'s ContactSurface, ChainError> {
        setting.tool.surfaces.get(push.surface).ok_or_else(|| ChainError::Surface {
            action: self.action.name.clone(),
            surface: push.surface,
            tool: setting.tool.name.clone(),
            surfaces: setting.tool.surfaces.len(),
        })
    }

    fn contact(&mut self, setting: &Setting<'_>, surface: &ContactSurface, moment: Moment) {
        let scene =
            |tool: &PlanarMotion, object: &PlanarMotion| Scene { setting, tool: tool.pose(), object: object.pose() };
        let (gap_m, beyond_m) = (self.tolerances.gap_m, self.tolerances.beyond_surface_m);
        self.check(Condition::InContact(surface.name.clone()), moment, gap_m, |tool, object| {
            Some(scene(tool, object).gap_m(surface))
        });
        self.check(Condition::OnSurface(surface.name.clone()), moment, beyond_m, |tool, object| {
            Some(scene(tool, object).beyond_m(surface))
        });
    }

    fn direction(&mut self, setting: &Setting<'_>, surface: &ContactSurface) {
        let speed = |object: &PlanarMotion| object.velocity.xy().norm();
        let most = self.action.object.motions().iter().map(speed).fold(0.0, f64::max);
        let least = (most * self.tolerances.least_speed_share).max(f64::EPSILON);
        let limit = self.tolerances.push_angle_rad.unwrap_or(setting.tool.friction.atan());
        self.check(Condition::AlongNormal(surface.name.clone()), Moment::Throughout, limit, |tool, object| {
            let scene = Scene { setting, tool: tool.pose(), object: object.pose() };
            (speed(object) >= least).then(|| angle_rad(&scene.normal(surface), &object.velocity.xy()))
        });
    }
}
