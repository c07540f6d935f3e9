//! Frames of sections: where a blade that enters a piece will cut it.

use nalgebra::{Isometry3, Matrix3, Point2, Point3, Rotation3, UnitQuaternion, Vector3};

use super::setup::CuttingBoard;
use crate::cutting::geometry::Section;
use crate::cutting::knife::Edge;
use crate::cutting::mechanics::Board;

/// The cutting direction is the board's as long as the knife's own is within 60° of it: cosine of that.
const STEEPEST: f64 = 0.5;
/// Points of the edge at which its depth in the food is looked at.
const LOOKS: usize = 64;

/// Frame in the blade's plane at the knife's heel, `world_from_section`: y down to the board, so that the depth of a rocking
/// edge is a function of the place along x.
pub(super) fn section_frame(world_from_knife: &Isometry3<f64>, board: &CuttingBoard) -> Isometry3<f64> {
    let normal = world_from_knife.rotation * Vector3::z();
    let ahead = world_from_knife.rotation * Vector3::y();
    let down = -board.up_in_world().into_inner();
    let in_plane = down - normal * normal.dot(&down);
    let cutting = if in_plane.dot(&ahead) > STEEPEST { in_plane.normalize() } else { ahead };
    let axes = Matrix3::from_columns(&[cutting.cross(&normal), cutting, normal]);
    let rotation = UnitQuaternion::from_rotation_matrix(&Rotation3::from_matrix_unchecked(axes));
    Isometry3::from_parts(world_from_knife.translation, rotation)
}

/// The board's upper side in a section's plane; none if it is not below the cut.
pub(super) fn board_line(world_from_section: &Isometry3<f64>, board: &CuttingBoard) -> Option<Board> {
    let up = world_from_section.rotation.inverse() * board.up_in_world().into_inner();
    let top = world_from_section.inverse_transform_point(&board.top_in_world());
    (up.y < -STEEPEST).then(|| Board { y_m: up.dot(&top.coords) / up.y, slope: -up.x / up.y })
}

/// An edge that is seen this deep at first did not come through the top: m, and as a share of the section's height. A knife that
/// comes down at 0.2 m/s is 0.2 mm deep in its first step of 1 ms.
const DEEPEST_ENTRY_M: f64 = 2e-3;
const DEEPEST_ENTRY_SHARE: f64 = 0.5;

/// Whether an edge that is seen in a section for the first time came through its top, and not through a side: a blade that a
/// sliver of a food falls against stands in all of its height at once.
pub(super) fn came_through_the_top(section: &Section, section_from_knife: &Isometry3<f64>, edge: &Edge) -> bool {
    let height_m = section.bounds().map_or(0.0, |(low, high)| high.y - low.y);
    let deepest_m = DEEPEST_ENTRY_M.min(DEEPEST_ENTRY_SHARE * height_m);
    entry_depth_m(section, section_from_knife, edge) <= deepest_m
}

/// How deep an edge stands in the food below the upper side of the section, m; negative above it.
fn entry_depth_m(section: &Section, section_from_knife: &Isometry3<f64>, edge: &Edge) -> f64 {
    let points = edge
        .points
        .windows(2)
        .flat_map(|pair| (0..=LOOKS).map(move |look| pair[0] + (pair[1] - pair[0]) * (look as f64 / LOOKS as f64)));
    let depth = |point: Point2<f64>| {
        let at = section_from_knife * Point3::new(point.x, point.y, 0.0);
        let tops = section.polygons.iter().filter_map(|outline| top_at(outline, at.x));
        at.y - tops.fold(f64::INFINITY, f64::min)
    };
    points.map(depth).fold(f64::NEG_INFINITY, f64::max)
}

