//! What can be wrong with a shape that is to be cut.

/// Refusal of a cell, a solid or a cut surface.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum GeometryError {
    /// A face names a vertex that there is not, or has fewer than three.
    #[error("build cell: face {face} {found}; expected at least 3 different vertices of {vertices}; mend the face")]
    Face {
        /// Index of the face.
        face: usize,
        /// What is wrong with it.
        found: String,
        /// Number of vertices of the cell.
        vertices: usize,
    },
    /// The faces do not close: an edge belongs to one face, or to more than two.
    #[error(
        "build cell: the edge from vertex {from} to {to} has {found} faces running against it; expected exactly 1; \
         close the surface and turn all faces counterclockwise as seen from outside"
    )]
    Open {
        /// Vertex where the edge begins.
        from: usize,
        /// Vertex where it ends.
        to: usize,
        /// How often the edge runs the other way.
        found: usize,
    },
    /// A vertex lies outside of a face's plane: the face is not plane, the cell not convex, or the face turned inside out.
    #[error(
        "build cell: vertex {vertex} lies {distance_m:e} m {where_is}; expected a convex cell with plane faces that run \
         counterclockwise as seen from outside; divide it into convex cells"
    )]
    NotConvex {
        /// Index of the vertex.
        vertex: usize,
        /// How far out it lies, m.
        distance_m: f64,
        /// Relative to which face.
        where_is: String,
    },
    /// The cell, or what is to be a solid, has no volume, or numbers that are not finite.
    #[error("{operation}: found {found}; expected {expected}")]
    Value {
        /// What was done.
        operation: &'static str,
        /// What was found, with its unit.
        found: String,
        /// What would have been accepted, and how to mend it.
        expected: &'static str,
    },
}
