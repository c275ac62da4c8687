//! Take-off, landing, silence and handling noise are cut away by themselves, and what the user says overrules.
use crate::testkit::{SAMPLE_RATE_HZ, analyse, config, hears_nothing, noise, rotor, sound, steady, tone};
use hovertone::sound::Signal;
use hovertone::speed::{CutReason, Error, NoTone, Outcome, Warning, speed_from_source};
use hovertone_sim::prescribed::Noise;

/// Silence 0-2 s, run-up 2-4 s, hover 4-12 s at 90 rev/s, run-down 12-14 s, silence to 16 s.
fn flight() -> Vec<f32> {
    let speed_rev_s = |t: f64| 90.0 * ((t - 2.0) / 2.0).clamp(0.0, 1.0).min(((14.0 - t) / 2.0).clamp(0.0, 1.0));
    let lines = [(2.0, 0.1), (4.0, 0.05), (6.0, 0.03)];
    let rotor = rotor(speed_rev_s, &lines).with_level(|t| (speed_rev_s(t) / 90.0).powi(2));
    sound(&[rotor], 16.0, 0.0005, 7)
}

#[test]
fn only_the_hover_of_a_flight_is_used() {
    let analysis = analyse(flight(), &config(2.0));
    let hover = &analysis.hover;
    assert_eq!(hover.segments.len(), 1, "{hover:?}");
    let span = hover.segments[0];
    // rows of 0.5 s, one trimmed at each end, and a ramp that is within the band (8 %) for 0.16 s
    assert!((4.0 - 0.2..=5.5).contains(&span.from_s), "{span:?}");
    assert!((10.5..=12.2).contains(&span.to_s), "{span:?}");
    assert!(hover.cuts.iter().any(|cut| matches!(cut.reason, CutReason::Silence) && cut.span.from_s < 0.1));
    let covered: f64 = hover.length_s() + hover.cuts.iter().map(|cut| cut.span.length_s()).sum::<f64>();
    assert!((covered - 16.0).abs() < 0.1, "nothing is lost: {covered}");
    let speed = tone(&analysis).speeds[0].speed.rev_s();
    assert!((speed - 90.0).abs() < 0.05, "{speed}");
}

#[test]
fn a_knock_on_the_microphone_is_cut_out() {
    let mut samples = steady(90.0, 10.0, 0.002);
    for (n, knock) in noise(&Noise::white(1.0), 0.4, 8).into_iter().enumerate() {
        samples[5 * SAMPLE_RATE_HZ as usize + n] += 3.0 * knock;
    }
    let analysis = analyse(samples, &config(2.0));
    assert!(
        analysis.hover.cuts.iter().any(|cut| matches!(cut.reason, CutReason::HandlingNoise) && cut.span.contains(5.2)),
        "{:?}",
        analysis.hover
    );
    assert_eq!(analysis.hover.segments.len(), 2);
    assert!((tone(&analysis).speeds[0].speed.rev_s() - 90.0).abs() < 0.02);
}

#[test]
fn two_steady_speeds_are_not_averaged_and_the_other_one_is_said() {
    let speed_rev_s = |t: f64| if t < 8.0 { 90.0 } else { 70.0 };
    let lines = [(2.0, 0.1), (4.0, 0.05), (6.0, 0.03)];
    let analysis = analyse(sound(&[rotor(speed_rev_s, &lines)], 14.0, 0.01, 9), &config(2.0));
    assert!((tone(&analysis).speeds[0].speed.rev_s() - 90.0).abs() < 0.05);
    let other = analysis.warnings.iter().find_map(|warning| match warning {
        Warning::OtherSteadySpeed { speed_rev_s, .. } => Some(*speed_rev_s),
        _ => None,
    });
    assert!(other.is_some_and(|speed| (speed - 70.0).abs() < 1.0), "{:?}", analysis.warnings);
}

#[test]
fn from_and_to_overrule() {
    let mut config = config(2.0);
    (config.span.from_s, config.span.to_s) = (Some(5.0), Some(9.0));
    let analysis = analyse(flight(), &config);
    assert_eq!((analysis.hover.segments[0].from_s, analysis.hover.segments[0].to_s), (5.0, 9.0));
    assert!(analysis.hover.cuts.is_empty());
    (config.span.from_s, config.span.to_s) = (Some(0.0), Some(1.5));
    assert!(hears_nothing(&analyse(flight(), &config)));
    (config.span.from_s, config.span.to_s) = (Some(100.0), None);
    let beyond = analyse(flight(), &config);
    assert!(
        matches!(beyond.outcome, Outcome::NoRotorTone { reason: NoTone::OutsideRecording { end_s } } if end_s < 100.0),
        "{:?}",
        beyond.outcome
    );
    (config.span.from_s, config.span.to_s) = (Some(5.0), Some(5.0));
    let error = speed_from_source(&mut Signal::new(flight(), SAMPLE_RATE_HZ), &config, &mut |_| {}).unwrap_err();
    assert!(matches!(error, Error::Config(_)), "{error}");
}

