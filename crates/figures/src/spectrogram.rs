//! The spectrogram of one recording with bands and cuts, and the tracks of all rotors over it.

use crate::axis::Axis;
use crate::canvas::{Anchor, Canvas, LETTER, Label, Panel, Place, WIDTH, text_width};
use crate::colour::{BAND, ColourMap, INK, MUTED, OVER_PICTURE, PAPER};
use crate::figure::{Figure, FigureError, beginning, shortened, without_advice};
use crate::geometry::{Extent, Point};
use crate::picture::Picture;
use crate::raster::{Raster, level_range_db};
use crate::readings;
use crate::rotors;
use crate::rotors::colour_of_rotor;
use crate::spectrum::harmonic_name;
use crate::trial::{Trial, coarser, common_lines, hull, in_hz, track_lines};
use hovertone_analysis::{Band, CutReason, RotorTone, RotorsHeard, Span};
use plotters::style::{Color, RGBColor};

const ROWS_MAX: usize = 280;
const COLUMNS_MAX: usize = 1024;
const TOP: i32 = 130;
const PITCH: i32 = 190;
/// Heights of the two panels.
const HEIGHTS: [i32; 2] = [560, 460];
/// How much of the picture a cut hides: its reason is read over it.
const CUT_OPACITY: f64 = 0.78;
/// Height of the line over the panel's title: the key, or the reason why there is no speed.
const OVER_TITLE: i32 = 66;
/// Cuts with a smaller gap touch.
const TOUCHING_S: f64 = 1e-6;

/// The spectrogram of a recording: all frequencies in Hz and as shaft speeds with the tracks of the rotors and the reasons of the cuts, and
/// below it a narrow band with the same tracks: the highest one where rotors are separated, else that of the tone. Where several speeds remain
/// possible, the track of the most plausible one, and lines where the tones of the others would be. `None` where the recording is too
/// short for a picture.
///
/// # Errors
/// Errors of the plotting library.
pub fn recording_figure(trial: &Trial<'_>, name: &str) -> Result<Option<Figure>, FigureError> {
    let Some(whole) = trial.whole() else { return Ok(None) };
    let first = trial.heard_bands().first();
    let zoom = first.and_then(|band| Some((band, trial.around(band.harmonic)?)));
    let has_rotors = trial.tone().is_some_and(|tone| !tone.rotors.is_empty());
    let heights = &HEIGHTS[..if zoom.is_some() { 2 } else { 1 }];
    let mut canvas = Canvas::new(name, TOP + heights.iter().sum::<i32>() + (heights.len() as i32 - 1) * PITCH + 120);
    let levels_db = level_range_db([whole], trial.lowest_line_hz());
    canvas.colour_bar(ColourMap::Viridis, levels_db)?;
    let place = |top: i32, height: i32| Place { left: 180, top, right: WIDTH - 180, bottom: top + height };
    draw_whole(&mut canvas, trial, whole, place(TOP, HEIGHTS[0]), levels_db)?;
    if let Some((band, picture)) = zoom {
        let below = place(TOP + HEIGHTS[0] + PITCH, HEIGHTS[1]);
        let is_drawn = has_rotors && rotors::draw(&mut canvas, trial, below)?.is_some();
        if !is_drawn {
            draw_zoom(&mut canvas, trial, band, picture, below)?;
        }
    }
    let words = match (trial.tone(), trial.reason) {
        (None, Some(reason)) if !trial.readings.is_empty() => {
            format!("{} Ambiguous: {reason}.", readings::description(trial.readings).unwrap_or_default())
        }
        (Some(_), _) => "Marked at both sides: the bands of the fundamental and its harmonics; pale: parts that are not used, with the reason. \
                         Below: a narrow band around one harmonic, with the tracks over it."
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
        right: trial.heard_tone_order().map(|order| (format!("frequency / {order} (rev/s)"), order)),
        title: shortened(trial.recording, 60),
    };
    canvas.panel(&panel)?;
    let raster = Raster::from_picture(picture, all_hz, levels_db, ColourMap::Viridis);
    canvas.picture(&panel, range_s, &raster.at_most(COLUMNS_MAX, ROWS_MAX))?;
    draw_cuts(canvas, trial, &panel, all_hz)?;
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
        draw_tracks(canvas, trial, tone, &panel)?;
    } else if !trial.readings.is_empty() {
        readings::draw(canvas, trial, &panel, range_s)?;
    } else if let Some(reason) = trial.reason {
        canvas.layer("reason", |sheet| {
            sheet.text(
                &beginning(without_advice(reason), 88),
                Point::new(place.left, place.top - OVER_TITLE),
                Anchor::Left,
                MUTED,
            )
        })?;
    }
    Ok(())
}

