//! Part of stage 5: a hover → the track of each rotor, in two passes.

use super::Surveyed;
use crate::config::Config;
use crate::error::Error;
use crate::evidence::{OwnPropeller, loudness_db, own_lines_nats};
use crate::rotors::{RotorScout, RotorTracer, RotorTracks};
use crate::tone::{blades_of_tone, lines_between_speeds, lines_worth_hearing};
use hovertone_analysis::Hover;
use hovertone_signal::passes::Passes;
use hovertone_vehicle::BLADES_MAX;

/// Separates the rotors in two passes: the first finds their speeds in a wide band, the second follows each rotor.
pub(crate) fn rotors_from_hover(
    passes: &mut Passes<'_>,
    surveyed: &Surveyed,
    hover: &Hover,
    speed_rev_s: f64,
    config: &Config,
) -> Result<RotorTracks, Error> {
    let sample_rate_hz = passes.sample_rate_hz();
    let lines_in = |limits_rev_s: (f64, f64)| {
        lines_worth_hearing(lines_between_speeds(limits_rev_s, &config.tone, sample_rate_hz), &surveyed.survey)
    };
    let order = config.tone.order.lines_per_turn();
    let mesh_order = (order > BLADES_MAX).then_some(order);
    let share = config.rotors.band_half_width_share;
    let wide = lines_in((speed_rev_s * (1.0 - share), speed_rev_s * (1.0 + share)));
    let mut scout = RotorScout::new(sample_rate_hz, &wide, mesh_order, config.rotors.count as usize);
    passes.listen(&hover.spans_s(), &mut scout)?;
    let rough = scout.finish();
    let mut tracer = RotorTracer::new(sample_rate_hz, &lines_in(rough.band_rev_s()), mesh_order, rough);
    passes.listen(&hover.spans_s(), &mut tracer)?;
    Ok(tracer.finish())
}

/// The tracks without those that the evidence refutes: the lines which such a rotor shares with no other one are missing. The most doubtful one
/// goes first, because its lines may hide those of others.
pub(super) fn without_refuted(
    mut tracks: RotorTracks,
    surveyed: &Surveyed,
    hover: &Hover,
    config: &Config,
) -> RotorTracks {
    let Some((excess, blades)) = surveyed.excess.as_ref().zip(blades_of_tone(&config.tone)) else { return tracks };
    if tracks.rotors.is_empty() {
        return tracks;
    }
    let excess = excess.short.within(&hover.spans_s());
    let times_s: Vec<f64> = excess.frames.iter().map(|frame| frame.centre_s).collect();
    let mut speeds_rev_s: Vec<Option<Vec<f64>>> =
        tracks.rotors.iter().map(|rotor| rotor.track.speeds_at(&times_s)).collect();
    let propeller = OwnPropeller { blades, prior: &config.evidence.levels };
    let loudness = speeds_rev_s.iter().flatten().filter_map(|speeds_rev_s| loudness_db(&excess, speeds_rev_s, blades));
    let loudest_db = loudness.fold(f64::MIN, f64::max);
    loop {
        let own_nats = |rotor: usize| {
            let others = speeds_rev_s.iter().enumerate().filter(|(other, _)| *other != rotor);
            let others: Vec<&[f64]> = others.filter_map(|(_, speeds_rev_s)| speeds_rev_s.as_deref()).collect();
            Some(own_lines_nats(&excess, speeds_rev_s[rotor].as_deref()?, &others, loudest_db, &propeller))
        };
        let all = (0..speeds_rev_s.len()).filter_map(|rotor| Some((rotor, own_nats(rotor)?)));
        match all.min_by(|a, b| a.1.total_cmp(&b.1)) {
            Some((rotor, nats)) if nats < -config.evidence.refuting_nats_max => {
                tracks.rotors[rotor].track.blocks.clear();
                speeds_rev_s[rotor] = None;
            }
            _ => return tracks,
        }
    }
}
