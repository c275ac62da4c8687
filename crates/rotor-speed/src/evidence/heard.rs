//! What is heard: a rotor with the beliefs in its speeds, beside a voice or alone, or nothing. Here the steps of the evidence follow one another.

use super::beliefs::Beliefs;
use super::elsewhere::better_elsewhere;
use super::excess::{Excess, Looks};
use super::hypotheses::{
    Hypothesis, RESOLVED_REV_S, WantedPropeller, WantedRotor, hypothesis_of, one_of_each_speed, with_beliefs,
};
use super::level_model::LevelModel;
use super::levels::{NoiseLevel, noise_level};
use super::presence::Presence;
use super::prior::nats_of_vehicle;
use super::rotor_lines::RotorLines;
use super::search::{Multiple, Search, VOTES_SHARE_MIN};
use super::second_look::{SecondLook, path_in_long_frames};
use super::settings::EvidenceConfig;
use super::votes::VoteTable;
use crate::harmonic::STEADY_S_MIN;
use std::ops::RangeInclusive;

/// Compares the hypotheses in two looks at the same sound: without a voice, where one sounds; in long frames alone, where short ones hear no rotor:
/// a faint, steady one, which must keep its phase, so that a shorter sound cannot hold it. `None` where no rotor is heard.
pub(crate) fn beliefs_from_looks(looks: &Looks, wanted: &WantedRotor, config: &EvidenceConfig) -> Option<Beliefs> {
    clear_beliefs_from_looks(looks, wanted, config).or_else(|| {
        if looks.long.length_s() < STEADY_S_MIN {
            return None;
        }
        let of_long_frames = Looks { short: looks.long.clone(), long: looks.long.clone() };
        let of_any_votes = EvidenceConfig { votes_nats_min: f64::MIN, ..*config };
        match beliefs_of(&of_long_frames, wanted, &of_any_votes)? {
            Heard::Rotor(beliefs) => Some(Beliefs { is_faint: true, ..beliefs }),
            Heard::Voice(_) => None,
        }
    })
}

/// What sounds in some frames.
enum Heard {
    Rotor(Beliefs),
    Voice(HeardVoice),
}

/// A voice or an instrument, which explains the frames far better than any rotor.
struct HeardVoice {
    /// What it has more than the most probable rotor, in nats a frame.
    gain_nats: f64,
    /// Median of the votes for that rotor.
    rotor_votes_nats: f64,
    /// The frames in which it sounds, without its lines.
    without: Looks,
}

/// The same of a rotor that short frames hear: in the sound without a voice, where one sounds. The rotor goes on while a voice sounds, so that it
/// keeps most of its votes: a motor that jumps from speed to speed leaves a small rest of its lines, which is no rotor.
pub(crate) fn clear_beliefs_from_looks(
    looks: &Looks,
    wanted: &WantedRotor,
    config: &EvidenceConfig,
) -> Option<Beliefs> {
    let voice = match beliefs_of(looks, wanted, config)? {
        Heard::Rotor(beliefs) => return Some(beliefs),
        Heard::Voice(voice) => voice,
    };
    let Heard::Rotor(beliefs) = beliefs_of(&voice.without, wanted, config)? else { return None };
    let votes_nats = beliefs.hypotheses.first()?.votes_nats;
    let is_most = votes_nats >= VOTES_SHARE_MIN * voice.rotor_votes_nats;
    is_most.then_some(Beliefs { without_voice: Some(voice.without), ..beliefs })
}

