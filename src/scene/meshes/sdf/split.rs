//! Refines a closed mesh to an exact number of triangles.

use crate::scene::Model;

/// Splits the longest edges at their middles until there are exactly `count` triangles.
///
/// A split adds two triangles, so `count` must be even and not below the present number. Among equal edges the first
/// one is split.
///
/// # Panics
/// If the mesh has more than `count` triangles, or the difference is odd.
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

/// Splits at most `limit` edges, the longest first, no two of them in one triangle.
fn split_longest(model: &mut Model, limit: usize) {
    // Find both triangles of every edge: sorting puts the two half-edges next to each other.
    let mut halves = Vec::with_capacity(3 * model.triangles.len());
    for (t, triangle) in model.triangles.iter().enumerate() {
        for i in 0..3 {
            let (a, b) = (triangle[i], triangle[(i + 1) % 3]);
            halves.push((a.min(b), a.max(b), t as u32));
        }
    }
    halves.sort_unstable();
    let length = |a: u32, b: u32| model.positions[a as usize].distance_squared(model.positions[b as usize]);
    let mut edges: Vec<_> =
        halves.chunks_exact(2).map(|h| (length(h[0].0, h[0].1), h[0].0, h[0].1, [h[0].2, h[1].2])).collect();
    edges.sort_unstable_by(|x, y| y.0.total_cmp(&x.0).then((x.1, x.2).cmp(&(y.1, y.2))));

    let mut used = vec![false; model.triangles.len()];
    let mut left = limit;
    for (_, a, b, both) in edges {
        if left == 0 {
            break;
        }
        if both.iter().any(|&t| used[t as usize]) {
            continue;
        }
        left -= 1;
        let middle = model.positions.len() as u32;
        let [pa, pb] = [a, b].map(|i| model.positions[i as usize]);
        let normal = (model.normals[a as usize] + model.normals[b as usize]).normalize_or(model.normals[a as usize]);
        model.positions.push((pa + pb) * 0.5);
        model.normals.push(normal);
        for t in both {
            used[t as usize] = true;
            let old = model.triangles[t as usize];
            model.triangles[t as usize] = old.map(|v| if v == b { middle } else { v });
            model.triangles.push(old.map(|v| if v == a { middle } else { v }));
        }
    }
}
