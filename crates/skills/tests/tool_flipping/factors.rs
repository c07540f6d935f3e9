//! The factor k1 against numbers of an independent program and against what is printed.

use approx::assert_relative_eq;
use nalgebra::{DMatrix, DVector, dvector};
use proptest::prelude::*;
use rand::{RngExt, SeedableRng};
use skills::tool_flipping::FlipError;
use skills::tool_flipping::factors::{FactorKind, similarity};

use super::scenes::{number, numbers, vectors};

/// Both programs work in double precision.
const VECTORS: f64 = 1e-12;
/// A few roundings, relative to the displacements.
const ROUNDING: f64 = 1e-13;
/// A median of 4000 samples, relative: some standard errors.
const SAMPLED: f64 = 0.08;

fn matrix(value: &serde_json::Value) -> DMatrix<f64> {
    let rows: Vec<Vec<f64>> = value.as_array().unwrap().iter().map(numbers).collect();
    DMatrix::from_fn(rows.len(), rows.len(), |row, column| rows[row][column])
}

fn vector(value: &serde_json::Value) -> DVector<f64> {
    DVector::from_vec(numbers(value))
}

/// By how much Eq. (39), (I − k1)·a = (1 + k2)·b, is missed, relative to its right side.
fn miss(k1: &DMatrix<f64>, a: &DVector<f64>, b: &DVector<f64>, k2: f64) -> f64 {
    (a - k1 * a - b * (1.0 + k2)).norm() / (b * (1.0 + k2)).norm()
}

fn factor(kind: FactorKind, a: &DVector<f64>, b: &DVector<f64>, k2: f64) -> DMatrix<f64> {
    kind.factor(a, b, k2).unwrap().matrix
}

#[test]
fn complex_factors_agree_with_the_reference() {
    for case in vectors()["planar"].as_array().unwrap() {
        let (a, b, k2) = (vector(&case["a"]), vector(&case["b"]), number(&case["k2"]));
        let found = FactorKind::Complex.factor(&a, &b, k2).unwrap();
        assert_relative_eq!(found.matrix, matrix(&case["K1"]), epsilon = VECTORS);
        let k1 = numbers(&case["k1"]);
        assert_relative_eq!(found.scale, k1[0].hypot(k1[1]), epsilon = VECTORS);
        if let Some(literal) = case["literal_k1_eq27"].as_f64() {
            assert_relative_eq!(factor(FactorKind::Literal, &a, &b, k2)[(0, 0)], literal, epsilon = VECTORS);
        }
    }
}

#[test]
fn similarities_agree_with_the_reference() {
    for case in vectors()["similarity_nd"].as_array().unwrap() {
        let found = similarity(&vector(&case["a"]), &vector(&case["c"])).unwrap();
        assert_relative_eq!(found, matrix(&case["K1"]), epsilon = VECTORS);
        assert_relative_eq!(found.determinant(), number(&case["det"]), epsilon = VECTORS);
    }
}

#[test]
fn e11_the_printed_factor_depends_on_the_unit_of_length_and_the_complex_one_does_not() {
    // contacts 2 cm apart on object and tool
    let (a, b) = (dvector![2.0, 0.0], dvector![2.0, 0.0]);
    let (a_mm, b_mm) = (&a * 10.0, &b * 10.0);
    assert_relative_eq!(factor(FactorKind::Literal, &a, &b, 1.0)[(0, 0)], -7.0, epsilon = VECTORS);
    assert_relative_eq!(factor(FactorKind::Literal, &a_mm, &b_mm, 1.0)[(0, 0)], -799.0, epsilon = VECTORS);
    for kind in [FactorKind::NormalizedScalar, FactorKind::Complex, FactorKind::Similarity] {
        assert_relative_eq!(factor(kind, &a, &b, 1.0), factor(kind, &a_mm, &b_mm, 1.0), epsilon = VECTORS);
    }
}

#[test]
fn e11_the_printed_factor_misses_equation_39_sixfold_and_the_complex_one_meets_it() {
    let mut random = rand_chacha::ChaCha8Rng::seed_from_u64(11);
    // Box–Muller, standard deviation 3: the printed factor depends on the unit
    let mut normals = || {
        let (radius, angle) = ((-2.0 * (1.0 - random.random::<f64>()).ln()).sqrt(), random.random::<f64>());
        let (sin, cos) = (std::f64::consts::TAU * angle).sin_cos();
        dvector![3.0 * radius * cos, 3.0 * radius * sin]
    };
    let pairs: Vec<_> = (0..4000).map(|_| (normals(), normals())).collect();
    let median = |kind: FactorKind| {
        let mut misses: Vec<f64> = pairs.iter().map(|(a, b)| miss(&factor(kind, a, b, 1.0), a, b, 1.0)).collect();
        misses.sort_by(f64::total_cmp);
        misses[misses.len() / 2]
    };
    let (literal, scalar) = (median(FactorKind::Literal), median(FactorKind::NormalizedScalar));
    println!("median relative miss: literal {literal:.2}, normalized {scalar:.2}");
    assert_relative_eq!(literal, 6.0, max_relative = SAMPLED);
    // what is across a is left: the median of |sin| of a uniform angle
    assert_relative_eq!(scalar, 0.5f64.sqrt(), max_relative = SAMPLED);
    assert!(median(FactorKind::Complex) < ROUNDING && median(FactorKind::Similarity) < ROUNDING);
}

