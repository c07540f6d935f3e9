//! Shortcuts through a path: the fewest straight segments between places on it that keep clear, and of those the shortest.
//!
//! For a fair comparison: a planner that samples leaves corners that the task does not ask for.

use nalgebra::{Point2, distance};

use super::free_space::FreeSpace;
use crate::error::SkillError;

/// The checks grow with the square of the corners.
const MOST_CORNERS: f64 = 1e4;

/// Shortens a path (world frame, m) to the fewest straight segments through `space`; corners are looked for on the path,
/// `spacing_m` apart and at its nodes. The ends are kept.
///
/// Segments of the path itself are taken for free. Exact for these corners (dynamic programming over them), hence O(n²)
/// checks for n of them.
///
/// # Errors
/// [`SkillError::InvalidArgument`] if the spacing is not positive or leaves more than 10 000 corners,
/// [`SkillError::NonFinite`] if a place is not finite.
pub fn shortcut(path: &[Point2<f64>], space: &FreeSpace, spacing_m: f64) -> Result<Vec<Point2<f64>>, SkillError> {
    let operation = "shorten path";
    if !(spacing_m.is_finite() && spacing_m > 0.0) {
        let expected = "a finite number greater than 0";
        return Err(SkillError::InvalidArgument { operation, argument: "spacing_m", found: spacing_m, expected });
    }
    for (row, place) in path.iter().enumerate() {
        if let Some((column, found)) = place.iter().enumerate().find(|(_, coordinate)| !coordinate.is_finite()) {
            return Err(SkillError::NonFinite { operation, row, column, found: *found });
        }
    }
    let length_m: f64 = path.windows(2).map(|pair| distance(&pair[0], &pair[1])).sum();
    if length_m / spacing_m > MOST_CORNERS {
        let expected = "a spacing that leaves at most 10000 corners";
        return Err(SkillError::InvalidArgument { operation, argument: "spacing_m", found: spacing_m, expected });
    }
    let corners = corners(path, spacing_m);
    // segments and length of the best way from the start to each corner, and the corner before on it
    let mut best: Vec<(usize, f64)> = vec![(0, 0.0)];
    let mut before = vec![0];
    for (to, corner) in corners.iter().enumerate().skip(1) {
        let (segments, length_m) = best[to - 1];
        let mut least = (segments + 1, length_m + distance(&corners[to - 1], corner));
        let mut from = to - 1;
        for (earlier, start) in corners.iter().enumerate().take(to - 1) {
            let (segments, length_m) = best[earlier];
            let offered = (segments + 1, length_m + distance(start, corner));
            if offered < least && space.is_way_free(start, corner) {
                (least, from) = (offered, earlier);
            }
        }
        best.push(least);
        before.push(from);
    }
    Ok(traced(&corners, &before))
}

/// Places on the path: its nodes, and between them one every `spacing_m` or nearer.
fn corners(path: &[Point2<f64>], spacing_m: f64) -> Vec<Point2<f64>> {
    let mut corners: Vec<Point2<f64>> = path.iter().take(1).copied().collect();
    for pair in path.windows(2) {
        let way = pair[1] - pair[0];
        let parts = (way.norm() / spacing_m).ceil().max(1.0) as usize;
        corners.extend((1..parts).map(|part| pair[0] + way * (part as f64 / parts as f64)));
        corners.push(pair[1]);
    }
    corners
}

fn traced(corners: &[Point2<f64>], before: &[usize]) -> Vec<Point2<f64>> {
    let Some(mut at) = corners.len().checked_sub(1) else { return Vec::new() };
    let mut way = vec![corners[at]];
    while at != 0 {
        at = before[at];
        way.push(corners[at]);
    }
    way.reverse();
    way
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::outline::{Outline, PlacedOutline};

    fn space() -> FreeSpace {
        let shape = Outline::Box { width_m: 0.2, height_m: 0.2 };
        let obstacle = PlacedOutline { shape, position_m: [0.5, 0.1], angle_rad: 0.0 };
        FreeSpace::new([0.0; 2], [1.0; 2], 0.05, &[obstacle]).unwrap()
    }

    #[test]
    fn a_zigzag_through_free_space_becomes_one_segment() {
        let zigzag: Vec<_> = (0..9).map(|k| Point2::new(0.1 * f64::from(k), 0.5 + 0.02 * f64::from(k % 2))).collect();
        assert_eq!(shortcut(&zigzag, &space(), 0.01).unwrap(), [zigzag[0], zigzag[8]]);
    }

    #[test]
    fn a_way_round_an_obstacle_keeps_clear_and_grows_no_longer() {
        let way = [[0.1, 0.1], [0.2, 0.45], [0.4, 0.3], [0.6, 0.4], [0.8, 0.3], [0.9, 0.1]].map(Point2::from);
        let short = shortcut(&way, &space(), 0.01).unwrap();
        let length = |way: &[Point2<f64>]| way.windows(2).map(|pair| distance(&pair[0], &pair[1])).sum::<f64>();
        assert!((short[0], short[short.len() - 1]) == (way[0], way[5]));
        // the box bars the straight way; over a peak above it, two segments are the fewest
        assert!(short.len() == 3 && length(&short) < length(&way), "{short:?}");
        assert!(short.windows(2).all(|pair| space().is_way_free(&pair[0], &pair[1])));
    }

    #[test]
    fn paths_of_one_place_or_none_stay_and_bad_numbers_are_refused() {
        assert_eq!(shortcut(&[], &space(), 0.01).unwrap(), []);
        assert_eq!(shortcut(&[Point2::origin()], &space(), 0.01).unwrap(), [Point2::origin()]);
        let way = [Point2::origin(), Point2::new(1.0, 0.0)];
        for spacing_m in [0.0, -1.0, f64::NAN, 1e-5] {
            assert!(matches!(shortcut(&way, &space(), spacing_m), Err(SkillError::InvalidArgument { .. })));
        }
        let bad = [Point2::origin(), Point2::new(0.0, f64::NAN)];
        assert!(matches!(shortcut(&bad, &space(), 0.1), Err(SkillError::NonFinite { row: 1, column: 1, .. })));
    }
}
