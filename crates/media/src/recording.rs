//! A recording as a stream of mono samples: open, choose a track, decode, rewind.

use std::fmt;
use std::io::{BufReader, Seek, SeekFrom};
use std::ops::RangeInclusive;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use hovertone_signal::{SignalSource, SourceError};

use crate::choose;
use crate::codec::CHANNEL_COUNT_MAX;
use crate::container::{self, Container, Sniffed};
use crate::decoded::DecodedSound;
use crate::error::MediaError;
use crate::ffmpeg::FfmpegUse;
use crate::file_access::{FileAccess, OpenFile};
use crate::frames::{Frames, Incidents, Trim};
use crate::mix::Mix;
use crate::mix_loss::MixLoss;
use crate::plan::{Plan, Route};
use crate::recording_info::{Decoder, RecordingInfo};
use crate::samples::Samples;
use crate::tracks::Tracks;
use crate::warning::{MediaWarning, Warnings};

/// Fewest samples of a block, except for the last one. Small packets are joined, and memory does not grow.
const BLOCK_FRAMES_MIN: usize = 4096;

/// *Numeric.*
const MILLION: f64 = 1e6;

/// Options for opening a file.
#[derive(Clone, Debug, Default)]
pub struct OpenOptions {
    /// Number of the audio track, counted from 1. `None`: the first that is not silent.
    pub audio_track: Option<usize>,
    /// Number of the channel, counted from 1. `None`: the mean of all.
    pub channel: Option<usize>,
    /// Correction of the recorder's clock, in millionths: the samples count as taken at a rate that is higher by this share.
    pub clock_correction_ppm: f64,
    /// The ffmpeg for formats that this crate cannot decode.
    pub ffmpeg: FfmpegUse,
    /// The sound of the file, where another decoder has decoded the packets of [`crate::CodedSound`].
    pub decoded: Option<DecodedSound>,
}

/// An open recording. It reads the file block by block: memory does not grow with its length.
pub struct Recording {
    file: Arc<dyn FileAccess>,
    plan: Plan,
    info: RecordingInfo,
    warnings: Warnings,
    mix: Mix,
    pass: Pass,
    block: Vec<f32>,
    is_prefix: bool,
}

/// Audio samples at full scale: the largest of 16 bits is 0.99997. Floats beyond it were not clipped. *Physics.*
const FULL_SCALE: RangeInclusive<f32> = 0.9999..=1.0;
/// A larger share of audio samples at full scale is no single peak: a sine that just reaches full scale has 0.9 %. *Decision.*
const OVERDRIVEN_SHARE: f64 = 0.05;
/// … if there are audio samples of this length at full scale: a click is shorter. *Decision.*
const OVERDRIVEN_S: f64 = 0.1;

/// One pass through the sound.
struct Pass {
    frames: Box<dyn Frames>,
    trim: Trim,
    interleaved: Vec<f32>,
    incidents: Incidents,
    non_finite_samples: u64,
    /// Samples at full scale.
    full_samples: u64,
    mix_loss: MixLoss,
    heard_frames: u64,
    has_ended: bool,
    /// The block was already decoded, to prove that there is one.
    is_block_ahead: bool,
}

impl Recording {
    /// Opens a file, chooses its track and decodes its first block.
    ///
    /// # Errors
    /// All reasons for missing sound; see [`MediaError`].
    pub fn open(path: &Path, options: &OpenOptions) -> Result<Self, MediaError> {
        check_file(path)?;
        Self::open_file(Arc::new(path.to_owned()), options)
    }

    /// The same for a file at no path.
    ///
    /// # Errors
    /// All reasons for missing sound; see [`MediaError`].
    pub fn open_file(file: Arc<dyn FileAccess>, options: &OpenOptions) -> Result<Self, MediaError> {
        let opened = Self::open_any(&file, options);
        // what looks damaged where a read failed is not known to be
        opened.map_err(|error| file.failure().map_or(error, MediaError::Read))
    }

    fn open_any(file: &Arc<dyn FileAccess>, options: &OpenOptions) -> Result<Self, MediaError> {
        let sniffed = sniffed_from_file(&**file, &options.ffmpeg)?;
        let tracks = Tracks::of(&**file, &sniffed, &options.ffmpeg, options.decoded.as_ref())?;
        let audio_track_count = tracks.count();
        let mut warnings = Warnings::default();
        if let Some(extension) = file.name().extension().and_then(|extension| extension.to_str())
            && !sniffed.container.fits_extension(extension)
        {
            let (extension, container) = (extension.to_owned(), sniffed.container);
            warnings.put(MediaWarning::WrongExtension { extension, container });
        }
        let (index, plan) = match options.audio_track {
            Some(asked) => match asked.checked_sub(1).filter(|index| *index < audio_track_count) {
                Some(index) => (index, tracks.plan(index)?),
                None => return Err(MediaError::NoSuchTrack { asked, count: audio_track_count }),
            },
            None if audio_track_count == 1 => (0, tracks.plan(0)?),
            None => {
                let choice = choose::first_audible_track(&**file, &tracks)?;
                let (chosen, count, silent) = (choice.index + 1, audio_track_count, choice.silent);
                warnings.put(MediaWarning::SeveralAudioTracks { chosen, count, silent });
                (choice.index, choice.plan)
            }
        };
        plan.warnings.iter().cloned().for_each(|warning| warnings.put(warning));
        Self::start(Arc::clone(file), plan, index, audio_track_count, options, warnings)
    }

