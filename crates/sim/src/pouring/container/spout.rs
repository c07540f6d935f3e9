//! The spout: a channel out of a straight wall, at +x.

use std::f64::consts::PI;

use nalgebra::{Isometry3, Point3, Translation3, UnitQuaternion, Vector3};

use super::Lip;
use super::file::{ContainerFile, Spout};
use super::piece::{Piece, PieceShape};
use super::profile::Meridian;
use super::revolved::apothem_ratio;

/// A channel's measures in the container's frame.
#[derive(Clone, Debug)]
pub(super) struct Trough {
    facets: usize,
    /// The wall's sides from −count to +count about +x are cut.
    cut_each_side: usize,
    /// Where the sides of the channel begin.
    root_x_m: f64,
    root_half_width_m: f64,
    /// Where the middle of the wall is, and the bottom as high as the cut.
    wall_x_m: f64,
    lip_x_m: f64,
    lip_half_width_m: f64,
    bottom_m: f64,
    rise_m: f64,
    top_m: f64,
    wall_m: f64,
}

impl Trough {
    pub(super) fn new(spout: &Spout, file: &ContainerFile, meridian: &Meridian) -> Self {
        let apothem = apothem_ratio(file.facets) * meridian.mouth_radius_m();
        let half_angle = PI / file.facets as f64;
        let radius = apothem / half_angle.cos();
        // the cut ends at corners of the polygon: half width radius·sin((2n+1)·half angle)
        let wanted = (0.5 * spout.width_m / radius).clamp(-1.0, 1.0).asin() / half_angle;
        let cut_each_side = (0.5 * (wanted - 1.0)).round().max(0.0) as usize;
        let corner = (2 * cut_each_side + 1) as f64 * half_angle;
        let top_m = meridian.top_m();
        Self {
            facets: file.facets,
            cut_each_side,
            root_x_m: radius * corner.cos(),
            root_half_width_m: radius * corner.sin(),
            wall_x_m: apothem,
            lip_x_m: apothem + spout.length_m,
            lip_half_width_m: (0.5 * spout.lip_width_m).min(radius * corner.sin()),
            bottom_m: top_m - spout.depth_m,
            rise_m: spout.rise_m,
            top_m,
            wall_m: file.wall_m,
        }
    }

    /// Whether a side of the wall is cut down to the channel's bottom.
    pub(super) fn opens(&self, facet: usize) -> bool {
        facet.min(self.facets - facet) <= self.cut_each_side
    }

    /// Height of the channel's bottom at the wall, m.
    pub(super) fn bottom_m(&self) -> f64 {
        self.bottom_m
    }

    pub(super) fn lip(&self) -> Lip {
        Lip {
            point_in_container: Point3::new(self.lip_x_m, 0.0, self.bottom_m + self.rise_m),
            direction_in_container: Vector3::x(),
            width_m: 2.0 * self.lip_half_width_m,
        }
    }

    /// Half width of the channel at `x`.
    fn half_width(&self, x: f64) -> f64 {
        let share = (x - self.root_x_m) / (self.lip_x_m - self.root_x_m);
        self.root_half_width_m + share * (self.lip_half_width_m - self.root_half_width_m)
    }

    /// Height of the channel's bottom at `x`.
    fn height(&self, x: f64) -> f64 {
        self.bottom_m + self.rise_m * (x - self.wall_x_m) / (self.lip_x_m - self.wall_x_m)
    }

    /// Whether a point lies in the channel, below the rim's plane.
    pub(super) fn contains(&self, point: &Point3<f64>) -> bool {
        (self.root_x_m..=self.lip_x_m).contains(&point.x)
            && point.y.abs() <= self.half_width(point.x)
            && (self.height(point.x)..=self.top_m).contains(&point.z)
    }

    /// Bottom and two sides.
    pub(super) fn pieces(&self) -> impl Iterator<Item = Piece> + '_ {
        let last = self.cut_each_side as i32;
        (-last..=last).map(|strip| self.strip(strip)).chain([self.side(1.0), self.side(-1.0)])
    }

    /// The part of the bottom that begins at a cut side of the wall: it follows the wall's inner face, not to stick out
    /// into the hollow, and the outermost ones reach under the channel's sides.
    fn strip(&self, strip: i32) -> Piece {
        let last = self.cut_each_side as i32;
        let radius = self.wall_x_m / (PI / self.facets as f64).cos();
        let corner = |at_lip: bool, left: bool, upper: bool| {
            let edge = 2 * strip + if left { 1 } else { -1 };
            let (sin, cos) = (f64::from(edge) * PI / self.facets as f64).sin_cos();
            let narrowing = if at_lip { self.lip_half_width_m / self.root_half_width_m } else { 1.0 };
            let x = if at_lip { self.lip_x_m } else { radius * cos };
            let beyond = if edge.abs() > 2 * last { self.wall_m * f64::from(edge.signum()) } else { 0.0 };
            Point3::new(x, narrowing * radius * sin + beyond, self.height(x) - if upper { 0.0 } else { self.wall_m })
        };
        let corners = std::array::from_fn(|index| corner(index & 1 != 0, index & 2 != 0, index & 4 != 0));
        Piece { container_from_piece: Isometry3::identity(), shape: PieceShape::Block { corners } }
    }

    /// A side, from below the bottom up to the rim's plane, its inner face between the channel's root and lip.
    fn side(&self, sign: f64) -> Piece {
        let root = Vector3::new(self.root_x_m, sign * self.root_half_width_m, self.bottom_m - self.wall_m);
        let along = Vector3::new(self.lip_x_m - root.x, sign * self.lip_half_width_m - root.y, 0.0);
        let (length, height) = (along.norm(), self.top_m - root.z);
        let turn = UnitQuaternion::from_axis_angle(&Vector3::z_axis(), along.y.atan2(along.x));
        let center = Translation3::new(0.5 * length, sign * 0.5 * self.wall_m, 0.5 * height);
        Piece {
            container_from_piece: Isometry3::from_parts(root.into(), turn) * center,
            shape: PieceShape::Box { half_extents_m: [0.5 * length, 0.5 * self.wall_m, 0.5 * height] },
        }
    }
}
