use glam::{DVec3, Vec3};

use super::*;

const MIDDLE: DVec3 = DVec3::splat(1.0 / 3.0);

/// The sign of the result is exact.
fn side(corners: [Vec3; 3], point: Vec3) -> f64 {
    let [a, b, c, p] = [corners[0], corners[1], corners[2], point].map(|v| {
        let v = v.as_dvec3();
        robust::Coord3D { x: v.x, y: v.y, z: v.z }
    });
    robust::orient3d(a, b, c, p)
}

#[test]
fn an_error_bounded_origin_is_exactly_on_the_side_of_its_ray() {
    let shape = [Vec3::new(0.3, -0.4, 0.9), Vec3::new(1.1, 0.2, -0.7), Vec3::new(-0.6, 0.8, 0.1)];
    let weights = [MIDDLE, DVec3::new(1.0, 0.0, 0.0), DVec3::new(0.999, 0.001, 0.0), DVec3::new(0.1, 0.2, 0.7)];
    for scale in [1.0, 1e3, 1e18, 1e-3, 1e-10, 1e-20, 1e-38, 1e-42] {
        for shift in [0.0, 1.0, 1e3, -1e5] {
            let corners = shape.map(|p| (p + shift) * scale);
            for weights in weights {
                let start = SurfacePoint::on_triangle(corners, weights);
                if start.normal == Vec3::ZERO {
                    continue;
                }
                let origins = [start.normal, -start.normal].map(|way| Offset::ErrorBounded.leave(&start, way).origin);
                let sides = origins.map(|origin| side(corners, origin));
                assert!(sides[0] * sides[1] < 0.0, "{sides:?} at {scale:e}, {shift}: {start:?}");
                let farthest = corners.iter().map(|p| p.abs().max_element()).fold(0.0, f32::max);
                let reach = origins.map(|origin| (origin - start.position).abs().max_element());
                let ulp = farthest.next_up() - farthest;
                assert!(reach.iter().all(|r| *r <= 12.0 * ulp), "{reach:?} of {ulp:e} at {scale:e}, {shift}");
            }
        }
    }
}

#[test]
fn a_triangle_in_a_plane_of_zero_coordinates_is_left_too() {
    let corners = [Vec3::ZERO, Vec3::X, Vec3::Z];
    let start = SurfacePoint::on_triangle(corners, MIDDLE);
    assert_eq!(start.error.y, 0.0);
    let up = Offset::ErrorBounded.leave(&start, Vec3::new(0.1, 1.0, 0.0));
    assert!(up.origin.y > 0.0 && up.t_min > 0.0, "{up:?}");
    assert_eq!((up.origin.x, up.origin.z), (start.position.x, start.position.z));
}

#[test]
fn a_point_made_of_wrong_weights_is_still_in_the_triangle() {
    let corners = [Vec3::ZERO, Vec3::X * 4.0, Vec3::Y * 4.0];
    assert_eq!(SurfacePoint::on_triangle(corners, DVec3::new(0.5, 0.75, -0.25)).position, Vec3::new(2.4, 0.0, 0.0));
    assert_eq!(SurfacePoint::on_triangle(corners, DVec3::new(-1.0, 2.0, 0.0)).position, Vec3::X * 4.0);
}

#[test]
fn the_course_moves_all_rays_along_their_direction_and_the_error_bound_none_that_leave_no_surface() {
    let start = SurfacePoint::on_triangle(
        [Vec3::new(-1.0, 2.0, -1.0), Vec3::new(1.0, 2.0, -1.0), Vec3::new(0.0, 2.0, 2.0)],
        MIDDLE,
    );
    assert_eq!((start.position, start.normal), (Vec3::Y * 2.0, Vec3::NEG_Y));
    assert_eq!(Offset::Direction(0.5).leave(&start, Vec3::Y * 3.0), Ray::new(Vec3::Y * 2.5, Vec3::Y));
    let free = |offset: Offset| offset.leave_free(Vec3::Y, Vec3::X * 4.0);
    assert_eq!(free(Offset::Direction(0.5)), Ray::new(Vec3::new(0.5, 1.0, 0.0), Vec3::X));
    assert_eq!(free(Offset::ErrorBounded), Ray::new(Vec3::Y, Vec3::X));
}
