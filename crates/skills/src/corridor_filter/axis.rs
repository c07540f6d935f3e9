//! One coordinate of a constrained motion, step by step, for use inside a control loop.

use super::coupling::{additional_term, skill_forcing};
use super::{AxisLaw, CorridorFilterConfig, FilterError};
use crate::corridor::Bounds;
use crate::error::SkillError;
use crate::time_law::PathState;

/// Widths of the corridor beyond which a motion counts as diverged.
const DIVERGED: f64 = 1e6;

/// What a filter sees of one coordinate at one time.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct AxisSample {
    /// The generalized skill x^u, ẋ^u, ẍ^u, by time in s.
    pub skill: PathState,
    /// The bounds x^NL and x^NH, by time in s.
    pub bounds: Bounds,
}

impl AxisSample {
    /// Returns p^u = (x^u − x^L)/W with its derivatives: the place of the skill in the corridor, 0 to 1 inside.
    #[must_use]
    pub fn place(&self) -> PathState {
        let (width, lower) = (self.bounds.width(), self.bounds.lower);
        let position = (self.skill.position - lower.position) / width.position;
        let first = (self.skill.first - lower.first - position * width.first) / width.position;
        let second = self.skill.second - lower.second - 2.0 * first * width.first - position * width.second;
        PathState { position, first, second: second / width.position }
    }
}

/// What one coordinate of a constrained motion is to do.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct AxisTask {
    /// Index of the coordinate, from 0, for messages.
    pub coordinate: usize,
    /// Start x^N(0), unit and frame of the skill.
    pub start: f64,
    /// Goal g, unit and frame of the skill.
    pub goal: f64,
    /// Bounds expected at the end.
    pub goal_bounds: Bounds,
    /// Time constant τ of Eq. (29), s: the duration of the skill.
    pub duration_s: f64,
}

/// One coordinate of a constrained motion in progress.
///
/// Memory is taken when the motion begins: a step allocates nothing. The same steps give the same bits as
/// [`super::constrain`].
#[derive(Debug)]
pub struct AxisFilter {
    task: AxisTask,
    law: Box<dyn AxisLaw>,
    sample: AxisSample,
    motion: PathState,
    elapsed_s: f64,
}

impl AxisFilter {
    /// Begins a motion at the start of `task` where the skill and the bounds are `first`.
    ///
    /// # Errors
    /// If an option is invalid, a number is not finite, the duration is not above 0, the corridor has no width, or the
    /// start is not inside it.
    pub fn begin(config: &CorridorFilterConfig, task: &AxisTask, first: &AxisSample) -> Result<Self, FilterError> {
        config.validate().map_err(SkillError::from)?;
        check_finite("start", task.start)?;
        check_finite("goal", task.goal)?;
        if !(task.duration_s > 0.0 && task.duration_s.is_finite()) {
            return Err(refused("duration_s", task.duration_s, "a positive finite number"));
        }
        check_sample(task.coordinate, 0.0, first)?;
        let (coordinate, start) = (task.coordinate, task.start);
        let (lower, upper) = (first.bounds.lower.position, first.bounds.upper.position);
        let excess = -first.bounds.margin(start);
        if excess >= 0.0 {
            return Err(FilterError::StartOutside { coordinate, start, excess, lower, upper });
        }
        let (law, motion) = config.filter().begin(task, first);
        check_motion(coordinate, 0.0, first, motion)?;
        Ok(Self { task: *task, law, sample: *first, motion, elapsed_s: 0.0 })
    }

    /// Advances by `time_step_s` (> 0, s) to the time at which the skill and the bounds are `to`; returns x^N there.
    ///
    /// # Errors
    /// If the step is not a positive finite number, a number of `to` is not finite, the corridor has no width, or the law
    /// diverges. The motion then stays where it was.
    pub fn step(&mut self, to: &AxisSample, time_step_s: f64) -> Result<PathState, FilterError> {
        if !(time_step_s > 0.0 && time_step_s.is_finite()) {
            return Err(refused("time_step_s", time_step_s, "a positive finite number"));
        }
        let time_s = self.elapsed_s + time_step_s;
        check_sample(self.task.coordinate, time_s, to)?;
        let motion = self.law.step(self.motion, to, time_step_s);
        check_motion(self.task.coordinate, time_s, to, motion)?;
        (self.motion, self.sample, self.elapsed_s) = (motion, *to, time_s);
        Ok(motion)
    }

    /// Returns x^N, ẋ^N, ẍ^N, by time in s.
    #[must_use]
    pub fn motion(&self) -> PathState {
        self.motion
    }

    /// Returns the time since the begin, s.
    #[must_use]
    pub fn elapsed_s(&self) -> f64 {
        self.elapsed_s
    }

    /// Returns the additional term Δu^c that Eq. (29) needs now for x^N, `alpha` being its α (β = α/4); the forcing term
    /// f^u is that of the skill by Eq. (21).
    #[must_use]
    pub fn additional_term(&self, alpha: f64) -> f64 {
        let AxisTask { goal, duration_s, .. } = self.task;
        let forcing = skill_forcing(alpha, duration_s, goal, self.sample.skill);
        additional_term(alpha, duration_s, goal, forcing, self.motion)
    }
}

