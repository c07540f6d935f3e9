//! Rapier scenes, controllers and the control loop.
//!
//! | module | what it simulates |
//! |---|---|
//! | [`planar`] | pushing over a table: object on a limit surface, tool, obstacles, planar arm |
//! | [`spatial`] | an arm in space with its full dynamics, a tool in its hand, what a task adds |
//! | [`cutting`], [`pouring`] | foods that come apart under a knife, grains that leave a vessel |
//! | [`controllers`] | impedance and other laws, from the reference to joint torques |
//! | [`sensing`], [`human`] | a late and noisy camera, a synthetic human who demonstrates |
//!
//! # Example
//!
//! A disc slides over a table until friction has taken its speed, after v²/(2 μ g):
//!
//! ```
//! use nalgebra::{Isometry2, vector};
//! use sim::planar::{EngineConfig, MapBounds, ObjectConfig, PlanarWorld, WorldConfig};
//! use sim::support::SupportModel;
//! use skills::outline::Outline;
//!
//! let table = WorldConfig {
//!     map: MapBounds { min_m: [-1.0, -1.0], max_m: [1.0, 1.0] },
//!     gravity_m_per_s2: 9.81,
//!     obstacles: vec![],
//! };
//! let disc = ObjectConfig {
//!     name: "disc".into(),
//!     shape: Outline::Disc { radius_m: 0.012 },
//!     mass_kg: 0.0054,
//!     table_friction: 0.25,
//!     support: SupportModel::Ellipsoid,
//! };
//! let mut world = PlanarWorld::new(&table, &disc, &EngineConfig::default(), &Isometry2::identity())?;
//! world.set_object_twist(&vector![0.3, 0.0, 0.0]); // m/s, m/s, rad/s
//! while world.object_twist().norm() > 0.0 {
//!     world.step();
//! }
//! let slid_m = world.world_from_object().translation.vector.norm();
//! assert!((slid_m - 0.3_f64.powi(2) / (2.0 * 0.25 * 9.81)).abs() < 1e-4);
//! # Ok::<(), sim::SimError>(())
//! ```

pub mod controllers;
pub mod cutting;
mod error;
pub mod human;
pub mod planar;
pub mod pouring;
pub mod random;
pub mod sensing;
pub mod spatial;
pub mod support;

pub use error::SimError;
