//! Slices of rays: packets where they agree, one by one where not.

use super::WideTree;
use super::nearests::RAYS;
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
            if !together::<ANY, L, T, A>(tree, rays, answers, &form) {
                for (answer, ray) in answers.iter_mut().zip(rays) {
                    *answer = form(silent::<ANY, L, _>(tree, ray));
                }
            }
        }
    }
}

/// Answers the rays of a packet; false where the tree, the level or the rays are not for it.
#[inline(always)]
fn together<const ANY: bool, L: Sieve, T: TriangleTest, A>(
    tree: &WideTree<T>,
    rays: &[Ray],
    answers: &mut [A],
    form: &impl Fn(Option<Hit>) -> A,
) -> bool {
    if !L::FAST || !tree.packets {
        return false;
    }
    match (rays.try_into(), answers.try_into()) {
        (Ok(rays), Ok(answers)) => alike(rays) && tree.packet::<ANY, L, A>(rays, answers, form),
        _ => false,
    }
}

/// Whether some of the rays are of one octant: most that cannot travel together are soon told so.
#[inline(always)]
fn alike(rays: &[Ray; RAYS]) -> bool {
    let signs = |i: usize| rays[i].direction.to_array().map(f32::to_bits);
    let first = signs(0);
    let differ = |i: usize| (0..3).fold(0, |bits, axis| bits | (signs(i)[axis] ^ first[axis]));
    (differ(5) | differ(10) | differ(15)) >> 31 == 0
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
