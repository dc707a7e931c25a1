//! Views of a scene, and of the cost and errors of a structure.

use std::str::FromStr;

use image::RgbImage;

use super::picture::{from_pixels, of_colours, primary, quantised};
use super::{ErrorMap, Work, colour_map, shade};
use crate::accel::{DynAccel, Observed};
use crate::geometry::{Hit, Ray};
use crate::names::{Unknown, find, named_enum};
use crate::scene::Scene;

named_enum! {
    #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
    pub enum ViewKind {
        Shaded = "shaded",
        /// Reciprocal distance, from white (nearest hit) to dark grey (farthest hit). Misses are black.
        Depth = "depth",
        /// The shading normal: x, y and z, from -1 to 1, become red, green and blue. Misses are black.
        Normal = "normal",
        /// The colour of a primitive depends only on its number. Misses are black.
        Primitive = "primitive",
        Heat = "heat",
        Error = "error",
    }
}

#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("the structure does not count tests and steps, which the heat view shows: choose another view or structure")]
pub struct ViewError;

impl FromStr for ViewKind {
    type Err = Unknown;

    fn from_str(name: &str) -> Result<Self, Unknown> {
        find("view", Self::ALL, name, Self::name)
    }
}

/// `accel` must be built over the scene's mesh. `hottest` is the cost with the brightest colour in the heat view.
/// To compare structures, use the same `hottest` for all structures.
///
/// # Errors
/// In the heat view, if the structure does not count triangle tests or does not count traversal steps.
pub fn draw(
    scene: &Scene,
    accel: &dyn DynAccel,
    view: ViewKind,
    size: [u32; 2],
    hottest: u64,
) -> Result<RgbImage, ViewError> {
    let rays = primary(scene, size);
    let hits = || accel.closest_by_chunks(&rays, 4096).into_iter();
    let of_hits = |colour: &dyn Fn(&Ray, Hit) -> [u8; 3]| {
        let colours = rays.iter().zip(hits()).map(|(ray, hit)| hit.map_or([0; 3], |hit| colour(ray, hit)));
        from_pixels(size, colours.collect())
    };
    Ok(match view {
        ViewKind::Shaded => of_colours(size, &shade(scene, accel, &rays)),
        ViewKind::Depth => {
            let depths = hits().map(|hit| hit.map_or(f32::INFINITY, |hit| hit.t));
            depth_picture(size, &depths.collect::<Vec<f32>>())
        }
        ViewKind::Normal => of_hits(&|ray, hit| normal_colour(scene, ray, hit)),
        ViewKind::Primitive => of_hits(&|_, hit| identity(hit.prim.index())),
        ViewKind::Heat => {
            let colours = costs(scene, accel, size)?.into_iter().map(|cost| colour_map::heat(cost, hottest));
            from_pixels(size, colours.collect())
        }
        ViewKind::Error => ErrorMap::new(scene, accel, size).picture(),
    })
}

/// The sum of triangle tests and traversal steps for each pixel, row by row.
///
/// # Errors
/// If the structure does not count triangle tests or does not count traversal steps.
pub fn costs(scene: &Scene, accel: &dyn DynAccel, size: [u32; 2]) -> Result<Vec<u64>, ViewError> {
    if accel.observed() != Observed::ALL {
        return Err(ViewError);
    }
    Ok(Work::of(accel, &primary(scene, size)).iter().map(Work::cost).collect())
}

/// The cost with the brightest colour in the heat view: the 99.5th percentile of `costs`, at least 1. The percentile
/// ignores a few extreme pixels.
pub fn hottest(costs: &[u64]) -> u64 {
    let mut sorted = costs.to_vec();
    sorted.sort_unstable();
    let place = (sorted.len() - sorted.len() / 200).saturating_sub(1);
    sorted.get(place).copied().unwrap_or(1).max(1)
}

/// The longer side has `longest` pixels.
pub fn size_of(scene: &Scene, longest: u32) -> [u32; 2] {
    let [width, height] = scene.size;
    let most = width.max(height).max(1);
    [width, height].map(|side| (u64::from(side) * u64::from(longest) / u64::from(most)).max(1) as u32)
}

/// The size of pictures on the web page. `sahara render` also computes the scale of the heat view at this size.
pub fn coarse_size(scene: &Scene) -> [u32; 2] {
    size_of(scene, 320)
}

