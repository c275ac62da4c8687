//! WAVE files whose every value is known: each width is read exactly, channels are chosen and mixed.

use crate::recordings::{native_only, samples, temp_file, wav_bytes};
use hovertone_media::{Container, Decoder, MediaError, MediaWarning, Recording};
use hovertone_signal::SignalSource;

const RATE_HZ: u32 = 12_345;

fn heard(code: u16, bits: u16, data: &[u8]) -> Vec<f32> {
    let file = temp_file("sound.wav", &wav_bytes(code, 1, RATE_HZ, bits, data));
    let mut recording = Recording::open(&file.path, &native_only()).unwrap();
    assert_eq!(recording.sample_rate_hz(), f64::from(RATE_HZ));
    assert_eq!(recording.info().container, Container::Wav);
    assert_eq!(recording.info().decoder, Decoder::Native);
    let heard = samples(&mut recording);
    assert!(!recording.is_prefix());
    assert_eq!(recording.warnings(), []);
    heard
}

#[test]
fn pcm_of_every_width_is_read_exactly() {
    assert_eq!(heard(1, 8, &[0, 64, 128, 192, 255]), [-1.0, -0.5, 0.0, 0.5, 127.0 / 128.0]);

    let values = [i16::MIN, -16_384, -1, 0, 1, 16_384, i16::MAX];
    let bytes: Vec<u8> = values.iter().flat_map(|value| value.to_le_bytes()).collect();
    assert_eq!(heard(1, 16, &bytes), values.map(|value| f32::from(value) / 32_768.0));

    let values = [-8_388_608_i32, -4_194_304, -1, 0, 1, 4_194_304, 8_388_607];
    let bytes: Vec<u8> = values.iter().flat_map(|value| value.to_le_bytes()[..3].to_vec()).collect();
    assert_eq!(heard(1, 24, &bytes), values.map(|value| value as f32 / 8_388_608.0));

    // Multiples of 2^8 survive in the 24 bits of an f32.
    let values = [i32::MIN, -(1 << 30), -256, 0, 256, 1 << 30, i32::MAX - 255];
    let bytes: Vec<u8> = values.iter().flat_map(|value| value.to_le_bytes()).collect();
    assert_eq!(heard(1, 32, &bytes), values.map(|value| (f64::from(value) / 2_147_483_648.0) as f32));

    let values = [-1.5_f32, -0.1, 0.0, 1e-30, 0.7, 2.0];
    let bytes: Vec<u8> = values.iter().flat_map(|value| value.to_le_bytes()).collect();
    assert_eq!(heard(3, 32, &bytes), values);

    let values = [-1.5_f64, -0.1, 0.0, 1e-30, 0.7, 2.0];
    let bytes: Vec<u8> = values.iter().flat_map(|value| value.to_le_bytes()).collect();
    assert_eq!(heard(3, 64, &bytes), values.map(|value| value as f32));
}

#[test]
fn companded_samples_follow_g711() {
    // ITU-T G.711, tables 1a and 2a: the extreme and the smallest codes, in units of 16-bit full scale.
    assert_eq!(
        heard(7, 8, &[0x00, 0x80, 0x7f, 0xff]),
        [-32_124.0, 32_124.0, 0.0, 0.0].map(|value: f32| value / 32_768.0)
    );
    assert_eq!(
        heard(6, 8, &[0xaa, 0x2a, 0xd5, 0x55]),
        [32_256.0, -32_256.0, 8.0, -8.0].map(|value: f32| value / 32_768.0)
    );
}

#[test]
fn the_mean_of_all_channels_is_heard_unless_one_is_chosen() {
    let frames: [[i16; 3]; 3] = [[300, 600, 3000], [0, -3, 6], [-32_768, -32_768, -32_768]];
    let bytes: Vec<u8> = frames.iter().flatten().flat_map(|value| value.to_le_bytes()).collect();
    let file = temp_file("three.wav", &wav_bytes(1, 3, RATE_HZ, 16, &bytes));
    let mut options = native_only();
    let mean = samples(&mut Recording::open(&file.path, &options).unwrap());
    assert_eq!(mean, [1300.0, 1.0, -32_768.0].map(|value: f32| value / 32_768.0));
    for channel in 1..=3 {
        options.channel = Some(channel);
        let one = samples(&mut Recording::open(&file.path, &options).unwrap());
        assert_eq!(one, frames.map(|frame| f32::from(frame[channel - 1]) / 32_768.0));
    }
    for no_such in [0, 4] {
        options.channel = Some(no_such);
        let error = Recording::open(&file.path, &options).expect_err("there is no such channel");
        assert!(matches!(error, MediaError::NoSuchChannel { count: 3, .. }), "{error}");
    }
}

#[test]
fn long_sound_comes_in_blocks_of_bounded_length_and_again_after_rewind() {
    let data: Vec<u8> = (0..100_000_u32).flat_map(|frame| ((frame * 7919) as i16).to_le_bytes()).collect();
    let file = temp_file("long.wav", &wav_bytes(1, 1, RATE_HZ, 16, &data));
    let mut recording = Recording::open(&file.path, &native_only()).unwrap();
    let expected: Vec<f32> = (0..100_000_u32).map(|frame| f32::from((frame * 7919) as i16) / 32_768.0).collect();
    for _ in 0..2 {
        let mut at = 0;
        while let Some(block) = recording.next_block().unwrap() {
            assert!((1..=16_384).contains(&block.len()), "a block of {}", block.len());
            assert_eq!(block, &expected[at..at + block.len()]);
            at += block.len();
        }
        assert_eq!(at, expected.len());
        assert!(recording.next_block().unwrap().is_none(), "the end stays the end");
        recording.rewind().unwrap();
    }
}

#[test]
fn samples_that_are_not_numbers_become_zero_and_are_counted_once() {
    let values = [0.5, f32::NAN, f32::INFINITY, f32::NEG_INFINITY, -0.5];
    let bytes: Vec<u8> = values.iter().flat_map(|value| value.to_le_bytes()).collect();
    let file = temp_file("nan.wav", &wav_bytes(3, 1, RATE_HZ, 32, &bytes));
    let mut recording = Recording::open(&file.path, &native_only()).unwrap();
    for _ in 0..2 {
        assert_eq!(samples(&mut recording), [0.5, 0.0, 0.0, 0.0, -0.5]);
        assert_eq!(recording.warnings(), [MediaWarning::NonFiniteSamples { count: 3 }]);
        recording.rewind().unwrap();
    }
}

#[test]
fn a_header_that_promises_more_than_the_file_holds_gives_a_prefix() {
    let mut wav = wav_bytes(1, 1, RATE_HZ, 16, &[0, 64].repeat(1000));
    wav.truncate(44 + 1001);
    let file = temp_file("cut.wav", &wav);
    let mut recording = Recording::open(&file.path, &native_only()).unwrap();
    assert_eq!(samples(&mut recording).len(), 500, "half a sample at the end is dropped");
    assert!(recording.is_prefix());
    assert!(matches!(recording.warnings(), [MediaWarning::Truncated { declared_s: Some(_), .. }]));
}
