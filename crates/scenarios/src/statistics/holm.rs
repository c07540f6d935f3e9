//! Correction for having looked several times: Holm's.

/// Probabilities corrected for being a family (Holm 1979), in the order in which they came.
///
/// The smallest of m is multiplied by m, the next by m − 1 and so on; none becomes smaller than one before it, none larger
/// than 1. The chance of any false alarm in the family stays below the level, however the tests hang together.
#[must_use]
pub fn holm(probabilities: &[f64]) -> Vec<f64> {
    let mut order: Vec<usize> = (0..probabilities.len()).collect();
    let of = |index: &usize| probabilities.get(*index).copied().unwrap_or(1.0);
    order.sort_by(|a, b| of(a).total_cmp(&of(b)));
    let mut corrected = vec![1.0; probabilities.len()];
    let mut largest = 0.0_f64;
    for (rank, index) in order.iter().enumerate() {
        largest = largest.max(of(index) * (order.len() - rank) as f64).min(1.0);
        if let Some(place) = corrected.get_mut(*index) {
            *place = largest;
        }
    }
    corrected
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_family_agrees_with_the_definition_by_hand() {
        // 0.01·4, 0.03·3 = 0.09, 0.04·2 = 0.08 < 0.09, 0.5
        let found = holm(&[0.04, 0.01, 0.5, 0.03]);
        let expect = [0.09, 0.04, 0.5, 0.09];
        assert!(found.iter().zip(expect).all(|(a, b)| (a - b).abs() < 1e-15), "{found:?}");
    }

    #[test]
    fn one_look_needs_no_correction_and_none_is_above_one() {
        assert_eq!(holm(&[0.2]), [0.2]);
        assert_eq!(holm(&[0.7, 0.8]), [1.0, 1.0]);
        assert_eq!(holm(&[]), [0.0; 0]);
    }
}
