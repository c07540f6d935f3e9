//! What holds for every filter, or for the default filter in every corridor.

use nalgebra::{DMatrix, DVector, dvector};
use proptest::prelude::*;
use skills::corridor::{Bounds, Corridor};
use skills::corridor_filter::{
    AxisFilter, AxisSample, AxisTask, CorridorFilterConfig, Ecbf, FilterError, FilterRequest, Logit,
    OriginalReconstruction, Published, TheoremOne, constrain,
};
use skills::time_law::PathState;
use skills::{Rollout, SkillError, Trajectory};

use crate::cases::{Case, Class, run, skill, still, transfer};

fn every_kind() -> [CorridorFilterConfig; 6] {
    [
        CorridorFilterConfig::default(),
        CorridorFilterConfig::Logit(Logit { feed_forward: false, ..Logit::default() }),
        CorridorFilterConfig::Published(Published::default()),
        CorridorFilterConfig::OriginalReconstruction(OriginalReconstruction::default()),
        CorridorFilterConfig::TheoremOne(TheoremOne::default()),
        CorridorFilterConfig::Ecbf(Ecbf::default()),
    ]
}

fn case() -> impl Strategy<Value = Case> {
    let class = prop_oneof![Just(Class::Constant), Just(Class::Slow), Just(Class::Fast)];
    (class, 0.0..2.0f64, any::<u64>()).prop_map(|(class, amplitude, number)| Case::random(class, amplitude, number))
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(200))]

    #[test]
    fn the_default_filter_stays_inside_whatever_the_step_and_is_the_skill_well_inside(
        case in case(), step in 0.0005..0.5f64, margin in 0.05..0.45f64,
    ) {
        let (skill, corridor) = case.sampled(step, 1.5);
        let law = CorridorFilterConfig::Logit(Logit { margin, ..Logit::default() });
        let found = run(&law, &skill, &corridor, 1.0).unwrap();
        prop_assert!(found.certificate.holds_at_samples());
        prop_assert!(found.certificate.goal_error() < 1e-12 || skill.positions().end_time_s() < 1.0);
        for (row, time_s) in skill.positions().times_s().iter().enumerate() {
            let sample = AxisSample { skill: still(skill.positions().samples()[(row, 0)]), bounds: corridor.at(*time_s, 0) };
            if (margin..=1.0 - margin).contains(&sample.place().position) {
                prop_assert_eq!(found.rollout.positions().samples()[(row, 0)], sample.skill.position);
            }
        }
    }

    #[test]
    fn short_steps_of_the_default_filter_are_certified_between_the_samples(case in case(), step in 0.0005..0.003f64) {
        let (skill, corridor) = case.sampled(step, 1.2);
        prop_assert!(run(&CorridorFilterConfig::default(), &skill, &corridor, 1.0).unwrap().certificate.holds());
    }

    #[test]
    fn a_certificate_that_holds_is_true_of_a_dense_scan(case in case(), step in 0.01..0.2f64, kind in 0usize..6) {
        let (skill, corridor) = case.sampled(step, 1.2);
        let Ok(found) = run(&every_kind()[kind], &skill, &corridor, 1.0) else { return Ok(()) };
        let certified = found.certificate.smallest_margin();
        // a finer motion through the same samples: the quintic of a corridor is that of the certificate
        let motion = &found.rollout;
        let as_corridor = Corridor::sampled(motion.positions().times_s().to_vec(), 1, |t, _| {
            let row = motion.positions().times_s().iter().position(|time| *time == t).unwrap();
            let lower = PathState {
                position: motion.positions().samples()[(row, 0)],
                first: motion.velocities()[(row, 0)],
                second: motion.accelerations()[(row, 0)],
            };
            Bounds { lower, upper: PathState { position: lower.position + 1.0, ..lower } }
        }).unwrap();
        let end_s = motion.positions().end_time_s();
        let margin = |k: u32| {
            let t = end_s * f64::from(k) / 5000.0;
            corridor.at(t, 0).margin(as_corridor.at(t, 0).lower.position)
        };
        let scanned = (0..=5000).map(margin).fold(f64::INFINITY, f64::min);
        let size = 1.0 + scanned.abs();
        prop_assert!(certified <= scanned + 1e-9 * size, "{certified} {scanned}");
        prop_assert!(scanned - certified <= 1e-2 * size, "{certified} {scanned}");
    }
}

#[test]
fn stepping_an_axis_gives_the_bits_of_constraining_the_whole_and_allocates_nothing() {
    let case = Case::random(Class::Slow, 0.7, 7);
    let (skill, corridor) = case.sampled(0.01, 1.0);
    for law in every_kind() {
        let whole = run(&law, &skill, &corridor, 1.0).unwrap();
        let sample = |row: usize| {
            let at = (row, 0);
            let (position, first) = (skill.positions().samples()[at], skill.velocities()[at]);
            let skill_state = PathState { position, first, second: skill.accelerations()[at] };
            AxisSample { skill: skill_state, bounds: corridor.at(skill.positions().times_s()[row], 0) }
        };
        let goal_bounds = corridor.at(1.0, 0);
        let task = AxisTask { coordinate: 0, start: sample(0).skill.position, goal: 1.0, goal_bounds, duration_s: 1.0 };
        let mut axis = AxisFilter::begin(&law, &task, &sample(0)).unwrap();
        let times = skill.positions().times_s();
        for row in 1..times.len() {
            let (to, step) = (sample(row), times[row] - times[row - 1]);
            let mut stepped = None;
            let count = allocation_counter::measure(|| stepped = Some(axis.step(&to, step)));
            assert_eq!(count.count_total, 0, "{}", law.name());
            assert_eq!(stepped.unwrap().unwrap().position, whole.rollout.positions().samples()[(row, 0)]);
        }
        let terms =
            whole.additional_term(&skill, &FilterRequest { start: None, goal: dvector![1.0], duration_s: 1.0 }, 25.0);
        let (found, expected) = (axis.additional_term(25.0), terms.unwrap()[(times.len() - 1, 0)]);
        assert!((found - expected).abs() <= 1e-9 * (1.0 + expected.abs()), "{}: {found} {expected}", law.name());
    }
}

