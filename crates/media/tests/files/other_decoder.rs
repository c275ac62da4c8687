//! Packets for another decoder, and its samples in the place of a decoder: an ffmpeg stands for the decoder of a browser.

use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::Arc;

use crate::recordings::{native_only, samples};
use hovertone_media::{CodedSound, DecodedSound, Decoder, MediaError, OpenOptions, Recording};

const RATE_HZ: u32 = 48_000;
const CHANNELS: usize = 6;
/// Samples of a packet of AAC, and of its priming.
const PACKET_FRAMES: usize = 1024;

/// Runs an ffmpeg in a folder; `None` where there is none.
fn ffmpeg(folder: &Path, words: &str) -> Option<()> {
    let run = Command::new("ffmpeg").args(["-v", "error"]).args(words.split(' ')).current_dir(folder).output();
    let Ok(run) = run else {
        eprintln!("skipped: no ffmpeg on the search path");
        return None;
    };
    assert!(run.status.success(), "{words}: {}", String::from_utf8_lossy(&run.stderr));
    Some(())
}

/// Noise and a tone in six channels of AAC, two seconds long, in three containers and in raw frames; and the same packets decoded.
fn surround(folder: &Path) -> Option<([PathBuf; 4], PathBuf)> {
    let source = "-f lavfi -i sine=440:sample_rate=48000:duration=2 -f lavfi -i anoisesrc=r=48000:d=2:a=0.1:seed=1 \
                  -filter_complex [0][1]amix -ac 6 -c:a aac table.m4a";
    ffmpeg(folder, source)?;
    ffmpeg(folder, "-i table.m4a -c copy clusters.mkv")?;
    ffmpeg(folder, "-i table.m4a -c copy -movflags frag_keyframe+empty_moov -frag_duration 500000 pieces.mp4")?;
    // raw frames have no edit list: the priming is decoded too, as a browser does
    ffmpeg(folder, "-i table.m4a -c copy raw.aac")?;
    ffmpeg(folder, "-i raw.aac -f f32le decoded.f32")?;
    let files = ["table.m4a", "clusters.mkv", "pieces.mp4", "raw.aac"].map(|name| folder.join(name));
    Some((files, folder.join("decoded.f32")))
}

#[test]
fn the_samples_of_another_decoder_are_heard_at_their_time() {
    let folder = tempfile::tempdir().unwrap();
    let Some((files, decoded)) = surround(folder.path()) else { return };
    let all = std::fs::read(&decoded).unwrap();
    let frames: Vec<f32> = all
        .chunks_exact(4 * CHANNELS)
        .map(|frame| {
            let values = frame.as_chunks::<4>().0.iter().map(|bytes| f32::from_le_bytes(*bytes));
            values.sum::<f32>() / CHANNELS as f32
        })
        .collect();
    for file in files {
        let refused = Recording::open(&file, &native_only()).expect_err("hovertone decodes two channels");
        assert!(matches!(refused, MediaError::NeedsFfmpeg { .. }), "{refused}");
        let mut coded = CodedSound::open(&file).unwrap();
        let format = coded.format().clone();
        assert_eq!((&*format.codec, format.channel_count), ("mp4a.40.2", CHANNELS), "{}", file.display());
        assert_eq!(format.sample_rate_hz, f64::from(RATE_HZ), "{}", file.display());
        let mut times_s = Vec::new();
        while let Some(packet) = coded.next_packet().unwrap() {
            assert!(!packet.data.is_empty());
            times_s.push(packet.at_s);
        }
        assert_eq!(times_s.len(), frames.len() / PACKET_FRAMES, "{}", file.display());
        assert!(times_s.is_sorted(), "{}: {times_s:?}", file.display());

        let sound = DecodedSound {
            samples: Arc::new(decoded.clone()),
            channel_count: CHANNELS,
            sample_rate_hz: f64::from(RATE_HZ),
            first_packet_s: times_s[0],
        };
        let options = OpenOptions { decoded: Some(sound), ..native_only() };
        let mut recording = Recording::open(&file, &options).unwrap();
        assert_eq!((recording.info().decoder, recording.info().channel_count), (Decoder::Caller, CHANNELS));
        let heard = samples(&mut recording);
        assert!(!recording.is_prefix(), "{}: {:?}", file.display(), recording.warnings());
        // the priming is left out where the container tells it
        let skipped = [0, PACKET_FRAMES].into_iter().find(|&skip| {
            let wanted = &frames[skip..];
            heard.len() <= wanted.len() && heard.iter().zip(wanted).all(|(one, other)| (one - other).abs() < 1e-5)
        });
        let told = if file.ends_with("table.m4a") { Some(PACKET_FRAMES) } else { skipped };
        assert!(skipped.is_some() && skipped == told, "{}: {skipped:?} frames are left out", file.display());
        assert!(heard.len() + 3 * PACKET_FRAMES > frames.len(), "{}: {} frames", file.display(), heard.len());
    }
}

#[test]
fn what_hovertone_decodes_needs_no_other_decoder() {
    let folder = tempfile::tempdir().unwrap();
    if ffmpeg(folder.path(), "-f lavfi -i sine=440:duration=1 -ac 2 -c:a aac stereo.m4a").is_none() {
        return;
    }
    assert!(CodedSound::open(&folder.path().join("stereo.m4a")).is_none());
    std::fs::write(folder.path().join("notes.txt"), "no sound").unwrap();
    assert!(CodedSound::open(&folder.path().join("notes.txt")).is_none());
    assert!(CodedSound::open(&folder.path().join("gone.m4a")).is_none());
}
