use std::io::Cursor;

use super::super::movie_builder::{Packet, TrackPlan, boxed, entry_v0, entry_v1, entry_v2, movie};
use super::super::read_movie;
use super::*;

const PLAIN: u32 = 0x1_0000;

fn track(plan: &TrackPlan) -> AudioTrack {
    let file = movie(&[0; 4096], std::slice::from_ref(plan));
    read_movie(&mut Cursor::new(file)).unwrap().unwrap().tracks.remove(0)
}

fn esds(specific: &[u8]) -> Vec<u8> {
    let len = u8::try_from(specific.len()).unwrap();
    let mut payload = vec![0, 0, 0, 0, 0x03, 20 + len, 0, 1, 0, 0x04, 15 + len, 0x40, 0x15];
    payload.extend([0; 11]);
    payload.extend([0x05, len]);
    payload.extend(specific);
    boxed(b"esds", &payload)
}

/// `count` AAC packets of `ticks` each.
fn aac(rate_hz: u16, specific: &[u8], timescale_hz: u32, ticks: u32, count: usize) -> TrackPlan {
    TrackPlan::compressed(entry_v0(b"mp4a", 2, 16, rate_hz, &esds(specific)), timescale_hz, ticks, &vec![8; count])
}

#[test]
fn an_edit_of_the_whole_media_skips_and_keeps_all() {
    let mut plan = aac(44_100, &[0x12, 0x10], 44_100, 1024, 100);
    // 99 x 1024 frames are 2298.78 ms.
    plan.edits = vec![(2299, 1024, PLAIN)];
    let found = track(&plan);
    assert_eq!((found.skip_frames, found.kept_frames), (1024, None));
    assert_eq!((found.declared_frames, found.start_s), (Some(102_400), 0.0));
    assert_eq!((found.track_id, found.is_enabled, found.mp4_object_type), (1, true, Some(0x40)));
}

#[test]
fn an_edit_that_ends_early_keeps_less() {
    let mut plan = aac(44_100, &[0x12, 0x10], 44_100, 1024, 100);
    plan.edits = vec![(1000, 2112, PLAIN)];
    assert_eq!((track(&plan).skip_frames, track(&plan).kept_frames), (2112, Some(44_100)));
    // A duration of 0 means to the end.
    plan.edits = vec![(0, 2112, PLAIN)];
    assert_eq!(track(&plan).kept_frames, None);
}

#[test]
fn a_short_last_packet_is_exact_where_the_edit_is_only_to_a_tick() {
    let mut plan = aac(44_100, &[0x12, 0x10], 44_100, 1024, 100);
    plan.durations = vec![(99, 1024), (1, 340)];
    plan.edits = vec![(2283, 1024, PLAIN)];
    assert_eq!(track(&plan).kept_frames, Some(99 * 1024 + 340 - 1024));
    plan.edits.clear();
    assert_eq!((track(&plan).skip_frames, track(&plan).kept_frames), (0, Some(99 * 1024 + 340)));
}

#[test]
fn empty_edits_make_the_track_start_late() {
    let mut plan = aac(44_100, &[0x12, 0x10], 44_100, 1024, 100);
    plan.edits = vec![(976, -1, PLAIN), (2322, 0, PLAIN)];
    let found = track(&plan);
    assert_eq!((found.start_s, found.skip_frames, found.has_more_edits), (0.976, 0, false));
    plan.edits.push((100, 0, PLAIN));
    assert!(track(&plan).has_more_edits);
}

#[test]
fn the_timescale_of_the_media_need_not_be_the_rate() {
    let mut plan = aac(48_000, &[0x11, 0x90], 1000, 21, 100);
    plan.edits = vec![(2000, 44, PLAIN)];
    let found = track(&plan);
    assert_eq!((found.skip_frames, found.declared_frames), (2112, Some(100_800)));
    assert_eq!(found.kept_frames, Some(96_000));
}

