//! Verdicts: what the paper says, what came out here, and whether the two agree.

use std::fmt::Write as _;

/// Whether a claim of the paper came out.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Finding {
    /// As the paper says.
    Reproduced,
    /// In part, or in another way: the numbers say how.
    Differs,
    /// Not as the paper says.
    NotReproduced,
}

impl Finding {
    /// [`Finding::Reproduced`] if the claim `holds`, else [`Finding::NotReproduced`].
    pub fn of(holds: bool) -> Self {
        if holds { Self::Reproduced } else { Self::NotReproduced }
    }

    /// The word in tables.
    pub fn as_str(self) -> &'static str {
        match self {
            Self::Reproduced => "reproduced",
            Self::Differs => "differs",
            Self::NotReproduced => "not reproduced",
        }
    }
}

/// A claim of the paper with what came out here.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Verdict {
    /// Where the paper says it.
    pub place: &'static str,
    /// What it says.
    pub claim: &'static str,
    /// Whether it came out.
    pub finding: Finding,
    /// What was measured, with units.
    pub measured: String,
}

impl Verdict {
    /// A verdict.
    pub fn new(place: &'static str, claim: &'static str, finding: Finding, measured: String) -> Self {
        Self { place, claim, finding, measured }
    }
}

/// Verdicts as a table.
pub fn table(verdicts: &[Verdict]) -> String {
    let mut text = String::from("| in the paper | claim | verdict | measured here |\n|---|---|---|---|\n");
    for Verdict { place, claim, finding, measured } in verdicts {
        let _ = writeln!(text, "| {place} | {claim} | **{}** | {measured} |", finding.as_str());
    }
    text
}
