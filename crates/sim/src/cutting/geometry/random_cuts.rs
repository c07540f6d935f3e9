//! Ten thousand random cuts, half of them degenerate: nothing is lost, nothing panics, and every surface is closed.

use nalgebra::{Isometry3, Matrix3, Point2, Point3, UnitQuaternion, UnitVector3, Vector3};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

use super::*;
use crate::cutting::food::FoodFile;

/// What a split may add or lose of mass, moment and inertia, relative to the piece that is split.
const LOST: f64 = 1e-12;

/// Closed surfaces: the sum of their area vectors relative to their area, and their volume relative to the cells'. Exposed
/// parts of seams below 1e-16 m² are not drawn; at an arm of 0.1 m they are 1e-9 of the smallest pieces, some mm³.
const OPEN: f64 = 1e-9;

/// How far a section's area may be from half of what a cut adds to the surface, m²: slivers of up to a micrometer along
/// seams of up to 0.2 m.
const SECTION_M2: f64 = 2e-7;

/// Cuts before a fresh food is taken.
const CUTS_PER_FOOD: usize = 20;

fn foods() -> Vec<Solid> {
    let texts = [
        include_str!("../../../../../assets/foods/banana.toml"),
        include_str!("../../../../../assets/foods/biscuit.toml"),
        include_str!("../../../../../assets/foods/grape.toml"),
        include_str!("../../../../../assets/foods/strawberry.toml"),
        include_str!("../../../../../assets/foods/block.toml"),
    ];
    texts.map(|text| toml::from_str::<FoodFile>(text).unwrap().food().unwrap().solid).to_vec()
}

fn direction(random: &mut ChaCha8Rng) -> UnitVector3<f64> {
    loop {
        let point = Vector3::from_fn(|_, _| 2.0 * random.random::<f64>() - 1.0);
        if (0.1..1.0).contains(&point.norm()) {
            return UnitVector3::new_normalize(point);
        }
    }
}

/// Planes anywhere, and planes through what there is: corners, edges, faces, earlier cuts, and tangent ones.
fn plane(random: &mut ChaCha8Rng, piece: &Solid) -> Plane {
    let (low, high) = piece.bounds();
    let cells = piece.cells();
    let cell = &cells[random.random_range(0..cells.len())];
    let corner = |random: &mut ChaCha8Rng| cell.vertices()[random.random_range(0..cell.vertices().len())];
    let share = Vector3::from_fn(|_, _| random.random::<f64>());
    let inside = low + (high - low).component_mul(&share);
    let any = Plane { point: inside, normal: direction(random) };
    match random.random_range(0..10) {
        0..4 => any,
        4 => Plane { normal: Vector3::ith_axis(random.random_range(0..3)), ..any },
        5 => Plane { point: corner(random), ..any },
        6 => {
            let [a, b, c] = [corner(random), corner(random), corner(random)];
            UnitVector3::try_new((b - a).cross(&(c - a)), 1e-9).map_or(any, |normal| Plane { point: a, normal })
        }
        7 | 8 => {
            let faces = cell.faces().collect::<Vec<_>>();
            let (corners, normal, _) = &faces[random.random_range(0..faces.len())];
            let off = if random.random() { 0.0 } else { 10_f64.powf(-4.0 - 13.0 * random.random::<f64>()) };
            Plane { point: corners[0] - normal.scale(off), normal: *normal }
        }
        _ => {
            let height = |point: &Point3<f64>| any.normal.dot(&point.coords);
            let top = cells.iter().flat_map(ConvexCell::vertices).max_by(|a, b| height(a).total_cmp(&height(b)));
            let off = [0.0, 1e-15, 1e-3][random.random_range(0..3)];
            Plane { point: top.unwrap() + any.normal.scale(off), ..any }
        }
    }
}

/// A frame whose x-y plane is the plane.
fn frame(plane: &Plane) -> Isometry3<f64> {
    let turn = UnitQuaternion::rotation_between(&Vector3::z(), &plane.normal)
        .unwrap_or_else(|| UnitQuaternion::from_axis_angle(&Vector3::x_axis(), std::f64::consts::PI));
    Isometry3::from_parts(plane.point.into(), turn)
}

/// A cut of strips that wander by up to a few millimeters, with steps in every second one.
fn wandering(random: &mut ChaCha8Rng, plane: &Plane) -> CutSurface {
    let at = frame(plane);
    let strips = random.random_range(1..6_usize);
    let spread = 0.003;
    let mut wander = || spread * (2.0 * random.random::<f64>() - 1.0);
    let profile = (0..=strips).map(|step| Point2::new(0.008 * step as f64 - 0.02, wander())).collect::<Vec<_>>();
    let smooth = CutSurface::from_profile(&at, &profile).unwrap();
    if random.random() {
        return smooth;
    }
    let planes = smooth.planes().iter().map(|plane| Plane {
        point: plane.point + plane.normal.scale(0.001 * (random.random::<f64>() - 0.5)),
        normal: plane.normal,
    });
    CutSurface::new(planes.collect(), smooth.borders().to_vec()).unwrap()
}

