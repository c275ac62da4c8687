//! Tables for programs: named columns, each of one type, as CSV and as Parquet.

use crate::csv_text::text_of;

/// The values of a column.
#[derive(Clone, Debug, PartialEq)]
pub enum Values {
    /// Text in every row.
    Text(Vec<String>),
    /// A whole number in every row.
    Whole(Vec<i64>),
    /// Numbers; absent where unknown.
    Number(Vec<Option<f64>>),
}

/// A column. Its name contains the unit.
#[derive(Clone, Debug, PartialEq)]
pub struct DataColumn {
    /// Name of the column.
    pub name: &'static str,
    /// One value for each row.
    pub values: Values,
}

/// Columns of equal length.
#[derive(Clone, Debug, PartialEq)]
pub struct DataTable {
    /// Name of the rows.
    pub name: &'static str,
    /// Its columns.
    pub columns: Vec<DataColumn>,
}

impl DataTable {
    /// Number of rows.
    pub fn row_count(&self) -> usize {
        self.columns.first().map_or(0, |column| match &column.values {
            Values::Text(values) => values.len(),
            Values::Whole(values) => values.len(),
            Values::Number(values) => values.len(),
        })
    }

    /// The table as CSV with a header. Numbers have the shortest text that reads back exactly; unknown ones are empty.
    ///
    /// # Errors
    /// None is known, since the writer writes to memory.
    pub fn csv(&self) -> Result<String, csv::Error> {
        let mut writer = csv::Writer::from_writer(Vec::new());
        writer.write_record(self.columns.iter().map(|column| column.name))?;
        for row in 0..self.row_count() {
            writer.write_record(self.columns.iter().map(|column| match &column.values {
                Values::Text(values) => values[row].clone(),
                Values::Whole(values) => values[row].to_string(),
                Values::Number(values) => values[row].map_or(String::new(), |value| format!("{value:?}")),
            }))?;
        }
        text_of(writer)
    }

    /// The table as Parquet: one row group, no compression, columns under their names; a column is optional where values can be missing.
    ///
    /// # Errors
    /// None is known, since the writer writes to memory.
    #[cfg(feature = "parquet")]
    pub fn parquet(&self) -> Result<Vec<u8>, parquet::errors::ParquetError> {
        use parquet::data_type::{ByteArray, ByteArrayType, DoubleType, Int64Type};
        use parquet::file::properties::WriterProperties;
        use parquet::file::writer::SerializedFileWriter;
        use parquet::schema::parser::parse_message_type;
        use std::sync::Arc;
        let field = |column: &DataColumn| match column.values {
            Values::Text(_) => format!("REQUIRED BYTE_ARRAY {} (UTF8);", column.name),
            Values::Whole(_) => format!("REQUIRED INT64 {};", column.name),
            Values::Number(_) => format!("OPTIONAL DOUBLE {};", column.name),
        };
        let fields: Vec<String> = self.columns.iter().map(field).collect();
        let schema = Arc::new(parse_message_type(&format!("message {} {{ {} }}", self.name, fields.join(" ")))?);
        let made_by =
            WriterProperties::builder().set_created_by(format!("hovertone {}", crate::version::VERSION)).build();
        let mut writer = SerializedFileWriter::new(Vec::new(), schema, Arc::new(made_by))?;
        let mut group = writer.next_row_group()?;
        for column in &self.columns {
            let Some(mut into) = group.next_column()? else { break };
            match &column.values {
                Values::Text(values) => {
                    let values: Vec<ByteArray> = values.iter().map(|value| ByteArray::from(value.as_str())).collect();
                    into.typed::<ByteArrayType>().write_batch(&values, None, None)?;
                }
                Values::Whole(values) => {
                    into.typed::<Int64Type>().write_batch(values, None, None)?;
                }
                Values::Number(values) => {
                    let known: Vec<f64> = values.iter().flatten().copied().collect();
                    let levels: Vec<i16> = values.iter().map(|value| i16::from(value.is_some())).collect();
                    into.typed::<DoubleType>().write_batch(&known, Some(&levels), None)?;
                }
            }
            into.close()?;
        }
        group.close()?;
        writer.into_inner()
    }
}

/// Rows of any type, from which columns are made.
pub(crate) struct Rows<'a, Row>(pub(crate) &'a [Row]);

impl<Row> Rows<'_, Row> {
    /// A column of text.
    pub(crate) fn text(&self, name: &'static str, of: impl Fn(&Row) -> String) -> DataColumn {
        DataColumn { name, values: Values::Text(self.0.iter().map(of).collect()) }
    }

    /// A column of whole numbers.
    pub(crate) fn whole(&self, name: &'static str, of: impl Fn(&Row) -> i64) -> DataColumn {
        DataColumn { name, values: Values::Whole(self.0.iter().map(of).collect()) }
    }

    /// A column of numbers that can be missing.
    pub(crate) fn number(&self, name: &'static str, of: impl Fn(&Row) -> Option<f64>) -> DataColumn {
        DataColumn { name, values: Values::Number(self.0.iter().map(of).collect()) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn table() -> DataTable {
        let rows = [("a,b", 1, Some(2.83e-5)), ("ω", 2, None)];
        let rows = Rows(&rows);
        DataTable {
            name: "things",
            columns: vec![
                rows.text("load", |row| row.0.to_owned()),
                rows.whole("trial", |row| row.1),
                rows.number("speed_rev_s", |row| row.2),
            ],
        }
    }

    #[test]
    fn csv_is_quoted_and_what_is_not_known_is_empty() {
        assert_eq!(table().csv().unwrap(), "load,trial,speed_rev_s\n\"a,b\",1,2.83e-5\nω,2,\n");
    }

    #[cfg(feature = "parquet")]
    #[test]
    fn parquet_reads_back_the_same() {
        use parquet::file::reader::{FileReader, SerializedFileReader};
        use parquet::record::Field;
        let bytes = table().parquet().unwrap();
        let reader = SerializedFileReader::new(bytes::Bytes::from(bytes)).unwrap();
        let rows: Vec<Vec<(String, Field)>> = reader
            .get_row_iter(None)
            .unwrap()
            .map(|row| row.unwrap().get_column_iter().map(|(name, field)| (name.clone(), field.clone())).collect())
            .collect();
        let named = |name: &str, field: Field| (name.to_owned(), field);
        let first = vec![
            named("load", Field::Str("a,b".to_owned())),
            named("trial", Field::Long(1)),
            named("speed_rev_s", Field::Double(2.83e-5)),
        ];
        let second = vec![
            named("load", Field::Str("ω".to_owned())),
            named("trial", Field::Long(2)),
            named("speed_rev_s", Field::Null),
        ];
        assert_eq!(rows, [first, second]);
    }
}
