//! Rays from the eye, row by row or tile by tile.

use glam::{UVec2, Vec2};

use super::source::Source;
use crate::geometry::Ray;
use crate::scene::View;

pub fn centres(source: &mut Source) -> Vec<Ray> {
    in_tiles(&by_row(source, View::CENTRE), source.sampling.size)
}

pub fn corners(source: &mut Source) -> Vec<Ray> {
    in_tiles(&by_row(source, Vec2::ZERO), source.sampling.size)
}

pub fn by_row(source: &Source, offset: Vec2) -> Vec<Ray> {
    source.scene.primary_rays(source.sampling.size, offset, 0..source.sampling.pixels())
}

/// Side length of a tile, in pixels.
const TILE: u32 = 4;
/// Side length of a block, in pixels.
const BLOCK: u32 = 32;

/// The tile order makes packets of consecutive rays coherent.
fn in_tiles<T: Copy>(pixels: &[T], [width, height]: [u32; 2]) -> Vec<T> {
    assert_eq!(pixels.len(), width as usize * height as usize, "a picture has all its pixels");
    let corners = |from: UVec2, to: UVec2, side: u32| {
        (from.y..to.y)
            .step_by(side as usize)
            .flat_map(move |y| (from.x..to.x).step_by(side as usize).map(move |x| UVec2::new(x, y)))
    };
    let picture = UVec2::new(width, height);
    let blocks = corners(UVec2::ZERO, picture, BLOCK);
    let tiles = blocks.flat_map(|block| corners(block, (block + BLOCK).min(picture), TILE));
    let rows = tiles.flat_map(|tile| (tile.y..(tile.y + TILE).min(height)).map(move |y| UVec2::new(tile.x, y)));
    let mut ordered = Vec::with_capacity(pixels.len());
    for row in rows {
        let first = (row.y * width + row.x) as usize;
        ordered.extend_from_slice(&pixels[first..first + TILE.min(width - row.x) as usize]);
    }
    ordered
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_pixel_comes_once_and_tiles_and_blocks_are_contiguous() {
        for size in [[8, 8], [10, 6], [2, 2], [4, 9], [70, 33], [32, 64]] {
            let pixels: Vec<u32> = (0..size[0] * size[1]).collect();
            let ordered = in_tiles(&pixels, size);
            let mut sorted = ordered.clone();
            sorted.sort_unstable();
            assert_eq!(sorted, pixels);
        }
        let ordered = in_tiles(&(0..60).collect::<Vec<_>>(), [10, 6]);
        assert_eq!(ordered[..20], [0, 1, 2, 3, 10, 11, 12, 13, 20, 21, 22, 23, 30, 31, 32, 33, 4, 5, 6, 7]);
        assert_eq!(ordered[32..40], [8, 9, 18, 19, 28, 29, 38, 39]);
        let ordered = in_tiles(&(0..64 * 64).collect::<Vec<u32>>(), [64, 64]);
        for (i, block) in ordered.chunks(1024).enumerate() {
            let [left, top] = [i as u32 % 2 * 32, i as u32 / 2 * 32];
            let inside =
                |&pixel: &u32| (left..left + 32).contains(&(pixel % 64)) && (top..top + 32).contains(&(pixel / 64));
            assert!(block.iter().all(inside), "{i}");
        }
    }
}
