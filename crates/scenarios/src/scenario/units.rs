//! Unit suffixes of keys: recognizes `radius_mm` where `radius_m` is known, and converts its value.

use std::f64::consts::PI;

use super::document::{Node, Value};

/// The unit of a quantity in scenarios, and other units that people write.
struct Family {
    /// What is said about it: "lengths are in meters".
    rule: &'static str,
    /// Suffix in scenarios.
    suffix: &'static str,
    /// Other suffixes with the factor that leads to the unit of scenarios.
    others: &'static [(&'static str, f64)],
}

/// Longer suffixes come before those that they end in.
const FAMILIES: &[Family] = &[
    Family { rule: "damping is in N m s/rad", suffix: "nm_s_per_rad", others: &[("nm_s_per_deg", 180.0 / PI)] },
    Family {
        rule: "accelerations are in meters per second squared",
        suffix: "m_per_s2",
        others: &[("mm_per_s2", 1e-3), ("cm_per_s2", 1e-2)],
    },
    Family {
        rule: "angular speeds are in radians per second",
        suffix: "rad_per_s",
        others: &[("deg_per_s", PI / 180.0), ("rpm", PI / 30.0)],
    },
    Family {
        rule: "stiffnesses are in newtons per meter",
        suffix: "n_per_m",
        others: &[("n_per_mm", 1e3), ("n_per_cm", 1e2)],
    },
    Family {
        rule: "speeds are in meters per second",
        suffix: "m_per_s",
        others: &[("mm_per_s", 1e-3), ("cm_per_s", 1e-2), ("km_per_h", 1.0 / 3.6)],
    },
    Family {
        rule: "rates of change are per second",
        suffix: "per_s",
        others: &[("per_ms", 1e3), ("per_min", 1.0 / 60.0)],
    },
    Family {
        rule: "moments of inertia are in kg m²",
        suffix: "kg_m2",
        others: &[("g_cm2", 1e-7), ("kg_cm2", 1e-4), ("kg_mm2", 1e-6), ("g_mm2", 1e-9), ("g_m2", 1e-3)],
    },
    Family {
        rule: "lengths are in meters",
        suffix: "m",
        others: &[
            ("mm", 1e-3),
            ("cm", 1e-2),
            ("dm", 1e-1),
            ("um", 1e-6),
            ("km", 1e3),
            ("in", 0.0254),
            ("inch", 0.0254),
        ],
    },
    Family {
        rule: "angles are in radians",
        suffix: "rad",
        others: &[("deg", PI / 180.0), ("degree", PI / 180.0), ("degrees", PI / 180.0), ("mrad", 1e-3)],
    },
    Family { rule: "times are in seconds", suffix: "s", others: &[("ms", 1e-3), ("us", 1e-6), ("min", 60.0)] },
    Family { rule: "masses are in kilograms", suffix: "kg", others: &[("g", 1e-3), ("mg", 1e-6), ("t", 1e3)] },
    Family {
        rule: "frequencies are in hertz",
        suffix: "hz",
        others: &[("khz", 1e3), ("mhz", 1e6), ("rpm", 1.0 / 60.0)],
    },
    Family { rule: "torques are in newton meters", suffix: "nm", others: &[("nmm", 1e-3), ("ncm", 1e-2)] },
    Family { rule: "forces are in newtons", suffix: "n", others: &[("kn", 1e3), ("mn", 1e-3)] },
];

/// A key that was written with another unit, or with none.
pub(crate) struct Mistaken {
    /// The key that was meant.
    pub key: &'static str,
    /// What to write instead.
    pub help: String,
}

