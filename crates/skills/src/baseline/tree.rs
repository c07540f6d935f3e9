//! A tree of places with the length of the way from its root to each of them.

use nalgebra::{Point2, distance};

use super::neighbors::Neighbors;

/// Nodes by number; the root is number 0.
pub(super) struct Tree {
    places: Vec<Point2<f64>>,
    // the root is its own parent
    parents: Vec<usize>,
    costs_m: Vec<f64>,
    children: Vec<Vec<usize>>,
    neighbors: Neighbors,
}

impl Tree {
    pub(super) fn new(root: Point2<f64>) -> Self {
        let mut neighbors = Neighbors::new();
        neighbors.insert(&root);
        Self { places: vec![root], parents: vec![0], costs_m: vec![0.0], children: vec![Vec::new()], neighbors }
    }

    pub(super) fn len(&self) -> usize {
        self.places.len()
    }

    pub(super) fn place(&self, node: usize) -> Point2<f64> {
        self.places[node]
    }

    pub(super) fn cost_m(&self, node: usize) -> f64 {
        self.costs_m[node]
    }

    pub(super) fn nearest(&self, place: &Point2<f64>) -> Option<(usize, f64)> {
        self.neighbors.nearest(place)
    }

    pub(super) fn within(&self, place: &Point2<f64>, count: usize, radius_m: f64) -> Vec<(usize, f64)> {
        self.neighbors.within(place, count, radius_m)
    }

    /// Adds a place under a parent and returns its number.
    pub(super) fn add(&mut self, place: Point2<f64>, parent: usize) -> usize {
        let node = self.len();
        self.costs_m.push(self.costs_m[parent] + distance(&self.places[parent], &place));
        self.places.push(place);
        self.parents.push(parent);
        self.children.push(Vec::new());
        self.children[parent].push(node);
        self.neighbors.insert(&place);
        node
    }

    /// Hangs a node under another parent; the costs of all below it follow.
    pub(super) fn hang(&mut self, node: usize, parent: usize) {
        let old = self.parents[node];
        self.children[old].retain(|child| *child != node);
        self.children[parent].push(node);
        self.parents[node] = parent;
        let mut open = vec![node];
        while let Some(next) = open.pop() {
            let above = self.parents[next];
            self.costs_m[next] = self.costs_m[above] + distance(&self.places[above], &self.places[next]);
            open.extend(&self.children[next]);
        }
    }

    /// Places from the root to a node.
    pub(super) fn way_to(&self, node: usize) -> Vec<Point2<f64>> {
        let mut way = vec![self.places[node]];
        let mut at = node;
        while at != 0 {
            at = self.parents[at];
            way.push(self.places[at]);
        }
        way.reverse();
        way
    }

    /// Each node but the root with its parent's place.
    pub(super) fn branches(&self) -> Vec<[Point2<f64>; 2]> {
        self.places.iter().zip(&self.parents).skip(1).map(|(place, parent)| [self.places[*parent], *place]).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_node_that_is_hung_elsewhere_takes_its_whole_branch_along() {
        // a detour over (0, 3), and below it two more
        let mut tree = Tree::new(Point2::origin());
        let detour = tree.add(Point2::new(0.0, 3.0), 0);
        let hung = tree.add(Point2::new(4.0, 0.0), detour);
        let below = tree.add(Point2::new(4.0, 2.0), hung);
        let last = tree.add(Point2::new(4.0, 3.0), below);
        assert_eq!([detour, hung, below, last].map(|node| tree.cost_m(node)), [3.0, 8.0, 10.0, 11.0]);
        tree.hang(hung, 0);
        assert_eq!([detour, hung, below, last].map(|node| tree.cost_m(node)), [3.0, 4.0, 6.0, 7.0]);
        assert_eq!(tree.way_to(last), [[0.0, 0.0], [4.0, 0.0], [4.0, 2.0], [4.0, 3.0]].map(Point2::from));
        assert_eq!(tree.branches().len(), 4);
        assert_eq!(tree.nearest(&Point2::new(4.1, 1.9)).unwrap().0, below);
    }
}
