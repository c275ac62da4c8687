//! One exam for all methods: the same sounds, the same bounds.
use crate::testkit::{SAMPLE_RATE_HZ, TWO_BLADES, analyse, config, hears_nothing, noise, rotor, sound, steady, tone};
use hovertone::sound::{Signal, SignalError};
use hovertone::speed::{Error, Method, Warning, speed_from_source};
use hovertone_sim::prescribed::{Line, Noise, Recording, Rotor, Sampling};

#[test]
fn a_steady_rotor_is_read_within_the_bias_of_its_peak() {
    for speed_rev_s in [41.0, 60.3, 91.77, 203.05, 367.9] {
        let analysis = analyse(steady(speed_rev_s, 5.0, 0.01), &config(2.0));
        let tone = tone(&analysis);
        // the highest harmonic weighs most; its peak is biased by 0.0017 cells (0.02 for the Gaussian) at most, and
        // noise adds a hundredth of that over a hundred frames
        let cell_rev_s = 1.0 / tone.window_s / 2.0;
        for (method, bias_cells) in [(Method::Harmonic, 1e-4), (Method::MaximumTrace, 0.003), (Method::Gaussian, 0.03)]
        {
            let got = tone.speed(method).expect("a speed");
            let error = got.speed.rev_s() - speed_rev_s;
            assert!(error.abs() < bias_cells * cell_rev_s, "{method:?} at {speed_rev_s}: off by {error}");
            assert!(got.frame_count > 10);
            assert!(got.std_uncertainty_rev_s.is_some_and(|std| std < 0.02 * cell_rev_s));
        }
    }
}

#[test]
fn a_drifting_rotor_is_read_as_its_mean_and_followed_along_its_track() {
    let speed_rev_s = |time_s: f64| 90.0 + 1.5 * (0.9 * time_s).sin();
    let rotor = rotor(speed_rev_s, &TWO_BLADES);
    let mut config = config(2.0);
    for method in Method::ALL {
        config.method = method;
        let analysis = analyse(sound(std::slice::from_ref(&rotor), 6.0, 0.01, 2), &config);
        let tone = tone(&analysis);
        assert!(tone.track.len() > 20, "the track must cover the sound");
        let cell_rev_s = 1.0 / tone.window_s / 2.0;
        let mut errors: Vec<f64> =
            tone.track.iter().map(|point| (point.speed_rev_s - speed_rev_s(point.time_s)).abs()).collect();
        errors.sort_by(f64::total_cmp);
        let at = |share: f64| errors[((errors.len() - 1) as f64 * share) as usize];
        assert!(at(0.5) < 0.05 * cell_rev_s, "{method:?}: median {}", at(0.5));
        assert!(at(1.0) < 0.3 * cell_rev_s, "{method:?}: worst {}", at(1.0));
        let truth = (0..6000).map(|ms| speed_rev_s(f64::from(ms) / 1000.0)).sum::<f64>() / 6000.0;
        let got = tone.speed(method).expect("a speed").speed.rev_s();
        assert!((got - truth).abs() < 0.02 * cell_rev_s, "{method:?}: {got} {truth}");
    }
}

#[test]
fn the_gear_mesh_gives_the_same_speed_as_the_blade_pass() {
    let lines = [(2.0, 0.05), (4.0, 0.03), (6.0, 0.02), (69.0, 0.05), (138.0, 0.02), (207.0, 0.01)];
    let rotor = rotor(|_| 60.17, &lines);
    let samples = sound(&[rotor], 5.0, 0.01, 3);
    let mut with_blades = config(69.0);
    with_blades.tone.blades = Some(2);
    for config in [config(2.0), config(69.0), with_blades] {
        let got = tone(&analyse(samples.clone(), &config)).speeds[0].speed.rev_s();
        assert!((got / 60.17 - 1.0).abs() < 1e-3, "order {}: {got}", config.tone.order);
    }
}

