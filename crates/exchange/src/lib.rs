//! Files of other programs, text in and text out: models of simulators, and tables of thrust stands.
//!
//! ```text
//! units        a thrust constant in the units that others have      simulator     models: written, read back, compared
//! identified   results.json → what is exported                      thrust_stand  CSV tables → speeds and forces
//! ```

mod identified;
mod simulator;
mod thrust_stand;
mod units;

pub use identified::{HeardTone, IdentifiedRotor, ResultsError, identified_from_results};
pub use simulator::{ModelError, SimulatorFormat, SimulatorModel, export_text, model_from_text};
pub use thrust_stand::{StandForce, StandGroup, StandRow, StandTable, TableError, table_from_csv};
pub use units::ConstantUnits;
