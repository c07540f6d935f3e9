//! Container files: what a file states about a vessel, and the checks on it.

use serde::{Deserialize, Serialize};
use skills::field::{FieldError, not_negative, positive, within};

use super::profile::Meridian;

/// A container's largest length, m; more is a length in millimeters.
const LARGEST_M: f64 = 1.0;
/// A wall thinner than this lets grains through at the contacts' compliance, m.
const THINNEST_WALL_M: f64 = 0.001;

/// What a container file states.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ContainerFile {
    /// Name, as scenarios and reports call it.
    pub name: String,
    /// One line about the container.
    #[serde(default)]
    pub description: String,
    /// Mass, kg.
    #[schemars(range(min = 1e-3, max = 100.0))]
    pub mass_kg: f64,
    /// Coefficient of friction between the wall and a grain.
    #[schemars(range(min = 0.0, max = 2.0))]
    pub friction: f64,
    /// Coefficient of restitution between the wall and a grain.
    #[schemars(range(min = 0.0, max = 1.0))]
    pub restitution: f64,
    /// Thickness of wall and floor, m.
    #[schemars(range(min = THINNEST_WALL_M, max = 0.1))]
    pub wall_m: f64,
    /// Number of flat sides that stand for the round wall; the area of the hole is that of the circle.
    #[serde(default = "default_facets")]
    pub facets: usize,
    /// Shape of the hollow.
    pub profile: Profile,
    /// Channel out of the rim, at +x.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub spout: Option<Spout>,
}

/// With 32 sides the wall deviates from the circle by 0.3 % of its radius.
fn default_facets() -> usize {
    32
}

/// Shape of the hollow, a surface of revolution.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum Profile {
    /// Cylinder.
    Straight(Straight),
    /// Truncated cone, wider at the mouth.
    Cone(Cone),
    /// Cylinder, conical shoulder, narrower cylinder.
    Bottle(Bottle),
}

/// Cylinder.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Straight {
    /// Inner radius, m.
    #[schemars(range(min = THINNEST_WALL_M, max = LARGEST_M))]
    pub radius_m: f64,
    /// Inner height, m.
    #[schemars(range(min = THINNEST_WALL_M, max = LARGEST_M))]
    pub height_m: f64,
}

/// Truncated cone.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Cone {
    /// Inner radius at the floor, m.
    #[schemars(range(min = THINNEST_WALL_M, max = LARGEST_M))]
    pub floor_radius_m: f64,
    /// Inner radius at the mouth, m; at least that at the floor.
    #[schemars(range(max = LARGEST_M))]
    pub mouth_radius_m: f64,
    /// Inner height, m.
    #[schemars(range(min = THINNEST_WALL_M, max = LARGEST_M))]
    pub height_m: f64,
}

/// Cylinder, conical shoulder, narrower cylinder.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Bottle {
    /// Inner radius of the body, m.
    #[schemars(range(min = THINNEST_WALL_M, max = LARGEST_M))]
    pub body_radius_m: f64,
    /// Inner height of the whole hollow, m.
    #[schemars(range(min = THINNEST_WALL_M, max = LARGEST_M))]
    pub height_m: f64,
    /// Inclination of the shoulder against the horizontal, rad.
    #[schemars(range(min = 0.1, max = 1.4))]
    pub shoulder_rad: f64,
    /// Inner radius of the neck, m.
    #[schemars(range(min = THINNEST_WALL_M))]
    pub neck_radius_m: f64,
    /// Length of the neck, m.
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub neck_length_m: f64,
}

/// A channel that leads out of the rim at +x: a flat bottom between two sides that come closer to each other.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Spout {
    /// Width where it leaves the wall, m; rounded to a whole number of the wall's sides.
    pub width_m: f64,
    /// Width at the lip, m.
    #[schemars(range(min = THINNEST_WALL_M))]
    pub lip_width_m: f64,
    /// Length from the wall to the lip, measured horizontally, m.
    #[schemars(range(min = THINNEST_WALL_M))]
    pub length_m: f64,
    /// How far the channel's bottom lies below the rim at the wall, m.
    #[schemars(range(min = THINNEST_WALL_M))]
    pub depth_m: f64,
    /// How far the bottom rises from the wall to the lip, m.
    #[schemars(range(min = 0.0))]
    pub rise_m: f64,
}

