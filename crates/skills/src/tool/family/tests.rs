//! Tests of all families: valid lengths make valid tools, and what is said of their surfaces holds.

use super::*;
use crate::tool::{Grip, Tool, ToolFile};
use proptest::prelude::*;

/// What a contact may miss the outline by, m: chords stand up to 0.02 mm off their arc.
const OFF_OUTLINE_M: f64 = 2.1e-5;
/// Length of a step out of a tool, m.
const STEP_OUT_M: f64 = 2e-4;

/// The valid tool of a shape, weighing 10 g.
pub(super) fn tool(shape: &dyn ToolShape) -> Tool {
    assert_eq!(shape.validate(), Ok(()));
    let tool = Tool {
        name: "tool".into(),
        description: String::new(),
        mass_kg: 0.01,
        friction: 0.3,
        pieces: shape.pieces(),
        surfaces: shape.surfaces(),
    };
    assert_eq!(tool.validate(), Ok(()));
    tool
}

/// Sum of the pieces' areas, m².
pub(super) fn area_m2(tool: &Tool) -> f64 {
    tool.pieces.iter().map(|piece| piece.shape.area_m2()).sum()
}

/// Center, radius and half angle of a surface that is an arc about +y.
pub(super) fn top_arc(surface: &ContactSurface) -> ([f64; 2], f64, f64) {
    match surface.shape {
        SurfaceShape::Arc { center_m, radius_m, direction_rad, half_angle_rad } => {
            assert_eq!(direction_rad, std::f64::consts::FRAC_PI_2);
            (center_m, radius_m, half_angle_rad)
        }
        SurfaceShape::Face { .. } => panic!("{} is straight", surface.name),
    }
}

fn ranged(low: f64, high: f64) -> impl Strategy<Value = f64> {
    low..high
}

fn stick() -> impl Strategy<Value = ToolFamily> {
    (ranged(0.02, 0.2), ranged(0.004, 0.03), ranged(0.2, 1.0), ranged(0.01, 1.5), ranged(0.1, 1.0)).prop_map(
        |(length_m, width_m, head, head_half_angle_rad, side)| {
            let head_radius_m = head * width_m / 2.0;
            let side_length_m = (side * (length_m - head_radius_m)).max(SHORTEST_FACE_M);
            ToolFamily::Stick(Stick { length_m, width_m, head_radius_m, head_half_angle_rad, side_length_m })
        },
    )
}

fn ell() -> impl Strategy<Value = ToolFamily> {
    let shares = (ranged(0.1, 1.0), ranged(0.1, 1.0), ranged(0.1, 1.0), ranged(-0.5, 1.0));
    (ranged(0.02, 0.2), ranged(0.02, 0.2), ranged(0.006, 0.015), shares).prop_map(
        |(arm_m, stem_m, thickness_m, (bottom, tip, top, stem))| {
            // nearer to the inner corner than a step the other leg is before the surface
            let [arm_side_m, stem_side_m] = [arm_m, stem_m].map(|outer_m| outer_m - thickness_m - STEP_OUT_M);
            ToolFamily::L(Ell {
                arm_m,
                stem_m,
                thickness_m,
                bottom_length_m: (bottom * arm_side_m).max(SHORTEST_FACE_M),
                tip_length_m: tip * thickness_m,
                top_length_m: top * arm_m,
                stem_length_m: if stem < 0.1 { 0.0 } else { (stem * stem_side_m).max(SHORTEST_FACE_M) },
            })
        },
    )
}

fn tee() -> impl Strategy<Value = ToolFamily> {
    (ranged(0.0, 0.1), ranged(0.0, 0.1), ranged(0.0055, 0.02), ranged(0.002, 0.02), ranged(0.0, 0.0025)).prop_map(
        |(overhang, stem, thickness_m, object_radius_m, edge_margin_m)| {
            let least_m = object_radius_m + edge_margin_m + SHORTEST_FACE_M;
            let (bar_m, stem_m) = (thickness_m + 2.0 * (least_m + overhang), least_m + stem);
            ToolFamily::T(Tee { bar_m, stem_m, thickness_m, object_radius_m, edge_margin_m })
        },
    )
}

