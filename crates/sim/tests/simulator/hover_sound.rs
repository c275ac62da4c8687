//! The rendered sound against its own truth: closed forms, not estimates.

use hovertone_sim::{
    GearMeshTones, HoverSettings, HoverSound, NoiseSettings, RotorSound, SpeedProfile, ToneSettings, Truth,
};
use hovertone_vehicle::{QuantityError, RotorSpeed, find_preset};
use std::f64::consts::TAU;

fn rotor(rev_s: f64) -> RotorSound {
    RotorSound::at(RotorSpeed::from_rev_s(rev_s))
}

fn four_rotors() -> HoverSettings {
    HoverSettings { duration_s: 2.0, rotors: [60.17, 60.8, 59.4, 61.3].map(rotor).to_vec(), ..HoverSettings::default() }
}

fn one_line(duration_s: f64) -> HoverSettings {
    HoverSettings {
        duration_s,
        rotors: vec![rotor(60.172)],
        tones: ToneSettings::single(69),
        rotor_noise: None,
        truth_step_s: 1.0 / 48_000.0,
        ..HoverSettings::default()
    }
}

fn rendered(settings: HoverSettings) -> Result<(f64, Vec<f32>, Truth), QuantityError> {
    let sound = HoverSound::new(settings)?;
    let gain = sound.gain();
    let (samples, truth) = sound.render_all();
    Ok((gain, samples, truth))
}

/// A line's phase is its order times the turns of the shaft that the truth has, at every one of half a million samples,
/// while the speed wanders by 1.2 %.
#[test]
fn the_line_turns_exactly_as_the_truth_says() {
    let (gain, samples, truth) = rendered(one_line(10.0)).unwrap();
    assert_eq!(truth.rows().len(), samples.len() + 1);
    let angle = |sample: usize| TAU * (69.0 * truth.rows()[sample].rotors[0].turns).fract();
    let unwrapped_rev = truth.rows()[480_000].rotors[0].turns;
    assert!((unwrapped_rev / 10.0 / 60.172 - 1.0).abs() < 0.012);

    let window = 480;
    let phase_in = |start: usize| {
        let (mut cc, mut ss, mut cs, mut xc, mut xs) = (0.0, 0.0, 0.0, 0.0, 0.0);
        for (sample, &value) in samples.iter().enumerate().skip(start).take(window) {
            let (sine, cosine) = angle(sample).sin_cos();
            let value = f64::from(value);
            cc += cosine * cosine;
            ss += sine * sine;
            cs += cosine * sine;
            xc += value * cosine;
            xs += value * sine;
        }
        let determinant = cc * ss - cs * cs;
        let (cosine, sine) = ((xc * ss - xs * cs) / determinant, (xs * cc - xc * cs) / determinant);
        (cosine.hypot(sine), (-sine).atan2(cosine))
    };
    let (_, phase) = phase_in(0);
    for start in (0..samples.len() - window).step_by(window) {
        let (amplitude, here) = phase_in(start);
        let away = (here - phase + TAU / 2.0).rem_euclid(TAU) - TAU / 2.0;
        assert!(away.abs() < 1e-6, "phase {away} rad at sample {start}");
        assert!((amplitude / gain - 1.0).abs() < 1e-6, "amplitude {amplitude} at sample {start}");
    }
    // Nothing else is in the sound: what is left is the rounding to f32 at full scale 0.5.
    for (sample, &value) in samples.iter().enumerate() {
        let left = f64::from(value) - gain * (angle(sample) + phase).cos();
        assert!(left.abs() < 1e-6, "{left} left at sample {sample}");
    }
}

