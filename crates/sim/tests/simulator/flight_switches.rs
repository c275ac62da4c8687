//! What goes beyond the paper: each does what it says, and off it is not there to the last bit.

use hovertone_sim::control::{Command, Setpoint};
use hovertone_sim::environment::{Air, Gusts};
use hovertone_sim::rotor::ground_effect;
use hovertone_sim::{Flight, FlightSettings, FlightState, MotorWander, Payload, PilotedFlight, Spread, Start};
use hovertone_vehicle::find_flight_parameters;

fn settings() -> FlightSettings {
    FlightSettings::for_vehicle(find_flight_parameters("ardrone").unwrap().clone())
}

fn ten_seconds(settings: FlightSettings) -> Vec<FlightState> {
    let mut flight = Flight::new(settings).unwrap();
    let command = |k: u32| Command { roll: if k % 2000 < 1000 { 0.3 } else { -0.3 }, climb: 0.1, ..Command::HOVER };
    (0..10_000).map(|k| flight.step(&command(k))).collect()
}

fn hover(settings: FlightSettings, seconds: u32) -> Vec<FlightState> {
    let flight = Flight::new(settings).unwrap();
    let pilot = flight.pilot(Setpoint { position_m: [0.0, 0.0, 1.0], yaw_rad: 0.0 });
    PilotedFlight::new(flight, pilot).take(seconds as usize * 1000 + 1).collect()
}

/// A switch that is on with nothing in it is the same flight, to the last bit of every number, as with the switch off.
#[test]
fn switches_with_nothing_behind_them_change_no_bit() {
    let plain = ten_seconds(settings());
    let mut nothing = Vec::new();
    for index in 0..5 {
        let mut settings = settings();
        match index {
            0 => settings.spread = Some(Spread::default()),
            1 => settings.gusts = Some(Gusts { std_m_s: [0.0; 3], ..Gusts::low_altitude(2.0, 3.0) }),
            2 => settings.payloads.push(Payload { mass_kg: 0.0, position_m: [0.1, 0.1, 0.1] }),
            3 => settings.spread = Some(Spread::random(0.0, 0.0, 7)),
            _ => settings.seed = 12345,
        }
        nothing.push(ten_seconds(settings));
    }
    for states in &nothing {
        for (one, other) in states.iter().zip(&plain) {
            assert_eq!(one, other);
        }
    }
    assert_eq!(nothing.len(), 5);
    // Far from the ground its effect is exactly 1.
    let (mut high, mut high_with) = (settings(), settings());
    high.start = Start::Hover(Setpoint { position_m: [0.0, 0.0, 1e9], yaw_rad: 0.0 });
    high_with.start = high.start;
    high_with.ground_effect = true;
    assert_eq!(ten_seconds(high), ten_seconds(high_with));
}

#[test]
fn the_same_seed_gives_the_same_flight_and_another_seed_another() {
    let gusty = |seed: u64| {
        let mut settings = settings();
        settings.gusts = Some(Gusts::low_altitude(2.0, 3.0));
        settings.seed = seed;
        hover(settings, 2)
    };
    assert_eq!(gusty(4), gusty(4));
    assert_ne!(gusty(4), gusty(5));
}

#[test]
fn thinner_air_needs_faster_rotors_by_the_root_of_the_density() {
    let mut thin = settings();
    let air = Air { temperature_c: 22.0, pressure_hpa: 937.0, humidity_percent: 60.0 };
    thin.air = Some(air);
    let (plain, thin) = (Flight::new(settings()).unwrap(), Flight::new(thin).unwrap());
    let expected = (1.225 / air.density_kg_m3()).sqrt();
    let ratio = thin.trim().mean_speed_rad_s() / plain.trim().mean_speed_rad_s();
    assert!((ratio / expected - 1.0).abs() < 1e-12 && ratio > 1.05, "{ratio}");
    // The load torque scales alike, so at the same thrust it is the same torque.
    let (one, other) = (plain.state().torque_n_m[0], thin.state().torque_n_m[0]);
    assert!((one / other - 1.0).abs() < 1e-12);
}

#[test]
fn near_the_ground_the_same_thrust_takes_less_speed() {
    let low = |on: bool| {
        let mut settings = settings();
        settings.ground_effect = on;
        settings.start = Start::Hover(Setpoint { position_m: [0.0, 0.0, 0.2], yaw_rad: 0.0 });
        Flight::new(settings).unwrap()
    };
    let (with, without) = (low(true), low(false));
    let ratio = (without.trim().mean_speed_rad_s() / with.trim().mean_speed_rad_s()).powi(2);
    assert!((ratio / ground_effect(0.1, 0.2) - 1.0).abs() < 1e-12 && ratio > 1.015);
    let weight_n = 0.413 * 9.806_65;
    assert!((with.state().thrust_n.iter().sum::<f64>() / weight_n - 1.0).abs() < 1e-12);
}

