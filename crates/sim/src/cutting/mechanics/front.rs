//! The edge and the crack before it, at the nodes of a section.

use nalgebra::{Point2, Rotation2};

use super::grid::SectionGrid;
use super::motion::EdgeMotion;
use crate::cutting::knife::Edge;

/// Depth of the edge and of the crack at the nodes of a section.
#[derive(Clone, Debug)]
pub(super) struct Front {
    /// Corners of the edge in the knife's frame, its ends continued by steep fronts.
    corners: Vec<Point2<f64>>,
    /// Depth that the crack has reached, m; it only grows.
    pub crack: Vec<f64>,
    /// Depth of the edge now, m; above the food where the edge is not.
    pub edge: Vec<f64>,
    /// Slope dy/dx of the edge.
    pub slope: Vec<f64>,
    /// Length along x for which a node stands, where its crack is in food, m.
    pub width: Vec<f64>,
    /// Dent before the edge, m; zero where there is none.
    pub dent: Vec<f64>,
}

/// The fronts of a blade's ends lean by this many columns over the food's height, so that no column is cut at one blow.
const FRONT_COLUMNS: f64 = 4.0;

impl Front {
    pub(super) fn new(grid: &SectionGrid, edge: &Edge) -> Self {
        let nodes = grid.columns() + 1;
        let lean = FRONT_COLUMNS * grid.pitch();
        let mut corners = edge.points.clone();
        if let (Some(heel), Some(tip)) = (edge.points.first(), edge.points.last()) {
            corners.insert(0, Point2::new(heel.x - lean, heel.y - grid.height()));
            corners.push(Point2::new(tip.x + lean, tip.y - grid.height()));
        }
        Self {
            corners,
            crack: vec![grid.top(); nodes],
            edge: vec![grid.top(); nodes],
            slope: vec![0.0; nodes],
            width: vec![0.0; nodes],
            dent: vec![0.0; nodes],
        }
    }

    /// Places the edge, lets the crack follow where there is no food, and measures widths and dents.
    pub(super) fn place(&mut self, grid: &SectionGrid, motion: &EdgeMotion) {
        self.edge.fill(grid.top());
        self.slope.fill(0.0);
        let turn = Rotation2::new(motion.angle_rad);
        let placed = |corner: &Point2<f64>| motion.position + turn * corner.coords;
        for pair in self.corners.windows(2) {
            let (from, to) = (placed(&pair[0]), placed(&pair[1]));
            let (from, to) = if from.x <= to.x { (from, to) } else { (to, from) };
            let slope = (to.y - from.y) / (to.x - from.x);
            // an upright piece lies between nodes
            if !slope.is_finite() {
                continue;
            }
            for node in grid.nodes_between(from.x, to.x) {
                let depth = from.y + slope * (grid.x(node) - from.x);
                // the blade is above its edge, so the deepest piece counts
                if depth > self.edge[node] {
                    self.edge[node] = depth;
                    self.slope[node] = slope;
                }
            }
        }
        for node in 0..self.crack.len() {
            self.dent[node] = self.follow(grid, node);
        }
        self.measure_widths(grid);
    }

    /// Moves the crack of a node to the edge or to the next food, and returns the dent in this food.
    fn follow(&mut self, grid: &SectionGrid, node: usize) -> f64 {
        let (edge, crack) = (self.edge[node], &mut self.crack[node]);
        if edge <= *crack {
            return 0.0;
        }
        let Some(&(top, _)) = grid.spans(node).iter().find(|(_, bottom)| *crack < *bottom) else {
            *crack = edge;
            return 0.0;
        };
        *crack = crack.max(edge.min(top));
        edge - *crack
    }

    /// Shares the lengths on which the crack lies in food between the nodes.
    fn measure_widths(&mut self, grid: &SectionGrid) {
        self.width.fill(0.0);
        for column in 0..grid.columns() {
            let shares = grid.tributary(column, [self.crack[column], self.crack[column + 1]]);
            self.width[column] += shares[0];
            self.width[column + 1] += shares[1];
        }
    }

    /// Nodes whose edge presses on food.
    pub(super) fn engaged(&self) -> impl Iterator<Item = usize> + '_ {
        (0..self.crack.len()).filter(|&node| self.dent[node] > 0.0 && self.width[node] > 0.0)
    }

    /// Length along x of the pressing edge, m, and its middle; none if it presses nowhere.
    pub(super) fn pressing(&self, grid: &SectionGrid) -> Option<(f64, Point2<f64>)> {
        let (mut width, mut middle) = (0.0, Point2::origin());
        for node in self.engaged() {
            width += self.width[node];
            middle += Point2::new(grid.x(node), self.edge[node]).coords * self.width[node];
        }
        (width > 0.0).then(|| (width, middle / width))
    }

    /// Area of the column that is cut, m².
    pub(super) fn cut_area(&self, grid: &SectionGrid, column: usize) -> f64 {
        grid.area_above(column, [self.crack[column], self.crack[column + 1]])
    }

    /// Area of the column's cut in which the blade stands, m².
    pub(super) fn blade_area(&self, grid: &SectionGrid, column: usize, blade_height: f64) -> f64 {
        let under = [column, column + 1].map(|node| self.edge[node].min(self.crack[node]));
        grid.area_above(column, under) - grid.area_above(column, under.map(|depth| depth - blade_height))
    }

    /// Greatest depth of the cut below the food's upper side, m.
    pub(super) fn depth(&self, grid: &SectionGrid) -> f64 {
        let below = |(node, crack): (usize, &f64)| {
            let spans = grid.spans(node);
            let (top, bottom) =
                (spans.first().map_or(*crack, |span| span.0), spans.last().map_or(*crack, |span| span.1));
            crack.min(bottom) - top
        };
        self.crack.iter().enumerate().map(below).fold(0.0, f64::max)
    }
}