#[test]
fn truth_on_its_rows_is_the_brute_force_sum_over_samples() {
    let fine = HoverSettings { truth_step_s: 1.0 / 48_000.0, ..four_rotors() };
    let (_, _, coarse) = rendered(four_rotors()).unwrap();
    let (_, _, fine) = rendered(fine).unwrap();
    assert_eq!((coarse.rows().len(), fine.rows().len()), (201, 96_001));
    for (from, to) in [(0, 96_000), (480, 960), (24_000, 72_000)] {
        let (from_s, to_s) = (from as f64 / 48_000.0, to as f64 / 48_000.0);
        let seconds = to_s - from_s;
        let mut sum_of_squares = 0.0;
        for rotor in 0..4 {
            // The speed between two samples is how far the shaft turned there.
            let turned =
                |sample: usize| fine.rows()[sample + 1].rotors[rotor].turns - fine.rows()[sample].rotors[rotor].turns;
            let speeds = (from..to).map(|sample| turned(sample) * 48_000.0);
            let mean = speeds.clone().sum::<f64>() / f64::from(to as u32 - from as u32);
            let square = speeds.map(|rev_s| (TAU * rev_s).powi(2)).sum::<f64>() / 48_000.0 / seconds;
            sum_of_squares += square;
            assert!((coarse.mean_speed(rotor, from_s, to_s).unwrap().rev_s() / mean - 1.0).abs() < 1e-9);
            assert!((coarse.mean_square(rotor, from_s, to_s).unwrap() / square - 1.0).abs() < 1e-9);
        }
        let told = coarse.mean_sum_of_squares(from_s, to_s).unwrap();
        assert!((told / sum_of_squares - 1.0).abs() < 1e-9, "{told} {sum_of_squares}");
        let constant = coarse.thrust_constant_per_rotor_n_s2(0.413, 9.8, from_s, to_s).unwrap();
        assert!((constant * sum_of_squares / (0.413 * 9.8) - 1.0).abs() < 1e-9);
        let total = coarse.thrust_constant_total_n_s2(0.413, 9.8, from_s, to_s).unwrap();
        assert!((total / constant - 4.0).abs() < 1e-12);
    }
    for (from_s, to_s) in [(1.0, 1.0), (1.5, 1.0), (-0.1, 1.0), (0.0, 2.1)] {
        assert!(coarse.mean_sum_of_squares(from_s, to_s).is_none(), "{from_s} to {to_s}");
    }
    assert!(coarse.mean_speed(4, 0.0, 1.0).is_none());
}

/// The error that `Truth` states for spans that begin and end between rows.
#[test]
fn truth_between_rows_is_as_exact_as_stated() {
    let settings = HoverSettings { duration_s: 10.0, tones: ToneSettings::single(69), ..four_rotors() };
    let fine = HoverSettings { truth_step_s: 1.0 / 48_000.0, ..settings.clone() };
    let (_, _, coarse) = rendered(settings).unwrap();
    let (_, _, fine) = rendered(fine).unwrap();
    let (count, mut squares) = (200, 0.0);
    for step in 0..count {
        // Halfway between rows, where it is worst.
        let from_s = f64::from(step * 960 + 240) / 48_000.0;
        let (rough, exact) =
            (coarse.mean_square(0, from_s, from_s + 5.0).unwrap(), fine.mean_square(0, from_s, from_s + 5.0).unwrap());
        squares += (rough / exact - 1.0).powi(2);
    }
    let diffusion = 2.0 * 0.012_f64.powi(2) / 0.3;
    let stated = 2.0 * (diffusion * 0.01_f64.powi(3) / 24.0).sqrt() / 5.0;
    assert!((stated - 2.5e-6).abs() < 0.05e-6, "{stated}");
    // A standard deviation from n values has the relative standard error 1/√(2n).
    let ratio = (squares / f64::from(count)).sqrt() / stated;
    assert!((ratio - 1.0).abs() < 5.0 / f64::from(2 * count).sqrt(), "{ratio} of the stated error");
}

#[test]
fn the_same_settings_give_the_same_bytes_whatever_the_block_size() {
    let (_, whole, truth) = rendered(four_rotors()).unwrap();
    for size in [1, 47, 48, 1000, 100_000] {
        let mut sound = HoverSound::new(four_rotors()).unwrap();
        let (mut samples, mut rows, mut block) = (Vec::new(), Vec::new(), vec![0.0; size]);
        loop {
            let count = sound.render(&mut block, &mut rows);
            if count == 0 {
                break;
            }
            samples.extend_from_slice(&block[..count]);
        }
        assert_eq!(samples.len() as u64, sound.sample_count());
        assert!(samples.iter().zip(&whole).all(|(a, b)| a.to_bits() == b.to_bits()), "block size {size}");
        assert_eq!(rows, truth.rows());
    }
    let (_, other_seed, _) = rendered(HoverSettings { seed: 2, ..four_rotors() }).unwrap();
    assert_ne!(other_seed, whole);
}

#[test]
fn a_longer_sound_begins_like_the_shorter_one() {
    let (_, short, _) = rendered(four_rotors()).unwrap();
    let (_, long, _) = rendered(HoverSettings { duration_s: 3.0001, ..four_rotors() }).unwrap();
    assert_eq!(short, long[..short.len()]);
    assert_eq!(long.len(), 144_005);
}

