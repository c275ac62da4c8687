//! A sheet that is drawn on in layers, by plotters. Its unit is a tenth of a millimetre of the printed figure.

use crate::axis::Axis;
use crate::colour::{ColourMap, GRID, INK, MUTED, PAPER};
use crate::figure::{Figure, FigureError, escaped};
use crate::raster::Raster;
use plotters::coord::Shift;
use plotters::coord::types::RangedCoordf64;
use plotters::prelude::{
    Cartesian2d, Circle, DrawingArea, IntoDrawingArea, PathElement, Polygon, Rectangle, SVGBackend, Text,
};
use plotters::style::text_anchor::{HPos, Pos, VPos};
use plotters::style::{Color, FontTransform, IntoTextStyle, RGBColor, ShapeStyle};
use std::fmt::Write as _;

/// Height of letters: 8 points in print.
pub(crate) const LETTER: i32 = 28;
/// Width of a column of text in print, 180 mm.
pub(crate) const WIDTH: i32 = 1800;
/// Height of letters over the size that plotters wants.
const PLOTTERS_SIZE: f64 = 1.24;
const TICK: i32 = 10;
const LINE: u32 = 2;

/// A rectangle on the sheet.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Place {
    pub(crate) left: i32,
    pub(crate) top: i32,
    pub(crate) right: i32,
    pub(crate) bottom: i32,
}

/// A plot: where it is and what its axes show.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Panel {
    pub(crate) place: Place,
    pub(crate) x: Axis,
    pub(crate) y: Axis,
    /// The same y again at the right: its title, and how much of the left unit is one of it.
    pub(crate) right: Option<(String, f64)>,
    /// Words above the plot.
    pub(crate) title: String,
}

/// Which corner or edge of a text is at its point.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Anchor {
    Left,
    Middle,
    Right,
    /// Turned to read upwards, its middle at the point.
    Upwards,
    /// Turned to read downwards, its middle at the point.
    Downwards,
}

