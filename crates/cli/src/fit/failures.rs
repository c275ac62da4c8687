//! Tables that cannot be fitted: what happened, and what to do.

use crate::failure::Failure;
use hovertone::thrust::regression::FitError;
use hovertone::thrust::{ForcePoint, NoScatter};
use hovertone_exchange::{CsvError, StandGroup, StandTable, TableError, TableNote};
use std::path::Path;

/// Weight of the heaviest vehicles that hovertone takes, 10 000 kg.
const FORCE_N_MAX: f64 = 1e5;
/// Smallest and largest standard uncertainty over its quantity that a fit can use: beyond them, its weights are lost in rounding.
const STD_SHARES: std::ops::RangeInclusive<f64> = 1e-12..=1e6;

/// The failure of a file that is no table of speeds and forces.
pub(super) fn table_failure(error: &TableError, path: &Path) -> Failure {
    if let TableError::Csv(error @ (CsvError::NoTable(_) | CsvError::NotCsv(_))) = error {
        return Failure::failed(error.to_string(), error.hint(), path);
    }
    let rename: String;
    let hint = match error {
        TableError::OtherUnit { header: Some(header), .. } => {
            rename = format!(
                "the numbers probably have another unit: rename the header to {header}, or to the unit of the numbers"
            );
            &rename
        }
        TableError::OtherUnit { .. } => {
            "the numbers probably have another unit: write the unit into the header, as in speed_rad_s"
        }
        TableError::NoColumn { .. } => {
            "rename the header of the right column, as in speed_rpm, thrust_g or mass_g; docs/formats.md lists the words \
             that hovertone knows, under \"hovertone fit\""
        }
        TableError::NoUnit { .. } => "write the unit into the header: thrust_g, thrust_n, thrust_kg or thrust_lbf",
        TableError::Csv(error) => error.hint(),
        TableError::HeaderAlone => "write a row for each measurement below the header",
        TableError::EmptyStd { .. } => "write the uncertainty of this row, remove the row, or remove the column",
        TableError::NoRow => {
            "look at the columns of speed and force: without a tachometer or a scale, a table has only zeros or empty \
             cells there"
        }
        _ => "correct the cell, or remove the row",
    };
    Failure::Usage { what: error.to_string(), hint: hint.to_owned(), path: Some(path.to_owned()) }
}

/// The failure of rows that no constant fits.
pub(super) fn unfitted(error: &FitError, points: &[ForcePoint], path: &Path) -> Failure {
    let (what, hint) = match error {
        FitError::UnusablePoint { number } => {
            let name = points.get(number.saturating_sub(1)).map_or("a row", |point| point.name.as_str());
            let what = format!("{name} has a speed or a force that is too large or too small to be fitted");
            (what, "correct or remove that row of the table")
        }
        FitError::TooFewPoints { .. } => (error.to_string(), "measure more rows"),
        FitError::NoSpread => (error.to_string(), "measure at different speeds"),
        FitError::NotSettled => {
            let what = "no constant can be fitted to these rows: their numbers are too far apart".to_owned();
            (what, "check the units of speeds, forces and stated uncertainties in all rows")
        }
        _ => (error.to_string(), "check the table"),
    };
    Failure::failed(what, hint, path)
}

/// Refuses a stated uncertainty that is beyond all measure: the fit would use this row alone, or never.
pub(super) fn refuse_absurd_std(points: &[ForcePoint], table: &StandTable, path: &Path) -> Result<(), Failure> {
    let of_point = |point: &ForcePoint| {
        let shares = [
            ("force", point.force_std_n / point.force_n),
            ("squared speed", point.speed_square_std_rad2_s2 / point.speed_square_rad2_s2),
        ];
        shares.into_iter().find(|(_, share)| *share > 0.0 && !STD_SHARES.contains(share))
    };
    let absurd = points.iter().find_map(|point| Some((&point.name, of_point(point)?)));
    let Some((name, (quantity, share))) = absurd else { return Ok(()) };
    let how = if share > 1.0 { "large" } else { "small" };
    let columns = table.std_columns.join(" or ");
    Err(Failure::Usage {
        what: format!("{name}: the stated uncertainty is too {how} for a fit: it is {share:.0e} times the {quantity}"),
        hint: format!("correct {columns} in this row, or remove this column"),
        path: Some(path.to_owned()),
    })
}

/// Refuses a force that is larger than that of any vehicle.
pub(super) fn refuse_absurd_force(points: &[ForcePoint], path: &Path) -> Result<(), Failure> {
    let Some(point) = points.iter().find(|point| point.force_n > FORCE_N_MAX) else { return Ok(()) };
    Err(Failure::Usage {
        what: format!(
            "{}: the force is {:.1e} N, but it must be {FORCE_N_MAX:.0e} N or less",
            point.name, point.force_n
        ),
        hint: "correct the cell or its unit, or remove the row".to_owned(),
        path: Some(path.to_owned()),
    })
}

/// The failure of rows whose scatter tells no uncertainty, with what was done to them.
pub(super) fn without_scatter(reason: NoScatter, group: &StandGroup, table: &StandTable, path: &Path) -> Failure {
    let (count, rows) = match reason {
        NoScatter::TooFewPoints { count } => {
            let of = if group.name.is_empty() { "table" } else { "group" };
            let together = match table.groups.len() {
                ..=1 => String::new(),
                groups => format!(
                    "the columns with words split the table into {groups} groups, each with a fit of its own: remove \
                     these columns to fit all rows together; or "
                ),
            };
            (format!(", and the {of} has {count}"), together + "measure more rows")
        }
        _ => (String::new(), "give measured rows, not calculated rows".to_owned()),
    };
    let name = &group.name;
    let group = if group.name.is_empty() { String::new() } else { format!("group \"{}\": ", group.name) };
    // which columns are read is another matter, and copies are not in a fit
    let is_about_rows = |note: &&TableNote| !matches!(note, TableNote::Rivals { .. } | TableNote::Copies { .. });
    let of_rows = table.notes.iter().filter(|note| note.is_of(name)).filter(is_about_rows);
    let notes: String = of_rows.map(|note| format!("; {note}")).collect();
    Failure::Usage {
        what: format!("{group}{reason}{count}{notes}"),
        hint: format!(
            "{rows}, or state the standard uncertainty of each force in a column of its own (thrust_std_n, mass_std_g)"
        ),
        path: Some(path.to_owned()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Each error has the advice for its own cause.
    #[test]
    fn no_error_of_a_fit_is_answered_with_the_advice_of_another() {
        let hint_of = |error: FitError| match unfitted(&error, &[], Path::new("table.csv")) {
            Failure::Failed { hint, .. } => hint,
            _ => String::new(),
        };
        let errors = [
            FitError::UnusablePoint { number: 1 },
            FitError::TooFewPoints { given: 0, needed: 1 },
            FitError::NoSpread,
            FitError::NotSettled,
        ];
        let hints = errors.map(hint_of);
        assert!(hints[0].contains("remove that row") && hints[1..].iter().all(|hint| !hint.contains("that row")));
        assert!((1..hints.len()).all(|index| !hints[..index].contains(&hints[index])), "{hints:?}");
    }
}
