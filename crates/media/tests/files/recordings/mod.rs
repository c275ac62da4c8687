//! The real recordings that the tests hear, where this machine has them, and what the tests measure on them.

use std::path::{Path, PathBuf};

use hovertone_media::{FfmpegUse, OpenOptions, Recording};
use hovertone_signal::SignalSource;

/// A folder of the shared test data; says so where there is none.
pub(crate) fn test_data(folder: &str) -> Option<PathBuf> {
    let root = std::env::var_os("HOVERTONE_TEST_DATA")
        .map_or_else(|| Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/data"), PathBuf::from);
    let folder_path = root.join(folder);
    if folder_path.is_dir() {
        return Some(folder_path);
    }
    eprintln!("skipped: no test recordings at {} (set HOVERTONE_TEST_DATA)", folder_path.display());
    None
}

/// Hears with this crate's own decoders only.
pub(crate) fn native_only() -> OpenOptions {
    OpenOptions { ffmpeg: FfmpegUse::Never, ..OpenOptions::default() }
}

/// All of a recording from where it stands.
pub(crate) fn samples(recording: &mut Recording) -> Vec<f32> {
    let mut all = Vec::new();
    while let Some(block) = recording.next_block().unwrap() {
        assert!(!block.is_empty(), "a block is never empty");
        assert!(block.iter().all(|sample| sample.is_finite()), "every sample is finite");
        all.extend_from_slice(block);
    }
    all
}

/// The files of a folder, in order.
pub(crate) fn files_of(folder: &Path) -> Vec<PathBuf> {
    let mut files: Vec<_> = std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()).collect();
    files.sort();
    files
}

pub(crate) fn name_of(path: &Path) -> &str {
    path.file_name().unwrap().to_str().unwrap()
}

/// Less than a second of sound, from half a second on, holds enough to tell a shift.
const WINDOW_S: (f64, f64) = (0.5, 1.2);

/// Lag in frames of `sound` at which it is most like `reference`, and the correlation there. Positive: `sound` is late.
/// The reference is interpolated where the rates differ: its strong lines are far below both of their limits.
pub(crate) fn lag_against(reference: (&[f32], f64), sound: (&[f32], f64), lag_max: i64) -> (i64, f64) {
    let from = (WINDOW_S.0 * sound.1) as i64;
    let to = (WINDOW_S.1 * sound.1) as i64;
    let expected: Vec<f64> = (from..to)
        .map(|frame| {
            let at = frame as f64 / sound.1 * reference.1;
            let (whole, part) = (at.floor() as usize, at.fract());
            let value = |index: usize| reference.0.get(index).copied().map_or(0.0, f64::from);
            value(whole) * (1.0 - part) + value(whole + 1) * part
        })
        .collect();
    let correlation = |lag: i64| {
        let heard: Vec<f64> = (from..to)
            .map(|frame| {
                usize::try_from(frame + lag).ok().and_then(|at| sound.0.get(at)).copied().map_or(0.0, f64::from)
            })
            .collect();
        let mean = |values: &[f64]| values.iter().sum::<f64>() / values.len() as f64;
        let (mean_a, mean_b) = (mean(&expected), mean(&heard));
        let sums = expected.iter().zip(&heard).fold((0.0, 0.0, 0.0), |(ab, aa, bb), (a, b)| {
            let (a, b) = (a - mean_a, b - mean_b);
            (ab + a * b, aa + a * a, bb + b * b)
        });
        sums.0 / (sums.1 * sums.2).sqrt().max(f64::MIN_POSITIVE)
    };
    (-lag_max..=lag_max).map(|lag| (lag, correlation(lag))).max_by(|a, b| a.1.total_cmp(&b.1)).unwrap()
}

/// A RIFF/WAVE file of a format code, bits and raw samples.
pub(crate) fn wav_bytes(code: u16, channels: u16, rate_hz: u32, bits: u16, data: &[u8]) -> Vec<u8> {
    let block = channels * bits / 8;
    let mut wav = Vec::new();
    wav.extend_from_slice(b"RIFF");
    wav.extend_from_slice(&(36 + data.len() as u32).to_le_bytes());
    wav.extend_from_slice(b"WAVEfmt \x10\0\0\0");
    wav.extend_from_slice(&code.to_le_bytes());
    wav.extend_from_slice(&channels.to_le_bytes());
    wav.extend_from_slice(&rate_hz.to_le_bytes());
    wav.extend_from_slice(&(rate_hz * u32::from(block)).to_le_bytes());
    wav.extend_from_slice(&block.to_le_bytes());
    wav.extend_from_slice(&bits.to_le_bytes());
    wav.extend_from_slice(b"data");
    wav.extend_from_slice(&(data.len() as u32).to_le_bytes());
    wav.extend_from_slice(data);
    wav
}

/// A file in a folder of its own, which is removed with it.
pub(crate) struct TempFile {
    _folder: tempfile::TempDir,
    pub(crate) path: PathBuf,
}

pub(crate) fn temp_file(name: &str, content: &[u8]) -> TempFile {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join(name);
    std::fs::write(&path, content).unwrap();
    TempFile { _folder: folder, path }
}
