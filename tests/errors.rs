//! Every kind of bad input, given to the built program: exit code 2, place, key and suggestion, and nothing written.

mod program;

use std::fs;
use std::path::Path;

use program::{place, project, replaced, shipped, wield};

/// All files and folders below `folder`, sorted.
fn tree(folder: &Path) -> Vec<String> {
    let mut found = Vec::new();
    for entry in fs::read_dir(folder).into_iter().flatten().flatten() {
        found.push(entry.path().display().to_string());
        if entry.path().is_dir() {
            found.extend(tree(&entry.path()));
        }
    }
    found.sort();
    found
}

/// Runs `wield run a.toml` and asserts that it is refused with all `parts` in its message, without a trace on disk.
fn refused(folder: &Path, parts: &[&str]) -> String {
    let before = tree(folder);
    let output = wield(folder, None, &["run", "a.toml"]);
    let message = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(output.status.code(), Some(2), "{message}");
    for part in parts {
        assert!(message.contains(part), "{part:?} is missing in:\n{message}");
    }
    assert!(output.stdout.is_empty() && !message.contains('\u{1b}'), "{message}");
    assert!(!message.contains("panicked"), "{message}");
    assert_eq!(tree(folder), before, "something was written");
    message
}

/// Replaces `from` by `to` in the shipped scenario; the message must point at `at` and hold `parts`.
fn refused_change(from: &str, to: &str, at: &str, parts: &[&str]) -> String {
    let folder = project();
    let text = replaced(&shipped(), from, to);
    assert!(fs::write(folder.path().join("a.toml"), &text).is_ok());
    let place = format!("a.toml:{}", place(&text, at));
    let parts: Vec<&str> = parts.iter().copied().chain([place.as_str()]).collect();
    refused(folder.path(), &parts)
}

#[test]
fn an_unknown_key_suggests_the_nearest() {
    let parts = ["unknown key `mas_kg` in [object]", "did you mean `mass_kg`?"];
    let message = refused_change("mass_kg = 0.0054", "mas_kg = 0.0054", "mas_kg", &parts);
    assert!(!message.contains("missing key"), "the misspelled key is not missing as well:\n{message}");
}

#[test]
fn a_key_in_another_unit_is_converted() {
    let help = "lengths are in meters here: write radius_m = 0.012";
    refused_change("radius_m = 0.012", "radius_mm = 12", "radius_mm", &["`radius_mm` in [object.shape.disc]", help]);
    let help = "masses are in kilograms here: write mass_kg = 0.0054";
    refused_change("mass_kg = 0.0054", "mass_g = 5.4", "mass_g", &["`mass_g` in [object]", help]);
    let help = "lengths are in meters here: write start_m = [0.065, 0.05]";
    refused_change("start_m = [0.065, 0.050]", "start_cm = [6.5, 5]", "start_cm", &["`start_cm` in [task.push]", help]);
}

#[test]
fn numbers_that_are_not_finite_are_refused() {
    for (written, found) in [("nan", "nan"), ("inf", "inf"), ("-inf", "-inf"), ("1e999", "inf")] {
        let change = format!("error_gain_per_s = {written}");
        let found = format!("found {found}; expected a finite number");
        let parts = ["bad value for `error_gain_per_s` in [controller.impedance]", &found];
        refused_change("error_gain_per_s = 3.0", &change, &format!("{written} "), &parts);
    }
    let parts = ["entry 1 of `start_m` in [task.push]", "expected a finite number"];
    refused_change("start_m = [0.065, 0.050]", "start_m = [nan, 0.050]", "nan", &parts);
}

#[test]
fn a_negative_size_is_refused() {
    let parts = ["bad value for `radius_m` in [object.shape.disc]", "found -0.012; expected a number greater than 0"];
    refused_change("radius_m = 0.012", "radius_m = -0.012", "-0.012", &parts);
    let parts = ["`width_m` in `shape.box` of entry 1 of [[world.obstacles]]", "found -0.03"];
    refused_change("width_m = 0.03", "width_m = -0.03", "-0.03", &parts);
}