/// Recognizes `key = node` as one of the `known` keys in another unit.
pub(crate) fn mistaken_unit(key: &str, node: &Node, known: &[&'static str]) -> Option<Mistaken> {
    known.iter().find_map(|&meant| {
        let (stem, family) = FAMILIES.iter().find_map(|family| Some((stem(meant, family.suffix)?, family)))?;
        if key == stem {
            return Some(Mistaken {
                key: meant,
                help: format!("{} here, and every key says so: write {meant}", family.rule),
            });
        }
        let written = key.strip_prefix(stem)?.strip_prefix('_')?;
        let (_, factor) = family.others.iter().find(|(suffix, _)| *suffix == written)?;
        let value =
            converted(node, *factor).map_or_else(|| " with the converted value".into(), |value| format!(" = {value}"));
        Some(Mistaken { key: meant, help: format!("{} here: write {meant}{value}", family.rule) })
    })
}

/// The unit that the suffix of a key names, in words: "meters"; `None` if it has none of the common ones.
pub(crate) fn unit_of(key: &str) -> Option<&'static str> {
    let family = FAMILIES.iter().find(|family| stem(key, family.suffix).is_some())?;
    Some(family.rule.split_once(" in ").map_or("1/s", |(_, unit)| unit))
}

fn stem<'a>(key: &'a str, suffix: &str) -> Option<&'a str> {
    key.strip_suffix(suffix)?.strip_suffix('_')
}

/// A number or list of numbers times `factor`, as TOML.
fn converted(node: &Node, factor: f64) -> Option<String> {
    match &node.value {
        Value::Integer(number) => Some(rounded(*number as f64 * factor)),
        Value::Float(number) => Some(rounded(number * factor)),
        Value::List(entries) => {
            let entries: Option<Vec<String>> = entries.iter().map(|entry| converted(entry, factor)).collect();
            Some(format!("[{}]", entries?.join(", ")))
        }
        _ => None,
    }
}

/// The shortest text that equals `number` to twelve digits, so that 12 mm become 0.012 m and not 0.012000000000000001 m.
fn rounded(number: f64) -> String {
    let number: f64 = format!("{number:.11e}").parse().unwrap_or(number);
    format!("{number:?}")
}

#[cfg(test)]
mod tests {
    use super::super::document::path;
    use super::super::source::Source;
    use super::*;

    fn help(line: &str, known: &[&'static str]) -> Option<String> {
        let tree = Node::parse(&Source::new("a", line)).unwrap();
        let key = line.split(' ').next().unwrap();
        mistaken_unit(key, tree.at(&path(key)).unwrap(), known).map(|mistaken| mistaken.help)
    }

    #[test]
    fn other_units_are_converted() {
        let expect = [
            ("radius_mm = 12", "radius_m", "lengths are in meters here: write radius_m = 0.012"),
            ("start_cm = [6.5, -5]", "start_m", "lengths are in meters here: write start_m = [0.065, -0.05]"),
            ("angle_deg = 180", "angle_rad", "angles are in radians here: write angle_rad = 3.14159265359"),
            ("mass_g = 5.4", "mass_kg", "masses are in kilograms here: write mass_kg = 0.0054"),
            ("latency_ms = 75", "latency_s", "times are in seconds here: write latency_s = 0.075"),
            (
                "speed_mm_per_s = 20",
                "speed_m_per_s",
                "speeds are in meters per second here: write speed_m_per_s = 0.02",
            ),
            ("rate_khz = 1", "rate_hz", "frequencies are in hertz here: write rate_hz = 1000.0"),
            ("radius_mm = \"12\"", "radius_m", "lengths are in meters here: write radius_m with the converted value"),
        ];
        for (line, known, expected) in expect {
            assert_eq!(help(line, &["name", known]).as_deref(), Some(expected));
        }
    }

    #[test]
    fn a_key_without_unit_is_told_to_carry_it() {
        let help = help("radius = 0.1", &["radius_m"]).unwrap();
        assert_eq!(help, "lengths are in meters here, and every key says so: write radius_m");
    }

    #[test]
    fn other_keys_are_no_unit_mistakes() {
        assert_eq!(help("radius_kg = 1", &["radius_m"]), None);
        assert_eq!(help("width_mm = 1", &["radius_m"]), None);
        assert_eq!(help("speed_m_per_ms = 1", &["speed_m_per_s"]), None);
    }
}