/// What sounds in these frames. `None` where neither a rotor nor a voice is heard.
fn beliefs_of(looks: &Looks, wanted: &WantedRotor, config: &EvidenceConfig) -> Option<Heard> {
    let Look { noise, mut of_propellers, mut model } = look_at(&looks.short, wanted, config)?;
    let mut again = look_again(looks, &mut of_propellers, config);
    let mut presence = Presence::new(noise, again.as_ref().map(|(noise, _)| *noise), &config.levels);
    let is_possible = |look: &OfPropeller| wanted.may_be_slow || is_resolved(&look.hypotheses);
    let heard =
        of_propellers.into_iter().filter(|look| is_possible(look) && presence.is_heard(&look.hypotheses, config));
    let mut hypotheses: Vec<Hypothesis> = Vec::new();
    let mut loudest: Option<HeardVoice> = None;
    for look in heard {
        match voice_beside(&look, looks, config) {
            Some(voice) => loudest = loudest.filter(|it| it.gain_nats >= voice.gain_nats).or(Some(voice)),
            None => hypotheses
                .extend(look.hypotheses.into_iter().map(|it| Hypothesis { nats: it.nats + look.share_nats, ..it })),
        }
    }
    if hypotheses.is_empty() {
        return loudest.map(Heard::Voice);
    }
    let hypotheses = with_beliefs(hypotheses);
    let better = again
        .as_mut()
        .and_then(|(_, long)| better_elsewhere(hypotheses.first()?, looks, wanted, [&mut model, long], config));
    Some(Heard::Rotor(Beliefs { hypotheses, noise, is_faint: false, better, without_voice: None }))
}

/// The voice or the instrument that explains the frames far better than the most probable hypothesis. `None` where none does.
fn voice_beside(look: &OfPropeller, looks: &Looks, config: &EvidenceConfig) -> Option<HeardVoice> {
    let first = look.hypotheses.first()?;
    let searched;
    let search = match &look.search {
        Some(search) => search,
        None => {
            searched = Search::of(&looks.short, &look.lines, &look.speeds_rev_s)?;
            &searched
        }
    };
    let voice = search.voice_beside(first.speed_rev_s, config.jumps_nats_max)?;
    Some(HeardVoice {
        gain_nats: voice.gain_nats,
        rotor_votes_nats: first.votes_nats,
        without: voice.left_out_of(looks, |point| search.speed_rev_s(point)),
    })
}

/// Adds to each hypothesis what the long frames show along its path, and sorts them again. Returns the noise of these frames over the near
/// floor, and the model of that over the wide one; `None` where they show none.
fn look_again<'a>(
    looks: &Looks,
    of_propellers: &mut [OfPropeller],
    config: &'a EvidenceConfig,
) -> Option<(NoiseLevel, LevelModel<'a>)> {
    let near = looks.long.over_near_floor();
    let mut seen: Vec<Vec<Option<[SecondLook; 2]>>> = Vec::new();
    for look in &*of_propellers {
        let table = VoteTable::of(&look.lines);
        // octaves are compared along one path: that of the one with the most votes
        let mut paths: Vec<(&Hypothesis, Vec<f64>)> = Vec::new();
        let mut by_votes: Vec<&Hypothesis> = look.hypotheses.iter().collect();
        by_votes.sort_by(|a, b| b.votes_nats.total_cmp(&a.votes_nats));
        for it in by_votes {
            if !paths.iter().any(|(other, _)| other.path == it.path)
                && let Some(path) = path_in_long_frames(looks, &it.speeds_rev_s, &table)
            {
                paths.push((it, path));
            }
        }
        let along = |it: &Hypothesis| {
            let (of, path) = paths.iter().find(|(other, _)| other.path == it.path)?;
            let speeds_rev_s: Vec<f64> = path.iter().map(|speed_rev_s| it.factor / of.factor * speed_rev_s).collect();
            SecondLook::over_both_floors([&looks.long, &near], &speeds_rev_s, &look.lines)
        };
        seen.push(look.hypotheses.iter().map(along).collect());
    }
    let noise_over = |floor: usize| {
        let noises = seen.iter().flatten().flatten().map(|floors| floors[floor].noise).collect();
        NoiseLevel::of_emptiest(noises, config.levels.foreign)
    };
    let noises = [noise_over(0)?, noise_over(1)?];
    let mut models = noises.map(|noise| LevelModel::of_speeds(noise, &config.levels));
    for (look, seen) in of_propellers.iter_mut().zip(seen) {
        let Some(seen) = seen.into_iter().collect::<Option<Vec<[SecondLook; 2]>>>() else { continue };
        for (it, floors) in look.hypotheses.iter_mut().zip(seen) {
            let levels_nats = 0.5 * (it.levels_nats + SecondLook::evidence_nats(&floors, &mut models, &look.lines));
            it.nats += levels_nats - it.levels_nats;
            it.levels_nats = levels_nats;
            let [_, near] = floors;
            it.near_levels = Some(near.levels);
        }
        look.hypotheses.sort_by(|a, b| b.nats.total_cmp(&a.nats));
    }
    let ([_, near_noise], [model, _]) = (noises, models);
    Some((near_noise, model))
}

