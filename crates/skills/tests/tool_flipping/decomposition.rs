//! Division of a flip by a virtual object movement and recombination, Eqs. (22)–(28) and (39)–(46).

use approx::assert_relative_eq;
use nalgebra::{DMatrix, DVector, dvector};
use skills::time_law::minimum_jerk;
use skills::tool_flipping::FlipError;
use skills::tool_flipping::decomposition::FlipFactors;
use skills::tool_flipping::factors::{FactorKind, similarity};
use skills::{Dmp, DmpConfig, DmpForm, MovementPrimitive, RolloutRequest, Trajectory};

/// Rounding of sums of terms of order one, after αβ = 156 in the dynamics.
const ROUNDING: f64 = 1e-12;
/// Fit of 50 bases to a motion of order one and the part of the way left at T.
const FIT: f64 = 2e-3;

/// Samples a planar motion over one second.
fn motion(place: impl Fn(f64) -> [f64; 2]) -> Trajectory {
    Trajectory::uniform(0.005, DMatrix::from_fn(201, 2, |row, column| place(row as f64 / 200.0)[column])).unwrap()
}

fn bump(r: f64) -> f64 {
    16.0 * (r * (1.0 - r)).powi(2)
}

/// The way of a tool from (1, 2) to (−1, 1), with a detour.
fn flip() -> Trajectory {
    motion(|r| {
        let m = minimum_jerk(r);
        [1.0 - 2.0 * m + 0.3 * bump(r), 2.0 - m - 1.4 * bump(r)]
    })
}

/// A virtual movement from the same start by (−1, 2), with a bulge.
fn arch(height: f64) -> Trajectory {
    motion(|r| {
        let m = minimum_jerk(r);
        [1.0 - m - height * bump(r), 2.0 + 2.0 * m - height * bump(r)]
    })
}

fn learn(form: DmpForm, shown: Trajectory) -> Dmp {
    Dmp::learn(&DmpConfig { form, ..DmpConfig::default() }, &[shown]).unwrap()
}

fn roll(dmp: &Dmp, start: &DVector<f64>, goal: &DVector<f64>) -> Trajectory {
    let request = RolloutRequest::new(start.clone(), goal.clone(), 1.0, 0.005);
    dmp.rollout(&request).unwrap().into_positions()
}

/// k1 = i·1.1 + 0.4 and k2 = 0.7.
fn turning() -> FlipFactors {
    let k1 = FactorKind::Complex.factor(&dvector![1.0, 0.0], &dvector![0.6 / 1.7, -1.1 / 1.7], 0.7).unwrap();
    assert_relative_eq!(k1.matrix[(1, 0)], 1.1, epsilon = ROUNDING);
    FlipFactors::new(k1, 0.7).unwrap()
}

#[test]
fn flips_divided_and_recombined_are_the_plain_primitive() {
    let (start, goal, object_goal) = (dvector![0.4, -1.0], dvector![2.0, 0.3], dvector![-0.5, 0.8]);
    let mut worst = 0.0f64;
    for form in [DmpForm::Residual, DmpForm::Eq1Literal] {
        let (flip, object) = (learn(form, flip()), learn(form, arch(0.5)));
        let all = [0.0, 0.5, 1.0, 3.0].map(|k2| FlipFactors::identity(2, k2).unwrap());
        for factors in all.into_iter().chain([turning()]) {
            let tool = factors.divided(&flip, &object).unwrap();
            let tool_goal = factors.tool_goal(&start, &goal, &object_goal).unwrap();
            let by_28 =
                factors.path(&start, &roll(&tool, &start, &tool_goal), &roll(&object, &start, &object_goal)).unwrap();
            let plain = roll(&flip, &start, &goal);
            worst = worst.max((by_28.samples() - plain.samples()).amax());
            let recombined = roll(&factors.recombined(&tool, &object).unwrap(), &start, &goal);
            worst = worst.max((recombined.samples() - plain.samples()).amax());
        }
    }
    println!("largest difference of the recombined flip from the plain primitive: {worst:.1e}");
    assert!(worst < ROUNDING);
}

#[test]
fn another_outline_adds_the_difference_of_the_outlines() {
    let (flip, old, new) =
        (learn(DmpForm::Residual, flip()), learn(DmpForm::Residual, arch(0.2)), learn(DmpForm::Residual, arch(0.9)));
    let factors = FlipFactors::identity(2, 1.3).unwrap();
    let changed = factors.recombined(&factors.divided(&flip, &old).unwrap(), &new).unwrap();
    let expected = flip.weights() + (new.weights() - old.weights()) * 1.3;
    assert!((changed.weights() - expected).amax() < 1e-9 * flip.weights().amax());
}

#[test]
fn the_divided_primitive_is_that_of_the_divided_demonstration() {
    // Eq. (23) solved for x^t before learning: the dynamics are linear
    let factors = turning();
    let (flip, arch) = (flip(), arch(0.5));
    let start = flip.start();
    let k1 = factors.k1().clone().try_inverse().unwrap();
    let divided = DMatrix::from_fn(201, 2, |row, column| {
        let offset = (flip.samples().row(row) - start.transpose())
            - (arch.samples().row(row) - start.transpose()) * factors.k2();
        (&start + &k1 * offset.transpose())[column]
    });
    let before = learn(DmpForm::Residual, Trajectory::uniform(0.005, divided).unwrap());
    let after = factors.divided(&learn(DmpForm::Residual, flip), &learn(DmpForm::Residual, arch)).unwrap();
    assert!((before.weights() - after.weights()).amax() < 1e-8 * after.weights().amax());
}

