//! The rigid body and the force generation against rotorpy, an independent simulator: validation/rotorpy/.

use hovertone_sim::body::{BODY_NUMBERS, BodyState, RigidBody};
use hovertone_sim::forces::{hubs, rotor_wrench};
use hovertone_sim::rk4;
use hovertone_vehicle::find_flight_parameters;
use nalgebra::{Matrix3, Vector3};

const REFERENCE: &str = include_str!("../../../../validation/rotorpy/rigid_body.csv");
const COMMANDS_RAD_S: [[f64; 4]; 12] = [
    [378.0, 378.0, 378.0, 378.0],
    [390.0, 390.0, 366.0, 366.0],
    [360.0, 360.0, 396.0, 396.0],
    [385.0, 385.0, 371.0, 371.0],
    [366.0, 390.0, 390.0, 366.0],
    [396.0, 360.0, 360.0, 396.0],
    [430.0, 320.0, 430.0, 320.0],
    [420.0, 420.0, 420.0, 420.0],
    [330.0, 400.0, 350.0, 390.0],
    [410.0, 340.0, 380.0, 360.0],
    [300.0, 310.0, 305.0, 320.0],
    [440.0, 430.0, 445.0, 425.0],
];
const LAG_S: f64 = 0.0235;
const NUMBERS: usize = BODY_NUMBERS + 4;

/// Three seconds of it, through some turns and 20 m of height. rotorpy's solver is held to 1e-12, the file has 15
/// digits, and one step of 1 ms is good for some 1e-9 here, so 1e-7 of each quantity's size is asked for; a wrong sign
/// or a missing term is off by its whole size.
#[test]
fn a_flight_of_rotorpy_comes_back() {
    let parameters = find_flight_parameters("ardrone").unwrap();
    let (c_f, c_tau) = (7.0775e-6, 2.1308e-7);
    let inertia = Matrix3::new(2.237568e-3, 1e-4, -2e-4, 1e-4, 2.985236e-3, 3e-4, -2e-4, 3e-4, 4.80374e-3);
    let body = RigidBody::new(0.413, inertia, 9.81).unwrap();
    let hubs = hubs(parameters, Vector3::zeros());

    let mut lines = REFERENCE.lines();
    let made_by = lines.next().unwrap();
    assert!(made_by.starts_with("# ") && made_by.contains("rotorpy") && made_by.contains("make_reference.py"));
    assert!(lines.next().unwrap().starts_with("time_s,x_m,"));
    let rows: Vec<Vec<f64>> =
        lines.map(|line| line.split(',').map(|number| number.parse().unwrap()).collect()).collect();
    assert_eq!(rows.len(), 61);
    let turned = rows.iter().map(|row| (1.0 - 2.0 * (row[8].powi(2) + row[9].powi(2))).acos()).fold(0.0, f64::max);
    assert!(turned > 0.5, "the flight must not be a hover: leans by {turned} rad at most");

    let mut numbers: [f64; NUMBERS] = std::array::from_fn(|k| rows[0][k + 1]);
    let mut worst = 0.0_f64;
    for (index, row) in rows.iter().enumerate().skip(1) {
        let command = COMMANDS_RAD_S[(index - 1) / 5];
        for _ in 0..50 {
            numbers = rk4(&numbers, 0.001, |numbers| {
                let state = BodyState::from_array(&std::array::from_fn(|k| numbers[k]));
                let squares: [f64; 4] = std::array::from_fn(|k| numbers[BODY_NUMBERS + k].powi(2));
                let wrench = rotor_wrench(&hubs, &squares.map(|s| c_f * s), &squares.map(|s| c_tau * s));
                let rate = body.rate(&state, &state.rotation(), &wrench);
                std::array::from_fn(|k| match k.checked_sub(BODY_NUMBERS) {
                    None => rate[k],
                    Some(rotor) => (command[rotor] - numbers[k]) / LAG_S,
                })
            });
        }
        // Sizes: position, velocity, attitude, rates, rotor speeds.
        let size = |k: usize| [10.0, 10.0, 1.0, 5.0, 378.0][[0, 0, 0, 1, 1, 1, 2, 2, 2, 2, 3, 3, 3, 4, 4, 4, 4][k]];
        // A quaternion and its negative are one attitude.
        let sign = if (6..10).map(|k| numbers[k] * row[k + 1]).sum::<f64>() < 0.0 { -1.0 } else { 1.0 };
        for k in 0..NUMBERS {
            let found = if (6..10).contains(&k) { sign * numbers[k] } else { numbers[k] };
            let off = (found - row[k + 1]).abs() / size(k);
            assert!(off < 1e-7, "at {} s, number {k}: {found}, rotorpy has {}", row[0], row[k + 1]);
            worst = worst.max(off);
        }
    }
    println!("rigid body against rotorpy: worst {worst:.1e} of each quantity's size, leaning up to {turned:.2} rad");
}
