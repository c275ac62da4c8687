//! Damaged files: a decoded prefix with a warning, the whole sound with a warning, or one clear error, and soon.

use std::time::{Duration, Instant};

use crate::recordings::{files_of, name_of, native_only, samples, temp_file, test_data};
use hovertone_media::{MediaError, MediaWarning, Recording};
use hovertone_signal::SignalSource;

/// By hand and optimised every file takes a few milliseconds; this bound only tells a hang from a busy machine.
const TIME_MAX: Duration = Duration::from_secs(20);

enum Ending {
    /// Whole, with one warning.
    Whole(fn(&MediaWarning) -> bool),
    /// This much of it, within 5 %.
    Prefix {
        heard_s: f64,
    },
    Refused(fn(&MediaError) -> bool),
}

fn expected(name: &str) -> Option<Ending> {
    use Ending::{Prefix, Refused, Whole};
    let prefix = |heard_s| Some(Prefix { heard_s });
    match name {
        "bad_empty.wav" => Some(Refused(|error| matches!(error, MediaError::Empty))),
        "bad_header_only.wav" => Some(Refused(|error| matches!(error, MediaError::NoSamples { .. }))),
        "bad_random.mp3" => Some(Refused(|error| matches!(error, MediaError::UnknownFormat { .. }))),
        "bad_truncated_no_moov.mp4" => Some(Refused(|error| matches!(error, MediaError::Damaged { .. }))),
        "bad_wav_channels_0.wav" | "bad_wav_rate_0.wav" => {
            Some(Refused(|error| matches!(error, MediaError::BadHeader { value: 0, .. })))
        }
        "bad_mp4_named.wav" | "bad_wav_named.mp4" => {
            Some(Whole(|warning| matches!(warning, MediaWarning::WrongExtension { .. })))
        }
        "bad_nan_inf_f32.wav" => Some(Whole(|warning| matches!(warning, MediaWarning::NonFiniteSamples { count: 11 }))),
        "bad_wav_data_size_0.wav" | "bad_wav_sizes_ffffffff.wav" => {
            Some(Whole(|warning| matches!(warning, MediaWarning::WrongDataSize { actual_bytes: 441_000, .. })))
        }
        "bad_truncated.flac" => prefix(0.627),
        "bad_truncated.mp3" => prefix(1.177),
        "bad_truncated.wav" => prefix(3.400),
        "bad_truncated.webm" => prefix(1.333),
        "bad_truncated_faststart.mp4" => prefix(3.042),
        _ => None,
    }
}

#[test]
fn each_broken_file_ends_as_it_should_and_soon() {
    let Some(folder) = test_data("broken-containers") else { return };
    let files = files_of(&folder);
    assert_eq!(files.len(), 16);
    for path in &files {
        let name = name_of(path);
        let begun = Instant::now();
        let opened = Recording::open(path, &native_only());
        match expected(name).unwrap_or_else(|| panic!("no expectation for {name}")) {
            Ending::Refused(is_right) => {
                let error = opened.err().unwrap_or_else(|| panic!("{name} opened"));
                assert!(is_right(&error), "{name}: {error:?}");
            }
            Ending::Whole(is_right) => {
                let mut recording = opened.unwrap_or_else(|error| panic!("{name}: {error}"));
                assert_eq!(samples(&mut recording).len(), 220_500, "{name}");
                assert!(!recording.is_prefix(), "{name}");
                assert!(
                    matches!(recording.warnings(), [warning] if is_right(warning)),
                    "{name}: {:?}",
                    recording.warnings()
                );
            }
            Ending::Prefix { heard_s } => {
                let mut recording = opened.unwrap_or_else(|error| panic!("{name}: {error}"));
                let decoded_s = samples(&mut recording).len() as f64 / recording.info().sample_rate_hz;
                assert!((decoded_s / heard_s - 1.0).abs() < 0.05, "{name}: {decoded_s} s");
                assert!(recording.is_prefix(), "{name}");
                let warnings = recording.warnings();
                assert!(matches!(warnings, [MediaWarning::Truncated { .. }]), "{name}: {warnings:?}");
                assert!(!warnings[0].hint().is_empty());
            }
        }
        assert!(begun.elapsed() < TIME_MAX, "{name} took {:?}", begun.elapsed());
    }
}

#[test]
fn a_hole_in_the_middle_becomes_silence_so_that_time_stays_right() {
    let Some(folder) = test_data("containers") else { return };
    for (name, hole) in [("a.flac", 60_000..62_000), ("v_aac.mp4", 20_000..22_000), ("a_aac.m4a", 20_000..22_000)] {
        let mut content = std::fs::read(folder.join(name)).unwrap();
        content[hole].fill(0x55);
        let whole = samples(&mut Recording::open(&folder.join(name), &native_only()).unwrap());
        let file = temp_file(name, &content);
        let mut recording = Recording::open(&file.path, &native_only()).unwrap();
        let heard = samples(&mut recording);
        assert_eq!(heard.len(), whole.len(), "{name}");
        assert!(!recording.is_prefix(), "{name}");
        let warnings = recording.warnings().to_vec();
        assert!(
            matches!(warnings[..], [MediaWarning::CorruptPackets { silence_s, .. }] if silence_s > 0.02),
            "{name}: {warnings:?}"
        );
        // The last second is the same at the same time; AAC's noise bands are drawn anew after the hole.
        let last = whole.len() - 44_100;
        let power = |values: &mut dyn Iterator<Item = f32>| values.map(|value| f64::from(value).powi(2)).sum::<f64>();
        let difference = power(&mut heard[last..].iter().zip(&whole[last..]).map(|(a, b)| a - b));
        let part = difference / power(&mut whole[last..].iter().copied());
        assert!(part <= if name == "a.flac" { 0.0 } else { 0.05 }, "{name}: {part} of the end's power differs");
        recording.rewind().unwrap();
        samples(&mut recording);
        assert_eq!(recording.warnings(), warnings, "{name}: counted once");
    }
}

#[test]
fn aiff_and_caf_cut_short_give_a_prefix_too() {
    let Some(folder) = test_data("containers") else { return };
    for name in ["a.aiff", "a.caf"] {
        let mut content = std::fs::read(folder.join(name)).unwrap();
        content.truncate(300_001);
        let file = temp_file(name, &content);
        let mut recording = Recording::open(&file.path, &native_only()).unwrap();
        let heard = samples(&mut recording).len();
        assert!((149_000..150_001).contains(&heard), "{name}: {heard} frames");
        assert!(recording.is_prefix(), "{name}");
        assert!(matches!(recording.warnings(), [MediaWarning::Truncated { .. }]), "{name}: {:?}", recording.warnings());
    }
}
