//! A tool flip divided into the tool's own way x^t and a virtual object movement x^o, Eqs. (22)–(25), (39)–(46), and put
//! together again, Eq. (28).
//!
//! Departs from the paper: k1 may be any invertible d × d matrix, and with k1 = I the goal g^t is solved from Eq. (39)
//! instead of k1. In Eq. (45) the last term is −α_zβ_z(I − k1 − k2)·x0; with the printed plus it does not cancel in (46).

use nalgebra::{DMatrix, DVector};

use super::factors::{FactorKind, FirstFactor, check_k2};
use super::refusal::FlipError;
use crate::error::SkillError;
use crate::primitive::{Dmp, DmpForm, MovementPrimitive};
use crate::trajectory::Trajectory;

/// Factors k1 (d × d) and k2 of Eq. (23): x^Tf − x0 = k1·(x^t − x0) + k2·(x^o − x0).
#[derive(Debug, Clone, PartialEq)]
pub struct FlipFactors {
    k1: DMatrix<f64>,
    inverse: DMatrix<f64>,
    k2: f64,
}

impl FlipFactors {
    /// Takes k1 and k2, without unit.
    ///
    /// # Errors
    /// [`FlipError::Singular`] if k1 has no inverse; a [`SkillError`] if it is not square, or a value is not finite.
    pub fn new(k1: FirstFactor, k2: f64) -> Result<Self, FlipError> {
        check_k2(k2)?;
        let matrix = k1.matrix;
        if matrix.nrows() != matrix.ncols() {
            let (found, expected) = (matrix.ncols(), matrix.nrows());
            return Err(SkillError::Dimension { operation: "check flip factors", found, expected }.into());
        }
        crate::trajectory::check_finite("check flip factors", &matrix)?;
        let singular = matrix.singular_values();
        let condition = singular.max() / singular.min();
        let inverse = matrix.clone().try_inverse().filter(|_| condition < LARGEST_CONDITION);
        let inverse = inverse.ok_or(FlipError::Singular { condition })?;
        Ok(Self { k1: matrix, inverse, k2 })
    }

    /// Takes k1 = I in `dimension` coordinates: the goal g^t is what remains to be solved.
    ///
    /// # Errors
    /// A [`SkillError`] if there is no coordinate or k2 is not finite.
    pub fn identity(dimension: usize, k2: f64) -> Result<Self, FlipError> {
        let zeros = DVector::zeros(dimension);
        Self::new(FactorKind::Identity.factor(&zeros, &zeros, k2)?, k2)
    }

    /// Returns k1, d × d.
    #[must_use]
    pub fn k1(&self) -> &DMatrix<f64> {
        &self.k1
    }

    /// Returns k2.
    #[must_use]
    pub fn k2(&self) -> f64 {
        self.k2
    }

    /// Solves Eq. (39) for g^t = x0 + k1⁻¹·(g^Tf − x0 − k2·(g^o − x0)): d values, unit and frame of the arguments.
    ///
    /// `start` is x0, `flip_goal` g^Tf and `object_goal` g^o.
    ///
    /// # Errors
    /// [`SkillError::Dimension`] if an argument has not d values.
    pub fn tool_goal(
        &self,
        start: &DVector<f64>,
        flip_goal: &DVector<f64>,
        object_goal: &DVector<f64>,
    ) -> Result<DVector<f64>, FlipError> {
        for vector in [start, flip_goal, object_goal] {
            self.check_dimension(vector.len())?;
        }
        Ok(start + &self.inverse * (flip_goal - start - (object_goal - start) * self.k2))
    }

    /// Divides the flip x^Tf of Eq. (22) by the virtual movement x^o of Eq. (24), Eq. (25): f^t = k1⁻¹·(f^Tf − k2·f^o).
    ///
    /// The dynamics are linear in the forcing term, and the bases and the phase are shared, so the weights divide alike.
    ///
    /// # Errors
    /// [`FlipError::UnsharedSystem`] if the two primitives differ in more than their weights or are of the scaled form;
    /// [`SkillError::Dimension`] if they have not d coordinates.
    pub fn divided(&self, flip: &Dmp, object: &Dmp) -> Result<Dmp, FlipError> {
        self.check_system(flip, object)?;
        let weights = flip.weights() - object.weights() * self.k2;
        Ok(flip.with_weights(weights * self.inverse.transpose())?)
    }

    /// Puts a flip together from x^t and x^o as one primitive, Eq. (46): f^Tf = k1·f^t + k2·f^o.
    ///
    /// # Errors
    /// As [`FlipFactors::divided`].
    pub fn recombined(&self, tool: &Dmp, object: &Dmp) -> Result<Dmp, FlipError> {
        self.check_system(tool, object)?;
        Ok(tool.with_weights(tool.weights() * self.k1.transpose() + object.weights() * self.k2)?)
    }

    /// Adds paths by Eq. (28): x^Tf = k1·x^t + k2·x^o + (I − k2 − k1)·x0, n × d on the times of `tool`.
    ///
    /// `start` is x0; `object` has as many samples as `tool`, at the same times over duration.
    ///
    /// # Errors
    /// A [`SkillError`] if dimensions or numbers of samples differ or a sum is not finite.
    pub fn path(&self, start: &DVector<f64>, tool: &Trajectory, object: &Trajectory) -> Result<Trajectory, FlipError> {
        for dimension in [start.len(), tool.dimension(), object.dimension()] {
            self.check_dimension(dimension)?;
        }
        if object.len() != tool.len() {
            let expected = format!("{}, one per sample of the tool's way", tool.len());
            return Err(SkillError::RowCount { operation: "add flip", found: object.len(), expected }.into());
        }
        let still = start - &self.k1 * start - start * self.k2;
        let mut samples = tool.samples() * self.k1.transpose() + object.samples() * self.k2;
        samples.row_iter_mut().for_each(|mut row| row += still.transpose());
        Ok(Trajectory::new(tool.times_s().to_vec(), samples)?)
    }

    fn check_system(&self, first: &Dmp, second: &Dmp) -> Result<(), FlipError> {
        self.check_dimension(first.dimension())?;
        self.check_dimension(second.dimension())?;
        if first.form() == DmpForm::Scaled || !first.shares_system(second) {
            return Err(FlipError::UnsharedSystem);
        }
        Ok(())
    }

    fn check_dimension(&self, found: usize) -> Result<(), SkillError> {
        let expected = self.k1.nrows();
        if found == expected {
            return Ok(());
        }
        Err(SkillError::Dimension { operation: "combine flip", found, expected })
    }
}

/// Condition number of k1 from which its inverse counts as lost in rounding.
const LARGEST_CONDITION: f64 = 1e12;
