//! Tool flips learned from demonstrations by Prop. 2: what remains of them without the virtual object movement.
//!
//! Departs from the paper: the demonstration is seen from the tool, x^Tf is the object's center in the tool's frame, and
//! every demonstration is retimed by minimum jerk along its length, so that it and the virtual object movement of its tool
//! share the phase. Only the place is learned; the angle of the tool follows the task.

use nalgebra::{DMatrix, DVector, Isometry2, Matrix2, Point2, Vector2};

use super::clearance::Bodies;
use super::decomposition::FlipFactors;
use super::factors::similarity;
use super::generalization::{Flip, FlipTask};
use super::options::{FlipOptions, WayRound};
use super::refusal::FlipError;
use super::virtual_motion::{Hold, Polyline, VirtualMotion};
use super::way::Way;
use crate::field::{FieldError, positive};
use crate::outline::Outline;
use crate::primitive::{Dmp, DmpConfig, DmpForm, MovementPrimitive, RolloutRequest};
use crate::time_law::{minimum_jerk, minimum_jerk_first_derivative};
use crate::tool::{Contact, Tool};
use crate::trajectory::Trajectory;

/// Demonstrated flip of a tool round a resting object.
#[derive(Debug, Clone, Copy)]
pub struct ShownFlip<'a> {
    /// The tool that was used.
    pub tool: &'a Tool,
    /// Outline of the object.
    pub object: &'a Outline,
    /// Pose of the object: `world_from_object`.
    pub object_world: Isometry2<f64>,
    /// Poses of the tool, `world_from_tool`, from contact to contact; their times do not matter.
    pub tool_world: &'a [Isometry2<f64>],
    /// Contacts of the tool before and after, in its frame.
    pub contacts: [Contact; 2],
}

/// Learned tool flip, Eq. (25) with k1 = I: the tool's own way x^t, freed from the outline of the tool it was shown with.
#[derive(Debug, Clone, PartialEq)]
pub struct ToolFlip {
    tool: Dmp,
    displacement: Vector2<f64>,
    length_m: f64,
    way_round: WayRound,
}

/// Factor k2 at learning: the whole virtual object movement is taken out.
const LEARNED_K2: f64 = 1.0;
/// Rows of a retimed demonstration.
const RETIMED_ROWS: usize = 201;
/// Part of a way's length below which the displacement between its ends has no direction.
const SMALLEST_DISPLACEMENT: f64 = 1e-3;

impl ToolFlip {
    /// Learns f^t = f^Tf − k2·f^o, Eq. (25), from demonstrations with one sense of going round the tool.
    ///
    /// `margin_m` is the clearance of the virtual object movement round the tool that was used, m; what a demonstration
    /// keeps beyond it is part of x^t. The sense is that of the virtual movement nearest to the first demonstration.
    ///
    /// # Errors
    /// A [`FlipError`] if there is no demonstration, one does not move, a tool or an outline is invalid, or the tool cannot
    /// be gone round; `config.form` must be residual, for x^t then starts and ends at rest at any goal.
    pub fn learn(config: &DmpConfig, shown: &[ShownFlip<'_>], margin_m: f64) -> Result<Self, FlipError> {
        positive("margin_m", margin_m)?;
        if config.form != DmpForm::Residual {
            return Err(FieldError::new("form", format!("{:?}", config.form), "residual").into());
        }
        let (mut flips, mut objects) = (Vec::new(), Vec::new());
        let mut way_round = None;
        for (demonstration, shown) in shown.iter().enumerate() {
            let flip = shown.retimed(demonstration)?;
            let object = shown.virtual_motion(&flip, margin_m, way_round)?;
            way_round = Some(object.way_round);
            objects.push(sampled(|ratio| object.at(minimum_jerk(ratio)).0)?);
            flips.push(flip);
        }
        let (flip, object) = (Dmp::learn(config, &flips)?, Dmp::learn(config, &objects)?);
        let count = flips.len() as f64;
        let displacement = flips.iter().map(|flip| flip.end() - flip.start()).map(|way| Vector2::new(way[0], way[1]));
        Ok(Self {
            tool: FlipFactors::identity(2, LEARNED_K2)?.divided(&flip, &object)?,
            displacement: displacement.sum::<Vector2<f64>>() / count,
            length_m: flips.iter().map(Trajectory::path_length).sum::<f64>() / count,
            way_round: way_round.unwrap_or_default(),
        })
    }

    /// Generalizes to another tool, object or pair of contacts, Eq. (28), certified free of collisions.
    ///
    /// Where x^t leads into the tool k2 is enlarged first, then x^t fades; [`Flip`] tells both.
    ///
    /// # Errors
    /// A [`FlipError`] that says what is in the way, with numbers.
    pub fn generalize(&self, task: &FlipTask<'_>, options: &FlipOptions) -> Result<Flip, FlipError> {
        task.solve(Some(self), options)
    }

    /// Returns the primitive of x^t (x, y of the object's center in the tool's frame, m).
    #[must_use]
    pub fn tool_primitive(&self) -> &Dmp {
        &self.tool
    }

    /// Returns the sense in which the demonstrations go round the tool.
    #[must_use]
    pub fn way_round(&self) -> WayRound {
        self.way_round
    }

    /// Rolls x^t out from the origin back to it, ends closed, turned and scaled for a displacement between the contacts.
    pub(super) fn own_way(
        &self,
        displacement: &Vector2<f64>,
        way_round: WayRound,
        options: &FlipOptions,
    ) -> Result<OwnWay, FlipError> {
        let origin = DVector::zeros(2);
        let request = RolloutRequest::new(origin.clone(), origin, 1.0, 1.0 / Way::PIECES as f64);
        let rollout = self.tool.rollout(&request)?;
        let transform = self.transform(displacement, way_round, options)?;
        let (places, velocities) = (rollout.positions().samples(), rollout.velocities());
        let at = |table: &DMatrix<f64>, row: usize| match row < table.nrows() {
            true => Vector2::new(table[(row, 0)], table[(row, 1)]),
            false => Vector2::zeros(),
        };
        // what is left at the end is taken up on the way: mj(r) its place, r³(r − 1) its velocity
        let (miss, drift) = (at(places, Way::PIECES), at(velocities, Way::PIECES));
        let knot = |row: usize| {
            let r = Way::ratio(row);
            let place = at(places, row) - miss * minimum_jerk(r) - drift * (r * r * r * (r - 1.0));
            let slope =
                at(velocities, row) - miss * minimum_jerk_first_derivative(r) - drift * (r * r * (4.0 * r - 3.0));
            (transform * place, transform * slope)
        };
        Ok(OwnWay { knots: (0..=Way::PIECES).map(knot).collect() })
    }

    // a way in the other sense has its x^t on the other side of the line between the contacts
    fn transform(
        &self,
        displacement: &Vector2<f64>,
        way_round: WayRound,
        options: &FlipOptions,
    ) -> Result<Matrix2<f64>, FlipError> {
        let shown = self.displacement;
        if !options.scale_with_displacement || shown.norm() <= SMALLEST_DISPLACEMENT * self.length_m {
            return Ok(Matrix2::identity());
        }
        let vector = |v: &Vector2<f64>| DVector::from_column_slice(v.as_slice());
        let turned = similarity(&vector(&shown), &vector(displacement))?;
        let turned = Matrix2::from_iterator(turned.iter().copied());
        let along = shown.normalize();
        let mirror = along * along.transpose() * 2.0 - Matrix2::identity();
        Ok(if way_round == self.way_round { turned } else { turned * mirror })
    }
}

impl ShownFlip<'_> {
    /// The object's center in the tool's frame, by minimum jerk along its length over one unit of time.
    fn retimed(&self, demonstration: usize) -> Result<Trajectory, FlipError> {
        let center = Point2::from(self.object_world.translation.vector);
        let line = Polyline::new(self.tool_world.iter().map(|pose| pose.inverse_transform_point(&center)));
        let length_m = line.length_m();
        if length_m <= 0.0 {
            return Err(FlipError::Still { demonstration });
        }
        sampled(|ratio| line.at(length_m * minimum_jerk(ratio)))
    }

