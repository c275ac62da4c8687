//! Rotor speeds of recordings: a table for people, a JSON line and a track for programs.

use crate::cuts::used_in_words;
use crate::names::rotor_name;
use crate::notice::Notice;
use crate::number::{DASH, expanded, plus_minus, rounded, significant, spread};
use crate::printable::{folder_of, printable, shared_folder};
use crate::recording::{RecordingFacts, SpeedRecord};
use crate::table_lines::table_text;
use crate::text_table::{Column, TextTable};
use crate::tones::{ReadingLine, meanings_of, percent};
use crate::version::VERSION;
use hovertone_analysis::{
    Hover, LabelSource, Method, Reading, RotorCondition, RotorEstimate, RotorLabel, RotorsHeard, ShaftLine, Span,
    SpeedEstimate, UncertaintyTerm,
};
use hovertone_vehicle::{Order, RotorSpeed};
use serde::Serialize;
use serde_json::Value;

/// Digits of the speeds of several readings, of which at most one is right.
const DIGITS_OF_READINGS: usize = 4;

/// Readings below this plausibility are counted and not shown.
const SHOWN_MIN: f64 = 0.01;

/// Characters of the name of a single file, from which its folder stands below the table.
const LONG_NAME: usize = 30;

/// The speeds of all recordings, one row each. The folder that all files share stands below the table.
pub fn speed_table(records: &[SpeedRecord], width: Option<usize>) -> String {
    let files: Vec<&str> = records.iter().map(|record| record.file.as_str()).collect();
    let folder = match files.as_slice() {
        [one] if one.chars().count() > LONG_NAME => folder_of(one),
        _ => shared_folder(&files),
    };
    let name = |record: &SpeedRecord| record.file.strip_prefix(folder).unwrap_or(&record.file).to_owned();
    let mut table = TextTable::new(vec![
        Column::words("file"),
        Column::numbers("tone", "Hz"),
        Column::numbers("speed", "rev/s"),
        Column::numbers("± (k = 2)", "rev/s"),
        Column::numbers("spread", "rev/s"),
        Column::numbers("speed", "rpm"),
        Column::numbers("speed", "rad/s"),
        Column::numbers("used", "s"),
    ]);
    for record in records {
        match record.speed() {
            Some(speed) => {
                table.push(cells_of_speed(name(record), speed, cell_of_span(record)));
                for (index, rotor) in record.rotors().iter().enumerate() {
                    table.push(cells_of_speed(name_of_rotor(record, index), &rotor.speed, String::new()));
                }
                if record.is_doubtful() {
                    table.push_words(
                        match record.rotors() {
                            [] => "  do not use this speed",
                            _ => "  do not use these speeds",
                        }
                        .to_owned(),
                        "the sound contradicts the given facts".to_owned(),
                    );
                }
            }
            None if record.has_failed() => table.push_words(name(record), "could not be read".to_owned()),
            None if record.is_ambiguous() => {
                table.push_words(name(record), "possible speeds, each with its plausibility:".to_owned());
                let readings = record.alternatives();
                let shown = readings.iter().filter(|reading| reading.plausibility >= SHOWN_MIN).count().max(2);
                for (reading, meaning) in readings.iter().zip(meanings_of(readings)).take(shown) {
                    table.push(cells_of_reading(record, reading, &meaning));
                }
                match readings.len().saturating_sub(shown) {
                    0 => {}
                    more => table.push_words(
                        format!("  {more} more"),
                        "each below 1 %: `hovertone tones` lists them".to_owned(),
                    ),
                }
            }
            None => table.push_words(name(record), record.missing_speed_label().to_owned()),
        }
    }
    let below = if folder.is_empty() {
        String::new()
    } else {
        format!("{} in {}\n", if files.len() == 1 { "file" } else { "files" }, printable(folder))
    };
    table_text(&table, width) + &below
}

/// The label of a rotor, or its number in the order of the speeds.
pub(crate) fn name_of_rotor(record: &SpeedRecord, index: usize) -> String {
    let has_labels = record.labels.iter().flat_map(|labels| &labels.rotors).any(Option::is_some);
    rotor_name(record.label(index).map(|label| label.name.as_str()), has_labels, index)
}

fn cells_of_speed(name: String, estimate: &SpeedEstimate, used: String) -> Vec<String> {
    let (speed, std_rev_s) = (estimate.speed, estimate.combined_std_uncertainty_rev_s());
    let expanded = expanded(std_rev_s).map(RotorSpeed::from_rev_s);
    vec![
        name,
        rounded(speed.tone_hz(estimate.order), expanded.map(|expanded| expanded.tone_hz(estimate.order))),
        rounded(speed.rev_s(), expanded.map(RotorSpeed::rev_s)),
        plus_minus(std_rev_s),
        spread(estimate.spread_rev_s),
        rounded(speed.rpm(), expanded.map(RotorSpeed::rpm)),
        rounded(speed.rad_s(), expanded.map(RotorSpeed::rad_s)),
        used,
    ]
}

