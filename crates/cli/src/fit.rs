//! `hovertone fit`: the thrust constant from tables, and the plan of a campaign.

use crate::args::{AirArguments, FitArguments, PlaceArguments};
use crate::failure::{Ending, Failure};
use crate::files::sha256_of_bytes;
use crate::inputs::{is_no_text, read_bytes};
use crate::place::{air_density_kg_m3, gravity_of, refuse_height_alone};
use crate::terminal::Terminal;

use hovertone::thrust::regression::FitError;
use hovertone::thrust::{
    ForcePoint, Gravity, NoScatter, PlanError, PlanWish, PointNoise, ThrustCoefficients, ThrustSettings, ThrustWarning,
    TorqueReading, figure_of_merit, flight_plan, is_plausible_merit, least_diameter_m, least_tip_mach, row_drifts,
    square_law_fit, torque_constant_n_m_s2, warnings_of_points,
};
use hovertone_exchange::{CsvError, StandForce, StandGroup, StandRow, StandTable, TableError, table_from_csv};
use hovertone_report::{FittedTable, Notice, fitted_table_text, fitted_tables_json, flight_plan_text, significant};
use hovertone_vehicle::{
    AIR_KG_M3, Estimate, KnownRotor, QuantityError, RotorSpeed, THRUST_COEFFICIENT, TIP_MACH_MAX, check_tips,
};
use std::path::Path;

/// Most multirotors safely carry a quarter of their mass.
const ADDED_MASS_SHARE: f64 = 0.25;
/// The air changes C_T by less: thin air on the highest mountains has a third of the density at sea level.
const FAR_OFF_FACTOR: f64 = 3.0;
/// Propellers of the largest multirotors are smaller.
const DIAMETER_M_MAX: f64 = 2.0;
/// Number of rotors of most multirotors.
const ROTORS_OF_MOST: u32 = 4;

/// The meaning of the arguments.
struct Plan {
    gravity: Gravity,
    rotor_count: u32,
    /// Whether the user says so; else it is one.
    is_count_given: bool,
    diameter_m: Option<f64>,
    density_kg_m3: Option<f64>,
}

/// Fits all tables, or plans a campaign.
pub(crate) fn run(arguments: &FitArguments, terminal: &mut Terminal) -> Result<Ending, Failure> {
    let gravity = gravity_of(&arguments.place)?;
    match (arguments.plan.mass_kg, arguments.plan.plan) {
        (Some(mass_kg), true) => return plan_campaign(arguments, mass_kg, gravity, terminal),
        (Some(mass_kg), false) => {
            let what = format!("mass_kg = {mass_kg} is only for --plan: a table has its own forces");
            return Err(Failure::usage(what, "leave it out, or give --plan without a table"));
        }
        (None, _) => {}
    }
    let plan = Plan {
        gravity,
        rotor_count: arguments.rotors.unwrap_or(1),
        is_count_given: arguments.rotors.is_some(),
        diameter_m: arguments.air.diameter_m,
        density_kg_m3: air_density_kg_m3(&arguments.air, &arguments.place)?,
    };
    if let Some(notice) = half_given(&arguments.air, &arguments.place) {
        terminal.tip(&notice);
    }
    if arguments.json {
        let mut all = Vec::new();
        for path in &arguments.tables {
            all.extend(fitted_tables(path, &plan)?);
        }
        terminal.data(&fitted_tables_json(&all).map_err(Failure::internal)?)?;
        return Ok(Ending::Done);
    }
    let mut is_first = true;
    for path in &arguments.tables {
        let tables = fitted_tables(path, &plan)?;
        let is_alone = tables.len() == 1 && arguments.tables.len() == 1;
        for table in tables {
            if !std::mem::take(&mut is_first) {
                terminal.data("\n")?;
            }
            terminal.flush()?;
            terminal.warning_count_of(table.notices.len(), (!is_alone).then(|| table.name()).as_deref());
            for notice in &table.notices {
                terminal.warning(notice, "");
            }
            terminal.text(&fitted_table_text(&table, terminal.fold_width()))?;
        }
    }
    Ok(Ending::Done)
}

