//! Small QuickTime files for the tests, put together box by box.

/// A box of type `kind` around `content`.
pub(super) fn boxed(kind: &[u8; 4], content: &[u8]) -> Vec<u8> {
    let mut bytes = u32::try_from(content.len() + 8).unwrap().to_be_bytes().to_vec();
    bytes.extend(kind);
    bytes.extend(content);
    bytes
}

/// The concatenation of `parts`.
pub(super) fn joined(parts: &[&[u8]]) -> Vec<u8> {
    parts.concat()
}

/// Big-endian 32-bit numbers.
pub(super) fn words(values: &[u32]) -> Vec<u8> {
    values.iter().flat_map(|value| value.to_be_bytes()).collect()
}

/// A version 0 sample entry.
pub(super) fn entry_v0(codec: &[u8; 4], channels: u16, bits: u16, rate_hz: u16, extensions: &[u8]) -> Vec<u8> {
    boxed(codec, &joined(&[&entry_fields(0, channels, bits, 0, rate_hz), extensions]))
}

/// Size of a packet of constant size.
#[derive(Clone, Copy)]
pub(super) struct Packet {
    pub(super) frames: u32,
    /// Bytes of all channels (bytesPerFrame).
    pub(super) bytes: u32,
}

/// A version 1 sample entry.
pub(super) fn entry_v1(codec: &[u8; 4], channels: u16, packet: Packet, rate_hz: u16, extensions: &[u8]) -> Vec<u8> {
    let numbers = words(&[packet.frames, packet.bytes / u32::from(channels), packet.bytes, 2]);
    boxed(codec, &joined(&[&entry_fields(1, channels, 16, 0, rate_hz), &numbers, extensions]))
}

/// A version 2 sample entry: `stream` is bits, flags, bytes of a packet, frames of a packet.
pub(super) fn entry_v2(codec: &[u8; 4], channels: u32, rate_hz: f64, stream: [u32; 4]) -> Vec<u8> {
    let numbers = joined(&[&words(&[72]), &rate_hz.to_be_bytes(), &words(&[channels, 0x7f00_0000]), &words(&stream)]);
    boxed(codec, &joined(&[&entry_fields(2, 3, 16, 0xfffe, 1), &numbers]))
}

fn entry_fields(version: u16, channels: u16, bits: u16, compression: u16, rate_hz: u16) -> Vec<u8> {
    let halves = [0, 0, 0, 1, version, 0, 0, 0, channels, bits, compression, 0, rate_hz, 0];
    halves.iter().flat_map(|half: &u16| half.to_be_bytes()).collect()
}

/// The `wave` box of QuickTime with the byte order in it.
pub(super) fn wave_enda(value: u16) -> Vec<u8> {
    boxed(
        b"wave",
        &joined(&[&boxed(b"frma", b"in24"), &boxed(b"enda", &value.to_be_bytes()), &[0, 0, 0, 8, 0, 0, 0, 0]]),
    )
}

/// A track to build.
#[derive(Clone)]
pub(super) struct TrackPlan {
    pub(super) handler: [u8; 4],
    pub(super) entry: Vec<u8>,
    pub(super) timescale_hz: u32,
    /// Duration, start, speed of each edit.
    pub(super) edits: Vec<(u32, i32, u32)>,
    /// Count and ticks.
    pub(super) durations: Vec<(u32, u32)>,
    /// Offset from the start of the media data, samples.
    pub(super) chunks: Vec<(u32, u32)>,
    /// Constant size and count; a size of 0 takes `sizes`.
    pub(super) constant_size: u32,
    pub(super) sample_count: u32,
    pub(super) sizes: Vec<u32>,
    /// Flags of the data reference: 1 for the file itself.
    pub(super) reference_flags: u32,
    /// 64-bit chunk offsets.
    pub(super) is_co64: bool,
}

impl TrackPlan {
    /// An uncompressed track whose chunks hold `samples` each, one after another.
    pub(super) fn pcm(entry: Vec<u8>, rate_hz: u32, constant_size: u32, chunks: &[(u32, u32)]) -> Self {
        let sample_count = chunks.iter().map(|(_, samples)| samples).sum();
        Self {
            handler: *b"soun",
            entry,
            timescale_hz: rate_hz,
            edits: Vec::new(),
            durations: vec![(sample_count, 1)],
            chunks: chunks.to_vec(),
            constant_size,
            sample_count,
            sizes: Vec::new(),
            reference_flags: 1,
            is_co64: false,
        }
    }

