//! The audio tracks of a file, and a plan for decoding each.

use std::io::Read;

use crate::clipped::{Clipped, clipped_from_sizes};
use crate::codec;
use crate::coded::CodedSound;
use crate::container::{Container, Sniffed};
use crate::decoded::DecodedSound;
use crate::error::MediaError;
use crate::ffmpeg::{self, FfmpegUse, not_started};
use crate::file_access::FileAccess;
use crate::frames::Trim;
use crate::iso;
use crate::matroska::{self, MatroskaTrack};
use crate::native;
use crate::ogg;
use crate::opus::{OPUS_RATE_HZ, OpusHead};
use crate::plan::{NotNative, Plan, Route, Settled, settle};
use crate::quicktime::{self, AudioTrack, Movie};
use crate::warning::MediaWarning;
use crate::wave::{self, WaveCodec};

/// Bytes at the beginning of an AVI that contain its stream headers.
const AVI_HEAD_BYTES: u64 = 64 * 1024;

/// Tolerance of a stated length for codecs with constant packets, s: two packets of 1152 frames, or one of 2048, at 44.1 kHz.
const PACKET_SLACK_S: f64 = 0.053;

/// Tolerance of a start time of zero, s: Matroska has whole milliseconds.
const MATROSKA_TICK_SLACK_S: f64 = 0.002;

/// At and below this rate, AAC in ADTS is usually the core of HE-AAC.
const LIKELY_CORE_RATE_HZ: u32 = 24_000;

/// The audio tracks, in the order of the file.
pub(crate) struct Tracks<'a> {
    file: &'a dyn FileAccess,
    ffmpeg: &'a FfmpegUse,
    /// The sound, where another decoder has decoded it.
    decoded: Option<&'a DecodedSound>,
    container: Container,
    clipped: Clipped,
    list: List,
}

enum List {
    Iso(Movie),
    Matroska(matroska::Matroska),
    /// One track, or the tracks of a demuxer.
    Native {
        sniffed: Sniffed,
        track_ids: Vec<u32>,
    },
    Wave(Box<wave::WaveLayout>),
    /// Tracks that only ffmpeg knows.
    Foreign(ffmpeg::FfmpegInspection),
}

impl<'a> Tracks<'a> {
    /// Reads the list of tracks in the container.
    pub(crate) fn of(
        access: &'a dyn FileAccess,
        sniffed: &Sniffed,
        ffmpeg: &'a FfmpegUse,
        decoded: Option<&'a DecodedSound>,
    ) -> Result<Self, MediaError> {
        let container = sniffed.container;
        let mut file = access.open().map_err(MediaError::CannotOpen)?;
        let clipped = clipped_from_sizes(&mut file, container).map_err(MediaError::Read)?;
        let list = match container {
            Container::Wav | Container::Rf64 | Container::W64 => {
                List::Wave(Box::new(wave::layout_from_header(&mut file, container)?))
            }
            Container::Mov | Container::Mp4 | Container::ThreeGp => {
                let movie = quicktime::read_movie(&mut file)
                    .map_err(|error| MediaError::Damaged { container, why: error.to_string() })?;
                let movie =
                    movie.ok_or_else(|| MediaError::Damaged { container, why: "it has no movie header".to_owned() })?;
                List::Iso(movie)
            }
            Container::Matroska | Container::WebM => {
                List::Matroska(matroska::matroska_from_head(&mut file).map_err(MediaError::Read)?)
            }
            Container::Aiff | Container::Caf | Container::Flac | Container::Mp3 | Container::Adts | Container::Ogg => {
                match native::open_demuxer(access, container, sniffed.base, &clipped.patches) {
                    Ok(reader) => {
                        let audio = reader.tracks().iter().filter(|track| native::audio_parameters(track).is_some());
                        List::Native { sniffed: sniffed.clone(), track_ids: audio.map(|track| track.id).collect() }
                    }
                    Err(error) => match NotNative::from_symphonia(error, container) {
                        NotNative::Error(error) => {
                            List::Foreign(inspection(access, container, ffmpeg).map_err(|_| error)?)
                        }
                        NotNative::Unsupported => List::Foreign(inspection(access, container, ffmpeg)?),
                    },
                }
            }
            _ => List::Foreign(inspection(access, container, ffmpeg)?),
        };
        let tracks = Self { file: access, ffmpeg, decoded, container, clipped, list };
        if tracks.count() == 0 {
            return Err(MediaError::NoAudioTrack { container });
        }
        Ok(tracks)
    }

