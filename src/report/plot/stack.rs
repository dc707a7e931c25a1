//! Factors of a product as bars side by side: on a logarithmic axis their lengths add up to the whole.

use super::bars::{upright_ticks, whisker, with_intervals};
use super::canvas::{self, Canvas, Side};
use super::labels::{self, BarLabels};
use super::palette::{Colour, INK, MIDDLE, PAPER, PARTS};
use super::scale::{Axis, Scale};
use crate::measure::Estimate;
use crate::report::number::figures;
use crate::report::words::interval;

/// Products of the same factors.
#[derive(Clone, Debug, PartialEq)]
pub struct Stack {
    pub x_title: String,
    /// Names of the factors.
    pub parts: Vec<String>,
    pub rows: Vec<StackRow>,
}

/// One product.
#[derive(Clone, Debug, PartialEq)]
pub struct StackRow {
    pub label: String,
    /// One positive factor for each part.
    pub factors: Vec<f64>,
    /// The whole.
    pub total: Estimate,
}

const ROW: f64 = 44.0;
const BAR: f64 = 24.0;
const LEGEND: f64 = 24.0;
const FOOT: f64 = 50.0;

/// The colour of a part, and of text on it.
fn colours(part: usize) -> [Colour; 2] {
    let [paper, ink] = [PAPER.light, INK.light];
    let part = part % PARTS.len();
    [PARTS[part].light, if part == PARTS.len() - 1 { ink } else { paper }]
}

impl Stack {
    /// Height of the drawing where it is `width` wide.
    pub(super) fn height(&self, width: f64) -> f64 {
        self.top(width) + self.rows.len() as f64 * self.row(width) + FOOT
    }

    /// Where the names of the parts stand: as many in a line as there is room for.
    fn legend(&self, width: f64) -> Vec<[f64; 2]> {
        let widths = self.parts.iter().map(|name| 20.0 + canvas::width_of(name, canvas::SMALL));
        labels::legend(widths, 20.0, width, LEGEND)
    }

    fn labels(&self, width: f64) -> BarLabels {
        BarLabels::of(self.rows.iter().map(|row| &row.label), width)
    }

    /// Height of a bar with what is above it.
    fn row(&self, width: f64) -> f64 {
        ROW + self.labels(width).height()
    }

    /// Where the rows begin.
    fn top(&self, width: f64) -> f64 {
        self.legend(width).last().map_or(0.0, |place| place[1] + LEGEND * 0.5) + 8.0
    }

    pub(super) fn draw(&self, canvas: &Canvas, width: f64) {
        let top = self.top(width);
        for (part, [x, y]) in self.legend(width).into_iter().enumerate() {
            canvas.rect([x, y - 6.0], [x + 12.0, y + 6.0], colours(part)[0]);
            canvas.text(&self.parts[part], [x + 20.0, y], canvas::SMALL, INK.light, Side::Left);
        }
        let (labels, height) = (self.labels(width), self.row(width));
        let left = labels.left();
        // Parts below 1 take from the whole: they stand to the left of 1.
        let reach = |row: &StackRow| {
            let low: f64 = row.factors.iter().filter(|f| **f < 1.0).product();
            let high: f64 = row.factors.iter().filter(|f| **f > 1.0).product();
            [low.min(row.total.estimate), high.max(row.total.estimate)]
        };
        let ends = self.rows.iter().map(reach).fold([1.0f64, 1.5f64], |a, b| [a[0].min(b[0]), a[1].max(b[1])]);
        let ends = with_intervals(ends, self.rows.iter().map(|row| row.total));
        let axis = Axis::new(Scale::Log, ends, [left, width - 64.0]);
        let bottom = top + self.rows.len() as f64 * height;
        upright_ticks(canvas, axis, [top, bottom]);
        for (i, row) in self.rows.iter().enumerate() {
            let y = top + (i + 1) as f64 * height - ROW * 0.5;
            match labels {
                BarLabels::Above => canvas.text(&row.label, [0.0, y - ROW * 0.5], canvas::BODY, INK.light, Side::Left),
                BarLabels::Beside(_) => canvas.text(&row.label, [left - 12.0, y], canvas::BODY, INK.light, Side::Right),
            }
            self.draw_row(canvas, row, axis, y);
        }
        let one = axis.place(1.0);
        canvas.line(&[[one, top], [one, bottom]], MIDDLE.light, 1.5);
        let middle = (left + width) * 0.5;
        canvas.centred(&self.x_title, [middle, bottom + 36.0], canvas::SMALL, MIDDLE.light, width);
    }

    fn draw_row(&self, canvas: &Canvas, row: &StackRow, axis: Axis, y: f64) {
        let (mut up, mut down) = (1.0, 1.0);
        for (part, &factor) in row.factors.iter().enumerate() {
            let side = if factor >= 1.0 { &mut up } else { &mut down };
            let [a, b] = [axis.place(*side), axis.place(*side * factor)];
            *side *= factor;
            let [from, to] = [a.min(b), a.max(b)];
            let [colour, on_it] = colours(part);
            canvas.rect([from, y - BAR / 2.0], [to, y + BAR / 2.0], colour);
            let text = figures(factor);
            let told = format!("{}, {}: {text} times", row.label, self.parts[part]);
            canvas.tip([from, y - BAR / 2.0], [to, y + BAR / 2.0], told);
            if canvas::width_of(&text, canvas::SMALL) + 8.0 < to - from {
                canvas.text(&text, [(from + to) * 0.5, y], canvas::SMALL, on_it, Side::Centre);
            }
        }
        // The whole below its parts, which it must equal within its interval.
        let under = y + BAR / 2.0 + 5.0;
        let to = whisker(canvas, row.total, axis, under);
        let end = axis.place(up).max(axis.place(row.total.estimate)).max(to) + 8.0;
        canvas.text(&figures(row.total.estimate), [end, y], canvas::BODY, INK.light, Side::Left);
        let told = format!("{}, the whole: {} times", row.label, interval(row.total));
        canvas.tip([end - 8.0, y - ROW / 2.0], [end + 60.0, y + ROW / 2.0], told);
    }
}
