//! What only ffmpeg decodes, where this machine has one.

use std::process::{Command, Stdio};

use crate::recordings::{lag_against, native_only, samples, temp_file, test_data};
use hovertone_media::{Decoder, FfmpegUse, MediaError, OpenOptions, Recording};
use hovertone_signal::SignalSource;

fn has_ffmpeg() -> bool {
    let has = Command::new("ffmpeg").arg("-version").stdout(Stdio::null()).stderr(Stdio::null()).status().is_ok();
    if !has {
        eprintln!("skipped: no ffmpeg on the search path");
    }
    has
}

#[test]
fn ffmpeg_gives_what_hovertone_cannot_decode_at_its_own_rate() {
    let Some(folder) = test_data("containers") else { return };
    if !has_ffmpeg() {
        return;
    }
    let reference = samples(&mut Recording::open(&folder.join("a_pcm_s16le.wav"), &native_only()).unwrap());
    // Container and priming: what ffmpeg itself does not trim (AC-3: 256, AAC: 1024, MP3 without its tag: 1105).
    let files = [
        ("a.ac3", "AC-3", 256),
        ("v_aac.ts", "AAC", 1024),
        ("v_ac3.mkv", "AC-3", 256),
        ("v_mp3.avi", "MP3", 1105),
        ("v_pcm_s16le.avi", "16-bit PCM", 0),
    ];
    for (name, codec, priming) in files {
        let mut recording = Recording::open(&folder.join(name), &OpenOptions::default()).unwrap();
        assert_eq!(recording.info().decoder, Decoder::Ffmpeg, "{name}");
        assert!(
            recording.info().codec.starts_with(codec.split(' ').next().unwrap()) || recording.info().codec == codec
        );
        assert_eq!((recording.sample_rate_hz(), recording.info().channel_count), (44_100.0, 1), "{name}");
        let first = samples(&mut recording);
        assert!(!recording.is_prefix(), "{name}: {:?}", recording.warnings());
        recording.rewind().unwrap();
        assert!(first == samples(&mut recording), "{name} differs in its second pass");
        let (lag, correlation) = lag_against((&reference, 44_100.0), (&first, 44_100.0), 1300);
        // Versions of ffmpeg differ in what they trim: all of the priming, or nothing.
        assert!([0, priming].iter().any(|expected| (lag - expected).abs() <= 2), "{name}: lag {lag}");
        assert!(correlation > 0.95, "{name}: {correlation}");
    }
}

#[test]
fn an_ffmpeg_that_is_not_there_is_named_with_the_codec() {
    let Some(folder) = test_data("containers") else { return };
    let options = OpenOptions { ffmpeg: FfmpegUse::At("/nonexistent/ffmpeg".into()), ..OpenOptions::default() };
    for (name, codec) in [("a.wma", "WMA"), ("v_ac3.mkv", "AC-3")] {
        let error = Recording::open(&folder.join(name), &options).expect_err("there is no ffmpeg");
        assert!(matches!(error, MediaError::NeedsFfmpeg { .. }), "{error}");
        assert!(error.to_string().contains(codec), "{error}");
    }
}

#[test]
fn a_playlist_is_not_followed() {
    if !has_ffmpeg() {
        return;
    }
    let playlist =
        temp_file("list.m3u8", b"#EXTM3U\n#EXT-X-TARGETDURATION:1\n#EXTINF:1,\nfile:///etc/hostname\n#EXT-X-ENDLIST\n");
    assert!(Recording::open(&playlist.path, &OpenOptions::default()).is_err());
    let concat = temp_file("list.ffconcat", b"ffconcat version 1.0\nfile '/etc/hostname'\n");
    assert!(Recording::open(&concat.path, &OpenOptions::default()).is_err());
}

#[test]
fn a_recording_dropped_half_heard_leaves_no_ffmpeg_behind() {
    let Some(folder) = test_data("containers") else { return };
    if !has_ffmpeg() {
        return;
    }
    for _ in 0..3 {
        let mut recording = Recording::open(&folder.join("v_pcm_s16le.avi"), &OpenOptions::default()).unwrap();
        recording.next_block().unwrap();
        // Drop kills and waits: a child that goes on would block here or stay a zombie.
        drop(recording);
    }
}
