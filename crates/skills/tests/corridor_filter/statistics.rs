//! Rates of violation in 300 random corridors per class.
//!
//! The generator of the study that these rates were first measured in is not available. The amplitude of the skills
//! here is chosen so that an unfiltered skill violates about as often as there: .150, .767, .870 in constant, slow and
//! fast corridors. Nothing else is fitted; what the laws do then is compared.

use nalgebra::dvector;
use skills::corridor_filter::{
    Certificate, CorridorFilterConfig, Ecbf, EcbfForm, FilterError, Integration, Logit, OriginalReconstruction,
    Published, TheoremOne, certify,
};

use crate::cases::{Case, Class, DURATION_S, run};

const COUNT: u64 = 300;
/// Class, amplitude of its skills, rate of violation of an unfiltered skill in the first study.
const CLASSES: [(Class, f64, f64); 3] =
    [(Class::Constant, 0.575, 0.150), (Class::Slow, 0.68, 0.767), (Class::Fast, 0.7, 0.870)];
const STEPS_S: [f64; 3] = [0.001, 0.01, 0.05];
/// How far rates of another generator may lie off, three percentage points.
const RATE: f64 = 0.03;

fn cases(class: usize) -> impl Iterator<Item = Case> {
    let (class, amplitude, _) = CLASSES[class];
    (0..COUNT).map(move |number| Case::random(class, amplitude, number))
}

fn unfiltered(case: &Case, step: f64) -> Certificate {
    let (skill, corridor) = case.sampled(step, DURATION_S);
    certify(&skill, &corridor, &dvector![1.0]).unwrap()
}

/// Part of the cases of a class that a law leaves at a sample or diverges in.
fn rate(law: &CorridorFilterConfig, class: usize, step: f64, end_s: f64) -> f64 {
    let leaves = |case: &Case| {
        let (skill, corridor) = case.sampled(step, end_s);
        match run(law, &skill, &corridor, 1.0) {
            Ok(found) => !found.certificate.holds_at_samples(),
            Err(FilterError::Diverged { .. }) => true,
            Err(error) => panic!("{error}"),
        }
    };
    cases(class).filter(leaves).count() as f64 / COUNT as f64
}

fn rates(law: &CorridorFilterConfig, step: f64, end_s: f64) -> [f64; 3] {
    [0, 1, 2].map(|class| rate(law, class, step, end_s))
}

#[test]
fn an_unfiltered_skill_violates_as_often_as_it_was_calibrated_to() {
    for (class, (_, _, expected)) in CLASSES.into_iter().enumerate() {
        let outside = cases(class).filter(|case| !unfiltered(case, 0.005).holds_at_samples()).count();
        let found = outside as f64 / COUNT as f64;
        assert!((found - expected).abs() <= 0.01, "{class}: {found}");
    }
}

#[test]
fn the_default_filter_never_leaves_and_meets_the_goal_exactly() {
    for step in STEPS_S {
        for class in 0..CLASSES.len() {
            for (number, case) in cases(class).enumerate() {
                let (skill, corridor) = case.sampled(step, DURATION_S);
                let found = run(&CorridorFilterConfig::default(), &skill, &corridor, 1.0).unwrap().certificate;
                assert!(found.holds_at_samples(), "class {class}, case {number}, step {step}");
                assert_eq!(found.goal_error(), 0.0, "class {class}, case {number}, step {step}");
                // a step of a twentieth of the motion is too coarse for the interpolation of fast bounds
                assert!(step > 0.02 || found.holds(), "class {class}, case {number}, step {step}");
            }
        }
    }
}

#[test]
fn the_published_law_leaves_about_as_often_as_an_unfiltered_skill() {
    let found = rates(&CorridorFilterConfig::Published(Published::default()), 0.01, 3.0 * DURATION_S);
    for (found, expected) in found.into_iter().zip([0.143, 0.760, 0.867]) {
        assert!((found - expected).abs() <= RATE, "{found} for {expected}");
    }
}

