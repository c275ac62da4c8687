use std::fs::{self, File};
use std::io::{BufReader, Cursor};
use std::path::PathBuf;

use super::movie_builder::{
    Packet, TrackPlan, boxed, entry_v0, entry_v1, faststart_movie, joined, moov, movie, wave_enda, words,
};
use super::*;

fn read(file: &[u8]) -> Result<Option<Movie>, QuicktimeError> {
    read_movie(&mut Cursor::new(file))
}

fn sowt(chunks: &[(u32, u32)]) -> TrackPlan {
    TrackPlan::pcm(entry_v0(b"sowt", 1, 16, 44_100, &[]), 44_100, 2, chunks)
}

fn samples(file: &[u8]) -> Vec<f32> {
    let movie = read(file).unwrap().unwrap();
    let mut reader = PcmReader::new(Cursor::new(file), &movie.tracks[0]).unwrap();
    let (mut all, mut block) = (Vec::new(), Vec::new());
    while reader.next_block(&mut block).unwrap() > 0 {
        all.extend(&block);
    }
    all
}

#[test]
fn other_formats_are_left_to_others() {
    for bytes in
        [&b""[..], b"RIFF\x24\0\0\0WAVEfmt ", b"\0\0\0\0", b"ID3\x04\0\0\0\0\0\0\0\0", &[0; 64], b"I cannotskip this"]
    {
        assert!(read(bytes).unwrap().is_none(), "{bytes:?}");
    }
}

#[test]
fn boxes_before_the_index_and_sizes_of_both_widths() {
    let data = [0, 0x40];
    let long_mdat = joined(&[&words(&[1]), b"mdat", &18_u64.to_be_bytes(), &data]);
    for (before, mdat, data_at) in [
        (Vec::new(), boxed(b"mdat", &data), 8),
        (boxed(b"wide", &[]), boxed(b"mdat", &data), 16),
        (joined(&[&boxed(b"free", &[0; 5]), &boxed(b"skip", &[]), &boxed(b"uuid", &[7; 20])]), long_mdat, 65),
    ] {
        let head = joined(&[&before, &mdat]);
        // The index takes the rest of the file: size 0.
        let mut index = moov(&[sowt(&[(0, 1)])], data_at, &[]);
        index[..4].fill(0);
        assert_eq!(samples(&joined(&[&head, &index])), [0.5]);
    }
}

#[test]
fn media_data_beyond_four_gigabytes() {
    // A sparse file: only its start and its end have content.
    struct Sparse {
        head: Vec<u8>,
        tail: Vec<u8>,
        tail_at: u64,
        at: u64,
    }
    impl Read for Sparse {
        fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
            let (part, from) = if self.at < self.tail_at { (&self.head, 0) } else { (&self.tail, self.tail_at) };
            let from = usize::try_from(self.at - from).unwrap();
            let count = part.get(from..).unwrap_or_default().len().min(buffer.len());
            buffer[..count].copy_from_slice(&part[from..from + count]);
            self.at += count as u64;
            Ok(count)
        }
    }
    impl Seek for Sparse {
        fn seek(&mut self, to: SeekFrom) -> io::Result<u64> {
            self.at = match to {
                SeekFrom::Start(at) => at,
                SeekFrom::End(by) => (self.tail_at + self.tail.len() as u64).saturating_add_signed(by),
                SeekFrom::Current(by) => self.at.saturating_add_signed(by),
            };
            Ok(self.at)
        }
    }
    let mdat_len = (5_u64 << 30) + 16;
    let head = joined(&[&words(&[1]), b"mdat", &mdat_len.to_be_bytes(), &[0, 0x40]]);
    let mut plan = sowt(&[(16, 1)]);
    plan.is_co64 = true;
    let mut file = Sparse { head, tail: moov(&[plan], 0, &[]), tail_at: mdat_len, at: 0 };
    let movie = read_movie(&mut file).unwrap().unwrap();
    let mut block = Vec::new();
    assert_eq!(PcmReader::new(&mut file, &movie.tracks[0]).unwrap().next_block(&mut block).unwrap(), 1);
    assert_eq!(block, [0.5]);
}

#[test]
fn tracks_of_other_kinds_are_counted_only() {
    let mut video = sowt(&[(0, 1)]);
    video.handler = *b"vide";
    video.entry = Vec::new();
    let found = read(&movie(&[0; 8], &[video.clone(), sowt(&[(0, 4)])])).unwrap().unwrap();
    assert!(found.has_other_tracks && !found.is_fragmented);
    assert_eq!((found.tracks.len(), found.tracks[0].track_id), (1, 2));
    let silent = read(&movie(&[0; 8], &[video])).unwrap().unwrap();
    assert!(silent.tracks.is_empty() && silent.has_other_tracks);
}

