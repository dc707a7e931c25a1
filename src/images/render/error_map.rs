//! A picture that shows the errors of a structure.

use image::RgbImage;
use rayon::prelude::*;

use super::picture::{from_pixels, primary};
use crate::accel::DynAccel;
use crate::geometry::{Hit, Ray};
use crate::oracle::{DepthRule, Oracle, Outcome, Truth, outcome};
use crate::scene::Scene;

/// The primary rays of a picture, row by row, with their exact hits.
pub struct ExactPicture {
    pub size: [u32; 2],
    pub rays: Vec<Ray>,
    pub truths: Vec<Option<Truth>>,
}

impl ExactPicture {
    pub fn new(scene: &Scene, size: [u32; 2]) -> Self {
        let oracle = Oracle::new(&scene.mesh);
        let rays = primary(scene, size);
        let truths = rays.par_iter().map(|ray| oracle.nearest(ray)).collect();
        Self { size, rays, truths }
    }

    pub fn outcome(&self, pixel: usize, hit: Option<Hit>) -> Outcome {
        outcome(self.truths[pixel].as_ref(), hit, DepthRule::STRICT)
    }
}

pub struct ErrorMap {
    size: [u32; 2],
    pixels: Vec<(Outcome, Option<Hit>)>,
}

/// The outcomes that are painted as errors. Colour-blind people can distinguish the colours.
///
/// # References
/// Okabe, Ito, Color universal design, 2008.
const PAINTED: [(Outcome, &str, &str, [u8; 3]); 4] = [
    (Outcome::Missed, "missed", "vermilion", [213, 94, 0]),
    (Outcome::FalseHit, "false hit", "yellow", [240, 228, 66]),
    (Outcome::WrongDepth, "wrong depth", "sky blue", [86, 180, 233]),
    (Outcome::WrongPrimitive, "wrong primitive at the right depth", "pink", [204, 121, 167]),
];

/// `None` if the outcome is not painted as an error.
pub fn error_name(outcome: Outcome) -> Option<&'static str> {
    PAINTED.iter().find(|(painted, ..)| *painted == outcome).map(|(_, name, ..)| *name)
}

/// The grey level of the nearest correct hit. Grey levels are from 0 to 255. All error colours are brighter than this
/// grey level.
const BRIGHTEST: f32 = 90.0;

impl ErrorMap {
    pub fn new(scene: &Scene, accel: &dyn DynAccel, size: [u32; 2]) -> Self {
        let exact = ExactPicture::new(scene, size);
        Self::of(&exact, accel.closest_by_chunks(&exact.rays, 1024))
    }

    /// # Panics
    /// If the number of hits differs from the number of pixels.
    pub fn of(exact: &ExactPicture, hits: impl IntoIterator<Item = Option<Hit>>) -> Self {
        let check = |(pixel, hit)| (exact.outcome(pixel, hit), hit);
        let pixels: Vec<_> = hits.into_iter().enumerate().map(check).collect();
        assert_eq!(pixels.len(), exact.rays.len(), "one hit per pixel");
        Self { size: exact.size, pixels }
    }

    pub fn errors(&self) -> impl Iterator<Item = usize> {
        (0..self.pixels.len()).filter(move |&pixel| error_name(self.pixels[pixel].0).is_some())
    }

    pub fn count(&self, outcome: Outcome) -> usize {
        self.pixels.iter().filter(|(other, _)| *other == outcome).count()
    }

    pub fn legend(&self) -> String {
        let painted = PAINTED.map(|(outcome, name, colour, _)| format!("{name} {} ({colour})", self.count(outcome)));
        let right = self.count(Outcome::Right) + self.count(Outcome::RightMiss);
        format!("{}, correct {right} (grey, brighter where nearer); errors are three pixels wide", painted.join(", "))
    }

    /// The name, pixel count and RGB colour of each outcome that is painted as an error.
    pub fn colours(&self) -> [(&'static str, usize, [u8; 3]); 4] {
        PAINTED.map(|(outcome, name, _, colour)| (name, self.count(outcome), colour))
    }

    pub fn picture(&self) -> RgbImage {
        let right = |(outcome, hit): &(Outcome, Option<Hit>)| hit.filter(|_| *outcome == Outcome::Right);
        let nearest = self.pixels.iter().filter_map(right).fold(f32::INFINITY, |near, hit| near.min(hit.t));
        let colour = |pixel: &(Outcome, Option<Hit>)| {
            // The darkest grey level of a hit is a third of `BRIGHTEST`, because a miss is black.
            let light = |hit: Hit| 1.0 / 3.0 + 2.0 / 3.0 * if hit.t > nearest { nearest / hit.t } else { 1.0 };
            let grey = pixel.1.map_or(0, |hit| (BRIGHTEST * light(hit)) as u8);
            PAINTED.iter().find(|(outcome, ..)| *outcome == pixel.0).map_or([grey; 3], |(.., colour)| *colour)
        };
        let mut colours: Vec<[u8; 3]> = self.pixels.iter().map(colour).collect();
        // An error also colours neighbouring pixels without errors, because a single pixel is hard to see.
        let [width, height] = self.size.map(i64::from);
        for error in self.errors() {
            let (x, y) = (error as i64 % width, error as i64 / width);
            for (x, y) in (y - 1..=y + 1).flat_map(|y| (x - 1..=x + 1).map(move |x| (x, y))) {
                let is_inside = (0..width).contains(&x) && (0..height).contains(&y);
                let at = (y * width + x) as usize;
                if is_inside && error_name(self.pixels[at].0).is_none() {
                    colours[at] = colour(&self.pixels[error]);
                }
            }
        }
        from_pixels(self.size, colours)
    }
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use image::Rgb;

    use super::*;
    use crate::accel::Accel;
    use crate::geometry::Mesh;
    use crate::kdtree::{KdConfig, KdTree};
    use crate::scene::tests::of_the_report;
    use crate::triangle::Exact;

    #[test]
    fn right_hits_are_grey_and_errors_have_their_colours() {
        let mut scene = of_the_report("cube");
        let tree = KdTree::<Exact>::build(&scene.mesh, &KdConfig::SAH).unwrap();
        let size = [24, 24];
        let map = ErrorMap::new(&scene, &tree, size);
        let (hits, picture) = (map.count(Outcome::Right), map.picture());
        assert!(hits > 0 && hits < 24 * 24, "{}", map.legend());
        assert_eq!(hits + map.count(Outcome::RightMiss), 24 * 24);
        assert!(picture.pixels().all(|Rgb([r, g, b])| r == g && g == b && f32::from(*r) <= BRIGHTEST));
        assert_eq!(picture.get_pixel(0, 0), &Rgb([0; 3]));

        let empty = Arc::new(Mesh::new(vec![], vec![]).unwrap());
        let nothing = KdTree::<Exact>::build(&empty, &KdConfig::SAH).unwrap();
        let missed = ErrorMap::new(&scene, &nothing, size);
        assert_eq!(missed.count(Outcome::Missed), hits);
        assert!(missed.picture().pixels().any(|pixel| pixel.0 == [213, 94, 0]), "{}", missed.legend());
        scene.mesh = empty;
        let invented = ErrorMap::new(&scene, &tree, size);
        assert_eq!(invented.count(Outcome::FalseHit), hits);
        assert!(invented.picture().pixels().any(|pixel| pixel.0 == [240, 228, 66]));
        assert!(invented.legend().contains(&format!("false hit {hits} (yellow)")), "{}", invented.legend());
    }
}
