//! Triangles out of STL and OBJ files.

use std::io::Cursor;
use std::path::Path;

use nalgebra::Point3;

use crate::mesh::{MeshProblem, TriangleMesh};

/// Header and count of a binary STL file (bytes).
const BINARY_STL_HEAD: usize = 84;
/// One triangle of a binary STL file (bytes).
const BINARY_STL_TRIANGLE: usize = 50;

/// Reads the file, by the ending of its name.
pub(super) fn read(path: &Path) -> Result<TriangleMesh, MeshProblem> {
    let ending = path.extension().and_then(|ending| ending.to_str()).map(str::to_ascii_lowercase);
    let parse = match ending.as_deref() {
        Some("stl") => parse_stl,
        Some("obj") => parse_obj,
        _ => return Err(MeshProblem::UnsupportedFormat),
    };
    let unreadable = |reason: String| MeshProblem::Unreadable { path: path.to_owned(), reason };
    let bytes = std::fs::read(path).map_err(|error| unreadable(error.to_string()))?;
    let mesh = parse(bytes).map_err(unreadable)?;
    if mesh.triangles.is_empty() { Err(unreadable("it holds no triangle".to_owned())) } else { Ok(mesh) }
}

pub(super) fn parse_stl(mut bytes: Vec<u8>) -> Result<TriangleMesh, String> {
    let solid = bytes.starts_with(b"solid");
    if solid && is_binary_stl(&bytes) {
        // the reader takes every file that begins so for text, but many programs write it into binary headers
        bytes[..5].fill(b' ');
    } else if solid && bytes.get(5).is_some_and(|byte| byte.is_ascii_control()) {
        // a solid without a name; the reader expects a blank
        bytes.insert(5, b' ');
    }
    let read = stl_io::read_stl(&mut Cursor::new(bytes)).map_err(|error| error.to_string())?;
    let place = |index: usize| u32::try_from(index).map_err(|_| "it has more than 2³² corners".to_owned());
    Ok(TriangleMesh {
        vertices_m: read.vertices.iter().map(|vertex| Point3::from(vertex.0.map(f64::from))).collect(),
        triangles: read
            .faces
            .iter()
            .map(|face| {
                let [a, b, c] = face.vertices;
                Ok([place(a)?, place(b)?, place(c)?])
            })
            .collect::<Result<_, String>>()?,
    })
}

/// True if the length is just what the count of triangles asks for.
fn is_binary_stl(bytes: &[u8]) -> bool {
    let count = bytes.get(BINARY_STL_HEAD - 4..BINARY_STL_HEAD).and_then(|count| <[u8; 4]>::try_from(count).ok());
    let length = count.map(|count| BINARY_STL_HEAD + BINARY_STL_TRIANGLE * u32::from_le_bytes(count) as usize);
    length == Some(bytes.len())
}

pub(super) fn parse_obj(bytes: Vec<u8>) -> Result<TriangleMesh, String> {
    let options =
        tobj::LoadOptions { triangulate: true, ignore_points: true, ignore_lines: true, ..Default::default() };
    let corners = only_corners(&String::from_utf8_lossy(&bytes));
    let no_materials = |_: &Path| Err(tobj::LoadError::GenericFailure);
    let (models, _) =
        tobj::load_obj_buf(&mut Cursor::new(corners), &options, no_materials).map_err(|error| error.to_string())?;
    let mut mesh = TriangleMesh::default();
    for model in models {
        let first = u32::try_from(mesh.vertices_m.len()).map_err(|_| "it has more than 2³² corners".to_owned())?;
        let positions = model.mesh.positions.as_chunks::<3>().0;
        mesh.vertices_m.extend(positions.iter().map(|&position| Point3::from(position)));
        let triangles = model.mesh.indices.as_chunks::<3>().0;
        mesh.triangles.extend(triangles.iter().map(|triangle| triangle.map(|corner| first + corner)));
    }
    Ok(mesh)
}

/// Keeps corners and faces: normals, textures, groups and materials are not used, and need not be sound.
fn only_corners(text: &str) -> String {
    let mut kept = String::with_capacity(text.len());
    for line in text.lines() {
        let mut words = line.split_whitespace();
        match words.next() {
            Some("v") => {
                kept.push('v');
                words.take(3).for_each(|word| kept.extend([" ", word]));
            }
            Some("f") => {
                kept.push('f');
                words.for_each(|word| kept.extend([" ", word.split('/').next().unwrap_or_default()]));
            }
            _ => {}
        }
        kept.push('\n');
    }
    kept
}
