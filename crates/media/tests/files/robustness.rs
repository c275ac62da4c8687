//! Whatever the bytes are: no panic, no empty block, no sample that is not a number.

use crate::recordings::{files_of, native_only, samples, temp_file, test_data, wav_bytes};
use hovertone_media::{OpenOptions, Recording};
use proptest::prelude::*;

fn hear(content: &[u8]) -> Option<usize> {
    let file = temp_file("sound.bin", content);
    let mut recording = Recording::open(&file.path, &native_only()).ok()?;
    Some(samples(&mut recording).len())
}

#[test]
fn a_wav_cut_at_any_length_gives_its_prefix_or_an_error() {
    let wav = wav_bytes(1, 2, 8000, 16, &[1, 2, 3, 4].repeat(40));
    for len in 0..=wav.len() {
        let expected = len.checked_sub(44).map(|bytes| bytes / 4).filter(|frames| *frames > 0);
        assert_eq!(hear(&wav[..len]), expected, "cut to {len} bytes");
    }
}

#[test]
fn real_containers_cut_anywhere_near_their_headers_do_not_panic() {
    let Some(folder) = test_data("containers") else { return };
    let mut cut = 0;
    for path in files_of(&folder) {
        let content = std::fs::read(&path).unwrap();
        // Prime steps: header fields of every alignment are cut through.
        for len in (1..content.len().min(3000)).step_by(97).chain((3000..content.len()).step_by(20_011)) {
            hear(&content[..len]);
            cut += 1;
        }
    }
    assert!(cut > 1000, "{cut} cuts were made");
}

#[test]
fn a_missing_file_and_a_directory_are_errors() {
    let options = OpenOptions::default();
    assert!(Recording::open("/nonexistent/recording.wav".as_ref(), &options).is_err());
    assert!(Recording::open(&std::env::temp_dir(), &options).is_err());
}

/// Signatures that lead random bytes into each reader.
const SIGNATURES: [&[u8]; 12] = [
    b"RIFF\xff\xff\xff\xffWAVEfmt \x10\0\0\0",
    b"RF64\xff\xff\xff\xffWAVEds64",
    b"riff\x2e\x91\xcf\x11\xa5\xd6\x28\xdb\x04\xc1\0\0",
    b"FORM\0\0\xff\xffAIFFCOMM\0\0\0\x12",
    b"caff\0\x01\0\0desc\0\0\0\0\0\0\0\x20",
    b"fLaC\0\0\0\x22",
    b"OggS\0\x02",
    b"\0\0\0\x18ftypisom\0\0\0\0isomiso2\0\0\xff\xffmoov",
    b"\x1a\x45\xdf\xa3\x84\x42\x82\x81\x77\x18\x53\x80\x67\xff",
    b"\xff\xf1\x50\x80\x02\x1f\xfc",
    b"\xff\xfb\x90\x64",
    b"ID3\x04\0\0\0\0\x01\0",
];

proptest! {
    #![proptest_config(ProptestConfig::with_cases(300))]

    #[test]
    fn random_bytes_never_panic(
        signature in prop::sample::select(SIGNATURES.to_vec()),
        noise in prop::collection::vec(any::<u8>(), 0..3000),
    ) {
        hear(&noise);
        hear(&[signature, &noise].concat());
    }

    #[test]
    fn a_wav_header_with_random_fields_never_panics(
        mut fields in prop::collection::vec(any::<u8>(), 36),
        noise in prop::collection::vec(any::<u8>(), 0..2000),
    ) {
        fields[..4].copy_from_slice(b"fmt ");
        fields[4..8].copy_from_slice(&16_u32.to_le_bytes());
        fields[8] %= 8;
        fields[9] = 0;
        fields[24..28].copy_from_slice(b"data");
        hear(&[b"RIFF\0\0\0\0WAVE".as_slice(), &fields, &noise].concat());
    }
}
