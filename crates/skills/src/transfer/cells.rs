//! The map as cells: which of them the object's center may be in, and where the tool may stand to hold it there.

use nalgebra::{Point2, Vector2};

use super::holds::{Hold, scaled};
use super::workplace::{Shapes, Workplace};
use crate::field::FieldError;

/// Most cells of a map: their states are numbered in 32 bits.
const MOST_CELLS: usize = 4_000_000;

/// What is known of a place.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Known {
    Nothing,
    Free,
    Barred,
}

/// Cells of a map about the start, which is the center of the cell (0, 0); what is asked once is remembered.
pub(super) struct Cells {
    start: Point2<f64>,
    /// Sides of a cell, m, such that the goal is the center of a cell too.
    pub(super) cell_m: Vector2<f64>,
    first: [i32; 2],
    count: [usize; 2],
    shapes: Shapes,
    reference: Vec<Point2<f64>>,
    object: Vec<Known>,
    tool: Vec<Known>,
    deviations: Vec<f64>,
}

impl Cells {
    pub(super) fn new(
        workplace: &Workplace<'_>,
        cell_m: f64,
        reference: &[Point2<f64>],
        start: Point2<f64>,
        goal: Point2<f64>,
    ) -> Result<Self, FieldError> {
        let way = goal - start;
        let cell_m = way.map(|length: f64| match (length.abs() / cell_m).round() {
            0.0 => cell_m,
            cells => length.abs() / cells,
        });
        let range = |axis: usize| {
            let low = ((workplace.map_min[axis] - start[axis]) / cell_m[axis]).ceil();
            let high = ((workplace.map_max[axis] - start[axis]) / cell_m[axis]).floor();
            (low as i32, (high - low + 1.0).max(0.0) as usize)
        };
        let [(first_x, count_x), (first_y, count_y)] = [range(0), range(1)];
        let Some(len) = count_x.checked_mul(count_y).filter(|len| *len <= MOST_CELLS) else {
            let found = format!("{} m, which makes {count_x} by {count_y} cells", cell_m.min());
            return Err(FieldError::new("cell_m", found, format!("at most {MOST_CELLS} cells in the map")));
        };
        Ok(Self {
            start,
            cell_m,
            first: [first_x, first_y],
            count: [count_x, count_y],
            shapes: Shapes::new(workplace),
            reference: reference.to_vec(),
            object: vec![Known::Nothing; len],
            tool: Vec::new(),
            deviations: vec![f64::NAN; len],
        })
    }

    /// Number of cells.
    pub(super) fn len(&self) -> usize {
        self.object.len()
    }

    pub(super) fn index(&self, cell: [i32; 2]) -> Option<usize> {
        let column = usize::try_from(cell[0] - self.first[0]).ok().filter(|column| *column < self.count[0])?;
        let row = usize::try_from(cell[1] - self.first[1]).ok().filter(|row| *row < self.count[1])?;
        Some(row * self.count[0] + column)
    }

    pub(super) fn cell(&self, index: usize) -> [i32; 2] {
        [self.first[0] + (index % self.count[0]) as i32, self.first[1] + (index / self.count[0]) as i32]
    }

    pub(super) fn center(&self, cell: [i32; 2]) -> Point2<f64> {
        self.start + scaled(cell, &self.cell_m)
    }

    pub(super) fn nearest_cell(&self, place: &Point2<f64>) -> [i32; 2] {
        let cells = (place - self.start).component_div(&self.cell_m);
        [cells.x.round() as i32, cells.y.round() as i32]
    }

    /// Distance between tool and object in a hold, m; negative where they overlap.
    pub(super) fn gap_m(&self, hold: &Hold) -> f64 {
        self.shapes.gap_m(&hold.world_from_tool(&self.start), &self.start)
    }

    /// Whether the object may be in a cell, and half a cell around it.
    pub(super) fn object_is_free(&mut self, workplace: &Workplace<'_>, cell: [i32; 2]) -> bool {
        let Some(index) = self.index(cell) else { return false };
        if self.object[index] == Known::Nothing {
            self.object[index] = known(self.is_object_free_at(workplace, &self.center(cell)));
        }
        self.object[index] == Known::Free
    }

