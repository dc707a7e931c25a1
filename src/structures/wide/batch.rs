//! Slices of rays.

use serde::{Deserialize, Serialize};

use super::WideTree;
use super::nearests::RAYS;
use super::stream::{Slots, Stream};
use crate::accel::Observer;
use crate::geometry::{Hit, Ray};
use crate::simd::{Kernel, Level, Sieve, dispatch};
use crate::structures::walk::{silent, single};
use crate::triangle::TriangleTest;

/// How the rays of a slice are answered, always with the same answers.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Batch {
    /// One after the other.
    Single,
    /// Sixteen in a row travel together where they share an octant, else one after the other: faster for rays that lie side by side, about
    /// as fast for others.
    Packets,
    /// Eight at a time are under way. In one pass over 262,144 rays that start and go anywhere in a scan of 70,000 to 100,000 triangles 1.1
    /// to 1.3 times as fast, in buildings 0.9 to 1.1; over a few thousand rays again and again, whose nodes are all at hand, 0.8 to 1.2;
    /// rays that lie side by side 0.7 to 0.9.
    Interleaved,
}

/// In packets where they agree, one after the other where not.
struct InTurn<'a, const ANY: bool, T: TriangleTest, A, F> {
    tree: &'a WideTree<T>,
    rays: &'a [Ray],
    answers: &'a mut [A],
    form: F,
}

impl<const ANY: bool, T: TriangleTest, A, F: Fn(Option<Hit>) -> A> Kernel for InTurn<'_, ANY, T, A, F> {
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

/// Several under way at once.
pub(super) struct UnderWay<'a, const ANY: bool, T: TriangleTest, A, F> {
    pub tree: &'a WideTree<T>,
    pub rays: &'a [Ray],
    pub answers: &'a mut [A],
    pub form: F,
}

impl<const ANY: bool, T: TriangleTest, A, F: Fn(Option<Hit>) -> A> Kernel for UnderWay<'_, ANY, T, A, F> {
    type Output = ();

    #[inline(always)]
    fn run<L: Sieve>(self) {
        let Self { tree, rays, answers, form } = self;
        // On portable lanes it is not memory that takes the time.
        if !L::FAST {
            return InTurn::<ANY, T, A, F> { tree, rays, answers, form }.run::<L>();
        }
        let mut slots = Slots::EMPTY;
        let mut stream = Stream::<L, T>::new(tree, &mut slots);
        let mut done = |i: usize, hit| answers[i] = form(hit);
        for (i, ray) in rays.iter().enumerate() {
            stream.push::<ANY>(i, ray, &mut done);
        }
        stream.finish::<ANY>(&mut done);
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
    if !L::FAST || tree.batch != Batch::Packets {
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
        let level = Level::current();
        match tree.batch {
            Batch::Interleaved => dispatch(level, UnderWay::<ANY, T, A, _> { tree, rays, answers, form }),
            _ => dispatch(level, InTurn::<ANY, T, A, _> { tree, rays, answers, form }),
        }
    }
}
