//! The pose primitive: turns of any angle, invariance, and rates against differences.

use std::f64::consts::{PI, TAU};

use approx::{assert_abs_diff_eq, assert_relative_eq};
use nalgebra::{Isometry3, Quaternion, Translation3, Unit, UnitQuaternion};
use proptest::prelude::*;

use super::*;
use crate::time_law::minimum_jerk;

/// Reproduction of turns of some radians and ways of some decimeters by 50 bases.
const FIT: f64 = 1e-3;
/// Rounding of a motion after a fit of condition 1e8.
const ROUNDING: f64 = 1e-7;
/// Duration of the demonstrations, s.
const DURATION_S: f64 = 2.0;
/// Rows of the demonstrations.
const ROWS: usize = 401;

fn sampled(pose: impl Fn(f64) -> Isometry3<f64>) -> PoseTrajectory {
    let along = |row: usize| row as f64 / (ROWS - 1) as f64;
    let times_s = (0..ROWS).map(|row| DURATION_S * along(row)).collect();
    PoseTrajectory::new(times_s, (0..ROWS).map(|row| pose(along(row))).collect()).unwrap()
}

// an arch of 0.3 m that turns by `angle` about z while it nods about x
fn screw(angle: f64, nod: f64) -> PoseTrajectory {
    let first = UnitQuaternion::from_euler_angles(0.3, -0.5, 0.2);
    sampled(|r| {
        let (along, window) = (minimum_jerk(r), 16.0 * (r * (1.0 - r)).powi(2));
        let turn = UnitQuaternion::from_scaled_axis(Vector3::x() * (nod * window))
            * UnitQuaternion::from_scaled_axis(Vector3::z() * (angle * along + 0.2 * window));
        Isometry3::from_parts(Translation3::new(0.3 * along, 0.1 * window, 0.02 * along), turn * first)
    })
}

fn learn(shown: &PoseTrajectory) -> PoseDmp {
    PoseDmp::learn(&DmpConfig::default(), std::slice::from_ref(shown)).unwrap()
}

fn shown_task(shown: &PoseTrajectory) -> PoseRequest {
    PoseRequest::new(shown.poses()[0], shown.poses()[ROWS - 1], DURATION_S, DURATION_S / (ROWS - 1) as f64)
}

// the greatest distance of a rollout from poses, m and rad together
fn distance(found: &PoseRollout, expected: &[Isometry3<f64>]) -> f64 {
    assert_eq!(found.motions.len(), expected.len());
    let pairs = found.motions.iter().zip(expected);
    pairs.map(|(motion, expected)| apart(&motion.pose, expected)).fold(0.0, f64::max)
}

fn apart(pose: &Isometry3<f64>, other: &Isometry3<f64>) -> f64 {
    let turn = (pose.rotation * other.rotation.inverse()).angle();
    turn + (pose.translation.vector - other.translation.vector).norm()
}

// the angle turned through, whole turns included
fn turned(found: &PoseRollout) -> Vector3<f64> {
    let poses = found.motions.iter().map(|motion| motion.pose).collect();
    PoseTrajectory::new(found.times_s.clone(), poses).unwrap().turn_rad()
}

#[test]
fn demonstrations_are_reproduced_however_far_they_turn() {
    for degrees in [10.0, 170.0, 180.0, 190.0, 350.0, 360.0, 370.0, -350.0, 720.0_f64] {
        for nod in [0.0, 0.6] {
            let shown = screw(degrees.to_radians(), nod);
            let found = learn(&shown).rollout(&shown_task(&shown)).unwrap();
            let error = distance(&found, shown.poses());
            assert!(error < FIT, "{degrees} degrees with a nod of {nod}: {error}");
        }
    }
}

#[test]
fn a_turn_of_350_degrees_is_not_taken_the_short_way() {
    let shown = screw(350_f64.to_radians(), 0.0);
    let found = turned(&learn(&shown).rollout(&shown_task(&shown)).unwrap());
    assert_abs_diff_eq!(found, Vector3::z() * 350_f64.to_radians(), epsilon = FIT);
}

