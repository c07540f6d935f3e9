//! Plans made with learned skills: where they lead, when, how smoothly, and at what distance from the object.

use std::sync::LazyLock;

use approx::assert_relative_eq;
use nalgebra::Point2;
use skills::outline::Outline;
use skills::plan::{Action, ActionKind, Plan, Push, Track};
use skills::tool::Tool;
use skills::tool_use::{Orientation, PushProblem, SkillLibrary};
use skills::{DmpConfig, DmpForm, PrimitiveConfig};

use crate::shown::{HEAD, RADIUS_M, SIDE, Script, disc, stick};

/// Plans meet their places to rounding; a nanometer is far below what a robot can do.
pub const EXACT_M: f64 = 1e-9;
/// Gap that an approach leaves, m.
const APPROACH_GAP_M: f64 = 0.001;
/// What is shorter is no push, m: a goal may be missed by as much.
pub const SHORTEST_PUSH_M: f64 = 0.002;
/// A learned way may cut this deep into the object, m: it begins or ends in touch and is bent to another start and goal.
const CUT_M: f64 = 0.0005;
/// Error of the fit to a straight push, m.
const FIT_M: f64 = 0.0002;

pub static STICK: LazyLock<Tool> = LazyLock::new(stick);
pub static DISC: LazyLock<Outline> = LazyLock::new(disc);
/// Learned from one demonstration without any error.
pub static ONE: LazyLock<SkillLibrary> = LazyLock::new(|| learn(DmpForm::Residual, &[Script::default()]));
/// Learned from several that differ and err.
pub static SEVERAL: LazyLock<SkillLibrary> = LazyLock::new(|| {
    let noisy = Script { noise_m: 0.0005, ..Script::default() };
    let slow = Script { pause_s: 1.5, renewed: Some(0), ..noisy.clone() };
    let far = Script { home: Point2::new(0.11, 0.0), pushes: vec![(SIDE, 0.10), (HEAD, 0.09)], ..noisy.clone() };
    learn(DmpForm::Residual, &[noisy, slow, far])
});

pub fn learn(form: DmpForm, scripts: &[Script]) -> SkillLibrary {
    let shown: Vec<_> = scripts.iter().map(|script| script.demonstration("shown").0).collect();
    let primitive = PrimitiveConfig::Dmp(DmpConfig { form, ..DmpConfig::default() });
    SkillLibrary::learn(&primitive, &shown, &STICK, &DISC).unwrap().0
}

pub fn problem() -> PushProblem<'static> {
    PushProblem {
        start_world: Point2::new(0.065, 0.050),
        goal_world: Point2::new(-0.055, 0.125),
        home_world: Point2::new(0.100, 0.010),
        park_world: Point2::new(-0.060, 0.020),
        object: &DISC,
        tool: &STICK,
        orientation: Orientation::Fixed,
        push_speed_m_per_s: 0.02,
        free_speed_m_per_s: 0.08,
        time_step_s: 0.002,
    }
}

/// Tasks that the skills are generalized to.
pub fn problems() -> Vec<PushProblem<'static>> {
    let to = |start: [f64; 2], goal: [f64; 2]| PushProblem {
        start_world: start.into(),
        goal_world: goal.into(),
        ..problem()
    };
    vec![
        problem(),
        to([0.060, 0.055], [-0.060, 0.130]),
        to([0.030, 0.080], [0.010, 0.150]),
        to([0.070, 0.030], [-0.090, 0.060]),
        PushProblem { orientation: Orientation::WithTask, ..problem() },
    ]
}

pub fn pushes(plan: &Plan) -> Vec<(&Action, Push)> {
    let push = |action| match action {
        action @ &Action { kind: ActionKind::ObjectOperating(push), .. } => Some((action, push)),
        _ => None,
    };
    plan.actions().iter().filter_map(push).collect()
}

pub fn names(plan: &Plan) -> Vec<&str> {
    plan.actions().iter().map(|action| action.name.as_str()).collect()
}

pub fn assert_near(found: Point2<f64>, expected: Point2<f64>, tolerance_m: f64) {
    assert!((found - expected).norm() <= tolerance_m, "{found}, expected {expected}");
}

/// Checks that the tool stays out of the object on the ways between pushes.
pub fn assert_clear(plan: &Plan) {
    for way in plan.actions().iter().filter(|action| action.kind == ActionKind::ToolFlipping) {
        for (row, (tool, object)) in way.tool.motions().iter().zip(way.object.motions()).enumerate() {
            let gap_m = STICK.signed_distance_m(&tool.pose().inverse_transform_point(&object.point())) - RADIUS_M;
            let of = way.tool.motions().len();
            assert!(
                gap_m > -CUT_M,
                "{gap_m} m at motion {row} of {of} in '{}' at {}",
                way.name,
                tool.point() - object.point()
            );
        }
    }
}

