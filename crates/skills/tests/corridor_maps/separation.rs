//! Algorithm 2 on whole demonstrations.

use approx::assert_relative_eq;
use nalgebra::{DMatrix, DVector};
use skills::corridor::{Bounds, Corridor};
use skills::corridor_map::{ClosedForm, CorridorMapConfig, Fallback, MForm, MotionEnds};
use skills::separation::constraint_based::{
    ConstrainedDemonstration, ConstraintBased, ConstraintBasedConfig, ConstraintError, MappingOrder,
};
use skills::time_law::{PathState, minimum_jerk, minimum_jerk_first_derivative, minimum_jerk_second_derivative};
use skills::{RolloutRequest, SkillError, Trajectory};

const DURATION_S: f64 = 2.0;
const SAMPLES: usize = 401;
const GOAL_M: [f64; 2] = [0.2, -0.1];
/// Error of the fit with 50 bases, of 0.2 m.
const FIT_M: f64 = 2e-4;
/// A few roundings of lengths below a meter, magnified by 1/δ.
const ROUNDING: f64 = 1e-12;

/// Position, m, that is intended at the share r of the duration: a transfer with a weave, at rest at both ends.
fn intention(r: f64, coordinate: usize) -> f64 {
    let weave = [0.045, -0.055][coordinate] * 16.0 * (r * (1.0 - r)).powi(2);
    GOAL_M[coordinate] * minimum_jerk(r) + weave
}

/// Corridor of variant `which`, about 0.12 m wide, that follows the transfer and sways.
fn corridor(which: f64) -> Corridor {
    let times_s = (0..=40).map(|row| DURATION_S * f64::from(row) / 40.0).collect();
    Corridor::sampled(times_s, 2, |time_s, coordinate| {
        let (r, goal, rate) = (time_s / DURATION_S, GOAL_M[coordinate], 2.0);
        let (sway, angle) = (0.012, rate * time_s + which + coordinate as f64);
        let middle = PathState {
            position: goal * minimum_jerk(r) + sway * angle.sin(),
            first: goal * minimum_jerk_first_derivative(r) / DURATION_S + sway * rate * angle.cos(),
            second: goal * minimum_jerk_second_derivative(r) / DURATION_S.powi(2) - sway * rate * rate * angle.sin(),
        };
        let half = 0.06 + 0.015 * (2.0 * which).sin();
        let moved = |by: f64| PathState { position: middle.position + by, ..middle };
        Bounds { lower: moved(-half), upper: moved(half) }
    })
    .unwrap()
}

/// What a person shows who moves by the sigmoid about the middle of the corridor.
fn demonstration(corridor: &Corridor) -> Trajectory {
    let bounds = |r: f64, coordinate| corridor.at(r * DURATION_S, coordinate);
    let maps = [0, 1].map(|coordinate| {
        let ends = MotionEnds {
            start: intention(0.0, coordinate),
            start_bounds: bounds(0.0, coordinate),
            goal: intention(1.0, coordinate),
            goal_bounds: bounds(1.0, coordinate),
        };
        m_form().map(&ends, 0.01).unwrap().map
    });
    let samples = DMatrix::from_fn(SAMPLES, 2, |row, coordinate| {
        let r = row as f64 / (SAMPLES - 1) as f64;
        maps[coordinate].constrained(&bounds(r, coordinate), r, intention(r, coordinate))
    });
    Trajectory::uniform(DURATION_S / (SAMPLES - 1) as f64, samples).unwrap()
}

fn m_form() -> CorridorMapConfig {
    CorridorMapConfig::MForm(MForm::default())
}

fn config(map: CorridorMapConfig) -> ConstraintBasedConfig {
    ConstraintBasedConfig { map, ..ConstraintBasedConfig::default() }
}

fn learn(
    config: &ConstraintBasedConfig,
    shown: &[(Trajectory, Corridor)],
    noise: f64,
) -> Result<ConstraintBased, ConstraintError> {
    let noise = [noise; 2];
    let demonstrations: Vec<ConstrainedDemonstration<'_>> = shown
        .iter()
        .map(|(trajectory, corridor)| ConstrainedDemonstration { trajectory, corridor, noise: &noise })
        .collect();
    ConstraintBased::learn(config, &demonstrations)
}

