//! Movement primitives and tool-use skills: trajectories in, trajectories out.
//!
//! No files, no clock, no physics engine, no threads: equal input gives equal bits. What is there, from the ground up:
//!
//! | module | what it does | paper |
//! |---|---|---|
//! | [`primitive`] | learns motions from demonstrations and rolls them out to other starts, goals and durations: [`Dmp`], kernelized, generalizing by leave-one-out, position and orientation under one phase | (1)–(5) |
//! | [`regression`] | fits the forcing term: ridge, locally weighted, recursive sample by sample | (4) |
//! | [`coupling`] | laws of an additional term Δu: obstacles, potential fields, two arms | (6) |
//! | [`separation`] | takes constraints out of demonstrations, by a model of them or by bounds; says when the data cannot tell | (7)–(21) |
//! | [`corridor`], [`corridor_map`] | bounds over time, and the map between them and free space | (16)–(20) |
//! | [`corridor_filter`] | keeps a motion inside a corridor, with a certificate that holds between samples | (29)–(32), Theorem 1 |
//! | [`tool_flipping`] | changes the contact of tool and object without a collision, certified | (22)–(28) |
//! | [`plan`] | chains actions and verifies continuity, contacts and clearances | Sec. IV.A.3 |
//! | [`spatial`] | plans in space: timed tool poses with velocity and acceleration, verified between samples | Sec. III.A |
//! | [`cutting`], [`pouring`] | learns a cut and a pour from one demonstration, plans them for other foods, knives and containers | Sec. IV.C |
//! | [`tool_use`], [`transfer`] | learns pushing from demonstrations, plans with the same tool or with another one | Sec. III, IV.A |
//! | [`baseline`] | RRT* and two-level tool planning, to compare with | Sec. IV.B |
//!
//! Below them: [`trajectory`] (samples over time: derivatives, smoothing, joining), [`demonstration`] and [`segmentation`]
//! (what a person showed of a tool and an object, cut into actions), [`basis`], [`canonical`] and [`time_law`] (the functions that
//! primitives are made of), [`outline`], [`tool`] and [`pushing`] (flat shapes, tools with surfaces, what a push does),
//! [`field`] and [`error`] (why something was refused).
//!
//! # Which primitive
//!
//! | wanted | take |
//! |---|---|
//! | one demonstration or the mean of several, a goal or duration that changes on the way, obstacles | [`Dmp`], step by step [`DmpStepper`] |
//! | a tool's position and orientation | [`PoseDmp`], [`PoseStepper`] |
//! | via points, several at once; where the demonstrations agree | [`Kernelized`] with [`ViaPoint`]s |
//! | several demonstrations of which the best way to generalize is not known | [`Generalizing`] |
//! | the kind named in a file | [`PrimitiveConfig`], saved as [`SavedPrimitive`] |
//! | bounds of position, certified | [`corridor_filter::constrain`] |
//! | limits of velocity and acceleration | [`Rollout::least_stretch`], [`Rollout::stretched`] |
//!
//! # Examples
//!
//! Programs to begin with, `cargo run --release -p skills --example NAME`:
//!
//! | name | what it shows |
//! |---|---|
//! | `learn_from_csv` | a demonstration out of a CSV file, smoothed, learned and moved to a new goal |
//! | `change_goal` | a control loop, step by step, in which goal and duration change |
//! | `pose` | position and orientation, the way round that was shown, a goal that moves |
//! | `via_points` | several demonstrations, where they agree, two via points |
//! | `corridor` | a motion kept inside bounds with its certificate, and slowed to keep limits |
//! | `save_and_load` | every kind as text and back, with equal bits; a damaged file |
//!
//!
//! Learn a motion from one demonstration, move it to a new goal, and keep it inside a corridor:
//!
//! ```
//! use nalgebra::{DMatrix, dvector};
//! use skills::corridor::Corridor;
//! use skills::corridor_filter::{CorridorFilterConfig, FilterRequest, constrain};
//! use skills::{Dmp, DmpConfig, MovementPrimitive, RolloutRequest, Trajectory};
//!
//! // one second of a demonstration at 100 Hz, two coordinates, m
//! let shown = DMatrix::from_fn(101, 2, |row, k| {
//!     let t = row as f64 / 100.0;
//!     if k == 0 { 0.3 * t } else { 0.1 * (std::f64::consts::PI * t).sin().powi(2) }
//! });
//! let skill = Dmp::learn(&DmpConfig::default(), &[Trajectory::uniform(0.01, shown)?])?;
//!
//! let request = RolloutRequest::new(dvector![0.0, 0.0], dvector![0.4, 0.02], 1.5, 0.01);
//! let motion = skill.rollout(&request)?;
//!
//! let corridor = Corridor::still(&[-0.1, -0.05], &[0.5, 0.08])?;
//! let kept = constrain(&CorridorFilterConfig::default(), &motion, &corridor, &FilterRequest::of(&request))?;
//! assert!(kept.certificate.holds());
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

pub mod baseline;
pub mod basis;
pub mod canonical;
pub mod corridor;
pub mod corridor_filter;
pub mod corridor_map;
pub mod coupling;
pub mod cutting;
pub mod demonstration;
pub mod error;
pub mod field;
pub mod outline;
pub mod plan;
pub mod pouring;
pub mod primitive;
pub mod pushing;
pub mod regression;
pub mod segmentation;
pub mod separation;
pub mod spatial;
pub mod time_law;
pub mod tool;
pub mod tool_flipping;
pub mod tool_use;
pub mod trajectory;
pub mod transfer;

pub use error::SkillError;
pub use primitive::kernelized::{KernelizedMotion, ViaPoint};
pub use primitive::pose::{PoseDmp, PoseError, PoseMotion, PoseRequest, PoseRollout, PoseStepper, PoseTrajectory};
pub use primitive::{
    Dmp, DmpConfig, DmpForm, DmpPair, DmpStepper, Generalizing, GeneralizingConfig, Kernelized, KernelizedConfig,
    MotionLimits, MovementPrimitive, PrimitiveConfig, Rollout, RolloutRequest, SavedDmp, SavedPrimitive, rollout_pair,
};
pub use trajectory::{Ends, Trajectory};