    /// The virtual object movement round the tool that was used, in the given sense or in the one nearer to what was shown.
    fn virtual_motion(
        &self,
        flip: &Trajectory,
        margin_m: f64,
        way_round: Option<WayRound>,
    ) -> Result<VirtualMotion, FlipError> {
        let bodies = Bodies::new(self.tool, self.object)?;
        let (start, end) = (flip.start(), flip.end());
        let angle = |pose: Option<&Isometry2<f64>>| {
            self.object_world.rotation.angle() - pose.map_or(0.0, |pose| pose.rotation.angle())
        };
        let [first, second] = &self.contacts;
        let hold = |center: &DVector<f64>, contact: &Contact, angle_rad: f64| Hold {
            center: Point2::new(center[0], center[1]),
            normal: contact.normal.into_inner(),
            angle_rad,
        };
        let holds =
            [hold(&start, first, angle(self.tool_world.first())), hold(&end, second, angle(self.tool_world.last()))];
        if let Some(way_round) = way_round {
            return VirtualMotion::new(&bodies, &holds, margin_m, way_round);
        }
        let [one, other] = VirtualMotion::both(&bodies, &holds, margin_m)?;
        let miss_m = |motion: &VirtualMotion| {
            let rows = flip.samples().row_iter().zip(flip.times_s());
            let misses =
                rows.map(|(row, ratio)| (motion.at(minimum_jerk(*ratio)).0 - Point2::new(row[0], row[1])).norm());
            misses.fold(0.0, f64::max)
        };
        Ok(if miss_m(&one) <= miss_m(&other) { one } else { other })
    }
}

fn sampled(place: impl Fn(f64) -> Point2<f64>) -> Result<Trajectory, FlipError> {
    let step = 1.0 / (RETIMED_ROWS - 1) as f64;
    let places: Vec<Point2<f64>> = (0..RETIMED_ROWS).map(|row| place(row as f64 * step)).collect();
    let samples = DMatrix::from_fn(RETIMED_ROWS, 2, |row, column| places[row][column]);
    Ok(Trajectory::uniform(step, samples)?)
}

/// The tool's own way x^t about the straight line, with its slope, at the knots of a way, m.
pub(super) struct OwnWay {
    pub(super) knots: Vec<(Vector2<f64>, Vector2<f64>)>,
}

impl OwnWay {
    /// The way of a flip that was not shown.
    pub(super) fn straight() -> Self {
        Self { knots: Vec::new() }
    }

    pub(super) fn is_straight(&self) -> bool {
        self.knots.is_empty()
    }
}
