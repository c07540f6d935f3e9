//! Meshes are found only where they may be, and read as they were written.

use std::fs;

use nalgebra::{Point3, Vector3};
use tempfile::TempDir;

use crate::mesh::files::{parse_obj, parse_stl};
use crate::mesh::{MeshOptions, MeshProblem, TriangleMesh};
use crate::{Geometry, Manipulator, Warning};

/// A tetrahedron with corners at the origin and at 1 on each axis, faces seen from outside.
const TETRAHEDRON: [[[f32; 3]; 3]; 4] = [
    [[0.0, 0.0, 0.0], [0.0, 1.0, 0.0], [1.0, 0.0, 0.0]],
    [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]],
    [[0.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.0, 1.0, 0.0]],
    [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
];

const OBJ: &str = "mtllib none.mtl\no body\nv 0 0 0\nv 1 0 0 0.5 0.5 0.5\nv 0 1 0\nv 0 0 1\nvn 0 0\nusemtl none\n\
    f 1/9/9 3//7 2\nf 1 2 4\nf 1 4 3\nf -3 -2 -1\n";

fn binary_stl(header: &[u8]) -> Vec<u8> {
    let mut bytes = header.to_vec();
    bytes.resize(80, b' ');
    bytes.extend(4_u32.to_le_bytes());
    for triangle in TETRAHEDRON {
        bytes.extend([0; 12]);
        bytes.extend(triangle.iter().flatten().flat_map(|value| value.to_le_bytes()));
        bytes.extend([0; 2]);
    }
    bytes
}

fn text_stl(first_line: &str) -> Vec<u8> {
    let mut text = format!("{first_line}\n");
    for triangle in TETRAHEDRON {
        text += "facet normal 0 0 0\nouter loop\n";
        for [x, y, z] in triangle {
            text += &format!("vertex {x} {y} {z}\n");
        }
        text += "endloop\nendfacet\n";
    }
    (text + "endsolid\n").into_bytes()
}

/// Volume by the divergence theorem (m³): positive if the triangles are seen from outside.
fn volume(mesh: &TriangleMesh) -> f64 {
    let corner = |place: u32| mesh.vertices_m[place as usize].coords;
    let cones = mesh.triangles.iter().map(|&[a, b, c]| corner(a).dot(&corner(b).cross(&corner(c))) / 6.0);
    cones.sum()
}

#[test]
fn all_formats_give_the_same_tetrahedron() {
    let meshes = [
        parse_stl(binary_stl(b"made by hand")),
        // many programs begin a binary header with the word that text files begin with
        parse_stl(binary_stl(b"solid made by hand")),
        parse_stl(text_stl("solid tetrahedron")),
        parse_stl(text_stl("solid")),
        parse_obj(OBJ.as_bytes().to_vec()),
    ];
    for (place, mesh) in meshes.into_iter().enumerate() {
        let mesh = mesh.unwrap_or_else(|reason| panic!("format {place}: {reason}"));
        assert_eq!((mesh.vertices_m.len(), mesh.triangles.len()), (4, 4), "format {place}");
        assert!((volume(&mesh) - 1.0 / 6.0).abs() < 1e-15, "format {place}");
    }
}

#[test]
fn a_mirrored_mesh_keeps_its_outside() {
    let mesh = parse_stl(binary_stl(b"")).expect("a good file").scaled(&Vector3::new(2.0, -3.0, 1.0));
    assert!((volume(&mesh) - 1.0).abs() < 1e-15);
    assert!(mesh.vertices_m.contains(&Point3::new(0.0, -3.0, 0.0)));
}

#[test]
fn damaged_files_are_refused_without_panic() {
    let mut random = 1_u64;
    let mut next = |below: usize| {
        random = random.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (random >> 33) as usize % below
    };
    for good in [binary_stl(b"x"), text_stl("solid x"), OBJ.as_bytes().to_vec()] {
        for _ in 0..3000 {
            let mut bytes = good.clone();
            for _ in 0..=next(4) {
                let place = next(bytes.len());
                bytes[place] = b"-09. \n/vf\xff"[next(10)];
            }
            bytes.truncate(bytes.len() - next(3) * next(20));
            for parse in [parse_stl, parse_obj] {
                let Ok(mesh) = parse(bytes.clone()) else { continue };
                let count = mesh.vertices_m.len();
                assert!(mesh.triangles.iter().flatten().all(|corner| (*corner as usize) < count));
            }
        }
    }
    assert!(parse_stl(Vec::new()).is_err());
    // a count of triangles that no file holds
    let mut short = binary_stl(b"x");
    short[80..84].fill(0xff);
    assert!(parse_stl(short).is_err());
}