/// The notice where a diameter is given without the air, or the air without a diameter.
fn half_given(air: &AirArguments, place: &PlaceArguments) -> Option<Notice> {
    let of_air = air.temperature_c.or(air.pressure_hpa).or(air.humidity_percent);
    match (air.diameter_m, of_air.or(place.height_m)) {
        (Some(_), None) => Some(Notice::new(
            "the thrust coefficient C_T is not computed: it needs the density of the air too",
            "also give --temperature-c and --pressure-hpa, or --height-m",
        )),
        (None, Some(_)) if of_air.is_some() => Some(Notice::new(
            "the thrust coefficient C_T is not computed: it needs the diameter of the propeller too",
            "also give --diameter-m",
        )),
        _ => None,
    }
}

fn fitted_tables(path: &Path, plan: &Plan) -> Result<Vec<FittedTable>, Failure> {
    let bytes = read_bytes(path, "the table")?;
    // headers in Latin-1 are welcome, a recording is not
    if bytes.contains(&0) {
        return Err(is_no_text("the table", path, &bytes));
    }
    let text = String::from_utf8_lossy(&bytes);
    let table = table_from_csv(&text).map_err(|error| table_failure(&error, path))?;
    let sha256 = sha256_of_bytes(&bytes);
    table.groups.iter().map(|group| fitted_table(group, &table, path, &sha256, plan)).collect()
}

fn table_failure(error: &TableError, path: &Path) -> Failure {
    if let TableError::Csv(error @ (CsvError::NoTable(_) | CsvError::NotCsv(_))) = error {
        return Failure::failed(error.to_string(), error.hint(), path);
    }
    let rename: String;
    let hint = match error {
        TableError::OtherUnit { header: Some(header), .. } => {
            rename = format!(
                "their unit is probably another one: rename the header to {header}, or to the unit that they have"
            );
            &rename
        }
        TableError::OtherUnit { .. } => "their unit is probably another one: name it in the header, as in speed_rad_s",
        TableError::NoColumn { .. } => {
            "rename its header, as in speed_rpm, thrust_g or mass_g; `hovertone fit --help` lists all words that hovertone knows"
        }
        TableError::Csv(error) => error.hint(),
        TableError::HeaderAlone => "give a row for each measurement, below the header",
        TableError::NoRow => "check that the speed is not 0 in all rows: the tachometer may not have been connected",
        _ => "correct the cell, or remove the row",
    };
    Failure::Usage { what: error.to_string(), hint: hint.to_owned(), path: Some(path.to_owned()) }
}

