//! Weight against squared speed with the fitted square law, its interval, and the residuals.

use crate::axis::{Axis, range_with_margin};
use crate::canvas::{Anchor, Canvas, Datum, LETTER, Label, Panel, Place, WIDTH};
use crate::colour::{INK, MUTED, colour_of_method};
use crate::figure::{Figure, FigureError, shortened};
use crate::geometry::{Extent, Point};
use hovertone_analysis::Method;
use hovertone_thrust::{COVERAGE_FACTOR, LoadThrust, SquareLawFit, ThrustTable};
use plotters::style::Color;

/// Squared speeds are shown in this unit.
const SQUARE_UNIT: f64 = 1e3;
/// Radius of a dot.
const DOT: u32 = 9;
/// Place of the plot of the law.
const LAW: Place = Place { left: 200, top: 60, right: WIDTH - 60, bottom: 720 };
/// Place of the plot of the residuals.
const RESIDUALS: Place = Place { left: 200, top: 850, right: WIDTH - 60, bottom: 1220 };
/// Residuals are shown in millinewtons.
const MILLI: f64 = 1e3;

/// Room that the name of a load needs: width of a letter, and height.
const NAME_ROOM: (i32, i32) = (LETTER * 5 / 8, 44);
/// Width of the law with an intercept.
const INTERCEPT_WIDTH: u32 = 4;

/// A load as a point: squared speed in [`SQUARE_UNIT`], force of all rotors, and their expanded uncertainties.
struct LoadPoint<'a> {
    /// Its number among the loads of the table.
    index: usize,
    load: &'a LoadThrust,
    square: f64,
    force_n: f64,
    expanded_n: Option<f64>,
    square_expanded: Option<f64>,
}

fn points(table: &ThrustTable) -> Vec<LoadPoint<'_>> {
    let point = |load: &'_ LoadThrust| {
        let (speed, constant) = (load.speed?.rad_s(), load.thrust_constant_total_n_s2?);
        Some((speed, constant))
    };
    table
        .loads
        .iter()
        .enumerate()
        .filter_map(|(index, load)| {
            let (speed_rad_s, constant) = point(load)?;
            let square = speed_rad_s.powi(2);
            Some(LoadPoint {
                index,
                load,
                square: square / SQUARE_UNIT,
                // in a bench run fewer rotors run: the force that all rotors would have
                force_n: constant.value * square,
                expanded_n: constant.std_uncertainty.map(|std| COVERAGE_FACTOR * std * square),
                square_expanded: load
                    .std_uncertainty_rad_s
                    .map(|std| COVERAGE_FACTOR * 2.0 * speed_rad_s * std / SQUARE_UNIT),
            })
        })
        .collect()
}

/// The fit of the reported method with the ranges of both plots.
struct Drawing<'a> {
    tables: &'a [ThrustTable],
    reported: Method,
    /// Table of the reported method.
    table: &'a ThrustTable,
    fit: &'a SquareLawFit,
    /// Constant of the reported law per [`SQUARE_UNIT`].
    constant: f64,
    expanded_share: f64,
    range_x: Extent,
    range_y: Extent,
}

/// `None` where no load has a speed.
pub(crate) fn figure(tables: &[ThrustTable], reported: Method) -> Result<Option<Figure>, FigureError> {
    let Some(drawing) = Drawing::of(tables, reported) else { return Ok(None) };
    let mut canvas = Canvas::new("fit", 1340);
    drawing.laws(&mut canvas)?;
    drawing.names(&mut canvas)?;
    drawing.residuals(&mut canvas)?;
    drawing.key(&mut canvas)?;
    let description = "Force against squared shaft speed of every load, with the fitted square law F = C ω² of each method and the expanded \
                       uncertainty (k = 2) of the reported one, shaded; dashed: the law with an intercept. Below: how far each load is off the \
                       reported law; vertical bars are its own expanded uncertainty.";
    Ok(Some(canvas.finish("Weight against squared speed: the fit and its residuals", description)))
}

impl<'a> Drawing<'a> {
    fn of(tables: &'a [ThrustTable], reported: Method) -> Option<Self> {
        let table = tables.iter().find(|table| table.method == reported)?;
        let fit = table.fit.as_ref()?;
        let all = || tables.iter().flat_map(points);
        let shown = range_with_margin(all().map(|point| point.square), 0.25)?;
        let widest = all().filter_map(|point| point.square_expanded).fold(0.004 * shown.high, f64::max);
        let range_x = Extent::new((shown.low - widest).max(0.0), shown.high + widest);
        let constant = fit.thrust_constant_n_s2.value * SQUARE_UNIT;
        let ends = [law(constant, 0.0, range_x.low), law(constant, 0.0, range_x.high)];
        let range_y = range_with_margin(all().map(|point| point.force_n).chain(ends), 0.1)?;
        let expanded_share = table.budget.as_ref().map_or(0.0, |budget| budget.expanded_share);
        Some(Self { tables, reported, table, fit, constant, expanded_share, range_x, range_y })
    }

