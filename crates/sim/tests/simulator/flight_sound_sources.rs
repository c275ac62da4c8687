//! What rotors, room and microphone add: levels, directivity, modulation, start-up, clipping, and the promises about
//! memory and repetition.

use crate::flight_sound_rig::{UP, amplitude, mean_square, render, standing};
use hovertone_sim::{
    AmbientSettings, BabbleSettings, BroadbandSettings, FlightSound, MicrophoneSettings, Room, RotorState,
    SoundSettings, SoundState, SourceSettings, Surroundings,
};
use hovertone_vehicle::{RotorSpeed, find_preset};
use std::f64::consts::TAU;

const C: f64 = 343.2;
const RATE: f64 = 48_000.0;
/// Mean square of an ideal microphone's samples at 94 dB SPL: a sine of amplitude 1.
const AT_94_DB: f64 = 0.5;

fn ardrone() -> SourceSettings {
    SourceSettings::for_vehicle(find_preset("ardrone").unwrap(), RotorSpeed::from_rev_s(60.0))
}

/// Broadband noise of 70 dB alone, flat, so that 1 s has many independent values; alike in all directions.
fn noise(broadband: BroadbandSettings) -> SourceSettings {
    let mut source = ardrone();
    source.tone_level_db_spl = -100.0;
    source.broadband = Some(BroadbandSettings { level_db_spl: 70.0, slope_db_per_octave: 0.0, ..broadband });
    source.broadband_directivity = hovertone_sim::Directivity::OMNI;
    source
}

#[test]
fn noise_has_the_set_level_and_goes_with_the_set_power_of_the_speed() {
    for exponent in [5.0, 6.0] {
        let steady = BroadbandSettings { speed_exponent: exponent, modulation_depth: 0.0, ..Default::default() };
        let settings = SoundSettings::free_field(noise(steady), &[[1.0, 0.0, 0.0]]);
        let power = |speed_rev_s| mean_square(&render(&settings, 1.0, 0.001, standing(speed_rev_s, [0.0; 3]))[0]);
        // The same noise at another speed: exact. The level: 48,000 values, of which the interpolation between samples
        // dims the top; here the delay is a whole number of samples but for 0.13, where that is little.
        let ratio = power(75.0) / power(60.0);
        assert!((ratio / 1.25_f64.powf(exponent) - 1.0).abs() < 1e-5, "{ratio}");
        let level_db = 94.0 + 10.0 * (power(60.0) / AT_94_DB).log10();
        assert!((level_db - 70.0).abs() < 0.4, "{level_db}");
    }
}

/// What the documentation of the default levels says: 69 dB of lines, 71 dB in all, at 1 m from four rotors; ±2 dB for
/// the spread of the lines' levels (3 dB each; the first few blade-pass lines of four rotors carry most of the power).
#[test]
fn an_ardrone_in_hover_has_the_documented_level() {
    let power = |source: SourceSettings, seed| {
        let settings = SoundSettings { seed, ..SoundSettings::free_field(source, &[[1.0, 0.0, 0.0]]) };
        let flight = |_| vec![standing(60.0, [0.0; 3])(0.0)[0]; 4];
        mean_square(&render(&settings, 1.0, 0.001, flight)[0])
    };
    let level_db = |source: &SourceSettings| {
        let mean = (0..8).map(|seed| power(source.clone(), seed)).sum::<f64>() / 8.0;
        94.0 + 10.0 * (mean / AT_94_DB).log10()
    };
    let (all, lines) = (level_db(&ardrone()), level_db(&SourceSettings { broadband: None, ..ardrone() }));
    assert!((all - 71.0).abs() < 2.0 && (lines - 69.0).abs() < 2.0, "{all} {lines}");
}

