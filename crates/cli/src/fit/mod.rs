//! `hovertone fit`: the thrust constant from tables, and the plan of a campaign.

mod failures;
mod notices;
mod planned;

use crate::args::{AirArguments, FitArguments, PlaceArguments};
use crate::failure::{Ending, Failure};
use crate::files::sha256_of_bytes;
use crate::inputs::{is_no_text, name_of, read_bytes};
use crate::place::{air_density_kg_m3, gravity_of};
use crate::terminal::Terminal;
use failures::{refuse_absurd_force, refuse_absurd_std, table_failure, unfitted, without_scatter};
use hovertone::thrust::{
    ForcePoint, Gravity, PointNoise, SquareLawFit, ThrustCoefficients, ThrustWarning, TorqueReading, figure_of_merit,
    is_plausible_merit, row_drifts, square_law_fit, torque_constant_n_m_s2, warnings_of_points,
};
use hovertone_exchange::{StandForce, StandGroup, StandRow, StandTable, table_from_csv};
use hovertone_report::{FittedTable, Notice, fitted_table_text, fitted_tables_json};
use hovertone_vehicle::{Estimate, RotorSpeed, check_tips, number_in_words};
use notices::{FittedRows, WorstRow, far_off_notice, notice_of, rotors_notice, too_large_notice, too_strong_notice};
use planned::plan_campaign;
use std::path::Path;

/// Chance above which rows scatter less than their stated uncertainties make plausible.
const QUIET_CHANCE: f64 = 0.99;

/// The meaning of the arguments.
struct Plan {
    gravity: Gravity,
    /// The number of rotors, where the user gives it.
    given_rotors: Option<u32>,
    diameter_m: Option<f64>,
    density_kg_m3: Option<f64>,
}

impl Plan {
    /// The number of rotors that make the forces: as given, or as the table names it, or else one.
    fn rotors_of(&self, table: &StandTable) -> u32 {
        self.given_rotors.or(table.rotor_count).unwrap_or(1)
    }
}

/// Fits all tables, or plans a campaign.
pub(crate) fn run(arguments: &FitArguments, terminal: &mut Terminal) -> Result<Ending, Failure> {
    let gravity = gravity_of(&arguments.place)?;
    match (arguments.plan.mass_kg, arguments.plan.plan) {
        (Some(mass_kg), true) => return plan_campaign(arguments, mass_kg, gravity, terminal),
        (Some(mass_kg), false) => {
            let what = format!("mass_kg = {} is only for --plan: a table has its own forces", number_in_words(mass_kg));
            return Err(Failure::usage(what, "leave --mass-kg out, or give --plan without a table"));
        }
        (None, _) => {}
    }
    let plan = Plan {
        gravity,
        given_rotors: arguments.rotors,
        diameter_m: arguments.air.diameter_m,
        density_kg_m3: air_density_kg_m3(&arguments.air, &arguments.place)?,
    };
    if let Some(notice) = half_given(&arguments.air, &arguments.place) {
        terminal.tip(&notice);
    }
    let (mut is_first, mut ending) = (true, Ending::Done);
    let mut of_json = Vec::new();
    for path in &arguments.tables {
        let tables = match fitted_tables(path, &plan) {
            Err(failure) if arguments.tables.len() > 1 => {
                terminal.flush()?;
                terminal.failure(&failure);
                ending = ending.max(Ending::FilesFailed);
                continue;
            }
            tables => tables?,
        };
        let is_alone = tables.len() == 1 && arguments.tables.len() == 1;
        ending = ending.max(ending_of(&tables));
        if arguments.json {
            of_json.extend(tables);
            continue;
        }
        for table in tables {
            if !std::mem::take(&mut is_first) {
                terminal.data("\n")?;
            }
            terminal.flush()?;
            terminal.warning_count_of(table.notices.len(), (!is_alone).then(|| group_of_file(&table)).as_deref());
            let hints = table.notices.iter().skip(1).map(|next| next.hint.as_str()).chain([""]);
            for (notice, next_hint) in table.notices.iter().zip(hints) {
                // one advice for several stands below the last of them
                let hint = if notice.hint == next_hint { "" } else { &notice.hint };
                terminal.warning(&Notice { hint: hint.to_owned(), ..notice.clone() }, "");
            }
            terminal.text(&fitted_table_text(&table, terminal.fold_width()))?;
        }
    }
    if !of_json.is_empty() {
        terminal.data(&fitted_tables_json(&of_json).map_err(Failure::internal)?)?;
    }
    Ok(ending)
}