#[test]
fn a_start_inside_an_obstacle_names_it_and_the_depth() {
    // block from y = 0.08 to 0.12, disc of radius 12 mm: at y = 0.07 it overlaps by 2 mm
    let parts =
        ["`start_m` in [task.push] lies inside the obstacle `block`", "an overlap of 0.0020 m", "`block` stands here"];
    refused_change("start_m = [0.065, 0.050]", "start_m = [0.0, 0.070]", "[0.0, 0.070]", &parts);
    let parts = ["`goal_m` in [demonstrations.synthetic] lies inside the obstacle `block`"];
    refused_change("goal_m = [-0.060, 0.130]", "goal_m = [0.0, 0.11]", "[0.0, 0.11]", &parts);
}

#[test]
fn a_start_or_goal_outside_the_map_is_told_the_range() {
    let parts =
        ["`start_m` in [task.push] lies outside the map", "0.0120 m beyond the map", "x in -0.078 m to 0.078 m"];
    refused_change("start_m = [0.065, 0.050]", "start_m = [0.09, 0.050]", "[0.09, 0.050]", &parts);
    let parts = ["`goal_m` in [task.push] lies outside the map", "y in 0.012 m to 0.168 m"];
    refused_change("goal_m = [-0.055, 0.125]", "goal_m = [-0.055, 1.25]", "[-0.055, 1.25]", &parts);
    let parts = ["`start_m` in [demonstrations.synthetic] lies outside the map"];
    refused_change("start_m = [0.060, 0.055]", "start_m = [6.0, 5.5]", "[6.0, 5.5]", &parts);
}

#[test]
fn a_map_turned_inside_out_is_refused() {
    let parts = ["bad value for `max_m` in [world.map]", "above and to the right of min_m"];
    refused_change("max_m = [0.09, 0.18]", "max_m = [-0.10, 0.18]", "[-0.10, 0.18]", &parts);
}

#[test]
fn an_unknown_asset_lists_what_exists() {
    let parts = ["unknown tool in `asset` in [tool]", "`stick`", "did you mean `stick`?"];
    refused_change("asset = \"stick\"", "asset = \"stik\"", "\"stik\"", &parts);
    let parts = ["unknown robot in `asset` in [robot]", "`panda`", "`planar_3r`"];
    refused_change("asset = \"planar_3r\"", "asset = \"planar3r\"", "\"planar3r\"", &parts);
}

#[test]
fn a_name_that_leads_out_of_the_assets_is_refused() {
    for name in ["../tools/stick", "/etc/passwd", "..\\\\stick", ".stick", "tools/../stick"] {
        let change = format!("asset = \"{name}\"");
        let parts = ["path escaping the project in `asset` in [tool]", "the bare name of a file"];
        refused_change("asset = \"stick\"", &change, &format!("\"{name}\""), &parts);
    }
}

#[cfg(unix)]
#[test]
fn a_link_that_leads_out_of_the_assets_is_refused() {
    let folder = project();
    fs::write(folder.path().join("secret.toml"), "name = \"secret\"").unwrap();
    std::os::unix::fs::symlink("../../secret.toml", folder.path().join("assets/tools/link.toml")).unwrap();
    fs::write(folder.path().join("a.toml"), replaced(&shipped(), "asset = \"stick\"", "asset = \"link\"")).unwrap();
    refused(folder.path(), &["path escaping the project"]);
}

#[test]
fn a_wrong_type_is_said_in_words() {
    let parts =
        ["bad value for `mass_kg` in [object]", "found the text \"0.0054\"; expected a number", "without quotes"];
    refused_change("mass_kg = 0.0054", "mass_kg = \"0.0054\"", "\"0.0054\"", &parts);
    let parts =
        ["bad value for `title` in [scenario]", "found 5; expected a text in quotes", "write it in quotes: \"5\""];
    refused_change("title = \"Push a disc past an obstacle with a stick\"", "title = 5", "5\ndescription", &parts);
    let parts = ["bad value for `count`", "found 2.5; expected a whole number of at least 0"];
    refused_change("count = 5", "count = 2.5", "2.5", &parts);
}

