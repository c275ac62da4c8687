//! The trials of a load one after the other, as the paper's figure 6 joins them.

use crate::canvas::{Anchor, Panel, Sheet};
use crate::colour::{INK, MUTED};
use crate::figure::{FigureError, shortened};
use crate::trial::Trial;
use hovertone_analysis::Span;

/// Trials narrower than these have their number alone, or nothing above them.
const WIDTH_OF_WORDS: f64 = 120.0;
const WIDTH_OF_NUMBER: f64 = 40.0;

/// A trial and where it stands on the joined axis.
#[derive(Clone, Copy)]
pub(crate) struct Joined<'a> {
    pub(crate) trial: Trial<'a>,
    /// Its number among the trials of its load, counted from 1.
    pub(crate) number: usize,
    /// What is shown of it, on the recording's own clock.
    pub(crate) shown: Span,
    /// Joined time less the recording's own.
    pub(crate) shift_s: f64,
}

/// The loads in their order, each with its trials that can be shown.
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

/// Where the joined trials of a load end.
pub(crate) fn end_s(joined: &[Joined<'_>]) -> f64 {
    joined.last().map_or(1.0, |last| last.shown.to_s + last.shift_s)
}

/// Above a panel: the name of its load, and the numbers of the trials where they have room.
pub(crate) fn joined_words(
    sheet: &Sheet<'_, '_>,
    panel: &Panel,
    load: &str,
    joined: &[Joined<'_>],
) -> Result<(), FigureError> {
    let (left, top) = (panel.place.left, panel.place.top);
    sheet.text(&shortened(load, 80), (left, top - 60), Anchor::Left, INK)?;
    let unit_per_s = f64::from(panel.place.right - left) / end_s(joined);
    for one in joined {
        let words = match one.shown.length_s() * unit_per_s {
            width if width >= WIDTH_OF_WORDS => format!("trial {}", one.number),
            width if width >= WIDTH_OF_NUMBER => one.number.to_string(),
            _ => continue,
        };
        let middle = f64::from(left) + (one.shown.middle_s() + one.shift_s) * unit_per_s;
        sheet.text(&words, (middle as i32, top - 24), Anchor::Middle, MUTED)?;
    }
    Ok(())
}
