//! The path that a transfer keeps near: the intention generalized to start and goal, and kept out of the obstacles.

use nalgebra::{DVector, Point2};

use super::config::TransferConfig;
use super::passages::{Passage, Side, corridor, passages};
use super::workplace::Workplace;
use crate::corridor_filter::{Certificate, FilterError, FilterRequest, constrain};
use crate::error::SkillError;
use crate::primitive::RolloutRequest;
use crate::tool_use::Intention;
use crate::trajectory::Trajectory;

/// Samples of a reference path.
const STEPS: f64 = 400.0;

/// Path of the object's center that a transfer keeps near (Fig. 5(c)).
#[derive(Debug, Clone, PartialEq)]
pub struct Reference {
    /// The intention, generalized to start and goal without any constraint, n × 2, m: the green path.
    pub generalized: Trajectory,
    /// The same, kept out of the obstacles, n × 2, m: the blue path. The generalized one if there is no way to keep it out.
    pub constrained: Trajectory,
    /// What is certified of the constrained path in its corridor; absent if the corridor does not admit it.
    pub certificate: Option<Certificate>,
    /// Why the path could not be constrained, if so.
    pub refusal: Option<String>,
    /// On which side each obstacle is passed.
    pub passages: Vec<Passage>,
}

impl Reference {
    /// Generalizes `intention` from `start` to `goal` and constrains it to the corridor of the obstacles.
    ///
    /// `sides` may set on which side each obstacle is passed. A corridor that does not admit the path is no error: the
    /// search for phases keeps clear of obstacles by itself, and the reference only draws it to the demonstrated way.
    ///
    /// # Errors
    /// If the intention cannot be rolled out.
    pub fn new(
        workplace: &Workplace<'_>,
        config: &TransferConfig,
        intention: &Intention,
        start: Point2<f64>,
        goal: Point2<f64>,
        sides: &[Option<Side>],
    ) -> Result<Self, SkillError> {
        let vector = |point: Point2<f64>| DVector::from_column_slice(&[point.x, point.y]);
        let duration_s = intention.duration_s;
        let request = RolloutRequest::new(vector(start), vector(goal), duration_s, duration_s / STEPS);
        let skill = intention.primitive.rollout(&request)?;
        let generalized = skill.positions().clone();
        let passages = passages(workplace, &generalized, &intention.shown, sides);
        let constrained =
            corridor(workplace, &generalized, &passages, &config.smoothing).map_err(FilterError::from).and_then(
                |smoothed| constrain(&config.corridor_filter, &skill, &smoothed.corridor, &FilterRequest::of(&request)),
            );
        Ok(match constrained {
            Ok(constrained) => Self {
                generalized,
                constrained: constrained.rollout.into_positions(),
                certificate: Some(constrained.certificate),
                refusal: None,
                passages,
            },
            Err(error) => Self {
                constrained: generalized.clone(),
                generalized,
                certificate: None,
                refusal: Some(error.to_string()),
                passages,
            },
        })
    }

    /// The constrained path as points, m.
    #[must_use]
    pub fn points(&self) -> Vec<Point2<f64>> {
        self.constrained.samples().row_iter().map(|row| Point2::new(row[0], row[1])).collect()
    }
}
