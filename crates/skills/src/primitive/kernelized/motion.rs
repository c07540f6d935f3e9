//! A motion of the kernelized primitive: evaluated at any instant, through via points, with its uncertainty.

use nalgebra::{DMatrix, DVector};

use super::Kernelized;
use super::coordinate::{Conditioned, Given};
use super::kernel::Row;
use super::reference::{Transfer, progress};
use crate::error::SkillError;
use crate::primitive::rollout::check_vector;
use crate::primitive::{MovementPrimitive, Rollout, RolloutRequest};
use crate::trajectory::Trajectory;

/// Least part of the duration between two via points.
const LEAST_GAP: f64 = 1e-3;

/// Place to pass at a given part of the duration.
#[derive(Debug, Clone, PartialEq)]
pub struct ViaPoint {
    /// t/T at which to be there, in (0, 1).
    pub progress: f64,
    /// Position: d values, unit and frame of the demonstrations.
    pub position: DVector<f64>,
    /// Velocity: d values per second; free if absent.
    pub velocity: Option<DVector<f64>>,
    /// Standard deviation that is tolerated, unit of the demonstrations; 0 passes it exactly.
    pub deviation: f64,
}

impl ViaPoint {
    /// Asks to pass `position` (d values, unit and frame of the demonstrations) exactly, at any velocity, at `progress` = t/T
    /// in (0, 1).
    #[must_use]
    pub fn exact(progress: f64, position: DVector<f64>) -> Self {
        Self { progress, position, velocity: None, deviation: 0.0 }
    }
}

/// Motion of a [`Kernelized`] primitive for one request.
#[derive(Debug, Clone)]
pub struct KernelizedMotion<'a> {
    primitive: &'a Kernelized,
    request: RolloutRequest,
    transfers: Vec<Transfer>,
    // rows of the via points, and each coordinate conditioned on them
    rows: Vec<Row>,
    conditioned: Vec<Conditioned>,
    // progress of references and via points, and the weights of values and rates there, d × points
    points: Vec<f64>,
    values: DMatrix<f64>,
    rates: DMatrix<f64>,
}

impl<'a> KernelizedMotion<'a> {
    pub(super) fn new(
        primitive: &'a Kernelized,
        request: &RolloutRequest,
        via: &[ViaPoint],
    ) -> Result<Self, SkillError> {
        let dimension = primitive.dimension();
        request.validate(dimension)?;
        for point in via {
            check_via(point, dimension)?;
        }
        check_apart(via)?;
        let rate = |k: usize| request.start_velocity.as_ref().map_or(0.0, |velocity| velocity[k] * request.duration_s);
        let transfer = |k: usize| Transfer::new(request.start[k], request.goal[k], rate(k), 0.0);
        let transfers: Vec<_> = (0..dimension).map(transfer).collect();
        let mut conditioned = Vec::with_capacity(dimension);
        let mut rows = Vec::new();
        for (k, coordinate) in primitive.coordinates.iter().enumerate() {
            let unit = Units::of(primitive, request, coordinate.reference.scale);
            let given: Vec<Given> = via.iter().flat_map(|point| unit.given(point, k, &transfers[k])).collect();
            let solved = coordinate.conditioned(&primitive.config, primitive.kernel, &given);
            let (samples, bases) = (2 * primitive.config.references, given.len());
            conditioned.push(solved.ok_or(SkillError::Undetermined { samples, bases })?);
            rows = given.iter().map(|given| given.row).collect();
        }
        let mut motion = Self {
            primitive,
            request: request.clone(),
            transfers,
            points: Vec::new(),
            values: DMatrix::zeros(0, 0),
            rates: DMatrix::zeros(0, 0),
            rows,
            conditioned,
        };
        motion.gather_weights();
        Ok(motion)
    }

    /// Evaluates position, velocity (per second) and acceleration (per second squared) at `progress` = t/T into vectors
    /// of d values; before the start it holds it (NaN too), after T it rests at the goal. Allocates nothing.
    ///
    /// # Panics
    /// If a vector has not d values.
    pub fn evaluate_into(
        &self,
        progress: f64,
        position: &mut DVector<f64>,
        velocity: &mut DVector<f64>,
        acceleration: &mut DVector<f64>,
    ) {
        for vector in [&mut *position, &mut *velocity, &mut *acceleration] {
            assert_eq!(vector.len(), self.transfers.len(), "one value is written per coordinate");
            vector.fill(0.0);
        }
        if !(0.0..=1.0).contains(&progress) {
            position.copy_from(if progress > 1.0 { &self.request.goal } else { &self.request.start });
            return;
        }
        for (point, at) in self.points.iter().enumerate() {
            let columns = self.primitive.kernel.columns(progress, *at);
            for k in 0..position.len() {
                let (value, rate) = (self.values[(k, point)], self.rates[(k, point)]);
                position[k] += columns.value[0] * value + columns.rate[0] * rate;
                velocity[k] += columns.value[1] * value + columns.rate[1] * rate;
                acceleration[k] += columns.value[2] * value + columns.rate[2] * rate;
            }
        }
        let duration_s = self.request.duration_s;
        for (k, transfer) in self.transfers.iter().enumerate() {
            let along = transfer.at(progress);
            position[k] += along.position;
            velocity[k] = (velocity[k] + along.first) / duration_s;
            acceleration[k] = (acceleration[k] + along.second) / (duration_s * duration_s);
        }
        // not a rounding away from what was asked
        if progress == 0.0 {
            position.copy_from(&self.request.start);
            match &self.request.start_velocity {
                Some(start_velocity) => velocity.copy_from(start_velocity),
                None => velocity.fill(0.0),
            }
        } else if progress == 1.0 {
            position.copy_from(&self.request.goal);
            velocity.fill(0.0);
        }
    }

