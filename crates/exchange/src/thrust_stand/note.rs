//! What a table's reader did with columns and rows, and what the user can do about it.

use super::AT_REST_SHARE;
use std::fmt;

/// Largest number of lines that a note lists.
const LINES_LISTED_MAX: usize = 8;

/// A note about columns that are not used, or about rows that were left out or turned round.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum TableNote {
    /// A thrust or a torque without a known unit.
    UnitMissing {
        /// Header of the column.
        column: String,
    },
    /// An expanded uncertainty.
    Expanded {
        /// Header of the column.
        column: String,
        /// Its coverage factor k.
        coverage_factor: f64,
        /// The parts of the header that say so.
        stated: Vec<String>,
        /// Whether the header names an uncertainty without these parts.
        is_named_without: bool,
    },
    /// An uncertainty with a coverage whose factor is not known.
    CoverageUnknown {
        /// Header of the column.
        column: String,
        /// The coverage, as in the header.
        stated: String,
    },
    /// An error or a tolerance that may be a standard uncertainty or another one.
    KindMissing {
        /// Header of the column.
        column: String,
    },
    /// A column of coverage factors.
    FactorColumn {
        /// Header of the column.
        column: String,
        /// Header of the column of uncertainties …
        uncertainty: String,
        /// … and the coverage factor that it is read with.
        coverage_factor: f64,
    },
    /// A speed whose header has the unit Hz.
    SpeedInHz {
        /// Header of the column.
        column: String,
    },
    /// A standard uncertainty whose header does not name the quantity.
    QuantityMissing {
        /// Header of the column.
        column: String,
    },
    /// Columns that could have been the speed, the force or its uncertainty as well.
    Rivals {
        /// Headers of the columns that are not used.
        columns: Vec<String>,
        /// "speed", "force" or "uncertainty".
        what: &'static str,
        /// Header of the column that is used in their place.
        chosen: String,
    },
    /// Most thrusts are negative.
    TurnedRound,
    /// A row whose thrust has the other sign, or none.
    AgainstTheOthers {
        /// Group of the row; empty without groups.
        group: String,
        /// Line of the file, counted from 1.
        line: u64,
    },
    /// Rows without a speed or a force.
    Empty {
        /// Group of the rows; empty without groups.
        group: String,
        /// Lines of the file, counted from 1.
        lines: Vec<u64>,
    },
    /// Rows that are exact copies of earlier ones.
    Copies {
        /// Group of the rows; empty without groups.
        group: String,
        /// Number of copies.
        count: usize,
        /// Number of all rows of the group.
        of: usize,
    },
    /// Rows at rest.
    AtRest {
        /// Number of these rows.
        count: usize,
        /// Rows below this speed count as at rest.
        speed_rpm: f64,
    },
}

impl TableNote {
    /// Whether it concerns a group of rows.
    #[must_use]
    pub fn is_of(&self, name: &str) -> bool {
        match self {
            Self::AgainstTheOthers { group, .. } | Self::Empty { group, .. } | Self::Copies { group, .. } => {
                group == name
            }
            _ => true,
        }
    }

    /// What to do about it; empty where the user needs to do nothing.
    #[must_use]
    pub fn hint(&self) -> String {
        let hint = match self {
            Self::Expanded { stated, is_named_without: true, .. } => {
                return format!(
                    "if they are standard uncertainties (k = 1), remove {} from the name of the column",
                    quoted(stated, " and ")
                );
            }
            Self::Expanded { column, stated, .. } => {
                return format!(
                    "if they are standard uncertainties (k = 1), rename the column to \"{}\"",
                    with_std(column, stated)
                );
            }
            Self::CoverageUnknown { stated, .. } => {
                return format!("write the coverage factor in place of \"{stated}\", as in thrust_uncertainty_k=2_n");
            }
            Self::FactorColumn { uncertainty, .. } => {
                return format!(
                    "write the coverage factor into the name of column \"{uncertainty}\", as in thrust_uncertainty_k=2_n"
                );
            }
            Self::UnitMissing { .. } => {
                "if hovertone should use this column, write the unit into its name, as in thrust_g or torque_n_m"
            }
            Self::KindMissing { .. } => {
                "if they are standard uncertainties (k = 1), write std into its name, as in thrust_std_n; if they are expanded \
                 uncertainties, write the coverage factor, as in thrust_uncertainty_k=2_n"
            }
            Self::SpeedInHz { .. } => {
                "if it is the frequency of the tone of the blades, divide it by the number of blades; then name the column speed_rev_s"
            }
            Self::QuantityMissing { .. } => "write the quantity into its name, as in thrust_std_n or speed_std_percent",
            Self::Rivals { columns, .. } if columns.len() == 1 => {
                "if hovertone should use this column, remove the other column"
            }
            Self::Rivals { .. } => "if hovertone should use one of these columns, remove the others",
            Self::Copies { .. } => "if they are no measurements of their own, remove the copies",
            Self::TurnedRound | Self::AgainstTheOthers { .. } | Self::Empty { .. } | Self::AtRest { .. } => "",
        };
        hint.to_owned()
    }
}

