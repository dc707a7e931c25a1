use glam::Vec3;

use super::{Corners, TriangleTest};
use crate::geometry::Ray;
use crate::simd::{Lanes, each, indexed};

/// The watertight test in `f32`. The test shears space to align the ray with the third axis.
///
/// No ray passes between the triangles of a closed mesh, if coordinate differences do not overflow. All triangles at a
/// corner shear the corner to the same point, and the sign of each edge value is exact for the sheared corners.
///
/// Shearing causes rounding errors. A ray within an ulp of an edge may hit the triangle on the wrong side of the edge.
/// The `t` of a hit on a sliver may be off by thousands of ulps. The test may lose hits at `t` above 3e26.
///
/// The largest magnitude of a direction component must be from 3e-39 to 8e37. Otherwise, the test may lose hits.
///
/// # References
/// Woop, Benthin, Wald: Watertight ray/triangle intersection. Journal of Computer Graphics Techniques 2(1), 2013.
#[derive(Clone, Copy, Debug, Default)]
pub struct Watertight;

/// A ray with permuted axes. The direction component along the third axis has the largest magnitude.
#[derive(Clone, Copy, Debug)]
pub struct ShearedRay {
    axes: [usize; 3],
    /// The components of the origin, in the order of `axes`.
    origin: [f32; 3],
    shear: [f32; 3],
}

impl TriangleTest for Watertight {
    const NAME: &'static str = "watertight";
    const BATCHED: bool = true;

    type Ray = ShearedRay;
    type Block<const N: usize> = Corners<N>;

    decided_at_once!();

    #[inline(always)]
    fn prepare(ray: &Ray) -> ShearedRay {
        let z = ray.direction.abs().max_position();
        let (mut x, mut y) = ((z + 1) % 3, (z + 2) % 3);
        // The swap preserves the winding of the triangles.
        if ray.direction[z] < 0.0 {
            (x, y) = (y, x);
        }
        let along = ray.direction[z];
        ShearedRay {
            axes: [x, y, z],
            origin: each(&[x, y, z], |&axis| ray.origin[axis]),
            shear: [ray.direction[x] / along, ray.direction[y] / along, 1.0 / along],
        }
    }

    fn block<const N: usize>(triangles: &[[Vec3; 3]]) -> Corners<N> {
        Corners::new(triangles)
    }

    #[inline(always)]
    fn candidates<const N: usize, L: Lanes<N>>(ray: &ShearedRay, block: &Corners<N>, from: f32, to: f32) -> (u32, L) {
        let [[x, y, z], shear] = each(&[ray.origin, ray.shear], |v| each(v, |&x| L::splat(x)));
        let zs = each(&block.axis::<L>(ray.axes[2]), |corner| corner.sub(z));
        let sheared = |axis: usize, origin: L, shear: L| {
            let [a, b, c] = each(&block.axis::<L>(axis), |corner| corner.sub(origin));
            [a.sub(shear.mul(zs[0])), b.sub(shear.mul(zs[1])), c.sub(shear.mul(zs[2]))]
        };
        let xs = sheared(ray.axes[0], x, shear[0]);
        let ys = sheared(ray.axes[1], y, shear[1]);

        let edges = |[ax, bx, cx]: [L; 3], [ay, by, cy]: [L; 3]| {
            [cx.mul(by).sub(cy.mul(bx)), ax.mul(cy).sub(ay.mul(cx)), bx.mul(ay).sub(by.mul(ax))]
        };
        let mut volumes = edges(xs, ys);
        let zero = L::zero();
        let [u, v, w] = volumes;
        let det = u.add(v).add(w);
        let size = det.flip_sign(det);
        let all = L::splat(0.0).le(zero);
        let ordinary = L::splat(SMALL).le(size) & size.le(L::splat(LARGE));
        // A nonzero value has the exact sign, because rounding is monotonic and no operation is fused.
        if ordinary != all || volumes.iter().any(|v| zero.le(*v) & v.le(zero) != 0) {
            volumes = in_f64(volumes, xs, ys);
        }

        let [u, v, w] = volumes;
        let above = zero.le(u) & zero.le(v) & zero.le(w);
        let below = u.le(zero) & v.le(zero) & w.le(zero);
        let det = u.add(v).add(w);
        let abs_det = det.flip_sign(det);
        let [za, zb, zc] = each(&zs, |z| z.mul(shear[2]));
        let t = u.mul(za).add(v.mul(zb)).add(w.mul(zc)).div(det);
        ((above | below) & zero.lt(abs_det) & L::splat(from).le(t) & t.le(L::splat(to)), t)
    }
}

/// If the magnitude of `det` is below `SMALL` or above `LARGE`, the computation of `t` may overflow or underflow.
const SMALL: f32 = 1.0 / (1_u128 << 100) as f32;
const LARGE: f32 = (1_u64 << 40) as f32;

/// The function may multiply the three values of a lane by a power of two. The factor cancels in `t`.
#[cold]
fn in_f64<const N: usize, L: Lanes<N>>(volumes: [L; 3], xs: [L; 3], ys: [L; 3]) -> [L; 3] {
    let mut values = each(&volumes, |v| v.store());
    let (xs, ys) = (each(&xs, |x| x.store()), each(&ys, |y| y.store()));
    for lane in 0..N {
        let [u, v, w] = indexed(|i| values[i][lane]);
        if [u, v, w].iter().all(|v| *v != 0.0) && (SMALL..=LARGE).contains(&(u + v + w).abs()) {
            continue;
        }
        // Products of two `f32` are exact in `f64`. Hence the sign of each difference is exact.
        let [[ax, bx, cx], [ay, by, cy]] = each(&[xs, ys], |v| each(v, |corner| f64::from(corner[lane])));
        let exact = [cx * by - cy * bx, ax * cy - ay * cx, bx * ay - by * ax];
        let largest = exact.iter().fold(0.0_f64, |most, v| most.max(v.abs()));
        let scale = if largest > 0.0 && largest.is_finite() { inverse_power_of_two(largest) } else { 1.0 };
        for (value, exact) in values.iter_mut().zip(exact) {
            value[lane] = (exact * scale) as f32;
        }
    }
    each(&values, L::load)
}

/// The reciprocal of the largest power of two up to `x`. `x` must be positive, normal and below 2^1023.
fn inverse_power_of_two(x: f64) -> f64 {
    f64::from_bits((2046 - (x.to_bits() >> 52)) << 52)
}