/// Mass properties of pieces together, about the center of the whole.
fn together(pieces: &[Solid]) -> (f64, Point3<f64>, Matrix3<f64>) {
    let parts = pieces.iter().map(|piece| piece.mass_properties(1000.0)).collect::<Vec<_>>();
    let mass = parts.iter().map(|part| part.mass_kg).sum::<f64>();
    let center = parts.iter().map(|part| part.center.coords * part.mass_kg).sum::<Vector3<f64>>() / mass;
    let about_center = parts.iter().map(|part| {
        let arm = part.center.coords - center;
        part.inertia_kg_m2 + (Matrix3::identity() * arm.norm_squared() - arm * arm.transpose()) * part.mass_kg
    });
    (mass, Point3::from(center), about_center.sum())
}

fn assert_conserved(piece: &Solid, pieces: &[Solid], what: &str) {
    let whole = piece.mass_properties(1000.0);
    let (mass, center, inertia) = together(pieces);
    let (low, high) = piece.bounds();
    assert!((mass / whole.mass_kg - 1.0).abs() < LOST, "{what}: mass {mass} of {}", whole.mass_kg);
    assert!((center - whole.center).norm() < LOST * (high - low).norm(), "{what}: center {center}");
    let lost = (inertia - whole.inertia_kg_m2).norm() / whole.inertia_kg_m2.norm();
    assert!(lost < LOST, "{what}: inertia by {lost:e}");
}

/// Area of a mesh, after a check that it is closed and encloses the cells.
fn closed_area(piece: &Solid, what: &str) -> f64 {
    let mesh = piece.mesh();
    let anchor = mesh.vertices[0];
    let (mut area, mut vector, mut volume) = (0.0, Vector3::zeros(), 0.0);
    for triangle in &mesh.triangles {
        let [a, b, c] = triangle.map(|corner| mesh.vertices[corner as usize] - anchor);
        let normal = (b - a).cross(&(c - a)) / 2.0;
        area += normal.norm();
        vector += normal;
        volume += a.dot(&normal) / 3.0;
    }
    assert!(vector.norm() < OPEN * area, "{what}: open by {:e} of {area:e} m2", vector.norm());
    let cells = piece.volume_m3();
    assert!((volume / cells - 1.0).abs() < OPEN, "{what}: surface holds {volume:e} m3, cells {cells:e}");
    area
}

/// Checks that cells and colliders agree: none is missing but those of thin cells, and each has its cell's volume.
fn assert_collidable(piece: &Solid, what: &str) {
    let cells = piece.cells().iter().filter(|cell| cell.thickness_m() >= THINNEST_COLLIDER_M).collect::<Vec<_>>();
    let hulls = piece.hulls();
    assert_eq!(hulls.len(), cells.len(), "{what}: colliders missing");
    for (hull, cell) in hulls.iter().zip(cells) {
        let (found, volume) = (hull.mass_properties(1.0).mass(), cell.volume_m3());
        // corners within 10 µm of another are left out: up to some percent of cells of 0.3 mm
        assert!((found / volume - 1.0).abs() < 0.05, "{what}: collider of {found:e} m3, cell of {volume:e} m3");
    }
}

/// A piece worth cutting: thicker than the engine needs.
fn cuttable(pieces: &[Solid], random: &mut ChaCha8Rng) -> usize {
    loop {
        let index = random.random_range(0..pieces.len());
        if !pieces[index].is_crumb() {
            return index;
        }
    }
}

#[test]
fn ten_thousand_cuts_lose_nothing() {
    let foods = foods();
    let mut random = ChaCha8Rng::seed_from_u64(1);
    let mut pieces = Vec::new();
    let mut most = 0;
    for cut in 0..10_000 {
        if cut % CUTS_PER_FOOD == 0 {
            pieces = vec![foods[cut / CUTS_PER_FOOD % foods.len()].clone()];
        }
        let piece = pieces.swap_remove(cuttable(&pieces, &mut random));
        let plane = plane(&mut random, &piece);
        let steered = random.random_range(0..8) == 0;
        let what = format!("cut {cut} ({plane:?}, steered: {steered})");
        let parts = if steered {
            let parts = piece.split_along(&wandering(&mut random, &plane));
            parts.into_iter().map(|part| part.solid).collect()
        } else {
            piece.split(&plane)
        };
        assert_conserved(&piece, &parts, &what);
        if !steered && cut % 4 == 0 {
            let grown = parts.iter().map(|part| closed_area(part, &what)).sum::<f64>() - closed_area(&piece, &what);
            let section = piece.section(&frame(&plane)).area_m2();
            assert!((grown / 2.0 - section).abs() < SECTION_M2, "{what}: {grown:e} m2, section {section:e} m2");
        }
        if cut % 4 == 1 {
            parts.iter().for_each(|part| assert_collidable(part, &what));
        }
        pieces.extend(parts);
        most = most.max(pieces.len());
    }
    assert!(most > CUTS_PER_FOOD, "the foods came apart into {most} pieces at most");
}
