//! Pictures of the scenes, and of the work that structures do on them: drawn when the report is made.

use crate::accel::{DynAccel, Observed};
use crate::page::runs::Runs;
use crate::registry::Registry;
use crate::render::{Picture, ViewKind, costs, draw as draw_view, heat_colour, hottest};
use crate::report::Table;
use crate::report::document::{Art, Block, Figure, Overlay, Section, Thumbnail};
use crate::report::number::{count, figures};
use crate::report::plot::tick_text;
use crate::report::words::scene_name;
use crate::report::words::{distinct, slug};
use crate::scene::{Builtin, Scene};
use crate::study::{BRUTE_FORCE, REPORT_TREE, SAH_TREE, SceneId, Studies, guarded};

/// Longest side of a thumbnail and of a heat map, in pixels.
const THUMBNAIL: u32 = 208;
const HEAT: u32 = 320;

const HEAT_TITLE: &str = "Where is the work?";
const SCENES_TITLE: &str = "The scenes";

/// Scenes with heat maps: the largest.
const HEAT_SCENES: usize = 3;

/// How a scene that was measured is found again; nothing where it is not to be had.
pub type Find<'a> = &'a dyn Fn(&str) -> Option<Scene>;

/// A scene of the runs.
struct Shown {
    scene: Scene,
    /// As the command line names it: a built-in scene, or a file.
    argument: String,
    /// Whether it is not the one that was measured: another mesh of the same name.
    differs: bool,
}

/// The sections of heat maps and of scenes. `progress` is told the scene that is drawn.
pub fn draw(runs: &Runs, suite: (&Registry, &Studies), find: Find, progress: &mut dyn FnMut(&str)) -> Vec<Section> {
    let (registry, studies) = suite;
    let (mut shown, mut lost): (Vec<Shown>, Vec<String>) = (vec![], vec![]);
    for (SceneId { name, hash }, command) in runs.scenes(studies) {
        let candidates = std::iter::once(name.clone()).chain(files_named(&command, &name));
        let found = candidates.filter_map(|candidate| Some((find(&candidate)?, candidate)));
        let mut found: Vec<(Scene, String)> = found.collect();
        let same = found.iter().position(|(scene, _)| hash.as_ref().is_none_or(|hash| scene.hash() == *hash));
        match same {
            None if found.is_empty() => lost.push(name),
            _ => {
                let (scene, argument) = found.swap_remove(same.unwrap_or(0));
                shown.push(Shown { scene, argument, differs: same.is_none() });
            }
        }
    }
    let mut thumbnails = vec![];
    let all_builtin = shown.iter().all(|one| Builtin::find(&one.argument).is_ok());
    for one in &shown {
        progress(&one.scene.name);
        match thumbnail(one, registry) {
            Some(thumbnail) => thumbnails.push(thumbnail),
            None => lost.push(one.scene.name.clone()),
        }
    }
    let mut largest: Vec<&Shown> = shown.iter().collect();
    largest.sort_by_key(|one| std::cmp::Reverse(one.scene.mesh.len()));
    let mut heat = vec![];
    for one in largest.into_iter().take(HEAT_SCENES) {
        progress(&one.scene.name);
        heat.extend(heat_figure(one, runs, registry));
    }
    vec![scene_section(thumbnails, all_builtin, &lost), heat_section(heat)]
}

/// The sections of a report without pictures, which say so.
pub fn left_out() -> Vec<Section> {
    let command = "sahara report, without --no-pictures";
    let missing = |what| vec![Block::missing(what, command)];
    vec![
        Section { id: "scenes", title: SCENES_TITLE, blocks: missing("Pictures of the scenes") },
        Section { id: "heat", title: HEAT_TITLE, blocks: missing("Heat maps of the structures") },
    ]
}

/// The arguments of a command that are files named as the scene.
fn files_named(command: &str, scene: &str) -> Vec<String> {
    let words = command.split(' ').map(|word| word.trim_matches('\''));
    let named = words.filter(|word| std::path::Path::new(word).file_stem().is_some_and(|stem| stem == scene));
    named.map(String::from).collect()
}

