//! Convex polygons in a plane: area, chords, overlap and difference. Vertices run counterclockwise.

use nalgebra::Point2;

/// Returns the area of a polygon, positive if its vertices run counterclockwise, m².
#[must_use]
pub fn area(outline: &[Point2<f64>]) -> f64 {
    let Some(first) = outline.first() else { return 0.0 };
    outline.windows(2).map(|pair| (pair[0] - first).perp(&(pair[1] - first))).sum::<f64>() / 2.0
}

/// Returns the length that the line y = `y_m` has inside a convex polygon; just below the line where it follows an edge, m.
#[must_use]
pub fn chord(outline: &[Point2<f64>], y_m: f64) -> f64 {
    let crossings = edges(outline).filter(|(from, to)| (from.y <= y_m) != (to.y <= y_m)).map(|(from, to)| {
        let (upper, lower) = if from.y <= y_m { (from, to) } else { (to, from) };
        upper.x + (lower.x - upper.x) * ((y_m - upper.y) / (lower.y - upper.y))
    });
    let (low, high) = crossings.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| (low.min(x), high.max(x)));
    (high - low).max(0.0)
}

/// Does `point` lie inside a convex polygon or on its outline?
#[must_use]
pub fn contains(outline: &[Point2<f64>], point: &Point2<f64>) -> bool {
    outline.len() >= 3 && edges(outline).all(|(from, to)| left_of(&from, &to, point) >= 0.0)
}

/// Returns what two convex polygons share; fewer than three vertices if they do not overlap.
#[must_use]
pub fn overlap(one: &[Point2<f64>], other: &[Point2<f64>]) -> Vec<Point2<f64>> {
    edges(other).fold(one.to_vec(), |left, (from, to)| halves(&left, &from, &to).0)
}

/// Returns what is left of a convex polygon when others are taken out of it, as convex polygons with disjoint interiors.
///
/// Parts of less than `smallest_m2` are left out.
#[must_use]
pub fn difference(outline: &[Point2<f64>], others: &[Vec<Point2<f64>>], smallest_m2: f64) -> Vec<Vec<Point2<f64>>> {
    others.iter().fold(vec![outline.to_vec()], |parts, other| {
        parts.into_iter().flat_map(|part| without(part, other, smallest_m2)).collect()
    })
}

/// What is left of `part` outside of `other`: one strip along each edge of `other`.
fn without(part: Vec<Point2<f64>>, other: &[Point2<f64>], smallest_m2: f64) -> Vec<Vec<Point2<f64>>> {
    if area(&overlap(&part, other)) < smallest_m2 {
        return vec![part];
    }
    let mut rest = part;
    let mut strips = Vec::new();
    for (from, to) in edges(other) {
        let (inside, outside) = halves(&rest, &from, &to);
        if area(&outside) >= smallest_m2 {
            strips.push(outside);
        }
        rest = inside;
    }
    strips
}

/// The parts of a convex polygon on the left and on the right of the line through two points.
fn halves(outline: &[Point2<f64>], from: &Point2<f64>, to: &Point2<f64>) -> (Vec<Point2<f64>>, Vec<Point2<f64>>) {
    let mut parts = (Vec::with_capacity(outline.len() + 2), Vec::with_capacity(outline.len() + 2));
    for (here, next) in edges(outline) {
        let (at_here, at_next) = (left_of(from, to, &here), left_of(from, to, &next));
        if at_here >= 0.0 {
            parts.0.push(here);
        }
        if at_here <= 0.0 {
            parts.1.push(here);
        }
        if at_here * at_next < 0.0 {
            let crossing = here + (next - here) * (at_here / (at_here - at_next));
            parts.0.push(crossing);
            parts.1.push(crossing);
        }
    }
    parts
}

/// The edges of a polygon, each from one vertex to the next.
fn edges(outline: &[Point2<f64>]) -> impl Iterator<Item = (Point2<f64>, Point2<f64>)> + '_ {
    outline.iter().copied().zip(outline.iter().copied().cycle().skip(1))
}

/// Twice the area of the triangle of a line's two points and a third one: positive if that lies on the line's left.
fn left_of(from: &Point2<f64>, to: &Point2<f64>, point: &Point2<f64>) -> f64 {
    (to - from).perp(&(point - from))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Sums of a few products of numbers of the order of 1.
    const ROUNDING: f64 = 1e-14;

    fn square(x: f64, y: f64, side: f64) -> Vec<Point2<f64>> {
        [[x, y], [x + side, y], [x + side, y + side], [x, y + side]].map(Point2::from).to_vec()
    }

    fn disc(x: f64, y: f64, radius: f64, sides: usize) -> Vec<Point2<f64>> {
        let angle = |side: usize| std::f64::consts::TAU * side as f64 / sides as f64;
        (0..sides).map(|side| Point2::new(x + radius * angle(side).cos(), y + radius * angle(side).sin())).collect()
    }

    #[test]
    fn overlap_and_difference_make_up_the_whole() {
        let one = disc(0.0, 0.0, 1.0, 24);
        let others = [square(0.2, -0.3, 1.0), square(-2.0, 0.1, 1.5), disc(0.1, -1.0, 0.4, 7)];
        let taken: f64 = others.iter().map(|other| area(&overlap(&one, other))).sum();
        let left: f64 = difference(&one, &others, 0.0).iter().map(|part| area(part)).sum();
        let lens = area(&overlap(&others[0], &others[2]));
        assert!((taken - lens + left - area(&one)).abs() < ROUNDING, "taken {taken}, left {left}");
    }

    #[test]
    fn nothing_is_left_of_a_polygon_taken_out_of_itself() {
        let one = disc(0.3, 0.1, 1.0, 32);
        assert!(difference(&one, std::slice::from_ref(&one), 1e-12).is_empty());
    }

    #[test]
    fn polygons_apart_leave_each_other_whole() {
        let (one, other) = (square(0.0, 0.0, 1.0), square(1.0, 0.0, 1.0));
        assert_eq!(difference(&one, std::slice::from_ref(&other), 1e-12), vec![one.clone()]);
        assert_eq!(area(&overlap(&one, &other)), 0.0);
    }

    #[test]
    fn chord_of_a_fine_disc_is_that_of_a_circle() {
        let outline = disc(0.0, 0.0, 1.0, 400);
        for y in [-0.9, -0.2, 0.0, 0.55] {
            let circle = 2.0 * (1.0_f64 - y * y).sqrt();
            // the sagitta of one of 400 sides is 3e-5 of the radius; across a steep chord it shows as less than 2e-4
            assert!((chord(&outline, y) - circle).abs() < 2e-4, "at {y}");
        }
    }
}
