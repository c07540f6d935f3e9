//! Pushes are found where they are, and nowhere else.

use skills::segmentation::{PushFragment, pushes};

use crate::shown::{HEAD, SIDE, Script, Truth, disc, stick};

/// The object's path is smoothed over about this time, s.
const SMOOTHED_S: f64 = 0.1;

/// What is found, with begin and end of each push in the time of the recording, s.
fn found(script: &Script) -> (Vec<(PushFragment, f64, f64)>, Truth) {
    let (demonstration, truth) = script.demonstration("shown");
    let aligned = demonstration.aligned();
    let from_s = demonstration.tool.start_time_s().max(demonstration.object.start_time_s());
    let time_s = |row: usize| from_s + row as f64 * aligned.time_step_s;
    let fragments = pushes(&aligned, &stick(), &disc());
    let timed = fragments.into_iter().map(|push| (push.clone(), time_s(push.first()), time_s(push.end())));
    (timed.collect(), truth)
}

fn assert_found(script: &Script) -> Vec<PushFragment> {
    let (found, truth) = found(script);
    assert_eq!(found.len(), truth.pushes.len());
    for ((push, begin_s, end_s), (surface, true_begin_s, true_end_s, _)) in found.iter().zip(&truth.pushes) {
        assert_eq!(push.surface, *surface);
        assert!((begin_s - true_begin_s).abs() < SMOOTHED_S, "begin {begin_s}, in truth {true_begin_s}");
        assert!((end_s - true_end_s).abs() < SMOOTHED_S, "end {end_s}, in truth {true_end_s}");
    }
    found.into_iter().map(|(push, ..)| push).collect()
}

#[test]
fn pushes_are_found_with_their_surfaces_and_times() {
    let fragments = assert_found(&Script::default());
    assert!(fragments.iter().all(|push| push.runs.len() == 1));
}

#[test]
fn pauses_change_nothing_but_the_times() {
    for pause_s in [0.15, 1.0, 4.0] {
        assert_found(&Script { pause_s, ..Script::default() });
    }
}

#[test]
fn camera_noise_moves_the_ends_of_pushes_by_less_than_the_smoothing() {
    for noise_m in [0.0005, 0.001] {
        let fragments = assert_found(&Script { noise_m, ..Script::default() });
        assert!(fragments.iter().all(|push| push.runs.len() == 1));
    }
}

#[test]
fn a_renewed_hold_stays_one_push_with_two_runs() {
    for (renewed, runs) in [(0, [2, 1]), (1, [1, 2])] {
        let fragments = assert_found(&Script { renewed: Some(renewed), ..Script::default() });
        assert_eq!([fragments[0].runs.len(), fragments[1].runs.len()], runs);
    }
}

#[test]
fn a_nudge_is_no_push() {
    let fragments = assert_found(&Script { nudge_m: 0.003, ..Script::default() });
    assert!(fragments.iter().all(|push| push.runs.len() == 1));
}

#[test]
fn a_camera_that_errs_while_the_object_rests_shows_no_push() {
    let script = Script { pushes: vec![], noise_m: 0.001, pause_s: 3.0, ..Script::default() };
    assert!(found(&script).0.is_empty());
    // nor does it with the tool held against the object
    let at_hold = Script { home: script.start + nalgebra::Vector2::new(0.018, -0.019), park: script.start, ..script };
    assert!(found(&Script { park: at_hold.home, ..at_hold }).0.is_empty());
}

#[test]
fn an_object_that_moves_out_of_reach_of_the_tool_is_not_pushed() {
    // seen from a tool that stays at home, the same motion of the object is someone else's doing
    let (demonstration, _) = Script::default().demonstration("shown");
    let mut aligned = demonstration.aligned();
    let home = aligned.tool[0];
    aligned.tool.iter_mut().for_each(|pose| *pose = home);
    assert_eq!(pushes(&aligned, &stick(), &disc()), vec![]);
}

#[test]
fn a_tool_without_surfaces_pushes_nothing() {
    let (demonstration, _) = Script::default().demonstration("shown");
    let mut bare = stick();
    bare.surfaces.clear();
    assert_eq!(pushes(&demonstration.aligned(), &bare, &disc()), vec![]);
}

#[test]
fn pushes_in_another_order_are_found_in_that_order() {
    let script = Script { pushes: vec![(HEAD, 0.03), (SIDE, 0.05), (HEAD, 0.04)], ..Script::default() };
    let fragments = assert_found(&script);
    assert_eq!(fragments.iter().map(|push| push.surface).collect::<Vec<_>>(), [HEAD, SIDE, HEAD]);
}
