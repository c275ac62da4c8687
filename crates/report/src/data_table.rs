//! Tables for programs: named columns of one type each, as CSV and as Parquet.

/// The values of a column.
#[derive(Clone, Debug, PartialEq)]
pub enum Values {
    /// Text, always there.
    Text(Vec<String>),
    /// Whole numbers, always there.
    Whole(Vec<i64>),
    /// Numbers; absent where nothing is known.
    Number(Vec<Option<f64>>),
}

/// A column: its name, which carries the unit, and its values.
#[derive(Clone, Debug, PartialEq)]
pub struct DataColumn {
    /// Its name.
    pub name: &'static str,
    /// Its values, as many as there are rows.
    pub values: Values,
}

/// Columns of equal length.
#[derive(Clone, Debug, PartialEq)]
pub struct DataTable {
    /// What its rows are.
    pub name: &'static str,
    /// Its columns.
    pub columns: Vec<DataColumn>,
}

impl DataTable {
    /// A table of rows, each given by its columns' values.
    pub(crate) fn of_rows<Row>(name: &'static str, rows: &[Row], columns: &[(&'static str, Cell<'_, Row>)]) -> Self {
        let values = |cell: &Cell<'_, Row>| match cell {
            Cell::Text(of) => Values::Text(rows.iter().map(of).collect()),
            Cell::Whole(of) => Values::Whole(rows.iter().map(of).collect()),
            Cell::Number(of) => Values::Number(rows.iter().map(of).collect()),
        };
        let columns = columns.iter().map(|(name, cell)| DataColumn { name, values: values(cell) }).collect();
        Self { name, columns }
    }

    /// Number of rows.
    pub fn row_count(&self) -> usize {
        self.columns.first().map_or(0, |column| match &column.values {
            Values::Text(values) => values.len(),
            Values::Whole(values) => values.len(),
            Values::Number(values) => values.len(),
        })
    }

    /// As CSV with a header. Numbers are the shortest that read back exactly; what is not known is empty.
    ///
    /// # Errors
    /// None that is known of: memory is written to.
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
        crate::samples::text_of(writer)
    }

    /// As Parquet: one row group, no compression, columns under their names; optional where a value can be missing.
    ///
    /// # Errors
    /// None that is known of: memory is written to.
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
        let made_by = WriterProperties::builder().set_created_by(format!("hovertone {}", crate::VERSION)).build();
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

/// How a column's value comes from a row.
pub(crate) enum Cell<'a, Row> {
    Text(&'a dyn Fn(&Row) -> String),
    Whole(&'a dyn Fn(&Row) -> i64),
    Number(&'a dyn Fn(&Row) -> Option<f64>),
}

#[cfg(test)]
mod tests {
    use super::*;

    fn table() -> DataTable {
        let rows = [("a,b", 1, Some(2.83e-5)), ("ω", 2, None)];
        DataTable::of_rows(
            "things",
            &rows,
            &[
                ("load", Cell::Text(&|row: &(&str, i64, Option<f64>)| row.0.to_owned())),
                ("trial", Cell::Whole(&|row| row.1)),
                ("speed_rev_s", Cell::Number(&|row| row.2)),
            ],
        )
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
