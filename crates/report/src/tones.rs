//! Tone families of recordings: blocks for people, a JSON line for programs.

use crate::notice::Notice;
use crate::number::{DASH, significant};
use crate::printable::printable;
use crate::recording::{Found, RecordingFacts, SpeedRecord};
use crate::table_lines::table_text;
use crate::text_table::{Column, TextTable};
use crate::tone_line::{DIGITS, Whole, digits, kind_and_place};
use crate::version::VERSION;
use hovertone_analysis::{Meaning, Reading, Remark, SeenHarmonic, SpeedEstimate, ToneFamily};
use hovertone_vehicle::{Gear, Order};
use serde::Serialize;
use serde_json::Value;

/// Indentation of the table of a family.
const INDENT: &str = "   ";

/// Machine output of a reading.
#[derive(Serialize)]
pub(crate) struct ReadingLine<'a> {
    order: Order,
    tone_hz: f64,
    meaning: &'static str,
    blades: Option<u32>,
    gear: Option<Gear>,
    speed_rev_s: f64,
    speed_rpm: f64,
    speed_rad_s: f64,
    motor_rpm: f64,
    tip_mach: Option<f64>,
    thrust_coefficient: Option<f64>,
    plausibility: f64,
    why: &'a str,
}

impl<'a> From<&'a Reading> for ReadingLine<'a> {
    fn from(reading: &'a Reading) -> Self {
        Self {
            order: reading.order,
            tone_hz: reading.tone_hz,
            meaning: match reading.meaning {
                Meaning::BladePass { .. } => "blade_pass",
                Meaning::BladePassAndMesh { .. } => "blade_pass_and_mesh",
                Meaning::GivenOrder => "given_order",
            },
            blades: reading.meaning.blades(),
            gear: reading.meaning.gear(),
            speed_rev_s: reading.speed.rev_s(),
            speed_rpm: reading.speed.rpm(),
            speed_rad_s: reading.speed.rad_s(),
            motor_rpm: reading.motor_speed.rpm(),
            tip_mach: reading.tip_mach,
            thrust_coefficient: reading.thrust_coefficient,
            plausibility: reading.plausibility,
            why: &reading.why,
        }
    }
}

/// The families of one recording as a block of text: the rotor's with a table of its readings, the others on two lines each.
pub fn tones_text(record: &SpeedRecord, width: Option<usize>) -> String {
    let mut text = format!("{}\n", printable(&record.file));
    if record.has_failed() {
        return text + "could not be read\n";
    }
    let Some(found) = record.found.as_ref() else { return text };
    let whole = Whole::of(record);
    let rotor = found.rotor.filter(|_| record.tone().is_some());
    let remark = rotor.and_then(|rotor| found.families.get(rotor)).and_then(|family| family.remark);
    let verdict = match (rotor, remark) {
        (Some(_), Some(Remark::SingleLine)) => "a single tone, of a rotor or of something else".to_owned(),
        (Some(_), _) if record.is_ambiguous() => "a rotor with several possible speeds: see the table".to_owned(),
        (Some(_), _) => record.speed().map_or("a rotor".to_owned(), |heard| heard_in_words(record, heard)),
        (None, _) if record.is_part_outside() => "the chosen part lies after the end of the recording".to_owned(),
        (None, _) if found.families.is_empty() => "no rotor tone, and no other tone".to_owned(),
        (None, _) => "no rotor tone".to_owned(),
    };
    text += &format!("{verdict}\n");
    if let Some(family) = rotor.and_then(|rotor| found.families.get(rotor)) {
        let (place, table) = (kind_and_place("rotor", family, whole), readings_table(family, width));
        // several possible speeds may belong to other series than the one that is seen best
        text += &match record.is_ambiguous() {
            true => format!("\n{table}\n{place}\n"),
            false => format!("\n{place}\n{table}"),
        };
    }
    let others = found.families.iter().enumerate().filter(|(index, _)| rotor != Some(*index));
    for (_, family) in others {
        let is_near = rotor.and_then(|rotor| found.families.get(rotor)).is_some_and(|rotor| family.is_near(rotor));
        let kind = match family.remark {
            Some(remark @ (Remark::NearMains | Remark::GearMesh)) => remark.text(),
            _ if is_near && possible_readings(family).next().is_some() => {
                "another rotor, or the same rotor at another speed"
            }
            Some(remark) => remark.text(),
            None if rotor.is_none() => "a tone, but probably no rotor",
            None => "another tone",
        };
        let of_rotor = rotor.and_then(|rotor| line_of_rotor(family, found.families.get(rotor)?));
        let readings = match family.remark {
            Some(Remark::GearMesh) => String::new(),
            _ => readings_in_a_line(family, of_rotor.as_deref()),
        };
        text += &format!("\n{}\n{readings}", kind_and_place(kind, family, whole));
    }
    text
}

