//! Warnings about recordings, folded: a kind of warning that several recordings have is one line with their names.

use crate::cuts::{cut_in_short, cuts_in_words};
use crate::names::short_names;
use crate::notice::Notice;
use crate::quote::counted;
use crate::recording::SpeedRecord;

/// Fewer recordings stand side by side: only what both have in the same words is folded.
const RECORDINGS_MIN: usize = 3;
/// Most names in a line.
const NAMES_MAX: usize = 6;
/// Most names after "all but".
const EXCEPTIONS_MAX: usize = 3;
/// Words whose number is a name: warnings about another one are of another kind.
const NUMBERED: [&str; 1] = ["harmonic"];
/// Sign for a number in the shape of a text.
const NUMBER: &str = "#";

/// A kind of warning that at least two recordings have. Texts of one kind differ in their numbers alone.
#[derive(Clone, Debug, PartialEq)]
pub struct FoldedWarning {
    /// The warning with its ranges of numbers and its recordings: "12–15 % of the frames hold no tone (in 2 of 9 recordings: a.wav, b.wav)".
    pub notice: Notice,
    /// The warning with its ranges of numbers alone: "12–15 % of the frames hold no tone".
    pub what: String,
    /// How many recordings have it: "2 of 9 recordings".
    pub counted: String,
    /// Whether it is the reason for missing speeds.
    pub is_missing_speed: bool,
    /// Whether all recordings have it in the same words.
    pub is_of_all: bool,
    shape: Vec<String>,
    hint: String,
}

impl FoldedWarning {
    /// Whether a warning of a recording is of this kind.
    fn has(&self, notice: &Notice) -> bool {
        notice.hint == self.hint && shape(&notice.text) == self.shape
    }
}

/// The kinds of warnings that several recordings have, in the order in which the recordings name them.
pub fn folded_warnings(records: &[&SpeedRecord]) -> Vec<FoldedWarning> {
    let files: Vec<&str> = records.iter().map(|record| record.file.as_str()).collect();
    let names = short_names(&files);
    let all: Vec<Vec<Notice>> = records.iter().map(|record| told_notices(record)).collect();
    let missing = kinds_of(&records.iter().map(|record| missing_speed(record)).collect::<Vec<_>>(), &names);
    let missing = missing.into_iter().map(|kind| FoldedWarning { is_missing_speed: true, ..kind });
    let is_folded = |kind: &FoldedWarning| records.len() >= RECORDINGS_MIN || kind.is_of_all;
    missing.chain(kinds_of(&all, &names)).filter(is_folded).collect()
}

/// The warnings of one recording that are not folded.
pub fn own_notices<'a>(record: &'a SpeedRecord, folded: &[FoldedWarning]) -> Vec<&'a Notice> {
    let is_folded = |notice: &&Notice| folded.iter().any(|kind| !kind.is_missing_speed && kind.has(notice));
    record.notices.iter().filter(|notice| !record.has_failed() && !is_folded(notice)).collect()
}

/// The warnings of one recording that not all recordings have in the same words.
pub fn distinct_notices<'a>(record: &'a SpeedRecord, folded: &[FoldedWarning]) -> Vec<&'a Notice> {
    let is_of_all = |notice: &&Notice| folded.iter().any(|kind| kind.is_of_all && kind.has(notice));
    record.notices.iter().filter(|notice| !record.has_failed() && !is_of_all(notice)).collect()
}

/// The reason for a missing speed, where it is not folded.
pub fn own_reason(record: &SpeedRecord, folded: &[FoldedWarning]) -> Option<String> {
    let is_folded = |notice: &Notice| folded.iter().any(|kind| kind.is_missing_speed && kind.has(notice));
    record.reason().filter(|_| !missing_speed(record).iter().any(is_folded))
}

