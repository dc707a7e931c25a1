//! Reads pictures and writes PNG files.

use std::fs::File;
use std::io::{Cursor, Error, Read};
use std::path::{Path, PathBuf};

use image::error::DecodingError;
use image::{DynamicImage, ImageEncoder, ImageError, ImageFormat, ImageReader, ImageResult, Limits};

use crate::escaped::Escaped as _;
use crate::output::{OutputError, OutputFile};
use crate::render::png_encoder;

/// The maximum size, in MiB, of a file plus its decoded pixels. The decoder needs additional memory.
const LARGEST: u64 = 512;

#[derive(Debug, thiserror::Error)]
pub enum PictureError {
    #[error("cannot read the picture {}: {cause}", path.escaped())]
    Read { path: PathBuf, cause: Error },
    #[error("cannot read the picture {}, {}: {}", path.escaped(), reason(cause), in_a_line(cause))]
    Decode { path: PathBuf, cause: ImageError },
    #[error("cannot write the picture {} as PNG with 8 or 16 bits per channel: {}", path.escaped(), in_a_line(cause))]
    Encode { path: PathBuf, cause: ImageError },
    #[error("cannot create the folder {}: {cause}", path.escaped())]
    Directory { path: PathBuf, cause: Error },
    #[error(transparent)]
    Write(#[from] OutputError),
}

fn reason(cause: &ImageError) -> String {
    match cause {
        ImageError::Limits(_) => format!("which takes more than {LARGEST} MiB"),
        ImageError::Unsupported(_) if cfg!(feature = "pictures") => "which is not PNG, JPEG, WebP or EXR".into(),
        ImageError::Unsupported(_) => {
            "which is not PNG (for JPEG, WebP and EXR, install with `cargo install --path . --features pictures`)"
                .into()
        }
        _ => "which is damaged or truncated".into(),
    }
}

/// Some decoders put line breaks into messages.
fn in_a_line(cause: &ImageError) -> String {
    cause.to_string().lines().collect::<Vec<_>>().join(" ")
}

/// PNG files keep their channels and bits per channel. Only palettes, transparent colours and grey below 8 bits are
/// expanded. The content of the file, not its name, determines the format.
///
/// # Errors
/// If the file cannot be read, is damaged, is not a picture, or takes more than 512 MiB with its decoded pixels.
pub fn read(path: &Path) -> Result<DynamicImage, PictureError> {
    decode(path, &read_bytes(path)?)
}

pub(super) fn read_bytes(path: &Path) -> Result<Vec<u8>, PictureError> {
    let mut bytes = vec![];
    // Because of the extra byte, `decode` rejects files above the limit.
    let file = File::open(path).and_then(|file| file.take((LARGEST << 20) + 1).read_to_end(&mut bytes));
    file.map_err(|cause| PictureError::Read { path: path.into(), cause })?;
    Ok(bytes)
}

pub(super) fn decode(path: &Path, bytes: &[u8]) -> Result<DynamicImage, PictureError> {
    decoded(bytes).map_err(|cause| PictureError::Decode { path: path.into(), cause })
}

fn decoded(bytes: &[u8]) -> ImageResult<DynamicImage> {
    let mut limits = Limits::default();
    limits.max_alloc = Some(LARGEST << 20);
    limits.reserve_usize(bytes.len())?;
    let mut reader = ImageReader::new(Cursor::new(bytes)).with_guessed_format()?;
    reader.limits(limits);
    let format = reader.format();
    let picture = reader.decode()?;
    if format == Some(ImageFormat::Jpeg) && !is_whole_jpeg(bytes) {
        return Err(ImageError::Decoding(DecodingError::new(ImageFormat::Jpeg.into(), "its pixel data is truncated")));
    }
    Ok(picture)
}

/// The JPEG decoder fills missing pixels of a truncated file with grey, without an error.
fn is_whole_jpeg(bytes: &[u8]) -> bool {
    let last = |mark: [u8; 2]| bytes.windows(2).rposition(|pair| pair == mark);
    let (scan, end) = (last([0xFF, 0xDA]), last([0xFF, 0xD9]));
    end > scan
}

/// Writes a PNG file atomically. Creates missing folders.
///
/// # Errors
/// If the disk is full, the folder is not writable, or PNG does not support the layout of the picture.
pub fn write(path: &Path, picture: &DynamicImage) -> Result<(), PictureError> {
    write_noted(path, picture, None)
}

/// The note must be ASCII text.
pub(super) fn write_noted(path: &Path, picture: &DynamicImage, note: Option<&str>) -> Result<(), PictureError> {
    if let Some(folder) = path.parent() {
        std::fs::create_dir_all(folder).map_err(|cause| PictureError::Directory { path: folder.into(), cause })?;
    }
    let bytes = encode(picture, note).map_err(|cause| PictureError::Encode { path: path.into(), cause })?;
    Ok(OutputFile::check(path)?.write(&bytes)?)
}

/// The encoding must be deterministic, because `is_own` compares bytes.
pub(super) fn encode(picture: &DynamicImage, note: Option<&str>) -> ImageResult<Vec<u8>> {
    let mut bytes = vec![];
    // Unlike other functions of `image`, `write_image` rejects layouts that PNG does not support.
    let [width, height] = [picture.width(), picture.height()];
    png_encoder(&mut bytes).write_image(picture.as_bytes(), width, height, picture.color().into())?;
    if let Some(note) = note {
        let chunk = [TEXT, KEY, note.as_bytes()].concat();
        let length = (chunk.len() - TEXT.len()) as u32;
        let chunk = [&length.to_be_bytes(), &chunk[..], &crc32fast::hash(&chunk).to_be_bytes()].concat();
        bytes.splice(HEADER..HEADER, chunk);
    }
    Ok(bytes)
}

pub(super) fn is_own(bytes: &[u8]) -> bool {
    let encoded = |picture: DynamicImage| encode(&picture, note(bytes)).ok();
    decoded(bytes).ok().and_then(encoded).is_some_and(|own| own == bytes)
}

pub(super) fn note(bytes: &[u8]) -> Option<&str> {
    let (length, rest) = bytes.get(HEADER..)?.split_first_chunk()?;
    let chunk = rest.get(..TEXT.len() + u32::from_be_bytes(*length) as usize)?;
    str::from_utf8(chunk.strip_prefix(TEXT)?.strip_prefix(KEY)?).ok()
}

/// The length of the PNG signature and the first chunk, in bytes.
const HEADER: usize = 8 + 25;

const TEXT: &[u8] = b"tEXt";
const KEY: &[u8] = b"sahara\0";

#[cfg(test)]
mod tests {
    use std::fs;