/// "a rotor at 83.14 rev/s", or several with their mean.
fn heard_in_words(record: &SpeedRecord, heard: &SpeedEstimate) -> String {
    let rev_s = significant(heard.speed.rev_s(), DIGITS);
    match record.tone().map_or(&[][..], |tone| &tone.rotors) {
        [] | [_] => format!("a rotor at {rev_s} rev/s"),
        several => {
            let of_all = match record.given_rotor_count() {
                Some(count) if count > several.len() as u64 => format!("of the {count} "),
                _ => String::new(),
            };
            format!(
                "{} {of_all}rotors could be separated, at {rev_s} rev/s on average; the first tone below is the tone of the loudest rotor",
                several.len()
            )
        }
    }
}

/// A tone this near a harmonic may be that of another rotor of the vehicle.
const NEAR_ROTOR_SHARE: f64 = 0.05;
/// Harmonics that are named: higher ones are near any tone.
const OTHER_HARMONICS: std::ops::RangeInclusive<f64> = 2.0..=6.0;

/// The meaning of each reading in words. Where two readings have the same, each has the frequency of its tone too.
pub(crate) fn meanings_of(readings: &[Reading]) -> Vec<String> {
    let words: Vec<String> = readings.iter().map(|reading| reading.meaning.to_string()).collect();
    let is_twice = |word: &String| words.iter().filter(|other| *other == word).count() > 1;
    let of_tone = |reading: &Reading| format!(", tone of {} Hz", significant(reading.tone_hz, DIGITS));
    let named = readings.iter().zip(&words);
    named.map(|(reading, word)| if is_twice(word) { word.clone() + &of_tone(reading) } else { word.clone() }).collect()
}

/// Plausibility in per cent; a dash for an excluded reading.
pub(crate) fn percent(plausibility: f64) -> String {
    match plausibility {
        0.0 => DASH.to_owned(),
        share if share < 0.005 => "<1".to_owned(),
        // 99 % would settle it
        share if (0.985..1.0).contains(&share) => format!("{:.1}", (1000.0 * share).floor() / 10.0),
        share => format!("{:.0}", 100.0 * share),
    }
}

fn readings_table(family: &ToneFamily, width: Option<usize>) -> String {
    let (readings, digits) = (&family.readings, digits(family));
    let has_mach = readings.iter().any(|reading| reading.tip_mach.is_some());
    let has_coefficient = readings.iter().any(|reading| reading.thrust_coefficient.is_some());
    let has_gear = readings.iter().any(|reading| reading.meaning.gear().is_some());
    let mut columns = vec![
        Column::words("if it has"),
        Column::numbers("order", ""),
        Column::numbers("tone", "Hz"),
        Column::numbers("shaft", "rev/s"),
        Column::numbers("shaft", "rpm"),
    ];
    columns.extend(has_gear.then(|| Column::numbers("motor", "rpm")));
    columns.extend(has_mach.then(|| Column::numbers("tip", "Mach")));
    columns.extend(has_coefficient.then(|| Column::numbers("C_T", "")));
    columns.extend([Column::numbers("plausible", "%"), Column::words("because")]);
    let mut table = TextTable::new(columns);
    for (reading, meaning) in readings.iter().zip(meanings_of(readings)) {
        let mut cells = vec![
            meaning,
            reading.order.to_string(),
            significant(reading.tone_hz, digits),
            significant(reading.speed.rev_s(), digits),
            significant(reading.speed.rpm(), digits),
        ];
        cells.extend(has_gear.then(|| significant(reading.motor_speed.rpm(), digits)));
        let number = |value: Option<f64>| value.map_or(DASH.to_owned(), |value| significant(value, 2));
        cells.extend(has_mach.then(|| number(reading.tip_mach)));
        cells.extend(has_coefficient.then(|| number(reading.thrust_coefficient)));
        cells.extend([percent(reading.plausibility), reading.why.clone()]);
        table.push(cells);
    }
    table_text(&table, width.map(|width| width.saturating_sub(INDENT.len())))
        .lines()
        .map(|line| format!("{INDENT}{line}\n"))
        .collect()
}

/// The readings that nothing rules out.
fn possible_readings(family: &ToneFamily) -> impl Iterator<Item = &Reading> {
    family.readings.iter().filter(|reading| reading.plausibility > 0.0)
}

/// That a tone may be a harmonic of another rotor of the same vehicle, whose speed is near that of the loudest one.
fn line_of_rotor(family: &ToneFamily, rotor: &ToneFamily) -> Option<String> {
    let reading = rotor.readings.first()?;
    let blades = f64::from(reading.meaning.blades()?);
    let ratio = family.fundamental_hz / (blades * reading.speed.rev_s());
    let harmonic = ratio.round();
    let is_near = (ratio / harmonic - 1.0).abs() < NEAR_ROTOR_SHARE && OTHER_HARMONICS.contains(&harmonic);
    is_near.then(|| {
        let rev_s = significant(family.fundamental_hz / (harmonic * blades), DIGITS);
        format!(
            "perhaps harmonic {harmonic} of another rotor of this vehicle, which turns at {rev_s} rev/s ({})",
            reading.meaning
        )
    })
}

