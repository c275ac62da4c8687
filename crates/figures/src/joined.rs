//! The trials of a load in sequence on one time axis, as in figure 6 of the paper.

use crate::canvas::{Anchor, Canvas, LETTER, Label, Panel};
use crate::colour::{INK, MUTED};
use crate::figure::{FigureError, shortened};
use crate::geometry::{Extent, Point};
use crate::trial::Trial;
use hovertone_analysis::Span;

/// Text above the panels, for descriptions.
pub(crate) const NAMES: &str =
    "Where the names of the recordings have no room, the part in which they differ stands in their place.";

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

/// Text above a panel: the name of its load; the names of the trials, or the part in which they differ where not all have room.
pub(crate) fn joined_words(
    canvas: &mut Canvas,
    panel: &Panel,
    load: &str,
    joined: &[Joined<'_>],
) -> Result<(), FigureError> {
    let (left, top) = (panel.place.left, panel.place.top);
    canvas.layer("load", |sheet| sheet.text(&shortened(load, 80), Point::new(left, top - 60), Anchor::Left, INK))?;
    let unit_per_s = f64::from(panel.place.right - left) / end_s(joined);
    // one more letter than the name has: neighbours stay apart
    let has_room =
        |one: &Joined<'_>, name: &str| one.shown.length_s() * unit_per_s >= letters_width(name.chars().count() + 1);
    let names: Vec<&str> = joined.iter().map(|one| one.trial.recording).collect();
    let have_room = joined.iter().zip(&names).all(|(one, name)| has_room(one, name));
    let shown = if have_room { names } else { distinct_parts(&names) };
    for (one, name) in joined.iter().zip(shown).filter(|(one, name)| has_room(one, name)) {
        let words = shortened(name, usize::MAX);
        let middle_s = one.shown.middle_s() + one.shift_s;
        let on_sheet = Point::new(panel.x_unit(middle_s), top - 24);
        let label = Label { text: &words, x: middle_s, y: None, on_sheet, anchor: Anchor::Middle, colour: MUTED };
        canvas.label("trial-name", &label)?;
    }
    Ok(())
}

/// The names without the beginning and the ending that all of them share; numbers stay whole.
fn distinct_parts<'a>(names: &[&'a str]) -> Vec<&'a str> {
    let Some(first) = names.first() else { return Vec::new() };
    let is_of_all = |start: &&str| names.iter().all(|name| name.starts_with(start));
    let starts = first.char_indices().map(|(end, _)| &first[..end]);
    let start = starts.take_while(is_of_all).last().unwrap_or_default();
    let start = start.trim_end_matches(|letter: char| letter.is_ascii_digit());
    let ending = first.rfind('.').map_or("", |dot| &first[dot..]);
    let part = |name: &'a str| name.strip_prefix(start)?.strip_suffix(ending).filter(|part| !part.is_empty());
    let parts: Option<Vec<&str>> = names.iter().map(|name| part(name)).collect();
    parts.unwrap_or_else(|| names.to_vec())
}

/// Room that a text needs, units of the sheet.
fn letters_width(letters: usize) -> f64 {
    letters as f64 * f64::from(LETTER * 3 / 5)
}

#[cfg(test)]
mod tests {
    use super::distinct_parts;

    #[test]
    fn names_without_room_keep_the_part_in_which_they_differ() {
        assert_eq!(distinct_parts(&["long_name_0.wav", "long_name_3.wav"]), ["0", "3"]);
        assert_eq!(distinct_parts(&["trial_10.wav", "trial_11.wav", "trial_1.wav"]), ["10", "11", "1"]);
        assert_eq!(distinct_parts(&["a.wav", "ab.wav"]), ["a.wav", "ab.wav"]);
        assert_eq!(distinct_parts(&["a.wav", "b.mov"]), ["a.wav", "b.mov"]);
        assert_eq!(distinct_parts(&["größe_1", "größe_2"]), ["1", "2"]);
    }
}