fn shown(variants: &[f64]) -> Vec<(Trajectory, Corridor)> {
    variants.iter().map(|which| (demonstration(&corridor(*which)), corridor(*which))).collect()
}

fn request(goal: [f64; 2]) -> RolloutRequest {
    let step_s = DURATION_S / (SAMPLES - 1) as f64;
    RolloutRequest::new(DVector::zeros(2), DVector::from_row_slice(&goal), DURATION_S, step_s)
}

fn assert_inside(motion: &Trajectory, corridor: &Corridor) {
    for (row, time_s) in motion.times_s().iter().enumerate() {
        for coordinate in 0..2 {
            assert!(corridor.at(*time_s, coordinate).margin(motion.samples()[(row, coordinate)]) > 0.0);
        }
    }
}

fn rms(table: &DMatrix<f64>) -> f64 {
    (table.norm_squared() / table.len() as f64).sqrt()
}

// the claim of Eq. (21): map, learn, roll out, map back
#[test]
fn what_was_shown_is_reproduced_inside_the_corridor_from_the_same_start_to_the_same_goal() {
    for map in super::kinds() {
        let shown = shown(&[0.3]);
        let skill = learn(&config(map), &shown, 0.0).unwrap();
        let (trajectory, corridor) = &shown[0];
        let generated = skill.generate(&request(GOAL_M), corridor).unwrap();
        assert_eq!(generated.fallbacks, [None; 2]);
        let motion = generated.positions;
        assert_inside(&motion, corridor);
        assert!((motion.start() - trajectory.start()).amax() < ROUNDING);
        assert!((motion.end() - trajectory.end()).amax() < FIT_M);
        assert!(rms(&(motion.samples() - trajectory.samples())) < FIT_M);
    }
}

#[test]
fn a_skill_stays_strictly_inside_corridors_it_was_never_shown() {
    let skill = learn(&config(CorridorMapConfig::default()), &shown(&[0.3, 1.7]), 0.0).unwrap();
    for which in 0..20 {
        let corridor = corridor(0.31 * f64::from(which));
        for goal in [GOAL_M, [0.22, -0.12], [0.18, -0.13]] {
            let motion = skill.generate(&request(goal), &corridor).unwrap().positions;
            assert_inside(&motion, &corridor);
            assert!((motion.start() - DVector::<f64>::zeros(2)).amax() < ROUNDING);
            assert!((motion.end() - DVector::from_row_slice(&goal)).amax() < FIT_M);
        }
    }
}

#[test]
fn motions_bent_by_different_corridors_become_one_in_the_unconstrained_coordinate() {
    let shown = shown(&[0.3, 1.7, 3.9]);
    let skill = learn(&config(m_form()), &shown, 0.0).unwrap();
    let intended =
        DMatrix::from_fn(SAMPLES, 2, |row, coordinate| intention(row as f64 / (SAMPLES - 1) as f64, coordinate));
    for (unconstrained, (trajectory, _)) in skill.unconstrained().iter().zip(&shown) {
        assert!((unconstrained.samples() - &intended).amax() < ROUNDING);
        assert!(rms(&(trajectory.samples() - &intended)) > 5.0 * FIT_M);
    }
    let motion = skill.primitive().rollout(&request(GOAL_M)).unwrap();
    assert!(rms(&(motion.positions().samples() - &intended)) < FIT_M);
}

#[test]
fn learning_first_loses_the_intention_that_mapping_the_demonstrations_keeps() {
    let shown = shown(&[0.3, 1.7, 3.9]);
    let error = |order| {
        let skill = learn(&ConstraintBasedConfig { order, ..config(m_form()) }, &shown, 0.0).unwrap();
        let motion = skill.primitive().rollout(&request(GOAL_M)).unwrap();
        let intended =
            DMatrix::from_fn(SAMPLES, 2, |row, coordinate| intention(row as f64 / (SAMPLES - 1) as f64, coordinate));
        rms(&(motion.positions().samples() - intended))
    };
    let (mapped, learned) = (error(MappingOrder::MapDemonstrations), error(MappingOrder::LearnFirst));
    println!("rms to the intention: {mapped:.2e} m mapped first, {learned:.2e} m learned first");
    assert!(learned > 5.0 * mapped);
}

