//! Sound against telemetry: text for people, JSON for programs.

use crate::notice::Notice;
use crate::number::{fixed, signed, significant};
use crate::printable::printable;
use crate::table_lines::table_text;
use crate::text_table::{Column, TextTable};
use crate::version::VERSION;
use hovertone_analysis::{Agreement, COVERAGE_OF_HALF, MEAN_OF_MOTORS, RIGHT_SHARE, Verification, percent_in_words};
use serde::Serialize;
use std::f64::consts::TAU;
use std::ops::RangeInclusive;

/// Millionths of a share.
pub(crate) const PPM: f64 = 1e6;

/// Pole pairs of the motors of multirotors.
const POLE_PAIRS: RangeInclusive<f64> = 5.0..=14.0;
/// A ratio of speeds is that of two units if it is this near, as a share.
const UNIT_SHARE: f64 = 0.02;

/// Largest error of a recorder's clock, as a share.
const CLOCK_SHARE_MAX: f64 = 0.01;

/// Why equal means do not show that the log is of this flight: the speeds are steady, or the heard ones do not follow quick changes.
const OFFSET_NOT_KNOWN: &str = "nothing shows which offset of the log is right";

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
        Column::words("compared with"),
        Column::numbers("heard", "rev/s"),
        Column::numbers("heard − logged", "rev/s"),
        Column::numbers("scatter", "rev/s"),
        Column::numbers("logged speeds within ±", ""),
        Column::numbers("points", ""),
    ]);
    for (number, rotor) in (1..).zip(&found.rotors) {
        // rotors that are not separated have one speed, that of all
        let is_of_all = found.rotors.len() == 1 && rotor.name == MEAN_OF_MOTORS;
        shown.push(vec![
            if is_of_all { "all".to_owned() } else { number.to_string() },
            rotor.name.clone(),
            significant(rotor.speed_rev_s, 5),
            signed(rotor.bias_rev_s, 3),
            fixed(rotor.scatter_rev_s, 3),
            percent_in_words(rotor.coverage),
            rotor.point_count.to_string(),
        ]);
    }
    let offset = offset_in_words(found);
    let rate = found.clock_rate_share.map_or(String::new(), |share| {
        format!("the clocks of log and recording drift apart by {} millionths\n", signed(share * PPM, 0))
    });
    format!(
        "{} against {}\n{}\n{offset}{rate}{}\n",
        printable(&record.file),
        printable(&record.log),
        table_text(&shown, width),
        verdict_in_words(found)
    )
}

/// The time to add to the clock of the log, and how it is known.
fn offset_in_words(found: &Verification) -> String {
    if found.is_offset_told {
        let meaning = match found.is_right() {
            true => "the time to add to the clock of the log",
            false => "but it may be wrong, because the check failed",
        };
        return format!("offset of the log: {} s, {meaning}\n", signed(found.offset_s, 3));
    }
    let used = signed(found.offset_s, 1);
    if let Some(better_s) = found.better_offset_s.filter(|_| found.is_offset_given) {
        return format!(
            "offset of the log: {used} s is used, within --log-offset-s, but the speeds fit clearly better at {} s\n",
            signed(better_s, 1)
        );
    }
    if found.is_offset_given {
        return format!(
            "offset of the log: {used} s is used, within --log-offset-s; the speeds do not show whether it is right\n"
        );
    }
    format!(
        "offset of the log: not known, because no offset fits clearly better than all others; the table above uses {used} s, which may be wrong\n"
    )
}

fn verdict_in_words(found: &Verification) -> String {
    if let Some(Notice { text, hint, .. }) = failed_check(found) {
        return format!("failed: {text}; {hint}");
    }
    if let Some(undecided) = undecided(found) {
        let Notice { text, hint, .. } = undecided.notice(found);
        let limits = match undecided {
            Undecided::UnknownOffset => {
                "; or, if you know the offset of the log, give it with --log-offset-s LOW:HIGH, limits at most 2 s apart"
            }
            _ => "",
        };
        return format!("not decided: {text}; {hint}{limits}");
    }
    let percent = percent_of(found);
    // order and clock are judged apart from the ±
    let small = small_plus_minus(found);
    let small = small.map_or(String::new(), |Notice { text, hint, .. }| format!("\nbut {text}; {hint}"));
    format!(
        "passed: the number of blades (or the gear) is right, and the clock of the recorder is right within {} %; the mean of the heard speeds differs \
        from the log by {percent} %{small}",
        100.0 * RIGHT_SHARE
    )
}

