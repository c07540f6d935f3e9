//! Whether a model can be accelerated: every joint feels inertia, and no body has a negative one.

use std::f64::consts::TAU;

use nalgebra::{DMatrix, DVector};

use crate::error::RobotError;
use crate::manipulator::Manipulator;
use crate::urdf::principal_moments;

/// Part of a body's largest moment below which a negative one counts as rounding, as files give about six digits.
const MOMENT_ROUNDING: f64 = 1e-6;
/// Part of a joint's inertia, with all others held, below which what is left with the others free counts as none. In f64 the
/// elimination loses about n·1e-16; the lightest real wrists keep more than 1e-4.
const LEAST_PART: f64 = 1e-12;
/// An inertia (kg m² or kg) that counts as none: that of a grain of 1 µg at 1 mm.
const LEAST_INERTIA: f64 = 1e-15;
/// Where in its range a joint is placed: not in the middle, where axes tend to be parallel.
const PART_OF_RANGE: f64 = 0.37;

impl Manipulator {
    /// Checks that forward dynamics and simulation have an answer: each joint feels inertia (its rotor's, or that of the
    /// links it moves while the joints behind it move freely), and no body has a negative moment of inertia. Kinematics,
    /// and torques for a given motion, need none of this.
    ///
    /// Inertia is felt at one posture inside the limits: what is massless by construction is found, a posture in
    /// which the mass matrix happens to be singular is not.
    ///
    /// # Errors
    /// [`RobotError::NoInertia`] or [`RobotError::NegativeInertia`] with the joint and the remedy.
    pub fn check_dynamics(&self) -> Result<(), RobotError> {
        for joint in &self.joints {
            let moments = principal_moments(&joint.body.inertia_kg_m2);
            let least = -LEAST_INERTIA.max(MOMENT_ROUNDING * moments.amax());
            if moments.iter().any(|moment| moment.is_nan() || *moment < least) {
                let (joint, links) = (joint.name.clone(), joint.body.links.clone());
                return Err(RobotError::NegativeInertia { joint, links, moments: moments.into() });
            }
        }
        let mut matrix = self.mass_matrix_inside_limits()?;
        let held = matrix.diagonal();
        // what a joint feels with those behind it free: the pivots D of M = Lᵀ D L, from the last joint on
        for index in (0..self.joint_count()).rev() {
            let inertia = matrix[(index, index)];
            if !(inertia > LEAST_INERTIA && inertia > LEAST_PART * held[index]) {
                return Err(RobotError::NoInertia { joint: self.joints[index].name.clone(), inertia });
            }
            eliminate(&mut matrix, index);
        }
        Ok(())
    }

    fn mass_matrix_inside_limits(&self) -> Result<DMatrix<f64>, RobotError> {
        let places = self.joints.iter().map(|joint| {
            let lower = joint.limits.lower.unwrap_or_else(|| joint.limits.upper.unwrap_or(0.0).min(0.0) - 1.0);
            let upper = joint.limits.upper.unwrap_or_else(|| lower.max(0.0) + 1.0);
            // a sum of parts, as the width of a range of huge limits overflows
            let place = (1.0 - PART_OF_RANGE) * lower + PART_OF_RANGE * upper;
            if joint.kind.rotates() { place % TAU } else { place }
        });
        let mut workspace = self.workspace();
        let mut matrix = DMatrix::zeros(0, 0);
        workspace.set_positions(&DVector::from_iterator(self.joint_count(), places))?;
        workspace.mass_matrix_into(&mut matrix);
        Ok(matrix)
    }
}

/// Takes joint `pivot` out of the matrix of the joints before it.
fn eliminate(matrix: &mut DMatrix<f64>, pivot: usize) {
    for row in 0..pivot {
        let factor = matrix[(row, pivot)] / matrix[(pivot, pivot)];
        for column in 0..pivot {
            matrix[(row, column)] -= factor * matrix[(pivot, column)];
        }
    }
}

#[cfg(test)]
mod tests {
    use crate::{Manipulator, RobotError};

