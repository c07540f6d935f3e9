//! Planar scenes on Rapier 2-D: the table seen from above.

mod arm;
mod config;
mod contact;
mod convert;
mod episode;
mod observer;
mod pusher;
mod reach;
mod reference;
mod simulation;
mod slider;
mod tracker;
mod world;

pub use arm::{PlanarArm, arm_with_tool, spatial};
pub use config::{EngineConfig, MapBounds, ObjectConfig, Obstacle, WorldConfig};
pub use contact::{ContactForce, Party};
pub use episode::{Episode, EpisodeSample};
pub use observer::{ArmDescription, Event, EventLevel, Observer, Sample, SceneDescription};
pub use pusher::Pusher;
pub use reach::ArmReach;
pub use reference::{ClosedLoop, ClosedLoopConfig, OpenLoop, ReferenceSource, ToolReference};
pub use simulation::{PlanarSetup, check_reach, simulate};
pub use tracker::Tracker;
pub use world::PlanarWorld;
