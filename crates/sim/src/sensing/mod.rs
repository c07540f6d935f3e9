//! Sensors: what the controller or the human sees of the world, late and with errors.

mod camera;

pub use camera::{Camera, CameraConfig, Sighting};
