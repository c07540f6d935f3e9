//! A piece of food as a body of the engine.

use nalgebra::{Isometry3, Point3, Vector3};
use rapier3d::prelude::{
    CoefficientCombineRule, ColliderBuilder, MassProperties as EngineMass, RigidBodyBuilder, RigidBodyHandle,
};

use super::incision::Incision;
use super::record::PieceRecord;
use super::setup::FOOD_GROUPS;
use crate::cutting::geometry::{MassProperties, Solid};
use crate::cutting::knife::Edge;
use crate::cutting::material::Material;
use crate::spatial::SpatialWorld;
use crate::spatial::convert;

/// How a piece lies and moves: pose of the food's frame, and the velocity of that frame's points.
#[derive(Clone, Copy, Debug)]
pub(super) struct Lie {
    /// Pose of the food's frame, in which the piece keeps its place of the whole food.
    pub world_from_food: Isometry3<f64>,
    /// Velocity of the center of mass, m/s.
    pub velocity: Vector3<f64>,
    /// Angular velocity, rad/s.
    pub angular_velocity: Vector3<f64>,
    /// Center of mass in the world.
    pub center: Point3<f64>,
}

impl Lie {
    /// Velocity of the point of the piece that is at `at` in the world, m/s.
    pub fn velocity_at(&self, at: &Point3<f64>) -> Vector3<f64> {
        self.velocity + self.angular_velocity.cross(&(at - self.center))
    }
}

/// One piece.
pub(super) struct Piece {
    pub name: String,
    pub solid: Solid,
    pub mass: MassProperties,
    pub lie: Lie,
    /// Cuts that were begun in it and are not through.
    pub incisions: Vec<Incision>,
    /// Index of the one in which the knife is.
    pub active: Option<usize>,
    /// Whether a touch begins a cut: not while the knife that cut it off is beside it still.
    pub armed: bool,
    /// Shade in which it is drawn.
    pub shade: usize,
    /// None for a crumb.
    body: Option<RigidBodyHandle>,
    low: Point3<f64>,
    high: Point3<f64>,
}

/// The knife has left a piece when it is this far outside of the piece's box, m.
const CLEAR_M: f64 = 1e-3;

impl Piece {
    /// Puts a solid into the engine; it moves as `lie` says of the body that it was part of.
    pub fn insert(
        world: &mut SpatialWorld,
        name: String,
        solid: Solid,
        material: &Material,
        lie: &Lie,
        armed: bool,
    ) -> Self {
        let mass = solid.mass_properties(material.density_kg_per_m3);
        let (low, high) = solid.bounds();
        let center = lie.world_from_food * mass.center;
        let lie = Lie { velocity: lie.velocity_at(&center), center, ..*lie };
        let body = (!solid.is_crumb()).then(|| body_of(world, &solid, &mass, material, &lie));
        Self { name, solid, mass, lie, incisions: Vec::new(), active: None, armed, shade: 0, body, low, high }
    }

    /// Takes the piece out of the engine.
    pub fn remove(&self, world: &mut SpatialWorld) {
        if let Some(body) = self.body {
            world.physics.remove_body(body);
        }
    }

    /// Reads how the piece lies and moves now.
    pub fn refresh(&mut self, world: &SpatialWorld) {
        let Some(body) = self.body.and_then(|body| world.physics.bodies.get(body)) else { return };
        self.lie = Lie {
            world_from_food: convert::isometry(body.position()),
            velocity: convert::to_vector(body.linvel()),
            angular_velocity: convert::to_vector(body.angvel()),
            center: Point3::from(convert::to_vector(body.center_of_mass())),
        };
    }

    /// Forgets the forces of the last step.
    pub fn relax(&self, world: &mut SpatialWorld) {
        if let Some(body) = self.body.and_then(|body| world.physics.bodies.get_mut(body)) {
            body.reset_forces(false);
            body.reset_torques(false);
        }
    }

