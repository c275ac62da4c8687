//! From rotor to microphone, against the closed forms: delay, Doppler shift, 1/distance, reflections.

use crate::flight_sound_rig::{UP, amplitude, distance, render, standing};
use hovertone_sim::{
    BladePassTones, Room, RotorState, SoundSettings, SourceSettings, Surroundings, ToneSettings, WallAbsorption,
};
use hovertone_vehicle::RotorSpeed;
use std::f64::consts::TAU;

const C: f64 = 343.2;
const RATE: f64 = 48_000.0;

/// One line of level 1: at an ideal microphone 1 m away its samples have the amplitude 1.
fn line(order: u32, microphones_m: &[[f64; 3]]) -> SoundSettings {
    SoundSettings::free_field(SourceSettings::single_line(order, RotorSpeed::from_rev_s(50.0)), microphones_m)
}

/// Steady lines at 1…count times the speed, alike in all directions.
fn comb(count: u32) -> SourceSettings {
    let blades = BladePassTones { blade_count: 1, harmonic_count: count, level: 1.0, exponent: 0.0 };
    SourceSettings {
        tones: ToneSettings {
            gear_mesh: None,
            blade_pass: Some(blades),
            shaft_level: 0.0,
            unlike_blades_level: 0.0,
            level_spread_db: 0.0,
            scatter: None,
        },
        // So that a hundred of them are not clipped.
        tone_level_db_spl: 50.0,
        ..SourceSettings::single_line(1, RotorSpeed::from_rev_s(50.0))
    }
}

/// f c/(c - v) for a rotor that comes straight on, and 1/d at the moment of sending. Phase error of a clip: the
/// interpolation's -72 dB, 2.5e-4 rad at most, once at each end.
#[test]
fn a_rotor_that_comes_near_is_higher_by_the_doppler_factor() {
    for (speed_m_s, order) in [(30.0, 40), (3.0, 69), (-10.0, 69), (-60.0, 100), (0.0, 69)] {
        let settings = line(order, &[[0.0, 0.0, 0.0]]);
        let start_m = -60.0;
        let place = |time_s: f64| start_m + speed_m_s * time_s;
        let flight =
            |time_s: f64| vec![RotorState { speed_rad_s: TAU * 50.0, position_m: [place(time_s), 0.0, 0.0], axis: UP }];
        let duration_s = 1.0;
        let samples = &render(&settings, duration_s, 0.001, flight)[0];
        assert_eq!(samples.len(), 48_000);
        // Before 60/c the rotor was standing.
        let first = (60.0 / C * RATE) as usize + 100;
        let doppler_hz = f64::from(order) * 50.0 * C / (C - speed_m_s);
        let turns = |n: usize| doppler_hz * n as f64 / RATE;
        let (count, last) = (4800, samples.len() - 4800);
        let early = amplitude(samples, first, count, turns);
        let late = amplitude(samples, last, count, turns);
        let ratio = late / early;
        let found_hz = doppler_hz + ratio.arg() / TAU / ((last - first) as f64 / RATE);
        let tolerance_hz = 2.0 * 2.5e-4 / TAU / ((last - first) as f64 / RATE);
        assert!((found_hz - doppler_hz).abs() < tolerance_hz, "{speed_m_s}: {found_hz} {doppler_hz}");
        // Sent at τ = (t - d₀/c)/(1 - v/c); the mean over the window of 1/d, to second order of its width.
        let sent_s = |n: f64| (n / RATE + start_m / C) / (1.0 - speed_m_s / C);
        let d = -place(sent_s(last as f64 + count as f64 / 2.0));
        let width = speed_m_s * count as f64 / RATE / d;
        assert!((late.norm() * d - 1.0).abs() < 3e-4 + 0.1 * width * width, "{speed_m_s} m/s at {d} m");
    }
}

