//! What became of the grains of a run.

use nalgebra::Vector2;

use super::arm_watch::ArmClearance;
use super::lip_watch::LipReport;
use crate::pouring::monitor::{Counts, Place, PourMonitor};

/// Mass in each place, kg.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Masses {
    /// In the cup.
    pub source_kg: f64,
    /// In the target.
    pub target_kg: f64,
    /// On the way.
    pub flying_kg: f64,
    /// Spilt.
    pub spilt_kg: f64,
}

/// What became of the grains, and how they flowed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PourResult {
    /// How many are where; their sum is the number of grains.
    pub counts: Counts,
    /// The same as masses.
    pub masses: Masses,
    /// Mean flow between the first and the last grain, kg/s.
    pub mean_flow_kg_per_s: f64,
    /// Largest flow of any interval, kg/s.
    pub peak_flow_kg_per_s: f64,
    /// Standard deviation of the flow over its mean.
    pub flow_variation: f64,
    /// Mean speed of the grains as they left the cup, m/s.
    pub exit_speed_m_per_s: f64,
    /// Times that the flow stopped in a tilted cup.
    pub clogs: usize,
    /// Times that a grain left the target again.
    pub bounce_outs: usize,
    /// Times that a grain hit the target's rim.
    pub rim_hits: usize,
    /// Grains that came down through the plane of the mouth, inside or beside it.
    pub landed: usize,
    /// Mean place there from the middle of the mouth, m, in the target's frame.
    pub landing_mean_m: Vector2<f64>,
    /// Standard deviation there along x and y of the target, m.
    pub landing_deviation_m: Vector2<f64>,
    /// Width there that 95 % pass, along x and y of the target, m.
    pub landing_width_m: Vector2<f64>,
    /// The lip while grains left the cup.
    pub lip: LipReport,
    /// Times that the cup touched the target.
    pub target_touches: usize,
    /// Times that the cup touched the table.
    pub table_touches: usize,
    /// How far the arm's links kept from table and target, but for the base and its first link.
    pub arm: ArmClearance,
}

impl PourResult {
    pub(super) fn new(
        monitor: &PourMonitor,
        lip: LipReport,
        [target_touches, table_touches]: [usize; 2],
        arm: ArmClearance,
    ) -> Self {
        let landing = monitor.landing();
        Self {
            counts: monitor.counts(),
            masses: Masses {
                source_kg: monitor.mass_kg(Place::Source),
                target_kg: monitor.mass_kg(Place::Target),
                flying_kg: monitor.mass_kg(Place::Flying),
                spilt_kg: monitor.mass_kg(Place::Spilt),
            },
            mean_flow_kg_per_s: monitor.mean_flow_kg_per_s(),
            peak_flow_kg_per_s: monitor.peak_flow_kg_per_s(),
            flow_variation: monitor.flow_variation(),
            exit_speed_m_per_s: monitor.exit_speed_m_per_s(),
            clogs: monitor.clogs(),
            bounce_outs: monitor.bounce_outs(),
            rim_hits: monitor.rim_hits(),
            landed: landing.points_m().len(),
            landing_mean_m: landing.mean_m(),
            landing_deviation_m: landing.deviation_m(),
            landing_width_m: landing.width_m(),
            lip,
            target_touches,
            table_touches,
            arm,
        }
    }
}