#[test]
fn adding_a_rotor_changes_no_other() {
    let noiseless = HoverSettings { rotor_noise: None, ..four_rotors() };
    let silent = RotorSound { level_db: -400.0, ..noiseless.rotors[3] };
    let alone = HoverSettings { rotors: noiseless.rotors[..3].to_vec(), ..noiseless.clone() };
    let mut joined = alone.clone();
    joined.rotors.push(silent);
    let (gain_alone, alone, truth_alone) = rendered(alone).unwrap();
    let (gain_joined, joined, truth_joined) = rendered(joined).unwrap();
    for (a, b) in alone.iter().zip(&joined) {
        assert!((f64::from(*a) / gain_alone - f64::from(*b) / gain_joined).abs() < 1e-5);
    }
    for (a, b) in truth_alone.rows().iter().zip(truth_joined.rows()) {
        assert_eq!(a.rotors[..], b.rotors[..3]);
    }
}

#[test]
fn rotors_wander_independently() {
    let (_, _, truth) = rendered(HoverSettings { duration_s: 60.0, ..four_rotors() }).unwrap();
    let share = |rotor: usize, row: usize| {
        truth.rows()[row].rotors[rotor].speed_rev_s / four_rotors().rotors[rotor].mean_speed.rev_s() - 1.0
    };
    let rows = truth.rows().len();
    // Two such processes correlate with a standard error of √(τ/T).
    let error = (0.3_f64 / 60.0).sqrt();
    for (a, b) in [(0, 1), (0, 2), (0, 3), (1, 2), (1, 3), (2, 3)] {
        let product = (0..rows).map(|row| share(a, row) * share(b, row)).sum::<f64>() / rows as f64;
        assert!((product / 0.012_f64.powi(2)).abs() < 5.0 * error, "rotors {a} and {b}");
    }
    for rotor in 0..4 {
        let variance = (0..rows).map(|row| share(rotor, row).powi(2)).sum::<f64>() / rows as f64;
        let relative_error = (2.0_f64 * 0.3 / 60.0).sqrt();
        assert!((variance / 0.012_f64.powi(2) - 1.0).abs() < 5.0 * relative_error, "rotor {rotor}: {variance}");
    }
}

#[test]
fn no_sound_clips_and_none_is_faint() {
    let crazyflie =
        find_preset("crazyflie").map(|vehicle| HoverSettings::for_vehicle(vehicle, RotorSpeed::from_rev_s(280.0)));
    let loud_noise = NoiseSettings { carrier_to_noise_density_db_hz: 20.0, slope_db_per_octave: -6.0 };
    let cases = [
        four_rotors(),
        HoverSettings { sample_rate_hz: 44_100, ..four_rotors() },
        HoverSettings { rotor_noise: Some(loud_noise), ambient_noise: Some(loud_noise), ..four_rotors() },
        one_line(2.0),
        crazyflie.unwrap(),
    ];
    for (number, case) in cases.into_iter().enumerate() {
        for seed in 1..4 {
            let (_, samples, _) = rendered(HoverSettings { duration_s: 5.0, seed, ..case.clone() }).unwrap();
            let peak = samples.iter().fold(0.0_f32, |peak, sample| peak.max(sample.abs()));
            assert!((0.2..=0.5 + 1e-6).contains(&peak), "case {number}, seed {seed}: peak {peak}");
        }
    }
}

/// Noise is what is left when the sound without noise is taken away. The mean of M periodograms has the relative
/// standard error 1/√M.
#[test]
fn noise_has_the_set_level_against_the_mesh_line() {
    let settings = HoverSettings { duration_s: 20.0, ..one_line(20.0) };
    let noise = NoiseSettings { carrier_to_noise_density_db_hz: 42.0, slope_db_per_octave: -3.0 };
    let (gain_clean, clean, _) = rendered(settings.clone()).unwrap();
    let (gain_noisy, noisy, _) = rendered(HoverSettings { rotor_noise: Some(noise), ..settings }).unwrap();
    let left: Vec<f64> =
        noisy.iter().zip(&clean).map(|(a, b)| f64::from(*a) / gain_noisy - f64::from(*b) / gain_clean).collect();
    let (length, hz) = (1024, 69.0 * 60.172);
    let (mut sum, mut count) = (0.0, 0.0);
    for frame in left.chunks_exact(length) {
        let (mut re, mut im, mut weights) = (0.0, 0.0, 0.0);
        for (n, value) in frame.iter().enumerate() {
            let weight = 0.5 - 0.5 * (TAU * (n as f64 + 0.5) / length as f64).cos();
            let (sine, cosine) = (TAU * hz * n as f64 / 48_000.0).sin_cos();
            re += weight * value * cosine;
            im += weight * value * sine;
            weights += weight * weight;
        }
        sum += (re * re + im * im) * 2.0 / (48_000.0 * weights);
        count += 1.0;
    }
    let ratio = (0.5 / (sum / count)) / 10_f64.powf(4.2);
    assert!(count > 900.0);
    assert!((ratio - 1.0).abs() < 5.0 / f64::sqrt(count), "C/N0 is off by {} dB", 10.0 * ratio.log10());
}

