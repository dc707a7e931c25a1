//! Tests of scene files, placement, framing and surfaces.

use std::fs;

use glam::{Vec2, Vec3};

use super::assemble::{Origin, assemble};
use super::format::SceneFile;
use super::*;
use crate::geometry::{Aabb, Hit, Ray};

const PLAIN: &str = r#"
name = "Test"
camera = { eye = [0.0, 0.0, 5.0], target = [0, 0, 0], vertical_fov = 60 }
objects = [{ mesh = "cube" }]
"#;

pub(crate) fn of_the_report(folder: &str) -> Scene {
    let scenes = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes");
    Scene::read(&scenes.join(folder).join("scene.toml"), None).unwrap()
}

fn scene(text: &str) -> Result<Scene, SceneError> {
    made(text, None)
}

fn made(text: &str, real_meshes: Option<&std::path::Path>) -> Result<Scene, SceneError> {
    assemble(&SceneFile::parse(text, "test.toml")?, &Origin { file: "test.toml", folder: None, real_meshes })
}

fn message(text: &str) -> String {
    scene(text).unwrap_err().to_string()
}

#[test]
fn a_plain_file_gets_the_defaults() {
    let scene = scene(PLAIN).unwrap();
    assert_eq!((scene.size, scene.recursion_limit, scene.shadow_terminator_fix), ([512, 512], 8, true));
    assert_eq!(scene.offset, Offset::ErrorBounded);
    assert_eq!(scene.materials[0].name, "grey");
    assert!(scene.normals.is_none() && scene.stand_ins.is_empty() && scene.notes.is_empty());
}

#[test]
fn errors_name_the_file_the_location_and_a_remedy() {
    for (from, to, start) in [
        ("name = \"Test\"", "nmae = \"Test\"", ", line 2: unknown field `nmae`, expected one of"),
        ("mesh", "mseh", ", line 4: unknown field `mseh`"),
        ("name = \"Test\"", "", ", line 1: missing field `name`"),
        ("60", "'60'", ", line 3: invalid type"),
        (
            "cube",
            "cub",
            ", `objects[0].mesh`: there is no mesh `cub` (did you mean cube?); name a file or one of cube,",
        ),
        ("60", "180", ", `camera`: the camera's vertical field of view must be"),
        ("[0, 0, 0]", "[0, 0, 5]", ", `camera`: the camera's eye and target are the same"),
        ("[0, 0, 0]", "[0, 1, 5]", ", `camera`: the camera's up is parallel"),
        ("\"cube\"", "\"cube\", material = \"Red\"", ", `objects[0].material`: the file has no material"),
        ("\"cube\"", "\"cube\", tra = [nan, 0, 0]", ", `objects[0].rot, sca or tra`: give finite"),
        ("\"cube\"", "\"cube\", sca = [3e38, 3e38, 3e38], tra = [3e38, 0, 0]", ": vertex"),
        ("\"Test\"", "\"\"", ", `name`: give a name"),
        ("\"Test\"", "\" \"", ", `name`: give a name"),
        ("\"Test\"", "\"a\\tb\"", ", `name`: give a name"),
        ("\"Test\"", "\"a\\u001bb\"", ", `name`: give a name"),
        ("name", "size = [0, 1]\nname", ", `size`: width and height must be between"),
        ("name", "triangles = 13\nname", ", `triangles`: the file states 13 triangles, but"),
    ] {
        let message = message(&PLAIN.replace(from, to));
        assert!(message.starts_with(&format!("test.toml{start}")), "{message}");
    }
    for r in ["1.5", "-0.1", "nan"] {
        let material = format!("[materials.M]\nKa = [0, 0, 0]\nKd = [0, 0, 0]\nKs = [0, 0, 0]\nr = {r}\n");
        let message = message(&format!("{PLAIN}\n{material}"));
        assert!(message.starts_with("test.toml, `materials.M.r`: give a number from 0 to 1"), "{message}");
    }
    let missing = Scene::read(std::path::Path::new("no/such.toml"), None).unwrap_err().to_string();
    assert!(missing.starts_with("no/such.toml: cannot read the scene"), "{missing}");
}