    /// Opens samples in memory, which are one track.
    ///
    /// # Errors
    /// A track or a channel that is not there; no sample; a rate that is none.
    pub fn of_samples(samples: &Samples, options: &OpenOptions) -> Result<Self, MediaError> {
        if let Some(asked) = options.audio_track.filter(|asked| *asked != 1) {
            return Err(MediaError::NoSuchTrack { asked, count: 1 });
        }
        let rate_hz = samples.sample_rate_hz();
        if !(rate_hz.is_finite() && rate_hz >= 1.0) {
            return Err(MediaError::RateOfArray { rate_hz });
        }
        let declared_s = Some(samples.duration_s());
        let plan = Plan::new(Container::Memory, "samples", Route::Memory(samples.clone()));
        // the samples are in the plan: no file is opened
        let file = Arc::new(PathBuf::new());
        Self::start(file, Plan { declared_s, ..plan }, 0, 1, options, Warnings::default())
    }

    fn start(
        file: Arc<dyn FileAccess>,
        plan: Plan,
        index: usize,
        audio_track_count: usize,
        options: &OpenOptions,
        warnings: Warnings,
    ) -> Result<Self, MediaError> {
        let pass = Pass::start(&*file, &plan)?;
        let (sample_rate_hz, channel_count) = (pass.frames.sample_rate_hz(), pass.frames.channel_count());
        let container = plan.container;
        let bad = |field, value, limit| Err(MediaError::BadHeader { container, field, value, limit });
        if !(sample_rate_hz.is_finite() && sample_rate_hz >= 1.0) {
            return bad("the sample rate", sample_rate_hz as u64, "at least 1 Hz");
        }
        if channel_count == 0 || channel_count > CHANNEL_COUNT_MAX {
            return bad("the number of channels", channel_count as u64, "1 to 256");
        }
        let mix = Mix::of(channel_count, options.channel)?;
        let info = RecordingInfo {
            container,
            codec: plan.codec.clone(),
            sample_rate_hz: sample_rate_hz * (1.0 + options.clock_correction_ppm / MILLION),
            clock_correction_ppm: options.clock_correction_ppm,
            channel_count,
            channel: options.channel,
            audio_track: index + 1,
            audio_track_count,
            declared_duration_s: plan.declared_s.or(plan.approximate_s),
            start_s: plan.start_s,
            decoder: Decoder::of(&plan.route),
        };
        let mut recording = Self { file, plan, info, warnings, mix, pass, block: Vec::new(), is_prefix: false };
        recording.fill_block().map_err(MediaError::Read)?;
        if recording.block.is_empty() {
            return Err(recording.nothing_heard());
        }
        recording.pass.is_block_ahead = true;
        Ok(recording)
    }

    /// Facts about the recording.
    pub fn info(&self) -> &RecordingInfo {
        &self.info
    }

    /// The bytes of the file, from the first on.
    ///
    /// # Errors
    /// The file cannot be opened again.
    pub fn bytes(&self) -> std::io::Result<OpenFile> {
        self.file.open()
    }

    /// The warnings so far. More can come during a pass; a second pass changes nothing.
    pub fn warnings(&self) -> &[MediaWarning] {
        self.warnings.as_slice()
    }

    /// Whether the file ended before its sound did; final after a complete pass.
    pub fn is_prefix(&self) -> bool {
        self.is_prefix
    }

    fn nothing_heard(&self) -> MediaError {
        let container = self.plan.container;
        match (&self.plan.route, &self.pass.incidents.ffmpeg_message) {
            (Route::Ffmpeg { .. }, Some(message)) => {
                MediaError::FfmpegFailed { container, codec: self.plan.codec.clone(), message: message.clone() }
            }
            (Route::Memory(_), _) => MediaError::NoSampleInArray,
            _ => MediaError::NoSamples { container, why: "no sound follows its header".to_owned() },
        }
    }

    /// Decodes until the block is long enough or the sound ends.
    fn fill_block(&mut self) -> std::io::Result<()> {
        self.block.clear();
        let pass = &mut self.pass;
        while !pass.has_ended && self.block.len() < BLOCK_FRAMES_MIN {
            let has_more = pass.frames.next_frames(&mut pass.interleaved, &mut pass.incidents)?;
            let wants_more = pass.trim.apply(&mut pass.interleaved, self.mix.channel_count);
            pass.non_finite_samples += self.mix.append(&mut pass.interleaved, &mut self.block, &mut pass.mix_loss);
            pass.has_ended = !(has_more && wants_more);
        }
        let decoded_failure = match &self.plan.route {
            Route::Decoded(sound) => sound.samples.failure(),
            _ => None,
        };
        if let Some(error) = self.file.failure().or(decoded_failure) {
            return Err(error);
        }
        pass.heard_frames += self.block.len() as u64;
        let full: u32 = self.block.iter().map(|sample| u32::from(FULL_SCALE.contains(&sample.abs()))).sum();
        pass.full_samples += u64::from(full);
        self.note_incidents();
        Ok(())
    }

