//! The shaft lines of the rotors as a table, without a diagnosis.

use crate::number::{DASH, fixed, rounded};
use crate::recording::SpeedRecord;
use crate::speed::name_of_rotor;
use crate::table_lines::table_text;
use crate::text_table::{Column, TextTable};
use hovertone_analysis::{Method, RotorCondition, ShaftLine};

const WITHOUT_BLADES: &str = "not known: give the number of blades with --blades N";

/// The lines of all rotors, each relative to its own blade pass; `None` where no recording has them.
pub fn condition_table(records: &[SpeedRecord], width: Option<usize>) -> Option<String> {
    let mut table = TextTable::new(vec![
        Column::words("lines against the tone of the blades"),
        Column::numbers("once per turn", "dB"),
        Column::numbers("loudest other line", "dB"),
        Column::numbers("order of this line", ""),
        Column::numbers("missing harmonics", ""),
    ]);
    let wanted = || records.iter().filter(|record| record.wants_condition && record.speed().is_some());
    wanted().next()?;
    for record in wanted() {
        let are_blades_known = record.are_blades_known();
        if let Some(condition) = record.tone().and_then(|tone| tone.condition.as_ref()) {
            table.push(row(record.file.clone(), condition));
            continue;
        }
        let why_none = match () {
            () if !record.rotors().is_empty() => "",
            () if !are_blades_known => WITHOUT_BLADES,
            () if is_short(record) => "not known: less than 4 s of the sound are used; record for longer",
            () if record.is_one_rotor() => {
                "not known: no clear tone of the blades lasts 4 s; hold the speed for longer, or place the microphone nearer"
            }
            () if record.method != Method::Separated => {
                "not known: this method does not separate rotors; leave --method and --mean-only out; if one rotor turns, give --rotors 1"
            }
            () => "not known: the rotors could not be separated; if one rotor turns, give --rotors 1",
        };
        table.push_words(record.file.clone(), why_none.to_owned());
        for (index, rotor) in record.rotors().iter().enumerate() {
            let name = name_of_rotor(record, index);
            match &rotor.condition {
                Some(condition) => table.push(row(name, condition)),
                None if are_blades_known => {
                    table.push_words(
                        name,
                        "not known: another rotor sounds too near to the tone of its blades".to_owned(),
                    );
                }
                None => table.push_words(name, WITHOUT_BLADES.to_owned()),
            }
        }
    }
    Some(table_text(&table, width))
}

/// Whether less of the sound is used than a condition needs.
fn is_short(record: &SpeedRecord) -> bool {
    record.analysis().is_some_and(|analysis| analysis.hover.length_s() < CONDITION_S_MIN)
}

fn row(name: String, condition: &RotorCondition) -> Vec<String> {
    let between = condition.loudest_between();
    let missing: Vec<String> = condition.missing_harmonics.iter().map(u32::to_string).collect();
    vec![
        name,
        condition.lines.first().map_or_else(|| DASH.to_owned(), level),
        between.map_or_else(|| DASH.to_owned(), level),
        between.map_or_else(|| DASH.to_owned(), |line| line.order.to_string()),
        if missing.is_empty() { DASH.to_owned() } else { missing.join(", ") },
    ]
}

/// Length of a clear tone from which a condition is told, s.
const CONDITION_S_MIN: f64 = 4.0;

/// No level is told finer than this: a microphone's own response is known no better, dB.
const LEVEL_STD_DB_MIN: f64 = 0.1;

/// The level of a line, or the level of the noise for an inaudible line.
fn level(line: &ShaftLine) -> String {
    match (line.level_db, line.noise_db) {
        (Some(level_db), _) => rounded(level_db, line.std_uncertainty_db.map(|std_db| std_db.max(LEVEL_STD_DB_MIN))),
        (None, Some(noise_db)) => format!("< {}", fixed(noise_db, 0)),
        (None, None) => DASH.to_owned(),
    }
}