fn size_of(scene: &Scene, longest: u32) -> [u32; 2] {
    let [width, height] = scene.size;
    let most = width.max(height).max(1);
    [width, height].map(|side| (u64::from(side) * u64::from(longest) / u64::from(most)).max(1) as u32)
}

/// The scene as the report's course shades it, four rays a pixel.
fn thumbnail(shown: &Shown, registry: &Registry) -> Option<Thumbnail> {
    let scene = &shown.scene;
    let choice = registry.choose(SAH_TREE).ok().or_else(|| registry.all().into_iter().next())?;
    let accel = choice.build(&scene.mesh).ok()?;
    let size = size_of(scene, THUMBNAIL);
    let fine = guarded(|| draw_view(scene, accel.as_ref(), ViewKind::Shaded, size.map(|side| 2 * side), 1))
        .and_then(Result::ok)?;
    let picture = halved(&fine);
    let differs = if shown.differs { "; another mesh than the one measured" } else { "" };
    let name = scene_name(&scene.name, !scene.stand_ins.is_empty());
    Some(Thumbnail {
        alt: format!("{name}, rendered"),
        note: format!("{} triangles{differs}", count(scene.mesh.len() as u64)),
        name,
        png: picture.png(),
        size,
    })
}

/// The mean of each two by two pixels.
fn halved(fine: &Picture) -> Picture {
    let [width, height] = fine.size().map(|side| side / 2);
    let pixel = |x: u32, y: u32| fine.pixels()[(y * fine.size()[0] + x) as usize];
    let mean = |x: u32, y: u32| {
        let four = [pixel(x, y), pixel(x + 1, y), pixel(x, y + 1), pixel(x + 1, y + 1)];
        std::array::from_fn(|c| (four.iter().map(|p| u32::from(p[c])).sum::<u32>().div_ceil(4)).min(255) as u8)
    };
    let pixels = (0..height).flat_map(|y| (0..width).map(move |x| mean(2 * x, 2 * y)));
    Picture::new([width, height], pixels.collect())
}

/// What one structure does for each pixel.
struct Heat {
    label: String,
    costs: Vec<u64>,
}

