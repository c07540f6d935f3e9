//! How pieces and board look.

use nalgebra::Isometry3;

use crate::cutting::food::FoodLook;
use crate::cutting::geometry::{Solid, Surface};
use crate::spatial::{Drawing, DrawnShape, Rgba, Series, TriangleMesh};

use super::setup::CuttingBoard;

const BOARD: Rgba = [0.72, 0.56, 0.38, 1.0];

/// The board, placed in the world.
pub(super) fn board(board: &CuttingBoard) -> Drawing {
    let [x, y, z] = board.half_extents_m;
    let size_m = nalgebra::Vector3::new(2.0 * x, 2.0 * y, 2.0 * z);
    Drawing { shape: DrawnShape::Box { size_m }, body_from_shape: board.world_from_middle(), color: BOARD }
}

/// Number of shades in which pieces are drawn: with three, no piece needs that of a neighbor.
pub(super) const SHADES: usize = 3;
/// Share of the skin's color that is left in the second shade, and of the way to white in the third.
const DARKER: f64 = 0.72;
const LIGHTER: f64 = 0.45;

/// The skin's color in a shade: pieces lie beside each other as they were cut, only their shade tells them apart.
fn shaded(skin_rgb: [f64; 3], shade: usize) -> [f64; 3] {
    skin_rgb.map(|value| match shade % SHADES {
        0 => value,
        1 => DARKER * value,
        _ => value + LIGHTER * (1.0 - value),
    })
}

/// Shades of the `count` parts of a piece, in their order: the first keeps `own`, none is that of the part before it, and the
/// last not that of the piece `after` them.
pub(super) fn shades(own: usize, after: Option<usize>, count: usize) -> Vec<usize> {
    let mut shades = vec![own % SHADES];
    while shades.len() < count {
        let before = shades.last().copied().unwrap_or_default();
        let last = shades.len() + 1 == count;
        let free = (1..SHADES).map(|step| (before + step) % SHADES);
        shades.push(free.clone().find(|shade| !last || Some(*shade) != after).unwrap_or(before));
    }
    shades.truncate(count);
    shades
}

/// A piece in the food's frame: skin in its shade, and cut faces in the color of the flesh.
pub(super) fn piece(solid: &Solid, look: &FoodLook, shade: usize) -> Drawing {
    let mesh = solid.mesh();
    let skin_rgb = shaded(look.skin_rgb, shade);
    let color = |surface: &Surface| match surface {
        Surface::Skin => rgba(skin_rgb),
        Surface::Cut => rgba(look.flesh_rgb),
    };
    // corners of skin and of cut faces are different corners: each has one color
    let mut numbers = [vec![None; mesh.vertices.len()], vec![None; mesh.vertices.len()]];
    let mut drawn = TriangleMesh::default();
    for (corners, surface) in mesh.triangles.iter().zip(&mesh.surfaces) {
        let numbers = &mut numbers[usize::from(*surface == Surface::Cut)];
        drawn.triangles.push(corners.map(|corner| {
            *numbers[corner as usize].get_or_insert_with(|| {
                drawn.vertices.push(mesh.vertices[corner as usize]);
                drawn.colors.push(color(surface));
                (drawn.vertices.len() - 1) as u32
            })
        }));
    }
    Drawing { shape: DrawnShape::Mesh(drawn), body_from_shape: Isometry3::identity(), color: rgba(skin_rgb) }
}

fn rgba([r, g, b]: [f64; 3]) -> Rgba {
    [r as f32, g as f32, b as f32, 1.0]
}

/// Color of where a cut is wanted, and opacity of the plane within its outline.
const WANTED: Rgba = [0.10, 0.38, 0.85, 1.0];
const PANE: f32 = 0.22;
/// How far the outline of a wanted cut stands out from the food, and how thick it is, m.
const AROUND_M: f64 = 0.008;
const LINE_M: f64 = 0.0007;
const PANE_M: f64 = 0.0001;

