//! Learns a movement primitive from a demonstration in a CSV file and rolls it out to a goal that was never shown.
//!
//! Prints how closely the demonstration is reproduced without and with smoothing, and the new motion as CSV.
//! `cargo run --release -p skills --example learn_from_csv`

use std::error::Error;

use nalgebra::{DMatrix, dvector};
use skills::{Dmp, DmpConfig, Ends, MovementPrimitive, Rollout, RolloutRequest, Trajectory};

/// A pushed disc as a camera saw it thirty times a second: time (s), x, y (m); the cells of other moments are empty.
const RECORDING: &str = include_str!("../../../assets/demonstrations/push_stick_1.csv");

/// Reads the columns `time_s` and those named in `columns`; rows where one of them is empty are left out.
fn read_csv(text: &str, columns: &[&str]) -> Result<Trajectory, Box<dyn Error>> {
    let mut lines = text.lines().filter(|line| !line.starts_with('#'));
    let header: Vec<&str> = lines.next().ok_or("the file is empty")?.split(',').collect();
    let place = |name: &str| header.iter().position(|cell| *cell == name).ok_or(format!("there is no column {name}"));
    let time = place("time_s")?;
    let wanted = columns.iter().map(|name| place(name)).collect::<Result<Vec<_>, _>>()?;
    let (mut times_s, mut values) = (Vec::new(), Vec::new());
    for line in lines {
        let cells: Vec<&str> = line.split(',').collect();
        let row: Vec<&str> = wanted.iter().filter_map(|column| cells.get(*column).copied()).collect();
        if row.len() == wanted.len() && row.iter().all(|cell| !cell.is_empty()) {
            times_s.push(cells[time].parse()?);
            for cell in row {
                values.push(cell.parse()?);
            }
        }
    }
    Ok(Trajectory::new(times_s, DMatrix::from_row_slice(values.len() / columns.len(), columns.len(), &values))?)
}

/// Root mean square of the distance of a rollout from what was shown, mm.
fn error_mm(shown: &Trajectory, motion: &Rollout) -> f64 {
    let square = |(row, time_s): (usize, &f64)| {
        let place = motion.positions().at(time_s - shown.start_time_s());
        shown.sample(row).unwrap_or_default().metric_distance(&place).powi(2)
    };
    let sum: f64 = shown.times_s().iter().enumerate().map(square).sum();
    1e3 * (sum / shown.len() as f64).sqrt()
}

fn main() -> Result<(), Box<dyn Error>> {
    let shown = read_csv(RECORDING, &["object_x_m", "object_y_m"])?;
    println!("demonstration: {} samples in {:.2} s", shown.len(), shown.duration_s());
    let again = RolloutRequest::new(shown.start(), shown.end(), shown.duration_s(), 0.01);

    // the noise of the camera looks like a motion at both ends; the disc was at rest there
    let raw = Dmp::learn(&DmpConfig::default(), std::slice::from_ref(&shown))?;
    println!("learned as recorded: {:.2} mm from it", error_mm(&shown, &raw.rollout(&again)?));
    let skill = Dmp::learn(&DmpConfig::default(), &[shown.smoothed(0.1, Ends::Resting)?])?;
    println!("learned smoothed:    {:.2} mm from it", error_mm(&shown, &skill.rollout(&again)?));

    // another goal, in half the time
    let goal = shown.end() + dvector![0.03, -0.02];
    let motion = skill.rollout(&RolloutRequest::new(shown.start(), goal.clone(), 5.0, 0.01))?;
    println!("new goal missed by {:.2} mm", 1e3 * motion.positions().end().metric_distance(&goal));
    println!("time_s,x_m,y_m");
    for (row, time_s) in motion.positions().times_s().iter().enumerate().step_by(100) {
        let place = motion.positions().samples().row(row);
        println!("{time_s:.2},{:.4},{:.4}", place[0], place[1]);
    }
    Ok(())
}
