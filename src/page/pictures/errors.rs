//! Pictures of wrong hits, pixel by pixel, judged by exact arithmetic.

use super::camera_rays::{CameraRays, StructureWork};
use super::hex;
use super::inspect::{inspector, most_rays};
use crate::render::{ErrorMap, png};
use crate::report::number::{count, plural};
use crate::report::words::{listed, slug};
use crate::report::{Art, Block, Colours, Figure, Overlay, Picture, Table};

/// The pictures of all structures with a wrong hit, with the command that draws one; a sentence if all hits are right.
/// `None` without structures.
pub fn block(camera: &CameraRays) -> Option<(Block, String)> {
    let maps: Vec<(&StructureWork, ErrorMap)> = camera.structures.iter().map(|s| (s, camera.errors(s))).collect();
    let (wrong, right): (Vec<_>, Vec<_>) = maps.into_iter().partition(|(_, map)| map.errors().next().is_some());
    let rays = plural(camera.exact.rays.len(), "camera ray");
    let right: Vec<&str> = right.iter().map(|(structure, _)| structure.label.as_str()).collect();
    match (wrong.is_empty(), right.is_empty()) {
        (true, true) => None,
        (true, false) => {
            let text = format!("{}: every hit of {rays} is correct with {}.", camera.name, listed(&right));
            Some((Block::Text(text), String::new()))
        }
        (false, _) => {
            let words = camera.loaded.words();
            let command = format!("sahara render {words} --view error --structure NAME -o NAME.png");
            Some((Block::figure(figure(camera, &wrong, &right)), command))
        }
    }
}

fn figure(camera: &CameraRays, wrong: &[(&StructureWork, ErrorMap)], right: &[&str]) -> Figure {
    let picture = |(structure, map): &(&StructureWork, ErrorMap)| {
        let errors = map.colours().into_iter().filter(|(_, n, _)| *n > 0);
        let errors = errors.map(|(name, n, _)| format!("{name}: {}", count(n as u64))).collect::<Vec<_>>().join(", ");
        Picture {
            name: structure.label.clone(),
            alt: format!("Wrong hits of {} on {}: {errors}", structure.label, camera.name),
            note: errors,
            png: png(&map.picture()),
            size: camera.exact.size,
        }
    };
    let names = wrong[0].1.colours().map(|(name, _, colour)| (hex(colour), name.to_owned()));
    let columns = ["structure".to_owned()].into_iter().chain(names.iter().map(|(_, name)| name.clone())).collect();
    let row = |(structure, map): &(&StructureWork, ErrorMap)| {
        let numbers = map.colours().map(|(_, n, _)| n.into());
        [structure.label.as_str().into()].into_iter().chain(numbers).collect()
    };
    let rays = plural(camera.exact.rays.len(), "camera ray");
    let right = if right.is_empty() { String::new() } else { format!(" No errors: {}.", listed(right)) };
    Figure {
        id: format!("errors-{}", slug(&camera.loaded.scene.name)),
        caption: format!(
            "{}: wrong hits among {rays}, by exact arithmetic, drawn three pixels wide. Correct hits are grey, \
             brighter where nearer.{right}",
            camera.name
        ),
        alt: String::new(),
        art: Art::Overlay(Overlay {
            heading: camera.name.clone(),
            pictures: wrong.iter().map(picture).collect(),
            colours: Colours::Key(names.into()),
            inspector: Some(pixels(camera, wrong)),
        }),
        data: Table { columns, rows: wrong.iter().map(row).collect(), ..Table::default() },
    }
}

/// The rays of all pixels on which some structure has a wrong hit; if there are too many, an even selection.
fn pixels(camera: &CameraRays, wrong: &[(&StructureWork, ErrorMap)]) -> serde_json::Value {
    let mut pixels: Vec<usize> = wrong.iter().flat_map(|(_, map)| map.errors()).collect();
    pixels.sort_unstable();
    pixels.dedup();
    let (all, most) = (pixels.len(), most_rays(camera.structures.len()));
    let chosen: Vec<usize> = pixels.into_iter().step_by(all.div_ceil(most).max(1)).collect();
    let which = match chosen.len() {
        n if n == all => format!("Select any of {} with a wrong hit.", plural(n, "pixel")),
        n => format!("Select any of {} (of {} with a wrong hit).", count(n as u64), plural(all, "pixel")),
    };
    inspector(camera, &chosen, &which)
}
