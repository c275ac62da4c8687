//! The container of a file, recognised by its content and never by its name.

use std::fmt;
use std::io::{self, Read, Seek, SeekFrom};

use crate::mpeg_audio::{self, MpegAudio};

/// Containers, recognised by their first bytes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Container {
    /// RIFF/WAVE.
    Wav,
    /// The 64-bit forms of RIFF/WAVE: RF64 and BW64.
    Rf64,
    /// Sony Wave64.
    W64,
    /// AIFF and AIFF-C.
    Aiff,
    /// Core Audio Format.
    Caf,
    /// Native FLAC.
    Flac,
    /// MPEG layer 3 without a container.
    Mp3,
    /// MPEG layer 1 or 2 without a container.
    Mp2,
    /// AAC in ADTS frames.
    Adts,
    /// Ogg.
    Ogg,
    /// QuickTime.
    Mov,
    /// MP4, M4A and related formats.
    Mp4,
    /// 3GPP.
    ThreeGp,
    /// Matroska.
    Matroska,
    /// WebM.
    WebM,
    /// Audio Video Interleave.
    Avi,
    /// MPEG transport stream.
    MpegTs,
    /// MPEG program stream.
    MpegPs,
    /// Advanced Systems Format: WMA and WMV.
    Asf,
    /// Sun audio.
    Au,
    /// AC-3 or E-AC-3 without a container.
    Ac3,
    /// Adaptive Multi-Rate.
    Amr,
    /// WavPack.
    WavPack,
    /// True Audio.
    Tta,
    /// Monkey's Audio.
    Ape,
    /// Flash video.
    Flv,
    /// No file: samples in memory.
    Memory,
    /// A format that only ffmpeg recognised.
    Other,
}

impl Container {
    /// The container of a file that begins with these bytes; `None` for unknown content. A long tag in front of the sound counts as MP3.
    pub fn of_beginning(bytes: &[u8]) -> Option<Self> {
        let sniffed = container_from_content(&mut io::Cursor::new(bytes)).ok()?;
        let has_tag = mpeg_audio::id3v2_len(bytes) > 0;
        sniffed.map(|sniffed| sniffed.container).or(has_tag.then_some(Self::Mp3))
    }

