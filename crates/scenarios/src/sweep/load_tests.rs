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
    assert!(problem.contains("push.toml:") && problem.contains("found -0.4"), "{problem}");
    let text = format!("{HEAD}[[factor]]\nkey = \"object.mas_kg\"\nvalues = [0.2, 0.4]\n");
    let problem = refused(&text).remove(0);
    assert!(problem.starts_with("a.toml:4:7: ") && problem.contains("did you mean `mass_kg`?"), "{problem}");
    let text = format!(
        "{HEAD}[design.random]\npoints = 4\n[[factor]]\nkey = \"tool.asset:friction\"\nuniform = {{ min = -2.0, max = -1.0 }}\n"
    );
    let problem = refused(&text).remove(0);
    assert!(problem.starts_with("a.toml:6:7: "), "{problem}");
}

#[test]
fn sweeps_are_told_from_scenarios() {
    assert!(is_sweep(Path::new(&format!("{PROJECT}/scenarios/sweeps/push_friction.toml"))));
    assert!(!is_sweep(Path::new(&format!("{PROJECT}/scenarios/push_stick.toml"))));
    assert!(!is_sweep(Path::new("nowhere.toml")));
}
