//! A figure with a pixel inspector and one picture per structure.

use super::camera_rays::CameraRays;
use super::inspect::inspector;
use crate::report::words::slug;
use crate::report::{Art, Block, Colours, Figure, Overlay, Picture, Table};

pub struct Maps {
    /// The text after `--view` in the `sahara render` command, such as `heat --hottest 9`.
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
    /// Returns the figure, and a command that draws one picture of the figure.
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
