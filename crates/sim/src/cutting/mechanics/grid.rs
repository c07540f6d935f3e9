//! The section of a food, divided into columns along the edge.
//!
//! A column holds one slab of each polygon that crosses it, straight above and below: lengths and areas under a profile
//! that is straight between the nodes (the columns' borders) follow in closed form.

use nalgebra::Point2;
use skills::field::FieldError;

/// The part of one polygon in one column, straight above and below.
#[derive(Clone, Copy, Debug)]
struct Slab {
    /// Where it begins and ends, as a share of the column's width.
    extent: [f64; 2],
    /// y of its upper side at both ends.
    top: [f64; 2],
    /// y of its lower side at both ends.
    bottom: [f64; 2],
}

/// A section in columns.
#[derive(Clone, Debug)]
pub(super) struct SectionGrid {
    left: f64,
    pitch: f64,
    top: f64,
    bottom: f64,
    slabs: Vec<Slab>,
    /// Slabs of column k are `slabs[first_slab[k]..first_slab[k + 1]]`.
    first_slab: Vec<usize>,
    /// Upper and lower ends of the food at the nodes, from top to bottom.
    spans: Vec<(f64, f64)>,
    /// Spans of node k are `spans[first_span[k]..first_span[k + 1]]`.
    first_span: Vec<usize>,
    area: f64,
}

/// Differences of lengths below this are rounding, m.
const ROUNDING_M: f64 = 1e-9;
/// Columns of one section, at most: 10 m of food in cells of 0.1 mm.
const MOST_COLUMNS: f64 = 1e5;

impl SectionGrid {
    /// Divides a section of convex polygons with disjoint interiors into columns of about `cell` width.
    ///
    /// # Errors
    /// A [`FieldError`] if a polygon is not convex, has no area or is not finite, or if there is none.
    pub(super) fn new(polygons: &[Vec<Point2<f64>>], cell: f64) -> Result<Self, FieldError> {
        polygons.iter().enumerate().try_for_each(|(at, polygon)| convex(at, polygon))?;
        let points = || polygons.iter().flatten();
        let [left, right] = range(points().map(|point| point.x));
        let [top, bottom] = range(points().map(|point| point.y));
        let columns = ((right - left) / cell).ceil();
        if !(1.0..=MOST_COLUMNS).contains(&columns) {
            let found = format!("{} polygons spanning {} m", polygons.len(), right - left);
            return Err(FieldError::new("polygons", found, "at least one convex polygon, 0 to 10 m wide"));
        }
        let columns = columns as usize;
        let pitch = (right - left) / columns as f64;
        let mut grid = Self {
            left,
            pitch,
            top,
            bottom,
            slabs: Vec::new(),
            first_slab: vec![0],
            spans: Vec::new(),
            first_span: vec![0],
            area: 0.0,
        };
        for column in 0..columns {
            let start = grid.x(column);
            grid.slabs.extend(polygons.iter().filter_map(|polygon| slab(polygon, start, pitch)));
            grid.first_slab.push(grid.slabs.len());
        }
        for node in 0..=columns {
            let spans = grid.spans_from_slabs(node);
            grid.spans.extend(spans);
            grid.first_span.push(grid.spans.len());
        }
        grid.area = (0..columns).map(|column| grid.area_above(column, [bottom; 2])).sum();
        Ok(grid)
    }

    /// Number of columns; there is one node more.
    pub(super) fn columns(&self) -> usize {
        self.first_slab.len() - 1
    }

    /// x of a node, m.
    pub(super) fn x(&self, node: usize) -> f64 {
        self.left + self.pitch * node as f64
    }

    /// Width of a column, m.
    pub(super) fn pitch(&self) -> f64 {
        self.pitch
    }

    /// Smallest y of the food, m.
    pub(super) fn top(&self) -> f64 {
        self.top
    }

    /// Largest y of the food, m.
    pub(super) fn bottom(&self) -> f64 {
        self.bottom
    }

    /// Extent along the cutting direction, m.
    pub(super) fn height(&self) -> f64 {
        self.bottom - self.top
    }

    /// Area of the food, m².
    pub(super) fn area(&self) -> f64 {
        self.area
    }

