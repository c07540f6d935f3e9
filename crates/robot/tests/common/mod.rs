//! Arms and random postures that several test files use.
#![allow(dead_code, reason = "each test file uses its own part")]
#![allow(clippy::unwrap_used, reason = "a test stops at the first surprise")]

use nalgebra::{DVector, Isometry3, Translation3, UnitQuaternion};
use robot::{FrameId, Manipulator};

pub const PANDA: &str = include_str!("../../../../assets/robots/panda.urdf");
pub const PLANAR_3R: &str = include_str!("../../../../assets/robots/planar_3r.urdf");
pub const DOUBLE_PENDULUM: &str = include_str!("../data/double_pendulum.urdf");
pub const TWO_ARMS: &str = include_str!("../data/two_arms.urdf");
pub const GANTRY: &str = include_str!("../data/gantry.urdf");
pub const THREE_FINGERS: &str = include_str!("../data/three_fingers.urdf");
pub const CARTPOLE: &str = include_str!("../data/cartpole.urdf");

/// A tree with a branch, a slide and skew axes: nothing that a serial arm about z would hide.
pub const BRANCHED: &str = r#"<robot name="branched">
    <link name="base"/>
    <link name="trunk"><inertial><origin xyz="0.1 0.2 0.3" rpy="0.3 0.2 0.1"/><mass value="2"/>
        <inertia ixx="0.1" ixy="0.01" ixz="0.02" iyy="0.12" iyz="0.005" izz="0.09"/></inertial></link>
    <link name="left"><inertial><origin xyz="0 0.3 0"/><mass value="1"/>
        <inertia ixx="0.05" ixy="0" ixz="0" iyy="0.02" iyz="0" izz="0.05"/></inertial></link>
    <link name="right"><inertial><origin xyz="0.2 -0.1 0"/><mass value="1.5"/>
        <inertia ixx="0.03" ixy="0" ixz="0" iyy="0.04" iyz="0" izz="0.05"/></inertial></link>
    <link name="finger"><inertial><origin xyz="0.05 0 0.1"/><mass value="0.4"/>
        <inertia ixx="0.01" ixy="0.001" ixz="0" iyy="0.01" iyz="0" izz="0.005"/></inertial></link>
    <joint name="a" type="continuous"><origin xyz="0.1 0 0.2" rpy="0.4 -0.3 0.2"/><parent link="base"/>
        <child link="trunk"/><axis xyz="1 2 3"/></joint>
    <joint name="b" type="prismatic"><origin xyz="0 0.3 0" rpy="1 0 0"/><parent link="trunk"/><child link="left"/>
        <axis xyz="0 1 1"/><limit lower="-2" upper="2" effort="9" velocity="1"/></joint>
    <joint name="c" type="revolute"><origin xyz="0 -0.3 0.1" rpy="0 1 0.5"/><parent link="trunk"/><child link="right"/>
        <axis xyz="1 0 -1"/><limit lower="-3" upper="3" effort="9" velocity="1"/></joint>
    <joint name="d" type="revolute"><origin xyz="0.4 0 0"/><parent link="right"/><child link="finger"/>
        <axis xyz="0 1 0"/><limit lower="-3" upper="3" effort="9" velocity="1"/></joint></robot>"#;

pub fn model(urdf: &str) -> Manipulator {
    Manipulator::from_urdf_str(urdf).unwrap()
}

/// The Panda's customary posture, elbow up and hand down.
pub const READY: [f64; 7] = [0.0, -0.785, 0.0, -2.356, 0.0, 1.571, 0.785];

pub fn planar() -> (Manipulator, FrameId) {
    let arm = model(PLANAR_3R);
    let flange = arm.frame("flange").unwrap();
    (arm, flange)
}

pub fn panda() -> (Manipulator, FrameId) {
    let arm = model(PANDA);
    let tip = arm.frame("panda_hand_tcp").unwrap();
    (arm, tip)
}

pub fn pose_of(arm: &Manipulator, frame: FrameId, q: &DVector<f64>) -> Isometry3<f64> {
    let mut workspace = arm.workspace();
    workspace.set_positions(q).unwrap();
    workspace.base_from_frame(frame)
}

pub fn within_limits(arm: &Manipulator, q: &DVector<f64>) -> bool {
    arm.joints().iter().zip(q.iter()).all(|(joint, &q)| joint.limits.clamp(q) == q)
}

pub fn planar_pose(x: f64, y: f64, angle: f64) -> Isometry3<f64> {
    Isometry3::from_parts(Translation3::new(x, y, 0.0), UnitQuaternion::from_euler_angles(0.0, 0.0, angle))
}

pub fn planar_start() -> DVector<f64> {
    DVector::from_vec(vec![-0.9, 1.8, -0.9])
}

/// A small reproducible generator of numbers in (−1, 1).
pub struct Random(pub u64);

impl Random {
    pub fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    }

    pub fn vector(&mut self, n: usize, scale: f64) -> DVector<f64> {
        DVector::from_fn(n, |_, _| scale * self.next())
    }

    /// Normally distributed numbers of standard deviation `scale` (Box and Muller).
    pub fn normal_vector(&mut self, n: usize, scale: f64) -> DVector<f64> {
        DVector::from_fn(n, |_, _| {
            let (radius, angle) = (0.5 * (1.0 + self.next()), std::f64::consts::PI * self.next());
            scale * (-2.0 * radius.max(f64::MIN_POSITIVE).ln()).sqrt() * angle.cos()
        })
    }

    /// Positions within the limits (±π where there are none), `margin` away from them.
    pub fn posture(&mut self, model: &Manipulator, margin: f64) -> DVector<f64> {
        DVector::from_iterator(
            model.joint_count(),
            model.joints().iter().map(|joint| {
                let lower = joint.limits.lower.unwrap_or(-std::f64::consts::PI) + margin;
                let upper = joint.limits.upper.unwrap_or(std::f64::consts::PI) - margin;
                0.5 * (lower + upper) + 0.5 * (upper - lower) * self.next()
            }),
        )
    }
}