    /// Evaluates the standard deviation of each coordinate at `progress` (clamped to [0, 1]): d values, unit of the
    /// demonstrations.
    ///
    /// √((N/λ)(k(u,u) − k*ᵀ(K + λΣ)⁻¹k*)), the covariance of the article; 0 at both ends. It is that of a prior of the
    /// shape's own size, so it tells where the motion is known well rather than by how much a hand would miss it.
    #[must_use]
    pub fn standard_deviation(&self, progress: f64) -> DVector<f64> {
        let Kernelized { config, kernel, coordinates } = self.primitive;
        let at = if progress.is_nan() { 0.0 } else { progress.clamp(0.0, 1.0) };
        let solved = coordinates.iter().zip(&self.conditioned).map(|(coordinate, conditioned)| {
            let variance = coordinate.variance(config, *kernel, conditioned, &self.rows, at);
            coordinate.reference.scale * variance.sqrt()
        });
        DVector::from_iterator(coordinates.len(), solved)
    }

    /// Samples the motion at the times of its request.
    ///
    /// # Errors
    /// If a value overflows.
    pub fn rollout(&self) -> Result<Rollout, SkillError> {
        let times_s = self.request.times_s();
        let dimension = self.transfers.len();
        let [mut positions, mut velocities, mut accelerations] =
            [(); 3].map(|()| DMatrix::zeros(times_s.len(), dimension));
        let [mut position, mut velocity, mut acceleration] = [(); 3].map(|()| DVector::zeros(dimension));
        for (row, time_s) in times_s.iter().enumerate() {
            self.evaluate_into(time_s / self.request.duration_s, &mut position, &mut velocity, &mut acceleration);
            positions.row_mut(row).tr_copy_from(&position);
            velocities.row_mut(row).tr_copy_from(&velocity);
            accelerations.row_mut(row).tr_copy_from(&acceleration);
        }
        Rollout::new(Trajectory::new(times_s, positions)?, velocities, accelerations)
    }

    // weights by point and back in the unit of the demonstrations
    fn gather_weights(&mut self) {
        let config = &self.primitive.config;
        self.points = (0..config.references).map(|index| progress(config, index)).collect();
        self.points.extend(self.rows.iter().map(|row| row.progress));
        let dimension = self.conditioned.len();
        self.values = DMatrix::zeros(dimension, self.points.len());
        self.rates = DMatrix::zeros(dimension, self.points.len());
        for (k, (coordinate, solved)) in self.primitive.coordinates.iter().zip(&self.conditioned).enumerate() {
            let scale = coordinate.reference.scale;
            for index in 0..config.references {
                self.values[(k, index)] = scale * solved.weights[2 * index];
                self.rates[(k, index)] = scale * solved.weights[2 * index + 1];
            }
            for (index, row) in self.rows.iter().enumerate() {
                let table = if row.rate { &mut self.rates } else { &mut self.values };
                table[(k, config.references + index)] = scale * solved.further[index];
            }
        }
    }
}

// from the units of a request to those of a reference
struct Units {
    scale: f64,
    length_scale: f64,
    duration_s: f64,
}

impl Units {
    fn of(primitive: &Kernelized, request: &RolloutRequest, scale: f64) -> Self {
        Self { scale, length_scale: primitive.kernel.length_scale(), duration_s: request.duration_s }
    }

    fn given(&self, point: &ViaPoint, k: usize, transfer: &Transfer) -> impl Iterator<Item = Given> + use<> {
        let along = transfer.at(point.progress);
        let variance = (point.deviation / self.scale).powi(2);
        let (at, value) = (point.progress, (point.position[k] - along.position) / self.scale);
        let velocity = point.velocity.as_ref().map(|velocity| velocity[k] * self.duration_s - along.first);
        let rate = velocity.map(|rate| rate * self.length_scale / self.scale);
        let value = Given { row: Row::value(at), target: value, variance };
        std::iter::once(value).chain(rate.map(|target| Given { row: Row::rate(at), target, variance }))
    }
}

fn check_via(point: &ViaPoint, dimension: usize) -> Result<(), SkillError> {
    let refused = |argument, found, expected| {
        Err(SkillError::InvalidArgument { operation: "pass via point", argument, found, expected })
    };
    if !(point.progress > 0.0 && point.progress < 1.0) {
        return refused("progress", point.progress, "a number between 0 and 1");
    }
    if !(point.deviation >= 0.0 && point.deviation.is_finite()) {
        return refused("deviation", point.deviation, "a finite number of at least 0");
    }
    check_vector("position", dimension, point.position.as_slice())?;
    point.velocity.as_ref().map_or(Ok(()), |velocity| check_vector("velocity", dimension, velocity.as_slice()))
}

// two places at one instant contradict each other
fn check_apart(via: &[ViaPoint]) -> Result<(), SkillError> {
    let mut instants: Vec<f64> = via.iter().map(|point| point.progress).collect();
    instants.sort_by(f64::total_cmp);
    let gaps = instants.windows(2).map(|pair| pair.iter().rev().copied().reduce(|after, before| after - before));
    let gap = gaps.flatten().fold(f64::INFINITY, f64::min);
    if gap < LEAST_GAP {
        let expected = "via points at least a thousandth of the duration apart";
        return Err(SkillError::InvalidArgument {
            operation: "pass via points",
            argument: "gap",
            found: gap,
            expected,
        });
    }
    Ok(())
}
