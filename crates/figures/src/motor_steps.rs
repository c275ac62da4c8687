//! Steps of a motor: the log rows of all steps, each as a share of its step, with the fitted curves.

use crate::axis::Axis;
use crate::canvas::{Canvas, LETTER, Panel, Place, WIDTH};
use crate::colour::SERIES;
use crate::figure::{Figure, FigureError};
use crate::geometry::{Extent, Point};
use hovertone_dynamics::MotorStep;
use plotters::style::Color;

/// Shown time before and behind the start, in time constants.
const BEFORE: f64 = 2.0;
const BEHIND: f64 = 7.0;
const SHARES: Extent = Extent::new(-0.15, 1.2);
/// Points of a curve.
const CURVE_POINTS: u32 = 200;
/// Most log rows that are drawn of a step.
const ROWS_MAX: usize = 400;
const MS_PER_S: f64 = 1e3;
const KEY: i32 = 260;

/// A step with the log rows that it was found in.
#[derive(Clone, Copy, Debug)]
pub struct DrawnStep<'a> {
    /// Name of the motor.
    pub motor: &'a str,
    /// The step.
    pub step: &'a MotorStep,
    /// Times of the log rows, increasing.
    pub time_s: &'a [f64],
    /// Speeds of the log rows.
    pub speed_rev_s: &'a [f64],
}

/// All steps with a time constant, rising and falling ones in their colours; `None` without any.
///
/// # Errors
/// Errors of the plotting library.
pub fn motor_steps_figure(steps: &[DrawnStep<'_>]) -> Result<Option<Figure>, FigureError> {
    let time_constants_s = steps.iter().filter_map(|drawn| drawn.step.time_constant_s.map(|told| told.value));
    let Some(longest_s) = time_constants_s.reduce(f64::max) else { return Ok(None) };
    let shown_ms = Extent::new(-BEFORE * longest_s * MS_PER_S, BEHIND * longest_s * MS_PER_S);
    let place = Place { left: 180, top: 100, right: WIDTH - 80, bottom: 810 };
    let panel = Panel {
        place,
        x: Axis::new("time after the start of the step (ms)", shown_ms).with_ticks(11),
        y: Axis::new("share of the step", SHARES).with_ticks(8),
        right: None,
        title: "steps of the motor speed".to_owned(),
    };
    let mut canvas = Canvas::new("motor-steps", 940);
    canvas.panel(&panel)?;
    let told = || steps.iter().filter(|drawn| drawn.step.time_constant_s.is_some());
    for (number, drawn) in (1..).zip(told()) {
        let (colour, sense) = colour_of(drawn.step);
        let rows = rows_of(drawn, shown_ms);
        let curve: Vec<Point> = curve_of(drawn.step, shown_ms);
        canvas.curve(&panel, &format!("step step-{number}"), &format!("{}, {sense}", drawn.motor), |plot| {
            plot.line(&curve, colour.stroke_width(3))?;
            rows.iter().try_for_each(|row| plot.dot(*row, 5, colour.filled()))
        })?;
    }
    canvas.layer("key", |sheet| {
        let mut at = Point::new(place.right - 2 * KEY, place.top - LETTER + 4);
        for (colour, sense) in [(SERIES[0], "rising"), (SERIES[1], "falling")] {
            at.x = sheet.key(at, colour, sense)?;
        }
        Ok(())
    })?;
    let words = format!("{} steps as shares of their sizes, with the fitted curves of first order.", told().count());
    Ok(Some(canvas.finish("Steps of the motor speed", words)))
}

fn colour_of(step: &MotorStep) -> (plotters::style::RGBColor, &'static str) {
    if step.is_up() { (SERIES[0], "rising") } else { (SERIES[1], "falling") }
}

fn share_of(step: &MotorStep, speed_rev_s: f64) -> f64 {
    (speed_rev_s - step.speed_from_rev_s) / (step.speed_to_rev_s - step.speed_from_rev_s)
}

/// The log rows in the shown time, thinned to [`ROWS_MAX`].
fn rows_of(drawn: &DrawnStep<'_>, shown_ms: Extent) -> Vec<Point> {
    let start_s = drawn.step.time_s.value;
    let before = |limit_ms: f64| drawn.time_s.partition_point(|&time_s| (time_s - start_s) * MS_PER_S < limit_ms);
    let (from, to) = (before(shown_ms.low), before(shown_ms.high));
    let stride = (to - from).div_ceil(ROWS_MAX).max(1);
    let row = |at: usize| {
        let share = share_of(drawn.step, drawn.speed_rev_s[at]);
        Point::new((drawn.time_s[at] - start_s) * MS_PER_S, share)
    };
    (from..to).step_by(stride).map(row).collect()
}

fn curve_of(step: &MotorStep, shown_ms: Extent) -> Vec<Point> {
    let point = |at: u32| {
        let time_ms = shown_ms.low + shown_ms.width() * f64::from(at) / f64::from(CURVE_POINTS);
        let speed_rev_s = step.speed_rev_s_at(step.time_s.value + time_ms / MS_PER_S)?;
        Some(Point::new(time_ms, share_of(step, speed_rev_s)))
    };
    (0..=CURVE_POINTS).filter_map(point).collect()
}
