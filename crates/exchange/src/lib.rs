//! Files of other programs, text in and text out: models of simulators, tables of thrust stands.
//!
//! ```text
//! units        a thrust constant in the units of other programs      simulator     models: written, read back, compared
//! identified   results.json → numbers for an export                 thrust_stand  CSV tables → speeds and forces
//! csv_text     CSV text, for the tables
//! ```

mod csv_text;
mod identified;
mod simulator;
mod thrust_stand;
mod units;

pub use csv_text::CsvError;
pub use identified::{Doubt, HeardTone, IdentifiedRotor, ResultsError, identified_from_results};
pub use simulator::{
    ChangedLine, ModelError, SimulatorFormat, SimulatorModel, UpdatedModel, export_text, model_from_text, updated_model,
};
pub use thrust_stand::{StandForce, StandGroup, StandRow, StandTable, TableError, TableNote, table_from_csv};
pub use units::ConstantUnits;
