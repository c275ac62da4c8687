//! Predicted and observed speeds of the four rotors over time.

use crate::axis::Axis;
use crate::canvas::{Canvas, LETTER, Panel, Place, WIDTH};
use crate::colour::SERIES;
use crate::figure::{Figure, FigureError};
use crate::geometry::{Extent, Point};
use hovertone_dynamics::{SpeedObservation, SpeedPrediction};
use hovertone_vehicle::RotorSpeed;
use plotters::style::Color;

/// Most points of a curve, and most observations that are drawn of a rotor.
const POINTS_MAX: usize = 3000;
const DOTS_MAX: usize = 700;
/// Room above and below the curves, as a share of their range.
const MARGIN: f64 = 0.08;
/// An observation is drawn where its standard uncertainty is below this share of the range.
const STD_SHARE_MAX: f64 = 0.1;

/// Speeds to be drawn.
#[derive(Clone, Copy, Debug)]
pub struct DrawnSpeeds<'a> {
    /// The observed ones.
    pub observations: &'a [SpeedObservation],
    /// The predicted ones.
    pub prediction: &'a SpeedPrediction,
    /// Where the observed ones come from: "heard", "logged", or "true".
    pub source: &'static str,
    /// Names of the rotors.
    pub places: [&'static str; 4],
}

/// One panel with a curve for each rotor and its observations as dots.
///
/// # Errors
/// Errors of the plotting library.
pub fn grey_box_figure(drawn: &DrawnSpeeds<'_>) -> Result<Figure, FigureError> {
    let rev_s = |rad_s: f64| RotorSpeed::from_rad_s(rad_s).rev_s();
    let (slowest, fastest) = drawn.prediction.range_rad_s();
    let (slowest, fastest) = (rev_s(slowest), rev_s(fastest));
    let margin = MARGIN * (fastest - slowest).max(1e-3 * fastest);
    let prediction = drawn.prediction;
    let end_s = prediction.start_s + prediction.step_s * prediction.speed_rad_s.len() as f64;
    let place = Place { left: 180, top: 140, right: WIDTH - 80, bottom: 850 };
    let observed = drawn.source;
    let panel = Panel {
        place,
        x: Axis::new("time (s)", Extent::new(prediction.start_s, end_s)).with_ticks(11),
        y: Axis::new("shaft speed (rev/s)", Extent::new(slowest - margin, fastest + margin)).with_ticks(8),
        right: None,
        title: format!("predicted (lines) and {observed} (dots) speeds"),
    };
    let mut canvas = Canvas::new("grey-box", 980);
    canvas.panel(&panel)?;
    let stride = prediction.speed_rad_s.len().div_ceil(POINTS_MAX).max(1);
    for (rotor, name) in drawn.places.iter().enumerate() {
        let colour = SERIES[rotor % SERIES.len()];
        let point = |(at, speeds): (usize, &[f64; 4])| {
            Point::new(prediction.start_s + at as f64 * prediction.step_s, rev_s(speeds[rotor]))
        };
        let curve: Vec<Point> = prediction.speed_rad_s.iter().enumerate().step_by(stride).map(point).collect();
        let dots = dots_of(drawn, rotor, (fastest - slowest).max(1e-3 * fastest));
        canvas.curve(&panel, &format!("rotor rotor-{}", rotor + 1), name, |plot| {
            plot.line(&curve, colour.stroke_width(2))?;
            dots.iter().try_for_each(|dot| plot.dot(*dot, 4, colour.filled()))
        })?;
    }
    canvas.layer("key", |sheet| {
        let mut at = Point::new(place.left, LETTER - 4);
        for (rotor, name) in drawn.places.iter().enumerate() {
            at.x = sheet.key(at, SERIES[rotor % SERIES.len()], name)?;
        }
        Ok(())
    })?;
    let words = format!("Speeds of the four rotors: predicted by the model as lines, {observed} as dots.");
    Ok(canvas.finish(format!("Predicted and {observed} speeds"), words))
}

fn dots_of(drawn: &DrawnSpeeds<'_>, rotor: usize, range_rev_s: f64) -> Vec<Point> {
    let stride = drawn.observations.len().div_ceil(DOTS_MAX).max(1);
    let certain = drawn.observations.iter().step_by(stride).filter(|observation| {
        let variance =
            observation.information.try_inverse().map_or(f64::INFINITY, |covariance| covariance[(rotor, rotor)]);
        variance >= 0.0 && RotorSpeed::from_rad_s(variance.sqrt()).rev_s() < STD_SHARE_MAX * range_rev_s
    });
    let dot = |observation: &SpeedObservation| {
        Point::new(observation.time_s, RotorSpeed::from_rad_s(observation.speed_rad_s[rotor]).rev_s())
    };
    certain.map(dot).collect()
}
