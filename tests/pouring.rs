//! Pours with the arm: what is collected, spilt and left, by the built program.
//!
//! Pours of 300 beans take 10 to 20 s of processor time each; those of many seeds are left to be asked for.

#![allow(clippy::unwrap_used, clippy::indexing_slicing, reason = "a test stops at the first surprise, its helpers too")]

#[path = "pouring/pours.rs"]
mod pours;
mod program;
#[path = "pouring/seeds.rs"]
mod seeds;

use pours::{Pour, few_beans};

/// The accepted error of the arm's tool in a pour, mm: a tenth of the clearance that is certified.
const TOOL_ERROR_MM: f64 = 0.3;

#[test]
fn a_small_pour_is_collected_without_a_touch_and_repeats_itself_byte_by_byte() {
    let text = few_beans("pour_wide_bowl.toml", 60);
    let (first, second) = (Pour::of(&text, 3), Pour::of(&text, 3));
    assert_eq!(first.code, Some(0), "{}", first.text);
    assert_eq!((first.count("collected_count"), first.count("spilt_count")), (60, 0));
    assert_eq!((first.count("cup_touches"), first.count("table_touches")), (0, 0));
    assert!(first.value("tool_error_max_mm") < TOOL_ERROR_MM);
    // what the plan certified is what the engine's colliders were kept apart by
    assert!(first.value("planned_clearance_mm") >= 3.0);
    first.assert_conserved(60);
    assert!(!first.outcome["trajectory_digest"].as_str().unwrap().is_empty());
    assert_eq!(first.text, second.text);
}

#[test]
fn the_outcome_does_not_depend_on_the_number_of_threads() {
    let text = few_beans("pour_wide_bowl.toml", 30);
    assert_eq!(Pour::pair_on_threads(&text, 1), Pour::pair_on_threads(&text, 2));
}

#[test]
fn a_cup_that_strikes_the_target_is_counted_and_fails_the_run() {
    // the plain primitive moves a jug as a narrower cup was shown: its wall strikes the neck of the bottle
    let text = few_beans("pour_plain_dmp.toml", 20).replace("asset = \"source_cup\"", "asset = \"jug\"");
    let shown = "[demonstrations.synthetic]\nsource = \"source_cup\"";
    let pour = Pour::of(&text.replace("[demonstrations.synthetic]", shown), 1);
    assert!(pour.count("cup_touches") > 0, "{}", pour.text);
    assert_eq!(pour.code, Some(1));
    pour.assert_conserved(20);
}

#[test]
fn an_arm_that_goes_through_the_table_fails_the_run() {
    let low = few_beans("pour_wide_bowl.toml", 20).replace("options.floor_m = 0.03", "options.floor_m = 0.005");
    let pour = Pour::of(&low, 1);
    assert!(pour.value("arm_above_table_mm") < 0.0);
    assert_eq!(pour.code, Some(1));
}

#[test]
fn a_bowl_out_of_reach_is_refused_before_anything_moves() {
    let pour = Pour::shipped("pour_out_of_reach.toml", 1);
    assert_eq!(pour.code, Some(1));
    pour.assert_infeasible(&[
        "plan pour: the underside of the cup",
        " m out of reach of `panda`",
        "move the container nearer",
    ]);
}

#[test]
fn a_cup_too_full_to_be_brought_near_the_mouth_is_refused_by_name() {
    let full = few_beans("pour_wide_bowl.toml", 60)
        .replace("options.floor_m", "options.largest_gap_m = 0.011\noptions.floor_m");
    let pour = Pour::of(&full, 1);
    assert_eq!(pour.code, Some(1));
    pour.assert_infeasible(&["plan pour: at the onset", "raise largest_gap_m"]);
}