/// A sheet and what was drawn on it.
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

    /// A layer without axes: words and boxes.
    pub(crate) fn layer(
        &mut self,
        class: &str,
        paint: impl FnOnce(&Sheet<'_, '_>) -> Result<(), FigureError>,
    ) -> Result<(), FigureError> {
        let drawn = self.drawn(|area| paint(&Sheet { area }))?;
        self.push_group(class, "", &drawn);
        Ok(())
    }

    /// The axes of a plot, to be followed by its layers.
    pub(crate) fn panel(&mut self, panel: &Panel) -> Result<(), FigureError> {
        let Panel { place, x, y, right, title } = panel;
        let (at_x, at_y) = (|value: f64| panel.x_unit(value), |value: f64| panel.y_unit(value));
        let ticks = self.drawn(|area| {
            let sheet = Sheet { area };
            for (value, label) in x.ticks() {
                sheet.line(&[(at_x(value), place.bottom), (at_x(value), place.bottom + TICK)], INK, LINE)?;
                sheet.text(&label, (at_x(value), place.bottom + 30), Anchor::Middle, INK)?;
            }
            for (value, label) in y.ticks() {
                sheet.line(&[(place.left, at_y(value)), (place.right, at_y(value))], GRID, 1)?;
                sheet.line(&[(place.left - TICK, at_y(value)), (place.left, at_y(value))], INK, LINE)?;
                sheet.text(&label, (place.left - 16, at_y(value)), Anchor::Right, INK)?;
            }
            let Some((_, unit)) = right else { return Ok(()) };
            for (value, label) in Axis::new("", (y.from / unit, y.to / unit)).with_ticks(y.ticks_max).ticks() {
                let at = at_y(value * unit);
                sheet.line(&[(place.right, at), (place.right + TICK, at)], INK, LINE)?;
                sheet.text(&label, (place.right + 16, at), Anchor::Left, INK)?;
            }
            Ok(())
        })?;
        let frame = self.drawn(|area| {
            let sheet = Sheet { area };
            let corners = [(place.left, place.top), (place.left, place.bottom), (place.right, place.bottom)];
            sheet.line(&corners, INK, LINE)?;
            sheet.text(&x.title, (place.middle_x(), place.bottom + 72), Anchor::Middle, INK)?;
            sheet.text(&y.title, (place.left - 128, place.middle_y()), Anchor::Upwards, INK)?;
            if let Some((right_title, _)) = right {
                sheet.text(right_title, (place.right + 122, place.middle_y()), Anchor::Downwards, INK)?;
            }
            sheet.text(title, (place.left, place.top - 24), Anchor::Left, INK)
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

    /// A layer in the coordinates of the last panel, cut at its edges.
    pub(crate) fn plot(
        &mut self,
        panel: &Panel,
        class: &str,
        paint: impl FnOnce(&Plot<'_, '_>) -> Result<(), FigureError>,
    ) -> Result<(), FigureError> {
        let Place { left, top, right, bottom } = panel.place;
        let drawn = self.drawn(|area| {
            let coordinates = Cartesian2d::<RangedCoordf64, RangedCoordf64>::new(
                panel.x.range(),
                panel.y.range(),
                (left..right, bottom..top),
            );
            paint(&Plot { area: &area.clone().apply_coord_spec(coordinates) })
        })?;
        self.push_zoomable(class, &drawn);
        Ok(())
    }

    /// A spectrogram over the whole of a panel, or over a part of its x axis.
    pub(crate) fn picture(&mut self, panel: &Panel, x: (f64, f64), raster: &Raster) -> Result<(), FigureError> {
        let (left, right) = (panel.x_unit_exact(x.0), panel.x_unit_exact(x.1));
        let image = format!(
            "<image class=\"picture\" x=\"{left:.2}\" y=\"{}\" width=\"{:.2}\" height=\"{}\" preserveAspectRatio=\"none\" \
             data-x-from=\"{}\" data-x-to=\"{}\" data-level-low-db=\"{:.1}\" data-level-high-db=\"{:.1}\" href=\"{}\"/>\n",
            panel.place.top,
            right - left,
            panel.place.bottom - panel.place.top,
            x.0,
            x.1,
            raster.level_db_low,
            raster.level_db_high,
            raster.data_uri()?
        );
        self.push_zoomable("pictures", &image);
        Ok(())
    }

    /// The key of a spectrogram's colours, at the top of the sheet.
    pub(crate) fn colour_bar(&mut self, map: ColourMap, levels_db: (f64, f64)) -> Result<(), FigureError> {
        let (left, width, height) = (WIDTH - 180 - 400 - 290, 400, 18);
        let raster = Raster::of_all_colours(map, levels_db);
        let image = format!(
            "<image x=\"{left}\" y=\"16\" width=\"{width}\" height=\"{height}\" preserveAspectRatio=\"none\" href=\"{}\"/>\n",
            raster.data_uri()?
        );
        self.push_group("colour-bar", "", &image);
        self.layer("colour-bar-words", |sheet| {
            let words = format!("{:.0} dB", levels_db.0).replace('-', "−");
            sheet.text(&words, (left - 14, 24), Anchor::Right, MUTED)?;
            let words = format!("{:.0} dB re full scale", levels_db.1).replace('-', "−");
            sheet.text(&words, (left + width + 14, 24), Anchor::Left, MUTED)
        })
    }

    /// A layer of the last panel: cut at its edges, and what is in it can be enlarged by whoever shows it.
    fn push_zoomable(&mut self, class: &str, content: &str) {
        let clip = format!(" data-panel=\"{1}\" clip-path=\"url(#{0}-clip-{1})\"", self.name, self.panels);
        self.push_group(class, &clip, &format!("<g class=\"zoomable\">\n{content}</g>\n"));
    }

    fn push_group(&mut self, class: &str, attributes: &str, content: &str) {
        // writing to a string does not fail
        let _ = write!(self.body, "<g class=\"{}\"{attributes}>\n{content}</g>\n", escaped(class));
    }

    /// What plotters draws, without the element around it.
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
        inner.map(|(inner, _)| inner.to_owned()).ok_or_else(|| refused("the drawing is not what it used to be"))
    }
}

impl Place {
    pub(crate) fn middle_x(&self) -> i32 {
        i32::midpoint(self.left, self.right)
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

    fn x_unit(&self, value: f64) -> i32 {
        self.x_unit_exact(value).round() as i32
    }

    fn y_unit(&self, value: f64) -> i32 {
        let share = (value - self.y.from) / (self.y.to - self.y.from);
        (f64::from(self.place.bottom) - share * f64::from(self.place.bottom - self.place.top)).round() as i32
    }
}

/// The whole sheet, in its own unit, y downwards.
pub(crate) struct Sheet<'a, 'b> {
    area: &'a DrawingArea<SVGBackend<'b>, Shift>,
}

impl Sheet<'_, '_> {
    pub(crate) fn line(&self, points: &[(i32, i32)], colour: RGBColor, width: u32) -> Result<(), FigureError> {
        self.area.draw(&PathElement::new(points.to_vec(), colour.stroke_width(width))).map_err(refused)
    }

    pub(crate) fn filled(&self, place: Place, colour: RGBColor, opacity: f64) -> Result<(), FigureError> {
        let corners = [(place.left, place.top), (place.right, place.bottom)];
        self.area.draw(&Rectangle::new(corners, colour.mix(opacity).filled())).map_err(refused)
    }

    pub(crate) fn outlined(&self, place: Place, colour: RGBColor) -> Result<(), FigureError> {
        let corners = [(place.left, place.top), (place.right, place.bottom)];
        self.area.draw(&Rectangle::new(corners, colour.stroke_width(1))).map_err(refused)
    }

    pub(crate) fn text(&self, text: &str, at: (i32, i32), anchor: Anchor, colour: RGBColor) -> Result<(), FigureError> {
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
        self.area.draw(&Text::new(text.to_owned(), at, style)).map_err(refused)
    }

    /// A line and its meaning, to be read from left to right; where the next may begin.
    pub(crate) fn key(&self, at: (i32, i32), colour: RGBColor, text: &str) -> Result<i32, FigureError> {
        self.line(&[at, (at.0 + 50, at.1)], colour, 6)?;
        self.text(text, (at.0 + 62, at.1), Anchor::Left, MUTED)?;
        Ok(at.0 + 62 + text.chars().count() as i32 * LETTER * 11 / 20 + 40)
    }
}

/// One panel, in its own coordinates.
pub(crate) struct Plot<'a, 'b> {
    area: &'a DrawingArea<SVGBackend<'b>, Cartesian2d<RangedCoordf64, RangedCoordf64>>,
}

impl Plot<'_, '_> {
    pub(crate) fn line(&self, points: &[(f64, f64)], style: impl Into<ShapeStyle>) -> Result<(), FigureError> {
        if points.len() == 1 {
            return self.dot(points[0], 3, style);
        }
        self.area.draw(&PathElement::new(points.to_vec(), style)).map_err(refused)
    }

    /// A line of dashes; they are of equal length on the sheet.
    pub(crate) fn dashed(
        &self,
        from: (f64, f64),
        to: (f64, f64),
        colour: RGBColor,
        width: u32,
    ) -> Result<(), FigureError> {
        const DASHES: usize = 60;
        let at = |share: f64| (from.0 + share * (to.0 - from.0), from.1 + share * (to.1 - from.1));
        (0..DASHES).try_for_each(|dash| {
            let start = dash as f64 / DASHES as f64;
            self.line(&[at(start), at(start + 0.6 / DASHES as f64)], colour.stroke_width(width))
        })
    }

    pub(crate) fn area(&self, outline: &[(f64, f64)], colour: RGBColor, opacity: f64) -> Result<(), FigureError> {
        self.area.draw(&Polygon::new(outline.to_vec(), colour.mix(opacity))).map_err(refused)
    }

    pub(crate) fn block(
        &self,
        x: (f64, f64),
        y: (f64, f64),
        colour: RGBColor,
        opacity: f64,
    ) -> Result<(), FigureError> {
        self.area.draw(&Rectangle::new([(x.0, y.0), (x.1, y.1)], colour.mix(opacity).filled())).map_err(refused)
    }

    pub(crate) fn dot(&self, at: (f64, f64), radius: u32, style: impl Into<ShapeStyle>) -> Result<(), FigureError> {
        let style = style.into();
        self.area.draw(&Circle::new(at, radius, ShapeStyle { filled: true, ..style })).map_err(refused)
    }
}
