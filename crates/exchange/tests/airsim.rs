//! The export for AirSim in the hands of a C++ compiler: it is a part of `struct RotorParams`, and no file of settings.
#![allow(clippy::unwrap_used, clippy::print_stdout)] // what tests share has no attribute by which the lints know it

use hovertone_exchange::{IdentifiedRotor, SimulatorFormat, export_text};
use std::fs;
use std::process::Command;

/// The export stands for the members of AirSim's struct of the same names (`RotorParams.hpp`, commit 07a0c8e). The program computes thrust and
/// torque by its formulas: T = C_T ρ n² D⁴ and Q = C_P ρ n² D⁵ / (2π), n in turns per second.
const PROGRAM: &str = "
#include <cstdio>
typedef float real_T;
struct RotorParams {
EXPORT
    real_T max_rpm = 6000.0f;
};
int main() {
    RotorParams params;
    const double turns = 100.0, diameter = params.propeller_diameter;
    const double pressure = params.air_density * turns * turns * diameter * diameter * diameter * diameter;
    std::printf(\"%.9g %.9g\\n\", params.C_T * pressure, params.C_P * pressure * diameter / (2 * 3.14159265358979323846));
    return 0;
}
";

fn rotor() -> IdentifiedRotor {
    IdentifiedRotor {
        vehicle_name: "a vehicle */ \"with\" signs \\".to_owned(),
        thrust_constant_n_s2: 7.07753e-6,
        expanded_uncertainty_n_s2: Some(1.4e-7),
        measured_std_total_n_s2: None,
        rotors_std_share: 0.0,
        tone: None,
        method: None,
        trial_std_share: None,
        rotor_count: 4,
        mass_kg: Some(0.413),
        hover_speed_rad_s: Some(378.07),
        gravity_m_s2: 9.80,
        propeller_diameter_m: Some(0.2),
        air_density_kg_m3: Some(1.17),
        torque_constant_n_m_s2: Some(2.1308e-7),
        hover_command: None,
        forbids_use: false,
        doubts: Vec::new(),
        recordings_sha256: Vec::new(),
        clock_correction_ppm: 0.0,
        origin: "a test".to_owned(),
    }
}

#[test]
fn a_compiler_finds_the_names_of_airsim_and_computes_the_measured_thrust() {
    let folder = tempfile::tempdir().unwrap();
    let (source, program) = (folder.path().join("export.cpp"), folder.path().join("export"));
    let rotor = rotor();
    let export = export_text(&rotor, SimulatorFormat::Airsim).unwrap();
    fs::write(&source, PROGRAM.replace("EXPORT", &export)).unwrap();
    let compiled =
        Command::new("c++").args(["-std=c++11", "-Wall", "-Werror", "-o"]).args([&program, &source]).output();
    let Ok(compiled) = compiled else {
        println!("skipped: no `c++`");
        return;
    };
    assert!(compiled.status.success(), "{}\n{export}", String::from_utf8_lossy(&compiled.stderr));
    let printed = Command::new(&program).output().unwrap().stdout;
    let numbers: Vec<f64> =
        String::from_utf8(printed).unwrap().split_whitespace().map(|number| number.parse().unwrap()).collect();
    let square = (100.0 * std::f64::consts::TAU).powi(2);
    let measured = [rotor.thrust_constant_n_s2, 2.1308e-7].map(|constant| constant * square);
    assert_eq!(numbers.len(), 2);
    for (number, measured) in numbers.iter().zip(measured) {
        // AirSim's numbers have 24 bits; the diameter is in it four or five times
        assert!((number / measured - 1.0).abs() < 5.0 * f64::from(f32::EPSILON), "{number}, {measured}");
    }
}