/// Smallest y of a convex outline at `x`.
fn top_at(outline: &[Point2<f64>], x: f64) -> Option<f64> {
    let next = outline.iter().cycle().skip(1);
    let crossing = |(from, to): (&Point2<f64>, &Point2<f64>)| {
        let share = (x - from.x) / (to.x - from.x);
        (0.0..=1.0).contains(&share).then(|| from.y + share * (to.y - from.y))
    };
    outline.iter().zip(next).filter_map(crossing).reduce(f64::min)
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    fn board() -> CuttingBoard {
        let world_from_board = Isometry3::translation(0.0, 0.0, 0.1);
        CuttingBoard { world_from_board, half_extents_m: [0.2, 0.2, 0.01], friction: 0.4 }
    }

    /// Edge along the world's x, cutting down, 50 mm above the board, rocked by `rock` and leaning by `lean`.
    fn knife(rock: f64, lean: f64) -> Isometry3<f64> {
        let down = UnitQuaternion::from_axis_angle(&Vector3::x_axis(), -std::f64::consts::FRAC_PI_2);
        Isometry3::from_parts(nalgebra::Translation3::new(0.0, 0.0, 0.15), down)
            * UnitQuaternion::from_axis_angle(&Vector3::z_axis(), rock)
            * UnitQuaternion::from_axis_angle(&Vector3::x_axis(), lean)
    }

    #[test]
    fn a_rocked_knife_cuts_straight_down_to_a_level_board() {
        let frame = section_frame(&knife(0.3, 0.0), &board());
        assert_relative_eq!(frame.rotation * Vector3::y(), -Vector3::z(), epsilon = 1e-12);
        assert_relative_eq!(frame.rotation * Vector3::z(), Vector3::y(), epsilon = 1e-12);
        let line = board_line(&frame, &board()).unwrap();
        assert_relative_eq!(line.y_m, 0.05, epsilon = 1e-12);
        assert_relative_eq!(line.slope, 0.0, epsilon = 1e-12);
    }

    #[test]
    fn below_a_leaning_blade_the_board_is_farther() {
        let frame = section_frame(&knife(0.0, 0.3), &board());
        let line = board_line(&frame, &board()).unwrap();
        assert_relative_eq!(line.y_m, 0.05 / 0.3_f64.cos(), epsilon = 1e-12);
        assert_eq!(board_line(&section_frame(&knife(0.0, 1.5), &board()), &board()), None);
    }

    #[test]
    fn a_sliver_that_falls_against_the_edge_is_not_squeezed_by_it() {
        let of_height = |height: f64| {
            let outline = [[0.0, 0.01], [0.04, 0.01], [0.04, 0.01 + height], [0.0, 0.01 + height]];
            let polygons = vec![outline.map(Point2::from).to_vec()];
            Section { food_from_section: Isometry3::identity(), polygons }
        };
        let edge = Edge::ideal(0.2, 0.03);
        let entered = |height, depth| {
            came_through_the_top(&of_height(height), &Isometry3::translation(-0.1, 0.01 + depth, 0.0), &edge)
        };
        assert!(!entered(0.00045, 0.00044), "all of the sliver at once");
        assert!(entered(0.00045, 0.0002) && entered(0.03, 0.0019));
        assert!(!entered(0.03, 0.0021));
    }

    #[test]
    fn the_depth_of_an_edge_is_measured_from_the_top_of_the_section() {
        let outline = [[0.0, 0.01], [0.04, 0.01], [0.04, 0.05], [0.0, 0.05]].map(Point2::from).to_vec();
        let section = Section { food_from_section: Isometry3::identity(), polygons: vec![outline] };
        let edge = Edge::ideal(0.2, 0.03);
        let depth = |y: f64, x: f64| entry_depth_m(&section, &Isometry3::translation(x, y, 0.0), &edge);
        assert_relative_eq!(depth(0.012, -0.1), 0.002, epsilon = 1e-12);
        assert_relative_eq!(depth(0.0, -0.1), -0.01, epsilon = 1e-12);
        assert_eq!(depth(0.02, 0.1), f64::NEG_INFINITY);
    }
}
