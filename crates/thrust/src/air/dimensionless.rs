//! Dimensionless thrust coefficients, figure of merit and torque constant of one rotor.

use crate::regression::{FitPoint, proportional_fit};
use hovertone_vehicle::{AIR_KG_M3, RotorSpeed, SOUND_M_S, THRUST_COEFFICIENT};
use serde::Serialize;
use std::f64::consts::{PI, TAU};

/// Plausible figures of merit. The best rotors of helicopters reach 0.8, and momentum theory allows less than 1. The smallest
/// brushed motors have 0.15 with their electrical power. *Physics.*
const FIGURE_OF_MERIT: std::ops::RangeInclusive<f64> = 0.05..=0.85;

/// The thrust coefficient C_T of one rotor, in both conventions.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct ThrustCoefficients {
    /// F / (ρ n² D⁴), n in turns per second.
    pub propeller: f64,
    /// F / (ρ A (ω R)²), with the area A of the disc.
    pub rotorcraft: f64,
    /// Air density ρ that was used.
    pub density_kg_m3: f64,
    /// Whether a propeller can have this coefficient.
    pub is_plausible: bool,
}

impl ThrustCoefficients {
    /// The coefficients from the constant of one rotor, the diameter of its propeller and the density of the air.
    pub fn of_rotor(thrust_constant_n_s2: f64, propeller_diameter_m: f64, density_kg_m3: f64) -> Self {
        let radius_m = propeller_diameter_m / 2.0;
        let propeller = thrust_constant_n_s2 * TAU.powi(2) / (density_kg_m3 * propeller_diameter_m.powi(4));
        Self {
            propeller,
            rotorcraft: thrust_constant_n_s2 / (density_kg_m3 * PI * radius_m.powi(4)),
            density_kg_m3,
            is_plausible: THRUST_COEFFICIENT.contains(&propeller),
        }
    }
}

/// Least Mach number of the tips of a propeller with this thrust constant, N s², at this speed: that of the smallest one, with the largest C_T, in
/// air of 1.2 kg/m³. `M = D ω / (2 a)`, where `D⁴ = C_f (2π)² / (ρ C_T)`.
pub fn least_tip_mach(thrust_constant_n_s2: f64, speed: RotorSpeed) -> f64 {
    least_diameter_m(thrust_constant_n_s2) * speed.rad_s() / (2.0 * SOUND_M_S)
}

/// Diameter of the smallest propeller with a thrust constant: that of the largest C_T, in air of sea level.
pub fn least_diameter_m(thrust_constant_n_s2: f64) -> f64 {
    let fourth_power_m4 = thrust_constant_n_s2 * TAU.powi(2) / (AIR_KG_M3 * THRUST_COEFFICIENT.end());
    fourth_power_m4.sqrt().sqrt()
}

/// Figure of merit: the ideal power of momentum theory, T √(T/(2 ρ A)), over the real power. With the power of the shaft it describes
/// the rotor alone; with electrical power it includes motor and controller.
pub fn figure_of_merit(thrust_n: f64, power_w: f64, propeller_diameter_m: f64, density_kg_m3: f64) -> f64 {
    let area_m2 = PI * propeller_diameter_m.powi(2) / 4.0;
    thrust_n * (thrust_n / (2.0 * density_kg_m3 * area_m2)).sqrt() / power_w
}

/// Whether a rotor can have this figure of merit.
pub fn is_plausible_merit(figure_of_merit: f64) -> bool {
    FIGURE_OF_MERIT.contains(&figure_of_merit)
}

/// A torque of one rotor at a speed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TorqueReading {
    /// Shaft speed.
    pub speed: RotorSpeed,
    /// Torque; its sign is the direction of the rotor.
    pub torque_n_m: f64,
}

/// Torque of one rotor over its squared speed, N m/(rad/s)²: least squares through the origin, without the sign. `None` without
/// readings.
pub fn torque_constant_n_m_s2(readings: &[TorqueReading]) -> Option<f64> {
    let point = |reading: &TorqueReading| FitPoint::with_y_std(reading.speed.rad_s().powi(2), reading.torque_n_m, 1.0);
    let points: Vec<FitPoint> = readings.iter().map(point).collect();
    proportional_fit(&points).ok().map(|fit| fit.slope.abs())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_two_conventions_differ_by_pi_cubed_over_four() {
        let both = ThrustCoefficients::of_rotor(7.08e-6, 0.2, 1.225);
        assert!((both.propeller / both.rotorcraft - PI.powi(3) / 4.0).abs() < 1e-12);
        assert!((both.propeller - 0.143).abs() < 5e-4);
        assert!(both.is_plausible);
    }

    #[test]
    fn a_constant_of_the_whole_vehicle_taken_for_a_rotors_is_implausible() {
        // the trap of the paper's tables, and BebopS's number with half the radius
        assert!(!ThrustCoefficients::of_rotor(2.83e-5, 0.2, 1.2).is_plausible);
        assert!(!ThrustCoefficients::of_rotor(8.54858e-6, 0.1016, 1.2).is_plausible);
    }

    #[test]
    fn the_papers_rotor_has_a_third_of_the_ideal() {
        // 11.44 W for a quarter of 0.429 kg (the authors' own simulator, AuRoRA) with D = 0.2 m and ρ = 1.2 kg/m³ give 0.34
        let merit = figure_of_merit(0.429 * 9.8 / 4.0, 11.44, 0.2, 1.2);
        assert!((merit - 0.34).abs() < 0.005, "{merit}");
        assert!(is_plausible_merit(merit));
        // a rotor's thrust with the power of all four, and milliwatts for watts
        assert!(!is_plausible_merit(merit / 8.0) && !is_plausible_merit(merit * 1e3) && !is_plausible_merit(f64::NAN));
    }
}
