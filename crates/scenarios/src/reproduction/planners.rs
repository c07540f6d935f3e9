//! Table 2: two-level RRT* with the paper's parameters, with shortcuts, and the transferred skill, on one map.

use nalgebra::Point2;
use rayon::prelude::*;
use skills::baseline::{
    FreeSpace, PathMeasures, RrtStar, RrtStarConfig, TwoLevelConfig, TwoLevelMeasures, TwoLevelPlan, TwoLevelProblem,
    shortcut,
};
use skills::outline::PlacedOutline;

use super::planners_figure::{Example, draw};
use super::transfer::{SAFE_MARGIN_M, corners, ends};
use super::verdict::{Finding, Verdict};
use super::{Figure, Part, Study, StudyError, Table};

/// Seeds of the sampling planner.
const SEEDS: u64 = 100;
/// Spacing of the corners of a shortcut, m.
const SHORTCUT_M: f64 = 0.002;
/// Where the actuator may be in Experiment 1, m: what its planner was given.
const WORKSPACE_M: ([f64; 2], [f64; 2]) = ([-0.12, 0.0], [0.12, 0.16]);
/// A path ends at its goal if it is nearer than this, m.
const AT_GOAL_M: f64 = 1e-6;
/// The paper's counts (Table 2).
const PAPER_POINTS: usize = 22;
const PAPER_PHASES: usize = 3;

/// One seed: the object's path as it was found and with shortcuts, and the tool's plan along each.
pub struct Searched {
    /// The search.
    pub found: RrtStar,
    /// Path measures and plan, as found and with shortcuts.
    pub plans: [(PathMeasures, TwoLevelPlan); 2],
}

/// What the planners are asked.
pub struct Map<'a> {
    /// Free places of the object's center.
    pub space: FreeSpace,
    /// The obstacles.
    pub obstacles: Vec<PlacedOutline>,
    /// Start and goal of the center.
    pub ends: (Point2<f64>, Point2<f64>),
    study: &'a Study<'a>,
}

impl<'a> Map<'a> {
    /// The map of the scenario, less the object's radius and the safe margin.
    pub fn new(study: &'a Study<'a>) -> Result<Self, StudyError> {
        let scenario = &study.push.scenario;
        let radius_m = scenario.object.shape.radius_m();
        let obstacles: Vec<PlacedOutline> = scenario.world.obstacles.iter().map(|obstacle| obstacle.placed()).collect();
        let (min, max) = (scenario.world.map.min_m, scenario.world.map.max_m);
        let space = FreeSpace::new(
            min.map(|low| low + radius_m),
            max.map(|high| high - radius_m),
            SAFE_MARGIN_M + radius_m,
            &obstacles,
        )?;
        Ok(Self { space, obstacles, ends: ends(study), study })
    }

    /// The tool level along a path of the object.
    pub fn tool_level(&self, config: &TwoLevelConfig, path: &[Point2<f64>]) -> Result<TwoLevelPlan, StudyError> {
        let problem = TwoLevelProblem {
            tool: &self.study.push.tool,
            object_radius_m: self.study.push.scenario.object.shape.radius_m(),
            obstacles: &self.obstacles,
            workspace_m: Some(WORKSPACE_M),
        };
        Ok(config.plan(&problem, path)?)
    }

    /// Both levels with one seed.
    fn search(&self, seed: u64) -> Result<Searched, StudyError> {
        let (start, goal) = self.ends;
        let found = RrtStarConfig { seed, ..RrtStarConfig::default() }.search(&self.space, start, goal)?;
        let short = shortcut(&found.path, &self.space, SHORTCUT_M)?;
        let config = TwoLevelConfig::default();
        let plans = [
            (found.measures, self.tool_level(&config, &found.path)?),
            (PathMeasures::new(&short, &goal), self.tool_level(&config, &short)?),
        ];
        Ok(Searched { found, plans })
    }
}

