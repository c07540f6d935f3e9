//! Constraint-based separation of a constraint-irrelevant skill, Algorithm 2: demonstrations inside corridors are
//! mapped to the unconstrained coordinate, and a primitive is learned there, Eq. (21).
//!
//! Departs from the paper: Algorithm 2 first learns the constrained motion and maps what was learned; by default the
//! demonstrations themselves are mapped, each through its own corridor (see [`MappingOrder`]). The map is one of
//! [`CorridorMapConfig`], by default not that of Eqs. (18)–(20).

mod mapping;
mod refusal;
mod saved;

use serde::{Deserialize, Serialize};

pub use mapping::{CoordinateReport, DemonstrationReport};
pub use refusal::ConstraintError;
pub use saved::SavedConstraintBased;

use crate::corridor::{Bounds, Corridor};
use crate::corridor_map::{CorridorMapConfig, Fallback, MotionEnds};
use crate::error::SkillError;
use crate::field::FieldError;
use crate::primitive::{MovementPrimitive, PrimitiveConfig, RolloutRequest};
use crate::trajectory::Trajectory;

/// What is mapped to the unconstrained coordinate.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum MappingOrder {
    /// The demonstrations, each through its own corridor; the primitive is learned from all of them after that
    /// (default).
    #[default]
    MapDemonstrations,
    /// Steps 1 to 3 of Algorithm 2 as printed: a primitive is learned under the constraints, and its reproduction of
    /// each demonstration is mapped.
    ///
    /// With several demonstrations the reproduction is the mean of shapes that different corridors bent differently; it
    /// keeps to none of them, and what tells the intention from the constraint is averaged away before the map sees it.
    LearnFirst,
}

/// Options of Algorithm 2.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct ConstraintBasedConfig {
    /// Map between the corridor and the unconstrained coordinate.
    pub map: CorridorMapConfig,
    /// What is mapped.
    pub order: MappingOrder,
    /// Primitive of Eq. (21), and of step 1 where that comes first.
    pub primitive: PrimitiveConfig,
}

impl ConstraintBasedConfig {
    /// Checks every option.
    ///
    /// # Errors
    /// A [`FieldError`] with the field relative to this struct, such as `map.proximal.strength`.
    pub fn validate(&self) -> Result<(), FieldError> {
        self.map.validate().map_err(|error| error.within("map"))?;
        self.primitive.validate().map_err(|error| error.within("primitive"))
    }
}

/// Demonstration that was shown inside a corridor.
#[derive(Debug, Clone, Copy)]
pub struct ConstrainedDemonstration<'a> {
    /// The motion, n × d.
    pub trajectory: &'a Trajectory,
    /// Its bounds x^L and x^H of d coordinates, in the time of the motion.
    pub corridor: &'a Corridor,
    /// Standard deviation of the recording's noise: d values ≥ 0, unit of the samples.
    pub noise: &'a [f64],
}

/// Motion that was generated inside a corridor.
#[derive(Debug, Clone, PartialEq)]
pub struct ConstrainedMotion {
    /// Positions, n × d, in the time of the request.
    pub positions: Trajectory,
    /// Why the map of a coordinate is not the one asked for, where it is not: d entries. The motion is inside all the
    /// same, but of another shape than was learned.
    pub fallbacks: Vec<Option<Fallback>>,
}

/// Constraint-irrelevant skill of Eq. (21), separated from demonstrations that were shown inside corridors.
#[derive(Debug)]
pub struct ConstraintBased {
    primitive: Box<dyn MovementPrimitive>,
    map: CorridorMapConfig,
    unconstrained: Vec<Trajectory>,
    reports: Vec<DemonstrationReport>,
}

