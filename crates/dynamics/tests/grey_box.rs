//! The grey box on simulated flights whose gains are known.

#![allow(clippy::unwrap_used, clippy::panic)] // what tests share has no attribute by which the lints know it

use hovertone_dynamics::{
    ControlKnowns, ControlLog, GreyBoxConfig, GreyBoxFit, GreyBoxModel, GreyBoxStop, LineOrders, LoopInputs, Parameter,
    SoundConfig, TorqueConstant, YawInertia, advice_of, checked, grey_box_from_sound, grey_box_from_speeds,
    lines_from_passes, observations_of_rows, torque_constant,
};
use hovertone_signal::Signal;
use hovertone_signal::passes::Passes;
use hovertone_sim::FlightState;
use hovertone_sim::scenario::{
    ControllerSection, DoubletAmounts, GainsSection, ScenarioFile, ScenarioRun, SpreadSection,
};
use hovertone_vehicle::{Axis, FlightParameters, LoopGains, find_flight_parameters, find_preset};
use std::collections::BTreeMap;
use std::f64::consts::TAU;

const GRAVITY_M_S2: f64 = 9.806_65;
/// True gains over those of the preset, at which the fits start.
const FACTORS: [f64; 4] = [1.3, 0.75, 1.25, 0.8];

struct Flown {
    log: ControlLog,
    inputs: LoopInputs,
    speeds: [Vec<f64>; 4],
    truth: GreyBoxModel,
    vehicle: FlightParameters,
    sound: Signal,
}

/// Doublets of a vehicle whose gains are not those of its preset.
fn doublets(preset: &str, seed: u64, duration_s: f64) -> ScenarioFile {
    let of = &find_flight_parameters(preset).unwrap().controller;
    let scaled = |gains: LoopGains, factor: f64| {
        let LoopGains { proportional, derivative, limit_v } = gains;
        Some(GainsSection { proportional: factor * proportional, derivative: factor * derivative, limit_v })
    };
    let controller = ControllerSection {
        roll: scaled(of.roll.value, FACTORS[0]),
        pitch: scaled(of.pitch.value, FACTORS[1]),
        yaw_rate: scaled(of.yaw_rate.value, FACTORS[2]),
        climb: scaled(of.climb.value, FACTORS[3]),
        ..ControllerSection::default()
    };
    let scenario = ScenarioFile::doublets(preset, seed, duration_s, DoubletAmounts::default());
    ScenarioFile { controller: Some(controller), ..scenario }
}

fn flown(scenario: &ScenarioFile, has_sound: bool) -> Flown {
    let resolved = scenario.resolve(&BTreeMap::new()).unwrap();
    let mut run = if has_sound { ScenarioRun::new(resolved) } else { ScenarioRun::silent(resolved) }.unwrap();
    let vehicle = run.scenario().flight.vehicle.clone();
    let rate_hz = f64::from(run.scenario().sound.sample_rate_hz);
    let (mut channels, mut rows): (Vec<Vec<f32>>, Vec<FlightState>) = (Vec::new(), Vec::new());
    while run.advance(&mut channels, &mut rows).unwrap() {}
    run.finish(&mut channels);
    let column = |of: &dyn Fn(&FlightState) -> f64| rows.iter().map(of).collect::<Vec<f64>>();
    let rate = |axis: usize| column(&|row| row.euler().rates(&row.rates_rad_s.into())[axis]);
    let log = ControlLog {
        time_s: column(&|row| row.time_s),
        command: std::array::from_fn(|axis| Some(column(&|row| row.command.to_array()[axis]))),
        measured: [
            Some(column(&|row| row.euler().roll_rad)),
            Some(column(&|row| row.euler().pitch_rad)),
            Some(rate(2)),
            Some(column(&|row| row.velocity_m_s[2])),
        ],
        tilt_rate_rad_s: [Some(rate(0)), Some(rate(1))],
    };
    let mut truth = GreyBoxModel::of(&vehicle, vehicle.mass_kg.value, GRAVITY_M_S2);
    let speeds: [Vec<f64>; 4] = std::array::from_fn(|rotor| column(&|row| row.speed_rad_s[rotor]));
    truth.hover_rad_s = std::array::from_fn(|rotor| speeds[rotor][0]);
    Flown {
        inputs: LoopInputs::from_log(&log, &ControlKnowns::of(&vehicle)).unwrap(),
        sound: Signal::new(channels.into_iter().next().unwrap_or_default(), rate_hz),
        log,
        speeds,
        truth,
        vehicle,
    }
}

fn start_of(preset: &str) -> GreyBoxModel {
    let vehicle = find_flight_parameters(preset).unwrap();
    GreyBoxModel::of(vehicle, vehicle.mass_kg.value, GRAVITY_M_S2)
}

fn fitted(flown: &Flown, preset: &str) -> GreyBoxFit {
    let speeds = std::array::from_fn(|rotor| flown.speeds[rotor].as_slice());
    let observations = observations_of_rows(&flown.log.time_s, speeds, 0.1);
    grey_box_from_speeds(&observations, &flown.inputs, &start_of(preset), &GreyBoxConfig::default()).unwrap()
}

fn gains_are_within(fit: &GreyBoxFit, truth: &GreyBoxModel, share: f64) {
    for axis in Axis::ALL {
        let found = fit.estimate(Parameter::Proportional(axis)).unwrap();
        let off = found.value / truth.loops[axis as usize].proportional - 1.0;
        assert!(off.abs() < share, "{axis:?} {off}");
    }
}

