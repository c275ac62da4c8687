//! Tables of the thrust constant like those of the paper, with correct units and uncertainties.

use crate::number::{DASH, PowerOfTen, rounded, scaled_number, significant, spread, with_uncertainty};
use crate::table_lines::table_text;
use crate::text_table::{Column, TextTable};
use crate::units::superscript;
use hovertone_analysis::Method;
use hovertone_thrust::{LoadThrust, ThrustCoefficients, ThrustTable};
use hovertone_vehicle::{Estimate, RotorSpeed};

/// Unit of every thrust constant: newton per (rad/s)².
pub(crate) const CONSTANT_UNIT: &str = "N s²";

/// What the ± of a single trial lacks.
pub(crate) const WITHOUT_FLIGHTS: &str = ", without the differences from flight to flight";

/// The meaning of ± in a table of loads.
pub const LOADS_FOOTNOTE: &str = "The ± in the row of a load includes only the uncertainties of its mass and its speed (k = 2). The ± of the final C_f includes the whole uncertainty budget, also what all loads share.";

/// The table of one method: a row for each load, like tables 1 and 2 of the paper.
pub fn thrust_table(table: &ThrustTable) -> TextTable {
    let has_mass = table.loads.iter().any(|load| load.mass_kg.is_some());
    let has_bench = table.loads.iter().any(|load| load.mass_kg.is_none());
    let has_verdict = table.loads.iter().any(|load| load.fits.is_some());
    let has_merit = table.loads.iter().any(|load| load.figure_of_merit.is_some());
    let (total_unit, rotor_unit) = units_of(table);
    let mut columns = vec![Column::words("load")];
    columns.extend(has_mass.then(|| Column::numbers("mass", "g")));
    columns.extend(has_bench.then(|| Column::numbers("thrust", "N")));
    columns.extend([
        Column::numbers("speed", "rpm"),
        Column::numbers("STD", "rpm"),
        Column::numbers("ω", "rad/s"),
        Column::numbers("C_f, vehicle", &total_unit.unit(CONSTANT_UNIT)),
        Column::numbers("C_f, one rotor", &rotor_unit.unit(CONSTANT_UNIT)),
    ]);
    columns.extend(has_merit.then(|| Column::numbers("figure of merit", "")));
    columns.extend(has_verdict.then(|| Column::numbers("fits", "")));
    let mut text = TextTable::new(columns);
    for load in &table.loads {
        let mut cells = vec![load.name.clone()];
        cells.extend(has_mass.then(|| load.mass_kg.map_or(DASH.to_owned(), grams)));
        cells.extend(
            has_bench.then(|| if load.mass_kg.is_none() { significant(load.force_n, 4) } else { DASH.to_owned() }),
        );
        if load.speed.is_none() {
            text.push_words(load.name.clone(), "none of its recordings has a speed".to_owned());
            continue;
        }
        cells.extend(speed_cells(load));
        cells.push(constant_cell(load.thrust_constant_total_n_s2, total_unit));
        cells.push(constant_cell(load.thrust_constant_per_rotor_n_s2, rotor_unit));
        let merit = load.figure_of_merit.map_or(DASH.to_owned(), |merit| significant(merit, 3));
        cells.extend(has_merit.then_some(merit));
        cells.extend(has_verdict.then(|| verdict(load.fits)));
        text.push(cells);
    }
    text
}

/// A load on lines of its own, for a viewer that points at it: name, mass, speed, constant of the whole vehicle, method.
pub fn load_in_words(table: &ThrustTable, load: &LoadThrust) -> String {
    let mut lines = vec![load.name.clone()];
    lines.push(match load.mass_kg {
        Some(mass_kg) => format!("mass {} g", grams(mass_kg)),
        None => format!("thrust {} N", significant(load.force_n, 4)),
    });
    if load.speed.is_some() {
        let [rpm, _, rad_s] = speed_cells(load);
        lines.push(format!("speed {rpm} rpm = {rad_s} rad/s"));
    }
    if let Some(constant) = load.thrust_constant_total_n_s2 {
        let scaled = scaled_number(constant.value, constant.std_uncertainty);
        lines.push(format!("C_f ({}) · 10{} N s²", scaled.digits, superscript(scaled.exponent)));
    }
    lines.push(table.title().to_owned());
    lines.join("\n")
}

/// Speed in rpm, its spread, and the speed in rad/s.
pub(crate) fn speed_cells(load: &LoadThrust) -> [String; 3] {
    let std = load.std_uncertainty_rad_s.map(RotorSpeed::from_rad_s);
    let std_of_speed = load.spread_rad_s.map(RotorSpeed::from_rad_s);
    [
        load.speed.map_or(DASH.to_owned(), |speed| rounded(speed.rpm(), std.map(RotorSpeed::rpm))),
        spread(std_of_speed.map(RotorSpeed::rpm)),
        load.speed.map_or(DASH.to_owned(), |speed| rounded(speed.rad_s(), std.map(RotorSpeed::rad_s))),
    ]
}

