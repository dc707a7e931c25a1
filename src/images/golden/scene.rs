//! Renders, checks and updates the golden images of scenes.

use std::borrow::Cow;
use std::path::{Path, PathBuf};

use image::DynamicImage;

use super::{Difference, GoldenError, Layout, Match, failure, file, numbers};
use crate::accel::DynAccel;
use crate::geometry::{Hit, Ray};
use crate::render::{ViewKind, from_pixels, normal_colour, of_colours, shade};
use crate::scene::{Camera, Scene, View};
use crate::triangle::{Exact, TriangleTest};

/// By default, golden images are rendered with this triangle test. Its hits do not depend on rounding.
pub const TRIANGLE_TEST: &str = Exact::NAME;

/// Width and height of a golden image of a built-in scene.
pub const SIZE: [u32; 2] = [160, 160];

/// For a given scene, the pixels of these views depend only on the hits.
pub const VIEWS: [ViewKind; 4] = [ViewKind::Shaded, ViewKind::Depth, ViewKind::Normal, ViewKind::Primitive];

const REMEDY: &str = "create the golden images with `sahara golden update`";

/// The golden image of one view of a scene, as a file or compiled into the program.
#[derive(Clone, Debug, PartialEq)]
pub struct SceneGolden {
    pub view: ViewKind,
    pub size: [u32; 2],
    path: PathBuf,
    shown_path: PathBuf,
    /// The file's content for a built-in scene. `None` for a golden image in a folder.
    bytes: Option<&'static [u8]>,
    /// The requested camera. `None` for a built-in scene.
    note: Option<String>,
}

#[derive(Clone, Debug, PartialEq)]
pub enum Update {
    Same,
    New,
    Changed(Difference),
    /// The layout changed. The field is the old layout.
    Layout(Layout),
}

impl SceneGolden {
    /// The shaded view of a built-in scene. `bytes` is the content of the PNG file. [`update`](Self::update) writes
    /// to `file` in the source tree `sources`. The source tree may be missing at run time.
    pub fn in_program(bytes: &'static [u8], sources: &Path, file: &Path) -> Self {
        let (path, shown_path) = (sources.join(file), file.into());
        Self { view: ViewKind::Shaded, size: SIZE, path, shown_path, bytes: Some(bytes), note: None }
    }

    pub fn file(folder: &Path, name: &str, view: ViewKind, scene: &Scene) -> Self {
        let view_name = if view == ViewKind::Shaded { String::new() } else { format!(".{}", view.name()) };
        let path = folder.join(format!("{name}{view_name}.golden.png"));
        let note = Some(camera_note(&scene.camera));
        Self { view, size: scene.size, shown_path: path.clone(), path, bytes: None, note }
    }

    pub fn is_in_program(&self) -> bool {
        self.bytes.is_some()
    }

    /// For a built-in scene, only [`update`](Self::update) uses the file at this path.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// The path for messages. For a built-in scene, the path is relative to the source tree, because absolute
    /// paths differ between machines.
    pub fn display_path(&self) -> &Path {
        &self.shown_path
    }

    /// The golden image in the form for comparisons. Packed depths are unpacked to floats.
    ///
    /// # Errors
    /// If the golden image is missing or damaged, or does not have the requested size and camera.
    pub fn expected(&self) -> Result<DynamicImage, GoldenError> {
        let missing = |cause| GoldenError::Missing { cause, remedy: REMEDY };
        let read = || file::read_bytes(&self.path).map_err(missing);
        let bytes = self.bytes.map_or_else(|| read().map(Cow::from), |bytes| Ok(bytes.into()))?;
        let picture = file::decode(&self.path, &bytes)?;
        let size = [picture.width(), picture.height()];
        if size != self.size {
            return Err(GoldenError::Size { path: self.path.clone(), golden: size, requested: self.size });
        }
        match (file::note(&bytes), &self.note) {
            (Some(golden), Some(requested)) if golden != requested => {
                let [golden, requested] = [golden, requested].map(String::from);
                Err(GoldenError::Camera { path: self.path.clone(), golden, requested })
            }
            _ => Ok(self.comparable(picture)),
        }
    }

    pub fn drawn(&self, scene: &Scene, accel: &dyn DynAccel) -> DynamicImage {
        self.comparable(self.picture(scene, accel))
    }

    pub fn drawn_pixel(&self, scene: &Scene, accel: &dyn DynAccel, ray: &Ray) -> DynamicImage {
        self.comparable(draw(scene, accel, self.view, [1, 1], &[*ray]))
    }

