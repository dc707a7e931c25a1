//! Pictures of 8 bits per channel: written, read, compared.

use std::io::Cursor;
use std::path::{Path, PathBuf};

use glam::Vec3;
use png::{BitDepth, DecodingError};

use crate::escaped::Escaped as _;
use crate::output::{OutputError, OutputFile};

/// Bytes of a picture that is read, at most.
const LARGEST: usize = 512 << 20;

/// RGB pixels, row by row, the top row first.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Picture {
    size: [u32; 2],
    pixels: Vec<[u8; 3]>,
}

/// Why a picture cannot be read or written.
#[derive(Debug, thiserror::Error)]
pub enum PictureError {
    #[error("cannot read the picture {}: {cause}", path.escaped())]
    Read { path: PathBuf, cause: std::io::Error },
    #[error("{} is not a PNG picture: {cause}", path.escaped())]
    Decode { path: PathBuf, cause: DecodingError },
    #[error(transparent)]
    Write(#[from] OutputError),
}

/// The difference of two pictures of one size.
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

    /// The picture of linear RGB colours: each channel times 255, rounded to the nearest; values
    /// below 0 or above 1 are clamped, NaN becomes 0. There is no gamma curve, as in the course.
    ///
    /// # Panics
    /// As [`Picture::new`].
    pub fn of_colours(size: [u32; 2], colours: &[Vec3]) -> Self {
        Self::new(size, colours.iter().map(|colour| colour.to_array().map(quantised)).collect())
    }

    /// Width and height.
    pub fn size(&self) -> [u32; 2] {
        self.size
    }

    pub fn pixels(&self) -> &[[u8; 3]] {
        &self.pixels
    }

    /// This picture with `other` below it.
    ///
    /// # Panics
    /// If they are not of one width.
    pub fn above(self, other: &Self) -> Self {
        let [width, height] = self.size;
        assert_eq!(width, other.size[0], "pictures of one width");
        Self::new([width, height + other.size[1]], [self.pixels, other.pixels.clone()].concat())
    }

    /// The bytes of a PNG file; the same for the same picture.
    ///
    /// # Panics
    /// If the picture has no pixels.
    pub fn png(&self) -> Vec<u8> {
        let mut bytes = vec![];
        let mut encoder = png::Encoder::new(&mut bytes, self.size[0], self.size[1]);
        encoder.set_color(png::ColorType::Rgb);
        encoder.set_compression(png::Compression::Fast);
        encoder.set_filter(png::Filter::Adaptive);
        let written = encoder.write_header().and_then(|mut writer| writer.write_image_data(self.pixels.as_flattened()));
        written.expect("memory takes every picture that has pixels");
        bytes
    }

    /// The picture in the bytes of a PNG file. Colours of more than 8 bits are rounded, transparency is dropped.
    ///
    /// # Errors
    /// If they are no PNG picture, or one of more than 512 MiB.
    pub fn from_png(bytes: &[u8]) -> Result<Self, DecodingError> {
        let mut decoder = png::Decoder::new(Cursor::new(bytes));
        decoder.set_transformations(png::Transformations::EXPAND);
        let mut reader = decoder.read_info()?;
        let size = reader.output_buffer_size().filter(|&size| size <= LARGEST).ok_or(DecodingError::LimitsExceeded)?;
        let mut samples = vec![0; size];
        let frame = reader.next_frame(&mut samples)?;

        let width = if frame.bit_depth == BitDepth::Sixteen { 2 } else { 1 };
        let sample = |sample: &[u8]| match *sample {
            [high, low] => ((u32::from(high) * 256 + u32::from(low) + 128) / 257) as u8,
            _ => sample[0],
        };
        let channels = frame.color_type.samples();
        let is_grey = channels < 3;
        let pixel = |pixel: &[u8]| {
            std::array::from_fn(|channel| {
                let at = if is_grey { 0 } else { channel * width };
                sample(&pixel[at..at + width])
            })
        };
        Ok(Self::new([frame.width, frame.height], samples.chunks_exact(channels * width).map(pixel).collect()))
    }

    /// Reads a PNG file as [`Picture::from_png`].
    ///
    /// # Errors
    /// If there is no such file, or it is no PNG picture.
    pub fn read(path: &Path) -> Result<Self, PictureError> {
        let bytes = std::fs::read(path).map_err(|cause| PictureError::Read { path: path.into(), cause })?;
        Self::from_png(&bytes).map_err(|cause| PictureError::Decode { path: path.into(), cause })
    }

    /// Writes a PNG file, whole or not at all.
    ///
    /// # Errors
    /// If the directory does not exist or takes no file, or there is no room.
    pub fn write(&self, path: &Path) -> Result<(), PictureError> {
        Ok(OutputFile::check(path)?.write(&self.png())?)
    }

    /// The difference of the pictures, or none if they are equal.
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

    fn gaps(&self, other: &Self) -> Vec<u8> {
        assert_eq!(self.size, other.size, "pictures of one size");
        let gap = |(a, b): (&[u8; 3], &[u8; 3])| a.iter().zip(b).map(|(a, b)| a.abs_diff(*b)).max().unwrap_or(0);
        self.pixels.iter().zip(&other.pixels).map(gap).collect()
    }
}

pub(super) fn quantised(channel: f32) -> u8 {
    (channel * 255.0 + 0.5) as u8
}

#[cfg(test)]
mod tests {
    use super::*;

    fn gradient() -> Picture {
        let colours: Vec<Vec3> = (0..15).map(|i| Vec3::new(i as f32 / 14.0, 0.5, 1.5)).collect();
        Picture::of_colours([5, 3], &colours)
    }

    #[test]
    fn channels_are_rounded_and_clamped() {
        let colours = [Vec3::new(-1.0, 0.5, 2.0), Vec3::new(f32::NAN, 1.0, 0.1)];
        assert_eq!(Picture::of_colours([2, 1], &colours).pixels(), [[0, 128, 255], [0, 255, 26]]);
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
    fn every_kind_of_png_is_read() {
        let (rgb, grey) = (png::ColorType::Rgb, png::ColorType::Grayscale);
        let (rgba, grey_alpha) = (png::ColorType::Rgba, png::ColorType::GrayscaleAlpha);
        for (kind, depth, samples, expected) in [
            (rgb, BitDepth::Sixteen, &[1, 0, 0, 129, 255, 255][..], [1, 1, 255]),
            (rgba, BitDepth::Eight, &[1, 2, 3, 0], [1, 2, 3]),
            (grey, BitDepth::One, &[128], [255; 3]),
            (grey_alpha, BitDepth::Sixteen, &[2, 0, 0, 0], [2; 3]),
            (png::ColorType::Indexed, BitDepth::Eight, &[1], [7, 8, 9]),
        ] {
            let mut bytes = vec![];
            let mut encoder = png::Encoder::new(&mut bytes, 1, 1);
            encoder.set_color(kind);
            encoder.set_depth(depth);
            if kind == png::ColorType::Indexed {
                encoder.set_palette(&[0, 0, 0, 7, 8, 9][..]);
            }
            encoder.write_header().unwrap().write_image_data(samples).unwrap();
            assert_eq!(Picture::from_png(&bytes).unwrap(), Picture::new([1, 1], vec![expected]), "{kind:?} {depth:?}");
        }
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
    fn a_difference_has_its_place_and_size() {
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
