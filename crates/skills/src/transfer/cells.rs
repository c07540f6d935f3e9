//! The map as cells: which of them the object's center may be in, and where the tool may stand to hold it there.

use std::f64::consts::TAU;

use nalgebra::Point2;

use super::grid::Grid;
use super::holds::Hold;
use super::shapes::Shapes;
use super::workplace::Workplace;

/// What is known of a place.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Known {
    Nothing,
    Free,
    Barred,
}

/// Cells of a map; what is asked once is remembered.
pub(super) struct Cells {
    pub(super) grid: Grid,
    shapes: Shapes,
    reference: Vec<Point2<f64>>,
    object: Vec<Known>,
    tool: Vec<Known>,
    deviations: Vec<f64>,
}

impl Cells {
    pub(super) fn new(workplace: &Workplace<'_>, grid: Grid, reference: &[Point2<f64>]) -> Self {
        Self {
            shapes: Shapes::new(workplace),
            reference: reference.to_vec(),
            object: vec![Known::Nothing; grid.len()],
            tool: Vec::new(),
            deviations: vec![f64::NAN; grid.len()],
            grid,
        }
    }

    /// Distance between tool and object in a hold, m; negative where they overlap.
    pub(super) fn gap_m(&self, hold: &Hold) -> f64 {
        self.shapes.gap_m(&hold.center_from_tool, &Point2::origin())
    }

    /// Whether the object may be in a cell, and half a cell around it.
    pub(super) fn object_is_free(&mut self, workplace: &Workplace<'_>, cell: [i32; 2]) -> bool {
        let Some(index) = self.grid.index(cell) else { return false };
        if self.object[index] == Known::Nothing {
            self.object[index] = known(self.is_object_free_at(workplace, &self.grid.center(cell)));
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
        let Some(index) = self.grid.index(cell) else { return false };
        self.tool.resize(self.object.len() * holds.len(), Known::Nothing);
        let state = index * holds.len() + hold;
        if self.tool[state] == Known::Nothing {
            self.tool[state] = known(self.is_tool_free_at(workplace, &holds[hold], &self.grid.center(cell)));
        }
        self.tool[state] == Known::Free
    }

    /// Whether nothing stands in the way of a push of several cells, its ends apart.
    pub(super) fn is_way_free(&self, workplace: &Workplace<'_>, hold: &Hold, from: [i32; 2]) -> bool {
        let way = self.grid.way(hold.step);
        let looks = (way.norm() / (2.0 * self.grid.half_m()) - WHOLE).ceil() as usize;
        (1..looks).all(|look| {
            let at = self.grid.center(from) + way * (look as f64 / looks as f64);
            self.is_object_free_at(workplace, &at) && self.is_tool_free_at(workplace, hold, &at)
        })
    }

    /// Squared distance of a cell from the reference path, m²; 0 without one.
    pub(super) fn squared_deviation(&mut self, cell: [i32; 2]) -> f64 {
        let Some(index) = self.grid.index(cell) else { return 0.0 };
        if self.deviations[index].is_nan() {
            let at = self.grid.center(cell);
            let pieces = self.reference.windows(2).filter_map(|piece| match piece {
                [a, b] => Some(squared_distance(&at, a, b)),
                _ => None,
            });
            let least = pieces.fold(f64::INFINITY, f64::min);
            self.deviations[index] = if least.is_finite() { least } else { 0.0 };
        }
        self.deviations[index]
    }

    /// What bars the object from the cell of a place, if anything does.
    pub(super) fn barred(&self, workplace: &Workplace<'_>, place: &Point2<f64>) -> Option<Barred> {
        let at = self.grid.center(self.grid.nearest_cell(place));
        if !is_in_map(workplace, &at) {
            return Some(Barred::Map);
        }
        let (clearance_m, least_m) =
            (self.shapes.object_clearance_m(&at), workplace.object_margin_m + self.grid.half_m());
        (clearance_m < least_m).then_some(Barred::Obstacle { clearance_m, least_m })
    }

    /// Whether a push from one place to another with a hold keeps every margin, whatever lies between the cells.
    pub(super) fn is_push_free(
        &self,
        workplace: &Workplace<'_>,
        hold: &Hold,
        from: &Point2<f64>,
        to: &Point2<f64>,
    ) -> bool {
        let looks = ((to - from).norm() / self.grid.half_m()).ceil().max(1.0) as usize;
        // a distance changes by no more than the way, which is half a look to the nearest look
        let slack_m = (to - from).norm() / looks as f64 / 2.0;
        (0..=looks).all(|look| {
            let at = from + (to - from) * (look as f64 / looks as f64);
            self.is_object_free(workplace, &at, slack_m) && self.is_tool_free(workplace, hold, &at, slack_m)
        })
    }

    fn is_object_free_at(&self, workplace: &Workplace<'_>, center: &Point2<f64>) -> bool {
        self.is_object_free(workplace, center, self.grid.half_m())
    }

    fn is_tool_free_at(&self, workplace: &Workplace<'_>, hold: &Hold, center: &Point2<f64>) -> bool {
        self.is_tool_free(workplace, hold, center, self.grid.half_m())
    }

    fn is_object_free(&self, workplace: &Workplace<'_>, center: &Point2<f64>, slack_m: f64) -> bool {
        let least_m = workplace.object_margin_m + slack_m;
        is_in_map(workplace, center) && self.shapes.object_clearance_up_to_m(center, least_m) >= least_m
    }

    fn is_tool_free(&self, workplace: &Workplace<'_>, hold: &Hold, center: &Point2<f64>, slack_m: f64) -> bool {
        let pose = hold.world_from_tool(center);
        let least_m = workplace.tool_margin_m + slack_m;
        let clear = workplace.tool_passes || self.shapes.tool_clearance_up_to_m(&pose, least_m) >= least_m;
        clear && workplace.reach.holds(&pose)
    }
}

/// What bars the object from a place.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Barred {
    /// The edge of the map.
    Map,
    /// An obstacle at `clearance_m` that is to be `least_m` away.
    Obstacle { clearance_m: f64, least_m: f64 },
}

/// Part of a look below which a way counts as a whole number of looks.
const WHOLE: f64 = 1e-9;

fn is_in_map(workplace: &Workplace<'_>, center: &Point2<f64>) -> bool {
    // an object that touches the edge is inside, whatever the rounding
    let rounding_m = 1e-12;
    (0..2).all(|axis| {
        let angle = axis as f64 * TAU / 4.0;
        center[axis] + workplace.object_support_m(angle) <= workplace.map_max[axis] + rounding_m
            && center[axis] - workplace.object_support_m(angle + TAU / 2.0) >= workplace.map_min[axis] - rounding_m
    })
}

fn known(free: bool) -> Known {
    if free { Known::Free } else { Known::Barred }
}

fn squared_distance(point: &Point2<f64>, a: &Point2<f64>, b: &Point2<f64>) -> f64 {
    let edge = b - a;
    let along = if edge.norm_squared() > 0.0 { (point - a).dot(&edge) / edge.norm_squared() } else { 0.0 };
    (point - (a + edge * along.clamp(0.0, 1.0))).norm_squared()
}
