//! A transfer: from an intention to a chain of pushes and flips with another tool.

use nalgebra::Point2;

use super::chaining::Chain;
use super::config::TransferConfig;
use super::passages::Side;
use super::phases::Phases;
use super::reference::Reference;
use super::refusal::{TransferError, explain};
use super::search::PhaseSearch;
use super::shapes::Shapes;
use super::workplace::Workplace;
use crate::error::SkillError;
use crate::field::{FieldError, finite, positive};
use crate::plan::Plan;
use crate::tool_flipping::Flip;
use crate::tool_use::SkillLibrary;

/// A pushing task for another tool.
#[derive(Debug, Clone)]
pub struct TransferProblem<'a> {
    /// World, object and tool.
    pub workplace: Workplace<'a>,
    /// Options.
    pub config: &'a TransferConfig,
    /// Where the object's center starts, world frame.
    pub start_world: Point2<f64>,
    /// Where the object's center is wanted, world frame.
    pub goal_world: Point2<f64>,
    /// Where the tool's origin waits before, world frame.
    pub home_world: Point2<f64>,
    /// Where the tool's origin is put afterwards, world frame.
    pub park_world: Point2<f64>,
    /// Side on which each obstacle is passed, if it is set.
    pub sides: &'a [Option<Side>],
    /// Mean speed of a push, m/s.
    pub push_speed_m_per_s: f64,
    /// Mean speed of the tool through free space, m/s.
    pub free_speed_m_per_s: f64,
    /// Time between two motions of the plan, s.
    pub time_step_s: f64,
}

/// A transferred skill.
#[derive(Debug, Clone, PartialEq)]
pub struct Transfer {
    /// The chain of actions.
    pub plan: Plan,
    /// The path that it keeps near.
    pub reference: Reference,
    /// The phases, with the cost of their search.
    pub phases: Phases,
    /// The flips between them.
    pub flips: Vec<Flip>,
    /// Changes of hold, first and last holds that were given up because no way of the tool was found there.
    pub barred_switches: usize,
}

/// Parts of plans that are given up before there is said to be no way.
const MOST_BARRED: usize = 60;

impl TransferProblem<'_> {
    /// Plans: the intention is generalized and kept out of obstacles, phases are searched for near it, flips are found
    /// between them, and all is chained and verified.
    ///
    /// Where no way of the tool is found for the phases of least cost, those of the next least are tried. The plan is a
    /// chain by [`Plan::verify`]; its tool and its object keep their margins from obstacles at every instant.
    ///
    /// # Errors
    /// A [`TransferError`] that says which constraint closes the last way, or which flip or way of the tool is not there.
    pub fn plan(&self, library: &SkillLibrary) -> Result<Transfer, TransferError> {
        self.validate().map_err(SkillError::from)?;
        let slack_m = self.config.slack_m;
        let mut workplace = self.workplace.clone();
        workplace.object_margin_m = self.config.object_margin_m + slack_m;
        workplace.tool_margin_m = self.config.tool_margin_m + slack_m;
        let (start, goal) = (self.start_world, self.goal_world);
        let reference = Reference::new(&workplace, self.config, &library.intention, start, goal, self.sides)?;
        let points = reference.points();
        let mut search =
            PhaseSearch::new(&workplace, &self.config.search, &points, start, goal).map_err(SkillError::from)?;
        let shapes = Shapes::new(&workplace);
        let chain = Chain {
            workplace: &workplace,
            shapes: &shapes,
            config: self.config,
            library,
            home_world: self.home_world,
            park_world: self.park_world,
            push_speed_m_per_s: self.push_speed_m_per_s,
            free_speed_m_per_s: self.free_speed_m_per_s,
            time_step_s: self.time_step_s,
        };
        // of many reasons, that of the phases of least cost is the one to mend
        let mut refusal = None;
        for barred_switches in 0..MOST_BARRED {
            let Some(phases) = search.solve() else {
                return Err(refusal.unwrap_or_else(|| explain(&workplace, &self.config.search, start, goal).into()));
            };
            match chain.plan(&phases) {
                Ok((plan, flips)) => return Ok(Transfer { plan, reference, phases, flips, barred_switches }),
                Err(obstructed) => {
                    let Some(at) = obstructed.at else { return Err(obstructed.error) };
                    search.bar(&phases, at);
                    refusal.get_or_insert(obstructed.error);
                }
            }
        }
        let (x_m, y_m) = (start.x, start.y);
        Err(refusal.unwrap_or(TransferError::NoWay { what: "the goal".into(), x_m, y_m }))
    }

    /// Checks options, world, places and speeds.
    fn validate(&self) -> Result<(), FieldError> {
        self.config.validate()?;
        self.workplace.validate()?;
        for (field, place) in [
            ("start_world", self.start_world),
            ("goal_world", self.goal_world),
            ("home_world", self.home_world),
            ("park_world", self.park_world),
        ] {
            finite(field, place.coords.as_slice())?;
        }
        positive("push_speed_m_per_s", self.push_speed_m_per_s)?;
        positive("free_speed_m_per_s", self.free_speed_m_per_s)?;
        positive("time_step_s", self.time_step_s)
    }
}
