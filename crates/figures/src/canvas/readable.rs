//! What a viewer needs beside the drawing: points that a pointer finds, curves with a name, labels that move with their point.

use super::{Anchor, Canvas, Panel, Plot};
use crate::axis::Axis;
use crate::figure::{FigureError, escaped};
use crate::geometry::{Extent, Point};
use plotters::style::RGBColor;
use std::fmt::Write as _;

/// A point of a panel that a viewer can describe.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Datum {
    /// Its place in the coordinates of the panel.
    pub(crate) at: Point,
    /// Key of its description, which the viewer has.
    pub(crate) key: String,
}

/// A part of the axes of a panel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct PanelPart {
    pub(crate) x: Extent,
    pub(crate) y: Extent,
}

/// Text at a point of a panel. A viewer keeps it there when it enlarges the panel.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Label<'a> {
    pub(crate) text: &'a str,
    /// Its point in the coordinates of the panel. Without y the label moves from left to right only.
    pub(crate) x: f64,
    pub(crate) y: Option<f64>,
    /// Place of the text on the sheet.
    pub(crate) on_sheet: Point<i32>,
    pub(crate) anchor: Anchor,
    pub(crate) colour: RGBColor,
}

impl Canvas {
    /// Invisible points of the last panel, for a pointer to find, and the part of the axes that a viewer shows where these points are all.
    pub(crate) fn data(&mut self, panel: &Panel, class: &str, data: &[Datum], part: &PanelPart) {
        let mut circles = String::new();
        for Datum { at, key } in data {
            let (x, y) = (panel.x_unit(at.x), panel.y_unit(at.y));
            // writing to a string does not fail
            let _ = writeln!(
                circles,
                "<circle cx=\"{x}\" cy=\"{y}\" r=\"1\" fill=\"none\" data-x=\"{}\" data-y=\"{}\" data-key=\"{}\"/>",
                at.x,
                at.y,
                escaped(key)
            );
        }
        // an axis has a width
        let (x, y) = (Axis::new("", part.x), Axis::new("", part.y));
        let about = format!(
            " data-panel=\"{}\" data-x-from=\"{}\" data-x-to=\"{}\" data-y-from=\"{}\" data-y-to=\"{}\"",
            self.panels, x.from, x.to, y.from, y.to
        );
        self.push_group(&format!("data {class}"), &about, &circles);
    }

    /// A layer of the last panel with curves of one name, whose values a viewer can read.
    pub(crate) fn curve(
        &mut self,
        panel: &Panel,
        class: &str,
        name: &str,
        paint: impl FnOnce(&Plot<'_, '_>) -> Result<(), FigureError>,
    ) -> Result<(), FigureError> {
        let drawn = self.plotted(panel, paint)?;
        self.push_zoomable(class, &format!(" data-curve=\"{}\"", escaped(name)), &drawn);
        Ok(())
    }

    /// A label of the last panel.
    pub(crate) fn label(&mut self, class: &str, label: &Label<'_>) -> Result<(), FigureError> {
        let &Label { text, x, y, on_sheet, anchor, colour } = label;
        let drawn = self.drawn(|area| super::Sheet { area }.text(text, on_sheet, anchor, colour))?;
        let mut about = format!(" data-panel=\"{}\" data-x=\"{x}\"", self.panels);
        if let Some(y) = y {
            let _ = write!(about, " data-y=\"{y}\"");
        }
        self.push_group(&format!("label {class}"), &about, &drawn);
        Ok(())
    }
}
