//! Factors of a product as bars side by side: on a logarithmic axis their lengths add up to the whole.

use plotters::prelude::DrawingBackend;
use plotters::style::text_anchor::HPos;

use super::axes::{self, height_with_legend, legend};
use super::canvas::{Canvas, DrawResult, TEXT, width_of};
use super::palette::{Colour, INK, PAPER, PARTS};
use super::rows::{RowAxes, Rows, with_intervals};
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

/// Height of a row and of its bar.
const ROW: [i32; 2] = [88, 48];

/// Above the rows.
const TOP: i32 = 8;

/// The colour of a part, and of text on it.
fn colours(part: usize) -> [Colour; 2] {
    let part = part % PARTS.len();
    [PARTS[part].light, if part == PARTS.len() - 1 { INK.light } else { PAPER.light }]
}

impl Stack {
    fn labels(&self) -> Vec<String> {
        self.rows.iter().map(|row| row.label.clone()).collect()
    }

    /// Height of the drawing where it is `width` wide.
    pub fn height(&self, width: i32) -> i32 {
        let rows = Rows::new(&self.labels(), ROW, width).height();
        height_with_legend(TOP + rows + axes::BOTTOM, self.parts.len(), width)
    }

    pub fn draw<B: DrawingBackend>(&self, canvas: &Canvas<B>, width: i32) -> DrawResult<B> {
        let labels = self.labels();
        let names = self.parts.iter().enumerate().map(|(part, name)| (name.clone(), colours(part)[0]));
        let area = legend(&canvas.area, &names.collect::<Vec<_>>())?;
        let rows = Rows::new(&labels, ROW, width);
        // The legend may make the drawing higher than the rows are.
        let (area, _) = area.split_vertically(TOP + rows.height() + axes::BOTTOM);
        let [low, high] = self.ends();
        let axes = rows.axes(canvas, &area, [low, 1.0, high], (rows.left, TOP, &self.x_title))?;
        for (i, row) in self.rows.iter().enumerate() {
            self.draw_row(canvas, &axes, i, row)?;
        }
        Ok(())
    }

    /// Ends of the axis. Parts below 1 take from the whole: they stand to the left of 1.
    fn ends(&self) -> [f64; 2] {
        let reach = |row: &StackRow| {
            let low: f64 = row.factors.iter().filter(|f| **f < 1.0).product();
            let high: f64 = row.factors.iter().filter(|f| **f > 1.0).product();
            [low.min(row.total.estimate), high.max(row.total.estimate)]
        };
        let ends = self.rows.iter().map(reach).fold([1.0f64, 1.5f64], |a, b| [a[0].min(b[0]), a[1].max(b[1])]);
        with_intervals(ends, self.rows.iter().map(|row| row.total))
    }

    fn draw_row<B: DrawingBackend>(
        &self,
        canvas: &Canvas<B>,
        axes: &RowAxes<B>,
        i: usize,
        row: &StackRow,
    ) -> DrawResult<B> {
        // The whole below its parts, which it must equal within its interval.
        let end = row.factors.iter().filter(|f| **f > 1.0).product::<f64>().max(row.total.estimate);
        let told = format!("{}, the whole: {} times", row.label, interval(row.total));
        axes.value(i, row.total, ROW[1] / 2 + 10, end, told)?;
        let (mut up, mut down) = (1.0, 1.0);
        for (part, &factor) in row.factors.iter().enumerate() {
            let side = if factor >= 1.0 { &mut up } else { &mut down };
            let ends = [*side, *side * factor];
            *side = ends[1];
            let [colour, on_it] = colours(part);
            let [min, max] = axes.bar(i, ends, colour)?;
            let text = figures(factor);
            canvas.tip(min, max, format!("{}, {}: {text} times", row.label, self.parts[part]));
            if width_of(&text, TEXT) + 16 < max.0 - min.0 {
                axes.text(i, (libm::sqrt(ends[0] * ends[1]), 0), &text, on_it, HPos::Center)?;
            }
        }
        Ok(())
    }
}