/// Number of lines of warnings about recordings. A recording without a speed is one, where its reason is not folded; a file that failed has an
/// error, and is none.
pub fn warning_count(records: &[&SpeedRecord]) -> usize {
    let folded = folded_warnings(records);
    let folded_reasons = folded.iter().filter(|kind| kind.is_missing_speed).count();
    let own_reasons = records.iter().filter(|record| own_reason(record, &folded).is_some() && !record.has_failed());
    lines_of_warnings(records, &folded) + folded_reasons + own_reasons.count()
}

/// Number of lines of warnings, without the reasons for missing speeds.
fn lines_of_warnings(records: &[&SpeedRecord], folded: &[FoldedWarning]) -> usize {
    let of_several = folded.iter().filter(|kind| !kind.is_missing_speed).count();
    of_several + records.iter().map(|record| own_notices(record, folded).len()).sum::<usize>()
}

/// "1 recording without a speed, 2 warnings": what stands above the speeds of recordings. `others` are warnings about something else than the
/// recordings. `None` where there is nothing to tell.
pub fn weaknesses_in_words(records: &[&SpeedRecord], others: usize) -> Option<String> {
    let ambiguous = records.iter().filter(|record| record.is_ambiguous()).count();
    let failed = records.iter().filter(|record| record.has_failed()).count();
    let without = records.iter().filter(|record| record.reason().is_some() && !record.has_failed()).count() - ambiguous;
    let warnings = others + lines_of_warnings(records, &folded_warnings(records));
    // an error alone needs no count
    let failed = if without + ambiguous + warnings > 0 { failed } else { 0 };
    let mut words = Vec::new();
    let states =
        [(failed, "that could not be read"), (without, "without a speed"), (ambiguous, "with several possible speeds")];
    for (count, what) in states {
        if count > 0 {
            words.push(format!("{} {what}", counted(count, "recording")));
        }
    }
    if warnings > 0 {
        words.push(counted(warnings, "warning"));
    }
    (!words.is_empty()).then(|| words.join(", "))
}

/// The warnings of a recording that could be read.
fn told_notices(record: &SpeedRecord) -> Vec<Notice> {
    if record.has_failed() { Vec::new() } else { record.notices.clone() }
}

/// The cuts that several recordings have for the same reasons, as lines of their own; where they lie is in the columns of used times.
pub fn folded_cuts(records: &[&SpeedRecord]) -> Vec<FoldedWarning> {
    if records.len() < RECORDINGS_MIN {
        return Vec::new();
    }
    let files: Vec<&str> = records.iter().map(|record| record.file.as_str()).collect();
    kinds_of(
        &records.iter().map(|record| cut_of(record).into_iter().collect()).collect::<Vec<_>>(),
        &short_names(&files),
    )
}

/// The cuts of one recording in words, where they are not folded.
pub fn own_cuts(record: &SpeedRecord, folded: &[FoldedWarning]) -> Option<String> {
    let cut = cut_of(record)?;
    let cuts = cuts_in_words(&record.analysis()?.hover.cuts);
    cuts.filter(|_| !folded.iter().any(|kind| kind.has(&cut)))
}

/// What was cut from a recording with a speed.
fn cut_of(record: &SpeedRecord) -> Option<Notice> {
    let analysis = record.analysis().filter(|_| record.reason().is_none())?;
    Some(Notice::new(cut_in_short(&analysis.hover.cuts)?, ""))
}

/// The reason for a missing speed of a recording that could be read.
fn missing_speed(record: &SpeedRecord) -> Vec<Notice> {
    let label = record.missing_speed_label();
    let reason = record.reason().filter(|_| !record.has_failed());
    reason.map(|reason| Notice::new(format!("{label}: {reason}"), "")).into_iter().collect()
}