    /// Name for people.
    pub fn name(self) -> &'static str {
        match self {
            Self::Wav => "WAV file",
            Self::Rf64 => "RF64 file",
            Self::W64 => "W64 file",
            Self::Aiff => "AIFF file",
            Self::Caf => "CAF file",
            Self::Flac => "FLAC file",
            Self::Mp3 => "MP3 file",
            Self::Mp2 => "MP2 file",
            Self::Adts => "AAC (ADTS) file",
            Self::Ogg => "Ogg file",
            Self::Mov => "MOV file",
            Self::Mp4 => "MP4 file",
            Self::ThreeGp => "3GP file",
            Self::Matroska => "Matroska file",
            Self::WebM => "WebM file",
            Self::Avi => "AVI file",
            Self::MpegTs => "MPEG-TS file",
            Self::MpegPs => "MPEG-PS file",
            Self::Asf => "ASF (WMA/WMV) file",
            Self::Au => "AU file",
            Self::Ac3 => "AC-3 file",
            Self::Amr => "AMR file",
            Self::WavPack => "WavPack file",
            Self::Tta => "TTA file",
            Self::Ape => "Monkey's Audio file",
            Self::Flv => "Flash video file",
            Self::Memory => "array",
            Self::Other => "media file",
        }
    }

    /// The codec that follows from the container alone.
    pub(crate) fn codec_guess(self) -> &'static str {
        match self {
            Self::Asf => "WMA",
            Self::Ac3 => "AC-3",
            Self::Amr => "AMR",
            Self::WavPack => "WavPack",
            Self::Tta => "TTA",
            Self::Ape => "Monkey's Audio",
            Self::Mp2 => "MPEG layer 2",
            Self::MpegTs | Self::MpegPs => "AAC, AC-3 or MPEG sound",
            _ => "sound of an unknown codec",
        }
    }

    /// Whether a file with this extension can have this container. An unknown extension can have any.
    pub(crate) fn fits_extension(self, extension: &str) -> bool {
        let family: &[&[Self]] = match extension.to_ascii_lowercase().as_str() {
            "wav" | "wave" | "bwf" => &[&[Self::Wav, Self::Rf64]],
            "rf64" => &[&[Self::Wav, Self::Rf64]],
            "w64" => &[&[Self::W64]],
            "aif" | "aiff" | "aifc" => &[&[Self::Aiff]],
            "caf" => &[&[Self::Caf]],
            "flac" => &[&[Self::Flac]],
            "mp1" | "mp2" | "mp3" | "mpa" => &[&[Self::Mp3, Self::Mp2]],
            "aac" | "adts" => &[&[Self::Adts]],
            "ogg" | "oga" | "opus" | "spx" | "ogv" => &[&[Self::Ogg]],
            "mp4" | "m4a" | "m4v" | "mov" | "qt" | "3gp" | "3g2" => &[&[Self::Mp4, Self::Mov, Self::ThreeGp]],
            "mkv" | "mka" | "webm" => &[&[Self::Matroska, Self::WebM]],
            "avi" => &[&[Self::Avi]],
            "ts" | "mts" | "m2ts" => &[&[Self::MpegTs]],
            "mpg" | "mpeg" | "vob" => &[&[Self::MpegPs, Self::MpegTs]],
            "wma" | "wmv" | "asf" => &[&[Self::Asf]],
            "au" | "snd" => &[&[Self::Au]],
            "ac3" | "eac3" => &[&[Self::Ac3]],
            "amr" => &[&[Self::Amr]],
            "wv" => &[&[Self::WavPack]],
            "tta" => &[&[Self::Tta]],
            "ape" => &[&[Self::Ape]],
            "flv" => &[&[Self::Flv]],
            _ => return true,
        };
        self == Self::Other || family.iter().any(|family| family.contains(&self))
    }
}

