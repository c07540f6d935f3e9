//! The kernelized primitive: reproduction, via points, uncertainty, and derivatives against differences.

use approx::{assert_abs_diff_eq, assert_relative_eq};
use nalgebra::{DMatrix, DVector, dvector};
use proptest::prelude::*;

use super::*;
use crate::primitive::PrimitiveConfig;
use crate::time_law::minimum_jerk;

/// Reproduction of a smooth shape of order ten by 50 references that are trusted to a thousandth.
const FIT: f64 = 0.01;
/// Rounding of a solution of condition 1e8 and size ten.
const ROUNDING: f64 = 1e-7;
/// Duration of the demonstrations, s.
const DURATION_S: f64 = 2.0;

// two coordinates at rest at both ends: a weave and an arch of the given height
fn weave(height: f64) -> Trajectory {
    let at = |row: usize, k: usize| {
        let r = row as f64 / 400.0;
        let window = 16.0 * (r * (1.0 - r)).powi(2);
        match k {
            0 => 50.0 * minimum_jerk(r) + 10.0 * (3.0 * std::f64::consts::PI * r).sin() * window,
            _ => 5.0 - 20.0 * minimum_jerk(r) + height * window,
        }
    };
    Trajectory::uniform(DURATION_S / 400.0, DMatrix::from_fn(401, 2, at)).unwrap()
}

fn learn(demonstrations: &[Trajectory]) -> Kernelized {
    Kernelized::learn(&KernelizedConfig::default(), demonstrations).unwrap()
}

fn shown_task() -> RolloutRequest {
    RolloutRequest::new(dvector![0.0, 5.0], dvector![50.0, -15.0], DURATION_S, DURATION_S / 400.0)
}

fn rms(table: &DMatrix<f64>) -> f64 {
    (table.norm_squared() / table.len() as f64).sqrt()
}

fn at(motion: &KernelizedMotion<'_>, progress: f64) -> [DVector<f64>; 3] {
    let [mut position, mut velocity, mut acceleration] = [(); 3].map(|()| DVector::zeros(2));
    motion.evaluate_into(progress, &mut position, &mut velocity, &mut acceleration);
    [position, velocity, acceleration]
}

#[test]
fn one_demonstration_is_reproduced() {
    let found = learn(&[weave(10.0)]).rollout(&shown_task()).unwrap();
    let error = rms(&(found.positions().samples() - weave(10.0).samples()));
    assert!(error < FIT, "{error}");
}

#[test]
fn several_demonstrations_give_their_mean() {
    let found = learn(&[weave(8.0), weave(10.0), weave(12.0)]).rollout(&shown_task()).unwrap();
    let error = found.positions().samples() - weave(10.0).samples();
    // where demonstrations differ the mean is trusted less and smoothed more
    assert!(rms(&error) < 10.0 * FIT, "{}", rms(&error));
}

#[test]
fn the_shape_moves_with_start_and_goal() {
    let primitive = learn(&[weave(10.0)]);
    let here = primitive.rollout(&shown_task()).unwrap();
    let moved = RolloutRequest { start: dvector![3.0, 5.0], goal: dvector![53.0, -15.0], ..shown_task() };
    let there = primitive.rollout(&moved).unwrap();
    let difference = there.positions().samples() - here.positions().samples();
    assert!((difference.column(0).add_scalar(-3.0)).amax() < ROUNDING);
    assert!(difference.column(1).amax() < ROUNDING);
}

#[test]
fn a_start_velocity_is_taken_up_and_the_goal_is_met_at_rest() {
    let request = RolloutRequest { start_velocity: Some(dvector![30.0, -7.0]), settle_s: 0.1, ..shown_task() };
    let found = learn(&[weave(10.0)]).rollout(&request).unwrap();
    assert_eq!(found.velocities().row(0).transpose(), dvector![30.0, -7.0]);
    assert_eq!(found.velocities().row(400).transpose(), dvector![0.0, 0.0]);
    assert_eq!(found.positions().at(DURATION_S), request.goal);
    assert_eq!(found.positions().end(), request.goal);
    // not only set at the ends: the motion leads there
    let beside = found.positions().samples().row(399).transpose();
    assert!((beside - &request.goal).norm() < 0.01);
    let early = found.velocities().row(1).transpose() - dvector![30.0, -7.0];
    assert!(early.norm() < 15.0, "{early}");
}