    /// Nodes within `[from, to]` along x, as a range.
    pub(super) fn nodes_between(&self, from: f64, to: f64) -> std::ops::Range<usize> {
        let first = ((from - self.left) / self.pitch).ceil().max(0.0) as usize;
        let beyond = ((to - self.left) / self.pitch).floor() + 1.0;
        first..(beyond.max(0.0) as usize).min(self.columns() + 1)
    }

    /// Upper and lower ends of the food at a node, from top to bottom.
    pub(super) fn spans(&self, node: usize) -> &[(f64, f64)] {
        &self.spans[self.first_span[node]..self.first_span[node + 1]]
    }

    /// Lengths along x, shared between the column's two nodes by the distance to them, on which the profile through
    /// `ends` lies in the food: on its upper side counts, on its lower does not.
    pub(super) fn tributary(&self, column: usize, ends: [f64; 2]) -> [f64; 2] {
        let mut shares = [0.0, 0.0];
        for slab in self.slabs_of(column) {
            let profile = slab.extent.map(|at| lerp(ends, at));
            let below_top = [profile[0] - slab.top[0] + ROUNDING_M, profile[1] - slab.top[1] + ROUNDING_M];
            let above_bottom = [slab.bottom[0] - profile[0] - ROUNDING_M, slab.bottom[1] - profile[1] - ROUNDING_M];
            let [first, second] = [not_negative_on(below_top), not_negative_on(above_bottom)];
            let (from, to) = (first[0].max(second[0]), first[1].min(second[1]));
            if from < to {
                let [from, to] = [from, to].map(|at| lerp(slab.extent, at));
                let toward_second = 0.5 * (to * to - from * from);
                shares[0] += to - from - toward_second;
                shares[1] += toward_second;
            }
        }
        shares.map(|share| share * self.pitch)
    }

    /// Area of the column's food above the profile through `ends`, m².
    pub(super) fn area_above(&self, column: usize, ends: [f64; 2]) -> f64 {
        let above = |slab: &Slab| {
            let profile = slab.extent.map(|at| lerp(ends, at));
            let under_top = mean_of_positive([profile[0] - slab.top[0], profile[1] - slab.top[1]]);
            let under_bottom = mean_of_positive([profile[0] - slab.bottom[0], profile[1] - slab.bottom[1]]);
            (under_top - under_bottom) * (slab.extent[1] - slab.extent[0]) * self.pitch
        };
        self.slabs_of(column).iter().map(above).sum()
    }

    /// Whether the middle of the column at depth `y` is food.
    pub(super) fn has_food_at(&self, column: usize, y: f64) -> bool {
        self.slabs_of(column).iter().any(|slab| {
            let width = slab.extent[1] - slab.extent[0];
            let at = (0.5 - slab.extent[0]) / width;
            (0.0..=1.0).contains(&at) && (lerp(slab.top, at)..lerp(slab.bottom, at)).contains(&y)
        })
    }

    fn slabs_of(&self, column: usize) -> &[Slab] {
        &self.slabs[self.first_slab[column]..self.first_slab[column + 1]]
    }

    /// Spans at a node: from the slabs that reach it or, beside an upright wall, from those of its columns.
    fn spans_from_slabs(&self, node: usize) -> Vec<(f64, f64)> {
        let left = node.checked_sub(1).map_or(&[][..], |column| self.slabs_of(column));
        let right = if node < self.columns() { self.slabs_of(node) } else { &[][..] };
        let mut spans: Vec<(f64, f64)> = Vec::new();
        spans.extend(left.iter().filter(|slab| slab.extent[1] >= 1.0).map(|slab| (slab.top[1], slab.bottom[1])));
        spans.extend(right.iter().filter(|slab| slab.extent[0] <= 0.0).map(|slab| (slab.top[0], slab.bottom[0])));
        if spans.is_empty() {
            let hull = |slab: &Slab| (slab.top[0].min(slab.top[1]), slab.bottom[0].max(slab.bottom[1]));
            spans.extend(left.iter().chain(right).map(hull));
        }
        spans.sort_by(|a, b| a.0.total_cmp(&b.0));
        spans.dedup_by(|next, kept| {
            let touching = next.0 <= kept.1 + ROUNDING_M;
            if touching {
                kept.1 = kept.1.max(next.1);
            }
            touching
        });
        spans
    }
}