    /// Number of audio tracks.
    pub(crate) fn count(&self) -> usize {
        match &self.list {
            List::Iso(movie) => movie.tracks.len(),
            List::Matroska(matroska) => matroska.audio_tracks.len(),
            List::Native { track_ids, .. } => track_ids.len(),
            List::Wave(_) => 1,
            List::Foreign(inspection) => inspection.audio_codecs.len(),
        }
    }

    /// The plan for the track with an index counted from 0: hovertone's own decoders where possible, else ffmpeg.
    pub(crate) fn plan(&self, index: usize) -> Result<Plan, MediaError> {
        let no_such = || MediaError::NoSuchTrack { asked: index + 1, count: self.count() };
        let (native, codec) = match &self.list {
            List::Wave(layout) => match layout.codec {
                WaveCodec::Pcm(pcm) => {
                    return Ok(self.wave_plan(layout, Route::WavePcm { layout: (**layout).clone(), pcm }));
                }
                WaveCodec::Blocks(codec, _) => {
                    return Ok(self.wave_plan(layout, Route::WaveBlocks { layout: (**layout).clone(), codec }));
                }
                WaveCodec::Foreign(_) => (NotNative::Unsupported, layout.codec.name()),
            },
            List::Iso(movie) => {
                let track = movie.tracks.get(index).ok_or_else(no_such)?;
                match self.iso_plan(track, movie.is_fragmented) {
                    Ok(plan) => return Ok(plan),
                    Err(native) => (native, iso::codec_name(track)),
                }
            }
            List::Matroska(matroska) => {
                let track = matroska.audio_tracks.get(index).ok_or_else(no_such)?;
                match self.matroska_plan(matroska, track) {
                    Ok(plan) => return Ok(plan),
                    Err(native) => (native, track.codec_name()),
                }
            }
            List::Native { sniffed, track_ids } => {
                let track_id = *track_ids.get(index).ok_or_else(no_such)?;
                match self.native_plan(sniffed, track_id) {
                    Ok(plan) => return Ok(plan),
                    Err((native, codec)) => (native, codec),
                }
            }
            List::Foreign(inspection) => {
                let codec = inspection.audio_codecs.get(index).ok_or_else(no_such)?.clone();
                (NotNative::Unsupported, codec)
            }
        };
        self.ffmpeg_plan(index, codec, native)
    }

    fn wave_plan(&self, layout: &wave::WaveLayout, route: Route) -> Plan {
        let mut plan = Plan::new(self.container, layout.codec.name(), route);
        plan.declared_s = Some(layout.declared_duration_s());
        plan.is_cut_off = self.is_cut_off();
        if let Some((declared_bytes, actual_bytes)) = layout.wrong_size {
            plan.warnings.push(MediaWarning::WrongDataSize { declared_bytes, actual_bytes });
        }
        plan
    }

    fn iso_plan(&self, track: &AudioTrack, is_fragmented: bool) -> Result<Plan, NotNative> {
        let route = match (track.pcm.is_some(), self.decoded, is_fragmented) {
            (true, _, _) => Route::IsoPcm(Box::new(track.clone())),
            (false, Some(decoded), _) => Route::Decoded(decoded.clone()),
            (false, None, false) => Route::IsoTable(Box::new(track.clone())),
            (false, None, true) => {
                Route::Demuxer { base: 0, patches: Vec::new(), track_id: track.track_id, has_gapless_packets: false }
            }
        };
        let trim = Trim { skip_frames: track.skip_frames, kept_frames: track.kept_frames };
        let kept_frames = track.kept_frames.or(track.declared_frames.map(|all| all.saturating_sub(track.skip_frames)));
        let plan = Plan {
            trim,
            start_s: track.start_s,
            declared_s: kept_frames.map(|frames| frames as f64 / track.sample_rate_hz),
            ..Plan::new(self.container, iso::codec_name(track), route)
        };
        if track.pcm.is_some() {
            return Ok(plan);
        }
        let Settled { mut plan, sample_rate_hz, .. } = settle(self.file, plan)?;
        plan.declared_slack_s = PACKET_SLACK_S;
        // The edit list counts at the rate of the header; the core of HE-AAC has half of it.
        let scaled = |frames: u64| (frames as f64 * sample_rate_hz / track.sample_rate_hz).round() as u64;
        plan.trim = Trim { skip_frames: scaled(trim.skip_frames), kept_frames: trim.kept_frames.map(scaled) };
        // a decoder of HE-AAC as a whole has the rate of the header
        if track.half_rate_aac.is_some() && self.decoded.is_none() {
            plan.warnings.push(MediaWarning::HalfRateAac { core_rate_hz: sample_rate_hz, is_certain: true });
        }
        Ok(plan)
    }

