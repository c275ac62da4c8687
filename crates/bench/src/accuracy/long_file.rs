//! What half an hour of sound costs, beside the leanest of the peers.

use crate::cost::{Cost, REPEATS, fastest};
use crate::document::Document;
use crate::speed::rendered_wav;
use crate::workspace::cargo;
use crate::workspace::target;
use std::path::Path;
use std::process::{Command, Stdio};

pub(super) fn add_long_file(document: &mut Document, root: &Path, minutes: u32) -> Result<(), String> {
    document.heading("A long file");
    cargo(root, &["build", "--release", "--locked", "-p", "hovertone-cli"])?;
    let wav = rendered_wav(root, minutes)?;
    let quiet = |command: &mut Command| {
        command.arg(&wav).stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::null()).spawn()
    };
    let arguments = ["speed", "--gear", "8:69", "--blades", "2", "--json", "--no-progress"];
    let hovertone = fastest(|| quiet(Command::new(target(root).join("release/hovertone")).args(arguments)))?;
    // as the peers' `cli.sh` has it
    let arguments = ["-p", "yinfft", "-B", "8192", "-H", "2400", "-u", "Hz", "-l", "0.99", "-i"];
    let aubio = fastest(|| quiet(Command::new("aubiopitch").args(arguments)));
    document.paragraph(&format!(
        "{minutes} minutes of four rotors, 48 kHz mono, 16-bit WAV; fastest of {REPEATS} runs. Processor time is that of all \
         threads, user and system. hovertone: `speed --gear 8:69 --blades 2 --json`, which hashes the file and reads it \
         twice. aubio: `aubiopitch -p yinfft -B 8192 -H 2400`, which reads it once."
    ));
    let mut rows = vec![row("hovertone", &hovertone, &hovertone)];
    match &aubio {
        Ok(aubio) => rows.push(row("aubio yinfft", aubio, &hovertone)),
        Err(reason) => document.paragraph(&format!("aubio is left out: {reason}.")),
    }
    let heads = ["", "processor s", "over hovertone's", "peak MiB", "over hovertone's"];
    document.table(&heads, &rows);
    Ok(())
}

fn row(name: &str, cost: &Cost, reference: &Cost) -> Vec<String> {
    let over = |value: Option<f64>| value.map_or("–".to_owned(), |value| format!("{value:.2}"));
    let ratio = cost.cpu_s.zip(reference.cpu_s).map(|(cost_s, reference_s)| cost_s / reference_s);
    vec![
        name.to_owned(),
        over(cost.cpu_s),
        over(ratio),
        format!("{:.1}", cost.peak_mib),
        over((reference.peak_mib > 0.0).then(|| cost.peak_mib / reference.peak_mib)),
    ]
}
