//! `cargo run --release -p hovertone-bench -- rotors`: four rotors from one microphone, against the truth of every instant. Writes
//! `docs/rotors.md`. Run by people, never in a test.

mod bobbing;
mod score;
mod sound;

use crate::accuracy::drawn;
use crate::rotors_report::{REPORT, labels_section};
use hovertone::sound::Signal;
use hovertone::speed::{Config, Method, Outcome, ToneConfig, TrackPoint, speed_from_source};
use hovertone_vehicle::Order;
use score::{Score, against_truth};
use sound::{Room, SAMPLE_RATE_HZ, Sound, rendered};
use std::path::Path;
use std::time::Instant;

const SEEDS: usize = 20;
const FIRST_SEED: u64 = 1000;

/// A kind of sound, and what is asked of it: shares of frames, and per cent.
struct Cell {
    name: &'static str,
    sound: Sound,
    wanted: Wanted,
}

#[derive(Clone, Copy)]
struct Wanted {
    set: Option<f64>,
    identity: Option<f64>,
    median_percent: f64,
    mean_square_percent: f64,
}

fn cells() -> Vec<Cell> {
    let sound = |spacing: f64, wander: f64| Sound {
        spacing_share: spacing,
        wander_std_share: wander,
        has_mesh: true,
        has_blade_pass: true,
        carrier_to_noise_db_hz: 42.0,
        duration_s: 20.0,
        room: None,
    };
    let cell = |name, wanted, sound| Cell { name, sound, wanted };
    let mesh = |sound| Sound { has_blade_pass: false, ..sound };
    let blades = |sound| Sound { has_mesh: false, ..sound };
    let room = |sound| Sound { room: Some(Room { t60_s: 0.4, coherence_s: 0.2 }), ..sound };
    let wanted = |set, identity, median_percent, mean_square_percent| Wanted {
        set: Some(set),
        identity: Some(identity),
        median_percent,
        mean_square_percent,
    };
    let first = wanted(0.99, 0.99, 0.006, 0.001);
    let second = wanted(0.98, 0.97, 0.008, 0.02);
    let third = wanted(0.95, 0.80, 0.015, 0.02);
    let fourth = Wanted { identity: None, ..wanted(0.94, 0.0, 0.025, 0.005) };
    let in_room = Wanted { set: None, identity: None, median_percent: 0.1, mean_square_percent: 0.1 };
    vec![
        cell("2 % apart, wander 0.05 %", first, sound(0.02, 0.0005)),
        cell("2 % apart, wander 0.2 %", second, sound(0.02, 0.002)),
        cell("1 % apart, wander 0.2 %", second, sound(0.01, 0.002)),
        cell("0.3 % apart, wander 0.2 %", third, sound(0.003, 0.002)),
        cell("0.1 % apart, wander 0.05 %, gear mesh alone", fourth, mesh(sound(0.001, 0.0005))),
        cell("1 % apart, wander 0.2 %, gear mesh alone", second, mesh(sound(0.01, 0.002))),
        cell("1 % apart, wander 0.2 %, blade pass alone", second, blades(sound(0.01, 0.002))),
        cell("2 % apart, wander 0.2 %, blade pass alone", second, blades(sound(0.02, 0.002))),
        cell("spread of 5 %, wander 0.05 %", first, sound(0.05 / 3.0, 0.0005)),
        cell("spread of 10 %, wander 0.05 %", first, sound(0.1 / 3.0, 0.0005)),
        cell("spread of 20 %, wander 0.05 %", first, sound(0.2 / 3.0, 0.0005)),
        cell("1 % apart, wander 0.2 %, room", in_room, room(sound(0.01, 0.002))),
        cell("2 % apart, wander 0.2 %, room", in_room, room(sound(0.02, 0.002))),
    ]
}

/// What is known of one clip.
struct Clip {
    seed: u64,
    score: Option<Score>,
    times_real_time: f64,
}

pub(crate) fn run(root: &Path, options: &[&str]) -> Result<(), String> {
    let option = |name: &str| options.iter().position(|option| *option == name).and_then(|at| options.get(at + 1));
    let seeds = option("--seeds").map_or(Ok(SEEDS), |text| text.parse::<usize>()).map_err(|error| error.to_string())?;
    let only = option("--only").copied();
    let mut rows = String::new();
    for cell in cells().iter().filter(|cell| only.is_none_or(|only| cell.name.contains(only))) {
        let clips = drawn(seeds, |seed| clip(cell, FIRST_SEED + seed as u64))?;
        let row = row_of(cell, &clips);
        print!("{row}");
        if only.is_some() {
            clips.iter().for_each(|clip| println!("  {}", words_of(clip)));
        }
        rows += &row;
    }
    let bobbing = if only.is_none_or(|only| only == "bobbing") { bobbing::section(seeds)? } else { String::new() };
    if only.is_none() {
        // another bench's section stays
        let before = std::fs::read_to_string(root.join(REPORT)).unwrap_or_default();
        let text = HEAD.replace("{seeds}", &seeds.to_string()) + &rows + &bobbing + "\n" + labels_section(&before);
        std::fs::write(root.join(REPORT), text).map_err(|error| format!("{REPORT}: {error}"))?;
        println!("written: {REPORT}");
    }
    Ok(())
}