    fn note_incidents(&mut self) {
        // lengths in headers are by the clock of the recorder
        let rate = self.pass.frames.sample_rate_hz();
        let Pass { incidents, non_finite_samples, full_samples, heard_frames, has_ended, .. } = &self.pass;
        if *non_finite_samples > 0 {
            self.warnings.put_larger(MediaWarning::NonFiniteSamples { count: *non_finite_samples });
        }
        if incidents.corrupt_packets > 0 {
            let silence_s = incidents.silence_frames as f64 / rate;
            self.warnings.put_larger(MediaWarning::CorruptPackets { count: incidents.corrupt_packets, silence_s });
        }
        if incidents.format_changed {
            self.warnings.put(MediaWarning::FormatChange { at_s: *heard_frames as f64 / rate });
        }
        if let Some(message) = &incidents.ffmpeg_message {
            self.warnings.put(MediaWarning::Ffmpeg { message: message.clone() });
        }
        let full_share = *full_samples as f64 / (*heard_frames).max(1) as f64;
        let full_s = *full_samples as f64 / rate;
        if *has_ended && full_share > OVERDRIVEN_SHARE && full_s > OVERDRIVEN_S {
            self.warnings.put(MediaWarning::Overdriven { share: full_share });
        }
        let of_mix = MediaWarning::of_mix(&self.pass.mix_loss).filter(|_| *has_ended);
        of_mix.into_iter().for_each(|warning| self.warnings.put(warning));
        if *has_ended {
            let decoded_s = *heard_frames as f64 / rate;
            let plan = &self.plan;
            let short_of_s = plan.short_of_s(decoded_s + 0.5 / rate, incidents.ffmpeg_message.is_some());
            let ended_early = incidents.is_cut_off && !plan.has_open_end;
            let is_cut_off = plan.declared_s.is_none() && (ended_early || plan.is_cut_off);
            self.is_prefix = short_of_s.is_some() || is_cut_off || incidents.format_changed;
            if short_of_s.is_some() || is_cut_off {
                let declared_s = plan.declared_s.or(short_of_s);
                self.warnings.put(MediaWarning::Truncated { decoded_s, declared_s });
            }
        }
    }
}

impl fmt::Debug for Recording {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Recording").field("file", &self.file.name()).field("info", &self.info).finish_non_exhaustive()
    }
}

impl SignalSource for Recording {
    fn sample_rate_hz(&self) -> f64 {
        self.info.sample_rate_hz
    }

    fn start_s(&self) -> f64 {
        self.info.start_s
    }

    fn next_block(&mut self) -> Result<Option<&[f32]>, SourceError> {
        if !std::mem::take(&mut self.pass.is_block_ahead) {
            self.fill_block().map_err(|error| SourceError::new(MediaError::Read(error)))?;
        }
        Ok((!self.block.is_empty()).then_some(self.block.as_slice()))
    }

    fn rewind(&mut self) -> Result<(), SourceError> {
        self.pass = Pass::start(&*self.file, &self.plan).map_err(SourceError::new)?;
        self.block.clear();
        Ok(())
    }
}

impl Pass {
    fn start(file: &dyn FileAccess, plan: &Plan) -> Result<Self, MediaError> {
        Ok(Self {
            frames: plan.open(file)?,
            trim: plan.trim,
            interleaved: Vec::new(),
            incidents: Incidents::default(),
            non_finite_samples: 0,
            full_samples: 0,
            mix_loss: MixLoss::default(),
            heard_frames: 0,
            has_ended: false,
            is_block_ahead: false,
        })
    }
}

fn check_file(path: &Path) -> Result<(), MediaError> {
    let metadata = std::fs::metadata(path).map_err(MediaError::CannotOpen)?;
    if !metadata.is_file() {
        return Err(MediaError::NotAFile);
    }
    Ok(())
}

pub(crate) fn sniffed_from_file(access: &dyn FileAccess, ffmpeg: &FfmpegUse) -> Result<Sniffed, MediaError> {
    let mut file = BufReader::new(access.open().map_err(MediaError::CannotOpen)?);
    if file.seek(SeekFrom::End(0)).map_err(MediaError::Read)? == 0 {
        return Err(MediaError::Empty);
    }
    if let Some(sniffed) = container::container_from_content(&mut file).map_err(MediaError::Read)? {
        return Ok(sniffed);
    }
    // ffmpeg knows more formats, but it takes any bytes for MP3 if the name says so, and its log then shows that it guessed.
    let inspection =
        ffmpeg.program().zip(access.path()).and_then(|(program, path)| crate::ffmpeg::inspect(&program, path, 0).ok());
    match inspection {
        Some(found) if found.has_input && !found.is_guess && !found.audio_codecs.is_empty() => {
            Ok(Sniffed { container: Container::Other, base: 0, mpeg: None })
        }
        _ => Err(MediaError::UnknownFormat { content: container::content_in_words(&mut file) }),
    }
}
