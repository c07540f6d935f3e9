//! Saves learned skills as text and loads them again: what is loaded moves exactly as what was learned, bit by bit.
//!
//! Prints the size of the file for each kind of primitive, and whether the motions are equal.
//! `cargo run --release -p skills --example save_and_load`

use std::error::Error;
use std::fs;

use nalgebra::{DMatrix, dvector};
use skills::{
    DmpConfig, GeneralizingConfig, KernelizedConfig, PrimitiveConfig, RolloutRequest, SavedPrimitive, Trajectory,
};

fn shown(height_m: f64) -> Result<Trajectory, Box<dyn Error>> {
    let samples = DMatrix::from_fn(201, 2, |row, k| {
        let r = row as f64 / 200.0;
        if k == 0 { 0.3 * r * r * (3.0 - 2.0 * r) } else { height_m * 16.0 * (r * (1.0 - r)).powi(2) }
    });
    Ok(Trajectory::uniform(0.005, samples)?)
}

fn main() -> Result<(), Box<dyn Error>> {
    let demonstrations = [shown(0.08)?, shown(0.10)?, shown(0.13)?];
    let request = RolloutRequest::new(dvector![0.0, 0.0], dvector![0.4, 0.1], 1.5, 0.01);
    let path = std::env::temp_dir().join(format!("skill-{}.json", std::process::id()));

    // a kind with its options, as a configuration file would name it
    let dmp: PrimitiveConfig = serde_json::from_str(r#"{"dmp": {"bases": 30}}"#)?;
    let others = [
        PrimitiveConfig::Dmp(DmpConfig::default()),
        PrimitiveConfig::Kernelized(KernelizedConfig::default()),
        PrimitiveConfig::Generalizing(GeneralizingConfig::default()),
    ];
    for config in [dmp].into_iter().chain(others) {
        let skill = config.learn(&demonstrations)?;
        fs::write(&path, serde_json::to_string(&skill.saved())?)?;

        let text = fs::read_to_string(&path)?;
        let loaded = serde_json::from_str::<SavedPrimitive>(&text)?.restore()?;
        let equal = loaded.rollout(&request)? == skill.rollout(&request)?;
        println!("{}: {} bytes, equal bits: {equal}", name(&skill.saved()), text.len());
    }

    // a file that was damaged is refused with the field at fault
    let text = fs::read_to_string(&path)?;
    fs::remove_file(&path)?;
    let damaged = text.replacen("\"alpha\":25.0", "\"alpha\":-25.0", 1);
    match serde_json::from_str::<SavedPrimitive>(&damaged)?.restore() {
        Ok(_) => println!("a damaged file was taken"),
        Err(error) => println!("a damaged file is refused: {error}"),
    }
    Ok(())
}

fn name(saved: &SavedPrimitive) -> &'static str {
    match saved {
        SavedPrimitive::Dmp(_) => "dmp",
        SavedPrimitive::Kernelized(_) => "kernelized",
        SavedPrimitive::Generalizing(_) => "generalizing",
    }
}
