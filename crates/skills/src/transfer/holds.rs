//! Holds: the places of a tool's surfaces at which it may push, and the direction of each push.

use std::f64::consts::TAU;

use nalgebra::{Isometry2, Point2, UnitComplex, Vector2};

use super::workplace::Workplace;

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

/// The holds of a workplace: `places` of them (at least 1) on each surface, evenly over its usable length; `cell_m` are
/// the sides of a cell.
///
/// A surface pushes along its normal. The tool is turned by less than a degree so that the normal leads from cell to
/// cell. A surface is left out where the object is no disc and has no side that lies flat against it, since a corner in
/// contact turns the object away.
#[must_use]
pub fn holds(workplace: &Workplace<'_>, places: usize, cell_m: &Vector2<f64>) -> Vec<Hold> {
    let mut all = Vec::new();
    for (surface, shape) in workplace.tool.surfaces.iter().enumerate() {
        let count = if places > 1 && shape.length_m() > 0.0 { places } else { 1 };
        for place in 0..count {
            let share = if count > 1 { place as f64 / (count - 1) as f64 - 0.5 } else { 0.0 };
            let place_m = share * shape.length_m();
            let contact = shape.contact_at(place_m);
            let wanted = UnitComplex::new(workplace.tool_angle_rad) * contact.normal.into_inner();
            let step = whole_direction(&wanted, cell_m);
            let direction = scaled(step, cell_m).normalize();
            if !workplace.lies_flat(&direction) {
                continue;
            }
            let turn = workplace.tool_angle_rad + signed_angle(&wanted, &direction);
            let stand_off = workplace.object_support_m(direction.y.atan2(direction.x) + TAU / 2.0);
            let center_from_tool = workplace.tool.pose_touching(&contact, &Point2::origin(), stand_off, 0.0, turn);
            all.push(Hold { surface, place_m, step, direction, center_from_tool });
        }
    }
    all
}

impl Workplace<'_> {
    /// Whether the object can be pushed in `direction` by something flat without being turned.
    fn lies_flat(&self, direction: &Vector2<f64>) -> bool {
        let inward = direction.y.atan2(direction.x) + TAU / 2.0 - self.object_angle_rad;
        self.object.has_side_towards(inward, FLAT_RAD)
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

/// A step in cells as a vector, m.
pub(super) fn scaled(step: [i32; 2], cell_m: &Vector2<f64>) -> Vector2<f64> {
    Vector2::new(f64::from(step[0]) * cell_m.x, f64::from(step[1]) * cell_m.y)
}

/// Angle from one vector to another, rad, in (−π, π].
fn signed_angle(from: &Vector2<f64>, to: &Vector2<f64>) -> f64 {
    from.perp(to).atan2(from.dot(to))
}

#[cfg(test)]
mod tests {
    use super::*;

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
}
