//! Figure 5 of the paper, the database: loads, their trials, their samples, and the reasons for unused parts.

use crate::axis::Axis;
use crate::canvas::{Anchor, Canvas, LETTER, Panel, Place, Sheet, WIDTH};
use crate::colour::{GRID, INK, MUTED, SERIES};
use crate::figure::{Figure, FigureError, beginning, shortened, without_advice};
use crate::geometry::{Extent, Point};
use crate::trial::Trial;
use hovertone_analysis::{CutReason, Span};

const ROW: i32 = 62;
const LOAD_GAP: i32 = 56;
const TOP: i32 = 70;
const LEFT: i32 = 570;
/// Largest number of trials on the sheet; the others are only counted.
const TRIALS_MAX: usize = 60;
/// Fewest letters of text in a cut.
const LETTERS_MIN: i32 = 6;

/// `None` without trials.
pub(crate) fn figure(trials: &[Trial<'_>]) -> Result<Option<Figure>, FigureError> {
    let shown = &trials[..trials.len().min(TRIALS_MAX)];
    if shown.is_empty() {
        return Ok(None);
    }
    let from_s = shown.iter().filter_map(|trial| Some(trial.analysis?.heard.from_s)).fold(f64::INFINITY, f64::min);
    let to_s = shown.iter().filter_map(|trial| Some(trial.analysis?.heard.to_s)).fold(f64::NEG_INFINITY, f64::max);
    let range_s = if from_s < to_s { Extent::new(from_s, to_s) } else { Extent::new(0.0, 1.0) };
    let load_count = shown.chunk_by(|a, b| a.load == b.load).count() as i32;
    let bottom = TOP + shown.len() as i32 * ROW + load_count * LOAD_GAP;
    let panel = Panel {
        place: Place { left: LEFT, top: TOP, right: WIDTH - 60, bottom },
        x: Axis::new("time on the recording's own clock (s)", range_s).with_ticks(9),
        y: Axis::new("", Extent::new(0.0, 1.0)).with_ticks(0),
        right: None,
        title: String::new(),
    };
    let mut canvas = Canvas::new("figure-5-database", bottom + 110);
    canvas.panel_of_rows(&panel)?;
    let at = |time_s: f64| {
        let share = range_s.share_of(time_s);
        LEFT + (share.clamp(0.0, 1.0) * f64::from(panel.place.right - LEFT)).round() as i32
    };
    canvas.layer("key", |sheet| {
        let next = key(sheet, 60, SERIES[0], 0.85, "sample")?;
        let next = key(sheet, next, SERIES[4], 0.45, "hover")?;
        let next = key(sheet, next, GRID, 1.0, "cut")?;
        if trials.len() > shown.len() {
            sheet.text(
                &format!("the first {} of {} trials", shown.len(), trials.len()),
                Point::new(next, 26),
                Anchor::Left,
                INK,
            )?;
        }
        Ok(())
    })?;
    let mut top = TOP;
    for of_load in shown.chunk_by(|a, b| a.load == b.load) {
        canvas.layer("load", |sheet| {
            let samples: usize = of_load.iter().filter_map(Trial::tone).map(|tone| tone.samples.len()).sum();
            let used = of_load.iter().filter(|trial| trial.tone().is_some()).count();
            let words = format!(
                "{}: {used} of {} trials used, {samples} samples",
                shortened(of_load[0].load, 60),
                of_load.len()
            );
            sheet.text(&words, Point::new(40, top + LOAD_GAP / 2), Anchor::Left, INK)
        })?;
        top += LOAD_GAP;
        for trial in of_load {
            let class = if trial.tone().is_some() { "trial used" } else { "trial rejected" };
            canvas.layer(class, |sheet| row(sheet, trial, top, &at))?;
            top += ROW;
        }
    }
    let used = trials.iter().filter(|trial| trial.tone().is_some()).count();
    let samples: usize = trials.iter().filter_map(Trial::tone).map(|tone| tone.samples.len()).sum();
    let description = format!(
        "The database of the experiment, as figure 5 of the paper: {} trials, of which {used} are used, with {samples} samples in them. Each bar is a \
         recording; parts without hover are grey, with the reason.",
        trials.len()
    );
    Ok(Some(canvas.finish("Figure 5: the database", description)))
}

fn key(
    sheet: &Sheet<'_, '_>,
    left: i32,
    colour: plotters::style::RGBColor,
    opacity: f64,
    text: &str,
) -> Result<i32, FigureError> {
    sheet.filled(Place { left, top: 12, right: left + 40, bottom: 40 }, colour, opacity)?;
    sheet.text(text, Point::new(left + 52, 26), Anchor::Left, MUTED)?;
    Ok(left + 52 + text.chars().count() as i32 * LETTER * 3 / 5 + 30)
}

/// One recording: its name, and its time from left to right.
fn row(sheet: &Sheet<'_, '_>, trial: &Trial<'_>, top: i32, at: &impl Fn(f64) -> i32) -> Result<(), FigureError> {
    let bar = |span: Span, low: i32, high: i32| {
        let left = at(span.from_s);
        Place { left, top: top + low, right: at(span.to_s).max(left + 1), bottom: top + high }
    };
    sheet.text(&shortened(trial.recording, 30), Point::new(60, top + ROW / 2 - 4), Anchor::Left, MUTED)?;
    let Some(analysis) = trial.analysis else {
        let at = Point::new(LEFT + 12, top);
        return words(sheet, trial.reason.map_or("could not be read", without_advice), at, WIDTH - 60);
    };
    let Some(tone) = trial.tone() else {
        sheet.filled(bar(analysis.heard, 6, ROW - 14), GRID, 0.6)?;
        let at = Point::new(at(analysis.heard.from_s) + 12, top);
        return words(sheet, trial.reason.map_or("no rotor tone", without_advice), at, WIDTH - 60);
    };
    for cut in &analysis.hover.cuts {
        let place = bar(cut.span, 6, ROW - 14);
        sheet.filled(place, GRID, 1.0)?;
        // an edge needs no text
        if cut.reason != CutReason::Edge {
            words(sheet, &cut.reason.to_string(), Point::new(place.left + 8, top), place.right)?;
        }
    }
    for segment in &analysis.hover.segments {
        sheet.filled(bar(*segment, 6, ROW - 14), SERIES[4], 0.45)?;
    }
    // neighbours overlap, so they alternate above and below
    for (index, sample) in tone.samples.iter().enumerate() {
        let low = if index % 2 == 0 { 10 } else { ROW / 2 - 2 };
        let place = bar(sample.span, low, low + (ROW - 24) / 2 - 2);
        sheet.filled(
            Place { left: place.left + 1, right: (place.right - 1).max(place.left + 2), ..place },
            SERIES[0],
            0.85,
        )?;
    }
    sheet.outlined(bar(analysis.heard, 6, ROW - 14), MUTED)
}

/// Text that ends with the last word that has room; nothing where the room is too small.
fn words(sheet: &Sheet<'_, '_>, text: &str, at: Point<i32>, right: i32) -> Result<(), FigureError> {
    let letters = (right - at.x) / (LETTER * 11 / 20);
    if letters < LETTERS_MIN {
        return Ok(());
    }
    sheet.text(&beginning(text, letters as usize), Point { y: at.y + ROW / 2 - 4, ..at }, Anchor::Left, INK)
}
