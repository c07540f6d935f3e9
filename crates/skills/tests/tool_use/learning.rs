//! What is learned is what was shown, and what does not fit is left out by name.

use approx::assert_relative_eq;
use nalgebra::{Point2, Vector2, dvector};
use skills::demonstration::Demonstration;
use skills::primitive::SavedPrimitive;
use skills::tool_use::{LearnError, LearningReport, SavedLibrary, SkillLibrary};
use skills::{PrimitiveConfig, RolloutRequest};

use crate::shown::{HEAD, SIDE, Script, disc, stick};

/// What smoothing smears past the speeds at which a push begins and ends: 20 mm/s over 0.1 s, of which 0.3 and 0.1 remain.
const SMEARED_M: f64 = 0.001;

fn learn(demonstrations: &[Demonstration]) -> Result<(SkillLibrary, LearningReport), LearnError> {
    SkillLibrary::learn(&PrimitiveConfig::default(), demonstrations, &stick(), &disc())
}

fn shown(name: &str, script: &Script) -> Demonstration {
    script.demonstration(name).0
}

#[test]
fn the_learned_displacement_is_the_shown_one() {
    for script in [
        Script::default(),
        Script { renewed: Some(0), ..Script::default() },
        Script { pushes: vec![(SIDE, 0.05), (HEAD, 0.03)], noise_m: 0.0005, ..Script::default() },
    ] {
        let (demonstration, truth) = script.demonstration("shown");
        let (library, _) = learn(&[demonstration]).unwrap();
        assert_eq!((library.pushes.len(), library.flips.len()), (2, 3));
        for (skill, (surface, begin_s, end_s, way)) in library.pushes.iter().zip(&truth.pushes) {
            assert_eq!(skill.surface, *surface);
            // a new hold is cut out, but its ends are smeared like those of a push
            let holds = if script.renewed.is_some() { 2.0 } else { 1.0 };
            assert!((skill.displacement - way).norm() < holds * SMEARED_M + script.noise_m, "{}", skill.displacement);
            assert!(skill.duration_s < end_s - begin_s + 0.2);
        }
    }
}

#[test]
fn displacements_of_several_demonstrations_average() {
    let of = |side, head| Script { pushes: vec![(SIDE, side), (HEAD, head)], ..Script::default() };
    let (library, report) = learn(&[shown("a", &of(0.10, 0.08)), shown("b", &of(0.12, 0.04))]).unwrap();
    assert_eq!(report.used, ["a", "b"]);
    assert_relative_eq!(library.pushes[0].displacement, Vector2::new(-0.11, 0.0), epsilon = SMEARED_M);
    assert_relative_eq!(library.pushes[1].displacement, Vector2::new(0.0, 0.06), epsilon = SMEARED_M);
}

#[test]
fn a_demonstration_with_another_sequence_of_surfaces_is_left_out_and_named() {
    let other = Script { pushes: vec![(HEAD, 0.05), (SIDE, 0.05)], ..Script::default() };
    let all = [shown("odd", &other), shown("a", &Script::default()), shown("b", &Script::default())];
    let (library, report) = learn(&all).unwrap();
    assert_eq!(report.used, ["a", "b"]);
    let expected = ("odd".to_owned(), "pushes with head - side, not with side - head".to_owned());
    assert_eq!(report.left_out, [expected]);
    assert_eq!(library.pushes.iter().map(|push| push.surface).collect::<Vec<_>>(), [SIDE, HEAD]);
}

#[test]
fn of_two_demonstrations_that_differ_the_first_is_learned() {
    let other = Script { pushes: vec![(HEAD, 0.05)], ..Script::default() };
    let (_, report) = learn(&[shown("first", &other), shown("second", &Script::default())]).unwrap();
    assert_eq!((report.used, report.left_out[0].0.as_str()), (vec!["first".to_owned()], "second"));
}

#[test]
fn renewed_holds_are_counted_over_the_demonstrations_used() {
    let renewed = |index| Script { renewed: Some(index), ..Script::default() };
    let (_, report) =
        learn(&[shown("a", &renewed(0)), shown("b", &Script::default()), shown("c", &renewed(1))]).unwrap();
    assert_eq!(report.renewed_holds, 2);
}

#[test]
fn a_demonstration_that_holds_the_tool_turned_is_left_out() {
    let turned = Script { angle_rad: 0.4, ..Script::default() };
    let (_, report) = learn(&[shown("turned", &turned), shown("straight", &Script::default())]).unwrap();
    assert_eq!(report.used, ["straight"]);
    assert_eq!(report.left_out, [("turned".to_owned(), "holds the tool turned by 0.40 rad".to_owned())]);
}

#[test]
fn demonstrations_without_a_push_are_refused_with_their_reasons() {
    assert_eq!(learn(&[]).err(), Some(LearnError::NoPush { found: 0, reasons: String::new() }));
    let still = Script { pushes: vec![], ..Script::default() };
    let error = learn(&[shown("still", &still)]).err().unwrap();
    assert!(error.to_string().contains("found no push in 1 demonstrations (still shows no push)"), "{error}");
    // one that shows nothing does not outvote one that does
    let (_, report) = learn(&[shown("still", &still), shown("a", &Script::default())]).unwrap();
    assert_eq!((report.used, report.left_out.len()), (vec!["a".to_owned()], 1));
}