#[test]
fn take_off_and_landing_come_when_they_should_and_rest_is_exactly_silent() {
    let profile = SpeedProfile { silence_before_s: 0.5, spin_up_s: 0.7, spin_down_s: 0.6, silence_after_s: 0.4 };
    let settings = HoverSettings { duration_s: 4.0, profile, hold_hover_balance: true, ..four_rotors() };
    let parts = HoverSound::new(settings.clone()).unwrap().parts();
    let (_, samples, truth) = rendered(settings.clone()).unwrap();
    let at = |time_s: f64| (time_s * 48_000.0).round() as usize;
    let silent = |range: &[f32]| range.iter().all(|sample| *sample == 0.0);
    assert!(silent(&samples[..=at(parts.spin_up.from_s)]));
    assert!(silent(&samples[at(parts.silence_after.from_s)..]));
    assert!(!silent(&samples[at(parts.spin_up.from_s) + 1..at(parts.spin_up.from_s) + 4800]));
    let level = |from_s: f64, to_s: f64| {
        samples[at(from_s)..at(to_s)].iter().map(|sample| sample.powi(2)).sum::<f32>() / (to_s - from_s) as f32
    };
    assert!(level(0.5, 0.8) < 0.5 * level(1.5, 1.8));

    assert_eq!(truth.mean_speed(0, 0.0, 0.5).unwrap().rev_s(), 0.0);
    assert_eq!(truth.mean_sum_of_squares(3.6, 4.0), Some(0.0));
    assert_eq!(truth.thrust_constant_per_rotor_n_s2(0.4, 9.8, 3.6, 4.0), None);
    let set: f64 = settings.rotors.iter().map(|rotor| rotor.mean_speed.rad_s().powi(2)).sum();
    let held = truth.mean_sum_of_squares(parts.hover.from_s, parts.hover.to_s).unwrap();
    assert!((held / set - 1.0).abs() < 1e-12, "hover balance off by {}", held / set - 1.0);

    let ambient = HoverSettings { ambient_noise: Some(NoiseSettings::default()), ..settings };
    let (_, samples, _) = rendered(ambient).unwrap();
    assert!(!silent(&samples[..at(0.4)]) && !silent(&samples[at(3.7)..]));
}

#[test]
fn settings_out_of_bounds_are_refused_by_name() {
    let refused = |settings: HoverSettings| HoverSound::new(settings).err().map(|error| error.name);
    assert_eq!(refused(HoverSettings::default()), Some("rotors"));
    assert_eq!(refused(HoverSettings { sample_rate_hz: 4000, ..four_rotors() }), Some("sample_rate_hz"));
    assert_eq!(refused(HoverSettings { duration_s: 0.0, ..four_rotors() }), Some("duration_s"));
    assert_eq!(refused(HoverSettings { peak: 1.5, ..four_rotors() }), Some("peak"));
    assert_eq!(refused(HoverSettings { rotors: vec![rotor(0.0)], ..four_rotors() }), Some("mean_speed"));
    let shaky = RotorSound { wander_std_share: 0.2, ..rotor(60.0) };
    assert_eq!(refused(HoverSettings { rotors: vec![shaky], ..four_rotors() }), Some("wander_std_share"));
    let mute = ToneSettings {
        gear_mesh: None,
        blade_pass: None,
        shaft_level: 0.0,
        unlike_blades_level: 0.0,
        level_spread_db: 0.0,
        scatter: None,
    };
    assert_eq!(refused(HoverSettings { tones: mute, ..four_rotors() }), Some("lines to measure the noise against"));
    let toothless = ToneSettings { gear_mesh: Some(GearMeshTones::with_order(0)), ..ToneSettings::default() };
    assert_eq!(refused(HoverSettings { tones: toothless, ..four_rotors() }), Some("gear mesh order"));
}
