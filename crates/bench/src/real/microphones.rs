//! Several microphones hear one rotor at the same moment: do their speeds differ as their uncertainties say?

use super::answer::{Answer, Status};
use super::hearing::duration_s;
use super::program::Program;
use super::progress::Progress;
use crate::accuracy::drawn;
use crate::document::Document;
use std::collections::BTreeMap;
use std::path::Path;

/// Recordings of one propeller by four microphones at once, beside the truth.
const FILES: [&str; 2] = ["cf_m1.wav", "cf_m3.wav"];
const CHANNELS: usize = 4;
/// Lengths of the windows, which follow each other without a gap.
const WINDOWS_S: [f64; 2] = [1.0, 1.5];
/// Speeds this far apart are of different readings: their difference says nothing about the uncertainty.
const SAME_SHARE: f64 = 0.1;

/// One window of one channel.
struct Listening {
    file: &'static str,
    window_s: f64,
    /// Number of the window.
    window: usize,
    /// Counted from 1, as `--channel` does.
    channel: usize,
}

impl Listening {
    fn flags(&self) -> Vec<String> {
        let at_s = |window: usize| (window as f64 * self.window_s).to_string();
        let words = ["--blades", "2", "--channel", &self.channel.to_string()].map(str::to_owned);
        let span = ["--from".to_owned(), at_s(self.window), "--to".to_owned(), at_s(self.window + 1)];
        words.into_iter().chain(span).collect()
    }

    fn is_at_the_moment_of(&self, other: &Self) -> bool {
        self.file == other.file && self.window_s == other.window_s && self.window == other.window
    }
}

/// What was heard in one window of one channel.
struct Heard {
    listening: Listening,
    answer: Answer,
}

/// Which uncertainty is meant.
#[derive(Clone, Copy)]
enum Stated {
    /// Of the sound alone.
    Sound,
    /// With clock and motion.
    Whole,
}

impl Stated {
    fn name(self) -> &'static str {
        match self {
            Self::Sound => "sound",
            Self::Whole => "whole",
        }
    }

    fn std_rev_s(self, answer: &Answer) -> Option<f64> {
        match self {
            Self::Sound => answer.std_uncertainty_rev_s,
            Self::Whole => answer.combined_std_uncertainty_rev_s,
        }
    }
}

/// Differences of all pairs of channels over their combined uncertainty.
#[derive(Default)]
struct Differences {
    ratios: Vec<f64>,
    /// Pairs whose speeds are of different readings.
    apart: usize,
}

impl Differences {
    /// Of all windows of which `is_meant` says so.
    fn of(all: &[Heard], stated: Stated, is_meant: impl Fn(&Listening) -> bool) -> Self {
        let mut differences = Self::default();
        for window in all.chunk_by(|a, b| a.listening.is_at_the_moment_of(&b.listening)) {
            if is_meant(&window[0].listening) {
                let told = window.iter().filter(|heard| heard.answer.status == Status::Ok);
                differences.add(&told.map(|heard| &heard.answer).collect::<Vec<_>>(), stated);
            }
        }
        differences
    }

    fn add(&mut self, answers: &[&Answer], stated: Stated) {
        for (index, a) in answers.iter().enumerate() {
            for b in &answers[index + 1..] {
                let (Some(speed_a), Some(speed_b)) = (a.speed_rev_s, b.speed_rev_s) else { continue };
                let (Some(std_a), Some(std_b)) = (stated.std_rev_s(a), stated.std_rev_s(b)) else { continue };
                if (speed_a / speed_b - 1.0).abs() > SAME_SHARE {
                    self.apart += 1;
                } else {
                    self.ratios.push((speed_a - speed_b).abs() / std_a.hypot(std_b));
                }
            }
        }
    }

    fn cells(&self) -> [String; 5] {
        let rms = (self.ratios.iter().map(|ratio| ratio * ratio).sum::<f64>() / self.ratios.len() as f64).sqrt();
        let mut sorted = self.ratios.clone();
        sorted.sort_by(f64::total_cmp);
        let shown = |value: Option<f64>| value.map_or("–".to_owned(), |value| format!("{value:.2}"));
        let rms = Some(rms).filter(|_| !sorted.is_empty());
        [
            sorted.len().to_string(),
            self.apart.to_string(),
            shown(rms),
            shown(sorted.get(sorted.len() / 2).copied()),
            shown(sorted.last().copied()),
        ]
    }
}