#[test]
fn a_recording_that_begins_and_ends_within_a_push_is_learned() {
    let (whole, truth) = Script { pushes: vec![(SIDE, 0.1)], ..Script::default() }.demonstration("whole");
    let (_, begin_s, end_s, _) = truth.pushes[0];
    let cut = |recording: &skills::Trajectory| {
        let inside = |time: &f64| (begin_s + 0.5..end_s - 0.5).contains(time);
        let rows: Vec<usize> = (0..recording.len()).filter(|row| inside(&recording.times_s()[*row])).collect();
        let times = rows.iter().map(|row| recording.times_s()[*row]).collect();
        skills::Trajectory::new(times, recording.samples().select_rows(&rows)).unwrap()
    };
    let middle = Demonstration::new("middle", cut(&whole.tool), cut(&whole.object)).unwrap();
    let (library, _) = learn(&[middle]).unwrap();
    assert_eq!((library.pushes.len(), library.flips.len()), (1, 2));
    // there is no way before and after: the tool is where it is
    assert!(library.flips.iter().all(|flip| flip.length_m < SMEARED_M));
}

/// Largest distance of the points of a path from the straight line between its ends, m.
fn bulge_m(path: &[Point2<f64>]) -> f64 {
    let (from, to) = (path[0], path[path.len() - 1]);
    let left = Vector2::new(from.y - to.y, to.x - from.x).normalize();
    path.iter().map(|point| (point - from).dot(&left).abs()).fold(0.0, f64::max)
}

#[test]
fn the_intention_is_freed_from_the_surface_that_was_shown() {
    let scripts =
        [0.0, 0.003, -0.003].map(|shift| Script { start: Point2::new(0.060 + shift, 0.055), ..Script::default() });
    let demonstrations: Vec<_> = scripts.iter().map(|script| shown("shown", script)).collect();
    let (library, _) = learn(&demonstrations).unwrap();
    let intention = &library.intention;
    assert_eq!((intention.shown.len(), intention.unconstrained.len()), (3, 3));
    for (shown, freed) in intention.shown.iter().zip(&intention.unconstrained) {
        // ends stay where they were shown
        let ends = [(shown[0], freed.start()), (shown[shown.len() - 1], freed.end())];
        for (shown, freed) in ends {
            assert_relative_eq!(shown.coords, Vector2::new(freed[0], freed[1]), epsilon = 1e-4);
        }
    }
    let request = RolloutRequest::new(dvector![0.06, 0.055], dvector![-0.06, 0.13], intention.duration_s, 0.01);
    let path = intention.primitive.rollout(&request).unwrap().into_positions();
    let points: Vec<_> = path.samples().row_iter().map(|row| Point2::new(row[0], row[1])).collect();
    // it keeps the corner that was shown: two legs of 120 and 75 mm lie 63 mm off the straight line at their corner
    assert_relative_eq!(bulge_m(&points), 0.12 * 0.075 / 0.12f64.hypot(0.075), max_relative = 0.05);
}

#[test]
fn a_library_read_back_from_text_moves_to_the_same_bits() {
    let (library, _) = learn(&[shown("shown", &Script::default())]).unwrap();
    let text = serde_json::to_string(&library.saved(&stick())).unwrap();
    let saved: SavedLibrary = serde_json::from_str(&text).unwrap();
    let restored = saved.clone().restore(&stick()).unwrap();
    assert_eq!(restored.saved(&stick()), saved);
    let request = RolloutRequest::new(dvector![0.0, 0.0], dvector![-0.1, 0.01], 3.0, 0.002);
    let primitives = |library: &SkillLibrary| {
        let pushes = library.pushes.iter().map(|push| push.primitive.rollout(&request).unwrap());
        let flips = library.flips.iter().map(|flip| flip.primitive.rollout(&request).unwrap());
        pushes.chain(flips).chain([library.intention.primitive.rollout(&request).unwrap()]).collect::<Vec<_>>()
    };
    assert_eq!(primitives(&restored), primitives(&library));
}

#[test]
fn saved_skills_that_cannot_be_are_refused_by_field() {
    let (library, _) = learn(&[shown("shown", &Script::default())]).unwrap();
    let refused = |change: &dyn Fn(&mut SavedLibrary)| {
        let mut saved = library.saved(&stick());
        change(&mut saved);
        saved.restore(&stick()).err().unwrap().to_string()
    };
    assert!(refused(&|saved| saved.pushes[0].surface = "sied".into()).contains("pushes.0.surface: found \"sied\""));
    assert!(refused(&|saved| saved.flips.truncate(1)).contains("flips: found 1 ways; expected 3"));
    assert!(refused(&|saved| saved.pushes[1].duration_s = f64::NAN).contains("pushes.1.duration_s"));
    let damaged = refused(&|saved| match &mut saved.pushes[0].path {
        SavedPrimitive::Dmp(dmp) => dmp.weights[3][1] = f64::INFINITY,
        other => panic!("{other:?}"),
    });
    assert!(damaged.contains("pushes.0.path") && damaged.contains("weights[3]"), "{damaged}");
}
