//! Families of blades: what each makes of its lengths.

use std::f64::consts::FRAC_PI_2;

use nalgebra::Point2;
use serde::{Deserialize, Serialize};
use skills::field::{FieldError, not_negative, positive, within};

use super::edge::Edge;
use super::solid::{self, Piece};

/// Families of blades, as a table in a file: `blade.chef = { length_m = 0.2, … }`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum BladeFamily {
    /// Long blade with a belly to rock on; the spine falls to the point over the last third.
    Chef(BladeShape),
    /// Short blade; the spine falls to the point over its front half.
    Paring(BladeShape),
    /// High, heavy blade with a square front.
    Cleaver(BladeShape),
    /// Blade with teeth; the spine falls over the last tenth.
    Serrated(Serration),
    /// Wire stretched in a bow.
    Wire(WireShape),
}

/// Lengths of a blade that is ground from a plate.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct BladeShape {
    /// Length of the edge along x, m.
    #[schemars(range(min = 0.02, max = 1.0))]
    pub length_m: f64,
    /// Height from the edge to the spine at the heel, m.
    #[schemars(range(min = 0.005, max = 0.3))]
    pub height_m: f64,
    /// Thickness of the plate, m.
    #[schemars(range(min = 0.0002, max = 0.02))]
    pub spine_thickness_m: f64,
    /// Angle between the two faces that meet at the edge, rad.
    #[schemars(range(min = 0.05, max = FRAC_PI_2))]
    pub bevel_angle_rad: f64,
    /// Radius of the edge, m: 2 to 10 µm is sharp, 50 µm dull.
    #[schemars(range(min = 0.0))]
    pub edge_radius_m: f64,
    /// Radius of the curved front of the edge, m; none for a straight edge.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub belly_radius_m: Option<f64>,
}

/// A blade with teeth.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Serration {
    /// The blade without its teeth.
    pub blade: BladeShape,
    /// Distance between teeth, m.
    #[schemars(range(min = 0.0005))]
    pub tooth_pitch_m: f64,
    /// Depth of the hollows between them, m.
    #[schemars(range(min = 0.0001))]
    pub tooth_depth_m: f64,
}

/// A wire in a bow.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct WireShape {
    /// Length of the wire between the legs of the bow, m.
    #[schemars(range(min = 0.02, max = 1.0))]
    pub length_m: f64,
    /// Diameter of the wire, m.
    #[schemars(range(min = 0.0001, max = 0.003))]
    pub diameter_m: f64,
    /// Distance from the wire to the back of the bow, m.
    #[schemars(range(max = 0.5))]
    pub bow_height_m: f64,
    /// Side of the square rod that the bow is bent of, m.
    #[schemars(range(min = 0.001, max = 0.03))]
    pub rod_m: f64,
}

/// Share of the length, from the heel, over which an edge with a belly is straight.
const STRAIGHT_SHARE: f64 = 0.35;
/// Pieces that a belly is divided into.
const BELLY_SEGMENTS: u32 = 16;
/// The tip of the edge stays this share of the height below the spine.
const LARGEST_RISE_SHARE: f64 = 0.9;
/// What teeth add to the slice-push ratio: estimate for bread and tomato knives.
const TOOTH_RATIO: f64 = 0.3;
/// Teeth leave a surface about twice as rough as their path: estimate.
const TOOTH_ROUGHNESS: f64 = 2.0;