impl ContainerFile {
    /// Checks every number.
    ///
    /// # Errors
    /// A [`FieldError`] naming the offending value.
    pub fn validate(&self) -> Result<(), FieldError> {
        within("mass_kg", self.mass_kg, 1e-3, 100.0)?;
        within("friction", self.friction, 0.0, 2.0)?;
        within("restitution", self.restitution, 0.0, 1.0)?;
        within("wall_m", self.wall_m, THINNEST_WALL_M, 0.1)?;
        if !(24..=256).contains(&self.facets) || !self.facets.is_multiple_of(4) {
            return Err(FieldError::new("facets", self.facets, "a multiple of 4 from 24 to 256"));
        }
        self.profile.validate().map_err(|error| error.within("profile"))?;
        self.spout.as_ref().map_or(Ok(()), |spout| spout.validate(&self.profile).map_err(|e| e.within("spout")))
    }
}

impl Profile {
    /// The hollow's radius over height, the floor at the thickness of the wall.
    pub(super) fn meridian(&self, floor_m: f64) -> Meridian {
        let points = match self {
            Self::Straight(s) => vec![(0.0, s.radius_m), (s.height_m, s.radius_m)],
            Self::Cone(c) => vec![(0.0, c.floor_radius_m), (c.height_m, c.mouth_radius_m)],
            Self::Bottle(b) => {
                let neck = b.height_m - b.neck_length_m;
                vec![
                    (0.0, b.body_radius_m),
                    (neck - b.shoulder_height_m(), b.body_radius_m),
                    (neck, b.neck_radius_m),
                    (b.height_m, b.neck_radius_m),
                ]
            }
        };
        Meridian::new(points.into_iter().map(|(height, radius)| (floor_m + height, radius)).collect())
    }

    fn mouth_m(&self) -> (f64, f64) {
        match self {
            Self::Straight(s) => (s.radius_m, s.height_m),
            Self::Cone(c) => (c.mouth_radius_m, c.height_m),
            Self::Bottle(b) => (b.neck_radius_m, b.neck_length_m),
        }
    }

    fn validate(&self) -> Result<(), FieldError> {
        match self {
            Self::Straight(s) => lengths("straight", &[("radius_m", s.radius_m), ("height_m", s.height_m)]),
            Self::Cone(c) => {
                lengths("cone", &[("floor_radius_m", c.floor_radius_m), ("height_m", c.height_m)])?;
                within("cone.mouth_radius_m", c.mouth_radius_m, c.floor_radius_m, LARGEST_M)
            }
            Self::Bottle(b) => b.validate(),
        }
    }
}

fn lengths(kind: &str, named: &[(&str, f64)]) -> Result<(), FieldError> {
    let mut named = named.iter();
    named.try_for_each(|(name, value)| within(&format!("{kind}.{name}"), *value, THINNEST_WALL_M, LARGEST_M))
}

impl Bottle {
    fn shoulder_height_m(&self) -> f64 {
        (self.body_radius_m - self.neck_radius_m) * self.shoulder_rad.tan()
    }

    fn validate(&self) -> Result<(), FieldError> {
        let named = [("body_radius_m", self.body_radius_m), ("height_m", self.height_m)];
        lengths("bottle", &named)?;
        within("bottle.neck_radius_m", self.neck_radius_m, THINNEST_WALL_M, 0.95 * self.body_radius_m)?;
        within("bottle.shoulder_rad", self.shoulder_rad, 0.1, 1.4)?;
        let room = self.height_m - self.shoulder_height_m();
        positive("bottle.neck_length_m", self.neck_length_m)?;
        if self.neck_length_m < room {
            return Ok(());
        }
        let expected = format!("less than {room:.4}, what height_m leaves above the shoulder");
        Err(FieldError::new("bottle.neck_length_m", self.neck_length_m, expected))
    }
}

impl Spout {
    fn validate(&self, profile: &Profile) -> Result<(), FieldError> {
        let (radius, height) = profile.mouth_m();
        if !matches!(profile, Profile::Straight(_)) {
            return Err(FieldError::new("", "a spout on a profile that is not straight", "a straight profile"));
        }
        within("width_m", self.width_m, 0.1 * radius, 1.4 * radius)?;
        within("lip_width_m", self.lip_width_m, THINNEST_WALL_M, self.width_m)?;
        within("length_m", self.length_m, THINNEST_WALL_M, 4.0 * radius)?;
        within("depth_m", self.depth_m, THINNEST_WALL_M, 0.8 * height)?;
        not_negative("rise_m", self.rise_m)?;
        within("rise_m", self.rise_m, 0.0, self.depth_m)
    }
}