    /// Outline of the expanded uncertainty of the law, as forces or as differences to the law.
    fn interval(&self, is_over_law: bool) -> Vec<Point> {
        let at = |x: f64, share: f64| {
            let zero_n = if is_over_law { law(self.constant, 0.0, x) } else { 0.0 };
            Point::new(x, law(self.constant, share, x) - zero_n)
        };
        let (Extent { low, high }, share) = (self.range_x, self.expanded_share);
        vec![at(low, -share), at(high, -share), at(high, share), at(low, share)]
    }

    /// The plot of forces: interval, laws and loads of all methods, the reported one on top.
    fn laws(&self, canvas: &mut Canvas) -> Result<(), FigureError> {
        let panel = Panel {
            place: LAW,
            x: Axis::new("", self.range_x).with_ticks(9),
            y: Axis::new("force of all rotors (N)", self.range_y).with_ticks(7),
            right: None,
            title: String::new(),
        };
        canvas.panel(&panel)?;
        let colour = colour_of_method(self.reported);
        canvas.plot(&panel, "interval", |plot| plot.area(&self.interval(false), colour, 0.18))?;
        reported_last(self.tables, self.reported).try_for_each(|table| self.method(canvas, &panel, table))?;
        self.with_intercept(canvas, &panel, Point::new)?;
        for table in self.tables {
            self.data(canvas, &panel, table, |point| Point::new(point.square, point.force_n));
        }
        Ok(())
    }

    /// The law with an intercept over the others, which it often hides.
    fn with_intercept(
        &self,
        canvas: &mut Canvas,
        panel: &Panel,
        place: impl Fn(f64, f64) -> Point,
    ) -> Result<(), FigureError> {
        let Some(other) = self.fit.with_intercept else { return Ok(()) };
        let constant = other.thrust_constant_n_s2.value * SQUARE_UNIT;
        let at = |x: f64| place(x, other.intercept_n.value + constant * x);
        canvas.plot(panel, "with-intercept", |plot| {
            plot.dashed(at(self.range_x.low), at(self.range_x.high), INK, INTERCEPT_WIDTH)
        })
    }

    /// The points of one method for a pointer: their keys name method and load.
    fn data(&self, canvas: &mut Canvas, panel: &Panel, table: &ThrustTable, place: impl Fn(&LoadPoint<'_>) -> Point) {
        let name = table.method.name();
        let datum = |point: LoadPoint<'_>| Datum { at: place(&point), key: format!("{name}-{}", point.index) };
        let data: Vec<Datum> = points(table).into_iter().map(datum).collect();
        canvas.data(panel, &format!("method-{name}"), &data);
    }

    /// The law and the loads of one method.
    fn method(&self, canvas: &mut Canvas, panel: &Panel, table: &ThrustTable) -> Result<(), FigureError> {
        let Some(fit) = &table.fit else { return Ok(()) };
        let (colour, name) = (colour_of_method(table.method), table.method.name());
        canvas.plot(panel, &format!("law method-{name}"), |plot| {
            let at = |x: f64| Point::new(x, fit.thrust_constant_n_s2.value * SQUARE_UNIT * x);
            let width = if table.method == self.reported { 4 } else { 2 };
            plot.line(&[at(self.range_x.low), at(self.range_x.high)], colour.stroke_width(width))
        })?;
        canvas.plot(panel, &format!("points method-{name}"), |plot| {
            for point in points(table) {
                let middle = Point::new(point.square, point.force_n);
                if let Some(half) = point.square_expanded {
                    let ends = [point.square - half, point.square + half].map(|x| Point { x, ..middle });
                    plot.line(&ends, colour.stroke_width(3))?;
                }
                let is_left_out = point.load.fits == Some(false);
                plot.dot(middle, DOT, if is_left_out { MUTED.filled() } else { colour.filled() })?;
            }
            Ok(())
        })
    }

    /// The names of the loads beside their points.
    fn names(&self, canvas: &mut Canvas) -> Result<(), FigureError> {
        let mut taken: Vec<Place> = Vec::new();
        for point in points(self.table) {
            let x = on_sheet(self.range_x.share_of(point.square), LAW.left, LAW.right);
            let y = on_sheet(self.range_y.share_of(point.force_n), LAW.bottom, LAW.top);
            let mark = if point.load.fits == Some(false) { " (does not fit)" } else { "" };
            let words = format!("{}{mark}", shortened(&point.load.name, 30));
            let width = words.chars().count() as i32 * NAME_ROOM.0;
            // above its point at the left; below it at the right where the axis is near or another name is there
            let left = Place {
                left: x - 24 - width,
                right: x - 24,
                top: y - 26 - NAME_ROOM.1 / 2,
                bottom: y - 26 + NAME_ROOM.1 / 2,
            };
            let right = Place {
                left: x + 24,
                right: x + 24 + width,
                top: y + 30 - NAME_ROOM.1 / 2,
                bottom: y + 30 + NAME_ROOM.1 / 2,
            };
            let is_free = |place: &Place| {
                let is_inside = place.left > LAW.left
                    && place.right < LAW.right
                    && place.top > LAW.top
                    && place.bottom < LAW.bottom;
                is_inside && !taken.iter().any(|other| other.meets(place))
            };
            let sides =
                [(left, Anchor::Right, Point::new(x - 24, y - 26)), (right, Anchor::Left, Point::new(x + 24, y + 30))];
            let Some((place, anchor, on_sheet)) = sides.into_iter().find(|(place, ..)| is_free(place)) else {
                continue;
            };
            taken.push(place);
            let (x, y) = (point.square, Some(point.force_n));
            canvas.label("name", &Label { text: &words, x, y, on_sheet, anchor, colour: INK })?;
        }
        Ok(())
    }

    /// The plot of the differences between the loads and the reported law.
    fn residuals(&self, canvas: &mut Canvas) -> Result<(), FigureError> {
        let residual = |point: &LoadPoint<'_>| MILLI * (point.force_n - self.constant * point.square);
        let ends = |point: &LoadPoint<'_>| {
            let half = MILLI * point.expanded_n.unwrap_or(0.0);
            [residual(point) - half, residual(point) + half]
        };
        let interval: Vec<Point> =
            self.interval(true).into_iter().map(|point| Point { y: MILLI * point.y, ..point }).collect();
        let of_points = self.tables.iter().flat_map(points).flat_map(|point| ends(&point));
        let of_interval = interval.iter().map(|point| point.y);
        let Some(range_y) = range_with_margin(of_points.chain(of_interval), 0.1) else { return Ok(()) };
        let panel = Panel {
            place: RESIDUALS,
            x: Axis::new("squared shaft speed ω² (1000 rad²/s²)", self.range_x).with_ticks(9),
            y: Axis::new("residual (mN)", range_y).with_ticks(6),
            right: None,
            title: String::new(),
        };
        canvas.panel(&panel)?;
        canvas.plot(&panel, "interval", |plot| plot.area(&interval, colour_of_method(self.reported), 0.18))?;
        canvas.plot(&panel, "zero", |plot| {
            plot.line(&[Point::new(self.range_x.low, 0.0), Point::new(self.range_x.high, 0.0)], INK.stroke_width(1))
        })?;
        let law_n = |x: f64| self.constant * x;
        self.with_intercept(canvas, &panel, |x, force_n| Point::new(x, MILLI * (force_n - law_n(x))))?;
        // the reported method stands at its speed; the others beside it, so that their bars do not cover each other
        let step = 0.006 * self.range_x.width();
        for (index, table) in reported_first(self.tables, self.reported).enumerate() {
            let colour = colour_of_method(table.method);
            let side = if index % 2 == 0 { -1.0 } else { 1.0 };
            let aside = side * index.div_ceil(2) as f64 * step;
            canvas.plot(&panel, &format!("residuals method-{}", table.method.name()), |plot| {
                for point in points(table) {
                    let x = point.square + aside;
                    plot.line(&ends(&point).map(|y| Point::new(x, y)), colour.stroke_width(3))?;
                    plot.dot(Point::new(x, residual(&point)), DOT, colour.filled())?;
                }
                Ok(())
            })?;
            self.data(canvas, &panel, table, |point| Point::new(point.square + aside, residual(point)));
        }
        Ok(())
    }

