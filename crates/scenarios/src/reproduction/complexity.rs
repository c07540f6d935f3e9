//! What the paper says of computing time, measured on this machine: the only item that looks at a clock.

use std::fmt::Write as _;
use std::hint::black_box;
use std::time::Instant;

use nalgebra::{DMatrix, dvector};
use skills::baseline::RrtStarConfig;
use skills::corridor::{Bounds, Corridor};
use skills::corridor_filter::{CorridorFilterConfig, FilterRequest, OriginalReconstruction, Published, constrain};
use skills::regression::{Lwr, RegressionConfig};
use skills::time_law::minimum_jerk;
use skills::{Dmp, DmpConfig, MovementPrimitive, RolloutRequest, Trajectory};

use super::planners::Map;
use super::{Part, Study, StudyError};

/// Repetitions of which the shortest is taken: what else runs only adds.
const REPEATS: usize = 15;
/// Sizes of data and of trees.
const SAMPLES: [usize; 5] = [1000, 2000, 4000, 8000, 16000];
const NODES: [usize; 5] = [350, 700, 1400, 2800, 5600];

/// Shortest time of `work`, s.
fn shortest_s<T>(mut work: impl FnMut() -> Result<T, StudyError>) -> Result<f64, StudyError> {
    let mut shortest = f64::INFINITY;
    for _ in 0..REPEATS {
        let begun = Instant::now();
        black_box(work()?);
        shortest = begun.elapsed().as_secs_f64().min(shortest);
    }
    Ok(shortest)
}

/// Slope of log y over log x by least squares: the exponent of a power law.
fn exponent(x: &[usize], y: &[f64]) -> f64 {
    let points: Vec<[f64; 2]> = x.iter().zip(y).map(|(x, y)| [(*x as f64).ln(), y.ln()]).collect();
    let mean = |axis: usize| points.iter().map(|point| point[axis]).sum::<f64>() / points.len().max(1) as f64;
    let (x0, y0) = (mean(0), mean(1));
    let [over, under] =
        points.iter().fold([0.0; 2], |[over, under], [x, y]| [over + (x - x0) * (y - y0), under + (x - x0) * (x - x0)]);
    over / under
}

/// A bulging motion of one coordinate over a second.
fn demonstration(samples: usize) -> Result<Trajectory, StudyError> {
    let step = 1.0 / (samples - 1) as f64;
    let position = |row: usize| {
        let t = row as f64 * step;
        minimum_jerk(t) + 0.3 * (3.0 * std::f64::consts::PI * t).sin() * 16.0 * (t * (1.0 - t)).powi(2)
    };
    Ok(Trajectory::uniform(step, DMatrix::from_fn(samples, 1, |row, _| position(row)))?)
}

/// Measures, and says of each claim what came of it.
pub fn complexity(study: &Study<'_>) -> Result<Part, StudyError> {
    let mut text = String::from("## Computation (Sec. IV.B, V.B, Table 2)\n\n");
    let _ = writeln!(text, "The shortest of {REPEATS} repetitions each.\n");
    learning(&mut text)?;
    searching(&mut text, study)?;
    laws(&mut text)?;
    Ok(Part {
        text: "How learning grows with the data, RRT* with its nodes, and what constraining a skill costs is measured by the \
               clock: numbers and verdicts stand in [timings.md](timings.md)."
            .into(),
        timings: text,
        ..Part::default()
    })
}

