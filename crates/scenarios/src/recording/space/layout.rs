//! The layout of a spatial run: the scene on the left, curves and texts on the right.

use nalgebra::{Point3, Vector3};
use rerun::RecordingStreamResult;
use rerun::blueprint::components::{BackgroundKind, ContainerKind, Eye3DKind};
use rerun::external::re_sdk_types::blueprint::archetypes as blueprint;
use sim::spatial::SceneDescription;

use super::plots::task_plot;
use super::shapes::{plain, plain_vector};
use crate::recording::layout::{Layout, Node};
use crate::recording::{plane_layout, style};

/// Where the eye stands, seen from the middle of the scene: to the front, to the side, above.
const EYE_DIRECTION: [f64; 3] = [1.0, -0.9, 0.55];
/// Plots on a page: of more of them, the axes have one number.
const PLOTS: usize = 3;
/// Distance of the eye over the radius of what is worth seeing.
const EYE_DISTANCE: f64 = 2.0;

/// Writes the layout and returns its root.
pub(super) fn write(layout: &mut Layout, scene: &SceneDescription) -> RecordingStreamResult<Node> {
    let space = space(layout, "scene", &scene.focus_world)?;
    let left = layout.container(ContainerKind::Vertical, "scene", &[&space], &[])?;
    let right = right(layout, scene)?;
    layout.container(ContainerKind::Horizontal, "run", &[&left, &right], &[1.3, 1.0])
}

/// The view of the scene; `focus_world` are middle and radius of what is worth seeing, m.
pub(in crate::recording) fn space(
    layout: &mut Layout,
    name: &str,
    focus_world: &(Point3<f64>, f64),
) -> RecordingStreamResult<Node> {
    let view = layout.view("3D", name, "/world", &["+ /world/**"])?;
    let background = blueprint::Background::new(BackgroundKind::SolidColor).with_color(style::BACKGROUND);
    layout.property(&view, "Background", &background)?;
    let (center, radius_m) = focus_world;
    let eye = center + Vector3::from(EYE_DIRECTION).normalize() * (EYE_DISTANCE * radius_m);
    let controls = blueprint::EyeControls3D::new()
        .with_kind(Eye3DKind::Orbital)
        .with_position(plain(&eye))
        .with_look_target(plain(center))
        .with_eye_up(plain_vector(&Vector3::z()));
    layout.property(&view, "EyeControls3D", &controls)?;
    plane_layout::show_whole(layout, &view, "world/tool_path")?;
    Ok(view)
}

/// Curves by subject: what matters most on the first page, the others behind it, three plots to a page, for all of them to have
/// a readable axis.
fn right(layout: &mut Layout, scene: &SceneDescription) -> RecordingStreamResult<Node> {
    let (main, others) = task_plots(scene);
    let mut first: Vec<Node> =
        main.iter().map(|title| task_view(layout, title)).collect::<RecordingStreamResult<_>>()?;
    if first.is_empty() {
        first.extend(tracking(layout)?);
    }
    if first.len() < PLOTS {
        first.push(force(layout)?);
    }
    let mut pages = vec![page(layout, "run", &first)?];
    for titles in others.chunks(PLOTS) {
        let views: Vec<Node> =
            titles.iter().map(|title| task_view(layout, title)).collect::<RecordingStreamResult<_>>()?;
        pages.push(page(layout, "process", &views)?);
    }
    let mut tool: Vec<Node> = tracking(layout)?.into();
    tool.push(force(layout)?);
    pages.push(page(layout, "tool", &tool)?);
    pages.extend(layout.joints()?);
    pages.push(layout.curves("action", &["+ /plots/state/**"])?);
    let curves = layout.container(ContainerKind::Tabs, "curves", &pages.iter().collect::<Vec<_>>(), &[])?;
    let texts = layout.texts()?;
    layout.container(ContainerKind::Vertical, "curves and texts", &[&curves, &texts], &[2.6, 1.0])
}

/// Titles of the task's plots: those of the first page, and the others.
fn task_plots(scene: &SceneDescription) -> (Vec<&str>, Vec<&str>) {
    let mut titles: Vec<&str> = Vec::new();
    for series in &scene.series {
        if !titles.contains(&series.plot.as_str()) {
            titles.push(&series.plot);
        }
    }
    let named = |title: &&str| scene.main_plots.iter().any(|main| main == title);
    let (mut main, mut others): (Vec<&str>, Vec<&str>) = match scene.main_plots.is_empty() {
        true => (titles, Vec::new()),
        false => titles.into_iter().partition(named),
    };
    let rest = main.split_off(main.len().min(PLOTS));
    others.splice(0..0, rest);
    (main, others)
}

fn task_view(layout: &mut Layout, title: &str) -> RecordingStreamResult<Node> {
    layout.curves(title, &[&format!("+ /plots/{}/**", task_plot(title))])
}

fn tracking(layout: &mut Layout) -> RecordingStreamResult<[Node; 2]> {
    Ok([
        layout.curves("tool to its reference [mm]", &["+ /plots/tracking/distance"])?,
        layout.curves("turn of the tool to its reference [mrad]", &["+ /plots/tracking/angle"])?,
    ])
}

fn force(layout: &mut Layout) -> RecordingStreamResult<Node> {
    layout.curves("force on the tool [N]", &["+ /plots/force/**"])
}

fn page(layout: &mut Layout, name: &str, views: &[Node]) -> RecordingStreamResult<Node> {
    layout.container(ContainerKind::Vertical, name, &views.iter().collect::<Vec<_>>(), &[])
}

#[cfg(test)]
mod tests {
    use sim::spatial::Series;

    use super::*;

    fn scene(plots: &[&str], main: &[&str]) -> SceneDescription {
        let series = |plot: &&str| Series { plot: (*plot).into(), name: "a".into() };
        SceneDescription {
            series: plots.iter().map(series).collect(),
            main_plots: main.iter().map(|plot| (*plot).to_owned()).collect(),
            ..SceneDescription::default()
        }
    }

    #[test]
    fn the_first_page_has_three_plots_of_the_task_at_most_and_no_plot_is_lost() {
        let scene_of_five = scene(&["a", "b", "b", "c", "d", "e"], &[]);
        assert_eq!(task_plots(&scene_of_five), (vec!["a", "b", "c"], vec!["d", "e"]));
        let told = scene(&["a", "b", "b", "c", "d", "e"], &["a", "d"]);
        assert_eq!(task_plots(&told), (vec!["a", "d"], vec!["b", "c", "e"]));
        let too_many = scene(&["a", "b", "c", "d", "e"], &["e", "d", "c", "b"]);
        assert_eq!(task_plots(&too_many), (vec!["b", "c", "d"], vec!["e", "a"]));
        assert_eq!(task_plots(&scene(&[], &[])), (vec![], vec![]));
    }
}