    fn matroska_plan(&self, matroska: &matroska::Matroska, track: &MatroskaTrack) -> Result<Plan, NotNative> {
        let track_id = u32::try_from(track.number).map_err(|_| NotNative::Unsupported)?;
        let route = match self.decoded {
            Some(decoded) => Route::Decoded(decoded.clone()),
            None => Route::Demuxer { base: 0, patches: matroska.patches.clone(), track_id, has_gapless_packets: true },
        };
        let settled = settle(self.file, Plan::new(self.container, track.codec_name(), route))?;
        let Settled { mut plan, sample_rate_hz, first_packet_s } = settled;
        let pre_skip = OpusHead::from_extra_data(&track.codec_private).map(|head| head.pre_skip_frames as f64);
        let skip_s = match pre_skip.filter(|_| track.codec_id == "A_OPUS") {
            Some(frames) => frames / f64::from(OPUS_RATE_HZ),
            None => track.codec_delay_s,
        };
        plan.trim.skip_frames = (skip_s * sample_rate_hz).round() as u64;
        let start_s = first_packet_s + skip_s;
        plan.start_s = if start_s.abs() <= MATROSKA_TICK_SLACK_S { 0.0 } else { start_s };
        plan.approximate_s = matroska.duration_s;
        plan.is_cut_off = self.is_cut_off();
        plan.has_open_end = matroska.has_open_end;
        if track.codec_id.starts_with("A_AAC")
            && self.decoded.is_none()
            && quicktime::half_rate_from_config(&track.codec_private, track.output_rate_hz).is_some()
        {
            plan.warnings.push(MediaWarning::HalfRateAac { core_rate_hz: sample_rate_hz, is_certain: true });
        }
        Ok(plan)
    }

    fn native_plan(&self, sniffed: &Sniffed, track_id: u32) -> Result<Plan, (NotNative, String)> {
        let reader =
            native::open_demuxer(self.file, self.container, sniffed.base, &self.clipped.patches).map_err(|error| {
                (NotNative::from_symphonia(error, self.container), self.container.codec_guess().to_owned())
            })?;
        let track = reader.tracks().iter().find(|track| track.id == track_id);
        let codec = track.and_then(native::audio_parameters).map_or("an unknown codec", |p| codec::codec_name(p.codec));
        let opus = track.and_then(native::audio_parameters).and_then(codec::opus_head);
        let promised = track.map(|track| (track.delay, track.num_frames)).unwrap_or_default();
        // The trims of the demuxer are correct in Ogg; in MP3 they come from a guessed length.
        let has_gapless_packets = self.container == Container::Ogg;
        let route = match self.decoded {
            Some(decoded) => Route::Decoded(decoded.clone()),
            None => {
                let patches = self.clipped.patches.clone();
                Route::Demuxer { base: sniffed.base, patches, track_id, has_gapless_packets }
            }
        };
        let settled = settle(self.file, Plan::new(self.container, codec, route));
        let Settled { mut plan, sample_rate_hz: rate, .. } = settled.map_err(|native| (native, codec.to_owned()))?;
        match (self.container, &sniffed.mpeg) {
            (Container::Mp3, Some(mpeg)) => {
                let (delay, padding) = mpeg.delay_and_padding.unwrap_or_default();
                let kept_frames = mpeg.total_frames.map(|total| total.saturating_sub(delay + padding));
                plan.trim = Trim { skip_frames: delay, kept_frames };
                plan.declared_s = kept_frames.map(|frames| frames as f64 / rate);
                plan.declared_slack_s = PACKET_SLACK_S;
            }
            (Container::Adts, Some(mpeg)) if mpeg.sample_rate_hz <= LIKELY_CORE_RATE_HZ && self.decoded.is_none() => {
                plan.warnings.push(MediaWarning::HalfRateAac { core_rate_hz: rate, is_certain: false });
            }
            (Container::Flac | Container::Aiff, _) => plan.declared_s = promised.1.map(|frames| frames as f64 / rate),
            (Container::Caf, _) => {
                let skip_frames = promised.0.map_or(0, u64::from);
                plan.trim = Trim { skip_frames, kept_frames: promised.1.filter(|_| skip_frames > 0) };
                plan.declared_s = promised.1.map(|frames| frames as f64 / rate);
                plan.declared_slack_s = PACKET_SLACK_S;
            }
            (Container::Ogg, _) => {
                plan.is_cut_off = self.is_cut_off();
                plan.trim.skip_frames = opus.map_or(0, |head| head.pre_skip_frames);
                plan.approximate_s = promised.1.map(|frames| frames as f64 / rate);
            }
            _ => {}
        }
        if self.clipped.is_cut_off {
            // the demuxer states the length after its own trims
            (plan.declared_s, plan.is_cut_off) = (None, true);
        }
        Ok(plan)
    }

