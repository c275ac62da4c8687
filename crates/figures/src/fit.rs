//! Weight against squared speed with the fitted square law, its interval, and the residuals.

use crate::axis::{Axis, range_with_margin};
use crate::canvas::{Anchor, Canvas, LETTER, Panel, Place, WIDTH};
use crate::colour::{INK, MUTED, colour_of_method};
use crate::figure::{Figure, FigureError, shortened};
use hovertone_analysis::Method;
use hovertone_thrust::{COVERAGE_FACTOR, LoadThrust, ThrustTable};
use plotters::style::Color;

/// Squared speeds are shown in this unit.
const SQUARE_UNIT: f64 = 1e3;
const DOT: u32 = 9;

/// A load as a point: squared speed, force of all rotors, and the expanded uncertainty of that force against the law.
struct Point<'a> {
    load: &'a LoadThrust,
    square: f64,
    force_n: f64,
    expanded_n: Option<f64>,
    square_expanded: Option<f64>,
}

fn points(table: &ThrustTable) -> Vec<Point<'_>> {
    let point = |load: &'_ LoadThrust| {
        let (speed, constant) = (load.speed?.rad_s(), load.thrust_constant_total_n_s2?);
        Some((speed, constant))
    };
    table
        .loads
        .iter()
        .filter_map(|load| {
            let (speed_rad_s, constant) = point(load)?;
            let square = speed_rad_s.powi(2);
            Some(Point {
                load,
                square: square / SQUARE_UNIT,
                // on a bench fewer rotors carry it: what all of them would carry
                force_n: constant.value * square,
                expanded_n: constant.std_uncertainty.map(|std| COVERAGE_FACTOR * std * square),
                square_expanded: load
                    .std_uncertainty_rad_s
                    .map(|std| COVERAGE_FACTOR * 2.0 * speed_rad_s * std / SQUARE_UNIT),
            })
        })
        .collect()
}

/// `None` where no load was heard.
pub(crate) fn figure(tables: &[ThrustTable], reported: Method) -> Result<Option<Figure>, FigureError> {
    let Some(table) = tables.iter().find(|table| table.method == reported) else { return Ok(None) };
    let Some(fit) = &table.fit else { return Ok(None) };
    let all = || tables.iter().flat_map(points);
    let Some(mut range_x) = range_with_margin(all().map(|point| point.square), 0.25) else { return Ok(None) };
    let widest = all().filter_map(|point| point.square_expanded).fold(0.004 * range_x.1, f64::max);
    range_x = ((range_x.0 - widest).max(0.0), range_x.1 + widest);
    let constant = fit.thrust_constant_n_s2.value * SQUARE_UNIT;
    let expanded_share = table.budget.as_ref().map_or(0.0, |budget| budget.expanded_share);
    let law = |share: f64| move |x: f64| constant * (1.0 + share) * x;
    let forces = all().map(|point| point.force_n).chain([law(0.0)(range_x.0), law(0.0)(range_x.1)]);
    let Some(range_y) = range_with_margin(forces, 0.1) else { return Ok(None) };
    let squared_speed = "squared shaft speed ω² (1000 rad²/s²)";
    let mut canvas = Canvas::new("fit", 1340);
    let panel = Panel {
        place: Place { left: 200, top: 60, right: WIDTH - 60, bottom: 720 },
        x: Axis::new("", range_x).with_ticks(9),
        y: Axis::new("force of all rotors (N)", range_y).with_ticks(7),
        right: None,
        title: String::new(),
    };
    let band = |share: f64, over_law: bool| -> Vec<(f64, f64)> {
        let at = |x: f64, share: f64| (x, law(share)(x) - if over_law { law(0.0)(x) } else { 0.0 });
        vec![at(range_x.0, -share), at(range_x.1, -share), at(range_x.1, share), at(range_x.0, share)]
    };
    let colour = colour_of_method(reported);
    canvas.panel(&panel)?;
    canvas.plot(&panel, "interval", |plot| plot.area(&band(expanded_share, false), colour, 0.18))?;
    if let Some(other) = fit.with_intercept {
        canvas.plot(&panel, "with-intercept", |plot| {
            let at = |x: f64| (x, other.intercept_n.value + other.thrust_constant_n_s2.value * SQUARE_UNIT * x);
            plot.dashed(at(range_x.0), at(range_x.1), MUTED, 2)
        })?;
    }
    for table in reported_last(tables, reported) {
        let Some(fit) = &table.fit else { continue };
        let (colour, name) = (colour_of_method(table.method), table.method.name());
        canvas.plot(&panel, &format!("law method-{name}"), |plot| {
            let at = |x: f64| (x, fit.thrust_constant_n_s2.value * SQUARE_UNIT * x);
            plot.line(
                &[at(range_x.0), at(range_x.1)],
                colour.stroke_width(if table.method == reported { 4 } else { 2 }),
            )
        })?;
        canvas.plot(&panel, &format!("points method-{name}"), |plot| {
            for point in points(table) {
                if let Some(half) = point.square_expanded {
                    let ends = [(point.square - half, point.force_n), (point.square + half, point.force_n)];
                    plot.line(&ends, colour.stroke_width(3))?;
                }
                let is_left_out = point.load.fits == Some(false);
                plot.dot(
                    (point.square, point.force_n),
                    DOT,
                    if is_left_out { MUTED.filled() } else { colour.filled() },
                )?;
            }
            Ok(())
        })?;
    }
    canvas.layer("names", |sheet| {
        for point in points(table) {
            let x = share_of(point.square, range_x, (200, WIDTH - 60));
            let y = share_of(point.force_n, range_y, (720, 60));
            let mark = if point.load.fits == Some(false) { " (does not fit)" } else { "" };
            sheet.text(&format!("{}{mark}", shortened(&point.load.name, 30)), (x - 24, y - 26), Anchor::Right, INK)?;
        }
        Ok(())
    })?;
    residuals(&mut canvas, tables, reported, (constant, range_x, squared_speed), &band(expanded_share, true))?;
    canvas.layer("key", |sheet| {
        let mut at = (200, LETTER - 4);
        for table in tables.iter().filter(|table| table.fit.is_some()) {
            at.0 = sheet.key(at, colour_of_method(table.method), &table.method.name().replace('_', " "))?;
        }
        if fit.with_intercept.is_some() {
            sheet.text("dashed: with an intercept", at, Anchor::Left, MUTED)?;
        }
        Ok(())
    })?;
    let description = "Force against squared shaft speed of every load, with the fitted square law F = C ω² of each method and the expanded \
                       uncertainty (k = 2) of the reported one, shaded. Below: how far each load is off the reported law; vertical bars are its own \
                       expanded uncertainty.";
    Ok(Some(canvas.finish("Weight against squared speed: the fit and its residuals", description)))
}

