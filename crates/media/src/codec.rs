//! Codecs: their names, and the decoder for each.

use symphonia::core::codecs::audio::well_known::{
    CODEC_ID_AAC, CODEC_ID_AC3, CODEC_ID_ADPCM_IMA_QT, CODEC_ID_ADPCM_IMA_WAV, CODEC_ID_ADPCM_MS, CODEC_ID_ALAC,
    CODEC_ID_DCA, CODEC_ID_EAC3, CODEC_ID_FLAC, CODEC_ID_MP1, CODEC_ID_MP2, CODEC_ID_MP3, CODEC_ID_OPUS,
    CODEC_ID_PCM_ALAW, CODEC_ID_PCM_F32BE, CODEC_ID_PCM_F32LE, CODEC_ID_PCM_F64BE, CODEC_ID_PCM_F64LE,
    CODEC_ID_PCM_MULAW, CODEC_ID_PCM_S8, CODEC_ID_PCM_S16BE, CODEC_ID_PCM_S16LE, CODEC_ID_PCM_S24BE,
    CODEC_ID_PCM_S24LE, CODEC_ID_PCM_S32BE, CODEC_ID_PCM_S32LE, CODEC_ID_PCM_U8, CODEC_ID_SPEEX, CODEC_ID_VORBIS,
};
use symphonia::core::codecs::audio::{AudioCodecId, AudioCodecParameters, AudioDecoder, AudioDecoderOptions};
use symphonia::core::errors::Error as SymphoniaError;

use crate::guard::guarded;
use crate::opus::{OPUS_RATE_HZ, OpusHead, OpusPackets};

/// Longest packet of any codec here, in bytes; a longer one is damage.
pub(crate) const PACKET_FRAMES_MAX: u64 = 65_536;

/// Largest number of channels; more are damage.
pub(crate) const CHANNEL_COUNT_MAX: usize = 256;

/// The decoder of packets.
pub(crate) enum Decoder {
    Symphonia(Box<dyn AudioDecoder>),
    Opus(OpusPackets),
}

/// The identification header of an Opus track.
pub(crate) fn opus_head(parameters: &AudioCodecParameters) -> Option<OpusHead> {
    let extra_data = parameters.extra_data.as_deref().filter(|_| parameters.codec == CODEC_ID_OPUS)?;
    OpusHead::from_extra_data(extra_data)
}

/// The decoder of a track, with the rate and the channels of its header.
pub(crate) fn decoder_for(
    parameters: &AudioCodecParameters,
    has_gapless_packets: bool,
) -> Result<(Decoder, u32, usize), SymphoniaError> {
    if parameters.codec == CODEC_ID_OPUS {
        let head =
            opus_head(parameters).ok_or(SymphoniaError::DecodeError("the header of the Opus sound is missing"))?;
        let decoder = OpusPackets::new(head)
            .map_err(|_| SymphoniaError::DecodeError("the header of the Opus sound is damaged"))?;
        let channel_count = decoder.channel_count();
        return Ok((Decoder::Opus(decoder), OPUS_RATE_HZ, channel_count));
    }
    check_parameters(parameters)?;
    let options = AudioDecoderOptions::default().gapless(has_gapless_packets);
    let decoder = guarded(|| symphonia::default::get_codecs().make_audio_decoder(parameters, &options))?;
    let sample_rate_hz = parameters.sample_rate.unwrap_or(0);
    let channel_count = parameters.channels.as_ref().map_or(0, |channels| channels.count());
    Ok((Decoder::Symphonia(decoder), sample_rate_hz, channel_count))
}

/// Refuses absurd sizes of damaged headers before a decoder allocates memory: a failed allocation ends the program.
fn check_parameters(parameters: &AudioCodecParameters) -> Result<(), SymphoniaError> {
    let is_adpcm = matches!(parameters.codec, CODEC_ID_ADPCM_IMA_QT | CODEC_ID_ADPCM_IMA_WAV | CODEC_ID_ADPCM_MS);
    // Symphonia's ADPCM decoder panics with more than two channels.
    let channel_count_max = if is_adpcm { 2 } else { CHANNEL_COUNT_MAX };
    if parameters.channels.as_ref().is_some_and(|channels| channels.count() > channel_count_max) {
        return Err(SymphoniaError::Unsupported("too many channels"));
    }
    let frames = [parameters.max_frames_per_packet, parameters.frames_per_block];
    if frames.into_iter().flatten().any(|frames| frames > PACKET_FRAMES_MAX) {
        return Err(SymphoniaError::DecodeError("its header gives a packet length that is too large"));
    }
    Ok(())
}

/// Name of a codec for people.
pub(crate) fn codec_name(codec: AudioCodecId) -> &'static str {
    match codec {
        CODEC_ID_AAC => "AAC",
        CODEC_ID_AC3 => "AC-3",
        CODEC_ID_EAC3 => "E-AC-3",
        CODEC_ID_DCA => "DTS",
        CODEC_ID_ALAC => "ALAC",
        CODEC_ID_FLAC => "FLAC",
        CODEC_ID_MP1 => "MPEG layer 1",
        CODEC_ID_MP2 => "MPEG layer 2",
        CODEC_ID_MP3 => "MP3",
        CODEC_ID_OPUS => "Opus",
        CODEC_ID_SPEEX => "Speex",
        CODEC_ID_VORBIS => "Vorbis",
        CODEC_ID_ADPCM_IMA_QT => "IMA ADPCM",
        CODEC_ID_PCM_ALAW => "A-law",
        CODEC_ID_PCM_MULAW => "mu-law",
        CODEC_ID_PCM_U8 | CODEC_ID_PCM_S8 => "8-bit PCM",
        CODEC_ID_PCM_S16LE | CODEC_ID_PCM_S16BE => "16-bit PCM",
        CODEC_ID_PCM_S24LE | CODEC_ID_PCM_S24BE => "24-bit PCM",
        CODEC_ID_PCM_S32LE | CODEC_ID_PCM_S32BE => "32-bit PCM",
        CODEC_ID_PCM_F32LE | CODEC_ID_PCM_F32BE => "32-bit float PCM",
        CODEC_ID_PCM_F64LE | CODEC_ID_PCM_F64BE => "64-bit float PCM",
        _ => "an unknown codec",
    }
}
