//! Ways of a tool round an object and past obstacles, its angle kept: shortest path over a ring of via-points.

use nalgebra::{Isometry2, Point2, Vector2};

use crate::outline::{PlacedOutline, separation_m};
use crate::tool::Tool;

/// What the tool must keep clear of.
#[derive(Clone, Debug)]
pub struct Surroundings<'a> {
    /// The tool.
    pub tool: &'a Tool,
    /// Angle of the tool, rad.
    pub angle_rad: f64,
    /// Center of the object, world frame.
    pub object_world: Point2<f64>,
    /// Radius of a disc about that center that holds the object, m.
    pub object_radius_m: f64,
    /// Obstacles, world frame.
    pub obstacles: &'a [PlacedOutline],
    /// Distance to keep from the object and from obstacles, m.
    pub margin_m: f64,
}

/// Via-points on each ring about the object.
const RING_POINTS: usize = 32;
/// Distance between two looks along a straight way, m.
const LOOK_M: f64 = 0.002;

impl Surroundings<'_> {
    /// Distance of the tool, with its origin at `at`, from the object and obstacles, m.
    #[must_use]
    pub fn clearance_m(&self, at: &Point2<f64>) -> f64 {
        let pose = Isometry2::new(at.coords, self.angle_rad);
        let object =
            self.tool.signed_distance_m(&pose.inverse_transform_point(&self.object_world)) - self.object_radius_m;
        let pieces =
            self.tool.pieces.iter().flat_map(|piece| self.obstacles.iter().map(move |obstacle| (piece, obstacle)));
        let distance = |(piece, obstacle): (&PlacedOutline, &PlacedOutline)| {
            separation_m(&piece.shape, &(pose * piece.pose()), &obstacle.shape, &obstacle.pose())
        };
        pieces.filter_map(distance).fold(object, f64::min)
    }

    /// Whether the margin is kept at a place and half a look around it: distances change no faster than the tool moves.
    fn is_free(&self, at: &Point2<f64>) -> bool {
        self.clearance_m(at) >= self.margin_m + LOOK_M / 2.0
    }

    fn is_straight_way_free(&self, from: &Point2<f64>, to: &Point2<f64>) -> bool {
        let looks = ((to - from).norm() / LOOK_M).ceil().max(1.0) as usize;
        // the ends are given: a hold may be nearer than the margin
        (1..looks).all(|look| {
            let at = from + (to - from) * (look as f64 / looks as f64);
            self.is_free(&at)
        })
    }

    /// Shortest way of the tool's origin from one place to another, both included; `None` if every way is barred.
    #[must_use]
    pub fn way(&self, from: Point2<f64>, to: Point2<f64>) -> Option<Vec<Point2<f64>>> {
        if self.is_straight_way_free(&from, &to) {
            return Some(vec![from, to]);
        }
        let mut places = vec![from, to];
        places.extend(self.via_points());
        let mut best = vec![f64::INFINITY; places.len()];
        let mut before = vec![0_usize; places.len()];
        let mut open: Vec<usize> = (0..places.len()).collect();
        if let Some(start) = best.first_mut() {
            *start = 0.0;
        }
        while let Some(position) = (0..open.len()).min_by(|a, b| best[open[*a]].total_cmp(&best[open[*b]])) {
            let node = open.swap_remove(position);
            if node == 1 || best[node].is_infinite() {
                break;
            }
            for &next in &open {
                let length = best[node] + (places[next] - places[node]).norm();
                if length < best[next] && self.is_straight_way_free(&places[node], &places[next]) {
                    best[next] = length;
                    before[next] = node;
                }
            }
        }
        if best.get(1).is_none_or(|length| length.is_infinite()) {
            return None;
        }
        let mut way = vec![to];
        let mut node = 1;
        while node != 0 {
            node = before[node];
            way.push(places[node]);
        }
        way.reverse();
        Some(way)
    }

    /// Places from which the tool clears the object: on each ray from it, as near as the margin allows and a bit farther.
    fn via_points(&self) -> Vec<Point2<f64>> {
        let reach =
            self.tool.pieces.iter().map(|piece| piece.pose().translation.vector.norm() + piece.shape.radius_m());
        let farthest = reach.fold(0.0, f64::max) + self.object_radius_m + 2.0 * self.margin_m;
        let mut places = Vec::new();
        for index in 0..RING_POINTS {
            let (sin, cos) = (std::f64::consts::TAU * index as f64 / RING_POINTS as f64).sin_cos();
            let ray = Vector2::new(cos, sin);
            let at = |distance: f64| self.object_world + ray * distance;
            let rings = (0..40).map(|k| farthest * (1.2 - f64::from(k) / 40.0));
            // from outside inwards, the last place that is still clear
            let nearest = rings.take_while(|distance| self.is_free(&at(*distance))).last();
            places.extend(nearest.map(at));
        }
        places
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::outline::Outline;
    use crate::tool::{ContactSurface, SurfaceShape};

    fn finger() -> Tool {
        let pieces =
            vec![PlacedOutline { shape: Outline::Disc { radius_m: 0.006 }, position_m: [0.0, 0.0], angle_rad: 0.0 }];
        let shape =
            SurfaceShape::Arc { center_m: [0.0, 0.0], radius_m: 0.006, direction_rad: 0.0, half_angle_rad: 0.1 };
        let surfaces = vec![ContactSurface::new("front", shape)];
        Tool { name: "finger".into(), description: String::new(), mass_kg: 0.01, friction: 0.3, pieces, surfaces }
    }

    #[test]
    fn the_way_round_a_disc_keeps_its_distance() {
        let tool = finger();
        let around = Surroundings {
            tool: &tool,
            angle_rad: 0.0,
            object_world: Point2::origin(),
            object_radius_m: 0.012,
            obstacles: &[],
            margin_m: 0.005,
        };
        let (from, to) = (Point2::new(0.03, 0.0), Point2::new(-0.03, 0.001));
        let way = around.way(from, to).unwrap();
        assert!(way.len() > 2 && way[0] == from && *way.last().unwrap() == to);
        for leg in way.windows(2) {
            for share in [0.1, 0.5, 0.9] {
                assert!(around.clearance_m(&(leg[0] + (leg[1] - leg[0]) * share)) >= 0.005 - 1e-12);
            }
        }
        let length: f64 = way.windows(2).map(|leg| (leg[1] - leg[0]).norm()).sum();
        // the taut string round a circle of 23 mm is 81 mm long
        assert!(length < 0.090, "{length}");
    }

    #[test]
    fn a_wall_all_round_bars_every_way() {
        let tool = finger();
        let wall = |x: f64, y: f64, width_m: f64, height_m: f64| PlacedOutline {
            shape: Outline::Box { width_m, height_m },
            position_m: [x, y],
            angle_rad: 0.0,
        };
        let walls = [
            wall(0.05, 0.0, 0.01, 0.12),
            wall(-0.05, 0.0, 0.01, 0.12),
            wall(0.0, 0.05, 0.12, 0.01),
            wall(0.0, -0.05, 0.12, 0.01),
        ];
        let around = Surroundings {
            tool: &tool,
            angle_rad: 0.0,
            object_world: Point2::origin(),
            object_radius_m: 0.012,
            obstacles: &walls,
            margin_m: 0.002,
        };
        assert!(around.way(Point2::new(0.03, 0.0), Point2::new(0.2, 0.0)).is_none());
    }
}
