//! Tests of loading that need no program: the shipped scenario, its round trip, random damage.

use std::fs;
use std::path::PathBuf;

use proptest::prelude::*;

use serde::Deserialize;
use sim::controllers::ControllerConfig;
use skills::field::FieldError;

use super::*;
use crate::assets::AssetKind;
use crate::scenario::named::read_asset;
use crate::scenario::{ArmKeys, Header, RecordingConfig, RobotConfig, ScenarioFile};
use crate::tasks::ResolvedTask;
use crate::tasks::push::ResolvedPush;
use skills::tool::Tool;

fn project() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../..")
}

fn assets() -> Assets {
    Assets::at(project().join("assets"))
}

fn shipped() -> String {
    fs::read_to_string(project().join("scenarios/push_stick.toml")).unwrap()
}

fn problems(text: &str) -> Vec<Diagnostic> {
    let source = Source::new("push.toml", text);
    resolve(&source, &assets()).err().unwrap_or_default()
}

/// The shipped scenario with one part of its text replaced.
fn changed(from: &str, to: &str) -> String {
    let text = shipped();
    assert_eq!(text.matches(from).count(), 1, "{from}");
    text.replace(from, to)
}

/// What is particular to a push in `scenario`.
fn push(scenario: &ResolvedScenario) -> &ResolvedPush {
    scenario.as_push().unwrap()
}

#[test]
fn the_shipped_scenario_loads() {
    let loaded = load(&project().join("scenarios/push_stick.toml"), &assets()).unwrap();
    assert_eq!(loaded.name, "push_stick");
    assert_eq!(loaded.arm.joint_count(), 3);
    assert_eq!(push(&loaded).tool, push(&loaded).demonstration_tool);
    assert_eq!(notes(&loaded), Vec::<String>::new());
}

#[test]
fn a_scenario_written_with_all_defaults_loads_to_the_same() {
    let loaded = load(&project().join("scenarios/push_stick.toml"), &assets()).unwrap();
    let text = toml::to_string(&push(&loaded).scenario).unwrap();
    let source = Source::new("again.toml", text.as_str());
    let again = resolve(&source, &assets()).map_err(|problems| problems[0].to_string()).unwrap();
    assert_eq!(push(&again).scenario, push(&loaded).scenario);
    assert!(text.contains("time_step_s"), "defaults are written out");
}

/// A shipped tool.
fn tool(name: &str) -> Tool {
    let file = assets().path(AssetKind::Tool, name).unwrap();
    read_asset(&Source::read(&file).unwrap()).unwrap()
}

/// The tool of a file with these lines about its shape, or the first problem.
fn tool_with(lines: &str) -> Result<Tool, String> {
    let text = format!("name = \"tool\"\nmass_kg = 0.01\nfriction = 0.3\n{lines}");
    read_asset(&Source::new("tool.toml", text)).map_err(|problems| problems[0].to_string())
}

#[test]
fn shipped_tools_are_the_defaults_of_their_families() {
    for (name, family) in [("l", "l"), ("t", "t"), ("hook", "hook"), ("rake", "rake"), ("paddle_flat", "paddle")] {
        let (shipped, default) = (tool(name), tool_with(&format!("family = \"{family}\"")).unwrap());
        assert_eq!((shipped.pieces, shipped.surfaces), (default.pieces, default.surfaces), "{name}");
    }
}

#[test]
fn the_stick_can_be_written_as_a_family() {
    let (pieces, family) = (tool("stick"), tool_with("family.stick = {}").unwrap());
    assert_eq!(pieces.surfaces.len(), family.surfaces.len());
    for (one, other) in pieces.surfaces.iter().zip(&family.surfaces) {
        assert_eq!(one.name, other.name);
        assert!((one.middle().point - other.middle().point).norm() < 1e-15);
        assert!((one.length_m() - other.length_m()).abs() < 1e-15);
    }
}