/// The section of the report.
pub(super) fn add_microphones(document: &mut Document, folder: &Path, program: &Program) -> Result<(), String> {
    let all = heard(folder, program)?;
    document.heading("Four microphones at once");
    document.paragraph(
        "`cf_m1.wav` and `cf_m3.wav`: one propeller, heard by four microphones at the same moment, in windows one after the other by `speed \
         --blades 2 --channel N --from S --to S`. Over all windows and pairs of channels: the difference of the two means over their combined \
         standard uncertainty, with the ± of the sound alone and with the whole ± (clock and motion too, which the channels share). If the ± of \
         the sound is true and the noise of the microphones independent, its rms is 1. Apart: pairs that differ by more than 10 %, which are of \
         different readings and left out.",
    );
    let mut lines = Vec::new();
    for window_s in WINDOWS_S {
        for file in FILES.map(Some).into_iter().chain([None]) {
            let is_meant = |listening: &Listening| {
                listening.window_s == window_s && file.is_none_or(|file| file == listening.file)
            };
            let meant = || all.iter().filter(|heard| is_meant(&heard.listening));
            let told = meant().filter(|heard| heard.answer.status == Status::Ok).count();
            for stated in [Stated::Sound, Stated::Whole] {
                let mut line = vec![format!("{window_s} s"), file.unwrap_or("both").to_owned()];
                line.extend([format!("{told} of {}", meant().count()), stated.name().to_owned()]);
                line.extend(Differences::of(&all, stated, is_meant).cells());
                lines.push(line);
            }
        }
    }
    document.table(&["window", "file", "answers", "±", "pairs", "apart", "rms", "median", "worst"], &lines);
    add_reasons(document, &all);
    Ok(())
}

fn heard(folder: &Path, program: &Program) -> Result<Vec<Heard>, String> {
    let mut all = Vec::new();
    for file in FILES {
        let duration_s = duration_s(&folder.join(file)).ok_or_else(|| format!("{file}: it cannot be read"))?;
        for window_s in WINDOWS_S {
            for window in 0..(duration_s / window_s).floor() as usize {
                all.extend((1..=CHANNELS).map(|channel| Listening { file, window_s, window, channel }));
            }
        }
    }
    let progress = Progress::new("windows of four microphones", all.len());
    let answers = drawn(all.len(), |number| {
        let answer = program.speed(&all[number].flags(), &folder.join(all[number].file))?;
        progress.step();
        Ok(answer)
    })?;
    Ok(all.into_iter().zip(answers).map(|(listening, answer)| Heard { listening, answer }).collect())
}

/// Why windows have no speed, the commonest reason first; numbers in it are left open.
fn add_reasons(document: &mut Document, all: &[Heard]) {
    let mut counts: BTreeMap<String, usize> = BTreeMap::new();
    for reason in all.iter().filter_map(|heard| heard.answer.reason.as_ref()) {
        *counts.entry(without_numbers(reason)).or_default() += 1;
    }
    let mut counts: Vec<(String, usize)> = counts.into_iter().collect();
    counts.sort_by_key(|(_, count)| std::cmp::Reverse(*count));
    for (reason, count) in counts {
        document.paragraph(&format!("{count} windows have no speed: {reason}."));
    }
}

/// "652 Hz" becomes "… Hz".
fn without_numbers(text: &str) -> String {
    let mut words =
        text.split(' ').map(|word| if word.starts_with(|letter: char| letter.is_ascii_digit()) { "…" } else { word });
    let first = words.next().unwrap_or_default().to_owned();
    words.fold(first, |text, word| text + " " + word)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn heard(window: usize, channel: usize, speed_rev_s: f64, std_rev_s: f64) -> Heard {
        let listening = Listening { file: FILES[0], window_s: 1.5, window, channel };
        let status = if speed_rev_s > 0.0 { Status::Ok } else { Status::NoRotorTone };
        let (speed_rev_s, std_uncertainty_rev_s) = (Some(speed_rev_s), Some(std_rev_s));
        Heard { listening, answer: Answer { status, speed_rev_s, std_uncertainty_rev_s, ..Answer::default() } }
    }

    #[test]
    fn every_pair_of_a_window_is_compared_and_no_other() {
        let all = [
            heard(0, 1, 100.0, 0.3),
            heard(0, 2, 100.5, 0.4),
            heard(0, 3, 0.0, 0.0),
            heard(1, 1, 90.0, 0.3),
            heard(1, 2, 91.0, 0.4),
            heard(1, 3, 45.0, 0.4),
        ];
        // 0.5 and 1 over the root of 0.3² + 0.4²; the octave is apart from both others
        let sound = Differences::of(&all, Stated::Sound, |_| true);
        assert_eq!(sound.cells(), ["2", "2", "1.58", "2.00", "2.00"]);
        assert_eq!(Differences::of(&all, Stated::Sound, |one| one.window == 0).cells()[0], "1");
        assert_eq!(Differences::of(&all, Stated::Whole, |_| true).cells(), ["0", "0", "–", "–", "–"]);
        assert_eq!(all[4].listening.flags().join(" "), "--blades 2 --channel 2 --from 1.5 --to 3");
    }

    #[test]
    fn reasons_are_alike_but_for_their_numbers() {
        assert_eq!(without_numbers("near 652.5 Hz, in 100 % of"), "near … Hz, in … % of");
    }
}