#[test]
fn the_published_law_leaves_about_as_often_with_a_smaller_weight_and_always_where_it_is_stiff_for_its_steps() {
    let light = CorridorFilterConfig::Published(Published { k_n: 0.1, ..Published::default() });
    for (found, expected) in rates(&light, 0.01, 3.0 * DURATION_S).into_iter().zip([0.177, 0.730, 0.857]) {
        assert!((found - expected).abs() <= RATE, "{found} for {expected}");
    }
    let stiff = CorridorFilterConfig::Published(Published { k_z: 100.0, ..Published::default() });
    assert_eq!(rates(&stiff, 0.05, 3.0 * DURATION_S), [1.0; 3]);
}

#[test]
fn the_published_law_breaks_skills_that_were_safe() {
    let law = CorridorFilterConfig::Published(Published { k_n: 0.1, ..Published::default() });
    let breaks = |case: &&Case| {
        let (skill, corridor) = case.sampled(0.01, 3.0 * DURATION_S);
        let safe = certify(&skill, &corridor, &dvector![1.0]).unwrap().holds();
        safe && !run(&law, &skill, &corridor, 1.0).unwrap().certificate.holds_at_samples()
    };
    let broken: Vec<Case> = {
        let all: Vec<Case> = (0..CLASSES.len()).flat_map(cases).collect();
        all.iter().filter(breaks).cloned().collect()
    };
    assert!(!broken.is_empty());
    for case in broken {
        let (skill, corridor) = case.sampled(0.01, 3.0 * DURATION_S);
        assert!(run(&CorridorFilterConfig::default(), &skill, &corridor, 1.0).unwrap().certificate.holds());
    }
}

#[test]
fn laws_with_a_guarantee_at_samples_never_leave() {
    let laws = [
        CorridorFilterConfig::Logit(Logit { feed_forward: false, alpha: 50.0, ..Logit::default() }),
        CorridorFilterConfig::Logit(Logit { margin: 0.15, ..Logit::default() }),
        CorridorFilterConfig::TheoremOne(TheoremOne::default()),
        CorridorFilterConfig::Ecbf(Ecbf::default()),
    ];
    for law in laws {
        for step in [0.01, 0.05] {
            assert_eq!(rates(&law, step, DURATION_S), [0.0; 3], "{law:?}, step {step}");
        }
    }
}

#[test]
fn explicit_laws_keep_inside_at_short_steps_and_leave_at_long_ones() {
    let theorem = TheoremOne { integration: Integration::Explicit, ..TheoremOne::default() };
    let original = CorridorFilterConfig::OriginalReconstruction(OriginalReconstruction::default());
    let plain = CorridorFilterConfig::Ecbf(Ecbf { form: EcbfForm::Plain, ..Ecbf::default() });
    for law in [CorridorFilterConfig::TheoremOne(theorem), original.clone()] {
        assert_eq!(rates(&law, 0.002, DURATION_S), [0.0; 3], "{law:?}");
        assert!(rate(&law, 2, 0.05, DURATION_S) > 0.0, "{law:?}");
    }
    // a start in motion along a fast bound violates ψ ≥ 0 at any step
    assert!(rate(&plain, 2, 0.001, DURATION_S) < 0.05);
    assert!(rate(&plain, 2, 0.05, DURATION_S) > 0.5);
    assert!(rate(&original, 2, 0.05, DURATION_S) > 0.5);
}

#[test]
fn a_smaller_margin_stays_with_the_skill_longer_and_accelerates_more() {
    let medians = |law: CorridorFilterConfig| {
        let peak = |case: Case| {
            let (skill, corridor) = case.sampled(0.005, DURATION_S);
            run(&law, &skill, &corridor, 1.0).unwrap().certificate.peak_acceleration()
        };
        let mut peaks: Vec<f64> = cases(1).map(peak).collect();
        peaks.sort_by(f64::total_cmp);
        peaks[peaks.len() / 2]
    };
    let wide = medians(CorridorFilterConfig::default());
    let narrow = medians(CorridorFilterConfig::Logit(Logit { margin: 0.15, ..Logit::default() }));
    let barrier = medians(CorridorFilterConfig::Ecbf(Ecbf::default()));
    assert!(narrow > 1.3 * wide && wide > 1.3 * barrier, "{narrow} {wide} {barrier}");
}
