//! Channels that cancel each other: each command that mixes them says so, and the advice helps.

use crate::testkit::{hovertone, hovertone_with, steady_hover, text};
use hovertone_sim::prescribed::{HoverSound, Noise, Recording, Sampling, seeded};
use hovertone_vehicle::RotorSpeed;
use std::fs::File;
use std::path::Path;
use std::process::Stdio;

/// Two channels: a hover with noise, and the second with the sign `sign`.
fn write_stereo(path: &Path, sign: f32) {
    let settings = steady_hover("ardrone", RotorSpeed::from_rev_s(60.0), 4.0);
    let rate_hz = settings.sample_rate_hz;
    let (hover, _) = HoverSound::new(settings).unwrap().render_all();
    let mut noise = Recording::of_rotors(&[], Sampling::new(f64::from(rate_hz), 4.0));
    noise.add_noise(&Noise::white(0.003), &mut seeded(1));
    let spec = hound::WavSpec {
        channels: 2,
        sample_rate: rate_hz,
        bits_per_sample: 16,
        sample_format: hound::SampleFormat::Int,
    };
    let mut writer = hound::WavWriter::create(path, spec).unwrap();
    for (sample, noise) in hover.iter().zip(noise.samples_f32()) {
        for value in [*sample, sign * sample + noise] {
            writer.write_sample((value * 32_767.0).round() as i16).unwrap();
        }
    }
    writer.finalize().unwrap();
}

const SAID: &str = "the channels cancel each other";

#[test]
fn a_mix_that_loses_most_of_the_sound_is_said_with_the_flag_that_helps() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("opposite.wav");
    write_stereo(&path, -1.0);
    for command in ["speed", "tones"] {
        let mixed = hovertone(&[command, "--vehicle", "ardrone", text(&path)]);
        assert!(mixed.stderr.contains(SAID) && mixed.stderr.contains("--channel 1"), "{}", mixed.stderr);
        assert!(mixed.stderr.contains(" dB less power than one channel"), "{}", mixed.stderr);
        let one = hovertone(&[command, "--vehicle", "ardrone", "--channel", "1", text(&path)]).ends_with(0);
        assert!(!one.stderr.contains(SAID), "{}", one.stderr);
    }
    let identified = hovertone(&["identify", "--vehicle", "ardrone", "--mass", "420g", text(&path)]);
    assert!(identified.stderr.contains(SAID), "{}", identified.stderr);
    let listen = ["listen", "--vehicle", "ardrone", "--speed", "1000", "--from-file"];
    let of_file = hovertone(&[&listen[..], &[text(&path)]].concat()).stderr;
    assert!(of_file.contains(SAID), "{of_file}");
    let pipe = hovertone_with(&[&listen[..], &["-"]].concat(), |command| {
        command.stdin(Stdio::from(File::open(&path).unwrap()))
    });
    assert!(pipe.stderr.contains(SAID), "{}", pipe.stderr);
}

#[test]
fn channels_of_one_sign_are_mixed_without_a_word() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("alike.wav");
    write_stereo(&path, 1.0);
    let run = hovertone(&["speed", "--vehicle", "ardrone", text(&path)]).ends_with(0);
    assert!(!run.stderr.contains(SAID), "{}", run.stderr);
}