/// A pass with acceleration, changing rotor speed and a distance that is nowhere straight: at every instant the phase is
/// that of the retarded time, found here by bisection.
#[test]
fn the_delay_is_the_distance_over_c_at_every_instant() {
    let order = 40;
    let microphones = [[0.0, 2.0, 1.0], [0.3, -2.5, 2.0], [3.0, 0.1, 0.2]];
    let settings = line(order, &microphones);
    let place = |t: f64| [-4.0 + 8.0 * t + 3.0 * t * t, 0.3 * (TAU * 1.5 * t).sin(), 1.0 + 0.5 * t];
    let speed_rev_s = |t: f64| 50.0 + 8.0 * t;
    let turns = |t: f64| 50.0 * t + 4.0 * t * t;
    let (place_held, speed_held) = (|t: f64| place(t.max(0.0)), |t: f64| speed_rev_s(t.max(0.0)));
    let flight = |t: f64| vec![RotorState { speed_rad_s: TAU * speed_held(t), position_m: place_held(t), axis: UP }];
    let channels = render(&settings, 1.2, 0.001, flight);
    assert_eq!(channels.len(), 3);
    let mut reference = None;
    for (samples, microphone) in channels.iter().zip(microphones) {
        let sent_s = |n: usize| {
            let t = n as f64 / RATE;
            let (mut low, mut high) = (t - 1.0, t);
            for _ in 0..60 {
                let middle = 0.5 * (low + high);
                if middle + distance(place_held(middle), microphone) / C < t { low = middle } else { high = middle }
            }
            0.5 * (low + high)
        };
        let held_turns = |t: f64| if t < 0.0 { 50.0 * t } else { turns(t) };
        for first in (0..samples.len() - 480).step_by(480) {
            let found = amplitude(samples, first, 480, |n| f64::from(order) * held_turns(sent_s(n)));
            // The first window tells the line's own phase; it is the same in all channels.
            let own = *reference.get_or_insert(found / found.norm());
            let relative = found / own;
            let phase = relative.arg();
            // Straight delays over 1 ms: d'' Δ²/8 with d'' up to v²/d = 100 m/s² is 1e-5 m, 4e-4 rad at 2.2 kHz; ten
            // cycles of a window leave 1e-3 of the double frequency.
            assert!(phase.abs() < 2e-3, "sample {first}: {phase} rad");
            let d = distance(place_held(sent_s(first + 240)), microphone);
            // Over a window of 10 ms the distance changes by 14 cm of at least 0.5 m.
            assert!((relative.re * d - 1.0).abs() < 0.02, "sample {first}: {} at {d}", relative.re * d);
        }
    }
}

#[test]
fn twice_the_distance_is_6_db_less_and_the_delays_of_channels_differ_by_the_distances() {
    let microphones = [[1.0, 0.0, 0.0], [0.0, 2.0, 0.0], [-4.0, 0.0, 0.0], [0.0, 0.0, 8.0], [0.0, 0.05, 0.0]];
    let mut settings = line(80, &microphones);
    settings.source.tone_level_db_spl = 64.0;
    let channels = render(&settings, 0.3, 0.001, standing(50.0, [0.0; 3]));
    let found: Vec<_> =
        channels.iter().map(|samples| amplitude(samples, 4800, 4800, |n| 4000.0 * n as f64 / RATE)).collect();
    for (channel, distance_m) in [1.0, 2.0, 4.0, 8.0].into_iter().enumerate() {
        let ratio = found[channel] / found[0];
        assert!((ratio.norm() * distance_m - 1.0).abs() < 5e-4);
        let behind = TAU * 4000.0 * (distance_m - 1.0) / C + ratio.arg();
        assert!((behind - TAU * (behind / TAU).round()).abs() < 5e-4, "{behind}");
    }
    // Within 10 cm it gets no louder.
    assert!((found[4].norm() / found[0].norm() - 10.0).abs() < 0.01);
}

