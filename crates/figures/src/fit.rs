//! Weight against squared speed with the fitted square law, its interval, and the residuals.

use crate::axis::{Axis, range_with_margin};
use crate::canvas::{Anchor, Canvas, Datum, LETTER, Label, Panel, PanelPart, Place, WIDTH};
use crate::colour::{INK, MUTED, colour_of_method};
use crate::figure::{Figure, FigureError, shortened};
use crate::geometry::{Extent, Point};
use hovertone_analysis::Method;
use hovertone_thrust::{LoadThrust, SquareLawFit, ThrustTable};
use hovertone_vehicle::COVERAGE_FACTOR;
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

/// The reported law F = C ω² with its expanded uncertainty.
#[derive(Clone, Copy)]
struct ReportedLaw {
    /// C per [`SQUARE_UNIT`].
    constant: f64,
    /// Expanded uncertainty of C as a share of it.
    expanded_share: f64,
}

impl ReportedLaw {
    /// Outline of the expanded uncertainty of the law over a range of squared speeds, as forces.
    fn interval(self, x: Extent) -> [Point; 4] {
        let at = |x: f64, sign: f64| Point::new(x, law(self.constant, sign * self.expanded_share, x));
        [at(x.low, -1.0), at(x.high, -1.0), at(x.high, 1.0), at(x.low, 1.0)]
    }

    /// A force less that of the law, in millinewtons.
    fn residual(self, Point { x, y }: Point) -> Point {
        Point::new(x, MILLI * (y - law(self.constant, 0.0, x)))
    }

    /// The residual of a load.
    fn residual_of(self, point: &LoadPoint<'_>) -> f64 {
        self.residual(Point::new(point.square, point.force_n)).y
    }

    /// Both ends of the bar of a load.
    fn ends_of(self, point: &LoadPoint<'_>) -> [f64; 2] {
        let half = MILLI * point.expanded_n.unwrap_or(0.0);
        [self.residual_of(point) - half, self.residual_of(point) + half]
    }
}

/// The ranges in which the loads of some methods are seen, with the reported law.
struct Ranges {
    x: Extent,
    force_n: Extent,
    residual_mn: Extent,
}

impl Ranges {
    fn of(tables: &[&ThrustTable], reported: ReportedLaw) -> Option<Self> {
        let all = || tables.iter().copied().flat_map(points);
        let shown = range_with_margin(all().map(|point| point.square), 0.25)?;
        let widest = all().filter_map(|point| point.square_expanded).fold(0.004 * shown.high, f64::max);
        let x = Extent::new((shown.low - widest).max(0.0), shown.high + widest);
        let interval = reported.interval(x);
        let residuals = all().flat_map(|point| reported.ends_of(&point));
        Some(Self {
            x,
            force_n: range_with_margin(all().map(|point| point.force_n).chain(interval.map(|point| point.y)), 0.1)?,
            residual_mn: range_with_margin(residuals.chain(interval.map(|point| reported.residual(point).y)), 0.1)?,
        })
    }

    /// Place of a load in the plot of the law.
    fn on_sheet(&self, point: &LoadPoint<'_>) -> Point<i32> {
        Point::new(
            on_sheet(self.x.share_of(point.square), LAW.left, LAW.right),
            on_sheet(self.force_n.share_of(point.force_n), LAW.bottom, LAW.top),
        )
    }
}

/// Side of a point at which the name of its load stands.
#[derive(Clone, Copy)]
enum Side {
    AboveLeft,
    BelowRight,
}

impl Side {
    /// Where the words end that stand at this side of a point, and which end of them it is.
    fn end(self, at: Point<i32>) -> (Anchor, Point<i32>) {
        match self {
            Self::AboveLeft => (Anchor::Right, Point::new(at.x - 24, at.y - 26)),
            Self::BelowRight => (Anchor::Left, Point::new(at.x + 24, at.y + 30)),
        }
    }

    /// The room that words take at this side of a point.
    fn room(self, at: Point<i32>, words: &str) -> Place {
        let width = words.chars().count() as i32 * NAME_ROOM.0;
        let (anchor, end) = self.end(at);
        let left = if anchor == Anchor::Right { end.x - width } else { end.x };
        Place { left, right: left + width, top: end.y - NAME_ROOM.1 / 2, bottom: end.y + NAME_ROOM.1 / 2 }
    }
}

