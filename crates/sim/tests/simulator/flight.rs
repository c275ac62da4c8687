//! The whole flight model against what can be worked out by hand.

use hovertone_sim::body::{BodyState, Euler};
use hovertone_sim::control::{Command, Setpoint};
use hovertone_sim::{Flight, FlightSettings, FlightState, Payload, PilotedFlight, Start, paper};
use hovertone_vehicle::{Layout, find_flight_parameters, flight_presets};

fn settings(id: &str) -> FlightSettings {
    FlightSettings::for_vehicle(find_flight_parameters(id).unwrap().clone())
}

fn flight(settings: FlightSettings) -> Flight {
    Flight::new(settings).unwrap()
}

fn at(x: f64, y: f64, z: f64, yaw_rad: f64) -> Setpoint {
    Setpoint { position_m: [x, y, z], yaw_rad }
}

fn after(flight: &mut Flight, command: Command, seconds: f64) -> FlightState {
    let count = (seconds / flight.settings().step_s).round() as u32;
    (0..count).map(|_| flight.step(&command)).last().unwrap()
}

#[test]
fn hover_is_found_and_held_for_ten_seconds() {
    for parameters in flight_presets() {
        let mut flight = flight(settings(parameters.id));
        let weight_n = parameters.mass_kg.value * 9.806_65;
        let expected_rad_s = (weight_n / 4.0 / parameters.rotor.thrust_constant_n_s2.value).sqrt();
        let mut seen = 0;
        for _ in 0..10_000 {
            let state = flight.step(&Command::HOVER);
            assert!((state.thrust_n.iter().sum::<f64>() / weight_n - 1.0).abs() < 1e-9, "{}: {state:?}", parameters.id);
            for speed in state.speed_rad_s {
                assert!((speed / expected_rad_s - 1.0).abs() < 1e-9);
            }
            seen += 1;
        }
        let end = flight.state();
        assert!((end.position_m[2] - 1.0).abs() < 1e-9 && end.position_m[0].hypot(end.position_m[1]) < 1e-9, "{end:?}");
        assert!(end.euler().yaw_rad.abs() < 1e-9 && seen == 10_000 && end.time_s == 10.0);
    }
}

/// 413, 444 and 462 g on 2.831e-5 N s² of the whole vehicle give the speeds of the paper's table 1 within 0.2 %,
/// heavier ones by changing the mass or by hanging the hull under the vehicle.
#[test]
fn the_papers_speeds_come_back_from_its_loads() {
    let mut compared = 0;
    for load in &paper::LOADS {
        let (mut heavier, mut hung) = (settings("ardrone"), settings("ardrone"));
        heavier.gravity_m_s2 = paper::GRAVITY_M_S2;
        hung.gravity_m_s2 = paper::GRAVITY_M_S2;
        heavier.vehicle.mass_kg.value = load.mass_kg;
        hung.payloads.push(Payload { mass_kg: load.mass_kg - 0.413, position_m: [0.0, 0.0, -0.01] });
        for settings in [heavier, hung] {
            let mut flight = flight(settings);
            let exact = (load.mass_kg * 9.8 / 2.831e-5).sqrt();
            assert!((flight.trim().mean_speed_rad_s() / exact - 1.0).abs() < 1e-12);
            let flown: f64 =
                (0..2000).map(|_| flight.step(&Command::HOVER).speed_rad_s.iter().sum::<f64>() / 4.0).sum();
            let ratio = flown / 2000.0 / load.speed().rad_s();
            println!("{}: {:.4} rad/s, {:+.3} % of the paper's", load.name, flown / 2000.0, 100.0 * (ratio - 1.0));
            assert!((ratio - 1.0).abs() < 0.002, "{}: {ratio}", load.name);
            compared += 1;
        }
    }
    assert_eq!(compared, 6);
}

