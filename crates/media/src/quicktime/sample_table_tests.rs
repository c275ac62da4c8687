use super::super::movie_builder::{TrackPlan, boxed, entry_v0, joined, words};
use super::*;

fn table_of(plan: &TrackPlan) -> Arc<SampleTable> {
    let stbl = plan.stbl(0);
    Arc::new(SampleTable::from_stbl(&stbl[8..]).unwrap())
}

fn compressed(sizes: &[u32]) -> TrackPlan {
    TrackPlan::compressed(entry_v0(b"mp4a", 2, 16, 44_100, &[]), 44_100, 1024, sizes)
}

#[test]
fn packets_of_three_chunks_in_order() {
    let mut plan = compressed(&[10, 20, 30, 40, 50]);
    plan.chunks = vec![(100, 2), (1000, 2), (400, 1)];
    plan.durations = vec![(3, 1024), (2, 500)];
    let packets: Vec<_> = table_of(&plan).packets(5000).map(|p| (p.offset, p.byte_len, p.duration_ticks)).collect();
    assert_eq!(packets, [(100, 10, 1024), (110, 20, 1024), (1000, 30, 1024), (1030, 40, 500), (400, 50, 500)]);
    assert_eq!(table_of(&plan).end_offset(), 1070);
    assert_eq!(table_of(&plan).duration_ticks(), 3 * 1024 + 2 * 500);
}

#[test]
fn a_run_of_chunks_lasts_until_the_next_run() {
    let stbl = joined(&[
        &boxed(b"stco", &words(&[0, 4, 0, 100, 200, 300])),
        // Chunks 1 to 3 hold two samples, chunk 4 holds one.
        &boxed(b"stsc", &words(&[0, 2, 1, 2, 1, 4, 1, 1])),
        &boxed(b"stsz", &words(&[0, 5, 7])),
        &boxed(b"stts", &words(&[0, 1, 7, 1])),
    ]);
    let table = Arc::new(SampleTable::from_stbl(&stbl).unwrap());
    let offsets: Vec<_> = Arc::clone(&table).packets(1000).map(|packet| packet.offset).collect();
    assert_eq!(offsets, [0, 5, 100, 105, 200, 205, 300]);
}

#[test]
fn packets_end_at_the_first_that_is_not_whole_in_the_file() {
    let table = table_of(&compressed(&[10, 20, 30]));
    assert_eq!(Arc::clone(&table).packets(60).count(), 3);
    assert_eq!(Arc::clone(&table).packets(59).count(), 2);
    assert_eq!(Arc::clone(&table).packets(30).count(), 2);
    assert_eq!(Arc::clone(&table).packets(0).count(), 0);
    let mut ended = Arc::clone(&table).packets(59);
    assert_eq!(ended.by_ref().count(), 2);
    assert_eq!(ended.next(), None);
}

#[test]
fn chunks_that_overlap_do_not_give_more_than_the_file_has() {
    let mut plan = compressed(&[]);
    plan.chunks = vec![(0, u32::MAX); 50];
    plan.constant_size = 1;
    plan.sample_count = u32::MAX;
    assert_eq!(table_of(&plan).packets(4000).count(), 4000);
}

#[test]
fn compact_sizes_of_four_eight_and_sixteen_bits() {
    let stz2 = |bits: u32, bytes: &[u8]| joined(&[&words(&[0, bits, 3]), bytes]);
    assert_eq!(compact_sizes(&stz2(4, &[0x12, 0x30])), [1, 2, 3]);
    assert_eq!(compact_sizes(&stz2(8, &[1, 2, 3, 4])), [1, 2, 3]);
    assert_eq!(compact_sizes(&stz2(16, &[1, 0, 0, 2, 0, 3])), [256, 2, 3]);
    assert_eq!(compact_sizes(&stz2(5, &[1, 2, 3])), [0_u32; 0]);
}

#[test]
fn frames_counted_as_samples_give_packets_of_a_group() {
    // ima4: 64 frames in 34 bytes; 130 samples are two packets and a rest that is none.
    let mut plan = TrackPlan::pcm(entry_v0(b"ima4", 1, 16, 44_100, &[]), 44_100, 1, &[(0, 64), (50, 66)]);
    plan.durations = vec![(130, 1)];
    let mut table = SampleTable::clone(&table_of(&plan));
    table.correct_constant_size(34, 64);
    let packets: Vec<_> = Arc::new(table).packets(1000).map(|p| (p.offset, p.byte_len, p.duration_ticks)).collect();
    assert_eq!(packets, [(0, 34, 64), (50, 34, 64)]);
}

#[test]
fn counts_beyond_the_boxes_allocate_nothing() {
    let stbl = joined(&[
        &boxed(b"stco", &words(&[0, u32::MAX, 0])),
        &boxed(b"stsc", &words(&[0, u32::MAX, 1, u32::MAX, 1])),
        &boxed(b"stsz", &words(&[0, 0, u32::MAX, 9])),
        &boxed(b"stts", &words(&[0, u32::MAX, u32::MAX, u32::MAX])),
    ]);
    let table = Arc::new(SampleTable::from_stbl(&stbl).unwrap());
    assert_eq!((table.chunk_offsets.len(), table.sample_count), (1, 1));
    assert_eq!(Arc::clone(&table).packets(100).count(), 1);
    assert_eq!(table.duration_ticks(), u64::from(u32::MAX) * u64::from(u32::MAX));
}

#[test]
fn a_change_of_description_is_seen() {
    let stsc = boxed(b"stsc", &words(&[0, 2, 1, 1, 1, 2, 1, 2]));
    assert!(SampleTable::from_stbl(&stsc).unwrap().has_mixed_descriptions);
}
