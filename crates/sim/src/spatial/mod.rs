//! Spatial scenes on Rapier 3-D: an arm with a tool in its hand, driven by torques.
//!
//! The arm is a multibody of the engine, with its full rigid-body dynamics; what a task adds (a food that resists the knife,
//! grains in a cup) is a [`Process`] that acts on the same engine between two steps, so that arm and task feel each other
//! within the step.

mod arm;
mod arm_config;
mod config;
pub(crate) mod convert;
mod drawing;
mod episode;
mod frames;
pub mod gain_study;
mod mismatch;
mod multibody;
mod observer;
mod process;
mod reach;
mod reference;
mod simulation;
mod tool;
mod view;
mod world;
mod wrench;

pub use arm::SpatialArm;
pub use arm_config::{ArmConfig, JointFriction};
pub use config::EngineConfig;
pub use drawing::{Drawing, DrawnShape, Rgba, TriangleMesh};
pub use episode::{Episode, EpisodeSample};
pub use mismatch::ModelMismatch;
pub use observer::{
    ArmDescription, BodyDrawing, GrainDescription, LinkDrawing, Observer, Sample, SceneDescription, Series, Target,
};
pub use process::{News, NoProcess, Process, Step, wrench_of};
pub use reach::{EachLook, OutOfReach, check_reach, check_reach_along, out_of_reach};
pub use reference::{ReferenceSource, SpatialReference};
pub use simulation::{SpatialSetup, simulate};
pub use tool::{HeldTool, ToolPiece, arm_with_tool};
pub use world::{SpatialWorld, standard_gravity};
pub use wrench::WrenchSensor;

pub use crate::planar::{Event, EventLevel};
