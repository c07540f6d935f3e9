//! Reproduction of the paper: its experiments, figures, tables and claims, each computed anew, drawn and judged.
//!
//! An item is a file with a function from the study to a part of the report, and its line in [`ITEMS`]. Nothing but
//! [`complexity`] looks at a clock, and what it finds is kept apart, so that the report is the same on every run.

mod complexity;
mod conflicts;
mod demonstrations;
mod drawing;
mod execution;
mod flip_tasks;
mod flips;
mod page;
mod planners;
mod planners_figure;
mod separation;
mod study;
mod transfer;
mod trials;
mod verdict;

pub use page::{README, TIMINGS, readme, timings};
pub use study::{Study, StudyError};

use verdict::Verdict;

/// A part of the report.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Part {
    /// What was done, in a few sentences.
    pub text: String,
    /// Its figures.
    pub figures: Vec<Figure>,
    /// Its tables.
    pub tables: Vec<Table>,
    /// What became of the paper's claims.
    pub verdicts: Vec<Verdict>,
    /// What depends on the clock, as Markdown; empty for most.
    pub timings: String,
}

/// A figure in a file of its own.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Figure {
    /// Name of its file.
    pub file: &'static str,
    /// The file.
    pub svg: String,
    /// What is seen, and how it compares with the paper.
    pub caption: String,
}

/// A table in a file of its own.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Table {
    /// Name of its file.
    pub file: &'static str,
    /// What it tells.
    pub caption: String,
    /// The file.
    pub markdown: String,
}

/// Something of the paper that can be reproduced by itself.
#[derive(Clone, Copy, Debug)]
pub struct Item {
    /// Its name on the command line.
    pub name: &'static str,
    /// Its heading in the report.
    pub title: &'static str,
    /// Computes it.
    pub run: fn(&Study<'_>) -> Result<Part, StudyError>,
}

/// All items, in the order of the paper.
pub const ITEMS: &[Item] = &[
    Item {
        name: "figure_2",
        title: "Fig. 2(e): a plain primitive of all demonstrations",
        run: demonstrations::figure_2,
    },
    Item {
        name: "figure_5_skill",
        title: "Fig. 5(a), (b): the skill without the tool's constraints",
        run: separation::figure_5_skill,
    },
    Item { name: "figure_5_transfer", title: "Fig. 5(c): three generalizations", run: transfer::figure_5_transfer },
    Item {
        name: "figure_7",
        title: "Fig. 5(d), Fig. 7: the whole process with the L-shaped tool",
        run: execution::figure_7,
    },
    Item { name: "trials", title: "Experiment 1 under many seeds", run: trials::trials },
    Item { name: "figure_6", title: "Fig. 6: tool flips learned and generalized", run: flips::figure_6 },
    Item { name: "table_2", title: "Fig. 8, Table 2: comparison with two-level RRT*", run: planners::table_2 },
    Item { name: "figure_9", title: "Fig. 9: flips by a classic primitive", run: conflicts::figure_9 },
    Item { name: "complexity", title: "Sec. IV.B, V.B: computation", run: complexity::complexity },
];
