//! How fast and how small: decoding alone and the whole `hovertone speed` on long files of each container, as ratios to
//! real time and to decoding alone, with peak memory. Run by people, never in a test.

use crate::cost::{REPEATS, fastest};
use crate::options::whole_number;
use crate::workspace::cargo;
use crate::workspace::target;
use hovertone::sound::SignalSource;
use hovertone_media::{OpenOptions, Recording};
use hovertone_sim::paper::LOADS;
use hovertone_sim::prescribed::{HoverSettings, HoverSound, PaperSimulation};
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

/// Name of the task that a measured child runs: decode a file and do nothing with it.
pub(crate) const DECODE_TASK: &str = "bench-decode";

/// Length of a recording, unless `--minutes` says otherwise.
pub(crate) const MINUTES: u32 = 30;

/// Containers and how an `ffmpeg` makes them of the WAV. `VIDEO` stands for a small picture track.
const CONTAINERS: [(&str, &[&str]); 15] = [
    ("pcm24.wav", &["-c:a", "pcm_s24le"]),
    ("adpcm.wav", &["-c:a", "adpcm_ima_wav"]),
    ("flac.flac", &[]),
    ("mp3.mp3", &["-b:a", "192k"]),
    ("aac.m4a", &["-c:a", "aac", "-b:a", "128k"]),
    ("video_aac.mp4", &["VIDEO", "-c:a", "aac", "-b:a", "128k"]),
    ("alac.m4a", &["-c:a", "alac"]),
    ("vorbis.ogg", &["-c:a", "libvorbis"]),
    ("opus.opus", &["-c:a", "libopus", "-b:a", "96k"]),
    ("opus.webm", &["-c:a", "libopus", "-b:a", "96k"]),
    ("video_opus.mkv", &["VIDEO", "-c:a", "libopus", "-b:a", "96k"]),
    ("pcm16.aiff", &["-c:a", "pcm_s16be"]),
    ("pcm16.caf", &["-c:a", "pcm_s16le"]),
    ("video_pcm16.mov", &["VIDEO", "-c:a", "pcm_s16le"]),
    ("video_pcm24be.mov", &["VIDEO", "-c:a", "pcm_s24be"]),
];

pub(crate) fn run(root: &Path, options: &[&str]) -> Result<(), String> {
    let minutes = match options {
        [] => MINUTES,
        ["--minutes", minutes] => whole_number("--minutes", minutes)?,
        _ => return Err("cargo run --release -p hovertone-bench -- speed [--minutes N]".to_owned()),
    };
    cargo(root, &["build", "--release", "--locked", "-p", "hovertone-cli", "-p", "hovertone-bench"])?;
    let programs = target(root).join("release");
    let wav = rendered_wav(root, minutes)?;
    let mut files: Vec<PathBuf> =
        CONTAINERS.iter().filter_map(|(name, arguments)| encoded(&wav, name, arguments)).collect();
    files.insert(0, wav);
    println!("\n{minutes} minutes of four rotors, 48 kHz mono; x: times real time; fastest of {REPEATS} runs\n");
    println!("| file | decode x | decode MiB | speed x | speed MiB | speed / decode |");
    println!("|---|---|---|---|---|---|");
    let seconds = f64::from(minutes) * 60.0;
    for file in &files {
        let decode = fastest(|| Command::new(programs.join("hovertone-bench")).arg(DECODE_TASK).arg(file).spawn())?;
        let speed = fastest(|| {
            Command::new(programs.join("hovertone"))
                .args(["speed", "--gear", "8:69", "--blades", "2", "--json", "--no-progress"])
                .arg(file)
                .stdout(Stdio::null())
                .stderr(Stdio::null())
                .spawn()
        })?;
        println!(
            "| {} | {:.0} | {:.1} | {:.0} | {:.1} | {:.1} |",
            file.file_name().unwrap_or_default().to_string_lossy(),
            seconds / decode.wall_s,
            decode.peak_mib,
            seconds / speed.wall_s,
            speed.peak_mib,
            speed.wall_s / decode.wall_s,
        );
    }
    Ok(())
}

/// The child's job: decodes a file to its end.
pub(crate) fn decode(file: &Path) -> Result<(), String> {
    let mut recording = Recording::open(file, &OpenOptions::default()).map_err(|error| error.to_string())?;
    let mut samples = 0usize;
    while let Some(block) = recording.next_block().map_err(|error| error.to_string())? {
        samples += block.len();
    }
    if samples == 0 { Err("nothing was decoded".to_owned()) } else { Ok(()) }
}

/// The recording that all others are made of; kept between runs.
pub(crate) fn rendered_wav(root: &Path, minutes: u32) -> Result<PathBuf, String> {
    let folder = target(root).join("bench").join(format!("{minutes}min"));
    fs::create_dir_all(&folder).map_err(|error| format!("{}: {error}", folder.display()))?;
    let path = folder.join("pcm16.wav");
    if path.exists() {
        return Ok(path);
    }
    println!("rendering {}", path.display());
    let paper = PaperSimulation { seed: 1, sample_rate_hz: 48_000, rotor_spacing_share: 0.0 };
    let settings = HoverSettings { duration_s: f64::from(minutes) * 60.0, ..paper.trial(&LOADS[0], 0) };
    let sample_rate = settings.sample_rate_hz;
    let mut sound = HoverSound::new(settings).map_err(|error| error.to_string())?;
    let spec =
        hound::WavSpec { channels: 1, sample_rate, bits_per_sample: 16, sample_format: hound::SampleFormat::Int };
    let unfinished = folder.join("unfinished.wav");
    let mut writer = hound::WavWriter::create(&unfinished, spec).map_err(|error| error.to_string())?;
    let (mut block, mut truth) = (vec![0.0f32; 65536], Vec::new());
    loop {
        let count = sound.render(&mut block, &mut truth);
        if count == 0 {
            break;
        }
        truth.clear();
        for sample in &block[..count] {
            let level = (f64::from(*sample) * 32767.0).round() as i16;
            writer.write_sample(level).map_err(|error| error.to_string())?;
        }
    }
    writer.finalize().map_err(|error| error.to_string())?;
    fs::rename(&unfinished, &path).map_err(|error| error.to_string())?;
    Ok(path)
}

/// The same sound in another container; `None`, said, where no `ffmpeg` can make it.
fn encoded(wav: &Path, name: &str, arguments: &[&str]) -> Option<PathBuf> {
    let path = wav.with_file_name(name);
    if path.exists() {
        return Some(path);
    }
    let unfinished = wav.with_file_name(format!("unfinished_{name}"));
    let has_video = arguments.contains(&"VIDEO");
    let mut command = Command::new("ffmpeg");
    command.args(["-nostdin", "-v", "error", "-y", "-i"]).arg(wav);
    if has_video {
        let picture = "color=c=gray:s=320x240:r=5";
        command.args(["-f", "lavfi", "-i", picture, "-map", "0:a", "-map", "1:v", "-c:v", "mpeg4", "-shortest"]);
    }
    command.args(arguments.iter().filter(|argument| **argument != "VIDEO")).arg(&unfinished);
    println!("encoding {name}");
    match command.status() {
        Ok(status) if status.success() && fs::rename(&unfinished, &path).is_ok() => Some(path),
        _ => {
            println!("{name} is left out: no ffmpeg here that makes it");
            None
        }
    }
}
