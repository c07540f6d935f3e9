//! Nearest places among those put in so far: a k-d tree that grows.

use kdtree::KdTree;
use kdtree::distance::squared_euclidean;
use nalgebra::Point2;

/// Places by number, in the order in which they were put in. Places are finite: others are neither kept nor found.
pub(super) struct Neighbors {
    tree: KdTree<f64, usize, [f64; 2]>,
}

impl Neighbors {
    pub(super) fn new() -> Self {
        Self { tree: KdTree::new(2) }
    }

    pub(super) fn insert(&mut self, place: &Point2<f64>) {
        let number = self.tree.size();
        // refuses what is not finite only
        let _refused = self.tree.add([place.x, place.y], number);
    }

    /// Number of the nearest place and its distance.
    pub(super) fn nearest(&self, place: &Point2<f64>) -> Option<(usize, f64)> {
        self.within(place, 1, f64::INFINITY).into_iter().next()
    }

    /// Numbers and distances of the nearest `count` places not farther than `radius`, the nearest first.
    pub(super) fn within(&self, place: &Point2<f64>, count: usize, radius: f64) -> Vec<(usize, f64)> {
        let found =
            self.tree.nearest_within_radius(&[place.x, place.y], count, Some(radius * radius), &squared_euclidean);
        found.unwrap_or_default().into_iter().map(|(squared, number)| (*number, squared.sqrt())).collect()
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    /// Rounding of a square and its root.
    const ROUNDING: f64 = 1e-12;

    fn place() -> impl Strategy<Value = Point2<f64>> {
        // whole numbers make ties and doubles
        prop_oneof![
            (-1.0f64..1.0, -1.0f64..1.0).prop_map(|(x, y)| Point2::new(x, y)),
            (-2i8..3, -2i8..3).prop_map(|(x, y)| Point2::new(f64::from(x), f64::from(y))),
        ]
    }

    #[test]
    fn nothing_is_near_in_an_empty_tree_and_what_is_no_place_is_not_kept() {
        let mut neighbors = Neighbors::new();
        assert_eq!(neighbors.nearest(&Point2::origin()), None);
        neighbors.insert(&Point2::new(f64::NAN, 0.0));
        assert_eq!(neighbors.nearest(&Point2::origin()), None);
        neighbors.insert(&Point2::new(3.0, 4.0));
        assert_eq!(neighbors.nearest(&Point2::origin()), Some((0, 5.0)));
        assert_eq!(neighbors.nearest(&Point2::new(0.0, f64::NAN)), None);
    }

    #[test]
    fn many_equal_places_are_all_found() {
        let mut neighbors = Neighbors::new();
        (0..100).for_each(|_| neighbors.insert(&Point2::new(0.1, 0.2)));
        assert_eq!(neighbors.within(&Point2::new(0.1, 0.2), 200, 0.0).len(), 100);
    }

    proptest! {
        #[test]
        fn neighbors_are_those_of_a_search_through_all(
            places in prop::collection::vec(place(), 1..200), at in place(), count in 1usize..12, radius in 0.0f64..2.0,
        ) {
            let mut neighbors = Neighbors::new();
            places.iter().for_each(|place| neighbors.insert(place));
            let mut all: Vec<f64> = places.iter().map(|place| (place - at).norm()).collect();
            all.sort_by(f64::total_cmp);
            let found = neighbors.within(&at, count, radius);
            // ties may come in any order: the distances decide
            let expected: Vec<f64> = all.iter().copied().take(count).filter(|far| *far <= radius + ROUNDING).collect();
            prop_assert!(found.len() == expected.len() || expected.iter().any(|far| (far - radius).abs() <= ROUNDING));
            for ((number, far), expected) in found.iter().zip(&expected) {
                prop_assert!((far - expected).abs() <= ROUNDING);
                prop_assert!(((places[*number] - at).norm() - far).abs() <= ROUNDING);
            }
            let (_, nearest) = neighbors.nearest(&at).unwrap();
            prop_assert!((nearest - all[0]).abs() <= ROUNDING);
        }
    }
}
