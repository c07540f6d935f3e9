//! Fig. 2(e): a plain primitive learned from whole demonstrations loses the corners that tell of the tool.

use nalgebra::{DMatrix, DVector, Point2};
use skills::baseline::heading_changes;
use skills::demonstration::Demonstration;
use skills::segmentation::pushes;
use skills::{RolloutRequest, Trajectory};

use super::drawing::{OBJECT, X_CM, Y_CM, cm, line_cm, outline_cm, points};
use super::verdict::{Finding, Verdict};
use super::{Figure, Part, Study, StudyError, Table};
use crate::measures::path_length_m;
use crate::plot::{BLACK, Chart, GRAY, ORANGE, RED, figure, fill, line};

/// Distance between two looks at the heading, m, and the change that counts as a corner, rad.
const LOOK_M: f64 = 0.005;
const CORNER_RAD: f64 = std::f64::consts::FRAC_PI_6;
/// Samples of a rollout.
const STEPS: f64 = 400.0;

/// The object's paths, waits cut out, each over one unit of time along its length or its clock.
fn object_paths(study: &Study<'_>) -> Result<Vec<Trajectory>, StudyError> {
    let scenario = study.push;
    let path = |demonstration: &Demonstration| {
        let aligned = demonstration.aligned();
        let fragments = pushes(&aligned, &scenario.demonstration_tool, &scenario.scenario.object.shape);
        let places: Vec<Point2<f64>> = fragments.iter().flat_map(|fragment| fragment.object_path(&aligned)).collect();
        let samples = DMatrix::from_fn(places.len(), 2, |row, axis| places[row][axis]);
        Ok(Trajectory::uniform(aligned.time_step_s, samples)?)
    };
    study.run()?.demonstrations.iter().map(path).collect()
}

/// Corners, and the sharpest turn within two looks, rad.
fn corners(path: &[Point2<f64>]) -> (usize, f64) {
    let even = evenly(path);
    let ways: Vec<_> = even.windows(2).map(|pair| pair[1] - pair[0]).collect();
    let sharpest = ways.windows(2).map(|pair| pair[0].angle(&pair[1])).fold(0.0, f64::max);
    (heading_changes(&even, CORNER_RAD), sharpest)
}

/// Places every [`LOOK_M`] along a path: what is shorter than that is noise.
fn evenly(path: &[Point2<f64>]) -> Vec<Point2<f64>> {
    let mut even: Vec<Point2<f64>> = path.first().copied().into_iter().collect();
    for place in path {
        if even.last().is_some_and(|last| (place - last).norm() >= LOOK_M) {
            even.push(*place);
        }
    }
    even
}

/// Learns one primitive from all demonstrations and counts corners.
pub fn figure_2(study: &Study<'_>) -> Result<Part, StudyError> {
    let shown = object_paths(study)?;
    let primitive = study.push.scenario.primitive.learn(&shown)?;
    let mean = |ends: Vec<DVector<f64>>| ends.iter().sum::<DVector<f64>>() / ends.len().max(1) as f64;
    let start = mean(shown.iter().map(Trajectory::start).collect());
    let goal = mean(shown.iter().map(Trajectory::end).collect());
    let duration_s = shown.iter().map(Trajectory::duration_s).sum::<f64>() / shown.len().max(1) as f64;
    let request = RolloutRequest::new(start, goal, duration_s, duration_s / STEPS);
    let learned = points(primitive.rollout(&request)?.positions());

    let mut chart = Chart::map("Object: shown and learned", X_CM, Y_CM);
    let mut rows = String::from("| path | corners | sharpest turn (°) | length (mm) |\n|---|---|---|---|\n");
    let mut fewest = usize::MAX;
    let mut mildest_rad = f64::INFINITY;
    let mut row = |name: &str, path: &[Point2<f64>]| {
        let (count, sharpest) = corners(path);
        rows += &format!("| {name} | {count} | {:.0} | {:.1} |\n", sharpest.to_degrees(), 1e3 * path_length_m(path));
        (count, sharpest)
    };
    if let Some(first) = shown.first() {
        let pose = nalgebra::Isometry2::translation(first.start()[0], first.start()[1]);
        chart.shape("object at the start", OBJECT, vec![outline_cm(&study.push.scenario.object.shape, &pose)]);
    }
    for (index, path) in shown.iter().enumerate() {
        let path = points(path);
        chart.line("demonstrations with the stick", line(GRAY, 1.2), line_cm(&path));
        let (count, sharpest) = row(&format!("demonstration {}", index + 1), &path);
        (fewest, mildest_rad) = (fewest.min(count), mildest_rad.min(sharpest));
    }
    chart.line("one plain primitive, learned from all", line(RED, 2.4), line_cm(&learned));
    chart.dots(
        "corner of a demonstration",
        fill(ORANGE, 1.0),
        3.5,
        shown.iter().filter_map(|path| corner(&points(path))).collect(),
    );
    chart.dots(None, fill(BLACK, 1.0), 3.0, learned.first().into_iter().chain(learned.last()).map(cm).collect());
    let (count, sharpest) = row("plain primitive", &learned);
    let measured = format!(
        "{count} heading changes above 30° within 5 mm steps, in every demonstration {fewest} or more; sharpest turn {:.0}°, \
         mildest of the demonstrations {:.0}°",
        sharpest.to_degrees(),
        mildest_rad.to_degrees()
    );
    Ok(Part {
        text: "All demonstrations of the object, from the first push to the last, are given to one plain primitive as they \
               are (waits of the object cut out), and it is rolled out from their mean start to their mean end. A corner is \
               a change of heading of more than 30° between steps of 5 mm."
            .into(),
        figures: vec![Figure {
            file: "figure_2e.svg",
            svg: figure(&[chart], 1, 520.0),
            caption: "In Fig. 2(e) the learned path (red) has fewer corners than the demonstrations (gray). Here it smooths what \
                      wavers in them but keeps their one corner: the synthetic human pushes left once and forward once, \
                      so that all demonstrations turn at one place and at nearly one share of their way, where the paper's turn \
                      again and again at places that differ."
                .into(),
        }],
        tables: vec![Table { file: "figure_2e.md", caption: "Corners:".into(), markdown: rows }],
        verdicts: vec![Verdict::new(
            "Sec. II.C, Fig. 2(e)",
            "the learned trajectory is smoother than the demonstrations and has fewer corners",
            if count < fewest { Finding::Reproduced } else if sharpest < mildest_rad { Finding::Differs } else { Finding::NotReproduced },
            measured,
        )],
        ..Part::default()
    })
}

/// The sharpest corner of a path, cm.
fn corner(path: &[Point2<f64>]) -> Option<[f64; 2]> {
    let even = evenly(path);
    let turn = |three: &&[Point2<f64>]| (three[1] - three[0]).angle(&(three[2] - three[1]));
    even.windows(3).max_by(|a, b| turn(a).total_cmp(&turn(b))).map(|three| cm(&three[1]))
}