    pub fn ray(&self, scene: &Scene, [column, row]: [u32; 2]) -> Ray {
        let pixel = row * self.size[0] + column;
        scene.primary_rays(self.size, View::CENTRE, pixel..pixel + 1)[0]
    }

    /// Compares the golden image with the picture that `accel` renders. If the pictures differ, writes a page to the
    /// folder `SCENE-STRUCTURE` in `out`.
    ///
    /// A built-in scene must have its generated meshes, not downloaded meshes.
    ///
    /// # Errors
    /// If [`expected`](Self::expected) fails, or the pictures differ.
    pub fn check(&self, scene: &Scene, structure: &str, accel: &dyn DynAccel, out: &Path) -> Result<(), GoldenError> {
        let pictures = [&self.expected()?, &self.drawn(scene, accel)];
        let shown = failure::folder(out, &format!("{}-{structure}", scene.name.to_lowercase()));
        let label = format!("{} with {structure}", scene.name);
        failure::check(self.display_path(), &label, pictures, Match::Exact, self.view.into(), &shown, REMEDY)
    }

    /// # Errors
    /// If the file cannot be written, or the source tree of a built-in scene is missing. With [`Overwrite::Own`], also
    /// if another program wrote the existing file.
    pub fn update(&self, scene: &Scene, accel: &dyn DynAccel, overwrite: Overwrite) -> Result<Update, GoldenError> {
        if self.bytes.is_some() && !self.path.parent().is_some_and(Path::is_dir) {
            return Err(GoldenError::NoSources);
        }
        let picture = self.picture(scene, accel);
        let existing = file::read_bytes(&self.path).ok();
        let old = existing.as_ref().and_then(|bytes| file::decode(&self.path, bytes).ok());
        let is_noted = existing.as_ref().is_some_and(|bytes| file::note(bytes) == self.note.as_deref());
        if is_noted && old.as_ref() == Some(&picture) {
            return Ok(Update::Same);
        }
        if overwrite == Overwrite::Own && existing.is_some_and(|bytes| !file::is_own(&bytes)) {
            return Err(GoldenError::Foreign(self.path.clone()));
        }
        file::write_noted(&self.path, &picture, self.note.as_deref())?;
        let Some(old) = old else { return Ok(Update::New) };
        if Layout::of(&old) != Layout::of(&picture) {
            return Ok(Update::Layout(Layout::of(&old)));
        }
        let [old, new] = [old, picture].map(|picture| self.comparable(picture));
        Ok(Difference::between(&old, &new).map_or(Update::New, Update::Changed))
    }

    /// The values of a picture with a single pixel. A miss is infinity in the views depth and primitive.
    pub fn pixel_values(&self, pixel: &DynamicImage) -> Vec<f64> {
        match (self.view, numbers::unpacked(pixel).as_deref()) {
            (ViewKind::Primitive, Some(&[numbers::MISS])) => vec![f64::INFINITY],
            (ViewKind::Primitive, Some(&[number])) => vec![number.into()],
            _ => Layout::of(pixel).values(pixel.as_bytes()).collect(),
        }
    }

    fn picture(&self, scene: &Scene, accel: &dyn DynAccel) -> DynamicImage {
        let rays = scene.primary_rays(self.size, View::CENTRE, 0..self.size[0] * self.size[1]);
        draw(scene, accel, self.view, self.size, &rays)
    }

    fn comparable(&self, picture: DynamicImage) -> DynamicImage {
        let numbers = if self.view == ViewKind::Depth { numbers::unpacked(&picture) } else { None };
        numbers.map_or(picture.clone(), |numbers| numbers::as_floats([picture.width(), picture.height()], &numbers))
    }
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Overwrite {
    /// Only files written by [`SceneGolden::update`].
    Own,
    Any,
}

/// The option `--camera` that selects `camera`.
fn camera_note(camera: &Camera) -> String {
    let point = |point: glam::Vec3| point.to_array().map(|x| x.to_string()).join(",");
    format!("--camera '{} {} {}'", point(camera.eye()), point(camera.target()), camera.vertical_fov())
}

fn draw(scene: &Scene, accel: &dyn DynAccel, view: ViewKind, size: [u32; 2], rays: &[Ray]) -> DynamicImage {
    if view == ViewKind::Shaded {
        return of_colours(size, &shade(scene, accel, rays)).into();
    }
    let hits = accel.closest_by_chunks(rays, 4096).into_iter();
    let number: fn(Option<Hit>) -> u32 = match view {
        ViewKind::Depth => |hit| hit.map_or(f32::INFINITY, |hit| hit.t).to_bits(),
        ViewKind::Primitive => |hit| hit.map_or(numbers::MISS, |hit| hit.prim.index()),
        _ => {
            let colour = |(ray, hit): (&Ray, Option<_>)| hit.map_or([0; 3], |hit| normal_colour(scene, ray, hit));
            return from_pixels(size, rays.iter().zip(hits).map(colour).collect()).into();
        }
    };
    numbers::packed(size, &hits.map(number).collect::<Vec<u32>>())
}

#[cfg(test)]
mod tests {
    use std::fs;

