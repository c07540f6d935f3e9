//! Flips learned round one tool and generalized to another.

use nalgebra::{Isometry2, Point2, dvector};
use skills::outline::Outline;
use skills::tool::Tool;
use skills::tool_flipping::{FlipError, FlipOptions, SecondFactor, ShownFlip, ToolFlip};
use skills::{DmpConfig, DmpForm, MovementPrimitive, RolloutRequest};

use super::scenes::{BOTTOM, TIP, TOP, disc, l_tool, pentagon, square, stick, task};

/// Clearance of the virtual object movement at learning, m.
const MARGIN_M: f64 = 0.0035;

/// A demonstration with the stick, from its side to its head, that keeps farther away than needed.
pub fn shown_poses(tool: &Tool, object: &Outline, clearance_m: f64) -> Vec<Isometry2<f64>> {
    let options = FlipOptions { margin_m: clearance_m, k2: SecondFactor::Fixed(1.0), ..FlipOptions::default() };
    let flip = task(tool, object, 0, 1).flip(&options).unwrap();
    let track = flip.tool_track(0.01).unwrap();
    track.motions().iter().map(|motion| motion.pose()).collect()
}

pub fn learned(clearance_m: f64) -> ToolFlip {
    let (tool, object) = (stick(), disc());
    let poses = shown_poses(&tool, &object, clearance_m);
    let shown = ShownFlip {
        tool: &tool,
        object: &object,
        object_world: task(&tool, &object, 0, 1).object_world,
        tool_world: &poses,
        contacts: task(&tool, &object, 0, 1).contacts,
    };
    ToolFlip::learn(&DmpConfig::default(), &[shown], MARGIN_M).unwrap()
}

/// Largest excursion of the tool's own way about the straight line, m.
fn excursion_m(skill: &ToolFlip) -> f64 {
    let origin = dvector![0.0, 0.0];
    let request = RolloutRequest::new(origin.clone(), origin, 1.0, 0.005);
    let way = skill.tool_primitive().rollout(&request).unwrap().into_positions();
    way.samples().row_iter().map(|row| row.norm()).fold(0.0, f64::max)
}

/// Accuracy of the clearance reported for the middle, above the contact tolerance, m.
const REPORTED_M: f64 = 1.1e-5;

#[test]
fn a_demonstration_of_the_virtual_movement_itself_leaves_nothing_of_the_tools_own() {
    let (same_m, wider_m) = (excursion_m(&learned(MARGIN_M)), excursion_m(&learned(2.0 * MARGIN_M)));
    println!("own way: same margin {same_m:.2e} m, double margin {wider_m:.2e} m");
    // what is left is how the demonstration was sampled; what is kept beyond the margin is learned
    assert!(same_m < 1e-4 && wider_m > 0.9 * MARGIN_M);
}

#[test]
fn a_generalization_to_the_shown_tool_is_the_demonstration() {
    let (tool, object) = (stick(), disc());
    let poses = shown_poses(&tool, &object, 0.007);
    let task = task(&tool, &object, 0, 1);
    let options = FlipOptions { k2: SecondFactor::Fixed(1.0), ..FlipOptions::default() };
    let flip = learned(0.007).generalize(&task, &options).unwrap();
    assert_eq!((flip.k2, flip.own_share), (1.0, 1.0));
    let mut worst_m = 0.0f64;
    for (row, pose) in poses.iter().enumerate() {
        let time_s = 2.0 * row as f64 / 200.0;
        let off_m = (flip.tool_in_world(time_s).point() - Point2::from(pose.translation.vector)).norm();
        worst_m = worst_m.max(off_m);
    }
    println!("largest difference from the demonstration {worst_m:.2e} m");
    // 50 bases round two bends of a way of 40 mm
    assert!(worst_m < 5e-4);
}

#[test]
fn a_learned_flip_is_clear_round_another_tool_and_objects() {
    let (tool, skill) = (l_tool(), learned(0.007));
    for object in [disc(), square(), pentagon()] {
        for (from, to) in [(BOTTOM, TIP), (TIP, TOP), (TOP, TIP)] {
            for k2 in [SecondFactor::Smallest, SecondFactor::Fixed(1.0)] {
                let options = FlipOptions { k2, ..FlipOptions::default() };
                let flip = skill.generalize(&task(&tool, &object, from, to), &options).unwrap();
                println!("{from}-{to}: k2 {:.3} own {} {:?}", flip.k2, flip.own_share, flip.certificate);
                assert!(flip.certificate.smallest_clearance_m >= -1e-6);
                assert!(flip.certificate.middle_clearance_m >= 0.001 - REPORTED_M);
                if k2 == SecondFactor::Fixed(1.0) && object == disc() {
                    // what the demonstration kept beyond the margin is kept
                    assert_eq!(flip.own_share, 1.0);
                    assert!(flip.certificate.middle_clearance_m > 0.004);
                }
            }
        }
    }
}

#[test]
fn a_way_of_its_own_that_leads_into_the_tool_fades_or_is_outweighed_and_that_is_told() {
    // shown with an object that all but touches, in a movement that cuts the corner of a wider margin
    let (tool, object) = (stick(), disc());
    let poses = shown_poses(&tool, &object, 0.002);
    let base = task(&tool, &object, 0, 1);
    let shown = ShownFlip {
        tool: &tool,
        object: &object,
        object_world: base.object_world,
        tool_world: &poses,
        contacts: base.contacts,
    };
    let skill = ToolFlip::learn(&DmpConfig::default(), &[shown], 0.010).unwrap();
    let tool = l_tool();
    let task = task(&tool, &object, BOTTOM, TIP);
    let fixed = FlipOptions { k2: SecondFactor::Fixed(1.0), ..FlipOptions::default() };
    let faded = skill.generalize(&task, &fixed).unwrap();
    let outweighed = skill.generalize(&task, &FlipOptions::default()).unwrap();
    println!("fixed: own {}; free: k2 {} own {}", faded.own_share, outweighed.k2, outweighed.own_share);
    assert!(faded.own_share < 1.0);
    assert!(outweighed.own_share < 1.0 || outweighed.k2 > 1.0);
    for flip in [faded, outweighed] {
        assert!(flip.certificate.smallest_clearance_m >= -1e-6);
    }
}

#[test]
fn what_cannot_be_learned_from_is_refused() {
    let (tool, object) = (stick(), disc());
    let base = task(&tool, &object, 0, 1);
    let poses = shown_poses(&tool, &object, 0.005);
    let shown = ShownFlip {
        tool: &tool,
        object: &object,
        object_world: base.object_world,
        tool_world: &poses,
        contacts: base.contacts,
    };
    let learn = |shown: ShownFlip<'_>| ToolFlip::learn(&DmpConfig::default(), &[shown], MARGIN_M);
    assert!(learn(shown).is_ok());
    let still = ShownFlip { tool_world: &poses[..1], ..shown };
    assert_eq!(learn(still).unwrap_err(), FlipError::Still { demonstration: 0 });
    assert!(ToolFlip::learn(&DmpConfig::default(), &[], MARGIN_M).is_err());
    assert!(ToolFlip::learn(&DmpConfig::default(), &[shown], 0.0).is_err());
    let literal = DmpConfig { form: DmpForm::Eq1Literal, ..DmpConfig::default() };
    assert!(ToolFlip::learn(&literal, &[shown], MARGIN_M).is_err());
}
