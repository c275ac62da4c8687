//! Heard and logged speeds over each other, and their difference with its ± below.

use crate::axis::{Axis, range_with_margin};
use crate::canvas::{Canvas, LETTER, Panel, Place, WIDTH};
use crate::colour::{INK, SERIES};
use crate::figure::{Figure, FigureError};
use crate::geometry::Point;
use hovertone_analysis::{ComparedPoint, Verification};
use hovertone_vehicle::COVERAGE_FACTOR;
use plotters::style::{Color, RGBColor};

/// Most points of a curve.
const POINTS_MAX: usize = 3000;
/// Points further apart than this are not joined.
const GAP_S: f64 = 0.5;
/// Room above and below the curves, as a share of their range.
const MARGIN_SHARE: f64 = 0.08;
/// Opacity of the ±.
const OPACITY: f64 = 0.15;
const KEY: i32 = 300;

/// Two panels, one above the other; `None` without a compared rotor.
///
/// # Errors
/// Errors of the plotting library.
pub fn verification_figure(found: &Verification) -> Result<Option<Figure>, FigureError> {
    let points = || found.rotors.iter().flat_map(|rotor| &rotor.points);
    let times_s = points().map(|point| point.time_s);
    let Some(time_s) = range_with_margin(times_s, 0.0) else { return Ok(None) };
    let speeds = points().flat_map(|point| [point.heard_rev_s, point.logged_rev_s]);
    let Some(speed_rev_s) = range_with_margin(speeds, MARGIN_SHARE) else { return Ok(None) };
    let edges = points().flat_map(|point| [lower(point), upper(point), difference(point)]);
    let Some(difference_rev_s) = range_with_margin(edges.chain([0.0]), MARGIN_SHARE) else { return Ok(None) };
    let panel = |top: i32, bottom: i32, y: Axis, title: &str| Panel {
        place: Place { left: 180, top, right: WIDTH - 80, bottom },
        x: Axis::new("time (s)", time_s).with_ticks(11),
        y,
        right: None,
        title: title.to_owned(),
    };
    let above = Axis::new("shaft speed (rev/s)", speed_rev_s).with_ticks(8);
    let below = Axis::new("difference (rev/s)", difference_rev_s).with_ticks(6);
    let above = panel(100, 760, above, "heard (colour) and logged (black) speeds");
    let below = panel(930, 1330, below, "heard less logged speed, with ± (k = 2)");
    let mut canvas = Canvas::new("verification", 1460);
    canvas.panel(&above)?;
    canvas.panel(&below)?;
    for (index, rotor) in found.rotors.iter().enumerate() {
        let colour = colour_of(index);
        let lines = lines_of(&rotor.points);
        canvas.curve(&above, &format!("rotor rotor-{}", index + 1), &rotor.name, |plot| {
            for line in &lines {
                plot.line(&curve(line, |point| point.heard_rev_s), colour.stroke_width(4))?;
                plot.line(&curve(line, |point| point.logged_rev_s), INK.stroke_width(1))?;
            }
            Ok(())
        })?;
        canvas.curve(&below, &format!("difference rotor-{}", index + 1), &rotor.name, |plot| {
            for line in &lines {
                let mut outline = curve(line, upper);
                outline.extend(curve(line, lower).into_iter().rev());
                plot.area(&outline, colour, OPACITY)?;
                plot.line(&curve(line, difference), colour.stroke_width(2))?;
            }
            plot.dashed(Point::new(time_s.low, 0.0), Point::new(time_s.high, 0.0), INK, 1)
        })?;
    }
    canvas.layer("key", |sheet| {
        let mut at = Point::new(above.place.right - found.rotors.len() as i32 * KEY, above.place.top - LETTER + 4);
        for (index, rotor) in found.rotors.iter().enumerate() {
            at.x = sheet.key(at, colour_of(index), &rotor.name)?;
        }
        Ok(())
    })?;
    let words = format!(
        "Heard and logged speeds of {} over each other; below, the difference of each with its ±.",
        found.rotors.iter().map(|rotor| rotor.name.as_str()).collect::<Vec<_>>().join(", ")
    );
    Ok(Some(canvas.finish("Sound against telemetry", words)))
}

fn colour_of(index: usize) -> RGBColor {
    SERIES[index % SERIES.len()]
}

fn difference(point: &ComparedPoint) -> f64 {
    point.heard_rev_s - point.logged_rev_s
}

fn upper(point: &ComparedPoint) -> f64 {
    difference(point) + COVERAGE_FACTOR * point.std_uncertainty_rev_s
}

fn lower(point: &ComparedPoint) -> f64 {
    difference(point) - COVERAGE_FACTOR * point.std_uncertainty_rev_s
}

fn curve(line: &[ComparedPoint], value: fn(&ComparedPoint) -> f64) -> Vec<Point> {
    line.iter().map(|point| Point::new(point.time_s, value(point))).collect()
}

/// The points between gaps, thinned.
fn lines_of(points: &[ComparedPoint]) -> Vec<Vec<ComparedPoint>> {
    let stride = points.len().div_ceil(POINTS_MAX).max(1);
    let stretches = points.chunk_by(|before, after| after.time_s - before.time_s <= GAP_S);
    stretches.map(|stretch| stretch.iter().copied().step_by(stride).collect()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use hovertone_analysis::{Agreement, VerifiedRotor};

    #[test]
    fn each_rotor_has_a_curve_above_and_its_difference_below() {
        let point = |at: u32| ComparedPoint {
            time_s: 0.04 * f64::from(at),
            heard_rev_s: 60.1,
            std_uncertainty_rev_s: 0.1,
            logged_rev_s: 60.0,
        };
        let rotor = |track: usize| VerifiedRotor {
            track,
            motor: track,
            name: format!("motor {track}"),
            speed_rev_s: 60.1,
            bias_rev_s: 0.1,
            scatter_rev_s: 0.0,
            coverage: 1.0,
            point_count: 100,
            points: (0..50).chain(100..150).map(point).collect(),
        };
        let found = Verification {
            offset_s: 0.0,
            is_offset_told: true,
            is_offset_given: false,
            is_offset_at_limit: false,
            better_offset_s: None,
            agreement: Agreement::AsStated,
            clock_rate_share: None,
            rotors: vec![rotor(1), rotor(2)],
            speed_ratio: 1.0,
            near_ratio: None,
        };
        let figure = verification_figure(&found).unwrap().unwrap();
        for part in ["rotor rotor-1", "rotor rotor-2", "difference rotor-1", "difference rotor-2", "heard less logged"]
        {
            assert!(figure.svg.contains(part), "{part}");
        }
        assert_eq!(lines_of(&found.rotors[0].points).len(), 2);
        let none = Verification { rotors: Vec::new(), ..found };
        assert!(verification_figure(&none).unwrap().is_none());
    }
}
