//! Decides by exact arithmetic which of two pictures shows a pixel correctly.

use image::DynamicImage;

use crate::accel::DynAccel;
use crate::escaped::quoted;
use crate::golden::{SceneGolden, TRIANGLE_TEST};
use crate::oracle::Oracle;
use crate::oracle::{DepthRule, outcome};
use crate::registry::Registry;
use crate::render::{ViewKind, error_name};
use crate::request::BRUTE_FORCE;
use crate::scene::Scene;

pub struct Judge<'a> {
    scene: &'a Scene,
    golden: &'a SceneGolden,
    exact: Box<dyn DynAccel>,
    oracle: Oracle,
    /// The argument that names the scene in a printed command.
    word: &'a str,
}

impl<'a> Judge<'a> {
    pub fn new(registry: &Registry, scene: &'a Scene, golden: &'a SceneGolden, word: &'a str) -> anyhow::Result<Self> {
        let exact = registry.choose(&format!("{BRUTE_FORCE}:test={TRIANGLE_TEST}"))?.build(&scene.mesh)?;
        Ok(Self { scene, golden, exact, oracle: Oracle::new(&scene.mesh), word })
    }

    /// Returns a sentence about a pixel, and a command that traces the pixel's primary ray.
    pub fn blame(
        &self,
        structure: &str,
        accel: &dyn DynAccel,
        [expected, actual]: [&DynamicImage; 2],
        [column, row]: [u32; 2],
    ) -> (String, String) {
        let ray = self.golden.ray(self.scene, [column, row]);
        let exact = self.golden.drawn_pixel(self.scene, self.exact.as_ref(), &ray);
        let pixel = |picture: &DynamicImage| picture.crop_imm(column, row, 1, 1);
        let [wanted, painted] = [expected, actual].map(pixel);
        let side = match () {
            () if exact == wanted => "exact arithmetic confirms the golden image".into(),
            () if exact == painted => {
                format!("exact arithmetic confirms {structure}: the golden image is out of date")
            }
            () => format!("exact arithmetic confirms neither and gives {}", self.values(&exact)),
        };
        let [hit, exact_hit] = [accel, self.exact.as_ref()].map(|accel| accel.closest(&[ray])[0]);
        let wrong = error_name(outcome(self.oracle.nearest(&ray).as_ref(), hit, DepthRule::STRICT));
        let primary = match wrong {
            Some(wrong) => wrong,
            None if hit.map(|hit| hit.prim) != exact_hit.map(|hit| hit.prim) => {
                "correct, with another triangle at the same t"
            }
            None => "correct, so the cause is another ray of the pixel",
        };
        let [wanted, painted] = [&wanted, &painted].map(|pixel| self.values(pixel));
        let sentence = format!(
            "at column {column}, row {row} the golden image has {wanted}, and {structure} gives {painted}; {side}; \
             result of its primary ray: {primary}"
        );
        (sentence, format!("sahara validate {} -s {} --ray \"{ray}\"", self.word, quoted(structure)))
    }

    /// The picture `pixel` has a size of 1 x 1 pixels.
    fn values(&self, pixel: &DynamicImage) -> String {
        let numbers = self.golden.pixel_values(pixel);
        let is_hit = !numbers.contains(&f64::INFINITY);
        match self.golden.view {
            ViewKind::Depth | ViewKind::Primitive if !is_hit => "no hit".into(),
            ViewKind::Depth => format!("t = {}", numbers[0]),
            ViewKind::Primitive => format!("triangle {}", numbers[0]),
            _ => numbers.iter().map(f64::to_string).collect::<Vec<_>>().join(", "),
        }
    }
}
