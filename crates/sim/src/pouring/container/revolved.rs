//! A vessel of revolution as convex pieces: a floor disc, and flat plates around the axis.
//!
//! Plates are boxes whose inner faces are the sides of a regular polygon. A box is wider than its side by what the
//! outer polygon needs; the surplus lies behind the neighboring plate's inner face, because the hollow is convex across
//! the corner, so there is neither a gap nor an edge that sticks out into the hollow.

use std::f64::consts::{PI, TAU};

use nalgebra::{Isometry3, Translation3, UnitQuaternion, Vector3};

use super::piece::{Piece, PieceShape};
use super::profile::Meridian;
use super::spout::Trough;

/// Distance of a polygon's sides from its center, in radii of the circle of equal area.
pub(super) fn apothem_ratio(facets: usize) -> f64 {
    let half_angle = PI / facets as f64;
    (half_angle / half_angle.tan()).sqrt()
}

/// Floor and wall of the hollow under `meridian`, with room for a spout.
pub(super) fn pieces(meridian: &Meridian, facets: usize, wall_m: f64, trough: Option<&Trough>) -> Vec<Piece> {
    let floor = Piece {
        container_from_piece: Isometry3::translation(0.0, 0.0, meridian.floor_m() - 0.5 * wall_m),
        shape: PieceShape::Disc { radius_m: meridian.floor_radius_m() + wall_m, half_thickness_m: 0.5 * wall_m },
    };
    let mut pieces = vec![floor];
    pieces.extend(plates(meridian, facets, wall_m, trough));
    pieces
}

/// The wall alone; its lowest plates reach down by the floor's thickness.
pub(super) fn plates(meridian: &Meridian, facets: usize, wall_m: f64, trough: Option<&Trough>) -> Vec<Piece> {
    let mut pieces = Vec::new();
    let parts: Vec<_> = meridian.parts().collect();
    for (index, part) in parts.iter().enumerate() {
        let below = index.checked_sub(1).and_then(|below| parts.get(below));
        let extra = Extra {
            below_m: overlap(below, Some(part), wall_m),
            above_m: overlap(Some(part), parts.get(index + 1), wall_m),
        };
        for facet in 0..facets {
            let cut_m = trough.filter(|trough| trough.opens(facet)).map(Trough::bottom_m);
            pieces.push(plate(*part, facet, facets, wall_m, extra, cut_m));
        }
    }
    pieces
}

/// By how much a plate is longer than its part of the meridian.
#[derive(Clone, Copy)]
struct Extra {
    below_m: f64,
    above_m: f64,
}

type Part = ((f64, f64), (f64, f64));

fn inclination(((z0, r0), (z1, r1)): Part) -> f64 {
    (r1 - r0).atan2(z1 - z0)
}

/// What closes the wedge behind the edge between two parts. Where the hollow is not convex the plates overlap anyway.
fn overlap(lower: Option<&Part>, upper: Option<&Part>, wall_m: f64) -> f64 {
    match (lower, upper) {
        (Some(lower), Some(upper)) => {
            let turn = inclination(*lower) - inclination(*upper);
            if turn > 0.0 { wall_m * (0.5 * turn).tan() } else { 0.0 }
        }
        // down to the underside of the floor
        (None, Some(_)) => wall_m,
        (_, None) => 0.0,
    }
}

fn plate(part: Part, facet: usize, facets: usize, wall_m: f64, extra: Extra, cut_m: Option<f64>) -> Piece {
    let ((z0, r0), (z1, r1)) = part;
    let ratio = apothem_ratio(facets);
    let (lean, top) = (inclination(((z0, ratio * r0), (z1, ratio * r1))), cut_m.unwrap_or(z1));
    let start = -extra.below_m / lean.cos();
    let end = (top - z0) / lean.cos() + if cut_m.is_some() { 0.0 } else { extra.above_m };
    let half_width = (ratio * r0.max(r1) + wall_m / lean.cos()) * (PI / facets as f64).tan();
    let around = UnitQuaternion::from_axis_angle(&Vector3::z_axis(), TAU * facet as f64 / facets as f64);
    let tilt = UnitQuaternion::from_axis_angle(&Vector3::y_axis(), lean);
    let foot = Isometry3::from_parts(Translation3::new(ratio * r0, 0.0, z0), tilt);
    let center = Translation3::new(0.5 * wall_m, 0.0, 0.5 * (start + end));
    Piece {
        container_from_piece: around * foot * center,
        shape: PieceShape::Box { half_extents_m: [0.5 * wall_m, half_width, 0.5 * (end - start)] },
    }
}