/// A wanted cut as a pane in an outline about the section of the food, placed in the world; nothing if it misses the food.
pub(super) fn wanted(solid: &Solid, world_from_food: &Isometry3<f64>, world_from_cut: &Isometry3<f64>) -> Vec<Drawing> {
    let Some((low, high)) = solid.section(&world_from_food.inv_mul(world_from_cut)).bounds() else { return Vec::new() };
    let (middle, half) = (nalgebra::center(&low, &high), 0.5 * (high - low).add_scalar(2.0 * AROUND_M));
    let bar = |x: f64, y: f64, size_m: [f64; 3], color: Rgba| Drawing {
        shape: DrawnShape::Box { size_m: size_m.into() },
        body_from_shape: world_from_cut * Isometry3::translation(middle.x + x, middle.y + y, 0.0),
        color,
    };
    let [width, height] = [2.0 * half.x, 2.0 * half.y];
    let [r, g, b, _] = WANTED;
    vec![
        bar(0.0, 0.0, [width, height, PANE_M], [r, g, b, PANE]),
        bar(0.0, -half.y, [width, LINE_M, LINE_M], WANTED),
        bar(0.0, half.y, [width, LINE_M, LINE_M], WANTED),
        bar(-half.x, 0.0, [LINE_M, height, LINE_M], WANTED),
        bar(half.x, 0.0, [LINE_M, height, LINE_M], WANTED),
    ]
}

/// Curves of a scene, in the order of [`super::CuttingProcess`]'s values.
pub(super) fn series() -> Vec<Series> {
    let curve = |plot: &str, name: &str| Series { plot: plot.into(), name: name.into() };
    vec![
        curve("force [N]", "knife on food [N]"),
        curve("force [N]", "knife on board [N]"),
        curve("depth [mm]", "depth of the cut [mm]"),
        curve("slice-push ratio", "slice-push ratio"),
        curve("lateral deviation [mm]", "blade off the plane [mm]"),
        curve("roughness so far [um]", "Ra of the cut face [um]"),
    ]
}

#[cfg(test)]
mod tests {
    use nalgebra::{Point3, Vector3};

    use super::*;

    #[test]
    fn no_part_has_the_shade_of_its_neighbor() {
        for own in 0..SHADES {
            for after in [None, Some(0), Some(1), Some(2)].into_iter().filter(|after| *after != Some(own)) {
                for count in 1..6 {
                    let shades = shades(own, after, count);
                    assert_eq!((shades.len(), shades[0]), (count, own));
                    assert!(shades.windows(2).all(|pair| pair[0] != pair[1]), "{shades:?}");
                    assert_ne!(shades.last().copied(), after, "{shades:?}");
                }
            }
        }
    }

    #[test]
    fn a_wanted_cut_is_outlined_round_the_section_of_a_block() {
        let cell = crate::cutting::geometry::ConvexCell::from_box(&Vector3::new(0.05, 0.02, 0.01)).unwrap();
        let block = Solid::from_cells(vec![cell]).unwrap();
        // x of the cut across the block, y down, z along it
        let turn = nalgebra::Rotation3::from_matrix_unchecked(nalgebra::Matrix3::from_columns(&[
            -Vector3::y(),
            -Vector3::z(),
            Vector3::x(),
        ]));
        let cut = Isometry3::from_parts(Point3::new(0.01, 0.0, 0.0).into(), turn.into());
        let drawn = wanted(&block, &Isometry3::identity(), &cut);
        let DrawnShape::Box { size_m } = &drawn[0].shape else { panic!("a pane") };
        assert!((size_m - Vector3::new(0.056, 0.036, PANE_M)).norm() < 1e-12, "{size_m}");
        assert!((drawn[0].body_from_shape.translation.vector - Vector3::new(0.01, 0.0, 0.0)).norm() < 1e-12);
        assert_eq!(drawn.len(), 5);
        let beside = cut * Isometry3::translation(0.0, 0.0, 0.2);
        assert!(wanted(&block, &Isometry3::identity(), &beside).is_empty());
    }
}
