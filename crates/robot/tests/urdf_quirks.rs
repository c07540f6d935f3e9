//! What real URDF files contain beyond the book loads, with the right values, or is refused by name with its line.
#![allow(clippy::unwrap_used, clippy::panic, reason = "a test stops at the first surprise")]

mod common;

use approx::assert_relative_eq;
use common::model;
use nalgebra::{Matrix3, Vector3};
use robot::{Geometry, Manipulator, RobotError, Warning};

const VENDOR_EXTRAS: &str = include_str!("data/urdf/vendor_extras.urdf");
const SHAPES: &str = include_str!("data/urdf/shapes.urdf");
const LIMITS: &str = include_str!("data/urdf/limits.urdf");
const INERTIALS: &str = include_str!("data/urdf/inertials.urdf");
const LOOSE_VALUES: &str = include_str!("data/urdf/loose_values.urdf");

/// A few multiplications of numbers near 1.
const ROUNDING: f64 = 1e-15;

fn refusal(text: &str) -> String {
    Manipulator::from_urdf_str(text).unwrap_err().to_string()
}

fn messages(model: &Manipulator) -> Vec<String> {
    model.warnings().iter().map(Warning::to_string).collect()
}

#[test]
fn extras_of_other_programs_change_nothing() {
    let arm = model(VENDOR_EXTRAS);
    assert_eq!((arm.name(), arm.joint_count()), ("Roboterärmchen", 1));
    let joint = &arm.joints()[0];
    assert_eq!((joint.name.as_str(), joint.body.links.as_slice()), ("ellbogen", ["ellbogen".to_owned()].as_slice()));
    assert_eq!((joint.limits.lower, joint.limits.upper), (Some(-1.5), Some(1.5)));
    assert_eq!((joint.limits.velocity, joint.limits.effort), (Some(2.0), Some(10.0)));
    assert_eq!((joint.damping, joint.friction), (0.5, 0.25));
    assert_eq!(joint.parent_from_joint.translation.vector, Vector3::new(0.0, 0.0, 0.5));
}

#[test]
fn elements_that_may_be_misspelled_are_told_with_their_line() {
    let found = messages(&model(VENDOR_EXTRAS));
    assert_eq!(found.len(), 4, "{found:?}");
    assert!(found[0].starts_with("line 7: <sensor:camera> in <link> has the undeclared prefix `sensor`"), "{found:?}");
    assert!(found[1].starts_with("line 20: <hardware_interface> in <joint> is ignored (1 in"), "{found:?}");
    assert!(found[2].starts_with("line 24: <colision> in <link> is ignored (2 in the file)"), "{found:?}");
    assert!(found[3].contains("joint `ellbogen` moves a body without mass"), "{found:?}");
}

#[test]
fn line_ends_of_windows_and_a_byte_order_mark_change_nothing() {
    for text in [VENDOR_EXTRAS, SHAPES, LIMITS, INERTIALS, LOOSE_VALUES] {
        assert_eq!(model(&format!("\u{feff}{}", text.replace('\n', "\r\n"))), model(text));
    }
}

#[test]
fn shapes_get_their_colors_by_value_and_by_name() {
    let arm = model(SHAPES);
    let colors: Vec<_> = arm.base().visuals.iter().map(|shape| shape.color_rgba).collect();
    let other = Some([0.1, 0.2, 0.3, 1.0]);
    let expected = [Some([0.0, 0.0, 1.0, 1.0]), Some([1.0, 0.0, 0.0, 0.5]), other, None, None, None, None, other];
    assert_eq!(colors, expected);
}

#[test]
fn several_shapes_of_a_link_are_all_there() {
    let arm = model(SHAPES);
    let shape = |place: usize| &arm.base().visuals[place];
    assert_eq!(shape(0).geometry, Geometry::Box { size_m: Vector3::new(0.1, 0.2, 0.3) });
    assert_eq!(shape(1).geometry, Geometry::Capsule { radius_m: 0.05, length_m: 0.4 });
    assert_eq!(shape(1).body_from_shape.translation.vector, Vector3::z());
    assert_eq!(shape(2).geometry, Geometry::Cylinder { radius_m: 0.1, length_m: 0.2 });
    let balls: Vec<_> = arm.base().collisions.iter().map(|shape| shape.geometry.clone()).collect();
    assert_eq!(balls, [Geometry::Sphere { radius_m: 0.5 }, Geometry::Sphere { radius_m: 0.25 }]);
}

