//! The force that the running rotors balance, and its uncertainty.

use serde::Serialize;

/// The force that the running rotors balance.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[serde(tag = "kind", rename_all = "snake_case")]
pub enum Force {
    /// A hover: the weight of vehicle and payload, m g.
    Weight {
        /// Mass of the vehicle, weighed once for all loads.
        vehicle_mass_kg: f64,
        /// Added mass of this load.
        added_mass_kg: f64,
        /// Standard uncertainty of a weighing.
        mass_std_kg: f64,
        /// Local gravity.
        gravity_m_s2: f64,
        /// Its standard uncertainty.
        gravity_std_m_s2: f64,
    },
    /// A bench run: thrust from a scale.
    Thrust {
        /// Thrust of all running rotors.
        thrust_n: f64,
        /// Its standard uncertainty.
        thrust_std_n: f64,
    },
}

impl Force {
    /// The force itself.
    pub fn newtons(&self) -> f64 {
        match *self {
            Self::Weight { vehicle_mass_kg, added_mass_kg, gravity_m_s2, .. } => {
                (vehicle_mass_kg + added_mass_kg) * gravity_m_s2
            }
            Self::Thrust { thrust_n, .. } => thrust_n,
        }
    }

    /// Mass in the air; `None` on a bench.
    pub fn mass_kg(&self) -> Option<f64> {
        match *self {
            Self::Weight { vehicle_mass_kg, added_mass_kg, .. } => Some(vehicle_mass_kg + added_mass_kg),
            Self::Thrust { .. } => None,
        }
    }

    /// Relative standard uncertainty of the force. All loads share the weighing of the vehicle; the weighing of an added mass and
    /// the thrust of a bench run belong to one load.
    pub(crate) fn relative_std(&self) -> RelativeStd {
        match *self {
            Self::Weight { vehicle_mass_kg, added_mass_kg, mass_std_kg, .. } => {
                let shared = mass_std_kg / (vehicle_mass_kg + added_mass_kg);
                RelativeStd { own: if added_mass_kg == 0.0 { 0.0 } else { shared }, shared }
            }
            Self::Thrust { thrust_n, thrust_std_n } => RelativeStd { own: thrust_std_n / thrust_n, shared: 0.0 },
        }
    }
}

/// Relative standard uncertainty of a force in two independent parts.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct RelativeStd {
    /// The part of this load alone.
    pub(crate) own: f64,
    /// The part that all loads have in common.
    pub(crate) shared: f64,
}
