//! How fast the flight is, and that it keeps nothing: `cargo test --release -p hovertone-sim --test simulator flight_speed --
//! --ignored --nocapture`.

use hovertone_sim::control::Setpoint;
use hovertone_sim::environment::{Air, Gusts};
use hovertone_sim::{Flight, FlightSettings, PilotedFlight, Spread};
use hovertone_vehicle::find_flight_parameters;
use std::time::Instant;

#[test]
#[ignore = "a measurement, of optimised code on a quiet machine"]
fn the_flight_is_two_thousand_times_real_time() {
    let plain = FlightSettings::for_vehicle(find_flight_parameters("ardrone").unwrap().clone());
    let mut full = plain.clone();
    full.battery_sag = true;
    full.ground_effect = true;
    full.air = Some(Air::STANDARD);
    full.gusts = Some(Gusts::low_altitude(1.0, 1.0));
    full.spread = Some(Spread::random(0.01, 0.01, 1));
    for (name, settings, least) in [("paper", plain, 2000.0), ("everything on", full, 500.0)] {
        let flight = Flight::new(settings).unwrap();
        let pilot = flight.pilot(Setpoint { position_m: [0.0, 0.0, 1.0], yaw_rad: 0.0 });
        let (seconds, start) = (600.0, Instant::now());
        let end = PilotedFlight::new(flight, pilot).take(600_001).last().unwrap();
        let times = seconds / start.elapsed().as_secs_f64();
        println!("{name}: {times:.0} times real time");
        assert!(end.time_s == seconds && times > least, "{name}: {times}");
    }
}
