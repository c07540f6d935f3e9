//! Tests of the designs: published points, strata, discrepancy against random points, and what stays when a design grows.

use super::*;

/// Coordinates of points of the sequence before any shift.
fn unshifted(count: usize, factors: usize) -> Vec<Vec<f64>> {
    let scale = |bits: u64| bits as f64 / 2.0_f64.powi(64);
    sequence(factors).take(count).map(|point| point.into_iter().map(scale).collect()).collect()
}

#[test]
fn the_sequence_begins_as_published() {
    // S. Joe and F. Y. Kuo, "Notes on generating Sobol' sequences", 2008: the first ten points in three dimensions
    let expected = [
        [0.0, 0.0, 0.0],
        [0.5, 0.5, 0.5],
        [0.75, 0.25, 0.25],
        [0.25, 0.75, 0.75],
        [0.375, 0.375, 0.625],
        [0.875, 0.875, 0.125],
        [0.625, 0.125, 0.875],
        [0.125, 0.625, 0.375],
        [0.1875, 0.3125, 0.9375],
        [0.6875, 0.8125, 0.4375],
    ];
    assert_eq!(unshifted(expected.len(), 3), expected);
}

#[test]
fn the_longest_sequence_has_one_point_per_stratum_of_every_factor() {
    for factor in strata_counts(&unshifted(256, 100), 256) {
        assert!(factor.iter().all(|&count| count == 1), "{factor:?}");
    }
}

/// For each factor, how many points lie in each of `strata` equal parts.
fn strata_counts(points: &[Vec<f64>], strata: usize) -> Vec<Vec<usize>> {
    let mut counts = vec![vec![0; strata]; points[0].len()];
    for point in points {
        for (factor, coordinate) in point.iter().enumerate() {
            counts[factor][(coordinate * strata as f64) as usize] += 1;
        }
    }
    counts
}

#[test]
fn a_latin_hypercube_has_one_point_per_stratum_of_every_factor() {
    for (count, seed) in [(1, 1), (2, 1), (7, 3), (100, 1), (1000, 9), (100_003, 2)] {
        for factor in strata_counts(&latin_hypercube(count, 3, seed), count as usize) {
            assert!(factor.iter().all(|&found| found == 1), "{count} points with seed {seed}");
        }
    }
}

#[test]
fn the_factors_of_a_latin_hypercube_are_not_in_step() {
    let points = latin_hypercube(400, 2, 1);
    let products: f64 = points.iter().map(|point| (point[0] - 0.5) * (point[1] - 0.5)).sum();
    // the standard deviation of a correlation of 400 independent pairs is 1 / 20
    assert!((products / 400.0 * 12.0).abs() < 4.0 / 20.0, "{products}");
}

#[test]
fn a_shifted_sequence_keeps_its_boxes_balanced() {
    let points = sobol(64, 2, 5);
    for factor in strata_counts(&points, 64) {
        assert!(factor.iter().all(|&found| found == 1), "{factor:?}");
    }
    // of 64 points in base 2, each of the 8 by 8 squares has one: the first two factors are a (0, 6, 2)-net
    let mut squares = [0; 64];
    for point in &points {
        squares[(point[0] * 8.0) as usize * 8 + (point[1] * 8.0) as usize] += 1;
    }
    assert_eq!(squares, [1; 64]);
}

/// Squared L2 star discrepancy by T. Warnock's formula (1972).
fn discrepancy(points: &[Vec<f64>]) -> f64 {
    let (count, factors) = (points.len() as f64, points[0].len() as i32);
    let single: f64 =
        points.iter().map(|point| point.iter().map(|x| (1.0 - x * x) / 2.0).product::<f64>()).sum::<f64>();
    let pair = |a: &Vec<f64>, b: &Vec<f64>| a.iter().zip(b).map(|(a, b)| 1.0 - a.max(*b)).product::<f64>();
    let pairs: f64 = points.iter().map(|a| points.iter().map(|b| pair(a, b)).sum::<f64>()).sum();
    3.0_f64.powi(-factors) - 2.0 / count * single + pairs / (count * count)
}

#[test]
fn the_discrepancy_of_one_point_is_known() {
    // in one dimension ∫ (1[x > a] − x)² dx = 1/3 − a + a², here with a = 1/2
    assert!((discrepancy(&[vec![0.5]]) - (1.0 / 3.0 - 0.5 + 0.25)).abs() < 1e-15);
}

#[test]
fn sobol_points_fill_space_more_evenly_than_random_ones() {
    // the mean squared discrepancy of random points is (2^-d − 3^-d) / n, of Sobol' points almost n^-2
    let (count, factors) = (256, 3);
    let mean = |points: fn(u64, usize, u64) -> Vec<Vec<f64>>| {
        (1..=8).map(|seed| discrepancy(&points(count, factors, seed))).sum::<f64>() / 8.0
    };
    let expected = (0.125 - 1.0 / 27.0) / count as f64;
    let (drawn, even) = (mean(random), mean(sobol));
    assert!((drawn / expected - 1.0).abs() < 0.5, "random points: {drawn} instead of {expected}");
    assert!(even < drawn / 20.0, "Sobol' points: {even}, random points: {drawn}");
}

#[test]
fn more_points_or_factors_leave_the_first_ones_as_they_are() {
    for points in [random as fn(u64, usize, u64) -> Vec<Vec<f64>>, sobol] {
        let (few, many) = (points(10, 2, 4), points(100, 3, 4));
        assert!(few.iter().zip(&many).all(|(few, many)| few[..] == many[..2]));
        assert_ne!(few, points(10, 2, 5), "another seed gives other points");
    }
    let (few, many) = (latin_hypercube(10, 2, 4), latin_hypercube(10, 3, 4));
    assert!(few.iter().zip(&many).all(|(few, many)| few[..] == many[..2]));
}

#[test]
fn coordinates_never_reach_the_ends() {
    assert_eq!(coordinate(0), 2.0_f64.powi(-53));
    assert_eq!(coordinate(u64::MAX), 1.0 - 2.0_f64.powi(-53));
    let last = latin_hypercube(1_000_000, 1, 1).into_iter().flatten().fold(0.0, f64::max);
    assert!(last < 1.0, "{last}");
}

#[test]
fn a_grid_has_every_combination_the_last_factor_first() {
    let factor = |key: &str, levels: &[i64]| Factor {
        key: key.into(),
        values: super::super::factor::Values::List(vec![]),
        levels: levels.iter().map(|&level| Value::Integer(level)).collect(),
    };
    let points = Design::Grid {}.values(&[factor("a", &[1, 2]), factor("b", &[3, 4, 5])]);
    let found: Vec<Vec<i64>> =
        points.iter().map(|point| point.iter().filter_map(Value::as_integer).collect()).collect();
    assert_eq!(found, [[1, 3], [1, 4], [1, 5], [2, 3], [2, 4], [2, 5]]);
    assert_eq!(Design::Grid {}.values(&[]), [Vec::<Value>::new()], "without factors there is one point");
}
