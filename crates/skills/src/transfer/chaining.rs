//! The chain of actions along phases: approach, pushes with flips between them, withdrawal; nothing leaves unverified.

use nalgebra::{Isometry2, Point2, Vector2, Vector3};

use super::barring::Barring;
use super::config::TransferConfig;
use super::phases::{Phase, Phases};
use super::refusal::TransferError;
use super::shapes::Shapes;
use super::sweep::first_near;
use super::workplace::Workplace;
use crate::error::SkillError;
use crate::plan::{Action, ActionKind, ChainTolerances, Plan, PlanarMotion, Push, Setting, Track};
use crate::tool_flipping::Flip;
use crate::tool_use::{SkillLibrary, Surroundings, straight_on};

/// A motion has at least this many time steps.
const FEWEST_STEPS: f64 = 10.0;
/// Distances that an approach or withdrawal is led round at, m, tried in turn: a learned way rounds its corners, and a
/// narrow place needs a nearer one.
const ROUND_M: [f64; 4] = [0.010, 0.015, 0.006, 0.004];
/// A way of the tool that begins or ends in touch may cut this deep into the object, m: rounding of what was learned.
const CUT_M: f64 = 1e-4;
/// Mean over largest speed of a minimum-jerk motion.
const MEAN_OVER_PEAK: f64 = 1.0 / 1.875;

/// What actions are chained from.
pub(super) struct Chain<'a> {
    /// World, object and tool, the margins with their slack.
    pub(super) workplace: &'a Workplace<'a>,
    pub(super) shapes: &'a Shapes,
    pub(super) config: &'a TransferConfig,
    pub(super) library: &'a SkillLibrary,
    pub(super) home_world: Point2<f64>,
    pub(super) park_world: Point2<f64>,
    pub(super) push_speed_m_per_s: f64,
    pub(super) free_speed_m_per_s: f64,
    pub(super) time_step_s: f64,
}

/// Why phases cannot be carried out, and what a search is to do without if that may help.
pub(super) struct Obstructed {
    pub(super) at: Option<Barring>,
    pub(super) error: TransferError,
}

impl<E: Into<TransferError>> From<E> for Obstructed {
    fn from(error: E) -> Self {
        Self { at: None, error: error.into() }
    }
}