#[test]
fn he_aac_counts_in_frames_of_the_full_rate() {
    // Core 24 kHz, output 48 kHz; a packet is 2048 frames. The container may count in either.
    for timescale_hz in [48_000, 24_000] {
        let ticks = timescale_hz / 48_000 * 1024 + 1024;
        let mut plan = aac(24_000, &[0x2b, 0x11, 0x88, 0x00], timescale_hz, ticks, 10);
        plan.edits = vec![(0, i32::try_from(ticks).unwrap(), PLAIN)];
        let found = track(&plan);
        let half = found.half_rate_aac.unwrap();
        assert_eq!((half.core_rate_hz, half.output_rate_hz), (24_000.0, 48_000.0));
        assert_eq!((found.sample_rate_hz, found.skip_frames, found.declared_frames), (48_000.0, 2048, Some(20_480)));
    }
    // Not signalled, but the entry or the timescale has twice the rate of the configuration.
    let by_entry = track(&aac(48_000, &[0x13, 0x10], 48_000, 2048, 10));
    assert_eq!(by_entry.half_rate_aac.map(|half| half.output_rate_hz), Some(48_000.0));
    let by_timescale = track(&aac(24_000, &[0x13, 0x10], 48_000, 2048, 10));
    assert_eq!((by_timescale.sample_rate_hz, by_timescale.declared_frames), (48_000.0, Some(20_480)));
    assert!(by_timescale.half_rate_aac.is_some());
    assert_eq!(track(&aac(48_000, &[0x11, 0x90], 48_000, 1024, 10)).half_rate_aac, None);
}

#[test]
fn opus_pre_skip_is_taken_once() {
    let config = boxed(b"dOps", &[0, 1, 0x01, 0x38, 0, 0, 0xbb, 0x80, 0, 0, 0]);
    let mut plan = TrackPlan::compressed(entry_v0(b"Opus", 1, 16, 48_000, &config), 48_000, 960, &[8; 50]);
    assert_eq!(track(&plan).skip_frames, 312);
    plan.edits = vec![(0, 312, PLAIN)];
    assert_eq!(track(&plan).skip_frames, 312);
    // An edit from the very start does not make the decoder's run-in audible: the end stays where the edit has it.
    plan.edits = vec![(500, 0, PLAIN)];
    assert_eq!((track(&plan).skip_frames, track(&plan).kept_frames), (312, Some(24_000 - 312)));
}

#[test]
fn rates_beyond_sixteen_bits_come_from_the_timescale() {
    let wrapped = TrackPlan::pcm(entry_v0(b"sowt", 1, 16, 30_464, &[]), 96_000, 2, &[(0, 10)]);
    assert_eq!(track(&wrapped).sample_rate_hz, 96_000.0);
    let zero = TrackPlan::pcm(entry_v0(b"sowt", 1, 16, 0, &[]), 192_000, 2, &[(0, 10)]);
    assert_eq!(track(&zero).sample_rate_hz, 192_000.0);
    let v2 = TrackPlan::pcm(entry_v2(b"lpcm", 1, 88_200.0, [16, 12, 2, 1]), 88_200, 2, &[(0, 10)]);
    assert_eq!(track(&v2).sample_rate_hz, 88_200.0);
}

#[test]
fn packets_of_a_quicktime_version_1_codec() {
    let plan =
        TrackPlan::pcm(entry_v1(b"ima4", 1, Packet { frames: 64, bytes: 34 }, 44_100, &[]), 44_100, 1, &[(0, 128)]);
    let found = track(&plan);
    let lens: Vec<_> = found.packets().map(|packet| (packet.byte_len, packet.duration_ticks)).collect();
    assert_eq!(lens, [(34, 64), (34, 64)]);
    assert_eq!((found.declared_frames, found.pcm), (Some(128), None));
}

#[test]
fn a_reference_movie_has_nothing_to_read() {
    let mut plan = TrackPlan::pcm(entry_v0(b"sowt", 1, 16, 44_100, &[]), 44_100, 2, &[(0, 10)]);
    plan.reference_flags = 0;
    let found = track(&plan);
    assert!(found.is_data_elsewhere && found.pcm.is_none() && found.packets().next().is_none());
    assert_eq!(found.tables_end(), 0);
}

#[test]
fn absurd_channel_counts_are_not_read_as_pcm() {
    for channels in [0, 257, u16::MAX] {
        let plan = TrackPlan::pcm(entry_v0(b"sowt", channels, 16, 44_100, &[]), 44_100, 2, &[(0, 10)]);
        assert_eq!(track(&plan).pcm, None);
    }
}