/// The kinds that at least two of the recordings have; `all` and `names` are by recording.
fn kinds_of(all: &[Vec<Notice>], names: &[String]) -> Vec<FoldedWarning> {
    let mut kinds: Vec<FoldedWarning> = Vec::new();
    for notice in all.iter().flatten() {
        if kinds.iter().any(|kind| kind.has(notice)) {
            continue;
        }
        let mut kind = FoldedWarning {
            notice: notice.clone(),
            what: String::new(),
            counted: String::new(),
            is_missing_speed: false,
            is_of_all: all.iter().all(|notices| notices.contains(notice)),
            shape: shape(&notice.text),
            hint: notice.hint.clone(),
        };
        let with: Vec<bool> = all.iter().map(|notices| notices.iter().any(|other| kind.has(other))).collect();
        let texts: Vec<&str> =
            all.iter().flatten().filter(|other| kind.has(other)).map(|other| other.text.as_str()).collect();
        kind.what = text_of_all(&texts);
        kind.counted = counted_recordings(&with);
        kind.notice.text = format!("{} (in {})", kind.what, recordings_in_words(&with, names));
        if with.iter().filter(|has| **has).count() > 1 {
            kinds.push(kind);
        }
    }
    kinds
}

/// "all 15 recordings", "14 of 15 recordings: all but trial_3.wav", "2 of 15 recordings: trial_1.wav, trial_4.wav".
fn recordings_in_words(with: &[bool], names: &[String]) -> String {
    let named = |wanted: bool| -> Vec<&str> {
        with.iter().zip(names).filter(|(has, _)| **has == wanted).map(|(_, name)| name.as_str()).collect()
    };
    let (having, others) = (named(true), named(false));
    let count = counted_recordings(with);
    if others.is_empty() {
        return count;
    }
    if others.len() <= EXCEPTIONS_MAX && others.len() < having.len() {
        return format!("{count}: all but {}", others.join(", "));
    }
    let more = having.len().saturating_sub(NAMES_MAX);
    let named = having[..having.len() - more].join(", ");
    if more > 0 { format!("{count}: {named} and {more} more") } else { format!("{count}: {named}") }
}

/// "all 15 recordings", "14 of 15 recordings".
fn counted_recordings(with: &[bool]) -> String {
    match with.iter().filter(|has| **has).count() {
        2 if with.len() == 2 => "both recordings".to_owned(),
        count if count == with.len() => format!("all {count} recordings"),
        count => format!("{count} of {} recordings", with.len()),
    }
}

/// One text for texts of one shape: numbers that differ become a range.
fn text_of_all(texts: &[&str]) -> String {
    let words: Vec<Vec<&str>> = texts.iter().map(|text| text.split(' ').collect()).collect();
    let Some(first) = words.first() else { return String::new() };
    let range = |index: usize| {
        let of_all: Vec<Word<'_>> =
            words.iter().filter_map(|words| words.get(index)).map(|word| Word::of(word)).collect();
        let low = of_all.iter().min_by(|a, b| a.number.total_cmp(&b.number))?;
        let high = of_all.iter().max_by(|a, b| a.number.total_cmp(&b.number))?;
        (low.digits != high.digits).then(|| format!("{}{}–{}{}", low.before, low.digits, high.digits, low.after))
    };
    let word = |(index, word): (usize, &&str)| range(index).unwrap_or_else(|| (*word).to_owned());
    first.iter().enumerate().map(word).collect::<Vec<_>>().join(" ")
}

/// The words of a text with a sign in place of each number.
fn shape(text: &str) -> Vec<String> {
    let before = std::iter::once("").chain(text.split(' '));
    text.split(' ')
        .zip(before)
        .map(|(word, word_before)| {
            let Word { before, digits, after, .. } = Word::of(word);
            let is_name = digits.is_empty() || NUMBERED.contains(&word_before);
            if is_name { word.to_owned() } else { format!("{before}{NUMBER}{after}") }
        })
        .collect()
}

/// A word of a text: a number between punctuation marks, or no number and no digits.
struct Word<'a> {
    before: &'a str,
    digits: &'a str,
    after: &'a str,
    number: f64,
}

