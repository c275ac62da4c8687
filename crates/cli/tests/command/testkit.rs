//! Running the command, sound for it to hear, and where the real recordings are.

use hovertone_sim::prescribed::{HoverSettings, HoverSound, Noise, Recording, RotorSound, Sampling, seeded};
use hovertone_sim::scenario::ScenarioFile;
use hovertone_vehicle::{RotorSpeed, find_preset};
use serde_json::Value;
use std::f64::consts::TAU;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

/// What a run of the command left behind.
pub(crate) struct Run {
    pub(crate) code: i32,
    pub(crate) stdout: String,
    pub(crate) stderr: String,
}

impl Run {
    /// Every line of stdout as JSON.
    pub(crate) fn json_lines(&self) -> Vec<Value> {
        self.stdout.lines().map(|line| serde_json::from_str(line).unwrap()).collect()
    }

    /// Asserts how the run ended; on failure shows what it said.
    pub(crate) fn ends_with(self, code: i32) -> Self {
        assert_eq!(self.code, code, "stdout:\n{}\nstderr:\n{}", self.stdout, self.stderr);
        self
    }
}

/// Runs `hovertone` and waits.
pub(crate) fn hovertone(arguments: &[&str]) -> Run {
    hovertone_with(arguments, |command| command)
}

/// Runs `hovertone` in an environment of its own.
pub(crate) fn hovertone_with(arguments: &[&str], set_up: impl FnOnce(&mut Command) -> &mut Command) -> Run {
    let mut command = Command::new(env!("CARGO_BIN_EXE_hovertone"));
    let output = set_up(command.args(arguments)).output().unwrap();
    Run {
        code: output.status.code().unwrap_or(-1),
        stdout: String::from_utf8(output.stdout).unwrap(),
        stderr: String::from_utf8(output.stderr).unwrap(),
    }
}

/// A path as an argument.
pub(crate) fn text(path: &Path) -> &str {
    path.to_str().unwrap()
}

/// The sound of a preset's rotors, all at one steady speed.
pub(crate) fn steady_hover(preset: &str, speed: RotorSpeed, duration_s: f64) -> HoverSettings {
    let settings = HoverSettings::for_vehicle(find_preset(preset).unwrap(), speed);
    let rotors = vec![RotorSound::steady(speed); settings.rotors.len()];
    HoverSettings { duration_s, rotors, ..settings }
}

/// The same of one rotor alone, as on a bench.
pub(crate) fn steady_bench(preset: &str, speed: RotorSpeed, duration_s: f64) -> HoverSettings {
    let mut settings = steady_hover(preset, speed, duration_s);
    settings.rotors.truncate(1);
    settings
}

/// Flies a random hover into `folder/flown`; returns its scenario and its truth.
pub(crate) fn flown_hover(folder: &Path, seed: u64, duration_s: f64, spread_share: f64) -> (ScenarioFile, Value) {
    fs::create_dir_all(folder).unwrap();
    let file = ScenarioFile::random_hover(seed, duration_s, spread_share);
    let scenario = folder.join("scenario.toml");
    fs::write(&scenario, toml::to_string(&file).unwrap()).unwrap();
    let flown = folder.join("flown");
    hovertone(&["simulate", text(&scenario), "-o", text(&flown)]).ends_with(0);
    let truth = serde_json::from_str(&fs::read_to_string(flown.join("truth.json")).unwrap()).unwrap();
    (file, truth)
}

/// Renders a sound into a 16-bit WAV file.
pub(crate) fn write_hover(path: &Path, settings: HoverSettings) {
    let rate_hz = settings.sample_rate_hz;
    let (samples, _) = HoverSound::new(settings).unwrap().render_all();
    write_wav(path, &samples, rate_hz);
}

/// A steady hover of an AR.Drone in a folder, and a log of its four motors, which agrees at any offset of the clocks.
pub(crate) fn write_steady_hover_and_log(folder: &Path) -> (PathBuf, PathBuf) {
    let (sound, log) = (folder.join("hover.wav"), folder.join("log.csv"));
    write_hover(&sound, steady_hover("ardrone", RotorSpeed::from_rev_s(61.3), 6.0));
    let rows: String = (0..60).map(|row| format!("{:.1},3678,3678,3678,3678\n", 0.1 * f64::from(row))).collect();
    fs::write(&log, format!("time_s,rotor1_rpm,rotor2_rpm,rotor3_rpm,rotor4_rpm\n{rows}")).unwrap();
    (sound, log)
}

/// White noise of a standard deviation of 0.06, the same at every run.
pub(crate) fn write_noise(path: &Path, duration_s: f64) {
    let rate_hz = 44_100;
    let mut noise = Recording::of_rotors(&[], Sampling::new(f64::from(rate_hz), duration_s));
    noise.add_noise(&Noise::white(0.06), &mut seeded(1));
    write_wav(path, &noise.samples_f32(), rate_hz);
}

/// Four seconds of a sine of amplitude 0.4, with white noise of this standard deviation.
pub(crate) fn write_sine(path: &Path, rate_hz: u32, hz: f64, noise_std: f64) {
    let mut noise = Recording::of_rotors(&[], Sampling::new(f64::from(rate_hz), 4.0));
    if noise_std > 0.0 {
        noise.add_noise(&Noise::white(noise_std), &mut seeded(1));
    }
    let sine = (0u32..).map(|n| 0.4 * (TAU * hz * f64::from(n) / f64::from(rate_hz)).sin() as f32);
    let samples: Vec<f32> = noise.samples_f32().into_iter().zip(sine).map(|(noise, sine)| noise + sine).collect();
    write_wav(path, &samples, rate_hz);
}

/// Writes samples into a 16-bit WAV file.
pub(crate) fn write_wav(path: &Path, samples: &[f32], sample_rate: u32) {
    let spec =
        hound::WavSpec { channels: 1, sample_rate, bits_per_sample: 16, sample_format: hound::SampleFormat::Int };
    let mut writer = hound::WavWriter::create(path, spec).unwrap();
    for sample in samples {
        writer.write_sample((sample * 32_767.0).round() as i16).unwrap();
    }
    writer.finalize().unwrap();
}

/// Usage that is refused: exit code 2, nothing on standard output, a message with a hint and with these words.
pub(crate) fn refused_with(arguments: &[&str], words: &[&str]) {
    let run = hovertone(arguments).ends_with(2);
    assert!(run.stdout.is_empty() && run.stderr.contains("hint:"), "{}", run.stderr);
    words.iter().for_each(|word| assert!(run.stderr.contains(word), "{word:?}:\n{}", run.stderr));
}

/// The root of the repository.
pub(crate) fn repository() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..").canonicalize().unwrap()
}

/// A folder of the real recordings; where there is none, says so on a line that the run's summary counts.
pub(crate) fn recordings(folder: &str) -> Option<PathBuf> {
    let named = std::env::var_os("HOVERTONE_TEST_DATA").map(PathBuf::from);
    let root = named.unwrap_or_else(|| repository().join("../shared/data"));
    let path = root.join(folder);
    if path.is_dir() {
        return Some(path);
    }
    println!("skipped: no test recordings at {} (set HOVERTONE_TEST_DATA)", path.display());
    None
}

/// The files of a folder with an ending, in order of their names; at least one.
pub(crate) fn files_in(folder: &Path, ending: &str) -> Vec<PathBuf> {
    let entries = std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
    let mut files: Vec<PathBuf> = entries.filter(|path| text(path).ends_with(ending)).collect();
    files.sort();
    assert!(!files.is_empty(), "nothing ends in {ending} in {}", folder.display());
    files
}
