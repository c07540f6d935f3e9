//! Tests of reading sweep files: places of mistakes, and what is planned.

use super::*;

const PROJECT: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../..");

fn assets() -> Assets {
    Assets::at(format!("{PROJECT}/assets"))
}

/// Reads a sweep of the shipped push, and plans it.
fn planned(text: &str) -> Result<(Sweep, Manifest), Vec<String>> {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("a.toml");
    std::fs::copy(format!("{PROJECT}/scenarios/push_stick.toml"), folder.path().join("push.toml")).unwrap();
    std::fs::write(&file, text).unwrap();
    let lines = |problems: Vec<Diagnostic>| {
        let prefix = format!("{}/", folder.path().display());
        problems.iter().map(|problem| problem.to_string().replace(&prefix, "")).collect::<Vec<_>>()
    };
    let sweep = load_sweep(&file, &|_| assets()).map_err(lines)?;
    let manifest = sweep.plan(&assets(), &|_, _| {}).map_err(lines)?;
    Ok((sweep, manifest))
}

fn refused(text: &str) -> Vec<String> {
    planned(text).map(|_| ()).unwrap_err()
}

const HEAD: &str = "[sweep]\nscenario = \"push.toml\"\n";

#[test]
fn each_point_is_run_under_the_same_seeds() {
    let text = format!(
        "{HEAD}trials = 3\nfirst_seed = 5\n[[factor]]\nkey = \"object.table_friction\"\nvalues = [0.2, 0.4]\n\
         [[factor]]\nkey = \"tool.asset\"\nvalues = [\"stick\"]\n"
    );
    let (sweep, manifest) = planned(&text).unwrap();
    assert_eq!((sweep.name.as_str(), manifest.runs.len()), ("a", 6));
    let found: Vec<_> = manifest.runs.iter().map(|run| (run.values[0].as_float().unwrap(), run.seed)).collect();
    assert_eq!(found, [(0.2, 5), (0.2, 6), (0.2, 7), (0.4, 5), (0.4, 6), (0.4, 7)]);
    let mut ids: Vec<_> = manifest.runs.iter().map(|run| run.run_id.clone()).collect();
    ids.sort();
    ids.dedup();
    assert_eq!(ids.len(), 6, "every run has an identity of its own");
}

#[test]
fn without_factors_there_is_one_point_with_the_seed_of_the_scenario() {
    let (_, manifest) = planned(HEAD).unwrap();
    assert_eq!((manifest.runs.len(), manifest.runs[0].seed), (1, 1));
}

#[test]
fn mistakes_are_shown_where_they_stand() {
    let factor = "[[factor]]\nkey = \"object.table_friction\"\n";
    let expect = [
        (format!("{HEAD}trial = 2\n"), "a.toml:3:1: unknown key `trial` in [sweep]"),
        (format!("{HEAD}trials = 0\n"), "a.toml:3:10: bad value for `trials` in [sweep]: found 0"),
        ("[sweep]\n".to_owned(), "a.toml:1:1: missing key `scenario` in [sweep]"),
        (format!("{HEAD}[design.sobl]\npoints = 4\n"), "a.toml:3:9: unknown kind `sobl` of `design`"),
        (format!("{HEAD}[design.sobol]\n{factor}values = [0.2]\n"), "a.toml:3:1: missing key `points`"),
        (
            format!("{HEAD}[design.random]\npoints = 4\n"),
            "a.toml:4:10: bad value for `points` in [design.random]: found no [[factor]]",
        ),
        (
            format!("{HEAD}{factor}"),
            "a.toml:4:7: bad value for `key` in entry 1 of [[factor]]: found no values; expected exactly one of `values`",
        ),
        (
            format!("{HEAD}{factor}values = [0.2]\nuniform = {{ min = 0.1, max = 0.2 }}\n"),
            "a.toml:6:11: bad value for `uniform`",
        ),
        (
            format!("{HEAD}{factor}uniform = {{ min = 0.3, max = 0.2 }}\nlevels = 2\n"),
            "a.toml:5:30: bad value for `max`",
        ),
        (
            format!("{HEAD}{factor}uniform = {{ min = 0.1, max = 0.2 }}\n"),
            "expected how many values of the range the grid takes",
        ),
        (
            format!("{HEAD}[design.random]\npoints = 2\n{factor}levels = 4\nuniform = {{ min = 0.1, max = 0.2 }}\n"),
            "a.toml:7:10: bad value for `levels`",
        ),
        (format!("{HEAD}{factor}values = [0.2, 0.2]\n"), "a.toml:5:16: bad value for entry 2 of `values`"),
        (format!("{HEAD}{factor}values = [0.2, nan]\n"), "a.toml:5:16: bad value for entry 2 of `values`"),
        (
            format!("{HEAD}{factor}values = [0.2]\n{factor}values = [0.3]\n"),
            "a.toml:7:7: bad value for `key` in entry 2 of [[factor]]: found the key of another factor",
        ),
        (
            format!("{HEAD}[[factor]]\nkey = \"scenario.seed\"\nvalues = [1]\n"),
            "`trials` and `first_seed` in [sweep] say which seeds are run",
        ),
        (format!("{HEAD}[[factor]]\nkey = \"a..b\"\nvalues = [1]\n"), "a.toml:4:7: bad value for `key`"),
        (
            format!("{HEAD}trials = 100000\n[design.sobol]\npoints = 100000\n{factor}values = [1]\n"),
            "expected at most 1000000 runs",
        ),
        (format!("{HEAD}[sweep\n"), "this is not valid TOML"),
        (
            "[sweep]\nscenario = \"pusch.toml\"\n".to_owned(),
            "a.toml:2:12: pusch.toml cannot be used: there is no such file",
        ),
    ];
    for (text, expected) in expect {
        let problems = refused(&text);
        assert!(problems[0].contains(expected), "{text}\n{problems:#?}");
        assert_eq!(problems.len(), 1, "{text}\n{problems:#?}");
    }
}