#[test]
fn materials_go_to_parts_by_name() {
    let white = "Ka = [0, 0, 0], Kd = [1, 1, 1], Ks = [0, 0, 0]";
    let text = |parts: &str| {
        PLAIN.replace("mesh = \"cube\"", &format!("mesh = \"cornellbox\", materials = {{ {parts} }}"))
            + &format!("[materials]\nB = {{ {white}, r = 0.5, texture = \"b.png\" }}\nA = {{ {white} }}")
    };
    let whole = "floor = \"A\", ceiling = \"A\", back = \"B\", right = \"A\"";
    let scene = scene(&text(&format!("{whole}, left = \"A\""))).unwrap();
    assert_eq!(scene.material_of, [0, 0, 0, 0, 1, 1, 0, 0, 0, 0]);
    assert_eq!(scene.material(Hit::new(1.0, 4).prim).name, "B");
    assert!(scene.has_mirrors());
    assert_eq!(scene.notes, ["textures ignored (materials use Kd): b.png"]);
    assert!(message(&text(whole)).contains("part `left` has no material"));
    assert!(message(&text("roof = \"A\"")).contains("no part `roof`, only: floor, ceiling, back, right, left"));
}

#[test]
fn a_real_mesh_takes_the_place_of_its_stand_in() {
    let folder = tempfile::tempdir().unwrap();
    let real = r#"mesh = "cube", stands_in_for = "a thing", real = { file = "thing.obj", url = "", licence = "", origin = "",
        reported_triangles = 3, tra = [0, 0, 7], exclude_materials = ["dust"] }"#;
    let text = "triangles = 12".to_string() + &PLAIN.replace("mesh = \"cube\"", &real.replace('\n', " "));

    let without = made(&text, Some(folder.path())).unwrap();
    assert_eq!((without.mesh.len(), without.stand_ins), (12, vec!["cube".to_string()]));
    assert_eq!(without.notes, ["mesh `cube` stands in for a thing"]);

    fs::write(folder.path().join("thing.mtl"), "newmtl dust\nnewmtl stone\nKd 1 0 0\n").unwrap();
    let faces = "usemtl dust\nf 1 2 3\nusemtl stone\nf 3 2 1\n";
    fs::write(folder.path().join("thing.obj"), format!("mtllib thing.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\n{faces}"))
        .unwrap();
    let with = made(&text, Some(folder.path())).unwrap();
    assert_eq!((with.mesh.len(), with.stand_ins.len()), (1, 0));
    assert_eq!(with.mesh.corners(0), [Vec3::new(0.0, 1.0, 7.0), Vec3::new(1.0, 0.0, 7.0), Vec3::new(0.0, 0.0, 7.0)]);
    assert_eq!(with.material(Hit::new(1.0, 0).prim).diffuse, Vec3::X);
    let noted = "thing.obj: 1 triangles instead of the report's 3";
    assert!(with.notes.iter().any(|note| note.ends_with(noted)), "{:?}", with.notes);
    assert!(made(&text, None).unwrap().mesh.len() == 12);
}

#[test]
fn a_scene_of_real_meshes_alone_says_how_to_get_them() {
    let folder = tempfile::tempdir().unwrap();
    let real = r#"real = { file = "thing.obj", url = "", licence = "", origin = "" }"#;
    let text = PLAIN.replace("mesh = \"cube\"", real);
    let refused = |folder| made(&text, folder).unwrap_err().to_string();
    let error = refused(Some(folder.path()));
    assert!(error.contains("`objects[0].real.file`: thing.obj is not in") && error.contains("sahara fetch"), "{error}");
    assert!(refused(None).contains("no folder of real meshes is set"), "{}", refused(None));
    let with = |key: &str| message(&PLAIN.replace("mesh = \"cube\"", &format!("{key}, {real}")));
    assert!(with("sca = [2, 2, 2]").contains("move it into `real`"));
    assert!(with("stands_in_for = \"a thing\"").contains("`objects[0].stands_in_for`"));
    let nothing = message(&PLAIN.replace("mesh = \"cube\"", ""));
    assert!(nothing.contains("name a mesh or a file, or give `terrain` or `real`"), "{nothing}");

    fs::write(folder.path().join("thing.obj"), "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n").unwrap();
    let scene = made(&text, Some(folder.path())).unwrap();
    assert_eq!((scene.mesh.len(), scene.stand_ins.len()), (1, 0));
    assert!(scene.notes.iter().any(|note| note.ends_with("thing.obj: 1 triangles")), "{:?}", scene.notes);
    let wrong = made(&format!("triangles = 2\n{text}"), Some(folder.path())).unwrap_err().to_string();
    assert!(wrong.contains("states 2 triangles, but its objects have 1"), "{wrong}");
}

