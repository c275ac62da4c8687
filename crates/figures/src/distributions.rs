//! Distributions of several quantities, each as curves of the share of the cases that have at most a value.

use crate::axis::{Axis, range_with_margin};
use crate::canvas::{Canvas, LETTER, Panel, Place, WIDTH};
use crate::colour::SERIES;
use crate::figure::{Figure, FigureError};
use crate::geometry::{Extent, Point};
use plotters::style::Color;

const COLUMNS: i32 = 3;
/// Height of the plot of a panel, and of a row of panels with its words.
const PLOT: i32 = 300;
const ROW: i32 = PLOT + 150;
const TOP: i32 = 80;
const LEFT: i32 = 120;
const GAP: i32 = 90;
const LINE: u32 = 4;
/// Margin of an axis beside its values, as a share of their range.
const MARGIN_SHARE: f64 = 0.04;

/// A quantity and its values in each set of cases.
#[derive(Clone, Debug, PartialEq)]
pub struct Distribution {
    /// Quantity with its unit.
    pub title: String,
    /// The values of each set, in the sequence of the names of the sets.
    pub values: Vec<Vec<f64>>,
}

/// Distributions beside each other, with one colour for each set. Values that are not finite count, and are not drawn.
///
/// # Errors
/// An error of the plotting library.
pub fn distributions_figure(
    name: &str,
    title: &str,
    sets: &[&str],
    quantities: &[Distribution],
) -> Result<Figure, FigureError> {
    let rows = (quantities.len() as i32).div_euclid(COLUMNS) + i32::from(quantities.len() as i32 % COLUMNS > 0);
    let mut canvas = Canvas::new(name, TOP + rows * ROW);
    for (quantity, place) in quantities.iter().zip((0..).map(place_of)) {
        let all = quantity.values.iter().flatten().copied();
        let shown = range_with_margin(all, MARGIN_SHARE).unwrap_or(Extent::new(0.0, 1.0));
        let panel = Panel {
            place,
            x: Axis::new(&quantity.title, shown).with_ticks(5),
            y: Axis::new("", Extent::new(0.0, 1.0)).with_ticks(5),
            right: None,
            title: String::new(),
        };
        canvas.panel(&panel)?;
        canvas.plot(&panel, "distributions", |plot| {
            for (values, colour) in quantity.values.iter().zip(SERIES) {
                plot.line(&steps_of(values, shown), colour.stroke_width(LINE))?;
            }
            Ok(())
        })?;
    }
    canvas.layer("key", |sheet| {
        let mut at = Point::new(LEFT, TOP / 2 - LETTER / 4);
        for (set, colour) in sets.iter().zip(SERIES) {
            at.x = sheet.key(at, colour, set)?;
        }
        Ok(())
    })?;
    let description = format!("Shares of the cases that have at most a value: {}.", sets.join("; "));
    Ok(canvas.finish(title, description))
}

fn place_of(number: i32) -> Place {
    let width = (WIDTH - LEFT - GAP / 2 - (COLUMNS - 1) * GAP) / COLUMNS;
    let left = LEFT + number % COLUMNS * (width + GAP);
    let top = TOP + number / COLUMNS * ROW;
    Place { left, top, right: left + width, bottom: top + PLOT }
}

/// The share of the values up to each place of the axis, as steps.
fn steps_of(values: &[f64], shown: Extent) -> Vec<Point> {
    let mut sorted = values.to_vec();
    sorted.sort_by(f64::total_cmp);
    let count = sorted.len() as f64;
    let mut share = sorted.iter().take_while(|value| **value < shown.low).count() as f64 / count;
    let mut steps = vec![Point::new(shown.low, if count > 0.0 { share } else { 0.0 })];
    for value in sorted.into_iter().filter(|value| (shown.low..=shown.high).contains(value)) {
        steps.push(Point::new(value, share));
        share += 1.0 / count;
        steps.push(Point::new(value, share));
    }
    steps.extend(steps.last().copied().map(|last| Point { x: shown.high, ..last }));
    steps
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shares_rise_by_one_step_at_each_value() {
        let steps = steps_of(&[2.0, f64::NEG_INFINITY, 1.0, f64::INFINITY], Extent::new(0.0, 3.0));
        let pairs: Vec<(f64, f64)> = steps.iter().map(|point| point.pair()).collect();
        assert_eq!(pairs, [(0.0, 0.25), (1.0, 0.25), (1.0, 0.5), (2.0, 0.5), (2.0, 0.75), (3.0, 0.75)]);
    }

    #[test]
    fn each_set_has_a_curve_in_each_panel() {
        let quantity = |title: &str| Distribution { title: title.to_owned(), values: vec![vec![1.0, 2.0], vec![3.0]] };
        let quantities = [quantity("fall"), quantity("offset (dB)"), quantity("scatter (dB)"), quantity("nats")];
        let figure = distributions_figure("levels", "Levels", &["simulated", "real"], &quantities).unwrap();
        assert_eq!(figure.svg.matches("class=\"distributions\"").count(), 4);
        assert!(figure.svg.contains("offset (dB)") && figure.svg.contains("simulated"));
        let empty = Distribution { title: "none".to_owned(), values: vec![Vec::new(), Vec::new()] };
        assert!(distributions_figure("levels", "Levels", &["simulated", "real"], &[empty]).is_ok());
    }
}
