//! Slices of rays: packets where they agree, one by one where not.

use super::WideTree;
use super::beams::RAYS;
use crate::accel::Observer;
use crate::geometry::{Hit, Ray};
use crate::simd::{Kernel, Level, Sieve, dispatch};
use crate::structures::walk::{silent, single};
use crate::triangle::TriangleTest;

struct Batch<'a, const ANY: bool, T: TriangleTest, A, F> {
    tree: &'a WideTree<T>,
    rays: &'a [Ray],
    answers: &'a mut [A],
    form: F,
}

impl<const ANY: bool, T: TriangleTest, A, F: Fn(Option<Hit>) -> A> Kernel for Batch<'_, ANY, T, A, F> {
    type Output = ();

    #[inline(always)]
    fn run<L: Sieve>(self) {
        let Self { tree, rays, answers, form } = self;
        for (rays, answers) in rays.chunks(RAYS).zip(answers.chunks_mut(RAYS)) {
            match together::<ANY, L, T>(tree, rays) {
                Some(hits) => answers.iter_mut().zip(hits).for_each(|(answer, hit)| *answer = form(hit)),
                None => {
                    for (answer, ray) in answers.iter_mut().zip(rays) {
                        *answer = form(silent::<ANY, L, _>(tree, ray));
                    }
                }
            }
        }
    }
}

/// The hits of a packet, where the tree, the level and the rays are for it.
#[inline(always)]
fn together<const ANY: bool, L: Sieve, T: TriangleTest>(
    tree: &WideTree<T>,
    rays: &[Ray],
) -> Option<[Option<Hit>; RAYS]> {
    if !L::FAST || !tree.packets {
        return None;
    }
    tree.packet::<ANY, L>(rays.try_into().ok()?)
}

/// Answers `rays` in order, on the level in use.
///
/// # Panics
/// If the slices differ in length.
pub(super) fn answer<const ANY: bool, T: TriangleTest, A, O: Observer>(
    tree: &WideTree<T>,
    rays: &[Ray],
    answers: &mut [A],
    observer: &mut O,
    form: impl Fn(Option<Hit>) -> A,
) {
    assert_eq!(rays.len(), answers.len(), "one answer a ray");
    if O::ACTIVE {
        // Counts are those of single rays.
        for (answer, ray) in answers.iter_mut().zip(rays) {
            *answer = form(single::<ANY, _, O>(tree, ray, observer));
        }
    } else {
        dispatch(Level::current(), Batch::<ANY, T, A, _> { tree, rays, answers, form });
    }
}
