//! The shaft lines of the rotors as a table, without a diagnosis.

use crate::number::{DASH, rounded};
use crate::recording::SpeedRecord;
use crate::speed::name_of_rotor;
use crate::table_lines::table_text;
use crate::text_table::{Column, TextTable};
use hovertone_analysis::ShaftLine;

/// The lines of all rotors, each relative to its own blade pass; `None` where no recording has them.
pub fn condition_table(records: &[SpeedRecord], width: Option<usize>) -> Option<String> {
    let mut table = TextTable::new(vec![
        Column::words("lines against the blade pass"),
        Column::numbers("once per turn", "dB"),
        Column::numbers("loudest between", "dB"),
        Column::numbers("its order", ""),
        Column::numbers("harmonics missing", ""),
    ]);
    let wanted = || records.iter().filter(|record| record.wants_condition && record.speed().is_some());
    wanted().next()?;
    for record in wanted() {
        let why_none = if record.rotors().is_empty() {
            "not known: this needs two or more rotors that could be separated"
        } else {
            ""
        };
        table.push_words(record.file.clone(), why_none.to_owned());
        for (index, rotor) in record.rotors().iter().enumerate() {
            let name = name_of_rotor(record, index);
            let Some(condition) = &rotor.condition else {
                let why = if record.given_facts().blades || record.given_facts().vehicle {
                    "not known: another rotor sounds too near to the tone of its blades"
                } else {
                    "not known: give the number of blades with --blades N"
                };
                table.push_words(name, why.to_owned());
                continue;
            };
            let between = condition.loudest_between();
            let missing: Vec<String> = condition.missing_harmonics.iter().map(u32::to_string).collect();
            table.push(vec![
                name,
                condition.lines.first().map_or_else(|| DASH.to_owned(), level),
                between.map_or_else(|| DASH.to_owned(), level),
                between.map_or_else(|| DASH.to_owned(), |line| line.order.to_string()),
                if missing.is_empty() { DASH.to_owned() } else { missing.join(", ") },
            ]);
        }
    }
    Some(table_text(&table, width))
}

/// The level of a line, or the level of the noise for an inaudible line.
fn level(line: &ShaftLine) -> String {
    match (line.level_db, line.noise_db) {
        (Some(level_db), _) => rounded(level_db, line.std_uncertainty_db),
        (None, Some(noise_db)) => format!("< {noise_db:.0}"),
        (None, None) => DASH.to_owned(),
    }
}