impl BladeShape {
    /// Checks the lengths, alone and against each other.
    ///
    /// # Errors
    /// A [`FieldError`] naming the offending length.
    pub fn validate(&self) -> Result<(), FieldError> {
        within("length_m", self.length_m, 0.02, 1.0)?;
        within("height_m", self.height_m, 0.005, 0.3)?;
        within("spine_thickness_m", self.spine_thickness_m, 0.0002, 0.02)?;
        within("bevel_angle_rad", self.bevel_angle_rad, 0.05, FRAC_PI_2)?;
        within("edge_radius_m", self.edge_radius_m, 0.0, 0.5 * self.spine_thickness_m)?;
        if self.shoulder_m() >= self.height_m {
            let expected = format!("an angle whose faces meet the spine's thickness within {} m", self.height_m);
            return Err(FieldError::new("bevel_angle_rad", self.bevel_angle_rad, expected));
        }
        let Some(belly) = self.belly_radius_m else { return Ok(()) };
        positive("belly_radius_m", belly)?;
        let arc = self.length_m * (1.0 - STRAIGHT_SHARE);
        let limit = self.height_m * LARGEST_RISE_SHARE - self.shoulder_m();
        if belly <= arc || self.rise_at(self.length_m) > limit {
            let expected = format!("a radius at which the edge rises by less than {limit:.4} m toward the tip");
            return Err(FieldError::new("belly_radius_m", belly, expected));
        }
        Ok(())
    }

    /// Height of the ground faces above the edge, m.
    fn shoulder_m(&self) -> f64 {
        0.5 * self.spine_thickness_m / (0.5 * self.bevel_angle_rad).tan()
    }

    /// How far the edge lies above its straight part at `x`, m.
    fn rise_at(&self, x: f64) -> f64 {
        let beyond = (x - STRAIGHT_SHARE * self.length_m).max(0.0);
        self.belly_radius_m.map_or(0.0, |radius| radius - (radius * radius - beyond * beyond).sqrt())
    }

    fn points(&self) -> Vec<Point2<f64>> {
        if self.belly_radius_m.is_none() {
            return vec![Point2::origin(), Point2::new(self.length_m, 0.0)];
        }
        let start = STRAIGHT_SHARE * self.length_m;
        let along = |k: u32| start + (self.length_m - start) * f64::from(k) / f64::from(BELLY_SEGMENTS);
        let belly = (0..=BELLY_SEGMENTS).map(|k| Point2::new(along(k), -self.rise_at(along(k))));
        std::iter::once(Point2::origin()).chain(belly).collect()
    }

    /// Height of the spine at `x` when it falls over the last `taper` of the length to just above the tip.
    fn spine_at(&self, x: f64, taper: f64) -> f64 {
        let fallen = ((x / self.length_m - 1.0 + taper) / taper.max(f64::EPSILON)).clamp(0.0, 1.0);
        let end = if taper > 0.0 { self.rise_at(self.length_m) + self.shoulder_m() } else { self.height_m };
        -(self.height_m + fallen * (end - self.height_m))
    }

    fn edge(&self, friction: f64) -> Edge {
        Edge {
            points: self.points(),
            radius_m: self.edge_radius_m,
            blade_height_m: self.height_m,
            thickness_m: self.spine_thickness_m,
            friction,
            tooth_ratio: 0.0,
            roughness_factor: 1.0,
        }
    }

    /// Convex pieces between neighboring corners of the edge and of the spine.
    fn pieces(&self, taper: f64) -> Vec<Piece> {
        let mut stations: Vec<f64> = self.points().iter().map(|point| point.x).collect();
        stations.push(self.length_m * (1.0 - taper));
        stations.sort_by(f64::total_cmp);
        stations.dedup_by(|next, previous| (*next - *previous).abs() < 1e-6);
        let half = 0.5 * self.spine_thickness_m;
        let section = |x: f64| {
            let edge = -self.rise_at(x);
            // the hull of two neighboring sections is the piece: spine, shoulder and edge
            let (spine, shoulder) = (self.spine_at(x, taper), edge - self.shoulder_m());
            [(spine, half), (spine, -half), (shoulder, half), (shoulder, -half), (edge, 0.0)]
                .map(|(y, z)| nalgebra::Point3::new(x, y, z))
        };
        stations.windows(2).map(|pair| [section(pair[0]), section(pair[1])].concat()).collect()
    }
}

impl Serration {
    /// Checks the lengths, alone and against each other.
    ///
    /// # Errors
    /// A [`FieldError`] naming the offending length.
    pub fn validate(&self) -> Result<(), FieldError> {
        self.blade.validate().map_err(|error| error.within("blade"))?;
        within("tooth_pitch_m", self.tooth_pitch_m, 0.0005, 0.1 * self.blade.length_m)?;
        within("tooth_depth_m", self.tooth_depth_m, 0.0001, self.tooth_pitch_m)
    }
}

