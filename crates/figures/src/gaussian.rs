//! Figure 9 of the paper: the traces of the fundamental and its harmonics, and the Gaussian beside them.

use crate::axis::{Axis, range_with_margin};
use crate::canvas::{Canvas, LETTER, Panel, Place, WIDTH};
use crate::colour::{GRID, colour_of_method};
use crate::figure::{Figure, FigureError, shortened};
use crate::geometry::{Extent, Point};
use crate::spectrum::harmonic_name;
use crate::trial::{Trial, hull, ridge_lines};
use hovertone_analysis::{Method, Ridge};
use plotters::style::Color;
use std::f64::consts::TAU;

const PANEL: i32 = 300;
const PITCH: i32 = 460;
const TOP: i32 = 120;
/// Number of bars of a distribution.
const BARS: usize = 40;
/// Number of points of a Gaussian curve.
const CURVE: usize = 160;

/// `None` where no trial has a tone.
pub(crate) fn figure(trials: &[Trial<'_>]) -> Result<Option<Figure>, FigureError> {
    let Some((trial, tone)) = trials.iter().find_map(|trial| Some((trial, trial.tone()?))) else { return Ok(None) };
    let ridges: Vec<&Ridge> = tone.ridges.iter().filter(|ridge| ridge.points_hz(Method::Gaussian).len() > 1).collect();
    let Some(span) = trial.hover().and_then(|hover| hull(hover.segments.iter().copied())) else { return Ok(None) };
    if ridges.is_empty() {
        return Ok(None);
    }
    let mut canvas = Canvas::new("figure-9-gaussian", TOP + ridges.len() as i32 * PITCH);
    let (trace, gaussian) = (colour_of_method(Method::MaximumTrace), colour_of_method(Method::Gaussian));
    canvas.layer("key", |sheet| {
        let next = sheet.key(Point::new(180, LETTER), trace, "maximum of each frame")?;
        let meaning = "centre of the Gaussian of each frame, and the Gaussian of all centres";
        sheet.key(Point::new(next, LETTER), gaussian, meaning).map(|_| ())
    })?;
    for (index, ridge) in ridges.iter().enumerate() {
        let top = TOP + index as i32 * PITCH;
        let all = ridge.points_hz(Method::MaximumTrace).into_iter().chain(ridge.points_hz(Method::Gaussian));
        let Some(range_hz) = range_with_margin(all, 0.08) else { continue };
        let over_time = Panel {
            place: Place { left: 180, top, right: 1240, bottom: top + PANEL },
            x: Axis::new("time (s)", Extent::of_span(span)).with_ticks(9),
            y: Axis::new("frequency (Hz)", range_hz).with_ticks(5),
            right: None,
            title: harmonic_name(ridge.band.harmonic),
        };
        canvas.panel(&over_time)?;
        for (class, method, colour) in
            [("maximum-trace", Method::MaximumTrace, trace), ("gaussian", Method::Gaussian, gaussian)]
        {
            canvas.plot(&over_time, &format!("{class} harmonic-{}", ridge.band.harmonic), |plot| {
                let lines = ridge_lines(&ridge.frames, ridge.hop_s, method);
                lines.iter().try_for_each(|line| plot.line(line, colour.stroke_width(2)))
            })?;
        }
        let centres_hz = ridge.points_hz(Method::Gaussian);
        let (mean_hz, std_hz) = mean_and_std(&centres_hz);
        let bars = bars(&centres_hz, range_hz);
        let bar_hz = range_hz.width() / BARS as f64;
        let density = |hz: f64| (-((hz - mean_hz) / std_hz).powi(2) / 2.0).exp() / (std_hz * TAU.sqrt());
        let highest = bars.iter().copied().fold(density(mean_hz), f64::max);
        let beside = Panel {
            place: Place { left: 1400, top, right: WIDTH - 60, bottom: top + PANEL },
            x: Axis::new("share per Hz", Extent::new(0.0, 1.08 * highest)).with_ticks(2),
            y: Axis::new("", range_hz).with_ticks(5),
            right: None,
            title: format!("{mean_hz:.1} Hz, STD {std_hz:.1} Hz"),
        };
        canvas.panel(&beside)?;
        canvas.plot(&beside, "distribution", |plot| {
            bars.iter().enumerate().try_for_each(|(bar, &share)| {
                let low_hz = range_hz.low + bar as f64 * bar_hz;
                plot.block(Extent::new(0.0, share), Extent::new(low_hz, low_hz + bar_hz), GRID, 1.0)
            })
        })?;
        canvas.plot(&beside, &format!("gaussian-curve harmonic-{}", ridge.band.harmonic), |plot| {
            let hz = |point: usize| range_hz.low + range_hz.width() * point as f64 / CURVE as f64;
            let curve: Vec<Point> = (0..=CURVE).map(|point| Point::new(density(hz(point)), hz(point))).collect();
            plot.line(&curve, gaussian.stroke_width(4))
        })?;
    }
    let description = format!(
        "Traces of the fundamental and its harmonics in {}; beside each, how often its Gaussian centres took which frequency, and the Gaussian with \
         their mean and standard deviation STD (eq 10, with the square that its print lacks).",
        shortened(trial.recording, 80)
    );
    Ok(Some(canvas.finish("Figure 9: traces with the Gaussian beside them", description)))
}

fn mean_and_std(values: &[f64]) -> (f64, f64) {
    let count = values.len() as f64;
    let mean = values.iter().sum::<f64>() / count;
    let variance = values.iter().map(|value| (value - mean).powi(2)).sum::<f64>() / (count - 1.0);
    // a steady tone has no visible width; a thousandth of a hertz is below the resolution of any frame
    (mean, variance.sqrt().max(1e-3))
}

/// Share of the values per hertz in each bar of a range.
fn bars(values: &[f64], range: Extent) -> Vec<f64> {
    let mut counts = vec![0.0; BARS];
    for value in values {
        let bar = (range.share_of(*value) * BARS as f64) as usize;
        counts[bar.min(BARS - 1)] += 1.0;
    }
    let unit = values.len() as f64 * range.width() / BARS as f64;
    counts.into_iter().map(|count: f64| count / unit).collect()
}