#[test]
fn the_logarithm_at_the_goal_jumps_where_the_residual_does_not() {
    // the usual coordinates of a quaternion DMP: 2 log(q·g⁻¹), one tangent space for all
    let shown = screw(350_f64.to_radians(), 0.3);
    let goal = shown.poses()[ROWS - 1].rotation;
    let usual: Vec<_> = shown.poses().iter().map(|pose| (pose.rotation * goal.inverse()).scaled_axis()).collect();
    let turning = ShownTurn::of(std::slice::from_ref(&shown)).turning(shown.poses()[0].rotation, goal);
    let residual = turning.residuals(&shown);
    let jump = |path: &[Vector3<f64>]| path.windows(2).map(|pair| (pair[1] - pair[0]).norm()).fold(0.0, f64::max);
    assert!(jump(&usual) > 6.0, "{}", jump(&usual));
    assert!(jump(&residual) < 0.02, "{}", jump(&residual));
    assert!(residual.iter().all(|rho| rho.norm() < 1.0));
}

#[test]
fn a_goal_past_half_a_turn_is_reached_the_way_round_that_was_shown() {
    for shown_degrees in [170.0, 180.0, 190.0_f64] {
        let shown = screw(shown_degrees.to_radians(), 0.2);
        let primitive = learn(&shown);
        for degrees in [150.0, 179.0, 180.0, 181.0, 210.0_f64] {
            let turn = UnitQuaternion::from_scaled_axis(Vector3::z() * degrees.to_radians());
            let mut request = shown_task(&shown);
            request.goal.rotation = turn * request.start.rotation;
            let found = primitive.rollout(&request).unwrap();
            assert!(apart(&found.motions[ROWS - 1].pose, &request.goal) < FIT);
            assert_abs_diff_eq!(turned(&found).z, degrees.to_radians(), epsilon = 0.1);
        }
    }
}

#[test]
fn a_full_turn_is_kept_for_a_goal_turned_about_another_axis() {
    let shown = screw(TAU, 0.0);
    let mut request = shown_task(&shown);
    request.goal.rotation = UnitQuaternion::from_scaled_axis(Vector3::x() * 1e-4) * request.start.rotation;
    let found = learn(&shown).rollout(&request).unwrap();
    assert_abs_diff_eq!(turned(&found), Vector3::z() * TAU, epsilon = 0.01);
    assert!(distance(&found, shown.poses()) < FIT);
}

#[test]
fn a_quaternion_and_its_negative_teach_the_same_motion() {
    let shown = screw(2.8, 0.5);
    let negated = |row: usize, pose: &Isometry3<f64>| {
        let quaternion = pose.rotation.into_inner();
        let sign = if row.is_multiple_of(3) { -1.0 } else { 1.0 };
        Isometry3::from_parts(pose.translation, Unit::new_unchecked(quaternion * sign))
    };
    let poses = shown.poses().iter().enumerate().map(|(row, pose)| negated(row, pose)).collect();
    let other = PoseTrajectory::new(shown.times_s().to_vec(), poses).unwrap();
    assert_eq!(learn(&shown).dmp(), learn(&other).dmp());
}

#[test]
fn a_rollout_begins_at_its_start_and_settles_at_its_goal() {
    let shown = screw(2.8, 0.5);
    let start = Isometry3::new(Vector3::new(1.0, 2.0, 3.0), Vector3::new(0.1, 0.4, -1.0));
    let goal = Isometry3::new(Vector3::new(0.5, 2.5, 3.0), Vector3::new(-0.6, 0.2, 1.5));
    let request = PoseRequest { settle_s: 1.3, ..PoseRequest::new(start, goal, 1.3, 0.01) };
    let found = learn(&shown).rollout(&request).unwrap();
    assert_eq!(found.motions[0].pose, start);
    assert_relative_eq!(found.times_s[found.times_s.len() - 1], 2.6, epsilon = 1e-12);
    assert!(apart(&found.motions[found.motions.len() - 1].pose, &goal) < 1e-5);
}

