//! Figure 8 of the paper: the maximum trace of the fundamental over time, for each load.

use crate::axis::{Axis, range_with_margin};
use crate::canvas::{Canvas, Panel, Place, WIDTH};
use crate::colour::{GRID, MUTED, colour_of_method};
use crate::figure::{Figure, FigureError};
use crate::geometry::{Extent, Point};
use crate::joined::{Joined, NAMES, end_s, joined_by_load, joined_words};
use crate::trial::{Trial, ridge_lines};
use hovertone_analysis::{Method, Ridge};
use plotters::style::Color;

const PANEL: i32 = 330;
const PITCH: i32 = 530;
const TOP: i32 = 90;
/// Room for the axis below the last panel.
const BELOW: i32 = 110;

/// `None` where no trial has a tone.
pub(crate) fn figure(trials: &[Trial<'_>]) -> Result<Option<Figure>, FigureError> {
    let loads: Vec<_> = joined_by_load(trials)
        .into_iter()
        .filter(|(_, joined)| joined.iter().any(|one| ridge(one).is_some()))
        .collect();
    let points_hz = || {
        loads.iter().flat_map(|(_, joined)| joined).filter_map(ridge).flat_map(|r| r.points_hz(Method::MaximumTrace))
    };
    let Some(range_hz) = range_with_margin(points_hz(), 0.05) else { return Ok(None) };
    let colour = colour_of_method(Method::MaximumTrace);
    let mut canvas = Canvas::new("figure-8-maximum-trace", TOP + (loads.len() as i32 - 1) * PITCH + PANEL + BELOW);
    for (index, (load, joined)) in loads.iter().enumerate() {
        let top = TOP + index as i32 * PITCH;
        let order = joined.iter().find_map(|one| Some(ridge(one)?.band.order.lines_per_turn()));
        let panel = Panel {
            place: Place { left: 180, top, right: WIDTH - 180, bottom: top + PANEL },
            x: Axis::new("joined time of the trials (s)", Extent::new(0.0, end_s(joined))).with_ticks(11),
            y: Axis::new("frequency (Hz)", range_hz).with_ticks(6),
            right: order.map(|order| ("shaft speed (rev/s)".to_owned(), order)),
            title: String::new(),
        };
        canvas.panel(&panel)?;
        canvas.plot(&panel, "trial-borders", |plot| {
            joined.iter().skip(1).try_for_each(|one| {
                let at_s = one.extent_s().low;
                plot.line(&[Point::new(at_s, range_hz.low), Point::new(at_s, range_hz.high)], GRID.stroke_width(3))
            })
        })?;
        for one in joined {
            let Some(ridge) = ridge(one) else { continue };
            canvas.plot(&panel, &format!("maximum-trace trial-{}", one.number), |plot| {
                ridge_lines(&ridge.frames, ridge.hop_s, Method::MaximumTrace).into_iter().try_for_each(|line| {
                    let line: Vec<Point> =
                        line.into_iter().map(|point| Point { x: point.x + one.shift_s, ..point }).collect();
                    plot.line(&line, colour.stroke_width(2))
                })
            })?;
            let points_hz = ridge.points_hz(Method::MaximumTrace);
            let mean_hz = points_hz.iter().sum::<f64>() / points_hz.len().max(1) as f64;
            canvas.plot(&panel, "mean", |plot| {
                let Extent { low: from_s, high: to_s } = one.extent_s();
                plot.dashed(Point::new(from_s, mean_hz), Point::new(to_s, mean_hz), MUTED, 3)
            })?;
        }
        joined_words(&mut canvas, &panel, load, joined)?;
    }
    let description = format!(
        "Frequency of the fundamental in every frame by the Maximum Trace method, one plot for each load, trials joined; \
                       dashed: the mean of each trial (eq 7). Where nothing stands out of the noise there is a gap. {NAMES}"
    );
    Ok(Some(canvas.finish("Figure 8: maximum trace of the fundamental over time", description)))
}

/// The lowest harmonic with a ridge.
fn ridge<'a>(one: &Joined<'a>) -> Option<&'a Ridge> {
    one.trial.tone()?.ridges.first().filter(|ridge| !ridge.points_hz(Method::MaximumTrace).is_empty())
}