#[test]
fn a_mistake_in_a_family_points_at_its_key() {
    let expect = [
        (
            "family.hook = { throat_m = 0.020 }",
            "tool.toml:4:28: bad value for `throat_m` in [family.hook]: found 0.02; \
             expected at least 0.026 m: object_radius_m on either side of the disc's center, and play",
        ),
        (
            "family.paddle.face.concave.radius_m = 0.010",
            "tool.toml:4:39: bad value for `radius_m` in [family.paddle.face.concave]: found 0.01; \
             expected at least 0.021053 m: width_m by 1.9, lest the rims end in blades",
        ),
        (
            "family.l = { thickness_mm = 12 }",
            "tool.toml:4:14: unknown key `thickness_mm` in [family.l]: expected one of `arm_m`, `stem_m`, `thickness_m`, \
             `bottom_length_m`, `tip_length_m`, `top_length_m`, `stem_length_m`; \
             lengths are in meters here: write thickness_m = 0.012",
        ),
        (
            "family.hok = {}",
            "tool.toml:4:8: unknown kind `hok` of `family`: expected one of `stick`, `l`, `t`, `hook`, `rake`, `paddle`; \
             did you mean `hook`?",
        ),
        (
            "grip = { position_m = [0.0, 40.0] }\nfamily = \"l\"",
            "tool.toml:4:23: bad value for `position_m` in [grip]: found 40; expected a number from -1 to 1",
        ),
    ];
    for (lines, expected) in expect {
        assert_eq!(tool_with(lines).unwrap_err(), expected);
    }
}

#[test]
fn a_tool_file_without_a_shape_is_told_both_ways_to_state_one() {
    let problem = tool_with("").unwrap_err();
    assert!(problem.contains("either `family`, or `pieces` with `surfaces`"), "{problem}");
}

#[test]
fn a_scenario_may_push_with_another_tool_than_was_shown() {
    let text = changed("asset = \"stick\"", "asset = \"l\"").replace("count = 5", "count = 5\ntool = \"stick\"");
    let source = Source::new("push.toml", text);
    let loaded = resolve(&source, &assets()).map_err(|problems| problems[0].to_string()).unwrap();
    let ResolvedPush { tool, demonstration_tool, .. } = push(&loaded);
    assert_eq!((tool.name.as_str(), demonstration_tool.name.as_str()), ("l", "stick"));
}

#[test]
fn problems_of_unlike_parts_are_listed_together() {
    let text = changed("mass_kg = 0.0054", "mass_kg = -1.0").replace("asset = \"stick\"", "asset = \"stik\"");
    let text = text.replace("tool_frame = \"flange\"", "tool_frame = \"flansch\"").replace("count = 5", "count = 0");
    let found: Vec<String> = problems(&text).iter().map(|problem| problem.title.clone()).collect();
    let expected = [
        "bad value for `mass_kg` in [object]",
        "unknown tool in `asset` in [tool]",
        "unknown frame in `tool_frame` in [robot]",
        "bad value for `count` in [demonstrations.synthetic]",
    ];
    assert_eq!(found, expected);
}

#[test]
fn a_box_too_large_for_the_map_is_told_so() {
    let text = changed("shape.disc = { radius_m = 0.012 }", "shape.box = { width_m = 0.5, height_m = 0.01 }");
    let found = problems(&text);
    assert!(found.iter().all(|problem| problem.expected == "an object smaller than the map"), "{found:?}");
}

#[test]
fn the_object_may_touch_the_border_but_not_cross_it() {
    // disc of radius 12 mm, border at -90 mm
    assert!(problems(&changed("goal_m = [-0.055, 0.125]", "goal_m = [-0.077, 0.125]")).is_empty());
    let found = problems(&changed("goal_m = [-0.055, 0.125]", "goal_m = [-0.079, 0.125]"));
    assert!(found[0].to_string().contains("reaches 0.0010 m beyond the map"), "{}", found[0]);
}

/// The only problem of a text.
fn only_problem(text: &str) -> String {
    let found = problems(text);
    assert_eq!(found.len(), 1, "{found:?}");
    found[0].to_string()
}

/// All kinds of tasks, as messages list them.
fn kinds() -> String {
    let names: Vec<String> = crate::tasks::TASKS.iter().map(|kind| format!("`{}`", kind.name)).collect();
    format!("one of {}", names.join(", "))
}

#[test]
fn a_task_of_no_known_kind_is_told_before_anything_else_is_looked_at() {
    // nothing that stands beside it can be wrong as long as its shape is not known
    let text = changed("[task.push]", "[task.pusch]").replace("mass_kg", "mas_kg");
    let expected =
        format!("push.toml:42:7: unknown kind `pusch` of `task`: expected {}; did you mean `push`?", kinds());
    assert_eq!(only_problem(&text), expected);
}