#[test]
fn angular_velocity_and_acceleration_are_those_of_the_orientations() {
    for degrees in [80.0, 350.0, 720.0_f64] {
        let shown = screw(degrees.to_radians(), 0.8);
        let mut request = PoseRequest { time_step_s: 0.001, settle_s: 0.1, ..shown_task(&shown) };
        request.goal.rotation = UnitQuaternion::from_scaled_axis(Vector3::new(0.4, -0.3, 0.2)) * request.goal.rotation;
        request.start_velocity = Some(PoseVelocity {
            linear_m_per_s: Vector3::new(0.1, 0.0, -0.2),
            angular_rad_per_s: Vector3::new(0.5, -0.4, 0.3),
        });
        let found = learn(&shown).rollout(&request).unwrap();
        assert_abs_diff_eq!(found.motions[0].angular_velocity_rad_per_s, Vector3::new(0.5, -0.4, 0.3), epsilon = 1e-14);
        for three in found.motions.windows(3) {
            let turn = three[2].pose.rotation * three[0].pose.rotation.inverse();
            let velocity = turn.scaled_axis() / 0.002;
            let change = (three[2].angular_velocity_rad_per_s - three[0].angular_velocity_rad_per_s) / 0.002;
            let linear = (three[2].pose.translation.vector - three[0].pose.translation.vector) / 0.002;
            // central differences over 1 ms at up to some ten rad/s and hundred rad/s²
            assert_abs_diff_eq!(three[1].angular_velocity_rad_per_s, velocity, epsilon = 2e-3);
            assert_abs_diff_eq!(three[1].angular_acceleration_rad_per_s2, change, epsilon = 0.2);
            assert_abs_diff_eq!(three[1].linear_velocity_m_per_s, linear, epsilon = 1e-3);
        }
    }
}

#[test]
fn demonstrations_at_other_places_teach_their_common_shape() {
    let shown = screw(3.0, 0.4);
    let moved = |pose: &Isometry3<f64>| {
        Isometry3::from_parts(Translation3::new(1.0, -2.0, 0.5) * pose.translation, pose.rotation)
    };
    let other = PoseTrajectory::new(shown.times_s().to_vec(), shown.poses().iter().map(moved).collect()).unwrap();
    let both = PoseDmp::learn(&DmpConfig::default(), &[shown.clone(), other]).unwrap();
    assert!(distance(&both.rollout(&shown_task(&shown)).unwrap(), shown.poses()) < FIT);
}

#[test]
fn stepping_allocates_nothing_and_equals_the_rollout() {
    let shown = screw(2.8, 0.5);
    let (primitive, request) = (learn(&shown), shown_task(&shown));
    let found = primitive.rollout(&request).unwrap();
    let mut stepper = primitive.stepper(&request).unwrap();
    let mut steps = coordinates_steps(&primitive, &request);
    assert_eq!(stepper.motion(), &found.motions[0]);
    for (row, step_s) in steps.drain(..).enumerate() {
        let info = allocation_counter::measure(|| stepper.step(step_s).unwrap());
        assert_eq!(info.count_total, 0);
        assert_eq!(stepper.motion(), &found.motions[row + 1]);
    }
}

fn coordinates_steps(primitive: &PoseDmp, request: &PoseRequest) -> Vec<f64> {
    motion::coordinates(primitive, request).time_steps_s().collect()
}

#[test]
fn a_saved_primitive_rolls_out_the_same_bits() {
    let shown = screw(6.0, 0.5);
    let primitive = learn(&shown);
    let text = serde_json::to_string(&primitive.saved()).unwrap();
    let restored = serde_json::from_str::<SavedPose>(&text).unwrap().restore().unwrap();
    assert_eq!(restored, primitive);
    assert_eq!(restored.rollout(&shown_task(&shown)).unwrap(), primitive.rollout(&shown_task(&shown)).unwrap());
}

