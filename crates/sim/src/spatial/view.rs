//! What an onlooker sees of a run at one instant; buffers that are filled anew each control period.

use nalgebra::{Isometry3, Point3, UnitQuaternion};

use super::arm::SpatialArm;
use super::process::Process;
use super::world::SpatialWorld;

/// Poses and curves of one instant, kept so that no period allocates.
#[derive(Debug, Default)]
pub(super) struct View {
    pub world_from_links: Vec<Isometry3<f64>>,
    pub world_from_bodies: Vec<Isometry3<f64>>,
    pub grain_centers_world: Vec<Point3<f64>>,
    pub grain_turns: Vec<UnitQuaternion<f64>>,
    pub series: Vec<f64>,
}

impl View {
    pub fn look(&mut self, world: &SpatialWorld, arm: &SpatialArm, process: &dyn Process) {
        arm.link_poses(world, &mut self.world_from_links);
        self.world_from_bodies.clear();
        process.bodies(world, &mut self.world_from_bodies);
        self.grain_centers_world.clear();
        self.grain_turns.clear();
        process.grains(world, &mut self.grain_centers_world, &mut self.grain_turns);
        self.series.clear();
        process.series(&mut self.series);
    }
}
