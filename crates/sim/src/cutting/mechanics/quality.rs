//! Quality of an incision: form and roughness of the surface that was cut.

use std::f64::consts::PI;

use nalgebra::Vector3;

use super::grid::SectionGrid;
use super::surface::{Cell, Surface};

/// Measures of a cut surface. Deviations are taken from the plane that fits the surface best.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct IncisionQuality {
    /// Mean absolute deviation Ra, m.
    pub mean_deviation_m: f64,
    /// Distance Rt between the highest and the lowest deviation, m.
    pub total_deviation_m: f64,
    /// Mean absolute deviation of what is longer than 5 mm along the cutting direction, m.
    pub waviness_m: f64,
    /// Angle between the best plane and the plane in which the cut began, rad.
    pub tilt_rad: f64,
    /// Retreats and stops of more than 50 ms in the food.
    pub kinks: u32,
    /// Work that dented the food before the cut began, J.
    pub crush_work_j: f64,
    /// Area that was torn instead of cut, m²; zero until the food comes apart.
    pub torn_area_m2: f64,
}

/// Wavelength at which the filter lets half through, m.
const CUTOFF_M: f64 = 0.005;
/// Constant of the Gaussian profile filter of ISO 16610-21, √(ln 2/π).
const ALPHA: f64 = 0.469_718_639_349_826;

impl IncisionQuality {
    /// Mean absolute deviation Ra alone, m. Allocates nothing.
    pub(super) fn mean_deviation_m(surface: &Surface, grid: &SectionGrid, roughness_factor: f64) -> f64 {
        let Some(plane) = surface.best_plane(grid) else { return 0.0 };
        let cells = (0..grid.columns()).flat_map(|column| surface.column(grid, column));
        let deviations = cells.map(|cell| (cell.deviation - plane.dot(&Vector3::new(1.0, cell.x, cell.y))).abs());
        let (count, sum) = deviations.fold((0.0_f64, 0.0), |(count, sum), deviation| (count + 1.0, sum + deviation));
        roughness_factor * sum / count.max(1.0)
    }

    /// Form and roughness of a surface, roughness multiplied by the edge's factor.
    pub(super) fn of(surface: &Surface, grid: &SectionGrid, roughness_factor: f64) -> Self {
        let Some(plane) = surface.best_plane(grid) else { return Self::default() };
        let residual = |cell: Cell| cell.deviation - plane.dot(&Vector3::new(1.0, cell.x, cell.y));
        let mut sums = Sums::default();
        for column in 0..grid.columns() {
            let profile: Vec<(f64, f64)> = surface.column(grid, column).map(|cell| (cell.y, residual(cell))).collect();
            sums.add(&profile, surface.row_height());
        }
        let count = (sums.count as f64).max(1.0);
        Self {
            mean_deviation_m: roughness_factor * sums.absolute / count,
            total_deviation_m: roughness_factor * (sums.highest - sums.lowest),
            waviness_m: sums.wave / count,
            tilt_rad: plane.y.hypot(plane.z).atan(),
            ..Self::default()
        }
    }
}

/// Running sums over profiles along the cutting direction.
#[derive(Default)]
struct Sums {
    count: usize,
    absolute: f64,
    wave: f64,
    highest: f64,
    lowest: f64,
}

impl Sums {
    /// Adds one column's depths and residuals.
    fn add(&mut self, profile: &[(f64, f64)], row_height: f64) {
        let reach = (CUTOFF_M / row_height).ceil() as usize;
        for (at, &(y, value)) in profile.iter().enumerate() {
            self.count += 1;
            self.absolute += value.abs();
            self.highest = self.highest.max(value);
            self.lowest = self.lowest.min(value);
            let near = &profile[at.saturating_sub(reach)..(at + reach + 1).min(profile.len())];
            let (mut weights, mut weighted) = (0.0, 0.0);
            for &(other, residual) in near {
                let weight = (-PI * ((other - y) / (ALPHA * CUTOFF_M)).powi(2)).exp();
                weights += weight;
                weighted += weight * residual;
            }
            self.wave += (weighted / weights).abs();
        }
    }
}
