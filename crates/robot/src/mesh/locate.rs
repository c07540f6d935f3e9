//! From the name of a mesh to a file in one of the allowed folders.

use std::path::{Path, PathBuf};

use crate::mesh::{MeshOptions, MeshProblem};

/// Prefixes of names that begin with a package.
const PACKAGE_SCHEMES: [&str; 2] = ["package://", "model://"];

/// Returns the file's true path, without links and `..`.
pub(super) fn locate(uri: &str, options: &MeshOptions) -> Result<PathBuf, MeshProblem> {
    let wanted = wanted_path(uri, options)?;
    let path = wanted.canonicalize().map_err(|_| MeshProblem::NotFound { path: wanted.clone() })?;
    let roots = options.package_roots.values().chain(&options.base_dir);
    // compared after links are followed, so that neither `..` nor a link leads out
    let inside = roots.filter_map(|root| root.canonicalize().ok()).any(|root| path.starts_with(root));
    if !inside {
        return Err(MeshProblem::Outside { path: wanted });
    }
    // pipes and devices would be waited for
    if path.is_file() { Ok(path) } else { Err(MeshProblem::NotFound { path: wanted }) }
}

fn wanted_path(uri: &str, options: &MeshOptions) -> Result<PathBuf, MeshProblem> {
    if let Some(name) = PACKAGE_SCHEMES.iter().find_map(|scheme| uri.strip_prefix(scheme)) {
        let (package, inside) = name.split_once('/').unwrap_or((name, ""));
        let root = options.package_roots.get(package);
        let root = root.ok_or_else(|| MeshProblem::UnknownPackage { package: package.to_owned() })?;
        return Ok(root.join(inside.trim_start_matches('/')));
    }
    let path = Path::new(uri.strip_prefix("file://").unwrap_or(uri));
    if path.is_absolute() {
        return Ok(path.to_owned());
    }
    if uri.contains("://") && !uri.starts_with("file://") {
        return Err(MeshProblem::UnsupportedScheme);
    }
    options.base_dir.as_ref().map(|base| base.join(path)).ok_or(MeshProblem::NoBaseDir)
}