#[test]
fn mesh_scales_may_mirror_and_have_one_or_four_numbers() {
    let arm = model(SHAPES);
    let scales = arm.base().visuals.iter().filter_map(|shape| match &shape.geometry {
        Geometry::Mesh { uri, scale, triangles: None } => Some((uri.as_str(), (*scale).into())),
        _ => None,
    });
    let scales: Vec<(&str, [f64; 3])> = scales.collect();
    let expected = [
        ("package://shapes/left.stl", [0.001, -0.001, 0.001]),
        ("four.stl", [1.0, 2.0, 3.0]),
        ("one.stl", [0.001; 3]),
        ("none.stl", [1.0; 3]),
    ];
    assert_eq!(scales, expected);
    let found = messages(&arm).join("\n");
    assert!(found.contains("line 20: scale=\"1 2 3 1\" of <mesh> of link `body` is read as \"1 2 3\""), "{found}");
    assert!(found.contains("line 21: scale=\"0.001\" of <mesh> of link `body` is read as \"0.001 0.001"), "{found}");
}

#[test]
fn shapes_that_urdf_does_not_know_are_left_out_and_told() {
    let found = messages(&model(SHAPES)).join("\n");
    for part in [
        "line 23: <visual> of link `body` is ignored, as it holds <drake:ellipsoid>",
        "line 24: <visual> of link `body` is ignored, as it holds a mesh without a file name",
        "line 25: <visual> of link `body` is ignored, as it holds no <geometry>",
        "line 27: <collision> of link `body` is ignored, as it holds an empty <geometry>",
    ] {
        assert!(found.contains(part), "{part}\n{found}");
    }
}

#[test]
fn limits_that_are_not_stated_are_unlimited() {
    let arm = model(LIMITS);
    let limits = |place: usize| {
        let limits = arm.joints()[place].limits;
        (limits.lower, limits.upper, limits.velocity, limits.effort)
    };
    assert_eq!(limits(0), (Some(-1.0), Some(2.0), None, None));
    assert_eq!(limits(1), (None, None, None, None));
    assert_eq!(limits(2), (None, None, Some(3.0), Some(5.0)));
    assert_eq!(limits(3), (None, Some(1.0), Some(1000.0), None));
    // the book: a bound that is not written is zero
    assert_eq!(limits(4), (Some(0.0), Some(1.0), None, None));
    assert_eq!(arm.joints()[1].axis.into_inner(), Vector3::z());
    assert_eq!(arm.joints()[2].axis.into_inner(), Vector3::x());
    let absent: Vec<_> =
        arm.warnings().iter().filter(|warning| matches!(warning, Warning::LimitsAbsent { .. })).collect();
    assert_eq!(absent, [&Warning::LimitsAbsent { joint: "no_limit".into() }]);
    let zero = |attribute| Warning::LimitZero { joint: "upper_only".into(), attribute };
    let zeros: Vec<_> = arm.warnings().iter().filter(|warning| matches!(warning, Warning::LimitZero { .. })).collect();
    assert_eq!(zeros, [&zero("effort"), &zero("velocity")]);
    assert!(zeros[0].to_string().contains("effort=\"0\" is taken as unlimited"), "{}", zeros[0]);
}

#[test]
fn inertials_may_lack_an_origin_or_be_rotated() {
    let arm = model(INERTIALS);
    assert_eq!((arm.base().mass_kg, arm.base().links.len()), (2.0, 2));
    let rotated = &arm.joints()[0].body;
    assert_eq!(rotated.center_of_mass_m, Vector3::new(0.1, 0.0, 0.0));
    // a quarter turn about z exchanges the moments about x and y
    let expected = Matrix3::from_diagonal(&Vector3::new(2.0, 1.0, 2.5));
    assert_relative_eq!(rotated.inertia_kg_m2, expected, epsilon = ROUNDING);
}

