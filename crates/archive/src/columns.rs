//! Columns from rows of any type: name, unit, meaning and value of each stand on one line.

use arrow_array::{ArrayRef, BooleanArray, Float64Array, Int64Array, ListArray, RecordBatch, StringArray, StructArray};
use arrow_buffer::{NullBuffer, OffsetBuffer};
use arrow_schema::{ArrowError, DataType, Field, Fields, Schema};
use std::sync::Arc;

/// Key of the unit in the metadata of a column: 1 for ratios and counts, empty for text and truth values.
pub const UNIT_KEY: &str = "unit";
/// Key of the meaning in the metadata of a column.
pub const MEANING_KEY: &str = "meaning";

/// Unit of ratios and counts.
pub(crate) const NO_UNIT: &str = "1";

/// Name, unit and meaning of a column.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Head {
    pub(crate) name: &'static str,
    pub(crate) unit: &'static str,
    pub(crate) meaning: &'static str,
}

/// The head of text, of truth values, and of columns in columns.
pub(crate) const fn plain(name: &'static str, meaning: &'static str) -> Head {
    Head { name, unit: "", meaning }
}

/// A head with a unit.
pub(crate) const fn head(name: &'static str, unit: &'static str, meaning: &'static str) -> Head {
    Head { name, unit, meaning }
}

impl Head {
    fn field(self, data_type: DataType, may_be_absent: bool) -> Field {
        let metadata = [(UNIT_KEY, self.unit), (MEANING_KEY, self.meaning)];
        Field::new(self.name, data_type, may_be_absent).with_metadata(metadata)
    }
}

/// The columns of some rows.
pub(crate) struct Columns<'a, Row> {
    rows: &'a [Row],
    fields: Vec<Field>,
    arrays: Vec<ArrayRef>,
}

impl<'a, Row> Columns<'a, Row> {
    pub(crate) fn of(rows: &'a [Row]) -> Self {
        Self { rows, fields: Vec::new(), arrays: Vec::new() }
    }

    fn with(mut self, field: Field, array: ArrayRef) -> Self {
        self.fields.push(field);
        self.arrays.push(array);
        self
    }

    /// Text in every row.
    pub(crate) fn text<'r>(self, head: Head, of: impl Fn(&'r Row) -> &'r str) -> Self
    where
        'a: 'r,
    {
        let array = StringArray::from_iter_values(self.rows.iter().map(of));
        self.with(head.field(DataType::Utf8, false), Arc::new(array))
    }

    /// Text that can be absent.
    pub(crate) fn text_or_none(self, head: Head, of: impl Fn(&Row) -> Option<String>) -> Self {
        let array: StringArray = self.rows.iter().map(of).collect();
        self.with(head.field(DataType::Utf8, true), Arc::new(array))
    }

    /// A number that can be absent.
    pub(crate) fn number(self, head: Head, of: impl Fn(&Row) -> Option<f64>) -> Self {
        let array: Float64Array = self.rows.iter().map(of).collect();
        self.with(head.field(DataType::Float64, true), Arc::new(array))
    }

    /// A whole number that can be absent.
    pub(crate) fn whole(self, head: Head, of: impl Fn(&Row) -> Option<i64>) -> Self {
        let array: Int64Array = self.rows.iter().map(of).collect();
        self.with(head.field(DataType::Int64, true), Arc::new(array))
    }

    /// A truth value that can be absent.
    pub(crate) fn flag(self, head: Head, of: impl Fn(&Row) -> Option<bool>) -> Self {
        let array: BooleanArray = self.rows.iter().map(of).collect();
        self.with(head.field(DataType::Boolean, true), Arc::new(array))
    }

    /// A list of rows of its own in each row.
    pub(crate) fn list<Item>(
        self,
        head: Head,
        of: impl Fn(&Row) -> Vec<Item>,
        columns: impl FnOnce(Columns<'_, Item>) -> Columns<'_, Item>,
    ) -> Self {
        let lists: Vec<Vec<Item>> = self.rows.iter().map(of).collect();
        let offsets = OffsetBuffer::from_lengths(lists.iter().map(Vec::len));
        let items: Vec<Item> = lists.into_iter().flatten().collect();
        let items = columns(Columns::of(&items)).structs(None);
        let item = Arc::new(Field::new("item", DataType::Struct(items.fields().clone()), false));
        let array = ListArray::new(item.clone(), offsets, Arc::new(items), None);
        self.with(head.field(DataType::List(item), false), Arc::new(array))
    }

    /// A list of texts in each row.
    pub(crate) fn texts(self, head: Head, of: impl Fn(&Row) -> Vec<String>) -> Self {
        let lists: Vec<Vec<String>> = self.rows.iter().map(of).collect();
        let offsets = OffsetBuffer::from_lengths(lists.iter().map(Vec::len));
        let item = Arc::new(Field::new("item", DataType::Utf8, false));
        let texts = Arc::new(StringArray::from_iter_values(lists.into_iter().flatten()));
        let array = ListArray::new(item.clone(), offsets, texts, None);
        self.with(head.field(DataType::List(item), false), Arc::new(array))
    }

    /// A group of columns that can be absent as a whole.
    pub(crate) fn group<'r, Item: Copy + 'r>(
        self,
        head: Head,
        of: impl Fn(&'r Row) -> Option<Item>,
        columns: impl FnOnce(Columns<'_, Option<Item>>) -> Columns<'_, Option<Item>>,
    ) -> Self
    where
        'a: 'r,
    {
        let items: Vec<Option<Item>> = self.rows.iter().map(of).collect();
        let present = NullBuffer::from_iter(items.iter().map(Option::is_some));
        let array = columns(Columns::of(&items)).structs(Some(present));
        self.with(head.field(DataType::Struct(array.fields().clone()), true), Arc::new(array))
    }

    fn structs(self, present: Option<NullBuffer>) -> StructArray {
        StructArray::new(Fields::from(self.fields), self.arrays, present)
    }

    /// All columns as a batch.
    pub(crate) fn batch(self) -> Result<RecordBatch, ArrowError> {
        RecordBatch::try_new(Arc::new(Schema::new(self.fields)), self.arrays)
    }
}