#[test]
fn the_additional_term_is_zero_where_the_skill_is_kept_and_the_printed_one_under_the_printed_law() {
    let rests = skill(0.01, 1.0, |_| still(0.2));
    let corridor = Corridor::still(&[-1.0], &[1.0]).unwrap();
    let request = FilterRequest { start: None, goal: dvector![0.2], duration_s: 2.0 };
    let kept = constrain(&CorridorFilterConfig::default(), &rests, &corridor, &request).unwrap();
    assert_eq!(kept.additional_term(&rests, &request, 25.0).unwrap(), DMatrix::zeros(101, 1));
    let law = Published::default();
    let moved = constrain(&CorridorFilterConfig::Published(law.clone()), &rests, &corridor, &request).unwrap();
    let terms = moved.additional_term(&rests, &request, 25.0).unwrap();
    for row in [0, 10, 100] {
        let at = (row, 0);
        let (position, first) = (moved.rollout.positions().samples()[at], moved.rollout.velocities()[at]);
        let motion = PathState { position, first, second: moved.rollout.accelerations()[at] };
        let printed = law.additional_term(2.0, &AxisSample { skill: still(0.2), bounds: corridor.at(0.0, 0) }, motion);
        assert!((terms[at] - printed).abs() < 1e-10, "{row}: {} {printed}", terms[at]);
    }
}

#[test]
fn every_coordinate_is_constrained_alone() {
    // outer coordinates are held back from a goal outside, the middle one is free
    let one = skill(0.01, 1.0, transfer);
    let narrow = Corridor::still(&[-1.0], &[0.8]).unwrap();
    let (lower, upper) = ([-1.0, -10.0, -1.0], [0.8, 10.0, 0.8]);
    let wide = |table: &DMatrix<f64>| DMatrix::from_fn(table.nrows(), 3, |row, _| table[(row, 0)]);
    let positions = Trajectory::new(one.positions().times_s().to_vec(), wide(one.positions().samples())).unwrap();
    let three = Rollout::new(positions, wide(one.velocities()), wide(one.accelerations())).unwrap();
    let corridor = Corridor::still(&lower, &upper).unwrap();
    let request = FilterRequest { start: None, goal: DVector::repeat(3, 1.0), duration_s: 1.0 };
    for law in every_kind() {
        let alone = run(&law, &one, &narrow, 1.0).unwrap();
        let found = constrain(&law, &three, &corridor, &request).unwrap();
        let column = |k: usize| found.rollout.positions().samples().column(k).into_owned();
        assert_eq!(column(0), alone.rollout.positions().samples().column(0).into_owned());
        assert_eq!(column(2), column(0));
        assert_ne!(column(1), column(0), "{}", law.name());
        assert_eq!(found.certificate.axes.len(), 3);
    }
}

#[test]
fn what_cannot_be_constrained_is_refused_with_its_reason() {
    let rests = skill(0.1, 1.0, |_| still(0.2));
    let law = CorridorFilterConfig::default();
    let request = FilterRequest { start: None, goal: dvector![0.2], duration_s: 1.0 };
    let attempt =
        |corridor: &Corridor, request: &FilterRequest| constrain(&law, &rests, corridor, request).unwrap_err();
    let low = Corridor::still(&[-1.0], &[0.1]).unwrap();
    assert!(
        matches!(attempt(&low, &request), FilterError::StartOutside { coordinate: 0, excess, .. } if excess > 0.09)
    );
    let two = Corridor::still(&[-1.0, -1.0], &[1.0, 1.0]).unwrap();
    assert!(matches!(attempt(&two, &request), FilterError::Skill(SkillError::Dimension { found: 2, expected: 1, .. })));
    let open = Corridor::still(&[-1.0], &[1.0]).unwrap();
    let far = FilterRequest { goal: dvector![f64::NAN], ..request.clone() };
    assert!(matches!(attempt(&open, &far), FilterError::Skill(SkillError::InvalidArgument { argument: "goal", .. })));
    let short = FilterRequest { duration_s: 0.0, ..request.clone() };
    assert!(matches!(
        attempt(&open, &short),
        FilterError::Skill(SkillError::InvalidArgument { argument: "duration_s", .. })
    ));
    // open at both samples, and at those of the skill, crossed in between
    let falling = |first: f64| PathState { position: 1.0, first, second: 0.0 };
    let pinched = Corridor::sampled(vec![0.0, 0.04], 1, |t, _| Bounds {
        lower: still(-0.5),
        upper: falling(if t < 0.02 { -200.0 } else { 200.0 }),
    });
    let FilterError::Closed { coordinate: 0, time_s, width } = attempt(&pinched.unwrap(), &request) else { panic!() };
    assert!((time_s - 0.02).abs() < 1e-3 && width < 0.0, "{time_s} {width}");
}

#[test]
fn a_goal_outside_the_corridor_is_missed_and_said_so() {
    let leaves = skill(0.01, 1.0, |t| still(if t < 0.5 { 0.0 } else { 2.0 }));
    let corridor = Corridor::still(&[-1.0], &[1.0]).unwrap();
    let found = run(&CorridorFilterConfig::default(), &leaves, &corridor, 2.0).unwrap().certificate;
    assert!(found.holds_at_samples());
    assert!(found.goal_error() > 1.0);
}