/// Beranek's diffuse field without the first reflection, `16 π (1 - ᾱ)²/A` times the power at 1 m: what the tail adds.
#[test]
fn the_tail_of_a_room_has_the_power_of_the_diffuse_field() {
    let power = |surroundings, microphone: [f64; 3]| {
        let steady = BroadbandSettings { modulation_depth: 0.0, ..Default::default() };
        let mut settings = SoundSettings::free_field(noise(steady), &[microphone]);
        settings.surroundings = surroundings;
        mean_square(&render(&settings, 2.0, 0.01, standing(60.0, [0.0, 0.0, 1.0]))[0])
    };
    let room = |reverberation_s| Surroundings::Room(Room { reverberation_s, ..Room::default() });
    let added = power(room(Some(0.6)), [3.0, 2.0, 1.7]) - power(room(None), [3.0, 2.0, 1.7]);
    // The default room: 8 x 6 x 3 m.
    let absorbing_m2 = 0.161 * 144.0 / 0.6;
    let expected = 16.0 * std::f64::consts::PI * (1.0 - absorbing_m2 / 180.0_f64).powi(2) / absorbing_m2;
    let found = added / power(Surroundings::FreeField, [1.0, 0.0, 1.0]);
    // The tail and the direct sound are the same noise at other times: their product averages out to about 1 %.
    assert!((found / expected - 1.0).abs() < 0.05, "{found} {expected}");
    assert!((Room::default().sabine_reverberation_s() - 1.9).abs() < 0.05);
}

/// x = n (1 + m cos β)/√(1 + m²/2): the mean of x² cos β over that of x² is m/(1 + m²/2), and no other harmonic but the
/// second is there.
#[test]
fn noise_is_modulated_at_the_blade_pass() {
    let depth = 0.5;
    let modulated = BroadbandSettings { modulation_depth: depth, ..Default::default() };
    let settings = SoundSettings::free_field(noise(modulated), &[[1.0, 0.0, 0.0]]);
    let samples = &render(&settings, 4.0, 0.001, standing(60.0, [0.0; 3]))[0];
    let squares: Vec<f32> = samples.iter().map(|value| value * value).collect();
    let mean = mean_square(samples);
    let share = |order: f64| {
        let turns = |n: usize| order * 60.0 * (n as f64 / RATE - 1.0 / C);
        let found = amplitude(&squares, 0, squares.len(), turns);
        (found.re / 2.0 / mean, found.im / 2.0 / mean)
    };
    // Standard error of the mean of x² cos: √(3/2 · 1.5/N), with Hann's weights 1.5 times N.
    let tolerance = 5.0 * (1.5 * 1.5 * 1.5 / squares.len() as f64).sqrt();
    let expected = depth / (1.0 + depth * depth / 2.0);
    let (re, im) = share(2.0);
    assert!((re - expected).abs() < tolerance && im.abs() < tolerance, "{re} {im} {expected}");
    let (re, im) = share(3.0);
    assert!(re.abs() < tolerance && im.abs() < tolerance);
}

#[test]
fn nulls_of_the_directivity_are_silent() {
    let microphones = [[1.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.0, 0.0, -1.0], [0.0, -1.0, 0.0]];
    let mut blades = SoundSettings::free_field(ardrone(), &microphones);
    blades.source.broadband = None;
    blades.source.tones.gear_mesh = None;
    blades.source.tones.shaft_level = 0.0;
    blades.source.motor = None;
    blades.source.blade_directivity.on_axis = 0.0;
    let mut hiss = SoundSettings::free_field(noise(BroadbandSettings::default()), &microphones);
    hiss.source.broadband_directivity = hovertone_sim::Directivity { in_plane: 0.0, on_axis: 1.0 };
    hiss.source.tones.level_spread_db = 0.0;
    for (settings, silent, loud) in [(blades, [1, 2], [0, 3]), (hiss, [0, 3], [1, 2])] {
        let channels = render(&settings, 0.3, 0.001, standing(60.0, [0.0; 3]));
        let power = channels.iter().map(|samples| mean_square(samples)).collect::<Vec<_>>();
        for (silent, loud) in silent.into_iter().zip(loud) {
            assert!(power[loud] > 1e-7 && power[silent] < 1e-12 * power[loud], "{power:?}");
        }
        assert!((power[loud[0]] / power[loud[1]] - 1.0).abs() < 0.01);
    }
}

