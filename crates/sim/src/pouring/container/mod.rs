//! Containers: hollow vessels made of convex pieces, with the places that pouring needs to know.
//!
//! A container's frame has its origin at the center of the base's underside and z along the axis, up; a spout points
//! along +x. What is drawn is what collides: the mesh is the union of the pieces, each closed.

mod attached;
mod file;
mod mass;
mod mesh;
mod piece;
mod profile;
mod revolved;
mod spout;

use nalgebra::{Point3, Vector3};
use rapier3d::prelude::{ColliderBuilder, SharedShape};
use skills::field::FieldError;

use super::grains::GrainConfig;

pub use attached::AttachedContainer;
pub use file::{Bottle, Cone, ContainerFile, Profile, Spout, Straight};
pub use mass::ContainerMass;
pub use mesh::DrawingMesh;
pub use piece::{Piece, PieceShape};
pub(crate) use profile::Meridian;

/// The circle that bounds the mouth, in the container's frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rim {
    /// Center, m.
    pub center_in_container: Point3<f64>,
    /// Inner radius, m.
    pub radius_m: f64,
    /// Unit normal of the mouth plane, out of the container.
    pub normal_in_container: Vector3<f64>,
}

/// Where the contents leave: the end of the spout, or the rim at +x without one; in the container's frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lip {
    /// Middle of the lip's edge, m.
    pub point_in_container: Point3<f64>,
    /// Unit vector along which the contents leave when the container lies on its side: horizontal, outward.
    pub direction_in_container: Vector3<f64>,
    /// Width of the opening there, m; the mouth's diameter without a spout.
    pub width_m: f64,
}

/// A rigid hollow vessel.
#[derive(Clone, Debug)]
pub struct Container {
    /// Name, as scenarios and reports call it.
    pub name: String,
    /// Convex pieces; their union is the vessel's wall.
    pub pieces: Vec<Piece>,
    /// The mouth.
    pub rim: Rim,
    /// The lip.
    pub lip: Lip,
    /// Height of the inner floor above the origin, m.
    pub floor_m: f64,
    /// Thickness of wall and floor, m.
    pub wall_m: f64,
    /// Volume up to the rim, m³.
    pub capacity_m3: f64,
    /// Mass, kg.
    pub mass_kg: f64,
    /// Coefficient of friction between the wall and a grain.
    pub friction: f64,
    /// Coefficient of restitution between the wall and a grain.
    pub restitution: f64,
    pub(crate) meridian: Meridian,
    facets: usize,
    spout: Option<spout::Trough>,
}

impl Container {
    /// Builds the container that `file` states.
    ///
    /// # Errors
    /// A [`FieldError`] naming the key of the file at fault, such as `profile.bottle.neck_radius_m`.
    pub fn new(file: &ContainerFile) -> Result<Self, FieldError> {
        file.validate()?;
        let meridian = file.profile.meridian(file.wall_m);
        let trough = file.spout.as_ref().map(|spout| spout::Trough::new(spout, file, &meridian));
        let mut pieces = revolved::pieces(&meridian, file.facets, file.wall_m, trough.as_ref());
        if let Some(trough) = &trough {
            pieces.extend(trough.pieces());
        }
        let rim_m = meridian.top_m();
        let rim = Rim {
            center_in_container: Point3::new(0.0, 0.0, rim_m),
            radius_m: meridian.mouth_radius_m(),
            normal_in_container: Vector3::z(),
        };
        let lip = trough.as_ref().map_or(
            Lip {
                point_in_container: Point3::new(rim.radius_m, 0.0, rim_m),
                direction_in_container: Vector3::x(),
                width_m: 2.0 * rim.radius_m,
            },
            spout::Trough::lip,
        );
        Ok(Self {
            name: file.name.clone(),
            pieces,
            rim,
            lip,
            floor_m: file.wall_m,
            wall_m: file.wall_m,
            capacity_m3: meridian.volume_m3(rim_m),
            mass_kg: file.mass_kg,
            friction: file.friction,
            restitution: file.restitution,
            meridian,
            facets: file.facets,
            spout: trough,
        })
    }

    /// Volume between the inner floor and `height_m` above it, m³; the capacity above the rim.
    #[must_use]
    pub fn volume_to_m3(&self, height_m: f64) -> f64 {
        self.meridian.volume_m3(self.floor_m + height_m)
    }

    /// Whether a point lies in the hollow: below the mouth plane and within the wall, or in the spout.
    #[must_use]
    pub fn holds(&self, point_in_container: &Point3<f64>) -> bool {
        self.meridian.contains(point_in_container)
            || self.spout.as_ref().is_some_and(|trough| trough.contains(point_in_container))
    }

    /// Mass, center of mass and inertia in the container's frame: those of the pieces, scaled to the stated mass.
    #[must_use]
    pub fn mass_properties(&self) -> ContainerMass {
        ContainerMass::of(&self.mesh(), self.mass_kg)
    }

    /// The collider of all pieces, without mass, its origin that of the container; a wall for grains of `grain`.
    pub fn collider(&self, grain: &GrainConfig) -> ColliderBuilder {
        grain.wall(self.shape().density(0.0), self.friction, self.restitution)
    }

    fn shape(&self) -> ColliderBuilder {
        ColliderBuilder::compound(self.pieces.iter().map(Piece::placed_shape).collect())
    }

    /// The pieces as one shape of the engine, its origin that of the container.
    pub(crate) fn solid(&self) -> SharedShape {
        SharedShape::compound(self.pieces.iter().map(Piece::placed_shape).collect())
    }

    /// A wall that continues the mouth upward by `height_m` and closes the spout: it keeps grains in while they settle.
    pub(crate) fn guide(&self, grain: &GrainConfig, height_m: f64) -> ColliderBuilder {
        let bottom_m = self.spout.as_ref().map_or(self.meridian.top_m(), spout::Trough::bottom_m);
        let radius_m = self.meridian.mouth_radius_m();
        let wall = Meridian::new(vec![(bottom_m, radius_m), (self.meridian.top_m() + height_m, radius_m)]);
        let plates = revolved::plates(&wall, self.facets, self.wall_m, None);
        let shapes = plates.iter().map(Piece::placed_shape).collect();
        grain.wall(ColliderBuilder::compound(shapes).density(0.0), self.friction, self.restitution)
    }

    /// Triangles of the wall, both sides, in the container's frame.
    #[must_use]
    pub fn mesh(&self) -> DrawingMesh {
        DrawingMesh::of(&self.pieces)
    }

    /// The same as it looks: without the faces within the wall, where its plates touch.
    #[must_use]
    pub fn looks(&self) -> DrawingMesh {
        DrawingMesh::mitered(&self.pieces, self.facets)
    }
}

#[cfg(test)]
#[path = "container_tests.rs"]
mod tests;
