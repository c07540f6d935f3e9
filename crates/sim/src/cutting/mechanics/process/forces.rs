//! Forces of the edge, of the flanks and of the walls of the cut in one step.

use nalgebra::Point2;

use super::Cut;
use crate::cutting::mechanics::elements::{
    EdgeElement, EdgeSums, EdgeZone, FlankPatch, FlankStress, FlankSums, PlanarWrench,
};
use crate::cutting::mechanics::giving::Elasticity;
use crate::cutting::mechanics::lateral::{Walls, flank_stiffness_n_per_m, plane_strain, shear_share};
use crate::cutting::mechanics::motion::EdgeMotion;

/// Foods at least this stiff press on the flanks of the blade that spreads them, Pa.
const STIFF_FOOD_PA: f64 = 1e6;
/// Share of the largest stiffness that a step of semi-implicit integration bears; 4 is the limit of stability.
const STIFFNESS_SHARE: f64 = 0.5;

impl Cut {
    /// How the edge meets the food in this step.
    pub(super) fn zone(&self, width: f64, resistance: f64, dt: f64) -> EdgeZone {
        let largest_stiffness = STIFFNESS_SHARE * self.config.effective_mass_kg / (dt * dt * width);
        EdgeZone {
            resistance,
            stiffness: self.material.indentation_stiffness_pa.min(largest_stiffness),
            largest_stiffness,
            efficiency: self.material.slice_efficiency,
            tooth_ratio: self.edge.tooth_ratio,
            friction: self.edge.friction,
            creep_speed: self.config.creep_speed_m_per_s,
            squeeze_ratio: self.config.squeeze_ratio,
            board: self.board,
            elasticity: self.config.free_food_kg.map(|mass_kg| {
                let stiffness = shear_share() * self.material.indentation_stiffness_pa * width;
                (Elasticity::new(stiffness, mass_kg, dt), width)
            }),
            dt,
        }
    }

    /// Lets the edge act at all nodes.
    pub(super) fn act(&mut self, motion: &EdgeMotion, zone: &EdgeZone) -> EdgeSums {
        let mut sums = EdgeSums::default();
        for node in 0..=self.grid.columns() {
            let element = &mut self.elements[node];
            if self.front.dent[node] <= 0.0 || self.front.width[node] <= 0.0 {
                *element = EdgeElement::default();
            } else {
                let at = Point2::new(self.grid.x(node), self.front.edge[node]);
                zone.act(node, &mut self.front, element, at, motion, &mut sums);
            }
        }
        sums
    }

    /// Friction of the flanks in the cut, both together: 2 (τ + μ p) with the pressure p of a spread stiff food.
    pub(super) fn rub(&mut self, motion: &EdgeMotion, dt: f64) -> FlankSums {
        let shear = 2.0 * (self.material.flank_shear_pa + self.edge.friction * self.spreading_pressure_pa());
        let blade_area = |column: usize| self.front.blade_area(&self.grid, column, self.edge.blade_height_m);
        let elasticity = self.config.free_food_kg.map(|mass_kg| {
            let whole: f64 = (0..self.grid.columns()).map(blade_area).sum();
            let stiffness = flank_stiffness_n_per_m(self.material.youngs_modulus_pa, whole);
            (Elasticity::new(stiffness, mass_kg, dt), whole)
        });
        let stress = FlankStress { shear, creep_speed: self.config.creep_speed_m_per_s, elasticity };
        let mut sums = FlankSums::default();
        for column in 0..self.grid.columns() {
            self.surface.record(&self.grid, &self.front, column, motion);
            let area = self.front.blade_area(&self.grid, column, self.edge.blade_height_m);
            if area <= 0.0 {
                self.flanks[column].release();
            } else {
                let ends = [column, column + 1].map(|node| self.front.edge[node].min(self.front.crack[node]));
                let depth = (0.5 * (ends[0] + ends[1])).min(self.grid.bottom());
                sums.add(column, &self.grid, FlankPatch { area, depth }, &stress, &mut self.flanks[column], motion);
            }
        }
        sums
    }

    /// Pressure of a stiff food on the blade that spreads it, Pa: E* t/(2 h).
    fn spreading_pressure_pa(&self) -> f64 {
        let modulus = self.material.youngs_modulus_pa;
        // a brittle food opens before the blade and does not grip it
        if modulus < STIFF_FOOD_PA || self.brittle() {
            return 0.0;
        }
        plane_strain(modulus) * self.edge.thickness_m / (2.0 * self.grid.height())
    }

    /// What keeps the blade in the plane of the cut.
    pub(super) fn walls(&self, dt: f64) -> Walls {
        let mass = self.config.effective_mass_kg;
        Walls {
            modulus: self.material.youngs_modulus_pa,
            yield_stress: self.material.yield_stress_pa,
            freedom: self.config.blade_freedom_m,
            // what the walls turn and push is the lighter one of knife and food
            largest_stiffness: STIFFNESS_SHARE * self.config.free_food_kg.unwrap_or(mass).min(mass) / (dt * dt),
        }
    }
}

/// Adds up forces.
pub(super) fn sum(wrenches: [PlanarWrench; 3]) -> PlanarWrench {
    wrenches.iter().fold(PlanarWrench::default(), |total, wrench| PlanarWrench {
        force: total.force + wrench.force,
        moment: total.moment + wrench.moment,
    })
}
