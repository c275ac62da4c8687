//! Rows of `recordings.parquet` → what pages and comparisons need of them.

use crate::error::ArchiveError;
use crate::part::Part;
use arrow_array::cast::AsArray;
use arrow_array::types::{Float64Type, Int64Type};
use arrow_array::{Array, Float64Array, Int64Array, ListArray, RecordBatch, StringArray, StructArray};
use parquet::arrow::arrow_reader::ParquetRecordBatchReaderBuilder;
use parquet::file::reader::ChunkReader;

/// Speed of one rotor, or of all together.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RotorSummary {
    /// Mean shaft speed.
    pub speed_rev_s: f64,
    /// Standard uncertainty of all terms, where it is known.
    pub std_rev_s: Option<f64>,
    /// Standard deviation over the frames, where it is known.
    pub spread_rev_s: Option<f64>,
    /// Number of its label, from 1, where it is known which rotor it is. A batch has no labels.
    pub label_number: Option<usize>,
}

/// A recording in short.
#[derive(Clone, Debug, PartialEq)]
pub struct Summary {
    /// Its name.
    pub file: String,
    /// `ok`, `ambiguous`, `no_rotor_tone` or `error`.
    pub status: String,
    /// Why there is no speed.
    pub reason: Option<String>,
    /// Frequency of the tone.
    pub tone_hz: Option<f64>,
    /// The mean speed, where there is one.
    pub speed: Option<RotorSummary>,
    /// The part of the standard uncertainty that all recordings of one recorder share: its clock.
    pub clock_std_rev_s: f64,
    /// The separated rotors, fastest first.
    pub rotors: Vec<RotorSummary>,
    /// From the start to the end of the used hover.
    pub used_s: Option<(f64, f64)>,
    /// What weakens the answer.
    pub warnings: Vec<String>,
    /// Whether the speed must not be used.
    pub is_doubtful: bool,
    /// Whether the file ends before its sound does.
    pub is_prefix: bool,
}

impl Part {
    /// The recording in short.
    ///
    /// # Errors
    /// None is known for a part that could be read.
    pub fn summary(&self) -> Result<Summary, ArchiveError> {
        summaries_of(&self.row)?.into_iter().next().ok_or(ArchiveError::NoPart)
    }
}

/// The rows of a `recordings.parquet`.
///
/// # Errors
/// It is no Parquet, or a column is missing.
pub fn summaries_of_parquet(file: impl ChunkReader + 'static) -> Result<Vec<Summary>, ArchiveError> {
    let mut summaries = Vec::new();
    for batch in ParquetRecordBatchReaderBuilder::try_new(file)?.build()? {
        summaries.extend(summaries_of(&batch?)?);
    }
    Ok(summaries)
}

/// The rows of a batch.
///
/// # Errors
/// A column is missing.
pub fn summaries_of(batch: &RecordBatch) -> Result<Vec<Summary>, ArchiveError> {
    let text = |name| batch.column_by_name(name).and_then(|column| column.as_string_opt::<i32>()).ok_or(missing(name));
    let list = |name| batch.column_by_name(name).and_then(|column| column.as_list_opt::<i32>()).ok_or(missing(name));
    let number = |name| number_of(batch.column_by_name(name), name);
    let (file, status, reason) = (text("file")?, text("status")?, text("reason")?);
    let (tone_hz, from_s, to_s) = (number("tone_hz")?, number("from_s")?, number("to_s")?);
    let speed = Speeds {
        speed_rev_s: number("speed_rev_s")?,
        std_rev_s: number("combined_std_uncertainty_rev_s")?,
        spread_rev_s: number("spread_rev_s")?,
    };
    let facts: &StructArray =
        batch.column_by_name("recording").and_then(|column| column.as_struct_opt()).ok_or(missing("recording"))?;
    let (rotors, budget, warnings) = (list("rotors")?, list("uncertainty_budget")?, list("warnings")?);
    // earlier tables do not have it
    let is_doubtful = batch.column_by_name("is_doubtful").and_then(|column| column.as_boolean_opt());
    (0..batch.num_rows())
        .map(|row| {
            Ok(Summary {
                file: file.value(row).to_owned(),
                status: status.value(row).to_owned(),
                reason: reason.is_valid(row).then(|| reason.value(row).to_owned()),
                tone_hz: value(tone_hz, row),
                speed: speed.at(row),
                clock_std_rev_s: clock_std_rev_s(budget, row)?,
                rotors: rotors_of(rotors, row)?,
                used_s: value(from_s, row).zip(value(to_s, row)),
                warnings: texts_of(warnings, row)?,
                is_doubtful: is_doubtful.is_some_and(|column| column.is_valid(row) && column.value(row)),
                is_prefix: is_prefix(facts, row)?,
            })
        })
        .collect()
}

