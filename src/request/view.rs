//! The options of the camera, shared by all commands with camera rays.

use std::str::FromStr;

use anyhow::Context;
use glam::Vec3;
use serde::{Deserialize, Serialize};

use crate::geometry::numbers;
use crate::scene::{Camera, Scene};

/// Options that replace a scene's camera and picture size.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, clap::Args)]
#[command(next_help_heading = super::SCENES)]
pub struct ViewArgs {
    /// Eye, target and vertical field of view in degrees [default: the scene's; a bare mesh fills the picture]
    #[arg(long, value_name = "ex,ey,ez tx,ty,tz [fov]", allow_hyphen_values = true, value_parser = Look::parse)]
    #[serde(default, skip_serializing_if = "Option::is_none")]
    camera: Option<Look>,
    /// View the scene from the middle of its bounding box, along its longer horizontal side; a bare mesh is lit from
    /// there
    #[arg(long, conflicts_with = "camera")]
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    inside: bool,
    /// Picture size in pixels, one primary ray per pixel [default: the scene's]
    #[arg(long, value_name = "WxH")]
    #[serde(default, skip_serializing_if = "Option::is_none")]
    size: Option<Size>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
struct Size([u32; 2]);

impl FromStr for Size {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let side = |text: &str| text.parse().ok().filter(|side| (1..=16384).contains(side));
        let sides = text.split_once('x').and_then(|(width, height)| Some(Self([side(width)?, side(height)?])));
        sides.ok_or_else(|| "write WIDTHxHEIGHT, both from 1 to 16384, for example 640x480".into())
    }
}

#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "String", into = "String")]
struct Look {
    eye: Vec3,
    target: Vec3,
    vertical_fov: Option<f32>,
}

impl From<Look> for String {
    fn from(Look { eye, target, vertical_fov }: Look) -> Self {
        let point = |at: Vec3| at.to_array().map(|x| x.to_string()).join(",");
        let fov = vertical_fov.map_or(Self::new(), |fov| format!(" {fov}"));
        format!("{} {}{fov}", point(eye), point(target))
    }
}

impl TryFrom<String> for Look {
    type Error = &'static str;

    fn try_from(text: String) -> Result<Self, Self::Error> {
        Self::parse(&text)
    }
}

impl Look {
    fn parse(text: &str) -> Result<Self, &'static str> {
        match numbers(text).as_deref() {
            Ok(&[ex, ey, ez, tx, ty, tz, ref rest @ ..]) if rest.len() < 2 => {
                let vertical_fov = rest.first().copied();
                Ok(Self { eye: Vec3::new(ex, ey, ez), target: Vec3::new(tx, ty, tz), vertical_fov })
            }
            _ => Err("write \"ex,ey,ez tx,ty,tz\" and optionally a field of view in degrees"),
        }
    }
}

impl ViewArgs {
    pub fn seen(&self, scene: Scene) -> anyhow::Result<Scene> {
        let mut scene = if self.inside { scene.from_inside().context("--inside")? } else { scene };
        if let Some(Look { eye, target, vertical_fov }) = self.camera {
            let vertical_fov = vertical_fov.unwrap_or(scene.camera.vertical_fov());
            scene.camera = Camera::new(eye, target, scene.camera.up(), vertical_fov).context("--camera")?;
        }
        scene.size = self.size.map_or(scene.size, |size| size.0);
        Ok(scene)
    }

    pub fn of(&self, scene: Scene) -> anyhow::Result<Scene> {
        let mut scene = self.seen(scene)?;
        if scene.is_framed && self.looks_from().is_none() {
            let note = "the camera shows the whole mesh from outside; --inside or --camera changes the view";
            scene.notes.push(note.into());
        }
        Ok(scene)
    }

    pub fn is_default(&self) -> bool {
        *self == Self::default()
    }

