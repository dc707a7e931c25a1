//! What cannot be bettered in one respect without losing in the other.

/// For each point (cost, error), the point of the front that dominates it: at most as costly and at most as wrong, and
/// better in one of the two; of several, the cheapest. Nothing for the points of the front.
///
/// # References
/// Kung, Luccio, Preparata: On finding the maxima of a set of vectors. J. ACM 22, 1975.
pub fn dominators(points: &[(f64, f64)]) -> Vec<Option<usize>> {
    let dominates = |a: (f64, f64), b: (f64, f64)| a.0 <= b.0 && a.1 <= b.1 && a != b;
    let is_front = |i: usize| !points.iter().any(|&other| dominates(other, points[i]));
    let front: Vec<usize> = (0..points.len()).filter(|&i| is_front(i)).collect();
    let cheapest = |point: (f64, f64)| {
        let dominating = front.iter().copied().filter(|&i| dominates(points[i], point));
        dominating.min_by(|&a, &b| points[a].0.total_cmp(&points[b].0))
    };
    points.iter().map(|&point| cheapest(point)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_front_is_what_nothing_dominates() {
        let points = [(1.0, 0.5), (2.0, 0.1), (3.0, 0.1), (3.0, 0.6), (9.0, 0.0), (1.0, 0.5)];
        assert_eq!(dominators(&points), [None, None, Some(1), Some(0), None, None]);
        assert_eq!(dominators(&[]), []);
    }
}
