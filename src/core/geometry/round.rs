//! Conversion from `f64` to `f32` with directed rounding.

/// The largest `f32` that is at most `x`. The result for NaN is NaN.
#[inline(always)]
pub fn round_down(x: f64) -> f32 {
    let rounded = x as f32;
    if f64::from(rounded) > x { rounded.next_down() } else { rounded }
}

/// The smallest `f32` that is at least `x`. The result for NaN is NaN.
#[inline(always)]
pub fn round_up(x: f64) -> f32 {
    -round_down(-x)
}
