//! Part of stage 5: a hover → the track of each rotor, in two passes.

use super::Surveyed;
use crate::config::Config;
use crate::error::Error;
use crate::evidence::{Excess, OwnPropeller, loudness_db, own_lines_nats};
use crate::rotors::{RotorScout, RotorTracer, RotorTracks, RotorsConfig};
use crate::tone::{blades_of_tone, lines_between_speeds, lines_worth_hearing};
use hovertone_analysis::Hover;
use hovertone_signal::passes::Passes;
use hovertone_vehicle::BLADES_MAX;
use std::ops::RangeInclusive;

/// The rotors whose own lines are heard. Where their number is not known and another is heard beside all of them, two more are looked for, in
/// two more passes, and so on: tracks without a rotor would lie beside those of others. They count only where each of them stands apart, because a
/// track too many follows a rotor that another one follows already. Else the first ones stay, beside others of which nothing is known but that they
/// may turn. A multirotor has an even number of rotors.
pub(super) fn heard_rotors(
    passes: &mut Passes<'_>,
    surveyed: &Surveyed,
    hover: &Hover,
    speed_rev_s: f64,
    config: &Config,
) -> Result<RotorTracks, Error> {
    let separated = |passes: &mut Passes<'_>, rotors: RotorsConfig| -> Result<RotorTracks, Error> {
        let config = &Config { rotors, ..config.clone() };
        Ok(without_unheard(rotors_from_hover(passes, surveyed, hover, speed_rev_s, config)?, surveyed, hover, config))
    };
    let mut sought = config.rotors;
    let mut rotors = separated(passes, sought)?;
    let mut leave_another = rotors.leave_another();
    if sought.is_count_known {
        // what may be the rest of these rotors is no other rotor
        let another_s = if leave_another { rotors.another_s } else { 0.0 };
        return Ok(RotorTracks { another_s, ..rotors });
    }
    while let Some(more) = sought.more().filter(|_| leave_another) {
        sought = more;
        passes.expect_more(2);
        let of_more = separated(passes, sought)?;
        leave_another = of_more.leave_another();
        let count = (rotors.heard_count() + 1).next_multiple_of(2);
        rotors = if of_more.are_all_apart() { of_more } else { rotors.of_count(count) };
    }
    Ok(rotors)
}

/// Separates the rotors in two passes: the first finds their speeds in a wide band, the second follows each rotor.
pub(crate) fn rotors_from_hover(
    passes: &mut Passes<'_>,
    surveyed: &Surveyed,
    hover: &Hover,
    speed_rev_s: f64,
    config: &Config,
) -> Result<RotorTracks, Error> {
    let sample_rate_hz = passes.sample_rate_hz();
    let lines_in = |speeds_rev_s: RangeInclusive<f64>| {
        lines_worth_hearing(lines_between_speeds(&speeds_rev_s, &config.tone, sample_rate_hz), &surveyed.survey)
    };
    let order = config.tone.order.lines_per_turn();
    let mesh_order = (order > BLADES_MAX).then_some(order);
    let share = config.rotors.band_half_width_share;
    let wide = lines_in(speed_rev_s * (1.0 - share)..=speed_rev_s * (1.0 + share));
    let mut scout = RotorScout::new(sample_rate_hz, &wide, mesh_order, config.rotors.count as usize);
    passes.listen(&hover.spans_s(), &mut scout)?;
    let rough = scout.finish();
    let mut tracer = RotorTracer::new(sample_rate_hz, &lines_in(rough.band_rev_s()), mesh_order, rough);
    passes.listen(&hover.spans_s(), &mut tracer)?;
    Ok(tracer.finish())
}

/// The tracks without those whose own lines are not heard: the lines that a rotor shares with no other one, in short and long frames together. Long
/// frames resolve rotors that are close. In the quieter frames they must not speak against it, because a voice pauses and a rotor does not. A rotor
/// that has no such line stays, because nothing can be said of it. The most doubtful one goes first: its lines may hide those of others. Behind a
/// gear, propellers may be inaudible: then all rotors stay. But where one is heard, those of the others are, too: what has none is a side line of a
/// mesh, which the motor's turns make.
fn without_unheard(mut tracks: RotorTracks, surveyed: &Surveyed, hover: &Hover, config: &Config) -> RotorTracks {
    let of_tone = blades_of_tone(&config.tone);
    let Some(blades) = of_tone.or(config.tone.blades) else { return tracks };
    let nats_min = config.evidence.own_lines_nats_min;
    let propeller = OwnPropeller { blades, prior: &config.evidence.levels };
    let looks = [&surveyed.looks.short, &surveyed.looks.long].map(|look| look.within(&hover.spans_s()));
    let mut in_quiet = looks.each_ref().map(|look| SeenRotors::new(look.quieter(), &tracks));
    let mut in_all = looks.map(|look| SeenRotors::new(look, &tracks));
    loop {
        let nats_in = |looks: &[SeenRotors; 2], rotor: usize| {
            let nats = looks.iter().filter_map(|seen| seen.own_nats(rotor, &propeller));
            nats.reduce(|short, long| short + long)
        };
        let own_nats = |rotor: usize| {
            let nats = nats_in(&in_all, rotor)?;
            Some(nats_in(&in_quiet, rotor).map_or(nats, |quiet_nats| nats.min(nats_min + quiet_nats)))
        };
        let all: Vec<(usize, f64)> =
            (0..tracks.rotors.len()).filter_map(|rotor| Some((rotor, own_nats(rotor)?))).collect();
        if of_tone.is_none() && all.iter().all(|(_, nats)| *nats < nats_min) {
            return tracks;
        }
        match all.into_iter().min_by(|a, b| a.1.total_cmp(&b.1)) {
            Some((rotor, nats)) if nats < nats_min => {
                tracks.rotors[rotor].track.blocks.clear();
                in_all.iter_mut().chain(&mut in_quiet).for_each(|seen| seen.speeds_rev_s[rotor] = None);
            }
            _ => return tracks,
        }
    }
}

/// Frames of one length along the tracks of all rotors.
struct SeenRotors {
    excess: Excess,
    /// Speed of each rotor in each frame; `None` without a track.
    speeds_rev_s: Vec<Option<Vec<f64>>>,
}

impl SeenRotors {
    fn new(excess: Excess, tracks: &RotorTracks) -> Self {
        let times_s: Vec<f64> = excess.frames.iter().map(|frame| frame.centre_s).collect();
        let speeds_rev_s = tracks.rotors.iter().map(|rotor| rotor.track.speeds_at(&times_s)).collect();
        Self { excess, speeds_rev_s }
    }

    /// The evidence in nats of the lines that a rotor shares with no other one. `None` where there is none.
    fn own_nats(&self, rotor: usize, propeller: &OwnPropeller<'_>) -> Option<f64> {
        let Self { excess, speeds_rev_s } = self;
        let loudness = speeds_rev_s.iter().flatten().filter_map(|speeds| loudness_db(excess, speeds, propeller.blades));
        let loudest_db = loudness.max_by(f64::total_cmp)?;
        let others = speeds_rev_s.iter().enumerate().filter(|(other, _)| *other != rotor);
        let others: Vec<&[f64]> = others.filter_map(|(_, speeds)| speeds.as_deref()).collect();
        own_lines_nats(excess, speeds_rev_s[rotor].as_deref()?, &others, loudest_db, propeller)
    }
}
