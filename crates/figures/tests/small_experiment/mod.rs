//! A small experiment: two loads of two trials, heard, with their pictures and tables.

use hovertone_analysis::{Method, Outcome, Span, SpeedAnalysis};
use hovertone_figures::{PictureConfig, Pictures, Trial, pictures_from_source, views_of_recording};
use hovertone_rotor_speed::{Config, ToneConfig, speed_from_source};
use hovertone_signal::Signal;
use hovertone_thrust::{Force, LoadSpeeds, ThrustSettings, ThrustTable, TrialSpeeds, thrust_from_loads};
use hovertone_vehicle::Order;
use std::f64::consts::TAU;

pub(crate) const RATE_HZ: f64 = 16_000.0;
pub(crate) const LENGTH_S: f64 = 6.0;
/// Two blades at a speed that sways by 1 %, three harmonics, in noise.
pub(crate) fn hover(speed_rev_s: f64, seed: u64) -> Signal {
    let (mut state, mut turn) = (seed, 0.0);
    let samples = (0..(LENGTH_S * RATE_HZ) as usize).map(|n| {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        let noise = 0.02 * ((state >> 40) as f64 / (1_u64 << 23) as f64 - 1.0);
        turn += speed_rev_s * (1.0 + 0.01 * (TAU * 0.5 * n as f64 / RATE_HZ).sin()) / RATE_HZ;
        let line = |harmonic: f64| (TAU * 2.0 * harmonic * turn).sin() / harmonic;
        (0.1 * (line(1.0) + line(2.0) + line(3.0)) + noise) as f32
    });
    Signal::new(samples.collect(), RATE_HZ)
}

pub(crate) struct Heard {
    pub(crate) load: &'static str,
    pub(crate) name: String,
    pub(crate) analysis: SpeedAnalysis,
    pub(crate) pictures: Pictures,
}

pub(crate) fn heard(load: &'static str, number: u64, speed_rev_s: f64) -> Heard {
    let mut source = hover(speed_rev_s, number);
    let config = Config { all_methods: true, ..Config::for_tone(ToneConfig::of_order(Order::from_blades(2).unwrap())) };
    let analysis = speed_from_source(&mut source, &config, &mut |_| {}).unwrap();
    let Outcome::Ok(tone) = &analysis.outcome else { panic!("no tone in {load}: {:?}", analysis.outcome) };
    let config = PictureConfig { rows_max: 64, columns_max: 64, ..PictureConfig::default() };
    let views = views_of_recording(Some(tone), RATE_HZ, &config);
    let all = Span { from_s: 0.0, to_s: LENGTH_S };
    let pictures = pictures_from_source(&mut source, all, &views, &analysis.hover.segments, &config).unwrap();
    Heard { load, name: format!("{load}/{number}.wav"), analysis, pictures }
}

/// Two loads of two trials.
pub(crate) fn all_heard() -> Vec<Heard> {
    vec![heard("light", 1, 300.0), heard("light", 2, 301.0), heard("heavy", 3, 330.0), heard("heavy", 4, 329.0)]
}

pub(crate) fn trials(heard: &[Heard]) -> Vec<Trial<'_>> {
    heard
        .iter()
        .map(|Heard { load, name, analysis, pictures }| Trial {
            load,
            recording: name,
            analysis: Some(analysis),
            reason: None,
            readings: &[],
            method: Method::Harmonic,
            pictures: Some(pictures),
        })
        .collect()
}

pub(crate) fn tables(heard: &[Heard]) -> Vec<ThrustTable> {
    let speeds = |method: Method| -> Vec<LoadSpeeds> {
        [("light", 0.0), ("heavy", 0.1)]
            .map(|(load, added_mass_kg)| LoadSpeeds {
                name: load.to_owned(),
                force: Force::Weight {
                    vehicle_mass_kg: 0.5,
                    added_mass_kg,
                    mass_std_kg: 0.0005,
                    gravity_m_s2: 9.8,
                    gravity_std_m_s2: 0.0005,
                },
                rotors_running: 4,
                power_w: None,
                trials: heard
                    .iter()
                    .filter(|one| one.load == load)
                    .map(|one| match TrialSpeeds::from_analysis(&one.name, &one.analysis, method) {
                        Some(trial) => trial,
                        None => panic!("no tone"),
                    })
                    .collect(),
            })
            .to_vec()
    };
    [Method::Harmonic, Method::MaximumTrace, Method::Gaussian]
        .map(|method| thrust_from_loads(&speeds(method), method, &ThrustSettings::for_rotors(4)))
        .to_vec()
}
