/// Pixels on a side of a tile.
const SIDE: usize = 4;

/// The pixels of a picture, given row by row, tile by tile: what is near in the picture is near in the slice, as renderers take
/// rays, and a structure that takes several at once can show what that gives. Tiles at the right and lower border may be smaller.
pub fn in_tiles<T: Copy>(pixels: &[T], [width, height]: [u32; 2]) -> Vec<T> {
    let [width, height] = [width, height].map(|side| side as usize);
    assert_eq!(pixels.len(), width * height, "a picture has all its pixels");
    let mut ordered = Vec::with_capacity(pixels.len());
    for top in (0..height).step_by(SIDE) {
        for left in (0..width).step_by(SIDE) {
            for y in top..(top + SIDE).min(height) {
                ordered.extend_from_slice(&pixels[y * width + left..y * width + (left + SIDE).min(width)]);
            }
        }
    }
    ordered
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_pixel_comes_once_and_tiles_come_whole() {
        for size in [[8, 8], [10, 6], [2, 2], [4, 9]] {
            let pixels: Vec<u32> = (0..size[0] * size[1]).collect();
            let ordered = in_tiles(&pixels, size);
            let mut sorted = ordered.clone();
            sorted.sort_unstable();
            assert_eq!(sorted, pixels);
        }
        let ordered = in_tiles(&(0..60).collect::<Vec<_>>(), [10, 6]);
        assert_eq!(ordered[..20], [0, 1, 2, 3, 10, 11, 12, 13, 20, 21, 22, 23, 30, 31, 32, 33, 4, 5, 6, 7]);
        assert_eq!(ordered[32..40], [8, 9, 18, 19, 28, 29, 38, 39]);
    }
}