fn readings_in_a_line(family: &ToneFamily, of_rotor: Option<&str>) -> String {
    let words: Vec<String> = possible_readings(family)
        .map(|reading| format!("{} rev/s ({})", significant(reading.speed.rev_s(), DIGITS), reading.meaning))
        .collect();
    match words.is_empty() {
        true if let Some(of_rotor) = of_rotor => format!("{INDENT}{of_rotor}\n"),
        true => {
            let why = each_once(family.readings.iter().map(|reading| reading.why.as_str()));
            let of_gear = family.readings.iter().any(|reading| reading.meaning.gear().is_some());
            let which = if of_gear { "" } else { " without a gear" };
            format!("{INDENT}no rotor{which} can have this tone ({why})\n")
        }
        false => match of_rotor {
            Some(of_rotor) => {
                format!("{INDENT}{of_rotor}\n{INDENT}or the tone of a rotor that turns at {}\n", words.join(" or "))
            }
            None => format!("{INDENT}as the tone of a rotor: it turns at {}\n", words.join(" or ")),
        },
    }
}

/// The reasons of several readings, each once.
fn each_once<'a>(whys: impl Iterator<Item = &'a str>) -> String {
    let mut reasons: Vec<&str> = Vec::new();
    for reason in whys.flat_map(|why| why.split("; ")) {
        if !reasons.contains(&reason) {
            reasons.push(reason);
        }
    }
    reasons.join("; ")
}

#[derive(Serialize)]
struct FamilyLine<'a> {
    is_rotor: bool,
    fundamental_hz: f64,
    spread_hz: Option<f64>,
    harmonics: &'a [SeenHarmonic],
    level_db: f64,
    time_share: f64,
    from_s: f64,
    to_s: f64,
    is_settled: bool,
    remark: Option<Remark>,
    readings: Vec<ReadingLine<'a>>,
}

#[derive(Serialize)]
struct TonesLine<'a> {
    file: &'a str,
    status: &'static str,
    tone_hz: Option<f64>,
    speed_rev_s: Option<f64>,
    families: Vec<FamilyLine<'a>>,
    warnings: &'a [Notice],
    reason: Option<String>,
    recording: Option<&'a RecordingFacts>,
    discovery: Option<&'a Value>,
    settings: &'a Value,
    version: &'static str,
}

/// The families of a recording as one line of JSON, without a line feed.
///
/// # Errors
/// None is known, since all types can be serialised.
pub fn tones_json(record: &SpeedRecord) -> Result<String, serde_json::Error> {
    let rotor = record.found.as_ref().and_then(|found| found.rotor).filter(|_| record.tone().is_some());
    let families = record.found.iter().flat_map(|found: &Found| &found.families).enumerate();
    serde_json::to_string(&TonesLine {
        file: &record.file,
        status: record.status(),
        tone_hz: record.tone_hz(),
        speed_rev_s: record.speed().map(|speed| speed.speed.rev_s()),
        families: families
            .map(|(index, family)| FamilyLine {
                is_rotor: rotor == Some(index),
                fundamental_hz: family.fundamental_hz,
                spread_hz: family.spread_hz,
                harmonics: &family.harmonics,
                level_db: family.level_db,
                time_share: family.time_share,
                from_s: family.span.from_s,
                to_s: family.span.to_s,
                is_settled: family.is_settled,
                remark: family.remark,
                readings: family.readings.iter().map(ReadingLine::from).collect(),
            })
            .collect(),
        warnings: &record.notices,
        reason: record.reason(),
        recording: record.recording.as_ref(),
        discovery: record.found.as_ref().map(|found| &found.settings),
        settings: &record.settings,
        version: VERSION,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use hovertone_vehicle::RotorSpeed;

    #[test]
    fn a_reason_of_several_readings_is_told_once() {
        assert_eq!(
            each_once(["too fast; no thrust", "2 blades", "too fast"].into_iter()),
            "too fast; no thrust; 2 blades"
        );
    }

    #[test]
    fn readings_with_one_meaning_are_told_by_their_tones() {
        let reading = |blades: u32, tone_hz: f64| {
            let speed = RotorSpeed::from_rev_s(tone_hz / f64::from(blades));
            Reading {
                order: Order::from_blades(blades).unwrap(),
                tone_hz,
                meaning: Meaning::BladePass { blades },
                speed,
                motor_speed: speed,
                tip_mach: None,
                thrust_coefficient: None,
                plausibility: 0.3,
                why: String::new(),
            }
        };
        let named = meanings_of(&[reading(2, 404.0), reading(2, 201.8), reading(3, 201.8)]);
        assert_eq!(named, ["2 blades, tone of 404.0 Hz", "2 blades, tone of 201.8 Hz", "3 blades"]);
    }
}