impl fmt::Display for Container {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

/// The container of a file and the position of its content. Tags and other bytes before the first frame of MP3 and AAC are skipped.
#[derive(Clone, Debug)]
pub(crate) struct Sniffed {
    pub(crate) container: Container,
    pub(crate) base: u64,
    /// Facts from the first frames of MP3 and AAC.
    pub(crate) mpeg: Option<MpegAudio>,
}

/// Bytes of a file that are examined.
const SNIFF_BYTES: u64 = 256 * 1024;

/// Recognises the container; `None` for unknown content.
pub(crate) fn container_from_content<R: Read + Seek>(reader: &mut R) -> io::Result<Option<Sniffed>> {
    let mut head = Vec::new();
    reader.seek(SeekFrom::Start(0))?;
    reader.by_ref().take(SNIFF_BYTES).read_to_end(&mut head)?;
    if let Some(container) = container_from_signature(&head) {
        return Ok(Some(Sniffed { container, base: 0, mpeg: None }));
    }

    // An ID3 tag can contain a picture and be far longer than the examined bytes.
    let base = mpeg_audio::id3v2_len(&head);
    if base > 0 {
        head.clear();
        reader.seek(SeekFrom::Start(base))?;
        reader.by_ref().take(SNIFF_BYTES).read_to_end(&mut head)?;
        if let Some(container) = container_from_signature(&head) {
            return Ok(Some(Sniffed { container, base, mpeg: None }));
        }
    }
    Ok(mpeg_audio::first_frame(&head).map(|(offset, mpeg)| Sniffed {
        container: match mpeg {
            MpegAudio { is_adts: true, .. } => Container::Adts,
            MpegAudio { layer: 3, .. } => Container::Mp3,
            _ => Container::Mp2,
        },
        base: base + offset as u64,
        mpeg: Some(mpeg),
    }))
}

/// What a file of no known kind holds, for a message: text, or its first bytes as hexadecimal numbers.
pub(crate) fn content_in_words<R: Read + Seek>(reader: &mut R) -> String {
    const LOOKED_AT: u64 = 64;
    const SHOWN: usize = 8;
    let mut head = Vec::new();
    let read = reader.seek(SeekFrom::Start(0)).and_then(|_| reader.by_ref().take(LOOKED_AT).read_to_end(&mut head));
    let is_text = |byte: &u8| byte.is_ascii_graphic() || byte.is_ascii_whitespace();
    match read {
        Ok(_) if head.iter().all(is_text) => "it is text".to_owned(),
        Ok(_) => {
            let shown: Vec<String> = head.iter().take(SHOWN).map(|byte| format!("{byte:02x}")).collect();
            format!("it begins {}", shown.join(" "))
        }
        Err(_) => "it is unreadable".to_owned(),
    }
}

fn container_from_signature(head: &[u8]) -> Option<Container> {
    let tag = |at: usize| -> [u8; 4] {
        let mut tag = [0; 4];
        if let Some(bytes) = head.get(at..at + 4) {
            tag.copy_from_slice(bytes);
        }
        tag
    };
    match (&tag(0), &tag(4), &tag(8)) {
        (b"RIFF", _, b"WAVE") => return Some(Container::Wav),
        (b"RIFF", _, b"AVI ") => return Some(Container::Avi),
        (b"RF64" | b"BW64", _, b"WAVE") => return Some(Container::Rf64),
        (b"riff", [0x2e, 0x91, 0xcf, 0x11], _) => return Some(Container::W64),
        (b"FORM", _, b"AIFF" | b"AIFC") => return Some(Container::Aiff),
        (b"caff", _, _) => return Some(Container::Caf),
        (b"fLaC", _, _) => return Some(Container::Flac),
        (b"OggS", _, _) => return Some(Container::Ogg),
        (_, b"ftyp", brand) => return Some(container_from_brand(brand)),
        (_, b"moov" | b"mdat" | b"wide" | b"free" | b"skip" | b"pnot", _) => return Some(Container::Mov),
        ([0x1a, 0x45, 0xdf, 0xa3], _, _) => {
            let is_webm =
                head.iter().take(64).collect::<Vec<_>>().windows(4).any(|w| matches!(w, [b'w', b'e', b'b', b'm']));
            return Some(if is_webm { Container::WebM } else { Container::Matroska });
        }
        ([0x30, 0x26, 0xb2, 0x75], [0x8e, 0x66, 0xcf, 0x11], _) => return Some(Container::Asf),
        ([0x00, 0x00, 0x01, 0xba], _, _) => return Some(Container::MpegPs),
        (b".snd", _, _) => return Some(Container::Au),
        (b"wvpk", _, _) => return Some(Container::WavPack),
        (b"TTA1" | b"TTA2", _, _) => return Some(Container::Tta),
        (b"MAC ", _, _) => return Some(Container::Ape),
        ([b'F', b'L', b'V', 1], _, _) => return Some(Container::Flv),
        ([0x0b, 0x77, ..], _, _) => return Some(Container::Ac3),
        _ => {}
    }
    if head.starts_with(b"#!AMR") {
        return Some(Container::Amr);
    }
    // Transport packets have 188 bytes, or 192 with a time stamp of four bytes in front (AVCHD).
    for (packet_len, offset) in [(188, 0), (192, 4)] {
        let has_sync = (0..4).all(|packet| head.get(offset + packet * packet_len) == Some(&0x47));
        if has_sync {
            return Some(Container::MpegTs);
        }
    }
    None
}

fn container_from_brand(brand: &[u8; 4]) -> Container {
    match brand {
        b"qt  " => Container::Mov,
        [b'3', b'g', ..] => Container::ThreeGp,
        _ => Container::Mp4,
    }
}
