//! The spectrogram of one recording with bands and cuts, and the ridge or the rotors over it.

use crate::axis::Axis;
use crate::canvas::{Anchor, Canvas, Panel, Place, WIDTH};
use crate::colour::{BAND, ColourMap, INK, MUTED, OVER_PICTURE, PAPER};
use crate::figure::{Figure, FigureError, shortened};
use crate::geometry::{Extent, Point};
use crate::picture::Picture;
use crate::raster::{Raster, level_range_db};
use crate::rotors;
use crate::spectrum::harmonic_name;
use crate::trial::{Trial, ridge_lines, track_lines};
use hovertone_analysis::Method;
use plotters::style::Color;

const ROWS_MAX: usize = 330;
const COLUMNS_MAX: usize = 2048;
const TOP: i32 = 130;
const PITCH: i32 = 190;

/// The spectrogram of a recording: all frequencies in Hz and as shaft speeds, the band around the tone with the ridge over it, and the
/// separated rotors. `None` where the recording is too short for a picture.
///
/// # Errors
/// Errors of the plotting library.
pub fn recording_figure(trial: &Trial<'_>, name: &str) -> Result<Option<Figure>, FigureError> {
    let Some(whole) = trial.whole() else { return Ok(None) };
    let first = trial.bands().first();
    let zoom = first.and_then(|band| Some((band, trial.around(band.harmonic)?)));
    let has_rotors = trial.tone().is_some_and(|tone| !tone.rotors.is_empty());
    let heights = [560, if zoom.is_some() { 420 } else { 0 }, if has_rotors && zoom.is_some() { 420 } else { 0 }];
    let count = heights.iter().filter(|&&height| height > 0).count() as i32;
    let mut canvas = Canvas::new(name, TOP + heights.iter().sum::<i32>() + (count - 1) * PITCH + 120);
    let levels_db = level_range_db([whole]);
    canvas.colour_bar(ColourMap::Viridis, levels_db)?;
    let mut top = TOP;
    let mut place = |height: i32| {
        let place = Place { left: 180, top, right: WIDTH - 180, bottom: top + height };
        top += height + PITCH;
        place
    };
    draw_whole(&mut canvas, trial, whole, place(heights[0]), levels_db)?;
    if let Some((band, picture)) = zoom {
        draw_zoom(&mut canvas, trial, band, picture, place(heights[1]))?;
    }
    if heights[2] > 0 {
        rotors::draw(&mut canvas, trial, place(heights[2]))?;
    }
    let words = match (trial.tone(), trial.reason) {
        (Some(_), _) => "Marked at both sides: the bands of the fundamental and its harmonics; dimmed: parts without hover. Below: the band of the \
                         tone, with the ridge over it."
            .to_owned(),
        (None, Some(reason)) => format!("No speed: {reason}."),
        (None, None) => String::new(),
    };
    Ok(Some(canvas.finish(
        format!("Spectrogram of {}", shortened(trial.recording, 80)),
        format!("Level of the sound of {} over time and frequency. {words}", trial.recording),
    )))
}