#[test]
fn an_unknown_kind_suggests_the_nearest() {
    let parts = ["unknown kind `elipsoid` of `support` in [object]", "did you mean `ellipsoid`?"];
    refused_change("support = \"ellipsoid\"", "support = \"elipsoid\"", "\"elipsoid\"", &parts);
    let parts = ["unknown kind `pusch` of `task`", "did you mean `push`?"];
    refused_change("[task.push]", "[task.pusch]", "pusch", &parts);
}

#[test]
fn a_missing_key_names_its_table_and_shows_an_example() {
    let parts = ["missing key `mass_kg` in [object]", "write for example: mass_kg = 0.0054"];
    refused_change("mass_kg = 0.0054", "", "[object]", &parts);
    let parts = ["missing key `position_m` in entry 1 of [[world.obstacles]]", "position_m = [0.0, 0.10]"];
    refused_change("position_m = [0.0, 0.10]", "", "[[world.obstacles]]", &parts);
}

#[test]
fn a_missing_table_is_shown() {
    let folder = project();
    let text = replaced(&replaced(&shipped(), "[tool]\n", ""), "asset = \"stick\"\n", "");
    fs::write(folder.path().join("a.toml"), text).unwrap();
    refused(folder.path(), &["missing table [tool]", "asset = \"stick\""]);
}

#[test]
fn a_list_of_another_length_is_counted() {
    let parts = ["`start_m` in [task.push]", "found a list of 3 values; expected a list of 2 values"];
    refused_change("start_m = [0.065, 0.050]", "start_m = [0.065, 0.050, 0.0]", "[0.065, 0.050, 0.0]", &parts);
    let parts = ["`damping_nm_s_per_rad` in [controller.impedance]", "found 2 numbers", "`joint1`, `joint2`, `joint3`"];
    refused_change("[10.0, 10.0, 10.0]", "[10.0, 11.0]", "[10.0, 11.0]", &parts);
    let parts = ["`rotor_inertia_kg_m2` in [robot]", "found 4 numbers; expected 3 numbers"];
    refused_change("[0.01, 0.01, 0.01]", "[0.01, 0.01, 0.01, 0.01]", "[0.01, 0.01, 0.01, 0.01]", &parts);
}

#[test]
fn an_unknown_frame_suggests_the_nearest() {
    let parts = ["unknown frame in `tool_frame` in [robot]", "`link3`", "did you mean `flange`?"];
    refused_change("tool_frame = \"flange\"", "tool_frame = \"flang\"", "\"flang\"", &parts);
}

#[test]
fn an_unknown_contact_surface_suggests_the_nearest() {
    let parts = ["entry 1 of `surfaces` in [demonstrations.synthetic]", "`side`, `head`", "did you mean `side`?"];
    refused_change("surfaces = [\"side\"", "surfaces = [\"sid\"", "\"sid\"", &parts);
}

#[test]
fn a_recording_faster_than_the_control_loop_is_refused() {
    let parts = ["bad value for `rate_hz` in [recording]", "the control rate is 1000 Hz"];
    refused_change("[limits]", "[recording]\nrate_hz = 2000.0\n\n[limits]", "2000.0", &parts);
}

#[test]
fn a_syntax_error_has_its_place() {
    refused_change("mass_kg = 0.0054", "mass_kg == 0.0054", "= 0.0054", &["this is not valid TOML"]);
    refused_change("[object]\n", "[object\n", "\nname = \"disc\"", &["this is not valid TOML", "expected `]`"]);
}