/// The fit of the reported method with the ranges of both plots.
struct Drawing<'a> {
    tables: &'a [ThrustTable],
    reported: Method,
    /// Table of the reported method.
    table: &'a ThrustTable,
    fit: &'a SquareLawFit,
    law: ReportedLaw,
    /// The ranges that are drawn: those of all methods.
    drawn: Ranges,
    /// The ranges of the reported method alone, which a viewer shows first.
    own: Ranges,
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
        let law = ReportedLaw {
            constant: fit.thrust_constant_n_s2.value * SQUARE_UNIT,
            expanded_share: table.budget.as_ref().map_or(0.0, |budget| budget.expanded_share),
        };
        let all: Vec<&ThrustTable> = tables.iter().collect();
        let (drawn, own) = (Ranges::of(&all, law)?, Ranges::of(&[table], law)?);
        Some(Self { tables, reported, table, fit, law, drawn, own })
    }

    /// The plot of forces: interval, laws and loads of all methods, the reported one on top.
    fn laws(&self, canvas: &mut Canvas) -> Result<(), FigureError> {
        let panel = Panel {
            place: LAW,
            x: Axis::new("", self.drawn.x).with_ticks(9),
            y: Axis::new("force of all rotors (N)", self.drawn.force_n).with_ticks(7),
            right: None,
            title: String::new(),
        };
        canvas.panel(&panel)?;
        let colour = colour_of_method(self.reported);
        canvas.plot(&panel, "interval", |plot| plot.area(&self.law.interval(self.drawn.x), colour, 0.18))?;
        reported_last(self.tables, self.reported).try_for_each(|table| self.method(canvas, &panel, table))?;
        self.with_intercept(canvas, &panel, Point::new)?;
        for table in self.tables {
            self.data(canvas, &panel, table, |ranges| ranges.force_n, |point| Point::new(point.square, point.force_n));
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
            plot.dashed(at(self.drawn.x.low), at(self.drawn.x.high), INK, INTERCEPT_WIDTH)
        })
    }

    /// The points of one method for a pointer: their keys name method and load.
    fn data(
        &self,
        canvas: &mut Canvas,
        panel: &Panel,
        table: &ThrustTable,
        range_y: impl Fn(&Ranges) -> Extent,
        place: impl Fn(&LoadPoint<'_>) -> Point,
    ) {
        let Some(ranges) = Ranges::of(&[table], self.law) else { return };
        let name = table.method.name();
        let datum = |point: LoadPoint<'_>| Datum { at: place(&point), key: format!("{name}-{}", point.index) };
        let data: Vec<Datum> = points(table).into_iter().map(datum).collect();
        canvas.data(panel, &format!("method-{name}"), &data, &PanelPart { x: ranges.x, y: range_y(&ranges) });
    }

    /// The law and the loads of one method.
    fn method(&self, canvas: &mut Canvas, panel: &Panel, table: &ThrustTable) -> Result<(), FigureError> {
        let Some(fit) = &table.fit else { return Ok(()) };
        let (colour, name) = (colour_of_method(table.method), table.method.name());
        canvas.plot(panel, &format!("law method-{name}"), |plot| {
            let at = |x: f64| Point::new(x, fit.thrust_constant_n_s2.value * SQUARE_UNIT * x);
            let width = if table.method == self.reported { 4 } else { 2 };
            plot.line(&[at(self.drawn.x.low), at(self.drawn.x.high)], colour.stroke_width(width))
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

    /// The names of the loads beside their points: on a side that is free in what is drawn, and in what a viewer shows first.
    fn names(&self, canvas: &mut Canvas) -> Result<(), FigureError> {
        let ranges = [&self.drawn, &self.own];
        let mut taken: [Vec<Place>; 2] = Default::default();
        for point in points(self.table) {
            let mark = if point.load.fits == Some(false) { " (does not fit)" } else { "" };
            let words = format!("{}{mark}", shortened(&point.load.name, 30));
            let is_free = |side: &Side| {
                ranges.iter().zip(&taken).all(|(ranges, taken)| {
                    let place = side.room(ranges.on_sheet(&point), &words);
                    place.is_within(&LAW) && !taken.iter().any(|other| other.meets(&place))
                })
            };
            let Some(side) = [Side::AboveLeft, Side::BelowRight].into_iter().find(is_free) else { continue };
            for (ranges, taken) in ranges.iter().zip(&mut taken) {
                taken.push(side.room(ranges.on_sheet(&point), &words));
            }
            let (anchor, on_sheet) = side.end(self.drawn.on_sheet(&point));
            let (x, y) = (point.square, Some(point.force_n));
            canvas.label("name", &Label { text: &words, x, y, on_sheet, anchor, colour: INK })?;
        }
        Ok(())
    }

    /// The plot of the differences between the loads and the reported law.
    fn residuals(&self, canvas: &mut Canvas) -> Result<(), FigureError> {
        let (reported, x) = (self.law, self.drawn.x);
        let interval = reported.interval(x).map(|point| reported.residual(point));
        let panel = Panel {
            place: RESIDUALS,
            x: Axis::new("squared shaft speed ω² (1000 rad²/s²)", x).with_ticks(9),
            y: Axis::new("residual (mN)", self.drawn.residual_mn).with_ticks(6),
            right: None,
            title: String::new(),
        };
        canvas.panel(&panel)?;
        canvas.plot(&panel, "interval", |plot| plot.area(&interval, colour_of_method(self.reported), 0.18))?;
        canvas.plot(&panel, "zero", |plot| {
            plot.line(&[Point::new(x.low, 0.0), Point::new(x.high, 0.0)], INK.stroke_width(1))
        })?;
        self.with_intercept(canvas, &panel, |x, force_n| reported.residual(Point::new(x, force_n)))?;
        // the reported method stands at its speed; the others beside it, so that their bars do not cover each other
        let step = 0.006 * x.width();
        for (index, table) in reported_first(self.tables, self.reported).enumerate() {
            let colour = colour_of_method(table.method);
            let side = if index % 2 == 0 { -1.0 } else { 1.0 };
            let aside = side * index.div_ceil(2) as f64 * step;
            canvas.plot(&panel, &format!("residuals method-{}", table.method.name()), |plot| {
                for point in points(table) {
                    let x = point.square + aside;
                    plot.line(&reported.ends_of(&point).map(|y| Point::new(x, y)), colour.stroke_width(3))?;
                    plot.dot(Point::new(x, reported.residual_of(&point)), DOT, colour.filled())?;
                }
                Ok(())
            })?;
            let at = |point: &LoadPoint<'_>| Point::new(point.square + aside, reported.residual_of(point));
            self.data(canvas, &panel, table, |ranges| ranges.residual_mn, at);
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
