//! Where a structure or its triangle test is wrong, pixel by pixel.

use rayon::prelude::*;

use super::Picture;
use crate::accel::DynAccel;
use crate::geometry::Hit;
use crate::oracle::Oracle;
use crate::scene::{Scene, View};
use crate::validate::{DepthRule, Outcome, outcome};

/// The primary rays of a picture, each checked against the exact oracle.
pub struct ErrorMap {
    size: [u32; 2],
    pixels: Vec<(Outcome, Option<Hit>)>,
}

/// Outcomes that the map paints in a colour of their own, with its name: four that colour-blind people tell apart too
/// (Okabe, Ito: Color universal design, 2008). All others are grey.
const PAINTED: [(Outcome, &str, &str, [u8; 3]); 4] = [
    (Outcome::Missed, "missed", "vermilion", [213, 94, 0]),
    (Outcome::FalseHit, "false hit", "yellow", [240, 228, 66]),
    (Outcome::WrongDepth, "wrong depth", "sky blue", [86, 180, 233]),
    (Outcome::WrongPrimitive, "wrong primitive at the right depth", "pink", [204, 121, 167]),
];

/// The brightest grey of a right answer: errors must be brighter.
const BRIGHTEST: f32 = 90.0;

impl ErrorMap {
    /// Checks the answers of `accel` to the primary rays of `scene`, with the strict depth rule.
    pub fn new(scene: &Scene, accel: &dyn DynAccel, size: [u32; 2]) -> Self {
        let oracle = Oracle::new(&scene.mesh);
        let rays = scene.primary_rays(size, View::CENTRE, 0..size[0] * size[1]);
        let checked = |rays: &[_]| {
            let check = |(ray, hit)| (outcome(oracle.nearest(ray).as_ref(), hit, DepthRule::STRICT), hit);
            rays.iter().zip(accel.closest(rays)).map(check).collect::<Vec<_>>()
        };
        Self { size, pixels: rays.par_chunks(1024).flat_map_iter(checked).collect() }
    }

    /// Pixels with this outcome.
    pub fn count(&self, outcome: Outcome) -> usize {
        self.pixels.iter().filter(|(other, _)| *other == outcome).count()
    }

    /// What the colours mean, with the number of pixels of each.
    pub fn legend(&self) -> String {
        let painted = PAINTED.map(|(outcome, name, colour, _)| format!("{name} {} ({colour})", self.count(outcome)));
        let right = self.count(Outcome::Right) + self.count(Outcome::Nothing);
        format!(
            "{}, right {right} (grey, brighter where nearer); errors are drawn three pixels wide",
            painted.join(", ")
        )
    }

    /// Errors in colours, enlarged; right answers as a dim depth.
    pub fn picture(&self) -> Picture {
        let right = |(outcome, hit): &(Outcome, Option<Hit>)| hit.filter(|_| *outcome == Outcome::Right);
        let nearest = self.pixels.iter().filter_map(right).fold(f32::INFINITY, |near, hit| near.min(hit.t));
        let colour = |pixel: &(Outcome, Option<Hit>)| {
            if let Some((_, _, _, colour)) = PAINTED.iter().find(|(outcome, ..)| *outcome == pixel.0) {
                return *colour;
            }
            // What is far keeps a third of the light, so that it differs from a miss.
            let light = |hit: Hit| 1.0 / 3.0 + 2.0 / 3.0 * if hit.t > nearest { nearest / hit.t } else { 1.0 };
            [pixel.1.map_or(0, |hit| (BRIGHTEST * light(hit)) as u8); 3]
        };
        let mut colours: Vec<[u8; 3]> = self.pixels.iter().map(colour).collect();
        // One pixel of a large picture is not seen: an error is three wide and high, and hides no other error.
        let is_error = |outcome: Outcome| PAINTED.iter().any(|(painted, ..)| *painted == outcome);
        let [width, height] = self.size.map(i64::from);
        let index = |x: i64, y: i64| (y * width + x) as usize;
        for (x, y) in (0..height).flat_map(|y| (0..width).map(move |x| (x, y))) {
            let error = &self.pixels[index(x, y)];
            if !is_error(error.0) {
                continue;
            }
            for (x, y) in (y - 1..=y + 1).flat_map(|y| (x - 1..=x + 1).map(move |x| (x, y))) {
                let is_inside = (0..width).contains(&x) && (0..height).contains(&y);
                if is_inside && !is_error(self.pixels[index(x, y)].0) {
                    colours[index(x, y)] = colour(error);
                }
            }
        }
        Picture::new(self.size, colours)
    }
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use super::*;
    use crate::accel::Accel;
    use crate::geometry::Mesh;
    use crate::kdtree::{KdConfig, KdTree};
    use crate::scene::Builtin;
    use crate::triangle::Exact;

    #[test]
    fn exact_answers_are_all_grey() {
        let scene = Builtin::find("cube").unwrap().scene(None).unwrap();
        let tree = KdTree::<Exact>::build(&scene.mesh, &KdConfig::SAH).unwrap();
        let map = ErrorMap::new(&scene, &tree, [48, 48]);
        assert!(map.count(Outcome::Right) > 0 && map.count(Outcome::Nothing) > 0, "{}", map.legend());
        assert_eq!(map.count(Outcome::Right) + map.count(Outcome::Nothing), 48 * 48);
        assert!(map.picture().pixels().iter().all(|[r, g, b]| r == g && g == b && f32::from(*r) <= BRIGHTEST));
        assert_eq!(map.picture().pixels()[0], [0; 3]);
    }

    #[test]
    fn errors_have_their_colours() {
        let mut scene = Builtin::find("cube").unwrap().scene(None).unwrap();
        let tree = KdTree::<Exact>::build(&scene.mesh, &KdConfig::SAH).unwrap();
        let size = [24, 24];
        let hits = ErrorMap::new(&scene, &tree, size).count(Outcome::Right);

        // The answers are for one mesh, the truth is for another.
        let empty = Arc::new(Mesh::new(vec![], vec![]).unwrap());
        let nothing = KdTree::<Exact>::build(&empty, &KdConfig::SAH).unwrap();
        let missed = ErrorMap::new(&scene, &nothing, size);
        assert_eq!(missed.count(Outcome::Missed), hits);
        assert!(missed.picture().pixels().contains(&[213, 94, 0]), "{}", missed.legend());
        scene.mesh = empty;
        let invented = ErrorMap::new(&scene, &tree, size);
        assert_eq!(invented.count(Outcome::FalseHit), hits);
        assert!(invented.picture().pixels().contains(&[240, 228, 66]));
        assert!(invented.legend().contains(&format!("false hit {hits} (yellow)")), "{}", invented.legend());
    }
}
