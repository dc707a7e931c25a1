use glam::Vec3;
use rand_core::{RngCore, SeedableRng};
use rand_pcg::Pcg32;

use super::*;
use crate::exact::rational;
use crate::triangle::tests::{Number, any, grid, point, unit};

pub struct Numbers {
    random: Pcg32,
    number: Number,
    /// A power of two.
    scale: f32,
}

impl Numbers {
    pub fn all() -> impl Iterator<Item = Self> {
        let powers = [127 << 23, 1 << 10, 1 << 23, 97 << 23, 157 << 23, 253 << 23];
        let scaled = powers.map(|bits| (unit as Number, f32::from_bits(bits)));
        let kinds = scaled.into_iter().chain([(grid as Number, 1.0), (any, 1.0)]);
        (0..).zip(kinds).map(|(seed, (number, scale))| Self { random: Pcg32::seed_from_u64(seed), number, scale })
    }

    pub fn point(&mut self) -> Vec3 {
        point(&mut self.random, self.number) * self.scale
    }

    pub fn direction(&mut self) -> Vec3 {
        let mut direction = self.point();
        for axis in 0..3 {
            match self.random.next_u32() % 6 {
                0 => direction[axis] = 0.0,
                1 => direction[axis] = -0.0,
                _ => {}
            }
        }
        direction
    }
}

#[test]
fn rational_arithmetic_agrees() {
    let mut hits = 0;
    for mut numbers in Numbers::all() {
        let positions: Vec<Vec3> = (0..30).map(|_| numbers.point()).collect();
        let triangles = (0..20).map(|i| [i, (i * 7 + 1) % 30, (i * 5 + 2) % 30]).collect();
        let mesh = Arc::new(Mesh::new(positions, triangles).unwrap());
        let oracle = Oracle::new(&mesh);
        for round in 0..24 {
            let (origin, target) = (numbers.point(), mesh.positions()[round]);
            let ray = Ray::new(origin, if round % 2 == 0 { numbers.direction() } else { target - origin });
            let first = oracle.nearest(&ray).map(|truth| truth.first());
            let second = rational::nearest(&ray, mesh.solid().map(|id| (id, mesh.corners(id))));
            assert_eq!(first, second, "{ray:?}");
            hits += usize::from(first.is_some());
        }
    }
    assert!(hits > 40, "{hits}");
}

#[test]
fn all_triangles_at_the_nearest_t_are_listed() {
    let (lower, near) = ([-Vec3::Z, Vec3::new(5.0, 0.0, -1.0), Vec3::new(0.0, 5.0, -1.0)], Vec3::new(1.0, 1.0, 0.0));
    let points = [&[Vec3::ZERO, Vec3::X, Vec3::Y, near][..], &lower].concat();
    let mesh = Arc::new(Mesh::new(points, vec![[4, 5, 6], [0, 1, 2], [0, 0, 1], [1, 2, 3], [0, 1, 2]]).unwrap());
    let oracle = Oracle::new(&mesh);
    let ray = Ray::new(Vec3::new(0.5, 0.5, 1.0), Vec3::NEG_Z);
    let truth = oracle.nearest(&ray).unwrap();
    assert_eq!((truth.rounded(), &truth.ids[..]), (1.0, &[1, 3, 4][..]));
    assert_eq!(nearest(&ray, &mesh), Some(truth));
    assert_eq!(oracle.nearest(&ray.until(1.0)), None);
    assert!(oracle.nearest(&ray.until(1.0_f32.next_up())).is_some());
    assert_eq!(oracle.nearest(&Ray { t_min: 1.0, ..ray }).unwrap().ids, [1, 3, 4]);
    assert_eq!(oracle.nearest(&Ray { t_min: 1.0_f32.next_up(), ..ray }).unwrap().ids, [0]);
    for bad in [ray.until(f32::NAN), Ray { direction: Vec3::ZERO, ..ray }, Ray { origin: Vec3::INFINITY, ..ray }] {
        assert_eq!(oracle.nearest(&bad), None);
    }
}
