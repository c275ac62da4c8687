use super::*;
use crate::rk4::rk4;
use hovertone_vehicle::{FlightParameters, find_flight_parameters, flight_presets};

fn motor_of(flight: &FlightParameters) -> Motor {
    Motor::new(&flight.motor, flight.rotor.torque_constant_n_m_s2.value, 1.0)
}

fn ardrone() -> Motor {
    motor_of(find_flight_parameters("ardrone").unwrap())
}

/// The textbook form of the same solution, with the roots of the quadratic written out: tanh from below, coth from
/// above.
fn riccati_rad_s(motor: &Motor, start_rad_s: f64, voltage_v: f64, time_s: f64) -> f64 {
    let (a, b, c) = (motor.linear_v_s_rad, motor.load_v_s2_rad2, motor.inertia_v_s2_rad);
    let d = (a * a + 4.0 * b * voltage_v).sqrt();
    let y = (2.0 * b * start_rad_s + a) / d;
    let x = d * time_s / (2.0 * c);
    let end = if y < 1.0 { (x + y.atanh()).tanh() } else { 1.0 / (x + (1.0 / y).atanh()).tanh() };
    (d * end - a) / (2.0 * b)
}

#[test]
fn steps_at_one_millisecond_follow_the_riccati_solution() {
    let (mut worst, mut worst_closed, mut compared) = (0.0_f64, 0.0_f64, 0);
    for flight in flight_presets() {
        let motor = motor_of(flight);
        let full_v = flight.battery.voltage_v.value;
        for (from, to) in [(0.0, 1.0), (0.3, 0.9), (0.9, 0.4), (0.7, 0.75), (0.72, 0.7), (1.0, 0.1)] {
            let start = motor.steady_speed_rad_s(from * full_v);
            let mut state = [start];
            for step in 1..=300 {
                state = rk4(&state, 0.001, |&[speed]| [motor.acceleration_rad_s2(speed, to * full_v)]);
                let exact = riccati_rad_s(&motor, start, to * full_v, f64::from(step) * 0.001);
                let closed = motor.speed_after(start, to * full_v, f64::from(step) * 0.001);
                worst = worst.max((state[0] / exact - 1.0).abs());
                worst_closed = worst_closed.max((closed / exact - 1.0).abs());
                compared += 1;
            }
        }
    }
    println!("motor against the Riccati solution: worst {worst:.1e} (RK4), {worst_closed:.1e} (closed form)");
    assert!(compared == 4 * 6 * 300);
    assert!(worst < 1e-6, "RK4 off by {worst}");
    assert!(worst_closed < 1e-11, "closed form off by {worst_closed}");
}

/// For steps below 0.3 % of the speed, the linear form neglects only the square of the step: b Δω²/(a + 2 b ω) at most.
#[test]
fn small_steps_follow_the_linearised_form() {
    let motor = ardrone();
    let hover_rad_s = 378.07;
    let hover_v = motor.steady_voltage_v(hover_rad_s);
    let response = motor.linearised(hover_rad_s);
    for share in [0.003, 0.001, -0.003] {
        let step_v = share * hover_rad_s / response.gain_rad_s_v;
        let step_rad_s = response.gain_rad_s_v * step_v;
        let slope = motor.inertia_v_s2_rad / response.time_constant_s;
        let left_out_rad_s = motor.load_v_s2_rad2 * step_rad_s.powi(2) / slope;
        for time_s in [0.001, 0.01, 0.0235, 0.05, 0.1, 1.0] {
            let exact = motor.speed_after(hover_rad_s, hover_v + step_v, time_s);
            let linear = hover_rad_s - step_rad_s * (-time_s / response.time_constant_s).exp_m1();
            assert!((exact - linear).abs() <= 1.01 * left_out_rad_s, "{share} {time_s}: {}", exact - linear);
            assert!((exact / linear - 1.0).abs() < 1e-6);
        }
    }
    assert!((response.time_constant_s - 0.0235).abs() < 1e-4 && (response.gain_rad_s_v - 41.83).abs() < 0.05);
}

/// A load of 14.5 W at the paper's hover; all electrical power is copper loss, viscous loss and shaft power.
#[test]
fn power_is_accounted_for() {
    let flight = find_flight_parameters("ardrone").unwrap();
    let (motor, speed) = (ardrone(), 378.07);
    let volts = motor.steady_voltage_v(speed);
    let amperes = motor.current_a(speed, volts);
    let shaft_w = flight.rotor.torque_constant_n_m_s2.value * speed.powi(3);
    let viscous_w = flight.motor.viscous_n_m_s.value * (speed * flight.motor.gear_ratio.value).powi(2);
    let copper_w = flight.motor.resistance_ohm.value * amperes * amperes;
    assert!((volts * amperes - shaft_w - viscous_w - copper_w).abs() < 1e-9);
    assert!((volts * amperes - 14.5).abs() < 0.05, "{} W", volts * amperes);
}

#[test]
fn steady_speed_and_voltage_are_each_others_inverse_with_and_without_load() {
    let mut motor = ardrone();
    motor.gain = 1.03;
    for load in [motor.load_v_s2_rad2, 0.0] {
        motor.load_v_s2_rad2 = load;
        for volts in [0.5, 4.0, 8.0, 11.1] {
            let speed = motor.steady_speed_rad_s(volts);
            assert!((motor.steady_voltage_v(speed) / volts - 1.0).abs() < 1e-13);
            assert!(motor.acceleration_rad_s2(speed, volts).abs() < 1e-8);
            assert!((motor.speed_after(100.0, volts, 10.0) / speed - 1.0).abs() < 1e-12);
            assert!((motor.speed_after(100.0, volts, 0.0) - 100.0).abs() < 1e-11);
        }
    }
}