#[test]
fn e11_the_normalized_scalar_meets_the_goal_of_parallel_displacements_only() {
    let a = dvector![3.0, -1.0];
    for ratio in [-2.0, 0.3, 0.5, 4.0] {
        let b = &a * ratio;
        assert!(miss(&factor(FactorKind::NormalizedScalar, &a, &b, 1.0), &a, &b, 1.0) < ROUNDING);
        assert!(miss(&factor(FactorKind::Literal, &a, &b, 1.0), &a, &b, 1.0) > 1.0);
    }
    let across = dvector![1.0, 3.0];
    assert!(miss(&factor(FactorKind::NormalizedScalar, &a, &across, 1.0), &a, &across, 1.0) > 0.5);
}

#[test]
fn e12_equation_40_holds_for_the_swapped_names_only() {
    // a tool that touches an object at rest with another contact: p + c_tool = c_object before and after
    let (on_object, on_tool) = (dvector![-3.0, 1.0], dvector![-1.0, 2.0]);
    let tool_moves = &on_object - &on_tool;
    let k2 = 1.0;
    // as the algebra of (40) has it: a = g^t − x0 on the object, b = g^o − x0 on the tool
    let swapped = factor(FactorKind::Complex, &on_object, &on_tool, k2);
    assert_relative_eq!(&swapped * &on_object + &on_tool * k2, tool_moves, epsilon = VECTORS);
    // with Δx^t of x^t and Δx^o of x^o the factor is another one and leads elsewhere
    let by_name = factor(FactorKind::Complex, &on_tool, &on_object, k2);
    assert!((by_name * &on_object + &on_tool * k2 - &tool_moves).norm() > 0.5 * tool_moves.norm());
}

#[test]
fn displacements_that_cannot_be_turned_are_refused() {
    let (zero, one) = (dvector![0.0, 0.0], dvector![1.0, 0.0]);
    for kind in [FactorKind::NormalizedScalar, FactorKind::Complex, FactorKind::Similarity] {
        assert!(matches!(kind.factor(&zero, &one, 1.0), Err(FlipError::NoDisplacement { .. })), "{kind:?}");
    }
    // c = a − 2b = 0
    let half = FactorKind::Similarity.factor(&one, &dvector![0.5, 0.0], 1.0);
    assert!(matches!(half, Err(FlipError::NoDisplacement { .. })));
    assert!(FactorKind::Identity.factor(&zero, &zero, 1.0).is_ok());
    let space = dvector![1.0, 2.0, 3.0];
    assert!(matches!(FactorKind::Complex.factor(&space, &space, 1.0), Err(FlipError::Skill(_))));
    assert!(FactorKind::Literal.factor(&one, &space, 1.0).is_err());
    assert!(FactorKind::Literal.factor(&one, &dvector![f64::NAN, 0.0], 1.0).is_err());
    assert!(FactorKind::Literal.factor(&one, &one, f64::INFINITY).is_err());
}

#[test]
fn factors_far_from_one_are_told() {
    let a = dvector![1.0, 0.0];
    let scaled = |b: f64| FactorKind::Complex.factor(&a, &dvector![b, 0.0], 1.0).unwrap();
    assert!(scaled(0.3).is_well_scaled());
    assert!(!scaled(0.48).is_well_scaled() && !scaled(8.0).is_well_scaled());
}

proptest! {
    #[test]
    fn similarities_meet_the_goal_in_any_dimension(
        values in prop::collection::vec(-3.0f64..3.0, 12), dimension in 1usize..=6, k2 in -0.9f64..2.0,
    ) {
        let a = DVector::from_column_slice(&values[..dimension]);
        let b = DVector::from_column_slice(&values[6..6 + dimension]);
        let c = &a - &b * (1.0 + k2);
        prop_assume!(a.norm() > 0.1 && c.norm() > 0.1);
        let found = FactorKind::Similarity.factor(&a, &b, k2).unwrap();
        prop_assert!((&found.matrix * &a - &c).norm() < 1e-12 * (1.0 + c.norm()));
        // a similarity: KᵀK = |k1|²·I, without reflection from two dimensions on
        let gram = found.matrix.transpose() * &found.matrix;
        let expected = DMatrix::identity(dimension, dimension) * found.scale.powi(2);
        prop_assert!((gram - expected).norm() < 1e-11 * (1.0 + found.scale.powi(2)));
        prop_assert!(dimension == 1 || found.matrix.determinant() > 0.0);
    }
}
