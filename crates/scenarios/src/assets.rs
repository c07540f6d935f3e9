//! Assets: where tools, robots, demonstrations, skills and the like are found, and that no name leads out of that folder.

use std::io;
use std::path::{Path, PathBuf};

/// Environment variable that names the folder of assets.
pub const ASSETS_VARIABLE: &str = "WIELD_ASSETS";

/// The folder in which tools, robots, demonstrations, skills and the like are found by name.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Assets {
    root: PathBuf,
}

/// A kind of asset: a folder of files of one type.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum AssetKind {
    /// Tool shapes, `tools/*.toml`.
    Tool,
    /// Arms, `robots/*.urdf`.
    Robot,
    /// Recorded demonstrations, `demonstrations/*.csv`.
    Demonstration,
    /// Learned skills, `skills/*.toml`.
    Skills,
    /// What is cut, `foods/*.toml`.
    Food,
    /// What cuts, `knives/*.toml`.
    Knife,
    /// What is poured from or into, `containers/*.toml`.
    Container,
}

impl AssetKind {
    /// Folder inside the folder of assets.
    #[must_use]
    pub const fn folder(self) -> &'static str {
        match self {
            Self::Tool => "tools",
            Self::Robot => "robots",
            Self::Demonstration => "demonstrations",
            Self::Skills => "skills",
            Self::Food => "foods",
            Self::Knife => "knives",
            Self::Container => "containers",
        }
    }

    /// Ending of the files, without its dot.
    #[must_use]
    pub fn extension(self) -> &'static str {
        match self {
            Self::Tool | Self::Skills | Self::Food | Self::Knife | Self::Container => "toml",
            Self::Robot => "urdf",
            Self::Demonstration => "csv",
        }
    }

    /// What one of them is called.
    #[must_use]
    pub const fn noun(self) -> &'static str {
        match self {
            Self::Tool => "tool",
            Self::Robot => "robot",
            Self::Demonstration => "demonstration",
            Self::Skills => "file of skills",
            Self::Food => "food",
            Self::Knife => "knife",
            Self::Container => "container",
        }
    }
}

/// Why a name leads to no asset.
#[derive(Debug, thiserror::Error)]
pub enum AssetError {
    /// The name, or a symbolic link behind it, leads out of the folder of assets.
    #[error("path escaping the project")]
    Escapes,
    /// There is no such file.
    #[error("no file {}", path.display())]
    Unknown {
        /// The file looked for.
        path: PathBuf,
        /// Names that exist.
        known: Vec<String>,
    },
    /// The file system refused.
    #[error("cannot read {}: {source}", path.display())]
    Unreadable {
        /// The file.
        path: PathBuf,
        /// The system's reason.
        source: io::Error,
    },
}

impl Assets {
    /// Takes `root` as the folder of assets, whether it exists or not.
    #[must_use]
    pub fn at(root: impl Into<PathBuf>) -> Self {
        Self { root: root.into() }
    }

    /// Finds the folder of assets: `explicit`, else the environment variable [`ASSETS_VARIABLE`], else the folder
    /// `assets` in the nearest ancestor of `scenario` that has one, else in that of the current directory.
    ///
    /// If there is none, the folder that would be used is `assets` in the current directory.
    #[must_use]
    pub fn find(explicit: Option<&Path>, scenario: Option<&Path>) -> Self {
        let from_environment =
            || std::env::var_os(ASSETS_VARIABLE).filter(|value| !value.is_empty()).map(PathBuf::from);
        let named = explicit.map(Path::to_owned).or_else(from_environment);
        let near_scenario = || scenario.and_then(Path::parent).and_then(assets_above);
        let root = named.or_else(near_scenario).or_else(|| assets_above(Path::new("")));
        Self::at(root.unwrap_or_else(|| "assets".into()))
    }

    /// The folder.
    #[must_use]
    pub fn root(&self) -> &Path {
        &self.root
    }

    /// Names of all assets of a kind, sorted; empty if there is no such folder.
    #[must_use]
    pub fn list(&self, kind: AssetKind) -> Vec<String> {
        stems(&self.root.join(kind.folder()), kind.extension())
    }

