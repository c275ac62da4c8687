use super::*;
use crate::find_preset;

#[test]
fn every_number_has_a_source_and_belongs_to_a_vehicle() {
    let mut numbers = 0;
    for parameters in flight_presets() {
        assert!(find_preset(parameters.id).is_some_and(|vehicle| vehicle.flight_parameters() == Some(parameters)));
        parameters.check().unwrap();
        for (name, number) in parameters.numbers() {
            assert!(number.source.len() >= 10, "{} {name}: {}", parameters.id, number.source);
            numbers += 1;
        }
    }
    assert!(flight_presets().len() >= 4 && numbers > 40 * 4);
    assert!(find_flight_parameters("arducopter").is_none());
}

/// R J/k r and (R B/k + k) r of the rotor's speed give what the authors' code has: 30.217 ms and 53.683 (rad/s)/V; and
/// 14.5 W in hover as the paper's remark 4 has it, full speed within 1 % of Parrot's 4800 rpm without being put in.
#[test]
fn the_ardrones_motor_is_the_authors_and_the_manufacturers() {
    let (resistance, inertia, viscous, k_m, k_b) = (0.6029, 0.1215, 3.74, 130.14, 1.3014e-3);
    let a_theirs: f64 = resistance * viscous / k_m + k_b;
    let time_constant_theirs_s = resistance * inertia / k_m / a_theirs;
    for (id, full_speed_tolerance) in [("ardrone", 0.003), ("ardrone2", 0.025)] {
        let flight = find_flight_parameters(id).unwrap();
        let motor = &flight.motor;
        let (r, k, big_r) = (motor.gear_ratio.value, motor.constant_v_s_rad.value, motor.resistance_ohm.value);
        let a = r * (big_r * motor.viscous_n_m_s.value / k + k);
        let c = r * big_r * motor.inertia_kg_m2.value / k;
        assert!((a / a_theirs - 1.0).abs() < 1e-7, "gain {}", 1.0 / a);
        assert!((c / a / time_constant_theirs_s - 1.0).abs() < 1e-7, "time constant {}", c / a);
        assert!((1e3 * c / a - 30.217).abs() < 5e-4 && (1.0 / a - 53.683).abs() < 5e-4);
        let b = big_r * flight.rotor.torque_constant_n_m_s2.value / (r * k);
        let speed = (flight.mass_kg.value * 9.8 / 4.0 / flight.rotor.thrust_constant_n_s2.value).sqrt();
        let volts = a * speed + b * speed * speed;
        let amperes = (volts - k * r * speed) / big_r;
        // k is given to four digits: ±0.5e-6 V s/rad is ±0.025 W.
        assert!((volts * amperes - 14.5).abs() < 0.05, "{id}: {} W", volts * amperes);
        let full_rpm = (-a + (a * a + 4.0 * b * 11.1).sqrt()) / (2.0 * b) * 30.0 / std::f64::consts::PI;
        assert!((full_rpm / 4800.0 - 1.0).abs() < full_speed_tolerance, "{id}: {full_rpm} rpm");
    }
}

#[test]
fn masses_and_gears_are_those_of_the_vehicles() {
    for parameters in flight_presets() {
        let vehicle = find_preset(parameters.id).unwrap();
        assert_eq!(vehicle.rotor_count.value, 4);
        if let Some(mass) = vehicle.mass_kg {
            assert_eq!(mass.value, parameters.mass_kg.value, "{}", parameters.id);
        }
        let ratio = vehicle.gear.map_or(1.0, |gear| gear.value.ratio());
        assert_eq!(ratio, parameters.motor.gear_ratio.value, "{}", parameters.id);
        if let Some(diameter) = vehicle.propeller_diameter_m {
            assert!((diameter.value / 2.0 - parameters.rotor.radius_m.value).abs() < 1e-6, "{}", parameters.id);
        }
    }
}

#[test]
fn a_number_that_cannot_be_is_named() {
    let mut parameters = find_flight_parameters("ardrone").unwrap().clone();
    parameters.drag_n_s_m.value = [0.0; 3];
    assert!(parameters.check().is_ok());
    parameters.motor.resistance_ohm.value = 0.0;
    assert_eq!(parameters.check().unwrap_err().name, "resistance_ohm");
    parameters.motor.resistance_ohm.value = f64::NAN;
    assert!(parameters.check().is_err());
}

#[test]
fn rotors_stand_opposite_and_turn_against_each_other() {
    for layout in [Layout::X, Layout::Plus] {
        let (hubs, spins) = (layout.hub_directions(), layout.spins());
        for k in 0..4 {
            let (hub, opposite) = (hubs[k], hubs[(k + 2) % 4]);
            assert_eq!(hub, opposite.map(|along| -along));
            assert!((hub[0].hypot(hub[1]) - 1.0).abs() < 1e-15);
            assert_eq!(spins[k], spins[(k + 2) % 4]);
        }
        assert_eq!(spins.iter().sum::<f64>(), 0.0);
    }
}
