//! Draws axes and legends.

use std::fmt::Debug;

use plotters::chart::{ChartBuilder, ChartContext};
use plotters::coord::cartesian::Cartesian2d;
use plotters::coord::combinators::{BindKeyPoints, IntoLogRange, LogCoord, WithKeyPoints};
use plotters::coord::ranged1d::{DefaultFormatting, Ranged};
use plotters::element::Circle;
use plotters::prelude::SVGBackend;
use plotters::style::Color;
use plotters::style::text_anchor::HPos;

use super::canvas::{Area, DrawResult, TEXT, text, text_style, widest, width_of};
use super::palette::{Colour, FAINT, INK, MIDDLE};
use crate::report::number::count;

pub type LogAxis = WithKeyPoints<LogCoord<f64>>;

/// Candidate sets of axis labels, as multiples of powers of ten, from dense to sparse.
const FACTORS: [&[f64]; 4] = [&[1.0, 1.5, 2.0, 3.0, 4.0, 5.0, 7.0], &[1.0, 2.0, 5.0], &[1.0, 3.0], &[1.0]];

/// A horizontal axis, `length` pixels long.
pub fn across(ends: [f64; 2], length: i32) -> LogAxis {
    log_axis(ends, length, |tick| width_of(&tick_text(tick)) + 20)
}

/// A vertical axis, `length` pixels long.
pub fn upward(ends: [f64; 2], length: i32) -> LogAxis {
    log_axis(ends, length, |_| 48)
}

/// A logarithmic axis with the densest round numbers that fit. `space` returns the length in pixels that a label needs.
fn log_axis([low, high]: [f64; 2], length: i32, space: impl Fn(f64) -> i32) -> LogAxis {
    let per_decade = f64::from(length) / libm::log10(high / low);
    let exponents = libm::floor(libm::log10(low)) as i32..=libm::floor(libm::log10(high)) as i32;
    // If all sets of `FACTORS` are too dense, try every second power of ten, then every third.
    let between = FACTORS.into_iter().map(|factors| (1, factors));
    let powers = (2..20).map(|step| (step, FACTORS[3]));
    let ticks = |(step, factors): (i32, &[f64])| -> Vec<f64> {
        let exponents = exponents.clone().filter(|exponent| exponent % step == 0);
        let ticks =
            exponents.flat_map(|exponent| factors.iter().map(move |factor| factor * libm::exp10(f64::from(exponent))));
        ticks.filter(|tick| (low..=high).contains(tick)).collect()
    };
    let fit = |ticks: &Vec<f64>| {
        ticks.windows(2).all(|pair| {
            let gap = per_decade * libm::log10(pair[1] / pair[0]);
            gap >= 0.5 * f64::from(space(pair[0]) + space(pair[1]))
        })
    };
    let ticks = between.chain(powers).map(ticks).find(fit).unwrap_or_default();
    (low..high).log_scale().with_key_points(ticks)
}

/// The range of positive `values`, with padding at both ends. Before padding, the high end is at least twice the low
/// end. `below` and `above` are the paddings, as fractions of the logarithmic width.
pub fn padded(values: impl Iterator<Item = f64>, [below, above]: [f64; 2]) -> [f64; 2] {
    let (low, high) = values.fold((f64::INFINITY, 0.0), |(low, high), v| (v.min(low), v.max(high)));
    if low > high {
        return [1.0, 10.0];
    }
    let high = high.max(2.0 * low);
    [low / libm::pow(high / low, below), high * libm::pow(high / low, above)]
}

/// Height in pixels of the labels and the title below a horizontal axis.
pub const BOTTOM: i32 = 96;
pub const BOTTOM_WITHOUT_TITLE: i32 = 52;

pub const GAP: i32 = 20;

pub type Axes<'a, Y = LogAxis> = ChartContext<'a, SVGBackend<'a>, Cartesian2d<LogAxis, Y>>;

/// Lengths are in pixels.
pub struct AxisLabels<'a, V = f64> {
    pub x_title: &'a str,
    pub y_title: &'a str,
    pub y_text: &'a dyn Fn(&V) -> String,
    pub top: i32,
    pub left: i32,
    pub right: i32,
}

