//! Recordings whose own fault explains a missing tone: the reason names it, not the place of the microphone.

use crate::testkit::{hovertone, steady_hover, text, write_hover, write_noise};
use hovertone_sim::HoverSettings;
use hovertone_vehicle::RotorSpeed;
use std::path::Path;

/// A WAV file of 32-bit floats.
fn write_floats(path: &Path, samples: &[f32], sample_rate: u32) {
    let spec =
        hound::WavSpec { channels: 1, sample_rate, bits_per_sample: 32, sample_format: hound::SampleFormat::Float };
    let mut writer = hound::WavWriter::create(path, spec).unwrap();
    samples.iter().for_each(|sample| writer.write_sample(*sample).unwrap());
    writer.finalize().unwrap();
}

/// The same samples after a recorder with far too much gain.
fn overdrive(path: &Path, gain: f32) {
    let mut reader = hound::WavReader::open(path).unwrap();
    let rate = reader.spec().sample_rate;
    let clipped = |sample: i16| (gain * f32::from(sample) / 32_768.0).clamp(-1.0, 1.0);
    let samples: Vec<f32> = reader.samples::<i16>().map(|sample| clipped(sample.unwrap())).collect();
    write_floats(path, &samples, rate);
}

#[test]
fn a_missing_tone_is_explained_by_the_fault_of_the_recording() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    write_noise(&at("loud.wav"), 4.0);
    overdrive(&at("loud.wav"), 100.0);
    write_floats(&at("nan.wav"), &[f32::NAN; 96_000], 48_000);
    let hover = steady_hover("ardrone", RotorSpeed::from_rev_s(60.0), 4.0);
    write_hover(&at("low.wav"), HoverSettings { sample_rate_hz: 8_000, ..hover });
    for (name, reason) in [
        ("loud.wav", "no rotor tone: the recording is overdriven: "),
        ("nan.wav", "no rotor tone: the audio samples are no numbers (NaN or infinite)"),
        ("low.wav", "no rotor tone: the sample rate is too low: no sound above 4.0 kHz is recorded"),
    ] {
        let run = hovertone(&["speed", "--vehicle", "ardrone", text(&at(name))]).ends_with(3);
        assert!(run.stderr.contains(reason) && !run.stderr.contains("microphone nearer"), "{name}: {}", run.stderr);
    }
    write_noise(&at("noise.wav"), 4.0);
    let noise = hovertone(&["speed", "--vehicle", "ardrone", text(&at("noise.wav"))]).ends_with(3);
    assert!(!noise.stderr.contains("overdriven"), "{}", noise.stderr);
}