fn fitted_table(
    group: &StandGroup,
    table: &StandTable,
    path: &Path,
    sha256: &str,
    plan: &Plan,
) -> Result<FittedTable, Failure> {
    check_tips_of(group, path, plan)?;
    let points: Vec<ForcePoint> = group.rows.iter().map(|row| point_of(row, plan)).collect();
    let is_stated = group.rows.iter().any(|row| row.force_std.is_some() || row.speed_std_rad_s.is_some());
    let noise = if is_stated { PointNoise::Stated } else { PointNoise::FromResiduals };
    let fit = square_law_fit(&points, noise).map_err(|error| unfitted(&error, &points, path))?;
    if let Some(reason) = fit.why_no_uncertainty(&points) {
        return Err(without_scatter(reason, group, table, path));
    }
    let is_mass = |row: &StandRow| matches!(row.force, StandForce::Mass { .. });
    let is_weighed = group.rows.iter().all(is_mass);
    let total = with_gravity(fit.thrust_constant_n_s2, plan.gravity, is_weighed);
    let per_rotor = total.scaled(1.0 / f64::from(plan.rotor_count));
    let air = plan.diameter_m.zip(plan.density_kg_m3);
    // torques of several rotors add up with their directions, which are not in the table
    let has_torque = plan.rotor_count == 1;
    let torque = |row: &StandRow| {
        Some(TorqueReading { speed: RotorSpeed::from_rad_s(row.speed_rad_s), torque_n_m: row.torque_n_m? })
    };
    let torques: Vec<TorqueReading> = group.rows.iter().filter_map(torque).collect();
    let coefficients =
        air.map(|(diameter_m, density)| ThrustCoefficients::of_rotor(per_rotor.value, diameter_m, density));
    let mut warnings = warnings_of_points(&points, &fit, is_weighed.then_some(plan.gravity.m_s2));
    let voltages: Vec<Option<f64>> = group.rows.iter().map(|row| row.voltage_v).collect();
    warnings.extend(row_drifts(&points, &voltages).into_iter().map(ThrustWarning::ConstantDrifts));
    let figure_of_merit = merit_of(group, &points, plan);
    warnings.extend(figure_of_merit.filter(|merit| !is_plausible_merit(*merit)).map(|figure_of_merit| {
        ThrustWarning::ImplausibleFigureOfMerit { name: "at the largest thrust".to_owned(), figure_of_merit }
    }));
    warnings.extend(
        coefficients
            .filter(|both| !both.is_plausible)
            .map(|both| ThrustWarning::ImplausibleThrustCoefficient { propeller: both.propeller }),
    );
    let of_any_air = || plan.diameter_m.and_then(|diameter_m| far_off_notice(per_rotor, diameter_m));
    let too_strong = of_any_air()
        .or_else(|| too_large_notice(per_rotor))
        .or_else(|| too_strong_notice(group, per_rotor, plan.is_count_given))
        .filter(|_| coefficients.is_none());
    let has_std = |point: &&ForcePoint| point.force_std_n > 0.0 || point.speed_square_std_rad2_s2 > 0.0;
    let stated = points.iter().filter(has_std).count();
    if is_stated && stated < points.len() {
        warnings.push(ThrustWarning::UncertaintiesIncomplete { stated, of: points.len() });
    }
    let of_table = table.notes.iter().map(|note| Notice::new(note, hint_of_note(note)));
    let notes = rotors_notice(table, is_weighed, plan).into_iter().chain(of_table);
    Ok(FittedTable {
        file: path.display().to_string(),
        sha256: sha256.to_owned(),
        group: group.name.clone(),
        speed_column: table.speed_column.clone(),
        force_column: table.force_column.clone(),
        row_count: points.len(),
        thrust_constant_total_n_s2: total,
        thrust_constant_per_rotor_n_s2: per_rotor,
        rotor_count: plan.rotor_count,
        thrust_coefficients: coefficients,
        propeller_diameter_m: plan.diameter_m,
        figure_of_merit,
        torque_constant_per_rotor_n_m_s2: torque_constant_n_m_s2(&torques).filter(|_| has_torque),
        notices: notes.chain(too_strong).chain(warnings.iter().map(Notice::from)).collect(),
        fit,
    })
}

/// What to do about a note on a table; empty where it only says what was done with rows.
fn hint_of_note(note: &str) -> &'static str {
    match note {
        note if note.contains("its name has no unit") => "if it is meant, put its unit into its name, as in thrust_g",
        note if note.starts_with("column ") => "if you mean this column, remove the other",
        _ => "",
    }
}

fn unfitted(error: &FitError, points: &[ForcePoint], path: &Path) -> Failure {
    let what = match error {
        FitError::UnusablePoint { number } => {
            format!("{} has a speed or a force that is too large or too small to be fitted", points[number - 1].name)
        }
        _ => error.to_string(),
    };
    Failure::failed(what, "correct or remove that row of the table", path)
}

/// A notice where several rotors seem to make the forces, which count as the forces of one.
fn rotors_notice(table: &StandTable, is_weighed: bool, plan: &Plan) -> Option<Notice> {
    let several = table.rotor_count.filter(|count| *count > 1);
    let text = match several {
        _ if plan.is_count_given => return None,
        Some(count) => {
            format!("the table names {count} rotors, but its forces are used as the forces of one rotor")
        }
        None if is_weighed => "the masses are used as if one rotor carried them".to_owned(),
        None => return None,
    };
    let count = several.map_or_else(|| "N".to_owned(), |count| count.to_string());
    Some(Notice::new(
        text,
        format!("give --rotors {count} for the constant of one rotor; --rotors 1 if one rotor is right"),
    ))
}

