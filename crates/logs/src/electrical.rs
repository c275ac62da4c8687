//! Electrical speeds (eRPM): an ESC sees the magnetic field of its motor turn, half the number of magnetic poles times as fast as the shaft.

use crate::table::{SignalRole, TableSignal};

/// Electrical rpm per unit of a value: Betaflight writes hundreds.
pub(crate) const HUNDREDS_RPM: f64 = 100.0;
/// The usual number of magnetic poles of a motor.
pub(crate) const USUAL_POLES: f64 = 14.0;
/// Unit of a column of hundreds of rpm.
pub(crate) const UNIT_OF_HUNDREDS: &str = "electrical rpm / 100";

/// Shaft speed in rev/s of one electrical rpm.
pub(crate) fn rev_s_of_electrical_rpm(poles: f64) -> f64 {
    2.0 / poles / 60.0
}

/// A column of electrical speeds.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ElectricalColumn {
    /// Its header.
    pub header: String,
    /// A name that makes it a rotor speed, for a motor with 14 poles: "rotor1_erpm100_14_poles".
    pub name_with_poles: String,
}

/// The columns of electrical speeds among some signals.
pub(crate) fn electrical_columns<'a>(signals: impl Iterator<Item = &'a TableSignal>) -> Vec<ElectricalColumn> {
    let column = |signal: &TableSignal| {
        let Some(SignalRole::ElectricalSpeed(motor)) = signal.role else { return None };
        let unit = if signal.unit == UNIT_OF_HUNDREDS { "erpm100" } else { "erpm" };
        let name_with_poles = format!("rotor{motor}_{unit}_{USUAL_POLES}_poles");
        Some(ElectricalColumn { header: signal.name.clone(), name_with_poles })
    };
    signals.filter_map(column).collect()
}