    /// The name of the option that sets the viewpoint.
    pub fn looks_from(&self) -> Option<&'static str> {
        match (self.inside, self.camera) {
            (true, _) => Some("--inside"),
            (false, Some(_)) => Some("--camera"),
            (false, None) => None,
        }
    }

    /// The options as arguments for a shell.
    pub fn words(&self) -> String {
        let camera = self.camera.filter(|_| !self.inside).map(|look| format!("--camera '{}'", String::from(look)));
        let inside = self.inside.then(|| "--inside".to_owned());
        let size = self.size.map(|Size([width, height])| format!("--size {width}x{height}"));
        [camera, inside, size].into_iter().flatten().collect::<Vec<String>>().join(" ")
    }

    pub fn reject_unused(&self) -> anyhow::Result<()> {
        anyhow::ensure!(self.is_default(), "the file defines the rays: omit --camera, --inside and --size");
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::accel::Accel;
    use crate::builtin::Builtin;
    use crate::render::{ViewError, ViewKind, draw};
    use crate::study::measure::tests::{Flawed, FlawedConfig};

    #[test]
    fn sizes() {
        assert_eq!("640x480".parse(), Ok(Size([640, 480])));
        for wrong in ["640", "0x5", "5x0", "99999x5", "axb", "-1x2", "1x2x3"] {
            assert!(wrong.parse::<Size>().is_err(), "{wrong}");
        }
    }

    #[test]
    fn cameras() {
        let (eye, target) = (Vec3::new(-1.0, 2.0, 3.5), Vec3::ZERO);
        for (text, vertical_fov) in
            [("-1,2,3.5 0,0,0", None), ("-1 2 3.5, 0 0 0, 45", Some(45.0)), ("-1,2,3.5 0,0,0 45", Some(45.0))]
        {
            assert_eq!(Look::parse(text), Ok(Look { eye, target, vertical_fov }), "{text}");
        }
        for wrong in ["", "1,2,3", "1,2 3,4,5", "1,2,3 4,5,6 7 8", "1,2,3 4,5,6 7,8", "1,2,3, ,4,5,6", "a,b,c 1,2,3"] {
            assert!(Look::parse(wrong).is_err(), "{wrong}");
        }
    }

    #[test]
    fn a_view_is_written_as_it_is_typed_and_as_data() {
        let look = Look { eye: Vec3::Z, target: Vec3::new(0.1, 0.0, 0.0), vertical_fov: Some(40.0) };
        let view = ViewArgs { camera: Some(look), size: Some(Size([64, 32])), ..ViewArgs::default() };
        assert_eq!(view.words(), "--camera '0,0,1 0.1,0,0 40' --size 64x32");
        assert_eq!(ViewArgs { inside: true, ..ViewArgs::default() }.words(), "--inside");
        let text = serde_json::to_string(&view).unwrap();
        assert_eq!(serde_json::from_str::<ViewArgs>(&text).unwrap(), view);
        assert_eq!(serde_json::to_string(&ViewArgs::default()).unwrap(), "{}");
    }

    #[test]
    fn from_inside_the_eye_is_within_the_box_and_looks_along_it() {
        let scene = Builtin::find("sponza").unwrap().scene(None).unwrap();
        let (bounds, lights) = (scene.mesh.bounds(), scene.lights.clone());
        let inside = ViewArgs { inside: true, size: Some(Size([8, 6])), ..ViewArgs::default() }.of(scene).unwrap();
        let (eye, view) = (inside.camera.eye(), inside.camera.target() - inside.camera.eye());
        assert!(bounds.min.cmplt(eye).all() && eye.cmplt(bounds.max).all());
        let extent = bounds.max - bounds.min;
        let along = if extent.x >= extent.z { view.x } else { view.z };
        assert!(along.abs() == view.length() && inside.size == [8, 6]);
        assert_eq!(inside.lights.len(), lights.len());
        assert_eq!(inside.lights[0].position, lights[0].position);
    }

    #[test]
    fn heat_is_refused_where_steps_are_unknown() {
        let scene = Builtin::find("cube").unwrap().scene(None).unwrap();
        let unobserved = Flawed::build(&scene.mesh, &FlawedConfig::default()).unwrap();
        assert_eq!(draw(&scene, &unobserved, ViewKind::Heat, [4, 4], 1), Err(ViewError));
        assert!(draw(&scene, &unobserved, ViewKind::Depth, [4, 4], 1).is_ok());
    }
}
