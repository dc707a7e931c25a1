use glam::Vec3;

/// Linear RGB colours, row by row, the top row first.
#[derive(Clone, Debug, PartialEq)]
pub struct Image {
    size: [u32; 2],
    pixels: Vec<Vec3>,
}

impl Image {
    /// # Panics
    /// If there are not as many `pixels` as `size`, width and height, says.
    pub fn new(size: [u32; 2], pixels: Vec<Vec3>) -> Self {
        assert_eq!(pixels.len() as u64, u64::from(size[0]) * u64::from(size[1]), "one colour a pixel");
        Self { size, pixels }
    }

    /// Width and height.
    pub fn size(&self) -> [u32; 2] {
        self.size
    }

    pub fn pixels(&self) -> &[Vec3] {
        &self.pixels
    }
}