    use image::{ColorType, Rgb32FImage, Rgba, RgbaImage};

    use super::*;

    /// A 1-bit PNG file with one black and one white pixel.
    const GREY_1: &str = "iVBORw0KGgoAAAANSUhEUgAAAAIAAAABAQAAAADcWUInAAAACklEQVR4nGNwAAAAQgBBKTf07wAAAABJRU5ErkJggg==";

    #[test]
    fn pictures_of_another_writer_keep_their_channels_and_depth() {
        // Pillow 12 wrote these files.
        for (text, color, values) in [
            (GREY_1, ColorType::L8, &[0, 255][..]),
            (
                "iVBORw0KGgoAAAANSUhEUgAAAAIAAAABAQMAAADO7O3JAAAABlBMVEUHCAkBAgNf59QzAAAACklEQVR4nGNwAAAAQgBBKTf07wAAAABJ\
                 RU5ErkJggg==",
                ColorType::Rgb8,
                &[7, 8, 9, 1, 2, 3],
            ),
            (
                "iVBORw0KGgoAAAANSUhEUgAAAAIAAAABAQMAAADO7O3JAAAABlBMVEUHCAkBAgNf59QzAAAAAnRSTlP/AOW3MEoAAAAKSURBVHicY3AA\
                 AABCAEEpN/TvAAAAAElFTkSuQmCC",
                ColorType::Rgba8,
                &[7, 8, 9, 255, 1, 2, 3, 0],
            ),
            (
                "iVBORw0KGgoAAAANSUhEUgAAAAIAAAABCAIAAAB7QOjdAAAABnRSTlMAAQACAAPJS6v1AAAAD0lEQVR4nGNg5+BkZGIGAACHAB9spMAl\
                 AAAAAElFTkSuQmCC",
                ColorType::Rgba8,
                &[7, 8, 9, 255, 1, 2, 3, 0],
            ),
            (
                "iVBORw0KGgoAAAANSUhEUgAAAAIAAAABEAAAAACB2fwVAAAADUlEQVR4nGNgZPr/HwADDAICGwGttwAAAABJRU5ErkJggg==",
                ColorType::L16,
                &[258, 65535],
            ),
        ] {
            let picture = decoded(&base64::decode(text).unwrap()).unwrap();
            let found: Vec<u16> = match &picture {
                DynamicImage::ImageLuma16(grey) => grey.to_vec(),
                other => other.as_bytes().iter().copied().map(u16::from).collect(),
            };
            assert_eq!((picture.color(), &found[..]), (color, values), "{text}");
        }
    }