/// Plans with all seeds, counts, draws.
pub fn table_2(study: &Study<'_>) -> Result<Part, StudyError> {
    let map = Map::new(study)?;
    let searched: Vec<Searched> =
        (0..SEEDS).into_par_iter().map(|seed| map.search(seed)).collect::<Result<_, StudyError>>()?;
    let ours = corners(study.transfer()?);
    let [points, shortened] = [0, 1].map(|variant| -> Vec<usize> {
        searched.iter().map(|one| one.plans[variant].1.measures().trajectory_points).collect()
    });
    let middle = median(&points);
    let example = searched.iter().zip(&points).position(|(_, points)| *points == middle).unwrap_or(0);
    let charts = draw(
        study,
        &map,
        &Example { searched: &searched[example], points: &points, shortened: &shortened, ours: &ours },
    )?;
    Ok(Part {
        text: format!(
            "RRT* for the object's center with the paper's parameters (steps of 0.2 cm, 7 neighbors within 1 cm, 1400 nodes, goal \
             tolerance 0.2 cm), then holds of the L-shaped tool for each straight part of the path, with the fewest changes of \
             surface. The paper does not say how its tool level chooses; here the choice favors the baseline. {SEEDS} seeds. \
             \"Trajectory points\" are the places at which the contact is chosen anew, start and goal included: straight parts \
             + 1. The shortcut variant removes the corners that only the sampling has made. The transferred plan is refused by the program \
             if its tool's path jumps or leaves the arm's reach, so that its entries of that kind are true of every plan."
        ),
        figures: vec![Figure {
            file: "figure_8.svg",
            svg: charts,
            caption: format!(
                "Seed {example}, whose count is the median. (a) The tree and the object's path, which ends beside the goal. \
                 (b) If the tool could be turned anywhere, one surface would do. (c) The L with its angle kept, colored by \
                 surface as in Fig. 8(d); parts along which none of its surfaces can push within its friction angle, or only from a place \
                 that an obstacle or the workspace bars, are red and dotted. (d) Trajectory points of all seeds, as \
                 found and with shortcuts, beside the paper's 22 and 4."
            ),
        }],
        tables: vec![Table {
            file: "table_2.md",
            caption: "Table 2, medians and ranges over the seeds:".into(),
            markdown: markdown(study, &searched, &ours)?,
        }],
        verdicts: verdicts(study, &searched, &points)?,
        ..Part::default()
    })
}

/// The lower median of values.
fn median<T: PartialOrd + Copy + Default>(values: &[T]) -> T {
    let mut sorted = values.to_vec();
    sorted.sort_by(|a, b| a.partial_cmp(b).unwrap_or(std::cmp::Ordering::Equal));
    sorted.get(sorted.len().saturating_sub(1) / 2).copied().unwrap_or_default()
}

/// Median and range in words.
fn spread(values: Vec<f64>, decimals: usize) -> String {
    let low = values.iter().copied().fold(f64::INFINITY, f64::min);
    let high = values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    format!("{:.decimals$} ({low:.decimals$} to {high:.decimals$})", median(&values))
}

/// One number of each seed, as found or with shortcuts.
fn column(searched: &[Searched], variant: usize, value: impl Fn(&PathMeasures, &TwoLevelMeasures) -> f64) -> Vec<f64> {
    searched.iter().map(|one| value(&one.plans[variant].0, &one.plans[variant].1.measures())).collect()
}

fn markdown(study: &Study<'_>, searched: &[Searched], ours: &[Point2<f64>]) -> Result<String, StudyError> {
    let transfer = study.transfer()?;
    let measures = PathMeasures::new(ours, &ends(study).1);
    let numbers = |decimals: usize, value: &dyn Fn(&PathMeasures, &TwoLevelMeasures) -> f64| {
        [0, 1].map(|variant| spread(column(searched, variant, value), decimals))
    };
    let share = |holds: &dyn Fn(&PathMeasures, &TwoLevelMeasures) -> bool| {
        [0, 1].map(|variant| {
            let count =
                column(searched, variant, |path, plan| f64::from(u8::from(holds(path, plan)))).iter().sum::<f64>();
            format!("{count:.0} of {SEEDS} seeds")
        })
    };
    let fixed = |word: &str| [word.to_owned(), word.to_owned()];
    let rows: Vec<(&str, &str, &str, String, [String; 2])> = vec![
        ("levels of tool action planning", "2", "2", "2".into(), fixed("2")),
        (
            "phases of tool movement",
            "3",
            "3",
            transfer.phases.phases.len().to_string(),
            numbers(0, &|_, plan| plan.phases as f64),
        ),
        ("changes of surface", "2", "2", transfer.flips.len().to_string(), numbers(0, &|_, plan| plan.switches as f64)),
        (
            "trajectory points, reschedulings",
            "4",
            "22",
            measures.trajectory_points().to_string(),
            numbers(0, &|_, plan| plan.trajectory_points as f64),
        ),
        ("nodes of the object's path", "–", "22", ours.len().to_string(), numbers(0, &|path, _| path.nodes as f64)),
        (
            "continuous tool trajectory within each phase",
            "yes",
            "no",
            "yes".into(),
            share(&|_, plan| plan.is_continuous()),
        ),
        ("jumps of pose inside phases", "–", "–", "0".into(), numbers(0, &|_, plan| plan.pose_jumps as f64)),
        ("reaches the goal exactly", "yes", "may not", "yes".into(), share(&|path, _| path.goal_error_m <= AT_GOAL_M)),
        (
            "distance of the end from the goal (mm)",
            "0",
            "up to 2",
            format!("{:.4}", 1e3 * measures.goal_error_m),
            numbers(2, &|path, _| 1e3 * path.goal_error_m),
        ),
        ("some part is unreachable by the tool", "no", "may", "no".into(), share(&|_, plan| plan.unreachable > 0)),
        ("unreachable parts", "0", "–", "0".into(), numbers(0, &|_, plan| plan.unreachable as f64)),
        (
            "length of the object's path (mm)",
            "–",
            "–",
            format!("{:.1}", 1e3 * measures.length_m),
            numbers(1, &|path, _| 1e3 * path.length_m),
        ),
        ("skill generalization, human demonstrations", "yes", "no", "yes".into(), fixed("no")),
    ];
    let mut text = String::from(
        "| | paper: DMP-based | paper: two-level RRT* | here: DMP-based | here: two-level RRT* | here: with shortcuts |\n\
         |---|---|---|---|---|---|\n",
    );
    for (name, dmp, rrt, ours, [found, short]) in rows {
        text += &format!("| {name} | {dmp} | {rrt} | {ours} | {found} | {short} |\n");
    }
    Ok(text)
}

