//! Changes of single keys, put into a scenario's text before it is read: for sweeps, comparisons and `--set`.
//!
//! A key is a dotted path, `object.mass_kg` or `world.obstacles.0.position_m`. With a colon it goes on in the file that
//! the value names: `tool.asset:family.l.arm_m` is the arm's length in the tool that `tool.asset` names. Such changes are
//! kept in the scenario itself, in its table `scenario.asset_changes`, so that its text says all that a run depends on.

use std::collections::BTreeMap;
use std::fmt;
use std::path::Path;
use std::str::FromStr;

use serde::{Deserialize, Serialize};
use toml_edit::{DocumentMut, InlineTable, Item, Table, TableLike, value};

use super::given::Given;
use super::source::Source;
use crate::diagnostic::Diagnostic;

/// Divides the key of a scenario from the key in the asset that its value names.
pub(crate) const INTO_ASSET: char = ':';

/// A key and the value that it is to have.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Change {
    /// Dotted path of the key; after a colon, that in the asset which the value before it names.
    pub key: String,
    /// The value.
    pub value: toml::Value,
}

impl Change {
    /// A change of `key` to `value`.
    pub fn new(key: impl Into<String>, value: impl Into<toml::Value>) -> Self {
        Self { key: key.into(), value: value.into() }
    }
}

impl fmt::Display for Change {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} = {}", self.key, self.value)
    }
}

impl Change {
    /// The option that makes this change, as it is written in a shell: texts that are bare words without quotes.
    fn as_option(&self) -> String {
        let bare = |text: &str| parse_value(text).is_ok_and(|value| value.as_str() == Some(text));
        match &self.value {
            toml::Value::String(text) if bare(text) => format!("--set {}={text}", self.key),
            value => format!("--set {}={value}", self.key),
        }
    }
}

/// How a user made changes, which problems with them name.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum GivenBy {
    /// The values of a file or of an option for several values at once.
    Values,
    /// The option `--set`.
    Option,
}

impl GivenBy {
    /// The words by which the user knows a change of a file.
    pub(super) fn words(self, file: &Path, change: &Change) -> String {
        match self {
            Self::Values => format!("{} with {change}", file.display()),
            Self::Option => format!("{} {}", file.display(), change.as_option()),
        }
    }
}

impl FromStr for Change {
    type Err = String;

    /// Reads `KEY=VALUE`.
    ///
    /// # Errors
    /// In words, if there is no key or no value.
    fn from_str(text: &str) -> Result<Self, String> {
        let (key, value) = text.split_once('=').ok_or_else(|| format!("found {text:?}; expected KEY=VALUE"))?;
        check_key(key.trim())?;
        Ok(Self { key: key.trim().to_owned(), value: parse_value(value.trim())? })
    }
}

/// Reads a value as it is written in TOML; a bare word is a text.
///
/// # Errors
/// In words, if it is neither.
pub fn parse_value(text: &str) -> Result<toml::Value, String> {
    #[derive(Deserialize)]
    struct Holder {
        value: toml::Value,
    }
    if let Ok(Holder { value }) = toml::from_str(&format!("value = {text}")) {
        return Ok(value);
    }
    let bare = !text.is_empty() && text.chars().all(|letter| letter.is_alphanumeric() || "_-./".contains(letter));
    if bare {
        return Ok(toml::Value::String(text.to_owned()));
    }
    Err(format!("found the value {text:?}; expected a TOML value: a number, true, \"text\" or [a, list]"))
}

/// Refuses keys that are no dotted path.
///
/// # Errors
/// In words.
pub fn check_key(key: &str) -> Result<(), String> {
    let (own, in_asset) = key.split_once(INTO_ASSET).map_or((key, None), |(own, rest)| (own, Some(rest)));
    let whole = |part: &str| part.split('.').all(|step| !step.is_empty() && step.chars().all(is_in_key));
    if whole(own) && in_asset.is_none_or(whole) {
        return Ok(());
    }
    Err(format!("found the key {key:?}; expected a dotted path such as object.mass_kg or tool.asset:mass_kg"))
}

