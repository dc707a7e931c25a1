//! One step of Catmull-Clark subdivision.

use std::collections::HashMap;

use glam::DVec3;

#[derive(Clone, Copy, Default)]
struct Around {
    faces: f64,
    face_points: DVec3,
    neighbours: DVec3,
    boundary_neighbours: DVec3,
    boundary: bool,
}

struct Edge {
    ends: [u32; 2],
    faces: u32,
    face_points: DVec3,
}

/// The new points are the moved vertices, the edge points and the face points, in this order. The boundary is
/// subdivided as a cubic B-spline.
///
/// # References
/// Catmull, Clark: Recursively generated B-spline surfaces on arbitrary topological meshes (1978).
pub fn subdivide(points: &[DVec3], faces: &[Vec<u32>]) -> (Vec<DVec3>, Vec<[u32; 4]>) {
    let point = |i: u32| points[i as usize];
    let middle = |face: &Vec<u32>| face.iter().map(|&i| point(i)).sum::<DVec3>() / face.len() as f64;
    let face_points: Vec<DVec3> = faces.iter().map(middle).collect();

    let mut numbers = HashMap::new();
    let mut edges: Vec<Edge> = Vec::new();
    let mut around = vec![Around::default(); points.len()];
    for (face, &face_point) in faces.iter().zip(&face_points) {
        for ends in sides(face) {
            let number = *numbers.entry(key(ends)).or_insert(edges.len());
            if number == edges.len() {
                edges.push(Edge { ends, faces: 0, face_points: DVec3::ZERO });
            }
            let edge = &mut edges[number];
            edge.faces += 1;
            edge.face_points += face_point;
            let vertex = &mut around[ends[0] as usize];
            vertex.faces += 1.0;
            vertex.face_points += face_point;
        }
    }
    for edge in &edges {
        for [from, to] in [edge.ends, [edge.ends[1], edge.ends[0]]] {
            let vertex = &mut around[from as usize];
            vertex.neighbours += point(to);
            if edge.faces == 1 {
                vertex.boundary = true;
                vertex.boundary_neighbours += point(to);
            }
        }
    }

    // An inner vertex has as many neighbours as faces.
    let vertex_point = |(p, a): (&DVec3, &Around)| {
        if a.boundary {
            return *p * 0.75 + a.boundary_neighbours * 0.125;
        }
        let edge_middles = (*p * a.faces + a.neighbours) / 2.0;
        (a.face_points / a.faces + edge_middles * (2.0 / a.faces) + *p * (a.faces - 3.0)) / a.faces
    };
    let edge_point = |edge: &Edge| {
        let ends = point(edge.ends[0]) + point(edge.ends[1]);
        if edge.faces == 1 { ends / 2.0 } else { (ends + edge.face_points) / 4.0 }
    };
    let mut new_points: Vec<DVec3> = points.iter().zip(&around).map(vertex_point).collect();
    new_points.extend(edges.iter().map(edge_point));
    new_points.extend(&face_points);

    let first_face = points.len() + edges.len();
    let mut quads = Vec::new();
    for (number, face) in faces.iter().enumerate() {
        let middles: Vec<u32> = sides(face).map(|ends| (points.len() + numbers[&key(ends)]) as u32).collect();
        for (corner, &vertex) in face.iter().enumerate() {
            let before = middles[(corner + face.len() - 1) % face.len()];
            quads.push([vertex, middles[corner], (first_face + number) as u32, before]);
        }
    }
    (new_points, quads)
}

fn sides(face: &[u32]) -> impl Iterator<Item = [u32; 2]> + '_ {
    face.iter().copied().zip(face.iter().copied().cycle().skip(1)).map(|(a, b)| [a, b])
}

fn key([a, b]: [u32; 2]) -> (u32, u32) {
    (a.min(b), a.max(b))
}