/// From rest to 60 turns a second in 0.3 s: silent before, and the phase that of the integral of the speed throughout.
#[test]
fn a_rotor_at_rest_is_silent_and_starts_without_a_jump() {
    let mut source = SourceSettings::single_line(69, RotorSpeed::from_rev_s(60.0));
    source.mechanical_speed_exponent = 4.0;
    let settings = SoundSettings::free_field(source, &[[1.0, 0.0, 0.0]]);
    let speed_rev_s = |t: f64| (200.0 * (t - 0.1)).clamp(0.0, 60.0);
    let flight = |t: f64| vec![RotorState { speed_rad_s: TAU * speed_rev_s(t), position_m: [0.0; 3], axis: UP }];
    let samples = &render(&settings, 0.6, 0.001, flight)[0];
    let start = ((0.1 + 1.0 / C) * RATE) as usize;
    // The interpolation reaches a few samples ahead.
    assert!(samples[..start - 60].iter().all(|&value| value == 0.0));
    assert!(samples[..start].iter().all(|&value| value.abs() < 1e-7));
    let turns = |n: usize| {
        let t = n as f64 / RATE - 1.0 / C;
        let ramp = (t - 0.1).clamp(0.0, 0.3);
        69.0 * (100.0 * ramp * ramp + 60.0 * (t - 0.4).max(0.0))
    };
    let own = amplitude(samples, samples.len() - 4800, 4800, turns);
    assert!((own.norm() - 1.0).abs() < 1e-3);
    let (cosine, sine) = (own.re / own.norm(), own.im / own.norm());
    let mut loudest = 0.0_f64;
    for (n, &value) in samples.iter().enumerate().skip(start) {
        let phase = TAU * turns(n).fract();
        let gain = (speed_rev_s(n as f64 / RATE - 1.0 / C) / 60.0).powi(2);
        let expected = gain * (cosine * phase.cos() - sine * phase.sin());
        // The gain, the square of the speed, goes straight over 1 ms: off by its second difference over 8, 6e-6.
        assert!((f64::from(value) - expected).abs() < 5e-4, "sample {n}: {value} {expected}");
        loudest = loudest.max(expected.abs());
    }
    assert!(loudest > 0.9);
}

#[test]
fn with_rotors_at_rest_only_the_place_is_heard() {
    let mut settings = SoundSettings::free_field(ardrone(), &[[1.0, 0.0, 0.0], [5.0, 0.0, 0.0]]);
    settings.surroundings = Surroundings::Room(Room { corner_m: [-1.0; 3], ..Default::default() });
    let silence = render(&settings, 0.5, 0.001, standing(0.0, [0.0; 3]));
    assert!(silence.iter().all(|samples| samples.len() == 24_000 && samples.iter().all(|&value| value == 0.0)));
    settings.ambient = Some(AmbientSettings { level_db_spl: 60.0, flat_below_hz: 500.0, slope_db_per_octave: -3.0 });
    let channels = render(&settings, 4.0, 0.01, standing(0.0, [0.0; 3]));
    for samples in &channels {
        let level_db = 94.0 + 10.0 * (mean_square(samples) / AT_94_DB).log10();
        assert!((level_db - 60.0).abs() < 0.2, "{level_db}");
    }
    // Of its own at each microphone.
    let product: f64 = channels[0].iter().zip(&channels[1]).map(|(a, b)| f64::from(a * b)).sum();
    assert!((product / 192_000.0 / mean_square(&channels[0])).abs() < 0.03);
    // The babble alone: 6 dB less at twice the distance, later by the way between.
    settings.ambient = None;
    settings.babble = Some(BabbleSettings { position_m: [6.0, 0.0, 0.0], ..Default::default() });
    settings.microphones = [4.0, 2.0].map(|x| MicrophoneSettings::ideal([x, 0.0, 0.0])).to_vec();
    let channels = render(&settings, 3.0, 0.01, standing(0.0, [0.0; 3]));
    let later = (4.0 / C * RATE).round() as usize - (2.0 / C * RATE).round() as usize;
    assert!(mean_square(&channels[1]) > 0.0);
    for n in 4800..channels[1].len() {
        assert!((2.0 * channels[1][n] - channels[0][n - later]).abs() < 1e-6);
    }
}

