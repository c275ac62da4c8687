//! `cargo xtask bench rotors`: four rotors from one microphone, against the truth of every instant.

mod sound;

use crate::accuracy::drawn;
use hovertone::{Config, Method, Outcome, Signal, ToneConfig, TrackPoint, speed_from_source};
use hovertone_vehicle::Order;
use sound::{MEAN_REV_S, Rendered, Room, SAMPLE_RATE_HZ, Sound, rendered};
use std::path::Path;
use std::time::Instant;

/// Frames at which tracks are compared with the truth, and those left out at either end.
const FRAME_S: f64 = 0.05;
const EDGE_S: f64 = 0.3;
/// A track says nothing this far from its nearest point.
const GAP_S: f64 = 0.08;

struct Cell {
    name: &'static str,
    sound: Sound,
    wanted: &'static str,
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
    let room = Some(Room { t60_s: 0.4, coherence_s: 0.2 });
    let second = "0.98  0.97  0.008  0.02";
    let first = "0.99  0.99  0.006  0.001";
    vec![
        cell("2 %, wander 0.05 %", first, sound(0.02, 0.0005)),
        cell("2 %, wander 0.2 %", second, sound(0.02, 0.002)),
        cell("1 %, wander 0.2 %", second, sound(0.01, 0.002)),
        cell("0.3 %, wander 0.2 %", "0.95  0.80  0.015  0.02", sound(0.003, 0.002)),
        cell("0.1 %, wander 0.05 %, mesh", "0.94  said  0.025  0.005", mesh(sound(0.001, 0.0005))),
        cell("2 %, wander 0.05 %, mesh", first, mesh(sound(0.02, 0.0005))),
        cell("1 %, wander 0.2 %, mesh", second, mesh(sound(0.01, 0.002))),
        cell("0.3 %, wander 0.2 %, mesh", "0.95  0.80  0.015  0.02", mesh(sound(0.003, 0.002))),
        cell("1 %, wander 0.2 %, blades", second, blades(sound(0.01, 0.002))),
        cell("2 %, wander 0.2 %, blades", second, blades(sound(0.02, 0.002))),
        cell("spread 5 %, wander 0.05 %", first, sound(0.05 / 3.0, 0.0005)),
        cell("spread 10 %, wander 0.05 %", first, sound(0.1 / 3.0, 0.0005)),
        cell("spread 20 %, wander 0.05 %", first, sound(0.2 / 3.0, 0.0005)),
        cell("1 %, wander 0.2 %, room", "-  -  0.1  0.1", Sound { room, ..sound(0.01, 0.002) }),
        cell("2 %, wander 0.2 %, room", "-  -  0.1  0.1", Sound { room, ..sound(0.02, 0.002) }),
    ]
}

/// How one clip was heard.
struct Score {
    resolved: f64,
    set: f64,
    identity: f64,
    errors: Vec<f64>,
    mean_square_error: f64,
    times_real_time: f64,
    covered: f64,
}

pub(crate) fn run(_root: &Path, options: &[&str]) -> Result<(), String> {
    let option = |name: &str| options.iter().position(|option| *option == name).and_then(|at| options.get(at + 1));
    let seeds = option("--seeds").map_or(Ok(20), |text| text.parse::<usize>()).map_err(|error| error.to_string())?;
    let only = option("--only").copied();
    println!(
        "cell                          heard  set  identity  median %  mean square %  worst %  covered  x real time | wanted: set identity median mean square"
    );
    for cell in cells().iter().filter(|cell| only.is_none_or(|only| cell.name.contains(only))) {
        let scores = drawn(seeds, |seed| Ok(score(cell, 1000 + seed as u64)))?;
        let heard: Vec<&Score> = scores.iter().flatten().collect();
        let mean =
            |of: &dyn Fn(&Score) -> f64| heard.iter().map(|score| of(score)).sum::<f64>() / heard.len().max(1) as f64;
        let mut errors: Vec<f64> = heard.iter().flat_map(|score| score.errors.iter().copied()).collect();
        errors.sort_by(f64::total_cmp);
        let rms = mean(&|score| score.mean_square_error.powi(2)).sqrt();
        let worst = heard.iter().map(|score| score.mean_square_error.abs()).fold(0.0, f64::max);
        println!(
            "{:<29} {:>2}/{} {:.2} {:>5.3} {:>6.3} {:>9.4} {:>12.4} {:>9.4} {:>7.2} {:>8.0} | {}",
            cell.name,
            heard.len(),
            seeds,
            mean(&|score| score.resolved),
            mean(&|score| score.set),
            mean(&|score| score.identity),
            100.0 * errors.get(errors.len() / 2).copied().unwrap_or(f64::NAN),
            100.0 * rms,
            100.0 * worst,
            mean(&|score| score.covered),
            mean(&|score| score.times_real_time),
            cell.wanted
        );
        if option("--each").is_some() {
            for (seed, score) in scores.iter().enumerate() {
                if let Some(score) = score {
                    println!(
                        "    {:>4} heard {} set {:.3} identity {:.3} mean square {:.4}",
                        1000 + seed,
                        score.resolved,
                        score.set,
                        score.identity,
                        100.0 * score.mean_square_error
                    );
                }
            }
        }
    }
    Ok(())
}