#[test]
fn the_solved_goal_leads_the_flip_to_its_goal() {
    // k1 = I is exact where (27) is not: also without any displacement of the contact on the object
    let start = dvector![1.0, 2.0];
    let factors = FlipFactors::identity(2, 1.0).unwrap();
    let (object, flip) = (learn(DmpForm::Residual, arch(0.5)), learn(DmpForm::Residual, flip()));
    let tool = factors.divided(&flip, &object).unwrap();
    for (a, b) in [(dvector![-3.0, 1.0], dvector![-1.0, 2.0]), (dvector![0.0, 0.0], dvector![1.0, 1.0])] {
        let (goal, object_goal) = (&start + &a - &b, &start + &b);
        let tool_goal = factors.tool_goal(&start, &goal, &object_goal).unwrap();
        let path =
            factors.path(&start, &roll(&tool, &start, &tool_goal), &roll(&object, &start, &object_goal)).unwrap();
        assert!((path.end() - &goal).norm() < FIT);
        assert_eq!(path.start(), start);
    }
}

#[test]
fn e13_the_sign_printed_in_equation_45_leaves_a_term_in_46() {
    // scalars: α, β, τ and a state of each system
    let (alpha, beta) = (25.0, 6.25);
    let (x0, k1, k2) = (1.3, 0.8, 0.7);
    let (x_t, v_t, x_o, v_o, f_t, f_o) = (0.4, -0.9, 0.2, 1.1, 3.0, -5.0);
    let (goal_t, goal_o) = (-0.6, 2.1);
    // (23), (39) and (46) at this state
    let mixed = |t: f64, o: f64| x0 + k1 * (t - x0) + k2 * (o - x0);
    let goal = mixed(goal_t, goal_o);
    let solved = FlipFactors::new(FactorKind::Similarity.factor(&dvector![1.0], &dvector![0.2 / 1.7], k2).unwrap(), k2);
    let solved = solved.unwrap().tool_goal(&dvector![x0], &dvector![goal], &dvector![goal_o]).unwrap();
    assert_relative_eq!(solved[0], goal_t, epsilon = ROUNDING);
    let f = k1 * f_t + k2 * f_o;
    let acceleration = |goal: f64, x: f64, v: f64, f: f64| alpha * (beta * (goal - x) - v) + f;
    let flip = acceleration(goal, mixed(x_t, x_o), k1 * v_t + k2 * v_o, f);
    assert_relative_eq!(
        flip,
        k1 * acceleration(goal_t, x_t, v_t, f_t) + k2 * acceleration(goal_o, x_o, v_o, f_o),
        epsilon = ROUNDING
    );
    // (45): k2·τv̇^o told by g̃ = g^Tf − k1·g^t and x0
    let told = |sign: f64| {
        alpha * (beta * ((goal - k1 * goal_t) - k2 * x_o) - k2 * v_o) + f - k1 * f_t
            + sign * alpha * beta * (1.0 - k1 - k2) * x0
    };
    let true_value = k2 * acceleration(goal_o, x_o, v_o, f_o);
    assert_relative_eq!(told(-1.0), true_value, epsilon = ROUNDING);
    assert_relative_eq!(told(1.0) - true_value, -2.0 * alpha * beta * (k1 + k2 - 1.0) * x0, epsilon = 1e-10);
}

#[test]
fn a_turned_displacement_turns_the_own_way_of_the_tool() {
    let quarter = similarity(&dvector![1.0, 0.0], &dvector![0.0, 2.0]).unwrap();
    let factors = FlipFactors::identity(2, 1.0).unwrap();
    let (flip, object) = (learn(DmpForm::Residual, flip()), learn(DmpForm::Residual, arch(0.5)));
    let tool = factors.divided(&flip, &object).unwrap();
    let zero = dvector![0.0, 0.0];
    let shown = roll(&tool, &zero, &zero);
    let turned = shown.samples() * quarter.transpose();
    for row in [50, 100, 150] {
        assert_relative_eq!(turned[(row, 1)], 2.0 * shown.samples()[(row, 0)], epsilon = ROUNDING);
        assert_relative_eq!(turned[(row, 0)], -2.0 * shown.samples()[(row, 1)], epsilon = ROUNDING);
    }
}

#[test]
fn primitives_that_share_no_phase_and_factors_without_inverse_are_refused() {
    let flip_dmp = learn(DmpForm::Residual, flip());
    let factors = FlipFactors::identity(2, 1.0).unwrap();
    let fewer = Dmp::learn(&DmpConfig { bases: 20, ..DmpConfig::default() }, &[arch(0.5)]).unwrap();
    let literal = learn(DmpForm::Eq1Literal, arch(0.5));
    let scaled = learn(DmpForm::Scaled, flip());
    // ends in motion, so that its forcing term fades earlier
    let moving = learn(DmpForm::Residual, motion(|r| [r, r * r]));
    for other in [&fewer, &literal, &moving] {
        assert_eq!(factors.divided(&flip_dmp, other), Err(FlipError::UnsharedSystem));
    }
    assert_eq!(factors.divided(&scaled, &scaled), Err(FlipError::UnsharedSystem));
    let singular = FactorKind::Literal.factor(&dvector![1.0, 0.0], &dvector![0.5, 0.0], 1.0).unwrap();
    assert!(matches!(FlipFactors::new(singular, 1.0), Err(FlipError::Singular { .. })));
    assert!(matches!(FlipFactors::identity(3, 1.0).unwrap().divided(&flip_dmp, &flip_dmp), Err(FlipError::Skill(_))));
    let short = Trajectory::uniform(0.005, DMatrix::zeros(3, 2)).unwrap();
    assert!(factors.path(&dvector![0.0, 0.0], &flip(), &short).is_err());
    assert!(factors.tool_goal(&dvector![0.0], &dvector![0.0, 0.0], &dvector![0.0, 0.0]).is_err());
}
