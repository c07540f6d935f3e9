//! Models that are wrong on purpose: an arm whose inertias differ from those of the real one.

use crate::error::RobotError;
use crate::manipulator::{Manipulator, check_length};

impl Manipulator {
    /// Multiplies the mass and the inertia tensor of each joint's body by a factor (n entries), as if it were made of denser
    /// or lighter stuff: centers of mass and rotor inertias stay.
    ///
    /// # Errors
    /// [`RobotError::WrongLength`], or [`RobotError::InvalidArgument`] for a factor that is not positive or not finite.
    pub fn scale_inertias(&mut self, factors: &[f64]) -> Result<(), RobotError> {
        check_length("scale inertias: the list of factors", factors.len(), self.joint_count())?;
        if let Some(&found) = factors.iter().find(|factor| !(factor.is_finite() && **factor > 0.0)) {
            let expected = "more than zero, finite";
            return Err(RobotError::InvalidArgument { quantity: "factor of a body's inertia", found, expected });
        }
        for (joint, factor) in self.joints.iter_mut().zip(factors) {
            joint.body.mass_kg *= factor;
            joint.body.inertia_kg_m2 *= *factor;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use approx::assert_relative_eq;
    use nalgebra::{DMatrix, DVector};

    use crate::Manipulator;

    fn panda() -> Manipulator {
        Manipulator::from_urdf_str(include_str!("../../../assets/robots/panda.urdf")).unwrap()
    }

    #[test]
    fn one_factor_for_all_bodies_scales_mass_matrix_and_gravity() {
        let mut heavier = panda();
        heavier.scale_inertias(&[1.1; 7]).unwrap();
        let q = DVector::from_vec(vec![0.1, -0.8, 0.3, -2.3, 0.2, 1.5, 0.7]);
        let terms = |model: &Manipulator| {
            let mut workspace = model.workspace();
            let (mut mass, mut gravity) = (DMatrix::zeros(7, 7), DVector::zeros(7));
            workspace.set_positions(&q).unwrap();
            workspace.mass_matrix_into(&mut mass);
            workspace.gravity_into(&mut gravity);
            (mass, gravity)
        };
        let ((mass, gravity), (heavier_mass, heavier_gravity)) = (terms(&panda()), terms(&heavier));
        // both are linear in the masses: rounding only
        assert_relative_eq!(heavier_mass, mass * 1.1, epsilon = 1e-13);
        assert_relative_eq!(heavier_gravity, gravity * 1.1, epsilon = 1e-12);
    }

    #[test]
    fn factors_that_are_no_factors_are_refused() {
        let mut arm = panda();
        for factors in [vec![1.0; 6], vec![0.0; 7], vec![f64::NAN; 7]] {
            assert!(arm.scale_inertias(&factors).is_err(), "{factors:?}");
        }
        assert_eq!(arm, panda());
    }
}