fn cell_of_span(record: &SpeedRecord) -> String {
    used_in_words(record.analysis().map_or(&[][..], |analysis| &analysis.hover.segments))
}

/// One of several readings; its plausibility stands in the column of the uncertainty.
fn cells_of_reading(record: &SpeedRecord, reading: &Reading, meaning: &str) -> Vec<String> {
    vec![
        format!("  {meaning} ({} %)", percent(reading.plausibility)),
        significant(reading.tone_hz, DIGITS_OF_READINGS),
        significant(reading.speed.rev_s(), DIGITS_OF_READINGS),
        DASH.to_owned(),
        DASH.to_owned(),
        significant(reading.speed.rpm(), DIGITS_OF_READINGS),
        significant(reading.speed.rad_s(), DIGITS_OF_READINGS),
        cell_of_span(record),
    ]
}

/// A speed as printed, with digits that follow its uncertainty.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct SpeedWords {
    /// Frequency of the tone in Hz.
    pub tone_hz: String,
    /// Shaft speed in rev/s.
    pub speed_rev_s: String,
    /// Its expanded uncertainty in rev/s.
    pub plus_minus_rev_s: String,
    /// The same in percent of the speed.
    pub plus_minus_percent: String,
    /// Its standard deviation over time in rev/s.
    pub spread_rev_s: String,
    /// Shaft speed in rpm.
    pub speed_rpm: String,
    /// Shaft speed in rad/s.
    pub speed_rad_s: String,
}

/// A speed in the words of [`speed_table`].
pub fn speed_in_words(estimate: &SpeedEstimate) -> SpeedWords {
    let mut cells = cells_of_speed(String::new(), estimate, String::new()).into_iter().skip(1);
    let mut next = || cells.next().unwrap_or_default();
    SpeedWords {
        tone_hz: next(),
        speed_rev_s: next(),
        plus_minus_rev_s: next(),
        plus_minus_percent: percent_of(estimate.speed, estimate.combined_std_uncertainty_rev_s()),
        spread_rev_s: next(),
        speed_rpm: next(),
        speed_rad_s: next(),
    }
}

fn percent_of(speed: RotorSpeed, std_rev_s: Option<f64>) -> String {
    plus_minus(std_rev_s.map(|std_rev_s| 100.0 * std_rev_s / speed.rev_s()))
}

/// A live speed as printed, with digits that follow its uncertainty.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct LiveWords {
    /// Shaft speed in rev/s.
    pub speed_rev_s: String,
    /// Its expanded uncertainty in rev/s.
    pub plus_minus_rev_s: String,
    /// The same in percent of the speed.
    pub plus_minus_percent: String,
    /// Shaft speed in rpm.
    pub speed_rpm: String,
    /// Shaft speed in rad/s.
    pub speed_rad_s: String,
}

/// A live speed and its standard uncertainty in words.
pub fn live_speed_in_words(speed: RotorSpeed, std_rev_s: f64) -> LiveWords {
    let expanded = expanded(Some(std_rev_s)).map(RotorSpeed::from_rev_s);
    LiveWords {
        speed_rev_s: rounded(speed.rev_s(), expanded.map(RotorSpeed::rev_s)),
        plus_minus_rev_s: plus_minus(Some(std_rev_s)),
        plus_minus_percent: percent_of(speed, Some(std_rev_s)),
        speed_rpm: rounded(speed.rpm(), expanded.map(RotorSpeed::rpm)),
        speed_rad_s: rounded(speed.rad_s(), expanded.map(RotorSpeed::rad_s)),
    }
}

/// The fixed fields of the machine output, followed by all others.
#[derive(Serialize)]
struct SpeedLine<'a> {
    file: &'a str,
    status: &'static str,
    method: Method,
    rotors_heard: Option<RotorsHeard>,
    order: Option<Order>,
    tone_hz: Option<f64>,
    speed_rev_s: Option<f64>,
    speed_rpm: Option<f64>,
    speed_rad_s: Option<f64>,
    std_uncertainty_rev_s: Option<f64>,
    combined_std_uncertainty_rev_s: Option<f64>,
    uncertainty_budget: Option<&'a [UncertaintyTerm]>,
    spread_rev_s: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    mean_square_rad2_s2: Option<f64>,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    rotors: Vec<RotorLine<'a>>,
    #[serde(skip_serializing_if = "Option::is_none")]
    condition: Option<ConditionLine<'a>>,
    #[serde(skip_serializing_if = "Option::is_none")]
    labels: Option<LabelsLine>,
    from_s: Option<f64>,
    to_s: Option<f64>,
    warnings: &'a [Notice],
    reason: Option<String>,
    #[serde(skip_serializing_if = "Option::is_none")]
    found: Option<ReadingLine<'a>>,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    alternatives: Vec<ReadingLine<'a>>,
    frame_count: Option<usize>,
    window_s: Option<f64>,
    hover: Option<&'a Hover>,
    recording: Option<&'a RecordingFacts>,
    settings: &'a Value,
    version: &'static str,
}

