//! The same five seconds in 52 containers and codecs: each gives the right sound at the right time, or names its codec.

use crate::recordings::{files_of, lag_against, name_of, native_only, samples, test_data};
use hovertone_media::{MediaWarning, Recording};
use hovertone_signal::SignalSource;

const REFERENCE: &str = "a_pcm_s16le.wav";
const DURATION_S: f64 = 5.0;
const LAG_MAX: i64 = 1300;

/// The edit list of a late track counts in milliseconds of the movie.
const MOVIE_TICK_FRAMES: i64 = 45;

/// Priming of AAC that the container does not tell: raw ADTS, Matroska of an old muxer, a fragmented MP4 without edits.
const AAC_PRIMING: i64 = 1024;

/// Frames that a whole packet or block of any of these codecs may add at the end.
const TAIL_S: f64 = 0.05;

enum Ending {
    /// The reference at this rate, this late, this much alike.
    Sound { rate_hz: f64, lag: i64, correlation_min: f64 },
    /// The error says this.
    Refused(&'static [&'static str]),
    /// Two seconds of zeros.
    Silence,
}

fn expected(name: &str) -> Option<Ending> {
    use Ending::{Refused, Silence, Sound};
    let sound = |rate_hz, lag, correlation_min| Some(Sound { rate_hz, lag, correlation_min });
    match name {
        "a.ac3" => Some(Refused(&["AC-3", "ffmpeg"])),
        "a.wma" => Some(Refused(&["WMA", "ffmpeg"])),
        "v_aac.ts" => Some(Refused(&["MPEG-TS", "ffmpeg"])),
        "v_ac3.mkv" => Some(Refused(&["Matroska", "AC-3", "ffmpeg"])),
        "v_mp3.avi" => Some(Refused(&["AVI", "MP3", "ffmpeg"])),
        "v_pcm_s16le.avi" => Some(Refused(&["AVI", "PCM", "ffmpeg"])),
        "v_no_audio.mp4" => Some(Refused(&["no audio track"])),
        "a_digital_silence.wav" => Some(Silence),
        "a_96k_stereo.wav" => sound(96_000.0, 0, 0.9),
        "a_mulaw_8k.wav" => sound(8_000.0, 0, 0.6),
        "a_ima_adpcm.wav" => sound(44_100.0, 0, 0.99),
        "a_pcm_u8.wav" => sound(44_100.0, 0, 0.999),
        "a_clipped.wav" => sound(44_100.0, 0, 0.9),
        "a_adts.aac" | "v_aac.mkv" | "v_aac_frag.mp4" => sound(44_100.0, AAC_PRIMING, 0.95),
        name if name.contains("opus") => sound(48_000.0, 0, 0.9),
        name if name.contains("pcm") || name.contains("flac") || name.contains("alac") => sound(44_100.0, 0, 0.9999),
        "a.aiff" | "a.caf" | "a_rf64.wav" | "a_w64.w64" | "a_dc_offset.wav" => sound(44_100.0, 0, 0.9999),
        name if ["aac", "mp3", "vorbis", "two_tracks", "starts_1s_late"].iter().any(|codec| name.contains(codec)) => {
            sound(44_100.0, 0, 0.95)
        }
        _ => None,
    }
}

