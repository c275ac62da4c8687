//! The trials of a load in sequence on one time axis, as in figure 6 of the paper.

use crate::canvas::{Anchor, Canvas, LETTER, Label, Panel};
use crate::colour::{INK, MUTED};
use crate::figure::{FigureError, shortened};
use crate::geometry::{Extent, Point};
use crate::trial::Trial;
use hovertone_analysis::Span;

/// Narrower trials have no text above them, units of the sheet.
const WIDTH_OF_NUMBER: f64 = 40.0;
/// What the text above the panels means, for descriptions.
pub(crate) const NAMES_OR_NUMBERS: &str = "Where names have no room, numbers count the recordings of the load in the order of figure 5, with those that are not used.";

/// A trial with its position on the joined axis.
#[derive(Clone, Copy)]
pub(crate) struct Joined<'a> {
    pub(crate) trial: Trial<'a>,
    /// Its number among the trials of its load, counted from 1.
    pub(crate) number: usize,
    /// The shown part, on the clock of the recording.
    pub(crate) shown: Span,
    /// Time on the joined axis minus time of the recording.
    pub(crate) shift_s: f64,
}

impl Joined<'_> {
    /// Extent on the joined axis, s.
    pub(crate) fn extent_s(&self) -> Extent {
        Extent::new(self.shown.from_s + self.shift_s, self.shown.to_s + self.shift_s)
    }
}

/// The loads in their order, each with its trials that have a picture.
pub(crate) fn joined_by_load<'a>(trials: &[Trial<'a>]) -> Vec<(&'a str, Vec<Joined<'a>>)> {
    trials
        .chunk_by(|a, b| a.load == b.load)
        .map(|of_load| {
            let mut end_s = 0.0;
            let joined = (1..)
                .zip(of_load)
                .filter_map(|(number, trial)| Some((number, trial, trial.whole()?.span)))
                .map(|(number, &trial, shown)| {
                    let shift_s = end_s - shown.from_s;
                    end_s += shown.length_s();
                    Joined { trial, number, shown, shift_s }
                })
                .collect();
            (of_load[0].load, joined)
        })
        .filter(|(_, joined): &(&str, Vec<Joined<'_>>)| !joined.is_empty())
        .collect()
}

/// End of the joined trials of a load.
pub(crate) fn end_s(joined: &[Joined<'_>]) -> f64 {
    joined.last().map_or(1.0, |last| last.shown.to_s + last.shift_s)
}

/// Text above a panel: the name of its load; the names of the trials where all fit, else their numbers where they fit.
pub(crate) fn joined_words(
    canvas: &mut Canvas,
    panel: &Panel,
    load: &str,
    joined: &[Joined<'_>],
) -> Result<(), FigureError> {
    let (left, top) = (panel.place.left, panel.place.top);
    canvas.layer("load", |sheet| sheet.text(&shortened(load, 80), Point::new(left, top - 60), Anchor::Left, INK))?;
    let unit_per_s = f64::from(panel.place.right - left) / end_s(joined);
    let width = |one: &Joined<'_>| one.shown.length_s() * unit_per_s;
    // one more letter than the name has: neighbours stay apart
    let has_room = |one: &Joined<'_>| width(one) >= letters_width(one.trial.recording.chars().count() + 1);
    let has_names = joined.iter().all(has_room);
    for one in joined.iter().filter(|one| has_names || width(one) >= WIDTH_OF_NUMBER) {
        let words = if has_names { shortened(one.trial.recording, usize::MAX) } else { one.number.to_string() };
        let middle_s = one.shown.middle_s() + one.shift_s;
        let on_sheet = Point::new(panel.x_unit(middle_s), top - 24);
        let label = Label { text: &words, x: middle_s, y: None, on_sheet, anchor: Anchor::Middle, colour: MUTED };
        canvas.label("trial-name", &label)?;
    }
    Ok(())
}

/// Room that a text needs, units of the sheet.
fn letters_width(letters: usize) -> f64 {
    letters as f64 * f64::from(LETTER * 3 / 5)
}
