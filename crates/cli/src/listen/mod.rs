//! `hovertone listen`: rotor speed of sound as it arrives.

mod advice;
mod level;
mod lines;
#[cfg(feature = "microphone")]
mod microphone;
mod pace;
mod screen;
mod source;
mod summary;
mod view;

use crate::args::{AnalysisArguments, ListenArguments};
use crate::failure::{Ending, Failure};
use crate::settings::{config_of, idle_mass};
use crate::terminal::Terminal;
use crate::which_speed::which_is_right;
use advice::Advice;
use hovertone::live::{Listener, LiveConfig, LiveSpeed, LiveStatus};
use hovertone_report::Notice;
use hovertone_vehicle::{RotorSpeed, check_range, check_tips};
use lines::{PlainLines, json_line};
use pace::Pace;
use screen::{Key, Screen};
use source::LiveSound;
use std::io::{IsTerminal, stdout};
use std::time::Duration;
use summary::LiveSummary;
use view::View;

/// Slowest and fastest play.
const SPEED_MIN: f64 = 0.1;
const SPEED_MAX: f64 = 1e6;

/// Where the live speeds go.
enum Output {
    Json,
    Plain(PlainLines),
    Screen(Box<Screen>, Box<View>),
}

/// Hears the sound to its end.
pub(crate) fn run(arguments: &ListenArguments, terminal: &mut Terminal) -> Result<Ending, Failure> {
    check_range("--speed", arguments.speed, SPEED_MIN, SPEED_MAX)?;
    let analysis = AnalysisArguments { mean_only: arguments.mean_only, ..AnalysisArguments::default() };
    let (config, discovery) = config_of(&arguments.tone, &arguments.known, &analysis)?;
    if let Some(notice) = idle_mass(&arguments.known, &config.known) {
        terminal.tip(&notice);
    }
    let mut sound = LiveSound::open(arguments.from_file.as_deref(), arguments.channel)?;
    let which_is_right = which_is_right(&config, discovery.as_ref());
    let advice = Advice::new(&arguments.tone, &arguments.known, which_is_right);
    let mut summary = LiveSummary::new(config.hover.held_s_min);
    let config = LiveConfig::of_analysis(config, discovery);
    let block_samples = (config.every_s * sound.sample_rate_hz()) as usize;
    let mut listener = Listener::new(sound.sample_rate_hz(), config).map_err(unheard)?;
    let mut output = match (arguments.json, arguments.plain || !stdout().is_terminal()) {
        (true, _) => Output::Json,
        (false, true) => Output::Plain(PlainLines::new(advice.clone())),
        (false, false) => Output::Screen(Box::new(Screen::open()?), Box::new(View::new(sound.name(), advice.clone()))),
    };
    let pace = Pace::new(arguments.speed);
    let mut too_fast = None;
    while let Some(samples) = sound.next_block()? {
        for mut rest in samples.chunks(block_samples.max(1)) {
            while !rest.is_empty() {
                let mut arrived = None;
                rest = listener.push(rest, &mut |speed| arrived = Some(speed));
                let is_reviewed = listener.wants_review();
                if is_reviewed {
                    listener.review().map_err(unheard)?;
                }
                arrived.iter().for_each(|speed| summary.add(speed, listener.more_probable()));
                too_fast = too_fast.or_else(|| tips_too_fast(arguments.known.diameter_m, &arrived?));
                let wait = pace.time_left(listener.heard_s());
                if !tell(&mut output, arrived, is_reviewed, wait, &mut listener, terminal)? {
                    return Ok(Ending::Done);
                }
            }
        }
    }
    if let Output::Plain(_) = &output {
        terminal.data(&summary.in_words(&advice).unwrap_or_default())?;
        terminal.flush()?;
    }
    // a message on the screen would go with it
    drop(output);
    sound.notices().iter().chain(&too_fast).for_each(|notice| terminal.warning(notice, ""));
    Ok(if summary.is_settled() { Ending::Done } else { Ending::Incomplete })
}

/// That the blade tips would be too fast at a live speed.
fn tips_too_fast(diameter_m: Option<f64>, live: &LiveSpeed) -> Option<Notice> {
    let rev_s = live.speed_rev_s.filter(|_| live.status == LiveStatus::Ok)?;
    let contradiction = check_tips(diameter_m?, RotorSpeed::from_rev_s(rev_s)).err()?;
    Some(Notice::new(contradiction.to_string(), contradiction.hint()))
}

/// Tells a speed, and waits until the sound so far has been played. `false` where a person ends it.
fn tell(
    output: &mut Output,
    arrived: Option<LiveSpeed>,
    is_reviewed: bool,
    wait: Duration,
    listener: &mut Listener,
    terminal: &mut Terminal,
) -> Result<bool, Failure> {
    let lines = match output {
        Output::Json => arrived.map(|speed| json_line(&speed, listener)).transpose()?,
        Output::Plain(lines) => arrived.and_then(|speed| lines.line(&speed, listener)),
        Output::Screen(screen, view) => {
            if is_reviewed {
                view.take_review(listener);
            }
            if let Some(speed) = arrived {
                view.take(speed);
                screen.draw(view)?;
            }
            return answer_key(screen, view, wait, listener);
        }
    };
    if let Some(line) = lines {
        terminal.data(&line)?;
        terminal.flush()?;
    }
    std::thread::sleep(wait);
    Ok(true)
}

/// Does what a key says. `false` for the end.
fn answer_key(screen: &mut Screen, view: &mut View, wait: Duration, listener: &mut Listener) -> Result<bool, Failure> {
    let begun = std::time::Instant::now();
    loop {
        match screen.key(wait.saturating_sub(begun.elapsed()))? {
            Some(Key::Quit) => return Ok(false),
            Some(Key::Freeze) => view.is_frozen = !view.is_frozen,
            Some(Key::Choose(choice)) => listener.choose(choice),
            None if begun.elapsed() >= wait => return Ok(true),
            None => {}
        }
        screen.draw(view)?;
    }
}

fn unheard(error: hovertone::speed::Error) -> Failure {
    Failure::usage(error.to_string(), "see `hovertone listen --help`")
}