/// One of several rotors.
#[derive(Serialize)]
struct RotorLine<'a> {
    /// Null where the label is unknown.
    label: Option<&'a RotorLabel>,
    speed_rev_s: f64,
    std_uncertainty_rev_s: Option<f64>,
    combined_std_uncertainty_rev_s: Option<f64>,
    spread_rev_s: Option<f64>,
    mean_square_rad2_s2: Option<f64>,
    merged: &'a [Span],
    #[serde(skip_serializing_if = "Option::is_none")]
    condition: Option<ConditionLine<'a>>,
}

/// Shaft lines of a rotor.
#[derive(Serialize)]
struct ConditionLine<'a> {
    shaft_over_blade_pass_db: Option<f64>,
    loudest_between: Option<&'a ShaftLine>,
    #[serde(flatten)]
    condition: &'a RotorCondition,
}

impl<'a> RotorLine<'a> {
    fn of(record: &'a SpeedRecord, index: usize, rotor: &'a RotorEstimate) -> Self {
        Self {
            label: record.label(index),
            speed_rev_s: rotor.speed.speed.rev_s(),
            std_uncertainty_rev_s: rotor.speed.std_uncertainty_rev_s,
            combined_std_uncertainty_rev_s: rotor.speed.combined_std_uncertainty_rev_s(),
            spread_rev_s: rotor.speed.spread_rev_s,
            mean_square_rad2_s2: rotor.speed.mean_square_rad2_s2,
            merged: &rotor.merged,
            condition: rotor.condition.as_ref().map(ConditionLine::of),
        }
    }
}

impl<'a> ConditionLine<'a> {
    fn of(condition: &'a RotorCondition) -> Self {
        Self {
            shaft_over_blade_pass_db: condition.shaft_over_blade_pass_db(),
            loudest_between: condition.loudest_between(),
            condition,
        }
    }
}

/// Source of the labels.
#[derive(Serialize)]
struct LabelsLine {
    source: Option<LabelSource>,
    offset_s: Option<f64>,
    offset_std_uncertainty_s: Option<f64>,
    probability: Option<f64>,
    reason: Option<String>,
}

impl LabelsLine {
    /// `None` without separated rotors; without a source where rotors have numbers by their speed.
    fn of(record: &SpeedRecord) -> Option<Self> {
        let by_speed = || Self {
            source: None,
            offset_s: None,
            offset_std_uncertainty_s: None,
            probability: None,
            reason: Some(
                "rotor 1 is the fastest: one microphone does not show which rotor of the vehicle it is".to_owned(),
            ),
        };
        match &record.labels {
            Some(labels) => Some(Self {
                source: Some(labels.source),
                offset_s: labels.offset_s,
                offset_std_uncertainty_s: labels.offset_std_s,
                probability: labels.probability,
                reason: labels.not_told.as_ref().map(ToString::to_string),
            }),
            None => (!record.rotors().is_empty()).then(by_speed),
        }
    }
}

/// A recording as one line of JSON, without a line feed.
///
/// # Errors
/// None is known, since all types can be serialised.
pub fn speed_json(record: &SpeedRecord) -> Result<String, serde_json::Error> {
    let (estimate, used) = (record.speed(), record.used());
    let speed = estimate.map(|estimate| estimate.speed);
    serde_json::to_string(&SpeedLine {
        file: &record.file,
        status: record.status(),
        method: estimate.map_or(record.method, |estimate| estimate.method),
        rotors_heard: record.rotors_heard(),
        order: (record.found.is_none() || estimate.is_some()).then_some(record.order),
        tone_hz: record.tone_hz(),
        speed_rev_s: speed.map(RotorSpeed::rev_s),
        speed_rpm: speed.map(RotorSpeed::rpm),
        speed_rad_s: speed.map(RotorSpeed::rad_s),
        std_uncertainty_rev_s: estimate.and_then(|estimate| estimate.std_uncertainty_rev_s),
        combined_std_uncertainty_rev_s: estimate.and_then(SpeedEstimate::combined_std_uncertainty_rev_s),
        uncertainty_budget: estimate.map(|estimate| estimate.budget.as_slice()),
        spread_rev_s: estimate.and_then(|estimate| estimate.spread_rev_s),
        mean_square_rad2_s2: estimate.and_then(|estimate| estimate.mean_square_rad2_s2),
        rotors: record.rotors().iter().enumerate().map(|(index, rotor)| RotorLine::of(record, index, rotor)).collect(),
        condition: record.tone().and_then(|tone| tone.condition.as_ref()).map(ConditionLine::of),
        labels: LabelsLine::of(record),
        from_s: used.map(|used| used.from_s),
        to_s: used.map(|used| used.to_s),
        warnings: &record.notices,
        reason: record.reason(),
        found: record.found_reading().filter(|_| estimate.is_some()).map(ReadingLine::from),
        alternatives: record.alternatives().iter().map(ReadingLine::from).collect(),
        frame_count: estimate.map(|estimate| estimate.frame_count),
        window_s: record.tone().map(|tone| tone.window_s),
        hover: record.analysis().map(|analysis| &analysis.hover),
        recording: record.recording.as_ref(),
        settings: &record.settings,
        version: VERSION,
    })
}