fn draw_whole(
    canvas: &mut Canvas,
    trial: &Trial<'_>,
    picture: &Picture,
    place: Place,
    levels_db: Extent,
) -> Result<(), FigureError> {
    let range_s = Extent::of_span(picture.span);
    let all_hz = Extent::new(0.0, picture.hz_high);
    let panel = Panel {
        place,
        x: Axis::new("time (s)", range_s).with_ticks(11),
        y: Axis::new("frequency (Hz)", all_hz).with_ticks(8),
        // shaft speeds of the fundamental; harmonic k lies at k times its shaft speed
        right: trial.tone_order().map(|order| (format!("frequency / {order} (rev/s)"), order)),
        title: shortened(trial.recording, 60),
    };
    canvas.panel(&panel)?;
    let raster = Raster::from_picture(picture, all_hz, levels_db, ColourMap::Viridis);
    canvas.picture(&panel, range_s, &raster.at_most(COLUMNS_MAX, ROWS_MAX))?;
    if let Some(hover) = trial.hover() {
        canvas.plot(&panel, "cuts", |plot| {
            hover.cuts.iter().try_for_each(|cut| plot.block(Extent::of_span(cut.span), all_hz, PAPER, 0.45))
        })?;
    }
    // bands are marked at both sides and by thin edges, where they do not hide the tone
    canvas.plot(&panel, "bands", |plot| {
        let flag_s = 0.012 * range_s.width();
        for band in trial.bands() {
            let edges_hz = Extent::new(band.band_hz_low, band.band_hz_high);
            for hz in [edges_hz.low, edges_hz.high] {
                plot.dashed(Point::new(range_s.low, hz), Point::new(range_s.high, hz), BAND, 2)?;
            }
            plot.block(Extent::new(range_s.low, range_s.low + flag_s), edges_hz, BAND, 1.0)?;
            plot.block(Extent::new(range_s.high - flag_s, range_s.high), edges_hz, BAND, 1.0)?;
        }
        Ok(())
    })?;
    if let Some(tone) = trial.tone() {
        canvas.plot(&panel, "ridges", |plot| {
            for ridge in &tone.ridges {
                for line in ridge_lines(&ridge.frames, ridge.hop_s, Method::MaximumTrace) {
                    plot.line(&line, OVER_PICTURE.mix(0.7).stroke_width(1))?;
                }
            }
            Ok(())
        })?;
    } else if let Some(reason) = trial.reason {
        canvas.layer("reason", |sheet| {
            sheet.text(&shortened(reason, 110), Point::new(place.left, place.top - 66), Anchor::Left, MUTED)
        })?;
    }
    Ok(())
}

fn draw_zoom(
    canvas: &mut Canvas,
    trial: &Trial<'_>,
    band: &hovertone_analysis::Band,
    picture: &Picture,
    place: Place,
) -> Result<(), FigureError> {
    let order = band.order.lines_per_turn();
    let range_s = trial.whole().map_or(picture.span, |whole| whole.span);
    let range_hz = Extent::new(picture.hz_low, picture.hz_high);
    let panel = Panel {
        place,
        x: Axis::new("time (s)", Extent::of_span(range_s)).with_ticks(11),
        y: Axis::new("frequency (Hz)", range_hz).with_ticks(6),
        right: Some(("shaft speed (rev/s)".to_owned(), order)),
        title: format!("{}, with the ridge", harmonic_name(band.harmonic)),
    };
    canvas.panel(&panel)?;
    let raster = Raster::from_picture(picture, range_hz, level_range_db([picture]), ColourMap::Viridis);
    canvas.picture(&panel, Extent::of_span(picture.span), &raster.at_most(COLUMNS_MAX, ROWS_MAX))?;
    let Some(tone) = trial.tone() else { return Ok(()) };
    // the ridge, if a method of the paper was requested, else the track of the speed
    let lines = if trial.method.name() == Method::MaximumTrace.name() || tone.track.is_empty() {
        let ridge = tone.ridges.iter().find(|ridge| ridge.band.harmonic == band.harmonic);
        ridge.map_or(Vec::new(), |ridge| ridge_lines(&ridge.frames, ridge.hop_s, Method::MaximumTrace))
    } else {
        let in_hz = |line: Vec<Point>| line.into_iter().map(|point| Point { y: order * point.y, ..point }).collect();
        track_lines(&tone.track).into_iter().map(in_hz).collect()
    };
    canvas.plot(&panel, "bands", |plot| {
        [band.band_hz_low, band.band_hz_high]
            .into_iter()
            .try_for_each(|hz| plot.dashed(Point::new(range_s.from_s, hz), Point::new(range_s.to_s, hz), BAND, 3))
    })?;
    canvas.plot(&panel, "track", |plot| {
        lines.iter().try_for_each(|line| {
            plot.line(line, INK.mix(0.85).stroke_width(7))?;
            plot.line(line, OVER_PICTURE.stroke_width(3))
        })
    })
}
