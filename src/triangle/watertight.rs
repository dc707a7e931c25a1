use glam::Vec3;

use super::{Corners, TriangleTest};
use crate::geometry::Ray;
use crate::simd::Lanes;

/// Watertight, in `f32`: the triangle is sheared so that the ray becomes the third axis, and edges are tested in 2D; an edge
/// value of exactly zero is computed again in `f64`.
///
/// Promises: a corner is sheared to the same point for every triangle that has it, and the sign of an edge is exact for the
/// sheared corners, so that no ray passes between the triangles of a closed mesh, edges and vertices included. Does not promise:
/// the sheared corners are rounded, so that what lies within an ulp beside an edge may go to either side (a lone triangle may be
/// missed at its rim), and `t` of slivers may be off by thousands of ulps. Costs about as much as Möller-Trumbore.
///
/// # References
/// Woop, Benthin, Wald: Watertight ray/triangle intersection. Journal of Computer Graphics Techniques 2(1), 2013.
#[derive(Clone, Copy, Debug, Default)]
pub struct Watertight;

/// A ray with its axes named so that it runs along the third.
#[derive(Clone, Copy, Debug)]
pub struct Sheared {
    /// The axes in the order x, y, z of the sheared space.
    axes: [usize; 3],
    /// The origin in that order.
    origin: [f32; 3],
    shear: [f32; 3],
}

impl TriangleTest for Watertight {
    const NAME: &'static str = "watertight";

    type Ray = Sheared;
    type Block<const N: usize> = Corners<N>;
    type Depth = f32;

    #[inline(always)]
    fn prepare(ray: &Ray) -> Sheared {
        // The longest component becomes the third; swapping the others keeps the winding where it points backward.
        let z = ray.direction.abs().max_position();
        let (mut x, mut y) = ((z + 1) % 3, (z + 2) % 3);
        if ray.direction[z] < 0.0 {
            (x, y) = (y, x);
        }
        let along = ray.direction[z];
        Sheared {
            axes: [x, y, z],
            origin: [x, y, z].map(|axis| ray.origin[axis]),
            shear: [ray.direction[x] / along, ray.direction[y] / along, 1.0 / along],
        }
    }

    fn block<const N: usize>(triangles: &[[Vec3; 3]]) -> Corners<N> {
        Corners::new(triangles)
    }

    #[inline(always)]
    fn candidates<const N: usize, L: Lanes<N>>(ray: &Sheared, block: &Corners<N>, from: f32, to: f32) -> (u32, L) {
        // Corners as seen from the origin, sheared.
        let [[x, y, z], shear] = [ray.origin, ray.shear].map(|v| v.map(L::splat));
        let zs = block.axis::<L>(ray.axes[2]).map(|corner| corner.sub(z));
        let sheared = |axis: usize, origin: L, shear: L| {
            let [a, b, c] = block.axis::<L>(axis).map(|corner| corner.sub(origin));
            [a.sub(shear.mul(zs[0])), b.sub(shear.mul(zs[1])), c.sub(shear.mul(zs[2]))]
        };
        let xs = sheared(ray.axes[0], x, shear[0]);
        let ys = sheared(ray.axes[1], y, shear[1]);

        // The edges, again in f64 where one is zero: products of two floats are exact there, and so is the sign.
        let edges = |[ax, bx, cx]: [L; 3], [ay, by, cy]: [L; 3]| {
            [cx.mul(by).sub(cy.mul(bx)), ax.mul(cy).sub(ay.mul(cx)), bx.mul(ay).sub(by.mul(ax))]
        };
        let mut volumes = edges(xs, ys);
        let zero = L::zero();
        if volumes.iter().any(|v| zero.le(*v) & v.le(zero) != 0) {
            volumes = exact_where_zero(volumes, xs, ys);
        }

        let [u, v, w] = volumes;
        let above = zero.le(u) & zero.le(v) & zero.le(w);
        let below = u.le(zero) & v.le(zero) & w.le(zero);
        let det = u.add(v).add(w);
        let abs_det = det.flip_sign(det);
        let [za, zb, zc] = zs.map(|z| z.mul(shear[2]));
        let t = u.mul(za).add(v.mul(zb)).add(w.mul(zc)).div(det);
        ((above | below) & zero.lt(abs_det) & L::splat(from).le(t) & t.le(L::splat(to)), t)
    }

    #[inline(always)]
    fn decide<const N: usize>(_: &Self::Ray, _: &Self::Block<N>, _: usize, t: f32) -> Option<f32> {
        Some(t)
    }
}

/// The edge values, those of lanes with a zero among them computed in `f64`.
#[cold]
fn exact_where_zero<const N: usize, L: Lanes<N>>(volumes: [L; 3], xs: [L; 3], ys: [L; 3]) -> [L; 3] {
    let mut values = volumes.map(L::store);
    let (xs, ys) = (xs.map(L::store), ys.map(L::store));
    for lane in 0..N {
        if values.iter().all(|v| v[lane] != 0.0) {
            continue;
        }
        let [[ax, bx, cx], [ay, by, cy]] = [xs, ys].map(|v| v.map(|corner| f64::from(corner[lane])));
        values[0][lane] = (cx * by - cy * bx) as f32;
        values[1][lane] = (ax * cy - ay * cx) as f32;
        values[2][lane] = (bx * ay - by * ax) as f32;
    }
    values.map(|v| L::load(&v))
}