#[test]
fn a_damaged_file_is_refused() {
    let good = learn(&screw(6.0, 0.5)).saved();
    let refused = |damage: fn(&mut SavedPose)| {
        let mut saved = good.clone();
        damage(&mut saved);
        saved.restore().unwrap_err().to_string()
    };
    assert!(refused(|saved| saved.weights = DMatrix::zeros(50, 5)).contains("found 5 coordinates"));
    assert!(refused(|saved| saved.weights[(3, 4)] = f64::NAN).contains("row 3, column 4 is NaN"));
    assert!(refused(|saved| saved.turn.whole_rad.z += 0.1).contains("turn.whole_rad"));
    assert!(refused(|saved| saved.turn.rest_rad.z = f64::NAN).contains("turn.rest_rad"));
    assert!(refused(|saved| saved.unwound_rad.x = 1.0).contains("unwound_rad"));
    assert!(refused(|saved| saved.config.form = DmpForm::Eq1Literal).contains("form"));
}

#[test]
fn poses_that_tell_no_motion_are_refused() {
    let turned = |angle: f64| Isometry3::new(Vector3::zeros(), Vector3::z() * angle);
    let refused = |poses: Vec<Isometry3<f64>>| PoseTrajectory::new(vec![0.0, 1.0], poses).unwrap_err();
    assert!(matches!(refused(vec![turned(0.0)]), PoseError::Skill(SkillError::RowCount { found: 1, .. })));
    assert!(matches!(refused(vec![turned(0.0), turned(2.0)]), PoseError::FastTurn { row: 1, .. }));
    let long =
        Isometry3::from_parts(Translation3::identity(), Unit::new_unchecked(Quaternion::new(2.0, 0.0, 0.0, 0.0)));
    assert_eq!(refused(vec![turned(0.0), long]), PoseError::NotUnit { row: 1, norm: 2.0 });
    let astray = Isometry3::translation(f64::NAN, 0.0, 0.0);
    assert!(matches!(refused(vec![astray, turned(0.0)]), PoseError::Skill(SkillError::NonFinite { row: 0, .. })));
    let primitive = learn(&screw(1.0, 0.0));
    let request = PoseRequest::new(turned(0.0), long, 1.0, 0.1);
    assert_eq!(primitive.rollout(&request).unwrap_err(), PoseError::NotUnit { row: 1, norm: 2.0 });
    let request = PoseRequest::new(turned(0.0), turned(1.0), -1.0, 0.1);
    assert!(matches!(primitive.rollout(&request), Err(PoseError::Skill(_))));
}

#[test]
fn no_demonstration_other_forms_and_other_ways_round_are_refused() {
    let config = DmpConfig::default();
    assert_eq!(PoseDmp::learn(&config, &[]).unwrap_err(), PoseError::Skill(SkillError::NoDemonstrations));
    let literal = DmpConfig { form: DmpForm::Eq1Literal, ..config.clone() };
    assert!(matches!(PoseDmp::learn(&literal, &[screw(1.0, 0.0)]), Err(PoseError::Skill(_))));
    // to the same goal, once by 100 degrees and once by 260 the other way
    let [one, other] = [100.0, -260.0].map(|degrees: f64| screw(degrees.to_radians(), 0.0));
    let error = PoseDmp::learn(&config, &[one, other]).unwrap_err();
    let PoseError::OtherWayRound { demonstration: 1, apart_rad } = error else { panic!("{error}") };
    assert_relative_eq!(apart_rad, TAU, max_relative = 1e-9);
}

#[test]
fn a_whole_turn_that_is_taken_back_is_refused_unless_about_one_axis() {
    let forth_and_back = |nod: f64| {
        sampled(|r| {
            let window = 16.0 * (r * (1.0 - r)).powi(2);
            let turn = UnitQuaternion::from_scaled_axis(Vector3::x() * (nod * window))
                * UnitQuaternion::from_scaled_axis(Vector3::z() * (7.0 * window));
            Isometry3::from_parts(Translation3::identity(), turn)
        })
    };
    let shown = forth_and_back(0.0);
    assert!(distance(&learn(&shown).rollout(&shown_task(&shown)).unwrap(), shown.poses()) < 10.0 * FIT);
    let error = PoseDmp::learn(&DmpConfig::default(), &[forth_and_back(0.01)]).unwrap_err();
    assert!(matches!(error, PoseError::TurnsBack { demonstration: 0, .. }), "{error}");
}