fn hook() -> impl Strategy<Value = ToolFamily> {
    let more = (ranged(0.0, 0.05), ranged(0.0, 0.03), ranged(0.0, 0.05));
    let angle = ranged(std::f64::consts::FRAC_PI_3, std::f64::consts::PI);
    (more, angle, ranged(0.0055, 0.02), ranged(0.002, 0.02), ranged(0.0, 0.0025)).prop_map(
        |((shank, prong, throat), opening_angle_rad, thickness_m, object_radius_m, edge_margin_m)| {
            let seat_m = object_radius_m / (opening_angle_rad / 2.0).tan();
            let end_m = edge_margin_m + SHORTEST_FACE_M;
            let prong_m = seat_m + end_m + prong;
            let mouth_m = 2.0 * object_radius_m + (prong_m * opening_angle_rad.cos()).max(0.0);
            let throat_m = mouth_m.max(object_radius_m + seat_m) + PLAY_M + throat;
            let shank_m = object_radius_m + end_m + shank;
            let lengths = Hook { shank_m, throat_m, prong_m, thickness_m, object_radius_m, ..Hook::default() };
            ToolFamily::Hook(Hook { opening_angle_rad, edge_margin_m, ..lengths })
        },
    )
}

fn rake() -> impl Strategy<Value = ToolFamily> {
    let tine = (2_u32..6, ranged(0.0, 0.03), ranged(0.0, 0.03), ranged(0.001, 0.004));
    (tine, ranged(0.0055, 0.02), ranged(0.002, 0.02), ranged(0.0, 0.0025)).prop_map(
        |((tines, throat, tine, tine_radius_m), thickness_m, object_radius_m, edge_margin_m)| {
            let throat_m = 2.0 * object_radius_m + PLAY_M + throat;
            let tine_length_m = object_radius_m + tine_radius_m + edge_margin_m + SHORTEST_FACE_M + tine;
            let lengths = Rake { tines, throat_m, tine_length_m, tine_radius_m, ..Rake::default() };
            ToolFamily::Rake(Rake { thickness_m, object_radius_m, edge_margin_m, ..lengths })
        },
    )
}

fn paddle() -> impl Strategy<Value = ToolFamily> {
    (ranged(0.006, 0.1), ranged(0.006, 0.03), ranged(1.0, 200.0), 0..3, ranged(0.0, 0.0025)).prop_map(
        |(width_m, thickness_m, wide, form, edge_margin_m)| {
            let radius_m = (wide * width_m / paddle::WIDEST_FACE).min(10.0);
            let face = match form {
                0 => PaddleFace::Flat,
                1 => PaddleFace::Convex { radius_m },
                _ => PaddleFace::Concave { radius_m },
            };
            ToolFamily::Paddle(Paddle { width_m, thickness_m, face, edge_margin_m })
        },
    )
}

fn any_family() -> impl Strategy<Value = ToolFamily> {
    prop_oneof![stick(), ell(), tee(), hook(), rake(), paddle()]
}

/// Usable contacts of a surface: both ends and some between.
fn contacts(surface: &ContactSurface) -> impl Iterator<Item = crate::tool::Contact> + '_ {
    (-4..=4).map(|k| surface.contact_at(surface.length_m() * f64::from(k) / 8.0))
}