#[test]
fn learning_first_and_mapping_first_agree_on_one_demonstration() {
    let shown = shown(&[0.3]);
    let rolled = |order| {
        let config = ConstraintBasedConfig { order, ..ConstraintBasedConfig::default() };
        learn(&config, &shown, 0.0).unwrap().generate(&request(GOAL_M), &shown[0].1).unwrap().positions
    };
    let difference = rolled(MappingOrder::MapDemonstrations).samples() - rolled(MappingOrder::LearnFirst).samples();
    assert!(rms(&difference) < FIT_M);
}

/// The first demonstration with rows of coordinate 1 moved above the upper bound by `outside_m`.
fn spoiled(rows: std::ops::Range<usize>, outside_m: f64) -> (Trajectory, Corridor) {
    let (trajectory, corridor) = shown(&[0.3]).remove(0);
    let mut samples = trajectory.samples().clone();
    for row in rows {
        samples[(row, 1)] = corridor.at(trajectory.times_s()[row], 1).upper.position + outside_m;
    }
    (Trajectory::new(trajectory.times_s().to_vec(), samples).unwrap(), corridor)
}

#[test]
fn a_demonstration_outside_its_corridor_is_refused_with_the_sample_and_how_far() {
    let mut shown = vec![shown(&[1.7]).remove(0), spoiled(100..110, 0.004)];
    shown[1] = {
        let (trajectory, corridor) = shown[1].clone();
        let mut samples = trajectory.samples().clone();
        samples[(104, 1)] += 0.001;
        (Trajectory::new(trajectory.times_s().to_vec(), samples).unwrap(), corridor)
    };
    let error = learn(&ConstraintBasedConfig::default(), &shown, 0.001).unwrap_err();
    let ConstraintError::OutsideCorridor { demonstration, coordinate, percent, row, time_s, outside, tolerance } =
        error
    else {
        panic!("{error:?}");
    };
    assert_eq!((demonstration, coordinate, row, time_s), (1, 1, 104, 0.52));
    assert_relative_eq!(percent, 1000.0 / 401.0, max_relative = ROUNDING);
    assert_relative_eq!(outside, 0.005, max_relative = 1e-9);
    assert_relative_eq!(tolerance, 0.003, max_relative = ROUNDING);
    // as much outside is noise if there is that much of it
    assert!(learn(&ConstraintBasedConfig::default(), &shown, 0.002).is_ok());
}

#[test]
fn a_few_samples_outside_are_mapped_and_reported() {
    let shown = [spoiled(100..104, 0.004)];
    let skill = learn(&ConstraintBasedConfig::default(), &shown, 0.001).unwrap();
    let [inside, outside] = [0, 1].map(|coordinate| skill.reports()[0].coordinates[coordinate].clone());
    assert_eq!((inside.outside_fraction, inside.furthest_outside, inside.fallback), (0.0, 0.0, None));
    assert_relative_eq!(outside.outside_fraction, 4.0 / 401.0, max_relative = ROUNDING);
    assert_relative_eq!(outside.furthest_outside, 0.004, max_relative = 1e-9);
    // 3σ over the width of 2·(0.06 + 0.015 sin 0.6) m
    assert_relative_eq!(outside.delta, 0.003 / (0.12 + 0.03 * 0.6f64.sin()), max_relative = 1e-6);
}

