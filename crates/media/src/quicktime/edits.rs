//! The edit list: the played part of a track, and its time.
//!
//! ISO/IEC 14496-12 section 8.6.6 (`elst`), QuickTime File Format "Edit list atom". Each entry has a duration in the
//! movie's timescale, a start in the track's own timescale (-1: nothing is played, the track waits) and a speed. Encoders
//! use one entry to hide their priming frames and an empty one to start a track late.

use super::boxes::{be_u16, be_u32, be_u64};

/// Meaning of the edit list of a track.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(super) struct Edits {
    /// Movie ticks before the first frame is heard.
    pub(super) wait_movie_ticks: u64,
    /// The first played part. `None` without an edit list, or with waiting times only.
    pub(super) played: Option<Played>,
    /// The list has more than one start and one length: more parts, or a speed other than 1.
    pub(super) has_more: bool,
}

/// A stretch of the track.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Played {
    /// Start, in ticks of the track's timescale.
    pub(super) start_media_ticks: u64,
    /// Length in movie ticks. Zero means to the end (fragmented files).
    pub(super) length_movie_ticks: u64,
}

/// Reads the payload of `elst`. Entries beyond its end are ignored.
pub(super) fn edits_from_elst(payload: &[u8]) -> Edits {
    let is_64_bit = payload.first() == Some(&1);
    let entry_len = if is_64_bit { 20 } else { 12 };
    let count = be_u32(payload, 4).and_then(|count| usize::try_from(count).ok()).unwrap_or(0);
    let mut edits = Edits::default();
    for entry in payload.get(8..).unwrap_or_default().chunks_exact(entry_len).take(count) {
        let times = if is_64_bit {
            be_u64(entry, 0).zip(be_u64(entry, 8).map(u64::cast_signed))
        } else {
            be_u32(entry, 0).map(u64::from).zip(be_u32(entry, 4).map(|ticks| i64::from(ticks.cast_signed())))
        };
        let Some((length_movie_ticks, media_time)) = times else { break };
        // 16.16 fixed point: 0 holds one frame, anything but 1 changes the speed.
        let is_plain = be_u16(entry, entry_len - 4) == Some(1) && be_u16(entry, entry_len - 2) == Some(0);
        match u64::try_from(media_time) {
            _ if edits.played.is_some() => edits.has_more = true,
            Err(_) => edits.wait_movie_ticks = edits.wait_movie_ticks.saturating_add(length_movie_ticks),
            Ok(start_media_ticks) => {
                edits.played = Some(Played { start_media_ticks, length_movie_ticks });
                edits.has_more |= !is_plain;
            }
        }
    }
    edits
}

#[cfg(test)]
mod tests {
    use super::*;

    fn elst(entries: &[(u32, i32, u32)]) -> Vec<u8> {
        let mut payload = vec![0; 4];
        payload.extend(u32::try_from(entries.len()).unwrap().to_be_bytes());
        for (length, start, speed) in entries {
            payload.extend(length.to_be_bytes());
            payload.extend(start.to_be_bytes());
            payload.extend(speed.to_be_bytes());
        }
        payload
    }

    const PLAIN: u32 = 0x1_0000;

    #[test]
    fn one_edit_skips_the_priming_frames() {
        let edits = edits_from_elst(&elst(&[(5000, 1024, PLAIN)]));
        let played = Some(Played { start_media_ticks: 1024, length_movie_ticks: 5000 });
        assert_eq!(edits, Edits { wait_movie_ticks: 0, played, has_more: false });
    }

    #[test]
    fn empty_edits_add_up() {
        let edits = edits_from_elst(&elst(&[(400, -1, PLAIN), (576, -1, PLAIN), (5024, 0, PLAIN)]));
        assert_eq!(edits.wait_movie_ticks, 976);
        assert_eq!(edits.played, Some(Played { start_media_ticks: 0, length_movie_ticks: 5024 }));
        assert!(!edits.has_more);
    }

    #[test]
    fn more_parts_or_another_speed_are_flagged() {
        let first = Some(Played { start_media_ticks: 0, length_movie_ticks: 10 });
        let two = edits_from_elst(&elst(&[(10, 0, PLAIN), (20, 500, PLAIN)]));
        assert!(two.has_more && two.played == first);
        assert!(edits_from_elst(&elst(&[(10, 0, PLAIN), (20, -1, PLAIN)])).has_more);
        assert!(edits_from_elst(&elst(&[(10, 0, 2 * PLAIN)])).has_more);
    }

    #[test]
    fn sixty_four_bit_entries() {
        let mut payload = vec![1, 0, 0, 0, 0, 0, 0, 2];
        payload.extend((1_u64 << 33).to_be_bytes());
        payload.extend((-1_i64).to_be_bytes());
        payload.extend(PLAIN.to_be_bytes());
        payload.extend(7_u64.to_be_bytes());
        payload.extend((1_i64 << 34).to_be_bytes());
        payload.extend(PLAIN.to_be_bytes());
        let played = Some(Played { start_media_ticks: 1 << 34, length_movie_ticks: 7 });
        assert_eq!(edits_from_elst(&payload), Edits { wait_movie_ticks: 1 << 33, played, has_more: false });
    }

    #[test]
    fn a_count_beyond_the_box_is_not_believed() {
        let mut payload = elst(&[(10, 5, PLAIN)]);
        payload[4..8].fill(0xff);
        assert_eq!(edits_from_elst(&payload).played.unwrap().start_media_ticks, 5);
        for len in 0..payload.len() {
            assert_eq!(edits_from_elst(&payload[..len]).played, None);
        }
    }
}