#[test]
fn the_ends_are_met_by_the_kernel_and_not_only_written_over() {
    let primitive = learn(&[weave(10.0)]);
    let request = RolloutRequest { start_velocity: Some(dvector![30.0, -7.0]), ..shown_task() };
    let motion = primitive.motion(&request).unwrap();
    for (progress, expected, rate) in
        [(1e-12, request.start.clone(), dvector![30.0, -7.0]), (1.0 - 1e-12, request.goal.clone(), dvector![0.0, 0.0])]
    {
        let [position, velocity, _] = at(&motion, progress);
        assert_abs_diff_eq!(position, expected, epsilon = ROUNDING);
        assert_abs_diff_eq!(velocity, rate, epsilon = 1e2 * ROUNDING);
    }
}

#[test]
fn velocity_and_acceleration_are_the_derivatives_of_the_position() {
    let primitive = learn(&[weave(10.0), weave(14.0)]);
    let via = ViaPoint { progress: 0.3, position: dvector![9.0, 20.0], velocity: None, deviation: 0.0 };
    let motion = primitive.motion_through(&shown_task(), &[via]).unwrap();
    let h = 1e-5;
    for progress in [0.01, 0.2, 0.3, 0.55, 0.99] {
        let [[before, slower, _], [_, velocity, acceleration], [after, faster, _]] =
            [progress - h, progress, progress + h].map(|progress| at(&motion, progress));
        let step_s = 2.0 * h * DURATION_S;
        assert_relative_eq!((after - before) / step_s, velocity, epsilon = 1e-3, max_relative = 1e-4);
        assert_relative_eq!((faster - slower) / step_s, acceleration, epsilon = 1e-2, max_relative = 1e-4);
    }
}

#[test]
fn via_points_are_passed_with_their_velocity() {
    let primitive = learn(&[weave(8.0), weave(10.0), weave(12.0)]);
    let via = [
        ViaPoint { progress: 0.3, position: dvector![14.0, 12.0], velocity: Some(dvector![40.0, 0.0]), deviation: 0.0 },
        ViaPoint { progress: 0.71, position: dvector![40.0, -1.0], velocity: None, deviation: 0.0 },
    ];
    let motion = primitive.motion_through(&shown_task(), &via).unwrap();
    for point in &via {
        assert_abs_diff_eq!(at(&motion, point.progress)[0], point.position, epsilon = ROUNDING);
    }
    assert_abs_diff_eq!(at(&motion, 0.3)[1], dvector![40.0, 0.0], epsilon = 1e2 * ROUNDING);
    // and the ends with them
    let end = at(&motion, 1.0 - 1e-12)[0].clone();
    assert_abs_diff_eq!(end, shown_task().goal, epsilon = ROUNDING);
}

#[test]
fn a_via_point_picks_the_member_of_the_shown_family_that_passes_it() {
    let primitive = learn(&[weave(5.0), weave(10.0), weave(15.0)]);
    let picked = weave(13.0);
    let via = ViaPoint { progress: 0.5, position: picked.at(1.0), velocity: None, deviation: 0.0 };
    let found = primitive.motion_through(&shown_task(), &[via]).unwrap().rollout().unwrap();
    // the mean is an arch of 10: one instant tells of all others
    let error = rms(&(found.positions().samples() - picked.samples()));
    assert!(error < 0.1, "{error}");
}

#[test]
fn a_via_point_with_a_deviation_is_passed_as_near_as_it_is_trusted() {
    let primitive = learn(&[weave(8.0), weave(12.0)]);
    let miss = |deviation: f64| {
        let via = ViaPoint { progress: 0.5, position: dvector![25.0, 10.0], velocity: None, deviation };
        let motion = primitive.motion_through(&shown_task(), std::slice::from_ref(&via)).unwrap();
        (at(&motion, 0.5)[0].clone() - via.position).norm()
    };
    assert!(miss(0.0) < ROUNDING);
    assert!(miss(0.0) < miss(1.0) && miss(1.0) < miss(10.0));
}

