//! Where a food is to be cut: the sections of its solid at the wanted places, as a planner sees them.

use nalgebra::{Isometry3, Point3, Rotation3, Translation3, UnitQuaternion, Vector3};
use sim::cutting::food::Food;
use sim::cutting::geometry::Section as CutSection;
use skills::cutting::Section;

/// A section that is to be cut: as the planner sees it, and its outline in the same frame.
#[derive(Clone, Debug)]
pub(super) struct Place {
    /// Frame, width and height.
    pub section: Section,
    /// What the knife has to pass, in the section's frame.
    pub outline: CutSection,
}

/// Pose of a food's frame that lies on a board whose upper side is at `board_top_m`, turned about the vertical.
pub(super) fn lying(food: &Food, at_m: [f64; 2], angle_rad: f64, board_top_m: f64) -> Isometry3<f64> {
    let lowest_m = food.solid.bounds().0.z;
    let turn = UnitQuaternion::from_axis_angle(&Vector3::z_axis(), angle_rad);
    Isometry3::from_parts(Translation3::new(at_m[0], at_m[1], board_top_m - lowest_m), turn)
}

/// Horizontal direction of a food's x axis, its long one, in the world; along the world's x axis if that stands upright.
fn along(world_from_food: &Isometry3<f64>) -> Vector3<f64> {
    let axis = world_from_food.rotation * Vector3::x();
    Vector3::new(axis.x, axis.y, 0.0).try_normalize(1e-6).unwrap_or_else(Vector3::x)
}

/// Length of a lying food along its x axis, and where it begins on the line through its origin, m.
pub(super) fn extent_m(food: &Food, world_from_food: &Isometry3<f64>) -> (f64, f64) {
    let axis_in_food = world_from_food.rotation.inverse() * along(world_from_food);
    let corners = food.solid.cells().iter().flat_map(|cell| cell.vertices());
    let (low, high) = corners
        .map(|corner| corner.coords.dot(&axis_in_food))
        .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), at| (low.min(at), high.max(at)));
    (high - low, low)
}

/// The section of a lying food at the distance `along_m` from its end, leaning by `tilt_rad` about the edge.
///
/// The cut's frame is that of [`Section`]: in the middle of the chord on top of the food, the edge across the food's long
/// axis, the normal along it. The words of the error say what is wrong with the place.
pub(super) fn place(
    food: &Food,
    world_from_food: &Isometry3<f64>,
    board_top_m: f64,
    along_m: f64,
    tilt_rad: f64,
) -> Result<Place, String> {
    let (length_m, begin_m) = extent_m(food, world_from_food);
    let axis = along(world_from_food);
    // y of the section is down, z is along the food
    let axes = nalgebra::Matrix3::from_columns(&[Vector3::new(axis.y, -axis.x, 0.0), -Vector3::z(), axis]);
    let upright = UnitQuaternion::from_rotation_matrix(&Rotation3::from_matrix_unchecked(axes));
    let turn = upright * UnitQuaternion::from_axis_angle(&Vector3::x_axis(), tilt_rad);
    let on_axis = world_from_food.translation.vector + axis * (begin_m + along_m);
    let world_from_axis = Isometry3::from_parts(Translation3::from(on_axis), turn);
    let Some((low, high)) = food.solid.section(&(world_from_food.inverse() * world_from_axis)).bounds() else {
        return Err(format!(
            "a cut at {along_m:.4} m from the end misses the food `{}` of {length_m:.4} m length; expected a place on it",
            food.name
        ));
    };
    let world_from_section = world_from_axis * Translation3::new(0.5 * (low.x + high.x), low.y, 0.0);
    let down = -(world_from_section.rotation * Vector3::y()).z;
    let height_m = (world_from_section.translation.z - board_top_m) / down;
    Ok(Place {
        section: Section { world_from_section, width_m: high.x - low.x, height_m },
        outline: food.solid.section(&(world_from_food.inverse() * world_from_section)),
    })
}

/// Lowest point of a polyline of the tool's frame on the way of a tool, world frame, m.
pub(super) fn lowest_m(world_from_tool: &Isometry3<f64>, edge_in_tool: &[Point3<f64>]) -> f64 {
    edge_in_tool.iter().map(|point| (world_from_tool * point).z).fold(f64::INFINITY, f64::min)
}

#[cfg(test)]
mod tests {
    use approx::assert_relative_eq;
    use sim::cutting::food::FoodFile;

    use super::*;

    fn food(text: &str) -> Food {
        toml::from_str::<FoodFile>(text).unwrap().food().unwrap()
    }

    fn cylinder() -> Food {
        food(include_str!("../../../../../assets/foods/cylinder.toml"))
    }

    #[test]
    fn a_cylinders_section_is_its_disc_on_the_board() {
        let food = cylinder();
        let (low, high) = food.solid.bounds();
        let world_from_food = lying(&food, [0.5, 0.1], 0.3, 0.02);
        assert_relative_eq!(world_from_food.translation.z + low.z, 0.02, epsilon = 1e-12);
        let (length_m, _) = extent_m(&food, &world_from_food);
        let place = place(&food, &world_from_food, 0.02, length_m / 3.0, 0.0).unwrap();
        assert_relative_eq!(place.section.height_m, high.z - low.z, epsilon = 1e-9);
        assert_relative_eq!(place.section.width_m, high.y - low.y, epsilon = 1e-9);
        place.section.validate().unwrap();
        // the middle of its top, a third along the axis
        let top = world_from_food * Point3::new(low.x + length_m / 3.0, 0.0, high.z);
        let origin = place.section.world_from_section.translation.vector;
        assert_relative_eq!(origin, top.coords, epsilon = 1e-9);
        let normal = place.section.world_from_section.rotation * Vector3::z();
        assert_relative_eq!(normal, world_from_food.rotation * Vector3::x(), epsilon = 1e-12);
    }

    #[test]
    fn a_leaning_section_is_longer_down_to_the_board() {
        let food = cylinder();
        let world_from_food = lying(&food, [0.5, 0.0], 0.0, 0.0);
        let (length_m, _) = extent_m(&food, &world_from_food);
        let upright = place(&food, &world_from_food, 0.0, 0.5 * length_m, 0.0).unwrap().section;
        let leaning = place(&food, &world_from_food, 0.0, 0.5 * length_m, 0.4).unwrap().section;
        assert_relative_eq!(leaning.height_m, upright.height_m / 0.4_f64.cos(), epsilon = 1e-6);
        assert_relative_eq!(leaning.width_m, upright.width_m, epsilon = 1e-9);
    }

    #[test]
    fn a_place_beside_the_food_is_refused_in_words() {
        let food = cylinder();
        let world_from_food = lying(&food, [0.5, 0.0], 0.0, 0.0);
        let refused = place(&food, &world_from_food, 0.0, 1.0, 0.0).unwrap_err();
        assert!(refused.contains("misses the food"), "{refused}");
    }
}