/// That the stated ± holds too few of the logged speeds, although order and clock are right; `None` where it is large enough, or where the check
/// does not pass anyway.
pub fn small_plus_minus(found: &Verification) -> Option<Notice> {
    let within = percent_in_words(found.coverage());
    let few = format!("only {within} of the logged speeds lie within the ± of the heard speeds, and 95 % should");
    match found.agreement {
        _ if !found.is_right() || !found.passes() => None,
        Agreement::PlusMinusTooSmall => Some(Notice::new(
            format!("the ± is too small: {few}"),
            "check that the log is of this flight; if it is, use the mean speeds, and do not rely on the ± of the speed at a single moment",
        )),
        Agreement::AsStated if found.coverage() < COVERAGE_OF_HALF => Some(Notice::new(
            format!("the ± may be too small: {few}. There are too few points to be sure"),
            "compare a longer recording with its log",
        )),
        _ => None,
    }
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
            format!(
                "the heard speeds are {} times the logged speeds, near {}",
                significant(found.speed_ratio, 3),
                fraction_in_words(ratio)
            ),
            "check the number of blades (or the gear); check the number of pole pairs in the \
            ESC's settings; check that the log is of this flight",
        )),
        None if let Some(pairs) = pole_pairs(found.speed_ratio) => Some(Notice::new(
            format!(
                "the logged speeds are {} times the heard speeds: they seem to be electrical speeds of motors with {pairs} pole pairs",
                significant(1.0 / found.speed_ratio, 3)
            ),
            "divide the logged speeds by the number of pole pairs, or set it in the ESC; check that the log is of this flight",
        )),
        None if let Some(units) = units_in_words(found.speed_ratio) => Some(Notice::new(
            format!("the heard speeds are {} times the logged speeds: {units}", significant(found.speed_ratio, 3)),
            "check the unit of the speeds in the log; in a CSV log, tell the right unit in the header of the column, as in rotor1_rad_s, or with --column",
        )),
        None => Some(Notice::new(
            format!("the mean of the heard speeds differs by {} % from the log", percent_of(found)),
            match (found.speed_ratio - 1.0).abs() < CLOCK_SHARE_MAX {
                true => "check that the log is of this flight; if it is, check the clock of the recorder",
                false => {
                    "check that the log is of this flight; if it is, check the number of blades, or the gear if the vehicle has one"
                }
            },
        )),
    }
}

/// The number of pole pairs of motors that multiplies the speeds in a log.
fn pole_pairs(speed_ratio: f64) -> Option<u32> {
    let pairs = (1.0 / speed_ratio).round();
    let is_near = (speed_ratio * pairs - 1.0).abs() < UNIT_SHARE;
    (is_near && POLE_PAIRS.contains(&pairs)).then_some(pairs as u32)
}

/// Which unit of the log explains a ratio of heard and logged speeds: its header says another unit than its numbers have.
fn units_in_words(speed_ratio: f64) -> Option<String> {
    let of_turns = [("rpm", 1.0 / 60.0), ("rev/s", 1.0), ("rad/s", 1.0 / TAU)];
    let pairs = of_turns.into_iter().flat_map(|read| of_turns.into_iter().map(move |meant| (read, meant)));
    let (read, meant) = pairs
        .filter(|((read, _), (meant, _))| read != meant)
        .map(|((read, of_read), (meant, of_meant))| ((read, meant), of_meant / of_read))
        .find(|(_, ratio)| (speed_ratio / ratio - 1.0).abs() < UNIT_SHARE)?
        .0;
    Some(format!("the log seems to hold {meant}, but is read as {read}"))
}

/// "3/2", "2".
fn fraction_in_words(ratio: f64) -> String {
    let is_whole = |part: &u32| (f64::from(*part) * ratio - (f64::from(*part) * ratio).round()).abs() < 1e-9;
    match (1..=4).find(is_whole) {
        Some(1) => format!("{ratio:.0}"),
        Some(part) => format!("{:.0}/{part}", f64::from(part) * ratio),
        None => significant(ratio, 3),
    }
}

/// Why equal means prove nothing.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Undecided {
    /// The log fits better at an offset, in s, outside of the given limits.
    OffsetOutside(f64),
    /// Too few logged speeds lie within the ± of the heard ones.
    FewWithin,
    /// The offset lies at a limit that was given, and the speeds do not tell it.
    OffsetAtLimit,
    /// The speeds are too steady to show the offset of the log, or the heard ones do not follow quick changes.
    UnknownOffset,
}