#[test]
fn a_mistake_in_a_tool_points_into_the_tools_file() {
    let folder = project();
    let tool = folder.path().join("assets/tools/stick.toml");
    let text = replaced(&fs::read_to_string(&tool).unwrap(), "friction = 0.30", "friction = -0.30");
    fs::write(&tool, &text).unwrap();
    fs::write(folder.path().join("a.toml"), shipped()).unwrap();
    let place = format!("stick.toml:{}", place(&text, "-0.30"));
    refused(folder.path(), &[&place, "bad value for `friction`", "names this file: `asset` in [tool]"]);
}

#[test]
fn a_mistake_in_a_robot_points_into_the_robots_file() {
    let folder = project();
    let robot = folder.path().join("assets/robots/planar_3r.urdf");
    let text = replaced(&fs::read_to_string(&robot).unwrap(), "<link name=\"flange\"/>", "");
    fs::write(&robot, &text).unwrap();
    fs::write(folder.path().join("a.toml"), shipped()).unwrap();
    let place = format!("planar_3r.urdf:{}", place(&text, "name=\"flange_mount\""));
    refused(folder.path(), &[&place, "the robot cannot be used", "flange"]);
}

#[test]
fn a_flaw_of_a_robots_text_points_to_its_line() {
    let folder = project();
    let robot = folder.path().join("assets/robots/planar_3r.urdf");
    let text = replaced(&fs::read_to_string(&robot).unwrap(), "<link name=\"flange\"/>", "<link nme=\"flange\"/>");
    fs::write(&robot, &text).unwrap();
    fs::write(folder.path().join("a.toml"), shipped()).unwrap();
    let place = format!("planar_3r.urdf:{}", place(&text, "<link nme=\"flange\"/>"));
    refused(folder.path(), &[&place, "the robot cannot be used", "<link> of the robot has no `name`"]);
}

#[test]
fn a_name_that_no_folder_could_have_is_refused() {
    let parts = ["bad value for `name` in [scenario]", "expected letters, digits, `_` and `-` only"];
    refused_change("seed = 1\n", "seed = 1\nname = \"../up\"\n", "\"../up\"", &parts);
}

#[test]
fn gains_that_sampling_makes_unstable_are_refused() {
    let folder = project();
    let text = replaced(&shipped(), "[10.0, 10.0, 10.0]", "[30.0, 30.0, 30.0]");
    assert!(fs::write(folder.path().join("a.toml"), text).is_ok());
    let parts =
        ["controller.impedance.damping_nm_s_per_rad", "expected a stable loop", "inertia at joint `joint3`", "a.toml"];
    refused(folder.path(), &parts);
}

#[test]
fn all_problems_are_listed_at_once() {
    let folder = project();
    let text = replaced(&shipped(), "mass_kg = 0.0054", "mass_kg = -1");
    let text = replaced(&text, "count = 5", "count = 5\ncolour = \"red\"");
    let text = replaced(&text, "asset = \"stick\"", "asset = \"spoon\"");
    fs::write(folder.path().join("a.toml"), text).unwrap();
    refused(folder.path(), &["`mass_kg`", "`colour`", "\"spoon\""]);
}

#[test]
fn files_that_are_no_text_are_refused() {
    let folder = project();
    fs::write(folder.path().join("a.toml"), b"[scenario]\ntitle = \"\xff\"\n").unwrap();
    refused(folder.path(), &["a.toml:2:10", "not UTF-8", "byte 0xff"]);
    fs::write(folder.path().join("a.toml"), "").unwrap();
    refused(folder.path(), &["the file is empty"]);
}

#[test]
fn a_folder_or_a_missing_file_is_refused() {
    let folder = project();
    fs::write(folder.path().join("aa.toml"), shipped()).unwrap();
    refused(folder.path(), &["a.toml", "there is no such file", "did you mean `aa.toml`?"]);
    fs::create_dir(folder.path().join("a.toml")).unwrap();
    refused(folder.path(), &["this is a folder"]);
}

#[test]
fn without_assets_the_way_to_name_them_is_told() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("a.toml"), shipped()).unwrap();
    refused(folder.path(), &["unknown tool", "--assets DIR", "WIELD_ASSETS"]);
}

