//! The analysis of the last seconds, the same as that of a recording.

use crate::follower::SpeedAt;
use crate::octave::PossibleSpeed;
use crate::settings::LiveConfig;
use hovertone_analysis::{
    Method, NoTone, Outcome, Reading, RotorTone, RotorsHeard, Span, SpeedAnalysis, TrackPoint, Warning,
};
use hovertone_rotor_speed::{Config, Error, FoundSpeed, blades_known, speed_from_source, tones_from_source};
use hovertone_signal::Signal;

/// What a review found.
pub(crate) enum Reviewed {
    /// A rotor, or several.
    Heard(Box<HeardRotors>),
    /// None.
    NotHeard(NoTone),
}

/// Rotors that a review heard.
pub(crate) struct HeardRotors {
    /// Speed of each separated rotor, fastest first.
    pub(crate) rotors_rev_s: Vec<f64>,
    /// Combined standard uncertainty of the mean.
    pub(crate) std_uncertainty_rev_s: f64,
    /// Mean shaft speed.
    pub(crate) speed_rev_s: f64,
    /// The speeds that were compared, this one first.
    pub(crate) compared: Vec<PossibleSpeed>,
    /// Warnings that the speed may not be that of the rotor.
    pub(crate) doubts: Vec<Warning>,
    /// The settings with the tone that was found.
    pub(crate) config: Config,
    hover: Vec<Span>,
    track: Vec<TrackPoint>,
}

impl HeardRotors {
    /// `None` where the tone has no speed. `alternatives`: the possible readings, most plausible first; empty where one is decided.
    fn of(tone: RotorTone, hover: Vec<Span>, alternatives: &[Reading], config: Config) -> Option<Self> {
        let method = config.method;
        let speed = tone.speed(method)?;
        let speed_rev_s = speed.speed.rev_s();
        Some(Self {
            speed_rev_s,
            compared: compared(&tone, alternatives, speed_rev_s, &config),
            rotors_rev_s: tone.rotors.iter().map(|rotor| rotor.speed.speed.rev_s()).collect(),
            std_uncertainty_rev_s: speed.combined_std_uncertainty_rev_s().or(speed.std_uncertainty_rev_s)?,
            doubts: Vec::new(),
            config,
            hover,
            track: track_of(tone, method),
        })
    }

    /// The points of the track before and behind a time.
    fn points_around(&self, time_s: f64) -> Option<(&TrackPoint, &TrackPoint)> {
        let behind = self.track.partition_point(|point| point.time_s < time_s);
        Some((self.track.get(behind.checked_sub(1)?)?, self.track.get(behind)?))
    }

    /// Lines per turn that are followed: of a gear whose blades are known, those of the blades, which rotors at unlike speeds share for longer.
    pub(crate) fn followed_order(&self) -> f64 {
        let tone = &self.config.tone;
        blades_known(tone).map_or(tone.order.lines_per_turn(), f64::from)
    }
}

/// The speed over time. That of a group is its mean, and each point has the spread of its rotors.
fn track_of(tone: RotorTone, method: Method) -> Vec<TrackPoint> {
    match tone.rotors_heard(method) {
        Some(RotorsHeard::Group) => tone.tracks_beside_log(method).swap_remove(0).into_owned(),
        _ => tone.track,
    }
}

/// The speeds that were compared: the readings of a tone that nobody has named, else the chosen speed and its runner-up.
fn compared(tone: &RotorTone, alternatives: &[Reading], speed_rev_s: f64, config: &Config) -> Vec<PossibleSpeed> {
    let blades = blades_known(&config.tone);
    let own = PossibleSpeed { order: config.tone.order, blades, speed_rev_s, belief: 1.0 };
    if !alternatives.is_empty() {
        let possible = |reading: &Reading| PossibleSpeed {
            order: reading.order,
            blades: reading.meaning.blades().or(blades),
            speed_rev_s: reading.speed.rev_s(),
            belief: reading.plausibility,
        };
        return alternatives.iter().map(possible).collect();
    }
    let weighed = tone.weighed.iter().map(|it| (it.speed.rev_s(), it.plausibility));
    let weighed: Vec<PossibleSpeed> =
        weighed.map(|(speed_rev_s, belief)| PossibleSpeed { speed_rev_s, belief, ..own }).collect();
    if weighed.is_empty() { vec![own] } else { weighed }
}

impl SpeedAt for HeardRotors {
    fn speed_rev_s_at(&self, time_s: f64) -> Option<f64> {
        let is_hover = self.hover.iter().any(|span| span.contains(time_s));
        let (before, behind) = self.points_around(time_s)?;
        let share = (time_s - before.time_s) / (behind.time_s - before.time_s).max(f64::MIN_POSITIVE);
        is_hover.then_some(before.speed_rev_s + share * (behind.speed_rev_s - before.speed_rev_s))
    }

    fn std_uncertainty_rev_s_at(&self, time_s: f64) -> Option<f64> {
        let (before, behind) = self.points_around(time_s)?;
        Some(before.std_uncertainty_rev_s.max(behind.std_uncertainty_rev_s))
    }

    fn mean_rev_s(&self) -> f64 {
        self.speed_rev_s
    }
}

/// Analyses the sound.
///
/// # Errors
/// Settings without a meaning; a band above half the sample rate.
pub(crate) fn review(sound: &mut Signal, config: &LiveConfig) -> Result<Reviewed, Error> {
    let (analysis, alternatives, config) = match &config.discovery {
        Some(discovery) => {
            let FoundSpeed { config, analysis, alternatives, .. } =
                tones_from_source(sound, &config.analysis, discovery, &mut |_| {})?;
            (analysis, alternatives, config)
        }
        None => (speed_from_source(sound, &config.analysis, &mut |_| {})?, Vec::new(), config.analysis.clone()),
    };
    let SpeedAnalysis { hover, outcome, mut warnings, .. } = analysis;
    Ok(match outcome {
        Outcome::NoRotorTone { reason } => Reviewed::NotHeard(reason),
        Outcome::Ok(mut tone) => {
            let own = std::mem::take(&mut tone.alternatives);
            let alternatives = if alternatives.is_empty() { own } else { alternatives };
            match HeardRotors::of(tone, hover.segments, &alternatives, config) {
                Some(heard) => {
                    warnings.retain(|warning| {
                        matches!(warning, Warning::FitsElsewhere(_) | Warning::OtherRotorsHeard { .. })
                    });
                    Reviewed::Heard(Box::new(HeardRotors { doubts: warnings, ..heard }))
                }
                None => Reviewed::NotHeard(NoTone::NoHover),
            }
        }
    })
}
