//! The readings of an ambiguous tone over a spectrogram: the track of the most plausible one, and where the tones of the others would be.

use crate::canvas::{Canvas, Panel, Sheet, WIDTH};
use crate::colour::OVER_PICTURE;
use crate::figure::FigureError;
use crate::geometry::{Extent, Point};
use crate::rotors::colour_of_rotor;
use crate::trial::{Trial, coarser, common_lines};
use hovertone_analysis::Reading;
use plotters::style::Color;

/// Tones this near are one line of the picture: readings of one tone that differ in its order.
const SAME_LINE_SHARE: f64 = 0.02;
/// Smallest plausibility of a reading in the key.
const SHOWN_MIN: f64 = 0.01;
/// Height of the key over the panel.
const KEY_UP: i32 = 66;

/// Draws the readings over the spectrogram of all frequencies, and the key above it.
pub(crate) fn draw(canvas: &mut Canvas, trial: &Trial<'_>, panel: &Panel, range_s: Extent) -> Result<(), FigureError> {
    let lines = lines_of(trial.readings);
    let Some((_, others)) = lines.split_first() else { return Ok(()) };
    if let Some(tone) = trial.heard_tone() {
        canvas.plot(panel, "tracks reading-1", |plot| {
            let lines = tone.bands.iter().flat_map(|band| coarser(common_lines(trial, tone, band)));
            lines.into_iter().try_for_each(|line| {
                plot.line(&line, OVER_PICTURE.mix(0.8).stroke_width(7))?;
                plot.line(&line, colour_of_rotor(0).stroke_width(3))
            })
        })?;
    }
    for (index, line) in (1..).zip(others) {
        let [reading, ..] = line.as_slice() else { continue };
        canvas.plot(panel, &format!("reading reading-{}", index + 1), |plot| {
            let at = |time_s: f64| Point::new(time_s, reading.tone_hz);
            let (from, to) = (at(range_s.low), at(range_s.high));
            plot.line(&[from, to], OVER_PICTURE.mix(0.8).stroke_width(7))?;
            plot.dashed(from, to, colour_of_rotor(index), 4)
        })?;
    }
    canvas.layer("key readings", |sheet| key(sheet, &lines, panel))
}

/// The readings of each line of the picture: those of one tone differ in its order. The line of the most plausible reading is first.
fn lines_of(readings: &[Reading]) -> Vec<Vec<&Reading>> {
    let mut lines: Vec<Vec<&Reading>> = Vec::new();
    for reading in readings {
        match lines.iter_mut().find(|line| line.first().is_some_and(|first| is_same_line(first, reading))) {
            Some(line) => line.push(reading),
            None => lines.push(vec![reading]),
        }
    }
    lines
}

/// The meaning of each line, with its readings of a per cent or more; what has no room is named in the description alone.
fn key(sheet: &Sheet<'_, '_>, lines: &[Vec<&Reading>], panel: &Panel) -> Result<(), FigureError> {
    let mut at = Point::new(panel.place.left, panel.place.top - KEY_UP);
    for (index, line) in lines.iter().enumerate() {
        let shown = line.iter().enumerate().filter(|(at, reading)| *at == 0 || reading.plausibility >= SHOWN_MIN);
        let words = shown.map(|(_, reading)| in_words(reading)).collect::<Vec<_>>().join(", ");
        if at.x + Sheet::key_width(&words) > WIDTH {
            break;
        }
        let colour = colour_of_rotor(index);
        at.x = if index == 0 { sheet.key(at, colour, &words)? } else { sheet.dashed_key(at, colour, &words)? };
    }
    Ok(())
}

fn is_same_line(first: &Reading, other: &Reading) -> bool {
    (other.tone_hz / first.tone_hz - 1.0).abs() < SAME_LINE_SHARE
}

/// "52.4 rev/s (62 %)".
fn in_words(reading: &Reading) -> String {
    format!("{:.1} rev/s ({:.0} %)", reading.speed.rev_s(), 100.0 * reading.plausibility)
}

/// What the lines mean, as a sentence of the description.
pub(crate) fn description(readings: &[Reading]) -> Option<String> {
    let (first, others) = readings.split_first()?;
    let (same, apart): (Vec<&Reading>, Vec<&Reading>) = others.iter().partition(|other| is_same_line(first, other));
    let listed =
        |readings: &[&Reading]| readings.iter().map(|reading| in_words(reading)).collect::<Vec<_>>().join(", ");
    let mut words =
        format!("Several speeds remain possible. Solid: the track of the most plausible one, {}", in_words(first));
    if !same.is_empty() {
        words += &format!("; the same line with another order: {}", listed(&same));
    }
    if !apart.is_empty() {
        words += &format!("; dashed: where the tones of the others would be, {}", listed(&apart));
    }
    Some(words + ".")
}
