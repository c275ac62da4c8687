use std::io::Cursor;

use super::super::movie_builder::{Packet, TrackPlan, boxed, entry_v0, entry_v1, entry_v2, movie, wave_enda};
use super::super::{Movie, read_movie};
use super::*;

fn opened(file: &[u8]) -> Movie {
    read_movie(&mut Cursor::new(file)).unwrap().unwrap()
}

fn read_all<R: Read + Seek>(reader: &mut PcmReader<R>) -> Vec<f32> {
    let (mut all, mut block) = (Vec::new(), Vec::new());
    while reader.next_block(&mut block).unwrap() > 0 {
        all.extend(&block);
    }
    all
}

/// The samples of a file of one track with `data` in chunks of two and one frames, and the frames missing.
fn samples(entry: Vec<u8>, constant_size: u32, frame_bytes: u32, data: &[u8]) -> Vec<f32> {
    let plan = TrackPlan::pcm(entry, 44_100, constant_size, &[(0, 2), (2 * frame_bytes, 1)]);
    let file = movie(data, &[plan]);
    let movie = opened(&file);
    assert_eq!(movie.missing_bytes(), 0);
    assert_eq!(movie.tracks[0].declared_frames, Some(3));
    let mut reader = PcmReader::new(Cursor::new(&file), &movie.tracks[0]).unwrap();
    let all = read_all(&mut reader);
    assert_eq!(reader.missing_frames(), 0);
    reader.rewind();
    assert_eq!(read_all(&mut reader), all);
    all
}

#[test]
fn every_layout_to_exact_values() {
    let be_24 = [0x40, 0, 0, 0xc0, 0, 0, 0, 0, 0x01];
    let le_24 = [0, 0, 0x40, 0, 0, 0xc0, 0x01, 0, 0];
    let values_24 = [0.5, -0.5, 1.0 / 8_388_608.0];
    assert_eq!(samples(entry_v1(b"in24", 1, Packet { frames: 1, bytes: 3 }, 44_100, &[]), 3, 3, &be_24), values_24);
    assert_eq!(
        samples(entry_v1(b"in24", 1, Packet { frames: 1, bytes: 3 }, 44_100, &wave_enda(1)), 3, 3, &le_24),
        values_24
    );
    // A constant size of 1 or of one channel, where a frame has more.
    assert_eq!(samples(entry_v1(b"in24", 1, Packet { frames: 1, bytes: 3 }, 44_100, &[]), 1, 3, &be_24), values_24);
    assert_eq!(samples(entry_v2(b"lpcm", 1, 44_100.0, [24, 12, 3, 1]), 3, 3, &le_24), values_24);

    let stereo = [0, 0x40, 0, 0xc0, 1, 0, 0, 0x80, 0, 0, 0, 0x20];
    let stereo_values = [0.5, -0.5, 1.0 / 32_768.0, -1.0, 0.0, 0.25];
    for constant_size in [4, 2, 1] {
        assert_eq!(samples(entry_v0(b"sowt", 2, 16, 44_100, &[]), constant_size, 4, &stereo), stereo_values);
    }
    assert_eq!(
        samples(entry_v0(b"twos", 1, 16, 44_100, &[]), 2, 2, &[0x40, 0, 0x80, 0, 0, 1]),
        [0.5, -1.0, 1.0 / 32_768.0]
    );
    assert_eq!(samples(entry_v0(b"raw ", 1, 8, 44_100, &[]), 1, 1, &[0, 128, 192]), [-1.0, 0.0, 0.5]);
    assert_eq!(samples(entry_v0(b"NONE", 1, 16, 44_100, &[]), 2, 2, &[0x40, 0, 0, 0, 0xc0, 0]), [0.5, 0.0, -0.5]);
    let pcm_c = boxed(b"pcmC", &[0, 0, 0, 0, 1, 32]);
    let floats: Vec<u8> = [0.1_f32, -2.5, 0.75].iter().flat_map(|value| value.to_le_bytes()).collect();
    assert_eq!(samples(entry_v0(b"fpcm", 1, 16, 44_100, &pcm_c), 4, 4, &floats), [0.1, -2.5, 0.75]);
    let doubles: Vec<u8> = [0.1_f64, -2.5, 0.75].iter().flat_map(|value| value.to_be_bytes()).collect();
    assert_eq!(
        samples(entry_v1(b"fl64", 1, Packet { frames: 1, bytes: 8 }, 44_100, &[]), 8, 8, &doubles),
        [0.1, -2.5, 0.75]
    );
    let wide: Vec<u8> = [1_i32 << 30, i32::MIN, 0].iter().flat_map(|value| value.to_be_bytes()).collect();
    assert_eq!(
        samples(entry_v1(b"in32", 1, Packet { frames: 1, bytes: 4 }, 44_100, &[]), 4, 4, &wide),
        [0.5, -1.0, 0.0]
    );
    assert_eq!(
        samples(entry_v0(b"ulaw", 1, 16, 44_100, &[]), 1, 1, &[0xff, 0x80, 0x00]),
        [0.0, 32_124.0 / 32_768.0, -32_124.0 / 32_768.0]
    );
    assert_eq!(
        samples(entry_v0(b"alaw", 1, 16, 44_100, &[]), 1, 1, &[0xd5, 0xaa, 0x2a]),
        [8.0 / 32_768.0, 32_256.0 / 32_768.0, -32_256.0 / 32_768.0]
    );
}

