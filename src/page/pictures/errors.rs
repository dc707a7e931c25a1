//! Where answers are wrong, pixel by pixel, by exact arithmetic.

use super::inspect::{inspector, most_rays};
use super::seen::{Seen, SeenStructure};
use super::{hex, told};
use crate::render::ErrorMap;
use crate::report::Table;
use crate::report::document::{Art, Block, Colours, Figure, Overlay, Section, Thumbnail};
use crate::report::inspector::Inspector;
use crate::report::number::{count, plural};
use crate::report::words::{listed, slug};

pub const TITLE: &str = "Where are answers wrong?";

/// The pictures of all structures with a wrong answer; a sentence where none has one. Nothing without structures.
pub fn block(seen: &Seen) -> Option<Block> {
    let maps: Vec<(&SeenStructure, ErrorMap)> = seen.structures.iter().map(|s| (s, seen.errors(s))).collect();
    let (wrong, right): (Vec<_>, Vec<_>) = maps.into_iter().partition(|(_, map)| map.errors().next().is_some());
    let rays = plural(seen.exact.rays.len(), "camera ray");
    let right: Vec<&str> = right.iter().map(|(structure, _)| structure.label.as_str()).collect();
    match (wrong.is_empty(), right.is_empty()) {
        (true, true) => None,
        (true, false) => {
            Some(Block::Text(format!("{}: all {rays} are answered right by {}.", seen.name, listed(&right))))
        }
        (false, _) => Some(Block::figure(figure(seen, &wrong, &right))),
    }
}

fn figure(seen: &Seen, wrong: &[(&SeenStructure, ErrorMap)], right: &[&str]) -> Figure {
    let picture = |(structure, map): &(&SeenStructure, ErrorMap)| {
        let errors = map.colours().into_iter().filter(|(_, n, _)| *n > 0);
        let errors = errors.map(|(name, n, _)| format!("{name}: {}", count(n as u64))).collect::<Vec<_>>().join(", ");
        Thumbnail {
            name: structure.label.clone(),
            alt: format!("Wrong answers of {} on {}: {errors}", structure.label, seen.name),
            note: errors,
            png: map.picture().png(),
            size: seen.exact.size,
        }
    };
    let names = wrong[0].1.colours().map(|(name, _, colour)| (hex(colour), name.to_owned()));
    let columns = ["structure".to_owned()].into_iter().chain(names.iter().map(|(_, name)| name.clone())).collect();
    let row = |(structure, map): &(&SeenStructure, ErrorMap)| {
        let numbers = map.colours().map(|(_, n, _)| count(n as u64).into());
        [structure.label.as_str().into()].into_iter().chain(numbers).collect()
    };
    let rays = plural(seen.exact.rays.len(), "camera ray");
    let right = if right.is_empty() { String::new() } else { format!(" Without an error: {}.", listed(right)) };
    Figure {
        id: format!("errors-{}", slug(&seen.shown.scene.name)),
        caption: format!(
            "{}: answers to {rays} that exact arithmetic finds wrong, drawn three pixels wide; right ones are grey, brighter where \
             nearer.{right}",
            seen.name
        ),
        alt: String::new(),
        command: format!("sahara render {} --view error --structure NAME -o NAME.png", seen.shown.quoted()),
        art: Art::Overlay(Overlay {
            heading: seen.name.clone(),
            pictures: wrong.iter().map(picture).collect(),
            colours: Colours::Key(names.into()),
            inspector: Some(Box::new(pixels(seen, wrong))),
        }),
        data: Table { columns, rows: wrong.iter().map(row).collect(), ..Table::default() },
    }
}

/// The rays of all pixels that some structure answers wrong; evenly chosen ones where they are too many.
fn pixels(seen: &Seen, wrong: &[(&SeenStructure, ErrorMap)]) -> Inspector {
    let mut pixels: Vec<usize> = wrong.iter().flat_map(|(_, map)| map.errors()).collect();
    pixels.sort_unstable();
    pixels.dedup();
    let (all, most) = (pixels.len(), most_rays(seen.structures.len()));
    let chosen: Vec<usize> = pixels.into_iter().step_by(all.div_ceil(most).max(1)).collect();
    let which = match chosen.len() {
        n if n == all => format!("{} that some structure answers wrong can be asked for.", plural(n, "pixel")),
        n => format!(
            "{} of the {} that some structure answers wrong can be asked for.",
            count(n as u64),
            plural(all, "pixel")
        ),
    };
    inspector(seen, chosen, which)
}

/// The section with what is known of all scenes, and what is said of those without a picture.
pub fn section(found: Vec<Block>, left_out: Vec<Block>) -> Section {
    let what = "The camera rays of a picture, each held against exact arithmetic.";
    Section { id: "errors", title: TITLE, blocks: told("Pictures of wrong answers", what, found, left_out) }
}