#[test]
fn samples_are_clipped_at_full_scale_and_whole_steps() {
    let mut settings = SoundSettings::free_field(
        SourceSettings::single_line(20, RotorSpeed::from_rev_s(50.0)),
        &[[1.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 0.0, 0.0]],
    );
    (settings.microphones[0].full_scale_db_spl, settings.microphones[0].bits) = (88.0, Some(16));
    settings.microphones[1].bits = Some(8);
    let channels = render(&settings, 0.2, 0.001, standing(50.0, [0.0; 3]));
    let step = 2.0_f32.powi(-15);
    assert!(channels[0].iter().all(|value| (value / step).fract() == 0.0));
    let (low, high) = channels[0].iter().fold((0.0_f32, 0.0_f32), |(low, high), &v| (low.min(v), high.max(v)));
    assert_eq!((low, high), (-1.0, 1.0 - step));
    // A sine of twice full scale is beyond it for two thirds of the time.
    let clipped = channels[0].iter().filter(|value| value.abs() >= 1.0 - step).count();
    assert!((clipped as f64 / channels[0].len() as f64 - 2.0 / 3.0).abs() < 0.02);
    let mut worst = 0.0_f32;
    for (rounded, exact) in channels[1].iter().zip(&channels[2]) {
        assert_eq!((rounded * 128.0).fract(), 0.0);
        worst = worst.max((rounded - exact.min(1.0 - 1.0 / 128.0)).abs());
    }
    assert!(worst <= 0.5 / 128.0 + 1e-6 && worst > 0.4 / 128.0, "{worst}");
}

/// A sine through the microphone's filters: 3 dB down at both corners.
#[test]
fn the_microphone_limits_the_band_and_adds_its_own_noise() {
    for (order, loss_db) in [(2, 3.01), (20, 0.0), (320, 3.01)] {
        let mut settings = SoundSettings::free_field(
            SourceSettings::single_line(order, RotorSpeed::from_rev_s(50.0)),
            &[[1.0, 0.0, 0.0], [1.0, 0.0, 0.0]],
        );
        (settings.microphones[0].high_pass_hz, settings.microphones[0].low_pass_hz) = (Some(100.0), Some(16_000.0));
        let channels = render(&settings, 0.5, 0.001, standing(50.0, [0.0; 3]));
        let found_db = 10.0 * (mean_square(&channels[1]) / mean_square(&channels[0])).log10();
        assert!((found_db - loss_db).abs() < 0.05, "{order}: {found_db}");
    }
    let mut settings = SoundSettings::free_field(ardrone(), &[[1.0, 0.0, 0.0]]);
    settings.microphones[0].self_noise_db_spl = Some(40.0);
    let samples = &render(&settings, 1.0, 0.001, standing(0.0, [0.0; 3]))[0];
    let level_db = 94.0 + 10.0 * (mean_square(samples) / AT_94_DB).log10();
    assert!((level_db - 40.0).abs() < 0.15, "{level_db}");
}

fn hover(time_s: f64) -> Vec<RotorState> {
    let rotor = |number: u32| {
        let angle = f64::from(number) * TAU / 4.0;
        RotorState {
            speed_rad_s: TAU * (60.0 + 0.5 * (3.0 * time_s + angle).sin()),
            position_m: [0.18 * angle.cos(), 0.18 * angle.sin() + 0.2 * time_s, 1.0],
            axis: [0.05, 0.0, 1.0],
        }
    };
    (0..4).map(rotor).collect()
}

#[test]
fn the_same_seed_gives_the_same_bytes_whenever_they_are_asked_for() {
    let settings = SoundSettings { sample_rate_hz: 44_100, ..SoundSettings::laboratory(ardrone()) };
    let whole = render(&settings, 0.5, 0.001, hover);
    assert_eq!(whole[0].len(), 22_050);
    assert_eq!(render(&settings, 0.5, 0.001, hover), whole);
    assert_ne!(render(&SoundSettings { seed: 2, ..settings.clone() }, 0.5, 0.001, hover), whole);
    // Taken out after every push instead of at the end.
    let mut sound = FlightSound::new(settings.clone()).unwrap();
    let mut taken = Vec::new();
    let mut out = Vec::new();
    for step in 0..=500 {
        let time_s = f64::from(step) * 0.001;
        sound.push(&SoundState { time_s, rotors: hover(time_s) }, &mut out).unwrap();
        taken.append(&mut out[0]);
        let behind = (time_s * 44_100.0) as usize - taken.len().min((time_s * 44_100.0) as usize);
        assert!(behind < 2 * 45 + 8, "{behind} samples behind");
    }
    sound.finish(&mut out);
    taken.append(&mut out[0]);
    assert_eq!(taken, whole[0]);
    // Another microphone, elsewhere, changes nothing for the first.
    let mut two = settings;
    two.microphones.push(MicrophoneSettings::at([3.0, -2.0, 1.0]));
    let both = render(&two, 0.5, 0.001, hover);
    assert_eq!(both[0], whole[0]);
    assert_ne!(both[1], whole[0]);
}