#[test]
fn a_recording_that_starts_late_keeps_its_clock() {
    let mut source = Signal::new(steady(90.0, 6.0, 0.01), SAMPLE_RATE_HZ).with_start_s(3.5);
    let analysis = speed_from_source(&mut source, &config(2.0), &mut |_| {}).unwrap();
    assert!((analysis.heard.from_s - 3.5).abs() < 1e-9 && (analysis.heard.to_s - 9.5).abs() < 1e-3);
    let track = &tone(&analysis).track;
    assert!(track.iter().all(|point| (3.5..9.5).contains(&point.time_s)) && track.len() > 10);
}

#[test]
fn a_given_band_is_where_it_is_looked_for() {
    let lines = [(2.0, 0.02), (4.0, 0.01), (6.0, 0.01)];
    let quiet = rotor(|_| 90.0, &lines);
    let loud = rotor(|_| 61.7, &[(2.0, 0.3), (4.0, 0.1), (6.0, 0.1)]);
    let samples = sound(&[quiet, loud], 5.0, 0.003, 10);
    let mut config = config(2.0);
    for (band_hz, speed_rev_s) in [((115.0, 132.0), 61.7), ((170.0, 190.0), 90.0)] {
        config.tone.band_hz = Some(band_hz);
        assert!((tone(&analyse(samples.clone(), &config)).speeds[0].speed.rev_s() - speed_rev_s).abs() < 0.1);
    }
}

#[test]
fn a_wide_band_does_not_choose_the_octave() {
    // the shaft of unlike blades is loud: an octave down in a band that holds both
    let lines = [(1.0, 0.02), (2.0, 0.03), (3.0, 0.004), (4.0, 0.02), (6.0, 0.012), (8.0, 0.008)];
    let samples = sound(&[rotor(|_| 170.0, &lines)], 5.0, 0.003, 10);
    let mut config = config(2.0);
    for band_hz in [None, Some((30.0, 1600.0)), Some((100.0, 900.0)), Some((300.0, 380.0))] {
        config.tone.band_hz = band_hz;
        let speed_rev_s = tone(&analyse(samples.clone(), &config)).speeds[0].speed.rev_s();
        assert!((speed_rev_s - 170.0).abs() < 0.1, "{band_hz:?}: {speed_rev_s}");
    }
}

#[test]
fn a_band_that_the_recording_cannot_hold_is_an_error_that_says_so() {
    let mut config = config(69.0);
    config.tone.band_hz = Some((23000.0, 24000.0));
    let mut source = Signal::new(steady(90.0, 3.0, 0.01), SAMPLE_RATE_HZ);
    let error = speed_from_source(&mut source, &config, &mut |_| {}).unwrap_err();
    assert!(error.to_string().contains("22050"), "{error}");
}

#[test]
fn the_window_that_is_asked_for_is_used() {
    let mut config = config(2.0);
    config.spectrogram.window_s = Some(0.31);
    let analysis = analyse(steady(90.0, 5.0, 0.01), &config);
    assert_eq!(tone(&analysis).window_s, 0.31);
}

#[test]
fn samples_cover_the_hover_as_set() {
    let mut config = config(2.0);
    (config.samples.length_s, config.samples.overlap) = (2.94, 0.4);
    let analysis = analyse(steady(90.0, 10.0, 0.01), &config);
    let Outcome::Ok(tone) = &analysis.outcome else { panic!("no tone") };
    assert_eq!(tone.samples.len(), 5);
    for sample in &tone.samples {
        assert_eq!(sample.speeds.len(), 3);
        assert!((sample.speeds[0].speed.rev_s() - 90.0).abs() < 0.02);
    }
}

#[test]
fn a_long_hover_has_no_more_frames_than_asked_for() {
    let mut config = config(2.0);
    config.spectrogram.frames_max = 100;
    let analysis = analyse(steady(90.0, 60.0, 0.01), &config);
    let tone = tone(&analysis);
    assert!(tone.ridges.iter().all(|ridge| (90..=101).contains(&ridge.frames.len())));
    let last_s = tone.track.last().map_or(0.0, |point| point.time_s);
    assert!(last_s > 58.0, "the frames still span the hover: {last_s}");
    assert!((tone.speeds[0].speed.rev_s() - 90.0).abs() < 0.01);
}
