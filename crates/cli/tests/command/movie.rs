//! Small MOV files, as a phone makes them: uncompressed sound of one track behind a `moov` box.

use hovertone_sim::{HoverSettings, HoverSound};
use std::fs;
use std::path::Path;

/// A hover as a MOV file with 16-bit sound.
pub(crate) fn write_movie(path: &Path, settings: HoverSettings) {
    let rate_hz = settings.sample_rate_hz;
    let (samples, _) = HoverSound::new(settings).unwrap().render_all();
    let data: Vec<u8> = samples.iter().flat_map(|sample| ((sample * 32_767.0).round() as i16).to_le_bytes()).collect();
    let frames = u32::try_from(samples.len()).unwrap();
    let file_type = boxed(b"ftyp", b"qt  \0\0\0\0qt  ");
    let data_at = u32::try_from(file_type.len() + 8).unwrap();
    fs::write(path, [file_type, boxed(b"mdat", &data), index_of(frames, rate_hz, data_at)].concat()).unwrap();
}

fn index_of(frames: u32, rate_hz: u32, data_at: u32) -> Vec<u8> {
    // version 0: one channel of 16 bits, at a rate in 16.16 fixed point
    let halves = [0, 0, 0, 1, 0, 0, 0, 0, 1, 16, 0, 0, u16::try_from(rate_hz).unwrap(), 0];
    let entry = boxed(b"sowt", &halves.iter().flat_map(|half: &u16| half.to_be_bytes()).collect::<Vec<u8>>());
    let table = [
        boxed(b"stsd", &[words(&[0, 1]), entry].concat()),
        boxed(b"stts", &words(&[0, 1, frames, 1])),
        boxed(b"stsc", &words(&[0, 1, 1, frames, 1])),
        boxed(b"stsz", &words(&[0, 2, frames])),
        boxed(b"stco", &words(&[0, 1, data_at])),
    ];
    let reference = boxed(b"dinf", &boxed(b"dref", &[words(&[0, 1]), boxed(b"url ", &words(&[1]))].concat()));
    let media = [
        boxed(b"mdhd", &words(&[0, 0, 0, rate_hz, frames, 0])),
        boxed(b"hdlr", &[&[0; 4][..], b"mhlrsoun", &[0; 12]].concat()),
        boxed(b"minf", &[reference, boxed(b"stbl", &table.concat())].concat()),
    ];
    let track = [boxed(b"tkhd", &words(&[3, 0, 0, 1, 0, 0])), boxed(b"mdia", &media.concat())];
    boxed(b"moov", &[boxed(b"mvhd", &words(&[0, 0, 0, 1000, 0])), boxed(b"trak", &track.concat())].concat())
}

fn boxed(kind: &[u8; 4], content: &[u8]) -> Vec<u8> {
    let length = u32::try_from(content.len() + 8).unwrap();
    [&length.to_be_bytes()[..], kind, content].concat()
}

fn words(values: &[u32]) -> Vec<u8> {
    values.iter().flat_map(|value| value.to_be_bytes()).collect()
}