impl Chain<'_> {
    /// Chains the actions of phases and verifies the plan.
    pub(super) fn plan(&self, phases: &Phases) -> Result<(Plan, Vec<Flip>), Obstructed> {
        let mut changes = self.changes(phases)?.into_iter();
        let mut flips = Vec::new();
        let mut actions = Vec::new();
        let rest = Vector2::zeros();
        for phase in &phases.phases {
            if actions.is_empty() {
                let name = format!("approach {}", self.name(phase));
                let hold = (self.hold(phase, &phase.from_world), -phase.hold.direction);
                let way = self.free_way(&name, (phase, phase.from_world), (self.home_world, rest), hold);
                actions.push(way.map_err(|error| obstructed(Barring::Start, error))?);
            } else if let Some((flip, tool)) = changes.next() {
                let object = self.resting(&phase.from_world, tool.motions().len())?;
                let name = format!("flip to {}", self.name(phase));
                actions.push(Action { name, kind: ActionKind::ToolFlipping, tool, object });
                flips.push(flip);
            }
            actions.push(self.push(phase)?);
        }
        if let Some(last) = phases.phases.last() {
            let place = Point2::from(last.hold.world_from_tool(&last.to_world).translation.vector);
            let hold = (place, -last.hold.direction);
            let way = self.free_way("withdraw", (last, last.to_world), hold, (self.park_world, rest));
            actions.push(way.map_err(|error| obstructed(Barring::End, error))?);
        }
        let plan = Plan::new(actions)?;
        self.verify(&plan)?;
        Ok((plan, flips))
    }

    fn name(&self, phase: &Phase) -> &str {
        self.workplace.tool.surfaces.get(phase.hold.surface).map_or("", |surface| &surface.name)
    }

    /// Place of the tool at which it waits for a phase, a gap before the object.
    fn hold(&self, phase: &Phase, center: &Point2<f64>) -> Point2<f64> {
        let before = center - phase.hold.direction * self.config.approach_gap_m;
        Point2::from(phase.hold.world_from_tool(&before).translation.vector)
    }

    /// The object straight along its phase, the tool behind it; the tool closes its gap on the way.
    fn push(&self, phase: &Phase) -> Result<Action, SkillError> {
        let way = phase.to_world - phase.from_world;
        let duration_s = self.whole_steps_s(way.norm() / self.push_speed_m_per_s);
        let steps = (duration_s / self.time_step_s).round();
        let line = |from: Point2<f64>, to: Point2<f64>, angle_rad: f64| {
            let ends = [from, to].map(|place| place.coords.push(angle_rad)).into();
            let motions = (0..=steps as usize).map(|step| straight_on(&ends, step as f64 / steps, duration_s));
            Track::new(self.time_step_s, motions.collect())
        };
        let end = Point2::from(phase.hold.world_from_tool(&phase.to_world).translation.vector);
        Ok(Action {
            name: format!("push {}", self.name(phase)),
            kind: ActionKind::ObjectOperating(Push {
                surface: phase.hold.surface,
                place_m: phase.hold.place_m,
                from_world: phase.from_world,
                to_world: phase.to_world,
            }),
            tool: line(self.hold(phase, &phase.from_world), end, phase.hold.tool_angle_rad)?,
            object: line(phase.from_world, phase.to_world, self.workplace.object_angle_rad)?,
        })
    }

    /// A way of the tool through free space, its angle kept, past object and obstacles: the first that is certified to be.
    fn free_way(
        &self,
        name: &str,
        (phase, center): (&Phase, Point2<f64>),
        from: (Point2<f64>, Vector2<f64>),
        to: (Point2<f64>, Vector2<f64>),
    ) -> Result<Action, TransferError> {
        for margin_m in ROUND_M {
            let around = Surroundings {
                tool: self.workplace.tool,
                angle_rad: phase.hold.tool_angle_rad,
                object_world: center,
                object_radius_m: self.workplace.object.radius_m(),
                obstacles: if self.workplace.tool_passes { &[] } else { self.workplace.obstacles },
                margin_m: margin_m.max(self.workplace.tool_margin_m),
            };
            let found = self.library.free_way(&around, from, to, self.free_speed_m_per_s, self.time_step_s)?;
            if let Some(tool) = found.filter(|tool| self.is_way_clear(tool, &center)) {
                let object = self.resting(&center, tool.motions().len())?;
                return Ok(Action { name: name.into(), kind: ActionKind::ToolFlipping, tool, object });
            }
        }
        Err(TransferError::NoWay { what: name.into(), x_m: center.x, y_m: center.y })
    }

    /// Whether a way of the tool is certified to stay out of the object and to keep the margin from obstacles.
    fn is_way_clear(&self, tool: &Track, center: &Point2<f64>) -> bool {
        let lever_m = self.shapes.tool_lever_m();
        let of_object = |pose: &Isometry2<f64>| self.shapes.gap_m(pose, center);
        self.is_clear_of_obstacles(tool) && first_near(tool, lever_m, -CUT_M, of_object).is_none()
    }

    fn is_clear_of_obstacles(&self, tool: &Track) -> bool {
        let of_obstacles = |pose: &Isometry2<f64>| self.shapes.tool_clearance_up_to_m(pose, f64::INFINITY);
        self.workplace.tool_passes
            || first_near(tool, self.shapes.tool_lever_m(), self.config.tool_margin_m, of_obstacles).is_none()
    }

    fn resting(&self, center: &Point2<f64>, rows: usize) -> Result<Track, SkillError> {
        let rest = PlanarMotion::at_rest(Vector3::new(center.x, center.y, self.workplace.object_angle_rad));
        Track::new(self.time_step_s, vec![rest; rows])
    }

    /// The next whole number of time steps, s: tracks lie on a uniform grid.
    pub(super) fn whole_steps_s(&self, duration_s: f64) -> f64 {
        // a rounding above a whole number is no further step
        (duration_s / self.time_step_s - 1e-6).ceil().max(FEWEST_STEPS) * self.time_step_s
    }

    /// Verifies that the plan is a chain whose pushes touch and lead along their normals, and that tool and object keep
    /// their margins from obstacles between its motions too.
    fn verify(&self, plan: &Plan) -> Result<(), TransferError> {
        // obstacles have margins of their own for tool and object, which the sweeps below look at
        let setting = Setting { tool: self.workplace.tool, object: self.workplace.object, obstacles: &[] };
        plan.verify(Some(&setting), &self.tolerances())?;
        for action in plan.actions() {
            let of_obstacles = |pose: &Isometry2<f64>| {
                self.shapes.object_clearance_up_to_m(&Point2::from(pose.translation.vector), f64::INFINITY)
            };
            // an object that is not turned has no lever
            let object = first_near(&action.object, 0.0, self.config.object_margin_m, of_obstacles);
            if object.is_some() || !self.is_clear_of_obstacles(&action.tool) {
                let center = action.object.start().point();
                return Err(TransferError::NoWay { what: action.name.clone(), x_m: center.x, y_m: center.y });
            }
        }
        Ok(())
    }

    /// Jump of the velocity that a flip may have between two motions, m/s: its way is C¹, so that v²/r sets in at once on a
    /// turn, of which half a time step is missing; it turns back on twice its margin, and the acceleration of a cubic
    /// swings by as much again.
    pub(super) fn largest_bend_m_per_s(&self) -> f64 {
        let fastest = self.free_speed_m_per_s / MEAN_OVER_PEAK;
        let turn_m = 2.0 * self.config.flip.margin_m / std::f64::consts::PI;
        (self.time_step_s * fastest * fastest / turn_m).max(ChainTolerances::default().velocity_m_per_s)
    }

    /// Tolerances of a plan: the gap of an approach, what a learned way cuts, and how a flip bends.
    fn tolerances(&self) -> ChainTolerances {
        ChainTolerances {
            gap_m: self.config.approach_gap_m + CUT_M,
            overlap_m: CUT_M,
            velocity_m_per_s: self.largest_bend_m_per_s(),
            ..ChainTolerances::default()
        }
    }
}

/// What was refused at a place, unless another place would not help.
fn obstructed(at: Barring, error: TransferError) -> Obstructed {
    let at = matches!(error, TransferError::NoWay { .. }).then_some(at);
    Obstructed { at, error }
}