/// What frames of one length show.
struct Look<'a> {
    noise: NoiseLevel,
    /// The model that told the speeds apart.
    model: LevelModel<'a>,
    /// The hypotheses with each of the propellers that are heard.
    of_propellers: Vec<OfPropeller>,
}

/// The hypotheses with one propeller.
struct OfPropeller {
    lines: RotorLines,
    speeds_rev_s: RangeInclusive<f64>,
    /// Logarithm of how common it is.
    share_nats: f64,
    /// Most probable first; none where no path has the votes of a rotor.
    hypotheses: Vec<Hypothesis>,
    /// The search that found them, where it was kept.
    search: Option<Search>,
}

/// The hypotheses on frames of one length. `None` without frames.
///
/// The path with the most votes of all may be that of a slow comb, whose dense lines cover the wide lines of several rotors. Therefore each
/// octave has its path, and the levels decide among them. The noise is what the paths that explain most leave between their lines.
fn look_at<'a>(excess: &Excess, wanted: &WantedRotor, config: &'a EvidenceConfig) -> Option<Look<'a>> {
    let noises_of = |search: &Search| -> Vec<NoiseLevel> {
        search.speeds_of_paths().filter_map(|speeds_rev_s| noise_level(excess, &speeds_rev_s)).collect()
    };
    let mut noises: Vec<NoiseLevel> = Vec::new();
    // votes are large, so that those of the last propeller alone are kept
    let mut last: Option<Search> = None;
    let mut found: Vec<(&WantedPropeller, Vec<Multiple>)> = Vec::new();
    let mut lines_share = f64::INFINITY;
    for propeller in &wanted.propellers {
        drop(last.take());
        let search = Search::of(excess, &propeller.lines, &propeller.speeds_rev_s)?;
        let own = noises_of(&search);
        lines_share = own.iter().map(|noise| noise.lines_share).fold(lines_share, f64::min);
        noises.extend(own);
        found.push((propeller, search.multiples(config.votes_nats_min)));
        last = Some(search);
    }
    // lines that no wanted rotor explains are foreign, whatever another one would explain
    let noise = NoiseLevel { lines_share, ..NoiseLevel::of_emptiest(noises, config.levels.foreign)? };
    let mut model = LevelModel::of_speeds(noise, &config.levels);
    let of_propeller = |(propeller, multiples): (&WantedPropeller, Vec<Multiple>)| {
        let all = multiples.iter().filter_map(|multiple| {
            let hypothesis = hypothesis_of(multiple, &propeller.lines, excess, &mut model)?;
            let nats = hypothesis.levels_nats + nats_of_vehicle(hypothesis.speed_rev_s, &wanted.known, config);
            Some(Hypothesis { nats, ..hypothesis })
        });
        OfPropeller {
            lines: propeller.lines,
            speeds_rev_s: propeller.speeds_rev_s.clone(),
            share_nats: propeller.share.ln(),
            hypotheses: one_of_each_speed(all.collect()),
            search: None,
        }
    };
    let mut of_propellers: Vec<OfPropeller> = found.into_iter().map(of_propeller).collect();
    if let Some(propeller) = of_propellers.last_mut() {
        propeller.search = last;
    }
    Some(Look { noise, model, of_propellers })
}

/// Whether the lines of the most probable hypothesis stand apart.
fn is_resolved(hypotheses: &[Hypothesis]) -> bool {
    hypotheses.first().is_some_and(|first| first.speed_rev_s >= RESOLVED_REV_S)
}
