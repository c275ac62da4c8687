//! The line of a tone family: what it is, its lines, level and time.

use crate::number::significant;
use crate::recording::SpeedRecord;
use hovertone_analysis::{Remark, SeenHarmonic, ToneFamily};

/// Digits of a frequency or speed from the survey.
pub(crate) const DIGITS: usize = 4;
/// Standard deviation of a fundamental over time, Hz, up to which a tone is steady: it has two decimals.
const STEADY_HZ: f64 = 0.1;

/// A tone that sounds for more of its time has no breaks that count.
const UNBROKEN_SHARE: f64 = 0.95;

/// A tone that moves by more (standard deviation) has no single frequency.
const MOVING_SHARE: f64 = 0.002;

/// What was heard: the recording, or a part of it.
#[derive(Clone, Copy)]
pub(crate) struct Whole {
    length_s: f64,
    name: &'static str,
}

impl Whole {
    /// The part of a recording that was chosen, or all of it.
    pub(crate) fn of(record: &SpeedRecord) -> Self {
        let is_part = ["/span/from_s", "/span/to_s"].iter().any(|place| record.setting(place).is_some());
        Self {
            length_s: record.analysis().map_or(f64::INFINITY, |analysis| analysis.heard.length_s()),
            name: if is_part { "the chosen part" } else { "the recording" },
        }
    }
}

/// "rotor: harmonics 1–9 of 360.2 Hz, 31 dB over the noise, all the time".
pub(crate) fn kind_and_place(kind: &str, family: &ToneFamily, whole: Whole) -> String {
    let Whole { length_s: heard_s, name: whole } = whole;
    let is_unbroken = family.time_share * heard_s >= UNBROKEN_SHARE * family.span.length_s();
    let time = match (100.0 * family.time_share).round() {
        100.0 => "all the time".to_owned(),
        _ if is_unbroken => format!("from {:.1} to {:.1} s", family.span.from_s, family.span.to_s),
        percent => {
            format!(
                "on and off from {:.1} to {:.1} s, in {percent:.0} % of {whole}",
                family.span.from_s, family.span.to_s
            )
        }
    };
    let fundamental = significant(family.fundamental_hz, digits(family));
    let lines = match family.harmonics.len() {
        0 => format!("faint lines at multiples of {fundamental} Hz"),
        1 if kind == Remark::SingleLine.text() => format!("{fundamental} Hz"),
        1 => format!("a {} at {fundamental} Hz", Remark::SingleLine.text()),
        _ => {
            let is_moving = family.spread_hz.is_some_and(|spread_hz| spread_hz > MOVING_SHARE * family.fundamental_hz);
            let about = if is_moving { "about " } else { "" };
            format!("harmonics {} of {about}{fundamental} Hz", numbers_in_words(&family.harmonics))
        }
    };
    let level =
        if family.harmonics.is_empty() { String::new() } else { format!(", {:.0} dB over the noise", family.level_db) };
    format!("{kind}: {lines}{level}, {time}")
}

/// "1–4, 6, 8".
fn numbers_in_words(harmonics: &[SeenHarmonic]) -> String {
    let mut ranges: Vec<(u32, u32)> = Vec::new();
    for number in harmonics.iter().map(|line| line.number) {
        match ranges.last_mut().filter(|range| range.1 + 1 == number) {
            Some(range) => range.1 = number,
            None => ranges.push((number, number)),
        }
    }
    let words = ranges.into_iter().map(|(first, last)| match last - first {
        0 => first.to_string(),
        1 => format!("{first}, {last}"),
        _ => format!("{first}–{last}"),
    });
    words.collect::<Vec<_>>().join(", ")
}

/// Digits of the frequencies and speeds of a family.
pub(crate) fn digits(family: &ToneFamily) -> usize {
    let is_steady = family.spread_hz.is_some_and(|spread_hz| spread_hz < STEADY_HZ);
    let decimals = family.fundamental_hz.log10().floor().max(0.0) as usize + 3;
    if is_steady { DIGITS.max(decimals) } else { DIGITS }
}