impl<'a> Word<'a> {
    fn of(word: &'a str) -> Self {
        let digits = word.trim_matches(|letter: char| !letter.is_ascii_digit());
        let none = Self { before: "", digits: "", after: "", number: 0.0 };
        let (Some((before, after)), Ok(number)) = (word.split_once(digits), digits.parse()) else { return none };
        let is_mark = |letter: char| letter.is_ascii_punctuation();
        if digits.is_empty() || !before.chars().all(is_mark) || !after.chars().all(is_mark) {
            return none;
        }
        Self { before, digits, after, number }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn names(count: usize) -> Vec<String> {
        (1..=count).map(|number| format!("trial_{number}.wav")).collect()
    }

    fn texts(kinds: &[FoldedWarning]) -> Vec<&str> {
        kinds.iter().map(|kind| kind.notice.text.as_str()).collect()
    }

    #[test]
    fn another_harmonic_is_another_kind() {
        let left_out = |harmonic: u32, percent: u32| {
            Notice::new(format!("harmonic {harmonic} is left out: its speed is {percent} % off"), "ignore")
        };
        let all = vec![vec![left_out(2, 1), left_out(3, 1)], vec![left_out(2, 4)], vec![left_out(3, 1)]];
        let kinds = kinds_of(&all, &names(3));
        let words = [
            "harmonic 2 is left out: its speed is 1–4 % off (in 2 of 3",
            "harmonic 3 is left out: its speed is 1 % off (in 2 of 3",
        ];
        assert_eq!(kinds.len(), 2);
        assert!(texts(&kinds).iter().zip(words).all(|(text, words)| text.starts_with(words)), "{kinds:?}");
    }

    #[test]
    fn a_kind_of_warning_is_one_line_with_the_names_of_its_recordings() {
        let gaps = |percent: u32| Notice::new(format!("{percent} % of the frames hold no tone"), "move");
        let apart = || Notice::new("separated rotors: 2 of 4", "wait");
        let mut all: Vec<Vec<Notice>> = (0..15).map(|_| vec![apart()]).collect();
        all[3].push(gaps(12));
        all[9].push(gaps(9));
        all[4].push(Notice::new("single", ""));
        assert_eq!(
            texts(&kinds_of(&all, &names(15))),
            [
                "separated rotors: 2 of 4 (in all 15 recordings)",
                "9–12 % of the frames hold no tone (in 2 of 15 recordings: trial_4.wav, trial_10.wav)"
            ]
        );
        all[2].clear();
        let kinds = kinds_of(&all, &names(15));
        assert_eq!(kinds[0].notice.text, "separated rotors: 2 of 4 (in 14 of 15 recordings: all but trial_3.wav)");
        assert!(!kinds[0].is_of_all && kinds[0].has(&apart()) && !kinds[0].has(&gaps(1)));
    }

    #[test]
    fn many_names_are_counted() {
        let with: Vec<bool> = (0..20).map(|index| index % 2 == 0).collect();
        assert_eq!(
            recordings_in_words(&with, &names(20)),
            "10 of 20 recordings: trial_1.wav, trial_3.wav, trial_5.wav, trial_7.wav, trial_9.wav, trial_11.wav and 4 more"
        );
        assert_eq!(recordings_in_words(&[true, true, false], &names(3)), "2 of 3 recordings: all but trial_3.wav");
    }

    #[test]
    fn only_whole_numbers_of_a_text_become_a_range() {
        assert_eq!(shape("in b_2.wav: (12.5 rev/s), 3"), ["in", "b_2.wav:", "(#", "rev/s),", "#"]);
        let heard = ["from 1.5 s to 12 s", "from 0.5 s to 9.0 s", "from 1.5 s to 10 s"];
        assert_eq!(text_of_all(&heard), "from 0.5–1.5 s to 9.0–12 s");
        assert_eq!(text_of_all(&["no number"]), "no number");
    }
}