pub fn axes<'a, Y>(area: &Area<'a>, x: LogAxis, y: Y, labels: &AxisLabels<Y::ValueType>) -> DrawResult<Axes<'a, Y>>
where
    Y: Ranged<ValueType: Debug, FormatOption = DefaultFormatting>,
{
    let bottom = if labels.x_title.is_empty() { BOTTOM_WITHOUT_TITLE } else { BOTTOM };
    let mut builder = ChartBuilder::on(area);
    builder.margin_left(GAP).margin_top(labels.top).margin_right(labels.right);
    let mut chart = builder.y_label_area_size(labels.left).x_label_area_size(bottom).build_cartesian_2d(x, y)?;
    let x_text = |x: &f64| tick_text(*x);
    let mut mesh = chart.configure_mesh();
    mesh.bold_line_style(FAINT.light.stroke_width(2)).axis_style(MIDDLE.light.stroke_width(2));
    mesh.label_style(text_style(INK.light)).axis_desc_style(text_style(MIDDLE.light));
    mesh.set_all_tick_mark_size(6);
    mesh.x_label_formatter(&x_text).y_label_formatter(labels.y_text);
    mesh.x_desc(labels.x_title).y_desc(labels.y_title).draw()?;
    Ok(chart)
}

pub fn log_log<'a>(
    area: &Area<'a>,
    [x_title, y_title]: [&str; 2],
    [x_ends, y_ends]: [[f64; 2]; 2],
) -> DrawResult<Axes<'a>> {
    let (width, height) = area.dim_in_pixel();
    let y = upward(y_ends, height as i32 - GAP - BOTTOM);
    let texts: Vec<String> = y.bold_points().iter().map(|tick| tick_text(*tick)).collect();
    // The rotated title of the vertical axis is `TEXT` pixels wide.
    let left = widest(&texts) + GAP + TEXT;
    // A label at the right end of the horizontal axis extends beyond the axis.
    let right = 3 * GAP;
    let x = across(x_ends, width as i32 - left - GAP - right);
    axes(area, x, y, &AxisLabels { x_title, y_title, y_text: &|y| tick_text(*y), top: GAP, left, right })
}

/// Height in pixels of a row of the legend.
const LINE: i32 = 40;

pub fn legend_height(names: &[String]) -> i32 {
    if names.is_empty() { 0 } else { names.len() as i32 * LINE + GAP }
}

/// Draws the legend at the bottom of `area`. Returns the area above the legend.
pub fn legend<'a>(area: &Area<'a>, names: &[String], colours: &[Colour]) -> DrawResult<Area<'a>> {
    const DOT: i32 = 8;
    let (axes, below) = area.split_vertically(area.dim_in_pixel().1 as i32 - legend_height(names));
    for (i, (name, colour)) in names.iter().zip(colours).enumerate() {
        let y = 3 * GAP / 2 + i as i32 * LINE;
        below.draw(&Circle::new((GAP, y), DOT, colour.filled()))?;
        text(&below, name, (2 * GAP, y), INK.light, HPos::Left)?;
    }
    Ok(axes)
}

/// A round number as an axis label: `0.001`, `20`, `5,000`, `1e6`.
pub fn tick_text(value: f64) -> String {
    // Remove the rounding errors of the axis ticks.
    let rounded: f64 = format!("{value:.6e}").parse().expect("a number");
    match rounded {
        0.0 => "0".into(),
        large if large >= 1e6 => format!("{large:e}"),
        small if small < 1e-3 => format!("{small:e}"),
        thousands if thousands >= 1000.0 => count(thousands.round() as u64),
        _ => rounded.to_string(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ticks_are_round_numbers_on_the_axis_as_many_as_fit_in_short() {
        for (low, high, length, texts) in [
            (90.0, 6000.0, 400, &["100", "200", "500", "1,000", "2,000", "5,000"][..]),
            (140.0, 410.0, 400, &["150", "200", "300", "400"]),
            (1e-5, 0.6, 400, &["1e-5", "1e-4", "0.001", "0.01", "0.1"]),
            (1.0, 1e12, 200, &["1", "1,000", "1e6", "1e9", "1e12"]),
        ] {
            let axis = upward([low, high], length);
            assert_eq!(axis.bold_points().iter().map(|tick| tick_text(*tick)).collect::<Vec<_>>(), texts);
        }
        assert_eq!([0.0, 20.0].map(tick_text), ["0", "20"]);
    }
}