#[test]
fn commands_go_the_right_way_and_to_their_size() {
    for (id, layout) in
        [("ardrone", Layout::X), ("ardrone", Layout::Plus), ("crazyflie", Layout::X), ("f450", Layout::X)]
    {
        let of = |command: Command, seconds: f64| {
            let mut settings = settings(id);
            settings.vehicle.layout.value = layout;
            settings.start = Start::Hover(at(0.0, 0.0, 20.0, 0.0));
            after(&mut flight(settings), command, seconds)
        };
        let controller = &find_flight_parameters(id).unwrap().controller;
        let (tilt, climb) = (controller.tilt_rad_max.value, controller.climb_m_s_max.value);
        let right = of(Command { roll: 0.5, ..Command::HOVER }, 6.0);
        assert!((right.euler().roll_rad / (0.5 * tilt) - 1.0).abs() < 0.02, "{id}: {:?}", right.euler());
        assert!(right.position_m[1] < -1.0 && right.position_m[0].abs() < 0.1 * right.position_m[1].abs(), "{id}");
        let forward = of(Command { pitch: 0.5, ..Command::HOVER }, 6.0);
        assert!((forward.euler().pitch_rad / (0.5 * tilt) - 1.0).abs() < 0.02, "{id}: {:?}", forward.euler());
        assert!(forward.position_m[0] > 1.0 && forward.position_m[1].abs() < 0.1 * forward.position_m[0], "{id}");
        let left = of(Command { yaw_rate: 0.2, ..Command::HOVER }, 8.0);
        let wanted = 0.2 * controller.yaw_rate_rad_s_max.value;
        assert!((left.rates_rad_s[2] / wanted - 1.0).abs() < 0.02, "{id}: {:?}", left.rates_rad_s);
        assert!(left.position_m[0].hypot(left.position_m[1]) < 1e-3, "{id}");
        // A proportional loop against linear drag: k_p e = volts that carry the drag.
        let up = of(Command { climb: 0.5, ..Command::HOVER }, 6.0);
        assert!((up.velocity_m_s[2] / (0.5 * climb) - 1.0).abs() < 0.1, "{id}: {:?}", up.velocity_m_s);
        assert!(up.position_m[2] > 20.5 && up.rates_rad_s.iter().all(|rate| rate.abs() < 1e-6), "{id}");
    }
}

/// From one second of a roll, climb and yaw, at steps of 16, 8 and 4 ms against one of 0.25 ms, the controller running
/// every 16 ms in all of them: the error falls with the fourth power.
#[test]
fn the_error_of_the_flight_goes_with_the_fourth_power_of_the_step() {
    let end = |step_s: f64| {
        let mut settings = settings("ardrone");
        settings.vehicle.controller.period_s.value = 0.016;
        settings.step_s = step_s;
        settings.gusts = None;
        settings.ground_effect = true;
        settings.battery_sag = true;
        let command = Command { roll: 0.8, pitch: -0.3, yaw_rate: 0.5, climb: 0.4 };
        after(&mut flight(settings), command, 0.96)
    };
    let reference = end(0.000_25);
    let error = |step_s: f64| -> f64 {
        let state = end(step_s);
        let of = |state: &FlightState| [state.position_m, state.velocity_m_s, state.rates_rad_s].concat();
        let pairs = of(&state).into_iter().zip(of(&reference));
        let speeds = state.speed_rad_s.into_iter().zip(reference.speed_rad_s);
        pairs.map(|(a, b)| (a - b).powi(2)).sum::<f64>().sqrt()
            + speeds.map(|(a, b)| ((a - b) / 378.0).powi(2)).sum::<f64>().sqrt()
    };
    let (coarse, middle, fine) = (error(0.016), error(0.008), error(0.004));
    println!("errors at 16, 8, 4 ms: {coarse:.2e} {middle:.2e} {fine:.2e}; 1 ms: {:.2e}", error(0.001));
    for order in [(coarse / middle).log2(), (middle / fine).log2()] {
        assert!((order - 4.0).abs() < 0.3, "order {order}");
    }
}