#[test]
fn a_value_that_the_scenario_refuses_is_blamed_on_its_factor() {
    let text = format!("{HEAD}[[factor]]\nkey = \"object.table_friction\"\nvalues = [0.2, -0.4]\n");
    let problem = refused(&text).remove(0);
    assert!(
        problem.starts_with("a.toml:5:16: the scenario cannot be run with object.table_friction = -0.4"),
        "{problem}"
    );
    assert!(
        problem.contains("push.toml with object.table_friction = -0.4: bad value for `table_friction`"),
        "{problem}"
    );
    let text = format!("{HEAD}[[factor]]\nkey = \"object.mas_kg\"\nvalues = [0.2, 0.4]\n");
    let problem = refused(&text).remove(0);
    assert!(problem.starts_with("a.toml:4:7: ") && problem.contains("did you mean `mass_kg`?"), "{problem}");
    assert!(!problem.contains("invalid_points"), "a misspelled key is no bad point: {problem}");
    let text = format!(
        "{HEAD}[design.random]\npoints = 4\n[[factor]]\nkey = \"tool.asset:friction\"\nuniform = {{ min = -2.0, max = -1.0 }}\n"
    );
    let problem = refused(&text).remove(0);
    assert!(problem.starts_with("a.toml:6:7: "), "{problem}");
}

/// Eight points of a friction of which some are below zero.
const DRAWN: &str = "[design.random]\npoints = 8\n[[factor]]\nkey = \"object.table_friction\"\n\
                     uniform = { min = -0.2, max = 0.4 }\n";

#[test]
fn a_drawn_point_that_makes_no_scenario_is_kept_with_its_reason_and_the_others_are_planned() {
    let (_, manifest) = planned(&format!("{HEAD}trials = 2\n{DRAWN}")).unwrap();
    let mut invalid = 0;
    for run in &manifest.runs {
        let friction = run.values[0].as_float().unwrap();
        assert_eq!(run.invalid.is_empty(), friction > 0.0, "{run:?}");
        for reason in &run.invalid {
            invalid += 1;
            assert!(reason.starts_with("push.toml") && reason.contains("`table_friction`"), "{reason}");
        }
    }
    assert!((2..=12).contains(&invalid), "{invalid} of 16: some and not all");
    let mut ids: Vec<_> = manifest.runs.iter().map(|run| run.run_id.clone()).collect();
    ids.sort();
    ids.dedup();
    assert_eq!(ids.len(), 16, "runs without a scenario have identities of their own, too");
    assert_eq!(planned(&format!("{HEAD}trials = 2\n{DRAWN}")).unwrap().1.runs, manifest.runs, "whatever the folder");
}

#[test]
fn whoever_wants_every_point_to_be_valid_is_told_which_is_not_and_how_to_go_on() {
    let problem = refused(&format!("{HEAD}invalid_points = \"refuse\"\n{DRAWN}")).remove(0);
    for part in ["object.table_friction = -0.", " of 8: object.table_friction = -0.", "`invalid_points = \"record\"`"] {
        assert!(problem.contains(part), "{part}: {problem}");
    }
    let grid = "[[factor]]\nkey = \"object.table_friction\"\nvalues = [0.2, -0.4]\n";
    let problem = refused(&format!("{HEAD}{grid}")).remove(0);
    assert!(problem.contains("this is point 2 of 2: object.table_friction = -0.4"), "{problem}");
    let (_, manifest) = planned(&format!("{HEAD}invalid_points = \"record\"\n{grid}")).unwrap();
    assert_eq!(manifest.runs.iter().map(|run| run.invalid.len()).collect::<Vec<_>>(), [0, 1]);
}

#[test]
fn a_sweep_without_any_valid_point_is_refused_however_it_treats_single_ones() {
    let text = format!("{HEAD}[design.sobol]\npoints = 4\n[[factor]]\nkey = \"object.mas_kg\"\nvalues = [0.2, 0.4]\n");
    let problem = refused(&text).remove(0);
    assert!(problem.contains("did you mean `mass_kg`?") && problem.contains("no point of the sweep"), "{problem}");
}

#[test]
fn sweeps_are_told_from_scenarios() {
    assert!(is_sweep(Path::new(&format!("{PROJECT}/scenarios/sweeps/push_friction.toml"))));
    assert!(!is_sweep(Path::new(&format!("{PROJECT}/scenarios/push_stick.toml"))));
    assert!(!is_sweep(Path::new("nowhere.toml")));
}
