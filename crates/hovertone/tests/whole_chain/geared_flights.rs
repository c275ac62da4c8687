//! Flights of a vehicle whose rotors turn behind a gear, and bob.

use hovertone::sound::Signal;
use hovertone::speed::{Config, Method, Outcome, ToneConfig, speed_from_source};
use hovertone_sim::paper::LOADS;
use hovertone_sim::scenario::{ScenarioFile, ScenarioRun, SpreadSection};
use hovertone_vehicle::Order;
use std::collections::BTreeMap;

#[test]
fn a_flight_whose_rotors_are_a_percent_apart_is_heard_through_the_gear() {
    // the motion of the vehicle smears the lines of the mesh into one another: none of them stands out of the noise by itself
    let load = &LOADS[0];
    for trial in [0, 2] {
        let mut file = ScenarioFile::paper_trial(load, trial, 1);
        let thrust_shares = [-1.5, -0.5, 1.5, 0.5].map(|place: f64| (1.0 + 0.01 * place).powi(-2));
        file.spread = Some(SpreadSection { thrust_shares: Some(thrust_shares), ..SpreadSection::default() });
        let scenario = file.resolve(&BTreeMap::new()).unwrap();
        let sample_rate_hz = f64::from(scenario.sound.sample_rate_hz);
        let mut run = ScenarioRun::new(scenario).unwrap();
        let (mut channels, mut states) = (Vec::new(), Vec::new());
        while run.advance(&mut channels, &mut states).unwrap() {}
        let truth = run.finish(&mut channels).flight.mean_sum_of_squares_rad2_s2 / 4.0;
        let mut tone = ToneConfig::of_order(Order::new(69.0).unwrap());
        tone.blades = Some(2);
        let mut config = Config::for_tone(tone);
        config.rotors.count = 4;
        config.method = Method::Separated;
        let mut signal = Signal::new(channels.swap_remove(0), sample_rate_hz);
        let analysis = speed_from_source(&mut signal, &config, &mut |_| {}).unwrap();
        let Outcome::Ok(tone) = &analysis.outcome else { panic!("{trial}: {:?}", analysis.outcome) };
        let square = tone.speed(Method::Separated).unwrap().mean_square_rad2_s2.unwrap();
        assert!((square / truth - 1.0).abs() < 0.002, "{trial}: {square} {truth}");
    }
}
