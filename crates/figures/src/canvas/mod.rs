//! A sheet with layers, drawn by plotters. Its unit is a tenth of a millimetre of the printed figure.

use crate::axis::Axis;
use crate::colour::{ColourMap, GRID, INK, MUTED, PAPER};
use crate::figure::{Figure, FigureError, escaped};
use crate::geometry::{Extent, Point};
use crate::raster::Raster;
use plotters::coord::Shift;
use plotters::coord::types::RangedCoordf64;
use plotters::prelude::{Cartesian2d, DrawingArea, IntoDrawingArea, SVGBackend};
use std::fmt::Write as _;

mod readable;
mod sheet;

pub(crate) use readable::{Datum, Label, PanelPart};
pub(crate) use sheet::{Anchor, Plot, Sheet};

/// Height of letters in units of the sheet: 8 points in print.
pub(crate) const LETTER: i32 = 28;
/// Width of the sheet: 180 mm, a column of text in print.
pub(crate) const WIDTH: i32 = 1800;
/// Font size of plotters over the height of its letters.
const PLOTTERS_SIZE: f64 = 1.24;
/// plotters has no dashes in SVG: a line of this opacity, which nothing else has, becomes one with dashes.
const DASHED_OPACITY: f64 = 0.987;
/// Lengths of a dash and of the gap behind it.
const DASHES: &str = "stroke-dasharray=\"18 12\"";
const TICK: i32 = 10;
const LINE: u32 = 2;

/// Width of a text on the sheet: a letter is on average 11/20 as wide as high.
pub(crate) fn text_width(text: &str) -> i32 {
    text.chars().count() as i32 * LETTER * 11 / 20
}

/// A rectangle on the sheet.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Place {
    pub(crate) left: i32,
    pub(crate) top: i32,
    pub(crate) right: i32,
    pub(crate) bottom: i32,
}

/// A plot: its place and its axes.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Panel {
    pub(crate) place: Place,
    pub(crate) x: Axis,
    pub(crate) y: Axis,
    /// A second axis at the right: its title, and the number of left units per right unit.
    pub(crate) right: Option<(String, f64)>,
    /// Text above the plot.
    pub(crate) title: String,
}

/// A sheet with the layers drawn so far.
pub(crate) struct Canvas {
    name: String,
    height: i32,
    body: String,
    panels: usize,
}

fn refused(error: impl std::fmt::Display) -> FigureError {
    FigureError::Drawing(error.to_string())
}

impl Canvas {
    pub(crate) fn new(name: &str, height: i32) -> Self {
        Self { name: name.to_owned(), height, body: String::new(), panels: 0 }
    }