#[test]
fn a_fragmented_file_is_not_read_as_pcm() {
    let mut plan = sowt(&[]);
    plan.durations.clear();
    let file = moov(&[plan], 0, &boxed(b"mvex", &[]));
    let found = read(&file).unwrap().unwrap();
    assert!(found.is_fragmented);
    assert_eq!((found.tracks[0].pcm, found.tracks[0].declared_frames), (None, None));
}

#[test]
fn errors_name_what_is_wrong() {
    let text = |bytes: &[u8]| read(bytes).unwrap_err().to_string();
    let whole = movie(&[0; 100], &[sowt(&[(0, 50)])]);
    assert!(
        text(&whole[..60]).contains("no index (moov box) and ends inside its 'mdat' box"),
        "{}",
        text(&whole[..60])
    );
    assert!(text(&whole[..whole.len() - 1]).contains("ends inside its index"));
    assert!(text(&boxed(b"moov", &boxed(b"cmov", &[0; 20]))).contains("compressed index (cmov box)"));
    assert!(text(&boxed(b"moov", &[])).contains("movie header (mvhd)"));
    assert!(text(&boxed(b"ftyp", b"isom")).contains("no index"));
    let absurd = joined(&[&boxed(b"ftyp", b"isom"), &words(&[4]), b"free", &[0; 8]]);
    assert!(text(&absurd).contains("'free' box takes 4 bytes where 16 are left"), "{}", text(&absurd));
    let huge = joined(&[&boxed(b"ftyp", b"isom"), &words(&[1]), b"moov", &u64::MAX.to_be_bytes()]);
    assert!(text(&huge).contains("ends inside its index"), "{}", text(&huge));
}

#[test]
fn cut_at_every_length_and_damaged_at_every_byte_it_never_panics() {
    let mut late = TrackPlan::compressed(
        entry_v1(b"in24", 1, Packet { frames: 1, bytes: 3 }, 44_100, &wave_enda(1)),
        44_100,
        1,
        &[3; 20],
    );
    late.edits = vec![(10, -1, 0x1_0000), (20, 3, 0x1_0000)];
    let plans = [sowt(&[(0, 10), (20, 20)]), late];
    let mut opened = 0;
    for whole in [movie(&[7; 60], &plans), faststart_movie(&[7; 60], &plans)] {
        let mut exercise = |bytes: &[u8]| {
            let Ok(Some(movie)) = read(bytes) else { return };
            opened += 1;
            movie.missing_bytes();
            for track in &movie.tracks {
                assert!(track.packets().count() <= bytes.len());
                let Ok(mut reader) = PcmReader::new(Cursor::new(bytes), track) else { continue };
                let mut block = Vec::new();
                let mut frames = 0;
                while reader.next_block(&mut block).unwrap() > 0 {
                    frames += block.len();
                }
                assert!(frames <= bytes.len());
                reader.missing_frames();
            }
        };
        for len in 0..=whole.len() {
            exercise(&whole[..len]);
        }
        for at in 0..whole.len() {
            for value in [0, 1, 0x7f, 0x80, 0xff] {
                let mut damaged = whole.clone();
                damaged[at] = value;
                exercise(&damaged);
            }
        }
    }
    assert!(opened > 1000, "{opened}");
}

#[test]
fn random_tables_neither_hang_nor_panic() {
    // A 64-bit linear congruential generator (Knuth) writes over the index.
    let mut state = 1_u64;
    let mut next = || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        state >> 33
    };
    let whole = movie(&[7; 600], &[sowt(&[(0, 100), (200, 200)])]);
    for _ in 0..3000 {
        let mut damaged = whole.clone();
        for _ in 0..=next() % 8 {
            let at = usize::try_from(next()).unwrap() % damaged.len();
            damaged[at] = next().to_le_bytes()[0];
        }
        if let Ok(Some(movie)) = read(&damaged) {
            for track in &movie.tracks {
                assert!(track.packets().count() <= damaged.len());
            }
            movie.missing_bytes();
        }
    }
}

/// A file of the shared recordings; `None`, with a message, where they are not installed.
fn recording(name: &str) -> Option<PathBuf> {
    let shared = || PathBuf::from(concat!(env!("CARGO_MANIFEST_DIR"), "/../../../shared/data"));
    let folder = std::env::var_os("HOVERTONE_TEST_DATA").map_or_else(shared, PathBuf::from);
    let path = folder.join(name);
    if !path.exists() {
        println!("skipped: {} is not on this machine", path.display());
        return None;
    }
    Some(path)
}

fn movie_at(path: &PathBuf) -> Result<Movie, QuicktimeError> {
    read_movie(&mut BufReader::new(File::open(path).unwrap())).map(Option::unwrap)
}