/// What is reported lies over the others.
fn reported_last(tables: &[ThrustTable], reported: Method) -> impl Iterator<Item = &ThrustTable> {
    let is_reported = move |table: &&ThrustTable| table.method == reported;
    tables.iter().filter(move |table| !is_reported(table)).chain(tables.iter().filter(is_reported))
}

fn share_of(value: f64, (low, high): (f64, f64), (from, to): (i32, i32)) -> i32 {
    from + ((value - low) / (high - low) * f64::from(to - from)).round() as i32
}

fn residuals(
    canvas: &mut Canvas,
    tables: &[ThrustTable],
    reported: Method,
    (constant, range_x, x_title): (f64, (f64, f64), &str),
    interval: &[(f64, f64)],
) -> Result<(), FigureError> {
    const MILLI: f64 = 1e3;
    let residual = |point: &Point<'_>| MILLI * (point.force_n - constant * point.square);
    let ends = |point: &Point<'_>| {
        let half = MILLI * point.expanded_n.unwrap_or(0.0);
        [residual(point) - half, residual(point) + half]
    };
    let of_points = tables.iter().flat_map(points).flat_map(|point| ends(&point));
    let of_interval = interval.iter().map(|(_, force_n)| MILLI * force_n);
    let Some(range_y) = range_with_margin(of_points.chain(of_interval), 0.1) else { return Ok(()) };
    let panel = Panel {
        place: Place { left: 200, top: 850, right: WIDTH - 60, bottom: 1220 },
        x: Axis::new(x_title, range_x).with_ticks(9),
        y: Axis::new("residual (mN)", range_y).with_ticks(6),
        right: None,
        title: String::new(),
    };
    canvas.panel(&panel)?;
    canvas.plot(&panel, "interval", |plot| {
        let milli: Vec<(f64, f64)> = interval.iter().map(|&(x, force_n)| (x, MILLI * force_n)).collect();
        plot.area(&milli, colour_of_method(reported), 0.18)
    })?;
    canvas.plot(&panel, "zero", |plot| plot.line(&[(range_x.0, 0.0), (range_x.1, 0.0)], INK.stroke_width(1)))?;
    // methods stand beside each other, so that their bars can be told apart
    let step = 0.006 * (range_x.1 - range_x.0);
    for (index, table) in tables.iter().enumerate() {
        let colour = colour_of_method(table.method);
        let aside = (index as f64 - (tables.len() as f64 - 1.0) / 2.0) * step;
        canvas.plot(&panel, &format!("residuals method-{}", table.method.name()), |plot| {
            for point in points(table) {
                let [low, high] = ends(&point);
                plot.line(&[(point.square + aside, low), (point.square + aside, high)], colour.stroke_width(3))?;
                plot.dot((point.square + aside, residual(&point)), DOT, colour.filled())?;
            }
            Ok(())
        })?;
    }
    Ok(())
}
