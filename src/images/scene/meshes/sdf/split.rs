//! Refines a closed mesh to an exact number of triangles.

use crate::scene::Model;

/// The mesh must be closed. `count` must be even and at least the current number of triangles, or the function panics.
pub fn split_to(model: &mut Model, count: usize) {
    loop {
        let have = model.triangles.len();
        assert!(have <= count && (count - have).is_multiple_of(2), "cannot split {have} triangles into {count}");
        if have == count {
            return;
        }
        split_longest(model, (count - have) / 2);
    }
}

/// Splits the longest edges first, at most one edge per triangle. Vertex numbers break ties.
fn split_longest(model: &mut Model, limit: usize) {
    // After sorting, the two half-edges of an edge are adjacent.
    let mut halves = Vec::with_capacity(3 * model.triangles.len());
    for (t, &[a, b, c]) in (0..).zip(&model.triangles) {
        halves.extend([(a, b), (b, c), (c, a)].map(|(p, q)| (p.min(q), p.max(q), t)));
    }
    halves.sort_unstable();
    let length = |a: u32, b: u32| model.positions[a as usize].distance_squared(model.positions[b as usize]);
    let edge = |[(a, b, t), (.., u)]: &[(u32, u32, usize); 2]| (length(*a, *b), *a, *b, [*t, *u]);
    let mut edges: Vec<_> = halves.as_chunks().0.iter().map(edge).collect();
    edges.sort_unstable_by(|x, y| y.0.total_cmp(&x.0).then((x.1, x.2).cmp(&(y.1, y.2))));

    let mut used = vec![false; model.triangles.len()];
    let mut splits = 0;
    for (_, a, b, both) in edges {
        if splits == limit || both.iter().any(|&t| used[t]) {
            continue;
        }
        splits += 1;
        let middle = model.positions.len() as u32;
        let [pa, pb] = [a, b].map(|i| model.positions[i as usize]);
        let normal = (model.normals[a as usize] + model.normals[b as usize]).normalize_or(model.normals[a as usize]);
        model.positions.push((pa + pb) * 0.5);
        model.normals.push(normal);
        for t in both {
            used[t] = true;
            let old = model.triangles[t];
            model.triangles[t] = old.map(|v| if v == b { middle } else { v });
            model.triangles.push(old.map(|v| if v == a { middle } else { v }));
        }
    }
}