#[test]
fn chunks_apart_and_out_of_order_come_in_the_order_of_the_table() {
    let data: Vec<u8> = (0..100).collect();
    let plan = TrackPlan::pcm(entry_v0(b"raw ", 1, 8, 8000, &[]), 8000, 1, &[(50, 10), (60, 5), (0, 3), (90, 10)]);
    let file = movie(&data, &[plan]);
    let mut reader = PcmReader::new(Cursor::new(&file), &opened(&file).tracks[0]).unwrap();
    let bytes: Vec<u8> = read_all(&mut reader).iter().map(|value| (value * 128.0 + 128.0) as u8).collect();
    assert_eq!(bytes, [(50..65).collect::<Vec<u8>>(), (0..3).collect(), (90..100).collect()].concat());
}

#[test]
fn samples_that_are_blocks_of_frames_are_read_whole() {
    // Two samples of four 16-bit frames each, as ISO muxers write ipcm.
    let pcm_c = boxed(b"pcmC", &[0, 0, 0, 0, 1, 16]);
    let mut plan = TrackPlan::pcm(entry_v0(b"ipcm", 1, 16, 8000, &pcm_c), 8000, 8, &[(0, 1), (8, 1)]);
    plan.durations = vec![(2, 4)];
    let file = movie(&[0, 0x40].repeat(8), &[plan.clone()]);
    let movie_read = opened(&file);
    assert_eq!(movie_read.tracks[0].declared_frames, Some(8));
    assert_eq!(read_all(&mut PcmReader::new(Cursor::new(&file), &movie_read.tracks[0]).unwrap()), [0.5; 8]);
    // The same with the sizes one by one.
    plan.constant_size = 0;
    plan.sizes = vec![8, 8];
    let file = movie(&[0, 0x40].repeat(8), &[plan]);
    assert_eq!(read_all(&mut PcmReader::new(Cursor::new(&file), &opened(&file).tracks[0]).unwrap()), [0.5; 8]);
}

#[test]
fn a_file_that_ends_early_gives_its_prefix_and_says_so() {
    let plan = TrackPlan::pcm(entry_v0(b"twos", 1, 16, 8000, &[]), 8000, 2, &[(0, 30_000), (60_000, 30_000)]);
    let data = [0x40, 0].repeat(60_000);
    let file = super::super::movie_builder::faststart_movie(&data, &[plan]);
    let cut = &file[..file.len() - 70_001];
    let movie = opened(cut);
    assert_eq!(movie.missing_bytes(), 70_001);
    let mut reader = PcmReader::new(Cursor::new(cut), &movie.tracks[0]).unwrap();
    let all = read_all(&mut reader);
    assert_eq!((all.len(), reader.missing_frames()), (24_999, 35_001));
    assert!(all.iter().all(|value| *value == 0.5));
    // A file that has become shorter since its index was read.
    let mut reader = PcmReader::new(Cursor::new(cut), &opened(&file).tracks[0]).unwrap();
    assert_eq!((read_all(&mut reader).len(), reader.missing_frames()), (24_999, 35_001));
}

#[test]
fn chunks_that_lie_over_each_other_end_after_the_length_of_the_file() {
    let mut plan = TrackPlan::pcm(entry_v0(b"raw ", 1, 8, 8000, &[]), 8000, 1, &[(0, 1000)]);
    plan.chunks = vec![(0, 1000); 500];
    plan.sample_count = 500_000;
    let file = movie(&[128; 1000], &[plan]);
    let mut reader = PcmReader::new(Cursor::new(&file), &opened(&file).tracks[0]).unwrap();
    let delivered = read_all(&mut reader).len();
    assert!(delivered <= file.len() && delivered + 1000 > file.len(), "{delivered} of {}", file.len());
    assert!(reader.missing_frames() > 0);
}

#[test]
fn a_compressed_track_is_refused() {
    let plan = TrackPlan::compressed(entry_v0(b"mp4a", 1, 16, 8000, &[]), 8000, 1024, &[4]);
    let file = movie(&[0; 4], &[plan]);
    let error = PcmReader::new(Cursor::new(&file), &opened(&file).tracks[0]).unwrap_err();
    assert_eq!(error.to_string(), "the codec 'mp4a' is not uncompressed sound");
}