    /// The meaning of the lines: the reported law, the law with an intercept, then the other methods, each in a layer of its method.
    fn key(&self, canvas: &mut Canvas) -> Result<(), FigureError> {
        let mut at = Point::new(LAW.left, LETTER - 4);
        for table in reported_first(self.tables, self.reported).filter(|table| table.fit.is_some()) {
            canvas.layer(&format!("key method-{}", table.method.name()), |sheet| {
                at.x = sheet.key(at, colour_of_method(table.method), &key_words(table))?;
                Ok(())
            })?;
            if table.method == self.reported && self.fit.with_intercept.is_some() {
                canvas.layer("key with-intercept", |sheet| {
                    at.x = sheet.dashed_key(at, INK, "with an intercept")?;
                    Ok(())
                })?;
            }
        }
        Ok(())
    }
}

/// Short name of a method for the key.
fn key_words(table: &ThrustTable) -> String {
    match table.method {
        Method::Separated => table.title().to_lowercase(),
        method => method.name().replace('_', " "),
    }
}

/// Force of a law whose constant is larger by a share.
fn law(constant: f64, share: f64, x: f64) -> f64 {
    constant * (1.0 + share) * x
}

/// The tables with the reported one at the start.
fn reported_first(tables: &[ThrustTable], reported: Method) -> impl Iterator<Item = &ThrustTable> {
    let is_reported = move |table: &&ThrustTable| table.method == reported;
    tables.iter().filter(is_reported).chain(tables.iter().filter(move |table| !is_reported(table)))
}

/// The tables with the reported one at the end, so that it is drawn over the others.
fn reported_last(tables: &[ThrustTable], reported: Method) -> impl Iterator<Item = &ThrustTable> {
    let is_reported = move |table: &&ThrustTable| table.method == reported;
    tables.iter().filter(move |table| !is_reported(table)).chain(tables.iter().filter(is_reported))
}

/// Position on the sheet of a share of the way between two ends.
fn on_sheet(share: f64, from: i32, to: i32) -> i32 {
    from + (share * f64::from(to - from)).round() as i32
}