/// Says that C_T is far outside the range of propellers in the air of any place.
fn far_off_notice(per_rotor: Estimate, diameter_m: f64) -> Option<Notice> {
    let coefficient = ThrustCoefficients::of_rotor(per_rotor.value, diameter_m, AIR_KG_M3).propeller;
    let (least, most) = (*THRUST_COEFFICIENT.start(), *THRUST_COEFFICIENT.end());
    let is_far = coefficient < least / FAR_OFF_FACTOR || coefficient > most * FAR_OFF_FACTOR;
    let text = format!(
        "with this diameter, the thrust coefficient C_T would be {} in air of {AIR_KG_M3} kg/m³, but propellers have {least} to {most}",
        significant(coefficient, 2)
    );
    let hint = "check the units of the forces and of the speeds (rpm, rev/s or rad/s), the diameter, and --rotors";
    is_far.then(|| Notice::new(text, hint))
}

/// Says that a propeller with such a constant would be larger than any multirotor's.
fn too_large_notice(per_rotor: Estimate) -> Option<Notice> {
    let diameter_m = least_diameter_m(per_rotor.value);
    let text = format!(
        "a propeller with this thrust constant would have a diameter of {} m or more",
        significant(diameter_m, 2)
    );
    let hint = "check whether the columns of speed and force are exchanged, and check their units";
    (diameter_m > DIAMETER_M_MAX).then(|| Notice::new(text, hint))
}

/// Says that no propeller has such a thrust.
fn too_strong_notice(group: &StandGroup, per_rotor: Estimate, is_count_given: bool) -> Option<Notice> {
    let fastest_rad_s = group.rows.iter().map(|row| row.speed_rad_s).fold(0.0, f64::max);
    let tip_mach = least_tip_mach(per_rotor.value, RotorSpeed::from_rad_s(fastest_rad_s));
    let text = format!(
        "no propeller has this thrust at this speed: its tips would move at Mach {tip_mach:.2} (times the speed of sound) or faster"
    );
    let rotors = if is_count_given { "--rotors" } else { "give the number of rotors with --rotors" };
    let hint = format!("check the units of the forces and of the speeds, and {rotors}");
    (tip_mach > TIP_MACH_MAX).then(|| Notice::new(text, hint))
}

/// Refuses the diameter of the arguments where the blade tips of a row would be faster than any multirotor's.
fn check_tips_of(group: &StandGroup, path: &Path, plan: &Plan) -> Result<(), Failure> {
    for row in &group.rows {
        let tips = plan.diameter_m.map(|diameter_m| check_tips(diameter_m, RotorSpeed::from_rad_s(row.speed_rad_s)));
        tips.transpose().map_err(|tips| Failure::Usage {
            what: format!("line {}: {tips}", row.line_number),
            hint: tips.hint(),
            path: Some(path.to_owned()),
        })?;
    }
    Ok(())
}

/// The failure of rows whose scatter tells no uncertainty, with what was done to them.
fn without_scatter(reason: NoScatter, group: &StandGroup, table: &StandTable, path: &Path) -> Failure {
    let (count, rows) = match reason {
        NoScatter::TooFewPoints { count } => {
            let of = if group.name.is_empty() { "table" } else { "group" };
            let together = match table.groups.len() {
                ..=1 => String::new(),
                groups => format!(
                    "the columns with words split the table into {groups} groups, each with a fit of its own: remove these columns to fit all rows together; else "
                ),
            };
            (format!(", and the {of} has {count}"), together + "measure more rows")
        }
        _ => (String::new(), "give the rows as they were measured".to_owned()),
    };
    let group = if group.name.is_empty() { String::new() } else { format!("group \"{}\": ", group.name) };
    let notes: String = table.notes.iter().map(|note| format!("; {note}")).collect();
    Failure::Usage {
        what: format!("{group}{reason}{count}{notes}"),
        hint: format!(
            "{rows}, or state the standard uncertainty of each force in a column of its own (thrust_std_n, mass_std_g)"
        ),
        path: Some(path.to_owned()),
    }
}