/// The 16-bit samples of a WAV file whose `data` chunk is its last.
fn wave_samples(path: &PathBuf) -> Vec<f32> {
    let bytes = fs::read(path).unwrap();
    let data_at = bytes.windows(4).position(|window| window == b"data").unwrap() + 8;
    let (pairs, _) = bytes[data_at..].as_chunks::<2>();
    pairs.iter().map(|pair| f32::from(i16::from_le_bytes(*pair)) / 32_768.0).collect()
}

#[test]
fn uncompressed_recordings_equal_the_wave_file_exactly() {
    let Some(reference) = recording("containers/a_pcm_s16le.wav") else { return };
    let reference = wave_samples(&reference);
    assert_eq!(reference.len(), 220_500);
    for name in ["v_pcm_s16le.mov", "v_pcm_s16be.mov", "v_pcm_s24le.mov", "v_pcm_f32le.mov"] {
        let Some(path) = recording(&format!("containers/{name}")) else { return };
        let movie = movie_at(&path).unwrap();
        let track = &movie.tracks[0];
        assert_eq!((track.sample_rate_hz, track.channel_count), (44_100.0, 1), "{name}");
        assert_eq!((track.skip_frames, track.kept_frames, track.declared_frames), (0, None, Some(220_500)), "{name}");
        assert!(samples(&fs::read(&path).unwrap()) == reference, "{name} differs from the WAV file");
    }
}

/// Content of the tables and the edit list of a recording.
struct Expected {
    name: &'static str,
    tracks: usize,
    codec: &'static [u8; 4],
    start_s: f64,
    skip_frames: u64,
    /// Numbers of kept and declared frames.
    lengths: Option<(u64, u64)>,
}

#[test]
fn edit_lists_of_the_recordings() {
    let expect =
        |name, codec, skip_frames, lengths| Expected { name, tracks: 1, codec, start_s: 0.0, skip_frames, lengths };
    let aac = |name| expect(name, b"mp4a", 1024, Some((220_500, 221_524)));
    let late = expect("v_audio_starts_1s_late.mp4", b"mp4a", 0, Some((221_524, 221_524)));
    let mut checked = 0;
    for expected in [
        aac("v_aac.mp4"),
        aac("v_aac.mov"),
        aac("v_aac.3gp"),
        aac("a_aac.m4a"),
        // The priming frames are played, from 0.976 s on: the sound itself starts at 0.9992 s.
        Expected { start_s: 0.976, ..late },
        expect("v_mp3.mp4", b"mp4a", 1105, Some((220_500, 221_605))),
        expect("v_opus.mp4", b"Opus", 312, Some((240_000, 240_312))),
        expect("a_alac.m4a", b"alac", 0, Some((220_500, 220_500))),
        expect("v_alac.mov", b"alac", 0, Some((220_500, 220_500))),
        expect("v_flac.mp4", b"fLaC", 0, Some((220_500, 220_500))),
        expect("v_aac_frag.mp4", b"mp4a", 0, None),
        Expected { tracks: 2, ..aac("v_two_tracks_first_silent.mp4") },
    ] {
        let name = expected.name;
        let Some(path) = recording(&format!("containers/{name}")) else { return };
        let movie = movie_at(&path).unwrap();
        assert_eq!((movie.tracks.len(), movie.missing_bytes()), (expected.tracks, 0), "{name}");
        let track = movie.tracks.last().unwrap();
        assert_eq!((&track.codec, track.start_s), (expected.codec, expected.start_s), "{name}");
        assert_eq!(
            (track.skip_frames, track.kept_frames.zip(track.declared_frames)),
            (expected.skip_frames, expected.lengths),
            "{name}"
        );
        assert_eq!(movie.is_fragmented, name.contains("frag"), "{name}");
        assert_eq!(track.half_rate_aac, None, "{name}");
        checked += 1;
    }
    assert_eq!(checked, 12);
}

#[test]
fn broken_recordings_say_what_is_missing() {
    let Some(path) = recording("broken-containers/bad_truncated_faststart.mp4") else { return };
    let movie = movie_at(&path).unwrap();
    assert!(movie.missing_bytes() > 10_000, "{}", movie.missing_bytes());
    let track = &movie.tracks[0];
    let whole = track.packets().count();
    assert!((100..217).contains(&whole), "{whole} packets");
    assert!(track.packets().all(|packet| packet.duration_ticks == 1024 && packet.byte_len > 0));
    let Some(path) = recording("broken-containers/bad_truncated_no_moov.mp4") else { return };
    // Cut within the index itself, which stands at the end.
    assert!(matches!(movie_at(&path), Err(QuicktimeError::MoovCut { size: 3862, room: 2901 })));
    let Some(path) = recording("broken-containers/bad_wav_named.mp4") else { return };
    assert!(read(&fs::read(&path).unwrap()).unwrap().is_none());
}
