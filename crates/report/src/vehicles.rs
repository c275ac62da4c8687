//! The vehicles, presets or the user's own, every number with its source.

use crate::printable::{width_of, wrapped};
use hovertone_vehicle::{Sourced, Vehicle};
use std::fmt::Write;

/// Text in place of a number without a source.
const UNKNOWN: &str = "not known";
/// Text for direct drive, or for a gear without a source; a vehicle does not distinguish them.
const NO_GEAR: &str = "none known";
/// Fewest columns of a source beside its number.
const SOURCE_WIDTH_MIN: usize = 30;
/// Columns before a source below its number.
const SOURCE_INDENT: usize = 4;

/// Vehicles for people, in lines of at most `width` characters where possible.
pub fn vehicles_text(vehicles: &[Vehicle], width: usize) -> String {
    let id_width = vehicles.iter().map(|vehicle| vehicle.id.len()).max().unwrap_or(0);
    let rows: Vec<Vec<Row>> = vehicles.iter().map(rows_of).collect();
    let all = || rows.iter().flatten();
    let name_width = all().map(|row| width_of(row.name)).max().unwrap_or(0);
    let value_width = all().map(|row| width_of(&row.value)).max().unwrap_or(0);
    let indent = 2 + name_width + 2 + value_width + 2;
    // on a narrow terminal a source stands below its number
    let is_below = width.saturating_sub(indent) < SOURCE_WIDTH_MIN;
    let indent = if is_below { SOURCE_INDENT } else { indent };
    let source_width = width.saturating_sub(indent);
    let mut text = String::new();
    for (vehicle, rows) in vehicles.iter().zip(&rows) {
        // writing to a string does not fail
        let name = wrapped(vehicle.name, width.saturating_sub(id_width + 2)).join(&format!("\n{:id_width$}  ", ""));
        let _ = writeln!(text, "{:id_width$}  {name}", vehicle.id);
        for Row { name, value, source } in rows {
            let space = |text: &str, width: usize| " ".repeat(width.saturating_sub(width_of(text)));
            let head = format!("  {name}{}  {value}{}", space(name, name_width), space(value, value_width));
            let sources = wrapped(source, source_width);
            let beside = usize::from(!is_below && !sources.is_empty());
            let first = sources.iter().take(beside).map(String::as_str).collect::<String>();
            let _ = writeln!(text, "{}", format!("{head}  {first}").trim_end());
            for line in sources.iter().skip(beside) {
                let _ = writeln!(text, "{:indent$}{line}", "");
            }
        }
        text.push('\n');
    }
    text
}

struct Row {
    name: &'static str,
    value: String,
    source: &'static str,
}

fn rows_of(vehicle: &Vehicle) -> Vec<Row> {
    let tone = match (vehicle.tone_order(), vehicle.gear_mesh_order()) {
        (Some(order), Some(_)) => format!("{order} (gear mesh)"),
        (Some(order), None) => format!("{order} (blade pass)"),
        (None, _) => "give --blades".to_owned(),
    };
    let gear = vehicle.gear.map_or(NO_GEAR.to_owned(), |gear| format!("{}:{}", gear.value.pinion, gear.value.wheel));
    vec![
        Row { name: "tone order", value: tone, source: "" },
        row("rotors", Some(vehicle.rotor_count), |count| count.to_string()),
        row("blades", vehicle.blade_count, |count| count.to_string()),
        Row { value: gear, ..row("gear", vehicle.gear, |_| String::new()) },
        row("propeller", vehicle.propeller_diameter_m, |diameter_m| format!("{:.1} mm", 1e3 * diameter_m)),
        row("mass", vehicle.mass_kg, |mass_kg| format!("{} g", (1e6 * mass_kg).round() / 1e3)),
        row("shaft speed", vehicle.shaft_speed, |range| format!("{}–{} rev/s", range.rev_s_low, range.rev_s_high)),
    ]
}

fn row<T>(name: &'static str, number: Option<Sourced<T>>, in_words: impl Fn(T) -> String) -> Row {
    match number {
        Some(Sourced { value, source }) => Row { name, value: in_words(value), source },
        None => Row { name, value: UNKNOWN.to_owned(), source: "" },
    }
}

/// Vehicles as JSON, ending with a line feed.
///
/// # Errors
/// None is known, since all types can be serialised.
pub fn vehicles_json(vehicles: &[Vehicle]) -> Result<String, serde_json::Error> {
    Ok(serde_json::to_string_pretty(vehicles)? + "\n")
}

#[cfg(test)]
mod tests {
    use super::*;
    use hovertone_vehicle::presets;

    #[test]
    fn every_number_is_shown_with_its_source_and_lines_are_not_too_long() {
        let text = vehicles_text(presets(), 100);
        for vehicle in presets() {
            assert!(text.contains(vehicle.name), "{}", vehicle.name);
        }
        assert!(text.contains("8:69") && text.contains("413 g") && text.contains("69 (gear mesh)"));
        let longest = text.lines().map(width_of).max().unwrap();
        assert!((90..=100).contains(&longest), "{longest}");
        let words = text.split_whitespace().collect::<Vec<_>>().join(" ");
        assert!(words.contains("tooth counts derived"), "{words}");
    }

    #[test]
    fn on_a_narrow_terminal_nothing_is_wider_and_nothing_is_lost() {
        let words = |text: &str| text.split_whitespace().map(str::to_owned).collect::<Vec<_>>();
        for width in [50, 80] {
            let text = vehicles_text(presets(), width);
            assert!(text.lines().all(|line| width_of(line) <= width), "{width}:\n{text}");
            assert_eq!(words(&text), words(&vehicles_text(presets(), 100)));
        }
    }

    #[test]
    fn json_has_every_preset() {
        let parsed: serde_json::Value = serde_json::from_str(&vehicles_json(presets()).unwrap()).unwrap();
        assert_eq!(parsed.as_array().unwrap().len(), presets().len());
        assert_eq!(parsed[0]["gear"]["value"]["wheel"], 69);
    }
}
