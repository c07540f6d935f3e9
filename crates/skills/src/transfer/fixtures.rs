//! Tools, outlines and workplaces that the tests of a transfer share.

use nalgebra::Point2;

use super::{RectangularReach, Workplace};
use crate::outline::{Outline, PlacedOutline};
use crate::tool::family::ToolShape;
use crate::tool::{ContactSurface, SurfaceShape, Tool};

pub(super) const DISC: Outline = Outline::Disc { radius_m: 0.012 };

pub(super) fn block(width_m: f64, height_m: f64, position_m: [f64; 2]) -> PlacedOutline {
    PlacedOutline { shape: Outline::Box { width_m, height_m }, position_m, angle_rad: 0.0 }
}

pub(super) fn face(name: &str, start_m: [f64; 2], end_m: [f64; 2]) -> ContactSurface {
    ContactSurface::new(name, SurfaceShape::Face { start_m, end_m })
}

pub(super) fn tool(name: &str, pieces: Vec<PlacedOutline>, surfaces: Vec<ContactSurface>) -> Tool {
    let tool = Tool { name: name.into(), description: String::new(), mass_kg: 0.01, friction: 0.3, pieces, surfaces };
    tool.validate().unwrap();
    tool
}

/// A tool of a family, held at the origin of the family's frame.
pub(super) fn of_family(name: &str, shape: &dyn ToolShape) -> Tool {
    tool(name, shape.pieces(), shape.surfaces())
}

/// Tool 2 of the paper: 40 x 40 mm, 12 mm thick, held at its corner.
pub(super) fn ell() -> Tool {
    let pieces = vec![block(0.040, 0.012, [-0.014, 0.0]), block(0.012, 0.028, [0.0, -0.020])];
    let surfaces = vec![
        face("bottom", [-0.034, -0.006], [-0.019, -0.006]),
        face("tip", [-0.034, 0.005], [-0.034, -0.005]),
        face("top", [-0.014, 0.006], [-0.034, 0.006]),
    ];
    tool("ell", pieces, surfaces)
}

/// The paper's map of 180 x 180 mm with its margin of 15 mm.
pub(super) fn workplace<'a>(tool: &'a Tool, object: &'a Outline, obstacles: &'a [PlacedOutline]) -> Workplace<'a> {
    Workplace {
        map_min: Point2::new(-0.09, 0.0),
        map_max: Point2::new(0.09, 0.18),
        obstacles,
        object_margin_m: 0.015,
        tool_margin_m: 0.003,
        object,
        object_angle_rad: 0.0,
        tool,
        tool_angle_rad: 0.0,
        tool_passes: false,
        reach: &RectangularReach { min_m: [-0.12, 0.0], max_m: [0.12, 0.16] },
    }
}
