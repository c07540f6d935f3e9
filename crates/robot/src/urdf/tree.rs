//! How joints connect links: one root, one parent each, no loop.

use std::collections::HashMap;

use urdf_rs::Robot;

use crate::error::RobotError;

/// The links as a tree, by index into the parsed robot.
#[derive(Debug)]
pub(crate) struct Tree {
    pub root: usize,
    /// For each link, its child joints and the links they carry, in the order of the file.
    pub children: Vec<Vec<(usize, usize)>>,
}

impl Tree {
    pub fn new(robot: &Robot) -> Result<Self, RobotError> {
        let links: HashMap<&str, usize> = robot.links.iter().map(|link| link.name.as_str()).zip(0..).collect();
        let mut children = vec![Vec::new(); robot.links.len()];
        let mut parents: Vec<Option<usize>> = vec![None; robot.links.len()];
        for (index, joint) in robot.joints.iter().enumerate() {
            let (name, parent_name, child_name) = (&joint.name, &joint.parent.link, &joint.child.link);
            let parent = links
                .get(parent_name.as_str())
                .copied()
                .ok_or_else(|| RobotError::UnknownParent { joint: name.clone(), link: parent_name.clone() })?;
            let child = links
                .get(child_name.as_str())
                .copied()
                .ok_or_else(|| RobotError::UnknownChild { joint: name.clone(), link: child_name.clone() })?;
            if let Some(first) = parents[child] {
                return Err(RobotError::SeveralParents {
                    link: child_name.clone(),
                    first: robot.joints[first].name.clone(),
                    second: name.clone(),
                });
            }
            parents[child] = Some(index);
            children[parent].push((index, child));
        }
        let root = find_root(robot, &parents)?;
        check_connected(robot, root, &children)?;
        Ok(Self { root, children })
    }
}

fn find_root(robot: &Robot, parents: &[Option<usize>]) -> Result<usize, RobotError> {
    let roots: Vec<usize> = (0..parents.len()).filter(|&link| parents[link].is_none()).collect();
    match (roots.as_slice(), robot.links.first()) {
        (_, None) => Err(RobotError::NoLinks),
        ([], Some(link)) => Err(RobotError::Cycle { link: link.name.clone() }),
        ([root], _) => Ok(*root),
        (roots, _) => {
            let roots = roots.iter().map(|&root| robot.links[root].name.clone()).collect();
            Err(RobotError::SeveralRoots { roots })
        }
    }
}

/// With one root and one parent each, links that the root does not reach are on a loop or hang from one.
fn check_connected(robot: &Robot, root: usize, children: &[Vec<(usize, usize)>]) -> Result<(), RobotError> {
    let mut reached = vec![false; children.len()];
    let mut open = vec![root];
    while let Some(link) = open.pop() {
        reached[link] = true;
        open.extend(children[link].iter().map(|(_, child)| *child));
    }
    match reached.iter().position(|reached| !reached) {
        Some(link) => Err(RobotError::Cycle { link: robot.links[link].name.clone() }),
        None => Ok(()),
    }
}