/// A folder with a package, a robot's folder beside it and a file outside of both.
fn folders() -> (TempDir, MeshOptions) {
    let folder = TempDir::new().expect("a temporary folder");
    let path = |name: &str| folder.path().join(name);
    for name in ["hand/meshes", "robot"] {
        fs::create_dir_all(path(name)).expect("a folder");
    }
    fs::write(path("hand/meshes/palm.STL"), binary_stl(b"")).expect("a file");
    fs::write(path("robot/arm.obj"), OBJ).expect("a file");
    fs::write(path("robot/arm.dae"), "<COLLADA/>").expect("a file");
    fs::write(path("robot/broken.stl"), "solid x\nfacet").expect("a file");
    fs::write(path("robot/empty.obj"), "v 0 0 0\n").expect("a file");
    fs::write(path("secret.stl"), binary_stl(b"")).expect("a file");
    let package_roots = [("hand".to_owned(), path("hand"))].into();
    let base_dir = Some(path("robot"));
    (folder, MeshOptions { package_roots, base_dir })
}

/// The model of one link with this mesh as visual and collision.
fn with_mesh(uri: &str) -> Manipulator {
    let shape = format!(r#"<geometry><mesh filename="{uri}" scale="0.5 0.5 -0.5"/></geometry>"#);
    let text =
        format!("<robot><link name='palm'><visual>{shape}</visual><collision>{shape}</collision></link></robot>");
    Manipulator::from_urdf_str(&text).expect("a good file")
}

/// Why the mesh was left out.
fn problem(uri: &str, options: &MeshOptions) -> MeshProblem {
    let mut model = with_mesh(uri);
    model.resolve_meshes(options);
    assert!(model.base().visuals.is_empty() && model.base().collisions.is_empty(), "{uri}: the shapes are left out");
    match model.warnings() {
        [Warning::MeshIgnored { link, uri: named, problem }] if link == "palm" && named == uri => problem.clone(),
        other => panic!("{uri}: {other:?}"),
    }
}

#[test]
fn meshes_keep_their_names_until_they_are_resolved() {
    let model = with_mesh("package://hand/meshes/palm.STL");
    let expected = Geometry::Mesh {
        uri: "package://hand/meshes/palm.STL".into(),
        scale: Vector3::new(0.5, 0.5, -0.5),
        triangles: None,
    };
    assert_eq!(model.base().visuals[0].geometry, expected);
    assert!(matches!(model.warnings()[0], Warning::MeshIgnored { problem: MeshProblem::NotResolved, .. }));
}

#[test]
fn meshes_in_packages_and_beside_the_robot_are_read() {
    let (folder, options) = folders();
    let absolute = format!("file://{}", folder.path().join("robot/arm.obj").display());
    for uri in [
        "package://hand/meshes/palm.STL",
        "model://hand//meshes/palm.STL",
        "arm.obj",
        "file://arm.obj",
        "../robot/arm.obj",
        &absolute,
    ] {
        let mut model = with_mesh(uri);
        model.resolve_meshes(&options);
        assert_eq!(model.warnings(), [], "{uri}");
        let shapes = [&model.base().visuals, &model.base().collisions];
        for shape in shapes.map(|shapes| &shapes[0]) {
            let Geometry::Mesh { triangles: Some(mesh), .. } = &shape.geometry else { panic!("{uri}: no triangles") };
            assert!((volume(mesh) - 0.125 / 6.0).abs() < 1e-15, "{uri}");
        }
    }
}

#[test]
fn names_that_lead_out_of_the_folders_are_refused() {
    let (folder, options) = folders();
    let secret = folder.path().join("secret.stl");
    for uri in ["../secret.stl", "package://hand/../secret.stl", &secret.display().to_string()] {
        assert!(matches!(problem(uri, &options), MeshProblem::Outside { .. }), "{uri}");
    }
    #[cfg(unix)]
    {
        std::os::unix::fs::symlink(&secret, folder.path().join("robot/link.stl")).expect("a link");
        assert!(matches!(problem("link.stl", &options), MeshProblem::Outside { .. }));
    }
}

#[test]
fn meshes_that_cannot_be_used_are_told_by_reason() {
    let (_folder, options) = folders();
    assert_eq!(problem("package://gripper/a.stl", &options), MeshProblem::UnknownPackage { package: "gripper".into() });
    assert_eq!(problem("https://host/a.stl", &options), MeshProblem::UnsupportedScheme);
    assert_eq!(problem("arm.dae", &options), MeshProblem::UnsupportedFormat);
    assert_eq!(problem("arm.obj", &MeshOptions::default()), MeshProblem::NoBaseDir);
    assert!(matches!(problem("missing.stl", &options), MeshProblem::NotFound { .. }));
    assert!(matches!(problem("package://hand/meshes", &options), MeshProblem::NotFound { .. }));
    for uri in ["broken.stl", "empty.obj"] {
        assert!(matches!(problem(uri, &options), MeshProblem::Unreadable { .. }), "{uri}");
    }
}