#[test]
fn odd_inertials_load_with_a_warning_and_dynamics_are_refused_by_name() {
    let arm = model(INERTIALS);
    let warnings = arm.warnings();
    assert!(matches!(&warnings[0], Warning::PointMass { link, mass_kg: 0.5 } if link == "point"));
    assert!(matches!(&warnings[1], Warning::UnphysicalInertia { link, .. } if link == "flat"));
    assert!(matches!(&warnings[2], Warning::UnphysicalInertia { link, moments }
        if link == "negative" && moments.contains(&-1.0)));
    let told = warnings[2].to_string();
    assert!(told.contains("ITS INERTIA IS IMPOSSIBLE") && told.contains("-1.000e0"), "{told}");
    assert_eq!(warnings[3], Warning::MasslessBody { joint: "e".into() });
    assert_eq!(warnings.len(), 4);
    let error = arm.check_dynamics().unwrap_err();
    assert!(matches!(&error, RobotError::NegativeInertia { joint, .. } if joint == "d"), "{error}");
    assert!(error.to_string().contains("correct <inertia> of negative"), "{error}");
}

#[test]
fn loose_values_are_read_as_meant_and_told() {
    let arm = model(LOOSE_VALUES);
    let joint = &arm.joints()[0];
    assert_eq!(joint.parent_from_joint.translation.vector, Vector3::new(1.0, 2.0, 3.0));
    assert_eq!(joint.axis.into_inner(), Vector3::z());
    let (_, pose) = arm.frame_attachment(arm.frame("c").unwrap());
    assert_eq!(pose.translation.vector, Vector3::new(0.1, 0.2, 0.3));
    assert_relative_eq!(pose.rotation.angle(), std::f64::consts::PI, epsilon = ROUNDING);
    let found = messages(&arm);
    assert_eq!(found.len(), 6, "{found:?}");
    assert!(found[0].starts_with("line 4: xyz=\"1, 2,3\" of <origin> of joint `commas` is read as \"1 2 3\""));
    assert!(found[2].starts_with("line 5: <origin> of joint `commas` stands there again"), "{found:?}");
    assert!(found[4].starts_with("line 10: xyz=\"$(optenv TOOL_XYZ 0.1 0.2 0.3)\""), "{found:?}");
}

/// The arm of two links with a piece replaced: line 1 robot, 2 and 3 links, 4 joint, 5 to 9 its children.
fn arm_with(old: &str, new: &str) -> String {
    let text = r#"<robot name="r">
<link name="base"><inertial><mass value="1"/><inertia ixx="1" iyy="1" izz="1"/></inertial></link>
<link name="arm"/>
<joint name="turn" type="revolute">
<origin xyz="0 0 1"/>
<parent link="base"/>
<child link="arm"/>
<axis xyz="0 0 1"/>
<limit lower="-1" upper="1" effort="2" velocity="3"/></joint></robot>"#;
    assert_eq!(text.matches(old).count(), 1, "`{old}` is there once");
    text.replace(old, new)
}

