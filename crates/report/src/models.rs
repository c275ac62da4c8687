//! Models of simulators compared with the measured constant.

use crate::number::{DASH, PowerOfTen, signed, significant};
use crate::printable::printable;
use crate::table_lines::table_text;
use crate::text_table::{Column, TextTable};
use crate::thrust::{CONSTANT_UNIT, grams};
use crate::version::VERSION;
use hovertone_exchange::{IdentifiedRotor, SimulatorModel};
use hovertone_thrust::{ThrustTable, VehicleModel};
use hovertone_vehicle::RotorSpeed;
use serde::Serialize;

/// A model that was read from a file.
#[derive(Clone, Debug)]
pub struct ComparedModel {
    /// Name of the file.
    pub file: String,
    /// Content of the file.
    pub model: SimulatorModel,
}

#[derive(Serialize)]
struct Compared<'a> {
    file: &'a str,
    format: &'static str,
    constant_name: &'static str,
    constant_unit: &'static str,
    thrust_constant_per_rotor_n_s2: f64,
    thrust_constant_at_hover_n_s2: f64,
    over_heard: f64,
    mass_kg: Option<f64>,
    rotor_count: Option<u32>,
    hover_speed_rad_s: Option<f64>,
    heard_hover_speed_rad_s: Option<f64>,
    version: &'static str,
}

fn compared<'a>(compared: &'a ComparedModel, heard: &IdentifiedRotor) -> Compared<'a> {
    let model = &compared.model;
    let speed_rad_s = heard.hover_speed_rad_s.or(heard.hover_speed_by_balance_rad_s());
    let at_hover = speed_rad_s.map_or(model.thrust_constant_n_s2, |speed| model.constant_at_n_s2(speed));
    let thrust_n = heard.mass_kg.map(|mass_kg| mass_kg * heard.gravity_m_s2 / f64::from(heard.rotor_count));
    let (constant_name, constant_unit) = model.format.constant();
    Compared {
        file: &compared.file,
        format: model.format.name(),
        constant_name,
        constant_unit,
        thrust_constant_per_rotor_n_s2: model.thrust_constant_n_s2,
        thrust_constant_at_hover_n_s2: at_hover,
        over_heard: at_hover / heard.thrust_constant_n_s2,
        mass_kg: model.mass_kg,
        rotor_count: model.rotor_count,
        hover_speed_rad_s: thrust_n.and_then(|thrust_n| model.speed_rad_s(thrust_n)),
        heard_hover_speed_rad_s: speed_rad_s,
        version: VERSION,
    }
}

/// One JSON object per line and model.
///
/// # Errors
/// None is known, since all types can be serialised.
pub fn models_json(models: &[ComparedModel], heard: &IdentifiedRotor) -> Result<String, serde_json::Error> {
    let lines = models.iter().map(|model| Ok(serde_json::to_string(&compared(model, heard))? + "\n"));
    lines.collect()
}

/// A row for the measured constant and one for each model. The speed is the one at which the model would carry the measured vehicle.
pub fn models_text(models: &[ComparedModel], heard: &IdentifiedRotor, width: Option<usize>) -> String {
    let rows: Vec<Compared<'_>> = models.iter().map(|model| compared(model, heard)).collect();
    let constants = rows.iter().map(|row| row.thrust_constant_at_hover_n_s2);
    let unit = PowerOfTen::of(constants.chain([heard.thrust_constant_n_s2]));
    let mut text = TextTable::new(vec![
        Column::words("model"),
        Column::words("constant"),
        Column::numbers("C_f, one rotor", &unit.unit(CONSTANT_UNIT)),
        Column::numbers("model / measured", ""),
        Column::numbers("its mass", "g"),
        Column::numbers("hovers at", "rpm"),
    ]);
    let rpm = |rad_s: Option<f64>| rad_s.map_or(DASH.to_owned(), |s| format!("{:.0}", RotorSpeed::from_rad_s(s).rpm()));
    text.push(vec![
        heard.vehicle_name.clone(),
        "as measured".to_owned(),
        significant(unit.scale(heard.thrust_constant_n_s2), 5),
        "1".to_owned(),
        heard.mass_kg.map_or(DASH.to_owned(), grams),
        rpm(heard.hover_speed_rad_s.or(heard.hover_speed_by_balance_rad_s())),
    ]);
    for row in rows {
        text.push(vec![
            row.file.to_owned(),
            format!("{} [{}]", row.constant_name, row.constant_unit),
            significant(unit.scale(row.thrust_constant_at_hover_n_s2), 5),
            significant(row.over_heard, 4),
            row.mass_kg.map_or(DASH.to_owned(), grams),
            rpm(row.hover_speed_rad_s),
        ]);
    }
    let mut words = table_text(&text, width);
    if let Some(expanded) = heard.expanded_uncertainty_n_s2 {
        let percent = 100.0 * expanded / heard.thrust_constant_n_s2;
        words += &format!("the ± of the measured constant is {percent:.2} % (k = 2)\n");
    }
    if let Some(first) = first_speed_in_words(heard) {
        words += &format!(
            "\"hovers at\": in the first row, {first}; in every other row, the speed at which the measured vehicle would hover with the constant of this row\n"
        );
    }
    words
}

/// What the speed of the measured constant is; `None` where it has none.
fn first_speed_in_words(heard: &IdentifiedRotor) -> Option<&'static str> {
    match heard.hover_speed_rad_s {
        Some(_) => Some("the speed that was heard"),
        None => heard.hover_speed_by_balance_rad_s().map(|_| "the speed at which its thrust carries the vehicle"),
    }
}

/// A line for the model that an experiment names as its vehicle; empty without a measured constant.
pub fn vehicle_model_text(model: &VehicleModel, heard: &ThrustTable) -> String {
    let Some(against) = model.against(heard) else { return String::new() };
    let unit = PowerOfTen::of([against.thrust_constant_per_rotor_n_s2]);
    let verdict = match (against.agrees, against.expanded_share) {
        (Some(true), Some(share)) => {
            format!("; this is within the ± of the measured constant, ±{:.2} % (k = 2)", 100.0 * share)
        }
        (Some(false), Some(share)) => {
            format!("; this is outside the ± of the measured constant, ±{:.2} % (k = 2)", 100.0 * share)
        }
        _ => String::new(),
    };
    format!(
        "{} ({}): C_f of one rotor {} {} at {:.0} rpm, {} % from the measured constant{verdict}\n",
        printable(&model.file),
        model.format,
        significant(unit.scale(against.thrust_constant_per_rotor_n_s2), 5),
        unit.unit(CONSTANT_UNIT),
        RotorSpeed::from_rad_s(against.speed_rad_s).rpm(),
        signed(100.0 * (against.over_heard - 1.0), 2),
    )
}