    /// Path of the file of an asset.
    ///
    /// # Errors
    /// An [`AssetError`]; a name with separators or a leading dot is refused before any file is touched.
    pub fn path(&self, kind: AssetKind, name: &str) -> Result<PathBuf, AssetError> {
        if name.starts_with('.') || name.contains(['/', '\\', '\0']) || name.contains("..") {
            return Err(AssetError::Escapes);
        }
        let path = self.root.join(kind.folder()).join(format!("{name}.{}", kind.extension()));
        let resolved = match path.canonicalize() {
            Ok(resolved) => resolved,
            Err(error) if error.kind() == io::ErrorKind::NotFound => {
                return Err(AssetError::Unknown { path, known: self.list(kind) });
            }
            Err(source) => return Err(AssetError::Unreadable { path, source }),
        };
        match self.root.canonicalize() {
            Ok(root) if resolved.starts_with(&root) => Ok(path),
            Ok(_) => Err(AssetError::Escapes),
            Err(source) => Err(AssetError::Unreadable { path: self.root.clone(), source }),
        }
    }
}

/// Names, without ending, of the files of a folder that end in `extension`, sorted; empty if there is no such folder.
#[must_use]
pub fn stems(folder: &Path, extension: &str) -> Vec<String> {
    let entries = std::fs::read_dir(folder).into_iter().flatten().flatten();
    let files =
        entries.map(|entry| entry.path()).filter(|path| path.extension().is_some_and(|found| found == extension));
    let mut names: Vec<String> = files.filter_map(|path| Some(path.file_stem()?.to_str()?.to_owned())).collect();
    names.sort();
    names
}

/// The folder `assets` in `folder` or in the nearest of its ancestors that has one.
fn assets_above(folder: &Path) -> Option<PathBuf> {
    let folder = if folder.as_os_str().is_empty() { Path::new(".") } else { folder };
    let here = folder.join("assets");
    if here.is_dir() {
        return Some(if folder == Path::new(".") { "assets".into() } else { here });
    }
    let absolute = folder.canonicalize().ok()?;
    absolute.ancestors().skip(1).map(|ancestor| ancestor.join("assets")).find(|candidate| candidate.is_dir())
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::fs;

    fn folder() -> tempfile::TempDir {
        let folder = tempfile::tempdir().unwrap();
        fs::create_dir_all(folder.path().join("assets/tools")).unwrap();
        fs::create_dir_all(folder.path().join("scenarios/deep")).unwrap();
        fs::write(folder.path().join("assets/tools/stick.toml"), "").unwrap();
        fs::write(folder.path().join("assets/tools/notes.txt"), "").unwrap();
        folder
    }

    #[test]
    fn a_scenario_finds_the_assets_of_its_nearest_ancestor() {
        let folder = folder();
        let found = Assets::find(None, Some(&folder.path().join("scenarios/deep/a.toml")));
        assert_eq!(found.root().canonicalize().unwrap(), folder.path().join("assets").canonicalize().unwrap());
        assert_eq!(found.list(AssetKind::Tool), ["stick"]);
    }

    #[test]
    fn an_explicit_folder_wins() {
        assert_eq!(Assets::find(Some(Path::new("/x")), None).root(), Path::new("/x"));
    }

    #[test]
    fn names_that_lead_elsewhere_are_refused_before_any_file_access() {
        let nowhere = Assets::at("/does/not/exist");
        for name in ["../stick", "a/b", "a\\b", "..", ".hidden", "a..b/", "a\0b"] {
            assert!(matches!(nowhere.path(AssetKind::Tool, name), Err(AssetError::Escapes)), "{name}");
        }
    }

    #[test]
    fn an_unknown_name_lists_what_exists() {
        let folder = folder();
        let assets = Assets::at(folder.path().join("assets"));
        let Err(AssetError::Unknown { known, .. }) = assets.path(AssetKind::Tool, "stik") else { panic!() };
        assert_eq!(known, ["stick"]);
        assert!(assets.path(AssetKind::Tool, "stick").is_ok());
    }

    #[cfg(unix)]
    #[test]
    fn a_link_out_of_the_folder_is_refused() {
        let folder = folder();
        fs::write(folder.path().join("secret.toml"), "").unwrap();
        std::os::unix::fs::symlink(folder.path().join("secret.toml"), folder.path().join("assets/tools/link.toml"))
            .unwrap();
        let assets = Assets::at(folder.path().join("assets"));
        assert!(matches!(assets.path(AssetKind::Tool, "link"), Err(AssetError::Escapes)));
    }
}