#[test]
fn a_closed_form_that_would_reverse_falls_back_to_the_m_form_and_says_so() {
    // from p = 0.75 in a width of 1 to p = 0.9 in a width of 4
    let widen = |from: f64, by: f64| move |r: f64| from + by * minimum_jerk(r);
    let upper = widen(1.0, 3.0);
    let times_s: Vec<f64> = (0..=20).map(|row| f64::from(row) / 20.0).collect();
    let corridor = Corridor::sampled(times_s, 1, |r, _| {
        let (first, second) = (3.0 * minimum_jerk_first_derivative(r), 3.0 * minimum_jerk_second_derivative(r));
        Bounds { lower: PathState::default(), upper: PathState { position: upper(r), first, second } }
    })
    .unwrap();
    let samples = DMatrix::from_fn(201, 1, |row, _| widen(0.75, 2.85)(row as f64 / 200.0));
    let trajectory = Trajectory::uniform(0.005, samples).unwrap();
    let shown = [ConstrainedDemonstration { trajectory: &trajectory, corridor: &corridor, noise: &[0.0] }];
    let closed = ConstraintBased::learn(&config(CorridorMapConfig::ClosedForm(ClosedForm::default())), &shown).unwrap();
    let fallback = closed.reports()[0].coordinates[0].fallback;
    assert!(matches!(fallback, Some(Fallback::Reversing { k }) if k < 0.0), "{fallback:?}");
    let m_form = ConstraintBased::learn(&config(m_form()), &shown).unwrap();
    assert_eq!(closed.unconstrained(), m_form.unconstrained());
    let request = RolloutRequest::new(trajectory.start(), trajectory.end(), 1.0, 0.005);
    let generated = closed.generate(&request, &corridor).unwrap();
    assert!(matches!(generated.fallbacks[..], [Some(Fallback::Reversing { .. })]));
}

#[test]
fn equation_17_as_published_has_no_value_outside() {
    let as_published = CorridorMapConfig::AsPublished(skills::corridor_map::AsPublished::default());
    let error = learn(&config(as_published), &[spoiled(100..101, 0.001)], 0.001).unwrap_err();
    assert!(matches!(error, ConstraintError::NoValue { row: 100, coordinate: 1, .. }), "{error:?}");
}

#[test]
fn ends_outside_the_corridor_are_refused_when_generating() {
    let skill = learn(&ConstraintBasedConfig::default(), &shown(&[0.3]), 0.0).unwrap();
    let error = skill.generate(&request([0.5, -0.1]), &corridor(0.3)).unwrap_err();
    assert!(matches!(error, ConstraintError::EndOutside { end: "goal", coordinate: 0, .. }), "{error:?}");
    let error = skill.generate(&request(GOAL_M), &Corridor::still(&[-1.0, 0.0], &[1.0, 1.0]).unwrap()).unwrap_err();
    assert!(matches!(error, ConstraintError::EndOutside { end: "start", coordinate: 1, .. }), "{error:?}");
}

#[test]
fn arguments_that_do_not_belong_together_are_refused() {
    let (trajectory, corridor) = shown(&[0.3]).remove(0);
    let with = |corridor: &Corridor, noise: &[f64]| {
        let shown = [ConstrainedDemonstration { trajectory: &trajectory, corridor, noise }];
        ConstraintBased::learn(&ConstraintBasedConfig::default(), &shown).unwrap_err()
    };
    let skill = |error| matches!(error, ConstraintError::Skill(SkillError::Dimension { .. }));
    assert!(skill(with(&corridor, &[0.0])));
    assert!(skill(with(&Corridor::still(&[-1.0], &[1.0]).unwrap(), &[0.0; 2])));
    let negative = with(&corridor, &[0.0, -1.0]);
    assert!(matches!(negative, ConstraintError::Skill(SkillError::InvalidArgument { argument: "noise", .. })));
    let none = ConstraintBased::learn(&ConstraintBasedConfig::default(), &[]).unwrap_err();
    assert_eq!(none, ConstraintError::Skill(SkillError::NoDemonstrations));
}

#[test]
fn an_invalid_option_is_named_by_its_path() {
    let field = |text: &str| serde_json::from_str::<ConstraintBasedConfig>(text).unwrap().validate().unwrap_err().field;
    assert_eq!(field(r#"{"map": {"proximal": {"strength": -1}}}"#), "map.proximal.strength");
    assert_eq!(field(r#"{"order": "learn_first", "primitive": {"dmp": {"bases": 1}}}"#), "primitive.dmp.bases");
    assert!(serde_json::from_str::<ConstraintBasedConfig>(r#"{"maps": {}}"#).is_err());
}
