//! The table of the hard cases.

use glam::Vec3;

use super::case::{Content, Expected, HardCase, Rank, cases};
use super::meshes::*;
use super::metamorphic::{metamorphic, straight_down};
use super::properties::*;
use super::rays::*;
use super::set::{Set, on_edge, on_surface, ray_to, vertex};
use crate::geometry::Ray;
use crate::validate::degenerate::{box_grid, exponential, half_without_area, huge_and_small, mesh, needles};
use crate::validate::degenerate::{same_centroid, sheets, shells, soup};

const EPSILON: &str = "obvhs, CwBvh node.rs EPSILON = 1e-4";
const EPSILONS: &str = "tinybvh pull request 283; obvhs, CwBvh node.rs EPSILON";
const INVERSE: &str = "obvhs, safe_inverse: 1.19e-7";
const INVERSES: &str = "obvhs, safe_inverse; Embree, zero_fix";
const MISSED: &str = "measured: every f32 system misses all";
const OVERFLOW: &str = "Embree, FLT_LARGE; measured: every peer of f32 misses or misplaces all";
const TIME: &str = "Embree, verify.cpp, nan_test and inf_test: time below 2.5 times the time of valid rays";

cases! {
    // Rays from inside a closed star.
    Moderate 1 "closed_random", Hit => |n| Set::new(star(), n, 1, |_, s| Ray::new(inside(s), s.direction())),
        "Random rays inside a spiky closed star: the minimum requirement of watertight traversal.",
        "pbrt-v4, shapes_test.cpp, Triangle.Watertight";
    Moderate 2 "closed_vertex", Hit => |n| Set::new(star(), n, 1, |mesh, s| ray_to(inside(s), vertex(mesh, s))),
        "At a vertex each adjacent triangle may reject the ray by its own rounding, and the ray leaks.",
        "pbrt-v4, Triangle.Watertight; Embree issues 174 and 181; obvhs, rt_triangle.rs: -0.0 counts as outside";
    Moderate 3 "closed_edge", Hit => |n| Set::new(star(), n, 1, |mesh, s| ray_to(inside(s), on_edge(mesh, s))),
        "At an edge both triangles may reject the ray when their edge functions round differently.", "Woop, Benthin, Wald 2013";

    // A cube with grid lines at multiples of 1/8.
    Moderate 4 "cube_random", Hit => |n| Set::new(cube(), n, 3, |_, s| Ray::new(s.cube() * 0.99, s.direction())),
        "Random rays inside a cube: faces in the planes of the root box.", "survey";
    Moderate 5 "cube_axis_aligned", Hit => |n| {
        Set::new(cube(), n, 3, |_, s| Ray::new(s.cube() * 0.99, along_axis(s, 0.0)))
    },
        "Two direction components of +0.0: their inverse is infinite, and 0 times it is NaN.", "madmann91/bvh issue 9";
    Moderate 6 "cube_axis_negzero", SameAs("cube_axis_aligned") => |n| {
        Set::new(cube(), n, 3, |_, s| Ray::new(s.cube() * 0.99, along_axis(s, -0.0)))
    },
        "The same rays with components of -0.0: an octant from d < 0 contradicts the sign of 1 / d.",
        "tinybvh pull request 282; madmann91/bvh issue 20; obvhs, CwBvh";
    Moderate 7 "cube_faceplane_grid", Hit => |n| Set::new(cube(), n, 4, face_plane),
        "Rays in box faces and split planes, through vertices and along edges of the silhouette: 0 times infinity.",
        "Embree pull request 589; svenstaro/bvh pull request 149; Hapala, Havran 2011";
    Moderate 8 "cube_diagonal_111", Hit => |n| Set::new(cube(), n, 5, |_, s| diagonal(s, false)),
        "Space diagonals through grid points meet three planes, and diagonals of cells, at once.",
        "Hapala, Havran 2011";
    Moderate 9 "cube_diag_110", Hit => |n| Set::new(cube(), n, 5, |_, s| diagonal(s, true)),
        "A diagonal with one zero component, often in the plane of a face.", "Embree pull request 589; Ize 2013";

    // Triangles in one plane.
    Moderate 10 "flat_down", Hit => |n| Set::new(sheet(32), n, 6, |_, s| Ray::new(at_height(s, 1.0), Vec3::NEG_Z)),
        "The root box has no thickness: an interval of one point must not count as empty.",
        "Hapala, Havran 2011: flat cells";
    Moderate 11 "flat_inplane", Miss => |n| Set::new(sheet(32), n, 7, in_plane),
        "A ray in the plane of every triangle meets none in a point: the determinant is 0.", "Möller, Trumbore 1997";
    Moderate 12 "flat_grazing_1e-3", Oracle => |n| Set::new(moved(&sheet(32), tilted), n, 10, |_, s| at_slope(s, 1e-3)),
        "Rays at a slope of 1e-3 to a tilted plane: the determinant loses ten bits.", "Embree issue 387";
    Moderate 13 "flat_grazing_1e-6", Oracle => |n| Set::new(moved(&sheet(32), tilted), n, 10, |_, s| at_slope(s, 1e-6)),
        "At a slope of 1e-6 the determinant is only rounding: t is off by a hundred thousand ulps, hits are missed \
         and invented.",
        "Embree issue 387; measured: 55 to 75 % of the depths wrong in every f32 system";

    // A sphere far from zero.
    Moderate 14 "offset_1e3", Hit => |n| in_sphere(n, Vec3::splat(1e3), 1.0),
        "A unit sphere at 1e3: tests that store planes in absolute coordinates lose their digits.",
        "measured: Baldwin-Weber in f32 misses 43 %";
    Moderate 15 "offset_embree_1.5e5", Hit => |n| in_sphere(n, Vec3::new(148_376.0, 1234.0, -223_423.0), 2.0),
        "The position of the sphere in Embree's own watertight test; its default mode leaks there.",
        "Embree, verify.cpp, watertight tests, run in robust mode only";
    Moderate 16 "offset_1e6", Hit => |n| in_sphere(n, Vec3::new(1e6, -1e6, 1e6), 10.0),
        "A slab test of the form bound * inverse - origin * inverse cancels far from zero.",
        "Embree, node_intersector1.h; madmann91/bvh, intersect_fast";
    Moderate 17 "offset_1e7", Hit => |n| in_sphere(n, Vec3::new(-1e7, 1e7, 1e7), 100.0),
        "One ulp is one unit here: coordinates of rays, boxes and planes often coincide.",
        "measured: truncating the near interval at a plane through the origin lost 2 to 27 % of the rays";

    // Very small and very large scenes. Very short, very long and nearly axis-aligned directions.
    Extreme 18 "scale_1e-40", Hit => |n| scaled(n, 1e-40),
        "Coordinates are denormal: every product of two of them is zero.", MISSED;
    Extreme 19 "scale_1e-30", Hit => |n| scaled(n, 1e-30),
        "Products of two lengths underflow to zero.", MISSED;
    Extreme 20 "scale_1e-20", Hit => |n| scaled(n, 1e-20),
        "Products of two lengths are denormal: their digits are lost.", MISSED;
    Moderate 21 "scale_1e-10", Hit => |n| scaled(n, 1e-10),
        "Absolute epsilons on determinants and distances swallow the whole scene.", EPSILONS;
    Moderate 22 "scale_1e-5", Hit => |n| scaled(n, 1e-5),
        "Absolute epsilons on determinants and distances swallow a scene of 1e-5, a scale that models in metres have.",
        EPSILONS;
    Moderate 23 "scale_1e5", Hit => |n| scaled(n, 1e5),
        "Absolute epsilons are too small here to have an effect.", "Wächter, Binder 2019";
    Moderate 23 "scale_1e10", Hit => |n| scaled(n, 1e10),
        "Products of three lengths come near the end of the range.", "Embree, FLT_LARGE";
    Extreme 24 "scale_1e15", Hit => |n| scaled(n, 1e15),
        "Products of three lengths overflow.", OVERFLOW;
    Extreme 25 "scale_1e18", Hit => |n| scaled(n, 1e18),
        "Areas come near the end of the range, products of three lengths overflow.", OVERFLOW;
    Extreme 26 "dirlen_1e-30", Hit => |n| long(n, 1e-30),
        "t is measured in lengths of the direction, which need not be 1: clamps of small components lose the ray.",
        INVERSES;
    Extreme 27 "dirlen_1e-20", Hit => |n| long(n, 1e-20),
        "Squares of the direction underflow, and clamps of small components lose the ray.", INVERSES;
    Moderate 28 "dirlen_1e-10", Hit => |n| long(n, 1e-10),
        "Components of the direction are below the machine epsilon, which some systems treat as zero.", INVERSE;
    Moderate 29 "dirlen_1e-6", Hit => |n| long(n, 1e-6),
        "Only small components of the direction fall below the machine epsilon, so only some rays bend.", INVERSE;
    Moderate 30 "dirlen_1e6", Hit => |n| long(n, 1e6),
        "Hits lie at t of 1e-6: below an absolute bound on box exits.", EPSILON;
    Extreme 31 "dirlen_1e15", Hit => |n| long(n, 1e15),
        "Hits lie at t of 1e-15.", EPSILON;
    Extreme 32 "dirlen_1e30", Hit => |n| long(n, 1e30),
        "Inverses of components are near the end of the range, and the square of the length overflows.",
        "svenstaro/bvh: misses all";
    Moderate 33 "dir_nearly_axis_1e-9", Hit => |n| {
        Set::new(star(), n, 1, |_, s| Ray::new(inside(s), nearly_axis(s, 1e-9)))
    },
        "Two direction components of 1e-9: inverses are huge, and clamps of small components bend the ray.",
        "obvhs, ray.rs, safe_inverse; tinybvh, tinybvh_safercp";
    Moderate 34 "dir_nearly_axis_1e-30", Hit => |n| {
        Set::new(star(), n, 1, |_, s| Ray::new(inside(s), nearly_axis(s, 1e-30)))
    },
        "Two direction components of 1e-30: products with them underflow.",
        "Embree, zero_fix: components below 1e-18 lose their sign";

    // Slivers, needles and fans.
    Moderate 35 "slivers_1e6_axis", Oracle => |n| slivers(n, |p| p),
        "Strips of 1000 x 1e-3 along the axes: a million times longer than wide.",
        "Woop, Benthin, Wald 2013: t is as accurate as the least accurate axis";
    Moderate 36 "slivers_1e6_rot", Oracle => |n| slivers(n, tilted),
        "Tilted strips of 1000 x 1e-3: the f32 normal has no correct digit, and t is off by percents.",
        "Embree, stable_triangle_normal; measured: 36 to 44 % of the depths wrong";
    Moderate 37 "hair_diag", Oracle => |n| {
        Set::new(hair(), n, 13, |mesh, s| ray_to(s.direction() * 8.0, on_surface(mesh, s)))
    },
        "Needles of 2 x 1e-3 along a diagonal: their boxes are almost empty, and all overlap.", "survey";
    Moderate 38 "fan_apex", Hit x 2000 => |n| Set::new(fan(), n, 14, |_, s| ray_to(below(s), Vec3::ZERO)),
        "800 triangles meet in the target vertex: rays hit them at edges, and rounding must not cull their boxes.",
        "obvhs, rt_triangle.rs: seen from behind, 0 times a negative number is -0.0, and counts as outside";
    Moderate 39 "fan_random", Hit => |n| Set::new(fan(), n, 15, |_, s| ray_to(below(s), at_height(s, 0.0) * 0.4)),
        "A fan of 800 triangles; the rays aim next to its apex.", "survey";

    // Triangles that coincide, overlap, have no area or differ much in size. Meshes with at most one triangle.
    Moderate 40 "coincident_1000", Hit x 2000 => |n| Set::new(copies(1000), n, 28, to_copies),
        "A thousand copies of one triangle: the lowest number must win, and no split separates them.",
        "Embree, verify.cpp, overlapping_primitives";
    Moderate 41 "duplicates_20000", Hit x 200 => |n| Set::new(copies(20_000), n, 28, to_copies),
        "Builders that search for nearest neighbours, or split without end, take quadratic time.",
        "obvhs, ploc: 17 to 32 s";
    Moderate 42 "coplanar_overlap_200", Oracle x 2000 => overlapping,
        "Overlapping triangles in one tilted plane: their order is below the rounding of t.", "survey";
    Moderate 43 "huge_tri_1e6", Oracle => |n| {
        Set::new(huge_and_small(), n, 30, |_, s| ray_to(s.direction() * 4.0, s.cube()))
    },
        "One triangle a million times the size of the scene: it dominates every bound and every cost.", "survey";
    Moderate 44 "teapot_in_stadium_1e5", Hit => stadium,
        "A teapot in a stadium a hundred thousand times its size, seen from the seats: boxes are below the rounding \
         of t.",
        "folklore of spatial subdivision; survey";
    Moderate 45 "degenerate_half", Oracle => |n| Set::new(half_without_area(2000), n, 20, to_surface),
        "Half of the triangles are points, needles or have a double corner: hits must equal the hits without them.",
        "tests of obvhs and Embree on degenerate input";
    Moderate 46 "one_triangle", Hit => |n| Set::new(copies(1), n, 31, to_copies), "The root is a leaf.", "survey";
    Moderate 47 "one_triangle_vertex_edge", Hit => |n| Set::new(mesh([SIMPLE]), n, 32, exactly_on_the_rim),
        "Rays through the exact vertices and edges of a single triangle, which is closed.",
        "Woop, Benthin, Wald 2013: no promise for the rim of an open mesh";
    Unranked 48 "empty", Miss => |n| Set::new(mesh([]), n, 33, |_, s| Ray::new(s.cube(), s.direction())),
        "No triangle at all: no root box, no node, no hit, no panic.",
        "kdtree-ray: asserts; Embree, verify.cpp, empty_scene";

    // Distant origins, triangles of very different sizes, and triangles that no split separates.
    Moderate 49 "far_1e3", Oracle => |n| Set::new(star_times(0.3), n, 36, |mesh, s| from_afar(mesh, s, 1e3)),
        "From 1e3 away: the boxes of thin leaves are a few ulps of t deep.", "Ize 2013";
    Moderate 50 "far_1e6", Oracle => |n| Set::new(star_times(0.3), n, 36, |mesh, s| from_afar(mesh, s, 1e6)),
        "From 1e6 away: entry and exit of most boxes are the same float.", "Ize 2013";
    Extreme 51 "far_1e8", Oracle => |n| Set::new(star_times(0.3), n, 36, |mesh, s| from_afar(mesh, s, 1e8)),
        "From 1e8 away: the scene is smaller than an ulp of t.", "Ize 2013";
    Moderate 52 "shells_nested_in", Hit => |n| Set::new(shells(), n, 34, among_shells),
        "Nested octahedra from 2^-30 to 2^30, seen from between them: the next octahedron must be hit, even if it is \
         nearer than any absolute epsilon.",
        "obvhs, CwBvh node.rs EPSILON";
    Moderate 53 "shells_nested_out", Hit => |n| Set::new(shells(), n, 35, around_shells),
        "Octahedra from 2^-30 to 2^30 around zero, seen from outside: the outermost must be hit.",
        "survey";
    Moderate 54 "same_centroid_2000", Oracle => |n| Set::new(same_centroid(2000), n, 21, to_surface),
        "All centroids in one point: a median split separates nothing and must stop.",
        "Hapala, Havran 2011; bvh crates with a fixed stack";
    Moderate 55 "exp_sequence_1.3", Hit => |n| Set::new(moved(&exponential(300), |p| p * 1e16), n, 38, through_smaller),
        "Each of 300 triangles is 1.3 times as large as the one before: trees become chains, fixed stacks overflow.",
        "svenstaro/bvh, iter.rs: a stack of 32 panics";
    Moderate 56 "needle_stack_kd", Oracle => |n| {
        Set::new(needles(2200), n, 16, |_, s| ray_to(s.direction() * 12.0, s.cube() * 3.0))
    },
        "Needles that cross in one place: no plane separates them, and every split doubles references.",
        "pbrt-v4, kd-tree: bad refines; Wald, Havran 2006";
    Unranked 57 "nonfinite_verts", Oracle => |n| {
        Set::new(largest_numbers(), n, 40, |_, s| ray_to(s.direction() * 3.0, s.cube()))
    },
        "Mesh::new rejects vertices that are NaN or infinite, so no structure receives one; this is the worst that it \
         accepts: some vertices at the largest float, which makes extents and areas infinite.",
        "obvhs, ploc, and svenstaro/bvh, bvh_node.rs: builders panic";

    // Ends of ray intervals, and rays that begin on a surface.
    Unranked 58 "tmin_tmax_window", Hit => |n| Set::new(sphere(), n, 54, window),
        "Intervals that hold only the first, or only the second crossing of a sphere.", "parry: has no t_min";
    Unranked 59 "tmax_exact_hit", Miss => |n| Set::new(box_grid(4), n, 51, |_, s| to_the_lid(s, |t| (0.0, t))),
        "The only hit is exactly at t_max: the interval is half-open, so there is no hit. Other systems close it.",
        "Embree, CHANGELOG: robust mode is closed; obvhs half-open, as here";
    Unranked 60 "tmin_exact_hit", Hit => |n| Set::new(box_grid(4), n, 51, |_, s| to_the_lid(s, |t| (t, f32::INFINITY))),
        "The only hit is exactly at t_min, which is in the interval. Other systems exclude it.",
        "Embree, default mode: T > tnear";
    Moderate 61 "tiny_t_near_surface", Hit => |n| Set::new(sheet(32), n, 50, just_above),
        "From 1e-1 to 1e-7 above a surface: absolute epsilons lose the nearest hits.",
        "obvhs, CwBvh node.rs EPSILON = 1e-4";
    Unranked 62 "origin_on_surface", Hit => |n| {
        let lower = moved(&sheet(16), |p| p * 4.0 - Vec3::Z);
        Set::new(joined(&sheet(16), &lower), n, 55, |_, s| Ray::new(at_height(s, 0.0), at_height(s, -1.0)))
    },
        "The origin lies exactly on a triangle: the hit at t = 0 must win over the sheet below.",
        "svenstaro/bvh and Embree leave t = 0 out";
    Moderate 63 "origin_in_aabb_face", Oracle => |n| Set::new(soup(2000, 22), n, 52, from_the_root_box),
        "The origin lies in a face of the root box: entry is at t = 0 exactly, and must not count as behind.",
        "Hapala, Havran 2011: the ray's origin in a plane";
    Moderate 64 "soup_random", Oracle => |n| Set::new(soup(2000, 22), n, 22, to_surface),
        "Random triangles and rays, for comparison with the other cases.", "survey";

    // Invalid rays, except in case 72. All invalid rays must miss.
    Unranked 65 "rays_nan_origin", Miss x 1000 => |n| spoilt(n, |s, ray| ray.origin[s.below(3)] = f32::NAN),
        "NaN in the origin: comparisons with it are false, and code that drops NaN walks the whole tree.", TIME;
    Unranked 66 "rays_nan_dir", Miss x 1000 => |n| spoilt(n, |s, ray| ray.direction[s.below(3)] = f32::NAN),
        "NaN in the direction.", TIME;
    Unranked 67 "rays_inf_origin", Miss x 1000 => |n| spoilt(n, |s, ray| ray.origin[s.below(3)] = infinity(s)),
        "An infinite origin: differences are infinite, and differences of infinities are NaN.", TIME;
    Unranked 68 "rays_inf_dir", Miss x 1000 => |n| spoilt(n, |s, ray| ray.direction[s.below(3)] = infinity(s)),
        "An infinite direction component: its inverse is 0, and every t comes out as 0 or NaN.",
        "parry: a hit at t = 0 for every ray";
    Unranked 69 "rays_zero_dir", Miss x 1000 => |n| {
        spoilt(n, |s, ray| ray.direction = Vec3::new(s.zero(), s.zero(), s.zero()))
    },
        "A zero direction: a point inside every box that contains it.",
        "kdtree-ray: 8 times the time; parry, CHANGELOG: clip_aabb_line";
    Unranked 70 "rays_tmin_gt_tmax", Miss x 1000 => |n| spoilt(n, |s, ray| (ray.t_min, ray.t_max) = (2.0, s.unit())),
        "The interval ends before it begins.", "Embree, verify.cpp, inactive_rays";
    Unranked 71 "rays_nan_interval", Miss x 1000 => |n| spoilt(n, spoil_interval),
        "An interval that begins or ends at NaN.", TIME;
    Added 72 "secondary_rays", Oracle => |n| Set::new(sphere(), n, 53, off_a_sphere),
        "Rays that leave a surface at a rounded point: half of the points lie below it, so the ray hits it again.",
        "Wächter, Binder 2019; pbrt-v4, Triangle.Reintersect";

    // Further cases, which the survey did not measure.
    Added 73 "continuation", Property => continuation,
        "Continuing behind each hit must visit every crossing of a ray once.",
        "Embree, verify.cpp, sphere_filter_multi_hit";
    Added 74 "parity", Property => parity,
        "A ray from outside crosses a closed surface an even number of times.",
        "survey: volume and point-in-solid tests depend on it";
    Added 75 "metamorphic", Property => metamorphic,
        "Reordered and mirrored scenes keep t, and scaling by a power of two scales t; rotated, moved and cut scenes \
         keep t if the arithmetic is exact.",
        "survey: finds errors that a comparison with the same triangle test cannot find";
    Added 76 "any_equals_closest", Property => any_equals_closest,
        "Any hit has its own loop in most systems, with its own bugs.", "pbrt-v4: a second copy of the loop";
    Added 77 "batch_equals_single", Property => batch_equals_single,
        "Packets and batches must return the hits of single rays.",
        "Embree, verify.cpp: the same tests for every packet size";
    Added 78 "zfighting_ulp_copies", Oracle x 2000 => |n| Set::new(ulp_copies(), n, 24, to_surface),
        "Copies one ulp apart: the order is below the rounding of t.", "survey";
    Added 79 "planar_in_split_plane", Oracle => |n| {
        Set::new(moved(&sheet(32), |p| Vec3::new(0.5, p.x, p.y)), n, 9, from_split_plane)
    },
        "All triangles lie in the only plane across x that can split, and belong to neither side.",
        "Wald, Havran 2006: planar triangles on either side; Hapala, Havran 2011";
    Added 80 "collinear_line", Oracle => |n| Set::new(line(), n, 25, to_line),
        "Boxes without extent in one or two axes: a half area of 0 divides by zero in cost models.",
        "Wald, Havran 2006; Hapala, Havran 2011";
    Added 81 "sizes_0_to_40", Property => sizes,
        "Zero to three triangles and all leaf sizes: blocks and nodes are partly filled.", "survey";
    Added 82 "median_matches_heavy", Oracle => |n| Set::new(mostly_centred(), n, 27, to_surface),
        "More than half of the centroids equal the median: both sides of the split must get fewer triangles.",
        "the report's own median tree; survey";
    Added 83 "deep_chain", Hit => |n| Set::new(deep_chain(), n, 41, along_chain),
        "A triangle at every power of two from 2^-60 to 2^60: halving the box separates one at a time, deeper than \
         64.",
        "stacks of 32 or 64 entries in svenstaro/bvh and pbrt-v4";
    Added 84 "limits", Property => limits,
        "References and depth must stay bounded if no plane separates the triangles, or memory runs out.",
        "pbrt-v4, kd-tree: depth 8 + 1.3 log2 N and bad refines; Embree, regression with failing allocations";

    // Failures that were found with this crate.
    Added 85 "scale_7e-15", Hit => in_tiny_star,
        "Products of three lengths underflow, products of two do not: a bound on one does not bound the other.",
        "sahara, the first stage of the exact test";
    Added 86 "origins_near_the_largest", Oracle => |n| Set::new(star_times(5e36), n, 61, from_the_largest),
        "The distance from the origin to a plane overflows, though the ray crosses it at t near 3.",
        "sahara, crossings of planes";
    Added 87 "beside_a_sliver", Oracle => |n| along_edges(
        n, 62,
        [[0.0, 0.2331, 0.0], [1.0, 0.2341, 1.0], [1.0, 0.2331, 1.0001]],
        [[1.0529697, 0.79743576, 2.6935759], [-0.052969694, -0.5633358, -1.6935759]],
        |s, target| ray_to(target + s.cube(), target),
    ),
        "Rays miss a sliver of 1 to 10,000 by less than f64 can resolve; this distance grows with the aspect ratio.",
        "an independent check: a hit 4.5e-11 outside, although an f64 test promised 1e-15";
    Added 88 "along_a_needle", Oracle => |n| along_edges(
        n, 63,
        [[249066.56, -560805.06, -789597.4], [-249066.31, 560804.8, 789596.9], [-224159.67, 504724.3, 710637.2]],
        [[-0.41515878, 0.8378415, 1.5203968], [-5957.0234, 13413.253, 18885.059]],
        along_needle,
    ),
        "A needle of 1 to 10,000,000, hit along its length: f64 has no correct digit of the determinant.",
        "an independent check: a hit that a test in f64 loses";
    Added 89 "depth_on_a_needle", Oracle => |n| along_edges(
        n, 64,
        [[-405851.38, 785724.8, -466819.28], [405851.56, -785725.3, 466820.28], [365266.44, -707152.8, 420138.3]],
        [[49.000397, -704.82355, 176.40697], [-9731.703, 19450.404, -11313.292]],
        along_needle,
    ),
        "A needle grazed at a sine of 5e-3: t keeps only half of the digits of f64, a loss that a tolerance of 1 % \
         hides.",
        "an independent check: t of a test in f64 115 ulps off";
    Added 90 "t_rounds_to_t_max", Hit => |n| Set::new(star(), n, 65, before_the_end),
        "The exact t is below t_max and rounds to it, half of the time near the largest float, where crossings \
         overflow.",
        "a user's ray: both KD-trees lost a hit just before t_max = 3.4028235e38";
    Added 91 "straight_down", Property => straight_down,
        "Rays in the planes of many boxes, through shared corners: a slab distance of 0 x infinity is not a number.", "a user's BVH";
    Added 92 "stacked_sheets", Oracle => |n| {
        Set::new(sheets(8192), n, 66, |_, s| ray_to(s.direction() * 12.0, s.cube()))
    },
        "A ray crosses the boxes of thousands of sheets: the stack must hold a node for each level of the tree.",
        "a user's BVH, with a stack of ten";
}