/// Where everything goes straight, how often the states come does not matter, but for rounding.
#[test]
fn the_step_between_states_does_not_matter_where_all_is_straight() {
    let mut settings = SoundSettings::free_field(ardrone(), &[[2.0, 1.0, 0.0]]);
    settings.source.blade_speed_exponent = 2.0;
    settings.source.mechanical_speed_exponent = 2.0;
    settings.source.unsteadiness = 0.0;
    settings.source.broadband = None;
    let flight = |time_s: f64| {
        let still = RotorState { speed_rad_s: TAU * (50.0 + 10.0 * time_s), position_m: [0.0; 3], axis: UP };
        vec![still; 2]
    };
    let fine = &render(&settings, 0.5, 0.001, flight)[0];
    for step_s in [0.000_013, 0.0003, 0.0025, 0.01, 0.1] {
        // The first is less than a sample.
        let other = &render(&settings, 0.5, step_s, flight)[0];
        let gap = fine.iter().zip(other).map(|(a, b)| (a - b).abs()).fold(0.0, f32::max);
        let peak = fine.iter().fold(0.0_f32, |peak, value| peak.max(value.abs()));
        assert!(gap < 3e-5 * peak, "{step_s}: {gap} of {peak}");
    }
}

#[test]
fn memory_does_not_grow_with_the_length_and_is_bounded_by_the_room() {
    let settings = SoundSettings::laboratory(ardrone());
    let mut sound = FlightSound::new(settings).unwrap();
    let mut out = Vec::new();
    let (mut early, mut late) = (0, 0);
    for step in 0..=6000_u32 {
        let time_s = f64::from(step) * 0.001;
        sound.push(&SoundState { time_s, rotors: hover(time_s / 4.0) }, &mut out).unwrap();
        out[0].clear();
        let held = sound.buffered_samples();
        if step < 500 { early = early.max(held) } else { late = late.max(held) }
    }
    assert!(late <= early + 100, "{early} {late}");
    // The longest path by one wall, and 4096 taken samples; 16 lines of up to 0.1 s; babble over 9 m; two steps and 256
    // samples of ten terms for four rotors.
    let longest_m = (16.0_f64.powi(2) + 36.0 + 9.0).sqrt();
    let bound =
        longest_m / C * RATE + 16.0 * 4800.0 + 9.0 / C * RATE + 4.0 * 10.0 * (3.0 * 48.0 + 32.0 + 256.0) + 256.0;
    assert!((late as f64) < bound, "{late} {bound}");
}

#[test]
fn states_that_make_no_sense_are_refused_and_change_nothing() {
    let settings = SoundSettings::laboratory(ardrone());
    let mut sound = FlightSound::new(settings.clone()).unwrap();
    let mut out = Vec::new();
    let mut refused = 0;
    for step in 0..=200_u32 {
        let time_s = f64::from(step) * 0.001;
        let good = SoundState { time_s, rotors: hover(time_s) };
        if step == 100 {
            let mut bad = vec![good.clone(); 6];
            bad[0].time_s = 0.05;
            bad[1].time_s = f64::NAN;
            bad[2].rotors.pop();
            bad[3].rotors[1].position_m[2] = 3.5;
            bad[4].rotors[0].position_m[0] += 0.5;
            bad[5].rotors[3].speed_rad_s = -1.0;
            refused = bad.iter().filter(|state| sound.push(state, &mut out).is_err()).count();
        }
        sound.push(&good, &mut out).unwrap();
    }
    sound.finish(&mut out);
    assert_eq!(refused, 6);
    assert_eq!(out, render(&settings, 0.2, 0.001, hover));
    // And settings.
    let good = SoundSettings::laboratory(ardrone());
    let mut bad = vec![good; 5];
    bad[0].microphones.clear();
    bad[1].sample_rate_hz = 0;
    bad[2].microphones[0].position_m = [9.0, 0.0, 1.0];
    bad[3].source.unsteadiness = 2.0;
    bad[4].speed_of_sound_m_s = f64::NAN;
    assert!(bad.into_iter().all(|settings| FlightSound::new(settings).is_err()));
}
