//! The framework takes other kinds of primitive too: skills learned and plans made with each of them.

use skills::PrimitiveConfig;
use skills::primitive::generalizing::GeneralizingConfig;
use skills::primitive::kernelized::KernelizedConfig;
use skills::tool_use::SkillLibrary;

use crate::planning::{EXACT_M, assert_clear, assert_near, assert_sound, names, problems, pushes};
use crate::shown::{Script, disc, stick};

/// Error of the fit to a straight push, m.
const FIT_M: f64 = 0.0002;

fn kinds() -> [PrimitiveConfig; 2] {
    [
        PrimitiveConfig::Kernelized(KernelizedConfig::default()),
        PrimitiveConfig::Generalizing(GeneralizingConfig::default()),
    ]
}

fn learn(kind: &PrimitiveConfig, scripts: &[Script]) -> SkillLibrary {
    let shown: Vec<_> = scripts.iter().map(|script| script.demonstration("shown").0).collect();
    SkillLibrary::learn(kind, &shown, &stick(), &disc()).unwrap().0
}

#[test]
fn every_kind_learns_and_plans_all_tasks_soundly() {
    let noisy = Script { noise_m: 0.0005, ..Script::default() };
    let slow = Script { pause_s: 1.5, renewed: Some(0), ..noisy.clone() };
    for kind in kinds() {
        for scripts in [vec![Script::default()], vec![noisy.clone(), slow.clone()]] {
            let library = learn(&kind, &scripts);
            for problem in problems() {
                let plan = problem.plan(&library).unwrap();
                assert_eq!(names(&plan), ["approach side", "push side", "flip to head", "push head", "withdraw"]);
                assert_sound(&problem, &plan);
                assert_clear(&plan);
                assert_near(plan.actions().last().unwrap().object.end().point(), problem.goal_world, EXACT_M);
            }
        }
    }
}

#[test]
fn every_kind_plans_a_straight_push_that_was_shown_straight() {
    for kind in kinds() {
        let library = learn(&kind, &[Script::default()]);
        for problem in problems() {
            let plan = problem.plan(&library).unwrap();
            for (action, push) in pushes(&plan) {
                let along = push.direction_world().unwrap();
                let aside = action.object.motions().iter().map(|at| (at.point() - push.from_world).perp(&along).abs());
                assert!(aside.fold(0.0, f64::max) < FIT_M);
            }
        }
    }
}