    /// Whether the tool may stand where it holds the object of a cell, and half a cell around it.
    pub(super) fn tool_is_free(
        &mut self,
        workplace: &Workplace<'_>,
        holds: &[Hold],
        cell: [i32; 2],
        hold: usize,
    ) -> bool {
        let Some(index) = self.index(cell) else { return false };
        self.tool.resize(self.object.len() * holds.len(), Known::Nothing);
        let state = index * holds.len() + hold;
        if self.tool[state] == Known::Nothing {
            self.tool[state] = known(self.is_tool_free_at(workplace, &holds[hold], &self.center(cell)));
        }
        self.tool[state] == Known::Free
    }

    /// Whether nothing stands in the way of a push of several cells, its ends apart.
    pub(super) fn is_way_free(&self, workplace: &Workplace<'_>, hold: &Hold, from: [i32; 2]) -> bool {
        let way = scaled(hold.step, &self.cell_m);
        let looks = (way.norm() / self.cell_m.min()).ceil() as usize;
        (1..looks).all(|look| {
            let at = self.center(from) + way * (look as f64 / looks as f64);
            self.is_object_free_at(workplace, &at) && self.is_tool_free_at(workplace, hold, &at)
        })
    }

    /// Squared distance of a cell from the reference path, m²; 0 without one.
    pub(super) fn squared_deviation(&mut self, cell: [i32; 2]) -> f64 {
        let Some(index) = self.index(cell) else { return 0.0 };
        if self.deviations[index].is_nan() {
            let at = self.center(cell);
            let pieces = self.reference.windows(2).filter_map(|piece| match piece {
                [a, b] => Some(squared_distance(&at, a, b)),
                _ => None,
            });
            let least = pieces.fold(f64::INFINITY, f64::min);
            self.deviations[index] = if least.is_finite() { least } else { 0.0 };
        }
        self.deviations[index]
    }

    /// Distance of the object from the nearest obstacle where that or the map's edge bars `place`, m.
    pub(super) fn refused_place_m(&self, workplace: &Workplace<'_>, place: &Point2<f64>) -> Option<f64> {
        let at = self.center(self.nearest_cell(place));
        (!self.is_object_free_at(workplace, &at)).then(|| self.shapes.object_clearance_m(&at))
    }

    fn is_object_free_at(&self, workplace: &Workplace<'_>, center: &Point2<f64>) -> bool {
        let tau = std::f64::consts::TAU;
        // a distance changes by no more than the way, so that what is free by half a look is free between two looks
        let look = self.cell_m.max() / 2.0;
        (0..2).all(|axis| {
            let angle = axis as f64 * tau / 4.0;
            center[axis] + workplace.object_support_m(angle) <= workplace.map_max[axis]
                && center[axis] - workplace.object_support_m(angle + tau / 2.0) >= workplace.map_min[axis]
        }) && self.shapes.object_clearance_m(center) >= workplace.object_margin_m + look
    }

    fn is_tool_free_at(&self, workplace: &Workplace<'_>, hold: &Hold, center: &Point2<f64>) -> bool {
        let pose = hold.world_from_tool(center);
        let look = self.cell_m.max() / 2.0;
        let clear = workplace.tool_passes || self.shapes.tool_clearance_m(&pose) >= workplace.tool_margin_m + look;
        clear && workplace.reach.holds(&pose)
    }
}

fn known(free: bool) -> Known {
    if free { Known::Free } else { Known::Barred }
}

fn squared_distance(point: &Point2<f64>, a: &Point2<f64>, b: &Point2<f64>) -> f64 {
    let edge = b - a;
    let along = if edge.norm_squared() > 0.0 { (point - a).dot(&edge) / edge.norm_squared() } else { 0.0 };
    (point - (a + edge * along.clamp(0.0, 1.0))).norm_squared()
}
