//! The force that the running rotors balance.

use serde::Serialize;

/// The force that the running rotors balance.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[serde(tag = "kind", rename_all = "snake_case")]
pub enum Force {
    /// A hover: the weight of vehicle and payload.
    Weight {
        /// Mass of the vehicle, weighed once for all loads.
        vehicle_mass_kg: f64,
        /// Mass that this load adds.
        added_mass_kg: f64,
        /// Standard uncertainty of a weighing.
        mass_std_kg: f64,
        /// Local gravity.
        gravity_m_s2: f64,
        /// Its standard uncertainty.
        gravity_std_m_s2: f64,
    },
    /// A bench run: thrust read from a scale.
    Thrust {
        /// Thrust of all rotors that run.
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

    /// Mass that is lifted; none on a bench.
    pub fn mass_kg(&self) -> Option<f64> {
        match *self {
            Self::Weight { vehicle_mass_kg, added_mass_kg, .. } => Some(vehicle_mass_kg + added_mass_kg),
            Self::Thrust { .. } => None,
        }
    }

    /// Relative standard uncertainty that this load has alone, and the one it shares with the others.
    pub(crate) fn relative_std(&self) -> (f64, f64) {
        match *self {
            Self::Weight { vehicle_mass_kg, added_mass_kg, mass_std_kg, .. } => {
                let shared = mass_std_kg / (vehicle_mass_kg + added_mass_kg);
                (if added_mass_kg == 0.0 { 0.0 } else { shared }, shared)
            }
            Self::Thrust { thrust_n, thrust_std_n } => (thrust_std_n / thrust_n, 0.0),
        }
    }
}