fn is_in_key(letter: char) -> bool {
    letter.is_alphanumeric() || letter == '_' || letter == '-'
}

/// The source with the values of some keys changed, each change with the words by which its user knows it; problems at
/// what they put there name these.
///
/// # Errors
/// As [`with`].
pub(crate) fn changed(source: &Source, changes: Vec<(Change, String)>) -> Result<Source, Box<Diagnostic>> {
    if changes.is_empty() {
        return Ok(source.clone());
    }
    let bare: Vec<Change> = changes.iter().map(|(change, _)| change.clone()).collect();
    let text = with(source, &bare)?.text.to_string();
    Ok(Source::changed(text, Given::new(source.clone(), changes)))
}

/// The source with the values of some keys changed; keys that were not there are added.
///
/// A text that is no TOML is returned as it is: whoever reads it finds out.
///
/// # Errors
/// A [`Diagnostic`] if a key leads through something that has no keys.
pub(crate) fn with(source: &Source, changes: &[Change]) -> Result<Source, Box<Diagnostic>> {
    let Ok(mut document) = source.text.parse::<DocumentMut>() else { return Ok(source.clone()) };
    for change in changes {
        set(document.as_item_mut(), &path_in_text(&change.key), &change.value).map_err(|obstacle| {
            let problem = Diagnostic::of_file(&source.file, format!("`{}` cannot be changed", change.key));
            Box::new(problem.found(obstacle).expected("the path of a key through tables and lists"))
        })?;
    }
    Ok(Source::new(&source.file, document.to_string()))
}

/// Where a changed value stands in the text: one in an asset is kept in a table of the scenario.
pub(super) fn path_in_text(key: &str) -> Vec<&str> {
    match key.split_once(INTO_ASSET) {
        None => key.split('.').collect(),
        Some(_) => vec!["scenario", "asset_changes", key],
    }
}

/// An asset's source with the changes that a scenario makes in it: those of `changes` whose keys begin with `key:`.
///
/// # Errors
/// As [`changed`].
pub(crate) fn changed_asset(
    source: &Source,
    key: &str,
    changes: &BTreeMap<String, toml::Value>,
    scenario: &Source,
) -> Result<Source, Box<Diagnostic>> {
    let inside = |(whole, value): (&String, &toml::Value)| {
        let (own, rest) = whole.split_once(INTO_ASSET)?;
        let stated = || format!("{}, [scenario.asset_changes] \"{whole}\" = {value}", scenario.file.display());
        let words = || scenario.words_for(whole).map_or_else(stated, str::to_owned);
        (own == key).then(|| (Change::new(rest, value.clone()), words()))
    };
    changed(source, changes.iter().filter_map(inside).collect())
}

/// Sets the value at `path`; the error says what stands in the way.
fn set(item: &mut Item, path: &[&str], to: &toml::Value) -> Result<(), String> {
    let Some((step, rest)) = path.split_first() else {
        *item = replacement(item, to)?;
        return Ok(());
    };
    // a kind that is named without options is a text: its options come with the first change of one
    if item.as_str() == Some(step) {
        let mut kind = InlineTable::new();
        kind.insert(*step, InlineTable::new().into());
        *item = value(kind);
    }
    if let Some(next) = entry(item, step)? {
        return set(next, rest, to);
    }
    let found = item.type_name();
    Err(format!("a value of type {found} before `{step}`"))
}

/// The entry `step` of a table or list, made if a table has none.
fn entry<'a>(item: &'a mut Item, step: &str) -> Result<Option<&'a mut Item>, String> {
    if item.is_none() {
        let mut table = Table::new();
        table.set_implicit(true);
        *item = Item::Table(table);
    }
    if item.is_table_like() {
        let table: Option<&mut dyn TableLike> = item.as_table_like_mut();
        return Ok(table.map(|table| table.entry(step).or_insert(Item::None)));
    }
    if !item.is_array() && !item.is_array_of_tables() {
        return Ok(None);
    }
    let index: usize = step.parse().map_err(|_| format!("`{step}` in a list; its entries are 0, 1, …"))?;
    item.get_mut(index).map(Some).ok_or_else(|| format!("no entry {index} in the list"))
}

