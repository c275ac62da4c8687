//! From packets to frames with Symphonia's demuxers and decoders, and our adapter for Opus.

use std::io;

use symphonia::core::codecs::CodecParameters;
use symphonia::core::codecs::audio::{AudioCodecId, AudioCodecParameters};
use symphonia::core::errors::Error as SymphoniaError;
use symphonia::core::formats::probe::{Hint, Probe};
use symphonia::core::formats::{FormatOptions, FormatReader, Track};
use symphonia::core::meta::MetadataOptions;
use symphonia::core::packet::Packet;
use symphonia::core::units::TimeBase;
use symphonia::default::formats::{
    AdtsReader, AiffReader, CafReader, FlacReader, IsoMp4Reader, MkvReader, MpaReader, OggReader,
};

use crate::codec::{Decoder, PACKET_FRAMES_MAX, decoder_for};
use crate::container::Container;
use crate::file_access::FileAccess;
use crate::frames::{Frames, Incidents};
use crate::guard::guarded;
use crate::iso::{self, TablePackets};
use crate::opus::{OPUS_RATE_HZ, packet_frames};
use crate::packets::PacketSource;
use crate::quicktime::AudioTrack;
use crate::source::{FileView, Patch};
use crate::wave::{WaveBlocks, WaveLayout};

/// A longer jump in time is a damaged time stamp, not lost sound.
const GAP_S_MAX: f64 = 10.0;

/// Opens the demuxer of one container and no other, so that damaged content is not taken for another format.
pub(crate) fn open_demuxer(
    file: &dyn FileAccess,
    container: Container,
    base: u64,
    patches: &[Patch],
) -> Result<Box<dyn FormatReader>, SymphoniaError> {
    let mut probe = Probe::new();
    match container {
        Container::Aiff => probe.register_format::<AiffReader<'_>>(),
        Container::Caf => probe.register_format::<CafReader<'_>>(),
        Container::Flac => probe.register_format::<FlacReader<'_>>(),
        Container::Mp3 => probe.register_format::<MpaReader<'_>>(),
        Container::Adts => probe.register_format::<AdtsReader<'_>>(),
        Container::Ogg => probe.register_format::<OggReader<'_>>(),
        Container::Mov | Container::Mp4 | Container::ThreeGp => probe.register_format::<IsoMp4Reader<'_>>(),
        Container::Matroska | Container::WebM => probe.register_format::<MkvReader<'_>>(),
        _ => return Err(SymphoniaError::Unsupported("hovertone does not read this kind of file itself")),
    }
    let stream = FileView::open(file, base, patches)?.into_stream();
    guarded(|| probe.probe(&Hint::new(), stream, FormatOptions::default(), MetadataOptions::default()))
}

/// The audio parameters of a track, where it is audio.
pub(crate) fn audio_parameters(track: &Track) -> Option<&AudioCodecParameters> {
    match &track.codec_params {
        Some(CodecParameters::Audio(parameters)) => Some(parameters),
        _ => None,
    }
}

/// One track, decoded packet by packet.
pub(crate) struct NativeFrames {
    packets: PacketSource,
    decoder: Decoder,
    time_base: Option<TimeBase>,
    sample_rate_hz: u32,
    channel_count: usize,
    decoded: Vec<f32>,
    /// Jumps of the packet times from this length on are lost sound; `None` where the times are unreliable.
    gap_s_min: Option<f64>,
    /// End of the last packet by its time and its frames.
    last_end_s: Option<f64>,
    /// A packet that waits until the gap before it is filled.
    held: Option<Packet>,
}

impl NativeFrames {
    /// A track of a demuxer. `has_gapless_packets`: whether the trims of the demuxer are correct.
    pub(crate) fn from_demuxer(
        reader: Box<dyn FormatReader>,
        track_id: u32,
        has_gapless_packets: bool,
    ) -> Result<Self, SymphoniaError> {
        let track = reader.tracks().iter().find(|track| track.id == track_id);
        let track = track.ok_or(SymphoniaError::Unsupported("the decoder does not find the audio track"))?;
        let parameters = audio_parameters(track).ok_or(SymphoniaError::Unsupported("unsupported audio codec"))?;
        let time_base = track.time_base;
        let (decoder, sample_rate_hz, channel_count) = decoder_for(parameters, has_gapless_packets)?;
        Ok(Self {
            decoder,
            time_base,
            sample_rate_hz,
            channel_count,
            packets: PacketSource::of_demuxer(reader, track_id),
            decoded: Vec::new(),
            gap_s_min: None,
            last_end_s: None,
            held: None,
        })
    }