#[test]
fn noise_silence_and_an_offset_are_no_rotor() {
    for order in [2.0, 3.0, 69.0] {
        assert!(hears_nothing(&analyse(vec![0.0; 5 * SAMPLE_RATE_HZ as usize], &config(order))), "silence, {order}");
        assert!(hears_nothing(&analyse(vec![0.3; 5 * SAMPLE_RATE_HZ as usize], &config(order))), "offset, {order}");
        assert!(hears_nothing(&analyse(Vec::new(), &config(order))), "nothing, {order}");
        assert!(hears_nothing(&analyse(vec![0.1; 10], &config(order))), "ten samples, {order}");
        for seed in 0..20 {
            let white = noise(&Noise::white(0.1), 4.0, seed);
            assert!(hears_nothing(&analyse(white, &config(order))), "white noise, order {order}, seed {seed}");
        }
    }
}

#[test]
fn noise_that_is_coloured_or_bursts_is_no_rotor() {
    let mut heard = 0;
    for seed in 0..20 {
        let white = noise(&Noise::white(0.1), 5.0, seed);
        let mut band = [0.0f32; 2];
        let red = noise(&Noise::low_passed(0.1, 0.98, 0.0), 5.0, seed);
        // a resonance at 430 Hz, 60 Hz wide
        let (r, turn) = (1.0 - std::f32::consts::PI * 60.0 / 44100.0, std::f32::consts::TAU * 430.0 / 44100.0);
        let hum: Vec<f32> = white
            .iter()
            .map(|x| {
                let y = x * 0.01 + 2.0 * r * turn.cos() * band[0] - r * r * band[1];
                band = [y, band[0]];
                y
            })
            .collect();
        let bursts: Vec<f32> =
            white.iter().enumerate().map(|(n, x)| if (n / 9000) % 3 == 0 { *x } else { 0.01 * x }).collect();
        for (name, samples) in [("red", red), ("resonance", hum), ("bursts", bursts)] {
            if !hears_nothing(&analyse(samples, &config(2.0))) {
                eprintln!("{name} noise, seed {seed}, heard as a rotor");
                heard += 1;
            }
        }
    }
    assert_eq!(heard, 0);
}

#[test]
fn the_gaussian_threshold_changes_little_between_a_half_and_nine_tenths() {
    // the paper's remark 5, on a rotor that wanders as its AR.Drone did
    let speed_rev_s = |time_s: f64| {
        60.17
            * (1.0 + 0.009 * (3.1 * time_s).sin() + 0.008 * (7.7 * time_s + 1.0).sin() + 0.005 * (15.0 * time_s).cos())
    };
    let lines = [(2.0, 0.05), (4.0, 0.03), (69.0, 0.05), (138.0, 0.025), (207.0, 0.0125)];
    let samples = sound(&[rotor(speed_rev_s, &lines)], 10.0, 0.01, 4);
    let speeds: Vec<f64> = [0.5, 0.6, 0.7, 0.8, 0.9]
        .into_iter()
        .map(|share| {
            let mut config = config(69.0);
            config.tone.blades = Some(2);
            config.ridge.gaussian_threshold_share = share;
            let analysis = analyse(samples.clone(), &config);
            tone(&analysis).speed(Method::Gaussian).expect("a speed").speed.rev_s()
        })
        .collect();
    let (low, high) = speeds.iter().fold((f64::MAX, f64::MIN), |(low, high), &s| (low.min(s), high.max(s)));
    // negligible: a tenth of the paper's own difference between its two methods (0.06 % in speed)
    assert!(high / low - 1.0 < 6e-5, "{speeds:?}");
    assert!(high > low, "the threshold must take part in the result");
}

#[test]
fn the_octave_is_right_or_open_whichever_harmonic_is_loudest() {
    let truth_rev_s = 71.3;
    let series: [&[(f64, f64)]; 4] = [
        &[(2.0, 0.1), (4.0, 0.05), (6.0, 0.03)],                            // falling
        &[(2.0, 0.02), (4.0, 0.1), (6.0, 0.06), (8.0, 0.06), (10.0, 0.03)], // second strongest
        &[(1.0, 0.03), (2.0, 0.1), (3.0, 0.02), (4.0, 0.06), (5.0, 0.01), (6.0, 0.05)], // shaft lines between
        &[(2.0, 0.03), (4.0, 0.03), (6.0, 0.1), (8.0, 0.03), (10.0, 0.02)], // third strongest
    ];
    for (index, lines) in series.into_iter().enumerate() {
        let samples = sound(&[rotor(|_| truth_rev_s, lines)], 5.0, 0.02, 5);
        let analysis = analyse(samples, &config(2.0));
        let found = tone(&analysis);
        let got = found.speeds[0].speed.rev_s();
        // with five lines, the second series may also be that of unlike blades at twice the speed: then the octave is left open
        let is_open =
            index == 1 && found.alternatives.iter().any(|other| (other.speed.rev_s() / truth_rev_s - 1.0).abs() < 0.02);
        assert!(is_open || (got / truth_rev_s - 1.0).abs() < 2e-3, "series {index}: {got} {:?}", found.alternatives);
    }
}

