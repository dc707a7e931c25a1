//! Pictures of wrong hits.

use super::camera_rays::{CameraRays, StructureWork};
use super::inspect::most_rays;
use super::maps::{Maps, hex};
use crate::render::ErrorMap;
use crate::report::number::{count, plural};
use crate::report::words::listed;
use crate::report::{Colours, Table};

/// If all hits are correct, the result is `Some(Err(sentence))`. If `camera` has no structures, the result is `None`.
pub fn maps(camera: &CameraRays) -> Option<Result<Maps, String>> {
    let maps: Vec<(&StructureWork, ErrorMap)> = camera.structures.iter().map(|s| (s, camera.errors(s))).collect();
    let (wrong, right): (Vec<_>, Vec<_>) = maps.into_iter().partition(|(_, map)| map.errors().next().is_some());
    let (name, rays) = (&camera.name, plural(camera.exact.rays.len(), "camera ray"));
    let right: Vec<&str> = right.iter().map(|(structure, _)| structure.label.as_str()).collect();
    let Some((_, first)) = wrong.first() else {
        let sentence = || Err(format!("{name}: every hit of {rays} is correct with {}.", listed(&right)));
        return (!right.is_empty()).then(sentence);
    };

    let names = first.colours().map(|(name, _, colour)| (hex(colour), name.to_owned()));
    let columns = ["structure".to_owned()].into_iter().chain(names.iter().map(|(_, name)| name.clone()));
    let row = |(structure, map): &(&StructureWork, ErrorMap)| {
        let numbers = map.colours().map(|(_, n, _)| n.into());
        [structure.label.as_str().into()].into_iter().chain(numbers).collect()
    };
    let picture = |(structure, map): &(&StructureWork, ErrorMap)| {
        let errors = map.colours().into_iter().filter(|(_, n, _)| *n > 0);
        let errors = errors.map(|(name, n, _)| format!("{name}: {}", count(n as u64))).collect::<Vec<_>>().join(", ");
        let alt = format!("Wrong hits of {} on {name}: {errors}", structure.label);
        camera.picture(&structure.label, alt, errors, &map.picture())
    };
    let no_errors = if right.is_empty() { String::new() } else { format!(" No errors: {}.", listed(&right)) };
    let (pixels, which) = pixels(&wrong, most_rays(camera.structures.len()));
    Some(Ok(Maps {
        view: "error".into(),
        caption: format!(
            "{name}: wrong hits among {rays}, by exact arithmetic, drawn three pixels wide. Correct hits are grey, \
             brighter where nearer.{no_errors}"
        ),
        pictures: wrong.iter().map(picture).collect(),
        data: Table::new("", columns, wrong.iter().map(row)),
        colours: Colours::Key(names.into()),
        pixels,
        which,
    }))
}

fn pixels(wrong: &[(&StructureWork, ErrorMap)], most: usize) -> (Vec<usize>, String) {
    let mut pixels: Vec<usize> = wrong.iter().flat_map(|(_, map)| map.errors()).collect();
    pixels.sort_unstable();
    pixels.dedup();
    let all = pixels.len();
    let chosen: Vec<usize> = pixels.into_iter().step_by(all.div_ceil(most).max(1)).collect();
    let which = match chosen.len() {
        n if n == all => format!("Select any of {} with a wrong hit.", plural(n, "pixel")),
        n => format!("Select any of {} (of {} with a wrong hit).", count(n as u64), plural(all, "pixel")),
    };
    (chosen, which)
}
