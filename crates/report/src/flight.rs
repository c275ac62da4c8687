//! Summary of a simulated flight.

use crate::number::significant;
use crate::quote::counted;
use crate::table_lines::table_text;
use crate::text_table::{Column, TextTable};
use hovertone_vehicle::RotorSpeed;

/// A simulated flight, summarised over its hovers, or over the whole flight where it has none.
#[derive(Clone, Debug, PartialEq)]
pub struct SimulatedFlight {
    /// Name of the preset of the vehicle.
    pub vehicle: String,
    /// Total mass.
    pub mass_kg: f64,
    /// Gravity.
    pub gravity_m_s2: f64,
    /// Length of the flight.
    pub duration_s: f64,
    /// Number of channels of the sound.
    pub microphone_count: usize,
    /// Seed of all random numbers.
    pub seed: u64,
    /// Time in hover; absent where the means are over the whole flight.
    pub hover_s: Option<f64>,
    /// The rotors.
    pub rotors: Vec<SimulatedRotor>,
    /// Constant by the balance of weight and thrust in hover, the truth for an estimate; absent where nothing hovers.
    pub thrust_constant_total_n_s2: Option<f64>,
}

/// One rotor of a simulated flight.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SimulatedRotor {
    /// Mean speed.
    pub speed: RotorSpeed,
    /// Standard deviation of the speed.
    pub spread: RotorSpeed,
    /// Constant of this rotor.
    pub thrust_constant_n_s2: f64,
}

/// A headline, a row for each rotor, and the constant.
pub fn simulated_flight_table(flight: &SimulatedFlight, width: Option<usize>) -> String {
    let mut text = format!(
        "{}, {} g: {:.1} s of flight, {}, seed {}\n{}\n",
        flight.vehicle,
        significant(1000.0 * flight.mass_kg, 4),
        flight.duration_s,
        counted(flight.microphone_count, "microphone"),
        flight.seed,
        match flight.hover_s {
            Some(hover_s) => format!("Means over {hover_s:.1} s of hover"),
            None => "Means over the whole flight: there is no hover".to_owned(),
        }
    );
    let mut table = TextTable::new(vec![
        Column::words("rotor"),
        Column::numbers("speed", "rev/s"),
        Column::numbers("spread", "rev/s"),
        Column::numbers("speed", "rpm"),
        Column::numbers("speed", "rad/s"),
        Column::numbers("C_f", "N s²"),
    ]);
    for (number, rotor) in (1..).zip(&flight.rotors) {
        table.push(vec![
            format!("{number}"),
            significant(rotor.speed.rev_s(), 6),
            significant(rotor.spread.rev_s(), 2),
            significant(rotor.speed.rpm(), 6),
            significant(rotor.speed.rad_s(), 6),
            format!("{:.4e}", rotor.thrust_constant_n_s2),
        ]);
    }
    text += &table_text(&table, width);
    if let Some(total) = flight.thrust_constant_total_n_s2 {
        text +=
            &format!("C_f of the whole vehicle, in hover: {total:.4e} N s² (weight m g over the mean ω² of a rotor)\n");
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_flight_is_told_in_a_few_lines() {
        let rotor = SimulatedRotor {
            speed: RotorSpeed::from_rpm(3610.0),
            spread: RotorSpeed::from_rpm(44.0),
            thrust_constant_n_s2: 7.0775e-6,
        };
        let mut flight = SimulatedFlight {
            vehicle: "ardrone".to_owned(),
            mass_kg: 0.413,
            gravity_m_s2: 9.8,
            duration_s: 10.0,
            microphone_count: 1,
            seed: 3,
            hover_s: Some(8.0),
            rotors: vec![rotor; 4],
            thrust_constant_total_n_s2: Some(2.831e-5),
        };
        let text = simulated_flight_table(&flight, None);
        for words in [
            "413.0 g",
            "1 microphone,",
            "seed 3",
            "8.0 s of hover",
            "3610.00",
            "0.73",
            "7.0775e-6",
            "2.8310e-5 N s² (weight m g",
        ] {
            assert!(text.contains(words), "{words}:\n{text}");
        }
        (flight.hover_s, flight.thrust_constant_total_n_s2) = (None, None);
        assert!(simulated_flight_table(&flight, None).contains("no hover"));
    }
}