/// Why the check is not decided, although the means are equal; `None` where it is decided.
fn undecided(found: &Verification) -> Option<Undecided> {
    if !found.is_right() || found.passes() {
        return None;
    }
    let is_clock_known = found.is_offset_told || found.is_offset_given;
    Some(match found.better_offset_s {
        Some(offset_s) => Undecided::OffsetOutside(offset_s),
        None if found.is_offset_at_limit => Undecided::OffsetAtLimit,
        None if is_clock_known || found.agreement == Agreement::Scattered => Undecided::FewWithin,
        None => Undecided::UnknownOffset,
    })
}

impl Undecided {
    /// The reason in words, and what to check.
    fn notice(self, found: &Verification) -> Notice {
        let within = percent_in_words(found.coverage());
        let few = format!("only {within} of the logged speeds lie within the ± of the heard speeds, and 95 % should");
        let means = fixed(100.0 * (found.speed_ratio - 1.0).abs(), 2);
        let means = format!("the mean speeds of sound and log differ by only {means} %, but");
        match self {
            Self::OffsetOutside(offset_s) => {
                let offset = signed(offset_s, 2);
                let what =
                    format!("the log fits better at an offset near {offset} s, which --log-offset-s does not allow");
                Notice::new(what, "give wider limits with --log-offset-s LOW:HIGH")
            }
            Self::FewWithin => Notice::new(
                format!("{means} {few}"),
                "check first that the log is of this flight, and then the offset of the log; if both are right, do not rely on the ± of the speed at a single moment",
            ),
            Self::OffsetAtLimit => Notice::new(
                format!(
                    "{means} the offset of the log lies at a limit of --log-offset-s, so the log may be of another flight"
                ),
                "check that the log is of this flight; if it is, give other limits, at most 2 s apart",
            ),
            Self::UnknownOffset => {
                let also = if found.coverage() < COVERAGE_OF_HALF { format!(". Also, {few}") } else { String::new() };
                Notice::new(
                    format!("{means} {OFFSET_NOT_KNOWN}, so the log may be of another flight{also}"),
                    "record a flight with a few climbs that last a second or longer: they change all speeds at once",
                )
            }
        }
    }
}

/// Why equal means prove nothing, and what to check.
pub(crate) fn undecided_check(found: &Verification) -> Option<Notice> {
    undecided(found).map(|why| why.notice(found))
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

#[cfg(test)]
mod tests {
    use super::*;
    use hovertone_analysis::VerifiedRotor;

    fn verified(coverage: f64, agreement: Agreement) -> Verification {
        let rotor = VerifiedRotor {
            track: 0,
            motor: 0,
            name: "motor 1".to_owned(),
            speed_rev_s: 60.0,
            bias_rev_s: 0.0,
            scatter_rev_s: 0.1,
            coverage,
            point_count: 100,
            points: Vec::new(),
        };
        Verification {
            offset_s: 0.0,
            is_offset_told: true,
            is_offset_given: false,
            is_offset_at_limit: false,
            better_offset_s: None,
            agreement,
            clock_rate_share: None,
            rotors: vec![rotor],
            speed_ratio: 1.0,
            near_ratio: None,
        }
    }

    /// A pass of order and clock is no pass of the ±.
    #[test]
    fn a_small_plus_minus_is_no_silent_pass() {
        let verdict = |coverage, agreement| verdict_in_words(&verified(coverage, agreement));
        assert!(verdict(0.95, Agreement::AsStated).starts_with(
            "passed: the number of blades (or the gear) is right, and the clock of the recorder is right within 0.5 %;"
        ));
        for (agreement, word) in
            [(Agreement::PlusMinusTooSmall, "is too small"), (Agreement::AsStated, "may be too small")]
        {
            let words = verdict(0.59, agreement);
            assert!(words.starts_with("passed: the number of blades") && words.contains("\nbut the ± "), "{words}");
            assert!(words.contains(word) && words.contains("only 59 % of the logged speeds"), "{words}");
            assert!(small_plus_minus(&verified(0.59, agreement)).is_some());
        }
        assert_eq!(small_plus_minus(&verified(0.9, Agreement::AsStated)), None);
        assert!(verdict(0.3, Agreement::Scattered).starts_with("not decided: "));
        assert_eq!(small_plus_minus(&verified(0.3, Agreement::Scattered)), None);
    }
}
