//! Points and extents of a drawing.

use hovertone_analysis::Span;

/// A point: on the sheet in its unit with y downwards (`i32`), or in the coordinates of a panel (`f64`).
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Point<T = f64> {
    pub(crate) x: T,
    pub(crate) y: T,
}

impl<T: Copy> Point<T> {
    pub(crate) const fn new(x: T, y: T) -> Self {
        Self { x, y }
    }

    /// The point as plotters takes it.
    pub(crate) const fn pair(self) -> (T, T) {
        (self.x, self.y)
    }
}

/// A range of values along an axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Extent {
    pub(crate) low: f64,
    pub(crate) high: f64,
}

impl Extent {
    pub(crate) const fn new(low: f64, high: f64) -> Self {
        Self { low, high }
    }

    pub(crate) const fn of_span(span: Span) -> Self {
        Self { low: span.from_s, high: span.to_s }
    }

    pub(crate) fn width(self) -> f64 {
        self.high - self.low
    }

    /// Position of a value from 0 at the low end to 1 at the high end.
    pub(crate) fn share_of(self, value: f64) -> f64 {
        (value - self.low) / (self.high - self.low)
    }
}
