//! Tests of paired differences: published data, another program's numbers, enumeration of all signs.

use proptest::prelude::*;

use super::*;

/// Heights of crossed minus self-fertilized plants, eighths of an inch: Darwin's, as printed by Fisher 1935, Section 17.
const DARWIN: [f64; 15] = [6.0, 8.0, 14.0, 16.0, 23.0, 24.0, 28.0, 29.0, 41.0, -48.0, 49.0, 56.0, 60.0, -67.0, 75.0];

/// Sixty values with ties and one zero, of one decimal.
const MANY: [f64; 60] = [
    0.3, 0.6, 0.0, -0.6, -0.2, -0.7, 0.4, 1.6, -0.2, -0.3, 0.8, 0.7, 0.4, -0.6, 0.3, 1.0, -1.0, -0.2, -1.6, -1.0, -1.5,
    0.1, -1.0, 0.6, 0.5, 0.1, -2.2, -0.2, 0.3, 0.4, -1.2, -0.2, -0.7, -0.5, 1.4, -0.5, 0.3, 1.2, -0.3, 0.2, 0.4, 0.4,
    -0.9, 0.4, 1.7, -1.2, 1.2, 0.4, -0.3, 2.3, 1.1, -0.9, 0.4, 0.9, 0.1, 1.0, 0.2, 1.0, 1.7, -0.4,
];

#[test]
fn darwins_plants_agree_with_scipy() {
    // scipy 1.17.1: wilcoxon(d, method="exact").pvalue; the 26th and the 95th of the 120 Walsh averages
    let found = signed_rank(&DARWIN).unwrap();
    assert_eq!((found.estimate, found.interval_95), (25.0, Some([4.0, 41.5])));
    assert!((found.p - 0.041_259_765_625).abs() < 1e-15 && found.exact);
}

#[test]
fn ties_agree_with_scipys_permutations() {
    // scipy 1.17.1: wilcoxon(d, method=PermutationMethod(n_resamples=inf)).pvalue = 0.2421875
    let found = signed_rank(&[1.0, 1.0, -1.0, 2.0, 2.0, 3.0, -3.0, 4.0]).unwrap();
    assert!((found.p - 0.242_187_5).abs() < 1e-15);
}

#[test]
fn many_pairs_agree_with_scipys_approximation() {
    // scipy 1.17.1: wilcoxon(d[d != 0], method="approx", correction=True).pvalue, 59 of 60
    let found = signed_rank(&MANY).unwrap();
    assert!((found.p - 0.350_722_366_250_0).abs() < 5e-8 && !found.exact, "{}", found.p);
    assert_eq!((found.pairs, found.zeros), (60, 1));
}

#[test]
fn intervals_begin_at_the_ranks_of_the_tables() {
    // Wilcoxon's table of critical values (two-sided 5 %: 0, 2, 8, 25, 52, 434 for n = 6, 7, 10, 15, 20, 50): one above
    for (count, critical) in [(6, 0), (7, 2), (10, 8), (15, 25), (20, 52), (50, 434)] {
        assert_eq!(exact_rank(count), critical + 1, "{count}");
    }
    assert_eq!(exact_rank(5), 0);
    assert!(exact_rank(50).abs_diff(normal_rank(50)) <= 1);
}

#[test]
fn equal_samples_are_not_told_apart() {
    let found = signed_rank(&[0.0; 8]).unwrap();
    assert_eq!((found.p, found.estimate, found.zeros), (1.0, 0.0, 8));
    assert_eq!(found.interval_95, Some([0.0, 0.0]));
}

#[test]
fn few_pairs_have_no_interval_and_none_say_nothing() {
    assert_eq!(signed_rank(&[1.0, 2.0, 3.0, 4.0, 5.0]).unwrap().interval_95, None);
    assert_eq!(signed_rank(&[]), None);
    assert_eq!(signed_rank(&[1.0, f64::INFINITY]), None);
}

#[test]
fn normal_tails_agree_with_the_tables() {
    // scipy 1.17.1: norm.sf
    let expect = [
        (0.0, 0.5),
        (1.0, 0.158_655_253_931_457_05),
        (1.959_963_984_540_054, 0.025),
        (3.0, 0.001_349_898_031_630_094_6),
        (3.1, 0.000_967_603_213_218_356),
        (8.0, 6.220_960_574_271_785e-16),
    ];
    for (z, tail) in expect {
        assert!((upper_tail(z) / tail - 1.0).abs() < 1e-11, "{z}: {}", upper_tail(z));
    }
}

proptest! {
    #[test]
    fn probabilities_are_those_of_all_signs(values in prop::collection::vec(-6_i32..7, 1..11)) {
        let values: Vec<f64> = values.into_iter().map(f64::from).collect();
        let sizes: Vec<f64> = values.iter().map(|value| value.abs()).filter(|size| *size > 0.0).collect();
        // mean ranks by counting, not by sorting
        let rank = |size: f64| {
            let count = |keep: &dyn Fn(f64) -> bool| sizes.iter().filter(|other| keep(**other)).count() as f64;
            count(&|other| other < size) + 0.5 * (count(&|other| other == size) + 1.0)
        };
        let middle: f64 = 0.5 * sizes.iter().map(|size| rank(*size)).sum::<f64>();
        let observed: f64 = values.iter().filter(|value| **value > 0.0).map(|value| rank(*value)).sum();
        let all = 1_u32 << sizes.len();
        let as_far = (0..all).filter(|signs| {
            let sum: f64 = sizes.iter().enumerate().filter(|(bit, _)| signs >> bit & 1 == 1).map(|(_, size)| rank(*size)).sum();
            (sum - middle).abs() >= (observed - middle).abs() - 1e-9
        });
        let expected = as_far.count() as f64 / f64::from(all);
        prop_assert!((signed_rank(&values).unwrap().p - expected).abs() < 1e-12);
    }
}