#[test]
fn check_tells_all_problems_of_all_files() {
    let folder = project();
    fs::write(folder.path().join("good.toml"), shipped()).unwrap();
    fs::write(folder.path().join("bad.toml"), replaced(&shipped(), "count = 5", "count = 0")).unwrap();
    let output = wield(folder.path(), None, &["check", "good.toml", "bad.toml", "none.toml"]);
    let (told, problems) = (String::from_utf8(output.stdout).unwrap(), String::from_utf8(output.stderr).unwrap());
    assert_eq!((output.status.code(), told.as_str()), (Some(2), "ok good.toml\n"), "{problems}");
    for part in ["bad value for `count`", "none.toml", "there is no such file", "2 of 3 files cannot be run"] {
        assert!(problems.contains(part), "{part:?} is missing in:\n{problems}");
    }
}

/// What is said of a scenario that options change, on one line.
fn refused_options(options: &[&str]) -> String {
    let folder = project();
    assert!(fs::write(folder.path().join("a.toml"), shipped()).is_ok());
    let sets = options.iter().flat_map(|option| ["--set", option]);
    let arguments: Vec<&str> = ["check", "a.toml"].into_iter().chain(sets).collect();
    let output = wield(folder.path(), None, &arguments);
    assert_eq!(output.status.code(), Some(2), "{options:?}");
    String::from_utf8_lossy(&output.stderr).into_owned()
}

#[test]
fn a_value_that_an_option_gave_is_blamed_on_the_option_and_not_on_a_line() {
    let expect = [
        (
            &["object.mass_kg=-1"][..],
            "--> a.toml --set object.mass_kg=-1\n",
            "found -1; expected a number greater than 0",
        ),
        (&["object.mas_kg=1"], "--> a.toml --set object.mas_kg=1\n", "did you mean `mass_kg`?"),
        (&["tool.asset=stik"], "--> a.toml --set tool.asset=stik\n", "did you mean `stick`?"),
        (&["controller=impedence"], "--> a.toml --set controller=impedence\n", "did you mean `impedance`?"),
        // a value inside a table that an option gave as a whole
        (
            &["controller={ impedance = { error_gain_per_s = 0.0 } }"],
            "--> a.toml --set controller={ impedance = { error_gain_per_s = 0.0 } }\n",
            "expected a number greater than 0",
        ),
        // in the file that a key names
        (
            &["tool.asset:friction=-2"],
            "--> a.toml --set tool.asset:friction=-2\n",
            "names this file: `asset` in [tool]",
        ),
        // the last of two options for the same key
        (&["object.mass_kg=-1", "object.mass_kg=-2"], "--> a.toml --set object.mass_kg=-2\n", "the file is read with"),
    ];
    for (options, place, part) in expect {
        let said = refused_options(options);
        assert!(said.contains(place) && said.contains(part), "{options:?}: {said}");
        assert!(!said.contains("a.toml:") || options[0].starts_with("tool.asset:"), "no line is blamed: {said}");
    }
}

#[test]
fn a_value_of_the_file_is_shown_at_its_place_in_the_file_whatever_options_change() {
    let folder = project();
    let text = replaced(&shipped(), "mass_kg = 0.0054", "mass_kg = -0.0054");
    fs::write(folder.path().join("a.toml"), &text).unwrap();
    // longer values above, keys that are not there, and a change of the same table
    let options = [
        "scenario.title=\"a title that is longer than the one which stands there\"",
        "scenario.description=\"x\"",
        "object.table_friction=0.31234",
        "execution.settle_s=0.5",
    ];
    let sets = options.iter().flat_map(|option| ["--set", option]);
    let arguments: Vec<&str> = ["check", "a.toml"].into_iter().chain(sets).collect();
    let output = wield(folder.path(), None, &arguments);
    assert_eq!(output.status.code(), Some(2));
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    let expected = format!("a.toml:{}", place(&text, "-0.0054"));
    assert!(said.contains(&expected), "expected {expected} in: {said}");
}
