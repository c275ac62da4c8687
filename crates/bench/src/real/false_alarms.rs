//! Rotors that are told where none is.

use super::answer::Status;
use super::judgement::Verdict;
use super::limits::poisson_upper_limit;
use super::rows::Row;
use crate::document::Document;
use std::collections::BTreeSet;

const SECONDS_PER_MINUTE: f64 = 60.0;
const MINUTES_PER_HOUR: f64 = 60.0;

/// Recordings without a rotor, heard in one mode.
struct Silence<'a> {
    name: String,
    rows: Vec<&'a Row>,
}

fn silences(rows: &[Row]) -> Vec<Silence<'_>> {
    let mut found = Vec::new();
    let negatives = || rows.iter().filter(|row| row.is_negative);
    let modes: BTreeSet<&str> = negatives().map(|row| row.mode.as_str()).collect();
    for (name, is_helicopter, is_low) in
        [("no rotor", false, false), ("no rotor (low confidence)", false, true), ("helicopters", true, false)]
    {
        for mode in &modes {
            let is_meant = |row: &&Row| {
                (row.class == "helicopter") == is_helicopter && row.is_low_confidence == is_low && row.mode == *mode
            };
            let rows: Vec<&Row> = negatives().filter(is_meant).collect();
            if !rows.is_empty() {
                found.push(Silence { name: format!("{name}, {mode}"), rows });
            }
        }
    }
    found
}

impl Silence<'_> {
    fn cells(&self) -> Vec<String> {
        let minutes = self.rows.iter().filter_map(|row| row.heard_s).sum::<f64>() / SECONDS_PER_MINUTE;
        let of_status = |status: Status| self.rows.iter().filter(move |row| row.status == status);
        let alarms = of_status(Status::Ok).filter(|row| row.verdict == Verdict::Wrong).count();
        let per_hour = |count: f64| format!("{:.0}", count / minutes * MINUTES_PER_HOUR);
        vec![
            self.name.clone(),
            self.rows.len().to_string(),
            format!("{minutes:.1}"),
            alarms.to_string(),
            per_hour(alarms as f64),
            per_hour(poisson_upper_limit(alarms)),
            (of_status(Status::Ok).count() - alarms).to_string(),
            of_status(Status::Ambiguous).count().to_string(),
        ]
    }
}

/// The section of the report.
pub(super) fn add_false_alarms(document: &mut Document, rows: &[Row]) {
    document.heading("False alarms");
    document.paragraph(
        "Recordings without a rotor to be found: backgrounds, voices, machines, drones too faint to be heard, and helicopters. A false alarm \
         is a speed outside what the truth also accepts (a rotor that may be there after all). Per hour: as measured, and the upper 95 % limit \
         of a Poisson count (Garwood 1936). Ambiguous: a rotor without a settled speed; not counted as an alarm, but a rotor is claimed.",
    );
    let heads = [
        "what, mode",
        "recordings",
        "minutes",
        "false alarms",
        "per hour",
        "95 % limit per hour",
        "speeds also accepted",
        "ambiguous",
    ];
    document.table(&heads, &silences(rows).iter().map(Silence::cells).collect::<Vec<_>>());
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::real::rows::tests::row;

    #[test]
    fn alarms_are_counted_by_the_hour() {
        let negative = |status, verdict| Row {
            is_negative: true,
            heard_s: Some(30.0),
            status,
            ..row("background", "blades", verdict)
        };
        let rows = [
            negative(Status::NoRotorTone, Verdict::Right),
            negative(Status::Ok, Verdict::Wrong),
            negative(Status::Ok, Verdict::Right),
            negative(Status::Ambiguous, Verdict::Right),
            Row { class: "helicopter".to_owned(), ..negative(Status::NoRotorTone, Verdict::Right) },
            row("drone", "blades", Verdict::Wrong),
        ];
        let found = silences(&rows);
        assert_eq!(found.len(), 2);
        assert_eq!(found[0].cells(), ["no rotor, blades", "4", "2.0", "1", "30", "142", "1", "1"]);
        assert_eq!(found[1].cells()[..5], ["helicopters, blades", "1", "0.5", "0", "0"]);
    }
}