#[test]
fn flaws_are_refused_with_line_owner_and_remedy() {
    for (old, new, expected) in [
        ("name=\"turn\"", "", "line 4: <joint> of the robot has no `name`"),
        ("<link name=\"arm\"/>", "<link/>", "line 3: <link> of the robot has no `name`"),
        ("<parent link=\"base\"/>", "", "line 4: joint `turn` has no <parent>"),
        ("<child link=\"arm\"/>", "<child/>", "line 7: <child> of joint `turn` has no `link`"),
        ("<axis xyz=\"0 0 1\"/>", "<axis/>", "line 8: <axis> of joint `turn` has no `xyz`"),
        ("<mass value=\"1\"/>", "", "line 2: <inertial> of link `base` has no <mass>"),
        ("ixx=\"1\" ", "", "line 2: <inertia> of link `base` has no `ixx`"),
        ("<origin xyz=\"0 0 1\"", "<origin xyz=\"0 0 x 1\"", "line 5: xyz=\"0 0 x 1\" of <origin> of joint `turn`"),
        ("<origin xyz=\"0 0 1\"", "<origin xyz=\"0 0\"", "expected 3 numbers separated by spaces"),
        ("lower=\"-1\"", "lower=\"0,5\"", "line 9: lower=\"0,5\" of <limit> of joint `turn`; expected one number"),
        ("lower=\"-1\"", "lower=\"-inf\" upper=\"2\"", "line 9: <limit> of joint `turn` has `upper` twice"),
        ("xyz=\"0 0 1\"/>\n<parent", "xyz=\"0 0 ${h}\"/>\n<parent", "line 5: found the xacro construct `0 0 ${h}`"),
        ("<limit", "<xacro:limits/>\n<limit", "line 9: found the xacro construct `<xacro:limits>`"),
        ("\"revolute\"", "\"hinge\"", "line 4: joint `turn` has the type `hinge`; expected fixed, revolute"),
        ("\"revolute\"", "\"floating\"", "joint `turn` is floating; expected fixed, revolute"),
        ("\"revolute\"", "\"planar\"", "joint `turn` is planar"),
        ("\"revolute\"", "\"spherical\"", "joint `turn` is spherical"),
        ("<axis xyz=\"0 0 1\"", "<axis xyz=\"0 0 0\"", "joint `turn` has a zero axis"),
        ("lower=\"-1\"", "lower=\"3\"", "joint `turn` has lower limit 3 above upper limit 1"),
        ("<mass value=\"1\"", "<mass value=\"nan\"", "mass of link `base` is not a finite number"),
        ("ixx=\"1\"", "ixx=\"inf\"", "inertia of link `base` is not a finite number"),
        ("<link name=\"arm\"/>", "<link name=\"arm\"/><link name=\"arm\"/>", "two links are named `arm`"),
        ("<link name=\"arm\"/>", "", "joint `turn` names the child link `arm`, which does not exist"),
        ("</joint>", "</joint><link name=\"b\"/>", "read urdf: 2 root links (base, b)"),
        ("</joint>", "", "line 9: </robot> stands where <joint> of line 4 ends"),
        ("<axis ", "<axis \"", "line 8: <axis> is not closed by `>`"),
        ("name=\"r\"", "name=\"&undefined;\"", "does not parse"),
    ] {
        let message = refusal(&arm_with(old, new));
        assert!(message.starts_with("read urdf: ") && message.contains(expected), "{expected}\n{message}");
    }
}

#[test]
fn lines_of_errors_are_those_of_the_file_after_comments_and_dropped_elements() {
    let padding = "<!-- one\ntwo -- three\n-->\n<gazebo>\n<a/>\n</gazebo>\n<link name=\"arm\"/>";
    let text = arm_with("<link name=\"arm\"/>", padding).replace("0 0 1\"/>\n<parent", "0 0 z\"/>\n<parent");
    assert!(refusal(&text).contains("line 11: xyz="), "{}", refusal(&text));
}

#[test]
fn other_formats_are_refused_by_name() {
    assert!(refusal("<sdf version='1.6'/>").contains("the root element is <sdf>; expected <robot>"));
    assert!(refusal("<mujoco/>").contains("convert the file to URDF first"));
    assert!(refusal("#VRML V2.0 utf8").contains("line 1: text outside of the root element"));
}

#[test]
fn huge_numbers_whose_products_overflow_are_refused() {
    let text = arm_with(
        "<link name=\"arm\"/>",
        "<link name=\"arm\"><inertial><origin xyz=\"1e200 0 0\"/><mass value=\"1e200\"/>\
        <inertia ixx=\"1\" iyy=\"1\" izz=\"1\"/></inertial></link>",
    );
    assert!(refusal(&text).contains("a product of its numbers of joint `turn`"), "{}", refusal(&text));
}

#[test]
fn deep_nesting_in_ignored_elements_does_not_overflow_the_stack() {
    const LEVELS: usize = 200_000;
    let nest = format!("<gazebo>{}{}</gazebo>", "<a>".repeat(LEVELS), "</a>".repeat(LEVELS));
    assert_eq!(model(&arm_with("<link name=\"arm\"/>", &format!("<link name=\"arm\"/>{nest}"))).joint_count(), 1);
}