    use super::*;
    use crate::accel::Accel;
    use crate::brute_force::BruteForce;
    use crate::kdtree::{KdConfig, KdTree};
    use crate::scene::tests::of_the_report;

    #[test]
    fn a_golden_image_holds_until_the_scene_changes() {
        let directory = tempfile::tempdir().unwrap();
        let out = directory.path().join("out");
        let mut scene = of_the_report("cube");
        scene.size = [80, 60];
        let tree = KdTree::<Exact>::build(&scene.mesh, &KdConfig::SAH).unwrap();
        let all = BruteForce::<Exact>::build(&scene.mesh, &Default::default()).unwrap();
        for view in VIEWS {
            let golden = SceneGolden::file(&directory.path().join("goldens"), "cube", view, &scene);
            let missing = golden.check(&scene, "sah-kd", &tree, &out).unwrap_err();
            assert!(matches!(missing, GoldenError::Missing { .. }), "{missing}");
            assert_eq!(golden.update(&scene, &tree, Overwrite::Own).unwrap(), Update::New);
            let written = fs::read(golden.path()).unwrap();
            assert_eq!(golden.update(&scene, &all, Overwrite::Own).unwrap(), Update::Same);
            assert!(fs::read(golden.path()).unwrap() == written, "the same picture is not written again");
            golden.check(&scene, "brute-force", &all, &out).unwrap();
        }
        assert_eq!(fs::read_dir(directory.path().join("goldens")).unwrap().count(), 4);
        assert!(!out.exists());

        // The new background changes all pixels whose ray misses, including the first pixel.
        scene.background.x += 0.5;
        let golden = SceneGolden::file(&directory.path().join("goldens"), "cube", ViewKind::Shaded, &scene);
        let error = golden.check(&scene, "sah-kd:leaf=1", &tree, &out).unwrap_err();
        let GoldenError::Differs { difference, shown, .. } = &error else { panic!("{error}") };
        assert_eq!(difference.first, [0, 0]);
        assert!(difference.pixels > 2_000 && difference.largest >= 127.0, "{error}");
        let folder = out.join("cube-sah-kd_leaf_1");
        assert!(shown.starts_with(&folder));
        let picture = |what: &str| file::read(&folder.join(format!("pictures/0-{what}.png"))).unwrap();
        let [actual, expected] = ["actual", "expected"].map(picture);
        assert_eq!(Difference::between(&expected, &actual), Some(**difference));
        assert_eq!(picture("difference"), crate::golden::difference_picture(&expected, &actual).into());
        assert!(error.to_string().contains("Cube with sah-kd:leaf=1"), "{error}");
        assert_eq!(golden.update(&scene, &tree, Overwrite::Own).unwrap(), Update::Changed(**difference));

        let drawn = golden.expected().unwrap();
        for other in [DynamicImage::from(drawn.to_rgba8()), drawn.to_rgb16().into()] {
            file::write(golden.path(), &other).unwrap();
            let refused = golden.check(&scene, "sah-kd", &tree, &out).unwrap_err();
            assert!(matches!(refused, GoldenError::Layout { .. }), "{refused}");
            let updated = golden.update(&scene, &tree, Overwrite::Own).unwrap();
            assert_eq!(updated, Update::Layout(Layout::of(&other)));
            assert_eq!(golden.expected().unwrap(), drawn);
        }
    }

    #[test]
    fn a_pixel_is_drawn_as_in_the_whole_picture() {
        let scene = of_the_report("cube");
        let tree = KdTree::<Exact>::build(&scene.mesh, &KdConfig::SAH).unwrap();
        for view in VIEWS {
            let golden = SceneGolden { size: SIZE, ..SceneGolden::file(Path::new(""), "cube", view, &scene) };
            let whole = golden.drawn(&scene, &tree);
            for [x, y] in [[0, 0], [80, 80], [95, 60]] {
                let pixel = golden.drawn_pixel(&scene, &tree, &golden.ray(&scene, [x, y]));
                assert_eq!(pixel, whole.crop_imm(x, y, 1, 1), "{view:?} {x} {y}");
            }
        }
    }
}