fn verdicts(study: &Study<'_>, searched: &[Searched], points: &[usize]) -> Result<Vec<Verdict>, StudyError> {
    let transfer = study.transfer()?;
    let ours = PathMeasures::new(&corners(transfer), &ends(study).1);
    let end_mm = |variant: usize| spread(column(searched, variant, |path, _| 1e3 * path.goal_error_m), 2);
    let exact = column(searched, 0, |path, _| path.goal_error_m).iter().filter(|miss| **miss <= AT_GOAL_M).count();
    let phases = column(searched, 0, |_, plan| plan.phases as f64);
    let unreachable = searched.iter().filter(|one| one.plans[0].1.measures().unreachable > 0).count();
    let continuous = searched.iter().filter(|one| one.plans[0].1.measures().is_continuous()).count();
    let range = [points.iter().min(), points.iter().max()].map(|count| count.copied().unwrap_or(0));
    let brackets = (range[0]..=range[1]).contains(&PAPER_POINTS);
    let is_goal = ours.goal_error_m <= AT_GOAL_M;
    Ok(vec![
        Verdict::new(
            "Sec. IV.B, Fig. 8(a)",
            "the end of the RRT* trajectory does not coincide with the destination; that of the DMP does",
            if is_goal && exact == 0 {
                Finding::Reproduced
            } else {
                Finding::of(is_goal && 2 * exact < searched.len())
            },
            format!(
                "RRT* ends {} mm off, exactly at the goal in {exact} of {SEEDS} seeds; the planned phases end {:.4} mm off",
                end_mm(0),
                1e3 * ours.goal_error_m
            ),
        ),
        Verdict::new(
            "Table 2",
            "RRT*: 22 trajectory points",
            Finding::of(brackets),
            format!(
                "{}; with shortcuts {}: the count measures step, radius and number of nodes more than the task",
                spread(points.iter().map(|count| *count as f64).collect(), 0),
                spread(column(searched, 1, |_, plan| plan.trajectory_points as f64), 0)
            ),
        ),
        Verdict::new(
            "Table 2",
            "DMP-based: 4 trajectory points in 3 phases",
            Finding::of(ours.trajectory_points() == 4 && transfer.phases.phases.len() == PAPER_PHASES),
            format!(
                "{} points in {} phases (the text says three contact points: those without the start)",
                ours.trajectory_points(),
                transfer.phases.phases.len()
            ),
        ),
        Verdict::new(
            "Table 2, Fig. 8(d)",
            "RRT*: the tool changes its surface only twice, in 3 phases",
            if median(&phases) == PAPER_PHASES as f64 { Finding::Reproduced } else { Finding::Differs },
            format!("{} phases: paths that wander need a surface again", spread(phases, 0)),
        ),
        Verdict::new(
            "Table 2",
            "within each phase the tool's trajectory is continuous with the DMP and not with RRT*",
            Finding::of(continuous == 0),
            format!(
                "continuous in {continuous} of {SEEDS} seeds; the DMP's phases are straight pushes with one hold each"
            ),
        ),
        Verdict::new(
            "Table 2",
            "with RRT* a position may be unreachable by the tool, with the DMP none is",
            Finding::of(unreachable > 0),
            format!(
                "some part is unreachable in {unreachable} of {SEEDS} seeds; the transferred plan is checked along its whole way"
            ),
        ),
    ])
}
