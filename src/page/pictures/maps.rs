//! A figure with one picture per structure and a pixel inspector.

use super::camera_rays::CameraRays;
use super::inspect::inspector;
use crate::report::words::slug;
use crate::report::{Art, Block, Colours, Figure, Overlay, Picture, Table};

pub struct Maps {
    /// The value of `--view` in the printed `sahara render` command. Other options may follow the value.
    pub view: String,
    pub caption: String,
    pub pictures: Vec<Picture>,
    pub colours: Colours,
    pub data: Table,
    /// The pixels that can be inspected, in ascending order.
    pub pixels: Vec<usize>,
    /// A sentence that describes `pixels`.
    pub which: String,
}

impl Maps {
    /// Returns the figure and the command that draws one of its pictures.
    pub fn figure(self, kind: &str, camera: &CameraRays) -> (Block, String) {
        let Self { view, caption, pictures, colours, data, pixels, which } = self;
        let inspector = inspector(camera, &pixels, &which);
        let art = Art::Overlay(Overlay { heading: camera.name.clone(), pictures, colours, inspector });
        let id = format!("{kind}-{}", slug(&camera.loaded.scene.name));
        let command = format!("sahara render {} --view {view} --structure NAME -o NAME.png", camera.loaded.words());
        (Block::figure(Figure { id, caption, alt: String::new(), art, data }), command)
    }
}

pub fn hex([r, g, b]: [u8; 3]) -> String {
    format!("#{r:02x}{g:02x}{b:02x}")
}
