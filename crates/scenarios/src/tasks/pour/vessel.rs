//! Containers as scenarios name them, and what the skills need to know of them.

use nalgebra::{Isometry3, Point3};
use sim::pouring::{Container, ContainerFile, FillAmount, GrainConfig, PACKING_FRACTION, Profile};
use skills::field::FieldError;
use skills::pouring::{self, Mouth, Shoulder};

use crate::assets::AssetKind;
use crate::scenario::named::TomlAsset;

/// Halvings of an interval of heights: 90 mm to less than a nanometer.
const HALVINGS: usize = 30;

/// A container and the file that states it.
#[derive(Clone, Debug)]
pub struct Vessel {
    /// What the file states.
    pub file: ContainerFile,
    /// What collides and is drawn.
    pub container: Container,
}

impl TomlAsset for Vessel {
    type File = ContainerFile;
    const KIND: AssetKind = AssetKind::Container;
    const EXAMPLE: (&'static str, &'static str) =
        ("assets/containers/beaker_spout.toml", include_str!("../../../../../assets/containers/beaker_spout.toml"));

    fn from_file(file: ContainerFile) -> Result<Self, FieldError> {
        let container = Container::new(&file)?;
        Ok(Self { file, container })
    }
}

impl Vessel {
    /// The vessel as the cup of a skill: a cylinder round its outermost edges; with a spout it ends at the lip's height.
    #[must_use]
    pub fn cup(&self) -> pouring::Container {
        let container = &self.container;
        let inner_m = container.rim.radius_m;
        let points = container.mesh().points;
        // the lip's side of a spout stands out and is told by `spout_m`
        let behind = points.iter().filter(|point| point.x <= 0.0).map(|point| point.x.hypot(point.y));
        let radius_m = behind.fold(inner_m, f64::max);
        pouring::Container {
            radius_m,
            height_m: container.lip.point_in_container.z,
            wall_m: container.wall_m,
            spout_m: match self.file.spout {
                Some(_) => container.lip.point_in_container.x - radius_m,
                None => 0.0,
            },
            spout_width_m: container.lip.width_m,
        }
    }

    /// The vessel as the mouth that a skill pours into.
    #[must_use]
    pub fn mouth(&self, world_from_container: &Isometry3<f64>) -> Mouth {
        let container = &self.container;
        let shoulder = match &self.file.profile {
            Profile::Bottle(bottle) => Some(Shoulder {
                drop_m: bottle.neck_length_m
                    + (bottle.body_radius_m - bottle.neck_radius_m) * bottle.shoulder_rad.tan(),
                radius_m: bottle.body_radius_m + container.wall_m,
            }),
            Profile::Straight(_) | Profile::Cone(_) => None,
        };
        Mouth {
            center_world: world_from_container * container.rim.center_in_container,
            radius_m: container.rim.radius_m,
            wall_m: container.wall_m,
            shoulder,
        }
    }

    /// Height of a fill above the inner floor, m, as far as its amount tells: settled piles differ by some percent.
    #[must_use]
    pub fn fill_height_m(&self, amount: FillAmount, bean: &GrainConfig) -> f64 {
        let count = match amount {
            FillAmount::HeightM(height_m) => return height_m,
            FillAmount::Count(count) => count,
        };
        let volume = count as f64 * bean.volume_m3() / PACKING_FRACTION;
        let top = self.container.rim.center_in_container.z - self.container.floor_m;
        let mut range = (0.0, top);
        for _ in 0..HALVINGS {
            let middle = 0.5 * (range.0 + range.1);
            range = if self.container.volume_to_m3(middle) < volume { (middle, range.1) } else { (range.0, middle) };
        }
        range.0
    }
}

/// Pose of a container on the table, `world_from_container`.
pub(super) fn standing([x, y]: [f64; 2]) -> Isometry3<f64> {
    Isometry3::translation(x, y, 0.0)
}

/// Pose of a cup that is held or stands upright, its lip toward `target` or as told, `world_from_cup`.
pub(super) fn upright([x, y, z]: [f64; 3], angle_rad: Option<f64>, target: &Point3<f64>) -> Isometry3<f64> {
    let angle_rad = angle_rad.unwrap_or_else(|| (target.y - y).atan2(target.x - x));
    Isometry3::translation(x, y, z) * Isometry3::rotation(nalgebra::Vector3::z() * angle_rad)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn shipped(name: &str) -> Vessel {
        let path = format!("{}/../../assets/containers/{name}.toml", env!("CARGO_MANIFEST_DIR"));
        Vessel::from_file(toml::from_str(&std::fs::read_to_string(path).unwrap()).unwrap()).unwrap()
    }

    #[test]
    fn a_straight_cup_is_as_wide_as_its_wall_and_as_high_as_its_rim() {
        let cup = shipped("source_cup").cup();
        // 35 mm inside, 3 mm of wall, the corners of a polygon of 32 sides stand out by 0.5 %
        assert!((0.038..0.0383).contains(&cup.radius_m), "{}", cup.radius_m);
        assert_eq!((cup.height_m, cup.spout_m), (0.093, 0.0));
    }

    #[test]
    fn the_lip_of_a_spout_is_where_the_container_says() {
        let vessel = shipped("beaker_spout");
        assert!((vessel.cup().lip() - vessel.container.lip.point_in_container).norm() < 1e-12);
    }

    #[test]
    fn a_bottle_is_known_with_its_shoulder() {
        let mouth = shipped("tall_bottle").mouth(&standing([0.4, 0.1]));
        assert!((mouth.center_world - Point3::new(0.4, 0.1, 0.213)).norm() < 1e-12);
        let shoulder = mouth.shoulder.unwrap();
        // 21 mm outward at 30 degrees below a neck of 40 mm
        assert!((shoulder.drop_m - 0.052_124).abs() < 1e-6 && (shoulder.radius_m - 0.038).abs() < 1e-12);
    }

    #[test]
    fn three_hundred_soybeans_fill_a_third_of_the_cup() {
        // 300 · π/6 · 7³ mm³ / 0.5 over π · 35² mm²
        let height_m = shipped("source_cup").fill_height_m(FillAmount::Count(300), &GrainConfig::default());
        assert!((height_m - 0.028).abs() < 1e-6, "{height_m}");
        assert_eq!(shipped("jug").fill_height_m(FillAmount::HeightM(0.05), &GrainConfig::default()), 0.05);
    }
}
