//! Geometry of things that come apart: convex cells, the solids they make up, and what a cut leaves of them.
//!
//! A food is a [`Solid`]: convex cells in one frame that hold together where they share faces. A cut divides the cells it
//! meets, by clipping their face polygons, and what no longer holds together is a piece. Clipping hands every part of a
//! face to exactly one side and gives both sides the same cap, so volume is conserved whatever the plane passes through.

mod bonds;
mod cell;
mod clip;
mod cut_surface;
mod error;
mod hulls;
mod mass;
mod mesh;
mod plane;
pub mod polygon;
mod section;
mod solid;
mod topology;

pub use cell::{ConvexCell, FaceKind};
pub use cut_surface::{CutSurface, Piece};
pub use error::GeometryError;
pub use hulls::{HOLLOW_SHARE, THINNEST_COLLIDER_M};
pub use mass::MassProperties;
pub use mesh::{Surface, TriangleMesh};
pub use plane::{Plane, Side};
pub use section::Section;
pub use solid::{SLIVER_M, Solid};

#[cfg(test)]
mod random_cuts;
