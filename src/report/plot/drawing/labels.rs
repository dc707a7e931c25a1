//! Places labels of points: none covers another label or a point. plotters does not place labels.

use super::canvas::Place;

/// The top left and the bottom right corner of a box.
pub type Corners = [Place; 2];

fn meet(a: &Corners, b: &Corners) -> bool {
    a[0].0 < b[1].0 && b[0].0 < a[1].0 && a[0].1 < b[1].1 && b[0].1 < a[1].1
}

fn is_inside(a: &Corners, b: &Corners) -> bool {
    a[0].0 >= b[0].0 && a[0].1 >= b[0].1 && a[1].0 <= b[1].0 && a[1].1 <= b[1].1
}

/// Distance between a point and its label.
const GAP: i32 = 22;

/// Boxes `height` high for labels of these widths, in order, within `frame`: beside the point if there is space,
/// otherwise as near as possible. They avoid each other and the obstacles as long as there is another place.
pub fn place(points: &[(Place, i32)], height: i32, obstacles: &[Corners], frame: Corners) -> Vec<Corners> {
    let mut taken = obstacles.to_vec();
    for &((x, y), width) in points {
        // To the right and to the left, then increasingly higher and lower, by half lines; further away as well.
        let steps = (0..40).flat_map(|i| [-i, i]).map(|i| i * height / 2);
        let lefts = [x + GAP, x - GAP - width, x + GAP + 60, x - GAP - 60 - width, x - width / 2];
        let corners = |left: i32, step: i32| [(left, y + step - height / 2), (left + width, y + step + height / 2)];
        let mut places = steps.flat_map(|step| lefts.map(|left| corners(left, step)));
        let is_free = |place: &Corners| is_inside(place, &frame) && !taken.iter().any(|other| meet(place, other));
        let free = places.find(is_free).unwrap_or(corners(lefts[0], 0));
        taken.push(free);
    }
    taken.split_off(obstacles.len())
}

#[cfg(test)]
mod tests {
    use super::*;

    const FRAME: Corners = [(0, 0), (1600, 800)];

    #[test]
    fn labels_of_points_in_a_heap_do_not_cover_each_other() {
        let points: Vec<(Place, i32)> = (0..24).map(|i| ((800 + 2 * (i % 5), 400 + 2 * (i / 5)), 240)).collect();
        let obstacles: Vec<Corners> = points.iter().map(|&((x, y), _)| [(x - 12, y - 12), (x + 12, y + 12)]).collect();
        let placed = place(&points, 30, &obstacles, FRAME);
        for (i, label) in placed.iter().enumerate() {
            assert!(is_inside(label, &FRAME));
            assert!(placed[..i].iter().chain(&obstacles).all(|other| !meet(label, other)), "{i}: {label:?}");
        }
    }
}
