//! What `identify` would do, before it does it.

use crate::number::fixed;
use crate::printable::printable;
use crate::quote::{counted, tone_of_order};
use crate::table_lines::table_text;
use crate::text_table::{Column, TextTable};
use hovertone_analysis::Method;
use hovertone_thrust::Force;
use hovertone_vehicle::Order;

/// Seconds in a minute. *Physics.*
const MINUTE_S: f64 = 60.0;
/// *Physics.*
const MM_IN_M: f64 = 1e3;
/// *Physics.*
const HZ_IN_KHZ: f64 = 1e3;

/// A recording that was found.
#[derive(Clone, Debug, PartialEq)]
pub struct PlannedRecording {
    /// Its name.
    pub file: String,
    /// Its sound; the reason where it cannot be read.
    pub sound: Result<PlannedSound, String>,
}

/// The sound of a recording, from its header.
#[derive(Clone, Debug, PartialEq)]
pub struct PlannedSound {
    /// Length, where the header has it.
    pub length_s: Option<f64>,
    /// Sample rate.
    pub sample_rate_hz: f64,
    /// Number of channels.
    pub channel_count: usize,
    /// Codec for people.
    pub codec: String,
}

/// A load with its recordings.
#[derive(Clone, Debug, PartialEq)]
pub struct PlannedLoad {
    /// Its name.
    pub name: String,
    /// The force that the rotors balance.
    pub force: Force,
    /// The recordings that were found.
    pub recordings: Vec<PlannedRecording>,
}

/// An experiment before its analysis.
#[derive(Clone, Debug, PartialEq)]
pub struct PlannedExperiment<'a> {
    /// Name of the vehicle.
    pub vehicle_name: &'a str,
    /// Number of rotors.
    pub rotor_count: u32,
    /// Order of the tone.
    pub order: Order,
    /// Diameter of the propellers, where known.
    pub propeller_diameter_m: Option<f64>,
    /// How the speeds will be found.
    pub method: Method,
    /// The loads.
    pub loads: Vec<PlannedLoad>,
}

/// What the analysis would use, as lines and a table.
pub fn planned_experiment_text(plan: &PlannedExperiment<'_>, width: Option<usize>) -> String {
    let diameter = match plan.propeller_diameter_m {
        Some(diameter_m) => format!("propellers of {} mm", fixed(MM_IN_M * diameter_m, 1)),
        None => "diameter of the propellers not known".to_owned(),
    };
    let heard = plan.loads.iter().map(|load| load.recordings.len()).sum();
    let mut text = format!(
        "{}: {}, {}, {diameter}; {}, {}; without --check, hovertone finds {} in each recording (method: {})\n\n",
        printable(plan.vehicle_name),
        counted(plan.rotor_count as usize, "rotor"),
        tone_of_order(plan.order),
        counted(plan.loads.len(), "load"),
        counted(heard, "recording"),
        if plan.method == Method::Separated {
            "the speed of each rotor, or their mean where it cannot separate them,"
        } else {
            "one rotor speed"
        },
        plan.method.name().replace('_', " "),
    );
    let columns = vec![
        Column::words("load"),
        Column::numbers("mass", "kg"),
        Column::numbers("force", "N"),
        Column::words("recording"),
        Column::numbers("length", "min:s"),
        Column::words("sound"),
    ];
    let mut table = TextTable::new(columns);
    for load in &plan.loads {
        let mass = load.force.mass_kg().map_or("bench".to_owned(), |mass_kg| fixed(mass_kg, 3));
        let head = [printable(&load.name), mass, fixed(load.force.newtons(), 3)];
        if load.recordings.is_empty() {
            table.push([head.to_vec(), vec!["none".to_owned(), String::new(), String::new()]].concat());
        }
        for (index, recording) in load.recordings.iter().enumerate() {
            let head = if index == 0 { head.to_vec() } else { vec![String::new(); head.len()] };
            table.push([head, recording_cells(recording)].concat());
        }
    }
    text += &table_text(&table, width);
    text
}

fn recording_cells(recording: &PlannedRecording) -> Vec<String> {
    let (length, sound) = match &recording.sound {
        Ok(sound) => {
            let length = sound.length_s.map_or("?".to_owned(), minutes);
            let channels = counted(sound.channel_count, "channel");
            (length, format!("{}, {} kHz, {channels}", sound.codec, fixed(sound.sample_rate_hz / HZ_IN_KHZ, 1)))
        }
        Err(_) => (String::new(), "cannot be read".to_owned()),
    };
    vec![printable(&recording.file), length, printable(&sound)]
}

/// "1:02".
fn minutes(length_s: f64) -> String {
    let length_s = length_s.round();
    format!("{}:{:02}", (length_s / MINUTE_S).floor(), length_s % MINUTE_S)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_recording_stands_beside_its_load() {
        let sound = PlannedSound {
            length_s: Some(62.4),
            sample_rate_hz: 44_100.0,
            channel_count: 1,
            codec: "PCM, 16 bit".to_owned(),
        };
        let recording = |file: &str, sound| PlannedRecording { file: file.to_owned(), sound };
        let load = |name: &str, force, recordings| PlannedLoad { name: name.to_owned(), force, recordings };
        let weight = Force::Weight {
            vehicle_mass_kg: 0.413,
            added_mass_kg: 0.031,
            mass_std_kg: 0.0,
            gravity_m_s2: 9.8,
            gravity_std_m_s2: 0.0,
        };
        let plan = PlannedExperiment {
            vehicle_name: "mine",
            rotor_count: 4,
            order: Order::new(2.0).unwrap(),
            propeller_diameter_m: None,
            method: Method::MaximumTrace,
            loads: vec![
                load(
                    "hull",
                    weight,
                    vec![recording("a.mov", Ok(sound)), recording("b.mov", Err("no sound".to_owned()))],
                ),
                load("bench", Force::Thrust { thrust_n: 1.0, thrust_std_n: 0.0 }, vec![]),
            ],
        };
        let text = planned_experiment_text(&plan, None);
        for words in [
            "4 rotors, tone at 2 times the rotor speed, diameter of the propellers not known; 2 loads, 2 recordings; without --check, hovertone finds one rotor speed in each recording (method: maximum trace)",
            "0.444",
            "1:02",
            "44.1 kHz, 1 channel",
            "cannot be read",
            "none",
        ] {
            assert!(text.contains(words), "{words}:\n{text}");
        }
    }
}
