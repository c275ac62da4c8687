//! Recordings that hovertone cannot decode itself: an `ffmpeg` decodes them into a pipe, at their own rate and number of channels.

use std::ffi::OsString;
use std::io::{self, BufReader, Read};
use std::path::{Path, PathBuf};
use std::process::{Child, ChildStdout, Command, Stdio};
use std::thread::JoinHandle;

use crate::frames::{Frames, Incidents};
use crate::wave;

/// Sample frames of one block.
const BLOCK_FRAMES: usize = 4096;

/// Messages are read up to this number of bytes; the rest is discarded.
const MESSAGE_BYTES_MAX: usize = 64 * 1024;

/// Demuxers that read one file and no other.
const FORMATS: &str = "aac,ac3,act,aiff,aix,amr,amrnb,amrwb,ape,apm,asf,au,avi,avr,caf,dsf,dts,dtshd,dv,eac3,flac,flv,g722,\
    g726,gsm,gxf,ircam,ivf,loas,matroska,mlp,mov,mp3,mpc,mpc8,mpeg,mpegts,mxf,nut,ogg,oma,qcp,rm,roq,shn,smk,sox,spdif,\
    swf,tak,truehd,tta,voc,w64,wav,wsaud,wtv,wv,xwma";

/// The ffmpeg that decodes what hovertone cannot.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub enum FfmpegUse {
    /// The ffmpeg in the search path.
    #[default]
    FromPath,
    /// The ffmpeg at this path.
    At(PathBuf),
    /// None: recordings that need it are refused.
    Never,
}

impl FfmpegUse {
    pub(crate) fn program(&self) -> Option<PathBuf> {
        match self {
            Self::FromPath => Some(PathBuf::from("ffmpeg")),
            Self::At(path) => Some(path.clone()),
            Self::Never => None,
        }
    }
}

/// Facts about a file from ffmpeg.
#[derive(Clone, Debug, Default)]
pub(crate) struct FfmpegInspection {
    /// Codecs of the audio tracks.
    pub(crate) audio_codecs: Vec<String>,
    pub(crate) has_input: bool,
    pub(crate) is_guess: bool,
    pub(crate) duration_s: Option<f64>,
    /// Time of the first frame of the first audio track.
    pub(crate) start_s: f64,
    pub(crate) first_complaint: Option<String>,
}

/// Runs ffmpeg to list the tracks and to find the time of the first frame of one of them. The error means that there is no ffmpeg.
pub(crate) fn inspect(program: &Path, file: &Path, audio_index: usize) -> io::Result<FfmpegInspection> {
    let mut command = command(program, "info");
    command.args(["-copyts", "-start_at_zero"]).arg("-i").arg(file_url(file));
    command.args(["-map", &format!("0:a:{audio_index}"), "-vn", "-sn", "-dn", "-af", "ashowinfo", "-frames:a", "1"]);
    command.args(["-f", "null", "-"]).stdout(Stdio::null());
    let mut child = command.spawn()?;
    let messages = child.stderr.take().map(|mut stderr| read_messages(&mut stderr)).unwrap_or_default();
    child.wait()?;
    Ok(inspection_from_messages(&messages))
}

fn inspection_from_messages(messages: &str) -> FfmpegInspection {
    let mut found = FfmpegInspection::default();
    let mut is_in_input = false;
    for line in messages.lines() {
        let text = line.trim_start();
        if text.starts_with("Input #") {
            (is_in_input, found.has_input) = (true, true);
        } else if text.starts_with("Output #") || text.starts_with("Stream mapping") {
            is_in_input = false;
        } else if text.contains("misdetection possible") {
            found.is_guess = true;
        } else if let Some((_, codec)) =
            text.split_once(": Audio: ").filter(|_| is_in_input && text.starts_with("Stream #"))
        {
            found.audio_codecs.push(codec_name(codec.split([',', ' ']).next().unwrap_or_default()));
        } else if let Some(duration) = text.strip_prefix("Duration: ").filter(|_| is_in_input) {
            found.duration_s = duration.split(',').next().and_then(seconds_from_clock);
        } else if let Some((_, rest)) = text.split_once(" n:0 ").filter(|_| text.contains("ashowinfo")) {
            let time = rest.split_once("pts_time:").and_then(|(_, time)| time.split_whitespace().next());
            found.start_s =
                time.and_then(|time| time.parse().ok()).filter(|time: &f64| time.is_finite()).unwrap_or(0.0);
        }
    }
    found.first_complaint = complaint_from_messages(messages);
    found
}