/// The uncertainty of gravity is common to all masses and does not average out.
fn with_gravity(constant: Estimate, gravity: Gravity, is_weighed: bool) -> Estimate {
    let shared = if is_weighed { constant.value * gravity.std_m_s2 / gravity.m_s2 } else { 0.0 };
    Estimate { std_uncertainty: constant.std_uncertainty.map(|std| std.hypot(shared)), ..constant }
}

fn point_of(row: &StandRow, plan: &Plan) -> ForcePoint {
    let (name, speed) = (format!("line {}", row.line_number), RotorSpeed::from_rad_s(row.speed_rad_s));
    let (speed_std, force_std) = (row.speed_std_rad_s.unwrap_or(0.0), row.force_std.unwrap_or(0.0));
    match row.force {
        StandForce::Thrust { thrust_n } => ForcePoint::from_speed(name, speed, speed_std, thrust_n, force_std),
        StandForce::Mass { mass_kg } => {
            ForcePoint::from_mass(name, speed, speed_std, mass_kg, force_std, plan.gravity.m_s2)
        }
    }
}

/// Figure of merit of one rotor at the largest thrust, where an offset of the stand matters least.
fn merit_of(group: &StandGroup, points: &[ForcePoint], plan: &Plan) -> Option<f64> {
    let rotors = f64::from(plan.rotor_count);
    let rows = group.rows.iter().zip(points).filter_map(|(row, point)| Some((point.force_n, row.power_w?)));
    let (thrust_n, power_w) = rows.max_by(|a, b| a.0.total_cmp(&b.0))?;
    Some(figure_of_merit(thrust_n / rotors, power_w / rotors, plan.diameter_m?, plan.density_kg_m3?))
}

fn plan_campaign(
    arguments: &FitArguments,
    mass_kg: f64,
    gravity: Gravity,
    terminal: &mut Terminal,
) -> Result<Ending, Failure> {
    refuse_height_alone(&arguments.place)?;
    let asked = &arguments.plan;
    let rotor_count = arguments.rotors.unwrap_or(ROTORS_OF_MOST);
    let flown = KnownRotor {
        diameter_m: arguments.air.diameter_m,
        mass_kg: Some(mass_kg),
        rotor_count: Some(rotor_count),
        ..KnownRotor::default()
    };
    let wish = PlanWish {
        wanted_share: asked.wanted_share,
        vehicle_mass_kg: mass_kg,
        added_mass_kg_max: asked.added_mass_kg.unwrap_or(ADDED_MASS_SHARE * mass_kg),
        mass_std_kg: asked.mass_std_kg,
        gravity_m_s2: gravity.m_s2,
        gravity_std_m_s2: gravity.std_m_s2,
        speed_spread_share: asked.speed_spread_share,
        correlation_time_s: asked.correlation_s,
        settings: ThrustSettings {
            follows_loudest: !asked.rotors_separated,
            propeller_diameter_m: arguments.air.diameter_m,
            ..ThrustSettings::for_rotors(rotor_count)
        },
    };
    let plan = flight_plan(&wish).map_err(|error| {
        let hint = match error {
            PlanError::OutOfReach { .. } => {
                "give a larger --wanted-share, or make an uncertainty smaller (--latitude-deg, --mass-std-kg, --rotors-separated)"
            }
            PlanError::Quantity(QuantityError { name: "wanted_share", .. }) => "for 2 % give --wanted-share 0.02",
            _ => "see `hovertone fit --help`",
        };
        Failure::usage(error.to_string(), hint)
    })?;
    flown.check_hover()?;
    if arguments.json {
        terminal.data(&(serde_json::to_string_pretty(&plan).map_err(Failure::internal)? + "\n"))?;
    } else {
        terminal.text(&flight_plan_text(&plan, &wish))?;
    }
    Ok(Ending::Done)
}
