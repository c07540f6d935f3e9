//! A reference that follows the plan whatever the object does.

use nalgebra::Isometry2;
use skills::plan::{Action, ActionKind, Plan, Track};

use super::{ReferenceSource, ToolReference};
use crate::sensing::Sighting;

/// Follows the plan whatever the object does.
#[derive(Clone, Debug)]
pub struct OpenLoop<'a> {
    plan: &'a Plan,
}

impl<'a> OpenLoop<'a> {
    /// Follows `plan`.
    #[must_use]
    pub fn new(plan: &'a Plan) -> Self {
        Self { plan }
    }
}

impl ReferenceSource for OpenLoop<'_> {
    fn next(&mut self, time_s: f64, _world_from_tool: &Isometry2<f64>, _sighting: Option<&Sighting>) -> ToolReference {
        let (phase, local_s) = self.plan.due_at(time_s);
        let action = self.plan.actions().get(phase);
        let motion = |track: fn(&Action) -> &Track| action.map(|action| track(action).at(local_s)).unwrap_or_default();
        ToolReference {
            tool: motion(|action| &action.tool),
            world_from_object_expected: motion(|action| &action.object).pose(),
            object_believed_world: None,
            phase,
            is_pushing: action.is_some_and(|action| matches!(action.kind, ActionKind::ObjectOperating(_))),
            renews_hold: false,
            gives_up: false,
            finished: time_s >= self.plan.duration_s(),
        }
    }
}
