use std::mem::MaybeUninit;

use super::node::{Child, Node, WIDTH};
use super::WideTree;
use crate::accel::Observer;
use crate::geometry::{Aabb, Hit, Ray};
use crate::simd::{Arithmetic, F32x8, Lanes, Sieve};
use crate::structures::leaf::{Nearest, search, start};
use crate::structures::line::{after};
use crate::triangle::TriangleTest;

pub(super) const STACK: usize = 512;

#[derive(Clone, Copy)]
pub(super) struct Beam<L> {
    origin: [L; 3],
    inverse: [L; 3],
    grown: [L; 3],
    /// Byte offsets
    near: [usize; 3],
    far: [usize; 3],
    octant: usize,
    t_min: L,
}

impl<L: Lanes<8>> Beam<L> {
    #[inline(always)]
    pub fn new(ray: &Ray, bounds: &Aabb, t_min: f32) -> Self {
        let mut inverse = ray.direction.to_array().map(|d| {
            let inverse = 1.0 / d;
            if inverse.is_normal() || d == 0.0 { inverse } else { f32::NAN }
        });
        let reach = ray.origin.abs() + bounds.min.abs().max(bounds.max.abs());
        if !reach.is_finite() {
            inverse = [f32::NAN; 3];
        }
        let near = ray.direction.to_array().map(|d| d.is_sign_negative() as usize);
        Self {
            origin: ray.origin.to_array().map(L::splat),
            inverse: inverse.map(L::splat),
            grown: inverse.map(|i| L::splat(i * (1.0 + 8.0 * f32::EPSILON))),
            near: [near[0], 2 + near[1], 4 + near[2]],
            far: [near[0] ^ 1, 2 + (near[1] ^ 1), 4 + (near[2] ^ 1)],
            octant: near[0] | near[1] << 1 | near[2] << 2,
            t_min: L::splat(t_min),
        }
    }

    #[inline(always)]
    pub fn enter(&self, node: &Node, end: L) -> (L, L) {
        let planes: &[[f32; 8]; 6] = unsafe { &*(&raw const node.planes).cast() };
        let mut tn = self.t_min;
        let mut tf = end;
        let tiny = L::splat(2.0 * f32::MIN_POSITIVE);
        for a in 0..3 {
            let (near, far) = unsafe { (planes.get_unchecked(self.near[a]), planes.get_unchecked(self.far[a])) };
            tn = L::load(near).sub(self.origin[a]).mul(self.inverse[a]).max(tn);
            tf = L::load(far).sub(self.origin[a]).mul_add_loosely(self.grown[a], tiny).min(tf);
        }
        (tn, tf)
    }
}

impl<T: TriangleTest> WideTree<T> {
    #[inline(always)]
    pub(super) fn query<const ANY: bool, O: Observer>(&self, ray: &Ray, observer: &mut O) -> Option<Hit> {
        let (prepared, t_min, nearest) = start::<T>(ray)?;
        self.walk::<ANY, F32x8, O>(ray, &prepared, t_min, nearest, observer)
    }

    fn walk<const ANY: bool, L: Sieve, O: Observer>(&self, ray: &Ray, prepared: &T::Ray, t_min: f32, mut nearest: Nearest<T::Depth>, observer: &mut O) -> Option<Hit> {
        let beam = Beam::<L>::new(ray, &self.bounds, t_min);
        let mut children = [const { MaybeUninit::<Child>::uninit() }; STACK];
        let mut depths = [const { MaybeUninit::<f32>::uninit() }; STACK];
        let mut top = 0_usize;
        let nodes = self.nodes.as_ptr();
        let mut child = self.root;
        let mut end = L::splat(after(nearest.t));
        'walk: loop {
            if let Some((first, count)) = child.blocks() {
                observer.leaf(0);
                let blocks = unsafe { self.blocks.get_unchecked(first..first + count) };
                let tests = search::<ANY, WIDTH, F32x8, T, ()>(blocks, u32::MAX, prepared, t_min, &mut nearest, &mut ());
                observer.test(tests);
                if ANY && nearest.found() { break; }
                end = L::splat(after(nearest.t));
            } else {
                observer.inner();
                let node = unsafe { &*nodes.add(child.index()) };
                let (tn, limit) = beam.enter(node, end);
                let mask = if ANY {
                    unsafe { tn.sift(limit, node.children.as_ptr().cast(), children.as_mut_ptr().add(top).cast()) }
                } else {
                    unsafe { tn.sieve(limit, node.children.as_ptr().cast(), node.orders[beam.octant], depths.as_mut_ptr().add(top).cast(), children.as_mut_ptr().add(top).cast()) }
                };
                if mask != 0 {
                    let last = 31 - mask.leading_zeros();
                    let lane = if ANY { last } else { node.orders[beam.octant] >> (3 * last) & 7 };
                    child = node.children[lane as usize];
                    top += mask.count_ones() as usize - 1;
                    continue;
                }
            }
            loop {
                if top == 0 { break 'walk; }
                top -= 1;
                // SAFETY: written below top
                child = unsafe { children.get_unchecked(top).assume_init() };
                if ANY || unsafe { depths.get_unchecked(top).assume_init() } <= after(nearest.t) { break; }
            }
        }
        nearest.hit()
    }
}
