//! How pieces and board look.

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

/// A piece in the food's frame: skin, and cut faces in the color of the flesh.
pub(super) fn piece(solid: &Solid, look: &FoodLook) -> Drawing {
    let mesh = solid.mesh();
    let rgba = |[r, g, b]: [f64; 3]| -> Rgba { [r as f32, g as f32, b as f32, 1.0] };
    let color = |surface: &Surface| match surface {
        Surface::Skin => rgba(look.skin_rgb),
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
    Drawing {
        shape: DrawnShape::Mesh(drawn),
        body_from_shape: nalgebra::Isometry3::identity(),
        color: rgba(look.skin_rgb),
    }
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
    ]
}
