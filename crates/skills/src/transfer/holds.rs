//! Holds: the places of a tool's surfaces at which it may push, and the direction of each push.

use std::f64::consts::TAU;

use nalgebra::{Isometry2, Point2, UnitComplex, Vector2};

use super::grid::Grid;
use super::workplace::Workplace;
use crate::outline::Outline;
use crate::tool::{ContactSurface, SurfaceShape};

/// Largest whole-number direction that a push is put on, in cells.
const LARGEST_STEP: i32 = 12;
/// A push may lie off its surface's normal by this before a longer step is sought, rad; the tool is turned by it.
const NEAR_ENOUGH_RAD: f64 = 0.005;
/// A face of the object counts as flat against the tool's within this, rad.
const FLAT_RAD: f64 = 0.01;

/// A place on a surface at which the tool may push, with all that follows from it.
#[derive(Debug, Clone, PartialEq)]
pub struct Hold {
    /// Index of the contact surface in the tool's list.
    pub surface: usize,
    /// Arc length from the middle of the surface, m, positive to the left of its normal.
    pub place_m: f64,
    /// Step of a push, in cells: the direction of the push as whole numbers.
    pub step: [i32; 2],
    /// Unit direction of a push, world frame.
    pub direction: Vector2<f64>,
    /// Angle of the tool in the world, rad: that of the workplace, but for a turn onto a direction of the grid.
    pub tool_angle_rad: f64,
    /// Pose of the tool relative to the object's center while it pushes, world axes.
    pub center_from_tool: Isometry2<f64>,
}

impl Hold {
    /// Pose of the tool that pushes the object at `center`.
    #[must_use]
    pub fn world_from_tool(&self, center: &Point2<f64>) -> Isometry2<f64> {
        Isometry2::from(*center) * self.center_from_tool
    }
}

/// The holds of a workplace: `places` of them (at least 1) on each face, evenly over its usable length, and the middle of
/// each arc.
///
/// A push goes straight along the normal of its place, so that friction is not asked for and the object neither turns nor
/// rolls along the surface: the paper's rule, and the reason why neither friction nor the allowed angle of a surface matters
/// here. Off its middle an arc would push in another direction, between the cells. Its middle is a stable place in a
/// hollow wider than the disc and an unstable one on a bulge, from which a disc departs with exp(s/(R + r)) of the way s.
///
/// Left out is what would turn the object: a round surface on an object that is no disc, a face on an object without a
/// side flat against it, and a place at which side and face do not both reach beyond the line through the object's center.
/// A normal between the directions of the grid turns the tool onto the nearest, by up to 2.4°.
pub(super) fn holds(workplace: &Workplace<'_>, places: usize, grid: &Grid) -> Vec<Hold> {
    let mut all = Vec::new();
    for (surface, shape) in workplace.tool.surfaces.iter().enumerate() {
        let is_face = matches!(shape.shape, SurfaceShape::Face { .. });
        let count = if places > 1 && is_face { places } else { 1 };
        for place in 0..count {
            let share = if count > 1 { place as f64 / (count - 1) as f64 - 0.5 } else { 0.0 };
            let place_m = share * shape.length_m();
            let contact = shape.contact_at(place_m);
            // the grid is turned as the tool is
            let wanted = grid.turn * contact.normal.into_inner();
            let step = whole_direction(&contact.normal, &grid.cell_m);
            let direction = grid.way(step).normalize();
            if !workplace.is_stable(shape, place_m, &direction) {
                continue;
            }
            let tool_angle_rad = workplace.tool_angle_rad + signed_angle(&wanted, &direction);
            let stand_off = workplace.object_support_m(direction.y.atan2(direction.x) + TAU / 2.0);
            let center_from_tool =
                workplace.tool.pose_touching(&contact, &Point2::origin(), stand_off, 0.0, tool_angle_rad);
            all.push(Hold { surface, place_m, step, direction, tool_angle_rad, center_from_tool });
        }
    }
    all
}

/// Length by which side and face reach beyond the line through the object's center, m: what a hold may be off by.
const LEAST_SEAT_M: f64 = 0.001;

impl Workplace<'_> {
    /// Whether the object can be pushed in `direction` at a place of a surface without being turned.
    fn is_stable(&self, surface: &ContactSurface, place_m: f64, direction: &Vector2<f64>) -> bool {
        if matches!(self.object, Outline::Disc { .. }) {
            return true;
        }
        if matches!(surface.shape, SurfaceShape::Arc { .. }) {
            return false;
        }
        let turn = UnitComplex::new(self.object_angle_rad);
        let half_m = surface.length_m() / 2.0;
        // to the left of the normal, as places are counted
        let left = Vector2::new(-direction.y, direction.x);
        self.object.side_towards(&(turn.inverse() * -direction), FLAT_RAD).is_some_and(|ends| {
            let [a, b] = ends.map(|end| (turn * end.coords).dot(&left));
            a.min(b).max(-half_m - place_m) <= -LEAST_SEAT_M && a.max(b).min(half_m - place_m) >= LEAST_SEAT_M
        })
    }
}

/// The shortest vector of whole numbers within [`NEAR_ENOUGH_RAD`] of a direction, or the nearest of those allowed.
fn whole_direction(direction: &Vector2<f64>, cell_m: &Vector2<f64>) -> [i32; 2] {
    let mut best = ([1, 0], f64::INFINITY);
    for size in 1..=LARGEST_STEP {
        for other in -size..=size {
            for step in [[size, other], [-size, other], [other, size], [other, -size]] {
                let off = signed_angle(direction, &scaled(step, cell_m)).abs();
                if off < best.1 - 1e-12 {
                    best = (step, off);
                }
            }
        }
        if best.1 <= NEAR_ENOUGH_RAD {
            break;
        }
    }
    best.0
}