#[test]
fn a_file_s_meshes_count_from_its_folder() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("one.obj"), "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n").unwrap();
    let path = folder.path().join("scene.toml");
    fs::write(&path, PLAIN.replace("cube", "one.obj")).unwrap();
    assert_eq!(Scene::read(&path, None).unwrap().mesh.len(), 1);
    fs::write(&path, PLAIN.replace("cube", "two.obj")).unwrap();
    let error = Scene::read(&path, None).unwrap_err().to_string();
    assert!(error.contains("`objects[0].mesh`") && error.contains("two.obj"), "{error}");
}

#[test]
fn rays_go_through_the_pixels() {
    let camera = Camera::new(Vec3::new(0.0, 0.0, 5.0), Vec3::ZERO, Vec3::Y, 90.0).unwrap();
    let view = camera.view([4, 2]);
    let through = |x, y, offset| {
        let ray: Ray = view.ray(x, y, offset);
        assert!((ray.direction.length() - 1.0).abs() < 1e-6);
        (ray.at(5.0 / -ray.direction.z) * 1e5).round() / 1e5
    };
    assert_eq!(through(0, 0, Vec2::ZERO), Vec3::new(-10.0, 5.0, 0.0));
    assert_eq!(through(3, 1, Vec2::ONE), Vec3::new(10.0, -5.0, 0.0));
    assert_eq!(through(2, 1, View::CENTRE), Vec3::new(2.5, -2.5, 0.0));
    assert_eq!(view.ray(1, 0, Vec2::ONE), view.ray(2, 1, Vec2::ZERO));
}

#[test]
fn a_mirror_leaves_fronts_in_front() {
    for (mesh, is_smooth) in [("cube", false), ("teapot", true), ("torus", true)] {
        let at = |sca: [f32; 3]| {
            let placed = format!("mesh = \"{mesh}\", rot = [20, 0, 70], sca = {sca:?}, tra = [1, 2, 3]");
            scene(&PLAIN.replace("mesh = \"cube\"", &placed)).unwrap()
        };
        let plain = at([1.0, 1.0, 1.0]);
        assert_eq!(plain.normals.is_some(), is_smooth);
        for (sca, is_mirrored) in [
            ([-1.0, 1.0, 1.0], true),
            ([1.0, -1.0, 1.0], true),
            ([-1.0, -1.0, -1.0], true),
            ([-1.0, 1.0, -1.0], false),
            ([2.0, 3.0, 0.5], false),
        ] {
            let placed = at(sca);
            let turned = |[a, b, c]: [u32; 3]| if is_mirrored { [a, c, b] } else { [a, b, c] };
            let expected: Vec<[u32; 3]> = plain.mesh.triangles().iter().map(|&t| turned(t)).collect();
            assert_eq!(placed.mesh.triangles(), expected, "{mesh} {sca:?}");
            for t in 0..placed.mesh.len() as u32 {
                let [a, b, c] = placed.mesh.corners(t);
                let front = (b - a).cross(c - a);
                let corners = placed.normals.as_ref().and_then(|normals| normals.corners(t));
                let is_in_front = |n: &Vec3| n.dot(front) >= 0.0;
                // At least one corner normal points to the front of the triangle.
                assert!(corners.is_none_or(|corners| corners.iter().any(is_in_front)), "{mesh} {sca:?} {t}");
            }
        }
    }
}

#[test]
fn a_surface_has_the_point_and_both_normals() {
    let flat = scene(PLAIN).unwrap();
    let ray = Ray::new(Vec3::new(0.25, 0.5, 5.0), -Vec3::Z);
    let is_hit = |&i: &u32| sahara_core::exact::hit(&ray, flat.mesh.corners(i)).is_some();
    let front = (0..12).filter(is_hit).find(|&i| flat.mesh.corners(i).iter().all(|p| p.z == 1.0)).unwrap();
    let surface = flat.surface(&ray, Hit::new(4.0, front));
    assert_eq!(surface.point.position, Vec3::new(0.25, 0.5, 1.0));
    assert_eq!((surface.point.normal, surface.shading_normal, surface.smooth), (Vec3::Z, Vec3::Z, false));
    assert_eq!(flat.area(Hit::new(4.0, front).prim), 2.0);

    let round = scene(&PLAIN.replace("cube", "icosphere")).unwrap();
    let [a, b, c] = round.mesh.corners(7);
    let [at_a, at_b, at_c] = round.normals.as_ref().unwrap().corners(7).unwrap();
    let towards = |p: Vec3| round.surface(&Ray::new(p * 3.0, -p), Hit::new(2.0, 7));
    assert!(towards(a).shading_normal.distance(at_a) < 1e-6);
    assert!(towards(b * 0.5 + c * 0.5).shading_normal.distance((at_b + at_c).normalize()) < 1e-6);
    assert!(towards(a).smooth);
}

