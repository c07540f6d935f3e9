//! Cup and mouth: what pours and what is poured into, and the clearance between them.

use std::f64::consts::{PI, TAU};

use nalgebra::{Isometry3, Point3, UnitQuaternion, Vector3};
use serde::{Deserialize, Serialize};

use crate::field::{FieldError, finite, not_negative, positive};

/// Cup that is poured from: a cylinder. Its frame lies in the middle of the bottom, z along the axis, x toward the lip.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Container {
    /// Outer radius, m.
    pub radius_m: f64,
    /// Height of the rim above the bottom, m.
    pub height_m: f64,
    /// Thickness of the wall, m.
    pub wall_m: f64,
    /// Length by which a spout stands out from the rim, m; 0 without.
    pub spout_m: f64,
    /// Width of the spout's end, m; of no account without one.
    pub spout_width_m: f64,
}

impl Default for Container {
    fn default() -> Self {
        Self { radius_m: 0.038, height_m: 0.09, wall_m: 0.003, spout_m: 0.0, spout_width_m: 0.02 }
    }
}

/// Body below the mouth of a bottle.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Shoulder {
    /// How far below the rim the body has its full radius, m.
    pub drop_m: f64,
    /// Radius there, m.
    pub radius_m: f64,
}

/// Upright mouth that is poured into.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Mouth {
    /// Middle of the mouth at the height of the rim, world frame, m.
    pub center_world: Point3<f64>,
    /// Inner radius, m.
    pub radius_m: f64,
    /// Thickness of the rim, m: the rim is a ring of circular section.
    pub wall_m: f64,
    /// Body below, where it is wider than the rim.
    pub shoulder: Option<Shoulder>,
}

impl Container {
    /// Checks the sizes.
    ///
    /// # Errors
    /// A [`FieldError`] naming the offending value.
    pub fn validate(&self) -> Result<(), FieldError> {
        positive("radius_m", self.radius_m)?;
        positive("height_m", self.height_m)?;
        positive("wall_m", self.wall_m)?;
        not_negative("spout_m", self.spout_m)?;
        positive("spout_width_m", self.spout_width_m)?;
        if self.wall_m >= self.radius_m {
            return Err(FieldError::new("wall_m", self.wall_m, format!("less than radius_m = {}", self.radius_m)));
        }
        Ok(())
    }

    /// The lip, cup frame.
    #[must_use]
    pub fn lip(&self) -> Point3<f64> {
        Point3::new(self.radius_m + self.spout_m, 0.0, self.height_m)
    }

    /// Greatest distance of a point of the cup from the origin of its frame, m.
    #[must_use]
    pub fn reach_m(&self) -> f64 {
        self.height_m.hypot(self.radius_m + self.spout_m) + self.wall_m
    }

    /// Angle of tilt at which a fill of `fill_m` above the bottom begins to flow, rad: θ_c = θ_s + atan((H − h)/R), the
    /// surface pivoting on the axis; θ_s is the angle at which its surface is stable, 0 for a liquid. Below half of the
    /// height the surface meets the bottom and the flow begins later.
    #[must_use]
    pub fn onset_rad(&self, fill_m: f64, stability_rad: f64) -> f64 {
        let bed_m = (fill_m + self.wall_m).clamp(0.0, self.height_m);
        stability_rad + ((self.height_m - bed_m) / (self.radius_m - self.wall_m)).atan()
    }

    /// Distance of a point of the cup's frame from the cup, taken as solid, m; negative inside. 1-Lipschitz.
    fn distance_m(&self, point: &Point3<f64>) -> f64 {
        let beside = point.x.hypot(point.y) - self.radius_m;
        let above = (point.z - 0.5 * self.height_m).abs() - 0.5 * self.height_m;
        let inside = beside.max(above).min(0.0);
        let body = inside + beside.max(0.0).hypot(above.max(0.0));
        if self.spout_m <= 0.0 {
            return body;
        }
        let along = point.x.clamp(0.0, self.radius_m + self.spout_m);
        let spout = (point - Point3::new(along, 0.0, self.height_m)).norm() - 0.5 * self.wall_m;
        body.min(spout)
    }
}

/// Tolerance of the search round a ring, m, and as a part of the distance: what is returned is below it by no more.
const RING_TOLERANCE_M: f64 = 5e-5;
const RING_TOLERANCE: f64 = 0.02;
/// Arcs that the search round a ring begins with.
const ARCS: usize = 12;

impl Mouth {
    /// Checks place and sizes.
    ///
    /// # Errors
    /// A [`FieldError`] naming the offending value.
    pub fn validate(&self) -> Result<(), FieldError> {
        finite("center_world", self.center_world.coords.as_slice())?;
        positive("radius_m", self.radius_m)?;
        positive("wall_m", self.wall_m)?;
        let Some(shoulder) = self.shoulder else { return Ok(()) };
        positive("shoulder.drop_m", shoulder.drop_m)?;
        positive("shoulder.radius_m", shoulder.radius_m)
    }

    /// Lower bound of the distance between a cup at `world_from_cup` and the rings of the mouth, rim and shoulder, m: no
    /// more than 0.05 mm and 2 % below it.
    ///
    /// A cup that tilts toward the mouth is nearest to it at a ring: its wall leans away from what lies below.
    #[must_use]
    pub fn clearance_m(&self, cup: &Container, world_from_cup: &Isometry3<f64>) -> f64 {
        let cup_from_world = world_from_cup.inverse();
        let half = 0.5 * self.wall_m;
        let rim = ring_distance_m(cup, &cup_from_world, &self.center_world, self.radius_m + half) - half;
        let Some(shoulder) = self.shoulder else { return rim };
        let center = self.center_world - Vector3::z() * shoulder.drop_m;
        rim.min(ring_distance_m(cup, &cup_from_world, &center, shoulder.radius_m))
    }