/// A step in cells as a vector along the grid's axes, m.
fn scaled(step: [i32; 2], cell_m: &Vector2<f64>) -> Vector2<f64> {
    Vector2::new(f64::from(step[0]) * cell_m.x, f64::from(step[1]) * cell_m.y)
}

/// Angle from one vector to another, rad, in (−π, π].
fn signed_angle(from: &Vector2<f64>, to: &Vector2<f64>) -> f64 {
    from.perp(to).atan2(from.dot(to))
}

#[cfg(test)]
mod tests {
    use super::super::fixtures::{DISC, ell, of_family, workplace};
    use super::*;
    use crate::tool::family::Stick;

    fn step(x: f64, y: f64) -> [i32; 2] {
        whole_direction(&Vector2::new(x, y).normalize(), &Vector2::repeat(0.001))
    }

    #[test]
    fn axes_are_steps_of_one_cell_and_other_directions_the_shortest_that_is_near() {
        assert_eq!(step(1.0, 0.0), [1, 0]);
        assert_eq!(step(0.0, -1.0), [0, -1]);
        assert_eq!(step(1.0, 1.0), [1, 1]);
        let wanted = Vector2::new(30f64.to_radians().cos(), -0.5);
        let oblique = step(wanted.x, wanted.y);
        let off_rad = signed_angle(&wanted, &scaled(oblique, &Vector2::repeat(1.0))).abs();
        assert!(off_rad <= NEAR_ENOUGH_RAD && oblique[0] <= LARGEST_STEP, "{oblique:?} is off by {off_rad} rad");
    }

    #[test]
    fn a_direction_is_told_in_cells_that_are_no_squares() {
        assert_eq!(whole_direction(&Vector2::new(2.0, 1.0).normalize(), &Vector2::new(0.002, 0.001)), [1, 1]);
    }

    #[test]
    fn no_direction_is_farther_from_the_grid_than_is_told() {
        let farthest = (0..3600).map(|index| {
            let (sin, cos) = (f64::from(index) * TAU / 3600.0).sin_cos();
            let wanted = Vector2::new(cos, sin);
            signed_angle(&wanted, &scaled(whole_direction(&wanted, &Vector2::repeat(1.0)), &Vector2::repeat(1.0))).abs()
        });
        // half of the gap beside an axis, 1/12 rad wide
        assert!(farthest.fold(0.0, f64::max) < 2.4_f64.to_radians());
    }

    fn surfaces_and_places(workplace: &Workplace<'_>) -> Vec<(usize, f64)> {
        let grid = Grid::new(workplace, 0.001, Point2::new(0.0, 0.05), Point2::new(0.03, 0.08)).unwrap();
        let found = holds(workplace, 5, &grid);
        found.iter().map(|hold| (hold.surface, (hold.place_m * 1e4).round() / 1e4)).collect()
    }

    #[test]
    fn a_disc_is_held_at_all_places_of_faces_and_at_the_middle_of_arcs() {
        let bar = ell();
        assert_eq!(surfaces_and_places(&workplace(&bar, &DISC, &[])).len(), 15);
        let round = of_family("stick", &Stick::default());
        let held = surfaces_and_places(&workplace(&round, &DISC, &[]));
        for (index, surface) in round.surfaces.iter().enumerate() {
            let count = if matches!(surface.shape, SurfaceShape::Arc { .. }) { 1 } else { 5 };
            assert_eq!(held.iter().filter(|(surface, _)| *surface == index).count(), count, "{}", surface.name);
        }
    }

    #[test]
    fn a_box_is_held_where_side_and_face_reach_beyond_its_center() {
        let (bar, square) = (ell(), Outline::Box { width_m: 0.024, height_m: 0.024 });
        let held = surfaces_and_places(&workplace(&bar, &square, &[]));
        // not at the ends of the faces, where half of the side hangs over
        assert_eq!(held.iter().filter(|(surface, _)| *surface == 0).count(), 3);
        assert!(held.iter().all(|(surface, place_m)| place_m.abs() < bar.surfaces[*surface].length_m() / 2.0));
        let turned = Workplace { object_angle_rad: 0.4, ..workplace(&bar, &square, &[]) };
        assert!(surfaces_and_places(&turned).is_empty());
        let with_tool = Workplace { tool_angle_rad: 0.4, ..turned };
        assert_eq!(surfaces_and_places(&with_tool), held);
        let round = of_family("stick", &Stick::default());
        let arcs = surfaces_and_places(&workplace(&round, &square, &[]));
        assert!(arcs.iter().all(|(surface, _)| matches!(round.surfaces[*surface].shape, SurfaceShape::Face { .. })));
    }

    #[test]
    fn a_side_that_does_not_lie_below_the_center_is_no_seat() {
        let bar = ell();
        // a sliver that leans over its lower side: its centroid lies beside that side
        let leaning = Outline::Polygon { vertices_m: vec![[-0.025, -0.01], [-0.015, -0.01], [0.04, 0.02]] };
        let held = surfaces_and_places(&workplace(&bar, &leaning, &[]));
        assert!(held.iter().all(|(surface, _)| bar.surfaces[*surface].name != "top"), "{held:?}");
        let upright = Outline::Polygon { vertices_m: vec![[-0.015, -0.01], [0.015, -0.01], [0.0, 0.02]] };
        let held = surfaces_and_places(&workplace(&bar, &upright, &[]));
        assert!(held.iter().any(|(surface, _)| bar.surfaces[*surface].name == "top"), "{held:?}");
    }
}
