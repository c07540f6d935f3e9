//! The study as tables in Markdown.

use std::fmt::Write;

use super::condition::Condition;
use super::outcome::{GainStudy, RunOutcome};
use crate::controllers::significant_digits as digits;

impl GainStudy {
    /// Two tables in Markdown: tool and joint errors per condition and gains, and what the gains make of the arm.
    #[must_use]
    pub fn to_markdown(&self) -> String {
        let mut text = String::new();
        self.write_errors(&mut text);
        text.push('\n');
        self.write_summaries(&mut text);
        text
    }

    fn write_header(&self, text: &mut String, first: &str) {
        let names: Vec<&str> = self.summaries.iter().map(|summary| summary.gains.name()).collect();
        line(text, first, names.iter().map(|name| (*name).to_owned()));
        line(text, "---", names.iter().map(|_| "---".to_owned()));
    }

    fn write_errors(&self, text: &mut String) {
        self.write_header(text, "largest tool error, mm (joint error, rad)");
        let mut conditions: Vec<Condition> = Vec::new();
        for run in &self.runs {
            if !conditions.contains(&run.condition) {
                conditions.push(run.condition);
            }
        }
        for condition in conditions {
            let runs = self.runs.iter().filter(|run| run.condition == condition);
            line(text, &condition.name(), runs.map(error_cell));
        }
        let peak = |summary: &super::GainSummary| {
            let of_gains = self.runs.iter().filter(|run| run.gains == summary.gains);
            digits(of_gains.map(|run| run.peak_torque_nm).fold(0.0, f64::max))
        };
        line(text, "largest torque in any run, N m", self.summaries.iter().map(peak));
    }

    fn write_summaries(&self, text: &mut String) {
        self.write_header(text, "");
        let cells =
            |cell: &dyn Fn(&super::GainSummary) -> String| -> Vec<String> { self.summaries.iter().map(cell).collect() };
        let settling = |summary: &super::GainSummary| {
            summary.settling_s.map_or_else(|| "does not settle".into(), |time_s| format!("{time_s:.2}"))
        };
        let joints = |summary: &super::GainSummary| {
            let stiffness = summary.joint_stiffness_nm_per_rad;
            let mut shown: Vec<String> = stiffness.iter().map(|value| digits(*value)).collect();
            shown.dedup();
            shown.join(" / ")
        };
        let tip = |summary: &super::GainSummary| summary.tip_stiffness_n_per_m.map(digits).join(" / ");
        line(text, "settling to 2 % after a step of 0.05 rad, s", cells(&settling).into_iter());
        line(text, "joint stiffness, N m/rad", cells(&joints).into_iter());
        line(text, "tool stiffness along x / y / z at the start, N/m", cells(&tip).into_iter());
        let growth = |summary: &super::GainSummary| format!("{:.4}", summary.growth_per_period);
        line(text, "change of errors per control period (stable below 1)", cells(&growth).into_iter());
    }
}

fn error_cell(run: &RunOutcome) -> String {
    if run.diverged {
        return "diverged".into();
    }
    format!("{} ({})", digits(1000.0 * run.tip_error_m), digits(run.joint_error_rad))
}

fn line(text: &mut String, first: &str, cells: impl Iterator<Item = String>) {
    let cells: Vec<String> = cells.collect();
    // writing to a string cannot fail
    let _ = writeln!(text, "| {first} | {} |", cells.join(" | "));
}
