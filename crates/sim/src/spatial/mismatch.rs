//! How much the arm that the controller believes in differs from the one that moves.

use nalgebra::{Matrix3, Vector3};
use rand_chacha::ChaCha8Rng;
use robot::{FrameId, Manipulator};
use serde::{Deserialize, Serialize};
use skills::field::{FieldError, within};

use crate::error::SimError;
use crate::random::symmetric;

/// Heaviest load in a hand, kg, and how far from the tool's frame it may be along an axis, m: beyond, a number is a mistake.
const HEAVIEST_PAYLOAD_KG: f64 = 1000.0;
const FARTHEST_PAYLOAD_M: f64 = 10.0;

/// Errors of a controller's model of its arm: without them a controller that cancels the arm's dynamics looks better than
/// any will on a machine.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct ModelMismatch {
    /// Share by which the model's masses and inertias are all too large; negative if too small.
    #[schemars(range(min = -0.9, max = 10.0))]
    pub inertia_share: f64,
    /// Largest share by which each joint's body is wrong besides, drawn for each, all shares up to it equally likely.
    #[schemars(range(min = 0.0, max = 0.9))]
    pub inertia_scatter_share: f64,
    /// Mass in the hand that the model lacks, kg.
    #[schemars(range(min = 0.0, max = HEAVIEST_PAYLOAD_KG))]
    pub payload_kg: f64,
    /// Where that mass is, as a point in the tool's frame, m.
    #[schemars(inner(range(min = -FARTHEST_PAYLOAD_M, max = FARTHEST_PAYLOAD_M)))]
    pub payload_at_m: [f64; 3],
}

impl ModelMismatch {
    /// Checks the numbers.
    ///
    /// # Errors
    /// A [`FieldError`] naming the offending value.
    pub fn validate(&self) -> Result<(), FieldError> {
        within("inertia_share", self.inertia_share, -0.9, 10.0)?;
        within("inertia_scatter_share", self.inertia_scatter_share, 0.0, 0.9)?;
        within("payload_kg", self.payload_kg, 0.0, HEAVIEST_PAYLOAD_KG)?;
        let reach = |&place_m: &f64| within("payload_at_m", place_m, -FARTHEST_PAYLOAD_M, FARTHEST_PAYLOAD_M);
        self.payload_at_m.iter().try_for_each(reach)
    }

    /// The arm that moves and the arm that the controller believes in, from the nominal one whose hand holds the frame `tool`.
    /// The scatter comes from `random`; nothing is drawn if there is none.
    ///
    /// # Errors
    /// A field error naming the offending value.
    pub fn plant_and_model(
        &self,
        nominal: &Manipulator,
        tool: FrameId,
        mut random: ChaCha8Rng,
    ) -> Result<(Manipulator, Manipulator), SimError> {
        self.validate()?;
        let mut model = nominal.clone();
        let mut scatter = || match self.inertia_scatter_share {
            0.0 => 1.0,
            share => 1.0 + share * symmetric(&mut random),
        };
        let factors: Vec<f64> = nominal.joints().iter().map(|_| (1.0 + self.inertia_share) * scatter()).collect();
        model.scale_inertias(&factors)?;
        let plant =
            nominal.attach_payload(tool, self.payload_kg, Vector3::from(self.payload_at_m), Matrix3::zeros())?;
        Ok((plant, model))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::{Purpose, stream};

    fn panda() -> (Manipulator, FrameId) {
        let arm = Manipulator::from_urdf_str(include_str!("../../../../assets/robots/panda.urdf")).expect("valid");
        let tool = arm.frame("panda_hand_tcp").expect("known");
        (arm, tool)
    }

    fn draw(mismatch: &ModelMismatch, trial: u64) -> (Manipulator, Manipulator) {
        let (arm, tool) = panda();
        mismatch.plant_and_model(&arm, tool, stream(1, Purpose::Variation, trial)).expect("valid")
    }

    fn masses(arm: &Manipulator) -> Vec<f64> {
        arm.joints().iter().map(|joint| joint.body.mass_kg).collect()
    }

    #[test]
    fn without_mismatch_plant_and_model_are_the_arm() {
        let (arm, _) = panda();
        let (plant, model) = draw(&ModelMismatch::default(), 0);
        assert_eq!(masses(&plant), masses(&arm));
        assert_eq!(model, arm);
    }

    #[test]
    fn a_payload_is_the_plants_alone_and_a_share_the_models() {
        let (arm, _) = panda();
        let mismatch = ModelMismatch { inertia_share: 0.1, payload_kg: 0.5, ..ModelMismatch::default() };
        let (plant, model) = draw(&mismatch, 0);
        let (nominal, hand) = (masses(&arm), 6);
        assert!((masses(&plant)[hand] - nominal[hand] - 0.5).abs() < 1e-15);
        for (wrong, right) in masses(&model).iter().zip(&nominal) {
            assert!((wrong / right - 1.1).abs() < 1e-15);
        }
    }

    #[test]
    fn scatter_stays_within_its_share_and_comes_from_the_stream() {
        let (arm, _) = panda();
        let mismatch = ModelMismatch { inertia_scatter_share: 0.2, ..ModelMismatch::default() };
        let factors = |trial| -> Vec<f64> {
            masses(&draw(&mismatch, trial).1).iter().zip(masses(&arm)).map(|(wrong, right)| wrong / right).collect()
        };
        assert_eq!(factors(0), factors(0));
        assert_ne!(factors(0), factors(1));
        assert!(factors(0).iter().all(|factor| (factor - 1.0).abs() <= 0.2));
        assert!(factors(0).windows(2).all(|pair| pair[0] != pair[1]), "one draw for each body");
    }

    #[test]
    fn numbers_that_make_no_arm_are_refused() {
        let wrong = [
            ModelMismatch { inertia_share: -1.0, ..ModelMismatch::default() },
            ModelMismatch { inertia_scatter_share: 1.0, ..ModelMismatch::default() },
            ModelMismatch { payload_kg: f64::NAN, ..ModelMismatch::default() },
            ModelMismatch { payload_at_m: [0.0, f64::INFINITY, 0.0], ..ModelMismatch::default() },
            // so heavy that the mass matrix loses the arm in rounding
            ModelMismatch { payload_kg: 1e300, ..ModelMismatch::default() },
            ModelMismatch { payload_at_m: [1e200, 0.0, 0.0], ..ModelMismatch::default() },
        ];
        for mismatch in wrong {
            assert!(mismatch.validate().is_err(), "{mismatch:?}");
        }
    }
}
