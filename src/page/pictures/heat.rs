//! Heat maps: the cost per pixel of each structure.

use super::camera_rays::{CameraRays, StructureWork};
use super::inspect::most_rays;
use super::maps::{Maps, hex};
use crate::accel::Observed;
use crate::render::{Work, from_pixels, heat_colour, hottest};
use crate::report::number::{count, figures};
use crate::report::plot::tick_text;
use crate::report::{Colours, Table};

pub fn maps(camera: &CameraRays) -> Option<Maps> {
    let counting = camera.structures.iter().filter(|own| own.observed == Observed::ALL);
    let costs = |own: &StructureWork| own.work.iter().map(Work::cost).collect();
    let costs: Vec<(&str, Vec<u64>)> = counting.map(|own| (own.label.as_str(), costs(own))).collect();
    let mean = |costs: &[u64]| costs.iter().sum::<u64>() as f64 / costs.len() as f64;
    // All structures share one scale, so equal cost has equal brightness.
    let scale = costs.iter().map(|(_, costs)| hottest(costs)).max()?;
    let (name, size) = (&camera.name, camera.exact.size);
    let picture = |(label, costs): &(&str, Vec<u64>)| {
        let colours = costs.iter().map(|&cost| heat_colour(stepped(cost, scale), scale));
        let mean = figures(mean(costs));
        let alt = format!("Heat map of {label} on {name}: {mean} tests and steps per ray on average");
        camera.picture(label, alt, format!("{mean} per ray"), &from_pixels(size, colours.collect()))
    };
    let rows = costs.iter().map(|(label, costs)| {
        let most = costs.iter().max().copied().unwrap_or(0);
        vec![(*label).into(), mean(costs).into(), hottest(costs).into(), most.into()]
    });
    let (pixels, which) = grid(camera);
    Some(Maps {
        view: format!("heat --hottest {scale}"),
        caption: format!(
            "{name}: triangle tests and traversal steps of each camera ray. All structures share one logarithmic \
             scale from 0 to {}; 99.5 % of the pixels are below its end. Brute force is left out: its cost would \
             darken all other maps.",
            count(scale)
        ),
        pictures: costs.iter().map(picture).collect(),
        colours: ramp(scale),
        data: Table::new("", ["structure", "mean", "99.5 % below", "most"], rows),
        pixels,
        which,
    })
}

fn grid(camera: &CameraRays) -> (Vec<usize>, String) {
    let [width, height] = camera.exact.size.map(|side| side as usize);
    let of = |stride: usize| {
        let places = |side: usize| (stride / 2..side).step_by(stride);
        places(height).flat_map(|y| places(width).map(move |x| y * width + x)).collect::<Vec<_>>()
    };
    let most = most_rays(camera.structures.len());
    let found = (1..).map(|stride| (stride, of(stride))).find(|(_, pixels)| pixels.len() <= most);
    let (stride, pixels) = found.expect("no pixel is few enough");
    let which = match stride {
        1 => "Select any pixel.".into(),
        _ => format!("Select any pixel of a grid with a spacing of {stride} pixels."),
    };
    (pixels, which)
}

fn ramp(scale: u64) -> Colours {
    let place = |cost: f64| libm::log1p(cost) / libm::log1p(scale as f64);
    let tens = (0..7).map(|exponent| f64::from(10u32.pow(exponent))).filter(|cost| place(*cost) < 0.93);
    let ticks = std::iter::once((0.0, "0".to_owned())).chain(tens.map(|cost| (place(cost), tick_text(cost))));
    let at = |i: i32| libm::expm1(f64::from(i) / 16.0 * libm::log1p(scale as f64));
    Colours::Ramp {
        title: "Triangle tests and traversal steps of a camera ray:".into(),
        colours: (0..=16).map(|i| hex(heat_colour(libm::round(at(i)) as u64, scale))).collect(),
        ticks: ticks.chain([(1.0, count(scale))]).collect(),
    }
}

/// Rounds `cost` to one of the logarithmic steps from 0 to `scale`. This rounding reduces the size of the PNG data.
fn stepped(cost: u64, scale: u64) -> u64 {
    const STEPS: f64 = 48.0;
    let unit = libm::log1p(scale as f64) / STEPS;
    let step = libm::round(libm::log1p(cost.min(scale) as f64) / unit);
    libm::round(libm::expm1(step * unit)) as u64
}