/// A mass with one decimal of a gram.
pub(crate) fn grams(mass_kg: f64) -> String {
    format!("{:.1}", 1e3 * mass_kg)
}

/// A thrust constant in a power of ten, with its ±.
pub(crate) fn constant_cell(constant_n_s2: Option<Estimate>, unit: PowerOfTen) -> String {
    constant_n_s2.map_or(DASH.to_owned(), |constant| {
        with_uncertainty(unit.scale(constant.value), constant.std_uncertainty.map(|std| unit.scale(std)))
    })
}

fn verdict(fits: Option<bool>) -> String {
    match fits {
        Some(true) => "yes",
        Some(false) => "NO",
        None => DASH,
    }
    .to_owned()
}

fn units_of(table: &ThrustTable) -> (PowerOfTen, PowerOfTen) {
    let values = |constant: &dyn Fn(&LoadThrust) -> Option<Estimate>| -> Vec<f64> {
        table.loads.iter().filter_map(|load| Some(constant(load)?.value)).collect()
    };
    (
        PowerOfTen::of(values(&|load| load.thrust_constant_total_n_s2)),
        PowerOfTen::of(values(&|load| load.thrust_constant_per_rotor_n_s2)),
    )
}

/// The constant of the whole vehicle and of one rotor by every method, with a mark on the reported one, and the plain mean over the loads
/// as in the paper, without a ± as there.
pub fn methods_table(tables: &[ThrustTable], reported: Method) -> TextTable {
    let values = |constant: &dyn Fn(&ThrustTable) -> Option<Estimate>| -> PowerOfTen {
        PowerOfTen::of(tables.iter().filter_map(|table| Some(constant(table)?.value)))
    };
    let total_unit = values(&|table| table.thrust_constant_total_n_s2);
    let rotor_unit = values(&|table| table.thrust_constant_per_rotor_n_s2);
    let mut text = TextTable::new(vec![
        Column::words("C_f = F/ω² (± is k = 2)"),
        Column::numbers("whole vehicle, fit", &total_unit.unit(CONSTANT_UNIT)),
        Column::numbers("one rotor, fit", &rotor_unit.unit(CONSTANT_UNIT)),
        Column::numbers("plain mean of the loads", &total_unit.unit(CONSTANT_UNIT)),
    ]);
    for table in tables {
        let mark = if table.method == reported { " (reported)" } else { "" };
        text.push(vec![
            format!("{}{mark}", table.title()),
            constant_cell(table.thrust_constant_total_n_s2, total_unit),
            constant_cell(table.thrust_constant_per_rotor_n_s2, rotor_unit),
            table.plain_mean_total_n_s2.map_or(DASH.to_owned(), |mean| significant(total_unit.scale(mean.value), 5)),
        ]);
    }
    text
}

/// The result: the table of the methods, and C_T in both conventions where air and diameter are known.
pub fn thrust_summary(tables: &[ThrustTable], reported: Method, width: Option<usize>) -> String {
    let coefficients = tables.iter().find(|table| table.method == reported).and_then(|table| table.coefficients);
    let coefficients = coefficients.map_or(String::new(), |both| format!("\n{}", coefficients_text(both)));
    table_text(&methods_table(tables, reported), width) + methods_note(tables, reported) + &coefficients
}

/// The thrust coefficient in both conventions.
pub(crate) fn coefficients_text(both: ThrustCoefficients) -> String {
    format!(
        "thrust coefficient C_T of one rotor: {} with the formula for propellers, C_T = F/(ρ n² D⁴), or {} with the formula for helicopters, C_T = F/(ρ A (ωR)²). F is the thrust of the rotor, n its turns per second, ω = 2πn, D its diameter, R its radius, A its disk area, and ρ = {} kg/m³ the density of the air\n",
        significant(both.propeller, 4),
        significant(both.rotorcraft, 4),
        significant(both.density_kg_m3, 4),
    )
}

/// Why methods beside the reported one have a larger ±; empty where they have not.
fn methods_note(tables: &[ThrustTable], reported: Method) -> &'static str {
    let hears_rotors = |table: &ThrustTable| table.rotors_heard.separated + table.rotors_heard.group > 0;
    let is_reported = |table: &ThrustTable| table.method == reported && table.rotor_count > 1 && hears_rotors(table);
    let follows_one = |table: &ThrustTable| table.method != reported && !hears_rotors(table);
    match tables.iter().any(is_reported) && tables.iter().any(follows_one) {
        true => "the other methods follow one tone, which may come from one rotor alone: their ± includes this\n",
        false => "",
    }
}