/// The new item in the place of `old`: a bare name in the place of a table that names an asset changes that name.
fn replacement(old: &Item, to: &toml::Value) -> Result<Item, String> {
    let names_asset = old.as_table_like().is_some_and(|table| table.contains_key("asset"));
    if let (true, toml::Value::String(name)) = (names_asset, to) {
        let mut table = old.clone();
        if let Some(entries) = table.as_table_like_mut() {
            entries.insert("asset", value(name.as_str()));
        }
        return Ok(table);
    }
    let written = to.to_string().parse::<toml_edit::Value>().map_err(|error| error.to_string())?;
    Ok(value(written))
}

#[cfg(test)]
mod tests {
    use super::*;

    const TEXT: &str = "a = 1 # one\n[tool]\nasset = \"stick\"\n[[list]]\nx = [1.0, 2.0]\n[kind]\nplain = \"none\"\n";

    fn with(changes: &[&str]) -> Result<toml::Table, String> {
        let changes: Vec<Change> = changes.iter().map(|text| text.parse().unwrap()).collect();
        let source = Source::new("a.toml", TEXT);
        super::with(&source, &changes).map(|source| source.text.parse().unwrap()).map_err(|problem| problem.to_string())
    }

    #[test]
    fn values_are_replaced_where_they_stand() {
        let table = with(&["a=2.5", "list.0.x.1=7", "tool.asset=l", "new.deep.key=true"]).unwrap();
        assert_eq!(table["a"].as_float(), Some(2.5));
        assert_eq!(table["list"][0]["x"][1].as_integer(), Some(7));
        assert_eq!(table["tool"]["asset"].as_str(), Some("l"));
        assert_eq!(table["new"]["deep"]["key"].as_bool(), Some(true));
    }

    #[test]
    fn a_name_for_a_table_with_an_asset_changes_the_name() {
        assert_eq!(with(&["tool=l"]).unwrap()["tool"]["asset"].as_str(), Some("l"));
    }

    #[test]
    fn options_of_a_kind_without_any_can_be_set() {
        assert_eq!(with(&["kind.plain.none.width=2"]).unwrap()["kind"]["plain"]["none"]["width"].as_integer(), Some(2));
    }

    #[test]
    fn a_key_in_an_asset_is_kept_in_the_scenario() {
        let table = with(&["tool.asset:family.l.arm_m=0.05"]).unwrap();
        assert_eq!(table["scenario"]["asset_changes"]["tool.asset:family.l.arm_m"].as_float(), Some(0.05));
        let changes = BTreeMap::from([("tool.asset:a".to_owned(), toml::Value::Integer(9))]);
        let source = Source::new("t.toml", "a = 1\n");
        let scenario = Source::new("s.toml", "");
        let text = |key: &str| changed_asset(&source, key, &changes, &scenario).unwrap().text;
        assert_eq!((&*text("tool.asset"), &*text("food.asset")), ("a = 9\n", "a = 1\n"));
    }

    #[test]
    fn a_path_through_a_number_is_refused() {
        let said = with(&["a.b=1"]).unwrap_err();
        assert_eq!(
            said,
            "a.toml: `a.b` cannot be changed: found a value of type integer before `b`; \
                          expected the path of a key through tables and lists"
        );
        assert!(with(&["list.3.x=1"]).unwrap_err().contains("no entry 3"));
    }

    #[test]
    fn what_is_no_change_is_refused_in_words() {
        for text in ["a", "=1", "a..b=1", "a=", "a=(", "a b=1", "a:b:c=1"] {
            assert!(text.parse::<Change>().is_err(), "{text}");
        }
        assert_eq!("a = joint_pd".parse::<Change>().unwrap(), Change::new("a", "joint_pd"));
        assert_eq!("a=1.0".parse::<Change>().unwrap(), Change::new("a", 1.0));
    }
}