/// The parts that are not used, with the reason where there is room for it.
fn draw_cuts(canvas: &mut Canvas, trial: &Trial<'_>, panel: &Panel, all_hz: Extent) -> Result<(), FigureError> {
    let Some(hover) = trial.hover() else { return Ok(()) };
    canvas.plot(panel, "cuts", |plot| {
        hover.cuts.iter().try_for_each(|cut| plot.block(Extent::of_span(cut.span), all_hz, PAPER, CUT_OPACITY))
    })?;
    // the transition to another stretch needs no words
    let edges = || hover.cuts.iter().filter(|cut| cut.reason == CutReason::Edge).map(|cut| cut.span);
    for cut in hover.cuts.iter().filter(|cut| cut.reason != CutReason::Edge) {
        let words = cut.reason.to_string();
        // the transitions to both sides are room for the words
        let touching = |span: &Span| span.overlap(cut.span).length_s() > -TOUCHING_S;
        let span = hull(edges().filter(touching).chain([cut.span])).unwrap_or(cut.span);
        let room = panel.x_unit(span.to_s) - panel.x_unit(span.from_s);
        if text_width(&words) <= room {
            let middle_s = span.middle_s();
            let on_sheet = Point::new(panel.x_unit(middle_s), panel.place.top + LETTER);
            let label = Label { text: &words, x: middle_s, y: None, on_sheet, anchor: Anchor::Middle, colour: INK };
            canvas.label("reason-of-cut", &label)?;
        }
    }
    Ok(())
}

/// The tracks at the tone and its harmonics: of each rotor where they are separated, else the one that stands for all.
fn draw_tracks(canvas: &mut Canvas, trial: &Trial<'_>, tone: &RotorTone, panel: &Panel) -> Result<(), FigureError> {
    // coloured lines over a picture need to be wider than white ones
    let width = if tone.rotors.is_empty() { 2 } else { 3 };
    let mut at_all_bands = |class: &str, lines: &dyn Fn(&Band) -> Vec<Vec<Point>>, colour: RGBColor| {
        canvas.plot(panel, class, |plot| {
            let lines = trial.bands().iter().flat_map(|band| coarser(lines(band)));
            lines.into_iter().try_for_each(|line| plot.line(&line, colour.mix(0.9).stroke_width(width)))
        })
    };
    for (index, rotor) in tone.rotors.iter().enumerate() {
        let class = format!("tracks rotor-{}", index + 1);
        at_all_bands(&class, &|band| in_hz(track_lines(&rotor.track), band), colour_of_rotor(index))?;
    }
    if tone.rotors.is_empty() {
        return at_all_bands("tracks", &|band| common_lines(trial, tone, band), OVER_PICTURE);
    }
    let place = panel.place;
    rotors::draw_key(canvas, tone.rotors.len(), Point::new(place.right, place.top - OVER_TITLE))
}

fn draw_zoom(
    canvas: &mut Canvas,
    trial: &Trial<'_>,
    band: &hovertone_analysis::Band,
    picture: &Picture,
    place: Place,
) -> Result<(), FigureError> {
    let order = band.order.lines_per_turn();
    let meaning = match trial.heard_tone().and_then(|tone| tone.rotors_heard(trial.method)) {
        _ if !trial.readings.is_empty() => "track of the most plausible speed",
        _ if trial.method.reads_ridges() => "ridge",
        Some(RotorsHeard::Group) => "common track of the rotors",
        _ => "track",
    };
    let range_s = trial.whole().map_or(picture.span, |whole| whole.span);
    let range_hz = Extent::new(picture.hz_low, picture.hz_high);
    let panel = Panel {
        place,
        x: Axis::new("time (s)", Extent::of_span(range_s)).with_ticks(11),
        y: Axis::new("frequency (Hz)", range_hz).with_ticks(6),
        right: Some(("shaft speed (rev/s)".to_owned(), order)),
        title: trial
            .heard_tone()
            .map_or(String::new(), |_| format!("{}, with the {meaning}", harmonic_name(band.harmonic))),
    };
    canvas.panel(&panel)?;
    let raster = Raster::from_picture(picture, range_hz, level_range_db([picture], 0.0), ColourMap::Viridis);
    canvas.picture(&panel, Extent::of_span(picture.span), &raster.at_most(COLUMNS_MAX, ROWS_MAX))?;
    let Some(tone) = trial.heard_tone() else { return Ok(()) };
    let lines = common_lines(trial, tone, band);
    canvas.plot(&panel, "bands", |plot| {
        [band.band_hz_low, band.band_hz_high]
            .into_iter()
            .try_for_each(|hz| plot.dashed(Point::new(range_s.from_s, hz), Point::new(range_s.to_s, hz), BAND, 3))
    })?;
    canvas.curve(&panel, "track", meaning, |plot| {
        lines.iter().try_for_each(|line| {
            plot.line(line, INK.mix(0.85).stroke_width(7))?;
            plot.line(line, OVER_PICTURE.stroke_width(3))
        })
    })
}