    /// The finished figure.
    pub(crate) fn finish(self, title: impl Into<String>, description: impl Into<String>) -> Figure {
        let (title, description) = (title.into(), description.into());
        let Self { name, height, body, .. } = self;
        let [red, green, blue] = [PAPER.0, PAPER.1, PAPER.2];
        let svg = format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{}mm\" height=\"{}mm\" viewBox=\"0 0 {WIDTH} {height}\" role=\"img\" \
             aria-labelledby=\"{name}-title {name}-description\" data-figure=\"{name}\">\n<title id=\"{name}-title\">{}</title>\n\
             <desc id=\"{name}-description\">{}</desc>\n<rect class=\"sheet\" width=\"{WIDTH}\" height=\"{height}\" \
             fill=\"#{red:02X}{green:02X}{blue:02X}\"/>\n{body}</svg>\n",
            f64::from(WIDTH) / 10.0,
            f64::from(height) / 10.0,
            escaped(&title),
            escaped(&description),
        );
        Figure { name, title, description, svg }
    }

    /// A layer without axes: text and boxes.
    pub(crate) fn layer(
        &mut self,
        class: &str,
        paint: impl FnOnce(&Sheet<'_, '_>) -> Result<(), FigureError>,
    ) -> Result<(), FigureError> {
        let drawn = self.drawn(|area| paint(&Sheet { area }))?;
        self.push_group(class, "", &drawn);
        Ok(())
    }

    /// The axes of a plot. Its layers follow.
    pub(crate) fn panel(&mut self, panel: &Panel) -> Result<(), FigureError> {
        self.axes(panel, true)
    }

    /// A plot without an axis at the left: names of rows have that place.
    pub(crate) fn panel_of_rows(&mut self, panel: &Panel) -> Result<(), FigureError> {
        self.axes(panel, false)
    }

    fn axes(&mut self, panel: &Panel, has_left: bool) -> Result<(), FigureError> {
        let Panel { place, x, y, right, title } = panel;
        let (at_x, at_y) = (|value: f64| panel.x_unit(value), |value: f64| panel.y_unit(value));
        let ticks = self.drawn(|area| {
            let sheet = Sheet { area };
            for (value, label) in x.ticks() {
                let ends = [Point::new(at_x(value), place.bottom), Point::new(at_x(value), place.bottom + TICK)];
                sheet.line(&ends, INK, LINE)?;
                sheet.text(&label, Point::new(at_x(value), place.bottom + 30), Anchor::Middle, INK)?;
            }
            for (value, label) in y.ticks() {
                let on_axis = Point::new(place.left, at_y(value));
                sheet.line(&[on_axis, Point { x: place.right, ..on_axis }], GRID, 1)?;
                sheet.line(&[Point { x: place.left - TICK, ..on_axis }, on_axis], INK, LINE)?;
                sheet.text(&label, Point { x: place.left - 16, ..on_axis }, Anchor::Right, INK)?;
            }
            let Some((_, unit)) = right else { return Ok(()) };
            let shown = Extent::new(y.from / unit, y.to / unit);
            for (value, label) in Axis::new("", shown).with_ticks(y.ticks_max).ticks() {
                let on_axis = Point::new(place.right, at_y(value * unit));
                sheet.line(&[on_axis, Point { x: place.right + TICK, ..on_axis }], INK, LINE)?;
                sheet.text(&label, Point { x: place.right + 16, ..on_axis }, Anchor::Left, INK)?;
            }
            Ok(())
        })?;
        let frame = self.drawn(|area| {
            let sheet = Sheet { area };
            let corners = [
                Point::new(place.left, place.top),
                Point::new(place.left, place.bottom),
                Point::new(place.right, place.bottom),
            ];
            sheet.line(&corners[usize::from(!has_left)..], INK, LINE)?;
            sheet.text(&x.title, Point::new(place.middle_x(), place.bottom + 72), Anchor::Middle, INK)?;
            sheet.text(&y.title, Point::new(place.left - 128, place.middle_y()), Anchor::Upwards, INK)?;
            if let Some((right_title, _)) = right {
                sheet.text(right_title, Point::new(place.right + 122, place.middle_y()), Anchor::Downwards, INK)?;
            }
            sheet.text(title, Point::new(place.left, place.top - 24), Anchor::Left, INK)
        })?;
        let drawn = format!("<g class=\"ticks\">\n{ticks}</g>\n<g class=\"frame\">\n{frame}</g>\n");
        self.panels += 1;
        let number = self.panels;
        let _ = writeln!(
            self.body,
            "<clipPath id=\"{}-clip-{number}\"><rect x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\"/></clipPath>",
            self.name,
            place.left,
            place.top,
            place.right - place.left,
            place.bottom - place.top
        );
        let mut about = format!(
            " data-panel=\"{number}\" data-left=\"{}\" data-top=\"{}\" data-right=\"{}\" data-bottom=\"{}\" data-x-from=\"{}\" data-x-to=\"{}\" \
             data-y-from=\"{}\" data-y-to=\"{}\" data-x-title=\"{}\" data-y-title=\"{}\"",
            place.left,
            place.top,
            place.right,
            place.bottom,
            x.from,
            x.to,
            y.from,
            y.to,
            escaped(&x.title),
            escaped(&y.title)
        );
        if let Some((right_title, unit)) = right {
            let _ = write!(about, " data-right-title=\"{}\" data-right-unit=\"{unit}\"", escaped(right_title));
        }
        self.push_group("panel", &about, &drawn);
        Ok(())
    }

    /// A layer in the coordinates of the last panel, clipped at its edges.
    pub(crate) fn plot(
        &mut self,
        panel: &Panel,
        class: &str,
        paint: impl FnOnce(&Plot<'_, '_>) -> Result<(), FigureError>,
    ) -> Result<(), FigureError> {
        let drawn = self.plotted(panel, paint)?;
        self.push_zoomable(class, "", &drawn);
        Ok(())
    }

    fn plotted(
        &self,
        panel: &Panel,
        paint: impl FnOnce(&Plot<'_, '_>) -> Result<(), FigureError>,
    ) -> Result<String, FigureError> {
        let Place { left, top, right, bottom } = panel.place;
        self.drawn(|area| {
            let coordinates = Cartesian2d::<RangedCoordf64, RangedCoordf64>::new(
                panel.x.range(),
                panel.y.range(),
                (left..right, bottom..top),
            );
            paint(&Plot { area: &area.clone().apply_coord_spec(coordinates) })
        })
    }

    /// A spectrogram over the whole of a panel, or over a part of its x axis.
    pub(crate) fn picture(&mut self, panel: &Panel, x: Extent, raster: &Raster) -> Result<(), FigureError> {
        let (left, right) = (panel.x_unit_exact(x.low), panel.x_unit_exact(x.high));
        let image = format!(
            "<image class=\"picture\" x=\"{left:.2}\" y=\"{}\" width=\"{:.2}\" height=\"{}\" preserveAspectRatio=\"none\" \
             data-x-from=\"{}\" data-x-to=\"{}\" data-level-low-db=\"{:.1}\" data-level-high-db=\"{:.1}\" href=\"{}\"/>\n",
            panel.place.top,
            right - left,
            panel.place.bottom - panel.place.top,
            x.low,
            x.high,
            raster.level_db_low,
            raster.level_db_high,
            raster.data_uri()?
        );
        self.push_zoomable("pictures", "", &image);
        Ok(())
    }

    /// The key of the colours of a spectrogram, at the top of the sheet.
    pub(crate) fn colour_bar(&mut self, map: ColourMap, levels_db: Extent) -> Result<(), FigureError> {
        let (left, width, height) = (WIDTH - 180 - 400 - 290, 400, 18);
        let raster = Raster::of_all_colours(map, levels_db);
        let image = format!(
            "<image x=\"{left}\" y=\"16\" width=\"{width}\" height=\"{height}\" preserveAspectRatio=\"none\" href=\"{}\"/>\n",
            raster.data_uri()?
        );
        self.push_group("colour-bar", "", &image);
        self.layer("colour-bar-words", |sheet| {
            let words = format!("{:.0} dB", levels_db.low).replace('-', "−");
            sheet.text(&words, Point::new(left - 14, 24), Anchor::Right, MUTED)?;
            let words = format!("{:.0} dB re full scale", levels_db.high).replace('-', "−");
            sheet.text(&words, Point::new(left + width + 14, 24), Anchor::Left, MUTED)
        })
    }

    /// A layer of the last panel, clipped at its edges. A viewer can enlarge its content.
    fn push_zoomable(&mut self, class: &str, attributes: &str, content: &str) {
        let clip = format!(" data-panel=\"{1}\"{attributes} clip-path=\"url(#{0}-clip-{1})\"", self.name, self.panels);
        self.push_group(class, &clip, &format!("<g class=\"zoomable\">\n{content}</g>\n"));
    }

    fn push_group(&mut self, class: &str, attributes: &str, content: &str) {
        // writing to a string does not fail
        let _ = write!(self.body, "<g class=\"{}\"{attributes}>\n{content}</g>\n", escaped(class));
    }

    /// The drawing of plotters without the SVG element around it.
    fn drawn(
        &self,
        paint: impl FnOnce(&DrawingArea<SVGBackend<'_>, Shift>) -> Result<(), FigureError>,
    ) -> Result<String, FigureError> {
        let mut svg = String::new();
        {
            let area = SVGBackend::with_string(&mut svg, (WIDTH as u32, self.height.max(1) as u32)).into_drawing_area();
            paint(&area)?;
            area.present().map_err(refused)?;
        }
        let inner = svg.split_once('\n').and_then(|(_, rest)| rest.rsplit_once("</svg>"));
        let dashed = |inner: &str| inner.replace(&format!("opacity=\"{DASHED_OPACITY}\""), DASHES);
        inner.map(|(inner, _)| dashed(inner)).ok_or_else(|| refused("the drawing is not what it used to be"))
    }
}

