//! Slices of rays: packets where they agree, one by one where not.

use super::WideTree;
use super::beams::RAYS;

use crate::accel::Observer;
use crate::geometry::{Hit, Ray};
use crate::simd::{Kernel, Level, Sieve, dispatch};
use crate::structures::walk::Walk;
use crate::triangle::TriangleTest;

struct Batch<'a, const ANY: bool, T: TriangleTest, A, O, F> {
    tree: &'a WideTree<T>,
    rays: &'a [Ray],
    answers: &'a mut [A],
    observer: &'a mut O,
    form: F,
}

impl<const ANY: bool, T: TriangleTest, A, O: Observer, F: Fn(Option<Hit>) -> A> Kernel for Batch<'_, ANY, T, A, O, F> {
    type Output = ();

    #[inline(always)]
    fn run<L: Sieve>(self) {
        let Self { tree, rays, answers, observer, form } = self;
        // Counts are those of single rays.
        let packets = tree.packets && !O::ACTIVE;
        for (rays, answers) in rays.chunks(RAYS).zip(answers.chunks_mut(RAYS)) {
            let together =
                if packets { rays.try_into().ok().and_then(|rays| tree.packet::<ANY, L>(rays)) } else { None };
            match together {
                Some(hits) => answers.iter_mut().zip(hits).for_each(|(answer, hit)| *answer = form(hit)),
                None => {
                    for (answer, ray) in answers.iter_mut().zip(rays) {
                        *answer = form(tree.walk::<ANY, L, O>(ray, observer));
                    }
                }
            }
        }
    }
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
    dispatch(Level::current(), Batch::<ANY, T, A, O, _> { tree, rays, answers, observer, form });
}
