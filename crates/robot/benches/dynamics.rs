//! Cost of the kinematics and dynamics of the Panda (seven joints), at one random state after another.
//!
//! Forward kinematics of all bodies is part of every figure (`set_positions`, and `set_state` with velocities where the
//! algorithm needs them), as every control step starts with it; terms that are asked for together share it.

#![expect(clippy::expect_used, reason = "a bench stops at the first surprise")]

use std::hint::black_box;
use std::time::Instant;

use criterion::{Criterion, criterion_group, criterion_main};
use nalgebra::{DMatrix, DVector, Matrix6xX};
use robot::{Manipulator, Workspace};

/// States visited in turn, so that no branch or cache learns one of them.
const STATES: usize = 64;
/// Calls of one batch (about 0.05 ms) and batches, of which the least time is printed.
const BATCH: usize = 64;
const BATCHES: usize = 5000;

/// Pseudo-random numbers in (−1, 1).
fn noise(seed: &mut u64) -> f64 {
    *seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
    (*seed >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
}

/// Positions within the limits and velocities up to 2 rad/s.
fn states(arm: &Manipulator) -> Vec<(DVector<f64>, DVector<f64>)> {
    let mut seed = 1;
    let mut state = || {
        let within = |joint: &robot::Joint, seed: &mut u64| {
            let (lower, upper) = (joint.limits.lower.expect("limited"), joint.limits.upper.expect("limited"));
            0.5 * (lower + upper) + 0.5 * (upper - lower) * noise(seed)
        };
        let q = DVector::from_iterator(7, arm.joints().iter().map(|joint| within(joint, &mut seed)));
        (q, DVector::from_fn(7, |_, _| 2.0 * noise(&mut seed)))
    };
    (0..STATES).map(|_| state()).collect()
}

/// Least time of a call (ns) over many short batches, which other programs on the machine disturb least.
fn least_ns(call: &mut impl FnMut()) -> f64 {
    let batch = |call: &mut dyn FnMut()| {
        let begun = Instant::now();
        (0..BATCH).for_each(|_| call());
        begun.elapsed().as_secs_f64() * 1e9 / BATCH as f64
    };
    (0..BATCHES).map(|_| batch(call)).fold(f64::INFINITY, f64::min)
}

fn dynamics(criterion: &mut Criterion) {
    let arm = Manipulator::from_urdf_str(include_str!("../../../assets/robots/panda.urdf")).expect("a model");
    let tip = arm.frame("panda_hand_tcp").expect("known");
    let states = states(&arm);
    let mut workspace = arm.workspace();
    let (mut mass, mut coriolis) = (DMatrix::zeros(7, 7), DMatrix::zeros(7, 7));
    let (mut gravity, mut out) = (DVector::zeros(7), DVector::zeros(7));
    let mut jacobian = Matrix6xX::zeros(7);
    let efforts = DVector::from_fn(7, |joint, _| 3.0 - joint as f64);
    let mut group = criterion.benchmark_group("panda");
    let mut visit = |name: &str, moving: bool, work: &mut dyn FnMut(&mut Workspace)| {
        let mut visited = states.iter().cycle();
        let mut call = || {
            let (q, dq) = visited.next().expect("a cycle");
            let placed = match moving {
                true => workspace.set_state(black_box(q), black_box(dq)),
                false => workspace.set_positions(black_box(q)),
            };
            placed.expect("seven joints");
            work(&mut workspace);
        };
        println!("panda/{name}: least {:.0} ns", least_ns(&mut call));
        group.bench_function(name, |bench| bench.iter(&mut call));
    };
    visit("forward kinematics", false, &mut |_| ());
    visit("forward kinematics with velocities", true, &mut |_| ());
    visit("pose of the tip", false, &mut |workspace| {
        black_box(workspace.base_from_frame(tip));
    });
    visit("Jacobian", false, &mut |workspace| workspace.jacobian_into(tip, black_box(&mut jacobian)));
    visit("gravity", false, &mut |workspace| workspace.gravity_into(black_box(&mut gravity)));
    visit("mass matrix (CRBA)", false, &mut |workspace| workspace.mass_matrix_into(black_box(&mut mass)));
    visit("inverse dynamics (RNEA)", true, &mut |workspace| {
        workspace.inverse_dynamics_into(&efforts, black_box(&mut out)).expect("seven joints");
    });
    visit("forward dynamics (ABA)", true, &mut |workspace| {
        workspace.forward_dynamics_into(&efforts, black_box(&mut out)).expect("seven joints");
    });
    visit("Coriolis matrix", true, &mut |workspace| workspace.coriolis_matrix_into(black_box(&mut coriolis)));
    visit("M, C, g and J", true, &mut |workspace| {
        workspace.mass_matrix_into(black_box(&mut mass));
        workspace.coriolis_matrix_into(black_box(&mut coriolis));
        workspace.gravity_into(black_box(&mut gravity));
        workspace.jacobian_into(tip, black_box(&mut jacobian));
    });
    group.finish();
}

criterion_group!(benches, dynamics);
criterion_main!(benches);
