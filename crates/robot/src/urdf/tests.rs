//! Malformed and odd URDF texts, and what the merged model of a good one looks like.

use approx::assert_relative_eq;
use nalgebra::{Matrix3, Vector3};

use crate::{Geometry, JointKind, Manipulator, RobotError, Warning};

/// Merging multiplies a few rotations; anything above rounding would be a wrong formula.
const ROUNDING: f64 = 1e-15;

const LINKS: &str = r#"<link name="base"/><link name="arm"/>"#;
const JOINT: &str = r#"<joint name="turn" type="revolute"><parent link="base"/><child link="arm"/>
    <axis xyz="0 0 1"/><limit lower="-1" upper="1" effort="2" velocity="3"/></joint>"#;

fn read(body: &str) -> Result<Manipulator, RobotError> {
    Manipulator::from_urdf_str(&format!("<robot name=\"test\">{body}</robot>"))
}

fn refusal(body: &str) -> RobotError {
    read(body).expect_err("the text is to be refused")
}

/// The refusal of the two-link arm with one piece of its joint replaced.
fn refusal_with(old: &str, new: &str) -> RobotError {
    assert!(JOINT.contains(old), "the piece to replace is there");
    refusal(&format!("{LINKS}{}", JOINT.replace(old, new)))
}

#[test]
fn text_that_is_not_xml_is_refused() {
    assert!(matches!(Manipulator::from_urdf_str("no xml"), Err(RobotError::NotUrdf { .. })));
    assert!(matches!(Manipulator::from_urdf_str(""), Err(RobotError::NotUrdf { .. })));
}

