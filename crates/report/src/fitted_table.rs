//! The fit of the table of a thrust stand.

use crate::adequacy::laws_text;
use crate::notice::Notice;
use crate::number::{PowerOfTen, significant};
use crate::printable::printable;
use crate::quote::{counted, quoted};
use crate::thrust::coefficients_text;
use crate::version::VERSION;
use hovertone_thrust::{SquareLawFit, ThrustCoefficients};
use hovertone_vehicle::Estimate;
use serde::Serialize;

/// The fit of the rows of one rotor.
#[derive(Clone, Debug, Serialize)]
pub struct FittedTable {
    /// Name of the file.
    pub file: String,
    /// SHA-256 of its bytes, in hexadecimal.
    pub sha256: String,
    /// Content of its columns of words.
    pub group: String,
    /// Header of the column with the speed.
    pub speed_column: String,
    /// Header of the column with the force.
    pub force_column: String,
    /// Number of rows.
    pub row_count: usize,
    /// Constant of all rotors of a row together.
    pub thrust_constant_total_n_s2: Estimate,
    /// Constant of one rotor.
    pub thrust_constant_per_rotor_n_s2: Estimate,
    /// Number of rotors that share the force of a row.
    pub rotor_count: u32,
    /// The fit of the total force of a row.
    pub fit: SquareLawFit,
    /// Thrust coefficients, where air and diameter are known.
    pub thrust_coefficients: Option<ThrustCoefficients>,
    /// Diameter of the propellers, where known.
    pub propeller_diameter_m: Option<f64>,
    /// Figure of merit at the largest force, where power, air and diameter are known.
    pub figure_of_merit: Option<f64>,
    /// Torque of one rotor over its squared speed, where the table has torques.
    pub torque_constant_per_rotor_n_m_s2: Option<f64>,
    /// Whether a warning says not to use the constant.
    pub forbids_use: bool,
    /// Whether a warning says so, or that the rows contradict each other.
    #[serde(skip)]
    pub is_incomplete: bool,
    /// Notices about rows that were left out or turned round, and warnings about the fit.
    pub notices: Vec<Notice>,
}

impl FittedTable {
    /// "stand.csv: motor, propeller": the file, and the group where it has several.
    pub fn name(&self) -> String {
        if self.group.is_empty() { self.file.clone() } else { format!("{}: {}", self.file, self.group) }
    }
}

#[derive(Serialize)]
struct Versioned<'a> {
    #[serde(flatten)]
    table: &'a FittedTable,
    version: &'static str,
}

#[derive(Serialize)]
struct Groups<'a> {
    groups: Vec<Versioned<'a>>,
    version: &'static str,
}

/// One JSON document, ending with a line feed: the fit of the only group, or all fits under `groups`.
///
/// # Errors
/// None is known, since all types can be serialised.
pub fn fitted_tables_json(tables: &[FittedTable]) -> Result<String, serde_json::Error> {
    let versioned = |table| Versioned { table, version: VERSION };
    let text = match tables {
        [only] => serde_json::to_string(&versioned(only))?,
        several => {
            serde_json::to_string(&Groups { groups: several.iter().map(versioned).collect(), version: VERSION })?
        }
    };
    Ok(text + "\n")
}

/// The result and the laws beside it.
pub fn fitted_table_text(table: &FittedTable, width: Option<usize>) -> String {
    let constant = table.thrust_constant_per_rotor_n_s2;
    let meaning = constant.std_uncertainty.map_or("± is not known", |_| "k = 2");
    let left_out = match table.fit.points.iter().filter(|point| point.is_gross).count() {
        0 => " used".to_owned(),
        count => format!(", {count} of them left out of the fit"),
    };
    let doubt = if table.forbids_use { "do not use this constant: " } else { "" };
    let (of_all, total) = match table.rotor_count {
        1 => (String::new(), String::new()),
        count => (
            format!("in the table of laws, C_f and F₀ are for all {count} rotors together\n"),
            format!("{doubt}C_f, all {count} rotors = {} ({meaning})\n", quoted(table.thrust_constant_total_n_s2)),
        ),
    };
    let mut text = format!(
        "{}\n{}{left_out}: {} against {}\n\n{}{of_all}\n{total}{doubt}C_f, one rotor = {} ({meaning})\n",
        printable(&table.name()),
        counted(table.row_count, "table row"),
        printable(&table.force_column),
        printable(&table.speed_column),
        laws_text(&table.fit, width),
        quoted(constant),
    );
    if constant.std_uncertainty.is_some() {
        text += "this ± does not include calibration errors of the scale and the tachometer: they are the same in all rows, so the scatter does not show them\n";
    }
    if let Some(both) = table.thrust_coefficients {
        text += &coefficients_text(both);
    }
    if let Some(merit) = table.figure_of_merit {
        text += &format!(
            "figure of merit at the largest thrust = {} (ideal power over measured power; if the measured power is electrical, it includes the losses of motor and ESC)\n",
            significant(merit, 3)
        );
    }
    if let Some(torque) = table.torque_constant_per_rotor_n_m_s2 {
        let unit = PowerOfTen::of([torque]);
        text += &format!(
            "torque constant C_τ, one rotor = {} {}\n",
            significant(unit.scale(torque), 4),
            unit.unit("N m s²")
        );
    }
    text
}
