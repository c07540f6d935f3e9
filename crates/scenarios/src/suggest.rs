//! Nearest names: what a misspelled key, kind or file was probably meant to be.

/// Returns the known name nearest to `found`, if one is near enough to be meant.
#[must_use]
pub fn nearest<'a, S: AsRef<str>>(found: &str, known: &'a [S]) -> Option<&'a str> {
    let lower = found.to_lowercase();
    let distance = |name: &str| strsim::damerau_levenshtein(&lower, &name.to_lowercase());
    let (best, edits) =
        known.iter().map(|name| (name.as_ref(), distance(name.as_ref()))).min_by_key(|&(_, edits)| edits)?;
    let longest = found.chars().count().max(best.chars().count());
    (edits <= (longest / 3).max(1) && edits < longest).then_some(best)
}

/// Lists names in backticks: "`a`, `b`", or "none" if there are none.
#[must_use]
pub fn listed<S: AsRef<str>>(names: &[S]) -> String {
    if names.is_empty() {
        return "none".into();
    }
    names.iter().map(|name| format!("`{}`", name.as_ref())).collect::<Vec<_>>().join(", ")
}

/// Says that `found` was probably meant to be the nearest of `known`, as a help line; nothing if none is near.
#[must_use]
pub fn did_you_mean<S: AsRef<str>>(found: &str, known: &[S]) -> Option<String> {
    nearest(found, known).map(|name| format!("did you mean `{name}`?"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_slip_of_the_finger_finds_its_name() {
        assert_eq!(nearest("mas_kg", &["mass_kg", "shape", "name"]), Some("mass_kg"));
        assert_eq!(nearest("elipsoid", &["ellipsoid", "support_points"]), Some("ellipsoid"));
        assert_eq!(nearest("Stick", &["stick"]), Some("stick"));
    }

    #[test]
    fn a_strange_name_finds_none() {
        assert_eq!(nearest("quantum", &["mass_kg", "shape"]), None);
        assert_eq!(nearest("x", &["y"]), None);
        assert_eq!(nearest::<&str>("x", &[]), None);
    }
}
