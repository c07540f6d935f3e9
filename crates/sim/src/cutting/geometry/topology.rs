//! Which faces meet at which edges, by indices alone.

use super::GeometryError;

/// Checks that every edge is shared by exactly two faces that run along it in opposite directions.
pub(super) fn check_closed(vertices: usize, faces: &[Vec<usize>]) -> Result<(), GeometryError> {
    for (face, corners) in faces.iter().enumerate() {
        let found = match corners {
            _ if corners.len() < 3 => format!("has {} vertices", corners.len()),
            _ if corners.iter().any(|&corner| corner >= vertices) => "names a vertex that does not exist".into(),
            _ => continue,
        };
        return Err(GeometryError::Face { face, found, vertices });
    }
    let mut edges = faces.iter().flat_map(|corners| directed_edges(corners)).collect::<Vec<_>>();
    edges.sort_unstable();
    for &(from, to) in &edges {
        let against = count_of(&edges, (to, from));
        if against != 1 || count_of(&edges, (from, to)) != 1 {
            return Err(GeometryError::Open { from, to, found: against });
        }
    }
    Ok(())
}

/// The closed loops of edges that `faces` run along once, in the direction in which they run.
///
/// They are looked for between the corners that are `likely`, and among all if that leaves a loop open. Every vertex has as
/// many edges in as out, so that a walk ends where it began.
pub(super) fn boundary_loops(faces: &[&[usize]], likely: impl Fn(usize) -> bool) -> Vec<Vec<usize>> {
    let edges = || faces.iter().flat_map(|corners| directed_edges(corners));
    let likely = walks(edges().filter(|&(from, to)| likely(from) && likely(to)).collect());
    likely.or_else(|| walks(edges().collect())).unwrap_or_default()
}

/// Joins the edges that have no opposite to closed walks; none if a walk stays open.
fn walks(mut edges: Vec<(usize, usize)>) -> Option<Vec<Vec<usize>>> {
    edges.sort_unstable_by_key(|&(from, to)| (from.min(to), from.max(to), from > to));
    let mut open =
        edges.chunk_by(|one, other| undirected(one) == undirected(other)).flat_map(unpaired).collect::<Vec<_>>();
    let mut loops = Vec::new();
    while !open.is_empty() {
        loops.push(take_loop(&mut open)?);
    }
    Some(loops)
}

/// Takes one closed walk out of the edges that are left; none if it cannot be closed.
fn take_loop(open: &mut Vec<(usize, usize)>) -> Option<Vec<usize>> {
    let (start, mut here) = open.remove(0);
    let mut walk = vec![start];
    while here != start {
        walk.push(here);
        let next = open.iter().position(|&(from, _)| from == here)?;
        here = open.remove(next).1;
    }
    Some(walk)
}

/// The edges of one pair of vertices that are left when opposite ones cancel.
fn unpaired(edges: &[(usize, usize)]) -> Vec<(usize, usize)> {
    let (up, down): (Vec<_>, Vec<_>) = edges.iter().copied().partition(|(from, to)| from < to);
    let paired = up.len().min(down.len());
    up.into_iter().skip(paired).chain(down.into_iter().skip(paired)).collect()
}

fn undirected(&(from, to): &(usize, usize)) -> (usize, usize) {
    (from.min(to), from.max(to))
}

/// The edges of a face, in the direction in which it runs.
fn directed_edges(corners: &[usize]) -> impl Iterator<Item = (usize, usize)> + '_ {
    corners.iter().copied().zip(corners.iter().copied().cycle().skip(1))
}

/// How often an edge stands in a sorted list.
fn count_of(sorted: &[(usize, usize)], edge: (usize, usize)) -> usize {
    let from = sorted.partition_point(|other| *other < edge);
    sorted[from..].iter().take_while(|&&other| other == edge).count()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn two_faces_side_by_side_have_one_outline() {
        let faces: [&[usize]; 2] = [&[0, 1, 2], &[0, 2, 3]];
        assert_eq!(boundary_loops(&faces, |_| true), vec![vec![0, 1, 2, 3]]);
    }

    #[test]
    fn a_loop_that_runs_over_unlikely_corners_is_found_too() {
        let faces: [&[usize]; 2] = [&[0, 1, 2], &[0, 2, 3]];
        assert_eq!(boundary_loops(&faces, |corner| corner != 1), vec![vec![0, 1, 2, 3]]);
    }

    #[test]
    fn a_closed_surface_has_no_outline() {
        let faces = [vec![0, 2, 1], vec![0, 1, 3], vec![1, 2, 3], vec![2, 0, 3]];
        assert!(boundary_loops(&faces.each_ref().map(Vec::as_slice), |_| true).is_empty());
        assert!(check_closed(4, &faces).is_ok());
    }

    #[test]
    fn an_open_surface_is_refused_with_its_edge() {
        let faces = [vec![0, 2, 1], vec![0, 1, 3], vec![1, 2, 3]];
        let error = check_closed(4, &faces).unwrap_err();
        assert!(matches!(error, GeometryError::Open { found: 0, .. }), "{error}");
    }
}