proptest! {
    #[test]
    fn valid_lengths_make_a_valid_tool(family in any_family()) {
        prop_assert_eq!(family.validate(), Ok(()));
        let tool = tool(family.shape());
        for surface in &tool.surfaces {
            prop_assert!(surface.length_m() > 0.0);
            for contact in contacts(surface) {
                let off_m = tool.signed_distance_m(&contact.point);
                prop_assert!(off_m.abs() < OFF_OUTLINE_M, "{}: {off_m} m off the outline", surface.name);
                // a step out along the normal is that far from the tool: the normal is outward and nothing is before it
                let out_m = tool.signed_distance_m(&(contact.point + contact.normal.into_inner() * STEP_OUT_M));
                prop_assert!((out_m - STEP_OUT_M).abs() < OFF_OUTLINE_M, "{}: {out_m} m", surface.name);
            }
        }
    }

    #[test]
    fn a_disc_of_the_stated_radius_fits_at_every_contact(family in prop_oneof![tee(), hook(), rake()]) {
        let radius_m = match &family {
            ToolFamily::T(tee) => tee.object_radius_m,
            ToolFamily::Hook(hook) => hook.object_radius_m,
            ToolFamily::Rake(rake) => rake.object_radius_m,
            _ => unreachable!(),
        };
        let tool = tool(family.shape());
        for surface in &tool.surfaces {
            for contact in contacts(surface) {
                let gap_m = tool.signed_distance_m(&(contact.point + contact.normal.into_inner() * radius_m)) - radius_m;
                prop_assert!(gap_m > -ROUNDING_M, "{}: {gap_m} m", surface.name);
            }
        }
    }

    #[test]
    fn a_family_survives_writing_and_reading(family in any_family()) {
        let text = serde_json::to_string(&family).unwrap();
        let read: ToolFamily = serde_json::from_str(&text).unwrap();
        prop_assert_eq!(read.name(), family.name());
        prop_assert_eq!(serde_json::to_string(&read).unwrap(), text);
    }

    #[test]
    fn unlikely_lengths_are_refused_or_make_a_valid_tool(
        numbers in prop::collection::vec(prop_oneof![
            any::<f64>(), 0.0..0.1_f64, Just(0.0), Just(1.0), Just(f64::NAN), Just(1e-9),
        ], 7),
        tines in any::<u32>(),
    ) {
        let [a, b, c, d, e, f, g] = numbers[..] else { unreachable!() };
        let families = [
            ToolFamily::Stick(Stick { length_m: a, width_m: b, head_radius_m: c, head_half_angle_rad: d, side_length_m: e }),
            ToolFamily::T(Tee { bar_m: a, stem_m: b, thickness_m: c, object_radius_m: d, edge_margin_m: e }),
            ToolFamily::L(Ell {
                arm_m: a, stem_m: b, thickness_m: c, bottom_length_m: d, tip_length_m: e, top_length_m: f, stem_length_m: g,
            }),
            ToolFamily::Hook(Hook {
                shank_m: a, throat_m: b, prong_m: c, opening_angle_rad: d, thickness_m: e, object_radius_m: f,
                edge_margin_m: g,
            }),
            ToolFamily::Rake(Rake {
                tines, throat_m: a, tine_length_m: b, tine_radius_m: c, thickness_m: d, object_radius_m: e, edge_margin_m: f,
            }),
            ToolFamily::Paddle(Paddle {
                width_m: a, thickness_m: b, face: PaddleFace::Concave { radius_m: c }, edge_margin_m: d,
            }),
        ];
        for family in families {
            if family.validate().is_ok() {
                tool(family.shape());
            }
        }
    }
}

#[test]
fn a_mistake_in_a_family_is_named_by_its_key_in_the_file() {
    let file = |family| ToolFile {
        name: "tool".into(),
        description: String::new(),
        mass_kg: 0.01,
        friction: 0.3,
        grip: Grip::default(),
        family: Some(family),
        pieces: Vec::new(),
        surfaces: Vec::new(),
    };
    let field = |family| file(family).tool().unwrap_err().field;
    assert_eq!(field(ToolFamily::Hook(Hook { throat_m: 0.02, ..Hook::default() })), "family.hook.throat_m");
    assert_eq!(field(ToolFamily::Stick(Stick { width_m: -1.0, ..Stick::default() })), "family.stick.width_m");
    assert_eq!(field(ToolFamily::L(Ell { arm_m: 40.0, ..Ell::default() })), "family.l.arm_m");
    assert_eq!(field(ToolFamily::T(Tee { bar_m: 0.01, ..Tee::default() })), "family.t.bar_m");
    assert_eq!(field(ToolFamily::Rake(Rake { tines: 9, ..Rake::default() })), "family.rake.tines");
    let face = PaddleFace::Concave { radius_m: 0.01 };
    let hollow = ToolFamily::Paddle(Paddle { face, ..Paddle::default() });
    assert_eq!(field(hollow), "family.paddle.face.concave.radius_m");
}