/// Checks what holds for every plan: ends, holds, joints, rests and finite numbers.
pub fn assert_sound(problem: &PushProblem<'_>, plan: &Plan) {
    let (first, last) = (&plan.actions()[0], plan.actions().last().unwrap());
    assert_near(first.tool.start().point(), problem.home_world, EXACT_M);
    assert_near(first.object.start().point(), problem.start_world, EXACT_M);
    assert_near(last.tool.end().point(), problem.park_world, EXACT_M);
    for pair in plan.actions().windows(2) {
        for (end, start) in [(pair[0].tool.end(), pair[1].tool.start()), (pair[0].object.end(), pair[1].object.start())]
        {
            assert!((end.position - start.position).norm() < EXACT_M);
            assert!(end.velocity.norm() + start.velocity.norm() < EXACT_M, "an action begins and ends at rest");
        }
    }
    for (action, push) in pushes(plan) {
        assert!((push.to_world - push.from_world).norm() >= SHORTEST_PUSH_M);
        let contact = problem.tool.surfaces[push.surface].middle();
        for (tool, object, center, gap_m) in [
            (action.tool.start(), action.object.start(), push.from_world, APPROACH_GAP_M),
            (action.tool.end(), action.object.end(), push.to_world, 0.0),
        ] {
            assert_near(object.point(), center, EXACT_M);
            let held = contact.point + contact.normal.into_inner() * (RADIUS_M + gap_m);
            assert_near(tool.pose() * held, center, EXACT_M);
        }
    }
}

#[test]
fn a_plan_begins_at_home_holds_the_object_at_both_ends_of_each_push_and_ends_at_park() {
    for library in [&*ONE, &*SEVERAL] {
        for problem in problems() {
            let plan = problem.plan(library).unwrap();
            assert_eq!(names(&plan), ["approach side", "push side", "flip to head", "push head", "withdraw"]);
            assert_sound(&problem, &plan);
        }
    }
}

#[test]
fn the_object_is_brought_from_its_start_to_its_goal_exactly() {
    for library in [&*ONE, &*SEVERAL] {
        for problem in problems() {
            let plan = problem.plan(library).unwrap();
            assert_near(plan.actions()[0].object.start().point(), problem.start_world, EXACT_M);
            assert_near(plan.actions().last().unwrap().object.end().point(), problem.goal_world, EXACT_M);
        }
    }
}

#[test]
fn a_straight_push_that_was_shown_is_planned_straight() {
    for problem in problems() {
        let plan = problem.plan(&ONE).unwrap();
        for (action, push) in pushes(&plan) {
            let along = push.direction_world().unwrap();
            let aside = action.object.motions().iter().map(|at| (at.point() - push.from_world).perp(&along).abs());
            assert!(aside.fold(0.0, f64::max) < FIT_M);
        }
    }
}

#[test]
fn velocities_and_accelerations_are_the_slopes_of_the_places() {
    for problem in problems() {
        for action in problem.plan(&SEVERAL).unwrap().actions() {
            assert_slopes(&action.tool);
            assert_slopes(&action.object);
        }
    }
}

/// A central difference over steps h errs by h²/6 of the third derivative, which the accelerations tell.
fn assert_slopes(track: &Track) {
    let (motions, h) = (track.motions(), track.time_step_s());
    let jerk = motions.windows(2).map(|pair| (pair[1].acceleration - pair[0].acceleration).norm() / h);
    let jerk = jerk.fold(0.0, f64::max);
    for three in motions.windows(3) {
        let velocity = (three[2].position - three[0].position) / (2.0 * h);
        assert!((velocity - three[1].velocity).norm() <= h * h / 6.0 * jerk + EXACT_M);
        let acceleration = (three[2].velocity - three[0].velocity) / (2.0 * h);
        // the trapezoid between two accelerations may miss half of their difference
        assert!((acceleration - three[1].acceleration).norm() <= 0.5 * h * jerk + EXACT_M);
    }
}

#[test]
fn the_tool_keeps_clear_of_the_object_between_pushes() {
    for library in [&*ONE, &*SEVERAL] {
        for problem in problems() {
            let plan = problem.plan(library).unwrap();
            assert_clear(&plan);
        }
    }
}

#[test]
fn durations_follow_the_requested_speeds() {
    for (push, free) in [(0.02, 0.08), (0.005, 0.3), (0.1, 0.02)] {
        let problem = PushProblem { push_speed_m_per_s: push, free_speed_m_per_s: free, ..problem() };
        let plan = problem.plan(&ONE).unwrap();
        let mut flips = ONE.flips.iter();
        for action in plan.actions() {
            let length = match action.kind {
                ActionKind::ObjectOperating(push) => {
                    (push.to_world - push.from_world).norm() / problem.push_speed_m_per_s
                }
                ActionKind::ToolFlipping => flips.next().unwrap().length_m / problem.free_speed_m_per_s,
            };
            // up to the next step
            let late_s = action.tool.duration_s() - length;
            assert!((-1e-6..problem.time_step_s).contains(&late_s), "{} {late_s}", action.name);
            assert_relative_eq!(action.tool.duration_s(), action.object.duration_s());
        }
        let total: f64 = plan.actions().iter().map(|action| action.tool.duration_s()).sum();
        assert_relative_eq!(plan.duration_s(), total, epsilon = EXACT_M);
    }
}

#[test]
fn a_time_step_that_divides_no_duration_leaves_the_plan_sound() {
    for time_step_s in [0.0017, 0.013, 0.3] {
        let problem = PushProblem { time_step_s, ..problem() };
        let plan = problem.plan(&ONE).unwrap();
        assert_sound(&problem, &plan);
        plan.actions().iter().for_each(|action| assert_slopes(&action.tool));
    }
}

#[test]
fn plans_by_the_printed_primitive_are_as_exact() {
    let library = learn(DmpForm::Eq1Literal, &[Script::default()]);
    for problem in problems() {
        let plan = problem.plan(&library).unwrap();
        assert_sound(&problem, &plan);
        assert_near(plan.actions().last().unwrap().object.end().point(), problem.goal_world, EXACT_M);
    }
}