/// Checks one polygon.
fn convex(at: usize, polygon: &[Point2<f64>]) -> Result<(), FieldError> {
    let refuse = |found: &str| Err(FieldError::new(format!("polygons[{at}]"), found, "a convex polygon with an area"));
    if polygon.iter().any(|point| !(point.x.is_finite() && point.y.is_finite())) {
        return refuse("a corner that is not finite");
    }
    let count = polygon.len();
    let turn = |k: usize| {
        let [a, b, c] = [0, 1, 2].map(|step| polygon[(k + step) % count]);
        (b - a).perp(&(c - b))
    };
    let (mut left, mut right, mut doubled_area) = (0.0_f64, 0.0_f64, 0.0);
    for k in 0..count {
        left = left.max(turn(k));
        right = right.max(-turn(k));
        doubled_area += polygon[k].coords.perp(&polygon[(k + 1) % count].coords);
    }
    if count < 3 || doubled_area.abs() < ROUNDING_M * ROUNDING_M {
        return refuse("no area");
    }
    // corners in one line turn by rounding only
    if left.min(right) > 1e-6 * doubled_area.abs() { refuse("a hollow corner") } else { Ok(()) }
}

/// The part of a convex polygon between `start` and `start + pitch`.
fn slab(polygon: &[Point2<f64>], start: f64, pitch: f64) -> Option<Slab> {
    let [low, high] = range(polygon.iter().map(|point| point.x));
    let (from, to) = (low.max(start), high.min(start + pitch));
    if to - from < ROUNDING_M {
        return None;
    }
    let (first, second) = (across(polygon, from)?, across(polygon, to)?);
    // the ends of the column are exactly 0 and 1 where the polygon covers them
    let share = |x: f64, border: f64, at: f64| if (x - border).abs() < ROUNDING_M { at } else { (x - start) / pitch };
    let extent = [share(from, start, 0.0), share(to, start + pitch, 1.0)];
    Some(Slab { extent, top: [first[0], second[0]], bottom: [first[1], second[1]] })
}

/// Smallest and largest y of a convex polygon at `x`.
fn across(polygon: &[Point2<f64>], x: f64) -> Option<[f64; 2]> {
    let next = polygon.iter().cycle().skip(1);
    let hits = polygon.iter().zip(next).flat_map(|(a, b)| {
        let run = b.x - a.x;
        let inside = (a.x.min(b.x) - ROUNDING_M..=a.x.max(b.x) + ROUNDING_M).contains(&x);
        let at = |share: f64| a.y + (b.y - a.y) * share.clamp(0.0, 1.0);
        let found = if run.abs() < ROUNDING_M { [a.y, b.y] } else { [at((x - a.x) / run); 2] };
        inside.then_some(found).into_iter().flatten()
    });
    let [low, high] = range(hits);
    (low <= high).then_some([low, high])
}

fn range(values: impl Iterator<Item = f64>) -> [f64; 2] {
    values.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], value| [low.min(value), high.max(value)])
}

fn lerp(ends: [f64; 2], at: f64) -> f64 {
    ends[0] + (ends[1] - ends[0]) * at
}

/// Part of [0, 1] on which a straight function through `ends` is not negative; empty is (1, 0).
fn not_negative_on(ends: [f64; 2]) -> [f64; 2] {
    match (ends[0] >= 0.0, ends[1] >= 0.0) {
        (true, true) => [0.0, 1.0],
        (true, false) => [0.0, ends[0] / (ends[0] - ends[1])],
        (false, true) => [ends[0] / (ends[0] - ends[1]), 1.0],
        (false, false) => [1.0, 0.0],
    }
}

/// Mean over [0, 1] of the positive part of a straight function through `ends`.
fn mean_of_positive(ends: [f64; 2]) -> f64 {
    match (ends[0] > 0.0, ends[1] > 0.0) {
        (true, true) => 0.5 * (ends[0] + ends[1]),
        (true, false) => 0.5 * ends[0] * ends[0] / (ends[0] - ends[1]),
        (false, true) => 0.5 * ends[1] * ends[1] / (ends[1] - ends[0]),
        (false, false) => 0.0,
    }
}

#[cfg(test)]
#[path = "grid_tests.rs"]
mod tests;
