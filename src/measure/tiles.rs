//! Selects subsets of the rays of a workload.
//!
//! A tile is a range of consecutive rays. A workload lists the rays of a picture block by block, so a tile is a block
//! of pixels. A subset consists of tiles, because scattered single rays would miss the caches more often. Different
//! epochs select different subsets, so the spread between epochs includes the choice of tiles.
//!
//! Level 0 contains all rays. Each further level contains about a quarter of the rays of the previous level. In one
//! epoch, the levels are nested, so a pass of a fast structure also times the rays of a slower structure.

use std::ops::Range;

use super::RandomOrder;

/// The number of rays of a full tile, such as a block of 32 by 32 pixels.
pub const TILE: usize = 1024;

/// Tiles are removed only if at least this many tiles remain. Otherwise the tiles become smaller.
const FEWEST: usize = 64;

/// The ranges are sorted. No range is empty.
pub fn tiles(rays: usize, level: usize, epoch: usize) -> Vec<Range<usize>> {
    if level == 0 {
        return (0..rays).step_by(TILE).map(|first| first..(first + TILE).min(rays)).collect();
    }
    // With only full tiles, the number of rays of a level does not depend on the epoch.
    let mut tiles: Vec<Range<usize>> = match rays / TILE {
        0 => std::iter::once(0..rays).collect(),
        whole => (0..whole).map(|i| i * TILE..(i + 1) * TILE).collect(),
    };
    for level in 1..=level {
        let mut random = RandomOrder::new((epoch as u64) << 8 | level as u64);
        tiles = if tiles.len() >= 4 * FEWEST { thinned(&tiles, &mut random) } else { shrunk(&tiles, &mut random) };
    }
    tiles
}

fn thinned(tiles: &[Range<usize>], random: &mut RandomOrder) -> Vec<Range<usize>> {
    let count = tiles.len() / 4;
    let stratum = |i: usize| i * tiles.len() / count;
    (0..count).map(|i| tiles[stratum(i) + random.below(stratum(i + 1) - stratum(i))].clone()).collect()
}

fn shrunk(tiles: &[Range<usize>], random: &mut RandomOrder) -> Vec<Range<usize>> {
    let quarter = |tile: &Range<usize>| {
        let length = tile.len().div_ceil(4);
        let first = tile.start + length * random.below(tile.len() / length);
        first..first + length
    };
    tiles.iter().map(quarter).collect()
}

pub fn rays_at(rays: usize, level: usize) -> usize {
    tiles(rays, level, 0).iter().map(Range::len).sum()
}

pub fn level_within(rays: usize, most: usize) -> usize {
    (0..last_level(rays)).find(|&level| rays_at(rays, level) <= most).unwrap_or(last_level(rays))
}

pub fn level_of(rays: usize, part: usize) -> Option<usize> {
    let level = level_within(rays, part);
    (rays_at(rays, level) == part).then_some(level)
}

pub fn last_level(rays: usize) -> usize {
    let is_last = |&level: &usize| level > 0 && tiles(rays, level, 0).iter().all(|tile| tile.len() <= 1);
    (0..usize::BITS as usize).find(is_last).expect("tiles shrink")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn levels_are_nested_and_each_is_about_a_quarter_of_the_one_before() {
        for rays in [1, 5, 700, 1024, 5000, 20_000, 262_144, 300_001] {
            for epoch in 0..3 {
                let mut before = tiles(rays, 0, epoch);
                assert_eq!(before.iter().map(Range::len).sum::<usize>(), rays);
                for level in 1..=last_level(rays) {
                    let now = tiles(rays, level, epoch);
                    assert!(now.iter().all(|tile| !tile.is_empty()) && now.is_sorted_by_key(|tile| tile.start));
                    let inside =
                        |tile: &Range<usize>| before.iter().any(|b| b.start <= tile.start && tile.end <= b.end);
                    assert!(now.iter().all(inside), "{rays} {level}");
                    let count: usize = now.iter().map(Range::len).sum();
                    assert_eq!(count, rays_at(rays, level), "as many in each epoch");
                    if rays >= 65_536 && level <= 4 {
                        let share = count as f64 / rays_at(rays, level - 1) as f64;
                        assert!((0.24..0.26).contains(&share), "{rays} {level} {share}");
                    }
                    before = now;
                }
            }
        }
        assert_eq!([0, 1, 2, 3, 4].map(|level| rays_at(262_144, level)), [262_144, 65_536, 16_384, 4096, 1024]);
    }

    #[test]
    fn epochs_draw_tiles_of_their_own_that_cover_the_workload_evenly() {
        assert_ne!(tiles(262_144, 1, 0), tiles(262_144, 1, 1));
        let mut drawn = vec![0; 256];
        (0..400).flat_map(|epoch| tiles(262_144, 1, epoch)).for_each(|tile| drawn[tile.start / TILE] += 1);
        // Each tile is drawn in 100 of the 400 epochs on average. Five standard deviations are 43.
        assert!(drawn.iter().all(|n| (57..=143).contains(n)), "{drawn:?}");
    }

    #[test]
    fn the_level_that_fits_is_found() {
        assert_eq!(
            [usize::MAX, 262_144, 262_143, 16_384, 16_383, 0].map(|most| level_within(262_144, most)),
            [0, 0, 1, 2, 3, 6]
        );
        assert_eq!([262_144, 4096, 4095, 0].map(|part| level_of(262_144, part)), [Some(0), Some(3), None, None]);
        assert_eq!((level_within(1, 1), level_within(1, 0), last_level(1)), (0, 1, 1));
    }
}
