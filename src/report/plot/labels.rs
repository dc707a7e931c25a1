//! Where labels of points go, so that none covers another or a point. Plotters has nothing for it.

/// A box by its top left and bottom right corner, in pixels.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rect {
    pub min: [f64; 2],
    pub max: [f64; 2],
}

impl Rect {
    pub fn around(centre: [f64; 2], half: [f64; 2]) -> Self {
        Self { min: [centre[0] - half[0], centre[1] - half[1]], max: [centre[0] + half[0], centre[1] + half[1]] }
    }

    /// The area that two boxes share.
    pub fn overlap(&self, other: &Self) -> f64 {
        let side = |i: usize| (self.max[i].min(other.max[i]) - self.min[i].max(other.min[i])).max(0.0);
        side(0) * side(1)
    }

    fn is_inside(&self, other: &Self) -> bool {
        (0..2).all(|i| other.min[i] <= self.min[i] && self.max[i] <= other.max[i])
    }

    /// How far a point is from the box.
    pub fn distance(&self, point: [f64; 2]) -> f64 {
        let gap = |i: usize| (self.min[i] - point[i]).max(point[i] - self.max[i]).max(0.0);
        libm::hypot(gap(0), gap(1))
    }
}

/// Between a point and its label.
const GAP: f64 = 22.0;

/// A place for the label of each point, in order, within `frame`: beside the point where that is free, else as near as
/// possible. `obstacles` are never covered while there is another place. Labels are `sizes`, width and height, large.
pub fn place(points: &[[f64; 2]], sizes: &[[f64; 2]], obstacles: &[Rect], frame: Rect) -> Vec<Rect> {
    let mut placed: Vec<Rect> = vec![];
    for (&point, &[width, height]) in points.iter().zip(sizes) {
        let covered = |rect: &Rect| obstacles.iter().chain(&placed).map(|other| rect.overlap(other)).sum::<f64>();
        let half = [width * 0.5, height * 0.5];
        // To the right, to the left, above and below, then ever higher and lower, by half lines.
        let steps = (0..40).flat_map(|i| [-0.5 * f64::from(i), 0.5 * f64::from(i)]);
        let beside = steps.flat_map(|step| {
            let [x, y] = [point[0], point[1] + step * height];
            let shift = GAP + half[0];
            [[x + shift, y], [x - shift, y], [x + shift + 60.0, y], [x - shift - 60.0, y], [x, y]]
        });
        let candidates: Vec<Rect> = beside
            .map(|centre| Rect::around(centre, half))
            .filter(|rect| rect.is_inside(&frame) && rect.distance(point) > 0.999 * GAP)
            .collect();
        // A label that covers something is worse than one that is anywhere else.
        let cost = |rect: &Rect| (covered(rect), rect.distance(point));
        let best = candidates.into_iter().min_by(|a, b| {
            let ((a_covered, a_far), (b_covered, b_far)) = (cost(a), cost(b));
            a_covered.total_cmp(&b_covered).then(a_far.total_cmp(&b_far))
        });
        placed.push(best.unwrap_or(Rect::around(point, half)));
    }
    placed
}

#[cfg(test)]
mod tests {
    use super::*;

    const FRAME: Rect = Rect { min: [0.0, 0.0], max: [1600.0, 800.0] };

    #[test]
    fn a_lone_label_is_to_the_right_of_its_point_or_where_there_is_room() {
        let size = [120.0, 20.0];
        assert_eq!(place(&[[200.0, 100.0]], &[size], &[], FRAME)[0].min, [200.0 + GAP, 90.0]);
        assert_eq!(place(&[[1580.0, 100.0]], &[size], &[], FRAME)[0].max, [1580.0 - GAP, 110.0]);
    }

    #[test]
    fn labels_of_points_in_a_heap_do_not_cover_each_other() {
        let points: Vec<[f64; 2]> =
            (0..24).map(|i| [800.0 + 2.0 * f64::from(i % 5), 400.0 + 2.0 * f64::from(i / 5)]).collect();
        let obstacles: Vec<Rect> = points.iter().map(|&p| Rect::around(p, [12.0, 12.0])).collect();
        let placed = place(&points, &[[240.0, 30.0]; 24], &obstacles, FRAME);
        for (i, rect) in placed.iter().enumerate() {
            assert!(rect.is_inside(&FRAME));
            assert!(placed[..i].iter().chain(&obstacles).all(|other| rect.overlap(other) == 0.0), "{i}: {rect:?}");
        }
    }
}