impl ConstraintBased {
    /// Separates the skill from one or more demonstrations by Algorithm 2, coordinate by coordinate.
    ///
    /// x^u is as smooth as motion and corridor (a [`Corridor`] is C²) where the motion keeps the linear margin δ from
    /// its bounds; nearer to them and outside, x^u is C¹ (see [`crate::corridor_map::extended_logit`]).
    ///
    /// # Errors
    /// If the options are invalid, there is no demonstration, dimensions differ, a demonstration is outside its
    /// corridor ([`ConstraintError::OutsideCorridor`]), the map has no value for it, or the primitive cannot be
    /// learned.
    pub fn learn(
        config: &ConstraintBasedConfig,
        demonstrations: &[ConstrainedDemonstration<'_>],
    ) -> Result<Self, ConstraintError> {
        config.validate().map_err(SkillError::from)?;
        let tables = demonstrations.iter().enumerate().map(|(index, shown)| mapping::check(index, shown));
        let tables = tables.collect::<Result<Vec<_>, _>>()?;
        let mapped: Vec<_> = match config.order {
            MappingOrder::MapDemonstrations => {
                let each = demonstrations.iter().zip(&tables).enumerate();
                each.map(|(index, (shown, table))| {
                    mapping::map(index, &config.map, shown.trajectory, table, shown.noise)
                })
                .collect::<Result<_, _>>()?
            }
            MappingOrder::LearnFirst => {
                let reproduced = reproduce(&config.primitive, demonstrations)?;
                let each = demonstrations.iter().zip(&reproduced).enumerate();
                each.map(|(index, (shown, motion))| {
                    let table = mapping::bounds_table(shown.corridor, motion)?;
                    mapping::map(index, &config.map, motion, &table, shown.noise)
                })
                .collect::<Result<_, ConstraintError>>()?
            }
        };
        let (unconstrained, reports): (Vec<_>, Vec<_>) = mapped.into_iter().unzip();
        let primitive = config.primitive.learn(&unconstrained)?;
        Ok(Self { primitive, map: config.map.clone(), unconstrained, reports })
    }

    /// Returns the primitive of Eq. (21), which moves the unconstrained coordinates.
    #[must_use]
    pub fn primitive(&self) -> &dyn MovementPrimitive {
        self.primitive.as_ref()
    }

    /// Returns the unconstrained motions x^u that the primitive was learned from, one per demonstration, in its time; none of a
    /// skill that was restored.
    #[must_use]
    pub fn unconstrained(&self) -> &[Trajectory] {
        &self.unconstrained
    }

    /// Returns what was found in each demonstration; nothing of a skill that was restored.
    #[must_use]
    pub fn reports(&self) -> &[DemonstrationReport] {
        &self.reports
    }

    /// Generates the motion to a start and goal inside a corridor: rolls Eq. (21) out, then maps by Eq. (16).
    ///
    /// The corridor has the time of the request: 0 at the start, T at the goal. Every position is strictly inside it,
    /// except for [`CorridorMapConfig::AsPublished`], which may round onto a bound. The motion begins at the requested
    /// start and tends to the goal as the primitive does, again except for that map. `start_velocity` of the request is
    /// one of x^u.
    ///
    /// # Errors
    /// If the dimensions differ, the request is invalid, an end is not strictly inside the corridor
    /// ([`ConstraintError::EndOutside`]), or the corridor has no width at a sample.
    pub fn generate(
        &self,
        request: &RolloutRequest,
        corridor: &Corridor,
    ) -> Result<ConstrainedMotion, ConstraintError> {
        let dimension = self.primitive.dimension();
        if corridor.dimension() != dimension {
            let found = corridor.dimension();
            return Err(SkillError::Dimension { operation: GENERATE, found, expected: dimension }.into());
        }
        request.validate(dimension)?;
        let motion = self.primitive.rollout(request)?.into_positions();
        let (mut samples, mut fallbacks) = (motion.samples().clone(), vec![]);
        for (coordinate, mut samples) in samples.column_iter_mut().enumerate() {
            let ends = MotionEnds {
                start: request.start[coordinate],
                start_bounds: corridor.at(0.0, coordinate),
                goal: request.goal[coordinate],
                goal_bounds: corridor.at(request.duration_s, coordinate),
            };
            check_inside(coordinate, &ends)?;
            let bounds = mapping::bounds(GENERATE, corridor, motion.times_s(), coordinate)?;
            let selected = self.map.map(&ends, ends.delta(0.0, mapping::narrowest(&bounds)))?;
            for ((sample, time_s), bounds) in samples.iter_mut().zip(motion.times_s()).zip(&bounds) {
                *sample = selected.map.constrained(bounds, time_s / request.duration_s, *sample);
            }
            fallbacks.push(selected.fallback);
        }
        Ok(ConstrainedMotion { positions: Trajectory::new(motion.times_s().to_vec(), samples)?, fallbacks })
    }
}

/// What is attempted, for errors.
const GENERATE: &str = "generate constrained motion";

/// Reproduces each demonstration, its ends and duration kept, by the primitive learned from all: step 1 of Algorithm 2.
fn reproduce(
    config: &PrimitiveConfig,
    demonstrations: &[ConstrainedDemonstration<'_>],
) -> Result<Vec<Trajectory>, ConstraintError> {
    let shown: Vec<Trajectory> = demonstrations.iter().map(|shown| shown.trajectory.clone()).collect();
    let primitive = config.learn(&shown)?;
    let reproduce = |shown: &Trajectory| {
        let step_s = shown.duration_s() / (shown.len() - 1) as f64;
        let motion = primitive
            .rollout(&RolloutRequest::new(shown.start(), shown.end(), shown.duration_s(), step_s))?
            .into_positions();
        let times_s = motion.times_s().iter().map(|time_s| shown.start_time_s() + time_s).collect();
        Ok(Trajectory::new(times_s, motion.samples().clone())?)
    };
    shown.iter().map(reproduce).collect()
}

fn check_inside(coordinate: usize, ends: &MotionEnds) -> Result<(), ConstraintError> {
    let inside = |bounds: &Bounds, position: f64| bounds.margin(position) > 0.0;
    let refused = |end, position, bounds: &Bounds| {
        let (lower, upper) = (bounds.lower.position, bounds.upper.position);
        Err(ConstraintError::EndOutside { end, coordinate, position, lower, upper })
    };
    if !inside(&ends.start_bounds, ends.start) {
        return refused("start", ends.start, &ends.start_bounds);
    }
    if !inside(&ends.goal_bounds, ends.goal) {
        return refused("goal", ends.goal, &ends.goal_bounds);
    }
    Ok(())
}