#[test]
fn a_whine_in_one_band_does_not_outvote_two_harmonics_that_agree() {
    for whine_amplitude in [0.02, 0.2] {
        let whine = rotor(|_| 570.0, &[(1.0, whine_amplitude)]);
        // two harmonics of the three that are followed, and those above, by which a rotor is heard
        let rotors = [rotor(|_| 90.0, &[(2.0, 0.1), (4.0, 0.05), (8.0, 0.025), (10.0, 0.02)]), whine];
        let analysis = analyse(sound(&rotors, 5.0, 0.005, 11), &config(2.0));
        let got = tone(&analysis).speeds[0].speed.rev_s();
        assert!((got - 90.0).abs() < 0.02, "{got}");
        assert!(analysis.warnings.iter().any(|w| matches!(w, Warning::HarmonicLeftOut { harmonic: 3, .. })));
    }
}

#[test]
fn a_harmonic_that_comes_and_goes_does_not_pull_the_mean() {
    let speed_rev_s = |time_s: f64| 89.28 + 0.144 * time_s;
    let base = rotor(speed_rev_s, &[(2.0, 0.1), (4.0, 0.05), (8.0, 0.025), (10.0, 0.02)]);
    let third = rotor(speed_rev_s, &[(6.0, 0.1)]).with_level(|time_s| if time_s > 6.5 { 1.0 } else { 0.0 });
    let samples = sound(&[base, third], 10.0, 0.002, 12);
    let got = tone(&analyse(samples, &config(2.0))).speeds[0].speed.rev_s();
    assert!((got - 90.0).abs() < 0.02, "{got}");
}

#[test]
fn a_glimpse_of_noise_is_no_rotor() {
    let mut heard = 0;
    for seed in 0..300 {
        let mut config = config(69.0);
        (config.span.from_s, config.span.to_s) = (Some(0.0), Some(0.42));
        heard += usize::from(!hears_nothing(&analyse(noise(&Noise::white(0.1), 0.6, seed), &config)));
    }
    assert_eq!(heard, 0);
}

#[test]
fn recordings_of_any_rate_tell_the_same_speed() {
    for rate in [8000.0, 22050.0, 48000.0, 96000.0, 47123.0] {
        let lines = TWO_BLADES.map(|(order, level)| Line::new(order, level)).to_vec();
        let recording = Recording::of_rotors(&[Rotor::steady(91.3, lines)], Sampling::new(rate, 5.0));
        let mut source = Signal::new(recording.samples_f32(), rate);
        let analysis = speed_from_source(&mut source, &config(2.0), &mut |_| {}).expect("an analysis");
        let got = tone(&analysis).speeds[0].speed.rev_s();
        assert!((got - 91.3).abs() < 0.01, "{rate} Hz: {got}");
    }
}

#[test]
fn a_rate_that_cannot_be_or_cannot_hold_the_tone_is_refused_at_once() {
    for rate in [0.0, -8000.0, f64::NAN, f64::INFINITY, 4294967295.0, 10.0] {
        let mut source = Signal::new(vec![0.1; 1000], rate);
        let refused = speed_from_source(&mut source, &config(2.0), &mut |_| {});
        assert!(matches!(refused, Err(Error::Signal(SignalError::SampleRate { .. }))), "{rate}");
    }
    let mut source = Signal::new(vec![0.1; 3000], 1000.0);
    let refused = speed_from_source(&mut source, &config(69.0), &mut |_| {});
    assert!(matches!(refused, Err(Error::ToneAboveNyquist { .. })), "{refused:?}");
}

#[test]
fn a_window_longer_than_the_hover_is_an_answer_with_its_reason() {
    let mut config = config(2.0);
    config.method = Method::MaximumTrace;
    config.all_methods = false;
    config.spectrogram.window_s = Some(2.0);
    assert!(hears_nothing(&analyse(steady(90.0, 1.5, 0.01), &config)));
}
