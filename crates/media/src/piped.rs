//! Sound that arrives through a pipe: decoded once, as it comes.

use std::io::Read;

use symphonia::core::errors::Error as SymphoniaError;
use symphonia::core::formats::probe::{Hint, Probe};
use symphonia::core::formats::{FormatOptions, FormatReader};
use symphonia::core::io::{MediaSourceStream, MediaSourceStreamOptions, ReadOnlySource};
use symphonia::core::meta::MetadataOptions;
use symphonia::default::formats::{AdtsReader, FlacReader, MkvReader, MpaReader, OggReader, WavReader};

use crate::error::MediaError;
use crate::frames::{Frames, Incidents};
use crate::guard::guarded;
use crate::mix::Mix;
use crate::mix_loss::MixLoss;
use crate::native::{NativeFrames, audio_parameters};
use crate::plan::damage_in_words;
use crate::warning::MediaWarning;

/// The first audio track of a stream of bytes that cannot seek: WAVE, FLAC, Ogg, Matroska, WebM, MP3 or ADTS.
pub struct PipedSound {
    frames: NativeFrames,
    mix: Mix,
    mix_loss: MixLoss,
    incidents: Incidents,
    interleaved: Vec<f32>,
    block: Vec<f32>,
    has_ended: bool,
}

impl PipedSound {
    /// Reads the header. `channel`: number of the channel, counted from 1; the mean of all where absent.
    ///
    /// # Errors
    /// A stream of another kind, one without audio, and a channel that it does not have.
    pub fn open(bytes: impl Read + Send + Sync + 'static, channel: Option<usize>) -> Result<Self, MediaError> {
        // Symphonia needs a power of two above 32 KiB; it hands on what has arrived, however little
        let options = MediaSourceStreamOptions { buffer_len: 64 * 1024 };
        let stream = MediaSourceStream::new(Box::new(ReadOnlySource::new(bytes)), options);
        let unknown = |error: SymphoniaError| MediaError::UnknownStream { why: stream_fault_in_words(&error) };
        let reader = probed(stream).map_err(unknown)?;
        let track = reader.tracks().iter().find(|track| audio_parameters(track).is_some());
        let track_id = track.map(|track| track.id).ok_or(MediaError::NoAudioInStream)?;
        let frames = NativeFrames::from_demuxer(reader, track_id, false).map_err(unknown)?;
        let mix = Mix::of(frames.channel_count(), channel)?;
        Ok(Self {
            frames,
            mix,
            mix_loss: MixLoss::default(),
            incidents: Incidents::default(),
            interleaved: Vec::new(),
            block: Vec::new(),
            has_ended: false,
        })
    }

    /// Samples per second.
    pub fn sample_rate_hz(&self) -> f64 {
        self.frames.sample_rate_hz()
    }

    /// That the channels cancel each other in the sound so far, where they do.
    pub fn warning(&self) -> Option<MediaWarning> {
        MediaWarning::of_mix(&self.mix_loss)
    }

    /// The samples of the next packets, as soon as they are there. `None` at the end of the stream.
    ///
    /// # Errors
    /// A stream that cannot be read.
    pub fn next_block(&mut self) -> Result<Option<&[f32]>, MediaError> {
        self.block.clear();
        while !self.has_ended && self.block.is_empty() {
            self.has_ended =
                !self.frames.next_frames(&mut self.interleaved, &mut self.incidents).map_err(MediaError::Read)?;
            self.mix.append(&mut self.interleaved, &mut self.block, &mut self.mix_loss);
        }
        Ok((!self.block.is_empty()).then_some(self.block.as_slice()))
    }
}

/// What is wrong with a stream whose kind is not known.
fn stream_fault_in_words(error: &SymphoniaError) -> String {
    match error {
        SymphoniaError::IoError(error) if error.kind() == std::io::ErrorKind::UnexpectedEof => {
            "it ended before any sound".to_owned()
        }
        SymphoniaError::Unsupported(_) => "its first bytes match none of these formats".to_owned(),
        error => damage_in_words(error).to_owned(),
    }
}

