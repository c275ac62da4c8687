use super::super::movie_builder::{Packet, boxed, entry_v0, entry_v1, entry_v2, joined, wave_enda, words};
use super::*;

fn description(entry: &[u8]) -> SoundDescription {
    description_from_stsd(&joined(&[&words(&[0, 1]), entry])).unwrap()
}

fn layout(entry: &[u8]) -> Option<(PcmKind, bool, u8)> {
    description(entry).pcm.map(|pcm| (pcm.kind, pcm.is_little_endian, pcm.sample_bytes))
}

#[test]
fn version_0_names() {
    let v0 = |codec: &[u8; 4], bits: u16| layout(&entry_v0(codec, 2, bits, 48_000, &[]));
    assert_eq!(v0(b"sowt", 16), Some((PcmKind::Signed, true, 2)));
    assert_eq!(v0(b"twos", 16), Some((PcmKind::Signed, false, 2)));
    assert_eq!(v0(b"twos", 8), Some((PcmKind::Signed, false, 1)));
    assert_eq!(v0(b"sowt", 24), Some((PcmKind::Signed, true, 3)));
    assert_eq!(v0(b"raw ", 8), Some((PcmKind::Unsigned, false, 1)));
    assert_eq!(v0(b"raw ", 16), Some((PcmKind::Signed, false, 2)));
    assert_eq!(v0(b"NONE", 8), Some((PcmKind::Unsigned, false, 1)));
    assert_eq!(v0(b"NONE", 16), Some((PcmKind::Signed, false, 2)));
    assert_eq!(v0(&[0; 4], 16), Some((PcmKind::Signed, false, 2)));
    assert_eq!(v0(b"ulaw", 16), Some((PcmKind::MuLaw, false, 1)));
    assert_eq!(v0(b"alaw", 16), Some((PcmKind::ALaw, false, 1)));
    assert_eq!(v0(b"mp4a", 16), None);
    let found = description(&entry_v0(b"sowt", 2, 16, 48_000, &[]));
    assert_eq!((found.rate_hz, found.channel_count, found.data_reference), (48_000.0, 2, 1));
}

#[test]
fn version_1_is_big_endian_unless_enda_says_otherwise() {
    let v1 = |codec: &[u8; 4], extensions: &[u8]| {
        layout(&entry_v1(codec, 1, Packet { frames: 1, bytes: 3 }, 44_100, extensions))
    };
    assert_eq!(v1(b"in24", &[]), Some((PcmKind::Signed, false, 3)));
    assert_eq!(v1(b"in24", &wave_enda(0)), Some((PcmKind::Signed, false, 3)));
    assert_eq!(v1(b"in24", &wave_enda(1)), Some((PcmKind::Signed, true, 3)));
    assert_eq!(v1(b"in24", &wave_enda(0x0100)), Some((PcmKind::Signed, true, 3)));
    assert_eq!(v1(b"in32", &wave_enda(1)), Some((PcmKind::Signed, true, 4)));
    assert_eq!(v1(b"fl32", &[]), Some((PcmKind::Float, false, 4)));
    assert_eq!(v1(b"fl64", &wave_enda(1)), Some((PcmKind::Float, true, 8)));
    assert_eq!(description(&entry_v1(b"in24", 1, Packet { frames: 1, bytes: 3 }, 44_100, &[])).packet, Some((1, 3)));
}

#[test]
fn version_2_stream_descriptions() {
    let v2 = |bits: u32, flags: u32, packet_bytes: u32| entry_v2(b"lpcm", 2, 96_000.0, [bits, flags, packet_bytes, 1]);
    let found = description(&v2(24, 4 | 8, 6));
    assert_eq!((found.rate_hz, found.channel_count), (96_000.0, 2));
    assert_eq!(layout(&v2(24, 4 | 8, 6)), Some((PcmKind::Signed, true, 3)));
    assert_eq!(layout(&v2(16, 2 | 4 | 8, 4)), Some((PcmKind::Signed, false, 2)));
    assert_eq!(layout(&v2(32, 1 | 8, 8)), Some((PcmKind::Float, true, 4)));
    assert_eq!(layout(&v2(64, 1 | 2 | 8, 16)), Some((PcmKind::Float, false, 8)));
    assert_eq!(layout(&v2(8, 8, 2)), Some((PcmKind::Unsigned, false, 1)));
    // 24 bits in 32: at the top with flag 16, else at the bottom.
    assert_eq!(description(&v2(24, 4 | 16, 8)).pcm.map(|pcm| (pcm.sample_bytes, pcm.empty_high_bits)), Some((4, 0)));
    assert_eq!(description(&v2(24, 4, 8)).pcm.map(|pcm| (pcm.sample_bytes, pcm.empty_high_bits)), Some((4, 8)));
    assert_eq!(layout(&v2(16, 4 | 8 | 32, 2)), None, "a plane per channel");
    assert_eq!(layout(&v2(0, 4, 0)), None);
    assert_eq!(layout(&v2(u32::MAX, 4, u32::MAX)), None);
}