const HEAD: &str = "\
# Four rotors from one microphone

Made by `cargo run --release -p hovertone-bench -- rotors`. Each cell: {seeds} clips of 20 s at 48 kHz with four rotors around 60.17 rev/s, heard by the
recommended settings with nothing but the gear (8:69), the blades (2) and the number of rotors given. The sound is that of the
bench's own generator, which shares no code with the core: blade pass to the 20th line, gear mesh 69, 138 and 207 with sidebands,
levels that differ by 3 dB, lines that swell by 10 %, a common wander of 0.3 % and each rotor's own (0.6 s), noise falling by
3 dB per octave, 42 dB Hz at the gear mesh. In the room: echoes as strong as the sound (T60 0.4 s), and lines that lose their phase
within 0.2 s.

- answered: clips with four separated rotors, of all.
- set: share of frames (every 0.05 s) in which all four are within 0.4 of the spacing, or 0.05 rev/s.
- identity: share of rotors and frames that are right under one labelling for the whole clip.
- median: of the error of one rotor in one frame. mean square: rms over clips of the error of ⟨ω²⟩, which is what carries the
  weight. worst: the largest of these. within 2 u: share of rotors and frames within twice the stated uncertainty of a point.
- times real time: each clip on one core, two at once.
- in brackets: the aim.

| sound | answered | set | identity | median, % | mean square, % | worst, % | within 2 u | times real time |
|---|---|---|---|---|---|---|---|---|
";

fn row_of(cell: &Cell, clips: &[Clip]) -> String {
    let scores: Vec<&Score> = clips.iter().filter_map(|clip| clip.score.as_ref()).collect();
    let count = scores.len().max(1) as f64;
    let mean = |of: &dyn Fn(&Score) -> f64| scores.iter().map(|score| of(score)).sum::<f64>() / count;
    let mut errors: Vec<f64> = scores.iter().flat_map(|score| score.errors.iter().copied()).collect();
    errors.sort_by(f64::total_cmp);
    let median = 100.0 * errors.get(errors.len() / 2).copied().unwrap_or(f64::NAN);
    let rms = 100.0 * mean(&|score| score.mean_square_error.powi(2)).sqrt();
    let worst = 100.0 * scores.iter().map(|score| score.mean_square_error.abs()).fold(0.0, f64::max);
    let speed = clips.iter().map(|clip| clip.times_real_time).sum::<f64>() / clips.len().max(1) as f64;
    let share = |wanted: Option<f64>| wanted.map_or_else(String::new, |wanted| format!(" (≥ {wanted})"));
    format!(
        "| {} | {} of {} | {:.3}{} | {:.3}{} | {:.4} (≤ {}) | {:.4} (≤ {}) | {:.4} | {:.2} | {:.0} |\n",
        cell.name,
        scores.len(),
        clips.len(),
        mean(&|score| score.set),
        share(cell.wanted.set),
        mean(&|score| score.identity),
        share(cell.wanted.identity),
        median,
        cell.wanted.median_percent,
        rms,
        cell.wanted.mean_square_percent,
        worst,
        mean(&|score| score.covered),
        speed,
    )
}

fn words_of(clip: &Clip) -> String {
    match &clip.score {
        None => format!("seed {}: not all separated", clip.seed),
        Some(score) => format!(
            "seed {}: set {:.3}, identity {:.3}, mean square {:+.4} %",
            clip.seed,
            score.set,
            score.identity,
            100.0 * score.mean_square_error
        ),
    }
}

fn clip(cell: &Cell, seed: u64) -> Result<Clip, String> {
    let rendered = rendered(&cell.sound, seed);
    let order = Order::new(if cell.sound.has_mesh { 69.0 } else { 2.0 }).map_err(|error| error.to_string())?;
    let mut tone = ToneConfig::of_order(order);
    tone.blades = cell.sound.has_blade_pass.then_some(2);
    let mut config = Config::for_tone(tone);
    config.rotors.count = 4;
    config.method = Method::Separated;
    let mut signal = Signal::new(rendered.samples.clone(), SAMPLE_RATE_HZ);
    let started = Instant::now();
    let analysis = speed_from_source(&mut signal, &config, &mut |_| {}).map_err(|error| error.to_string())?;
    let times_real_time = cell.sound.duration_s / started.elapsed().as_secs_f64();
    let score = match &analysis.outcome {
        Outcome::Ok(tone) if tone.rotors.len() == 4 => {
            let tracks: Vec<&[TrackPoint]> = tone.rotors.iter().map(|rotor| rotor.track.as_slice()).collect();
            Some(against_truth(&tracks, &rendered, cell.sound.duration_s, cell.sound.spacing_share))
        }
        _ => None,
    };
    Ok(Clip { seed, score, times_real_time })
}
