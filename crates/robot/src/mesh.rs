//! Triangle meshes of links: from the name in the URDF to triangles, within folders that the caller allows.

mod files;
mod locate;

use std::collections::BTreeMap;
use std::path::PathBuf;
use std::sync::Arc;

use nalgebra::{Point3, Vector3};
use thiserror::Error;

use crate::manipulator::Manipulator;
use crate::shape::{Geometry, Shape};
use crate::warning::Warning;

#[cfg(test)]
mod tests;

/// Where the meshes of a URDF may be.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct MeshOptions {
    /// The folder of each package, by its name: what `package://NAME/` and `model://NAME/` stand for.
    pub package_roots: BTreeMap<String, PathBuf>,
    /// The folder of the URDF file, from which relative names start.
    pub base_dir: Option<PathBuf>,
}

/// A surface of triangles in the frame of its shape, scaled.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct TriangleMesh {
    /// Corners (m).
    pub vertices_m: Vec<Point3<f64>>,
    /// Three places in `vertices_m` for each triangle, counter-clockwise seen from outside.
    pub triangles: Vec<[u32; 3]>,
}

impl TriangleMesh {
    /// Scales along each axis; a mirrored mesh keeps its outside.
    fn scaled(&self, scale: &Vector3<f64>) -> Self {
        let vertices_m = self.vertices_m.iter().map(|vertex| vertex.coords.component_mul(scale).into()).collect();
        let mirrored = scale.product() < 0.0;
        let turn = |&[a, b, c]: &[u32; 3]| if mirrored { [a, c, b] } else { [a, b, c] };
        Self { vertices_m, triangles: self.triangles.iter().map(turn).collect() }
    }
}

/// What prevents the use of a mesh.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[non_exhaustive]
pub enum MeshProblem {
    /// Nobody has asked for the meshes yet.
    #[error("meshes are not read with the URDF; resolve them if they are to be used")]
    NotResolved,
    /// The name stands for a package whose folder is not known.
    #[error("the folder of package `{package}` is not known; give it as a package root")]
    UnknownPackage {
        /// The package.
        package: String,
    },
    /// The name is relative, and the folder of the URDF file is not known.
    #[error("the name is relative; give the folder of the URDF file as base folder")]
    NoBaseDir,
    /// The name is no file name and no `package://`, `model://` or `file://`.
    #[error("expected a file name, package://, model:// or file://")]
    UnsupportedScheme,
    /// The file lies outside of all allowed folders.
    #[error("{} lies outside of the package roots and the folder of the URDF; move it there or add its folder", path.display())]
    Outside {
        /// The file.
        path: PathBuf,
    },
    /// There is no such file.
    #[error("{} is not a file that can be read", path.display())]
    NotFound {
        /// The file.
        path: PathBuf,
    },
    /// The format is not known.
    #[error("expected .stl or .obj; convert it")]
    UnsupportedFormat,
    /// The file does not hold what its name says.
    #[error("{} does not read ({reason}); export it again", path.display())]
    Unreadable {
        /// The file.
        path: PathBuf,
        /// The reader's own words.
        reason: String,
    },
}

type Loaded = Result<Arc<TriangleMesh>, MeshProblem>;

impl Manipulator {
    /// Reads the meshes of all shapes, STL (binary and text) and OBJ, from files in the allowed folders.
    ///
    /// A shape whose mesh cannot be read is left out, and a [`Warning::MeshIgnored`] says why: no mesh stops an arm from
    /// being used. Names that lead out of the allowed folders, by `..`, by an absolute path or by a link of the file
    /// system, are such a case. This is the only function of the crate that touches files; without it shapes of
    /// meshes stay in the model without triangles.
    pub fn resolve_meshes(&mut self, options: &MeshOptions) {
        self.warnings.retain(|warning| !matches!(warning, Warning::MeshIgnored { .. }));
        let mut loaded = BTreeMap::new();
        let warnings = &mut self.warnings;
        for body in self.joints.iter_mut().map(|joint| &mut joint.body).chain([&mut self.base]) {
            for shapes in [&mut body.visuals, &mut body.collisions] {
                shapes.retain_mut(|shape| fill(shape, options, &mut loaded, warnings));
            }
        }
    }
}

/// Gives a shape its triangles; false if it has none.
fn fill(
    shape: &mut Shape,
    options: &MeshOptions,
    loaded: &mut BTreeMap<(String, [u64; 3]), Loaded>,
    warnings: &mut Vec<Warning>,
) -> bool {
    let Geometry::Mesh { uri, scale, triangles } = &mut shape.geometry else { return true };
    let key = (uri.clone(), [scale.x.to_bits(), scale.y.to_bits(), scale.z.to_bits()]);
    match loaded.entry(key).or_insert_with(|| load(uri, scale, options)) {
        Ok(mesh) => {
            *triangles = Some(Arc::clone(mesh));
            true
        }
        Err(problem) => {
            let warning = Warning::MeshIgnored { link: shape.link.clone(), uri: uri.clone(), problem: problem.clone() };
            if !warnings.contains(&warning) {
                warnings.push(warning);
            }
            false
        }
    }
}

fn load(uri: &str, scale: &Vector3<f64>, options: &MeshOptions) -> Loaded {
    let path = locate::locate(uri, options)?;
    let mesh = files::read(&path)?.scaled(scale);
    if mesh.vertices_m.iter().all(|vertex| vertex.iter().all(|value| value.is_finite())) {
        Ok(Arc::new(mesh))
    } else {
        Err(MeshProblem::Unreadable { path, reason: "a coordinate is not finite".to_owned() })
    }
}