fn score(cell: &Cell, seed: u64) -> Option<Score> {
    let rendered = rendered(&cell.sound, seed);
    let order = Order::new(if cell.sound.has_mesh { 69.0 } else { 2.0 }).ok()?;
    let mut tone = ToneConfig::of_order(order);
    tone.blades = cell.sound.has_blade_pass.then_some(2);
    let mut config = Config::for_tone(tone);
    config.rotors.count = 4;
    config.method = Method::Separated;
    let started = Instant::now();
    let mut signal = Signal::new(rendered.samples.clone(), SAMPLE_RATE_HZ);
    let analysis = speed_from_source(&mut signal, &config, &mut |_| {}).ok()?;
    let took_s = started.elapsed().as_secs_f64();
    let Outcome::Ok(tone) = &analysis.outcome else {
        eprintln!("{seed}: {:?}", analysis.outcome);
        return None;
    };
    eprintln!("{seed} harmonic {:?}", tone.speeds.iter().map(|s| s.speed.rev_s()).collect::<Vec<_>>());
    if tone.rotors.is_empty() {
        return None;
    }
    let span = (EDGE_S, cell.sound.duration_s - EDGE_S);
    let tracks: Vec<&[TrackPoint]> = tone.rotors.iter().map(|rotor| rotor.track.as_slice()).collect();
    let mut score = against_truth(&tracks, &rendered, span, cell.sound.spacing_share);
    score.times_real_time = cell.sound.duration_s / took_s;
    score.resolved = tone.rotors.len() as f64;
    Some(score)
}

fn against_truth(
    tracks: &[&[TrackPoint]],
    rendered: &Rendered,
    (from_s, to_s): (f64, f64),
    spacing_share: f64,
) -> Score {
    let tolerance = (0.4 * spacing_share * MEAN_REV_S).max(0.05);
    let frames: Vec<f64> =
        (0..).map(|frame| from_s + FRAME_S * f64::from(frame)).take_while(|time| *time < to_s).collect();
    let labellings = permutations(4);
    let (mut right, mut errors, mut covered, mut counted) = (0usize, Vec::new(), 0usize, 0usize);
    let mut identities = vec![0usize; labellings.len()];
    for time_s in &frames {
        let truth = rendered.speeds_at(*time_s);
        let said: Vec<Option<(f64, f64)>> =
            (0..4).map(|rotor| at(tracks.get(rotor).copied().unwrap_or_default(), *time_s)).collect();
        let off =
            |rotor: usize, real: usize| said[rotor].map_or(f64::INFINITY, |(speed, _)| (speed - truth[real]).abs());
        let cost = |labelling: &[usize]| (0..4).map(|rotor| off(rotor, labelling[rotor]).min(1.0)).sum::<f64>();
        let best = labellings.iter().min_by(|a, b| cost(a).total_cmp(&cost(b))).cloned().unwrap_or_default();
        if std::env::var("HT_FR").is_ok() {
            let e: Vec<String> = (0..4)
                .map(|r| said[r].map_or("   -  ".into(), |(v, u)| format!("{:+.3}({:.3})", v - truth[best[r]], u)))
                .collect();
            let mut t = truth.clone();
            t.sort_by(f64::total_cmp);
            eprintln!(
                "{time_s:.2} {} | {}",
                e.join(" "),
                t.windows(2).map(|w| format!("{:.3}", w[1] - w[0])).collect::<Vec<_>>().join(" ")
            );
        }
        right += usize::from((0..4).all(|rotor| off(rotor, best[rotor]) < tolerance));
        for (rotor, &real) in best.iter().enumerate() {
            if let Some((_, std)) = said[rotor] {
                let error = off(rotor, real);
                errors.push(error / MEAN_REV_S);
                covered += usize::from(error <= 2.0 * std);
                counted += 1;
            }
        }
        for (labelling, count) in labellings.iter().zip(&mut identities) {
            *count += (0..4).filter(|&rotor| off(rotor, labelling[rotor]) < tolerance).count();
        }
    }
    // the mean square of the tracks over the same instants
    let (mut squares, mut points) = (0.0, 0usize);
    for time_s in (0..).map(|step| from_s + 0.01 * f64::from(step)).take_while(|time| *time < to_s) {
        for track in tracks {
            if let Some((speed, _)) = at(track, time_s) {
                squares += speed * speed;
                points += 1;
            }
        }
    }
    Score {
        resolved: 0.0,
        set: right as f64 / frames.len() as f64,
        identity: identities.iter().copied().max().unwrap_or(0) as f64 / (4 * frames.len()) as f64,
        errors,
        mean_square_error: squares / points.max(1) as f64 / rendered.mean_square(from_s, to_s) - 1.0,
        times_real_time: 0.0,
        covered: covered as f64 / counted.max(1) as f64,
    }
}

/// Speed and its uncertainty between the two nearest points of a track.
fn at(track: &[TrackPoint], time_s: f64) -> Option<(f64, f64)> {
    let next = track.partition_point(|point| point.time_s < time_s);
    let (before, after) = (track.get(next.wrapping_sub(1)), track.get(next));
    match (before, after) {
        (Some(a), Some(b)) if b.time_s - a.time_s < 2.0 * GAP_S => {
            let share = (time_s - a.time_s) / (b.time_s - a.time_s);
            let std = a.std_uncertainty_rev_s.max(b.std_uncertainty_rev_s);
            Some((a.speed_rev_s + share * (b.speed_rev_s - a.speed_rev_s), std))
        }
        (Some(a), _) if time_s - a.time_s < GAP_S => Some((a.speed_rev_s, a.std_uncertainty_rev_s)),
        (_, Some(b)) if b.time_s - time_s < GAP_S => Some((b.speed_rev_s, b.std_uncertainty_rev_s)),
        _ => None,
    }
}

fn permutations(count: usize) -> Vec<Vec<usize>> {
    if count == 0 {
        return vec![Vec::new()];
    }
    permutations(count - 1)
        .into_iter()
        .flat_map(|shorter| {
            (0..count).map(move |place| {
                let mut longer = shorter.clone();
                longer.insert(place, count - 1);
                longer
            })
        })
        .collect()
}