    /// Whether the sizes in the container show that the end is missing.
    fn is_cut_off(&self) -> bool {
        match &self.list {
            List::Matroska(matroska) => matroska.is_truncated,
            List::Wave(layout) => layout.is_truncated(),
            _ if self.container == Container::Ogg => {
                self.file.open().and_then(|mut file| ogg::last_page_is_cut(&mut file)).unwrap_or(false)
            }
            _ => self.clipped.is_cut_off,
        }
    }

    /// The packets of the first track, for another decoder; `None` where hovertone knows no such packets.
    pub(crate) fn coded_sound(&self) -> Option<CodedSound> {
        match &self.list {
            List::Iso(movie) => CodedSound::of_iso(self.file, self.container, movie),
            List::Matroska(matroska) => CodedSound::of_matroska(self.file, self.container, matroska),
            List::Native { sniffed, track_ids } if self.container == Container::Adts => {
                CodedSound::of_adts(self.file, sniffed, *track_ids.first()?)
            }
            _ => None,
        }
    }

    fn ffmpeg_plan(&self, audio_index: usize, codec: String, native: NotNative) -> Result<Plan, MediaError> {
        if let NotNative::Error(error @ (MediaError::Read(_) | MediaError::BadHeader { .. })) = native {
            return Err(error);
        }
        let container = self.container;
        let tried = self.ffmpeg.program().zip(self.file.path()).map(|(program, path)| {
            let inspected = ffmpeg::inspect(&program, path, audio_index);
            let route = Route::Ffmpeg { program, path: path.to_owned(), audio_index };
            (route, inspected)
        });
        match (tried, native) {
            (Some((route, Ok(inspection))), _) if inspection.audio_codecs.len() > audio_index => {
                let mut plan = Plan::new(container, codec, route);
                plan.start_s = inspection.start_s;
                plan.approximate_s = inspection.duration_s;
                plan.is_cut_off = self.is_cut_off();
                Ok(plan)
            }
            (_, NotNative::Error(error)) => Err(error),
            (Some((_, Ok(inspection))), _) => {
                let message = inspection.first_complaint.unwrap_or_else(|| "nothing".to_owned());
                Err(MediaError::FfmpegFailed { container, codec, message })
            }
            (Some((_, Err(error))), _) => {
                let why = not_started(&error);
                Err(MediaError::NeedsFfmpeg { container, codec, why })
            }
            (None, _) => Err(MediaError::NeedsFfmpeg { container, codec, why: why_no_ffmpeg(self.ffmpeg) }),
        }
    }
}

/// Name of the codec without a demuxer; for an AVI from the format of its first audio stream.
fn codec_guess(file: &dyn FileAccess, container: Container) -> String {
    let from_avi = || {
        let mut head = Vec::new();
        file.open().ok()?.take(AVI_HEAD_BYTES).read_to_end(&mut head).ok()?;
        let audio_at = head.windows(8).position(|window| window.ends_with(b"auds"))?;
        let format_at = audio_at + head.get(audio_at..)?.windows(4).position(|window| window == b"strf")?;
        let code = head.get(format_at + 8..)?.first_chunk().map(|code| u16::from_le_bytes(*code))?;
        Some(wave::codec_name_from_code(code))
    };
    let told = if container == Container::Avi { from_avi() } else { None };
    told.unwrap_or_else(|| container.codec_guess().to_owned())
}

/// Why no ffmpeg is asked.
fn why_no_ffmpeg(ffmpeg: &FfmpegUse) -> String {
    match ffmpeg.program() {
        Some(_) => "ffmpeg reads files on a disk only; copy the recording to a disk".to_owned(),
        None => "ffmpeg is switched off here; switch it on".to_owned(),
    }
}

/// The list of tracks from ffmpeg, for containers without a native demuxer.
fn inspection(
    file: &dyn FileAccess,
    container: Container,
    ffmpeg: &FfmpegUse,
) -> Result<ffmpeg::FfmpegInspection, MediaError> {
    let codec = codec_guess(file, container);
    let Some((program, path)) = ffmpeg.program().zip(file.path()) else {
        return Err(MediaError::NeedsFfmpeg { container, codec, why: why_no_ffmpeg(ffmpeg) });
    };
    let inspection = ffmpeg::inspect(&program, path, 0).map_err(|error| {
        let why = not_started(&error);
        MediaError::NeedsFfmpeg { container, codec: codec.clone(), why }
    })?;
    if !inspection.has_input || inspection.is_guess {
        let message = inspection.first_complaint.unwrap_or_else(|| "nothing".to_owned());
        return Err(MediaError::FfmpegFailed { container, codec, message });
    }
    Ok(inspection)
}