    /// Two revolute joints about z, 1 m apart, with these inertials.
    fn arm(first: &str, second: &str) -> Manipulator {
        let joint = |name: &str, parent: &str, child: &str| {
            format!(
                r#"<joint name="{name}" type="continuous"><origin xyz="1 0 0"/><parent link="{parent}"/>
                <child link="{child}"/><axis xyz="0 0 1"/></joint>"#
            )
        };
        let link = |name: &str, inertial: &str| format!(r#"<link name="{name}">{inertial}</link>"#);
        let text = [
            link("base", ""),
            link("first", first),
            link("second", second),
            joint("a", "base", "first"),
            joint("b", "first", "second"),
        ];
        Manipulator::from_urdf_str(&format!("<robot>{}</robot>", text.concat())).expect("a good file")
    }

    const SOLID: &str = r#"<inertial><origin xyz="0.5 0 0"/><mass value="1"/>
        <inertia ixx="0.1" iyy="0.1" izz="0.1"/></inertial>"#;
    const POINT_ON_AXIS: &str = r#"<inertial><mass value="1"/><inertia ixx="0" iyy="0" izz="0"/></inertial>"#;
    const ROUNDED_TO_NOTHING: &str = r#"<inertial><mass value="1"/><origin xyz="1 0 0"/>
        <inertia ixx="-5e-20" iyy="-5e-20" izz="0"/></inertial>"#;
    const NEGATIVE: &str = r#"<inertial><mass value="1"/><inertia ixx="0.1" iyy="-0.1" izz="0.1"/></inertial>"#;

    fn found(first: &str, second: &str) -> Result<(), String> {
        arm(first, second).check_dynamics().map_err(|error| match error {
            RobotError::NoInertia { joint, .. } | RobotError::NegativeInertia { joint, .. } => joint,
            other => other.to_string(),
        })
    }

    #[test]
    fn joints_without_inertia_are_named() {
        assert_eq!(found(SOLID, SOLID), Ok(()));
        assert_eq!(found(SOLID, ""), Err("b".to_owned()));
        assert_eq!(found(SOLID, POINT_ON_AXIS), Err("b".to_owned()));
        assert_eq!(found(SOLID, NEGATIVE), Err("b".to_owned()));
        assert_eq!(found(SOLID, ROUNDED_TO_NOTHING), Ok(()));
    }

    #[test]
    fn a_massless_link_is_felt_by_its_own_joint_only_if_the_next_one_yields() {
        // with b free, a body on b resists a only through its mass at the axis of b, 1 m from that of a
        assert_eq!(found("", SOLID), Ok(()));
        let slider = r#"<robot><link name="base"/><link name="none"/><link name="body"><inertial><mass value="1"/>
            <inertia ixx="1" iyy="1" izz="1"/></inertial></link>
            <joint name="a" type="prismatic"><parent link="base"/><child link="none"/><axis xyz="1 0 0"/></joint>
            <joint name="b" type="prismatic"><parent link="none"/><child link="body"/><axis xyz="1 0 0"/></joint></robot>"#;
        // two slides along one line: only their sum moves the mass
        let error = Manipulator::from_urdf_str(slider).expect("it has kinematics").check_dynamics();
        assert!(matches!(error, Err(RobotError::NoInertia { joint, .. }) if joint == "a"));
    }

    #[test]
    fn a_rotor_stands_in_for_mass() {
        let mut bare = arm("", "");
        bare.set_rotor_inertia(&[0.1, 0.1]).expect("two joints");
        assert_eq!(bare.check_dynamics(), Ok(()));
    }

    #[test]
    fn the_remedy_is_told() {
        let message = arm(SOLID, "").check_dynamics().expect_err("nothing moves").to_string();
        assert!(message.contains("joint `b`") && message.contains("<inertial>"), "{message}");
    }

    #[test]
    fn ranges_of_any_size_do_not_make_inertia_vanish() {
        let text = include_str!("../../../assets/robots/panda.urdf").replace("upper=\"2.8973\"", "upper=\"1.7e308\"");
        let text = text.replace("lower=\"-2.8973\"", "lower=\"-1.7e308\"");
        let arm = Manipulator::from_urdf_str(&text).unwrap();
        assert_eq!(arm.joints()[0].limits.upper, Some(1.7e308));
        arm.check_dynamics().unwrap();
    }
}