#[test]
fn a_scenario_without_a_task_or_with_several_is_told_what_to_write() {
    let none = only_problem("[scenario]\ntitle = \"nothing\"\n[task]\n");
    let expected = |place: &str| {
        let expected = format!("found none; expected {}; write for example [task.push]", kinds());
        format!("{place}: `task` needs exactly one kind: {expected}")
    };
    assert_eq!(none, expected("push.toml:3:1"));
    let several = only_problem("[task.push]\nstart_m = [0, 0]\n[task.scoop]\n");
    assert!(several.contains("`task` needs exactly one kind: found `push`, `scoop`"), "{several}");
    let missing = only_problem("[scenario]\ntitle = \"nothing\"\n");
    assert_eq!(missing, expected("push.toml:1:1"));
}

#[test]
fn a_misspelled_table_of_the_task_is_found_although_it_says_which_shape_the_file_has() {
    let found = only_problem(&changed("[task.push]", "[tusk.push]"));
    assert!(found.contains("unknown key `tusk`") && found.contains("did you mean `task`?"), "{found}");
}

/// A scenario of another shape than a push: of an arm that stands still.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Still {
    scenario: Header,
    robot: RobotConfig,
    controller: ControllerConfig,
    #[serde(rename = "task")]
    _task: StillTable,
    #[serde(default)]
    recording: RecordingConfig,
}

#[derive(Deserialize)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
enum StillTable {
    Still {},
}

impl ScenarioFile for Still {
    fn header(&self) -> &Header {
        &self.scenario
    }

    fn header_mut(&mut self) -> &mut Header {
        &mut self.scenario
    }

    fn arm(&self) -> ArmKeys<'_> {
        self.robot.keys(&self.controller)
    }

    fn recording(&self) -> &RecordingConfig {
        &self.recording
    }

    fn refused_values(&self) -> Vec<FieldError> {
        self.scenario.validate().err().into_iter().collect()
    }
}

impl ReadScenario for Still {
    fn resolve(self, _: &mut Reader<'_>, _: &[FieldError]) -> Option<ResolvedTask> {
        None
    }
}

#[test]
fn a_scenario_has_the_shape_of_its_task_and_its_arm_is_checked_all_the_same() {
    let problems = |frame: &str, rest: &str| {
        let text = format!(
            "[scenario]\ntitle = \"still\"\n[robot]\nasset = \"planar_3r\"\ntool_frame = \"{frame}\"\n\
             [controller.impedance]\ndamping_nm_s_per_rad = [1.0, 1.0]\n[task.still]\n{rest}"
        );
        let source = Source::new("still.toml", text);
        let found = load_as::<Still>(&source, &source, &assets()).map(drop).unwrap_err();
        found.iter().map(|problem| problem.title.clone()).collect::<Vec<_>>()
    };
    let gains = "bad value for `damping_nm_s_per_rad` in [controller.impedance]";
    assert_eq!(problems("flange", ""), [gains], "a push would miss its world");
    assert_eq!(
        problems("hand", "[world]\n"),
        ["unknown frame in `tool_frame` in [robot]", gains, "unknown key `world` in the file"]
    );
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 200, failure_persistence: None, ..ProptestConfig::default() })]

    /// Whatever stands in the file, loading ends in a scenario or in problems that can be printed.
    #[test]
    fn random_damage_never_panics(damage in prop::collection::vec((any::<prop::sample::Index>(), 0_usize..20, ".{0,6}"), 1..6)) {
        let mut text: Vec<char> = shipped().chars().collect();
        for (place, removed, inserted) in damage {
            let start = place.index(text.len());
            let end = (start + removed).min(text.len());
            text.splice(start..end, inserted.chars());
            if text.is_empty() {
                break;
            }
        }
        for problem in problems(&text.into_iter().collect::<String>()) {
            prop_assert!(!problem.render(false).is_empty() && !problem.render(true).is_empty());
            prop_assert!(!problem.to_string().is_empty());
        }
    }

    /// Swapping values between keys finds other paths through the checks than damage to single letters.
    #[test]
    fn swapped_values_never_panic(pairs in prop::collection::vec((any::<prop::sample::Index>(), any::<prop::sample::Index>()), 1..4)) {
        let mut lines: Vec<String> = shipped().lines().map(str::to_owned).collect();
        for (first, second) in pairs {
            let (first, second) = (first.index(lines.len()), second.index(lines.len()));
            let (Some((key, _)), Some((_, value))) = (lines[first].split_once('='), lines[second].split_once('=')) else {
                continue;
            };
            lines[first] = format!("{key}={value}");
        }
        for problem in problems(&lines.join("\n")) {
            prop_assert!(!problem.render(false).is_empty());
        }
    }
}