/// With no load, no drag and no levers (thrusts then act at the centre), spinning the rotors up and down turns the body
/// the other way: body and rotors together keep their angular momentum in the world, while the body tumbles.
#[test]
fn what_the_rotors_gain_the_body_loses() {
    let mut settings = settings("ardrone");
    settings.vehicle.drag_n_s_m.value = [0.0; 3];
    settings.vehicle.rotor.torque_constant_n_m_s2.value = 0.0;
    settings.vehicle.arm_length_m.value = 1e-12;
    settings.start = Start::Hover(at(0.0, 0.0, 500.0, 0.0));
    let mut flight = flight(settings);
    let mut start = flight.body();
    start.rates_rad_s = [3.0, -2.0, 1.0].into();
    flight.place_body(&start);
    let momentum = |flight: &Flight| {
        let (body, speeds, airframe) = (flight.body(), flight.state().speed_rad_s, flight.airframe());
        let mut within = airframe.body.inertia_kg_m2() * body.rates_rad_s;
        within.z += airframe.hubs.iter().zip(speeds).map(|(hub, w)| hub.spin * hub.momentum_kg_m2 * w).sum::<f64>();
        body.to_world(&within)
    };
    let (before, mut most_change) = (momentum(&flight), 0.0_f64);
    for k in 0..2000 {
        flight.step(&Command { yaw_rate: if k < 1000 { 1.0 } else { -1.0 }, ..Command::HOVER });
        most_change = most_change.max((flight.body().rates_rad_s - start.rates_rad_s).norm());
        assert!((momentum(&flight) - before).norm() / before.norm() < 1e-8);
    }
    assert!(most_change > 0.5, "{most_change}");
}

#[test]
fn energy_of_a_fall_with_braked_motors_is_height_less_drag() {
    let mut settings = settings("ardrone");
    settings.start = Start::Hover(at(0.0, 0.0, 60.0, 0.0));
    settings.vehicle.rotor.thrust_constant_n_s2.value = 1e-5;
    let mut flight = flight(settings);
    flight.switch_motors(false);
    after(&mut flight, Command::HOVER, 1.0);
    // Rotors stand still now: free fall against drag, from the speed it has, v' = -g - (k/m) v.
    let (start, mass, drag) = (flight.state(), 0.413, 0.2);
    assert!(start.speed_rad_s.iter().all(|speed| *speed < 1e-6), "{:?}", start.speed_rad_s);
    let (end_m_s, constant_s) = (mass * 9.806_65 / drag, mass / drag);
    let end = after(&mut flight, Command::HOVER, 1.0);
    let expected = -end_m_s + (start.velocity_m_s[2] + end_m_s) * (-1.0 / constant_s).exp();
    assert!((end.velocity_m_s[2] - expected).abs() < 1e-9, "{} {expected}", end.velocity_m_s[2]);
}

#[test]
fn it_stands_takes_off_holds_its_place_and_lands() {
    for parameters in flight_presets() {
        let mut settings = settings(parameters.id);
        settings.start = Start::Ground { place_m: [0.5, -0.5], yaw_rad: 1.0 };
        let flight = flight(settings);
        let standing = flight.state();
        let pilot = flight.pilot(at(0.5, -0.5, 1.0, 1.0));
        let mut piloted = PilotedFlight::new(flight, pilot);
        let still = piloted.by_ref().take(1001).last().unwrap();
        assert_eq!(still.time_s, 1.0);
        assert!((still.position_m[2] - standing.position_m[2]).abs() < 1e-9, "{}: {still:?}", parameters.id);
        assert!(still.voltage_v == [0.0; 4] && still.speed_rad_s == [0.0; 4]);
        piloted.flight_mut().switch_motors(true);
        let up = piloted.by_ref().take(15_000).last().unwrap();
        assert!((up.position_m[2] - 1.0).abs() < 0.02, "{}: {up:?}", parameters.id);
        assert!((up.position_m[0] - 0.5).hypot(up.position_m[1] + 0.5) < 0.02, "{}: {up:?}", parameters.id);
        assert!((up.euler().yaw_rad - 1.0).abs() < 0.02, "{}: {:?}", parameters.id, up.euler());
        piloted.pilot_mut().fly_to(at(0.5, -0.5, 0.0, 1.0));
        let low = piloted.by_ref().take(4_000).last().unwrap();
        assert!(low.position_m[2] < 2.5 * parameters.standing_height_m.value, "{}: {low:?}", parameters.id);
        piloted.flight_mut().switch_motors(false);
        let down = piloted.by_ref().take(3_000).last().unwrap();
        assert!((down.position_m[2] - standing.position_m[2]).abs() < 1e-4, "{}: {down:?}", parameters.id);
        assert!(down.speed_rad_s.iter().all(|speed| *speed < 1e-3) && down.velocity_m_s[2].abs() < 1e-4);
        assert!(down.attitude.iter().map(|part| part * part).sum::<f64>() - 1.0 < 1e-12);
    }
}