#[test]
fn iso_entries_with_pcm_configuration_and_rate_box() {
    let pcm_c = |flags: u8, bits: u8| boxed(b"pcmC", &[0, 0, 0, 0, flags, bits]);
    assert_eq!(layout(&entry_v0(b"ipcm", 2, 16, 48_000, &pcm_c(1, 24))), Some((PcmKind::Signed, true, 3)));
    assert_eq!(layout(&entry_v0(b"ipcm", 2, 16, 48_000, &pcm_c(0, 16))), Some((PcmKind::Signed, false, 2)));
    assert_eq!(layout(&entry_v0(b"fpcm", 2, 16, 48_000, &pcm_c(0, 64))), Some((PcmKind::Float, false, 8)));
    assert_eq!(layout(&entry_v0(b"ipcm", 2, 16, 48_000, &[])), None, "the configuration has to be there");
    // ISO's version 1 stands in an stsd of version 1 and adds no fields.
    let mut entry = entry_v0(b"ipcm", 2, 16, 1, &joined(&[&boxed(b"srat", &words(&[0, 192_000])), &pcm_c(1, 16)]));
    entry[17] = 1;
    let found = description_from_stsd(&joined(&[&words(&[0x0100_0000, 1]), &entry])).unwrap();
    assert_eq!((found.rate_hz, found.pcm.map(|pcm| pcm.sample_bytes)), (192_000.0, Some(2)));
}

#[test]
fn configurations_correct_rate_and_channels() {
    let opus = boxed(b"dOps", &[0, 1, 0x01, 0x38, 0, 0, 0xac, 0x44, 0, 0, 0]);
    let found = description(&entry_v0(b"Opus", 2, 16, 44_100, &opus));
    assert_eq!((found.rate_hz, found.channel_count), (48_000.0, 1));
    assert_eq!(found.codec_config.len(), 11);

    let mut cookie = vec![0, 0, 0, 0, 0, 0, 0x10, 0, 0, 24, 40, 10, 14, 1, 0, 255];
    cookie.extend(words(&[0, 0, 96_000]));
    let found = description(&entry_v0(b"alac", 2, 16, 30_464, &boxed(b"alac", &cookie)));
    assert_eq!((found.rate_hz, found.channel_count, found.codec_config.len()), (96_000.0, 1, 24));

    let mut stream_info = vec![0, 0, 0, 0, 0x80, 0, 0, 34, 0x12, 0, 0x12, 0, 0, 0, 0, 0, 0, 0];
    // 96000 = 0x17700 in 20 bits, then channels less one in 3.
    stream_info.extend([0x17, 0x70, 0x02, 0x70]);
    stream_info.extend([0; 20]);
    let found = description(&entry_v0(b"fLaC", 1, 16, 0, &boxed(b"dfLa", &stream_info)));
    assert_eq!((found.rate_hz, found.channel_count, found.codec_config.len()), (96_000.0, 2, 34));
}

#[test]
fn esds_is_found_in_wave_and_outside() {
    let mut esds = vec![0, 0, 0, 0, 0x03, 22, 0, 1, 0, 0x04, 17, 0x40, 0x15];
    esds.extend([0; 11]);
    esds.extend([0x05, 2, 0x12, 0x08]);
    let esds = boxed(b"esds", &esds);
    let wave = boxed(b"wave", &joined(&[&boxed(b"mp4a", &[0; 4]), &esds, &[0, 0, 0, 8, 0, 0, 0, 0]]));
    for entry in [
        entry_v0(b"mp4a", 2, 16, 44_100, &esds),
        entry_v1(b"mp4a", 2, Packet { frames: 1024, bytes: 0 }, 44_100, &wave),
    ] {
        let found = description(&entry);
        assert_eq!(found.codec_config, [0x12, 0x08]);
        assert_eq!((found.channel_count, found.packet), (1, None));
    }
}

#[test]
fn cut_short_anywhere_it_is_an_error_or_a_description() {
    let entries = [
        entry_v1(b"in24", 1, Packet { frames: 1, bytes: 3 }, 44_100, &wave_enda(1)),
        entry_v2(b"lpcm", 2, f64::NAN, [u32::MAX; 4]),
        entry_v0(b"ipcm", 2, 16, 48_000, &boxed(b"pcmC", &[0; 6])),
    ];
    for entry in entries {
        let stsd = joined(&[&words(&[0, 1]), &entry]);
        for len in 0..=stsd.len() {
            let mut cut = stsd[..len].to_vec();
            assert!(description_from_stsd(&cut).is_err() || len == stsd.len());
            if let Some(size) = cut.get_mut(8..12) {
                // The box itself cut at the same place.
                size.copy_from_slice(&u32::try_from(len - 8).unwrap().to_be_bytes());
                drop(description_from_stsd(&cut));
            }
        }
    }
}
