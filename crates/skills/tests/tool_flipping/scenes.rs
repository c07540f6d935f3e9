//! Tools, objects and reference vectors shared by the tests of tool flipping.

use nalgebra::{Isometry2, Vector2};
use serde_json::Value;
use skills::outline::{Outline, PlacedOutline};
use skills::tool::{ContactSurface, SurfaceShape, Tool};
use skills::tool_flipping::FlipTask;

/// Index of a surface of the L-shaped tool.
pub const BOTTOM: usize = 0;
pub const TIP: usize = 1;
pub const TOP: usize = 2;

pub fn vectors() -> Value {
    serde_json::from_str(include_str!("../data/tf.json")).unwrap()
}

pub fn number(value: &Value) -> f64 {
    value.as_f64().unwrap()
}

pub fn numbers(value: &Value) -> Vec<f64> {
    value.as_array().unwrap().iter().map(number).collect()
}

fn polygon(vertices_cm: &[[f64; 2]]) -> PlacedOutline {
    let vertices_m = vertices_cm.iter().map(|[x, y]| [x / 100.0, y / 100.0]).collect();
    PlacedOutline { shape: Outline::Polygon { vertices_m }, position_m: [0.0, 0.0], angle_rad: 0.0 }
}

fn face(name: &str, start_cm: [f64; 2], end_cm: [f64; 2]) -> ContactSurface {
    let meters = |[x, y]: [f64; 2]| [x / 100.0, y / 100.0];
    let shape = SurfaceShape::Face { start_m: meters(start_cm), end_m: meters(end_cm) };
    ContactSurface::new(name, shape)
}

fn tool(name: &str, pieces: Vec<PlacedOutline>, surfaces: Vec<ContactSurface>) -> Tool {
    Tool { name: name.into(), description: String::new(), mass_kg: 0.01, friction: 0.3, pieces, surfaces }
}

/// Tool 2 of the paper: an L of 40 x 40 mm, 12 mm thick, its concave outline cut into two convex pieces.
pub fn l_tool() -> Tool {
    let arm = polygon(&[[-3.4, -0.6], [0.6, -0.6], [0.6, 0.6], [-3.4, 0.6]]);
    let stem = polygon(&[[-0.6, -3.4], [0.6, -3.4], [0.6, 0.6], [-0.6, 0.6]]);
    let surfaces = vec![
        face("bottom", [-3.4, -0.6], [-1.9, -0.6]),
        face("tip", [-3.4, 0.5], [-3.4, -0.5]),
        face("top", [-1.4, 0.6], [-3.4, 0.6]),
    ];
    tool("L", vec![arm, stem], surfaces)
}

/// Tool 1 of the paper: a stick of 30 x 12 mm with a round head.
pub fn stick() -> Tool {
    let shaft = PlacedOutline {
        shape: Outline::Box { width_m: 0.012, height_m: 0.024 },
        position_m: [0.0, 0.012],
        angle_rad: 0.0,
    };
    let head = PlacedOutline { shape: Outline::Disc { radius_m: 0.006 }, position_m: [0.0, 0.024], angle_rad: 0.0 };
    let arc = SurfaceShape::Arc {
        center_m: [0.0, 0.024],
        radius_m: 0.006,
        direction_rad: std::f64::consts::FRAC_PI_2,
        half_angle_rad: 0.08,
    };
    let surfaces = vec![face("side", [-0.6, 2.4], [-0.6, 1.4]), ContactSurface::new("head", arc)];
    tool("stick", vec![shaft, head], surfaces)
}

/// The object of the paper's Table 1.
pub fn disc() -> Outline {
    Outline::Disc { radius_m: 0.012 }
}

pub fn square() -> Outline {
    Outline::Box { width_m: 0.016, height_m: 0.010 }
}

pub fn pentagon() -> Outline {
    Outline::Polygon {
        vertices_m: vec![[-0.008, -0.006], [0.007, -0.007], [0.011, 0.002], [0.002, 0.009], [-0.007, 0.006]],
    }
}

/// A flip between the middles of two surfaces, the tool's axes along the world's.
pub fn task<'a>(tool: &'a Tool, object: &'a Outline, from: usize, to: usize) -> FlipTask<'a> {
    FlipTask {
        tool,
        object,
        object_world: Isometry2::new(Vector2::new(0.06, 0.053), 0.0),
        contacts: [tool.surfaces[from].middle(), tool.surfaces[to].middle()],
        tool_angles_rad: [0.0, 0.0],
        duration_s: 2.0,
    }
}