/// A constant that must not be used, or of rows that contradict each other, is no complete answer.
fn ending_of(tables: &[FittedTable]) -> Ending {
    if tables.iter().any(|table| table.is_incomplete) { Ending::Incomplete } else { Ending::Done }
}

/// The notice where a diameter is given without the air, or the air without a diameter.
fn half_given(air: &AirArguments, place: &PlaceArguments) -> Option<Notice> {
    let of_air = air.temperature_c.or(air.pressure_hpa).or(air.humidity_percent);
    match (air.diameter_m, of_air.or(place.height_m)) {
        (Some(_), None) => Some(Notice::new(
            "the thrust coefficient C_T is not computed: it needs the density of the air too",
            "also give --temperature-c and --pressure-hpa, or only --height-m, the height above sea level",
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
    if bytes.contains(&0) {
        return Err(is_no_text("the table", path, &bytes));
    }
    let text = text_of(&bytes);
    let table = table_from_csv(&text).map_err(|error| table_failure(&error, path))?;
    let sha256 = sha256_of_bytes(&bytes);
    table.groups.iter().map(|group| fitted_table(group, &table, path, &sha256, plan)).collect()
}

/// The text of a table in UTF-8; or else in Latin-1, in which office programs write the signs ± and µ.
fn text_of(bytes: &[u8]) -> String {
    std::str::from_utf8(bytes).map_or_else(|_| bytes.iter().copied().map(char::from).collect(), str::to_owned)
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
    refuse_absurd_force(&points, path)?;
    refuse_absurd_std(&points, table, path)?;
    let noise = if is_stated(group) { PointNoise::Stated } else { PointNoise::FromResiduals };
    let fit = square_law_fit(&points, noise).map_err(|error| unfitted(&error, &points, path))?;
    if let Some(reason) = fit.why_no_uncertainty(&points) {
        return Err(without_scatter(reason, group, table, path));
    }
    let is_mass = |row: &StandRow| matches!(row.force, StandForce::Mass { .. });
    let is_weighed = group.rows.iter().all(is_mass);
    let total = with_gravity(fit.thrust_constant_n_s2, plan.gravity, is_weighed);
    let rotor_count = plan.rotors_of(table);
    let per_rotor = total.scaled(1.0 / f64::from(rotor_count));
    let air = plan.diameter_m.zip(plan.density_kg_m3);
    // torques of several rotors add up with their directions, which are not in the table
    let has_torque = rotor_count == 1;
    let torque = |row: &StandRow| {
        Some(TorqueReading { speed: RotorSpeed::from_rad_s(row.speed_rad_s), torque_n_m: row.torque_n_m? })
    };
    let torques: Vec<TorqueReading> = group.rows.iter().filter_map(torque).collect();
    let coefficients =
        air.map(|(diameter_m, density)| ThrustCoefficients::of_rotor(per_rotor.value, diameter_m, density));
    let mut warnings = warnings_of_rows(group, &points, &fit, is_weighed.then_some(plan.gravity.m_s2));
    let figure_of_merit = merit_of(group, &points, rotor_count, plan);
    warnings.extend(implausible(figure_of_merit, coefficients));
    let rows = FittedRows {
        speed_column: &table.speed_column,
        stated: if points.iter().all(has_std) { table.std_columns.as_slice() } else { &[] },
        has_speed_std: points.iter().any(|point| point.speed_square_std_rad2_s2 > 0.0),
        is_quiet: fit.agreement.is_some_and(|agreement| agreement.p_value > QUIET_CHANCE),
        worst: WorstRow::of(&points, &fit),
    };
    let of_any_air = || plan.diameter_m.and_then(|diameter_m| far_off_notice(per_rotor, diameter_m, &rows));
    let too_strong = of_any_air()
        .or_else(|| too_large_notice(per_rotor))
        .or_else(|| too_strong_notice(group, per_rotor, plan.given_rotors.is_some()))
        .filter(|_| coefficients.is_none());
    // forces that no propeller has are in a wrong unit, and their stated uncertainties too
    let is_too_strong = too_strong.is_some();
    let is_explained = |warning: &&ThrustWarning| {
        is_too_strong && matches!(warning, ThrustWarning::LoadsDisagree { are_rows: true, .. })
    };
    let of_table = table.notes.iter().filter(|note| note.is_of(&group.name));
    let of_table = of_table.map(|note| Notice::new(note.to_string(), note.hint()));
    let of_fit = warnings.iter().filter(|warning| !is_explained(warning)).map(|warning| notice_of(warning, &rows));
    let notices =
        rotors_notice(table, is_weighed, plan).into_iter().chain(of_table).chain(too_strong).chain(of_fit).collect();
    Ok(FittedTable {
        file: name_of(path),
        sha256: sha256.to_owned(),
        group: group.name.clone(),
        speed_column: table.speed_column.clone(),
        force_column: table.force_column.clone(),
        row_count: points.len(),
        thrust_constant_total_n_s2: total,
        thrust_constant_per_rotor_n_s2: per_rotor,
        rotor_count,
        thrust_coefficients: coefficients,
        propeller_diameter_m: plan.diameter_m,
        figure_of_merit,
        torque_constant_per_rotor_n_m_s2: torque_constant_n_m_s2(&torques).filter(|_| has_torque),
        forbids_use: is_too_strong || warnings.iter().any(ThrustWarning::forbids_use),
        is_incomplete: is_too_strong || warnings.iter().any(ThrustWarning::makes_incomplete),
        notices,
        fit,
    })
}

/// The warnings about numbers that no propeller has.
fn implausible(
    figure_of_merit: Option<f64>,
    coefficients: Option<ThrustCoefficients>,
) -> impl Iterator<Item = ThrustWarning> {
    let merit = figure_of_merit.filter(|merit| !is_plausible_merit(*merit)).map(|figure_of_merit| {
        ThrustWarning::ImplausibleFigureOfMerit { name: "at the largest thrust".to_owned(), figure_of_merit }
    });
    let coefficient = coefficients
        .filter(|both| !both.is_plausible)
        .map(|both| ThrustWarning::ImplausibleThrustCoefficient { propeller: both.propeller });
    merit.into_iter().chain(coefficient)
}

fn is_stated(group: &StandGroup) -> bool {
    group.rows.iter().any(|row| row.force_std.is_some() || row.speed_std_rad_s.is_some())
}

fn has_std(point: &ForcePoint) -> bool {
    point.force_std_n > 0.0 || point.speed_square_std_rad2_s2 > 0.0
}

/// The warnings about the rows and their fit. `gravity_m_s2` is given where the rows are masses that hover.
fn warnings_of_rows(
    group: &StandGroup,
    points: &[ForcePoint],
    fit: &SquareLawFit,
    gravity_m_s2: Option<f64>,
) -> Vec<ThrustWarning> {
    let mut warnings = warnings_of_points(points, fit, gravity_m_s2);
    let voltages: Vec<Option<f64>> = group.rows.iter().map(|row| row.voltage_v).collect();
    warnings.extend(row_drifts(points, &voltages).into_iter().map(ThrustWarning::ConstantDrifts));
    let (stated, of) = (points.iter().filter(|point| has_std(point)).count(), points.len());
    if is_stated(group) && stated < of {
        warnings.push(ThrustWarning::UncertaintiesIncomplete { stated, of });
    }
    warnings
}

/// Refuses the diameter of the arguments where the blade tips of a row would be faster than any multirotor's.
fn check_tips_of(group: &StandGroup, path: &Path, plan: &Plan) -> Result<(), Failure> {
    for row in &group.rows {
        let tips = plan.diameter_m.map(|diameter_m| check_tips(diameter_m, RotorSpeed::from_rad_s(row.speed_rad_s)));
        tips.transpose().map_err(|tips| Failure::Usage {
            what: format!("{tips} (this speed is in line {})", row.line_number),
            hint:
                "check the diameter (from tip to tip, in metres: 10 inches are 0.254), and the speed in this line and \
                   its unit; if all are right, leave --diameter-m out: C_f does not need it"
                    .to_owned(),
            path: Some(path.to_owned()),
        })?;
    }
    Ok(())
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
fn merit_of(group: &StandGroup, points: &[ForcePoint], rotor_count: u32, plan: &Plan) -> Option<f64> {
    let rotors = f64::from(rotor_count);
    let rows = group.rows.iter().zip(points).filter_map(|(row, point)| Some((point.force_n, row.power_w?)));
    let (thrust_n, power_w) = rows.max_by(|a, b| a.0.total_cmp(&b.0))?;
    Some(figure_of_merit(thrust_n / rotors, power_w / rotors, plan.diameter_m?, plan.density_kg_m3?))
}

/// "Tarot 4114 (in stand.csv)", or the file alone.
fn group_of_file(table: &FittedTable) -> String {
    if table.group.is_empty() { table.file.clone() } else { format!("{} (in {})", table.group, table.file) }
}
