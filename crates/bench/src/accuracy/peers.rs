//! The programs that others use, on the same recordings.

use super::track::{TrackFrame, frames_from_csv};
use super::workbench::Workbench;
use crate::workspace::output_of;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

/// What the peers' scripts divide a band-passed tone's frequency by (they take it for the blade pass), over what it is.
const BLADES_FOR_GEAR: f64 = 2.0 / 69.0;

/// Which script runs it.
#[derive(Clone, Copy, PartialEq)]
enum Kind {
    Python,
    Shell,
    JavaScript,
}

/// A program, or one setting of it.
pub(super) struct Peer {
    pub(super) name: &'static str,
    kind: Kind,
    /// Its name for the script.
    tool: &'static str,
    /// Hears the recording band-passed around the gear tone, for want of a search range of its own.
    band_passed: bool,
    /// Always says this many rotors.
    pub(super) rotor_count: Option<usize>,
}

const fn peer(name: &'static str, kind: Kind, tool: &'static str) -> Peer {
    Peer { name, kind, tool, band_passed: false, rotor_count: None }
}

pub(super) const PEERS: [Peer; 13] = [
    Peer { band_passed: true, ..peer("pitchy, band-passed", Kind::JavaScript, "pitchy") },
    Peer { band_passed: true, ..peer("aubio yinfft, band-passed", Kind::Shell, "aubio_yinfft") },
    Peer { band_passed: true, ..peer("aubio yin, band-passed", Kind::Shell, "aubio_yin") },
    peer("ssqueezepy, 1 ridge", Kind::Python, "ssq_ridges_1"),
    Peer { rotor_count: Some(4), ..peer("ssqueezepy, 4 ridges", Kind::Python, "ssq_ridges_4") },
    peer("scipy maximum, gear", Kind::Python, "scipy_max_gear"),
    peer("scipy maximum, blade pass", Kind::Python, "scipy_max_bpf"),
    peer("ROTA, all orders", Kind::Python, "rota_all"),
    peer("ROTA, gear", Kind::Python, "rota_gear"),
    peer("librosa piptrack, gear", Kind::Python, "librosa_piptrack_gear"),
    peer("Essentia Klapuri, blade pass", Kind::Python, "essentia_klapuri_bpf"),
    peer("SwiftF0, blade pass", Kind::Python, "swiftf0_bpf"),
    peer("Praat ac, blade pass", Kind::Python, "praat_ac_bpf"),
];

impl Peer {
    /// Its track of a recording; why not, where it cannot be had.
    pub(super) fn track(&self, workbench: &Workbench, wav: &Path) -> Result<Vec<TrackFrame>, String> {
        let heard = if self.band_passed { band_passed(wav) } else { wav.to_owned() };
        let out = wav.with_extension(format!("{}.csv", self.tool));
        if out.exists() {
            fs::remove_file(&out).map_err(|error| format!("{}: {error}", out.display()))?;
        }
        let mut command = match self.kind {
            Kind::Python => workbench.python(),
            Kind::Shell => Command::new("bash"),
            Kind::JavaScript => workbench.node()?,
        };
        let script = match self.kind {
            Kind::Python => "peer_py.py",
            Kind::Shell => "cli.sh",
            Kind::JavaScript => "peer_js.mjs",
        };
        output_of(command.arg(workbench.script(script)).arg(self.tool).arg(&heard).arg(&out))?;
        let text = fs::read_to_string(&out).map_err(|error| format!("{}: {error}", out.display()))?;
        let frames = frames_from_csv(&text, if self.band_passed { BLADES_FOR_GEAR } else { 1.0 });
        if frames.is_empty() { Err("not a single frame came back".to_owned()) } else { Ok(frames) }
    }
}

/// Makes the band-passed recording that some peers hear.
pub(super) fn make_band_passed(workbench: &Workbench, wav: &Path) -> Result<(), String> {
    output_of(workbench.python().arg(workbench.script("prefilter.py")).arg(wav).arg(band_passed(wav)).arg("bp"))
        .map(|_| ())
}

fn band_passed(wav: &Path) -> PathBuf {
    wav.with_extension("band_passed.wav")
}
