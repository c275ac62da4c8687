//! Sound against telemetry: text for people, JSON for programs.

use crate::notice::Notice;
use crate::number::{fixed, signed, significant};
use crate::printable::printable;
use crate::table_lines::table_text;
use crate::text_table::{Column, TextTable};
use crate::version::VERSION;
use hovertone_analysis::{Agreement, COVERAGE_OF_HALF, Verification, percent_in_words};
use serde::Serialize;

/// Millionths of a share.
pub(crate) const PPM: f64 = 1e6;

/// Why equal means of steady speeds do not show that the log is of this flight.
const CLOCKS_NOT_COMPARED: &str = "the speeds change too little to compare the clocks";

/// A verification with the names of its files.
#[derive(Clone, Debug, PartialEq)]
pub struct VerificationRecord {
    /// The recording as given.
    pub file: String,
    /// The log as given.
    pub log: String,
    /// The comparison.
    pub verification: Verification,
}

/// The verification as text.
pub fn verification_text(record: &VerificationRecord, width: Option<usize>) -> String {
    let found = &record.verification;
    let mut shown = TextTable::new(vec![
        Column::words("rotor"),
        Column::words("nearest in the log"),
        Column::numbers("heard", "rev/s"),
        Column::numbers("heard − logged", "rev/s"),
        Column::numbers("scatter", "rev/s"),
        Column::numbers("log within ±", ""),
        Column::numbers("points", ""),
    ]);
    for (number, rotor) in (1..).zip(&found.rotors) {
        shown.push(vec![
            number.to_string(),
            rotor.name.clone(),
            significant(rotor.speed_rev_s, 5),
            signed(rotor.bias_rev_s, 3),
            fixed(rotor.scatter_rev_s, 3),
            percent_in_words(rotor.coverage),
            rotor.point_count.to_string(),
        ]);
    }
    let offset = if found.is_offset_told {
        format!("offset of the log {} s: time to be added to its clock\n", signed(found.offset_s, 3))
    } else {
        format!(
            "offset of the log: not known, because other offsets fit nearly as well ({} s is used)\n",
            signed(found.offset_s, 1)
        )
    };
    let rate = found
        .clock_rate_share
        .map_or(String::new(), |share| format!("the clocks drift by {} millionths\n", signed(share * PPM, 0)));
    format!(
        "{} against {}\n{}\n{offset}{rate}{}\n",
        printable(&record.file),
        printable(&record.log),
        table_text(&shown, width),
        verdict_in_words(found)
    )
}

fn verdict_in_words(found: &Verification) -> String {
    if let Some(Notice { text, hint }) = failed_check(found) {
        return format!("failed: {text}; {hint}");
    }
    if let Some(Notice { text, hint }) = undecided_check(found) {
        let limits = match text.contains(CLOCKS_NOT_COMPARED) {
            true => "; or, if you know the offset of the clocks, give it with --log-offset-s LOW:HIGH",
            false => "",
        };
        return format!("not decided: {text}; {hint}{limits}");
    }
    let percent = percent_of(found);
    let small = match found.agreement {
        Agreement::PlusMinusTooSmall => format!(
            ". The ± of the heard speeds is too small: {} of the points lie within it, and 95 % should",
            percent_in_words(found.coverage())
        ),
        _ => String::new(),
    };
    format!("passed: order and clock are right; the mean of the heard speeds differs by {percent} %{small}")
}

/// The verdict for programs.
pub(crate) fn status_of(found: &Verification) -> &'static str {
    match found.is_right() {
        false => "failed",
        true if found.passes() => "passed",
        true => "not_decided",
    }
}

/// What is wrong, and what to check, where the means of heard and logged speeds differ.
pub(crate) fn failed_check(found: &Verification) -> Option<Notice> {
    match found.near_ratio {
        _ if found.is_right() => None,
        Some(ratio) => Some(Notice::new(
            format!("heard speeds are {} times the logged ones", significant(ratio, 3)),
            "check the number of blades or the order of the tone, and the number of pole pairs in the log; or the log is of another flight",
        )),
        None => Some(Notice::new(
            format!("the mean of the heard speeds differs by {} % from the log", percent_of(found)),
            "check the order of the tone, the clock of the recorder, and whether the log is of this flight",
        )),
    }
}

/// Why equal means prove nothing, and what to check.
pub(crate) fn undecided_check(found: &Verification) -> Option<Notice> {
    if !found.is_right() || found.passes() {
        return None;
    }
    if let Some(offset_s) = found.better_offset_s {
        let offset = signed(offset_s, 2);
        let what = format!("the log fits better at an offset near {offset} s, outside of the limits of --log-offset-s");
        return Some(Notice::new(what, "give wider limits"));
    }
    let means = format!("the means are equal within {} %, but", fixed(100.0 * (found.speed_ratio - 1.0).abs(), 2));
    let few = format!(
        "the logged speed lies within the ± of the heard speed in only {} of the points, and 95 % is normal",
        percent_in_words(found.coverage())
    );
    let is_scattered = found.agreement == Agreement::Scattered;
    if found.is_offset_told || found.is_offset_given || is_scattered {
        return Some(Notice::new(
            format!("{means} {few}"),
            "check first that the log is of this flight, and then the offset of the clocks",
        ));
    }
    let also = if found.coverage() < COVERAGE_OF_HALF { format!("; and {few}") } else { String::new() };
    Some(Notice::new(
        format!("{means} {CLOCKS_NOT_COMPARED}, so the log may be of another flight{also}"),
        "record a flight with a few quick climbs, which change the speeds",
    ))
}

/// By how much heard speeds differ, in per cent.
fn percent_of(found: &Verification) -> String {
    signed(100.0 * (found.speed_ratio - 1.0), 2)
}

#[derive(Serialize)]
struct VerificationLine<'a> {
    file: &'a str,
    log: &'a str,
    status: &'static str,
    offset_s: f64,
    is_offset_told: bool,
    clock_rate_share: Option<f64>,
    speed_ratio: f64,
    near_ratio: Option<f64>,
    better_offset_s: Option<f64>,
    coverage: f64,
    rotors: Vec<RotorLine<'a>>,
    version: &'static str,
}

#[derive(Serialize)]
struct RotorLine<'a> {
    motor: &'a str,
    speed_rev_s: f64,
    bias_rev_s: f64,
    scatter_rev_s: f64,
    coverage: f64,
    point_count: usize,
}

/// The verification as one JSON object on a line.
///
/// # Errors
/// None is known, since all types can be serialised.
pub fn verification_json(record: &VerificationRecord) -> Result<String, serde_json::Error> {
    let found = &record.verification;
    let rotors = found.rotors.iter().map(|rotor| RotorLine {
        motor: &rotor.name,
        speed_rev_s: rotor.speed_rev_s,
        bias_rev_s: rotor.bias_rev_s,
        scatter_rev_s: rotor.scatter_rev_s,
        coverage: rotor.coverage,
        point_count: rotor.point_count,
    });
    let line = VerificationLine {
        file: &record.file,
        log: &record.log,
        status: status_of(found),
        offset_s: found.offset_s,
        is_offset_told: found.is_offset_told,
        clock_rate_share: found.clock_rate_share,
        speed_ratio: found.speed_ratio,
        near_ratio: found.near_ratio,
        better_offset_s: found.better_offset_s,
        coverage: found.coverage(),
        rotors: rotors.collect(),
        version: VERSION,
    };
    Ok(serde_json::to_string(&line)? + "\n")
}
