//! Items and tests in the text of a Rust file, and the tables that name them.

/// First part of `item` (`Type::method`, `Enum::Variant`, `function`) that `text` does not define.
pub fn missing(text: &str, item: &str) -> Option<String> {
    item.split("::").find(|part| !text.lines().any(|line| defines(line, part))).map(str::to_owned)
}

/// Whether a line defines `name`: an item, a variant of an enum, a field, or the head of an `impl` block of it.
fn defines(line: &str, name: &str) -> bool {
    let line = line.trim_start();
    if line.starts_with("//") {
        return false;
    }
    let words: Vec<&str> = line.split(|letter: char| !(letter.is_alphanumeric() || letter == '_')).collect();
    let kinds = ["fn", "struct", "enum", "trait", "const", "static", "type", "mod", "impl", "for"];
    let item = words.windows(2).any(|pair| kinds.contains(&pair[0]) && pair[1] == name);
    let rest = line.strip_prefix("pub ").unwrap_or(line).strip_prefix(name);
    item || rest.is_some_and(|rest| [",", "(", " {", ": "].iter().any(|next| rest.starts_with(next)))
}

/// Whether `text` has a test function `name`: `#[test]` stands above it, with nothing but attributes in between.
pub fn is_test(text: &str, name: &str) -> bool {
    let lines: Vec<&str> = text.lines().map(str::trim).collect();
    let head = format!("fn {name}(");
    let found = lines.iter().position(|line| line.starts_with(&head));
    let above = found.map(|at| lines[..at].iter().rev().take_while(|line| line.starts_with('#')));
    above.is_some_and(|mut above| above.any(|line| *line == "#[test]"))
}

/// Rows of all tables whose last column is headed `Test`: their first cell, and the tests in the last one.
pub fn rows_with_tests(document: &str) -> Vec<(String, Vec<String>)> {
    let mut rows = Vec::new();
    let mut inside = false;
    for line in document.lines() {
        let cells: Vec<&str> = line.trim().trim_matches('|').split('|').map(str::trim).collect();
        if !line.starts_with('|') {
            inside = false;
        } else if cells.last() == Some(&"Test") {
            inside = true;
        } else if inside && !line.starts_with("|-") {
            let tests = cells.last().unwrap_or(&"").split('`').skip(1).step_by(2).filter(|code| code.contains("::"));
            rows.push((cells.first().unwrap_or(&"").to_string(), tests.map(str::to_owned).collect()));
        }
    }
    rows
}

#[test]
fn definitions_are_told_from_mentions() {
    let text =
        "/// Width of a Thing.\npub struct Thing {\n    pub width: f64,\n}\nimpl Thing {\n    fn area(&self) {}\n}\n";
    for item in ["Thing", "Thing::area", "Thing::width"] {
        assert_eq!(missing(text, item), None, "{item}");
    }
    assert_eq!(missing(text, "Thing::volume").as_deref(), Some("volume"));
    assert_eq!(missing(text, "Width").as_deref(), Some("Width"));
}

#[test]
fn only_functions_under_the_attribute_are_tests() {
    let text = "fn helper() {}\n#[test]\nfn first() {}\n#[test]\n#[ignore]\nfn second() {}\n";
    assert_eq!(["helper", "first", "second", "third"].map(|name| is_test(text, name)), [false, true, true, false]);
}
