//! The mass of a hovering vehicle from its sound.

use crate::notice::Notice;
use crate::number::{may_be_zero, rounded, significant, with_uncertainty};
use crate::recording::SpeedRecord;
use crate::thrust::WITHOUT_FLIGHTS;
use crate::version::VERSION;
use hovertone_thrust::WeighedHover;
use hovertone_vehicle::{COVERAGE_FACTOR, Estimate, RotorSpeed};
use serde::Serialize;

/// Digits of a mass without uncertainty.
const DIGITS: usize = 3;
/// Payload over the mass of its vehicle, above which a wrong constant is more probable: rotors that lift three times the vehicle are strong ones.
const PAYLOAD_FACTOR: f64 = 2.0;

#[derive(Serialize)]
struct WeighedDocument<'a> {
    mass_kg: Option<Estimate>,
    payload_kg: Option<Estimate>,
    speed_rad_s: Option<RotorSpeed>,
    recording_count: usize,
    has_flight_scatter: Option<bool>,
    warnings: &'a [Notice],
    recordings: Vec<HeardLine<'a>>,
    version: &'static str,
}

/// What a recording gave, and what weakens it.
#[derive(Serialize)]
struct HeardLine<'a> {
    file: &'a str,
    status: &'static str,
    reason: Option<String>,
    warnings: &'a [Notice],
}

impl<'a> From<&'a SpeedRecord> for HeardLine<'a> {
    fn from(record: &'a SpeedRecord) -> Self {
        Self { file: &record.file, status: record.status(), reason: record.reason(), warnings: &record.notices }
    }
}

/// JSON, ending with a line feed. `warnings` are about the mass, those of a recording stand beside its name. Where no recording has a
/// speed, the mass is null.
///
/// # Errors
/// None is known, since all types can be serialised.
pub fn weighed_json(
    weighed: Option<&WeighedHover>,
    warnings: &[Notice],
    records: &[SpeedRecord],
) -> Result<String, serde_json::Error> {
    let document = WeighedDocument {
        mass_kg: weighed.map(|weighed| weighed.mass_kg),
        payload_kg: weighed.and_then(|weighed| weighed.payload_kg),
        speed_rad_s: weighed.map(|weighed| weighed.speed),
        recording_count: weighed.map_or(0, |weighed| weighed.recording_count),
        has_flight_scatter: weighed.map(|weighed| weighed.has_flight_scatter),
        warnings,
        recordings: records.iter().map(HeardLine::from).collect(),
        version: VERSION,
    };
    Ok(serde_json::to_string_pretty(&document)? + "\n")
}

/// Mass and payload in grams, with their expanded uncertainties. `listed_kg` is the mass of the vehicle in the list of vehicles, where nobody
/// gave the mass of this one.
pub fn weighed_text(weighed: &WeighedHover, listed_kg: Option<f64>) -> String {
    let flights = if weighed.has_flight_scatter { "" } else { WITHOUT_FLIGHTS };
    let grams = |mass_kg: Estimate| {
        let mass = mass_kg.scaled(1e3);
        match mass.std_uncertainty {
            Some(_) => format!("{} g (k = 2{flights})", with_uncertainty(mass.value, mass.std_uncertainty)),
            None => {
                format!(
                    "{} g (its ± is not known, because the constant is given without one; give half the ± of the constant, its standard uncertainty, with --constant-std-n-s2)",
                    significant(mass.value, DIGITS)
                )
            }
        }
    };
    let share = weighed.mass_kg.std_uncertainty.map(|std| COVERAGE_FACTOR * std / weighed.mass_kg.value);
    let mut text = format!(
        "hovers at {} rpm ({} {})\nmass as flown: {}\n",
        // m ∝ ω²: the speed is known to half of the share of the mass
        rounded(weighed.speed.rpm(), share.map(|share| share / 2.0 * weighed.speed.rpm()).or(Some(10.0))),
        weighed.recording_count,
        if weighed.recording_count == 1 { "recording" } else { "recordings" },
        grams(weighed.mass_kg)
    );
    text += &match weighed.payload_kg {
        Some(payload_kg) => {
            let or_none = match may_be_zero(payload_kg) {
                true => "; the ± is larger than the payload, so there may be none",
                false if payload_kg.value < 0.0 => {
                    "; no payload weighs less than nothing: check the constant, the mass of the vehicle, and the blades or the gear"
                }
                false if payload_kg.value > PAYLOAD_FACTOR * (weighed.mass_kg.value - payload_kg.value) => {
                    "; hardly any multirotor carries so much: check the constant, the mass of the vehicle, and the blades or the gear"
                }
                false => "",
            };
            format!("payload: {}{or_none}\n", grams(payload_kg))
        }
        None => {
            let give = match listed_kg {
                Some(mass_kg) => format!("if it is {mass_kg} kg, as in the list of vehicles, give --mass-kg {mass_kg}"),
                None => "give it with --mass-kg".to_owned(),
            };
            format!("payload: not known, because the mass of the vehicle alone is not given ({give})\n")
        }
    };
    if weighed.mass_kg.std_uncertainty.is_some() {
        text += "the ± of the mass includes the uncertainties of the constant, of the heard speeds and of gravity";
        text += match weighed.payload_kg {
            Some(_) => "; the ± of the payload also includes the uncertainty of the mass of the vehicle\n",
            None => "\n",
        };
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;
    use hovertone_vehicle::Ending;

    #[test]
    fn the_speed_has_no_more_digits_than_the_mass_allows() {
        let weighed = |std_kg: Option<f64>, has_flight_scatter: bool| {
            let weighed = WeighedHover {
                mass_kg: Estimate { value: 0.462, std_uncertainty: std_kg, ending: Ending::Solved },
                payload_kg: None,
                speed: RotorSpeed::from_rpm(3820.1234),
                recording_count: 5,
                has_flight_scatter,
            };
            weighed_text(&weighed, Some(0.38))
        };
        // ± 0.6 % of the mass are ± 0.3 % of the speed, 12 rpm
        assert!(
            weighed(Some(0.0014), true)
                .starts_with("hovers at 3820 rpm (5 recordings)\nmass as flown: 462.0 ± 2.8 g (k = 2)\n")
        );
        assert!(weighed(None, true).starts_with("hovers at 3820 rpm"));
        assert!(weighed(Some(0.0014), false).contains("(k = 2, without the differences from flight to flight)"));
        assert!(weighed(None, true).contains("if it is 0.38 kg, as in the list of vehicles, give --mass-kg 0.38)"));
    }

    #[test]
    fn a_payload_that_hardly_any_multirotor_lifts_is_named() {
        let weighed = |payload_kg: f64| {
            let of = |value| Estimate { value, std_uncertainty: Some(0.01 * value), ending: Ending::Solved };
            let weighed = WeighedHover {
                mass_kg: of(0.4 + payload_kg),
                payload_kg: Some(of(payload_kg)),
                speed: RotorSpeed::from_rpm(3820.0),
                recording_count: 5,
                has_flight_scatter: true,
            };
            weighed_text(&weighed, None)
        };
        assert!(!weighed(0.6).contains("hardly any multirotor"));
        assert!(weighed(1.2).contains("hardly any multirotor carries so much: check the constant"), "{}", weighed(1.2));
    }
}