pub fn normal_colour(scene: &Scene, ray: &Ray, hit: Hit) -> [u8; 3] {
    (scene.surface(ray, hit).shading_normal * 0.5 + 0.5).to_array().map(quantised)
}

/// `depths` has one distance per pixel. A miss has an infinite distance.
pub fn depth_picture(size: [u32; 2], depths: &[f32]) -> RgbImage {
    let seen = depths.iter().copied().filter(|t| t.is_finite());
    let (near, far) = seen.fold((f32::INFINITY, 0.0f32), |(near, far), t| (near.min(t), far.max(t)));

    // Reciprocals keep the contrast of near surfaces, even if a floor extends to the horizon.
    // The constant 0.15 makes the farthest hit brighter than a miss.
    let near = near.max(far * 1e-3);
    let brightness = |t: f32| {
        let share = (near / t.max(near) - near / far) / (1.0 - near / far);
        0.15 + 0.85 * if far > near { share } else { 1.0 }
    };
    let colour = |&t: &f32| if t.is_finite() { [quantised(brightness(t)); 3] } else { [0; 3] };
    from_pixels(size, depths.iter().map(colour).collect())
}

/// A unique colour, not black, for each `index` from 0 to 2^24 - 2. Multiplication by an odd constant is invertible
/// modulo 2^24.
pub fn identity(index: u32) -> [u8; 3] {
    let [_, red, green, blue] = ((index.wrapping_add(1)).wrapping_mul(0x9E_37_79) & 0xFF_FF_FF).to_be_bytes();
    [red, green, blue]
}

#[cfg(test)]
mod tests {
    use std::collections::HashSet;

    use super::*;
    use crate::accel::Accel;
    use crate::brute_force::BruteForce;
    use crate::kdtree::{KdConfig, KdTree};
    use crate::scene::tests::of_the_report;
    use crate::triangle::MollerTrumbore;

    #[test]
    fn every_view_shows_the_cube_and_what_is_around_it() {
        let scene = of_the_report("cube");
        let tree = KdTree::<MollerTrumbore>::build(&scene.mesh, &KdConfig::SAH).unwrap();
        let all = BruteForce::<MollerTrumbore>::build(&scene.mesh, &Default::default()).unwrap();
        let colours = |view: ViewKind, accel: &dyn DynAccel| {
            let picture = draw(&scene, accel, view, [64, 64], 14).unwrap();
            (picture.get_pixel(0, 0).0, picture.pixels().map(|pixel| pixel.0).collect::<HashSet<_>>())
        };
        for view in [ViewKind::Shaded, ViewKind::Depth, ViewKind::Normal, ViewKind::Primitive] {
            assert_eq!(draw(&scene, &tree, view, [64, 64], 1), draw(&scene, &all, view, [64, 64], 9), "{view:?}");
            let miss = if view == ViewKind::Shaded { [51, 64, 77] } else { [0; 3] };
            assert_eq!(colours(view, &tree).0, miss, "{view:?}");
        }
        // The eye sees three sides of the cube, each with two triangles.
        assert_eq!(colours(ViewKind::Normal, &tree).1.len(), 3 + 1);
        assert_eq!(colours(ViewKind::Primitive, &tree).1.len(), 6 + 1);
        assert!(colours(ViewKind::Depth, &tree).1.contains(&[255; 3]));

        // The cost of brute force is twelve triangle tests and one step per ray.
        assert_eq!(costs(&scene, &all, [4, 4]).unwrap(), [13; 16]);
        assert_eq!(colours(ViewKind::Heat, &all).1, HashSet::from([colour_map::heat(13, 14)]));
    }

    #[test]
    fn primitives_have_colours_of_their_own() {
        let colours: HashSet<[u8; 3]> = (0..300_000).map(identity).collect();
        assert_eq!(colours.len(), 300_000);
        assert!(!colours.contains(&[0; 3]));
    }

    #[test]
    fn the_hottest_leaves_out_one_in_two_hundred() {
        let costs: Vec<u64> = (1..=1000).rev().collect();
        assert_eq!(hottest(&costs), 995);
        assert_eq!([hottest(&[]), hottest(&[0, 0]), hottest(&[7])], [1, 1, 7]);
    }
}