    /// Greatest radius that a cup of `height_m` meets beside the mouth while its rim is level with it, m.
    pub(super) fn outer_m(&self, height_m: f64) -> f64 {
        let rim = self.radius_m + self.wall_m;
        self.shoulder.filter(|shoulder| shoulder.drop_m < height_m).map_or(rim, |shoulder| rim.max(shoulder.radius_m))
    }

    /// Frame of pouring, `world_from_pour`: origin in the middle of the mouth, z up, x along `direction_rad` about z.
    pub(super) fn world_from_pour(&self, direction_rad: f64) -> Isometry3<f64> {
        let turn = UnitQuaternion::from_scaled_axis(Vector3::z() * direction_rad);
        Isometry3::from_parts(self.center_world.coords.into(), turn)
    }
}

/// Lower bound of the distance between a cup and a level circle, by halving arcs.
fn ring_distance_m(cup: &Container, cup_from_world: &Isometry3<f64>, center: &Point3<f64>, radius_m: f64) -> f64 {
    let at = |angle: f64| {
        let (sin, cos) = angle.sin_cos();
        cup.distance_m(&(cup_from_world * (center + Vector3::new(radius_m * cos, radius_m * sin, 0.0))))
    };
    let angle = |arc: usize| -PI + TAU * arc as f64 / ARCS as f64;
    let mut ends = [0.0; ARCS + 1];
    for (arc, end) in ends.iter_mut().enumerate() {
        *end = at(angle(arc));
    }
    let mut least = ends.iter().copied().fold(f64::INFINITY, f64::min);
    let mut bound = f64::INFINITY;
    for arc in 0..ARCS {
        halve(&at, [angle(arc), angle(arc + 1)], [ends[arc], ends[arc + 1]], radius_m, &mut least, &mut bound);
    }
    bound
}

fn halve(
    at: &impl Fn(f64) -> f64,
    [a, b]: [f64; 2],
    [da, db]: [f64; 2],
    radius_m: f64,
    least: &mut f64,
    bound: &mut f64,
) {
    let lowest = 0.5 * (da + db - radius_m * (b - a));
    if lowest >= *least - RING_TOLERANCE_M - RING_TOLERANCE * least.abs() || b - a < 1e-7 {
        *bound = bound.min(lowest).min(da).min(db);
        return;
    }
    let middle = 0.5 * (a + b);
    let dm = at(middle);
    *least = least.min(dm);
    // the nearer half first, so that the other is cut off sooner
    let halves = [([a, middle], [da, dm]), ([middle, b], [dm, db])];
    let order = if da <= db { [0, 1] } else { [1, 0] };
    for index in order {
        halve(at, halves[index].0, halves[index].1, radius_m, least, bound);
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    #[test]
    fn a_cup_beside_a_mouth_is_as_far_as_its_axis_less_both_radii() {
        let cup = Container { spout_m: 0.0, ..Container::default() };
        let mouth = Mouth { center_world: Point3::new(0.0, 0.0, 0.05), radius_m: 0.04, wall_m: 0.004, shoulder: None };
        let found = mouth.clearance_m(&cup, &Isometry3::translation(-0.1, 0.0, 0.0));
        let error = 0.1 - 0.038 - 0.044 - found;
        assert!((-1e-12..RING_TOLERANCE_M + 0.02 * 0.02).contains(&error), "{found}");
        // 10 mm above the rim
        let found = mouth.clearance_m(&cup, &Isometry3::translation(-0.05, 0.0, 0.062));
        assert!((-1e-12..RING_TOLERANCE_M + 0.02 * 0.012).contains(&(0.01 - found)), "{found}");
    }

    #[test]
    fn onset_of_a_half_full_cup_is_known_by_hand() {
        // R 35 and H 90 inside, h 45: atan(45/35) = 52.1 degrees and the slope at which beans hold
        let cup = Container { radius_m: 0.038, height_m: 0.093, wall_m: 0.003, ..Container::default() };
        let onset = cup.onset_rad(0.045, 30_f64.to_radians());
        assert!((onset.to_degrees() - (30.0 + 52.125)).abs() < 0.01, "{}", onset.to_degrees());
    }

    proptest! {
        #[test]
        fn the_clearance_is_a_lower_bound_close_to_a_dense_scan(
            place in prop::array::uniform3(-0.15f64..0.15), turn in prop::array::uniform3(-2.0f64..2.0),
            radius in 0.01f64..0.08, spout in prop::sample::select(vec![0.0, 0.02]),
        ) {
            let cup = Container { spout_m: spout, ..Container::default() };
            let mouth = Mouth { center_world: Point3::origin(), radius_m: radius, wall_m: 0.003, shoulder: None };
            let pose = Isometry3::new(Vector3::from(place), Vector3::from(turn));
            let found = mouth.clearance_m(&cup, &pose);
            let ring = radius + 0.0015;
            let scan = (0..4000).map(|k| {
                let (sin, cos) = (TAU * f64::from(k) / 4000.0).sin_cos();
                cup.distance_m(&(pose.inverse() * Point3::new(ring * cos, ring * sin, 0.0)))
            }).fold(f64::INFINITY, f64::min) - 0.0015;
            // the scan's arcs are 0.13 mm long at most
            prop_assert!(found <= scan + 1e-12 && found >= scan - RING_TOLERANCE_M - 0.7e-4 - RING_TOLERANCE * (scan.abs() + 0.002), "{found} {scan}");
        }
    }
}
