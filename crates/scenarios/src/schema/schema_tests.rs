//! Tests of the schemas themselves.

use super::*;

fn of(name: &str) -> Value {
    FILES.iter().find(|kind| kind.name == name).unwrap().schema()
}

fn key(name: &str, dotted: &str) -> Key {
    let steps: Vec<&str> = dotted.split('.').collect();
    keys::keys(&of(name)).into_iter().find(|key| key.is_at(&steps)).unwrap()
}

/// Visits every part of a schema.
fn visit(part: &Value, each: &mut dyn FnMut(&Value)) {
    each(part);
    match part {
        Value::Object(entries) => {
            entries.iter().filter(|(name, _)| *name != "default").for_each(|(_, part)| visit(part, each));
        }
        Value::Array(parts) => parts.iter().for_each(|part| visit(part, each)),
        _ => {}
    }
}

#[test]
fn every_reference_leads_to_a_part_and_no_value_may_be_null() {
    for kind in FILES {
        let whole = kind.schema();
        visit(&whole, &mut |part| {
            if part.get("$ref").is_some() {
                assert!(place::resolved(&whole, part).get("$ref").is_none(), "{part}");
            }
            assert_ne!(part.get("type"), Some(&json!("null")), "{}", kind.name);
            assert!(part.get("default").is_none_or(|default| !default.is_null()), "{}: {part}", kind.name);
        });
    }
}

#[test]
fn every_table_is_closed_and_every_key_has_a_description() {
    for kind in FILES {
        let keys = keys::keys(&kind.schema());
        assert!(keys.len() > 5, "{}: {} keys", kind.name, keys.len());
        let silent: Vec<String> = keys
            .iter()
            .filter(|key| key.description.is_empty() && key.path.last().is_some_and(|step| step != keys::ANY_NAME))
            // each is the basis of the number of the same name, which has a description
            .filter(|key| !key.dotted().starts_with("material.basis."))
            .map(Key::dotted)
            .collect();
        assert!(silent.is_empty(), "{}: {silent:?}", kind.name);
        visit(&kind.schema(), &mut |part| {
            if part["properties"].is_object() && part["type"] == "object" {
                assert_eq!(part["additionalProperties"], json!(false), "{}: {part}", kind.name);
            }
        });
    }
}

#[test]
fn a_kind_whose_options_have_defaults_is_a_bare_text_too() {
    let controller = key("scenario", "controller");
    assert!(controller.choices.iter().any(|(name, _)| name == "impedance"), "{controller:?}");
    // a box needs its lengths
    let shape = key("scenario", "object.shape");
    assert!(shape.choices.is_empty(), "{shape:?}");
}

#[test]
fn what_tasks_have_in_common_is_one_key_for_all() {
    assert_eq!(key("scenario", "scenario.title").tasks, ["push", "reach", "cut", "pour"]);
    assert_eq!(key("scenario", "task.push.start_m").tasks, ["push"]);
    assert!(key("tool", "mass_kg").tasks.is_empty());
}

#[test]
fn a_key_carries_type_default_and_need() {
    let speed = key("scenario", "task.push.push_speed_m_per_s");
    assert_eq!(
        (speed.takes.as_str(), speed.default, speed.needed),
        ("a number from 0.0001 to 2", Some(json!(0.02)), false)
    );
    let start = key("scenario", "task.push.start_m");
    assert_eq!((start.takes.as_str(), start.default, start.needed), ("a list of 2 numbers", None, true));
    assert_eq!(key("scenario", "world.obstacles").takes, "a list of tables");
    assert_eq!(key("scenario", "tool.asset").asset.as_deref(), Some("tools"));
}

#[test]
fn entries_of_lists_and_free_names_have_any_index_and_name() {
    assert!(key("scenario", "world.obstacles.3.position_m").needed);
    assert_eq!(key("scenario", "task.push.transfer.sides.post").dotted(), "task.push.transfer.sides.NAME");
}

/// Keys whose default depends on whether the table around them is stated: that table's own default differs from the one
/// that the table around it has for it. Whoever states one key of such a table has to state these as well.
const DEFAULTS_THAT_DEPEND: &[&str] = &[
    "demonstrations.synthetic.human.hand.constant_noise_rad_per_s",
    "learning.approach.primitive.dmp",
    "learning.separation.primitive.dmp",
    "learning.tilt.bases",
    "task.push.transfer.planner.flip.contact_tolerance_m",
    "task.push.transfer.planner.flip.least_clearance_m",
    "task.push.transfer.planner.flip.margin_m",
];

#[test]
fn no_other_default_depends_on_the_table_around_it() {
    for kind in FILES {
        let all = keys::keys(&kind.schema());
        for key in &all {
            let Some(Value::Object(default)) = &key.default else { continue };
            for (name, value) in default {
                let steps: Vec<&str> = key.path.iter().map(String::as_str).chain([name.as_str()]).collect();
                let path = steps.join(".");
                let same_tasks = |other: &&Key| other.is_at(&steps) && other.tasks == key.tasks;
                let own = all.iter().find(same_tasks).and_then(|own| own.default.clone());
                let depends = DEFAULTS_THAT_DEPEND.iter().any(|known| known.starts_with(&path));
                if let Some(own) = own.filter(|_| !depends) {
                    assert_eq!(own, *value, "{}: {path}", kind.name);
                }
            }
        }
    }
}

#[test]
fn values_are_written_as_toml() {
    let value = json!({ "a": [1, 2.5], "b": { "c": "x\"y" }, "d": {}, "e": true });
    let text = format!("v = {}", as_toml(&value));
    let read: toml::Table = text.parse().unwrap();
    assert_eq!(serde_json::to_value(&read["v"]).unwrap(), value);
    assert_eq!(as_toml(&json!(1.0)), "1.0");
}

#[test]
fn a_sentence_ends_before_a_capital() {
    assert_eq!(first_sentence("Gain k of\nEq. (34), 1/s. The paper's is 3."), "Gain k of Eq. (34), 1/s");
    assert_eq!(first_sentence("Mass, kg."), "Mass, kg");
}