/// Subtracts two paths with their derivatives.
pub(super) fn minus(from: PathState, other: PathState) -> PathState {
    PathState {
        position: from.position - other.position,
        first: from.first - other.first,
        second: from.second - other.second,
    }
}

fn check_sample(coordinate: usize, time_s: f64, sample: &AxisSample) -> Result<(), FilterError> {
    for state in [sample.skill, sample.bounds.lower, sample.bounds.upper] {
        check_finite("sample", state.position)?;
        check_finite("sample's velocity", state.first)?;
        check_finite("sample's acceleration", state.second)?;
    }
    let width = sample.bounds.width().position;
    if width > 0.0 { Ok(()) } else { Err(FilterError::Closed { coordinate, time_s, width }) }
}

fn check_motion(coordinate: usize, time_s: f64, at: &AxisSample, motion: PathState) -> Result<(), FilterError> {
    let finite = motion.position.is_finite() && motion.first.is_finite() && motion.second.is_finite();
    if finite && at.bounds.margin(motion.position) > -DIVERGED * at.bounds.width().position {
        return Ok(());
    }
    Err(FilterError::Diverged { coordinate, time_s })
}

fn check_finite(argument: &'static str, value: f64) -> Result<(), FilterError> {
    if value.is_finite() { Ok(()) } else { Err(refused(argument, value, "a finite number")) }
}

fn refused(argument: &'static str, found: f64, expected: &'static str) -> FilterError {
    SkillError::InvalidArgument { operation: "constrain skill", argument, found, expected }.into()
}

#[cfg(test)]
mod tests {
    use super::super::{Logit, Published};
    use super::*;

    fn at(position: f64, lower: f64, upper: f64) -> AxisSample {
        AxisSample { skill: PathState { position, ..PathState::default() }, bounds: Bounds::still(lower, upper) }
    }

    fn task(start: f64) -> AxisTask {
        AxisTask { coordinate: 3, start, goal: 0.0, goal_bounds: Bounds::still(-1.0, 1.0), duration_s: 1.0 }
    }

    fn begin(start: f64) -> Result<AxisFilter, FilterError> {
        AxisFilter::begin(&CorridorFilterConfig::default(), &task(start), &at(0.0, -1.0, 1.0))
    }

    #[test]
    fn a_start_outside_is_refused_with_its_distance() {
        let expected = FilterError::StartOutside { coordinate: 3, start: 1.5, excess: 0.5, lower: -1.0, upper: 1.0 };
        assert_eq!(begin(1.5).unwrap_err(), expected);
        // on the bound is not inside
        assert!(matches!(begin(-1.0), Err(FilterError::StartOutside { excess: 0.0, .. })));
        assert!(matches!(begin(f64::NAN), Err(FilterError::Skill(SkillError::InvalidArgument { .. }))));
    }

    #[test]
    fn a_step_that_cannot_be_made_leaves_the_motion_where_it_was() {
        let mut axis = begin(0.5).unwrap();
        let before = axis.motion();
        assert!(matches!(axis.step(&at(0.0, 1.0, 1.0), 0.5), Err(FilterError::Closed { time_s: 0.5, .. })));
        assert!(matches!(axis.step(&at(f64::NAN, -1.0, 1.0), 0.5), Err(FilterError::Skill(_))));
        assert!(matches!(axis.step(&at(0.0, -1.0, 1.0), 0.0), Err(FilterError::Skill(_))));
        assert_eq!((axis.motion(), axis.elapsed_s()), (before, 0.0));
        assert_eq!(axis.step(&at(0.0, -1.0, 1.0), 0.5).unwrap(), axis.motion());
        assert_eq!(axis.elapsed_s(), 0.5);
    }

    #[test]
    fn a_law_that_diverges_is_reported_with_its_time_and_never_yields_nan() {
        // an explicit step of 0.05 with k_z = 100 multiplies the fast mode by 1 − 5
        let config = CorridorFilterConfig::Published(Published { k_z: 100.0, ..Published::default() });
        let mut axis = AxisFilter::begin(&config, &task(0.5), &at(0.0, -1.0, 1.0)).unwrap();
        let failed = (0..1000).find_map(|_| match axis.step(&at(0.0, -1.0, 1.0), 0.05) {
            Ok(motion) => {
                assert!(motion.position.is_finite());
                None
            }
            Err(error) => Some(error),
        });
        let Some(FilterError::Diverged { coordinate: 3, time_s }) = failed else { panic!("{failed:?}") };
        assert!(time_s < 2.0, "{time_s}");
    }

    #[test]
    fn options_are_checked_when_a_motion_begins() {
        let config = CorridorFilterConfig::Logit(Logit { margin: 0.0, ..Logit::default() });
        let refused = AxisFilter::begin(&config, &task(0.0), &at(0.0, -1.0, 1.0)).unwrap_err();
        assert!(refused.to_string().contains("logit.margin"), "{refused}");
    }
}
