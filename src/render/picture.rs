//! Pictures of 8 bits a channel: written, read, compared.

use std::io::Cursor;
use std::path::{Path, PathBuf};

use image::{ExtendedColorType, ImageEncoder, ImageError, ImageFormat};

use super::Image;
use crate::output::{OutputError, OutputFile};

/// RGB pixels, row by row, the top row first.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Picture {
    size: [u32; 2],
    pixels: Vec<[u8; 3]>,
}

/// Why a picture cannot be read or written.
#[derive(Debug, thiserror::Error)]
pub enum PictureError {
    #[error("cannot read the picture {}: {cause}", path.display())]
    Read { path: PathBuf, cause: std::io::Error },
    #[error("{} is not a PNG picture: {cause}", path.display())]
    Decode { path: PathBuf, cause: ImageError },
    #[error(transparent)]
    Write(#[from] OutputError),
}

/// In what two pictures of one size differ.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Difference {
    /// How many pixels differ, at least 1.
    pub pixels: usize,
    /// Column and row, from the top left, of the first of them in reading order.
    pub first: [u32; 2],
    /// The largest difference of a channel, in steps of 255.
    pub largest: u8,
}

impl Picture {
    /// # Panics
    /// If there are not as many `pixels` as `size`, width and height, says.
    pub fn new(size: [u32; 2], pixels: Vec<[u8; 3]>) -> Self {
        assert_eq!(pixels.len() as u64, u64::from(size[0]) * u64::from(size[1]), "one colour a pixel");
        Self { size, pixels }
    }

    /// Width and height.
    pub fn size(&self) -> [u32; 2] {
        self.size
    }

    pub fn pixels(&self) -> &[[u8; 3]] {
        &self.pixels
    }

    /// The bytes of a PNG file; the same for the same picture.
    ///
    /// # Panics
    /// If the picture has no pixels.
    pub fn png(&self) -> Vec<u8> {
        let mut bytes = vec![];
        let [width, height] = self.size;
        image::codecs::png::PngEncoder::new(&mut bytes)
            .write_image(self.pixels.as_flattened(), width, height, ExtendedColorType::Rgb8)
            .expect("memory takes every picture that has pixels");
        bytes
    }

    /// Reads a PNG file. Colours of more than 8 bits are rounded, transparency is dropped.
    ///
    /// # Errors
    /// If there is no such file, or it is no PNG picture.
    pub fn read(path: &Path) -> Result<Self, PictureError> {
        let bytes = std::fs::read(path).map_err(|cause| PictureError::Read { path: path.into(), cause })?;
        let decoded = image::ImageReader::with_format(Cursor::new(bytes), ImageFormat::Png)
            .decode()
            .map_err(|cause| PictureError::Decode { path: path.into(), cause })?
            .into_rgb8();
        Ok(Self::new([decoded.width(), decoded.height()], decoded.pixels().map(|p| p.0).collect()))
    }

    /// Writes a PNG file, whole or not at all.
    ///
    /// # Errors
    /// If the directory does not exist or takes no file, or there is no room.
    pub fn write(&self, path: &Path) -> Result<(), PictureError> {
        Ok(OutputFile::check(path)?.write(&self.png())?)
    }

    /// In what the pictures differ, or none when they are equal.
    ///
    /// # Panics
    /// If they differ in size.
    pub fn difference(&self, other: &Self) -> Option<Difference> {
        let gaps = self.gaps(other);
        let first = gaps.iter().position(|&gap| gap > 0)? as u32;
        Some(Difference {
            pixels: gaps.iter().filter(|&&gap| gap > 0).count(),
            first: [first % self.size[0], first / self.size[0]],
            largest: gaps.into_iter().max().unwrap_or(0),
        })
    }

    /// A picture of the difference: black where equal, from dark red for 1 step to yellow for 255.
    ///
    /// # Panics
    /// If they differ in size.
    pub fn difference_picture(&self, other: &Self) -> Self {
        let colour = |gap: u8| if gap == 0 { [0; 3] } else { [128 + gap / 2, gap, 0] };
        Self::new(self.size, self.gaps(other).into_iter().map(colour).collect())
    }

    /// The largest difference of a channel in each pixel.
    fn gaps(&self, other: &Self) -> Vec<u8> {
        assert_eq!(self.size, other.size, "pictures of one size");
        let gap = |(a, b): (&[u8; 3], &[u8; 3])| a.iter().zip(b).map(|(a, b)| a.abs_diff(*b)).max().unwrap_or(0);
        self.pixels.iter().zip(&other.pixels).map(gap).collect()
    }
}

impl From<&Image> for Picture {
    /// Each channel times 255, rounded to the nearest; what is below 0 or above 1 is clamped, what is not a number is 0.
    ///
    /// Without a gamma curve, as the course.
    fn from(image: &Image) -> Self {
        let channel = |value: f32| (value * 255.0 + 0.5) as u8;
        Self::new(image.size(), image.pixels().iter().map(|colour| colour.to_array().map(channel)).collect())
    }
}

#[cfg(test)]
mod tests {
    use glam::Vec3;

    use super::*;

    fn gradient() -> Picture {
        let image = Image::new([5, 3], (0..15).map(|i| Vec3::new(i as f32 / 14.0, 0.5, 1.5)).collect());
        Picture::from(&image)
    }

    #[test]
    fn channels_are_rounded_and_clamped() {
        let image = Image::new([2, 1], vec![Vec3::new(-1.0, 0.5, 2.0), Vec3::new(f32::NAN, 1.0, 0.1)]);
        assert_eq!(Picture::from(&image).pixels(), [[0, 128, 255], [0, 255, 26]]);
    }

    #[test]
    fn a_written_picture_is_read_back_and_leaves_nothing_else() {
        let directory = tempfile::tempdir().unwrap();
        let path = directory.path().join("a.png");
        gradient().write(&path).unwrap();
        gradient().write(&path).unwrap();
        assert_eq!(Picture::read(&path).unwrap(), gradient());
        assert_eq!(std::fs::read_dir(directory.path()).unwrap().count(), 1);
    }

    #[test]
    fn errors_name_the_file() {
        let directory = tempfile::tempdir().unwrap();
        let missing = directory.path().join("no/a.png");
        assert!(gradient().write(&missing).unwrap_err().to_string().contains("no/a.png"));
        assert!(Picture::read(&missing).unwrap_err().to_string().contains("no/a.png"));
        let text = directory.path().join("text.png");
        std::fs::write(&text, "not a picture").unwrap();
        assert!(matches!(Picture::read(&text), Err(PictureError::Decode { .. })));
    }

    #[test]
    fn a_difference_tells_where_and_how_much() {
        let mut other = gradient();
        assert_eq!(gradient().difference(&other), None);
        other.pixels[7][1] += 1;
        other.pixels[11][2] -= 200;
        let found = gradient().difference(&other).unwrap();
        assert_eq!(found, Difference { pixels: 2, first: [2, 1], largest: 200 });
        let shown = gradient().difference_picture(&other);
        assert_eq!([shown.pixels[0], shown.pixels[7], shown.pixels[11]], [[0; 3], [128, 1, 0], [228, 200, 0]]);
    }
}