/// The sum over images worked out here from the walls, one by one, at a hundred frequencies at once: number, delays and
/// levels of the reflections all have to be right.
#[test]
fn a_room_adds_six_reflections_with_the_delays_and_levels_of_the_images() {
    let absorption = WallAbsorption { x_low: 0.1, x_high: 0.36, y_low: 0.2, y_high: 0.5, floor: 0.03, ceiling: 0.64 };
    let room = Room { corner_m: [-2.0, -3.0, 0.0], size_m: [7.0, 5.5, 3.2], absorption, reverberation_s: None };
    let (rotor, microphone) = ([0.4, -0.7, 1.1], [3.1, 1.3, 2.0]);
    let free = SoundSettings::free_field(comb(100), &[[1.4, -0.7, 1.1]]);
    let mut within = SoundSettings::free_field(comb(100), &[microphone]);
    let reference = &render(&free, 0.3, 0.001, standing(100.0, rotor))[0];
    let ratio_of = |settings: &SoundSettings, harmonic: u32| {
        let samples = &render(settings, 0.3, 0.001, standing(100.0, rotor))[0];
        let turns = |n: usize| f64::from(harmonic) * 100.0 * n as f64 / RATE;
        amplitude(samples, 4800, 4800, turns) / amplitude(reference, 4800, 4800, turns)
    };
    let images = |walls: &[(usize, f64, f64)]| -> Vec<([f64; 3], f64)> {
        let mirrored = walls.iter().map(|&(axis, at, absorbed)| {
            let mut image = rotor;
            image[axis] = 2.0 * at - image[axis];
            (image, (1.0 - absorbed).sqrt())
        });
        [(rotor, 1.0)].into_iter().chain(mirrored).collect()
    };
    let walls = [(0, -2.0, 0.1), (0, 5.0, 0.36), (1, -3.0, 0.2), (1, 2.5, 0.5), (2, 0.0, 0.03), (2, 3.2, 0.64)];
    for (surroundings, images) in [
        (Surroundings::Room(room), images(&walls)),
        (Surroundings::Ground { absorption: 0.19 }, images(&[(2, 0.0, 0.19)])),
        (Surroundings::FreeField, images(&[])),
    ] {
        within.surroundings = surroundings;
        for harmonic in [1, 2, 3, 10, 33, 77, 100] {
            let k = TAU * 100.0 * f64::from(harmonic) / C;
            let (mut re, mut im) = (0.0, 0.0);
            for (image, reflection) in &images {
                let d = distance(*image, microphone);
                re += reflection / d * (k * (d - 1.0)).cos();
                im -= reflection / d * (k * (d - 1.0)).sin();
            }
            let found = ratio_of(&within, harmonic);
            // Seven paths at -72 dB each, and the reference.
            assert!((found.re - re).hypot(found.im - im) < 1e-3, "{harmonic}: {found:?} {re} {im}");
        }
    }
}

/// The mirrored rotor's axis is mirrored too: what leaves towards the floor leaves along the axis.
#[test]
fn directivity_is_that_of_the_direction_in_which_the_sound_leaves() {
    let mut settings = SoundSettings::free_field(comb(1), &[[0.0, 0.0, 3.0]]);
    settings.source.blade_directivity.on_axis = 0.0;
    settings.surroundings = Surroundings::Ground { absorption: 0.0 };
    // Straight above and straight below: nothing, by any way.
    let samples = &render(&settings, 0.2, 0.001, standing(200.0, [0.0, 0.0, 1.0]))[0];
    assert!(samples.iter().all(|value| value.abs() < 1e-6));
    // Tilted by 30°: sin² of the angle on each way.
    let tilt = 30.0_f64.to_radians();
    let axis = [tilt.sin(), 0.0, tilt.cos()];
    let microphone = [2.0, 0.0, 2.0];
    settings.microphones[0].position_m = microphone;
    let flight = |_| vec![RotorState { speed_rad_s: TAU * 200.0, position_m: [0.0, 0.0, 1.0], axis }];
    let tilted = &render(&settings, 0.2, 0.001, flight)[0];
    settings.source.blade_directivity.on_axis = 1.0;
    settings.surroundings = Surroundings::FreeField;
    settings.microphones[0].position_m = [1.0, 0.0, 1.0];
    let reference = &render(&settings, 0.2, 0.001, flight)[0];
    let turns = |n: usize| 200.0 * n as f64 / RATE;
    let found = amplitude(tilted, 4800, 4800, turns) / amplitude(reference, 4800, 4800, turns);
    let (mut re, mut im) = (0.0, 0.0);
    // Leaving upwards to the microphone, and downwards to where it is mirrored in the floor.
    for way in [[2.0, 0.0, 1.0], [2.0, 0.0, -3.0]] {
        let d = distance(way, [0.0; 3]);
        let cosine = (way[0] * axis[0] + way[2] * axis[2]) / d;
        let k = TAU * 200.0 / C;
        re += (1.0 - cosine * cosine) / d * (k * (d - 1.0)).cos();
        im -= (1.0 - cosine * cosine) / d * (k * (d - 1.0)).sin();
    }
    assert!((found.re - re).hypot(found.im - im) < 1e-3, "{found:?} {re} {im}");
}
