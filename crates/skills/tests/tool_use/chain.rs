//! Plans of the pipeline verified as strict chains: continuity, contact, rest and clearance, with their margins.

use nalgebra::Vector3;
use skills::DmpForm;
use skills::outline::{Outline, PlacedOutline};
use skills::plan::{
    Action, Body, ChainError, ChainReport, ChainTolerances, Condition, Moment, Plan, Quantity, Setting, Track,
};
use skills::tool_use::{PushProblem, SkillLibrary};

use crate::planning::{DISC, EXACT_M, ONE, SEVERAL, STICK, learn, problem, problems, pushes};
use crate::shown::{HEAD, Script};

fn setting() -> Setting<'static> {
    Setting { tool: &STICK, object: &DISC, obstacles: &[] }
}

fn verified(plan: &Plan) -> ChainReport {
    plan.verify(Some(&setting()), &ChainTolerances::default()).unwrap()
}

fn refused(plan: &Plan) -> ChainError {
    plan.verify(Some(&setting()), &ChainTolerances::default()).unwrap_err()
}

/// A plan with one action changed.
fn changed(index: usize, change: impl Fn(&mut Action)) -> Plan {
    let mut actions = problem().plan(&ONE).unwrap().actions().to_vec();
    change(&mut actions[index]);
    Plan::new(actions).unwrap()
}

/// A track with its motions changed by row.
fn moved(track: &Track, change: impl Fn(usize, &mut Vector3<f64>)) -> Track {
    let mut motions = track.motions().to_vec();
    motions.iter_mut().enumerate().for_each(|(row, motion)| change(row, &mut motion.position));
    Track::new(track.time_step_s(), motions).unwrap()
}

/// Task whose push to the left is six times shorter than the one that was shown, and the push forward half as long.
const SHORT: [usize; 2] = [2, 3];

fn plan(library: &SkillLibrary, task: usize) -> Plan {
    problems()[task].plan(library).unwrap()
}

#[test]
fn plans_of_the_pipeline_are_strict_chains() {
    for plan in [&*ONE, &*SEVERAL].into_iter().flat_map(|library| (0..problems().len()).map(|task| plan(library, task)))
    {
        let report = verified(&plan);
        assert_eq!((report.joints.len(), report.actions.len()), (4, 5));
        for joint in &report.joints {
            // places and velocities meet to rounding, far below the tolerances
            for jump in [joint.tool, joint.object] {
                assert!(jump.position_m < EXACT_M && jump.velocity_m_per_s < EXACT_M);
                assert!(jump.angle_rad < EXACT_M && jump.angular_velocity_rad_per_s < EXACT_M);
            }
        }
        assert!(report.violations().next().is_none());
    }
}

#[test]
fn a_push_much_shorter_than_shown_leads_the_object_on_and_never_back() {
    for (library, task) in [&*ONE, &*SEVERAL].into_iter().flat_map(|library| SHORT.map(|task| (library, task))) {
        let plan = plan(library, task);
        verified(&plan);
        for (action, push) in pushes(&plan) {
            let along = push.direction_world().unwrap();
            let speeds = || action.object.motions().iter().map(|motion| motion.velocity.xy().dot(&along));
            let (least, most) = (speeds().fold(f64::INFINITY, f64::min), speeds().fold(0.0, f64::max));
            // a fit to a motion that begins at rest swings by a few hundredths
            assert!(least > -0.05 * most, "{}: {least} of {most} m/s", action.name);
        }
    }
}

#[test]
fn the_printed_primitive_leads_the_tool_through_the_object_where_the_goal_is_another_one() {
    let error = refused(&problem().plan(&learn(DmpForm::Eq1Literal, &[Script::default()])).unwrap());
    let ChainError::Condition { action, check } = &error else { panic!("{error}") };
    assert_eq!((action.as_str(), &check.condition), ("withdraw", &Condition::ToolClearOfObject));
    // its forcing term is that of the demonstrated goal
    assert!(check.found > 0.001, "{error}");
}

#[test]
fn the_report_tells_how_far_a_plan_is_from_its_limits() {
    let report = verified(&problem().plan(&ONE).unwrap());
    let push = &report.actions[1];
    let check = |condition, moment| {
        push.checks.iter().find(|check| check.condition == condition && check.moment == moment).unwrap()
    };
    // an approach leaves 1 mm, the push closes it; the middle of a face of 10 mm is 5 mm from its ends
    let contact = || Condition::InContact("side".into());
    assert!((check(contact(), Moment::Start).found - 0.001).abs() < EXACT_M);
    assert!(check(contact(), Moment::End).found.abs() < EXACT_M);
    let on_surface = check(Condition::OnSurface("side".into()), Moment::End);
    assert!((on_surface.found + 0.005).abs() < EXACT_M && (on_surface.margin() - 0.0051).abs() < EXACT_M);
    assert!((push.begins_s - report.actions[0].duration_s).abs() < EXACT_M);
    // an action is joined with the acceleration of its own beginning: the chain is C1, not C2
    assert!((0.01..1.0).contains(&report.largest_acceleration_jump_m_per_s2()));
    // without a setting there is no geometry
    let blind = problem().plan(&ONE).unwrap().verify(None, &ChainTolerances::default()).unwrap();
    assert_eq!(blind.actions[1].checks.len(), 6);
}

#[test]
fn a_gap_wider_than_accepted_is_refused_at_the_start_of_the_push() {
    let tolerances = ChainTolerances { gap_m: 0.0005, ..ChainTolerances::default() };
    let plan = problem().plan(&ONE).unwrap();
    let error = plan.verify(Some(&setting()), &tolerances).unwrap_err();
    let ChainError::Condition { action, check } = &error else { panic!("{error}") };
    assert_eq!((action.as_str(), check.moment), ("approach side", Moment::End));
    assert!(error.to_string().contains("the gap between the surface 'side' and the object is 0.001"), "{error}");
}

