//! Levels in decibels and pressures in pascal.

use std::f64::consts::SQRT_2;

/// 0 dB SPL in air, Pa (ISO 1683).
pub(crate) const REFERENCE_PRESSURE_PA: f64 = 20e-6;

/// Root-mean-square pressure of a level, `20 µPa · 10^(L/20)`.
pub(crate) fn rms_pa(level_db_spl: f64) -> f64 {
    REFERENCE_PRESSURE_PA * 10_f64.powf(level_db_spl / 20.0)
}

/// Amplitude of a sine of this level.
pub(crate) fn amplitude_pa(level_db_spl: f64) -> f64 {
    SQRT_2 * rms_pa(level_db_spl)
}