    /// Fills jumps in time of at least this length with silence.
    pub(crate) fn with_gap_s_min(self, gap_s_min: Option<f64>) -> Self {
        Self { gap_s_min, ..self }
    }

    /// The samples of a WAVE file in coded blocks.
    pub(crate) fn from_wave(
        file: &dyn FileAccess,
        layout: &WaveLayout,
        codec: AudioCodecId,
    ) -> Result<Self, SymphoniaError> {
        let parameters = layout.codec_parameters(codec);
        let (decoder, sample_rate_hz, channel_count) = decoder_for(&parameters, false)?;
        Ok(Self {
            decoder,
            time_base: TimeBase::try_from_recip(sample_rate_hz),
            sample_rate_hz,
            channel_count,
            packets: PacketSource::Wave(WaveBlocks::open(file, layout.clone())?),
            decoded: Vec::new(),
            gap_s_min: None,
            last_end_s: None,
            held: None,
        })
    }

    /// A compressed track of MP4 or MOV, read by its table of packets.
    pub(crate) fn from_iso_table(file: &dyn FileAccess, track: &AudioTrack) -> Result<Self, SymphoniaError> {
        let parameters = iso::codec_parameters(track).ok_or(SymphoniaError::Unsupported("unsupported audio codec"))?;
        let (decoder, sample_rate_hz, channel_count) = decoder_for(&parameters, false)?;
        Ok(Self {
            decoder,
            time_base: TimeBase::try_from_recip(track.timescale_hz),
            sample_rate_hz,
            channel_count,
            packets: PacketSource::IsoTable(TablePackets::open(file, track)?),
            decoded: Vec::new(),
            gap_s_min: None,
            last_end_s: None,
            held: None,
        })
    }

    /// Decodes into `self.decoded`; `false` for a damaged packet or a packet of another format.
    fn decode(&mut self, packet: &Packet, incidents: &mut Incidents) -> bool {
        match &mut self.decoder {
            Decoder::Opus(opus) => {
                let is_good = guarded(|| {
                    opus.decode(&packet.data, &mut self.decoded)
                        .map_err(|_| SymphoniaError::DecodeError("opus: a damaged packet"))
                })
                .is_ok();
                if is_good {
                    // Only the end: the plan drops the pre-skip at the beginning (Symphonia's Ogg reader leaves it out).
                    let frames = self.decoded.len() / self.channel_count;
                    let in_frames = |ticks: u64| {
                        usize::try_from(frames_from_ticks(ticks, self.time_base, OPUS_RATE_HZ)).unwrap_or(usize::MAX)
                    };
                    let kept = frames.saturating_sub(in_frames(packet.trim_end.get()));
                    self.decoded.truncate(kept * self.channel_count);
                }
                is_good
            }
            Decoder::Symphonia(decoder) => match guarded(|| decoder.decode(packet)) {
                Ok(buffer) => {
                    let spec = buffer.spec();
                    if spec.rate() != self.sample_rate_hz || spec.channels().count() != self.channel_count {
                        incidents.format_changed = true;
                        return false;
                    }
                    self.decoded.resize(buffer.samples_interleaved(), 0.0);
                    buffer.copy_to_slice_interleaved(&mut self.decoded[..]);
                    true
                }
                Err(_) => {
                    decoder.reset();
                    false
                }
            },
        }
    }

    /// Number of lost frames before a packet with this time.
    fn gap_before(&self, at_s: f64) -> Option<u64> {
        let gap_s = at_s - self.last_end_s?;
        let is_gap = gap_s >= self.gap_s_min? && gap_s <= GAP_S_MAX;
        is_gap.then(|| (gap_s * f64::from(self.sample_rate_hz)).round() as u64)
    }

