//! Walsh averages: the means of all pairs of values, each value with itself too, without writing them all down.

/// Number of Walsh averages of `count` values.
pub(super) fn count(count: usize) -> u64 {
    let count = count as u64;
    count * (count + 1) / 2
}

/// The `rank`-th smallest Walsh average (from 1) of finite values in ascending order; `None` if there is no such.
///
/// Bisects over the floating-point numbers themselves: memory stays linear in the number of values, and the result is
/// exact.
pub(super) fn ordered(sorted: &[f64], rank: u64) -> Option<f64> {
    let (least, greatest) = (*sorted.first()?, *sorted.last()?);
    if rank == 0 || rank > count(sorted.len()) {
        return None;
    }
    let (mut low, mut high) = (key(least), key(greatest));
    while low < high {
        let middle = low.midpoint(high);
        if at_most(sorted, value(middle)) >= rank {
            high = middle;
        } else {
            low = middle + 1;
        }
    }
    Some(value(low))
}

/// Their median.
pub(super) fn median(sorted: &[f64]) -> Option<f64> {
    let count = count(sorted.len());
    Some(ordered(sorted, count.div_ceil(2))?.midpoint(ordered(sorted, count / 2 + 1)?))
}

/// How many Walsh averages are not above `limit`.
fn at_most(sorted: &[f64], limit: f64) -> u64 {
    // the larger the first of a pair, the fewer partners
    let mut partners = sorted.len();
    let mut sum = 0;
    for (index, first) in sorted.iter().enumerate() {
        while partners > index && sorted.get(partners - 1).is_some_and(|last| first.midpoint(*last) > limit) {
            partners -= 1;
        }
        if partners <= index {
            break;
        }
        sum += (partners - index) as u64;
    }
    sum
}

/// Whole numbers in the order of the floating-point numbers.
fn key(value: f64) -> u64 {
    let bits = value.to_bits();
    if bits >> 63 == 1 { !bits } else { bits | 1 << 63 }
}

fn value(key: u64) -> f64 {
    f64::from_bits(if key >> 63 == 1 { key ^ 1 << 63 } else { !key })
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn order_statistics_are_those_of_the_list(mut values in prop::collection::vec(-9_i32..9, 1..20)) {
            values.sort_unstable();
            let sorted: Vec<f64> = values.iter().map(|value| 0.1 * f64::from(*value)).collect();
            let pairs = (0..sorted.len()).flat_map(|i| (i..sorted.len()).map(move |j| (i, j)));
            let mut all: Vec<f64> = pairs.map(|(i, j)| sorted[i].midpoint(sorted[j])).collect();
            all.sort_by(f64::total_cmp);
            for (index, expected) in all.iter().enumerate() {
                prop_assert_eq!(ordered(&sorted, index as u64 + 1), Some(*expected));
            }
            prop_assert_eq!(ordered(&sorted, all.len() as u64 + 1), None);
        }

        #[test]
        fn keys_keep_order_and_value(a in any::<f64>(), b in any::<f64>()) {
            prop_assert_eq!(value(key(a)).to_bits(), a.to_bits());
            prop_assert_eq!(key(a) < key(b), a.total_cmp(&b).is_lt());
        }
    }
}
