//! What draws: on the whole sheet in its unit, or on one panel in its coordinates.

use super::{DASHED_OPACITY, LETTER, PLOTTERS_SIZE, Place, refused, text_width};
use crate::colour::MUTED;
use crate::figure::FigureError;
use crate::geometry::{Extent, Point};
use plotters::coord::Shift;
use plotters::coord::types::RangedCoordf64;
use plotters::prelude::{Cartesian2d, Circle, DrawingArea, PathElement, Polygon, Rectangle, SVGBackend, Text};
use plotters::style::text_anchor::{HPos, Pos, VPos};
use plotters::style::{Color, FontTransform, IntoTextStyle, RGBColor, ShapeStyle};

/// Side of a text that lies at its point.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Anchor {
    Left,
    Middle,
    Right,
    /// Rotated to read upwards, with its middle at the point.
    Upwards,
    /// Rotated to read downwards, with its middle at the point.
    Downwards,
}

/// The whole sheet in its own unit, with y downwards.
pub(crate) struct Sheet<'a, 'b> {
    pub(super) area: &'a DrawingArea<SVGBackend<'b>, Shift>,
}

impl Sheet<'_, '_> {
    pub(crate) fn line(&self, points: &[Point<i32>], colour: RGBColor, width: u32) -> Result<(), FigureError> {
        let points: Vec<(i32, i32)> = points.iter().map(|point| point.pair()).collect();
        self.area.draw(&PathElement::new(points, colour.stroke_width(width))).map_err(refused)
    }

    pub(crate) fn filled(&self, place: Place, colour: RGBColor, opacity: f64) -> Result<(), FigureError> {
        let corners = [(place.left, place.top), (place.right, place.bottom)];
        self.area.draw(&Rectangle::new(corners, colour.mix(opacity).filled())).map_err(refused)
    }

    pub(crate) fn outlined(&self, place: Place, colour: RGBColor) -> Result<(), FigureError> {
        let corners = [(place.left, place.top), (place.right, place.bottom)];
        self.area.draw(&Rectangle::new(corners, colour.stroke_width(1))).map_err(refused)
    }

    pub(crate) fn text(&self, text: &str, at: Point<i32>, anchor: Anchor, colour: RGBColor) -> Result<(), FigureError> {
        if text.is_empty() {
            return Ok(());
        }
        let (side, turn) = match anchor {
            Anchor::Left => (HPos::Left, FontTransform::None),
            Anchor::Middle => (HPos::Center, FontTransform::None),
            Anchor::Right => (HPos::Right, FontTransform::None),
            Anchor::Upwards => (HPos::Center, FontTransform::Rotate270),
            Anchor::Downwards => (HPos::Center, FontTransform::Rotate90),
        };
        let style = ("sans-serif", f64::from(LETTER) * PLOTTERS_SIZE)
            .into_text_style(self.area)
            .transform(turn)
            .color(&colour)
            .pos(Pos::new(side, VPos::Center));
        self.area.draw(&Text::new(text.to_owned(), at.pair(), style)).map_err(refused)
    }

    /// Width of an entry of the key, dashed or not.
    pub(crate) fn key_width(text: &str) -> i32 {
        66 + text_width(text)
    }

    /// An entry of the key with a dashed line. Returns the x of the next entry.
    pub(crate) fn dashed_key(&self, at: Point<i32>, colour: RGBColor, text: &str) -> Result<i32, FigureError> {
        for dash in 0..3 {
            let from = Point { x: at.x + 20 * dash, ..at };
            self.line(&[from, Point { x: from.x + 12, ..from }], colour, 4)?;
        }
        self.text(text, Point { x: at.x + 66, ..at }, Anchor::Left, MUTED)?;
        Ok(at.x + Self::key_width(text) + 40)
    }

    /// An entry of the key: a line and its meaning. Returns the x of the next entry.
    pub(crate) fn key(&self, at: Point<i32>, colour: RGBColor, text: &str) -> Result<i32, FigureError> {
        self.line(&[at, Point { x: at.x + 50, ..at }], colour, 6)?;
        self.text(text, Point { x: at.x + 62, ..at }, Anchor::Left, MUTED)?;
        Ok(at.x + 62 + text_width(text) + 40)
    }
}

/// One panel, in its own coordinates.
pub(crate) struct Plot<'a, 'b> {
    pub(super) area: &'a DrawingArea<SVGBackend<'b>, Cartesian2d<RangedCoordf64, RangedCoordf64>>,
}

impl Plot<'_, '_> {
    pub(crate) fn line(&self, points: &[Point], style: impl Into<ShapeStyle>) -> Result<(), FigureError> {
        if points.len() == 1 {
            return self.dot(points[0], 3, style);
        }
        let points: Vec<(f64, f64)> = points.iter().map(|point| point.pair()).collect();
        self.area.draw(&PathElement::new(points, style)).map_err(refused)
    }

    /// A dashed line; the dashes have equal lengths on the sheet.
    pub(crate) fn dashed(&self, from: Point, to: Point, colour: RGBColor, width: u32) -> Result<(), FigureError> {
        self.line(&[from, to], colour.mix(DASHED_OPACITY).stroke_width(width))
    }

    pub(crate) fn area(&self, outline: &[Point], colour: RGBColor, opacity: f64) -> Result<(), FigureError> {
        let outline: Vec<(f64, f64)> = outline.iter().map(|point| point.pair()).collect();
        self.area.draw(&Polygon::new(outline, colour.mix(opacity))).map_err(refused)
    }

    pub(crate) fn block(&self, x: Extent, y: Extent, colour: RGBColor, opacity: f64) -> Result<(), FigureError> {
        let corners = [(x.low, y.low), (x.high, y.high)];
        self.area.draw(&Rectangle::new(corners, colour.mix(opacity).filled())).map_err(refused)
    }

    pub(crate) fn dot(&self, at: Point, radius: u32, style: impl Into<ShapeStyle>) -> Result<(), FigureError> {
        let style = style.into();
        self.area.draw(&Circle::new(at.pair(), radius, ShapeStyle { filled: true, ..style })).map_err(refused)
    }
}