#[test]
fn logged_speeds_tell_gains_that_are_not_the_presets() {
    for preset in ["ardrone", "f450"] {
        let flown = flown(&doublets(preset, 1, 30.0), false);
        let fit = fitted(&flown, preset);
        gains_are_within(&fit, &flown.truth, 0.015);
        let time_constant = fit.estimate(Parameter::TimeConstant).unwrap().value;
        assert!((time_constant / flown.truth.time_constant_s - 1.0).abs() < 0.03, "{preset} {time_constant}");
        assert_eq!(fit.information.rank, fit.information.parameters);
        // another flight, which was not used
        let mut other = doublets(preset, 2, 10.0);
        other.maneuvers.reverse();
        let other = self::flown(&other, false);
        let speeds = std::array::from_fn(|rotor| other.speeds[rotor].as_slice());
        let observations = observations_of_rows(&other.log.time_s, speeds, 0.1);
        let check = checked(&observations, &fit.prediction(&other.inputs)).unwrap();
        assert!(check.rms_share < 0.001 && check.change_share > 0.01, "{preset} {check:?}");
    }
}

#[test]
fn a_yaw_manoeuvre_tells_the_torque_constant_and_a_hover_does_not() {
    let flown = flown(&doublets("ardrone", 1, 30.0), false);
    let fit = fitted(&flown, "ardrone");
    let body = YawInertia::of(&flown.vehicle);
    let TorqueConstant::Told(told) = torque_constant(&flown.log, &flown.inputs, &fit, &body) else { panic!() };
    let truth = flown.vehicle.rotor.torque_constant_n_m_s2.value;
    assert!((told.value / truth - 1.0).abs() < 0.03, "{told:?} {truth}");
    let mut still = flown.log.clone();
    still.measured[2] = Some(vec![0.0; still.time_s.len()]);
    let told = torque_constant(&still, &flown.inputs, &fit, &body);
    assert!(told.reason().unwrap().contains("yaw doublets"), "{told:?}");
}

#[test]
fn what_a_flight_does_not_tell_is_said() {
    let mut flown = flown(&doublets("ardrone", 1, 30.0), false);
    let zeros = || Some(vec![0.0; flown.log.time_s.len()]);
    (flown.log.command[1], flown.log.measured[1], flown.log.tilt_rate_rad_s[1]) = (zeros(), zeros(), zeros());
    flown.inputs = LoopInputs::from_log(&flown.log, &ControlKnowns::of(&flown.vehicle)).unwrap();
    let fit = fitted(&flown, "ardrone");
    assert!(fit.estimate(Parameter::Proportional(Axis::Pitch)).is_none());
    let kept = fit.model.loops[Axis::Pitch as usize].proportional;
    assert!((kept / start_of("ardrone").loops[Axis::Pitch as usize].proportional - 1.0).abs() < 1e-12);
    let advice = advice_of(&fit, &flown.inputs);
    assert!(advice.iter().any(|advice| advice.hint.contains("pitch doublets")), "{advice:?}");
    // a loop whose angle is not logged
    flown.log.measured[0] = None;
    flown.inputs = LoopInputs::from_log(&flown.log, &ControlKnowns::of(&flown.vehicle)).unwrap();
    let advice = advice_of(&fitted(&flown, "ardrone"), &flown.inputs);
    assert!(
        advice.iter().any(|advice| advice.what.starts_with("the model leaves out the control of roll")),
        "{advice:?}"
    );
    flown.log.measured = Default::default();
    let empty = LoopInputs::from_log(&flown.log, &ControlKnowns::of(&flown.vehicle)).unwrap();
    let none = grey_box_from_speeds(&[], &empty, &start_of("ardrone"), &GreyBoxConfig::default());
    assert_eq!(none.unwrap_err(), GreyBoxStop::NoLoop);
}

/// The rotors are too near to each other for any hover to separate them; along the prediction they are heard.
#[test]
fn heard_speeds_tell_the_gains() {
    let mut scenario = doublets("f450", 2, 24.0);
    scenario.spread = Some(SpreadSection { thrust_std_share: 0.005, ..SpreadSection::default() });
    let mut flown = flown(&scenario, true);
    let start = start_of("f450");
    let hover = start.mean_hover_rad_s() / TAU;
    let mut quiet = |_| {};
    let mut passes = Passes::planned(&mut flown.sound, 1, &mut quiet).unwrap();
    let orders = LineOrders::of(find_preset("f450").unwrap()).unwrap();
    let lines = lines_from_passes(&mut passes, 0.0..24.0, &orders, 0.75 * hover..1.3 * hover).unwrap();
    let heard = grey_box_from_sound(&lines, &flown.inputs, &start, &SoundConfig::default(), &mut |_| {}).unwrap();
    gains_are_within(&heard.fit, &flown.truth, 0.05);
    for rotor in 0..4 {
        let off = heard.fit.model.hover_rad_s[rotor] / flown.truth.hover_rad_s[rotor] - 1.0;
        assert!(off.abs() < 5e-4, "rotor {rotor}: {off}");
    }
    let delay_s = heard.fit.model.command_delay_s;
    assert!((0.0..0.01).contains(&delay_s), "the sound needs 6 ms: {delay_s}");
}