#[test]
fn xacro_is_refused_by_name() {
    let error = refusal(r#"<xacro:include filename="arm.xacro"/>"#);
    assert_eq!(error, RobotError::Xacro { found: "<xacro:include>".into(), line: 1 });
    assert!(error.to_string().contains("xacro FILE > robot.urdf"), "{error}");
}

#[test]
fn xacro_inside_a_comment_is_harmless() {
    read(&format!("<!-- was ${{x}} -- once -->{LINKS}{JOINT}")).expect("comments do not count");
}

#[test]
fn robot_without_links_is_refused() {
    assert_eq!(refusal(""), RobotError::NoLinks);
}

#[test]
fn several_roots_are_named() {
    assert_eq!(refusal(LINKS), RobotError::SeveralRoots { roots: vec!["base".into(), "arm".into()] });
}

#[test]
fn cycles_are_refused() {
    let back = r#"<joint name="back" type="fixed"><parent link="arm"/><child link="base"/></joint>"#;
    assert_eq!(refusal(&format!("{LINKS}{JOINT}{back}")), RobotError::Cycle { link: "base".into() });
    let rooted = format!(r#"<link name="root"/>{LINKS}{JOINT}{back}"#);
    assert_eq!(refusal(&rooted), RobotError::Cycle { link: "base".into() });
}

#[test]
fn link_with_two_parents_is_refused() {
    let second = r#"<link name="other"/><joint name="a" type="fixed"><parent link="base"/><child link="other"/></joint>
        <joint name="b" type="fixed"><parent link="other"/><child link="arm"/></joint>"#;
    let error = refusal(&format!("{LINKS}{JOINT}{second}"));
    assert_eq!(error, RobotError::SeveralParents { link: "arm".into(), first: "turn".into(), second: "b".into() });
}

#[test]
fn unknown_links_are_named() {
    let parent = refusal_with(r#"parent link="base""#, r#"parent link="bse""#);
    assert_eq!(parent, RobotError::UnknownParent { joint: "turn".into(), link: "bse".into() });
    let child = refusal_with(r#"child link="arm""#, r#"child link="amr""#);
    assert_eq!(child, RobotError::UnknownChild { joint: "turn".into(), link: "amr".into() });
}

#[test]
fn repeated_names_are_refused() {
    let links = refusal(&format!("{LINKS}{LINKS}{JOINT}"));
    assert_eq!(links, RobotError::DuplicateLink { link: "base".into() });
    let joints = refusal(&format!("{LINKS}{JOINT}{JOINT}"));
    assert_eq!(joints, RobotError::DuplicateJoint { joint: "turn".into() });
}

#[test]
fn zero_axis_is_refused() {
    assert_eq!(refusal_with("0 0 1", "0 0 0"), RobotError::ZeroAxis { joint: "turn".into() });
}

#[test]
fn reversed_limits_are_refused() {
    let error = refusal_with(r#"lower="-1""#, r#"lower="2""#);
    assert_eq!(error, RobotError::LimitsReversed { joint: "turn".into(), lower: 2.0, upper: 1.0 });
}

#[test]
fn numbers_that_are_not_finite_are_refused() {
    let axis = refusal_with("0 0 1", "0 0 nan");
    assert_eq!(axis, RobotError::NonFinite { element: "joint `turn`".into(), quantity: "axis" });
    let limit = refusal_with(r#"lower="-1""#, r#"lower="nan""#);
    assert_eq!(limit, RobotError::NonFinite { element: "joint `turn`".into(), quantity: "limit" });
}

#[test]
fn negative_mass_is_refused() {
    let link = r#"<link name="base"><inertial><mass value="-1"/>
        <inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial></link>"#;
    assert_eq!(refusal(link), RobotError::NegativeMass { element: "link `base`".into(), mass_kg: -1.0 });
}

#[test]
fn joints_with_several_freedoms_are_refused_by_name() {
    for kind in ["floating", "planar", "spherical"] {
        let error = refusal_with("revolute", kind);
        assert_eq!(error, RobotError::UnsupportedJoint { joint: "turn".into(), kind });
    }
}

#[test]
fn joints_of_unknown_type_are_refused() {
    let error = refusal_with("revolute", "rotational");
    let expected = RobotError::UnknownJointType { line: 1, joint: "turn".into(), found: "rotational".into() };
    assert_eq!(error, expected);
}

#[test]
fn unphysical_inertia_and_missing_mass_are_warnings() {
    let arm = r#"<link name="base"/><link name="arm"><inertial><mass value="1"/>
        <inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="3"/></inertial></link>"#;
    let model = read(&format!("{arm}{JOINT}")).expect("an odd inertia does not prevent use");
    assert!(matches!(model.warnings(), [Warning::UnphysicalInertia { link, .. }] if link == "arm"));
    let bare = read(&format!("{LINKS}{JOINT}")).expect("a massless body does not prevent use");
    assert_eq!(bare.warnings(), [Warning::MasslessBody { joint: "turn".into() }]);
}

#[test]
fn limits_that_are_not_stated_are_none() {
    let joint = JOINT.replace(r#"<limit lower="-1" upper="1" effort="2" velocity="3"/>"#, "");
    let model = read(&format!("{LINKS}{joint}")).expect("limits may be absent");
    let limits = model.joints()[0].limits;
    assert_eq!((limits.lower, limits.upper, limits.velocity, limits.effort), (None, None, None, None));
    assert!(model.warnings().contains(&Warning::LimitsAbsent { joint: "turn".into() }));
}

#[test]
fn fixed_links_merge_with_rotated_inertials_and_keep_their_frames() {
    // two points of 1 kg on the arm at x = 0 and x = 2, the second behind a fixed joint that turns x into y
    let text = format!(
        r#"<link name="base"/>
        <link name="arm"><inertial><origin rpy="0 0 1.5707963267948966"/><mass value="1"/>
            <inertia ixx="1" ixy="0" ixz="0" iyy="2" iyz="0" izz="3"/></inertial></link>
        <link name="hand"><inertial><origin xyz="0 -1 0"/><mass value="1"/>
            <inertia ixx="0" ixy="0" ixz="0" iyy="0" iyz="0" izz="0"/></inertial>
            <visual><origin xyz="0 0 1"/><geometry><sphere radius="0.5"/></geometry></visual></link>
        {JOINT}
        <joint name="weld" type="fixed"><origin xyz="1 0 0" rpy="0 0 1.5707963267948966"/>
            <parent link="arm"/><child link="hand"/></joint>"#
    );
    let model = read(&text).expect("a good file");
    let joint = &model.joints()[0];
    assert_eq!((joint.kind, joint.parent, model.joint_count()), (JointKind::Revolute, None, 1));
    let body = &joint.body;
    assert_eq!((body.mass_kg, body.links.as_slice()), (2.0, ["arm".to_owned(), "hand".to_owned()].as_slice()));
    // hand's mass stands at 1 + rot90(0, −1) = (2, 0, 0); the center is half way
    assert_relative_eq!(body.center_of_mass_m, Vector3::new(1.0, 0.0, 0.0), epsilon = ROUNDING);
    // the quarter turn exchanges ixx and iyy; two points at ±1 add 2 to iyy and izz
    let inertia = Matrix3::from_diagonal(&Vector3::new(2.0, 3.0, 5.0));
    assert_relative_eq!(body.inertia_kg_m2, inertia, epsilon = 4.0 * ROUNDING);
    let (carrier, pose) = model.frame_attachment(model.frame("hand").expect("links are frames"));
    assert_eq!(carrier, Some(0));
    assert_relative_eq!(pose.translation.vector, Vector3::new(1.0, 0.0, 0.0), epsilon = ROUNDING);
    assert_eq!(body.visuals[0].geometry, Geometry::Sphere { radius_m: 0.5 });
    assert_relative_eq!(body.visuals[0].body_from_shape.translation.vector, Vector3::new(1.0, 0.0, 1.0));
    assert_eq!(model.warnings(), [Warning::PointMass { link: "hand".into(), mass_kg: 1.0 }]);
}

#[test]
fn unknown_frames_are_answered_with_the_known_ones() {
    let model = read(&format!("{LINKS}{JOINT}")).expect("a good file");
    let error = model.frame("hnad").expect_err("no such frame");
    assert_eq!(error, RobotError::UnknownFrame { frame: "hnad".into(), known: vec!["base".into(), "arm".into()] });
}