    #[test]
    fn what_is_written_is_read_back_and_leaves_nothing_else() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.png");
        let colours = RgbaImage::from_fn(5, 3, |x, y| Rgba([x as u8, y as u8, 200, 10 * x as u8]));
        let colours = DynamicImage::from(colours);
        for picture in [
            DynamicImage::from(colours.to_luma8()),
            colours.to_luma_alpha8().into(),
            colours.to_rgb8().into(),
            colours.clone(),
            colours.to_luma16().into(),
            colours.to_luma_alpha16().into(),
            colours.to_rgb16().into(),
            colours.to_rgba16().into(),
        ] {
            write(&path, &picture).unwrap();
            assert_eq!(read(&path).unwrap(), picture);
        }
        let refusal = write(&path, &Rgb32FImage::new(1, 1).into()).unwrap_err().to_string();
        assert!(refusal.contains("a.png") && refusal.contains("8 or 16 bits"), "{refusal}");
        assert_eq!(read(&path).unwrap().color(), ColorType::Rgba16, "after a failure the older file is there");
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1);
    }

    #[test]
    fn what_is_no_picture_is_refused_in_a_line_that_names_it() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.png");
        let refusal = |part: &str| {
            let error = read(&path).unwrap_err();
            let text = error.to_string();
            assert!(text.contains("a.png") && text.contains(part) && text.lines().count() == 1, "{text}");
            error
        };
        assert!(matches!(refusal("No such file"), PictureError::Read { .. }));
        fs::create_dir(&path).unwrap();
        assert!(matches!(refusal("directory"), PictureError::Read { .. }));
        fs::remove_dir(&path).unwrap();

        let good = base64::decode(GREY_1).unwrap();
        for length in 0..good.len() {
            fs::write(&path, &good[..length]).unwrap();
            // The first eight bytes identify the format. The last 12 bytes, an empty chunk, may be missing.
            if (8..good.len() - 12).contains(&length) {
                refusal("damaged or truncated");
            }
        }
        let other = if cfg!(feature = "pictures") { "not PNG, JPEG, WebP or EXR" } else { "--features pictures" };
        for bytes in
            [&good[..7], b"", b"not a picture", b"<html>", &[0; 4096], b"GIF89a\x01\0\x01\0\0\0\0", b"BM\0\0\0\0"]
        {
            fs::write(&path, bytes).unwrap();
            refusal(other);
        }

        // These 16-bit RGB pictures are rejected before they are decoded. Their sizes are 16,384 x 16,384,
        // (2^31 - 1) x 1, and (2^31 - 1) x (2^31 - 1).
        for text in [
            "iVBORw0KGgoAAAANSUhEUgAAQAAAAEAAEAIAAAB2OluQAAAADElEQVR4nGNgoD0AAABkAAGGZDw1",
            "iVBORw0KGgoAAAANSUhEUn////8AAAABEAIAAAB/xHjJAAAADElEQVR4nGNgoD0AAABkAAGGZDw1",
            "iVBORw0KGgoAAAANSUhEUn////9/////EAIAAADLO0ByAAAADElEQVR4nGNgoD0AAABkAAGGZDw1",
        ] {
            fs::write(&path, base64::decode(text).unwrap()).unwrap();
            assert!(matches!(refusal("512 MiB"), PictureError::Decode { cause: ImageError::Limits(_), .. }));
        }
    }

    #[test]
    fn a_note_is_in_the_file_and_other_writers_are_told_apart() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.png");
        let picture = DynamicImage::from(RgbaImage::from_pixel(3, 2, Rgba([1, 2, 3, 4])));
        for text in [None, Some("camera 0,2,5 0,0,0 45")] {
            write_noted(&path, &picture, text).unwrap();
            let bytes = read_bytes(&path).unwrap();
            assert_eq!((read(&path).unwrap(), note(&bytes), is_own(&bytes)), (picture.clone(), text, true));
            assert!(!is_own(&bytes[..bytes.len() - 1]));
        }
        assert!(!is_own(&base64::decode(GREY_1).unwrap()) && !is_own(b""));
        assert_eq!([note(b""), note(&[0xFF; 50]), note(&base64::decode(GREY_1).unwrap())], [None; 3]);
    }
}