/// Name for people of a codec in ffmpeg.
fn codec_name(codec: &str) -> String {
    let name = match codec {
        "aac" => "AAC",
        "ac3" => "AC-3",
        "eac3" => "E-AC-3",
        "dts" => "DTS",
        "mp2" => "MPEG layer 2",
        "mp3" | "mp3float" => "MP3",
        "opus" => "Opus",
        "vorbis" => "Vorbis",
        "alac" => "ALAC",
        "flac" => "FLAC",
        "wavpack" => "WavPack",
        "tta" => "TTA",
        "speex" => "Speex",
        "wmav1" | "wmav2" | "wmapro" | "wmalossless" => "WMA",
        "adpcm_ima_qt" | "adpcm_ima_wav" => "IMA ADPCM",
        "adpcm_ms" => "MS ADPCM",
        "pcm_alaw" => "A-law",
        "pcm_mulaw" => "mu-law",
        "pcm_u8" | "pcm_s8" => "8-bit PCM",
        "pcm_s16le" | "pcm_s16be" => "16-bit PCM",
        "pcm_s24le" | "pcm_s24be" => "24-bit PCM",
        "pcm_s32le" | "pcm_s32be" => "32-bit PCM",
        "pcm_f32le" | "pcm_f32be" => "32-bit float PCM",
        "pcm_f64le" | "pcm_f64be" => "64-bit float PCM",
        other => other,
    };
    name.to_owned()
}

/// Parses `00:00:05.02`.
fn seconds_from_clock(clock: &str) -> Option<f64> {
    clock.trim().split(':').try_fold(0.0, |seconds, part| Some(60.0 * seconds + part.parse::<f64>().ok()?))
}

/// The last line that is neither about a stream nor empty, where ffmpeg writes the reason of a failure.
fn complaint_from_messages(messages: &str) -> Option<String> {
    let last = messages.lines().map(str::trim).rfind(|line| !line.is_empty())?;
    // memory addresses in brackets are meaningless to people
    let text = match (last.starts_with('['), last.split_once("] ")) {
        (true, Some((_, text))) => text,
        _ => last,
    };
    Some(text.chars().take(200).collect())
}

/// One track as ffmpeg decodes it.
pub(crate) struct FfmpegFrames {
    child: Child,
    stdout: BufReader<ChildStdout>,
    messages: Option<JoinHandle<String>>,
    sample_rate_hz: u32,
    channel_count: u16,
    is_drained: bool,
    bytes: Vec<u8>,
}

/// Why ffmpeg decodes nothing where the system does not start it, and what to do.
pub(crate) fn not_started(error: &io::Error) -> String {
    format!("ffmpeg could not be started ({error}); install ffmpeg")
}

/// Reason for missing frames.
pub(crate) enum FfmpegError {
    NotFound(io::Error),
    Failed(String),
}

impl FfmpegFrames {
    pub(crate) fn spawn(program: &Path, file: &Path, audio_index: usize) -> Result<Self, FfmpegError> {
        let mut command = command(program, "error");
        command.arg("-i").arg(file_url(file)).args(["-map", &format!("0:a:{audio_index}"), "-vn", "-sn", "-dn"]);
        command.args(["-map_metadata", "-1", "-fflags", "+bitexact", "-c:a", "pcm_f32le", "-f", "wav", "pipe:1"]);
        let mut child = command.stdout(Stdio::piped()).spawn().map_err(FfmpegError::NotFound)?;
        // A thread reads the messages: a full pipe would block ffmpeg, and hovertone with it.
        let messages = child.stderr.take().map(|mut stderr| std::thread::spawn(move || read_messages(&mut stderr)));
        let Some(stdout) = child.stdout.take() else {
            return Err(FfmpegError::Failed("it gave no output".to_owned()));
        };
        let mut frames = Self {
            child,
            stdout: BufReader::with_capacity(128 * 1024, stdout),
            messages,
            sample_rate_hz: 0,
            channel_count: 0,
            is_drained: false,
            bytes: Vec::new(),
        };
        match wave::float_stream_header(&mut frames.stdout) {
            Ok(Some((sample_rate_hz, channel_count))) => {
                (frames.sample_rate_hz, frames.channel_count) = (sample_rate_hz, channel_count);
                Ok(frames)
            }
            header => {
                if header.is_ok() {
                    // ffmpeg would block on a full pipe that is no longer read
                    let _ = frames.child.kill();
                }
                let (_, message) = frames.finish();
                Err(FfmpegError::Failed(message.unwrap_or_else(|| "it gave no sound".to_owned())))
            }
        }
    }