#[test]
fn an_object_that_drifts_while_the_hold_changes_is_refused() {
    // to a millimeter and back, as slowly as the object's track can tell
    let drift = |action: &mut Action| {
        let rows = action.object.motions().len();
        action.object = moved(&action.object, |row, place| {
            place.x += 1e-3 * (std::f64::consts::PI * row as f64 / (rows - 1) as f64).sin().powi(2);
        });
    };
    let error = refused(&changed(2, drift));
    assert!(
        matches!(&error, ChainError::Condition { action, check }
            if action == "flip to head" && check.condition == Condition::ObjectStays),
        "{error}"
    );
}

#[test]
fn velocities_that_do_not_meet_are_refused_by_body_quantity_and_names() {
    let plan = changed(1, |action| {
        let mut motions = action.tool.motions().to_vec();
        let last = motions.len() - 1;
        motions[last].velocity.x = 0.002;
        action.tool = Track::new(action.tool.time_step_s(), motions).unwrap();
    });
    let error = refused(&plan);
    let ChainError::Joint { before, after, body, quantity, found, .. } = &error else { panic!("{error}") };
    assert_eq!((before.as_str(), after.as_str()), ("push side", "flip to head"));
    assert_eq!((*body, *quantity), (Body::Tool, Quantity::Velocity));
    assert!((found - 0.002).abs() < EXACT_M && error.to_string().contains("m/s from 'push side'"), "{error}");
}

#[test]
fn a_jump_inside_an_action_is_refused_where_it_is() {
    let plan = changed(3, |action| {
        action.object = moved(&action.object, |row, place| {
            if row == 100 {
                place.y += 2e-4
            }
        })
    });
    let ChainError::Inside { action, time_s, body, quantity, .. } = refused(&plan) else { panic!("a jump") };
    assert_eq!((action.as_str(), body, quantity), ("push head", Body::Object, Quantity::Position));
    let begins_s: f64 = plan.actions().iter().take(3).map(|action| action.tool.duration_s()).sum();
    assert!((time_s - begins_s - 0.2).abs() < EXACT_M);
}

#[test]
fn another_tool_an_obstacle_and_bad_numbers_are_refused() {
    let plan = problem().plan(&ONE).unwrap();
    let tolerances = ChainTolerances::default();
    let mut short = STICK.clone();
    short.surfaces.truncate(1);
    let error = plan.verify(Some(&Setting { tool: &short, ..setting() }), &tolerances).unwrap_err();
    assert!(matches!(error, ChainError::Surface { surface: HEAD, surfaces: 1, .. }), "{error}");
    let obstacles = [PlacedOutline {
        shape: Outline::Box { width_m: 0.01, height_m: 0.01 },
        position_m: [0.0, 0.05],
        angle_rad: 0.3,
    }];
    let error = plan.verify(Some(&Setting { obstacles: &obstacles, ..setting() }), &tolerances).unwrap_err();
    assert!(
        matches!(&error, ChainError::Condition { action, check }
            if action == "push side" && check.condition == Condition::ObjectClearOfObstacles
                || check.condition == Condition::ToolClearOfObstacles),
        "{error}"
    );
    let bad = ChainTolerances { gap_m: -1.0, ..tolerances };
    assert!(matches!(plan.verify(None, &bad), Err(ChainError::Skill(_))));
}

#[test]
fn actions_on_other_grids_or_without_duration_are_refused() {
    let fine = problem().plan(&ONE).unwrap();
    let coarse = PushProblem { time_step_s: 0.004, ..problem() }.plan(&ONE).unwrap();
    let mixed: Vec<_> = fine.actions().iter().take(2).chain(coarse.actions().iter().skip(2)).cloned().collect();
    assert!(matches!(refused(&Plan::new(mixed).unwrap()), ChainError::Grid { found_s: 0.004, expected_s: 0.002, .. }));
    let mut actions = fine.actions().to_vec();
    let still = |track: &Track| Track::new(track.time_step_s(), vec![track.end()]).unwrap();
    let end = actions.last().unwrap().clone();
    actions.push(Action { name: "wait".into(), tool: still(&end.tool), object: still(&end.object), ..end });
    assert!(matches!(refused(&Plan::new(actions).unwrap()), ChainError::NoDuration { action } if action == "wait"));
}

#[test]
fn an_action_that_is_slowed_keeps_its_way_and_the_chain_strict() {
    let plan = problem().plan(&ONE).unwrap();
    for (index, factor) in [(1, 2.0), (2, 1.37), (4, 0.8)] {
        let slowed = plan.retimed(index, factor).unwrap();
        verified(&slowed);
        let (before, after) = (&plan.actions()[index], &slowed.actions()[index]);
        assert!((after.tool.duration_s() / before.tool.duration_s() - factor).abs() < 1e-3);
        let k = after.tool.duration_s() / before.tool.duration_s();
        for share in [0.2, 0.5, 0.9] {
            let time_s = share * before.tool.duration_s();
            let (early, late) = (before.tool.at(time_s), after.tool.at(time_s * k));
            // cubic interpolation on a grid of 2 ms
            assert!((early.position - late.position).norm() < 1e-8);
            assert!((early.velocity / k - late.velocity).norm() < 1e-5);
        }
        let others = |plan: &Plan| plan.duration_s() - plan.actions()[index].tool.duration_s();
        assert!((others(&plan) - others(&slowed)).abs() < EXACT_M);
    }
    for (index, factor) in [(9, 2.0), (1, 0.0), (1, f64::NAN)] {
        assert!(plan.retimed(index, factor).is_err());
    }
}