#[test]
fn a_pilot_flies_a_square_and_turns() {
    for parameters in flight_presets() {
        let flight = flight(settings(parameters.id));
        let pilot = flight.pilot(at(0.0, 0.0, 1.0, 0.0));
        let mut piloted = PilotedFlight::new(flight, pilot);
        for (x, y, yaw) in [(1.0, 0.0, 0.0), (1.0, 1.0, 1.5), (0.0, 1.0, 3.0), (0.0, 0.0, -2.0)] {
            piloted.pilot_mut().fly_to(at(x, y, 1.2, yaw));
            let there = piloted.by_ref().take(20_000).last().unwrap();
            let off_m = (there.position_m[0] - x).hypot(there.position_m[1] - y);
            assert!(off_m < 0.05 && (there.position_m[2] - 1.2).abs() < 0.02, "{}: {off_m} m {there:?}", parameters.id);
            let turn = Euler { yaw_rad: there.euler().yaw_rad - yaw, ..there.euler() };
            assert!(turn.yaw_rad.sin().abs() < 0.05 && turn.yaw_rad.cos() > 0.9, "{}: {turn:?}", parameters.id);
        }
    }
}

#[test]
fn hubs_are_where_the_attitude_puts_them() {
    let mut flight = flight(settings("ardrone"));
    let mut body = BodyState::at_rest([1.0, 2.0, 3.0]);
    body.attitude = Euler { roll_rad: 0.0, pitch_rad: 0.0, yaw_rad: std::f64::consts::FRAC_PI_2 }.attitude();
    body.rates_rad_s.z = 2.0;
    body.velocity_m_s.x = 1.0;
    flight.place_body(&body);
    let (state, lever) = (flight.state(), 0.1785 / 2.0_f64.sqrt());
    let front_left = state.rotor_positions_m()[0];
    for (found, expected) in front_left.into_iter().zip([1.0 - lever, 2.0 + lever, 3.0]) {
        assert!((found - expected).abs() < 1e-12, "{front_left:?}");
    }
    assert_eq!(state.thrust_axis(), [0.0, 0.0, 1.0]);
    let velocity = state.rotor_velocities_m_s()[0];
    assert!((velocity[0] - (1.0 - 2.0 * lever)).abs() < 1e-12 && (velocity[1] + 2.0 * lever).abs() < 1e-12);
}

#[test]
fn what_cannot_fly_is_refused_by_name() {
    let refused = |change: fn(&mut FlightSettings)| {
        let mut settings = settings("ardrone");
        change(&mut settings);
        Flight::new(settings).unwrap_err().name
    };
    assert_eq!(refused(|s| s.vehicle.mass_kg.value = 2.0), "hover voltage");
    assert_eq!(refused(|s| s.vehicle.mass_kg.value = -1.0), "mass_kg");
    assert_eq!(refused(|s| s.step_s = 0.003), "step_s");
    assert_eq!(refused(|s| s.gravity_m_s2 = 0.0), "gravity_m_s2");
    let far = |s: &mut FlightSettings| s.payloads.push(Payload { mass_kg: 0.2, position_m: [-0.6, 0.0, 0.0] });
    assert_eq!(refused(far), "squared hover speed");
    assert_eq!(refused(|s| s.wind_m_s = [f64::NAN, 0.0, 0.0]), "wind_m_s");
    assert_eq!(refused(|s| s.start = Start::Hover(at(0.0, 0.0, 0.01, 0.0))), "start height");
}