/// Mean and standard deviation of many draws, within four of their own standard errors; Gaussians cut at three have
/// 0.9975 of the std.
#[test]
fn the_spread_is_as_wide_as_it_says() {
    let draws: Vec<f64> = (0..2000)
        .map(|seed| Spread::random(0.01, 0.02, seed))
        .flat_map(|spread| [spread.thrust_shares, spread.motor_gains.map(|gain| 1.0 + (gain - 1.0) / 2.0)].concat())
        .collect();
    let count = draws.len() as f64;
    let mean = draws.iter().sum::<f64>() / count;
    let std = (draws.iter().map(|draw| (draw - mean).powi(2)).sum::<f64>() / count).sqrt();
    assert!((mean - 1.0).abs() < 4.0 * 0.01 / count.sqrt(), "{mean}");
    assert!((std / 0.01 - 0.9975).abs() < 4.0 / (2.0 * count).sqrt(), "{std}");
}

/// A spread vehicle hovers trimmed: every balance holds with its own constants, and the sum of C_f,i ω_i² is the
/// weight.
#[test]
fn unlike_rotors_hover_at_unlike_speeds_and_in_balance() {
    let spread = Spread::random(0.01, 0.01, 11);
    assert!(spread.thrust_shares.iter().all(|share| (share - 1.0).abs() < 0.0301 && *share != 1.0));
    let mut settings = settings();
    settings.spread = Some(spread);
    let mut flight = Flight::new(settings).unwrap();
    let trim = *flight.trim();
    let by_hand: f64 = (0..4).map(|k| spread.thrust_shares[k] * 7.0775e-6 * trim.speed_rad_s[k].powi(2)).sum();
    assert!((by_hand / (0.413 * 9.806_65) - 1.0).abs() < 1e-12);
    let span = trim.speed_rad_s.iter().fold(f64::MIN, |a, b| a.max(*b))
        / trim.speed_rad_s.iter().fold(f64::MAX, |a, b| a.min(*b));
    assert!(span > 1.001 && span < 1.05, "{:?} {spread:?}", trim.speed_rad_s);
    let volts = trim.voltage_v;
    assert!((volts[0] / volts[1] - 1.0).abs() > 1e-4, "{volts:?}");
    let mut end = flight.state();
    for _ in 0..10_000 {
        end = flight.step(&Command::HOVER);
    }
    assert!(end.position_m[0].hypot(end.position_m[1]) < 1e-6 && (end.position_m[2] - 1.0).abs() < 1e-6, "{end:?}");
}

/// A mass on the front makes the front rotors work more by what the lever says: with arms at ±a, front over rear thrust
/// is (a + c)/(a - c) for a centre moved by c. It still hovers level and in place.
#[test]
fn a_mass_off_centre_is_carried_by_the_near_rotors() {
    let mut settings = settings();
    settings.payloads.push(Payload { mass_kg: 0.05, position_m: [0.08, 0.0, -0.03] });
    let mut flight = Flight::new(settings).unwrap();
    let (arm, shift) = (0.1785 / 2.0_f64.sqrt(), 0.05 * 0.08 / 0.463);
    let [front_left, rear_left, rear_right, front_right] = flight.trim().thrust_n;
    assert!((front_left / rear_left / ((arm + shift) / (arm - shift)) - 1.0).abs() < 1e-12);
    assert!((front_left - front_right).abs() < 1e-12 && (rear_left - rear_right).abs() < 1e-12);
    assert!(((front_left + rear_left) * 2.0 / (0.463 * 9.806_65) - 1.0).abs() < 1e-12);
    let end = (0..10_000).map(|_| flight.step(&Command::HOVER)).last().unwrap();
    assert!(end.position_m[0].hypot(end.position_m[1]) < 1e-6 && end.euler().pitch_rad.abs() < 1e-9, "{end:?}");
}

#[test]
fn a_sagging_battery_gives_charge_and_voltage_and_still_hovers() {
    let mut settings = settings();
    settings.battery_sag = true;
    let states = hover(settings, 60);
    let (early, late) = (states[10_000], *states.last().unwrap());
    // It starts in hover: four times 14.9 W (14.5 at the paper's gravity) from 12.2 V are 4.9 A, which cost 0.39 V of
    // 12.6 V.
    let amperes = (12.6 - states[0].battery_v) / 0.08;
    assert!((amperes * states[0].battery_v / 4.0 - 14.55).abs() < 0.1, "{amperes} A at {} V", states[0].battery_v);
    assert!((states[1].position_m[2] - 1.0).abs() < 1e-9 && (early.position_m[2] - 1.0).abs() < 1e-3, "{early:?}");
    // Constant power draws more current as the voltage falls: (1 - R P/V²) dV = dE.
    let fall_v = early.battery_v - late.battery_v;
    let open_v = 2.1 * amperes * 50.0 / 7200.0;
    let expected_v = open_v / (1.0 - 0.08 * amperes / early.battery_v);
    assert!((fall_v / expected_v - 1.0).abs() < 0.005, "{fall_v} V over 50 s, expected {expected_v}");
    assert!((late.position_m[2] - 1.0).abs() < 0.03, "{late:?}");
    let lift: f64 = late.thrust_n.iter().sum();
    assert!((lift / (0.413 * 9.806_65) - 1.0).abs() < 1e-3);
}

