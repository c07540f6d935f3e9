//! Friction between a flat object and the table under it.
//!
//! A law gives the friction wrench of a sliding twist. Twists and wrenches are taken at the object's center of mass in
//! world axes: `(vx, vy, w)` in m/s and rad/s, `(fx, fy, m)` in N and N m. To add a law: one file, its lines here.

mod ellipsoid;
mod pressure;

use nalgebra::Vector3;
use serde::{Deserialize, Serialize};
use skills::field::FieldError;
use skills::outline::Outline;

pub use ellipsoid::Ellipsoid;
pub use pressure::SupportPoints;

/// Which law of support friction a scene uses.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum SupportModel {
    /// Ellipsoidal limit surface.
    #[default]
    Ellipsoid,
    /// Uniform pressure on a finite number of support points, each with Coulomb friction.
    SupportPoints {
        /// Number of points, at least; more come closer to continuous pressure.
        #[serde(default = "default_point_count")]
        count: usize,
    },
}

/// Coulomb friction of 64 points is within 1 % of continuous pressure for a disc.
fn default_point_count() -> usize {
    64
}

/// A law of support friction for one object.
pub trait SupportLaw: Send {
    /// Wrench of friction on an object that slides with `twist` while turned by `angle_rad`; zero for a resting object.
    fn wrench(&self, twist: &Vector3<f64>, angle_rad: f64) -> Vector3<f64>;

    /// Twist after friction alone has acted for `dt` on `twist`, implicit in time: it stops but never reverses a motion.
    fn brake(&self, twist: &Vector3<f64>, angle_rad: f64, dt: f64) -> Vector3<f64>;

    /// Characteristic length that makes a rotation comparable with a translation, m.
    fn characteristic_length_m(&self) -> f64;
}

impl SupportModel {
    /// Builds the law for an outline of mass `mass_kg` on a table of friction `friction` under `gravity_m_per_s2`.
    #[must_use]
    pub fn law(&self, outline: &Outline, mass_kg: f64, friction: f64, gravity_m_per_s2: f64) -> Box<dyn SupportLaw> {
        let deceleration_m_per_s2 = friction * gravity_m_per_s2;
        match self {
            Self::Ellipsoid => Box::new(Ellipsoid::new(outline, mass_kg, deceleration_m_per_s2)),
            Self::SupportPoints { count } => {
                Box::new(SupportPoints::new(outline, mass_kg, deceleration_m_per_s2, *count))
            }
        }
    }

    /// Checks the model's numbers.
    ///
    /// # Errors
    /// A [`FieldError`] naming the offending value.
    pub fn validate(&self) -> Result<(), FieldError> {
        match self {
            Self::SupportPoints { count } if !(3..=100_000).contains(count) => {
                Err(FieldError::new("support_points.count", count, "a number from 3 to 100000"))
            }
            Self::Ellipsoid | Self::SupportPoints { .. } => Ok(()),
        }
    }
}
