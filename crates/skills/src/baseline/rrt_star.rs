//! RRT* for the center of an object in the plane, with the parameters of the paper's comparison (§IV.B) as defaults.
//!
//! S. Karaman and E. Frazzoli, "Sampling-based algorithms for optimal motion planning", International Journal of Robotics
//! Research 30(7), 2011, doi:10.1177/0278364911406761. As in the paper, neighbors are at most a fixed number within a fixed
//! radius: that takes O(n log n) for n nodes, but lengths tend to the least one for certain only if the number grows with
//! log n at least.

use nalgebra::{Point2, distance};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use serde::{Deserialize, Serialize};

use super::free_space::FreeSpace;
use super::measures::PathMeasures;
use super::tree::Tree;
use crate::error::SkillError;
use crate::field::{FieldError, not_negative, positive, within};

/// Options of the search.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct RrtStarConfig {
    /// Longest extension toward a sample, m.
    pub step_m: f64,
    /// A node this near to the goal reaches it, m.
    pub goal_tolerance_m: f64,
    /// Nodes within this distance of a new one are its neighbors, m. It may exceed the step: rewired edges are then longer.
    pub neighbor_radius_m: f64,
    /// Most neighbors of a new node, the nearest ones; none of them makes it a plain RRT.
    pub neighbors: usize,
    /// Number of nodes, the start included, after which the search ends.
    pub nodes: usize,
    /// Probability of taking the goal for a sample.
    pub goal_bias: f64,
    /// Samples per node after which the search gives up adding nodes.
    pub samples_per_node: usize,
    /// Seed of the samples.
    pub seed: u64,
}

impl Default for RrtStarConfig {
    fn default() -> Self {
        Self {
            step_m: 0.002,
            goal_tolerance_m: 0.002,
            neighbor_radius_m: 0.010,
            neighbors: 7,
            nodes: 1400,
            goal_bias: 0.05,
            samples_per_node: 20,
            seed: 0,
        }
    }
}

/// What the search did, independent of any clock.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub struct SearchCounts {
    /// Samples drawn.
    pub samples: usize,
    /// Nodes of the tree, the start included.
    pub nodes: usize,
    /// Straight ways that were checked for collisions.
    pub checked_ways: usize,
    /// Nodes that were hung under a new one.
    pub rewired: usize,
}

/// Outcome of a search.
#[derive(Clone, Debug, PartialEq)]
pub struct RrtStar {
    /// The shortest way found into the tolerance about the goal; without any, the way to the node nearest to the goal.
    pub path: Vec<Point2<f64>>,
    /// Whether the path ends within the tolerance about the goal.
    pub reached: bool,
    /// Measures of the path.
    pub measures: PathMeasures,
    /// What the search did.
    pub counts: SearchCounts,
    /// All edges of the tree, for drawing: where each node hangs, and where it is.
    pub branches: Vec<[Point2<f64>; 2]>,
}

/// Shorter edges are no edges, m: the goal is sampled again and again.
const SAME_PLACE_M: f64 = 1e-12;

impl RrtStarConfig {
    /// Checks that the numbers make a search.
    ///
    /// # Errors
    /// A [`FieldError`] naming the offending option.
    pub fn validate(&self) -> Result<(), FieldError> {
        positive("step_m", self.step_m)?;
        not_negative("goal_tolerance_m", self.goal_tolerance_m)?;
        not_negative("neighbor_radius_m", self.neighbor_radius_m)?;
        within("goal_bias", self.goal_bias, 0.0, 1.0)?;
        for (field, number) in [("nodes", self.nodes), ("samples_per_node", self.samples_per_node)] {
            if number == 0 {
                return Err(FieldError::new(field, number, "at least 1"));
            }
        }
        Ok(())
    }