fn probed(stream: MediaSourceStream<'static>) -> Result<Box<dyn FormatReader>, SymphoniaError> {
    let mut probe = Probe::new();
    probe.register_format::<WavReader<'_>>();
    probe.register_format::<FlacReader<'_>>();
    probe.register_format::<OggReader<'_>>();
    probe.register_format::<MkvReader<'_>>();
    probe.register_format::<AdtsReader<'_>>();
    probe.register_format::<MpaReader<'_>>();
    guarded(|| probe.probe(&Hint::new(), stream, FormatOptions::default(), MetadataOptions::default()))
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::io::{self, Cursor};

    /// Two channels of 16 bits at 8 kHz, with the sizes of a recorder that does not know when it will end.
    fn endless_wave(frames: &[[i16; 2]]) -> Vec<u8> {
        let mut bytes = Vec::new();
        bytes.extend(b"RIFF\xff\xff\xff\xffWAVEfmt \x10\0\0\0\x01\0\x02\0");
        bytes.extend(8000_u32.to_le_bytes());
        bytes.extend(32_000_u32.to_le_bytes());
        bytes.extend(b"\x04\0\x10\0data\xff\xff\xff\xff");
        frames.iter().flatten().for_each(|sample| bytes.extend(sample.to_le_bytes()));
        bytes
    }

    /// Hands out a few bytes at a time, as a pipe may.
    struct Drops(Cursor<Vec<u8>>);

    impl Read for Drops {
        fn read(&mut self, into: &mut [u8]) -> io::Result<usize> {
            let count = into.len().min(7);
            self.0.read(&mut into[..count])
        }
    }

    fn heard(mut sound: PipedSound) -> Vec<f32> {
        let mut all = Vec::new();
        while let Some(block) = sound.next_block().unwrap() {
            all.extend_from_slice(block);
        }
        all
    }

    #[test]
    fn a_wave_without_sizes_is_heard_to_its_end() {
        let frames: Vec<[i16; 2]> = (0..5000).map(|n| [n, 2 * n]).collect();
        let open = |channel| PipedSound::open(Drops(Cursor::new(endless_wave(&frames))), channel);
        let mono = heard(open(None).unwrap());
        assert_eq!(mono.len(), frames.len());
        assert!(
            mono.iter().zip(&frames).all(|(got, [left, _])| (got - 1.5 * f32::from(*left) / 32_768.0).abs() < 1e-6)
        );
        let right = heard(open(Some(2)).unwrap());
        assert!((right[100] - 200.0 / 32_768.0).abs() < 1e-6);
        assert_eq!(open(None).unwrap().sample_rate_hz(), 8000.0);
        assert!(matches!(open(Some(3)), Err(MediaError::NoSuchChannel { asked: 3, count: 2 })));
    }

    #[test]
    fn channels_of_opposite_sign_are_said_to_cancel() {
        let open = |right: i16, channel| {
            let frames: Vec<[i16; 2]> = (0..5000).map(|n| [n % 100, right * (n % 100)]).collect();
            let mut sound = PipedSound::open(Drops(Cursor::new(endless_wave(&frames))), channel).unwrap();
            while sound.next_block().unwrap().is_some() {}
            sound.warning()
        };
        assert!(matches!(open(-1, None), Some(MediaWarning::ChannelsCancel { .. })));
        assert_eq!(open(1, None), None);
        assert_eq!(open(-1, Some(1)), None);
    }

    #[test]
    fn what_is_no_sound_is_refused() {
        for bytes in [Vec::new(), b"hello, this is a text and no sound at all".repeat(40)] {
            let error = PipedSound::open(Cursor::new(bytes), None).err().unwrap();
            assert!(matches!(error, MediaError::UnknownStream { .. }), "{error}");
            let words_of_decoder = ["unsupported feature", "malformed", "probe"];
            assert!(words_of_decoder.iter().all(|word| !error.to_string().contains(word)), "{error}");
        }
    }
}