#[test]
fn in_a_steady_wind_the_pilot_leans_into_it_by_the_drag() {
    let mut settings = settings();
    settings.wind_m_s = [2.0, -1.0, 0.0];
    let end = *hover(settings, 60).last().unwrap();
    assert!(end.position_m[0].abs() < 0.05 && end.position_m[1].abs() < 0.05, "{end:?}");
    // Drag 0.2 N s/m: 0.4 N along x, -0.2 N along y, against 4.05 N of weight; nose into the wind is pitch back.
    let angles = end.euler();
    let (weight_n, drag) = (0.413 * 9.806_65, 0.2);
    assert!((angles.pitch_rad.tan() + drag * 2.0 / weight_n).abs() < 0.01, "{angles:?}");
    assert!((angles.roll_rad.tan() + drag * 1.0 / weight_n).abs() < 0.01, "{angles:?}");
}

#[test]
fn gusts_move_the_vehicle_and_its_rotors_and_the_pilot_holds_on() {
    let mut settings = settings();
    settings.wind_m_s = [2.0, 0.0, 0.0];
    settings.gusts = Some(Gusts { std_m_s: [0.3, 0.3, 0.15], length_m: [2.0; 3], airspeed_m_s: 2.0 });
    let states = hover(settings, 60);
    let late = &states[20_000..];
    let mean = |of: &dyn Fn(&FlightState) -> f64| late.iter().map(of).sum::<f64>() / late.len() as f64;
    let wind = |axis: usize| mean(&|state: &FlightState| (state.wind_m_s[axis] - [2.0, 0.0, 0.0][axis]).powi(2)).sqrt();
    assert!((0.1..0.5).contains(&wind(0)) && (0.1..0.5).contains(&wind(1)), "{} {}", wind(0), wind(1));
    let worst_m = late.iter().map(|s| s.position_m[0].hypot(s.position_m[1])).fold(0.0, f64::max);
    assert!((0.001..0.8).contains(&worst_m), "{worst_m} m");
    let speeds = mean(&|state: &FlightState| state.speed_rad_s[0]);
    let spread = mean(&|state: &FlightState| (state.speed_rad_s[0] / speeds - 1.0).powi(2)).sqrt();
    println!("gusts of 0.3 m/s: rotor 1 varies by {:.3} %, place by at most {worst_m:.2} m", 100.0 * spread);
    assert!(spread > 1e-4 && spread < 0.05, "{spread}");
}

/// A gain g in c ω' + a ω + b ω² = g v moves the speed by (a + b ω)/(a + 2 b ω) of its own share, behind the motor's lag τ: √(T/(T + τ)) of
/// its standard deviation, T being how long it lasts. The controller works against what turns the vehicle and not against the
/// rest; 120 s hold 150 times T, so each deviation is known to 6 %.
#[test]
fn motors_wander_each_for_itself_by_what_their_gains_do() {
    let (gain_std_share, time_constant_s) = (0.003, 0.4);
    let mut settings = settings();
    settings.motor_wander = Some(MotorWander { gain_std_share, time_constant_s });
    let states = hover(settings.clone(), 120);
    let flight = Flight::new(settings).unwrap();
    let (motor, speed_rad_s) = (flight.airframe().motors[0], flight.trim().speed_rad_s[0]);
    let load = motor.load_v_s2_rad2 * speed_rad_s;
    let lag_s = motor.linearised(speed_rad_s).time_constant_s;
    let free = gain_std_share * (motor.linear_v_s_rad + load) / (motor.linear_v_s_rad + 2.0 * load)
        * (time_constant_s / (time_constant_s + lag_s)).sqrt();
    let count = states.len() as f64;
    let shares = |rotor: usize| -> Vec<f64> {
        let mean = states.iter().map(|state| state.speed_rad_s[rotor]).sum::<f64>() / count;
        states.iter().map(|state| state.speed_rad_s[rotor] / mean - 1.0).collect()
    };
    let product = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>() / count;
    let wanders: Vec<Vec<f64>> = (0..4).map(shares).collect();
    for rotor in 0..4 {
        let std = product(&wanders[rotor], &wanders[rotor]).sqrt();
        println!("rotor {}: {:.3} %, free of the controller {:.3} %", rotor + 1, 100.0 * std, 100.0 * free);
        assert!((0.6..1.3).contains(&(std / free)), "{std} {free}");
        let next = (rotor + 1) % 4;
        let correlation =
            product(&wanders[rotor], &wanders[next]) / (std * product(&wanders[next], &wanders[next]).sqrt());
        assert!(correlation.abs() < 0.7, "{correlation}");
    }
}
