//! Separated rotors: the spectrogram around a high harmonic, with the track of each rotor over it.

use crate::axis::{Axis, range_with_margin};
use crate::canvas::{Canvas, LETTER, Panel, Place, WIDTH};
use crate::colour::{ColourMap, INK, OVER_PICTURE, SERIES};
use crate::figure::{Figure, FigureError};
use crate::geometry::{Extent, Point};
use crate::picture::Picture;
use crate::raster::{Raster, level_range_db};
use crate::spectrum::harmonic_name;
use crate::trial::{Trial, track_lines};
use hovertone_analysis::RotorEstimate;
use plotters::style::{Color, RGBColor};

/// Margin around the tracks, as a share of their range.
const MARGIN_SHARE: f64 = 0.35;
const ROWS_MAX: usize = 400;
/// Width of the key of one rotor, and with more rotors than have room for the word.
const KEY: i32 = 225;
const SHORT_KEY: i32 = 118;
const LONG_KEYS_MAX: usize = 5;

/// The separated rotors of a trial; `None` where they are not separated, or without a picture of a harmonic.
///
/// # Errors
/// Errors of the plotting library.
pub fn rotors_figure(trial: &Trial<'_>, name: &str) -> Result<Option<Figure>, FigureError> {
    let mut canvas = Canvas::new(name, 940);
    let place = Place { left: 180, top: 100, right: WIDTH - 180, bottom: 810 };
    let Some(words) = draw(&mut canvas, trial, place)? else { return Ok(None) };
    Ok(Some(canvas.finish(format!("Separated rotors: {}", trial.recording), words)))
}

/// Draws the panel and returns its description; `None` without separated rotors or picture.
pub(crate) fn draw(canvas: &mut Canvas, trial: &Trial<'_>, place: Place) -> Result<Option<String>, FigureError> {
    let Some(tone) = trial.tone().filter(|tone| !tone.rotors.is_empty()) else { return Ok(None) };
    let Some((picture, band)) = tone.bands.iter().rev().find_map(|band| Some((trial.around(band.harmonic)?, band)))
    else {
        return Ok(None);
    };
    let order = band.order.lines_per_turn();
    let Some(range_hz) = range_of(&tone.rotors, order, picture) else { return Ok(None) };
    let panel = Panel {
        place,
        x: Axis::new("time (s)", Extent::of_span(picture.span)).with_ticks(11),
        y: Axis::new("frequency (Hz)", range_hz).with_ticks(7),
        right: Some(("shaft speed (rev/s)".to_owned(), order)),
        title: format!("separated rotors, {}", harmonic_name(band.harmonic)),
    };
    canvas.panel(&panel)?;
    let raster = Raster::from_picture(picture, range_hz, level_range_db([picture], 0.0), ColourMap::Greys);
    canvas.picture(&panel, Extent::of_span(picture.span), &raster.at_most(2048, ROWS_MAX))?;
    for (index, rotor) in tone.rotors.iter().enumerate() {
        let name = format!("rotor {}", index + 1);
        canvas.curve(&panel, &format!("rotor rotor-{}", index + 1), &name, |plot| {
            for line in track_lines(&rotor.track) {
                let line: Vec<Point> = line.into_iter().map(|point| Point { y: order * point.y, ..point }).collect();
                plot.line(&line, OVER_PICTURE.mix(0.8).stroke_width(7))?;
                plot.line(&line, colour_of_rotor(index).stroke_width(3))?;
            }
            Ok(())
        })?;
    }
    draw_key(canvas, tone.rotors.len(), Point::new(place.right, place.top - LETTER + 4))?;
    Ok(Some(format!(
        "The {} separated rotors of {}: the track of each, times the order {order} of the {}, over the spectrogram.",
        tone.rotors.len(),
        trial.recording,
        harmonic_name(band.harmonic)
    )))
}

/// The colour of each rotor, up to the right end of the line.
pub(crate) fn draw_key(canvas: &mut Canvas, count: usize, right_end: Point<i32>) -> Result<(), FigureError> {
    canvas.layer("key rotors", |sheet| {
        let (width, word) = if count > LONG_KEYS_MAX { (SHORT_KEY, "") } else { (KEY, "rotor ") };
        let mut at = Point { x: right_end.x - count as i32 * width, ..right_end };
        for index in 0..count {
            at.x = sheet.key(at, colour_of_rotor(index), &format!("{word}{}", index + 1))?;
        }
        Ok(())
    })
}

pub(crate) fn colour_of_rotor(index: usize) -> RGBColor {
    SERIES.get(index % (SERIES.len() + 1)).copied().unwrap_or(INK)
}

/// Range of all tracks with a margin, within the picture.
fn range_of(rotors: &[RotorEstimate], order: f64, picture: &Picture) -> Option<Extent> {
    let speeds = rotors.iter().flat_map(|rotor| rotor.track.iter().map(|point| order * point.speed_rev_s));
    let tracks_hz = range_with_margin(speeds, MARGIN_SHARE)?;
    let range_hz = Extent::new(tracks_hz.low.max(picture.hz_low), tracks_hz.high.min(picture.hz_high));
    (range_hz.low < range_hz.high).then_some(range_hz)
}
