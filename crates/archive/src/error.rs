//! Reasons why a table or a part of it cannot be made or read.

/// An error of a table or of a part.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ArchiveError {
    /// Columns that do not fit together, or a part that is not whole.
    #[error(transparent)]
    Arrow(#[from] arrow_schema::ArrowError),
    /// A file that is no Parquet, or that cannot be written.
    #[error(transparent)]
    Parquet(#[from] parquet::errors::ParquetError),
    /// A table without a column that it must have.
    #[error("the table has no column {name}, or the column has another type than hovertone writes")]
    MissingColumn {
        /// Name of the column.
        name: &'static str,
    },
    /// Bytes that are no part.
    #[error("this is no part of a table")]
    NoPart,
}