fn heat_figure(shown: &Shown, runs: &Runs, registry: &Registry) -> Option<Figure> {
    let scene = &shown.scene;
    let size = size_of(scene, HEAT);
    let labels = distinct(runs.records().iter().filter(|r| r.scene == scene.name).map(|r| &r.label));
    let labels = if labels.is_empty() { [REPORT_TREE, SAH_TREE].map(String::from).into() } else { labels };
    let mut maps: Vec<Heat> = vec![];
    for label in labels {
        let Ok(choice) = registry.choose(&label) else { continue };
        if choice.entry.name == BRUTE_FORCE || choice.entry.observed != Observed::ALL {
            continue;
        }
        let Ok(accel) = choice.build(&scene.mesh) else { continue };
        let accel: &dyn DynAccel = accel.as_ref();
        if let Some(Ok(costs)) = guarded(|| costs(scene, accel, size)) {
            maps.push(Heat { label, costs });
        }
    }
    // One scale for all: a structure is as bright as its work.
    let scale = maps.iter().map(|heat| hottest(&heat.costs)).max()?;
    let name = scene_name(&scene.name, !scene.stand_ins.is_empty());
    let mean = |heat: &Heat| heat.costs.iter().sum::<u64>() as f64 / heat.costs.len() as f64;
    let pictures: Vec<Thumbnail> = maps
        .iter()
        .map(|heat| {
            let picture =
                Picture::new(size, heat.costs.iter().map(|&cost| heat_colour(stepped(cost, scale), scale)).collect());
            Thumbnail {
                name: heat.label.clone(),
                note: format!("{} a ray", figures(mean(heat))),
                alt: format!(
                    "Heat map of {} on {name}: {} tests and steps a ray on average",
                    heat.label,
                    figures(mean(heat))
                ),
                png: picture.png(),
                size,
            }
        })
        .collect();
    let rows = maps.iter().map(|heat| {
        let most = heat.costs.iter().max().copied().unwrap_or(0);
        [heat.label.clone(), figures(mean(heat)), count(hottest(&heat.costs)), count(most)]
    });
    let place = |cost: f64| libm::log1p(cost) / libm::log1p(scale as f64);
    let tens = (0..7).map(|exponent| f64::from(10u32.pow(exponent))).filter(|cost| place(*cost) < 0.93);
    let ticks = std::iter::once((0.0, "0".to_owned())).chain(tens.map(|cost| (place(cost), tick_text(cost))));
    let hex = |[r, g, b]: [u8; 3]| format!("#{r:02x}{g:02x}{b:02x}");
    let at = |i: i32| libm::expm1(f64::from(i) / 16.0 * libm::log1p(scale as f64));
    Some(Figure {
        id: format!("heat-{}", slug(&scene.name)),
        caption: format!(
            "{name}: triangle tests and steps of each camera ray, all structures on one logarithmic scale from 0 to {}, which \
             all but one in two hundred pixels stay below. Brute force, which tests every triangle for every ray, would \
             darken all of them and is left out.",
            count(scale)
        ),
        alt: String::new(),
        command: format!(
            "sahara render {} --view heat --hottest {scale} --structure NAME -o NAME.png",
            if Builtin::find(&shown.argument).is_ok() { shown.argument.to_lowercase() } else { shown.argument.clone() }
        ),
        art: Art::Overlay(Overlay {
            heading: name.clone(),
            pictures,
            ramp_title: "Triangle tests and steps of a camera ray:".into(),
            ramp: (0..=16).map(|i| hex(heat_colour(libm::round(at(i)) as u64, scale))).collect(),
            ticks: ticks.chain([(1.0, count(scale))]).collect(),
        }),
        data: Table::of_texts("", ["structure", "mean", "99.5 % below", "most"], rows.collect()),
    })
}

/// A cost in one of a few steps: the eye sees no more, and the file is a third.
fn stepped(cost: u64, scale: u64) -> u64 {
    const STEPS: f64 = 48.0;
    let unit = libm::log1p(scale as f64) / STEPS;
    let step = libm::round(libm::log1p(cost.min(scale) as f64) / unit);
    libm::round(libm::expm1(step * unit)) as u64
}

fn heat_section(figures: Vec<Figure>) -> Section {
    let mut blocks = vec![];
    if figures.is_empty() {
        blocks.push(Block::missing("Heat maps of the structures", "sahara compare --dir runs"));
    } else {
        blocks.push(Block::Text("Where the work is: brighter pixels cost more triangle tests and steps.".into()));
        blocks.extend(figures.into_iter().map(Block::Figure));
    }
    Section { id: "heat", title: HEAT_TITLE, blocks }
}

fn scene_section(thumbnails: Vec<Thumbnail>, all_builtin: bool, lost: &[String]) -> Section {
    let mut blocks = vec![];
    if !thumbnails.is_empty() {
        let rows = thumbnails.iter().map(|t| [t.name.clone(), t.note.clone()]).collect();
        blocks.push(Block::Figure(Figure {
            id: "scenes".into(),
            caption: if all_builtin {
                "The scenes as they were traced, rendered by sahara with the source report's cameras, lights and materials."
            } else {
                "The scenes as they were traced, rendered by sahara: the built-in ones with the source report's cameras, lights and \
                 materials, those of scene files with their own, and meshes with a camera that has them whole in view."
            }
            .into(),
            alt: String::new(),
            command: "sahara render SCENE -o SCENE.png".into(),
            art: Art::Gallery(thumbnails),
            data: Table::of_texts("", ["scene", "triangles"], rows),
        }));
    }
    for name in lost {
        blocks
            .push(Block::missing(&format!("A picture of {name}: its file is not here"), "sahara render FILE -o F.png"));
    }
    Section { id: "scenes", title: SCENES_TITLE, blocks }
}