    /// Adds a force (N) at a point and a moment (N m) for the next step, world axes.
    pub fn push(&self, world: &mut SpatialWorld, force: &Vector3<f64>, at: &Point3<f64>, moment: &Vector3<f64>) {
        if let Some(body) = self.body.and_then(|body| world.physics.bodies.get_mut(body)) {
            body.add_force_at_point(convert::vector(force), convert::point(at), true);
            body.add_torque(convert::vector(moment), true);
        }
    }

    /// Does the edge of a knife meet the piece?
    pub fn meets(&self, world_from_knife: &Isometry3<f64>, edge: &Edge) -> bool {
        self.body.is_some()
            && self.near(world_from_knife, edge)
            && self.segments(world_from_knife, edge).any(|[from, to]| self.solid.meets(&from, &to))
    }

    /// Is the edge of a knife in the box around the piece, or next to it?
    pub fn near(&self, world_from_knife: &Isometry3<f64>, edge: &Edge) -> bool {
        self.segments(world_from_knife, edge).any(|[from, to]| self.box_meets(&from, &to))
    }

    /// The segments of an edge in the food's frame.
    fn segments<'a>(
        &self,
        world_from_knife: &Isometry3<f64>,
        edge: &'a Edge,
    ) -> impl Iterator<Item = [Point3<f64>; 2]> + 'a {
        let food_from_knife = self.lie.world_from_food.inv_mul(world_from_knife);
        let placed = move |index: usize| food_from_knife * Point3::new(edge.points[index].x, edge.points[index].y, 0.0);
        (1..edge.points.len()).map(move |index| [placed(index - 1), placed(index)])
    }

    fn box_meets(&self, from: &Point3<f64>, to: &Point3<f64>) -> bool {
        let (mut first, mut last) = (0.0_f64, 1.0_f64);
        for axis in 0..3 {
            let (start, way) = (from[axis], to[axis] - from[axis]);
            let [low, high] = [self.low[axis] - CLEAR_M - start, self.high[axis] + CLEAR_M - start];
            if way.abs() < f64::EPSILON {
                if low > 0.0 || high < 0.0 {
                    return false;
                }
                continue;
            }
            let (enter, leave) = if way > 0.0 { (low / way, high / way) } else { (high / way, low / way) };
            (first, last) = (first.max(enter), last.min(leave));
        }
        first <= last
    }

    /// What is reported of it.
    pub fn record(&self) -> PieceRecord {
        PieceRecord {
            name: self.name.clone(),
            mass_kg: self.mass.mass_kg,
            volume_m3: self.solid.volume_m3(),
            center_in_world: self.lie.center,
            center_in_food: self.mass.center,
            extent_in_food_m: self.high - self.low,
            cells: self.solid.cells().len(),
            crumb: self.body.is_none(),
        }
    }
}

fn body_of(
    world: &mut SpatialWorld,
    solid: &Solid,
    mass: &MassProperties,
    material: &Material,
    lie: &Lie,
) -> RigidBodyHandle {
    let properties = EngineMass::with_inertia_matrix(
        convert::point(&mass.center),
        mass.mass_kg,
        convert::matrix(&mass.inertia_kg_m2),
    );
    let body = RigidBodyBuilder::dynamic()
        .pose(convert::pose(&lie.world_from_food))
        .linvel(convert::vector(&lie.velocity))
        .angvel(convert::vector(&lie.angular_velocity))
        .additional_mass_properties(properties)
        .can_sleep(false);
    let handle = world.physics.insert_body(body);
    for shape in solid.colliders() {
        let collider = ColliderBuilder::new(shape)
            .density(0.0)
            .friction(material.board_friction)
            .friction_combine_rule(CoefficientCombineRule::Min)
            .collision_groups(FOOD_GROUPS);
        world.physics.insert_collider(collider, Some(handle));
    }
    // the engine would know the mass only after the next step
    if let Some(body) = world.physics.bodies.get_mut(handle) {
        body.recompute_mass_properties_from_colliders(&world.physics.colliders);
    }
    handle
}
