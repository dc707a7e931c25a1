//! Checks the table of faults and measures in src/images/golden/GOLDEN.md.

use std::sync::Arc;

use sahara::accel::Accel;
use sahara::builtin::Builtin;
use sahara::geometry::Mesh;
use sahara::glam::Vec2;
use sahara::golden::measures::Measures;
use sahara::golden::{Allowed, Match, Verdict, compare};
use sahara::image::DynamicImage;
use sahara::kdtree::{KdConfig, KdTree};
use sahara::render::{of_colours, shade};
use sahara::scene::{Scene, View};
use sahara::triangle::Exact;

pub const SIZE: [u32; 2] = [256, 192];

fn draw(scene: &Scene, offset: Vec2) -> DynamicImage {
    let tree = KdTree::<Exact>::build(&scene.mesh, &KdConfig::SAH).unwrap();
    of_colours(SIZE, &shade(scene, &tree, &scene.primary_rays(SIZE, offset, 0..SIZE[0] * SIZE[1]))).into()
}

/// The picture of a scene, and copies with one fault each.
pub fn pictures() -> (DynamicImage, [(&'static str, DynamicImage); 6]) {
    let scene = Builtin::find("starters").unwrap().scene(None).unwrap();
    let right = draw(&scene, View::CENTRE);

    let mut flipped = right.to_rgb8();
    flipped.get_pixel_mut(100, 80).0.iter_mut().for_each(|value| *value ^= 0x80);
    let mut noisy = right.to_rgb8();
    for pixel in noisy.pixels_mut().step_by(10) {
        pixel.0.iter_mut().for_each(|value| *value = value.checked_add(1).unwrap_or(254));
    }
    let mut brighter = right.to_rgb8();
    brighter.iter_mut().for_each(|value| *value = value.saturating_add(1));
    let mut material = scene.clone();
    material.materials.iter_mut().for_each(|own| own.diffuse *= 0.98);
    // Collapse the triangle at the middle pixel to a point.
    let tree = KdTree::<Exact>::build(&scene.mesh, &KdConfig::SAH).unwrap();
    let middle = SIZE[0] * SIZE[1] / 2 + SIZE[0] / 2;
    let ray = scene.primary_rays(SIZE, View::CENTRE, middle..middle + 1)[0];
    let hit = tree.closest_hit(&ray, &mut ()).expect("the middle shows something");
    let mut triangles = scene.mesh.triangles().to_vec();
    let lost = &mut triangles[hit.prim.index() as usize];
    *lost = [lost[0]; 3];
    let mut holed = scene.clone();
    holed.mesh = Arc::new(Mesh::new(scene.mesh.positions().to_vec(), triangles).unwrap());

    let others = [
        ("one flipped pixel", flipped.into()),
        ("shift by half a pixel", draw(&scene, View::CENTRE + Vec2::new(0.5, 0.0))),
        ("materials 2 % darker", draw(&material, View::CENTRE)),
        ("a lost triangle", draw(&holed, View::CENTRE)),
        ("noise of 1 on every tenth pixel", noisy.into()),
        ("everything 1 of 255 brighter", brighter.into()),
    ];
    (right, others)
}

const CHECKS: [(&str, Match); 4] = [
    ("none", Match::Exact),
    ("`--max-difference 2`", Match::Tolerance { difference: 2.0, pixels: Allowed::Pixels(0) }),
    ("`--max-difference 2 --allow-pixels 10`", Match::Tolerance { difference: 2.0, pixels: Allowed::Pixels(10) }),
    ("`--max-flip 0.01`", Match::Flip { mean: 0.01, pixels_per_degree: sahara::golden::measures::PIXELS_PER_DEGREE }),
];

type Say = fn(&Measures) -> String;

fn table() -> String {
    let (right, others) = pictures();
    let row = |cells: Vec<String>| format!("| {} |\n", cells.join(" | "));
    let measures: [(&str, Say); 8] = [
        ("pixels that differ", |own| own.difference.pixels.to_string()),
        ("more than 2", |own| own.pixels_over.to_string()),
        ("largest difference", |own| own.difference.largest.to_string()),
        ("PSNR, dB", |own| format!("{:.1}", own.psnr)),
        ("SSIM", |own| format!("{:.4}", own.ssim.unwrap())),
        ("FLIP, mean", |own| format!("{:.4}", own.flip.unwrap().mean)),
        ("FLIP, 95th percentile", |own| format!("{:.4}", own.flip.unwrap().percentile_95)),
        ("FLIP, largest", |own| format!("{:.4}", own.flip.unwrap().largest)),
    ];
    let found: Vec<Measures> = others
        .iter()
        .map(|(name, other)| compare(name, [&right, other], CHECKS[2].1, None).0.measures.expect("it differs"))
        .collect();
    let mut table = row([vec!["fault".into()], others.iter().map(|(name, _)| name.to_string()).collect()].concat());
    table += &row(vec!["---".into(); 1 + others.len()]);
    for (name, of) in measures {
        table += &row([vec![name.into()], found.iter().map(of).collect()].concat());
    }
    for (options, how) in CHECKS {
        let caught = |(name, other): &(&str, DynamicImage)| match compare(name, [&right, other], how, None).0.verdict {
            Verdict::Differs => "**caught**".to_owned(),
            verdict => format!("{verdict:?}").to_lowercase(),
        };
        table += &row([vec![options.into()], others.iter().map(caught).collect()].concat());
    }
    table
}

#[test]
fn the_guide_says_which_measures_catch_which_fault() {
    let guide = include_str!("../src/images/golden/GOLDEN.md");
    let table = table();
    assert!(guide.contains(&table), "src/images/golden/GOLDEN.md should contain\n{table}");
}