impl WireShape {
    /// Checks the lengths, alone and against each other.
    ///
    /// # Errors
    /// A [`FieldError`] naming the offending length.
    pub fn validate(&self) -> Result<(), FieldError> {
        within("length_m", self.length_m, 0.02, 1.0)?;
        within("diameter_m", self.diameter_m, 0.0001, 0.003)?;
        within("rod_m", self.rod_m, 0.001, 0.03)?;
        within("bow_height_m", self.bow_height_m, 2.0 * self.rod_m, 0.5)?;
        not_negative("length_m", self.length_m - 2.0 * self.rod_m)
    }

    fn pieces(&self) -> Vec<Piece> {
        let (rod, half_wire) = (self.rod_m, 0.5 * self.diameter_m);
        let back = -self.bow_height_m;
        vec![
            solid::cuboid([0.0, -self.diameter_m, -half_wire], [self.length_m, 0.0, half_wire]),
            solid::cuboid([-rod, back, -0.5 * rod], [0.0, 0.0, 0.5 * rod]),
            solid::cuboid([self.length_m, back, -0.5 * rod], [self.length_m + rod, 0.0, 0.5 * rod]),
            solid::cuboid([-rod, back - rod, -0.5 * rod], [self.length_m + rod, back, 0.5 * rod]),
        ]
    }
}

impl BladeFamily {
    /// Checks the lengths of the blade.
    ///
    /// # Errors
    /// A [`FieldError`] naming the offending length, its path beginning with the family.
    pub fn validate(&self) -> Result<(), FieldError> {
        match self {
            Self::Chef(blade) | Self::Paring(blade) | Self::Cleaver(blade) => blade.validate(),
            Self::Serrated(serration) => serration.validate(),
            Self::Wire(wire) => wire.validate(),
        }
        .map_err(|error| error.within(self.name()))
    }

    /// Name of the family as written in a file.
    #[must_use]
    pub fn name(&self) -> &'static str {
        match self {
            Self::Chef(_) => "chef",
            Self::Paring(_) => "paring",
            Self::Cleaver(_) => "cleaver",
            Self::Serrated(_) => "serrated",
            Self::Wire(_) => "wire",
        }
    }

    /// Edge of the blade whose coefficient of friction with food is `friction`.
    #[must_use]
    pub fn edge(&self, friction: f64) -> Edge {
        match self {
            Self::Chef(blade) | Self::Paring(blade) | Self::Cleaver(blade) => blade.edge(friction),
            Self::Serrated(serration) => {
                Edge { tooth_ratio: TOOTH_RATIO, roughness_factor: TOOTH_ROUGHNESS, ..serration.blade.edge(friction) }
            }
            Self::Wire(wire) => Edge {
                points: vec![Point2::origin(), Point2::new(wire.length_m, 0.0)],
                radius_m: 0.5 * wire.diameter_m,
                blade_height_m: wire.diameter_m,
                thickness_m: wire.diameter_m,
                friction,
                tooth_ratio: 0.0,
                roughness_factor: 1.0,
            },
        }
    }

    /// Convex pieces of the blade in the knife's frame; the hollows between teeth are left out.
    #[must_use]
    pub fn pieces(&self) -> Vec<Piece> {
        match self {
            Self::Chef(blade) => blade.pieces(1.0 / 3.0),
            Self::Paring(blade) => blade.pieces(0.5),
            Self::Cleaver(blade) => blade.pieces(0.0),
            Self::Serrated(serration) => serration.blade.pieces(0.1),
            Self::Wire(wire) => wire.pieces(),
        }
    }

    /// Height above the edge at which the handle begins, m.
    #[must_use]
    pub fn back_m(&self) -> f64 {
        match self {
            Self::Chef(blade) | Self::Paring(blade) | Self::Cleaver(blade) => blade.height_m,
            Self::Serrated(serration) => serration.blade.height_m,
            Self::Wire(wire) => wire.bow_height_m + wire.rod_m,
        }
    }
}
