//! Distances of object and tool from obstacles and from each other, prepared once: they are asked for many thousand times.

use nalgebra::{Isometry2, Point2};

use super::workplace::Workplace;
use crate::outline::{Convex, PlacedOutline, gap};

/// A convex outline with a circle round it, by which most distances need not be computed.
#[derive(Debug, Clone)]
struct Piece {
    outline: Convex,
    center: Point2<f64>,
    radius_m: f64,
}

impl Piece {
    fn new(placed: &PlacedOutline) -> Self {
        let pose = placed.pose();
        let outline = Convex::new(&placed.shape).moved(|corner| pose * corner);
        let center = pose * placed.shape.centroid();
        let farthest = outline.corners.iter().map(|corner| (corner - center).norm()).fold(0.0, f64::max);
        Self { radius_m: farthest + outline.radius_m, outline, center }
    }

    /// Distance of this piece, moved by `pose`, from one that stands still, m, if that is less than `nearest_m`.
    fn nearer_m(&self, pose: &Isometry2<f64>, still: &Self, nearest_m: f64) -> f64 {
        if (pose * self.center - still.center).norm() - self.radius_m - still.radius_m >= nearest_m {
            return nearest_m;
        }
        gap(&still.outline, &self.outline, |corner| pose * corner).distance_m.min(nearest_m)
    }
}

/// Shapes of a workplace.
#[derive(Debug, Clone)]
pub(super) struct Shapes {
    /// The object about its center, turned as it stands.
    object: Piece,
    /// Pieces of the tool in its frame.
    tool: Vec<Piece>,
    obstacles: Vec<Piece>,
}

impl Shapes {
    /// Prepares the shapes of a valid workplace.
    pub(super) fn new(workplace: &Workplace<'_>) -> Self {
        let object = PlacedOutline {
            shape: workplace.object.clone(),
            position_m: [0.0; 2],
            angle_rad: workplace.object_angle_rad,
        };
        Self {
            object: Piece::new(&object),
            tool: workplace.tool.pieces.iter().map(Piece::new).collect(),
            obstacles: workplace.obstacles.iter().map(Piece::new).collect(),
        }
    }

    /// Distance of the object, its center at `center`, from the nearest obstacle, m; negative where they overlap.
    pub(super) fn object_clearance_m(&self, center: &Point2<f64>) -> f64 {
        self.object_clearance_up_to_m(center, f64::INFINITY)
    }

    /// The same, or `most_m` if it is more: what is far away is told at once.
    pub(super) fn object_clearance_up_to_m(&self, center: &Point2<f64>, most_m: f64) -> f64 {
        let pose = Isometry2::from(*center);
        self.obstacles.iter().fold(most_m, |nearest, obstacle| self.object.nearer_m(&pose, obstacle, nearest))
    }

    /// Distance of the tool from the nearest obstacle, m, or `most_m` if it is more; negative where they overlap.
    pub(super) fn tool_clearance_up_to_m(&self, world_from_tool: &Isometry2<f64>, most_m: f64) -> f64 {
        let pairs = self.tool.iter().flat_map(|piece| self.obstacles.iter().map(move |obstacle| (piece, obstacle)));
        pairs.fold(most_m, |nearest, (piece, obstacle)| piece.nearer_m(world_from_tool, obstacle, nearest))
    }

    /// Distance of the tool from the object, m; negative where they overlap.
    pub(super) fn gap_m(&self, world_from_tool: &Isometry2<f64>, center: &Point2<f64>) -> f64 {
        let from_object = Isometry2::from(*center).inverse() * world_from_tool;
        self.tool.iter().fold(f64::INFINITY, |nearest, piece| piece.nearer_m(&from_object, &self.object, nearest))
    }

    /// Greatest distance of a point of the tool from its origin, m: how far it goes per radian.
    pub(super) fn tool_lever_m(&self) -> f64 {
        self.tool.iter().map(|piece| piece.center.coords.norm() + piece.radius_m).fold(0.0, f64::max)
    }
}

#[cfg(test)]
mod tests {
    use approx::assert_relative_eq;
    use nalgebra::Vector2;

    use super::super::fixtures::{DISC, block, ell, workplace};
    use super::*;
    use crate::outline::separation_m;

    /// A few roundings of lengths of some decimeters.
    const ROUNDING_M: f64 = 1e-15;

    #[test]
    fn the_nearest_of_several_pieces_and_obstacles_counts() {
        let tool = ell();
        let obstacles = [block(0.03, 0.04, [0.0, 0.10]), block(0.01, 0.01, [0.05, 0.02])];
        let shapes = Shapes::new(&workplace(&tool, &DISC, &obstacles));
        for (x, y, angle_rad) in [(0.06, 0.06, 0.3), (0.0, 0.05, -2.0), (0.03, 0.1, 0.0)] {
            let pose = Isometry2::new(Vector2::new(x, y), angle_rad);
            let pairs = tool.pieces.iter().flat_map(|piece| obstacles.iter().map(move |obstacle| (piece, obstacle)));
            let apart = pairs.map(|(piece, obstacle)| {
                separation_m(&piece.shape, &(pose * piece.pose()), &obstacle.shape, &obstacle.pose()).unwrap()
            });
            let nearest = apart.fold(f64::INFINITY, f64::min);
            assert_relative_eq!(shapes.tool_clearance_up_to_m(&pose, 1.0), nearest, epsilon = ROUNDING_M);
            assert_relative_eq!(shapes.tool_clearance_up_to_m(&pose, -1.0), -1.0);
        }
        assert_relative_eq!(shapes.object_clearance_m(&Point2::new(0.047, 0.1)), 0.02, epsilon = ROUNDING_M);
        // the tip touches the disc 34 + 12 mm from the corner at which the tool is held
        let held = Isometry2::translation(0.106, 0.08);
        assert_relative_eq!(shapes.gap_m(&held, &Point2::new(0.06, 0.08)), 0.0, epsilon = ROUNDING_M);
    }
}
