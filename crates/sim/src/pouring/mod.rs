//! Pouring: grains, containers, and what is collected, spilt and left.
//!
//! Everything here is a component of somebody else's world: a [`Container`] lends its colliders to any body of a
//! `rapier3d::PhysicsWorld` (a kinematic one, a link of an arm), [`Grains`] owns no world, and a [`PourMonitor`] only
//! looks. Per engine step, the owner of the world calls, in this order: [`Grains::before_step`], the engine's step,
//! [`PourMonitor::after_step`]. None of these allocates. With an arm that holds the cup, [`PouringProcess`] is that owner.

mod container;
mod engine;
mod filling;
mod grains;
mod monitor;
mod process;

pub use container::{
    AttachedContainer, Bottle, Cone, Container, ContainerFile, ContainerMass, DrawingMesh, Lip, Piece, PieceShape,
    Profile, Rim, Spout, Straight,
};
pub use engine::{FrictionScheme, GrainEngineConfig};
pub use filling::{FillAmount, Filling, PACKING_FRACTION, fill};
pub use grains::{GrainBatch, GrainConfig, GrainShape, Grains};
pub use monitor::{Counts, LandingSpread, MonitorConfig, Place, PourMonitor};
pub use process::{
    ArmClearance, Grip, LipReport, Masses, PourGauge, PourReading, PourResult, PourSetup, PouringProcess, TableConfig,
    VesselClearance, container_drawing, grain_description, held_container,
};