fn any_rotation() -> impl Strategy<Value = UnitQuaternion<f64>> {
    prop::array::uniform3(-PI..PI).prop_map(|vector| UnitQuaternion::from_scaled_axis(Vector3::from(vector)))
}

fn any_pose() -> impl Strategy<Value = Isometry3<f64>> {
    (prop::array::uniform3(-2.0f64..2.0), any_rotation())
        .prop_map(|(place, turn)| Isometry3::from_parts(Translation3::from(Vector3::from(place)), turn))
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(32))]

    #[test]
    fn orientations_stay_of_unit_length_for_any_steps(
        start in any_pose(), goal in any_pose(), steps in prop::collection::vec(1e-6f64..0.5, 1..200),
    ) {
        let primitive = learn(&screw(4.0, 1.0));
        let mut stepper = primitive.stepper(&PoseRequest::new(start, goal, DURATION_S, 0.01)).unwrap();
        for step_s in steps {
            stepper.step(step_s).unwrap();
            prop_assert!((stepper.motion().pose.rotation.into_inner().norm() - 1.0).abs() < 1e-12);
        }
    }

    #[test]
    fn demonstration_and_request_turned_together_turn_the_motion(frame in any_pose(), goal in any_pose()) {
        let shown = screw(3.0, 0.5);
        let there = shown.poses().iter().map(|pose| frame * pose).collect();
        let there = PoseTrajectory::new(shown.times_s().to_vec(), there).unwrap();
        let request = PoseRequest { goal, ..shown_task(&shown) };
        // nearly as far one way round as the other, rounding decides
        let way = (request.goal.rotation * request.start.rotation.inverse() * UnitQuaternion::from_scaled_axis(-Vector3::z() * 3.0)).angle();
        prop_assume!(way < 3.0);
        let moved = PoseRequest { start: frame * request.start, goal: frame * request.goal, ..request.clone() };
        let (found, moved) = (learn(&shown).rollout(&request).unwrap(), learn(&there).rollout(&moved).unwrap());
        for (here, there) in found.motions.iter().zip(&moved.motions) {
            prop_assert!(apart(&(frame * here.pose), &there.pose) < ROUNDING);
            let velocity = frame.rotation * here.angular_velocity_rad_per_s;
            prop_assert!((velocity - there.angular_velocity_rad_per_s).norm() < 10.0 * ROUNDING);
            let change = frame.rotation * here.angular_acceleration_rad_per_s2;
            prop_assert!((change - there.angular_acceleration_rad_per_s2).norm() < 1e3 * ROUNDING);
        }
    }

    #[test]
    fn the_axes_of_the_body_may_be_named_anew(renamed in any_rotation()) {
        let shown = screw(3.0, 0.5);
        let rename = |pose: &Isometry3<f64>| Isometry3::from_parts(pose.translation, pose.rotation * renamed);
        let there = shown.poses().iter().map(rename).collect();
        let there = PoseTrajectory::new(shown.times_s().to_vec(), there).unwrap();
        let mut request = shown_task(&shown);
        request.goal.rotation = UnitQuaternion::from_scaled_axis(Vector3::x() * 0.7) * request.goal.rotation;
        let other = PoseRequest { start: rename(&request.start), goal: rename(&request.goal), ..request.clone() };
        let (found, other) = (learn(&shown).rollout(&request).unwrap(), learn(&there).rollout(&other).unwrap());
        for (here, there) in found.motions.iter().zip(&other.motions) {
            prop_assert!(apart(&rename(&here.pose), &there.pose) < ROUNDING);
        }
    }
}