    /// A compressed track with a packet of each of `sizes`, in one chunk.
    pub(super) fn compressed(entry: Vec<u8>, timescale_hz: u32, packet_ticks: u32, sizes: &[u32]) -> Self {
        let count = u32::try_from(sizes.len()).unwrap();
        let mut plan = Self::pcm(entry, timescale_hz, 0, &[(0, count)]);
        plan.durations = vec![(count, packet_ticks)];
        plan.sizes = sizes.to_vec();
        plan
    }

    pub(super) fn stbl(&self, data_offset: u32) -> Vec<u8> {
        let stsd = boxed(b"stsd", &joined(&[&words(&[0, 1]), &self.entry]));
        let counted = |kind: &[u8; 4], rows: usize, numbers: &[u32]| {
            boxed(kind, &joined(&[&words(&[0, u32::try_from(rows).unwrap()]), &words(numbers)]))
        };
        let durations: Vec<u32> = self.durations.iter().flat_map(|(count, ticks)| [*count, *ticks]).collect();
        let stts = counted(b"stts", self.durations.len(), &durations);
        let runs: Vec<u32> = (1..).zip(&self.chunks).flat_map(|(number, (_, samples))| [number, *samples, 1]).collect();
        let stsc = counted(b"stsc", self.chunks.len(), &runs);
        let stsz = boxed(b"stsz", &words(&[&[0, self.constant_size, self.sample_count], &self.sizes[..]].concat()));
        let offsets = self.chunks.iter().map(|(offset, _)| offset + data_offset);
        let stco = if self.is_co64 {
            counted(b"co64", self.chunks.len(), &offsets.flat_map(|offset| [0, offset]).collect::<Vec<_>>())
        } else {
            counted(b"stco", self.chunks.len(), &offsets.collect::<Vec<_>>())
        };
        boxed(b"stbl", &joined(&[&stsd, &stts, &stsc, &stsz, &stco]))
    }

    pub(super) fn trak(&self, track_id: u32, data_offset: u32) -> Vec<u8> {
        let tkhd = boxed(b"tkhd", &words(&[3, 0, 0, track_id, 0, 0]));
        let edts = if self.edits.is_empty() {
            Vec::new()
        } else {
            let rows: Vec<u32> =
                self.edits.iter().flat_map(|(len, at, speed)| [*len, at.cast_unsigned(), *speed]).collect();
            let count = u32::try_from(self.edits.len()).unwrap();
            boxed(b"edts", &boxed(b"elst", &joined(&[&words(&[0, count]), &words(&rows)])))
        };
        let mdhd = boxed(b"mdhd", &words(&[0, 0, 0, self.timescale_hz, 0, 0]));
        let hdlr = boxed(b"hdlr", &joined(&[&[0; 4], b"mhlr", &self.handler, &[0; 12]]));
        let url = boxed(b"url ", &words(&[self.reference_flags]));
        let dinf = boxed(b"dinf", &boxed(b"dref", &joined(&[&words(&[0, 1]), &url])));
        let minf = boxed(b"minf", &joined(&[&dinf, &self.stbl(data_offset)]));
        let mdia = boxed(b"mdia", &joined(&[&mdhd, &hdlr, &minf]));
        boxed(b"trak", &joined(&[&tkhd, &edts, &mdia]))
    }
}

/// `moov` of the tracks, numbered from 1, with `extra` behind them. The movie's clock ticks 1000 times a second.
pub(super) fn moov(tracks: &[TrackPlan], data_offset: u32, extra: &[u8]) -> Vec<u8> {
    let mvhd = boxed(b"mvhd", &words(&[0, 0, 0, 1000, 0]));
    let traks: Vec<u8> = (1..).zip(tracks).flat_map(|(track_id, plan)| plan.trak(track_id, data_offset)).collect();
    boxed(b"moov", &joined(&[&mvhd, &traks, extra]))
}

/// A file: `ftyp`, the media data, the index.
pub(super) fn movie(data: &[u8], tracks: &[TrackPlan]) -> Vec<u8> {
    let ftyp = boxed(b"ftyp", b"qt  \0\0\0\0qt  ");
    let data_offset = u32::try_from(ftyp.len() + 8).unwrap();
    joined(&[&ftyp, &boxed(b"mdat", data), &moov(tracks, data_offset, &[])])
}

/// A file with the index in front of the media data.
pub(super) fn faststart_movie(data: &[u8], tracks: &[TrackPlan]) -> Vec<u8> {
    let ftyp = boxed(b"ftyp", b"qt  \0\0\0\0qt  ");
    let data_offset = u32::try_from(ftyp.len() + moov(tracks, 0, &[]).len() + 8).unwrap();
    joined(&[&ftyp, &moov(tracks, data_offset, &[]), &boxed(b"mdat", data)])
}
