//! The cut surface as it was made: how far the edge was beside the plane when it passed each cell.

use nalgebra::{Matrix3, Point2, Vector2, Vector3};

use super::front::Front;
use super::grid::SectionGrid;
use super::motion::EdgeMotion;

/// Deviation of the cut surface from the section's plane, by columns and rows.
#[derive(Clone, Debug)]
pub(super) struct Surface {
    rows: usize,
    row_height: f64,
    deviation: Vec<f64>,
    recorded: Vec<bool>,
    /// The first row of each column that the crack has not passed.
    next_row: Vec<usize>,
}

/// One recorded cell: its place in the section and its deviation, m.
#[derive(Clone, Copy, Debug)]
pub(super) struct Cell {
    pub x: f64,
    pub y: f64,
    pub deviation: f64,
}

impl Surface {
    pub(super) fn new(grid: &SectionGrid, cell: f64) -> Self {
        let rows = (grid.height() / cell).ceil().max(1.0) as usize;
        let cells = rows * grid.columns();
        Self {
            rows,
            row_height: grid.height() / rows as f64,
            deviation: vec![0.0; cells],
            recorded: vec![false; cells],
            next_row: vec![0; grid.columns()],
        }
    }

    /// Records the rows of a column that the crack has passed since the last call.
    pub(super) fn record(&mut self, grid: &SectionGrid, front: &Front, column: usize, motion: &EdgeMotion) {
        let reached = 0.5 * (front.crack[column] + front.crack[column + 1]);
        let x = 0.5 * (grid.x(column) + grid.x(column + 1));
        while self.next_row[column] < self.rows {
            let row = self.next_row[column];
            let y = self.depth_of(grid, row);
            if y > reached {
                break;
            }
            let cell = column * self.rows + row;
            self.recorded[cell] = grid.has_food_at(column, y);
            self.deviation[cell] = motion.deviation_at(x, y);
            self.next_row[column] += 1;
        }
    }

    /// Mean depth and mean deviation from a plane that leans by `along` (dz/dx) in each of `bands` of equal height; bands
    /// that were not cut are left out.
    pub(super) fn bands(&self, grid: &SectionGrid, along: f64, bands: usize) -> Vec<Point2<f64>> {
        let mut sums = vec![(0.0_f64, Vector2::zeros()); bands];
        for cell in (0..grid.columns()).flat_map(|column| self.column(grid, column)) {
            let band = (cell.y - grid.top()) / grid.height() * bands as f64;
            if let Some((count, sum)) = sums.get_mut(band as usize) {
                *count += 1.0;
                *sum += Vector2::new(cell.y, cell.deviation - along * cell.x);
            }
        }
        sums.iter().filter(|(count, _)| *count > 0.0).map(|(count, sum)| Point2::from(sum / *count)).collect()
    }

    /// Height of a row, m.
    pub(super) fn row_height(&self) -> f64 {
        self.row_height
    }

    /// Recorded cells of a column from top to bottom.
    pub(super) fn column<'a>(&'a self, grid: &'a SectionGrid, column: usize) -> impl Iterator<Item = Cell> + 'a {
        let x = 0.5 * (grid.x(column) + grid.x(column + 1));
        (0..self.next_row[column]).filter_map(move |row| {
            let cell = column * self.rows + row;
            let y = self.depth_of(grid, row);
            self.recorded[cell].then(|| Cell { x, y, deviation: self.deviation[cell] })
        })
    }

    /// Plane z = c₀ + c₁ x + c₂ y through the recorded cells by least squares; none from less than three cells.
    pub(super) fn best_plane(&self, grid: &SectionGrid) -> Option<Vector3<f64>> {
        let (mut normal, mut right) = (Matrix3::zeros(), Vector3::zeros());
        // lengths about the section's corner in units of its height, for the matrix's sake
        let unit = grid.height();
        for cell in (0..grid.columns()).flat_map(|column| self.column(grid, column)) {
            let row = Vector3::new(1.0, (cell.x - grid.x(0)) / unit, (cell.y - grid.top()) / unit);
            normal += row * row.transpose();
            right += row * cell.deviation;
        }
        let scaled = normal.cholesky()?.solve(&right);
        let (along, down) = (scaled.y / unit, scaled.z / unit);
        Some(Vector3::new(scaled.x - along * grid.x(0) - down * grid.top(), along, down))
    }

    fn depth_of(&self, grid: &SectionGrid, row: usize) -> f64 {
        grid.top() + (row as f64 + 0.5) * self.row_height
    }
}
