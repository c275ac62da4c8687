//! Which values of a topic are signals, in which unit, and what they tell about the rotors.

use super::layout::Value;
use crate::packed::Place;
use crate::table::{SignalRole, TableSignal};

/// Endings of names that tell a unit.
const UNITS: [(&str, &str); 10] = [
    ("_rad_s", "rad/s"),
    ("_m_s2", "m/s²"),
    ("_m_s", "m/s"),
    ("_rad", "rad"),
    ("_deg", "°"),
    ("_v", "V"),
    ("_a", "A"),
    ("_pa", "Pa"),
    ("_celcius", "°C"),
    ("_mah", "mAh"),
];
/// Values of an ESC, whose names do not tell their units.
const UNITS_OF_ESC: [(&str, &str); 3] = [(".esc_voltage", "V"), (".esc_current", "A"), (".esc_temperature", "°C")];

/// The signals of a topic, and their places with the factor to their units. Times of the message are no signals.
pub(super) fn signals_of(topic: &str, values: &[Value]) -> (Vec<TableSignal>, Vec<Place>) {
    let is_signal = |value: &&Value| value.name != "timestamp" && value.name != "timestamp_sample";
    values.iter().filter(is_signal).map(|value| signal_of(topic, value)).unzip()
}

fn signal_of(topic: &str, Value { name, place }: &Value) -> (TableSignal, Place) {
    if name.ends_with("rpm") {
        let place = Place { factor: 1.0 / 60.0, ..*place };
        let signal = match index_of(name, "esc").filter(|_| topic == "esc_status") {
            Some(esc) => TableSignal::with_role(name.clone(), SignalRole::RotorSpeed(esc + 1)),
            None => TableSignal { unit: "rev/s".to_owned(), ..TableSignal::plain(name.clone()) },
        };
        return (signal, place);
    }
    let role = match topic {
        "actuator_motors" => index_of(name, "control").map(|channel| SignalRole::Command(channel + 1)),
        "actuator_outputs" => index_of(name, "output").map(|channel| SignalRole::Command(channel + 1)),
        "vehicle_angular_velocity" => index_of(name, "xyz").map(|axis| SignalRole::BodyRate(axis as usize)),
        "sensor_combined" => index_of(name, "gyro_rad").map(|axis| SignalRole::BodyRate(axis as usize)),
        _ => None,
    };
    let signal = match role {
        Some(role) => TableSignal::with_role(name.clone(), role),
        None => {
            let field = name.split('[').next().unwrap_or_default();
            let unit = UNITS.iter().find(|(ending, _)| field.ends_with(ending));
            let unit = unit.or_else(|| UNITS_OF_ESC.iter().find(|(ending, _)| name.ends_with(ending)));
            TableSignal { unit: unit.map_or("", |(_, unit)| unit).to_owned(), ..TableSignal::plain(name.clone()) }
        }
    };
    (signal, *place)
}

/// The index in "field[index]…".
fn index_of(name: &str, field: &str) -> Option<u32> {
    let (index, _) = name.strip_prefix(field)?.strip_prefix('[')?.split_once(']')?;
    index.parse().ok()
}
