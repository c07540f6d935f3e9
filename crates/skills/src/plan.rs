//! Plans: chains of timed actions that say where the tool should be and where the object is expected.

mod condition;
mod continuity;
mod refusal;
mod retiming;
mod setting;
mod track;
mod verification;

use nalgebra::{Point2, Vector2};

pub use condition::{Check, Condition, Moment};
pub use continuity::{Body, Joint, Jump};
pub use refusal::{ChainError, Quantity};
pub use setting::{ChainTolerances, Setting};
pub use track::{PlanarMotion, Track};
pub use verification::{ActionReport, ChainReport};

use crate::error::SkillError;

/// What an action does with the object.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ActionKind {
    /// The tool moves the object (object-operating, O2).
    ObjectOperating(Push),
    /// The tool goes from one contact to another without moving the object (tool-flipping, TF).
    ToolFlipping,
}

/// How an object-operating action pushes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Push {
    /// Index of the contact surface in the tool's list.
    pub surface: usize,
    /// Where on the surface the object is held: arc length from its middle, m, positive to the left of the normal.
    pub place_m: f64,
    /// Where the object's center begins, world frame.
    pub from_world: Point2<f64>,
    /// Where the object's center ends, world frame.
    pub to_world: Point2<f64>,
}

impl Push {
    /// Unit direction of the push; `None` if it leads nowhere.
    #[must_use]
    pub fn direction_world(&self) -> Option<Vector2<f64>> {
        (self.to_world - self.from_world).try_normalize(f64::EPSILON)
    }
}

/// One link of a plan.
#[derive(Clone, Debug, PartialEq)]
pub struct Action {
    /// Name, as recordings and reports call it.
    pub name: String,
    /// What it does with the object.
    pub kind: ActionKind,
    /// Where the tool should be, world frame.
    pub tool: Track,
    /// Where the object is expected, world frame.
    pub object: Track,
}

/// A chain of actions, each beginning where and when the one before ends.
#[derive(Clone, Debug, PartialEq)]
pub struct Plan {
    actions: Vec<Action>,
    starts_s: Vec<f64>,
}

/// Consecutive actions meet within this distance, m, and angle, rad.
const JOINT_TOLERANCE: f64 = 1e-4;

impl Plan {
    /// Chains actions that meet in place and angle; [`Plan::verified`] asks for what else makes a strict chain.
    ///
    /// # Errors
    /// [`SkillError::Gap`] if one action does not begin where the one before ends, [`SkillError::RowCount`] without any or
    /// if tool and object of an action have tracks of different lengths.
    pub fn new(actions: Vec<Action>) -> Result<Self, SkillError> {
        if actions.is_empty() {
            return Err(SkillError::RowCount { operation: "chain actions", found: 0, expected: "at least 1".into() });
        }
        for action in &actions {
            let (tool, object) = (action.tool.motions().len(), action.object.motions().len());
            if tool != object || action.tool.time_step_s() != action.object.time_step_s() {
                let expected = format!("{tool} motions of the object at the steps of the tool");
                return Err(SkillError::RowCount { operation: "chain actions", found: object, expected });
            }
        }
        for (before, after) in actions.iter().zip(actions.iter().skip(1)) {
            for (end, start) in [(before.tool.end(), after.tool.start()), (before.object.end(), after.object.start())] {
                let gap = (end.position - start.position).norm();
                if gap > JOINT_TOLERANCE {
                    return Err(SkillError::Gap { gap, largest_gap: JOINT_TOLERANCE });
                }
            }
        }
        let mut time_s = 0.0;
        let starts_s = actions
            .iter()
            .map(|action| {
                let start = time_s;
                time_s += action.tool.duration_s();
                start
            })
            .collect();
        Ok(Self { actions, starts_s })
    }

    /// Chains actions and verifies the chain as [`Plan::verify`] does, so that what is built keeps continuity (C0 and C1),
    /// timing, pre- and post-conditions; the report tells by how much.
    ///
    /// # Errors
    /// As [`Plan::new`] and [`Plan::verify`].
    pub fn verified(
        actions: Vec<Action>,
        setting: Option<&Setting<'_>>,
        tolerances: &ChainTolerances,
    ) -> Result<(Self, ChainReport), ChainError> {
        let plan = Self::new(actions)?;
        let report = plan.verify(setting, tolerances)?;
        Ok((plan, report))
    }

    /// The actions in their order.
    #[must_use]
    pub fn actions(&self) -> &[Action] {
        &self.actions
    }

    /// Time of the whole plan, s.
    #[must_use]
    pub fn duration_s(&self) -> f64 {
        self.actions.iter().map(|action| action.tool.duration_s()).sum()
    }

    /// Index of the action that is due at a time, and the time since it began, s.
    #[must_use]
    pub fn due_at(&self, time_s: f64) -> (usize, f64) {
        let index = self.starts_s.partition_point(|start| *start <= time_s).saturating_sub(1);
        (index, time_s - self.starts_s.get(index).copied().unwrap_or(0.0))
    }
}

#[cfg(test)]
mod tests {
    use nalgebra::Vector3;

    use super::*;

    /// One meter along x in one second.
    fn track(offset: f64) -> Track {
        let motion = |k: usize| PlanarMotion::at_rest(Vector3::new(offset + k as f64 / 100.0, 0.0, 0.0));
        Track::new(0.01, (0..=100).map(motion).collect()).unwrap()
    }

    fn action(offset: f64) -> Action {
        Action { name: "move".into(), kind: ActionKind::ToolFlipping, tool: track(offset), object: track(offset) }
    }

    #[test]
    fn an_object_that_is_timed_otherwise_than_its_tool_is_refused() {
        let rest = |step, rows| Track::new(step, vec![PlanarMotion::default(); rows]).unwrap();
        for object in [rest(0.01, 100), rest(0.02, 101)] {
            assert!(matches!(Plan::new(vec![Action { object, ..action(0.0) }]), Err(SkillError::RowCount { .. })));
        }
        assert!(matches!(Plan::new(vec![]), Err(SkillError::RowCount { found: 0, .. })));
    }

    #[test]
    fn a_chain_with_a_gap_is_refused() {
        assert!(Plan::new(vec![action(0.0), action(1.0)]).is_ok());
        assert!(matches!(Plan::new(vec![action(0.0), action(1.1)]), Err(SkillError::Gap { .. })));
    }

    #[test]
    fn the_action_that_is_due_is_found_by_time() {
        let plan = Plan::new(vec![action(0.0), action(1.0)]).unwrap();
        assert_eq!(plan.due_at(0.5), (0, 0.5));
        assert_eq!(plan.due_at(1.25), (1, 0.25));
        assert_eq!(plan.due_at(9.0), (1, 8.0));
    }
}