#[test]
fn the_hash_sees_all_that_rays_and_answers_depend_on() {
    let hash = |text: &str| scene(text).unwrap().hash();
    let first = hash(PLAIN);
    assert_eq!(first.len(), 64);
    assert_eq!(first, hash(&PLAIN.replace("Test", "Other")));
    assert_ne!(first, hash(&PLAIN.replace("60", "61")));
    assert_ne!(first, hash(&PLAIN.replace("\"cube\"", "\"cube\", sca = [1, 1, 1.0001]")));

    let plain = scene(PLAIN).unwrap();
    let light = Light { position: Vec3::ONE, colour: Vec3::ONE, linear: 0.0, quadratic: 0.0 };
    type Change = fn(&mut Scene, Light);
    let changes: [(&str, Change); 13] = [
        ("a light", |scene, light| scene.lights.push(light)),
        ("where a light is", |scene, light| scene.lights = vec![Light { position: Vec3::ZERO, ..light }]),
        ("how a light fades", |scene, light| scene.lights = vec![Light { quadratic: 0.5, ..light }]),
        ("a mirror", |scene, _| scene.materials[0].mirror = 0.5),
        ("a colour", |scene, _| scene.materials[0].diffuse.x += 0.125),
        ("which material", |scene, _| {
            scene.materials.push(scene.materials[0].clone());
            scene.material_of[3] = scene.materials.len() as u32 - 1;
        }),
        ("background", |scene, _| scene.background.y += 0.5),
        ("recursion", |scene, _| scene.recursion_limit += 1),
        ("the terminator", |scene, _| scene.shadow_terminator_fix ^= true),
        ("the offset", |scene, _| scene.offset = Offset::Direction(0.01)),
        ("its length", |scene, _| scene.offset = Offset::Direction(0.02)),
        ("the size", |scene, _| scene.size[0] += 1),
        ("normals", |scene, _| {
            scene.normals = Some(CornerNormals::new(vec![Vec3::Y], vec![[0; 3]; scene.mesh.len()]));
        }),
    ];
    let mut seen = vec![first];
    for (what, change) in changes {
        let mut changed = plain.clone();
        change(&mut changed, light);
        assert!(!seen.contains(&changed.hash()), "{what}");
        seen.push(changed.hash());
    }
    let mut named = plain;
    named.notes.push("a note".into());
    assert_eq!(named.hash(), seen[0]);
}

#[test]
fn a_framed_mesh_is_whole_in_view_at_any_size_and_place() {
    for (scale, shift) in
        [(1.0, Vec3::ZERO), (1e-6, Vec3::ZERO), (1e6, Vec3::ZERO), (1.0, Vec3::new(500.0, -70.0, 3.0))]
    {
        let mut model = meshes::teapot();
        model.positions.iter_mut().for_each(|p| *p = *p * scale + shift);
        let scene = Scene::framed("teapot", model).unwrap();
        assert_eq!(scene.offset, Offset::ErrorBounded);

        let camera = &scene.camera;
        let forward = (camera.target() - camera.eye()).normalize();
        let right = forward.cross(camera.up()).normalize();
        let (up, reach) = (right.cross(forward), (camera.vertical_fov().to_radians() / 2.0).tan());
        let Aabb { min, max } = scene.mesh.bounds();
        let sides = (0..8).map(|i| {
            let pick = |bit: usize| if i >> bit & 1 == 0 { min[bit] } else { max[bit] };
            let corner = Vec3::new(pick(0), pick(1), pick(2)) - camera.eye();
            assert!(corner.dot(forward) > 0.0);
            corner.dot(right).abs().max(corner.dot(up).abs()) / corner.dot(forward) / reach
        });
        let widest = sides.fold(0.0, f32::max);
        assert!((0.94..0.96).contains(&widest), "the box fills {widest} of the image");
    }
}

#[test]
fn nothing_and_a_single_point_can_be_framed() {
    assert!(Scene::framed("nothing", Model::default()).unwrap().mesh.is_empty());
    let point = Model { positions: vec![Vec3::new(5.0, 5.0, 5.0)], triangles: vec![[0, 0, 0]], ..Model::default() };
    assert_eq!(Scene::framed("point", point).unwrap().material_of, [0]);
    let broken = Model { positions: vec![], triangles: vec![[0, 0, 0]], ..Model::default() };
    assert!(Scene::framed("broken", broken).unwrap_err().to_string().starts_with("broken: triangle 0 refers to"));
}
