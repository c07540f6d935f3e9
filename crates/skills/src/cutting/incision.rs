//! The incision that a motion of a knife would make: how far it is from a plane, and whether it goes through.

use nalgebra::{Isometry3, Matrix3, Point3, Vector3};

use super::section::{Blade, Section};
use crate::spatial::SpatialTrack;

/// Chord lines of the raster, and its rows in depth.
const COLUMNS: usize = 31;
const ROWS: usize = 60;
/// Time between two looks at the edge, s.
const STEP_S: f64 = 0.002;
/// Steps of the search for the point of the edge above a place.
const STEPS: usize = 4;

/// Shape of an incision, of which the edge is the only maker: the food is rigid and holds still.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Incision {
    /// Mean distance of the cut face from its best plane, m.
    pub ra_m: f64,
    /// Distance between its highest and its lowest point across that plane, m.
    pub rt_m: f64,
    /// Angle between its best plane and the section, rad.
    pub tilt_rad: f64,
    /// Least depth of the cut over the chord, from the top of the food, m.
    pub least_depth_m: f64,
    /// Greatest depth of the edge over the chord, m.
    pub greatest_depth_m: f64,
}

impl Incision {
    /// Sweeps the edge of a knife that follows `track`, `world_from_tool`, through a section: every cell of a raster is cut
    /// where the edge first passes it.
    #[must_use]
    pub fn of(track: &SpatialTrack, section: &Section, blade: &Blade) -> Self {
        let from_world = section.world_from_section.inverse();
        let mut passed = vec![[None::<f64>; ROWS]; COLUMNS];
        let mut depths = [f64::NEG_INFINITY; COLUMNS];
        let looks = (track.duration_s() / STEP_S).ceil() as usize;
        for look in 0..=looks {
            let section_from_tool = from_world * track.at(look as f64 * STEP_S).pose;
            for (column, (cells, deepest)) in passed.iter_mut().zip(&mut depths).enumerate() {
                let x = section.width_m * (column as f64 / (COLUMNS - 1) as f64 - 0.5);
                let Some(point) = edge_above(&section_from_tool, blade, x) else { continue };
                *deepest = deepest.max(point.y);
                let reached = (point.y / section.height_m * ROWS as f64).floor().min(ROWS as f64);
                for cell in cells.iter_mut().take(reached.max(0.0) as usize) {
                    cell.get_or_insert(point.z);
                }
            }
        }
        let cells = passed.iter().enumerate().flat_map(|(column, cells)| {
            let x = section.width_m * (column as f64 / (COLUMNS - 1) as f64 - 0.5);
            let place = move |row: usize| section.height_m * (row as f64 + 0.5) / ROWS as f64;
            cells.iter().enumerate().filter_map(move |(row, cell)| cell.map(|z| Vector3::new(x, place(row), z)))
        });
        let face: Vec<Vector3<f64>> = cells.collect();
        let [ra_m, rt_m, tilt_rad] = about_plane(&face);
        Self {
            ra_m,
            rt_m,
            tilt_rad,
            least_depth_m: depths.iter().copied().fold(f64::INFINITY, f64::min),
            greatest_depth_m: depths.iter().copied().fold(f64::NEG_INFINITY, f64::max),
        }
    }
}

/// The point of the edge at the place `x` of the section, if the edge is there.
fn edge_above(section_from_tool: &Isometry3<f64>, blade: &Blade, x: f64) -> Option<Point3<f64>> {
    let point = |along_m: f64| {
        let [x, y] = blade.point(along_m);
        section_from_tool * Point3::new(x, y, 0.0)
    };
    let mut along_m = x - section_from_tool.translation.vector.x;
    for _ in 0..STEPS {
        along_m += x - point(along_m).x;
    }
    (along_m.abs() <= 0.5 * blade.edge_m).then(|| point(along_m))
}

/// Mean distance and range about the plane z = a + bx + cy of least squares, and its tilt.
fn about_plane(face: &[Vector3<f64>]) -> [f64; 3] {
    let (mut normal, mut right) = (Matrix3::zeros(), Vector3::zeros());
    for point in face {
        let row = Vector3::new(1.0, point.x, point.y);
        normal += row * row.transpose();
        right += row * point.z;
    }
    let Some(plane) = normal.try_inverse().map(|inverse| inverse * right) else { return [f64::NAN; 3] };
    let off = |point: &Vector3<f64>| point.z - plane.dot(&Vector3::new(1.0, point.x, point.y));
    let (low, high) =
        face.iter().map(off).fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), z| (low.min(z), high.max(z)));
    let mean = face.iter().map(|point| off(point).abs()).sum::<f64>() / face.len().max(1) as f64;
    [mean, high - low, plane.y.hypot(plane.z).atan()]
}
