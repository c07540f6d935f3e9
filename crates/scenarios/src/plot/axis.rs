//! Ticks of an axis: round numbers, a handful of them.

/// Fewest intervals between ticks that are aimed at.
const INTERVALS: f64 = 5.0;

/// Round numbers within `range`, and the number of decimals that tells them apart.
pub fn ticks(range: [f64; 2]) -> (Vec<f64>, usize) {
    let [low, high] = range;
    let step = round_step((high - low) / INTERVALS);
    let (first, last) = ((low / step - SLACK).ceil() as i64, (high / step + SLACK).floor() as i64);
    let decimals = (-(step.log10() + SLACK).floor()).max(0.0) as usize;
    ((first..=last).map(|index| index as f64 * step).collect(), decimals)
}

/// Share of a step by which a tick may lie outside for rounding.
const SLACK: f64 = 1e-9;

/// The largest of 1, 2, 5 times a power of ten that is not above `wanted`.
fn round_step(wanted: f64) -> f64 {
    let power = 10f64.powf(wanted.log10().floor());
    let share = wanted / power;
    let factor = if share >= 5.0 {
        5.0
    } else if share >= 2.0 {
        2.0
    } else {
        1.0
    };
    factor * power
}

/// The range of `values` with some room, never empty.
pub fn range(values: impl Iterator<Item = f64>) -> [f64; 2] {
    let [low, high] = values
        .filter(|value| value.is_finite())
        .fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], value| [low.min(value), high.max(value)]);
    if low > high {
        return [0.0, 1.0];
    }
    let room = (ROOM * (high - low)).max(LEAST_ROOM * (1.0 + low.abs()));
    [low - room, high + room]
}

/// Room beyond the data, as a share of their range, and the least of it.
const ROOM: f64 = 0.06;
const LEAST_ROOM: f64 = 1e-6;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ticks_are_round_and_inside() {
        assert_eq!(ticks([-9.0, 9.0]), (vec![-8.0, -6.0, -4.0, -2.0, 0.0, 2.0, 4.0, 6.0, 8.0], 0));
        let (found, decimals) = ticks([0.0, 1.0]);
        assert_eq!((found.len(), decimals), (6, 1));
        assert_eq!(ticks([0.0, 0.26]).1, 2);
    }

    #[test]
    fn a_single_value_has_a_range_about_it() {
        let [low, high] = range([3.0].into_iter());
        assert!(low < 3.0 && high > 3.0);
        assert_eq!(range(std::iter::empty()), [0.0, 1.0]);
    }
}
