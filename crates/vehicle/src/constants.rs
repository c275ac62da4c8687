//! Constants of nature that several stages share.

/// Speed of sound in dry air of 20 °C, m/s. It changes by 0.17 % per kelvin. *Physics.*
pub const SOUND_M_S: f64 = 343.2;

/// Density of air at sea level and 20 °C, kg/m³. *Physics.*
pub const AIR_KG_M3: f64 = 1.2;

/// Standard gravity, m/s² (ISO 80000-3). *Physics.*
pub const GRAVITY_STANDARD_M_S2: f64 = 9.806_65;
