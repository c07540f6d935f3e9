//! Cost of inverse kinematics of the Panda's tool center point to 1e-6 m and rad from random and from near starts, with
//! and without a preferred posture, and of one sample of a followed path.
//!
//! The times of single targets differ widely, so their median and ninth decile are printed beside the mean that the bench
//! reports; each target counts with the least of a few repetitions, as the machine may be shared.

#![expect(clippy::expect_used, reason = "a bench stops at the first surprise")]

use std::hint::black_box;
use std::time::Instant;

use criterion::{Criterion, criterion_group, criterion_main};
use nalgebra::{DVector, Isometry3, Vector6};
use robot::{
    DifferentialKinematics, FrameId, FrameMotion, InverseKinematics, InverseKinematicsOptions, JointReference,
    Manipulator, Redundancy, TaskRows,
};

const TARGETS: usize = 1000;
const REPETITIONS: usize = 7;
const TOLERANCE: f64 = 1e-6;
const READY: [f64; 7] = [0.0, -0.785, 0.0, -2.356, 0.0, 1.571, 0.785];

/// Pseudo-random numbers in (−1, 1).
fn noise(seed: &mut u64) -> f64 {
    *seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
    (*seed >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
}

fn posture(arm: &Manipulator, seed: &mut u64) -> DVector<f64> {
    let within = |joint: &robot::Joint| {
        let (lower, upper) = (joint.limits.lower.expect("limited"), joint.limits.upper.expect("limited"));
        0.5 * (lower + upper) + 0.5 * (upper - lower) * noise(seed)
    };
    DVector::from_iterator(arm.joint_count(), arm.joints().iter().map(within))
}

/// Three uniform numbers of variance 1/3 add up to nearly a normal one of variance 1.
fn nearly_normal(seed: &mut u64) -> f64 {
    noise(seed) + noise(seed) + noise(seed)
}

/// A reachable pose, a random start, and one about 0.1 rad from an answer at each joint.
struct Question {
    target: Isometry3<f64>,
    random: DVector<f64>,
    near: DVector<f64>,
}

fn questions(arm: &Manipulator, tip: FrameId) -> Vec<Question> {
    let mut workspace = arm.workspace();
    let mut seed = 1;
    let mut question = || {
        let truth = posture(arm, &mut seed);
        workspace.set_positions(&truth).expect("seven joints");
        let random = posture(arm, &mut seed);
        let near = truth.map(|q| q + 0.1 * nearly_normal(&mut seed));
        Question { target: workspace.base_from_frame(tip), random, near }
    };
    (0..TARGETS).map(|_| question()).collect()
}

/// Chooses where a question starts from.
type Start = fn(&Question) -> &DVector<f64>;

/// Prints the distribution of the time for one target over all of them.
fn print_times(name: &str, solver: &mut InverseKinematics, questions: &[Question], start: Start) {
    let mut solved = 0;
    let mut q = DVector::zeros(7);
    let mut time_us = |question: &Question| {
        let mut least = f64::INFINITY;
        for repetition in 0..REPETITIONS {
            q.copy_from(start(question));
            let begun = Instant::now();
            let answer = solver.solve_in_place(black_box(&question.target), &mut q);
            least = least.min(begun.elapsed().as_secs_f64() * 1e6);
            solved += usize::from(repetition == 0 && answer.is_ok());
        }
        least
    };
    let mut times: Vec<f64> = questions.iter().map(&mut time_us).collect();
    times.sort_by(f64::total_cmp);
    let mean = times.iter().sum::<f64>() / TARGETS as f64;
    let (median, decile) = (times[TARGETS / 2], times[TARGETS * 9 / 10]);
    println!("{name}: {solved} of {TARGETS}; median {median:.2} us, ninth decile {decile:.1} us, mean {mean:.1} us");
}

fn inverse_kinematics(criterion: &mut Criterion) {
    let arm = Manipulator::from_urdf_str(include_str!("../../../assets/robots/panda.urdf")).expect("a model");
    let tip = arm.frame("panda_hand_tcp").expect("known");
    let questions = questions(&arm, tip);
    let mut group = criterion.benchmark_group("inverse kinematics");
    let starts: [(&str, Start); 2] = [("random", |q| &q.random), ("near", |q| &q.near)];
    for (posture, preferred_posture) in [("", None), (", posture", Some(DVector::from_column_slice(&READY)))] {
        let options = InverseKinematicsOptions {
            position_tolerance_m: TOLERANCE,
            angle_tolerance_rad: TOLERANCE,
            preferred_posture,
            ..InverseKinematicsOptions::default()
        };
        let mut solver = InverseKinematics::new(&arm, tip, TaskRows::Pose, options).expect("a solver");
        for (name, start) in starts {
            let name = format!("{name} start{posture}");
            print_times(&name, &mut solver, &questions, start);
            let mut visited = questions.iter().cycle();
            let mut q = DVector::zeros(7);
            group.bench_function(name, |bench| {
                bench.iter(|| {
                    let question = visited.next().expect("a cycle");
                    q.copy_from(start(question));
                    solver.solve_in_place(&question.target, &mut q).is_ok()
                });
            });
        }
    }
    group.finish();
}

/// A sample of a path 0.1 m wide, 1 ms after another.
fn following(criterion: &mut Criterion) {
    let arm = Manipulator::from_urdf_str(include_str!("../../../assets/robots/panda.urdf")).expect("a model");
    let tip = arm.frame("panda_hand_tcp").expect("known");
    let ready = DVector::from_column_slice(&READY);
    let mut workspace = arm.workspace();
    workspace.set_positions(&ready).expect("seven joints");
    let start = workspace.base_from_frame(tip);
    let wanted_at = |sample: u32| {
        let (sine, cosine) = (std::f64::consts::TAU * 1e-3 * f64::from(sample)).sin_cos();
        let mut base_from_frame = start;
        base_from_frame.translation.y += 0.05 * sine;
        FrameMotion {
            base_from_frame,
            velocity: Vector6::new(0.0, 0.05 * std::f64::consts::TAU * cosine, 0.0, 0.0, 0.0, 0.0),
            acceleration: Vector6::new(0.0, -0.05 * std::f64::consts::TAU.powi(2) * sine, 0.0, 0.0, 0.0, 0.0),
        }
    };
    let wanted: Vec<FrameMotion> = (0..1000).map(wanted_at).collect();
    let policy = Redundancy::toward(ready.clone(), 1e-3);
    let followers = [
        ("shortest motion", DifferentialKinematics::new(&arm, tip, TaskRows::Pose)),
        ("posture policy", DifferentialKinematics::with_redundancy(&arm, tip, TaskRows::Pose, policy)),
    ];
    let mut group = criterion.benchmark_group("follow");
    for (name, follower) in followers {
        let mut follower = follower.expect("a follower");
        let mut reference = JointReference::at_rest(ready.clone());
        let mut visited = wanted.iter().cycle();
        group.bench_function(name, |bench| {
            bench.iter(|| follower.follow(visited.next().expect("a cycle"), &mut reference).expect("within reach"));
        });
    }
    group.finish();
}

criterion_group!(benches, inverse_kinematics, following);
criterion_main!(benches);