/// Parts of headers in quotation marks.
fn quoted(parts: &[String], between: &str) -> String {
    parts.iter().map(|part| format!("\"{part}\"")).collect::<Vec<_>>().join(between)
}

impl fmt::Display for TableNote {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::UnitMissing { column } => {
                write!(f, "column \"{column}\" is not used: its name has no unit that hovertone knows")
            }
            Self::Expanded { column, coverage_factor: k, .. } => write!(
                f,
                "column \"{column}\" is read as expanded uncertainties with k = {k}, so its numbers are divided by {k}"
            ),
            Self::CoverageUnknown { column, stated } => {
                write!(
                    f,
                    "column \"{column}\" is not used: hovertone does not know the coverage \"{stated}\" in its name"
                )
            }
            Self::KindMissing { column } => write!(
                f,
                "column \"{column}\" is not used: its name does not say whether these are standard uncertainties"
            ),
            Self::FactorColumn { column, uncertainty, coverage_factor } => write!(
                f,
                "column \"{column}\" is not used: column \"{uncertainty}\" is read as uncertainties with k = {coverage_factor}"
            ),
            Self::SpeedInHz { column } => {
                write!(f, "column \"{column}\" is read as turns of the rotor per second")
            }
            Self::QuantityMissing { column } => {
                write!(f, "column \"{column}\" is not used: its name does not say which quantity has this uncertainty")
            }
            Self::Rivals { columns, what, chosen } => {
                let (noun, verb) = if columns.len() == 1 { ("column", "is") } else { ("columns", "are") };
                let names = quoted(columns, ", ");
                write!(f, "{noun} {names} {verb} not used: the {what} comes from column \"{chosen}\"")
            }
            Self::TurnedRound => f.write_str(
                "the thrusts are negative, and are used as positive ones, because a stand that is mounted the other \
                 way shows the other sign; if yours is not, check the column of the thrust",
            ),
            Self::AgainstTheOthers { line, .. } => {
                write!(f, "line {line} is left out: its thrust is zero, or has another sign than the others")
            }
            Self::Empty { lines, .. } if lines.len() > LINES_LISTED_MAX => {
                write!(f, "{} rows are left out: their speed or force is empty", lines.len())
            }
            Self::Empty { lines, .. } => {
                let (noun, verb, their) =
                    if lines.len() == 1 { ("line", "is", "its") } else { ("lines", "are", "their") };
                let numbers = lines.iter().map(u64::to_string).collect::<Vec<_>>().join(", ");
                write!(f, "{noun} {numbers} {verb} left out: {their} speed or force is empty")
            }
            Self::Copies { count, of, .. } => write!(
                f,
                "{count} of {of} rows are exact copies of other rows: the fit uses them all, so the ± may be too small"
            ),
            Self::AtRest { count, speed_rpm } => write!(
                f,
                "{count} {}: slower than {speed_rpm:.0} rpm ({:.0} % of the fastest speed), as of a motor that starts or stops",
                if *count == 1 { "row is left out" } else { "rows are left out" },
                100.0 * AT_REST_SHARE
            ),
        }
    }
}

/// The name of a column with "std" in place of what makes its numbers expanded uncertainties.
fn with_std(column: &str, stated: &[String]) -> String {
    let without = stated.iter().fold(column.to_owned(), |name, part| name.replacen(part, "", 1)).replace("()", "");
    let words: Vec<&str> = without.split(['_', ' ']).filter(|word| !word.is_empty()).collect();
    format!("std_{}", words.join("_"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_advice_names_as_many_columns_as_the_note() {
        let rivals = |names: &[&str]| TableNote::Rivals {
            columns: names.iter().map(|&name| name.to_owned()).collect(),
            what: "speed",
            chosen: "rpm".to_owned(),
        };
        assert!(rivals(&["a"]).hint().contains("this column"), "{}", rivals(&["a"]).hint());
        let two = rivals(&["a", "b"]);
        assert_eq!(two.to_string(), "columns \"a\", \"b\" are not used: the speed comes from column \"rpm\"");
        assert!(two.hint().contains("one of these columns"), "{}", two.hint());
        assert_eq!(TableNote::TurnedRound.hint(), "");
    }
}
