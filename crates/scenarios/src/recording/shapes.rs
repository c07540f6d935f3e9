//! Shapes as strips of lines: closed outlines, filled insides, dashes, crosses.

use nalgebra::{Isometry2, Point, Point2};
use skills::outline::PlacedOutline;

/// A line through points, as Rerun takes it.
pub(super) type Strip = Vec<[f32; 2]>;

/// Corners of a drawn circle.
const ARC_POINTS: usize = 72;

/// Lines that fill an inside.
const FILL_LINES: u32 = 40;

/// A point as Rerun takes it.
pub(super) fn plain(point: &Point2<f64>) -> [f32; 2] {
    [point.x as f32, point.y as f32]
}

/// Corners of an outline in the larger frame, counterclockwise.
pub(super) fn corners(outline: &PlacedOutline) -> Vec<Point2<f64>> {
    let pose = outline.pose();
    outline.shape.drawing(ARC_POINTS).into_iter().map(|corner| pose * Point2::from(corner)).collect()
}

/// The outline as a closed strip.
pub(super) fn closed(corners: &[Point2<f64>]) -> Strip {
    corners.iter().chain(corners.first()).map(plain).collect()
}

/// A circle as a closed strip.
pub(super) fn circle(center: &Point2<f64>, radius_m: f64) -> Strip {
    let outline = PlacedOutline {
        shape: skills::outline::Outline::Disc { radius_m },
        position_m: [center.x, center.y],
        angle_rad: 0.0,
    };
    closed(&corners(&outline))
}

/// The inside of a convex polygon as horizontal lines, with half their width: Rerun fills no polygons in the plane.
pub(super) fn filled(corners: &[Point2<f64>]) -> (Vec<Strip>, f32) {
    let low = corners.iter().map(|corner| corner.y).fold(f64::INFINITY, f64::min);
    let high = corners.iter().map(|corner| corner.y).fold(f64::NEG_INFINITY, f64::max);
    let width = (high - low) / f64::from(FILL_LINES);
    let lines = (0..FILL_LINES).filter_map(|line| {
        let y = low + width * (f64::from(line) + 0.5);
        let (left, right) = crossing(corners, y)?;
        // lines have round ends: they begin and end half a width inside
        let inset = (0.55 * width).min(0.5 * (right - left));
        Some(vec![plain(&Point2::new(left + inset, y)), plain(&Point2::new(right - inset, y))])
    });
    // a little wider than the distance of the lines: no gaps
    (lines.collect(), (0.55 * width) as f32)
}

/// Where a horizontal line enters and leaves a convex polygon.
fn crossing(corners: &[Point2<f64>], y: f64) -> Option<(f64, f64)> {
    let next = corners.iter().cycle().skip(1);
    let at = corners.iter().zip(next).filter(|(a, b)| (a.y > y) != (b.y > y));
    let xs = at.map(|(a, b)| a.x + (b.x - a.x) * (y - a.y) / (b.y - a.y));
    xs.fold(None, |span: Option<(f64, f64)>, x| Some(span.map_or((x, x), |(low, high)| (low.min(x), high.max(x)))))
}

/// A path as dashes of `dash_m` with gaps as long.
pub(super) fn dashed<const D: usize>(path: &[Point<f64, D>], dash_m: f64) -> Vec<Vec<[f32; D]>> {
    let plain = |point: &Point<f64, D>| point.coords.map(|value| value as f32).into();
    let mut strips = Vec::new();
    let mut strip: Vec<[f32; D]> = path.first().map(plain).into_iter().collect();
    let (mut drawing, mut left) = (true, dash_m);
    for (start, end) in path.iter().zip(path.iter().skip(1)) {
        let length = (end - start).norm();
        let mut along = 0.0;
        while length - along > left && left > 0.0 {
            along += left;
            let point = plain(&(start + (end - start) * (along / length)));
            if drawing {
                strip.push(point);
                strips.push(std::mem::take(&mut strip));
            } else {
                strip = vec![point];
            }
            (drawing, left) = (!drawing, dash_m);
        }
        left -= length - along;
        if drawing {
            strip.push(plain(end));
        }
    }
    strips.extend(Some(strip).filter(|strip| strip.len() > 1));
    strips
}

/// A cross of two strokes, upright in the frame of `pose`.
pub(super) fn cross(pose: &Isometry2<f64>, half_m: f64) -> [[[f32; 2]; 2]; 2] {
    let at = |x: f64, y: f64| plain(&(pose * Point2::new(x, y)));
    [[at(-half_m, 0.0), at(half_m, 0.0)], [at(0.0, -half_m), at(0.0, half_m)]]
}

#[cfg(test)]
mod tests {
    use super::*;

    fn square() -> Vec<Point2<f64>> {
        [[0.0, 0.0], [2.0, 0.0], [2.0, 2.0], [0.0, 2.0]].map(Point2::from).to_vec()
    }

    #[test]
    fn an_outline_is_closed() {
        let strip = closed(&square());
        assert_eq!((strip.len(), strip.first()), (5, strip.last()));
        assert!(closed(&[]).is_empty());
    }

    #[test]
    fn a_square_is_filled_from_side_to_side() {
        let (lines, half_width) = filled(&square());
        assert_eq!(lines.len(), FILL_LINES as usize);
        let reaches =
            |line: &Strip| (line[0][0] - half_width).abs() < 1e-6 && (line[1][0] + half_width - 2.0).abs() < 1e-6;
        assert!(lines.iter().all(reaches));
    }

    #[test]
    fn half_of_a_path_is_dashes() {
        let path = [[0.0, 0.0], [0.75, 0.0], [0.75, 1.2]].map(Point2::from);
        let strips = dashed(&path, 0.1);
        let length = |strip: &Strip| {
            strip.windows(2).map(|pair| (pair[1][0] - pair[0][0]).hypot(pair[1][1] - pair[0][1])).sum::<f32>()
        };
        assert_eq!(strips.len(), 10);
        assert!((strips.iter().map(length).sum::<f32>() - 1.0).abs() < 1e-5);
    }

    #[test]
    fn a_path_without_length_has_no_dashes() {
        assert!(dashed::<2>(&[], 0.1).is_empty());
        assert!(dashed(&[Point2::origin()], 0.1).is_empty());
    }
}