    fn silence_for(&self, packet: &Packet) -> u64 {
        let frames = match &self.decoder {
            Decoder::Opus(_) => packet_frames(&packet.data),
            Decoder::Symphonia(_) => frames_from_ticks(packet.block_dur().get(), self.time_base, self.sample_rate_hz),
        };
        frames.min(PACKET_FRAMES_MAX)
    }

    /// Reads until a packet decodes and the decoder knows the true format, which a header can leave out or state wrongly (HE-AAC).
    /// Returns the time of the first packet; `None` where nothing decodes.
    pub(crate) fn settle_format(&mut self, packets_max: u32) -> io::Result<Option<f64>> {
        let mut incidents = Incidents::default();
        let mut first_s = None;
        for _ in 0..packets_max {
            let Some(packet) = self.packets.next_packet(&mut incidents)? else { return Ok(None) };
            let packet_s = *first_s.get_or_insert_with(|| seconds_from_ticks(packet.pts.get(), self.time_base));
            let is_settled = match &mut self.decoder {
                Decoder::Opus(_) => self.decode(&packet, &mut incidents),
                Decoder::Symphonia(decoder) => match guarded(|| decoder.decode(&packet)) {
                    Ok(buffer) => {
                        let (rate, channel_count) = (buffer.spec().rate(), buffer.spec().channels().count());
                        let is_settled = rate > 0 && channel_count > 0 && buffer.frames() > 0;
                        if is_settled {
                            (self.sample_rate_hz, self.channel_count) = (rate, channel_count);
                        }
                        is_settled
                    }
                    Err(_) => false,
                },
            };
            if is_settled {
                return Ok(Some(packet_s));
            }
        }
        Ok(None)
    }

    /// Replaces the format of the header.
    pub(crate) fn with_format(self, sample_rate_hz: u32, channel_count: usize) -> Self {
        Self { sample_rate_hz, channel_count, ..self }
    }

    pub(crate) fn format(&self) -> (u32, usize) {
        (self.sample_rate_hz, self.channel_count)
    }
}

impl Frames for NativeFrames {
    fn sample_rate_hz(&self) -> f64 {
        f64::from(self.sample_rate_hz)
    }

    fn channel_count(&self) -> usize {
        self.channel_count
    }

    fn next_frames(&mut self, out: &mut Vec<f32>, incidents: &mut Incidents) -> io::Result<bool> {
        out.clear();
        let held = self.held.take();
        let is_held = held.is_some();
        let Some(packet) = held.map_or_else(|| self.packets.next_packet(incidents), |packet| Ok(Some(packet)))? else {
            return Ok(false);
        };
        let at_s = seconds_from_ticks(packet.pts.get(), self.time_base);
        if !is_held && let Some(gap_frames) = self.gap_before(at_s) {
            out.resize(gap_frames as usize * self.channel_count, 0.0);
            incidents.corrupt_packets += 1;
            incidents.silence_frames += gap_frames;
            self.held = Some(packet);
            return Ok(true);
        }
        if self.decode(&packet, incidents) {
            std::mem::swap(out, &mut self.decoded);
        } else if incidents.format_changed {
            return Ok(false);
        } else {
            let silence_frames = self.silence_for(&packet);
            out.resize(silence_frames as usize * self.channel_count, 0.0);
            incidents.corrupt_packets += 1;
            incidents.silence_frames += silence_frames;
        }
        let frames = out.len() / self.channel_count.max(1);
        self.last_end_s = Some(at_s + frames as f64 / f64::from(self.sample_rate_hz));
        Ok(true)
    }
}

pub(crate) fn seconds_from_ticks(ticks: i64, time_base: Option<TimeBase>) -> f64 {
    time_base.map_or(0.0, |base| ticks as f64 * f64::from(base.numer.get()) / f64::from(base.denom.get()))
}

fn frames_from_ticks(ticks: u64, time_base: Option<TimeBase>, sample_rate_hz: u32) -> u64 {
    let Some(base) = time_base else { return 0 };
    let frames = u128::from(ticks) * u128::from(base.numer.get()) * u128::from(sample_rate_hz);
    u64::try_from((frames + u128::from(base.denom.get()) / 2) / u128::from(base.denom.get())).unwrap_or(u64::MAX)
}
