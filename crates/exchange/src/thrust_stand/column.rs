//! Columns of a table, and what is known of each.

use super::TableNote;
use super::coverage::{Coverage, coverage_of};
use super::header::{Meaning, Quantity, meaning_of, words_of};
use crate::csv_text::CsvText;
use csv::StringRecord;

/// Headers of columns that name a part, also where a name is a number: a propeller 1045.
const NAMED_PARTS: [&str; 4] = ["propeller", "prop", "motor", "esc"];
/// Words of a rotor.
const ROTOR: [&str; 4] = ["rotor", "prop", "propeller", "wheel"];

/// A column of a table.
pub(super) struct Column {
    pub(super) index: usize,
    pub(super) header: String,
    pub(super) quantity: Option<Quantity>,
    /// Whether the column has words: names of groups or of rows.
    pub(super) is_words: bool,
    /// SI units per unit of the column.
    pub(super) si_per_unit: f64,
    /// Meaning of the header.
    pub(super) meaning: Meaning,
    /// What the header says about an uncertainty.
    pub(super) coverage: Coverage,
}

impl Column {
    /// The number in a row, in SI units.
    pub(super) fn number(&self, csv: &CsvText, record: &StringRecord) -> Option<f64> {
        Some(csv.number(record.get(self.index)?)? * self.si_per_unit)
    }

    /// Whether the column is a thrust without a known unit.
    pub(super) fn is_force_without_unit(&self) -> bool {
        self.meaning == Meaning::UnknownUnit && !words_of(&self.header.to_lowercase()).any(|word| word == "torque")
    }

    /// The quantity of its standard uncertainty, for a column of forces or of speeds.
    pub(super) fn std_quantity(&self) -> Option<Quantity> {
        match self.quantity? {
            Quantity::Speed => Some(Quantity::SpeedStd),
            Quantity::Thrust => Some(Quantity::ThrustStd),
            Quantity::Mass => Some(Quantity::MassStd),
            _ => None,
        }
    }

    /// Whether the column is a standard uncertainty in percent of the measured value; then `si_per_unit` is that of a share.
    pub(super) fn is_share(&self) -> bool {
        matches!(self.meaning, Meaning::Share(_))
    }

    /// The coverage factor of a column of uncertainties that is used; `None` for any other column.
    pub(super) fn coverage_factor(&self) -> Option<f64> {
        self.coverage.factor.as_ref().ok().copied().filter(|_| self.quantity.is_some_and(Quantity::is_std))
    }

    /// Why the column is not used, though it seems to be a quantity.
    pub(super) fn why_unused(&self) -> Option<TableNote> {
        let column = self.header.clone();
        match self.meaning {
            Meaning::UnknownUnit | Meaning::UnknownStdUnit => Some(TableNote::UnitMissing { column }),
            Meaning::StdOfUnknown => Some(TableNote::QuantityMissing { column }),
            Meaning::UnknownKind => Some(TableNote::KindMissing { column }),
            Meaning::Known(quantity, _) | Meaning::Share(quantity) if quantity.is_std() => {
                self.coverage.factor.clone().err().map(|stated| TableNote::CoverageUnknown { column, stated })
            }
            Meaning::Known(..) | Meaning::Share(_) | Meaning::Other => None,
        }
    }

    /// Whether the header says Hz, and not turns: it may be the frequency of a tone.
    pub(super) fn is_in_hz(&self) -> bool {
        let lower = self.header.to_lowercase();
        words_of(&lower).any(|word| word == "hz") && !words_of(&lower).any(|word| ["rev", "rps"].contains(&word))
    }

    /// Whether the header says that the rotor is meant, and not the motor.
    pub(super) fn names_rotor(&self) -> bool {
        words_of(&self.header.to_lowercase()).any(|word| ROTOR.contains(&word))
    }
}

/// The number before the word "rotor" or "rotors" in a header.
pub(super) fn rotors_in(header: &str) -> Option<u32> {
    let lower = header.to_lowercase();
    let before = lower[..lower.find("rotor")?].trim_end_matches([' ', '_', '-']);
    let digits = before.len() - before.trim_end_matches(|letter: char| letter.is_ascii_digit()).len();
    before[before.len() - digits..].parse().ok()
}

pub(super) fn columns_of(headers: &StringRecord, records: &[StringRecord]) -> Vec<Column> {
    let column = |(index, header): (usize, &str)| {
        let coverage = coverage_of(header);
        let meaning = meaning_of(&coverage);
        let found = match meaning {
            Meaning::Known(quantity, si_per_unit) => Some((quantity, si_per_unit)),
            Meaning::Share(quantity) => Some((quantity, 0.01)),
            _ => None,
        };
        let known = found.and_then(|(quantity, si_per_unit)| {
            let factor = if quantity.is_std() { *coverage.factor.as_ref().ok()? } else { 1.0 };
            Some((quantity, si_per_unit / factor))
        });
        let cells = || records.iter().filter_map(|record| record.get(index));
        let is_word = |cell: &str| !cell.is_empty() && cell.replacen(',', ".", 1).parse::<f64>().is_err();
        Column {
            index,
            header: header.to_owned(),
            quantity: known.map(|(quantity, _)| quantity),
            is_words: known.is_none()
                && !records.is_empty()
                && (cells().all(is_word) || NAMED_PARTS.contains(&header.trim().to_lowercase().as_str())),
            si_per_unit: known.map_or(1.0, |(_, si_per_unit)| si_per_unit),
            meaning,
            coverage,
        }
    };
    headers.iter().enumerate().map(column).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_header_may_say_of_how_many_rotors() {
        let rotors: Vec<Option<u32>> =
            ["thrust_g_4rotors", "Thrust of 6 rotors (N)", "rotor_thrust_n", "thrust_n"].map(rotors_in).into();
        assert_eq!(rotors, [Some(4), Some(6), None, None]);
    }
}
