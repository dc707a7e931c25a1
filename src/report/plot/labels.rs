//! Where labels go, so that none covers another or a point.

use super::canvas;

/// A box by its top left and bottom right corner.
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
const GAP: f64 = 11.0;

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
            [[x + shift, y], [x - shift, y], [x + shift + 30.0, y], [x - shift - 30.0, y], [x, y]]
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

/// Where the entries of a legend stand, each a mark and a name of these widths: as many in a line as there is room for, lines `height`
/// apart, from the middle of the first one on.
pub fn legend(widths: impl IntoIterator<Item = f64>, gap: f64, width: f64, height: f64) -> Vec<[f64; 2]> {
    let (mut x, mut y) = (0.0, height * 0.5);
    let place = |length: f64| {
        if x > 0.0 && x + length > width {
            (x, y) = (0.0, y + height);
        }
        let place = [x, y];
        x += length + gap;
        place
    };
    widths.into_iter().map(place).collect()
}

/// Where the labels of bars stand.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum BarLabels {
    /// To the left of their bars, in a column of this width.
    Beside(f64),
    /// Each above its bar.
    Above,
}

impl BarLabels {
    /// Those of a drawing `width` wide: above the bars where beside them they would leave the bars less than half of it.
    pub fn of<'a>(labels: impl IntoIterator<Item = &'a String>, width: f64) -> Self {
        let widths = labels.into_iter().map(|label| canvas::width_of(label, canvas::BODY));
        let column = widths.fold(0.0, f64::max) + 12.0;
        if column > width / 2.0 { Self::Above } else { Self::Beside(column) }
    }

    /// Where the bars begin.
    pub fn left(self) -> f64 {
        match self {
            Self::Beside(column) => column,
            Self::Above => 0.0,
        }
    }

    /// What a label adds to the height of its bar.
    pub fn height(self) -> f64 {
        match self {
            Self::Beside(_) => 0.0,
            Self::Above => 17.0,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const FRAME: Rect = Rect { min: [0.0, 0.0], max: [800.0, 400.0] };

    #[test]
    fn a_lone_label_is_to_the_right_of_its_point_or_where_there_is_room() {
        let size = [60.0, 10.0];
        assert_eq!(place(&[[100.0, 50.0]], &[size], &[], FRAME)[0].min, [100.0 + GAP, 45.0]);
        assert_eq!(place(&[[790.0, 50.0]], &[size], &[], FRAME)[0].max, [790.0 - GAP, 55.0]);
    }

    #[test]
    fn labels_of_points_in_a_heap_do_not_cover_each_other() {
        let points: Vec<[f64; 2]> = (0..24).map(|i| [400.0 + f64::from(i % 5), 200.0 + f64::from(i / 5)]).collect();
        let obstacles: Vec<Rect> = points.iter().map(|&p| Rect::around(p, [6.0, 6.0])).collect();
        let placed = place(&points, &[[120.0, 15.0]; 24], &obstacles, FRAME);
        for (i, rect) in placed.iter().enumerate() {
            assert!(rect.is_inside(&FRAME));
            assert!(placed[..i].iter().chain(&obstacles).all(|other| rect.overlap(other) == 0.0), "{i}: {rect:?}");
        }
    }
}
