//! The page that shows everything, and the one with the clock times.

use std::fmt::Write as _;

use super::verdict::{Finding, Verdict, table};
use super::{ITEMS, Item, Part};

/// Name of the page.
pub const README: &str = "README.md";
/// Name of the page with what depends on the clock.
pub const TIMINGS: &str = "timings.md";

/// The page of the parts, each with its item; `recording` names the recording beside it.
pub fn readme(parts: &[(&Item, Part)], scenario: &str, trials: u32, recording: &str) -> String {
    let mut text = String::from("# Reproduction of the paper\n\n");
    let partial = if parts.len() < ITEMS.len() { " --only …" } else { "" };
    let _ = write!(
        text,
        "Written by `wield reproduce{partial} --trials {trials}` of version {}; do not edit. The paper is Lu, Wang, Yang, \
         \"A Dynamic Movement Primitives-based Tool Use Skill Learning and Transfer Framework for Robot Manipulation\", \
         [doi:10.1109/TASE.2024.3370139](https://doi.org/10.1109/TASE.2024.3370139); its equations and where they are in \
         the code stand in PAPER.md.\n\n\
         Everything is computed anew from `scenarios/{scenario}.toml`: a synthetic human shows the push with the stick, \
         the skill is learned, transferred to the L-shaped tool and carried out by a simulated arm. The paper's own data \
         are not published, so shapes are compared by what they do and by the numbers that the text gives, not point \
         by point. \"Reproduced\": it came out as the paper says. \"Differs\": in part, or in another way, as the numbers \
         tell. \"Not reproduced\": it did not.\n\n",
        env!("CARGO_PKG_VERSION")
    );
    let verdicts: Vec<Verdict> = parts.iter().flat_map(|(_, part)| part.verdicts.iter().cloned()).collect();
    let _ = write!(text, "## Verdicts\n\n{}\n{}\n", tally(&verdicts), table(&verdicts));
    let _ = write!(
        text,
        "Clock times, and what the paper claims of them, are in [{TIMINGS}]({TIMINGS}): they change from run to run, and \
         nothing else here does.\n\n\
         The run of Fig. 7 as a recording: `{recording}`, written beside this page by the same command and not kept under \
         version control; open it with `rerun {recording}`. Or `wield run scenarios/{scenario}.toml --view`.\n",
    );
    for (item, part) in parts {
        let _ = write!(text, "\n## {}\n\n{}\n", item.title, part.text.trim_end());
        for figure in &part.figures {
            let _ = write!(text, "\n![{}]({})\n\n*{}*\n", item.title, figure.file, figure.caption);
        }
        for table in &part.tables {
            let _ = write!(text, "\n{}\n\n{}", table.caption, table.markdown);
        }
    }
    text
}

fn tally(verdicts: &[Verdict]) -> String {
    let count = |finding: Finding| verdicts.iter().filter(|verdict| verdict.finding == finding).count();
    format!(
        "Of {} claims {} are reproduced, {} differ, {} are not reproduced.\n",
        verdicts.len(),
        count(Finding::Reproduced),
        count(Finding::Differs),
        count(Finding::NotReproduced)
    )
}

/// The page of clock times; `seconds` are those of the items themselves.
pub fn timings(parts: &[(&Item, Part)], seconds: &[f64]) -> String {
    let mut text = String::from(
        "# Clock times of the reproduction\n\nWritten by `wield reproduce`; do not edit. The times are those of the machine on \
         which it ran, with whatever else ran there.\n",
    );
    for (_, part) in parts.iter().filter(|(_, part)| !part.timings.is_empty()) {
        let _ = write!(text, "\n{}\n", part.timings.trim_end());
    }
    text += "\n## Time of each item\n\n| item | time (s) |\n|---|---|\n";
    for ((item, _), seconds) in parts.iter().zip(seconds) {
        let _ = writeln!(text, "| `{}` | {seconds:.2} |", item.name);
    }
    text
}
