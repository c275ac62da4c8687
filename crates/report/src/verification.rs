//! Sound against telemetry: text for people, JSON for programs.

use crate::notice::Notice;
use crate::number::{fixed, signed, significant};
use crate::printable::printable;
use crate::table_lines::table_text;
use crate::text_table::{Column, TextTable};
use crate::version::VERSION;
use hovertone_analysis::{Verification, percent_in_words};
use serde::Serialize;

/// Millionths of a share.
pub(crate) const PPM: f64 = 1e6;

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
            "offset of the log: not found, because other offsets fit nearly as well ({} s is used)\n",
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
    match failed_check(found) {
        None => {
            let percent = percent_of(found);
            match found.is_offset_told {
                true => format!("passed: order and clock are right; heard speeds differ by {percent} %"),
                false => format!(
                    "passed: the order is right; heard speeds differ by {percent} %; the clocks are not compared, so the log may be of another flight"
                ),
            }
        }
        Some(Notice { text, hint }) => format!("failed: {text}; {hint}"),
    }
}

/// What is wrong, and what to check, where heard and logged speeds are not equal.
pub(crate) fn failed_check(found: &Verification) -> Option<Notice> {
    match found.near_ratio {
        _ if found.is_right() => None,
        Some(ratio) => Some(Notice::new(
            format!("heard speeds are {} times the logged ones", significant(ratio, 3)),
            "check the blades or the order, and the pole pairs of the log; or the log is of another flight",
        )),
        None => Some(Notice::new(
            format!("heard speeds differ by {} %", percent_of(found)),
            "check the order, the clock of the recorder, or the log",
        )),
    }
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
        status: if found.is_right() { "passed" } else { "failed" },
        offset_s: found.offset_s,
        is_offset_told: found.is_offset_told,
        clock_rate_share: found.clock_rate_share,
        speed_ratio: found.speed_ratio,
        near_ratio: found.near_ratio,
        rotors: rotors.collect(),
        version: VERSION,
    };
    Ok(serde_json::to_string(&line)? + "\n")
}