/// Learning and rolling out against the number of samples.
fn learning(text: &mut String) -> Result<(), StudyError> {
    let kinds = [
        ("locally weighted regression", RegressionConfig::Lwr(Lwr::default())),
        ("ridge regression", RegressionConfig::default()),
    ];
    text.push_str("| samples |");
    kinds.iter().for_each(|(name, _)| {
        let _ = write!(text, " learn by {name} (ms) |");
    });
    text.push_str(" roll out, 1000 steps (ms) |\n|---|---|---|---|\n");
    let mut times: [Vec<f64>; 3] = Default::default();
    for samples in SAMPLES {
        let shown = [demonstration(samples)?];
        let _ = write!(text, "| {samples} |");
        for ((_, regression), times) in kinds.iter().zip(&mut times) {
            let config = DmpConfig { regression: regression.clone(), ..DmpConfig::default() };
            let seconds = shortest_s(|| Ok(Dmp::learn(&config, &shown)?))?;
            times.push(seconds);
            let _ = write!(text, " {:.3} |", 1e3 * seconds);
        }
        let learned = Dmp::learn(&DmpConfig::default(), &shown)?;
        let request = RolloutRequest::new(dvector![0.0], dvector![1.0], 1.0, 0.001);
        let seconds = shortest_s(|| Ok(learned.rollout(&request)?))?;
        times[2].push(seconds);
        let _ = writeln!(text, " {:.3} |", 1e3 * seconds);
    }
    let [lwr, ridge, _] = [&times[0], &times[1], &times[2]].map(|times| exponent(&SAMPLES, times));
    let longest = times.iter().flatten().copied().fold(0.0, f64::max);
    let _ = writeln!(
        text,
        "\n- Claim: learning takes between O(n) and O(n²) for n samples. Measured exponents: {lwr:.2} (locally weighted), \
         {ridge:.2} (ridge). With a fixed number of bases both grow about linearly: **{}**.\n\
         - Claim: a primitive takes 10⁻⁴ to 10⁻³ s. Measured: up to {longest:.1e} s with {} samples: **{}**.\n",
        if lwr < 1.3 && ridge < 1.3 { "reproduced, the lower bound" } else { "differs on this machine" },
        SAMPLES[SAMPLES.len() - 1],
        if longest < 1e-2 { "reproduced in its order" } else { "differs on this machine" }
    );
    Ok(())
}

/// RRT* against the number of nodes, and both ways of planning.
fn searching(text: &mut String, study: &Study<'_>) -> Result<(), StudyError> {
    let map = Map::new(study)?;
    text.push_str("| nodes | RRT* (ms) | per n log n (ns) |\n|---|---|---|\n");
    let mut times = Vec::new();
    for nodes in NODES {
        let config = RrtStarConfig { nodes, ..RrtStarConfig::default() };
        let seconds = shortest_s(|| Ok(config.search(&map.space, map.ends.0, map.ends.1)?))?;
        times.push(seconds);
        let n = nodes as f64;
        let _ = writeln!(text, "| {nodes} | {:.3} | {:.0} |", 1e3 * seconds, 1e9 * seconds / (n * n.ln()));
    }
    let found = exponent(&NODES, &times);
    let _ = writeln!(
        text,
        "\n- Claim: RRT* takes O(n log n). Measured exponent {found:.2}, where n log n has about 1.13 over this range: **{}**.\n\
         - Claim: the two-level planner takes 10⁻³ to 10⁻¹ s. Its first level with the paper's 1400 nodes: {:.1e} s: **{}**.\n",
        if found < 1.3 { "reproduced" } else { "differs on this machine, other work on it included" },
        times[2],
        if times[2] < 1e-1 { "reproduced" } else { "differs on this machine" }
    );
    Ok(())
}

/// Constraining a skill by the published law and by the law that it abridges.
fn laws(text: &mut String) -> Result<(), StudyError> {
    let learned = Dmp::learn(&DmpConfig::default(), &[demonstration(1001)?])?;
    let request = RolloutRequest::new(dvector![0.0], dvector![1.0], 1.0, 0.001);
    let skill = learned.rollout(&request)?;
    let wide = Corridor::sampled(vec![0.0, 1.0], 1, |_, _| Bounds::still(-2.0, 3.0))?;
    let kinds = [
        ("C-DMP lite, Eq. (32)", CorridorFilterConfig::Published(Published::default())),
        (
            "its predecessor, reconstructed",
            CorridorFilterConfig::OriginalReconstruction(OriginalReconstruction::default()),
        ),
        ("the logit law used here", CorridorFilterConfig::default()),
    ];
    text.push_str("| law | constrain 1000 steps (ms) |\n|---|---|\n");
    let mut times = Vec::new();
    for (name, config) in kinds {
        let seconds = shortest_s(|| Ok(constrain(&config, &skill, &wide, &FilterRequest::of(&request))?))?;
        times.push(seconds);
        let _ = writeln!(text, "| {name} | {:.3} |", 1e3 * seconds);
    }
    let saved = 1e2 * (1.0 - times[0] / times[1]);
    let _ = writeln!(
        text,
        "\n- Claim: C-DMP lite saves at least 30 % (in the conclusion: over one third). Measured on whole motions, their \
         certificate included: {saved:.0} % against a reconstruction of the predecessor, whose paper is not at hand: **{}**. \
         `cargo bench -p skills --bench corridors` measures a single step of each law. What the cheaper law does not \
         guarantee is told in PAPER.md.",
        if saved >= 30.0 { "reproduced" } else { "differs: the law is cheaper, the whole motion hardly" }
    );
    Ok(())
}