#[test]
fn the_uncertainty_is_greatest_where_demonstrations_differ_and_vanishes_at_ends_and_via_points() {
    let primitive = learn(&[weave(5.0), weave(10.0), weave(15.0)]);
    let plain = primitive.motion(&shown_task()).unwrap();
    let arch = |progress: f64| plain.standard_deviation(progress)[1];
    assert!(arch(0.0) < ROUNDING.sqrt() && arch(1.0) < ROUNDING.sqrt());
    assert!(arch(0.5) > 2.0 * arch(0.1), "{} {}", arch(0.5), arch(0.1));
    // the weave is the same in all demonstrations
    assert!(plain.standard_deviation(0.5)[0] < 0.05 * arch(0.5));
    let via = ViaPoint { progress: 0.5, position: dvector![25.0, 10.0], velocity: None, deviation: 0.0 };
    let through = primitive.motion_through(&shown_task(), &[via]).unwrap();
    assert!(through.standard_deviation(0.5)[1] < 1e-3 * arch(0.5));
    // demonstrations differ in one way, so that one instant tells of all others
    assert!(through.standard_deviation(0.8)[1] < 0.2 * arch(0.8));
}

#[test]
fn the_uncertainty_grows_away_from_references() {
    // references a quarter apart under a kernel that just bridges them
    let config = KernelizedConfig { references: 5, length_scale: 0.125, ..KernelizedConfig::default() };
    let primitive = Kernelized::learn(&config, &[weave(10.0)]).unwrap();
    let motion = primitive.motion(&shown_task()).unwrap();
    for reference in [0.25, 0.5, 0.75] {
        let (on, off) = (motion.standard_deviation(reference)[1], motion.standard_deviation(reference + 0.125)[1]);
        assert!(off > 3.0 * on, "{on} {off}");
    }
}

#[test]
fn a_demonstration_that_starts_in_motion_does_not_oscillate() {
    let line = Trajectory::uniform(0.02, DMatrix::from_fn(101, 1, |row, _| row as f64)).unwrap();
    let primitive = learn(&[line]);
    let request = RolloutRequest::new(dvector![0.0], dvector![100.0], 2.0, 0.005);
    let found = primitive.rollout(&request).unwrap();
    // from rest to 50 per second and back: half again as fast for a moment, never backwards
    assert!(found.velocities().min() > -1.0, "{}", found.velocities().min());
    assert!(found.velocities().max() < 90.0, "{}", found.velocities().max());
    // and as shown if it starts in motion, until it slows down
    let moving = RolloutRequest { start_velocity: Some(dvector![50.0]), ..request };
    let found = primitive.rollout(&moving).unwrap();
    assert!((found.velocities().rows(0, 280).add_scalar(-50.0)).amax() < 0.5, "{}", found.velocities().rows(0, 280));
}

#[test]
fn doubling_the_duration_scales_time_exactly() {
    let primitive = learn(&[weave(10.0)]);
    let short = primitive.rollout(&shown_task()).unwrap();
    let long = RolloutRequest { duration_s: 4.0, time_step_s: 0.01, ..shown_task() };
    let long = primitive.rollout(&long).unwrap();
    assert_eq!(short.positions().samples(), long.positions().samples());
    assert_eq!(short.velocities(), &(long.velocities() * 2.0));
}

#[test]
fn another_unit_gives_the_same_motion() {
    let millimeters = |shown: Trajectory| Trajectory::new(shown.times_s().to_vec(), shown.samples() * 1e3).unwrap();
    let shown = [weave(8.0), weave(12.0)];
    let meters = learn(&shown).rollout(&shown_task()).unwrap();
    let request = RolloutRequest { start: shown_task().start * 1e3, goal: shown_task().goal * 1e3, ..shown_task() };
    let other = learn(&shown.map(millimeters)).rollout(&request).unwrap();
    assert_abs_diff_eq!(other.positions().samples() * 1e-3, meters.positions().samples(), epsilon = ROUNDING);
}

#[test]
fn a_standing_demonstration_stands() {
    let standing = Trajectory::uniform(0.5, DMatrix::repeat(3, 1, 4.0)).unwrap();
    let found = learn(&[standing]).rollout(&RolloutRequest::new(dvector![4.0], dvector![4.0], 1.0, 0.1)).unwrap();
    assert_eq!(found.positions().samples(), &DMatrix::repeat(11, 1, 4.0));
}

