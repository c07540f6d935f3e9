//! In what the moving arm of the study differs from the one that its controller believes in.

use nalgebra::Vector3;

use crate::spatial::arm_config::{ArmConfig, JointFriction};
use crate::spatial::mismatch::ModelMismatch;

/// Largest change of a Franka motor's torque, N m/s (Franka Control Interface).
const FRANKA_RATE_LIMIT_NM_PER_S: f64 = 1000.0;
/// Force of the pushed conditions, N.
const PUSH_N: f64 = 10.0;

/// Coulomb (N m) and viscous (N m s/rad) friction of a Panda's joints, least-squares fit over ±1.5 rad/s to the sigmoids of Gaz et al.,
/// "Dynamic identification of the Franka Emika Panda robot", IEEE RA-L 2019, Table I. Their sigmoid is nearly viscous below
/// 0.1 rad/s and lets a joint at rest move freely; dry friction holds it.
const GAZ_FRICTION: [JointFriction; 7] = [
    friction(0.121, 0.137),
    friction(0.281, 0.148),
    friction(0.214, 0.102),
    friction(0.305, 0.305),
    friction(0.259, 0.151),
    friction(0.121, 0.030),
    friction(0.193, 0.085),
];

const fn friction(coulomb_nm: f64, viscous_nm_s_per_rad: f64) -> JointFriction {
    JointFriction { coulomb_nm, viscous_nm_s_per_rad }
}

/// A way in which the moving arm differs from the model.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Condition {
    /// Not at all.
    Perfect,
    /// All masses and inertias of the model are wrong by this share.
    Inertia {
        /// +0.1: the model is a tenth too heavy.
        share: f64,
    },
    /// Each body of the model is wrong by up to 20 %, drawn anew for each number.
    Scatter {
        /// Number of the draw.
        draw: u64,
    },
    /// The hand holds 0.5 kg that the model lacks.
    Payload,
    /// 10 N push the tool down from 1 s on.
    PushDown,
    /// 10 N push the tool sideways from 1 s on.
    PushSideways,
    /// The joints rub as those of a real Panda.
    Friction,
    /// Torques have Franka's limits, also of their rate of change.
    TorqueLimits,
    /// Friction, the payload, a model 10 % too heavy, and torque limits at once.
    Everything,
}

impl Condition {
    /// All conditions of the study.
    pub const ALL: [Self; 12] = [
        Self::Perfect,
        Self::Inertia { share: -0.2 },
        Self::Inertia { share: 0.1 },
        Self::Scatter { draw: 1 },
        Self::Scatter { draw: 2 },
        Self::Scatter { draw: 3 },
        Self::Payload,
        Self::PushDown,
        Self::PushSideways,
        Self::Friction,
        Self::TorqueLimits,
        Self::Everything,
    ];

    /// Name in tables.
    #[must_use]
    pub fn name(self) -> String {
        match self {
            Self::Perfect => "perfect model".into(),
            Self::Inertia { share } => format!("model's inertias {:+.0} %", 100.0 * share),
            Self::Scatter { draw } => format!("model's inertias random ±20 %, draw {draw}"),
            Self::Payload => "0.5 kg in the hand, not in the model".into(),
            Self::PushDown => "10 N down from 1 s".into(),
            Self::PushSideways => "10 N sideways from 1 s".into(),
            Self::Friction => "joint friction".into(),
            Self::TorqueLimits => "torque limits, 1000 N m/s".into(),
            Self::Everything => "friction, 0.5 kg, model +10 %, torque limits".into(),
        }
    }

    /// Errors of the model, and the number of the stream that their scatter is drawn from.
    pub(super) fn mismatch(self) -> (ModelMismatch, u64) {
        const PAYLOAD_KG: f64 = 0.5;
        let none = ModelMismatch::default;
        match self {
            Self::Inertia { share } => (ModelMismatch { inertia_share: share, ..none() }, 0),
            Self::Scatter { draw } => (ModelMismatch { inertia_scatter_share: 0.2, ..none() }, draw),
            Self::Payload => (ModelMismatch { payload_kg: PAYLOAD_KG, ..none() }, 0),
            Self::Everything => (ModelMismatch { inertia_share: 0.1, payload_kg: PAYLOAD_KG, ..none() }, 0),
            _ => (none(), 0),
        }
    }

    pub(super) fn arm(self) -> ArmConfig {
        let rubs = matches!(self, Self::Friction | Self::Everything);
        let limited = matches!(self, Self::TorqueLimits | Self::Everything);
        ArmConfig {
            friction: if rubs { GAZ_FRICTION.to_vec() } else { Vec::new() },
            torque_rate_limit_nm_per_s: limited.then_some(FRANKA_RATE_LIMIT_NM_PER_S),
            ideal_motors: !limited,
        }
    }

    /// Force on the tool's origin from 1 s on, world axes, N.
    pub(super) fn push_world_n(self) -> Vector3<f64> {
        match self {
            Self::PushDown => Vector3::new(0.0, 0.0, -PUSH_N),
            Self::PushSideways => Vector3::new(0.0, PUSH_N, 0.0),
            _ => Vector3::zeros(),
        }
    }
}