impl Place {
    pub(crate) fn middle_x(&self) -> i32 {
        i32::midpoint(self.left, self.right)
    }

    /// Whether two places have a common part.
    pub(crate) fn meets(&self, other: &Self) -> bool {
        self.left < other.right && other.left < self.right && self.top < other.bottom && other.top < self.bottom
    }

    /// Whether a place is inside of another.
    pub(crate) fn is_within(&self, other: &Self) -> bool {
        self.left > other.left && self.right < other.right && self.top > other.top && self.bottom < other.bottom
    }

    pub(crate) fn middle_y(&self) -> i32 {
        i32::midpoint(self.top, self.bottom)
    }
}

impl Panel {
    fn x_unit_exact(&self, value: f64) -> f64 {
        let share = (value - self.x.from) / (self.x.to - self.x.from);
        f64::from(self.place.left) + share * f64::from(self.place.right - self.place.left)
    }

    pub(crate) fn x_unit(&self, value: f64) -> i32 {
        self.x_unit_exact(value).round() as i32
    }

    pub(crate) fn y_unit(&self, value: f64) -> i32 {
        let share = (value - self.y.from) / (self.y.to - self.y.from);
        (f64::from(self.place.bottom) - share * f64::from(self.place.bottom - self.place.top)).round() as i32
    }
}