/// Columns of speeds.
struct Speeds<'a> {
    speed_rev_s: &'a Float64Array,
    std_rev_s: &'a Float64Array,
    spread_rev_s: &'a Float64Array,
}

impl Speeds<'_> {
    fn at(&self, row: usize) -> Option<RotorSummary> {
        Some(RotorSummary {
            speed_rev_s: value(self.speed_rev_s, row)?,
            std_rev_s: value(self.std_rev_s, row),
            spread_rev_s: value(self.spread_rev_s, row),
            label_number: None,
        })
    }
}

fn rotors_of(rotors: &ListArray, row: usize) -> Result<Vec<RotorSummary>, ArchiveError> {
    let rotors = rotors.value(row);
    let rotors: &StructArray = rotors.as_struct_opt().ok_or(missing("rotors"))?;
    let number = |name| number_of(rotors.column_by_name(name), name);
    let speeds = Speeds {
        speed_rev_s: number("speed_rev_s")?,
        std_rev_s: number("combined_std_uncertainty_rev_s")?,
        spread_rev_s: number("spread_rev_s")?,
    };
    let labels = label_numbers(rotors);
    let rotor = |rotor| Some(RotorSummary { label_number: label_number(labels, rotor), ..speeds.at(rotor)? });
    Ok((0..rotors.len()).filter_map(rotor).collect())
}

/// The column `label.number` of a table that has labels.
fn label_numbers(rotors: &StructArray) -> Option<&Int64Array> {
    rotors.column_by_name("label")?.as_struct_opt()?.column_by_name("number")?.as_primitive_opt::<Int64Type>()
}

fn label_number(numbers: Option<&Int64Array>, rotor: usize) -> Option<usize> {
    let number = numbers.filter(|numbers| numbers.is_valid(rotor))?.value(rotor);
    usize::try_from(number).ok().filter(|number| *number > 0)
}

fn clock_std_rev_s(budget: &ListArray, row: usize) -> Result<f64, ArchiveError> {
    let terms = budget.value(row);
    let terms: &StructArray = terms.as_struct_opt().ok_or(missing("uncertainty_budget"))?;
    let source: &StringArray =
        terms.column_by_name("source").and_then(|column| column.as_string_opt::<i32>()).ok_or(missing("source"))?;
    let std_rev_s = number_of(terms.column_by_name("std_uncertainty_rev_s"), "std_uncertainty_rev_s")?;
    let clock = (0..terms.len()).filter(|term| source.value(*term) == "clock");
    Ok(clock.filter_map(|term| value(std_rev_s, term)).map(|std| std * std).sum::<f64>().sqrt())
}

fn texts_of(texts: &ListArray, row: usize) -> Result<Vec<String>, ArchiveError> {
    let texts = texts.value(row);
    let texts: &StringArray = texts.as_string_opt::<i32>().ok_or(missing("warnings"))?;
    Ok(texts.iter().flatten().map(str::to_owned).collect())
}

fn is_prefix(facts: &StructArray, row: usize) -> Result<bool, ArchiveError> {
    let column = facts.column_by_name("is_prefix").and_then(|column| column.as_boolean_opt());
    let column = column.ok_or(missing("is_prefix"))?;
    Ok(facts.is_valid(row) && column.is_valid(row) && column.value(row))
}

fn number_of<'a>(
    column: Option<&'a arrow_array::ArrayRef>,
    name: &'static str,
) -> Result<&'a Float64Array, ArchiveError> {
    column.and_then(|column| column.as_primitive_opt::<Float64Type>()).ok_or(missing(name))
}

fn value(column: &Float64Array, row: usize) -> Option<f64> {
    column.is_valid(row).then(|| column.value(row))
}

fn missing(name: &'static str) -> ArchiveError {
    ArchiveError::MissingColumn { name }
}