    /// Searches a short way of the center from `start` to `goal` (world frame) through `space`.
    ///
    /// The same seed gives the same tree on every machine.
    ///
    /// # Errors
    /// [`SkillError::InvalidConfig`] if an option is out of its range, or start or goal (fields `start`, `goal`) are not free.
    pub fn search(&self, space: &FreeSpace, start: Point2<f64>, goal: Point2<f64>) -> Result<RrtStar, SkillError> {
        self.validate()?;
        for (field, place) in [("start", start), ("goal", goal)] {
            if !space.is_free(&place) {
                let found = format!("({} m, {} m)", place.x, place.y);
                let expected = "a place inside the bounds that keeps its clearance from every obstacle";
                return Err(FieldError::new(field, found, expected).into());
            }
        }
        let mut search = Search { config: self, space, tree: Tree::new(start), counts: SearchCounts::default() };
        let mut random = ChaCha8Rng::seed_from_u64(self.seed);
        let most_samples = self.nodes.saturating_mul(self.samples_per_node);
        while search.tree.len() < self.nodes && search.counts.samples < most_samples {
            search.counts.samples += 1;
            search.extend(&self.sample(space, &goal, &mut random));
        }
        Ok(search.finish(&goal))
    }

    fn sample(&self, space: &FreeSpace, goal: &Point2<f64>, random: &mut ChaCha8Rng) -> Point2<f64> {
        if random.random::<f64>() < self.goal_bias {
            return *goal;
        }
        let (min, max) = space.bounds_m();
        let mut coordinate = |axis: usize| min[axis] + (max[axis] - min[axis]) * random.random::<f64>();
        Point2::new(coordinate(0), coordinate(1))
    }
}

/// A search under way.
struct Search<'a> {
    config: &'a RrtStarConfig,
    space: &'a FreeSpace,
    tree: Tree,
    counts: SearchCounts,
}

impl Search<'_> {
    fn is_way_free(&mut self, from: &Point2<f64>, to: &Point2<f64>) -> bool {
        self.counts.checked_ways += 1;
        self.space.is_way_free(from, to)
    }

    /// Grows the tree one step toward a sample, and hangs neighbors under the new node where that shortens their way.
    fn extend(&mut self, sample: &Point2<f64>) {
        let Some((nearest, far_m)) = self.tree.nearest(sample) else { return };
        if far_m <= SAME_PLACE_M {
            return;
        }
        let from = self.tree.place(nearest);
        let place = from + (sample - from) * (self.config.step_m / far_m).min(1.0);
        if !self.is_way_free(&from, &place) {
            return;
        }
        let near = self.tree.within(&place, self.config.neighbors, self.config.neighbor_radius_m);
        let node = self.add(place, nearest, &near);
        let cost_m = self.tree.cost_m(node);
        for (neighbor, length_m) in near {
            if cost_m + length_m < self.tree.cost_m(neighbor) - SAME_PLACE_M
                && self.is_way_free(&place, &self.tree.place(neighbor))
            {
                self.tree.hang(neighbor, node);
                self.counts.rewired += 1;
            }
        }
    }

    /// Adds a place under the neighbor with the shortest way to it, or under the nearest node.
    fn add(&mut self, place: Point2<f64>, nearest: usize, near: &[(usize, f64)]) -> usize {
        let mut parent = nearest;
        let mut least_m = self.tree.cost_m(nearest) + distance(&self.tree.place(nearest), &place);
        for (neighbor, length_m) in near {
            let cost_m = self.tree.cost_m(*neighbor) + length_m;
            if cost_m < least_m && self.is_way_free(&self.tree.place(*neighbor), &place) {
                (parent, least_m) = (*neighbor, cost_m);
            }
        }
        self.tree.add(place, parent)
    }

    fn finish(self, goal: &Point2<f64>) -> RrtStar {
        let miss_m = |node: &usize| distance(&self.tree.place(*node), goal);
        let nodes = 0..self.tree.len();
        let arrived = nodes.clone().filter(|node| miss_m(node) <= self.config.goal_tolerance_m);
        let best = arrived.min_by(|a, b| self.tree.cost_m(*a).total_cmp(&self.tree.cost_m(*b)));
        let nearest = || nodes.min_by(|a, b| miss_m(a).total_cmp(&miss_m(b))).unwrap_or(0);
        let path = self.tree.way_to(best.unwrap_or_else(nearest));
        let counts = SearchCounts { nodes: self.tree.len(), ..self.counts };
        let measures = PathMeasures::new(&path, goal);
        RrtStar { path, reached: best.is_some(), measures, counts, branches: self.tree.branches() }
    }
}
