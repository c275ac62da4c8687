//! Labels from several microphones at known places: levels and delays of each rotor's lines.
//!
//! ```text
//! each audio channel, along the rotors' turns ─▶ amplitude of every line in blocks ─▶ all channels together ─┐
//!                                                (line_amplitudes, line_bank)         (paired_lines)         │
//!         posterior over all assignments ◀─┬── level_model: distance, directivity, gains of microphones ◀────┤
//!                                          └── delay_model: distance / speed of sound, as phases ◀───────────┘
//! ```

mod array;
mod delay_model;
mod level_model;
mod line_amplitudes;
mod line_bank;
mod paired_lines;
mod settings;
mod von_mises;

pub use array::{ArrayError, MicrophoneArray, PlacedRotor};
pub use line_amplitudes::{MicrophoneLines, microphone_lines_from_source};
pub use settings::MicrophonesConfig;

use crate::posterior::{Posterior, TRACKS_MIN, assignments};
use crate::settings::LabelsConfig;
use delay_model::DelayModel;
use hovertone_analysis::{LabelSource, NotTold, RotorLabels};
use level_model::LevelModel;
use paired_lines::paired_lines_from_channels;

/// The labels of tracks, from their lines at several microphones. `channels` has one entry for each microphone of `array`, in its sequence,
/// all made with the same tracks.
///
/// The likelihood of every assignment of tracks to rotors is divided by that of "rotors and microphones are elsewhere, at distances like
/// these, in no known sequence":
///
/// - *Levels*: the mean level of a rotor's lines at a microphone is `loudness − 20 log₁₀ d + D/2`, with the unknown loudness of the rotor,
///   the distance d and the directivity D of turning blades. Standard deviations: D/2, bodies and arms
///   ([`level_std_db`](MicrophonesConfig::level_std_db)), the gain of a microphone, which is the same for all rotors, and the scatter of
///   the rotor's lines, which is measured.
/// - *Delays*: the phase of a line between two microphones a and b is `−2π f (d_a − d_b) / c`. The difference of this phase between two
///   rotors is compared: the drift of the vehicle is common to both and cancels. The error of the places adds to the paths of all lines
///   of a rotor alike, and is integrated out. Single phases scatter by a von Mises distribution, whose width is integrated out, and a
///   share of them is uniform. Lines for which the error of the places exceeds half a wavelength are left out.
///
/// A track without a label, or the reason why no track has one, is part of the result: microphones in a plane of symmetry of the vehicle
/// cannot separate its two sides. Measured limits: docs/rotors.md.
pub fn labels_from_microphones(
    channels: &[MicrophoneLines],
    array: &MicrophoneArray,
    config: &MicrophonesConfig,
) -> RotorLabels {
    let tracks = channels.first().map_or(0, |lines| lines.speeds_rev_s.len());
    let not_told = |reason| RotorLabels::not_told(LabelSource::Microphones, tracks, reason);
    if channels.len() != array.microphones_m.len() {
        return not_told(NotTold::OtherChannels { channels: channels.len(), microphones: array.microphones_m.len() });
    }
    if tracks < TRACKS_MIN {
        return not_told(NotTold::TooFewTracks { tracks, needed: TRACKS_MIN });
    }
    if tracks > array.rotors.len() {
        return not_told(NotTold::OtherPlaces { tracks, places: array.rotors.len() });
    }
    let lines = paired_lines_from_channels(channels, config);
    let has_lines = |microphone: &usize| lines.powers.iter().any(|line| line.powers[*microphone].is_some());
    if let Some(deaf) = (0..channels.len()).find(|microphone| !has_lines(microphone)) {
        return not_told(NotTold::NothingHeard { microphone: deaf + 1 });
    }
    let assignments = assignments(tracks, array.rotors.len());
    let levels = LevelModel::new(&lines.powers, tracks, array, config);
    let delays = DelayModel::new(&lines.phases, tracks, array, config);
    let tempered = assignments
        .iter()
        .map(|assignment| levels.ln_likelihood_ratio(assignment) + delays.ln_likelihood_ratio(assignment))
        // a ratio that overflowed carries no information
        .map(|ln_ratio| if ln_ratio.is_finite() { config.evidence_share * ln_ratio } else { 0.0 })
        .map(|ln_ratio| ln_ratio + (config.array_prior / (1.0 - config.array_prior)).ln());
    // all channels have one clock: the only offset is 0
    let mut posterior = Posterior::new(&assignments, 1);
    posterior.add(0.0, Some(tempered.collect()));
    let names: Vec<String> = array.rotors.iter().map(|rotor| rotor.name.clone()).collect();
    let settings = LabelsConfig { probability_min: config.probability_min, ..LabelsConfig::default() };
    let labels = posterior.labels(LabelSource::Microphones, &names, &settings);
    let not_told = labels.not_told.map(|reason| match reason {
        NotTold::NothingInCommon { probability } => NotTold::OtherArray { probability },
        NotTold::SeveralFit { tracks } => NotTold::SeveralPlacesFit { tracks },
        other => other,
    });
    RotorLabels { offset_s: None, offset_std_s: None, not_told, ..labels }
}