    /// Waits for the end of the program; returns whether it succeeded, and its error message.
    fn finish(&mut self) -> (bool, Option<String>) {
        let is_good = self.child.wait().is_ok_and(|status| status.success());
        let messages = self.messages.take().and_then(|thread| thread.join().ok()).unwrap_or_default();
        (is_good, complaint_from_messages(&messages))
    }
}

impl Frames for FfmpegFrames {
    fn sample_rate_hz(&self) -> f64 {
        f64::from(self.sample_rate_hz)
    }

    fn channel_count(&self) -> usize {
        usize::from(self.channel_count)
    }

    fn next_frames(&mut self, out: &mut Vec<f32>, incidents: &mut Incidents) -> io::Result<bool> {
        out.clear();
        if self.is_drained {
            return Ok(false);
        }
        let wanted = BLOCK_FRAMES * self.channel_count() * size_of::<f32>();
        self.bytes.clear();
        self.stdout.by_ref().take(wanted as u64).read_to_end(&mut self.bytes)?;
        let samples = self.bytes.as_chunks::<4>().0;
        let whole = samples.len() / self.channel_count() * self.channel_count();
        out.extend(samples[..whole].iter().map(|bytes| f32::from_le_bytes(*bytes)));
        if self.bytes.len() < wanted {
            self.is_drained = true;
            let (is_good, message) = self.finish();
            incidents.is_cut_off |= !is_good || message.as_ref().is_some_and(|message| tells_of_cut_off(message));
            incidents.ffmpeg_message = message.or(incidents.ffmpeg_message.take());
        }
        Ok(!out.is_empty())
    }
}

fn tells_of_cut_off(message: &str) -> bool {
    let message = message.to_ascii_lowercase();
    ["partial file", "truncat", "end of file"].iter().any(|words| message.contains(words))
}

impl Drop for FfmpegFrames {
    fn drop(&mut self) {
        // an error means that the process has already ended
        let _ = self.child.kill();
        let _ = self.child.wait();
        if let Some(messages) = self.messages.take() {
            let _ = messages.join();
        }
    }
}

fn command(program: &Path, verbosity: &str) -> Command {
    let mut command = Command::new(program);
    // Playlists can name other files or addresses. So formats with references are refused, and only files and pipes can be opened.
    command.args(["-hide_banner", "-nostdin", "-nostats", "-v", verbosity, "-protocol_whitelist", "file,pipe"]);
    command.args(["-format_whitelist", FORMATS]);
    command.stdin(Stdio::null()).stderr(Stdio::piped());
    command
}

/// With `file:` in front, a name with a colon or a dash at its start is still a name.
fn file_url(file: &Path) -> OsString {
    let mut url = OsString::from("file:");
    url.push(file);
    url
}

fn read_messages(stderr: &mut impl Read) -> String {
    let mut kept = Vec::new();
    let mut buffer = [0; 4096];
    loop {
        match stderr.read(&mut buffer) {
            Ok(0) => break,
            Ok(count) => {
                let room = MESSAGE_BYTES_MAX - kept.len();
                kept.extend_from_slice(&buffer[..count.min(room)]);
            }
            Err(error) if error.kind() == io::ErrorKind::Interrupted => {}
            Err(_) => break,
        }
    }
    String::from_utf8_lossy(&kept).into_owned()
}