#[test]
fn each_container_gives_the_same_sound_at_the_same_time_or_names_its_codec() {
    let Some(folder) = test_data("containers") else { return };
    let mut reference = Recording::open(&folder.join(REFERENCE), &native_only()).unwrap();
    let reference_rate_hz = reference.sample_rate_hz();
    let reference = samples(&mut reference);

    let files = files_of(&folder);
    assert!(files.len() >= 52, "the folder holds {} files", files.len());
    for path in &files {
        let name = name_of(path);
        let ending = expected(name).unwrap_or_else(|| panic!("no expectation for {name}"));
        let opened = Recording::open(path, &native_only());
        match ending {
            Ending::Refused(words) => {
                let error = opened.err().unwrap_or_else(|| panic!("{name} opened")).to_string();
                for word in words {
                    assert!(error.contains(word), "{name}: \u{201c}{error}\u{201d} does not say {word}");
                }
            }
            Ending::Silence => {
                let heard = samples(&mut opened.unwrap());
                assert_eq!(heard.len(), 88_200, "{name}");
                assert!(heard.iter().all(|sample| *sample == 0.0), "{name}");
            }
            Ending::Sound { rate_hz, lag, correlation_min } => {
                let mut recording = opened.unwrap_or_else(|error| panic!("{name}: {error}"));
                let heard = samples(&mut recording);
                assert_eq!(recording.sample_rate_hz(), rate_hz, "{name}");
                let duration_s = heard.len() as f64 / rate_hz - lag.max(0) as f64 / rate_hz;
                assert!((DURATION_S - 0.001..=DURATION_S + TAIL_S).contains(&duration_s), "{name}: {duration_s} s");
                assert!(!recording.is_prefix(), "{name} is whole: {:?}", recording.warnings());
                let (found, correlation) = lag_against((&reference, reference_rate_hz), (&heard, rate_hz), LAG_MAX);
                // The late track's priming is part of its time, and is held against it below.
                let found = if name.contains("starts_1s_late") { found - AAC_PRIMING } else { found };
                assert!((found - lag).abs() <= 2, "{name}: {found} frames late, expected {lag}");
                assert!(correlation >= correlation_min, "{name}: correlation {correlation}");
            }
        }
    }
}

#[test]
fn sound_that_starts_late_in_a_video_keeps_its_time() {
    let Some(folder) = test_data("containers") else { return };
    let recording = Recording::open(&folder.join("v_audio_starts_1s_late.mp4"), &native_only()).unwrap();
    // The track begins with its priming, one second less 1024 frames into the movie.
    let expected_s = 1.0 - AAC_PRIMING as f64 / 44_100.0;
    let tolerance_s = MOVIE_TICK_FRAMES as f64 / 44_100.0;
    assert!((recording.start_s() - expected_s).abs() <= tolerance_s, "{}", recording.start_s());
}

#[test]
fn the_first_track_that_is_not_silent_is_chosen_with_a_warning() {
    let Some(folder) = test_data("containers") else { return };
    let path = folder.join("v_two_tracks_first_silent.mp4");
    let recording = Recording::open(&path, &native_only()).unwrap();
    assert_eq!((recording.info().audio_track, recording.info().audio_track_count), (2, 2));
    let several = MediaWarning::SeveralAudioTracks { chosen: 2, count: 2, silent: vec![1] };
    assert_eq!(recording.warnings(), [several]);

    let mut options = native_only();
    options.audio_track = Some(1);
    let mut asked = Recording::open(&path, &options).unwrap();
    assert!(samples(&mut asked).iter().all(|sample| sample.abs() < 1e-3), "the first track is silent");
    assert_eq!(asked.warnings(), []);
    for no_such in [0, 3] {
        options.audio_track = Some(no_such);
        let error = Recording::open(&path, &options).expect_err("there is no such track").to_string();
        assert!(error.contains("the file has audio tracks 1 to 2"), "{error}");
    }
}

#[test]
fn a_second_pass_gives_the_same_samples_and_no_warning_twice() {
    let Some(folder) = test_data("containers") else { return };
    let mut heard = 0;
    for path in files_of(&folder) {
        let Ok(mut recording) = Recording::open(&path, &native_only()) else { continue };
        let first = samples(&mut recording);
        let warnings = recording.warnings().to_vec();
        recording.rewind().unwrap();
        // From the middle of a pass too.
        recording.next_block().unwrap();
        recording.rewind().unwrap();
        let second = samples(&mut recording);
        assert!(first == second, "{} differs in its second pass", name_of(&path));
        assert_eq!(recording.warnings(), warnings, "{}", name_of(&path));
        heard += 1;
    }
    assert!(heard >= 45, "{heard} files were heard");
}