#[test]
fn contradicting_and_misplaced_via_points_are_refused() {
    let primitive = learn(&[weave(10.0)]);
    let via = ViaPoint { progress: 0.5, position: dvector![0.0, 0.0], velocity: None, deviation: 0.0 };
    let refused = |via: ViaPoint| match primitive.motion_through(&shown_task(), &[via]).map(|_| ()) {
        Err(SkillError::InvalidArgument { argument, .. }) => argument,
        other => panic!("{other:?}"),
    };
    assert_eq!(refused(ViaPoint { progress: 1.0, ..via.clone() }), "progress");
    assert_eq!(refused(ViaPoint { progress: f64::NAN, ..via.clone() }), "progress");
    assert_eq!(refused(ViaPoint { deviation: -1.0, ..via.clone() }), "deviation");
    assert_eq!(refused(ViaPoint { position: dvector![f64::NAN, 0.0], ..via.clone() }), "position");
    assert_eq!(refused(ViaPoint { velocity: Some(dvector![0.0, f64::INFINITY]), ..via.clone() }), "velocity");
    let twice = primitive.motion_through(&shown_task(), &[via.clone(), ViaPoint { deviation: 1.0, ..via.clone() }]);
    assert!(matches!(twice.map(|_| ()), Err(SkillError::InvalidArgument { argument: "gap", .. })));
    let short = ViaPoint { position: dvector![0.0], ..via };
    assert!(matches!(primitive.motion_through(&shown_task(), &[short]), Err(SkillError::Dimension { .. })));
}

#[test]
fn a_saved_primitive_rolls_out_the_same_bits() {
    let primitive = learn(&[weave(8.0), weave(12.0)]);
    let text = serde_json::to_string(&primitive.saved()).unwrap();
    let restored = serde_json::from_str::<SavedKernelized>(&text).unwrap().restore().unwrap();
    assert_eq!(restored.saved(), primitive.saved());
    let request = RolloutRequest { start_velocity: Some(dvector![1.0, 2.0]), ..shown_task() };
    assert_eq!(restored.rollout(&request).unwrap(), primitive.rollout(&request).unwrap());
}

#[test]
fn a_damaged_file_is_refused() {
    let good = learn(&[weave(10.0)]).saved();
    let refused = |damage: fn(&mut SavedKernelized)| {
        let mut saved = good.clone();
        damage(&mut saved);
        saved.restore().unwrap_err()
    };
    assert!(matches!(refused(|saved| saved.references.clear()), SkillError::Dimension { .. }));
    assert!(matches!(refused(|saved| saved.references[1].means.truncate(3)), SkillError::RowCount { found: 3, .. }));
    for error in [
        refused(|saved| saved.references[0].scale = 0.0),
        refused(|saved| saved.references[0].means[7][1] = f64::NAN),
        refused(|saved| saved.references[0].covariances[7] = [1.0, 2.0, 1.0]),
        refused(|saved| saved.references[0].covariances[7] = [-1.0, 0.0, 1.0]),
        refused(|saved| saved.config.lambda = -1.0),
    ] {
        assert!(matches!(error, SkillError::InvalidConfig(_)), "{error}");
    }
}

#[test]
fn nothing_to_learn_from_and_unequal_dimensions_are_refused() {
    let config = PrimitiveConfig::Kernelized(KernelizedConfig::default());
    assert_eq!(config.learn(&[]).unwrap_err(), SkillError::NoDemonstrations);
    let line = Trajectory::uniform(1.0, DMatrix::from_column_slice(2, 1, &[0.0, 1.0])).unwrap();
    assert!(matches!(config.learn(&[weave(1.0), line]), Err(SkillError::DemonstrationDimension { .. })));
}

#[test]
fn samples_whose_squares_overflow_are_refused() {
    let huge = Trajectory::uniform(1.0, DMatrix::from_column_slice(3, 1, &[0.0, 1e200, 0.0])).unwrap();
    let error = Kernelized::learn(&KernelizedConfig::default(), &[huge]).unwrap_err();
    assert!(matches!(error, SkillError::InvalidArgument { operation: "learn primitive", .. }), "{error}");
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(48))]

    #[test]
    fn rollouts_begin_at_the_start_and_end_at_the_goal(
        start in prop::array::uniform2(-1e3f64..1e3), goal in prop::array::uniform2(-1e3f64..1e3),
        velocity in prop::array::uniform2(-1e2f64..1e2), duration_s in 1e-2f64..1e2, steps in 1u32..200,
    ) {
        let request = RolloutRequest {
            start_velocity: Some(DVector::from_row_slice(&velocity)),
            settle_s: 0.3 * duration_s,
            ..RolloutRequest::new(
                DVector::from_row_slice(&start), DVector::from_row_slice(&goal), duration_s, duration_s / f64::from(steps),
            )
        };
        let found = learn(&[weave(10.0)]).rollout(&request).unwrap();
        prop_assert_eq!(found.positions().start(), request.start);
        prop_assert_eq!(found.velocities().row(0).transpose(), DVector::from_row_slice(&velocity));
        prop_assert_eq!(found.positions().end(), request.goal);
    }
}
